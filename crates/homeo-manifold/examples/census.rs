//! The hyperbolic manifolds with geodesic boundary that are glued from a number of tetrahedra, told apart by their canonical
//! decompositions:
//!
//! ```sh
//! cargo run --release -p homeo-manifold --example census -- 4
//! ```
//!
//! Where cells of the canonical decomposition are larger than tetrahedra nothing is decided: such triangulations that one move
//! leads to the same from are of one manifold, and those whose volume, boundary, homology or homology of coverings differs are of different
//! ones, so that their number is bounded from both sides.
#![allow(clippy::print_stdout)] // a program that prints what it finds

use homeo_manifold::hyperbolic::{Canonical, NotCanonical, Structure, find_canonical};
use homeo_manifold::simplify::flips;
use homeo_manifold::{AllowedLinks, Enumerated, Homology, Skeleton, Triangulation, covers, enumerate, signature};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;

/// Triangulations that are looked at for one canonical decomposition.
const TRIES: usize = 2000;

fn main() -> Result<(), Box<dyn Error>> {
    let tetrahedra = std::env::args().nth(1).ok_or("give a number of tetrahedra")?.parse()?;
    let entries = enumerate(tetrahedra, AllowedLinks::Higher)?;
    let count = entries.len();
    let mut refused = BTreeMap::<bool, usize>::new();
    let (mut canonical, mut open, mut not_found) = (BTreeMap::new(), Vec::new(), Vec::new());
    for entry in entries {
        let structure = match Structure::find(&entry.triangulation, &Skeleton::new(&entry.triangulation)) {
            Ok(structure) => structure,
            Err(refusal) => {
                *refused.entry(refusal.is_proved()).or_default() += 1;
                continue;
            }
        };
        match find_canonical(&entry.triangulation, &structure, TRIES, || true) {
            Ok(found) => {
                canonical.insert(signature(&found.triangulation), (entry.genera, found));
            }
            Err(NotCanonical::Undecided { .. }) => open.push((entry, structure)),
            Err(NotCanonical::NotFound { .. }) => not_found.push(entry.signature),
        }
    }
    println!("{count} triangulations; without a structure, by whether it is proved: {refused:?}");
    print_canonical(&canonical);
    print_open(&open)?;
    println!("{} not found {not_found:?}", not_found.len());
    let of_open = open.iter().map(|(_, structure)| structure.volume().middle());
    let volumes: BTreeSet<String> = canonical
        .values()
        .map(|(_, found)| found.structure.volume().middle())
        .chain(of_open)
        .map(|volume| format!("{volume:.8}"))
        .collect();
    println!("{} volumes", volumes.len());
    Ok(())
}

/// How many manifolds have canonical decompositions of how many tetrahedra.
fn print_canonical(canonical: &BTreeMap<String, (Vec<usize>, Canonical)>) {
    let mut counts = BTreeMap::<_, usize>::new();
    for (genera, found) in canonical.values() {
        *counts.entry((found.triangulation.len(), genera)).or_default() += 1;
    }
    for ((cells, genera), count) in counts {
        println!("{count} manifolds of {cells} canonical tetrahedra, boundary {genera:?}");
    }
}

/// How many manifolds the triangulations belong to whose canonical cells are larger.
fn print_open(open: &[(Enumerated, Structure)]) -> Result<(), Box<dyn Error>> {
    let mut classes: Vec<usize> = (0..open.len()).collect();
    let mut at = BTreeMap::new();
    for (number, (entry, _)) in open.iter().enumerate() {
        let faces: Vec<_> = entry.triangulation.faces().collect();
        for near in [vec![entry.triangulation.clone()], flips(&entry.triangulation, &faces)?].concat() {
            let other = *at.entry(signature(&near)).or_insert(number);
            let (from, to) = (classes[number].max(classes[other]), classes[number].min(classes[other]));
            classes.iter_mut().filter(|class| **class == from).for_each(|class| *class = to);
        }
    }
    let firsts: BTreeSet<usize> = classes.into_iter().collect();
    let (mut counts, mut kinds) = (BTreeMap::<_, usize>::new(), BTreeSet::new());
    for (entry, structure) in firsts.iter().map(|&first| &open[first]) {
        *counts.entry(&entry.genera).or_default() += 1;
        let volume = format!("{:.8}", structure.volume().middle());
        kinds.insert((volume, &entry.genera, homologies(&entry.triangulation)?));
    }
    let (most, least) = (firsts.len(), kinds.len());
    println!(
        "{} triangulations undecided: of at most {most} manifolds, boundaries {counts:?}, at least {least}",
        open.len()
    );
    Ok(())
}

/// The homology of a manifold and of its coverings with at most four sheets.
fn homologies(triangulation: &Triangulation) -> Result<Vec<Vec<String>>, Box<dyn Error>> {
    let of_covers = |sheets| {
        let mut groups: Vec<String> =
            covers(triangulation, sheets)?.iter().map(|cover| Homology::new(cover).to_string()).collect();
        groups.sort();
        Ok(groups)
    };
    (1..=4).map(of_covers).collect()
}
