//! Builds a map and tries it: `try_map MESH TARGET [POINTS]`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::time::Instant;

use homeo::certificate::{FoliationMap, Provenance, read_map, write_map};
use homeo::construct::foliation::{FoliationParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Bijection, Foliation, Target};
use homeo::progress::Silent;
use homeo_core::mesh::{SimplicialComplex, VertexId};
use homeo_core::number::Rational;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let clock = Instant::now();
    let file = homeo_core::io::read_mesh(arguments[1].as_ref()).expect("readable");
    let target: Target = arguments[2].parse().expect("a target");
    let points: usize = arguments.get(3).map_or(100, |n| n.parse().expect("a number"));
    println!("read {:.3}", clock.elapsed().as_secs_f64());
    if file.tetrahedra.is_empty() {
        let cells: Vec<[u32; 3]> =
            (0..file.polygons.len()).map(|p| file.polygons.polygon(p).try_into().expect("triangles")).collect();
        try_map::<3>(file.positions, &cells, target, points);
    } else {
        try_map::<4>(file.positions, &file.tetrahedra, target, points);
    }
}

fn try_map<const K: usize>(positions: Vec<[f64; 3]>, cells: &[[u32; K]], target: Target, points: usize)
where
    FoliationMap: From<Foliation<K>>,
{
    let complex = SimplicialComplex::<K>::from_indices(positions.len(), cells).expect("indices");
    let source = SourceMesh::new(positions, complex);
    let clock = Instant::now();
    let params = FoliationParams {
        refinements: std::env::var("REF").map_or(6, |r| r.parse().unwrap()),
        ..FoliationParams::default()
    };
    let (map, info) = match build(&source, target, &params, &Silent) {
        Ok(built) => built,
        Err(error) => {
            println!("FAILED {error}");
            return;
        }
    };
    let map = map.with_accuracy(std::env::var("ACC").map_or(1e-8, |a| a.parse().unwrap()));
    println!("built {:.3} {info:?}", clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let mut worst_float = 0.0f64;
    let mut worst_inverse = 0.0f64;
    let (mut cells_crossed, mut float_time, mut exact_time, mut inverse_time) = (0, 0.0, 0.0, 0.0);
    let mut seed = 12345u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as i64
    };
    let mut worst_round = 0.0f64;
    let mut trips = Vec::new();
    for _ in 0..points {
        let cell =
            source.complex().cell(homeo_core::mesh::CellId::new(random() as usize % source.complex().cell_count()));
        let weights: [i64; K] = std::array::from_fn(|_| random() % 1000);
        let sum = Rational::from(weights.iter().sum::<i64>().max(1));
        let p: [Rational; 3] = std::array::from_fn(|axis| {
            let total: Rational = (0..K)
                .map(|k| {
                    &Rational::from(weights[k])
                        * &Rational::from_f64(source.positions()[cell[k].index()][axis]).unwrap()
                })
                .sum();
            &total / &sum
        });
        let t = Instant::now();
        let q = map.forward_exact(&p).expect("inside");
        exact_time += t.elapsed().as_secs_f64();
        cells_crossed += map.leaf_cells(&p).unwrap();
        let t = Instant::now();
        let back = map.inverse_exact(&q).expect("in target");
        inverse_time += t.elapsed().as_secs_f64();
        assert!(back == p, "round trip failed at {:?}", p.each_ref().map(|x| x.to_f64()));
        let near = p.each_ref().map(|x| x.to_f64());
        let t = Instant::now();
        let float = map.forward(near).expect("inside");
        float_time += t.elapsed().as_secs_f64();
        worst_float = worst_float.max(float.radius);
        if !target.is_radial() {
            let off = (0..3).map(|a| (float.point[a] - q[a].to_f64()).abs()).fold(0.0, f64::max);
            worst_inverse = worst_inverse.max(off);
        }
        match map.inverse(float.point) {
            Ok(there) => {
                let off = (0..3).map(|a| (there.point[a] - near[a]).abs()).fold(0.0, f64::max);
                worst_round = worst_round.max(off);
                trips.push(off);
            }
            Err(error) => println!("inverse: {error} at {:?}", float.point),
        }
    }
    trips.sort_by(f64::total_cmp);
    if let Ok(n) = std::env::var("BATCH") {
        let n: usize = n.parse().unwrap();
        let pts: Vec<[f64; 3]> = (0..n).map(|_| { let cell = source.complex().cell(homeo_core::mesh::CellId::new(random() as usize % source.complex().cell_count())); let w: [f64; K] = std::array::from_fn(|_| random() as f64 + 1.0); let sum: f64 = w.iter().sum(); std::array::from_fn(|a| (0..K).map(|k| w[k] / sum * source.positions()[cell[k].index()][a]).sum()) }).collect();
        let t = Instant::now();
        let images: Vec<_> = pts.iter().map(|&p| map.forward(p).unwrap()).collect();
        let s = t.elapsed().as_secs_f64();
        let mut radii: Vec<f64> = images.iter().map(|i| i.radius).collect();
        radii.sort_by(f64::total_cmp);
        println!("radius 10% {:.1e} 50% {:.1e} 90% {:.1e} 99% {:.1e}", radii[n / 10], radii[n / 2], radii[n * 9 / 10], radii[n * 99 / 100]);
        let exact = images.iter().filter(|i| i.radius < 1e-15 && i.radius > 0.0).count();
        println!("batch {n}: {:.2} us/point, {:.1} ns/cell, exact fallbacks about {exact}", s * 1e6 / n as f64, s * 1e9 / n as f64 / (cells_crossed as f64 / points as f64));
    }
    let _ = VertexId::new(0);
    println!(
        "points {points} {:.3}s cells/leaf {:.1} exact fwd {:.2} us/cell inv {:.2} us/cell float {:.1} ns/cell; radius {worst_float:.1e} off {worst_inverse:.1e}; trip median {:.1e} worst {worst_round:.1e}",
        clock.elapsed().as_secs_f64(),
        cells_crossed as f64 / points as f64,
        exact_time * 1e6 / cells_crossed as f64,
        inverse_time * 1e6 / cells_crossed as f64,
        float_time * 1e9 / cells_crossed as f64,
        trips[trips.len() / 2],
    );
    if let Ok(path) = std::env::var("OUT") {
        let mut file = std::io::BufWriter::new(std::fs::File::create(&path).expect("writable"));
        write_map(&FoliationMap::from(map), &Provenance::default(), &mut file).expect("writable");
        drop(file);
        let clock = Instant::now();
        let again = read_map(&std::fs::read(&path).expect("readable")).expect("a map");
        if let Ok(html) = std::env::var("HTML") {
            let clock = Instant::now();
            let data = homeo::export::report_of_map(&again, &path, "a try", Default::default());
            println!("images {:.3}s", clock.elapsed().as_secs_f64());
            let mut sorted = data.distortion.clone();
            sorted.sort_by(f64::total_cmp);
            println!(
                "distortion median {:.2} 90% {:.2} 99% {:.2e} max {:.2e}",
                sorted[sorted.len() / 2],
                sorted[sorted.len() * 9 / 10],
                sorted[sorted.len() * 99 / 100],
                sorted[sorted.len() - 1]
            );
            homeo::export::write_report(&data, &mut std::fs::File::create(html).expect("writable")).expect("report");
        }
        println!("read back {:.3}s {}", clock.elapsed().as_secs_f64(), again.target());
    }
}
