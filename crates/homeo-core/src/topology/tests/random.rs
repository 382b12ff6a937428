//! Random complexes: nothing panics, and the answers agree with direct definitions.

use std::collections::{BTreeMap, BTreeSet};

use crate::mesh::{TetrahedronComplex, TriangleComplex};
use crate::topology::*;

struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % u64::from(bound)) as u32
    }

    fn cells<const K: usize>(&mut self, vertices: u32, count: u32) -> Vec<[u32; K]> {
        (0..count).map(|_| [(); K].map(|()| self.below(vertices))).collect()
    }

    fn points(&mut self, count: u32) -> Vec<[f64; 3]> {
        (0..count).map(|_| [(); 3].map(|()| f64::from(self.below(4)))).collect()
    }
}

/// Cells with different vertices, each set once, as sorted lists.
fn proper<const K: usize>(cells: &[[u32; K]]) -> BTreeSet<Vec<u32>> {
    let sets = cells.iter().map(|cell| cell.iter().copied().collect::<BTreeSet<u32>>());
    sets.filter(|set| set.len() == K).map(|set| set.into_iter().collect()).collect()
}

/// The simplices opposite `vertex` in the cells that contain it.
fn link(cells: &BTreeSet<Vec<u32>>, vertex: u32) -> BTreeSet<Vec<u32>> {
    let around = cells.iter().filter(|cell| cell.contains(&vertex));
    around.map(|cell| cell.iter().copied().filter(|&v| v != vertex).collect()).collect()
}

/// Whether a graph is one path or one cycle.
fn is_path_or_cycle(edges: &BTreeSet<Vec<u32>>) -> bool {
    let mut degree: BTreeMap<u32, usize> = BTreeMap::new();
    edges.iter().flatten().for_each(|&v| *degree.entry(v).or_default() += 1);
    degree.values().all(|&d| d <= 2) && is_connected(edges)
}

fn is_connected(simplices: &BTreeSet<Vec<u32>>) -> bool {
    let vertices: BTreeSet<u32> = simplices.iter().flatten().copied().collect();
    let mut reached: BTreeSet<u32> = vertices.iter().take(1).copied().collect();
    loop {
        let touching = simplices.iter().filter(|s| s.iter().any(|v| reached.contains(v)));
        let next: BTreeSet<u32> = touching.flatten().copied().collect();
        if next.len() <= reached.len() {
            return reached.len() == vertices.len();
        }
        reached = next;
    }
}

/// Whether triangles form a sphere or a disk, by definition: a connected surface with Euler
/// characteristic 2, or 1 and a boundary.
fn is_sphere_or_disk(triangles: &BTreeSet<Vec<u32>>) -> bool {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for t in triangles {
        [[t[0], t[1]], [t[0], t[2]], [t[1], t[2]]].into_iter().for_each(|e| *edges.entry(e).or_default() += 1);
    }
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let is_surface = edges.values().all(|&count| count <= 2)
        && is_connected(triangles)
        && vertices.iter().all(|&v| is_path_or_cycle(&link(triangles, v)));
    let euler = vertices.len() as i64 - edges.len() as i64 + triangles.len() as i64;
    let has_boundary = edges.values().any(|&count| count == 1);
    is_surface && euler == if has_boundary { 1 } else { 2 }
}

#[test]
fn tetrahedra_agree_with_the_definitions() {
    let mut dice = Dice(11);
    let mut seen = [0; 2];
    for case in 0..4000 {
        let vertices = 5 + case % 5;
        let count = 1 + dice.below(9);
        let cells = dice.cells::<4>(vertices, count);
        let complex = TetrahedronComplex::from_indices(vertices as usize, &cells).unwrap();
        let points = if case % 2 == 0 { dice.points(vertices) } else { Vec::new() };
        let report = analyse_tetrahedra(&points, &complex, Options { intersections: Intersections::Find });
        let proper = proper(&cells);
        let used: BTreeSet<u32> = proper.iter().flatten().copied().collect();
        let mut facets: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        for cell in &proper {
            (0..4).for_each(|i| *facets.entry([&cell[..i], &cell[i + 1..]].concat()).or_default() += 1);
        }
        assert_eq!(report.facet_manifold, proper.len() == cells.len() && facets.values().all(|&n| n <= 2));
        assert_eq!((report.faces, report.isolated_vertices), (facets.len(), vertices as usize - used.len()));
        if facets.values().all(|&n| n <= 2) {
            let bad = used.iter().filter(|&&v| !is_sphere_or_disk(&link(&proper, v))).count();
            assert_eq!(report.bad_vertex_links, bad, "{cells:?}");
            seen[usize::from(bad == 0)] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
}

#[test]
fn triangles_agree_with_the_definitions() {
    let mut dice = Dice(12);
    let mut seen = [0; 2];
    for case in 0..6000 {
        let vertices = 4 + case % 6;
        let count = 1 + dice.below(10);
        let cells = dice.cells::<3>(vertices, count);
        let complex = TriangleComplex::from_indices(vertices as usize, &cells).unwrap();
        let points = if case % 2 == 0 { dice.points(vertices) } else { Vec::new() };
        let report = analyse_triangles(&points, &complex, Options { intersections: Intersections::Find });
        let proper = proper(&cells);
        let used: BTreeSet<u32> = proper.iter().flatten().copied().collect();
        let mut edges: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        for cell in &proper {
            (0..3).for_each(|i| *edges.entry([&cell[..i], &cell[i + 1..]].concat()).or_default() += 1);
        }
        let is_edge_manifold = edges.values().all(|&n| n <= 2);
        assert_eq!(report.edge_manifold, proper.len() == cells.len() && is_edge_manifold);
        assert_eq!(report.boundary_edges, edges.values().filter(|&&n| n == 1).count());
        if is_edge_manifold {
            let is_good = used.iter().all(|&v| is_path_or_cycle(&link(&proper, v)));
            assert_eq!(report.vertex_manifold, is_good, "{cells:?}");
            let edges_of_loops: usize = report.boundary.unwrap().iter().map(|l| l.edges).sum();
            assert_eq!(edges_of_loops, report.boundary_edges);
            seen[usize::from(is_good)] += 1;
        }
        assert_eq!(report.components == 1, !proper.is_empty() && is_connected(&proper));
    }
    assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
}
