//! The census of small hyperbolic manifolds with geodesic boundary, made anew: counts and volumes against Frigerio, Martelli and
//! Petronio (Experimental Mathematics 13, 2004), and the volumes of Fujii.

use homeo_manifold::hyperbolic::Structure;
use homeo_manifold::{AllowedLinks, Skeleton, Triangulation, enumerate};

/// All triangulations that have a structure, with their volumes, and the number of those that are refused with proof.
fn structures(tetrahedra: usize) -> (Vec<(Triangulation, f64)>, usize) {
    let mut found = Vec::new();
    let mut refused = 0;
    for entry in enumerate(tetrahedra, AllowedLinks::Higher).unwrap() {
        match Structure::find(&entry.triangulation, &Skeleton::new(&entry.triangulation)) {
            Ok(structure) => found.push((entry.triangulation, structure.volume().middle())),
            Err(refusal) => {
                assert!(refusal.is_proved(), "{refusal}");
                refused += 1;
            }
        }
    }
    (found, refused)
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
fn two_tetrahedra_give_eight_structures_of_one_volume() {
    let (found, refused) = structures(2);
    assert_eq!((found.len(), refused), (8, 0));
    assert!(found.iter().all(|(_, volume)| (volume - LEAST).abs() < 1e-9));
}

#[test]
fn three_tetrahedra_give_a_hundred_and_fifty_more_of_seventeen_volumes() {
    let (found, refused) = structures(3);
    assert_eq!(refused, 74);
    // Sixteen are triangulations of the eight of two tetrahedra: the same volume from other tetrahedra.
    let (old, new): (Vec<_>, Vec<_>) = found.into_iter().partition(|(_, volume)| (volume - LEAST).abs() < 1e-8);
    assert_eq!((old.len(), new.len()), (16, 150));
    let genus_three = new.iter().filter(|(triangulation, _)| Skeleton::new(triangulation).edges().len() == 1);
    assert_eq!(genus_three.count(), 74);
    let volumes = distinct(new.iter().map(|(_, volume)| *volume));
    assert_eq!(volumes.len(), 17);
    assert!((volumes[0] - 7.107_592).abs() < 1e-6 && (volumes[16] - 10.428_601_580).abs() < 1e-9, "{volumes:?}");
}
