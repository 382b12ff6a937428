//! Mean value maps between cages in space, each proved or refuted by the independent checker.
//!
//! Usage: `cargo run --release -p homeo --example cage_table -- [--long]`
//!
//! Prints one row of a Markdown table for each pair: triangles, steps, the verdict, cells, seconds. While a map has no
//! certificate the steps are doubled, up to 64. With `--long` pairs that take minutes, too.
#![allow(clippy::print_stdout, reason = "a program")]

use std::f64::consts::TAU;
use std::io::Cursor;
use std::time::Instant;

use homeo::cage::{CageMap, CagePair};
use homeo::certificate::{Provenance, write_cages};
use homeo::shape::StraightPolyhedra;
use homeo_verify::{Verdict, verify_bytes};

type Point = [f64; 3];
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const MOST_STEPS: usize = 64;

fn main() -> Result<()> {
    println!("| cages | triangles | steps | verdict | cells | s |\n|---|---:|---:|---|---:|---:|");
    for (name, pair) in pairs()? {
        table_rows(name, &pair)?;
    }
    if std::env::args().any(|argument| argument == "--long") {
        table_rows("a bar of five storeys, twisted by a quarter turn", &bars()?)?;
    }
    Ok(())
}

fn table_rows(name: &str, pair: &CagePair) -> Result<()> {
    let path = StraightPolyhedra::new(pair.source().to_vec(), pair.target().to_vec())?;
    let mut steps = 1;
    while steps <= MOST_STEPS {
        let mut file = Cursor::new(Vec::new());
        write_cages(&CageMap::along(pair, &path, steps)?, &Provenance::default(), &mut file)?;
        let begin = Instant::now();
        let verdict = verify_bytes(file.get_ref())?;
        let seconds = begin.elapsed().as_secs_f64();
        let (words, cells) = match &verdict {
            Verdict::Certified(claim) => {
                let cells = claim.checked.iter().find(|(what, _)| what.starts_with("cells"));
                ("certified".to_owned(), cells.map_or(String::new(), |(_, count)| count.to_string()))
            }
            Verdict::Refuted(witness) => (format!("refuted by {}", witness.rule), String::new()),
            Verdict::Undecided(_) => ("undecided".to_owned(), String::new()),
        };
        println!("| {name} | {} | {steps} | {words} | {cells} | {seconds:.2} |", pair.triangles().len());
        if matches!(verdict, Verdict::Certified(_)) {
            return Ok(());
        }
        steps *= 2;
    }
    Ok(())
}

fn pairs() -> Result<Vec<(&'static str, CagePair)>> {
    let dart = |top: f64| {
        vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, top], [0.0, 0.0, -1.5]]
    };
    let sides = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    let darts = |before: f64, after: f64| CagePair::new(dart(before), dart(after), sides.clone());
    let octahedron = |height: f64, turn: f64| {
        let (sine, cosine) = f64::sin_cos(turn);
        let around = [[cosine, sine], [-sine, cosine], [-cosine, -sine], [sine, -cosine]];
        let ends = [[0.0, 0.0, height], [0.0, 0.0, -1.0]];
        around.map(|[x, y]| [x, y, 0.0]).into_iter().chain(ends).collect::<Vec<Point>>()
    };
    let tent = |apex: Point| vec![[-2.0, -2.0, -1.0], [2.0, -2.0, -1.0], [2.0, 2.0, -1.0], [-2.0, 2.0, -1.0], apex];
    let roof = vec![[0, 3, 2], [0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let (block, faces) = notched();
    let bend = |&[x, y, z]: &Point| [x + 0.2 * y * z, y - 0.15 * x * x + 0.1 * z, z + 0.1 * x * y];
    let bent = block.iter().map(bend).collect();
    Ok(vec![
        ("a tent whose top moves", CagePair::new(tent([0.0, 0.0, 3.0]), tent([1.5, 0.5, 2.5]), roof)?),
        (
            "an octahedron that grows and turns",
            CagePair::new(octahedron(1.0, 0.0), octahedron(1.5, 0.4), sides.clone())?,
        ),
        ("a prism whose upper end turns", CagePair::new(prism(0.0), prism(0.2), PRISM.to_vec())?),
        ("two pyramids, one turned inwards", darts(0.3, -0.6)?),
        ("the same, back", darts(-0.6, 0.3)?),
        ("a block with a notch that bends", CagePair::new(block, bent, faces)?),
    ])
}

const PRISM: [[u32; 3]; 8] = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];

fn prism(turn: f64) -> Vec<Point> {
    let corner = |k: u32| {
        let (height, turn) = if k < 3 { (0.0, 0.0) } else { (1.5, turn) };
        let (sine, cosine) = (TAU * f64::from(k % 3) / 3.0 + turn).sin_cos();
        [cosine, sine, height]
    };
    (0..6).map(corner).collect()
}

/// Of twenty triangles, with an edge where it is not convex.
fn notched() -> (Vec<Point>, Vec<[u32; 3]>) {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.25], [1.0, 2.0], [0.0, 2.0]];
    let points = [0.0, 1.5].iter().flat_map(|&z| outline.map(|[x, y]| [x, y, z])).collect();
    let top = [[6, 7, 9], [7, 8, 9], [6, 9, 11], [9, 10, 11]];
    let bottom = top.map(|[a, b, c]: [u32; 3]| [a - 6, c - 6, b - 6]);
    (points, top.into_iter().chain(bottom).chain(walls(0, 6)).collect())
}

/// Five storeys, as in `testdata/cages`.
fn bars() -> Result<CagePair> {
    let ring = [[-0.6, -0.85], [0.6, -0.85], [0.6, 1.15], [-0.6, 1.15]];
    let floor = |level: u32, turn: f64| {
        let (sine, cosine) = (turn * f64::from(level) / 5.0).sin_cos();
        ring.map(|[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y, 0.4 * f64::from(level) - 0.8])
    };
    let bar = |turn: f64| (0..6).flat_map(|level| floor(level, turn)).collect();
    let ends = [[0, 2, 1], [0, 3, 2], [20, 21, 22], [20, 22, 23]];
    let triangles = ends.into_iter().chain((0..5).flat_map(|level| walls(4 * level, 4))).collect();
    Ok(CagePair::new(bar(0.0), bar(0.25 * TAU), triangles)?)
}

/// Between two rings of vertices, one after the other.
fn walls(first: u32, count: u32) -> Vec<[u32; 3]> {
    let wall = |k: u32| {
        let [a, b] = [k, (k + 1) % count].map(|v| first + v);
        [[a, b, b + count], [a, b + count, a + count]]
    };
    (0..count).flat_map(wall).collect()
}
