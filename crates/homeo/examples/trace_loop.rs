#![allow(warnings)]
use std::hint::black_box;
use std::time::Instant;

use homeo::construct::foliation::{FoliationInfo, FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Bijection, Foliation, Target};
use homeo::progress::Silent;
use homeo_core::mesh::{CellId, SimplicialComplex, VertexId};
use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient3d};
use homeo_core::spatial::{Aabb, Tree};

fn main() {
    let a: Vec<String> = std::env::args().collect();
    let source = generated(&a[1], a[2].parse().unwrap());
    let target: Target = a[3].parse().unwrap();
    let mode = a[4].as_str();
    let (map, info) = build(&source, target, &FoliationParams::default(), &Silent).unwrap();
    println!("{:?}", info.seconds);
    let mut random = Random(7);
    let count = a[5].parse().unwrap();
    let points: Vec<[f64; 3]> = (0..count).map(|_| random_point(map.source(), &mut random)).collect();
    let crossed: usize = points[..300].iter().filter_map(|p| map.leaf_cells(&p.map(|x| Rational::from_f64(x).unwrap())).ok()).sum();
    let per = crossed as f64 / 300.0;
    let map = if mode.ends_with("inf") { map.with_accuracy(f64::INFINITY) } else { map };
    let run = |name: &str, work: &dyn Fn()| {
        for _ in 0..3 {
            let clock = Instant::now();
            work();
            let t = clock.elapsed().as_secs_f64();
            println!("{name} {:.2} Mc/s {:.1} ns/cell {:.2} us/point", per * count as f64 / t / 1e6, t * 1e9 / (per * count as f64), t * 1e6 / count as f64);
        }
    };
    if mode.starts_with("fwd") { run("fwd", &|| points.iter().for_each(|&p| drop(black_box(map.forward(p))))); }
    if mode.starts_with("batch") { run("batch", &|| drop(black_box(map.forward_batch(&points)))); }
    if mode.starts_with("hash") {
        let mut h = 0u64;
        let mut mix = |x: f64| h = h.rotate_left(5).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ x.to_bits();
        for &p in &points {
            let q = map.forward(p).unwrap();
            q.point.iter().for_each(|&x| mix(x));
            mix(q.radius);
            let b = map.inverse(q.point).unwrap();
            b.point.iter().for_each(|&x| mix(x));
            mix(b.radius);
        }
        println!("hash {h:016x}");
    }
    if mode.starts_with("inv") {
        let images: Vec<[f64; 3]> = points.iter().map(|&p| map.forward(p).unwrap().point).collect();
        run("inv", &|| images.iter().for_each(|&p| drop(black_box(map.inverse(p)))));
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    fn below(&mut self, bound: u64) -> u64 {
        self.bits() % bound
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn random_point(source: &SourceMesh<4>, random: &mut Random) -> [f64; 3] {
    let cell = source.complex().cell(CellId::new(random.below(source.complex().cell_count() as u64) as usize));
    let weights = [0; 4].map(|_| 0.05 + random.unit());
    let sum: f64 = weights.iter().sum();
    std::array::from_fn(|axis| (0..4).map(|k| weights[k] / sum * source.positions()[cell[k].index()][axis]).sum())
}

fn mesh(positions: Vec<[f64; 3]>, cells: &[[u32; 4]]) -> SourceMesh<4> {
    let is_positive = |cell: &[u32; 4]| {
        let [a, b, c, d] = cell.map(|v| positions[v as usize]);
        orient3d(a, b, c, d) == Sign::Positive
    };
    assert!(cells.iter().all(is_positive), "a tetrahedron is not positively oriented");
    let complex = SimplicialComplex::from_indices(positions.len(), cells).expect("indices below the vertex count");
    SourceMesh::new(positions, complex)
}

/// A cube of `size` cubed cubes of six tetrahedra, its inner vertices moved at random; `bumpy` bends it all,
/// `shuffled` numbers vertices and cells at random.
fn generated(shape: &str, size: usize) -> SourceMesh<4> {
    let mut random = Random(11);
    let (mut positions, mut cells) = jittered_cube(size, &mut random);
    if shape == "bumpy" {
        positions.iter_mut().for_each(|p| *p = bent(p.map(|x| x / size as f64)));
    }
    if shape == "shuffled" {
        shuffle(&mut positions, &mut cells, &mut random);
    }
    mesh(positions, &cells)
}

fn jittered_cube(size: usize, random: &mut Random) -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
    let side = size + 1;
    let mut positions = Vec::with_capacity(side * side * side);
    for k in 0..side * side * side {
        let p = [k % side, k / side % side, k / side / side];
        let is_inside = p.iter().all(|&x| x > 0 && x < size);
        let jitter = if is_inside { 0.2 } else { 0.0 };
        positions.push(p.map(|x| x as f64 + jitter * (random.unit() - 0.5)));
    }
    let steps = [1, side as u32, (side * side) as u32];
    let mut cells = Vec::with_capacity(6 * size * size * size);
    for k in 0..size * size * size {
        let corner = [k % size, k / size % size, k / size / size];
        let low = corner[0] as u32 + corner[1] as u32 * steps[1] + corner[2] as u32 * steps[2];
        let high = low + steps[0] + steps[1] + steps[2];
        for [a, b, c] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            let (one, two, three) = (low + steps[a], low + steps[a] + steps[b], low + steps[a] + steps[c]);
            cells.extend([[low, one, two, high], [low, three, one, high]]);
        }
    }
    (positions, cells)
}

/// A cube becomes a body with waves and a waist.
fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    let waist = 1.0 - 0.5 * (-20.0 * (z - 0.5) * (z - 0.5)).exp();
    let (u, v) = ((x - 0.5) * waist, (y - 0.5) * waist);
    [u + 0.08 * (6.0 * z).sin(), v + 0.06 * (9.0 * z).cos(), 1.5 * z + 0.05 * (7.0 * x).sin() + 0.04 * (8.0 * y).cos()]
}

fn shuffle(positions: &mut [[f64; 3]], cells: &mut [[u32; 4]], random: &mut Random) {
    let mut number: Vec<u32> = (0..positions.len() as u32).collect();
    (1..number.len()).rev().for_each(|i| number.swap(i, random.below(i as u64 + 1) as usize));
    let before = positions.to_vec();
    number.iter().zip(before).for_each(|(&to, p)| positions[to as usize] = p);
    (1..cells.len()).rev().for_each(|i| cells.swap(i, random.below(i as u64 + 1) as usize));
    cells.iter_mut().for_each(|cell| *cell = cell.map(|v| number[v as usize]));
}
