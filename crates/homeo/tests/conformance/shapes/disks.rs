//! Triangulated disks.

use std::f64::consts::TAU;

use homeo_core::predicate::{Sign, orient2d};

use super::Shape;
use crate::random::Random;

type Disk = Shape<3>;

pub fn triangle() -> Disk {
    Disk { positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.25, 1.0, 0.0]], cells: vec![[0, 1, 2]] }
}

pub fn two_triangles() -> Disk {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    Disk { positions, cells: vec![[0, 1, 2], [0, 2, 3]] }
}

fn rim(count: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |k| {
        let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
        [cos, sin, 0.0]
    })
}

/// Triangles all round a vertex.
pub fn fan(count: usize) -> Disk {
    let mut positions = vec![[0.0; 3]];
    positions.extend(rim(count));
    let n = count as u32;
    Disk { positions, cells: (0..n).map(|k| [0, 1 + k, 1 + (k + 1) % n]).collect() }
}

/// Triangles halfway round a vertex of the boundary.
pub fn half_fan(count: usize) -> Disk {
    let mut positions = vec![[0.0; 3]];
    positions.extend(rim(2 * count).take(count + 1));
    Disk { positions, cells: (0..count as u32).map(|k| [0, 1 + k, 2 + k]).collect() }
}

/// A band of triangles, all of whose vertices lie on the boundary.
pub fn strip(count: usize) -> Disk {
    let positions = (0..count + 2).map(|k| [k as f64 / 2.0, (k % 2) as f64, 0.0]).collect();
    let cells = (0..count as u32).map(|k| if k % 2 == 0 { [k, k + 2, k + 1] } else { [k, k + 1, k + 2] }).collect();
    Disk { positions, cells }
}

/// A convex polygon cut along chords at random: no interior vertex at all.
pub fn chords(count: usize, seed: u64) -> Disk {
    let mut random = Random::new(seed);
    let mut left: Vec<u32> = (0..count as u32).collect();
    let mut cells = Vec::new();
    while left.len() > 2 {
        let at = random.below(left.len() as u64) as usize;
        let around = |step: usize| left[(at + left.len() + step - 1) % left.len()];
        cells.push([around(0), around(1), around(2)]);
        left.remove(at);
    }
    Disk { positions: rim(count).collect(), cells }
}

/// The same disk with a triangle on every boundary edge.
pub fn with_ears(mut disk: Disk, height: f64) -> Disk {
    let edges: Vec<[u32; 2]> = disk.cells.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let boundary = edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a]));
    for &[a, b] in boundary {
        let [p, q] = [a, b].map(|v| disk.positions[v as usize]);
        let out = [(q[1] - p[1]) * height, (p[0] - q[0]) * height];
        disk.positions.push([(p[0] + q[0]) / 2.0 + out[0], (p[1] + q[1]) / 2.0 + out[1], (p[2] + q[2]) / 2.0]);
        disk.cells.push([b, a, disk.positions.len() as u32 - 1]);
    }
    disk
}

/// Squares cut in two, diagonals in turn, where `keep` says so.
pub fn grid_where(width: usize, height: usize, keep: impl Fn(usize, usize) -> bool) -> Disk {
    let id = |x: usize, y: usize| (y * (width + 1) + x) as u32;
    let positions = (0..=height).flat_map(|y| (0..=width).map(move |x| [x as f64, y as f64, 0.0])).collect();
    let mut cells = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| keep(x, y)) {
        let [a, b, c, d] = [id(x, y), id(x + 1, y), id(x + 1, y + 1), id(x, y + 1)];
        cells.extend(if (x + y) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    Disk { positions, cells }.compacted()
}

pub fn grid(width: usize, height: usize) -> Disk {
    grid_where(width, height, |_, _| true)
}

/// A corner.
pub fn l_shape(size: usize) -> Disk {
    grid_where(size, size, |x, y| x < size / 3 || y < size / 3)
}

/// A comb: dead ends one square wide.
pub fn comb(teeth: usize) -> Disk {
    grid_where(2 * teeth - 1, 5, |x, y| y == 0 || x % 2 == 0)
}

/// A band two squares wide, wound up in the plane.
pub fn spiral(length: usize) -> Disk {
    grid(length, 2).moved(|[x, y, _]| {
        let angle = x * 0.35;
        let radius = 2.0 + 0.6 * angle + y;
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    })
}

/// A surface in space.
pub fn bumpy(size: usize) -> Disk {
    grid(size, size).moved(|[x, y, _]| [x, y, (1.3 * x).sin() * (0.9 * y).cos() + 0.1 * x * y])
}

/// A surface folded flat like a fan of paper, nearly onto itself.
pub fn folded(size: usize) -> Disk {
    grid(size, size).moved(|[x, y, _]| [x / 8.0, y, if (x as usize).is_multiple_of(2) { 0.0 } else { 3.0 }])
}

/// A triangle split and flipped at random, in the plane.
pub fn random_splits(steps: usize, seed: u64) -> Disk {
    let mut random = Random::new(seed);
    let mut disk = Disk { positions: vec![[0.0; 3], [8.0, 0.0, 0.0], [3.0, 7.0, 0.0]], cells: vec![[0, 1, 2]] };
    for _ in 0..steps {
        split_somewhere(&mut disk, &mut random);
        for _ in 0..3 {
            flip_somewhere(&mut disk, &mut random);
        }
    }
    disk
}

fn is_positive(disk: &Disk, cell: [u32; 3]) -> bool {
    let [a, b, c] = cell.map(|v| [disk.positions[v as usize][0], disk.positions[v as usize][1]]);
    orient2d(a, b, c) == Sign::Positive
}

fn split_somewhere(disk: &mut Disk, random: &mut Random) {
    let at = random.below(disk.cells.len() as u64) as usize;
    let [a, b, c] = disk.cells[at];
    let weights = [0; 3].map(|_| 0.1 + random.unit());
    let sum: f64 = weights.iter().sum();
    let point = std::array::from_fn(|axis| {
        (0..3).map(|i| weights[i] / sum * disk.positions[disk.cells[at][i] as usize][axis]).sum()
    });
    disk.positions.push(point);
    let new = disk.positions.len() as u32 - 1;
    let parts = [[a, b, new], [b, c, new], [c, a, new]];
    if parts.iter().all(|&part| is_positive(disk, part)) {
        disk.cells[at] = parts[0];
        disk.cells.extend([parts[1], parts[2]]);
    } else {
        disk.positions.pop();
    }
}

fn flip_somewhere(disk: &mut Disk, random: &mut Random) {
    let at = random.below(disk.cells.len() as u64) as usize;
    let mut here = disk.cells[at];
    here.rotate_left(random.below(3) as usize);
    let [a, b, c] = here;
    let Some(other) = disk.cells.iter().position(|cell| (0..3).any(|i| cell[i] == b && cell[(i + 1) % 3] == a)) else {
        return;
    };
    let d = disk.cells[other].into_iter().find(|v| ![a, b].contains(v)).expect("a triangle has a third corner");
    let flipped = [[c, a, d], [d, b, c]];
    if flipped.iter().all(|&cell| is_positive(disk, cell)) {
        [disk.cells[at], disk.cells[other]] = flipped;
    }
}
