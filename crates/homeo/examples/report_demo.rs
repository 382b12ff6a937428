//! Writes a report for a made-up map onto each target: `cargo run --example report_demo DIRECTORY`.
//!
//! The maps are smooth formulas on structured meshes. They show what the page can do; nothing is certified.

use homeo::export::{CellList, CellMesh, Leaf, ReportData, TargetShape, VerdictWords, write_report};
use std::f64::consts::PI;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

type Point = [f64; 3];
/// Takes a point of the target to the point of the source that is mapped to it.
type Inverse = fn(Point) -> Point;

fn main() -> io::Result<()> {
    let directory = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let steps = std::env::args().nth(2).and_then(|text| text.parse().ok()).unwrap_or(20);
    let demos: [(TargetShape, Inverse); 4] = [
        (TargetShape::Square, |[x, y, _]| [x - 0.5, y - 0.5, 0.18 * (7.0 * x).sin() * (5.0 * y).cos() + 0.3 * x * x]),
        (TargetShape::Disk, |[x, y, _]| {
            let (r, a) = (x.hypot(y), y.atan2(x));
            let reach = r * (1.0 + 0.25 * r * (5.0 * a).cos());
            [reach * (a + 0.8 * r).cos(), reach * (a + 0.8 * r).sin(), 0.5 * (-4.0 * r * r).exp()]
        }),
        (TargetShape::Cube, |[x, y, z]| {
            let (a, width) = (1.1 * z, 1.0 - 0.45 * (PI * z).sin());
            let (u, v) = ((x - 0.5) * width, (y - 0.5) * width * (1.0 + 0.3 * x));
            [u * a.cos() - v * a.sin() + 0.4 * z * z, u * a.sin() + v * a.cos(), 2.0 * z]
        }),
        (TargetShape::Ball, |[x, y, z]| {
            let reach = 1.0 + 0.35 * (3.0 * x).sin() * (3.0 * y).cos() * (2.0 * z).cos();
            [1.3 * x * reach, y * reach, z * reach + 0.5 * x * x]
        }),
    ];
    for (target, inverse) in demos {
        let path = directory.join(format!("report_demo_{}.html", target.name()));
        let mut out = BufWriter::new(File::create(path)?);
        write_report(&demo(target, inverse, steps), &mut out)?;
        out.flush()?;
    }
    Ok(())
}

fn demo(target: TargetShape, inverse: Inverse, steps: usize) -> ReportData {
    let cells = structured_mesh(target, inverse, steps);
    let distortion = distortions(&cells);
    let holds = target != TargetShape::Disk;
    let headline = if holds {
        format!(
            "The map from the mesh onto the {} is one-to-one, onto and continuous, with its inverse.",
            target.name()
        )
    } else {
        "Two triangles have directions that disagree across their common edge (rule 2).".into()
    };
    ReportData {
        title: format!("Example page, made-up data: a shape onto the {}", target.name()),
        subtitle: "Simplicial foliation, homeo 0.1.0. Made-up data, nothing is certified.".into(),
        target,
        verdict: VerdictWords {
            holds,
            headline,
            sentences: demo_sentences(holds),
            checked: vec![
                ("cells with a direction".into(), cells.cells.len() as u64),
                ("facets crossed one way".into(), 2 * cells.cells.len() as u64),
                ("vertices with one way in and one way out".into(), cells.positions.len() as u64),
            ],
            limits: vec![
                "That cells of the source do not overlap in space: this is a property of the input mesh.".into(),
                "That numbers returned by evaluation in floating point are exact.".into(),
            ],
        },
        facts: vec![
            ("vertices".into(), cells.positions.len().to_string()),
            ("cells".into(), cells.cells.len().to_string()),
            ("refinement".into(), "none".into()),
            ("threads".into(), "2".into()),
        ],
        stage_seconds: [
            ("read", 0.04),
            ("check", 0.11),
            ("order", 0.62),
            ("directions", 0.35),
            ("certificate", 0.2),
            ("total", 1.32),
        ]
        .map(|(stage, seconds)| (stage.into(), seconds))
        .to_vec(),
        leaves: demo_leaves(target, inverse),
        cells,
        distortion,
        shell: None,
    }
}

fn demo_sentences(holds: bool) -> Vec<String> {
    let sentences: &[&str] = if holds {
        &[
            "Every rule of the certificate was checked in exact arithmetic on the stored numbers.",
            "Leaves start on the source region, end on the sink region, and no two of them meet.",
        ]
    } else {
        &["Rule 2 does not hold at triangles 17 and 18. Nothing is known about the map."]
    };
    sentences.iter().map(|&sentence| sentence.into()).collect()
}

/// From the unit cube or square of parameters to the target.
fn to_target(target: TargetShape, parameter: Point) -> Point {
    if matches!(target, TargetShape::Square | TargetShape::Cube) {
        return parameter;
    }
    let centred: Point = std::array::from_fn(|i| if i < target.dimension() { 2.0 * parameter[i] - 1.0 } else { 0.0 });
    let length = centred.iter().map(|c| c * c).sum::<f64>().sqrt();
    let largest = centred.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    if length > 0.0 { centred.map(|c| c * largest / length) } else { centred }
}

/// A grid whose squares are split into two triangles, or whose cubes are split into six tetrahedra.
fn structured_mesh(target: TargetShape, inverse: Inverse, steps: usize) -> CellMesh {
    let flat = target.dimension() == 2;
    let (steps, layers) = if flat { (3 * steps, 0) } else { (steps, steps) };
    let at = |i: usize, j: usize, k: usize| (i + (steps + 1) * (j + (steps + 1) * k)) as u32;
    let mut images = Vec::new();
    for k in 0..=layers {
        for j in 0..=steps {
            for i in 0..=steps {
                let share = |n: usize| n as f64 / steps as f64;
                images.push(to_target(target, [share(i), share(j), share(k)]));
            }
        }
    }
    let positions = images.iter().map(|&image| inverse(image)).collect();
    let (mut triangles, mut tetrahedra) = (Vec::new(), Vec::new());
    for (i, j) in (0..steps * steps).map(|n| (n % steps, n / steps)) {
        if flat {
            let [a, b, c, d] = [at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        for k in 0..layers {
            for [p, q, r] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
                let mut corner = [i, j, k];
                let mut path = vec![at(i, j, k)];
                for axis in [p, q, r] {
                    corner[axis] += 1;
                    path.push(at(corner[0], corner[1], corner[2]));
                }
                let even = (q + 3 - p) % 3 == 1;
                tetrahedra.push(if even {
                    [path[0], path[1], path[2], path[3]]
                } else {
                    [path[0], path[2], path[1], path[3]]
                });
            }
        }
    }
    let cells = if flat { CellList::Triangles(triangles) } else { CellList::Tetrahedra(tetrahedra) };
    CellMesh { positions, images, cells }
}

fn demo_leaves(target: TargetShape, inverse: Inverse) -> Vec<Leaf> {
    let leaf = |points: Vec<Point>| Leaf { source: points.iter().map(|&p| inverse(p)).collect(), target: points };
    let shares = || (0..=60).map(|n| f64::from(n) / 60.0);
    let mut leaves = Vec::new();
    for (i, j) in (0..49).map(|n| (f64::from(n % 7) / 7.0 + 1.0 / 14.0, f64::from(n / 7) / 7.0 + 1.0 / 14.0)) {
        let points: Vec<Point> = match target {
            TargetShape::Square => shares().map(|t| [i, t, 0.0]).collect(),
            TargetShape::Cube => shares().map(|t| [i, j, t]).collect(),
            TargetShape::Disk => {
                let angle = 2.0 * PI * (i + j / 7.0);
                shares().map(|t| [(0.1 + 0.9 * t) * angle.cos(), (0.1 + 0.9 * t) * angle.sin(), 0.0]).collect()
            }
            TargetShape::Middle | TargetShape::Section => Vec::new(), // shells have no leaves of this kind
            TargetShape::Ball => {
                let (longitude, height) = (2.0 * PI * (i + j / 7.0), 2.0 * j - 1.0);
                let across = (1.0 - height * height).sqrt();
                let end = [across * longitude.cos(), across * longitude.sin(), height];
                shares().map(|t| end.map(|c| c * (0.1 + 0.9 * t))).collect()
            }
        };
        leaves.push(leaf(points));
    }
    leaves
}

/// Ratio of the largest to the smallest singular value of the linear map on each cell.
fn distortions(mesh: &CellMesh) -> Vec<f64> {
    let edge = |points: &[Point], from: u32, to: u32| -> Point {
        std::array::from_fn(|i| points[to as usize][i] - points[from as usize][i])
    };
    let ratio = |corners: &[u32]| {
        let frame = |points: &[Point]| {
            let (a, b) = (edge(points, corners[0], corners[1]), edge(points, corners[0], corners[2]));
            let third = corners.get(3).map_or_else(|| unit(cross(a, b)), |&last| edge(points, corners[0], last));
            [a, b, third]
        };
        let (source, image) = (frame(&mesh.positions), frame(&mesh.images));
        let volume = dot(source[0], cross(source[1], source[2]));
        let dual = [cross(source[1], source[2]), cross(source[2], source[0]), cross(source[0], source[1])];
        let jacobian: [Point; 3] = std::array::from_fn(|row| {
            std::array::from_fn(|column| (0..3).map(|e| image[e][row] * dual[e][column] / volume).sum())
        });
        let gram: [Point; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|row| jacobian[row][i] * jacobian[row][j]).sum())
        });
        let mut squares = eigenvalues(gram);
        if corners.len() == 3 {
            // The normal was mapped to the normal, with factor 1: leave that value out.
            let nearest = (0..3).min_by(|&i, &j| (squares[i] - 1.0).abs().total_cmp(&(squares[j] - 1.0).abs()));
            squares.swap(2, nearest.unwrap_or(2));
        }
        let used = &squares[..corners.len() - 1];
        let (low, high) = used.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &s| (l.min(s), h.max(s)));
        if low > 0.0 { (high / low).sqrt() } else { f64::INFINITY }
    };
    match &mesh.cells {
        CellList::Triangles(cells) => cells.iter().map(|cell| ratio(cell)).collect(),
        CellList::Tetrahedra(cells) => cells.iter().map(|cell| ratio(cell)).collect(),
    }
}

/// Eigenvalues of a symmetric matrix by the trigonometric formula.
fn eigenvalues(m: [Point; 3]) -> Point {
    let mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    let off = m[0][1].powi(2) + m[0][2].powi(2) + m[1][2].powi(2);
    let spread = (((0..3).map(|i| (m[i][i] - mean).powi(2)).sum::<f64>() + 2.0 * off) / 6.0).sqrt();
    if spread == 0.0 {
        return [mean; 3];
    }
    let b: [Point; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| (m[i][j] - if i == j { mean } else { 0.0 }) / spread));
    let angle = (dot(b[0], cross(b[1], b[2])) / 2.0).clamp(-1.0, 1.0).acos() / 3.0;
    [0.0, 2.0, 4.0].map(|third| mean + 2.0 * spread * (angle + third * PI / 3.0).cos())
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    a.map(|coordinate| coordinate / length)
}
