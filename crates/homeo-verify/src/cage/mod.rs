//! Rules Q1 to Q3: a composite mean value map is a homeomorphism between the insides of cages.
//!
//! *Theorem* (`docs/theory/cages.md`). Let two closed triangle meshes of one connectivity each be placed in space without meeting
//! itself, and let the Jacobian determinant of the mean value map be positive at every point inside the first. Then the map is a
//! homeomorphism of the closed insides, linear on every triangle: it takes boundary to boundary one-to-one, so its degree
//! over a point is 1 inside the second mesh and 0 outside; every preimage counts +1. So is a composition of such maps.

mod arctangent;
mod chart;
mod cover;
mod determinant;
mod inside;
mod jet;
mod outline;
#[cfg(test)]
mod tests;

use crate::complex::Complex;
use crate::links::check_manifold;
use crate::map_file::MapFile;
use crate::moved::{Placement, Skin, check_signs};
use crate::number::Point;
use crate::parallel::in_parallel;
use crate::verdict::{Checked, Obstacle, Stop, check, refuted, refuted_at};
use chart::{Cell, Chart};
use cover::{Cover, Outcome};
use outline::Outline;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// So many enclosures are computed at most in one of the cells that are begun with.
const MOST: u64 = 40_000;
/// Cells that are bounded before it is seen whether one fails: a fixed number, so that the first one found does not depend on
/// the number of threads.
const CHUNK: usize = 128;

/// Applies the rules and counts what was checked; `later` are the vertices of the cages after the source.
pub(crate) fn check_cages(map: &MapFile, later: &[Vec<Point>]) -> Checked<Vec<(&'static str, u64)>> {
    let stages: Vec<&[Point]> = std::iter::once(&map.positions[..]).chain(later.iter().map(Vec::as_slice)).collect();
    for (number, points) in stages.iter().enumerate() {
        for (v, point) in (0..).zip(*points) {
            let message = format!("a vertex of cage {number} is not finite");
            check(point.iter().all(|x| x.is_finite()), "Q1", &message, &[], &[v])?;
        }
    }
    let complex = Complex::new(3, map.cells.clone(), map.positions.len(), ["S2", "Q1"])?;
    check_surface(&complex)?;
    let skin = Skin::of_cage(&complex);
    for (number, points) in stages.iter().enumerate() {
        let placement = Placement { points, when: &format!("in cage {number}"), rules: ["Q2", "Q2"] };
        placement.drawn(check_signs(&complex, &placement).and_then(|_| skin.check(&placement)))?;
    }
    let triangles: Vec<[u32; 3]> = complex.cells().map(|cell| [cell[0], cell[1], cell[2]]).collect();
    let steps: Vec<Outline> = stages.windows(2).map(|pair| Outline::new(pair[0], pair[1], &triangles)).collect();
    let covers: Vec<Cover> = steps.iter().map(Cover::new).collect();
    // What folds a lot shows at once; else all steps before it would be bounded first.
    for (number, cover) in covers.iter().enumerate() {
        cover.sampled_fold().map_or(Ok(()), |at| fold(number, at))?;
    }
    let mut count = 0;
    for (number, cover) in covers.iter().enumerate() {
        count += check_step(number, cover)?;
    }
    Ok(vec![
        ("source vertices, finite in every cage (rule Q1)", map.positions.len() as u64),
        ("source triangles, a closed surface (rules S2, Q1)", complex.count() as u64),
        (
            "triangles that meet in common vertices and edges only, in all cages (rule Q2)",
            (stages.len() * complex.count()) as u64,
        ),
        ("steps whose Jacobian determinant is positive everywhere inside (rule Q3)", later.len() as u64),
        ("cells that it is bounded in (rule Q3)", count),
    ])
}

/// Q1: a closed surface in one piece, oriented consistently.
fn check_surface(complex: &Complex) -> Checked {
    let found = check_manifold(complex, "the cage", "Q1")?;
    check(found.components == 1, "Q1", &format!("the cage has {} pieces", found.components), &[], &[])?;
    if let Some(slot) = complex.boundary_slots().next() {
        return Err(refuted("Q1", "an edge has one triangle only".to_owned(), &[slot / 3], &complex.facet(slot)[..2]));
    }
    for (a, b) in complex.inner_facets() {
        let are_opposite = complex.induces_sorted_order(a) != complex.induces_sorted_order(b);
        check(are_opposite, "Q1", "two triangles use an edge alike", &[a / 3, b / 3], &complex.facet(a)[..2])?;
    }
    Ok(())
}

fn fold(step: usize, at: Point) -> Checked {
    let message = format!("the mean value map of step {step} folds round the point {at:?}");
    Err(refuted_at("Q3", message, at))
}

/// Q3: the determinant of the map of a step is positive inside. Counts the cells.
fn check_step(number: usize, cover: &Cover) -> Checked<u64> {
    let cells: Vec<(Chart, Cell)> = cover.cells();
    let (mut count, failed) = (0, AtomicUsize::new(usize::MAX));
    // The first cell that fails is the answer: none after one that has failed matters.
    let bound_unless_failed = |&number: &usize| {
        if number > failed.load(Relaxed) {
            return None;
        }
        let outcome = cover.bound(cells[number].0, cells[number].1, MOST);
        if !matches!(outcome, Outcome::Positive(_)) {
            failed.fetch_min(number, Relaxed);
        }
        Some(outcome)
    };
    let numbers: Vec<usize> = (0..cells.len()).collect();
    for chunk in numbers.chunks(CHUNK) {
        for outcome in in_parallel(chunk, bound_unless_failed).into_iter().flatten() {
            match outcome {
                Outcome::Positive(more) => count += more,
                Outcome::Negative(at) => return fold(number, at).map(|()| count),
                Outcome::Undecided(at) => {
                    return Err(Stop::Undecided(Obstacle {
                        message: format!(
                            "rule Q3: the sign of the Jacobian determinant of the mean value map of step {number} near {at:?} is not \
                             known after {MOST} cells"
                        ),
                        remedy: "more cages between source and target".to_owned(),
                    }));
                }
            }
        }
    }
    Ok(count)
}
