//! From meshes of solids with entangled tunnels to few tetrahedra and their hyperbolic structures:
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example knotted -- [FOLDER]
//! ```
//!
//! In the folder, if one is given, the meshes are left as MEDIT files.
#![allow(clippy::print_stdout)]

#[path = "../tests/common/lattice.rs"]
mod lattice;

use homeo_core::mesh::TetrahedronComplex;
use homeo_manifold::hyperbolic::find_by_retriangulating;
use homeo_manifold::simplify::{Simplifier, coned, without_inner_vertices};
use homeo_manifold::{Homology, Triangulation, signature};
use lattice::Place;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "| tunnels | tetrahedra | coned | collapsed | simplified | H1 | signature | volume | tried | collapse s | all s |"
    );
    println!("|---|---:|---:|---:|---:|---|---|---|---:|---:|---:|");
    print_row("knotted Y", &lattice::knotted_y())?;
    print_row("knotted X", &lattice::knotted_x())
}

fn print_row(name: &str, paths: &[Vec<Place>]) -> Result<(), Box<dyn Error>> {
    let (vertices, cells) = lattice::tunnelled(paths);
    if let Some(folder) = std::env::args().nth(1) {
        let path = std::path::Path::new(&folder).join(format!("{}.mesh", name.replace(' ', "_").to_lowercase()));
        std::fs::write(path, medit(&vertices, &cells))?;
    }
    let start = Instant::now();
    let mesh = Triangulation::from_complex(&TetrahedronComplex::from_indices(vertices.len(), &cells)?)?;
    let closed = coned(&mesh)?;
    let coarse = without_inner_vertices(&closed)?;
    let collapsed = start.elapsed().as_secs_f64();
    let mut simplifier = Simplifier::new(&coarse, 1)?;
    simplifier.run(300);
    let small = simplifier.best();
    let homology = Homology::new(small);
    let (volume, tried) = match find_by_retriangulating(small, 1, 300, || true) {
        Ok(found) => (format!("{:.10}", found.structure.volume().middle()), found.tried),
        Err(refusal) => (refusal.to_string(), 0),
    };
    let counts = format!("{} | {} | {} | {}", mesh.len(), closed.len(), coarse.len(), small.len());
    let all = start.elapsed().as_secs_f64();
    println!(
        "| {name} | {counts} | {homology} | {} | {volume} | {tried} | {collapsed:.2} | {all:.2} |",
        signature(small)
    );
    Ok(())
}

fn medit(vertices: &[Place], cells: &[[u32; 4]]) -> String {
    let mut text = format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", vertices.len());
    text.extend(vertices.iter().map(|[x, y, z]| format!("{x} {y} {z} 0\n")));
    text.push_str(&format!("Tetrahedra\n{}\n", cells.len()));
    text.extend(cells.iter().map(|&[a, b, c, d]| format!("{} {} {} {} 0\n", a + 1, b + 1, c + 1, d + 1)));
    text + "End\n"
}
