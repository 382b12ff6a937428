//! Rule 8: manifolds with boundary by their vertex links, and their topological type.
//!
//! *Theorem (classification of compact surfaces).* A connected surface is a sphere when it has no boundary and
//! Euler number 2, a disk when it has a boundary and Euler number 1, an annulus when it has two boundary loops
//! and Euler number 0. The link of a vertex of a 3-complex is a surface when every facet has at most two cells
//! and the cells around every edge are connected through facets; so these checks need no search.

use crate::complex::{Complex, TETRAHEDRON_EDGES, UnionFind, edge_place, edge_vertices};
use crate::verdict::{Checked, refuted};

/// What tells apart the manifolds that occur here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Number of components.
    pub(crate) components: usize,
    /// Vertices - edges + triangles - tetrahedra.
    pub(crate) euler: i64,
    /// Number of components of the boundary.
    pub(crate) boundaries: usize,
}

/// Checks that every vertex link is a sphere or a ball, and returns the topological numbers.
pub(crate) fn check_manifold(complex: &Complex, rule: &'static str, what: &str) -> Checked<Shape> {
    let edges = complex.sorted_edges();
    check_edge_links(complex, &edges, rule, what)?;
    check_vertex_stars(complex, rule, what)?;
    if complex.size == 4 {
        check_vertex_links(complex, &edges, rule, what)?;
    }
    shape(complex, edges.chunk_by(same_edge).count(), rule)
}

fn same_edge(a: &u128, b: &u128) -> bool {
    a >> 32 == b >> 32
}

/// The cells around each edge are one path or cycle: those that facets connect are all of them.
fn check_edge_links(complex: &Complex, edges: &[u128], rule: &'static str, what: &str) -> Checked {
    let mut classes = UnionFind::new(edges.len());
    for (a, b) in complex.inner_facets().take_while(|_| !edges.is_empty()) {
        for (e, [i, j]) in TETRAHEDRON_EDGES.iter().enumerate() {
            if *i == a % 4 || *j == a % 4 {
                continue; // not an edge of this facet
            }
            let ends = [complex.cell(a / 4)[*i], complex.cell(a / 4)[*j]];
            let other = complex.cell(b / 4);
            let found = TETRAHEDRON_EDGES.iter().position(|f| f.iter().all(|&k| ends.contains(&other[k])));
            found.into_iter().for_each(|f| classes.join(a / 4 * 6 + e, b / 4 * 6 + f));
        }
    }
    for group in edges.chunk_by(same_edge) {
        let mut roots = group.iter().map(|&key| edge_place(key)).map(|(c, e)| (c, classes.find(6 * c + e)));
        let Some((cell, first)) = roots.next() else { continue };
        if let Some((other, _)) = roots.find(|&(_, root)| root != first) {
            let message = format!("{what}: the cells around an edge are not connected through facets");
            return refuted(rule, message, &[cell, other], &edge_vertices(group[0]));
        }
    }
    Ok(())
}

/// The cells around each vertex are connected through facets that contain it.
fn check_vertex_stars(complex: &Complex, rule: &'static str, what: &str) -> Checked {
    let size = complex.size;
    let mut classes = UnionFind::new(size * complex.count());
    for (a, b) in complex.inner_facets() {
        let (first, second) = (a / size, b / size);
        for (i, v) in complex.cell(first).iter().enumerate().filter(|(i, _)| *i != a % size) {
            let found = complex.cell(second).iter().position(|w| w == v);
            found.into_iter().for_each(|j| classes.join(size * first + i, size * second + j));
        }
    }
    let mut first_class = vec![None; complex.vertex_count];
    for c in 0..complex.count() {
        for (i, &v) in complex.cell(c).iter().enumerate() {
            let class = classes.find(size * c + i);
            let first = *first_class[v as usize].get_or_insert(class as u32) as usize;
            if first != class {
                let message = format!("{what}: the cells around a vertex are not connected through facets");
                return refuted(rule, message, &[first / size, c], &[v]);
            }
        }
    }
    Ok(())
}

/// Each vertex link, a connected surface by the checks before, is a sphere (inside) or a disk (on the boundary).
fn check_vertex_links(complex: &Complex, edges: &[u128], rule: &'static str, what: &str) -> Checked {
    let mut euler = vec![0i64; complex.vertex_count];
    let mut expected = vec![2i64; complex.vertex_count];
    edges.chunk_by(same_edge).flat_map(|group| edge_vertices(group[0])).for_each(|v| euler[v as usize] += 1);
    let add_facet = |euler: &mut Vec<i64>, slot| complex.facet(slot).0.iter().for_each(|&v| euler[v as usize] -= 1);
    complex.inner_facets().for_each(|(slot, _)| add_facet(&mut euler, slot));
    for slot in complex.boundary_slots() {
        add_facet(&mut euler, slot);
        complex.facet(slot).0.iter().for_each(|&v| expected[v as usize] = 1);
    }
    (0..complex.count()).flat_map(|c| complex.cell(c)).for_each(|&v| euler[v as usize] += 1);
    for c in 0..complex.count() {
        if let Some(&v) = complex.cell(c).iter().find(|&&v| euler[v as usize] != expected[v as usize]) {
            let message = format!("{what}: the link of vertex {v} is neither a sphere nor a disk");
            return refuted(rule, message, &[c], &[v]);
        }
    }
    Ok(())
}

/// Components, Euler number and boundary components of a manifold.
pub(crate) fn shape(complex: &Complex, edge_count: usize, rule: &'static str) -> Checked<Shape> {
    let size = complex.size;
    let mut classes = UnionFind::new(complex.count());
    complex.inner_facets().for_each(|(a, b)| classes.join(a / size, b / size));
    let components = (0..complex.count()).filter(|&c| classes.find(c) == c).count();
    let mut used = vec![false; complex.vertex_count];
    (0..complex.count()).flat_map(|c| complex.cell(c)).for_each(|&v| used[v as usize] = true);
    let vertices = used.iter().filter(|&&seen| seen).count() as i64;
    let single = complex.boundary_slots().count();
    let facets = ((size * complex.count() + single) / 2) as i64;
    let cells = complex.count() as i64;
    let euler = match size {
        4 => vertices - edge_count as i64 + facets - cells,
        3 => vertices - facets + cells,
        _ => vertices - cells,
    };
    let boundaries = match size {
        2 => single,
        _ if single == 0 => 0,
        _ => shape(&complex.facet_complex(complex.boundary_slots(), rule)?, 0, rule)?.components,
    };
    Ok(Shape { components, euler, boundaries })
}
