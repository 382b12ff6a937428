//! Which sides of triangles meet: the walls between prisms over them.

use std::collections::HashMap;
use thiserror::Error;

/// A side of a triangle: that from its corner `side` to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Side {
    /// The triangle.
    pub triangle: u32,
    /// 0, 1 or 2.
    pub side: u8,
}

impl Side {
    /// The side of a triangle.
    pub fn new(triangle: u32, side: u8) -> Self {
        debug_assert!(side < 3, "a triangle has no side {side}");
        Self { triangle, side }
    }

    /// The other two sides of the triangle, in order.
    pub(crate) fn others(self) -> [Self; 2] {
        [1, 2].map(|step| Self { side: (self.side + step) % 3, ..self })
    }
}

/// Why triangles are no oriented surface.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum WallError {
    #[error("triangle {triangle} names vertex {vertex} twice: remove degenerate triangles")]
    Degenerate { triangle: u32, vertex: u32 },
    #[error(
        "triangles {first} and {second} both run from vertex {from} to vertex {to}: the surface is not manifold there or not \
         consistently oriented; turn the triangles so that neighbours agree"
    )]
    NotOriented { first: u32, second: u32, from: u32, to: u32 },
}

/// The neighbours of the sides of oriented triangles.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::{Side, Walls};
/// let square = Walls::new(&[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!(square.across(Side::new(0, 2)), Some(Side::new(1, 0)));
/// assert_eq!(square.across(Side::new(0, 0)), None);
/// assert!(Walls::new(&[[0, 1, 2], [0, 1, 3]]).is_err());
/// # Ok::<(), homeo_manifold::bundle::WallError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Walls {
    across: Vec<[Option<Side>; 3]>,
}

impl Walls {
    /// The neighbours of the sides of triangles; two sides are neighbours where they run between the same vertices in
    /// opposite directions. Linear cost, but for a sort.
    ///
    /// # Errors
    /// The first triangle that names a vertex twice, or that runs along an edge in the same direction as one before.
    pub fn new(triangles: &[[u32; 3]]) -> Result<Self, WallError> {
        let place = |place: usize| Side { triangle: (place / 3) as u32, side: (place % 3) as u8 };
        let ends_at = |at: usize| [triangles[at / 3][at % 3], triangles[at / 3][(at % 3 + 1) % 3]];
        let edge = |at: usize| {
            let [from, to] = ends_at(at);
            (u64::from(from.min(to)) << 32 | u64::from(from.max(to)), at)
        };
        // A sort is several times as fast as a table of hashes.
        let mut edges: Vec<(u64, usize)> = (0..3 * triangles.len()).map(edge).collect();
        edges.sort_unstable();
        let mut across = vec![[None; 3]; triangles.len()];
        let mut fault: Option<(usize, WallError)> = None;
        let mut blame = |at: usize, error: WallError| {
            if fault.as_ref().is_none_or(|(first, _)| at < *first) {
                fault = Some((at, error));
            }
        };
        for group in edges.chunk_by(|a, b| a.0 == b.0) {
            let mut along: [Option<usize>; 2] = [None; 2];
            for &(_, at) in group {
                let [from, to] = ends_at(at);
                if from == to {
                    blame(at, WallError::Degenerate { triangle: place(at).triangle, vertex: from });
                } else if let Some(first) = along[usize::from(from < to)] {
                    let (first, second) = (place(first).triangle, place(at).triangle);
                    blame(at, WallError::NotOriented { first, second, from, to });
                } else {
                    along[usize::from(from < to)] = Some(at);
                }
            }
            if let [Some(a), Some(b)] = along {
                across[a / 3][a % 3] = Some(place(b));
                across[b / 3][b % 3] = Some(place(a));
            }
        }
        match fault {
            Some((_, error)) => Err(error),
            None => Ok(Self { across }),
        }
    }

    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.across.len()
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.across.is_empty()
    }

    /// The side on the other side; nothing at the boundary.
    pub fn across(&self, side: Side) -> Option<Side> {
        self.across[side.triangle as usize][usize::from(side.side)]
    }

    /// Cuts the surface open along a side.
    pub fn cut(&mut self, side: Side) {
        if let Some(other) = self.across[side.triangle as usize][usize::from(side.side)].take() {
            self.across[other.triangle as usize][usize::from(other.side)] = None;
        }
    }

    /// Makes two boundary sides neighbours.
    #[cfg(test)]
    pub(crate) fn join(&mut self, a: Side, b: Side) {
        assert!(self.across(a).is_none() && self.across(b).is_none());
        self.across[a.triangle as usize][usize::from(a.side)] = Some(b);
        self.across[b.triangle as usize][usize::from(b.side)] = Some(a);
    }

    /// All sides, triangle by triangle; those of edges inside from both sides.
    pub fn sides(&self) -> impl Iterator<Item = Side> + use<> {
        (0..self.len() as u32).flat_map(|triangle| (0..3).map(move |side| Side { triangle, side }))
    }

    /// The sides at the boundary.
    pub fn open_sides(&self) -> impl Iterator<Item = Side> + '_ {
        self.sides().filter(|&side| self.across(side).is_none())
    }
}

/// The sides by the vertices that they run from and to.
pub(crate) fn sides_by_ends(triangles: &[[u32; 3]]) -> Result<HashMap<[u32; 2], Side>, WallError> {
    let mut sides = HashMap::with_capacity(3 * triangles.len());
    for (triangle, corners) in (0..).zip(triangles) {
        for side in 0..3_u8 {
            let [from, to] = [corners[usize::from(side)], corners[usize::from(side + 1) % 3]];
            if from == to {
                return Err(WallError::Degenerate { triangle, vertex: from });
            }
            if let Some(first) = sides.insert([from, to], Side { triangle, side }) {
                return Err(WallError::NotOriented { first: first.triangle, second: triangle, from, to });
            }
        }
    }
    Ok(sides)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles with random corners among few: most are faulty, those with one or two triangles often are not.
    #[test]
    fn neighbours_and_faults_are_those_of_a_table() {
        let (mut state, mut right, mut wrong) = (5_u64, 0, 0);
        let mut below = |count: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % count
        };
        for _ in 0..4000 {
            let (triangles, vertices) = (1 + below(5), 3 + below(6));
            let triangles: Vec<[u32; 3]> =
                (0..triangles).map(|_| [0; 3].map(|_: u32| below(vertices) as u32)).collect();
            match (Walls::new(&triangles), sides_by_ends(&triangles)) {
                (Ok(walls), Ok(table)) => {
                    for (ends, side) in &table {
                        assert_eq!(walls.across(*side), table.get(&[ends[1], ends[0]]).copied());
                    }
                    right += 1;
                }
                (Err(error), Err(expected)) => {
                    assert_eq!(error, expected);
                    wrong += 1;
                }
                other => panic!("{triangles:?}: {other:?}"),
            }
        }
        assert!(right > 500 && wrong > 500, "{right}, {wrong}");
    }
}
