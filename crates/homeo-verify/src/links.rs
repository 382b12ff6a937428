//! Rules 8, L1, T2 and T7: manifolds with boundary by their vertex links, and their topological type.
//!
//! *Theorem (classification of compact surfaces).* A connected surface is a sphere when it has no boundary and
//! Euler number 2, a disk when it has a boundary and Euler number 1, an annulus when it has two boundary loops
//! and Euler number 0. The link of a vertex of a 3-complex is a surface when every facet has at most two cells
//! and the cells around every edge are connected through facets; so these checks need no search.

use crate::complex::{Complex, EDGES, UnionFind, is_same_face, place};
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
pub(crate) fn check_manifold(complex: &Complex, what: &str, rule: &'static str) -> Checked<Shape> {
    let [vertices, edges] = complex.small_faces();
    let edges = check_stars(complex, edges, what, rule)?;
    check_stars(complex, vertices, what, rule)?;
    if complex.size == 4 {
        check_vertex_links(complex, &edges, what, rule)?;
    }
    shape(complex, edges.chunk_by(is_same_face).count())
}

/// The cells around each face of a kind are connected through facets that contain it. Returns the sorted faces.
fn check_stars(complex: &Complex, kind: &[u8], what: &str, rule: &'static str) -> Checked<Vec<u128>> {
    let (size, faces) = (complex.size, complex.sorted_faces(kind));
    let mut classes = UnionFind::new(faces.len());
    for (a, b) in complex.inner_facets() {
        let (c, d) = (a / size, b / size);
        for (k, &mask) in kind.iter().enumerate().filter(|(_, mask)| *mask >> (a % size) & 1 == 0) {
            let face = complex.face(c, mask);
            let found = kind.iter().position(|&other| complex.face(d, other) == face);
            found.into_iter().for_each(|l| classes.join(kind.len() * c + k, kind.len() * d + l));
        }
    }
    for group in faces.chunk_by(is_same_face) {
        let first = place(group[0]);
        if let Some(&key) = group.iter().find(|&&key| classes.find(place(key)) != classes.find(first)) {
            let face = complex.face(first / kind.len(), kind[first % kind.len()]);
            let cells = [first / kind.len(), place(key) / kind.len()];
            let what = format!("{what}: the cells around a face of {} vertices are not connected", face.len());
            return Err(refuted(rule, format!("{what} through facets"), &cells, &face));
        }
    }
    Ok(faces)
}

/// Each vertex link, a connected surface by the checks before, is a sphere (inside) or a disk (on the boundary).
fn check_vertex_links(complex: &Complex, edges: &[u128], what: &str, rule: &'static str) -> Checked {
    // Euler numbers of the links: edges - facets + cells at each vertex.
    let mut euler = vec![0i64; complex.vertex_count];
    let mut add = |vertices: &[u32], sign: i64| vertices.iter().for_each(|&v| euler[v as usize] += sign);
    for group in edges.chunk_by(is_same_face) {
        let edge = place(group[0]);
        add(&complex.face(edge / 6, EDGES[edge % 6]), 1);
    }
    complex.inner_facets().for_each(|(slot, _)| add(&complex.facet(slot), -1));
    complex.boundary_slots().for_each(|slot| add(&complex.facet(slot), -1));
    complex.cells().for_each(|cell| add(cell, 1));
    let on_boundary = complex.vertices_of(complex.boundary_slots().map(|slot| complex.facet(slot)));
    for (c, cell) in complex.cells().enumerate() {
        let is_right = |v: usize| euler[v] == if on_boundary[v] { 1 } else { 2 };
        if let Some(&v) = cell.iter().find(|&&v| !is_right(v as usize)) {
            let message = format!("{what}: the link of vertex {v} is neither a sphere nor a disk");
            return Err(refuted(rule, message, &[c], &[v]));
        }
    }
    Ok(())
}

/// Components, Euler number and boundary components of a manifold.
pub(crate) fn shape(complex: &Complex, edge_count: usize) -> Checked<Shape> {
    let size = complex.size;
    let mut classes = UnionFind::new(complex.count());
    complex.inner_facets().for_each(|(a, b)| classes.join(a / size, b / size));
    let components = (0..complex.count()).filter(|&c| classes.find(c) == c).count();
    let single = complex.boundary_slots().count();
    let vertices = complex.vertices_of(complex.cells()).iter().filter(|&&is_used| is_used).count();
    let [vertices, edges, facets, cells] =
        [vertices, edge_count, (size * complex.count() + single) / 2, complex.count()].map(|count| count as i64);
    let euler = match size {
        4 => vertices - edges + facets - cells,
        3 => vertices - facets + cells,
        _ => vertices - cells,
    };
    let boundaries = match size {
        2 => single,
        _ if single == 0 => 0,
        _ => shape(&complex.facet_complex(complex.boundary_slots())?, 0)?.components,
    };
    Ok(Shape { components, euler, boundaries })
}

/// Given rules 1 to 6 the theorem implies the topology of the regions, so no map file can break that sentence of
/// rule 8 alone: its negative controls are here.
#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(size: usize, cells: &[u32]) -> Option<(usize, i64, usize)> {
        let complex = Complex::new(size, cells.to_vec(), 12, ["8"; 2]).ok()?;
        let shape = check_manifold(&complex, "test", "8").ok()?;
        Some((shape.components, shape.euler, shape.boundaries))
    }

    #[test]
    fn regions_of_another_topology_are_told_apart() {
        assert_eq!(numbers(3, &[0, 1, 2]), Some((1, 1, 1)), "disk");
        assert_eq!(numbers(3, &[0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3]), Some((1, 2, 0)), "sphere");
        let annulus = [0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5, 2, 5, 0, 0, 5, 3];
        assert_eq!(numbers(3, &annulus), Some((1, 0, 2)), "annulus");
        let moebius = [0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1];
        assert_eq!(numbers(3, &moebius), Some((1, 0, 1)), "moebius strip");
        assert_eq!(numbers(3, &[0, 1, 2, 3, 4, 5]), Some((2, 2, 2)), "two disks");
        assert_eq!(numbers(3, &[0, 1, 2, 0, 3, 4]), None, "two triangles at a vertex");
        assert_eq!(numbers(2, &[0, 1, 1, 2]), Some((1, 1, 2)), "arc");
        assert_eq!(numbers(2, &[0, 1, 1, 2, 2, 0]), Some((1, 0, 0)), "circle");
        assert_eq!(numbers(2, &[0, 1, 2, 3]), Some((2, 2, 4)), "two arcs");
        assert_eq!(numbers(2, &[0, 1, 0, 2, 0, 3]), None, "three edges at a vertex");
        assert_eq!(numbers(3, &[]), Some((0, 0, 0)), "nothing");
    }
}
