//! Prints the signatures of all closed orientable triangulations of some tetrahedra whose links have genus 2 and above,
//! with the genera; with `torus` after the number, tori are allowed too.
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example enumerate -- 3
//! ```
#![allow(clippy::print_stdout)] // a program that prints what it finds

use homeo_manifold::{AllowedLinks, Homology, enumerate};
use std::collections::BTreeMap;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let tetrahedra = arguments.next().ok_or("give a number of tetrahedra")?.parse()?;
    let links = match arguments.next().as_deref() {
        None => AllowedLinks::Higher,
        Some("torus") => AllowedLinks::TorusOrHigher,
        Some(other) => return Err(format!("{other:?} is neither nothing nor `torus`").into()),
    };
    let found = enumerate(tetrahedra, links)?;
    let mut counts: BTreeMap<_, (usize, u128)> = BTreeMap::new();
    for triangulation in &found {
        println!(
            "{} {:?} {}",
            triangulation.signature,
            triangulation.genera,
            Homology::new(&triangulation.triangulation)
        );
        let (kinds, labelled) = counts.entry(&triangulation.genera).or_default();
        *kinds += 1;
        *labelled += triangulation.labelled_count();
    }
    for (genera, (kinds, labelled)) in counts {
        println!("# links of genera {genera:?}: {kinds} triangulations, {labelled} labelled gluings");
    }
    Ok(())
}
