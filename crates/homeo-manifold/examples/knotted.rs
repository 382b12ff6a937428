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
use homeo_manifold::hyperbolic::{find_by_retriangulating, find_canonical};
use homeo_manifold::simplify::{Simplifier, coned, without_inner_vertices};
use homeo_manifold::{Homology, Triangulation, signature};
use lattice::Place;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "| tunnels | tetrahedra | coned | collapsed | simplified | H1 | volume | tried | canonical | collapse s | all s |"
    );
    println!("|---|---:|---:|---:|---:|---|---|---:|---|---:|---:|");
    print_row("knotted Y", &lattice::knotted_y())?;
    print_row("knotted X", &lattice::knotted_x())?;
    for (arms, fingers) in ENTANGLED {
        let word: Vec<String> = fingers.iter().map(|(from, to)| format!("{from}{to}")).collect();
        print_row(&format!("{arms} arms {}", word.join(" ")), &lattice::entangled(*arms, fingers))?;
    }
    Ok(())
}

/// Arms in a row, and which of them have a finger round which.
const ENTANGLED: &[(i32, &[(i32, i32)])] = &[
    (3, &[(0, 1), (1, 2), (2, 0)]),
    (3, &[(0, 2), (2, 1), (1, 0)]),
    (3, &[(1, 2), (0, 1), (2, 0)]),
    (3, &[(0, 1), (1, 2), (2, 0), (0, 1)]),
    (3, &[(0, 1), (1, 2), (2, 1), (1, 0)]),
    (3, &[(0, 1), (1, 2), (2, 0), (0, 2), (2, 1), (1, 0)]),
    (4, &[(0, 1), (1, 2), (2, 3), (3, 0)]),
    (4, &[(0, 2), (1, 3), (2, 0), (3, 1)]),
    (5, &[(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)]),
];

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
    let (volume, tried, canonical) = match find_by_retriangulating(small, 1, 300, || true) {
        Ok(found) => {
            let canonical = find_canonical(&found.triangulation, &found.structure, 1000, || true);
            let name = canonical.map_or_else(
                |reason| reason.to_string(),
                |canonical| format!("`{}`", signature(&canonical.triangulation)),
            );
            (format!("{:.10}", found.structure.volume().middle()), found.tried, name)
        }
        Err(refusal) => (refusal.to_string(), 0, String::new()),
    };
    let counts = format!("{} | {} | {} | {}", mesh.len(), closed.len(), coarse.len(), small.len());
    let all = start.elapsed().as_secs_f64();
    println!("| {name} | {counts} | {homology} | {volume} | {tried} | {canonical} | {collapsed:.2} | {all:.2} |");
    Ok(())
}

fn medit(vertices: &[Place], cells: &[[u32; 4]]) -> String {
    let mut text = format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", vertices.len());
    text.extend(vertices.iter().map(|[x, y, z]| format!("{x} {y} {z} 0\n")));
    text.push_str(&format!("Tetrahedra\n{}\n", cells.len()));
    text.extend(cells.iter().map(|&[a, b, c, d]| format!("{} {} {} {} 0\n", a + 1, b + 1, c + 1, d + 1)));
    text + "End\n"
}
