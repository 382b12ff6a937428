//! Speed of construction and evaluation of foliations: `cargo bench -p homeo --bench foliation`.
//!
//! Words after `--`: a name of a shape (`jittered`, `bumpy`, `shuffled`), a size (`1k` to `5m`), a target (`cube`,
//! `ball`); what is left out is tried in all its values, but for 5 million tetrahedra, which must be asked for.
//! `HOMEO_BENCH_MESH=FILE` measures a file instead of generated shapes. Threads: as `RAYON_NUM_THREADS` says;
//! the figures of `docs/performance.md` are for one.
#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
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
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_asked = |choices: &[&str], name: &str| {
        words.iter().any(|w| w == name) || !words.iter().any(|w| choices.contains(&w.as_str()))
    };
    println!("threads {}", rayon::current_num_threads());
    let targets: Vec<Target> =
        [Target::Cube, Target::Ball].into_iter().filter(|t| is_asked(&["cube", "ball"], t.name())).collect();
    println!("{}", HEADINGS.map(|(name, width)| format!("{name:>width$}")).join(" "));
    if let Ok(path) = std::env::var("HOMEO_BENCH_MESH") {
        let file = homeo_core::io::read_mesh(path.as_ref()).expect("a readable mesh");
        let source = mesh(file.positions, &file.tetrahedra);
        targets.iter().for_each(|&target| measure("file", &source, target));
        return memory_floor();
    }
    let mut sizes = vec![("1k", 6), ("10k", 12), ("100k", 26), ("1m", 55)];
    if words.iter().any(|w| w == "5m") {
        sizes.push(("5m", 94));
    }
    for (size, cubes) in sizes.into_iter().filter(|(name, _)| is_asked(&["1k", "10k", "100k", "1m", "5m"], name)) {
        for shape in SHAPES.into_iter().filter(|name| is_asked(&SHAPES, name)) {
            let source = generated(shape, cubes);
            targets.iter().for_each(|&target| measure(&format!("{shape} {size}"), &source, target));
        }
    }
    memory_floor();
}

const SHAPES: [&str; 3] = ["jittered", "bumpy", "shuffled"];

/// Columns of the table. Mt: a million tetrahedra, Mc: a million cells crossed. Rates are per second.
/// Busy: the share of the time in which a processor worked for us; well below 100 others disturbed.
const HEADINGS: [(&str, usize); 18] = [
    ("mesh", 14),
    ("target", 6),
    ("cells", 8),
    ("prepare Mt", 10),
    ("harm. Mt", 8),
    ("order Mt", 8),
    ("direct. Mt", 10),
    ("shell Mt", 8),
    ("sweep Mt", 8),
    ("build s", 7),
    ("cells/leaf", 10),
    ("fast Mc", 8),
    ("batch Mc", 8),
    ("loose Mc", 8),
    ("exact kc", 8),
    ("tree us", 7),
    ("peak MB", 7),
    ("busy %", 6),
];

fn measure(name: &str, source: &SourceMesh<4>, target: Target) {
    let params = FoliationParams::default();
    let begin = (Instant::now(), processor_seconds());
    // Small meshes several times: the best of each stage counts.
    let repetitions = (300_000 / source.complex().cell_count()).clamp(1, 20);
    let mut best = BTreeMap::new();
    let mut last = None;
    for _ in 0..repetitions {
        drop(last.take());
        let clock = Instant::now();
        let (map, mut info) = match build(source, target, &params, &Silent) {
            Ok(built) => built,
            Err(error) => return println!("{name:>14} {target:>6} {error}"),
        };
        info.seconds.push(("build", clock.elapsed().as_secs_f64()));
        let mut stages: BTreeMap<&str, f64> = BTreeMap::new();
        info.seconds.iter().for_each(|(stage, seconds)| *stages.entry(stage).or_default() += seconds);
        stages.into_iter().for_each(|(stage, s)| {
            best.entry(stage).and_modify(|least: &mut f64| *least = least.min(s)).or_insert(s);
        });
        last = Some((map, info));
    }
    let Some((map, info)) = last else { return };
    let rate = |stages: &[&str], sweeps: usize| {
        let spent: f64 = stages.iter().filter_map(|stage| best.get(stage)).sum();
        (sweeps * info.cells) as f64 / spent / 1e6
    };
    let tracing = trace(map);
    let tree = tree_query(source);
    let busy = (processor_seconds() - begin.1) / begin.0.elapsed().as_secs_f64();
    let columns = [
        name.to_owned(),
        target.name().to_owned(),
        info.cells.to_string(),
        format!("{:.2}", rate(&["prepare"], 1)),
        format!("{:.2}", rate(&["harmonic"], 1)),
        format!("{:.2}", rate(&["order"], 1)),
        format!("{:.2}", rate(&["directions"], 1)),
        format!("{:.2}", rate(&["order", "directions"], 1)),
        format!("{:.2}", rate(&["smooth"], params.smoothing_sweeps)),
        format!("{:.3}", best["build"]),
        format!("{:.1}", tracing.cells_per_leaf),
        format!("{:.2}", tracing.fast),
        format!("{:.2}", tracing.batch),
        format!("{:.2}", tracing.loose),
        format!("{:.0}", tracing.exact),
        format!("{tree:.2}"),
        format!("{:.0}", peak_megabytes()),
        format!("{:.0}", 100.0 * busy),
    ];
    println!(
        "{}",
        columns.iter().zip(HEADINGS).map(|(c, (_, width))| format!("{c:>width$}")).collect::<Vec<_>>().join(" ")
    );
    explain(&info);
}

/// Seconds that processors have spent on this process.
fn processor_seconds() -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds = tasks.filter_map(|task| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    nanoseconds.sum::<f64>() / 1e9
}

/// Seconds of the fastest of three runs.
fn fastest(work: impl Fn()) -> f64 {
    let run = |_| {
        let clock = Instant::now();
        work();
        clock.elapsed().as_secs_f64()
    };
    (0..3).map(run).fold(f64::INFINITY, f64::min)
}

/// What a reader of the table should know when a build was not straightforward.
fn explain(info: &FoliationInfo) {
    if info.restarts + info.local_refinements + info.barycentric_refinements > 0 {
        println!(
            "{:>14} {} restarts, {} local and {} barycentric refinements",
            "", info.restarts, info.local_refinements, info.barycentric_refinements
        );
    }
    if std::env::var_os("HOMEO_BENCH_STAGES").is_some() {
        println!("{:>14} {:?}", "", info.seconds);
    }
}

struct Tracing {
    cells_per_leaf: f64,
    /// Million cells per second, one point after the other.
    fast: f64,
    /// The same in a batch.
    batch: f64,
    /// The same with any accuracy: exact only where a branch is undecided.
    loose: f64,
    /// Thousand cells per second in exact arithmetic.
    exact: f64,
}

/// Follows leaves through random points of cells. Times include locating the points.
fn trace(map: Foliation<4>) -> Tracing {
    let mut random = Random(7);
    let mut points: Vec<[f64; 3]> = (0..20_000).map(|_| random_point(map.source(), &mut random)).collect();
    // Counted exactly, on a part of them.
    let exact: Vec<[Rational; 3]> =
        points[..300].iter().map(|p| p.map(|x| Rational::from_f64(x).expect("finite"))).collect();
    let crossed: usize = exact.iter().filter_map(|p| map.leaf_cells(p).ok()).sum();
    let cells_per_leaf = crossed as f64 / exact.len() as f64;
    // Fewer points where leaves are long.
    points.truncate((2e6 / cells_per_leaf).max(1000.0) as usize);
    let count = points.len();
    let exact_seconds = fastest(|| exact.iter().for_each(|p| drop(black_box(map.forward_exact(p)))));
    let fast_seconds = fastest(|| points.iter().for_each(|&p| drop(black_box(map.forward(p)))));
    let batch_seconds = fastest(|| drop(black_box(map.forward_batch(&points))));
    let map = map.with_accuracy(f64::INFINITY);
    let loose_seconds = fastest(|| drop(black_box(map.forward_batch(&points))));
    let rate = |seconds: f64| cells_per_leaf * count as f64 / seconds / 1e6;
    Tracing {
        cells_per_leaf,
        fast: rate(fast_seconds),
        batch: rate(batch_seconds),
        loose: rate(loose_seconds),
        exact: crossed as f64 / exact_seconds / 1e3,
    }
}

/// Microseconds per point query of a tree over the cells, the time of finding candidates for a point.
fn tree_query(source: &SourceMesh<4>) -> f64 {
    let corner = |v: VertexId| source.positions()[v.index()];
    let boxes: Vec<Aabb> = source.complex().cells().iter().map(|cell| Aabb::of(&cell.map(corner))).collect();
    let tree = Tree::new(&boxes);
    let mut random = Random(9);
    let points: Vec<[f64; 3]> = (0..20_000).map(|_| random_point(source, &mut random)).collect();
    let query = || {
        let mut found = 0;
        points.iter().for_each(|&p| tree.query_point(p, |index| found += index));
        black_box(found);
    };
    fastest(query) * 1e6 / points.len() as f64
}

/// What the machine can do: bandwidth of streaming, and latency of dependent and of independent random
/// reads of 32-byte records, in tables of the size of the leaves' own.
fn memory_floor() {
    let n = 8 << 20;
    let (a, b) = (vec![1.0f64; n], vec![2.0f64; n]);
    let mut c = vec![0.0f64; n];
    let mut best = f64::INFINITY;
    for _ in 0..4 {
        let clock = Instant::now();
        c.iter_mut().zip(&a).zip(&b).for_each(|((c, a), b)| *c = a + 3.0 * b);
        best = best.min(clock.elapsed().as_secs_f64());
        black_box(&c);
    }
    println!("triad {:.1} GB/s", 24.0 * n as f64 / best / 1e9);
    for records in [10_000, 100_000, 1_000_000, 5_000_000] {
        let (chased, independent) = random_reads(records);
        println!(
            "{records:>8} records of 32 bytes: {chased:.1} ns per dependent read, {independent:.1} ns per independent one"
        );
    }
}

fn random_reads(records: usize) -> (f64, f64) {
    let mut random = Random(3);
    // One cycle through all records.
    let mut order: Vec<u32> = (0..records as u32).collect();
    (1..records).rev().for_each(|i| order.swap(i, random.below(i as u64 + 1) as usize));
    let mut table = vec![[0u32; 8]; records];
    for k in 0..records {
        table[order[k] as usize][0] = order[(k + 1) % records];
    }
    let reads = 2_000_000;
    let clock = Instant::now();
    let mut at = 0u32;
    (0..reads).for_each(|_| at = table[at as usize][0]);
    black_box(at);
    let chased = clock.elapsed().as_secs_f64();
    let clock = Instant::now();
    let sum = (0..reads).fold(0u32, |sum, k| sum ^ table[order[k % records] as usize][0]);
    black_box(sum);
    let independent = clock.elapsed().as_secs_f64();
    (chased * 1e9 / reads as f64, independent * 1e9 / reads as f64)
}

/// The most memory that this process has held so far; of all meshes before, too.
fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).map_or(f64::NAN, |kb| kb / 1024.0)
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
