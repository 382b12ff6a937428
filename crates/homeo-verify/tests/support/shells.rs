//! Small meshes and shells, and the definition of a valid shell, checked naively: all pairs, rational numbers.

use super::clip::{Rational, cross, dot, minus, normal, rational, span_an_area, within_tetrahedron, within_triangle};
use super::{Map, write};
use dashu_ratio::RBig;
use std::collections::{BTreeMap, BTreeSet};

/// Vertices, and triangles seen anticlockwise from outside.
pub type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);

pub fn tetrahedron() -> Mesh {
    let positions = vec![[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    (positions, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

pub fn octahedron() -> Mesh {
    let positions = vec![[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let upper = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
    let lower = [[2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    (positions, [upper, lower].concat())
}

/// A sphere of radius 1.
pub fn icosphere(steps: usize) -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut mesh: Mesh = (vec![], vec![]);
    for (a, b) in [(-1., g), (1., g), (-1., -g), (1., -g)] {
        mesh.0.extend([[a, b, 0.], [0., a, b], [b, 0., a]]);
    }
    let n = mesh.0.len() as u32;
    let length = |a: [f64; 3], b: [f64; 3]| (0..3).map(|x| (a[x] - b[x]).powi(2)).sum::<f64>();
    for [a, b, c] in (0..n * n * n).map(|k| [k % n, k / n % n, k / n / n]) {
        let [p, q, r] = [a, b, c].map(|v| mesh.0[v as usize]);
        let is_face = [(p, q), (q, r), (r, p)].iter().all(|(p, q)| (length(*p, *q) - 4.0).abs() < 1e-9);
        let turn = p[0] * (q[1] * r[2] - q[2] * r[1])
            + p[1] * (q[2] * r[0] - q[0] * r[2])
            + p[2] * (q[0] * r[1] - q[1] * r[0]);
        if is_face && turn > 0.0 && a < b && a < c {
            mesh.1.push([a, b, c]);
        }
    }
    let unit = |p: [f64; 3]| scaled(p, 1.0 / length(p, [0.0; 3]).sqrt());
    for _ in 0..steps {
        mesh.0.iter_mut().for_each(|p| *p = unit(*p));
        mesh = quartered(&mesh);
    }
    mesh.0.iter_mut().for_each(|p| *p = unit(*p));
    mesh
}

/// Four triangles from each; the new vertices are moved away from the origin.
pub fn quartered(mesh: &Mesh) -> Mesh {
    let mut middles = BTreeMap::new();
    let (mut positions, mut cells) = mesh.clone();
    for [a, b, c] in std::mem::take(&mut cells) {
        let [x, y, z] = [(a, b), (b, c), (c, a)].map(|(v, w)| {
            *middles.entry((v.min(w), v.max(w))).or_insert_with(|| {
                positions.push([0, 1, 2].map(|x| 0.625 * (mesh.0[v as usize][x] + mesh.0[w as usize][x])));
                positions.len() as u32 - 1
            })
        });
        cells.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
    }
    (positions, cells)
}

/// A torus of radii 3 and `r`.
pub fn torus(r: f64) -> Mesh {
    let (m, n) = (12, 8);
    let mut mesh: Mesh = (vec![], vec![]);
    for (i, j) in (0..m * n).map(|k| (k / n, k % n)) {
        let [s, t] = [f64::from(i) / f64::from(m), f64::from(j) / f64::from(n)].map(|x| std::f64::consts::TAU * x);
        mesh.0.push([(3. + r * t.cos()) * s.cos(), (3. + r * t.cos()) * s.sin(), r * t.sin()]);
        let at = |i: u32, j: u32| i % m * n + j % n;
        mesh.1.extend([[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    }
    mesh
}

pub fn scaled(p: [f64; 3], factor: f64) -> [f64; 3] {
    p.map(|x| factor * x)
}

/// All points moved by a similarity without symmetry, turned by about a radian and enlarged a little.
pub fn turned(mesh: &Mesh, factor: f64) -> Mesh {
    let turn = |[x, y, z]: [f64; 3]| {
        let (x, y) = (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
        let (y, z) = (12. / 13. * y - 5. / 13. * z, 5. / 13. * y + 12. / 13. * z);
        scaled([x, y, z], factor)
    };
    (mesh.0.iter().map(|&p| turn(p)).collect(), mesh.1.clone())
}

pub fn joined(a: &Mesh, b: &Mesh, offset: [f64; 3]) -> Mesh {
    let n = a.0.len() as u32;
    let moved = b.0.iter().map(|p| [0, 1, 2].map(|x| p[x] + offset[x]));
    (
        a.0.iter().copied().chain(moved).collect(),
        a.1.iter().copied().chain(b.1.iter().map(|t| t.map(|v| v + n))).collect(),
    )
}

/// The shell between three positions of one mesh.
pub fn shell(source: &Mesh, prisms: &[[u32; 3]], levels: [&[[f64; 3]]; 3]) -> Map {
    let points = |points: &[[f64; 3]]| -> Vec<Vec<f64>> { points.iter().map(|p| p.to_vec()).collect() };
    let rows = |rows: &[[u32; 3]]| -> Vec<Vec<u32>> { rows.iter().map(|p| p.to_vec()).collect() };
    let mut map = Map::new("shell", "shell", points(&source.0), rows(&source.1));
    map.levels = levels.map(points);
    map.prisms = rows(prisms);
    map.sign();
    map
}

/// The shell round a mesh about the origin, from `low` to `high` times its size.
pub fn around(source: &Mesh, middle: &Mesh, [low, high]: [f64; 2]) -> Map {
    let level = |factor: f64| -> Vec<[f64; 3]> { middle.0.iter().map(|p| scaled(*p, factor)).collect() };
    shell(source, &middle.1, [&level(low), &middle.0, &level(high)])
}

fn pinch(map: &mut Map, column: usize) {
    let point = map.levels[1][column].clone();
    map.levels.iter_mut().for_each(|level| level[column] = point.clone());
}

/// A patch over the plane: a triangle.
pub fn triangle() -> Mesh {
    (vec![[4., 0., 0.], [-2., 3., 0.25], [-2., -3., -0.25]], vec![[0, 1, 2]])
}

/// A bumpy hexagon: a boundary loop of 6 edges, then loops further in, then the centre.
pub fn hexagon(loops: u32) -> Mesh {
    let mut mesh: Mesh = (vec![], vec![]);
    let bumps = [0., 0.5, 0.25, -0.25, 0.125, 0.25, -0.125];
    for (n, i) in (0..loops).flat_map(|n| (0..6).map(move |i| (n, i))) {
        let [x, y] = [[4., 0.], [2., 3.], [-2., 3.], [-4., 0.], [-2., -3.], [2., -3.]][i as usize];
        let part = f64::from(loops - n) / f64::from(loops);
        mesh.0.push([part * x, part * y, bumps[(i + n) as usize % 7]]);
        let [a, b] = [6 * n + i, 6 * n + (i + 1) % 6];
        match n + 1 == loops {
            true => mesh.1.push([a, b, 6 * loops]),
            false => mesh.1.extend([[a, b, a + 6], [b, b + 6, a + 6]]),
        }
    }
    mesh.0.push([0., 0., 0.25]);
    mesh
}

/// The boundary of [`hexagon`] without any vertices inside.
pub fn bare_hexagon() -> Mesh {
    (hexagon(1).0[..6].to_vec(), vec![[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]])
}

/// The part of a mesh whose vertices are kept.
pub fn cap(mesh: &Mesh, is_kept: impl Fn([f64; 3]) -> bool) -> Mesh {
    let kept: Vec<u32> = (0..mesh.0.len() as u32).filter(|&v| is_kept(mesh.0[v as usize])).collect();
    let place = |v: u32| kept.binary_search(&v).ok().map(|place| place as u32);
    let cells = mesh.1.iter().filter_map(|&[a, b, c]| Some([place(a)?, place(b)?, place(c)?]));
    (kept.iter().map(|&v| mesh.0[v as usize]).collect(), cells.collect())
}

/// Three triangles from each, with a vertex a little outward from the middle.
pub fn starred(mesh: &Mesh) -> Mesh {
    let (mut positions, mut cells) = (mesh.0.clone(), vec![]);
    for &[a, b, c] in &mesh.1 {
        let n = positions.len() as u32;
        let [p, q, r] = [a, b, c].map(|v| mesh.0[v as usize]);
        positions.push([0, 1, 2].map(|x| 0.34375 * (p[x] + q[x] + r[x])));
        cells.extend([[a, b, n], [b, c, n], [c, a, n]]);
    }
    (positions, cells)
}

/// A ring of radius 1 about the third axis.
pub fn cylinder(count: u32, rows: u32) -> Mesh {
    let mut mesh: Mesh = (vec![], vec![]);
    for (j, i) in (0..rows).flat_map(|j| (0..count).map(move |i| (j, i))) {
        let s = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        mesh.0.push([s.cos(), s.sin(), f64::from(j) + 0.25 * s.sin()]);
        let [a, b] = [count * j + i, count * j + (i + 1) % count];
        if j + 1 < rows {
            mesh.1.extend([[a, b, b + count], [a, b + count, a + count]]);
        }
    }
    mesh
}

/// The shell of a patch over the plane, from `low` to `high` along the third axis.
pub fn over_plane(source: &Mesh, middle: &Mesh, heights: [f64; 2]) -> Map {
    let [bottom, top] = heights.map(|h| middle.0.iter().map(|p| [p[0], p[1], p[2] + h]).collect::<Vec<_>>());
    shell(source, &middle.1, [&bottom, &middle.0, &top])
}

/// Shells of surfaces with boundary.
pub fn open_shells() -> Vec<(&'static str, Map)> {
    let (t, h, ball) = (triangle(), hexagon(1), icosphere(1));
    let half = cap(&ball, |p| p[2] > -0.3);
    let lid = cap(&icosphere(0), |p| p[2] > -0.1);
    let mut leaning = over_plane(&starred(&h), &h, [-2.0, 2.0]);
    for v in 0..6 {
        (leaning.levels[0][v][0], leaning.levels[2][v][1]) = (1.125 * h.0[v][0], 0.875 * h.0[v][1]);
    }
    let mut pinched = over_plane(&h, &h, [-2.0, 2.0]);
    pinch(&mut pinched, 1);
    let mut twice_pinched = over_plane(&hexagon(2), &h, [-2.0, 2.0]);
    pinch(&mut twice_pinched, 0);
    pinch(&mut twice_pinched, 2);
    let mut ring_pinched = tube(&cylinder(5, 2), &cylinder(5, 2));
    pinch(&mut ring_pinched, 3);
    let two = joined(&h, &octahedron(), [0.0, 0.0, 5.0]);
    let level = |h: f64, factor: f64| -> Vec<[f64; 3]> {
        let (patch, ball) = two.0.split_at(7);
        let ball = ball.iter().map(|p| [factor * p[0], factor * p[1], 5.0 + factor * (p[2] - 5.0)]);
        patch.iter().map(|p| [p[0], p[1], p[2] + h]).chain(ball).collect()
    };
    let patch_and_ball = shell(&two, &two.1, [&level(-1.0, 0.75), &two.0, &level(1.0, 1.25)]);
    let overlapping = joined(&h, &h, [0.0, 0.0, 3.0]);
    vec![
        ("triangle", over_plane(&t, &t, [-1.0, 1.0])),
        ("starred triangle", over_plane(&starred(&t), &t, [-1.0, 1.0])),
        ("hexagon", over_plane(&h, &h, [-2.0, 2.0])),
        ("hexagon in a finer one", over_plane(&hexagon(2), &bare_hexagon(), [-2.0, 2.0])),
        ("hexagon in a coarser one", over_plane(&bare_hexagon(), &hexagon(2), [-2.0, 2.0])),
        ("hexagon with leaning walls", leaning),
        ("hexagon, pinched at the boundary", pinched),
        ("hexagon, pinched twice", twice_pinched),
        ("two hexagons that overlap", over_plane(&overlapping, &overlapping, [-2.0, 2.0])),
        ("hexagon and octahedron", patch_and_ball),
        ("part of an icosahedron", around(&lid, &lid, [0.75, 1.25])),
        ("part of a sphere", around(&half, &half, [0.75, 1.25])),
        ("finer part of a sphere", around(&starred(&half), &half, [0.75, 1.25])),
        ("ring", tube(&cylinder(5, 2), &cylinder(5, 2))),
        ("finer ring", tube(&starred_ring(&cylinder(5, 2)), &cylinder(5, 2))),
        ("long ring", tube(&cylinder(7, 4), &cylinder(7, 4))),
        ("ring, pinched at the boundary", ring_pinched),
    ]
}

/// Three triangles from each, with a vertex a little outward from the third axis.
fn starred_ring(mesh: &Mesh) -> Mesh {
    let (mut positions, cells) = starred(mesh);
    positions.iter_mut().skip(mesh.0.len()).for_each(|p| p[2] *= 32.0 / 33.0);
    (positions, cells)
}

/// The shell round a mesh about the third axis.
pub fn tube(source: &Mesh, middle: &Mesh) -> Map {
    let level = |f: f64| -> Vec<[f64; 3]> { middle.0.iter().map(|p| [f * p[0], f * p[1], p[2]]).collect() };
    shell(source, &middle.1, [&level(0.5), &middle.0, &level(1.5)])
}

pub fn all_shells() -> Vec<(&'static str, Map)> {
    closed_shells().into_iter().chain(open_shells()).collect()
}

pub fn closed_shells() -> Vec<(&'static str, Map)> {
    let (t, o, i) = (tetrahedron(), octahedron(), icosphere(0));
    let mut pinched = around(&o, &o, [0.75, 1.5]);
    pinch(&mut pinched, 4);
    let mut twice_pinched = pinched.clone();
    pinch(&mut twice_pinched, 5);
    let two = joined(&o, &turned(&t, 0.5), [2.5, 0.25, 0.]);
    let level = |factor: f64| {
        joined(
            &(around_points(&o.0, factor), vec![]),
            &(around_points(&turned(&t, 0.5).0, factor), vec![]),
            [2.5, 0.25, 0.],
        )
        .0
    };
    let tori = [0.75, 1.0, 1.25].map(|r| torus(r).0);
    vec![
        ("tetrahedron", around(&t, &t, [0.5, 1.5])),
        ("octahedron", around(&o, &o, [0.75, 1.25])),
        ("octahedron in a finer one", around(&quartered(&o), &o, [0.75, 2.0])),
        ("octahedron, pinched", pinched),
        ("octahedron, pinched twice", twice_pinched),
        ("two that overlap", shell(&two, &two.1, [&level(0.75), &two.0, &level(1.75)])),
        ("icosahedron", around(&i, &i, [0.75, 1.25])),
        ("icosahedron in a finer one", around(&turned(&icosphere(1), 1.0), &i, [0.75, 1.5])),
        ("sphere in an icosahedron", around(&turned(&icosphere(2), 1.0), &i, [0.8, 1.4])),
        ("torus", shell(&torus(1.0), &torus(1.0).1, [&tori[0], &tori[1], &tori[2]])),
        ("finer torus", shell(&torus(1.1), &torus(1.0).1, [&tori[0], &tori[1], &tori[2]])),
    ]
}

fn around_points(points: &[[f64; 3]], factor: f64) -> Vec<[f64; 3]> {
    points.iter().map(|p| scaled(*p, factor)).collect()
}

// The oracle.

type Corner = (u32, usize);

pub struct Exact {
    pub cells: Vec<Vec<u32>>,
    pub triangles: Vec<[Rational; 3]>,
    levels: Vec<Vec<Rational>>,
    pub prisms: Vec<Vec<u32>>,
    pub pairs: Option<BTreeSet<[usize; 2]>>,
}

/// Whether a shell is valid, and has the counts and the hash that its manifest states.
pub fn is_valid(map: &Map) -> bool {
    let as_source = |(positions, cells): &super::Rows| {
        let mut other = Map { positions: positions.clone(), source_cells: cells.clone(), section: None, ..map.clone() };
        other.sign();
        other
    };
    is_valid_for_source(map) && map.section.as_ref().is_none_or(|section| is_valid_for_source(&as_source(section)))
}

fn is_valid_for_source(map: &Map) -> bool {
    let source = &map.manifest["source"];
    let counts = [map.positions.len(), map.source_cells.len()].map(|n| Some(n as u64));
    let is_counted = [source["vertices"].as_u64(), source["cells"].as_u64()] == counts
        && source["content_sha256"] == write::content_hash(map)
        && map.levels.iter().all(|level| level.len() == map.levels[0].len());
    let all_points = || map.positions.iter().chain(map.levels.iter().flatten());
    if !is_counted || all_points().flatten().any(|x| !x.is_finite()) {
        return false;
    }
    if !is_surface(&map.source_cells, map.positions.len()) || !is_surface(&map.prisms, map.levels[0].len()) {
        return false;
    }
    let shell = Exact::new(map);
    let has_area = |t: &[Rational; 3]| span_an_area(t);
    shell.has_common_boundary()
        && shell.triangles.iter().all(has_area)
        && shell.is_positive()
        && map.pairs.as_ref().is_none_or(|pairs| shell.has_complete_pairs(pairs))
        && shell.keeps_off_bottom_and_top()
        && shell.keeps_inside_of_walls()
        && shell.is_crossed_from_below()
        && shell.covers_once()
        && shell.is_met_once()
}

pub fn directed_edges(cells: &[Vec<u32>]) -> Vec<[u32; 2]> {
    cells.iter().flat_map(|c| [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]).collect()
}

/// Every directed edge at most once, round every vertex one loop or one path, no triangle twice.
fn is_surface(cells: &[Vec<u32>], count: usize) -> bool {
    let directed = directed_edges(cells);
    let set: BTreeSet<[u32; 2]> = directed.iter().copied().collect();
    let sets: BTreeSet<BTreeSet<u32>> = cells.iter().map(|cell| cell.iter().copied().collect()).collect();
    let is_simple = set.len() == directed.len()
        && set.iter().all(|&[a, b]| a != b && (a as usize) < count)
        && sets.len() == cells.len();
    is_simple && {
        let vertices: BTreeSet<u32> = cells.iter().flatten().copied().collect();
        vertices.into_iter().all(|v| {
            let star = cells.iter().filter(|cell| cell.contains(&v));
            let after = |cell: &Vec<u32>, k: usize| cell[(cell.iter().position(|w| *w == v).expect("in it") + k) % 3];
            let next: BTreeMap<u32, u32> = star.map(|cell| (after(cell, 1), after(cell, 2))).collect();
            let is_first = |w: &&u32| !next.values().any(|other| other == *w);
            let start = *next.keys().find(is_first).or(next.keys().next()).expect("a triangle");
            let (mut at, mut steps) = (next[&start], 1);
            while at != start && next.contains_key(&at) {
                at = next[&at];
                steps += 1;
            }
            steps == next.len()
        })
    }
}

/// Directed edges without the opposite ones.
pub fn boundary(cells: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let directed = directed_edges(cells);
    directed.iter().copied().filter(|&[a, b]| !directed.contains(&[b, a])).collect()
}

impl Exact {
    /// The numbers of a map, all of which are finite, exactly.
    pub fn new(map: &Map) -> Self {
        let points =
            |rows: &[Vec<f64>]| -> Vec<Rational> { rows.iter().map(|p| rational([p[0], p[1], p[2]])).collect() };
        let positions = points(&map.positions);
        let corners = |cell: &Vec<u32>| [0, 1, 2].map(|i| positions[cell[i] as usize].clone());
        let set = |pairs: &Vec<[u32; 2]>| pairs.iter().map(|pair| pair.map(|n| n as usize)).collect();
        Exact {
            cells: map.source_cells.clone(),
            triangles: map.source_cells.iter().map(corners).collect(),
            levels: map.levels.iter().map(|level| points(level)).collect(),
            prisms: map.prisms.clone(),
            pairs: map.pairs.as_ref().map(set),
        }
    }

    fn are_paired(&self, c: usize, q: usize) -> bool {
        self.pairs.as_ref().is_none_or(|pairs| pairs.contains(&[c, q]))
    }

    /// The triangles that belong to a prism.
    fn of_prism(&self, q: usize) -> impl Iterator<Item = (&Vec<u32>, &[Rational; 3])> {
        let all = self.cells.iter().zip(&self.triangles).enumerate();
        all.filter(move |(c, _)| self.are_paired(*c, q)).map(|(_, triangle)| triangle)
    }

    pub fn at(&self, (column, level): Corner) -> &Rational {
        &self.levels[level][column as usize]
    }

    fn is_pinched(&self, v: u32) -> bool {
        self.at((v, 0)) == self.at((v, 1)) && self.at((v, 1)) == self.at((v, 2))
    }

    fn slabs(&self) -> impl Iterator<Item = (usize, &Vec<u32>, usize)> {
        self.prisms.iter().enumerate().flat_map(|(q, cell)| [(q, cell, 0), (q, cell, 1)])
    }

    /// By the page: `det(u_i - l_i, x - l_i, y - l_i)` for all choices.
    pub fn tetrahedra(&self, cell: &[u32], low: usize) -> Vec<[Rational; 4]> {
        let mut found = vec![];
        for i in (0..3).filter(|&i| !self.is_pinched(cell[i])) {
            for (x, y) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let corners =
                    [(cell[i], low), (cell[i], low + 1), (cell[(i + 1) % 3], low + x), (cell[(i + 2) % 3], low + y)];
                found.push(corners.map(|corner| self.at(corner).clone()));
            }
        }
        found
    }

    fn is_positive(&self) -> bool {
        self.slabs().all(|(_, cell, low)| {
            cell.iter().filter(|&&v| self.is_pinched(v)).count() <= 1
                && self
                    .tetrahedra(cell, low)
                    .iter()
                    .all(|[l, u, x, y]| dot(&minus(u, l), &normal(&[l.clone(), x.clone(), y.clone()])) > RBig::ZERO)
        })
    }

    fn keeps_off_bottom_and_top(&self) -> bool {
        self.prisms.iter().enumerate().all(|(q, cell)| {
            [0, 2].iter().all(|&level| {
                let end = [0, 1, 2].map(|i| self.at((cell[i], level)).clone());
                self.of_prism(q).all(|(_, triangle)| {
                    let allowed = |p: &Rational| {
                        let is_pinched = cell.iter().any(|&v| self.is_pinched(v) && self.at((v, level)) == p);
                        is_pinched && triangle.contains(p)
                    };
                    are_apart(triangle, &end) || within_triangle(triangle, &end).iter().all(allowed)
                })
            })
        })
    }

    /// The point of a vertex of the source that lies in a triangle.
    pub fn position(&self, v: u32) -> &Rational {
        let place = |cell: &Vec<u32>| cell.iter().position(|&w| w == v);
        self.cells.iter().zip(&self.triangles).find_map(|(cell, t)| Some(&t[place(cell)?])).expect("in a triangle")
    }

    /// L1: the boundary edges as pairs of points, and different points of boundary vertices.
    fn has_common_boundary(&self) -> bool {
        let ends = [boundary(&self.cells), boundary(&self.prisms)];
        let mut points = [
            ends[0].iter().map(|e| e.map(|v| self.position(v))).collect::<Vec<_>>(),
            ends[1].iter().map(|e| e.map(|v| self.at((v, 1)))).collect::<Vec<_>>(),
        ];
        points.iter_mut().for_each(|list| list.sort());
        let differ = |k: usize| {
            let vertices: BTreeSet<u32> = ends[k].iter().flatten().copied().collect();
            vertices.len() == points[k].iter().flatten().collect::<BTreeSet<_>>().len()
        };
        points[0] == points[1] && differ(0) && differ(1)
    }

    /// L3 at walls, all triangles with all.
    fn keeps_inside_of_walls(&self) -> bool {
        boundary(&self.prisms).iter().all(|&[i, j]| {
            let prism = self.prisms.iter().position(|cell| directed_edges(&[cell.to_vec()]).contains(&[i, j]));
            let prism = prism.expect("a prism at the edge");
            let third = *self.prisms[prism].iter().find(|v| ![i, j].contains(v)).expect("a column");
            let middles = [i, j].map(|v| self.at((v, 1)));
            let ends = boundary(&self.cells).into_iter().find(|e| e.map(|v| self.position(v)) == middles);
            let [v, w] = ends.expect("as both surfaces have these edges");
            let triples = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
            triples.iter().flat_map(|triple| [(triple, 0), (triple, 1)]).all(|(triple, low)| {
                let corners = [(i, low), (j, low), (i, low + 1), (j, low + 1)];
                let wall = triple.map(|n| self.at(corners[n]).clone());
                let side = |x: &Rational| dot(&normal(&wall), &minus(x, &wall[0]));
                let is_proper = wall[0] != wall[1] && wall[1] != wall[2] && wall[2] != wall[0];
                let is_inside = |x: &Rational| side(x) * side(self.at((third, low))) > RBig::ZERO;
                !is_proper
                    || self.of_prism(prism).all(|(cell, triangle)| {
                        let held = |n: usize, v: u32| cell.contains(&v) && wall.contains(middles[n]);
                        let common = || match are_apart(triangle, &wall) {
                            true => vec![],
                            false => within_triangle(triangle, &wall),
                        };
                        match (held(0, v), held(1, w)) {
                            (false, false) => common().is_empty(),
                            (true, false) => common().iter().all(|p| p == middles[0]),
                            (false, true) => common().iter().all(|p| p == middles[1]),
                            (true, true) => {
                                let mut others = cell.iter().filter(|u| ![v, w].contains(u));
                                let step = minus(middles[1], middles[0]);
                                others.all(|&u| is_inside(self.position(u)))
                                    && common().iter().all(|p| cross(&minus(p, middles[0]), &step) == [RBig::ZERO; 3])
                            }
                        }
                    })
            })
        })
    }

    fn is_crossed_from_below(&self) -> bool {
        self.slabs().all(|(q, cell, low)| {
            self.of_prism(q).all(|(_, triangle)| {
                let normal = normal(triangle);
                let is_positive =
                    |&&v: &&u32| dot(&normal, &minus(self.at((v, low + 1)), self.at((v, low)))) > RBig::ZERO;
                let mut pillars = cell.iter().filter(|&&v| !self.is_pinched(v));
                pillars.all(|v| is_positive(&v))
                    || self.tetrahedra(cell, low).iter().all(|t| {
                        are_apart(triangle, t) || {
                            let common = within_tetrahedron(triangle, t);
                            common.is_empty() || !span_an_area(&common)
                        }
                    })
            })
        })
    }

    /// The tetrahedra of the decomposition, by the page.
    fn decomposition(&self, cell: &[u32], low: usize) -> Vec<[Corner; 4]> {
        let mut order = [cell[0], cell[1], cell[2]];
        order.sort_unstable();
        let [i, j, k] = order;
        let (l, u) = (low, low + 1);
        let all = [
            (k, [(i, l), (j, l), (k, l), (k, u)]),
            (j, [(i, l), (j, l), (j, u), (k, u)]),
            (i, [(i, l), (i, u), (j, u), (k, u)]),
        ];
        all.into_iter().filter(|(pillar, _)| !self.is_pinched(*pillar)).map(|(_, t)| t).collect()
    }

    /// Preimages of a point of a triangle, by their weights on columns and levels.
    fn preimages(&self, c: usize, x: &Rational) -> BTreeSet<BTreeMap<Corner, RBig>> {
        let mut found = BTreeSet::new();
        let slabs = self.slabs().filter(|(q, ..)| self.are_paired(c, *q));
        for corners in slabs.flat_map(|(_, cell, low)| self.decomposition(cell, low)) {
            let points = corners.map(|corner| self.at(corner).clone());
            if are_apart(std::slice::from_ref(x), &points) {
                continue;
            }
            let volume =
                |p: &[Rational; 4]| dot(&minus(&p[3], &p[0]), &normal(&[p[0].clone(), p[1].clone(), p[2].clone()]));
            let mut weights = BTreeMap::new();
            let mut is_inside = true;
            for i in 0..4 {
                let mut replaced = points.clone();
                replaced[i] = x.clone();
                let weight = volume(&replaced) / volume(&points);
                is_inside &= weight >= RBig::ZERO;
                if weight > RBig::ZERO {
                    let (v, level) = corners[i];
                    weights.insert((v, if self.is_pinched(v) { 0 } else { level }), weight);
                }
            }
            if is_inside {
                found.insert(weights);
            }
        }
        found
    }

    /// L5, by a point of each triangle: by the theorem's proof their numbers agree in a component.
    fn covers_once(&self) -> bool {
        self.triangles.iter().enumerate().all(|(number, triangle)| {
            let [a, b, c] = [0.40625, 0.328125, 0.265625].map(|w| RBig::try_from(w).expect("a number"));
            let x = [0, 1, 2].map(|i| &a * &triangle[0][i] + &b * &triangle[1][i] + &c * &triangle[2][i]);
            self.preimages(number, &x).len() == 1
        })
    }

    /// L6, over each prism, by points at the heights where a fibre bends.
    fn is_met_once(&self) -> bool {
        self.prisms.iter().enumerate().all(|(q, cell)| {
            let mut order = [cell[0], cell[1], cell[2]];
            order.sort_unstable();
            let weights = [0.390625, 0.34375, 0.265625].map(|w| RBig::try_from(w).expect("a number"));
            let point = |low: usize, height: &RBig| -> Rational {
                // High weights: the last column takes what it can, then the one before it, then the first.
                let mut rest = height.clone();
                let mut sum = [RBig::ZERO, RBig::ZERO, RBig::ZERO];
                for n in [2, 1, 0] {
                    let high = if rest < weights[n] { rest.clone() } else { weights[n].clone() };
                    rest -= &high;
                    let (l, u) = (self.at((order[n], low)), self.at((order[n], low + 1)));
                    (0..3).for_each(|x| sum[x] += &high * &u[x] + (&weights[n] - &high) * &l[x]);
                }
                sum
            };
            let heights = [RBig::ZERO, weights[2].clone(), &weights[1] + &weights[2], RBig::ONE];
            let mut met = BTreeSet::new();
            for (low, k) in (0..6).map(|k| (k / 3, k % 3)) {
                let segment = [point(low, &heights[k]), point(low, &heights[k + 1])];
                let near =
                    |(c, triangle): &(usize, &[Rational; 3])| self.are_paired(*c, q) && !are_apart(&segment, *triangle);
                for (c, triangle) in self.triangles.iter().enumerate().filter(near) {
                    met.extend(within_triangle(&segment, triangle).into_iter().map(|p| (c, p)));
                }
            }
            met.len() == 1
        })
    }
}

/// Whether the smallest boxes around points do not meet.
pub fn are_apart(a: &[Rational], b: &[Rational]) -> bool {
    let is_below = |a: &[Rational], b: &[Rational], x: usize| a.iter().all(|p| b.iter().all(|q| p[x] < q[x]));
    (0..3).any(|x| is_below(a, b, x) || is_below(b, a, x))
}
