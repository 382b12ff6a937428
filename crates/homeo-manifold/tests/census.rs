//! The census of small hyperbolic manifolds with geodesic boundary, made anew: counts and volumes against Frigerio, Martelli and
//! Petronio (Experimental Mathematics 13, 2004), and the volumes of Fujii.

use std::collections::BTreeMap;

use homeo_manifold::hyperbolic::{Canonical, Structure, find_canonical};
use homeo_manifold::{AllowedLinks, Skeleton, Triangulation, enumerate, signature};

/// All triangulations that have a structure, with it, and the number of those that are refused with proof.
fn structures(tetrahedra: usize) -> (Vec<(Triangulation, Structure)>, usize) {
    let mut found = Vec::new();
    let mut refused = 0;
    for entry in enumerate(tetrahedra, AllowedLinks::Higher).unwrap() {
        match Structure::find(&entry.triangulation, &Skeleton::new(&entry.triangulation)) {
            Ok(structure) => found.push((entry.triangulation, structure)),
            Err(refusal) => {
                assert!(refusal.is_proved(), "{refusal}");
                refused += 1;
            }
        }
    }
    (found, refused)
}

/// The manifolds of some triangulations by their canonical decompositions, and how many triangulations each has.
fn manifolds(found: &[(Triangulation, Structure)]) -> BTreeMap<String, (Canonical, usize)> {
    let mut manifolds = BTreeMap::new();
    for (triangulation, structure) in found {
        let canonical = find_canonical(triangulation, structure, 1000, || true).unwrap();
        let difference = canonical.structure.volume().middle() - structure.volume().middle();
        assert!(difference.abs() < 1e-9, "{}: {difference:e}", signature(triangulation));
        let name = signature(&canonical.triangulation);
        manifolds.entry(name).or_insert((canonical, 0)).1 += 1;
    }
    manifolds
}

fn distinct(volumes: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut volumes: Vec<f64> = volumes.collect();
    volumes.sort_by(f64::total_cmp);
    volumes.dedup_by(|a, b| (*a - *b).abs() < 1e-8);
    volumes
}

/// The least volume that there is.
const LEAST: f64 = 6.451_990_270_835_033;

#[test]
fn two_tetrahedra_give_eight_manifolds_of_one_volume() {
    let (found, refused) = structures(2);
    assert_eq!((found.len(), refused), (8, 0));
    assert!(found.iter().all(|(_, structure)| (structure.volume().middle() - LEAST).abs() < 1e-9));
    let manifolds = manifolds(&found);
    assert_eq!(manifolds.len(), 8);
    assert!(manifolds.values().all(|(canonical, _)| canonical.tried == 1), "each is its own canonical decomposition");
}

#[test]
fn three_tetrahedra_give_a_hundred_and_fifty_more_of_seventeen_volumes() {
    let (found, refused) = structures(3);
    assert_eq!((found.len(), refused), (166, 74));
    let all = manifolds(&found);
    // Sixteen are triangulations of the eight of two tetrahedra.
    let (eight, _) = structures(2);
    let (old, new): (Vec<_>, Vec<_>) =
        all.iter().partition(|(name, _)| eight.iter().any(|(triangulation, _)| signature(triangulation) == **name));
    assert_eq!(old.iter().map(|(_, (_, count))| count).sum::<usize>(), 16);
    // All others are different manifolds.
    assert_eq!(new.len(), 150);
    let genus_three = new.iter().filter(|(_, (canonical, _))| canonical.structure.lengths().len() == 1);
    assert_eq!(genus_three.count(), 74);
    // All but three are their own canonical decompositions; these have four cells.
    let cells = |count| new.iter().filter(|(_, (canonical, _))| canonical.triangulation.len() == count).count();
    assert_eq!((cells(3), cells(4)), (147, 3));
    let volumes = distinct(new.iter().map(|(_, (canonical, _))| canonical.structure.volume().middle()));
    assert_eq!(volumes.len(), 17);
    assert!((volumes[0] - 7.107_592).abs() < 1e-6 && (volumes[16] - 10.428_601_580).abs() < 1e-9, "{volumes:?}");
}
