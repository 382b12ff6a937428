//! Shells round surfaces that cross themselves, and rules I1 to I4, naively: all pairs, rational numbers.

use super::Map;
use super::clip::{Rational, within_tetrahedron, within_triangle};
use super::shells::{
    Exact, Mesh, are_apart, boundary, directed_edges, hexagon, joined, octahedron, over_plane, shell, starred, turned,
};
use serde_json::json;
use std::collections::BTreeSet;

/// A strip that winds one and a quarter times round the third axis, and crosses itself over the quarter.
pub fn ramp() -> Mesh {
    let mut mesh: Mesh = (vec![], vec![]);
    let heights = [-0.5, 0.5, 0.25, -0.25, 0.375, -0.375];
    let around = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    for (k, height) in (0..6).zip(heights) {
        let [x, y]: [f64; 2] = around[k as usize % 4];
        mesh.0.extend([[x, y, height], [3.0 * x, 3.0 * y, height + 0.125]]);
        if k > 0 {
            let [a, b, c, d] = [2 * k - 2, 2 * k - 1, 2 * k, 2 * k + 1];
            mesh.1.extend([[a, b, d], [a, d, c]]);
        }
    }
    mesh
}

/// Vertices of a tube once round the third axis, and round the tube.
const TUBE: [u32; 2] = [9, 9];

/// The triangles of a tube that winds once.
pub const TUBE_TRIANGLES: u32 = 2 * TUBE[0] * TUBE[1];

/// A tube that winds twice round the third axis before it closes, and crosses itself; once with `turns` 1.
pub fn tube_round(turns: u32, radius: impl Fn(f64) -> f64) -> Mesh {
    let (m, n) = (TUBE[0] * turns, TUBE[1]);
    let mut mesh: Mesh = (vec![], vec![]);
    for (i, j) in (0..m * n).map(|k| (k / n, k % n)) {
        let [s, t] =
            [f64::from(i) / f64::from(TUBE[0]), f64::from(j) / f64::from(n)].map(|x| std::f64::consts::TAU * x);
        let r = radius(s);
        mesh.0.push([(3. + r * t.cos()) * s.cos(), (3. + r * t.cos()) * s.sin(), r * t.sin()]);
        let at = |i: u32, j: u32| i % m * n + j % n;
        mesh.1.extend([[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    }
    mesh
}

/// How thick the tube is that winds twice: never the same at both visits of an angle in which vertices lie.
pub fn uneven(s: f64) -> f64 {
    1.0 + 0.0625 * (s / 2.0 + 0.25).cos()
}

/// A shell of the tube that winds twice.
pub fn around_tube_twice(source: &Mesh) -> Map {
    let level = |factor: f64| tube_round(2, |s| factor * uneven(s));
    shell(source, &level(1.0).1, [&level(0.5).0, &level(1.0).0, &level(1.5).0])
}

/// The map with the fewest pairs that hold some to begin with and satisfy I3 and I4.
pub fn immersed(mut map: Map, seeds: impl IntoIterator<Item = [u32; 2]>) -> Map {
    let exact = Exact::new(&map);
    let mut pairs: BTreeSet<[usize; 2]> = seeds.into_iter().map(|pair| pair.map(|n| n as usize)).collect();
    let mut waiting: Vec<[usize; 2]> = pairs.iter().copied().collect();
    while let Some(pair) = waiting.pop() {
        waiting.extend(exact.beside(pair).into_iter().filter(|&other| pairs.insert(other)));
    }
    map.pairs = Some(pairs.into_iter().map(|pair| pair.map(|n| n as u32)).collect());
    map.manifest["target"] = json!("immersed-shell");
    map.sign();
    map
}

/// Shells of surfaces that cross themselves, and of some that do not.
pub fn immersed_shells() -> Vec<(&'static str, Map)> {
    let (ramp, o, h) = (ramp(), octahedron(), hexagon(1));
    let same = |count: u32| (0..count).map(|c| [c, c]);
    let thirds = |count: u32| (0..3 * count).map(|c| [c, c / 3]);
    let two = joined(&o, &turned(&o, 1.0), [0.75, 0.25, 0.125]);
    let level = |factor: f64| {
        let scaled = |mesh: &Mesh| (mesh.0.iter().map(|p| p.map(|x| factor * x)).collect(), vec![]);
        joined(&scaled(&o), &scaled(&turned(&o, 1.0)), [0.75, 0.25, 0.125]).0
    };
    let mut leaning = h.clone();
    leaning.0.iter_mut().for_each(|p| p[2] += 0.5 * p[0] + 0.0625);
    let hexagons = joined(&h, &leaning, [0.5, 0.0, 0.0]);
    let mut pinched = over_plane(&ramp, &ramp, [-1.0, 1.0]);
    let point = pinched.levels[1][5].clone();
    pinched.levels.iter_mut().for_each(|level| level[5] = point.clone());
    vec![
        ("octahedron", immersed(super::shells::around(&o, &o, [0.75, 1.25]), same(8))),
        ("ramp", immersed(over_plane(&ramp, &ramp, [-1.0, 1.0]), same(10))),
        ("thin ramp", immersed(over_plane(&ramp, &ramp, [-0.125, 0.125]), same(10))),
        ("finer ramp", immersed(over_plane(&flatly_starred(&ramp), &ramp, [-1.0, 1.0]), thirds(10))),
        ("ramp, pinched at the boundary", immersed(pinched, same(10))),
        ("octahedra that cross", immersed(shell(&two, &two.1, [&level(0.75), &two.0, &level(1.25)]), same(16))),
        ("hexagons that cross", immersed(over_plane(&hexagons, &hexagons, [-2.0, 2.0]), same(12))),
    ]
}

/// Three triangles from each, with a vertex a little above the middle.
fn flatly_starred(mesh: &Mesh) -> Mesh {
    let (mut positions, cells) = starred(mesh);
    for (p, cell) in positions.iter_mut().skip(mesh.0.len()).zip(&mesh.1) {
        let sum = |x: usize| cell.iter().map(|&v| mesh.0[v as usize][x]).sum::<f64>();
        *p = [0.34375 * sum(0), 0.328125 * sum(1), 0.34375 * sum(2) + 0.0625];
    }
    (positions, cells)
}

impl Exact {
    /// I1 to I4 by the page.
    pub fn has_complete_pairs(&self, listed: &[[u32; 2]]) -> bool {
        let Some(pairs) = &self.pairs else { return true };
        let exist = pairs.iter().all(|&[c, q]| c < self.cells.len() && q < self.prisms.len());
        let is_ascending = listed.windows(2).all(|two| two[0] < two[1]);
        exist && is_ascending && self.has_boundary_pairs(pairs) && {
            pairs.iter().all(|&pair| self.beside(pair).iter().all(|other| pairs.contains(other)))
        }
    }

    fn has_boundary_pairs(&self, pairs: &BTreeSet<[usize; 2]>) -> bool {
        let cell_at = |cells: &[Vec<u32>], edge: [u32; 2]| {
            cells.iter().position(|cell| directed_edges(std::slice::from_ref(cell)).contains(&edge)).expect("a cell")
        };
        let of_source = boundary(&self.cells);
        boundary(&self.prisms).into_iter().all(|edge| {
            let same = |other: &[u32; 2]| other.map(|v| self.position(v)) == edge.map(|v| self.at((v, 1)));
            let other = *of_source.iter().find(|other| same(other)).expect("as both surfaces have it");
            pairs.contains(&[cell_at(&self.cells, other), cell_at(&self.prisms, edge)])
        })
    }

    /// The pairs that I3 and I4 ask for beside one.
    pub fn beside(&self, [c, q]: [usize; 2]) -> Vec<[usize; 2]> {
        let share = |a: &[u32], b: &[u32]| {
            let common: Vec<u32> = a.iter().copied().filter(|v| b.contains(v)).collect();
            <[u32; 2]>::try_from(common).ok()
        };
        let prisms = (0..self.prisms.len()).filter(|&other| {
            let edge = share(&self.prisms[q], &self.prisms[other]);
            edge.is_some_and(|edge| self.meets_walls(c, edge))
        });
        let triangles = (0..self.cells.len()).filter(|&other| {
            let edge = share(&self.cells[c], &self.cells[other]);
            edge.is_some_and(|edge| self.meets_prism(edge.map(|v| self.position(v).clone()), q))
        });
        prisms.map(|other| [c, other]).chain(triangles.map(|other| [other, q])).collect()
    }

    /// Whether a triangle meets one of the triangles with corners in the sides of both slabs over an edge.
    fn meets_walls(&self, c: usize, [i, j]: [u32; 2]) -> bool {
        [0, 1].into_iter().any(|low| {
            let side = [(i, low), (i, low + 1), (j, low), (j, low + 1)].map(|corner| self.at(corner));
            [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].into_iter().any(|three| {
                let wall = three.map(|n| side[n].clone());
                let is_proper = wall[0] != wall[1] && wall[1] != wall[2] && wall[2] != wall[0];
                is_proper
                    && !are_apart(&wall, &self.triangles[c])
                    && !within_triangle(&self.triangles[c], &wall).is_empty()
            })
        })
    }

    fn meets_prism(&self, segment: [Rational; 2], q: usize) -> bool {
        let mut cells = [0, 1].into_iter().flat_map(|low| self.tetrahedra(&self.prisms[q], low));
        cells.any(|cell| !are_apart(&segment, &cell) && !within_tetrahedron(&segment, &cell).is_empty())
    }
}
