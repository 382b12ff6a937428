//! Builds a shell and sends the source's vertices to the middle surface and back, exactly.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]
use homeo::construct::shell::{ShellParams, build};
use homeo::input::SourceMesh;
use homeo::progress::Silent;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::Rational;
use std::time::Instant;

fn main() {
    let path = std::env::args().nth(1).expect("a mesh");
    let rounds = std::env::args().nth(2).map_or(30, |n| n.parse().unwrap());
    let thickness = std::env::args().nth(3).map_or(0.1, |n| n.parse().unwrap());
    let file = homeo_core::io::read_mesh(path.as_ref()).expect("readable");
    let cells: Vec<[u32; 3]> = file.polygons.iter().map(|p| p.try_into().expect("triangles")).collect();
    let complex = SimplicialComplex::from_indices(file.positions.len(), &cells).unwrap();
    let source = SourceMesh::new(file.positions, complex);
    let clock = Instant::now();
    let (shell, info) = match build(&source, &ShellParams { rounds, thickness, ..ShellParams::default() }, &Silent) {
        Ok(built) => built,
        Err(error) => return println!("{path}: {error}"),
    };
    println!("{path}: {} triangles {:.3} s {info:?}", cells.len(), clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let mut failures = 0;
    let step = (source.positions().len() / 500).max(1);
    for p in source.positions().iter().step_by(step) {
        let exact = p.map(|x| Rational::from_f64(x).unwrap());
        let back = shell.to_middle_exact(&exact).and_then(|m| shell.to_source_exact(&m));
        match back {
            Ok(q) if q.point == exact => {}
            other => {
                failures += 1;
                if failures < 4 {
                    println!("{p:?} {other:?} {:?}", shell.to_middle_exact(&exact));
                }
            }
        }
    }
    println!("  {failures} failures {:.3} s", clock.elapsed().as_secs_f64());
}
