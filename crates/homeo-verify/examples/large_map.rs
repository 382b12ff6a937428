//! Times the checker on a large map: a grid of `n^3` cubes, six tetrahedra each, foliated radially over the ball.
//!
//! `cargo run --release -p homeo-verify --example large_map -- 47` (623k tetrahedra; add `refined` to split a third
//! of the cells). Signs of the directions come from which side of each facet the centre's middle lies on.
#![allow(clippy::print_stdout)]

#[path = "../tests/support/mod.rs"]
mod support;

use homeo_verify::verify_bytes;
use std::time::Instant;
use support::{Map, build, random::Random};

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn volume(p: &[[f64; 3]; 4]) -> f64 {
    let from_first = |i: usize| [0, 1, 2].map(|axis| p[i][axis] - p[0][axis]);
    determinant(from_first(1), from_first(2), from_first(3))
}

/// Splits every third cell at an inner vertex.
fn refine(map: &mut Map) {
    let mut r =
        support::Refinement { carrier_vertices: vec![], carrier_weights: vec![], cells: vec![], parents: vec![] };
    for (c, cell) in map.source_cells.iter().enumerate() {
        if c % 3 != 0 {
            r.cells.push(cell.clone());
            r.parents.push(c as u32);
            continue;
        }
        let new = (map.positions.len() + r.carrier_vertices.len()) as u32;
        r.carrier_vertices.push(cell.clone());
        r.carrier_weights.push(vec![1, 1, 2, 3]);
        for v in cell {
            r.cells.push(cell.iter().map(|w| if w == v { new } else { *w }).collect());
            r.parents.push(c as u32);
        }
    }
    map.refinement = Some(r);
}

fn main() {
    let n: u32 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(47);
    let (positions, cells) = build::cube_grid(n);
    let mut map = Map::new("foliation", "ball", positions, cells);
    if std::env::args().any(|argument| argument == "refined") {
        refine(&mut map);
    }
    let places: Vec<[f64; 3]> = build::places(&map).iter().map(|p| [p[0], p[1], p[2]]).collect();
    let corners = |cell: &[u32]| [0, 1, 2, 3].map(|i| places[cell[i] as usize]);
    let mut random = Random(1);
    let centre = map.cells().len() / 2 + (n * n * n / 2 % 2) as usize;
    let (of_centre, parts) = (corners(&map.cells()[centre]), [0; 4].map(|_| 1.0 + 0.1 * random.unit()));
    let middle =
        [0, 1, 2].map(|axis| (0..4).map(|i| parts[i] * of_centre[i][axis]).sum::<f64>() / parts.iter().sum::<f64>());
    for (c, cell) in map.cells().clone().iter().enumerate() {
        let signs = [0, 1, 2, 3].map(|i| {
            let mut moved = corners(cell);
            moved[i] = middle;
            if volume(&moved) < 0.0 { 1i8 } else { -1 }
        });
        let plus = signs.iter().filter(|s| **s > 0).count() as i8;
        let row = signs.map(|s| {
            if c == centre {
                0
            } else if s > 0 {
                4 - plus
            } else {
                -plus
            }
        });
        map.directions.push(row.to_vec());
    }
    map.lengths = vec![1000; map.directions.len()];
    map.manifest["centre"] = serde_json::json!({"cell": centre, "length": 1000});
    let bytes = map.signed_bytes();
    println!("{} cells, {} bytes", map.cells().len(), bytes.len());
    if let Some(path) = std::env::args().find(|argument| argument.ends_with(".homeo")) {
        println!("written: {:?}", std::fs::write(path, &bytes));
    }
    drop(map);
    for _ in 0..3 {
        let start = Instant::now();
        let verdict = verify_bytes(&bytes);
        println!(
            "{:.3} s: {}",
            start.elapsed().as_secs_f64(),
            format!("{verdict:?}").chars().take(160).collect::<String>()
        );
    }
}
