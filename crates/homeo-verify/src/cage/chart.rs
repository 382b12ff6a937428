//! Parameters of the inside of a cage: its own coordinates, and others that end at vertices and edges.
//!
//! At a vertex `v` points are `v + r y`, with `y` on the side of a cube. At an edge from `v`, `y = e + s z`, with `e` along
//! the edge and `z` on the side of a square across. So `r` and `s` are factors of what vanishes there.

use super::jet::{Form, Jet, Vector, constant, difference, plus, three, times};
use super::outline::Outline;

/// Intervals of the three parameters.
pub(super) type Cell = [[f64; 2]; 3];

/// What the parameters are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Chart {
    /// The coordinates.
    Open,
    /// `r`, and the coordinates of `y` but that with the number `axis`, which is `side`.
    Vertex { vertex: u32, axis: usize, side: f64 },
    /// `r`, `s`, and a coordinate of `z`; that with the number `axis` is `side`, and that in which the edge goes farthest is zero.
    Edge { vertex: u32, edge: u32, axis: usize, side: f64 },
}

/// How much vanishes: nothing, by `r`, or by `r s`.
pub(super) type Level = usize;

/// Points of a cell, with their derivatives by the parameters.
pub(super) struct Place {
    /// From the vertex of the chart, or from the origin.
    pub position: Vector<Jet>,
    pub y: Vector<Jet>,
    pub z: Vector<Jet>,
    /// `r` and `s`; 1 where there is none.
    pub r: Jet,
    pub s: Jet,
    /// The derivatives of the point: the second and third divided by `r`, the third by `s`.
    pub columns: [Vector<Form>; 3],
}

/// The axis in which an edge goes farthest, and how far with its sign.
pub(super) fn main_axis(along: Vector<f64>) -> (usize, f64) {
    let axis = (1..3).fold(0, |best, k| if along[k].abs() > along[best].abs() { k } else { best });
    (axis, along[axis])
}

impl Chart {
    /// The vertex that it ends at.
    pub fn vertex(&self) -> Option<u32> {
        match *self {
            Chart::Open => None,
            Chart::Vertex { vertex, .. } | Chart::Edge { vertex, .. } => Some(vertex),
        }
    }

    /// The edge that it ends at.
    pub fn edge(&self) -> Option<u32> {
        match *self {
            Chart::Edge { edge, .. } => Some(edge),
            _ => None,
        }
    }

    /// Where the origin of positions is.
    pub fn origin(&self, outline: &Outline) -> [f64; 3] {
        self.vertex().map_or([0.0; 3], |v| outline.points[v as usize])
    }

    /// How much vanishes at an edge.
    pub fn edge_level(&self, outline: &Outline, edge: u32) -> Level {
        let is_at_vertex = self.vertex().is_some_and(|v| outline.edges[edge as usize].ends.contains(&v));
        if self.edge() == Some(edge) { 2 } else { usize::from(is_at_vertex) }
    }

    /// The edge of the chart from its vertex to the other end, as far as `r = 1`.
    pub fn along_edge(&self, outline: &Outline) -> Option<Vector<Form>> {
        let (vertex, edge) = (self.vertex()?, &outline.edges[self.edge()? as usize]);
        let [a, b] = edge.ends;
        let other = if vertex == a { b } else { a };
        let along = difference(outline.points[other as usize], outline.points[vertex as usize]);
        let (axis, far) = main_axis(along.map(|x| x.middle));
        let size = if far < 0.0 { -along[axis] } else { along[axis] };
        Some(times(size.inverse(), along))
    }

    /// The points of a cell.
    pub fn place(&self, outline: &Outline, cell: &Cell) -> Place {
        let parameters = three(|k| Jet::parameter(cell[k], k));
        let unit = |axis: usize| three(|k| if k == axis { Form::ONE } else { Form::ZERO });
        let [first, second, third] = parameters;
        let nothing = [Jet::ZERO; 3];
        match *self {
            Chart::Open => Place {
                position: parameters,
                y: nothing,
                z: nothing,
                r: Jet::ONE,
                s: Jet::ONE,
                columns: [0, 1, 2].map(unit),
            },
            Chart::Vertex { axis, side, .. } => {
                let others = [(axis + 1) % 3, (axis + 2) % 3];
                let mut y = nothing;
                [y[axis], y[others[0]], y[others[1]]] = [Jet::constant(Form::exact(side)), second, third];
                let columns = [y.map(|c| c.value), unit(others[0]), unit(others[1])];
                Place { position: times(first, y), y, z: nothing, r: first, s: Jet::ONE, columns }
            }
            Chart::Edge { axis, side, .. } => {
                let along = self.along_edge(outline).unwrap_or([Form::UNKNOWN; 3]);
                let (main, _) = main_axis(along.map(|x| x.middle));
                let other = 3 - main - axis;
                let mut z = nothing;
                [z[axis], z[other]] = [Jet::constant(Form::exact(side)), third];
                let y = plus(constant(along), times(second, z));
                let columns = [y.map(|c| c.value), z.map(|c| c.value), unit(other)];
                Place { position: times(first, y), y, z, r: first, s: second, columns }
            }
        }
    }
}
