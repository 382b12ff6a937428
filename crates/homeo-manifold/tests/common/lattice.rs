//! Solids with tunnels, as tetrahedral meshes of cubes.

use std::collections::{BTreeMap, BTreeSet};

/// A place on a lattice.
pub type Place = [i32; 3];

/// A box of cubes less tunnels one cube wide, each cube cut into six tetrahedra; the indices of their vertices, and their number.
///
/// The tunnels follow `paths` of places on a lattice of twice the width, from place to place along axes. Paths that do
/// not share places keep a cube apart. The box ends one cube beyond all paths, but for the top, where it ends with them: a path that
/// ends there has an opening.
pub fn tunnelled(paths: &[Vec<Place>]) -> (usize, Vec<[u32; 4]>) {
    let tunnels: BTreeSet<Place> = paths.iter().flat_map(|path| cubes_of(path)).collect();
    let bound = |axis: usize| tunnels.iter().map(move |place| place[axis]);
    let low = [0, 1, 2].map(|axis| bound(axis).min().unwrap() - 1);
    let high = [0, 1, 2].map(|axis| bound(axis).max().unwrap() + i32::from(axis < 2));
    let mut numbers = BTreeMap::new();
    let mut cells = Vec::new();
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                if tunnels.contains(&[x, y, z]) {
                    continue;
                }
                for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let mut corner = [x, y, z];
                    let mut cell = [0; 4];
                    for step in 0..4 {
                        let next = numbers.len() as u32;
                        cell[step] = *numbers.entry(corner).or_insert(next);
                        if step < 3 {
                            corner[order[step]] += 1;
                        }
                    }
                    cells.push(cell);
                }
            }
        }
    }
    (numbers.len(), cells)
}

/// The cubes along a path of places.
fn cubes_of(path: &[Place]) -> Vec<Place> {
    let mut cubes = vec![path[0].map(|x| 2 * x)];
    for step in path.windows(2) {
        let direction = [0, 1, 2].map(|axis| (step[1][axis] - step[0][axis]).signum());
        let length: i32 = [0, 1, 2].map(|axis| (step[1][axis] - step[0][axis]).abs()).iter().sum();
        assert!(direction.iter().filter(|&&d| d != 0).count() <= 1, "{step:?} is not along an axis");
        for number in 1..=2 * length {
            cubes.push([0, 1, 2].map(|axis| 2 * step[0][axis] + number * direction[axis]));
        }
    }
    cubes
}

/// Three arms that rise from a common point, each with a finger round the next: the knotted Y, whose exterior in a ball is Thurston's tripus.
///
/// Arm `k` stands over corner `k` of a right triangle. At a low height its finger leaves it, rises, goes to the next
/// corner, round it and back, on the left of where it came.
pub fn knotted_y() -> Vec<Vec<Place>> {
    let (low, high, top) = (2, 6, 8);
    let arm0 = vec![
        [2, 2, 0],
        [2, 2, low],
        [2, 1, low],
        [4, 1, low],
        [4, 1, high],
        [13, 1, high],
        [13, 3, high],
        [4, 3, high],
        [4, 3, low],
        [2, 3, low],
        [2, 3, low + 1],
        [2, 2, low + 1],
        [2, 2, top],
    ];
    let arm1 = vec![
        [12, 2, 0],
        [12, 2, low],
        [13, 2, low],
        [13, 4, low],
        [13, 4, high],
        [13, 13, high],
        [11, 13, high],
        [11, 4, high],
        [11, 4, low],
        [11, 2, low],
        [11, 2, low + 1],
        [12, 2, low + 1],
        [12, 2, top],
    ];
    let arm2 = vec![
        [12, 12, 0],
        [12, 12, low],
        [12, 13, low],
        [10, 13, low],
        [10, 13, high],
        [1, 13, high],
        [1, 1, high],
        [3, 1, high],
        [3, 11, high],
        [10, 11, high],
        [10, 11, low],
        [12, 11, low],
        [12, 11, low + 1],
        [12, 12, low + 1],
        [12, 12, top],
    ];
    vec![arm0, arm1, arm2, vec![[2, 2, 0], [12, 2, 0], [12, 12, 0]]]
}
