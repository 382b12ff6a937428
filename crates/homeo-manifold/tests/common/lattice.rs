//! Solids with tunnels, as tetrahedral meshes of cubes.

use std::collections::{BTreeMap, BTreeSet};

/// A place on a lattice.
pub type Place = [i32; 3];

/// A box of cubes less tunnels one cube wide, each cube cut into six tetrahedra: vertices, and tetrahedra by their indices.
///
/// The tunnels follow `paths` of places on a lattice of twice the width, from place to place along axes. Paths that do
/// not share places keep a cube apart. The box ends one cube beyond all paths, but for the top, where it ends with them: a path that
/// ends there has an opening.
pub fn tunnelled(paths: &[Vec<Place>]) -> (Vec<Place>, Vec<[u32; 4]>) {
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
                for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]] {
                    let mut corner = [x, y, z];
                    let mut cell = [0; 4];
                    for step in 0..4 {
                        let next = numbers.len() as u32;
                        cell[step] = *numbers.entry(corner).or_insert(next);
                        if step < 3 {
                            corner[order[step]] += 1;
                        }
                    }
                    // All turned alike.
                    if (order[0] + 1) % 3 != order[1] {
                        cell.swap(2, 3);
                    }
                    cells.push(cell);
                }
            }
        }
    }
    let mut places: Vec<_> = numbers.into_iter().collect();
    places.sort_by_key(|&(_, number)| number);
    (places.into_iter().map(|(place, _)| place).collect(), cells)
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

/// Three arms that rise from a common point, each with a finger round the next: the knotted Y, whose exterior in a ball is
/// Thurston's tripus.
pub fn knotted_y() -> Vec<Vec<Place>> {
    let mut paths: Vec<_> = [0, 1].iter().map(|&corner| arm(corner, corner + 1)).collect();
    // The third goes round a corner of the square to come to the first.
    paths.push(vec![
        [12, 12, 0],
        [12, 12, LOW],
        [12, 13, LOW],
        [10, 13, LOW],
        [10, 13, HIGH],
        [1, 13, HIGH],
        [1, 1, HIGH],
        [3, 1, HIGH],
        [3, 11, HIGH],
        [10, 11, HIGH],
        [10, 11, LOW],
        [12, 11, LOW],
        [12, 11, LOW + 1],
        [12, 12, LOW + 1],
        [12, 12, TOP],
    ]);
    paths.push(vec![[2, 2, 0], [12, 2, 0], [12, 12, 0]]);
    paths
}

/// Arms that rise from a bar, in a row, and hold one another: for each pair the first arm has a finger that goes round the second and
/// back. Fingers leave their arms low and hold others high, each above the one before, so that they cannot be pulled off one
/// after the other; each has a lane of its own in front of the arms.
#[allow(dead_code, reason = "not in every program that has this module")]
pub fn entangled(arms: i32, fingers: &[(i32, i32)]) -> Vec<Vec<Place>> {
    let at = |arm: i32| 10 * arm;
    let mut paths: Vec<Vec<Place>> = (0..arms).map(|arm| vec![[at(arm), 0, 0]]).collect();
    let count = fingers.len() as i32;
    for (number, &(from, to)) in (0..).zip(fingers) {
        let (ahead, x, end) = ((to - from).signum(), at(from), at(to));
        let (low, high, near) = (2 + 2 * number, 3 + 2 * count + number, -2 - 2 * number);
        let far = near - 1;
        paths[from as usize].extend([
            [x, 0, low],
            [x, far, low],
            [x + 2 * ahead, far, low],
            [x + 2 * ahead, far, high],
            [end + ahead, far, high],
            [end + ahead, 1, high],
            [end - ahead, 1, high],
            [end - ahead, near, high],
            [x + 3 * ahead, near, high],
            [x + 3 * ahead, near, low + 1],
            [x, near, low + 1],
            [x, 0, low + 1],
        ]);
    }
    paths.iter_mut().zip(0..).for_each(|(path, arm)| path.push([at(arm), 0, 4 + 3 * count]));
    paths.push(vec![[at(0), 0, 0], [at(arms - 1), 0, 0]]);
    paths
}

/// Four arms that rise from a common point, each with a finger round the next.
pub fn knotted_x() -> Vec<Vec<Place>> {
    let mut paths: Vec<_> = (0..4).map(|corner| arm(corner, (corner + 1) % 4)).collect();
    paths.push(vec![[2, 2, 0], [12, 2, 0], [12, 12, 0], [2, 12, 0]]);
    paths
}

/// Heights at which fingers leave their arms, and go round the next; the top of the arms.
const LOW: i32 = 2;
const HIGH: i32 = 6;
const TOP: i32 = 8;

/// An arm over a corner of a square, with a finger round the next corner: it leaves the arm low, rises, goes there on the right,
/// round the corner and back on the left.
fn arm(corner: usize, next: usize) -> Vec<Place> {
    let corners: [[i32; 2]; 4] = [[2, 2], [12, 2], [12, 12], [2, 12]];
    let (at, to) = (corners[corner % 4], corners[next % 4]);
    let ahead = [0, 1].map(|axis: usize| (to[axis] - at[axis]).signum());
    let right = [ahead[1], -ahead[0]];
    let place = |from: [i32; 2], forward: i32, aside: i32, height: i32| {
        [from[0] + forward * ahead[0] + aside * right[0], from[1] + forward * ahead[1] + aside * right[1], height]
    };
    vec![
        place(at, 0, 0, 0),
        place(at, 0, 0, LOW),
        place(at, 0, 1, LOW),
        place(at, 2, 1, LOW),
        place(at, 2, 1, HIGH),
        place(to, 1, 1, HIGH),
        place(to, 1, -1, HIGH),
        place(at, 2, -1, HIGH),
        place(at, 2, -1, LOW),
        place(at, 0, -1, LOW),
        place(at, 0, -1, LOW + 1),
        place(at, 0, 0, LOW + 1),
        place(at, 0, 0, TOP),
    ]
}
