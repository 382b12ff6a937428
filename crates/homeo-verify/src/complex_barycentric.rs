//! Rules D and K1-K3: a complex map with speeds is a homeomorphism between planar domains.
//!
//! *Theorem.* Let the vertices of two domains correspond, let speeds of the edges be increasing homeomorphisms of `[0, 1]`, and
//! let the Jacobian determinant of the complex map be positive at every point of the open first domain. Then the map is a
//! homeomorphism of the closed domains that sends every edge onto its image by its speed. (Proof, and the formulas near edges
//! and vertices: `docs/theory/complex.md`.)
//!
//! A speed is a polynomial in Bernstein form with control values `0 = c_0 < ... < c_d = 1`: its derivative has the positive
//! coefficients `d (c_{k+1} - c_k)`. The boundary therefore needs no other rule.

use crate::archive::Archive;
use crate::composite::{check_determinant, check_tiling, flat, neighbours};
use crate::manifest::Manifest;
use crate::map_file::{TilingData, read_planar_source};
use crate::mean_value::{MOST_DEGREE, Speeds, Step};
use crate::npy::{Array, F8, U4};
use crate::number::Point;
use crate::rings::Rings;
use crate::verdict::{Checked, Unreadable, check, readable};

/// The arrays of a complex map with speeds. Third coordinates are 0.
pub(crate) struct ComplexData {
    /// How many vertices the rings of both domains have.
    pub(crate) ring_sizes: Vec<u32>,
    /// The vertices of the source and of the target.
    pub(crate) domains: [Vec<Point>; 2],
    /// Of the source.
    pub(crate) tiling: TilingData,
    /// Of all speeds.
    pub(crate) degree: usize,
    /// Of the edge from each vertex, one more than the degree.
    pub(crate) control_values: Vec<f64>,
}

impl ComplexData {
    /// Reads the arrays.
    pub(crate) fn read(archive: &mut Archive, manifest: &Manifest) -> Result<Self, Unreadable> {
        let (source, ring_sizes) = read_planar_source(archive, manifest)?;
        let count = source.len();
        let target = Array::take(archive, "target_points")?.read_points(Some(count), 2)?;
        let array = Array::take(archive, "control_values")?;
        let columns = array.content.len() / (8 * count);
        let degree = columns.saturating_sub(1);
        let message = "control_values does not have from 2 to 9 columns, for degrees from 1 to 8";
        readable((1..=MOST_DEGREE).contains(&degree), message)?;
        let control_values = array.read(F8, Some(count), columns)?;
        let added = Array::take(archive, "added_points")?.read_points(None, 2)?;
        let triangles = Array::take(archive, "triangles")?.read(U4, None, 3)?;
        let tiling = TilingData { added, triangles };
        Ok(ComplexData { ring_sizes, domains: [source, target], tiling, degree, control_values })
    }
}

/// Applies the rules and counts what was checked.
pub(crate) fn check_complex(data: &ComplexData) -> Checked<Vec<(&'static str, u64)>> {
    check_numbers(data)?;
    for (points, name) in data.domains.iter().zip(["source", "target"]) {
        Rings { points, sizes: &data.ring_sizes }.check_domain(name)?;
    }
    let rings = Rings { points: &data.domains[0], sizes: &data.ring_sizes };
    let boundary: Vec<[u32; 2]> = rings.edges().collect();
    let corners: Vec<Point> = data.domains[0].iter().chain(&data.tiling.added).copied().collect();
    check_tiling("K2", "the tiling of the source", &corners, &data.tiling.triangles, &boundary)?;
    Ok(vec![
        ("edges of both domains that meet in common ends only (rule D)", 2 * boundary.len() as u64),
        ("edges whose speeds increase from 0 to 1 (rule K1)", boundary.len() as u64),
        ("triangles that tile the source, edge to edge (rule K2)", data.tiling.triangles.len() as u64 / 3),
        ("boxes in which the Jacobian determinant is positive (rule K3)", check_map(data, &boundary)?),
    ])
}

/// Rule K1: coordinates are finite, and the control values of each edge increase strictly from 0 to 1.
fn check_numbers(data: &ComplexData) -> Checked {
    let mut points = data.domains.iter().flatten().chain(&data.tiling.added).flatten();
    check(points.all(|x| x.is_finite()), "K1", "a vertex or an added point is not finite", &[], &[])?;
    for (edge, values) in data.control_values.chunks_exact(data.degree + 1).enumerate() {
        let increases = values[0] == 0.0 && values[data.degree] == 1.0 && values.windows(2).all(|c| c[0] < c[1]);
        let message = format!("the control values of edge {edge} do not increase strictly from 0 to 1");
        check(increases, "K1", &message, &[], &[u32::try_from(edge).unwrap_or(u32::MAX)])?;
    }
    Ok(())
}

/// Rule K3: the determinant is positive in all charts. Counts the boxes.
fn check_map(data: &ComplexData, boundary: &[[u32; 2]]) -> Checked<u64> {
    let [source, target] = &data.domains;
    let [points, images, added] = [source, target, &data.tiling.added].map(|p| flat(p));
    let [next, previous] = neighbours(boundary);
    // Linear speeds add nothing: the map is the mean value map.
    let speeds = (data.degree > 1).then(|| Speeds::new(&data.control_values, data.degree));
    let [next, previous] = [&next[..], &previous];
    let step = Step { points: &points, images: &images, added: &added, next, previous, speeds: speeds.as_ref() };
    let remedy = "other speeds, or a composite mean value map, which goes in several steps";
    check_determinant(&step, &data.tiling.triangles, "K3", "the complex map", remedy)
}
