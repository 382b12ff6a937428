//! The boundary of a domain that is slit open along seams: one closed walk.

use homeo_core::planar::{PlanarDomain, Point2};

use super::half::BoundaryPoint;
use super::middle::SHARE_BITS;

/// One side of a [`Circuit`], from its corner to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CircuitSide {
    /// The edge of its ring that begins at the corner.
    Edge,
    /// One side of a seam.
    Seam {
        /// Which seam.
        number: u32,
        /// Whether it goes from the second end of the seam to the first.
        is_back: bool,
    },
}

/// The closed walk along the boundary of a domain with holes that is slit open along *seams* between its rings.
///
/// It goes along the rings in their sense. Where it comes to the end of a seam it goes over the seam to the other ring, on
/// there, and back in the end on the other side of the seam. So it passes every edge once and every seam twice, and the
/// domain lies to its left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Circuit {
    seams: Vec<[u32; 2]>,
    corners: Vec<u32>,
    sides: Vec<CircuitSide>,
    /// The sides of each seam: there and back.
    seam_sides: Vec<[usize; 2]>,
}

impl Circuit {
    /// The walk of a domain with rings of these sizes; each seam joins two vertices, numbered ring after ring. It begins with
    /// the first edge. None where a vertex does not exist or has two seams, or if one walk does not pass everything: it does
    /// if the seams join all rings as a tree.
    ///
    /// ```
    /// use homeo::map::{Circuit, CircuitSide::{Edge, Seam}};
    /// let circuit = Circuit::new(&[3, 3], &[[1, 5]]).unwrap();
    /// assert_eq!(circuit.corners(), [0, 1, 5, 3, 4, 5, 1, 2]);
    /// let [there, back] = [false, true].map(|is_back| Seam { number: 0, is_back });
    /// assert_eq!(circuit.sides(), [Edge, there, Edge, Edge, Edge, back, Edge, Edge]);
    /// assert!(Circuit::new(&[3, 3], &[]).is_none());
    /// ```
    pub fn new(sizes: &[usize], seams: &[[u32; 2]]) -> Option<Self> {
        let next = next_vertices(sizes);
        let mut seam_at = vec![CircuitSide::Edge; next.len()];
        for (number, ends) in seams.iter().enumerate() {
            for (end, is_back) in ends.iter().zip([false, true]) {
                let place = seam_at.get_mut(*end as usize)?;
                if *place != CircuitSide::Edge {
                    return None;
                }
                *place = CircuitSide::Seam { number: number as u32, is_back };
            }
        }
        let count = next.len() + 2 * seams.len();
        let mut circuit = Self {
            seams: seams.to_vec(),
            corners: Vec::with_capacity(count),
            sides: Vec::with_capacity(count),
            seam_sides: vec![[0; 2]; seams.len()],
        };
        let (mut corner, mut side) = (0, CircuitSide::Edge);
        while circuit.sides.len() < count {
            circuit.corners.push(corner);
            circuit.sides.push(side);
            match side {
                CircuitSide::Edge => {
                    corner = *next.get(corner as usize)?;
                    side = seam_at[corner as usize];
                }
                CircuitSide::Seam { number, is_back } => {
                    circuit.seam_sides[number as usize][usize::from(is_back)] = circuit.sides.len() - 1;
                    corner = seams[number as usize][usize::from(!is_back)];
                    side = CircuitSide::Edge;
                }
            }
            if (corner, side) == (0, CircuitSide::Edge) {
                break;
            }
        }
        (count > 0 && circuit.sides.len() == count).then_some(circuit)
    }

    /// Both ends of every seam.
    pub fn seams(&self) -> &[[u32; 2]] {
        &self.seams
    }

    /// The vertex at which each side begins; a vertex with a seam is there twice.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// The sides, in order.
    pub fn sides(&self) -> &[CircuitSide] {
        &self.sides
    }

    /// Where the corners lie in a domain.
    pub(super) fn outline(&self, domain: &PlanarDomain) -> Vec<Point2> {
        let vertices: Vec<Point2> = domain.vertices().collect();
        self.corners.iter().map(|&corner| vertices[corner as usize]).collect()
    }

    /// Where points of the boundary lie, if inside seams: these have given places, seam after seam. Nothing if the sides of a
    /// seam do not have the same points, at the shares `s` and `1 - s`, or there are not as many places.
    pub(crate) fn places(&self, boundary: &[BoundaryPoint], points: &[Point2]) -> Option<Vec<Option<Point2>>> {
        let mut inside: Vec<Vec<usize>> = vec![Vec::new(); self.sides.len()];
        for (row, point) in boundary.iter().enumerate().filter(|(_, point)| point.share > 0) {
            inside.get_mut(point.edge as usize)?.push(row);
        }
        let mut places = vec![None; boundary.len()];
        let mut rest = points.iter();
        for &[there, back] in &self.seam_sides {
            if inside[there].len() != inside[back].len() {
                return None;
            }
            for (&row, &opposite) in inside[there].iter().zip(inside[back].iter().rev()) {
                let shares = [row, opposite].map(|row| u64::from(boundary[row].share));
                if shares[0] + shares[1] != 1 << SHARE_BITS {
                    return None;
                }
                let place = *rest.next()?;
                places[row] = Some(place);
                places[opposite] = Some(place);
            }
        }
        rest.next().is_none().then_some(places)
    }
}

/// The next vertex on the ring of each.
fn next_vertices(sizes: &[usize]) -> Vec<u32> {
    let mut next = Vec::with_capacity(sizes.iter().sum());
    for &size in sizes {
        let first = next.len();
        next.extend((0..size).map(|i| (first + (i + 1) % size) as u32));
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_trees_of_seams_have_a_circuit() {
        let sizes = [3, 3, 3];
        assert_eq!(Circuit::new(&sizes, &[[0, 3], [4, 6]]).map(|c| c.corners().len()), Some(13));
        for wrong in [&[[0, 3]][..], &[[0, 3], [1, 4]], &[[0, 3], [0, 6]], &[[0, 3], [6, 9]], &[[0, 3], [6, 6]]] {
            assert_eq!(Circuit::new(&sizes, wrong), None, "{wrong:?}");
        }
        assert_eq!(Circuit::new(&[], &[]), None);
    }

    #[test]
    fn both_sides_of_a_seam_have_the_same_points() {
        let circuit = Circuit::new(&[3, 3], &[[1, 5]]).unwrap();
        let row = |edge: u32, share: u32| BoundaryPoint { ring: 0, edge, share };
        let rows = |back: u32| [row(1, 0), row(1, 1), row(5, 0), row(5, back)];
        let there = Some([2.0, 3.0]);
        assert_eq!(circuit.places(&rows((1 << 30) - 1), &[[2.0, 3.0]]), Some(vec![None, there, None, there]));
        assert_eq!(circuit.places(&rows(1), &[[2.0, 3.0]]), None);
        assert_eq!(circuit.places(&rows((1 << 30) - 1), &[]), None);
        assert_eq!(circuit.places(&rows((1 << 30) - 1)[..3], &[[2.0, 3.0]]), None);
    }
}
