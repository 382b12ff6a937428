//! Surfaces by class: what is expected of each, and what a fault changes.

use super::shapes::{Glue, Surface, grid, octahedron, tetrahedron, torus};
use super::{codes, find};
use crate::mesh::TriangleComplex;
use crate::topology::*;

fn analyse(surface: &Surface) -> SurfaceReport {
    analyse_triangles(&surface.positions, &surface.complex(), Options { intersections: Intersections::Find })
}

fn abstractly(surface: &Surface) -> SurfaceReport {
    analyse_triangles(&[], &surface.complex(), Options::default())
}

#[test]
fn convex_spheres() {
    for (surface, angle, volume) in
        [(tetrahedron(), 54.735_610_317, 1.0 / 6.0), (octahedron(), 109.471_220_634, 4.0 / 3.0)]
    {
        let report = analyse(&surface);
        assert!(report.is_sphere && report.manifold && report.closed && report.orientable && !report.is_disk);
        assert!(report.violations.is_empty(), "{:?}", report.violations);
        assert_eq!((report.genus, report.euler_characteristic, report.boundary_loops), (Some(0), 2, Some(0)));
        let geometry = report.geometry.unwrap();
        assert!((geometry.dihedral_angles.unwrap().min_degrees - angle).abs() < 1e-8);
        assert!((geometry.enclosed_volume.unwrap() - volume).abs() < 1e-12);
        assert_eq!(report.self_intersections, Some(0));
    }
}

#[test]
fn surfaces_glued_from_a_grid() {
    use Glue::{Open, Reversed, Straight};
    // Gluing, Euler characteristic, loops, orientable, genus.
    let classes = [
        ("disk", Open, Open, 1, 1, true, Some(0)),
        ("annulus", Straight, Open, 0, 2, true, Some(0)),
        ("Moebius band", Reversed, Open, 0, 1, false, None),
        ("torus", Straight, Straight, 0, 0, true, Some(1)),
        ("Klein bottle", Reversed, Straight, 0, 0, false, None),
    ];
    for (name, across, along, euler, loops, orientable, genus) in classes {
        let surface = grid(7, 6, across, along);
        let report = abstractly(&surface);
        assert!(report.manifold, "{name}: {:?}", report.violations);
        assert_eq!(report.components, 1, "{name}");
        assert_eq!(report.euler_characteristic, euler, "{name}");
        assert_eq!(report.boundary_loops, Some(loops), "{name}");
        assert_eq!(report.orientable, orientable, "{name}");
        assert_eq!(report.genus, genus, "{name}");
        assert_eq!(report.is_disk, name == "disk");
        assert_eq!(report.closed, loops == 0, "{name}");
        assert_eq!(codes(&report.violations).contains(&"non-orientable"), !orientable, "{name}");
    }
}

#[test]
fn loops_have_lengths() {
    let report = analyse(&grid(7, 6, Glue::Open, Glue::Open));
    let boundary = report.boundary.unwrap();
    assert_eq!((boundary.len(), boundary[0].edges, boundary[0].length), (1, 26, Some(26.0)));
    // Removing an inner triangle adds a loop of three edges; the Euler characteristic drops.
    let mut surface = grid(7, 6, Glue::Open, Glue::Open);
    surface.triangles.remove(30);
    let report = analyse(&surface);
    let mut edges: Vec<usize> = report.boundary.unwrap().iter().map(|l| l.edges).collect();
    edges.sort_unstable();
    assert_eq!((edges, report.is_disk, report.genus), (vec![3, 26], false, Some(0)));
}

#[test]
fn an_embedded_torus_has_no_violations() {
    let report = analyse(&torus(12, 9));
    assert!(report.violations.is_empty(), "{:?}", report.violations);
    assert_eq!((report.genus, report.is_sphere), (Some(1), false));
    assert!(report.geometry.unwrap().enclosed_volume.unwrap() > 0.0);
}

#[test]
fn an_inverted_surface_is_inside_out() {
    let report = analyse(&octahedron().reversed());
    assert_eq!(codes(&report.violations), ["inside-out"]);
    assert_eq!(report.violations[0].severity, Severity::Warning);
    // The wall of a cavity is not; a sphere beside it is.
    let inner = octahedron().scaled(0.25).reversed();
    let cavity = octahedron().scaled(2.0).with(&inner, [0.0; 3]);
    assert_eq!(codes(&analyse(&cavity).violations), ["several-components"]);
    let beside = octahedron().with(&inner, [5.0, 0.0, 0.0]);
    assert_eq!(codes(&analyse(&beside).violations), ["several-components", "inside-out"]);
}

#[test]
fn turned_triangles_are_named() {
    let mut surface = torus(12, 9);
    for cell in [5, 77] {
        surface.triangles[cell].swap(0, 1);
    }
    let report = analyse(&surface);
    let violation = find(&report.violations, "inconsistent-orientation");
    assert_eq!(violation.elements, [5, 77]);
    assert!(report.orientable && !report.consistently_oriented && report.manifold);
    assert_eq!(report.geometry.unwrap().enclosed_volume, None);
}

#[test]
fn two_tetrahedra_that_share_an_edge() {
    let triangles = tetrahedron().triangles;
    let second = triangles.iter().map(|t| t.map(|v| [0, 1, 4, 5][v as usize]));
    let all: Vec<_> = triangles.iter().copied().chain(second).collect();
    let complex = TriangleComplex::from_indices(6, &all).unwrap();
    let report = analyse_triangles(&[], &complex, Options::default());
    let violation = find(&report.violations, "non-manifold-edge");
    assert_eq!((violation.count, &violation.elements[..]), (1, &[0, 1][..]));
    assert_eq!(codes(&report.violations), ["non-manifold-edge"]);
    assert!(!report.manifold && !report.edge_manifold && report.genus.is_none());
    assert_eq!((report.components, report.boundary_loops), (1, None));
}

#[test]
fn two_tetrahedra_that_share_a_vertex() {
    let triangles = tetrahedron().triangles;
    let second = triangles.iter().map(|t| t.map(|v| [0, 4, 5, 6][v as usize]));
    let all: Vec<_> = triangles.iter().copied().chain(second).collect();
    let complex = TriangleComplex::from_indices(7, &all).unwrap();
    let report = analyse_triangles(&[], &complex, Options::default());
    assert_eq!(codes(&report.violations), ["non-manifold-vertex"]);
    assert_eq!(report.violations[0].elements, [0]);
    assert!(report.edge_manifold && !report.vertex_manifold && !report.is_sphere);
    assert_eq!((report.components, report.boundary_loops), (1, Some(0)));
}

#[test]
fn cells_that_are_no_cells_are_reported_once() {
    let mut surface = octahedron();
    surface.triangles.extend([surface.triangles[2], [0, 0, 2]]);
    surface.triangles[2].rotate_left(1);
    surface.positions.push([9.0, 9.0, 9.0]);
    let report = analyse(&surface);
    assert_eq!(codes(&report.violations), ["repeated-vertex", "duplicate-cell", "isolated-vertex"]);
    assert_eq!(find(&report.violations, "duplicate-cell").elements, [8]);
    assert_eq!(find(&report.violations, "repeated-vertex").elements, [9]);
    assert_eq!(find(&report.violations, "isolated-vertex").elements, [6]);
    assert!(!report.manifold && report.closed);
    assert_eq!((report.faces, report.euler_characteristic, report.isolated_vertices), (10, 2, 1));
}

#[test]
fn flat_triangles_are_degenerate_and_folded_ones_intersect() {
    let mut surface = grid(3, 3, Glue::Open, Glue::Open);
    assert_eq!(codes(&analyse(&surface).violations), ["open-boundary"]);
    // The corner vertex 0 onto the diagonal of its square: one of its two triangles becomes flat.
    surface.positions[1] = [0.5, 0.5, 0.0];
    let report = analyse(&surface);
    assert_eq!(find(&report.violations, "degenerate-cell").elements, [0]);
    assert_eq!(report.geometry.unwrap().flat_cells, 1);
    // Beyond it: the two triangles at the diagonal overlap, others too.
    surface.positions[1] = [0.25, 0.75, 0.0];
    let report = analyse(&surface);
    assert!(!codes(&report.violations).contains(&"degenerate-cell"));
    assert_eq!(find(&report.violations, "self-intersection").elements[..2], [0, 1]);
}

#[test]
fn overlapping_spheres_intersect_and_touching_banks_do_not() {
    let crossing = octahedron().with(&octahedron(), [0.7, 0.1, 0.2]);
    let report = analyse(&crossing);
    assert!(report.self_intersections.unwrap() > 0);
    assert_eq!(codes(&report.violations), ["several-components", "self-intersection"]);
    // Two squares along a common side with vertices of their own.
    let square = grid(1, 1, Glue::Open, Glue::Open);
    let report = analyse(&square.clone().with(&square, [1.0, 0.0, 0.0]));
    assert_eq!(report.self_intersections, Some(0));
    assert_eq!(find(&report.violations, "coincident-vertices").count, 2);
    // Shifted along the side they touch without common vertices.
    let report = analyse(&square.clone().with(&square, [1.0, 0.5, 0.0]));
    assert!(report.self_intersections.unwrap() > 0);
    // One on the other: copies with vertices of their own overlap.
    let report = analyse(&square.clone().with(&square, [0.0; 3]));
    assert_eq!(report.self_intersections, Some(2));
}

#[test]
fn coordinates_out_of_range_are_named_and_nothing_is_measured() {
    for bad in [f64::NAN, f64::INFINITY, 1e100, -1e-100] {
        let mut surface = octahedron();
        surface.positions[3][1] = bad;
        let report = analyse(&surface);
        assert_eq!(codes(&report.violations), ["coordinate-out-of-range"]);
        assert_eq!(report.violations[0].elements, [3]);
        assert!(report.is_sphere && report.geometry.is_none() && report.self_intersections.is_none());
    }
    let report = analyse_triangles(&[[0.0; 3]; 5], &octahedron().complex(), Options::default());
    assert_eq!(codes(&report.violations), ["positions-do-not-match"]);
}

#[test]
fn extreme_scales_keep_their_measures() {
    for scale in [2f64.powi(-290), 1e-30, 1e30, 2f64.powi(290)] {
        let report = analyse(&octahedron().scaled(scale));
        assert_eq!(codes(&report.violations), ["extreme-scale"]);
        let angles = report.geometry.unwrap().dihedral_angles.unwrap();
        assert!((angles.min_degrees - 109.471_220_634).abs() < 1e-8);
    }
}

#[test]
fn nothing_at_all() {
    let report = analyse_triangles(&[], &TriangleComplex::from_indices(0, &[]).unwrap(), Options::default());
    assert_eq!(codes(&report.violations), ["no-cells"]);
    assert!(!report.is_disk && !report.is_sphere && !report.closed && report.genus.is_none());
    let points = [[0.0; 3]; 2];
    let report = analyse_triangles(&points, &TriangleComplex::from_indices(2, &[]).unwrap(), Options::default());
    assert_eq!(codes(&report.violations), ["no-cells", "isolated-vertex", "coincident-vertices"]);
}

/// The tree leaves no pair out: every pair of triangles in question, one by one.
#[test]
fn the_search_agrees_with_all_pairs() {
    let surface = torus(12, 9).with(&torus(9, 8), [1.1, 0.3, 0.2]).with(&octahedron(), [2.0, 0.05, 0.01]);
    let complex = surface.complex();
    let found = self_intersections(&surface.positions, &complex);
    let mut naive = Vec::new();
    for (i, a) in surface.triangles.iter().enumerate() {
        for (j, b) in surface.triangles.iter().enumerate().skip(i + 1) {
            if a.iter().all(|v| !b.contains(v)) {
                let [p, q] = [a, b].map(|t| t.map(|v| surface.positions[v as usize]));
                if crate::predicate::triangles_meet(p, q) {
                    naive.push([i, j]);
                }
            }
        }
    }
    let found: Vec<_> = found.pairs.iter().map(|pair| pair.map(|cell| cell.index())).collect();
    assert!(found.len() > 50);
    assert_eq!(found, naive);
}
