//! A domain that is triangulated, and slit open if it has several holes, on its way to the middle.

use homeo_core::planar::{PlanarDomain, Point2};

use super::flatten::{Laplace, Weights};
use super::{HarmonicError, boundary, go_on, mesh, seams, turns};
use crate::map::{BoundaryPoint, Circuit, Half, HalfParts, Middle};
use crate::progress::Progress;

/// A domain that is triangulated, not yet flattened.
pub(crate) struct Triangulated {
    pub domain: PlanarDomain,
    /// Vertices on the boundary, which come first.
    pub boundary: Vec<BoundaryPoint>,
    /// Where they lie, ring by ring.
    rings: Vec<Vec<Point2>>,
    /// Where points inside seams lie, seam after seam.
    seam_points: Vec<Point2>,
    /// Where all vertices lie, rounded.
    pub positions: Vec<Point2>,
    mesh: mesh::Mesh,
}

impl Triangulated {
    /// About so many triangles, more where the domain is narrow; no edge joins two vertices of one ring if it `is_cylinder`.
    pub fn new(
        domain: &PlanarDomain,
        triangles: usize,
        is_cylinder: bool,
        progress: &impl Progress,
    ) -> Result<Self, HarmonicError> {
        progress.stage("triangulate");
        let largest_area = area(domain) / triangles.max(1) as f64;
        // Triangles with equal sides and this area.
        let spacing = (largest_area * 4.0 / 3f64.sqrt()).sqrt();
        let boundary = boundary::boundary_points(domain, spacing, 2 * triangles + 8 * domain.vertex_count() + 2_000);
        go_on(progress)?;
        let mut rings: Vec<Vec<Point2>> = vec![Vec::new(); domain.rings().len()];
        for point in &boundary {
            let ring = &domain.rings()[point.ring as usize];
            let (a, b) = (ring[point.edge as usize], ring[(point.edge as usize + 1) % ring.len()]);
            let share = point.fraction();
            let there = if point.share == 0 { a } else { [0, 1].map(|x| a[x] * (1.0 - share) + b[x] * share) };
            rings[point.ring as usize].push(there);
        }
        let mut mesh = mesh::triangulate(&rings, largest_area, 10 * (triangles + boundary.len()))?;
        if is_cylinder {
            let outer = rings[0].len() as u32;
            mesh.split_chords(|[low, high]| (high as usize) < boundary.len() && (low < outer) == (high < outer));
        }
        go_on(progress)?;
        let positions = mesh.positions();
        Ok(Self { domain: domain.clone(), boundary, rings, seam_points: Vec::new(), positions, mesh })
    }

    /// Corners of all triangles, counter-clockwise.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// Flattens it; on a cylinder the inner ring is put `turns` turns ahead.
    pub fn flatten(
        self,
        middle: &Middle,
        turns: i8,
        side: &'static str,
        progress: &impl Progress,
    ) -> Result<HalfParts, HarmonicError> {
        let Self { domain, boundary, rings, seam_points, positions, mesh } = self;
        let shifts = match middle.is_cylinder() {
            true => turns::shifts(&domain, &mesh, &rings, turns),
            false => Vec::new(),
        };
        let fixed: Vec<Point2> = boundary.iter().map(|point| middle.point(point)).collect();
        let mut first_flipped = 0;
        for weights in [Weights::Cotangent, Weights::Equal] {
            go_on(progress)?;
            let images = Laplace::new(&positions, fixed.len(), &mesh.triangles, &shifts, weights)?.solve(&fixed);
            let parts = HalfParts {
                domain: domain.clone(),
                boundary: boundary.clone(),
                seam_points: seam_points.clone(),
                inner: mesh.inner.clone(),
                images,
                triangles: mesh.triangles.clone(),
                shifts: shifts.clone(),
            };
            match Half::new(parts, middle).into_parts_if_positive(middle) {
                Ok(parts) => return Ok(parts),
                Err(triangle) => first_flipped = triangle,
            }
            log::info!("{side}: triangle {first_flipped} is turned over with {weights:?} weights");
        }
        Err(HarmonicError::Flipped { side, triangle: first_flipped })
    }
}

/// Slits the halves of a pair open along seams with the same ends. Returns how, and the lengths of the sides in both.
pub(super) fn slit(halves: [&mut Triangulated; 2]) -> Result<(Circuit, [Vec<f64>; 2]), HarmonicError> {
    let failed = || HarmonicError::Seams;
    let [source, target] = halves;
    let sizes: Vec<usize> = source.domain.rings().iter().map(Vec::len).collect();
    let sheets = [(&source.boundary[..], &mut source.mesh), (&target.boundary[..], &mut target.mesh)];
    let seams = seams::lay(&source.domain, sheets).ok_or_else(failed)?;
    let circuit = Circuit::new(&sizes, &seams.ends).ok_or_else(failed)?;
    let open = |half: &mut Triangulated, routes: &[Vec<u32>]| {
        let slit = seams::slit(&circuit, &half.boundary, &half.mesh, routes);
        half.mesh = half.mesh.opened(&slit.walk).ok_or_else(failed)?;
        half.positions = half.mesh.positions();
        (half.boundary, half.seam_points) = (slit.boundary, slit.seam_points);
        Ok(slit.lengths)
    };
    let lengths = [open(source, &seams.routes[0])?, open(target, &seams.routes[1])?];
    Ok((circuit, lengths))
}

fn area(domain: &PlanarDomain) -> f64 {
    let origin = domain.rings()[0][0];
    domain
        .edges()
        .map(|[a, b]| 0.5 * ((a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0])))
        .sum()
}
