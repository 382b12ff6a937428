//! Slow constructions of small valid maps: greedy with backtracking, by the definition of a free cell.

use super::random::Random;
use super::{Map, Refinement};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};

type Face = BTreeSet<u32>;

pub fn facets(cell: &[u32]) -> impl Iterator<Item = Face> + '_ {
    (0..cell.len()).map(|i| cell.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, v)| *v).collect())
}

/// The faces at which rule 5 speaks: vertices, and edges of tetrahedra.
fn small_faces(cell: &[u32]) -> Vec<Face> {
    let mut faces: Vec<Face> = cell.iter().map(|&v| Face::from([v])).collect();
    if cell.len() == 4 {
        for i in 0..4 {
            faces.extend((0..i).map(|j| Face::from([cell[i], cell[j]])));
        }
    }
    faces
}

/// Grid points of `[0, n]^2`, two triangles per square.
pub fn square_grid(n: u32) -> (Vec<Vec<f64>>, Vec<Vec<u32>>) {
    let at = |i: u32, j: u32| i + (n + 1) * j;
    let positions = (0..(n + 1) * (n + 1)).map(|v| vec![f64::from(v % (n + 1)), f64::from(v / (n + 1)), 0.0]).collect();
    let mut cells = vec![];
    for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
        cells.push(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        cells.push(vec![at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    (positions, cells)
}

/// Grid points of `[0, n]^3`, six tetrahedra per cube.
pub fn cube_grid(n: u32) -> (Vec<Vec<f64>>, Vec<Vec<u32>>) {
    let m = n + 1;
    let positions = (0..m * m * m).map(|v| vec![v % m, v / m % m, v / m / m].into_iter().map(f64::from).collect());
    let mut cells = vec![];
    for corner in (0..n * n * n).map(|k| k % n + m * (k / n % n) + m * m * (k / n / n)) {
        for (a, b, c, even) in
            [(0, 1, 2, true), (1, 2, 0, true), (2, 0, 1, true), (1, 0, 2, false), (0, 2, 1, false), (2, 1, 0, false)]
        {
            let step = [1, m, m * m];
            let second = corner + step[a];
            let (third, fourth) = (second + step[b], second + step[b] + step[c]);
            cells.push(if even { vec![corner, second, third, fourth] } else { vec![corner, third, second, fourth] });
        }
    }
    (positions.collect(), cells)
}

/// A hexagon with a vertex in the middle.
pub fn hexagon() -> (Vec<Vec<f64>>, Vec<Vec<u32>>) {
    let rim = [(2.0, 0.0), (1.0, 2.0), (-1.0, 2.0), (-2.0, 0.0), (-1.0, -2.0), (1.0, -2.0)];
    let mut positions: Vec<Vec<f64>> = rim.iter().map(|&(x, y)| vec![x, y, 0.25 * x * y]).collect();
    positions.push(vec![0.0, 0.0, 1.0]);
    (positions, (0..6).map(|i| vec![6, i, (i + 1) % 6]).collect())
}

/// Splits every cell that contains `face` at a new vertex inside it; weights of the face's vertices.
pub fn split(map: &mut Map, face: &[(u32, i64)]) -> u32 {
    let size = map.size();
    let source_count = map.positions.len() as u32;
    let new = map.vertex_count() as u32;
    let identity = Refinement {
        carrier_vertices: vec![],
        carrier_weights: vec![],
        cells: map.source_cells.clone(),
        parents: (0..map.source_cells.len() as u32).collect(),
    };
    let r = map.refinement.get_or_insert(identity);
    let carrier = |v: u32| -> Vec<(u32, i64)> {
        let Some(row) = v.checked_sub(source_count) else { return vec![(v, 1)] };
        let row = row as usize;
        r.carrier_vertices[row].iter().copied().zip(r.carrier_weights[row].iter().copied()).collect()
    };
    let common: i64 = face.iter().map(|&(v, _)| carrier(v).iter().map(|c| c.1).sum::<i64>()).product();
    let mut sum = BTreeMap::new();
    for &(v, weight) in face {
        let total: i64 = carrier(v).iter().map(|c| c.1).sum();
        for (vertex, part) in carrier(v).into_iter().filter(|c| c.1 > 0) {
            *sum.entry(vertex).or_insert(0) += weight * part * (common / total);
        }
    }
    let mut vertices: Vec<u32> = sum.keys().copied().collect();
    let mut weights: Vec<i64> = sum.values().copied().collect();
    vertices.resize(size, 0);
    weights.resize(size, 0);
    r.carrier_vertices.push(vertices);
    r.carrier_weights.push(weights);
    let (mut cells, mut parents) = (vec![], vec![]);
    for (cell, &parent) in r.cells.iter().zip(&r.parents) {
        let contains = face.iter().all(|(v, _)| cell.contains(v));
        for v in cell.iter().filter(|v| !contains || face.iter().any(|(w, _)| w == *v)) {
            cells.push(cell.iter().map(|w| if contains && w == v { new } else { *w }).collect());
            parents.push(parent);
            if !contains {
                break;
            }
        }
    }
    (r.cells, r.parents) = (cells, parents);
    new
}

/// Where the vertices of the refined complex lie, rounded.
pub fn places(map: &Map) -> Vec<Vec<f64>> {
    let mut places = map.positions.clone();
    for r in map.refinement.iter() {
        for (vertices, weights) in r.carrier_vertices.iter().zip(&r.carrier_weights) {
            let total: i64 = weights.iter().sum();
            let coordinate = |axis: usize| -> f64 {
                let parts = vertices.iter().zip(weights).map(|(&v, &w)| w as f64 * map.positions[v as usize][axis]);
                parts.sum::<f64>() / total as f64
            };
            places.push((0..3).map(coordinate).collect());
        }
    }
    places
}

/// Facets with one cell.
pub fn boundary(cells: &[Vec<u32>]) -> Vec<Face> {
    let mut count = BTreeMap::new();
    cells.iter().flat_map(|cell| facets(cell).collect::<Vec<_>>()).for_each(|f| *count.entry(f).or_insert(0) += 1);
    count.into_iter().filter(|&(_, n)| n == 1).map(|(f, _)| f).collect()
}

struct Search<'a> {
    cells: &'a [Vec<u32>],
    source: Vec<Face>,
    sink: Vec<Face>,
    around: BTreeMap<Face, Vec<usize>>,
    order: Vec<usize>,
    rank: Vec<Option<usize>>,
    steps: usize,
}

impl Search<'_> {
    /// 1 where leaves enter, -1 where they leave, 0 along the boundary, if `c` comes next.
    fn signs(&self, c: usize) -> Vec<i8> {
        let sign = |facet: Face| {
            let other = self.around[&facet].iter().find(|&&d| d != c);
            match other {
                Some(&d) => {
                    if self.rank[d].is_some() {
                        1
                    } else {
                        -1
                    }
                }
                None => i8::from(self.source.contains(&facet)) - i8::from(self.sink.contains(&facet)),
            }
        };
        facets(&self.cells[c]).map(sign).collect()
    }

    fn is_free(&self, c: usize) -> bool {
        let signs = self.signs(c);
        if !signs.contains(&1) || !signs.contains(&-1) {
            return false;
        }
        let with = |sign: i8, f: &Face| facets(&self.cells[c]).zip(&signs).any(|(g, s)| *s == sign && f.is_subset(&g));
        let lies_on = |region: &[Face], f: &Face| region.iter().any(|g| f.is_subset(g));
        small_faces(&self.cells[c]).iter().all(|f| {
            let others: Vec<usize> = self.around[f].iter().copied().filter(|&d| d != c).collect();
            let is_first = !lies_on(&self.source, f) && others.iter().all(|&d| self.rank[d].is_none());
            let is_last = !lies_on(&self.sink, f) && others.iter().all(|&d| self.rank[d].is_some());
            with(1, f) != is_first && with(-1, f) != is_last
        })
    }

    fn run(&mut self, wanted: &[usize]) -> bool {
        if self.order.len() == wanted.len() {
            return true;
        }
        self.steps += 1;
        for &c in wanted {
            if self.steps < 300 && self.rank[c].is_none() && self.is_free(c) {
                self.rank[c] = Some(self.order.len());
                self.order.push(c);
                if self.run(wanted) {
                    return true;
                }
                self.rank[c] = None;
                self.order.pop();
            }
        }
        false
    }
}

/// Directions for all cells but the one to skip, those with small keys first; ties and dead ends by chance.
fn directions(
    cells: &[Vec<u32>],
    regions: (Vec<Face>, Vec<Face>),
    keys: &[f64],
    skip: Option<usize>,
) -> Option<Vec<Vec<i8>>> {
    let mut random = Random(7);
    (0..400).find_map(|trial| {
        let noisy: Vec<f64> = keys.iter().map(|key| key + f64::from(trial) * 0.01 * random.unit()).collect();
        let mut wanted: Vec<usize> = (0..cells.len()).filter(|&c| Some(c) != skip).collect();
        wanted.sort_by(|&a, &b| noisy[a].total_cmp(&noisy[b]));
        directions_in_order(cells, regions.clone(), &wanted)
    })
}

fn directions_in_order(
    cells: &[Vec<u32>],
    (source, sink): (Vec<Face>, Vec<Face>),
    wanted: &[usize],
) -> Option<Vec<Vec<i8>>> {
    let mut around: BTreeMap<Face, Vec<usize>> = BTreeMap::new();
    for &c in wanted {
        for face in small_faces(&cells[c]).into_iter().chain(facets(&cells[c]).filter(|f| f.len() > 1)) {
            let list = around.entry(face).or_default();
            if !list.contains(&c) {
                list.push(c);
            }
        }
    }
    let rank = vec![None; cells.len()];
    let mut search = Search { cells, source, sink, around, order: vec![], rank, steps: 0 };
    if !search.run(wanted) {
        return None;
    }
    let order = std::mem::take(&mut search.order);
    search.rank.fill(None);
    let mut rows = vec![vec![0; cells[0].len()]; cells.len()];
    for (k, c) in order.into_iter().enumerate() {
        let signs = search.signs(c);
        let [plus, minus] = [1, -1].map(|sign| signs.iter().filter(|s| **s == sign).count() as i8);
        rows[c] = signs.iter().map(|&s| if s > 0 { minus } else { -plus * i8::from(s < 0) }).collect();
        search.rank[c] = Some(k);
    }
    Some(rows)
}

fn centroids(map: &Map) -> Vec<Vec<f64>> {
    let places = places(map);
    let mean = |cell: &Vec<u32>, axis: usize| cell.iter().map(|&v| places[v as usize][axis]).sum::<f64>();
    map.cells().iter().map(|cell| (0..3).map(|axis| mean(cell, axis) / cell.len() as f64).collect()).collect()
}

/// Foliates from the lowest to the highest part of the boundary along `axis`; square and cube.
pub fn foliate_upwards(map: &mut Map, axis: usize) {
    let (places, size) = (places(map), map.size());
    let height = |v: &u32| places[*v as usize][axis];
    let (low, high) =
        (0..places.len() as u32).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(height(&v)), h.max(height(&v))));
    let boundary = boundary(map.cells());
    let at = |level: f64| boundary.iter().filter(|f| f.iter().all(|v| height(v) == level)).cloned().collect::<Vec<_>>();
    let (source, sink) = (at(low), at(high));
    let keys: Vec<f64> = centroids(map).iter().map(|p| p[axis]).collect();
    map.directions = directions(map.cells(), (source.clone(), sink), &keys, None).expect("a foliation upwards");
    map.lengths = (0..map.directions.len() as u32).map(|c| 1 + c % 5).collect();
    let vertices: BTreeSet<u32> = source.iter().flatten().copied().collect();
    let across: Vec<usize> = (0..size - 1).filter(|&a| a != axis).collect();
    let range = |a: usize| {
        let all = vertices.iter().map(|&v| places[v as usize][a]);
        (all.clone().fold(f64::MAX, f64::min), all.fold(f64::MIN, f64::max))
    };
    let mut rows: Vec<(u32, Vec<f64>)> = vertices
        .iter()
        .map(|&v| {
            (v, across.iter().map(|&a| (places[v as usize][a] - range(a).0) / (range(a).1 - range(a).0)).collect())
        })
        .collect();
    rows.sort_by(|a, b| a.1.partial_cmp(&b.1).expect("numbers"));
    (map.section_vertices, map.section_coordinates) = rows.into_iter().unzip();
}

/// Foliates between the centre cell and the boundary; disk (inwards) and ball (outwards).
pub fn foliate_radially(map: &mut Map, centre: usize) {
    let inner: Vec<Face> = facets(&map.cells()[centre].clone()).collect();
    let outer = boundary(map.cells());
    let middle = centroids(map)[centre].clone();
    let distance = |p: &Vec<f64>| p.iter().zip(&middle).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    let is_disk = map.size() == 3;
    let keys: Vec<f64> = centroids(map).iter().map(|p| if is_disk { -distance(p) } else { distance(p) }).collect();
    let (source, sink) = if is_disk { (outer.clone(), inner) } else { (inner, outer.clone()) };
    map.directions = directions(map.cells(), (source, sink), &keys, Some(centre)).expect("a radial foliation");
    map.lengths = (0..map.directions.len() as u32).map(|c| 1 + c % 7).collect();
    map.manifest["centre"] = json!({"cell": centre, "length": 3});
    if !is_disk {
        return;
    }
    let mut path: Vec<u32> = outer[0].iter().copied().collect();
    while path.len() < outer.len() {
        let [before, last] = [path[path.len() - 2], path[path.len() - 1]];
        let next = outer.iter().find(|f| f.contains(&last) && !f.contains(&before)).expect("a loop");
        path.push(*next.iter().find(|&&v| v != last).expect("an edge"));
    }
    map.section_coordinates = (0..path.len()).map(|i| vec![4.0 * i as f64 / path.len() as f64]).collect();
    map.section_vertices = path;
}

/// The cell whose vertices are all inside, nearest to the middle of the first coordinates.
pub fn inner_cell(map: &Map) -> usize {
    let rim: BTreeSet<u32> = boundary(map.cells()).into_iter().flatten().collect();
    map.cells().iter().position(|cell| cell.iter().all(|v| !rim.contains(v))).expect("an inner cell")
}

/// A name and a valid map for every kind, target and refinement that the format knows.
pub fn all_maps() -> Vec<(&'static str, Map)> {
    let mut maps = vec![
        ("square from a hexagon", square_hexagon()),
        ("square", upwards("square", square_grid(3), 1, &[])),
        (
            "square, refined",
            upwards("square", square_grid(2), 1, &[&[(0, 1), (1, 2)], &[(4, 1), (5, 1), (8, 1)], &[(9, 1), (4, 3)]]),
        ),
        ("cube of six", upwards("cube", cube_grid(1), 2, &[])),
        ("cube of 48", upwards("cube", cube_grid(2), 2, &[])),
        (
            "cube, refined",
            upwards(
                "cube",
                cube_grid(1),
                2,
                &[&[(0, 1), (7, 3)], &[(0, 1), (1, 1), (3, 1)], &[(8, 2), (2, 1), (3, 1)]],
            ),
        ),
    ];
    maps.extend(radial_maps());
    maps.extend(linear_maps());
    maps.iter_mut().for_each(|(_, map)| map.sign());
    maps
}

fn upwards(target: &str, grid: (Vec<Vec<f64>>, Vec<Vec<u32>>), axis: usize, splits: &[&[(u32, i64)]]) -> Map {
    let mut map = Map::new("foliation", target, grid.0, grid.1);
    splits.iter().for_each(|face| {
        split(&mut map, face);
    });
    foliate_upwards(&mut map, axis);
    map
}

fn square_hexagon() -> Map {
    let (positions, cells) = hexagon();
    upwards("square", (positions, cells), 1, &[])
}

fn radial_maps() -> Vec<(&'static str, Map)> {
    let (positions, cells) = square_grid(4);
    let mut disk = Map::new("foliation", "disk", positions, cells);
    let mut fine_disk = disk.clone();
    split(&mut fine_disk, &[(6, 1), (12, 2)]);
    for map in [&mut disk, &mut fine_disk] {
        let centre = inner_cell(map);
        foliate_radially(map, centre);
    }
    let mut ball = Map::new(
        "foliation",
        "ball",
        vec![vec![0., 0., 0.], vec![4., 0., 0.], vec![0., 4., 0.], vec![0., 0., 4.]],
        vec![vec![0, 1, 2, 3]],
    );
    split(&mut ball, &[(0, 1), (1, 1), (2, 1), (3, 1)]); // an inner cell by four inner vertices
    split(&mut ball, &[(4, 1), (1, 1), (2, 1), (3, 1)]);
    split(&mut ball, &[(4, 2), (5, 2), (2, 1), (3, 1)]);
    split(&mut ball, &[(4, 2), (5, 2), (6, 2), (3, 1)]);
    let centre = inner_cell(&ball);
    foliate_radially(&mut ball, centre);
    let places = places(&ball);
    let mut plain = Map::new("foliation", "ball", places, ball.cells().clone());
    foliate_radially(&mut plain, centre);
    vec![("disk", disk), ("disk, refined", fine_disk), ("ball", plain), ("ball, refined", ball)]
}

fn linear_maps() -> Vec<(&'static str, Map)> {
    let linear = |target: &str, (positions, cells): (Vec<Vec<f64>>, Vec<Vec<u32>>), splits: &[&[(u32, i64)]]| {
        let mut map = Map::new("piecewise-linear", target, positions, cells);
        splits.iter().for_each(|face| {
            split(&mut map, face);
        });
        let (places, n) = (places(&map), map.size() - 1);
        let largest = places.iter().flatten().copied().fold(0.0, f64::max);
        map.target_positions = places.iter().map(|p| p[..n].iter().map(|x| x / largest).collect()).collect();
        map
    };
    let mut square = linear("square", square_grid(2), &[]);
    square.target_positions[4] = vec![0.375, 0.625];
    square.source_cells[3].swap(0, 1); // a surface need not be oriented
    let mut cube = linear("cube", cube_grid(2), &[]);
    cube.target_positions[13] = vec![0.5625, 0.4375, 0.53125];
    let fine_square = linear("square", square_grid(2), &[&[(4, 1), (8, 1)], &[(9, 3), (4, 1)]]);
    let fine_cube = linear("cube", cube_grid(1), &[&[(0, 1), (7, 1)], &[(0, 3), (1, 1)]]);
    vec![
        ("piecewise-linear square", square),
        ("piecewise-linear cube", cube),
        ("piecewise-linear square, refined", fine_square),
        ("piecewise-linear cube, refined", fine_cube),
    ]
}

/// Turns the flow across facet `i`, with magnitudes that keep the sum zero; `false` if no flow is left.
pub fn turn(row: &mut [i8], i: usize) -> bool {
    let signs: Vec<i8> = row.iter().enumerate().map(|(j, d)| if i == j { -d.signum() } else { d.signum() }).collect();
    let [plus, minus] = [1, -1].map(|sign| signs.iter().filter(|s| **s == sign).count() as i8);
    row.iter_mut().zip(&signs).for_each(|(d, s)| *d = if *s > 0 { minus } else { -plus * i8::from(*s < 0) });
    plus > 0 && minus > 0
}
