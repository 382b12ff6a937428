//! Where the search looks at the determinant: in corners, on edges and on a grid.

use homeo_core::planar::{PlanarDomain, Point2};

use super::chart::{Cover, Piece};
use super::frame::{Chart, Outline};
use super::guide::Guide;

/// A point, by the coordinates of its chart.
pub(super) struct Place {
    pub chart: Chart<f64>,
    pub at: [f64; 2],
    pub point: Point2,
    pub guide: Guide,
}

/// Parts of both sides of a corner's triangle, of an edge, and of the sides of a cell of the grid.
pub(super) struct Density {
    corner: [usize; 2],
    edge: usize,
    cell: usize,
}

/// Enough to begin with.
pub(super) const COARSE: Density = Density { corner: [1, 2], edge: 8, cell: 1 };
/// To see what was missed.
pub(super) const FINE: Density = Density { corner: [4, 8], edge: 64, cell: 4 };

impl Place {
    /// In the plane.
    pub fn new(outline: &Outline, point: Point2) -> Self {
        Self { chart: Chart::Plane, at: point, point, guide: Guide::at(outline, point, None, [0.0; 2]) }
    }

    fn in_corner(outline: &Outline, piece: &Piece, at: [f64; 2]) -> Self {
        let point = piece.place(outline, at);
        let guide = Guide::at(outline, point, piece.vertex(), piece.direction(at[1]));
        Self { chart: piece.rounded(), at, point, guide }
    }
}

/// Calls `visit` with the places of each triangle of a corner, of each edge, and of each cell of a grid of so many along the
/// longer side; no more of them once it is cancelled.
pub(super) fn visit(
    outline: &Outline,
    domain: &PlanarDomain,
    grid: usize,
    density: &Density,
    is_cancelled: &(dyn Fn() -> bool + Sync),
    mut visit: impl FnMut(&mut dyn Iterator<Item = Place>),
) {
    let [radial, across] = density.corner;
    // Denser towards the vertex.
    let shares =
        |k: usize| [((k / (across + 1)) as f64 / radial as f64).powi(2), (k % (across + 1)) as f64 / across as f64];
    for piece in Cover::new(outline, domain).pieces.iter().filter(|piece| piece.vertex().is_some()) {
        if is_cancelled() {
            return;
        }
        visit(&mut (0..(radial + 1) * (across + 1)).map(|k| Place::in_corner(outline, piece, shares(k))));
    }
    for [p, q] in domain.edges() {
        if is_cancelled() {
            return;
        }
        let on = |k: usize| [0, 1].map(|axis| p[axis] + k as f64 / density.edge as f64 * (q[axis] - p[axis]));
        visit(&mut (1..density.edge).map(|k| Place::new(outline, on(k))));
    }
    let [low, high] = domain.bounds();
    let step = (high[0] - low[0]).max(high[1] - low[1]) / grid as f64;
    let count = |axis: usize| ((high[axis] - low[axis]) / step).ceil() as usize;
    let parts = density.cell;
    for (x, y) in (0..count(0)).flat_map(|x| (0..count(1)).map(move |y| (x, y))) {
        if is_cancelled() {
            return;
        }
        let within = |k: usize| (k as f64 + 0.5) / parts as f64;
        let at =
            |k: usize| [low[0] + (x as f64 + within(k / parts)) * step, low[1] + (y as f64 + within(k % parts)) * step];
        let inside = (0..parts * parts).map(at).filter(|point| domain.contains(*point));
        visit(&mut inside.map(|point| Place::new(outline, point)));
    }
}
