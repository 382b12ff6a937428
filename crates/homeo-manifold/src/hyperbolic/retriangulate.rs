//! Other triangulations of the same manifold, where the first has no structure.

use super::proof::Structure;
use super::refusal::NoMetric;
use crate::simplify::Simplifier;
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;

/// A triangulation with its structure.
#[derive(Debug, Clone)]
pub struct Retriangulated {
    /// The triangulation, of the manifold that was given.
    pub triangulation: Triangulation,
    /// Its structure, proved.
    pub structure: Structure,
    /// How many triangulations were tried.
    pub tried: usize,
}

/// Rounds of simplification before the first try.
const FIRST_ROUNDS: usize = 60;

/// Finds and proves the structure of a manifold: of the given triangulation if it has few tetrahedra, or of others of the same
/// manifold.
///
/// By Mostow's theorem the structure is the same for all of them, but not every triangulation has one: a tetrahedron may be
/// flat or turned over in it. So simplified triangulations are tried, and others beside them by random moves that depend on
/// `seed` alone, until `tries` are made or `go_on` says no.
///
/// # Errors
/// Why the manifold has no structure, if a boundary component or its orientation says so; otherwise why the smallest triangulation has
/// none, which proves nothing about the manifold.
///
/// # Example
/// ```
/// use homeo_manifold::{from_signature, hyperbolic::find_by_retriangulating};
/// // The tripus: its first triangulation has the structure.
/// let found = find_by_retriangulating(&from_signature("cPcbbbihq")?, 1, 10, || true)?;
/// assert!((found.structure.volume().middle() - 6.451_990_270_8).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_by_retriangulating(
    triangulation: &Triangulation,
    seed: u64,
    tries: usize,
    mut go_on: impl FnMut() -> bool,
) -> Result<Retriangulated, NoMetric> {
    let first = Structure::find(triangulation, &Skeleton::new(triangulation));
    let mut refusal = match first {
        Ok(structure) => return Ok(Retriangulated { triangulation: triangulation.clone(), structure, tried: 1 }),
        Err(refusal) if refusal.is_of_the_manifold() => return Err(refusal),
        Err(refusal) => refusal,
    };
    let Ok(mut simplifier) = Simplifier::new(triangulation, seed) else { return Err(refusal) };
    simplifier.run(FIRST_ROUNDS);
    for tried in 1..tries {
        if !go_on() {
            break;
        }
        // The smallest first; then ever farther from it.
        let other = if tried == 1 { simplifier.best().clone() } else { simplifier.shaken(1 + tried % 8) };
        match Structure::find(&other, &Skeleton::new(&other)) {
            Ok(structure) => return Ok(Retriangulated { triangulation: other, structure, tried: tried + 1 }),
            Err(found) if found.is_of_the_manifold() => return Err(found),
            Err(found) if tried == 1 => refusal = found,
            Err(_) => {}
        }
    }
    Err(refusal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplify::without_inner_vertices;
    use crate::{from_signature, signature, subdivision::subdivided};

    #[test]
    fn volumes_do_not_depend_on_the_triangulation() {
        let mut names = std::collections::BTreeSet::new();
        for (name, volume) in [("cPcbbbihq", 6.451_990_270_835_033), ("dLQbcccdefo", 7.758_268_436_6)] {
            for seed in 0..25 {
                let fine = subdivided(&from_signature(name).unwrap());
                let other =
                    without_inner_vertices(&Simplifier::new(&fine, seed).unwrap().shaken(seed as usize)).unwrap();
                names.insert(signature(&other));
                let found = find_by_retriangulating(&other, seed, 100, || true).unwrap();
                let difference = found.structure.volume().middle() - volume;
                assert!(difference.abs() < 1e-8, "{name}: {difference:e}");
            }
        }
        assert!(names.len() > 20, "nearly always the same triangulation");
    }

    #[test]
    fn a_manifold_with_a_torus_as_boundary_is_refused_at_once() {
        // Of the census of three tetrahedra, the only one with a cusp.
        let cusped = from_signature("dLQacccjjkg").unwrap();
        let refusal = find_by_retriangulating(&cusped, 1, 1000, || panic!("tried on")).unwrap_err();
        assert!(matches!(refusal, NoMetric::VertexLink { .. }), "{refusal}");
    }
}
