//! Small meshes and shells, and the definition of a valid shell, checked naively: all pairs, rational numbers.

use super::clip::{Rational, dot, minus, normal, rational, span_an_area, within_tetrahedron, within_triangle};
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

pub fn all_shells() -> Vec<(&'static str, Map)> {
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

struct Exact {
    triangles: Vec<[Rational; 3]>,
    levels: Vec<Vec<Rational>>,
    prisms: Vec<Vec<u32>>,
}

/// Whether a shell is valid, and has the counts and the hash that its manifest states.
pub fn is_valid(map: &Map) -> bool {
    let source = &map.manifest["source"];
    let counts = [map.positions.len(), map.source_cells.len()].map(|n| Some(n as u64));
    let is_counted = [source["vertices"].as_u64(), source["cells"].as_u64()] == counts
        && source["content_sha256"] == write::content_hash(map)
        && map.levels.iter().all(|level| level.len() == map.levels[0].len());
    let all_points = || map.positions.iter().chain(map.levels.iter().flatten());
    if !is_counted || all_points().flatten().any(|x| !x.is_finite()) {
        return false;
    }
    let points = |rows: &[Vec<f64>]| -> Vec<Rational> { rows.iter().map(|p| rational([p[0], p[1], p[2]])).collect() };
    if !is_closed_surface(&map.source_cells, map.positions.len())
        || !is_closed_surface(&map.prisms, map.levels[0].len())
    {
        return false;
    }
    let positions = points(&map.positions);
    let corners = |cell: &Vec<u32>| [0, 1, 2].map(|i| positions[cell[i] as usize].clone());
    let shell = Exact {
        triangles: map.source_cells.iter().map(corners).collect(),
        levels: map.levels.iter().map(|level| points(level)).collect(),
        prisms: map.prisms.clone(),
    };
    let has_area = |t: &[Rational; 3]| span_an_area(t);
    shell.triangles.iter().all(has_area)
        && shell.is_positive()
        && shell.keeps_off_bottom_and_top()
        && shell.is_crossed_from_below()
        && shell.covers_once()
        && shell.is_met_once()
}

/// Every directed edge once and once in the other direction, round every vertex one loop, no triangle twice.
fn is_closed_surface(cells: &[Vec<u32>], count: usize) -> bool {
    let directed: Vec<(u32, u32)> = cells.iter().flat_map(|c| [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])]).collect();
    let set: BTreeSet<(u32, u32)> = directed.iter().copied().collect();
    let sets: BTreeSet<BTreeSet<u32>> = cells.iter().map(|cell| cell.iter().copied().collect()).collect();
    let is_simple = set.len() == directed.len()
        && set.iter().all(|&(a, b)| a != b && (a as usize) < count && set.contains(&(b, a)))
        && sets.len() == cells.len();
    is_simple && {
        let vertices: BTreeSet<u32> = cells.iter().flatten().copied().collect();
        vertices.into_iter().all(|v| {
            let star = cells.iter().filter(|cell| cell.contains(&v));
            let after = |cell: &Vec<u32>, k: usize| cell[(cell.iter().position(|w| *w == v).expect("in it") + k) % 3];
            let next: BTreeMap<u32, u32> = star.map(|cell| (after(cell, 1), after(cell, 2))).collect();
            let start = *next.keys().next().expect("a triangle");
            let (mut at, mut steps) = (next[&start], 1);
            while at != start {
                at = next[&at];
                steps += 1;
            }
            steps == next.len()
        })
    }
}

impl Exact {
    fn at(&self, (column, level): Corner) -> &Rational {
        &self.levels[level][column as usize]
    }

    fn is_pinched(&self, v: u32) -> bool {
        self.at((v, 0)) == self.at((v, 1)) && self.at((v, 1)) == self.at((v, 2))
    }

    fn slabs(&self) -> impl Iterator<Item = (&Vec<u32>, usize)> {
        self.prisms.iter().flat_map(|cell| [(cell, 0), (cell, 1)])
    }

    /// By the page: `det(u_i - l_i, x - l_i, y - l_i)` for all choices.
    fn tetrahedra(&self, cell: &[u32], low: usize) -> Vec<[Rational; 4]> {
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
        self.slabs().all(|(cell, low)| {
            cell.iter().filter(|&&v| self.is_pinched(v)).count() <= 1
                && self
                    .tetrahedra(cell, low)
                    .iter()
                    .all(|[l, u, x, y]| dot(&minus(u, l), &normal(&[l.clone(), x.clone(), y.clone()])) > RBig::ZERO)
        })
    }

    fn keeps_off_bottom_and_top(&self) -> bool {
        self.prisms.iter().all(|cell| {
            [0, 2].iter().all(|&level| {
                let end = [0, 1, 2].map(|i| self.at((cell[i], level)).clone());
                self.triangles.iter().all(|triangle| {
                    let allowed = |p: &Rational| {
                        let is_pinched = cell.iter().any(|&v| self.is_pinched(v) && self.at((v, level)) == p);
                        is_pinched && triangle.contains(p)
                    };
                    are_apart(triangle, &end) || within_triangle(triangle, &end).iter().all(allowed)
                })
            })
        })
    }

    fn is_crossed_from_below(&self) -> bool {
        self.slabs().all(|(cell, low)| {
            self.triangles.iter().all(|triangle| {
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

    /// Preimages of a point, by their weights on columns and levels.
    fn preimages(&self, x: &Rational) -> BTreeSet<BTreeMap<Corner, RBig>> {
        let mut found = BTreeSet::new();
        for corners in self.slabs().flat_map(|(cell, low)| self.decomposition(cell, low)) {
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
        self.triangles.iter().all(|triangle| {
            let [a, b, c] = [0.40625, 0.328125, 0.265625].map(|w| RBig::try_from(w).expect("a number"));
            let x = [0, 1, 2].map(|i| &a * &triangle[0][i] + &b * &triangle[1][i] + &c * &triangle[2][i]);
            self.preimages(&x).len() == 1
        })
    }

    /// L6, over each prism, by points at the heights where a fibre bends.
    fn is_met_once(&self) -> bool {
        self.prisms.iter().all(|cell| {
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
                let near = |(_, triangle): &(usize, &[Rational; 3])| !are_apart(&segment, *triangle);
                for (c, triangle) in self.triangles.iter().enumerate().filter(near) {
                    met.extend(within_triangle(&segment, triangle).into_iter().map(|p| (c, p)));
                }
            }
            met.len() == 1
        })
    }
}

/// Whether the smallest boxes around points do not meet.
fn are_apart(a: &[Rational], b: &[Rational]) -> bool {
    let is_below = |a: &[Rational], b: &[Rational], x: usize| a.iter().all(|p| b.iter().all(|q| p[x] < q[x]));
    (0..3).any(|x| is_below(a, b, x) || is_below(b, a, x))
}
