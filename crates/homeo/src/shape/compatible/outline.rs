//! A triangulated region, cut open, as a polygon whose triangles have all corners on its boundary.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::CompatibleError;

/// A polygon of `names.len()` corners, counter-clockwise, in triangles. A vertex on a cut has two corners.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Outline {
    /// The vertex at each corner.
    pub names: Vec<u32>,
    /// Corners of triangles, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
}

impl Outline {
    /// Opens triangles along walls, which are sides of the region and cuts, given in one direction. Corner 0 is where the
    /// first side begins, to the left of it.
    ///
    /// Corners of triangles at one vertex are one corner of the polygon where no wall parts them.
    pub fn new(triangles: &[[u32; 3]], first: [u32; 2], walls: &[[u32; 2]]) -> Result<Self, CompatibleError> {
        let failed = || CompatibleError::NotOpened { from: first[0], to: first[1] };
        let is_wall: HashSet<[u32; 2]> = walls.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        let side = |number: usize| {
            let (corners, k) = (triangles[number / 3], number % 3);
            [corners[k], corners[(k + 1) % 3]]
        };
        let numbers: HashMap<[u32; 2], usize> = (0..3 * triangles.len()).map(|number| (side(number), number)).collect();
        let mut parents: Vec<usize> = (0..3 * triangles.len()).collect();
        let after = |number: usize| number - number % 3 + (number + 1) % 3;
        for number in 0..3 * triangles.len() {
            let [a, b] = side(number);
            if is_wall.contains(&[a, b]) {
                continue;
            }
            let &twin = numbers.get(&[b, a]).ok_or_else(failed)?;
            join(&mut parents, number, after(twin));
            join(&mut parents, after(number), twin);
        }
        let mut next = BTreeMap::new();
        for number in (0..3 * triangles.len()).filter(|&number| is_wall.contains(&side(number))) {
            next.insert(root(&mut parents, number), root(&mut parents, after(number)));
        }
        let start = root(&mut parents, *numbers.get(&first).ok_or_else(failed)?);
        let mut places = HashMap::new();
        let mut names = Vec::with_capacity(next.len());
        let mut here = start;
        while names.len() < next.len() {
            if places.insert(here, names.len() as u32).is_some() {
                break;
            }
            names.push(side(here)[0]);
            here = *next.get(&here).ok_or_else(failed)?;
        }
        // One ring through all corners, in triangles without vertices inside.
        if here != start || names.len() != next.len() || names.len() != triangles.len() + 2 {
            return Err(failed());
        }
        let mut corner = |number: usize| places.get(&root(&mut parents, number)).copied().ok_or_else(failed);
        let triangles = (0..triangles.len())
            .map(|number| Ok([corner(3 * number)?, corner(3 * number + 1)?, corner(3 * number + 2)?]))
            .collect::<Result<_, CompatibleError>>()?;
        Ok(Self { names, triangles })
    }
}

/// The root of a tree of a union-find structure, with halved ways.
fn root(parents: &mut [usize], mut number: usize) -> usize {
    while parents[number] != number {
        parents[number] = parents[parents[number]];
        number = parents[number];
    }
    number
}

fn join(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_of_triangles_opens_along_its_cut() {
        // Outer vertices 0 to 2, inner ones 3 to 5.
        let ring = [[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]];
        let walls = [[0, 1], [1, 2], [2, 0], [3, 5], [5, 4], [4, 3], [0, 3]];
        let open = Outline::new(&ring, [0, 1], &walls).unwrap();
        assert_eq!(open.names, [0, 1, 2, 0, 3, 5, 4, 3]);
        assert!(open.triangles.iter().flatten().all(|&corner| corner < 8));
        // Without the cut there are two rings.
        assert!(Outline::new(&ring, [0, 1], &walls[..6]).is_err());
    }
}
