//! Tetrahedral balls.

use super::disks;
use super::{Shape, permutations};
use crate::random::Random;

type Ball = Shape<4>;

pub fn tetrahedron() -> Ball {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Ball { positions, cells: vec![[0, 1, 2, 3]] }
}

pub fn two_tetrahedra() -> Ball {
    let mut ball = tetrahedron();
    ball.positions.push([1.0, 1.0, 1.0]);
    ball.cells.push([1, 2, 3, 4]);
    ball
}

fn cube_corners() -> Vec<[f64; 3]> {
    (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect()
}

/// A cube of five tetrahedra.
pub fn cube_of_five() -> Ball {
    let cells = vec![[0, 1, 2, 4], [3, 1, 2, 7], [5, 1, 4, 7], [6, 2, 4, 7], [1, 2, 4, 7]];
    Ball { positions: cube_corners(), cells }
}

/// Cubes of six tetrahedra each, where `keep` says so.
pub fn kuhn_where(size: [usize; 3], keep: impl Fn([usize; 3]) -> bool) -> Ball {
    let id = |p: [usize; 3]| ((p[2] * (size[1] + 1) + p[1]) * (size[0] + 1) + p[0]) as u32;
    let points = |size: [usize; 3]| {
        (0..size[2]).flat_map(move |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])))
    };
    let positions = points(size.map(|n| n + 1)).map(|p| p.map(|x| x as f64)).collect();
    let mut cells = Vec::new();
    for cube in points(size).filter(|&p| keep(p)) {
        for order in permutations::<3>() {
            let mut corner = cube;
            let mut cell = [id(cube); 4];
            for (k, axis) in order.into_iter().enumerate() {
                corner[axis] += 1;
                cell[k + 1] = id(corner);
            }
            cells.push(cell);
        }
    }
    Ball { positions, cells }.compacted()
}

pub fn kuhn(x: usize, y: usize, z: usize) -> Ball {
    kuhn_where([x, y, z], |_| true)
}

/// The interior vertices of a box of unit cubes moved at random.
pub fn jittered(size: usize, seed: u64) -> Ball {
    let mut ball = kuhn(size, size, size);
    let mut random = Random::new(seed);
    for p in &mut ball.positions {
        if p.iter().all(|&x| x > 0.0 && x < size as f64) {
            *p = p.map(|x| x + 0.3 * (random.unit() - 0.5));
        }
    }
    ball
}

/// Four tetrahedra round an edge.
pub fn octahedron_with_axis() -> Ball {
    let mut ball = octahedron(0.0);
    ball.positions.truncate(6);
    ball.cells = (0..4).map(|k| [k, (k + 1) % 4, 4, 5]).collect();
    ball
}

/// Eight tetrahedra round a vertex at the given height below the upper tip at 1.
pub fn octahedron(height: f64) -> Ball {
    let positions = vec![
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [0.0, 0.0, height],
    ];
    let cells = (0..4).flat_map(|k| [[k, (k + 1) % 4, 4, 6], [k, (k + 1) % 4, 5, 6]]).collect();
    Ball { positions, cells }
}

/// A cone over a bumpy sphere: all cells meet in one vertex.
pub fn cone(refinements: usize) -> Ball {
    let mut ball = octahedron(0.0);
    for _ in 0..refinements {
        ball = quartered(&ball);
    }
    ball.moved(|p| {
        let size = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        let radius = 1.0 + 0.3 * (5.0 * p[0]).sin() * (4.0 * p[2]).cos();
        if size > 0.0 { p.map(|x| x / size * radius) } else { p }
    })
}

/// Each outer triangle of a cone over vertex 6 cut into four.
fn quartered(ball: &Ball) -> Ball {
    let mut positions = ball.positions.clone();
    let mut middles = std::collections::BTreeMap::new();
    let mut cells = Vec::new();
    for cell in &ball.cells {
        let [a, b, c] = [cell[0], cell[1], cell[2]];
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let [p, q] = [a, b].map(|v| ball.positions[v as usize]);
                positions.push([0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2.0));
                positions.len() as u32 - 1
            })
        };
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        cells.extend([[a, ab, ca, 6], [b, bc, ab, 6], [c, ca, bc, 6], [ab, bc, ca, 6]]);
    }
    Ball { positions, cells }
}

/// A thin bar.
pub fn bar(length: usize) -> Ball {
    kuhn(length, 1, 1)
}

pub fn l_shape(size: usize) -> Ball {
    kuhn_where([size, size, 2], |p| p[0] < 2 || p[1] < 2)
}

/// A ring with a slit: nearly a solid torus.
pub fn horseshoe(size: usize) -> Ball {
    kuhn_where([size, size, 1], |p| {
        let on_rim = p[0] == 0 || p[1] == 0 || p[0] == size - 1 || p[1] == size - 1;
        on_rim && !(p[0] == size - 1 && p[1] == size / 2)
    })
}

/// Two boxes joined by a bar one cube wide.
pub fn dumbbell(size: usize) -> Ball {
    kuhn_where([3 * size, size, size], |p| !(size..2 * size).contains(&p[0]) || (p[1] == 1 && p[2] == 1))
}

/// A tetrahedron on every boundary triangle.
pub fn with_ears(mut ball: Ball, height: f64) -> Ball {
    let mut sides = std::collections::BTreeMap::new();
    for cell in &ball.cells {
        for i in 0..4 {
            let mut facet: Vec<u32> = (0..4).filter(|&k| k != i).map(|k| cell[k]).collect();
            facet.sort_unstable();
            sides.entry(facet).or_insert_with(Vec::new).push(cell[i]);
        }
    }
    for (facet, inside) in sides.iter().filter(|(_, inside)| inside.len() == 1) {
        let corners: Vec<[f64; 3]> = facet.iter().map(|&v| ball.positions[v as usize]).collect();
        let within = ball.positions[inside[0] as usize];
        let apex = [0, 1, 2].map(|axis| {
            let centre = (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3.0;
            centre + height * (centre - within[axis])
        });
        ball.positions.push(apex);
        ball.cells.push([facet[0], facet[1], facet[2], ball.positions.len() as u32 - 1]);
    }
    ball
}

/// A prism over a disk, three tetrahedra for each triangle.
pub fn prism(disk: &Shape<3>) -> Ball {
    let n = disk.positions.len() as u32;
    let mut positions = disk.positions.clone();
    positions.extend(disk.positions.iter().map(|p| [p[0], p[1], p[2] + 1.0]));
    let mut cells = Vec::new();
    for cell in &disk.cells {
        // Cut from the lowest vertex up, so that neighbours agree.
        let mut v = *cell;
        v.sort_unstable();
        cells.extend([
            [v[0], v[1], v[2], v[2] + n],
            [v[0], v[1], v[1] + n, v[2] + n],
            [v[0], v[0] + n, v[1] + n, v[2] + n],
        ]);
    }
    Ball { positions, cells }
}

/// A prism over a polygon cut along chords: chords and spanning facets everywhere.
pub fn chord_prism(count: usize, seed: u64) -> Ball {
    prism(&disks::chords(count, seed))
}

/// A tetrahedron split at random points of cells.
pub fn random_splits(steps: usize, seed: u64) -> Ball {
    let mut random = Random::new(seed);
    let mut ball = tetrahedron();
    for _ in 0..steps {
        let at = random.below(ball.cells.len() as u64) as usize;
        let cell = ball.cells[at];
        let weights = [0; 4].map(|_| 0.2 + random.unit());
        let sum: f64 = weights.iter().sum();
        let point =
            std::array::from_fn(|axis| (0..4).map(|i| weights[i] / sum * ball.positions[cell[i] as usize][axis]).sum());
        ball.positions.push(point);
        let new = ball.positions.len() as u32 - 1;
        for i in 0..4 {
            let mut part = cell;
            part[i] = new;
            if i == 0 { ball.cells[at] = part } else { ball.cells.push(part) }
        }
    }
    ball
}
