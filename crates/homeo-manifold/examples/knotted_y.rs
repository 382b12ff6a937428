//! From a mesh of a ball with three entangled tunnels to two tetrahedra and their hyperbolic metric:
//! `cargo run --release -p homeo-manifold --example knotted_y`

#[path = "../tests/common/lattice.rs"]
mod lattice;

use homeo_core::mesh::TetrahedronComplex;
use homeo_manifold::simplify::{Simplifier, coned, without_inner_vertices};
use homeo_manifold::{Homology, Triangulation, signature};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let (vertices, cells) = lattice::tunnelled(&lattice::knotted_y());
    let start = Instant::now();
    let mesh = Triangulation::from_complex(&TetrahedronComplex::from_indices(vertices, &cells)?)?;
    println!("{} tetrahedra, H1 = {}, {:.2?}", mesh.len(), Homology::new(&mesh), start.elapsed());
    let closed = coned(&mesh)?;
    println!("{} with cones, {:.2?}", closed.len(), start.elapsed());
    let coarse = without_inner_vertices(&closed)?;
    println!("{} without inner vertices, H1 = {}, {:.2?}", coarse.len(), Homology::new(&coarse), start.elapsed());
    let mut simplifier = Simplifier::new(&coarse, 1)?;
    println!("{} by moves, {:.2?}", simplifier.best().len(), start.elapsed());
    for _ in 0..20 {
        simplifier.run(100);
        println!("{} after a search, {:.2?}", simplifier.best().len(), start.elapsed());
    }
    println!("{}", signature(simplifier.best()));
    Ok(())
}
