//! Whether a mesh is still sound after its vertices have moved, exactly.

use homeo_core::mesh::{CellId, TetrahedronComplex, TriangleComplex};
use homeo_core::predicate::Sign;
use homeo_core::predicate::orient3d;
use homeo_core::topology::{Answer, Intersections, Options, Violation, analyse_tetrahedra, analyse_triangles};
use rayon::prelude::*;

type Point3 = [f64; 3];

/// What moves.
#[derive(Clone, Copy, Debug)]
pub enum Moved<'a> {
    /// Points that make nothing together.
    Points,
    /// A surface.
    Surface(&'a TriangleComplex),
    /// A tetrahedral mesh.
    Volume(&'a TetrahedronComplex),
}

/// What is decided of a mesh that has moved, on its stored coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// A volume: all cells have the sign that they had, and the boundary does not meet itself; the piecewise linear map
    /// is a homeomorphism onto the moved mesh. A surface: no triangle lost its area, no two triangles share other points
    /// than those of common vertices and edges, no vertices fell together.
    Embedded,
    /// Cells that are turned over, or have lost their volume or area; ascending, all of them.
    Folded {
        /// The cells.
        cells: Vec<CellId>,
    },
    /// Triangles of the surface, or of the boundary of the volume, that meet, by their vertices.
    Meets {
        /// The first pairs.
        pairs: Vec<[[u32; 3]; 2]>,
        /// How many there are in all (the search ends after a million).
        count: usize,
    },
    /// Two vertices that were apart lie on the same point.
    Merged {
        /// The vertices.
        vertices: [u32; 2],
    },
    /// Points make nothing that could be folded.
    NothingToJudge,
    /// Out of reach of the theorem.
    Undecided {
        /// Why, and what to do.
        reason: String,
    },
}

/// Judges a mesh whose vertices have moved from `before` to `after` (#V by 3 each).
///
/// `before` is taken for sound: judge it against itself if it is not known to be, `judge(mesh, p, p)`.
///
/// # Guarantee
/// [`Verdict::Embedded`] is proved (`docs/theory/cages.md`), all others but [`Verdict::Undecided`] are witnesses of the
/// contrary. Signs are exact.
///
/// # Complexity
/// Linear in the number of cells, and `O(n log n)` in that of (boundary) triangles.
///
/// ```
/// use homeo::cage::{Moved, Verdict, judge};
/// use homeo_core::mesh::{CellId, TetrahedronComplex};
/// let mesh = TetrahedronComplex::from_indices(5, &[[0, 1, 2, 3], [1, 0, 2, 4]])?;
/// let before = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
/// let mut after = before;
/// after[4] = [0.0, 0.0, 0.5];
/// assert_eq!(judge(Moved::Volume(&mesh), &before, &before), Verdict::Embedded);
/// assert_eq!(judge(Moved::Volume(&mesh), &before, &after), Verdict::Folded { cells: vec![CellId::new(1)] });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge(mesh: Moved<'_>, before: &[Point3], after: &[Point3]) -> Verdict {
    match mesh {
        Moved::Points => Verdict::NothingToJudge,
        Moved::Surface(complex) => judge_surface(complex, before, after),
        Moved::Volume(complex) => judge_volume(complex, before, after),
    }
}

fn judge_surface(complex: &TriangleComplex, before: &[Point3], after: &[Point3]) -> Verdict {
    let report = analyse_triangles(after, complex, Options { intersections: Intersections::Find });
    if let Some(verdict) = out_of_range(&report.violations) {
        return verdict;
    }
    let flat = |cell: &CellId| {
        let [a, b, c] = complex.cell(*cell).map(|v| after[v.index()]);
        homeo_core::predicate::is_degenerate_triangle(a, b, c)
    };
    let cells: Vec<CellId> = complex.cell_ids().filter(flat).collect();
    if !cells.is_empty() {
        return Verdict::Folded { cells };
    }
    if let Some(vertices) = merged(before, after) {
        return Verdict::Merged { vertices };
    }
    let Some(found) = report.violations.iter().find(|v| v.code == "self-intersection") else {
        return Verdict::Embedded;
    };
    let triangle = |cell: u32| complex.cell(CellId::from(cell)).map(|v| v.raw());
    let pairs = found.elements.chunks_exact(2).map(|pair| [triangle(pair[0]), triangle(pair[1])]).collect();
    Verdict::Meets { pairs, count: found.count }
}

fn judge_volume(complex: &TetrahedronComplex, before: &[Point3], after: &[Point3]) -> Verdict {
    let report = analyse_tetrahedra(after, complex, Options::default());
    if let Some(verdict) = out_of_range(&report.violations) {
        return verdict;
    }
    let is_folded = |cell: &CellId| {
        let sign = |points: &[Point3]| {
            let [a, b, c, d] = complex.cell(*cell).map(|v| points[v.index()]);
            orient3d(a, b, c, d)
        };
        let now = sign(after);
        now == Sign::Zero || now != sign(before)
    };
    let all: Vec<CellId> = complex.cell_ids().collect();
    let cells: Vec<CellId> = all.into_par_iter().filter(is_folded).collect();
    if !cells.is_empty() {
        return Verdict::Folded { cells };
    }
    if report.embedded.answer == Answer::Yes {
        return Verdict::Embedded;
    }
    if let Some(found) = report.violations.iter().find(|v| v.code == "self-intersection") {
        let three = |v: &[u32]| [v[0], v[1], v[2]];
        let pairs = found.elements.chunks_exact(6).map(|six| [three(&six[..3]), three(&six[3..])]).collect();
        return Verdict::Meets { pairs, count: found.count };
    }
    match merged(before, after) {
        Some(vertices) => Verdict::Merged { vertices },
        None => Verdict::Undecided { reason: report.embedded.reason },
    }
}

fn out_of_range(violations: &[Violation]) -> Option<Verdict> {
    let codes = ["coordinate-out-of-range", "positions-do-not-match"];
    let found = violations.iter().find(|v| codes.contains(&v.code))?;
    Some(Verdict::Undecided { reason: found.message.clone() })
}

/// The first two vertices that lie on one point now and did not before.
fn merged(before: &[Point3], after: &[Point3]) -> Option<[u32; 2]> {
    let mut order: Vec<u32> = (0..after.len() as u32).collect();
    // Zeros of either sign are one place.
    let key = |v: u32| after[v as usize].map(|x| x + 0.0);
    let compare = |&a: &u32, &b: &u32| {
        let (p, q) = (key(a), key(b));
        let by = |k: usize| p[k].total_cmp(&q[k]);
        by(0).then_with(|| by(1)).then_with(|| by(2)).then(a.cmp(&b))
    };
    order.par_sort_unstable_by(compare);
    let together = |pair: &&[u32]| key(pair[0]) == key(pair[1]) && before[pair[0] as usize] != before[pair[1] as usize];
    order.windows(2).filter(together).map(|pair| [pair[0], pair[1]]).min()
}
