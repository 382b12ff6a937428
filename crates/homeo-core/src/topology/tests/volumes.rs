//! Volumes by class: what is expected of each, and what a fault changes.

use super::shapes::{Glue, Volume, cubes, cubes_without, grid, octahedron, product};
use super::{codes, find};
use crate::mesh::TetrahedronComplex;
use crate::topology::*;

fn analyse(volume: &Volume) -> VolumeReport {
    analyse_tetrahedra(&volume.positions, &volume.complex(), Options::default())
}

fn abstractly(complex: &TetrahedronComplex) -> VolumeReport {
    analyse_tetrahedra(&[], complex, Options::default())
}

fn complex(vertices: usize, cells: &[[u32; 4]]) -> TetrahedronComplex {
    TetrahedronComplex::from_indices(vertices, cells).unwrap()
}

#[test]
fn a_box_is_a_ball_by_either_argument() {
    let volume = cubes_without([3, 2, 2], &[]);
    let report = analyse(&volume);
    assert!(report.violations.is_empty(), "{:?}", report.violations);
    assert_eq!(report.ball.answer, Answer::Yes);
    assert!(report.ball.reason.contains("Alexander"), "{}", report.ball.reason);
    assert_eq!((report.embedded.answer, report.handle_body.answer), (Answer::Yes, Answer::Yes));
    assert_eq!((report.euler_characteristic, report.boundary.genus), (1, Some(0)));
    assert_eq!((report.vertices, report.interior_vertices, report.boundary.faces), (36, 2, 64));
    let geometry = report.geometry.unwrap();
    assert_eq!((geometry.positive_cells, geometry.volume), (72, 12.0));
    let angles = geometry.dihedral_angles.unwrap();
    assert!((angles.min_degrees - 45.0).abs() < 1e-9 && (angles.max_degrees - 90.0).abs() < 1e-9);
    let report = abstractly(&volume.complex());
    assert_eq!((report.ball.answer, report.embedded.answer), (Answer::Yes, Answer::Unknown));
    assert!(report.ball.reason.contains("Whitehead"), "{}", report.ball.reason);
}

/// All counts of elements between boundary vertices against a direct count.
#[test]
fn elements_between_boundary_vertices() {
    for volume in [cubes(&[[0, 0, 0]]), cubes_without([3, 3, 3], &[]), cubes_without([3, 3, 1], &[[1, 1, 0]])] {
        let report = analyse(&volume);
        let complex = volume.complex();
        let adjacency = complex.adjacency().unwrap();
        let on_boundary = adjacency.boundary_vertices(&complex);
        let mut skin = std::collections::BTreeSet::new();
        let mut faces = std::collections::BTreeSet::new();
        for cell in complex.cell_ids() {
            for i in 0..4 {
                let mut face: Vec<_> = complex.facet_vertices(cell, i).collect();
                face.sort_unstable();
                if adjacency.across(cell, i).is_none() {
                    skin.extend([[face[0], face[1]], [face[0], face[2]], [face[1], face[2]]]);
                } else if face.iter().all(|v| on_boundary[v.index()]) {
                    faces.insert(face);
                }
            }
        }
        let edges = complex.edges();
        let both = edges.ends().iter().filter(|ends| ends.iter().all(|v| on_boundary[v.index()]));
        let chords = both.filter(|ends| !skin.contains(*ends)).count();
        let cells = complex.cells().iter().filter(|cell| cell.iter().all(|v| on_boundary[v.index()])).count();
        assert_eq!(report.edges, edges.len());
        assert_eq!(report.interior_edges_between_boundary_vertices, chords);
        assert_eq!(report.interior_faces_with_all_vertices_on_boundary, faces.len());
        assert_eq!(report.cells_with_all_vertices_on_boundary, cells);
    }
}

#[test]
fn solid_tori_are_handle_bodies_and_no_balls() {
    for (holes, size, genus) in [(vec![[1, 1, 0]], [3, 3, 1], 1), (vec![[1, 1, 0], [3, 1, 0]], [5, 3, 1], 2)] {
        let volume = cubes_without(size, &holes);
        let report = analyse(&volume);
        assert!(report.violations.is_empty(), "{:?}", report.violations);
        assert_eq!((report.ball.answer, report.handle_body.answer), (Answer::No, Answer::Yes));
        assert_eq!((report.boundary.genus, report.euler_characteristic), (Some(genus), 1 - genus));
        assert_eq!(abstractly(&volume.complex()).ball.answer, Answer::No);
    }
}

#[test]
fn a_hollow_box_has_two_boundary_pieces() {
    let report = analyse(&cubes_without([3, 3, 3], &[[1, 1, 1]]));
    assert!(report.violations.is_empty(), "{:?}", report.violations);
    assert_eq!((report.boundary.components, &report.boundary.genera[..]), (2, &[0, 0][..]));
    assert_eq!((report.ball.answer, report.handle_body.answer), (Answer::No, Answer::No));
    assert_eq!(report.embedded.answer, Answer::Yes);
}

#[test]
fn cubes_that_share_too_little() {
    let report = analyse(&cubes(&[[0, 0, 0], [1, 1, 0]]));
    assert_eq!(codes(&report.violations), ["non-manifold-edge"]);
    assert_eq!((report.violations[0].count, report.bad_vertex_links), (1, 2));
    assert!(report.facet_manifold && !report.vertex_manifold);
    assert_eq!(report.ball.answer, Answer::No);

    let report = analyse(&cubes(&[[0, 0, 0], [1, 1, 1]]));
    assert_eq!(codes(&report.violations), ["non-manifold-vertex"]);
    assert_eq!((report.violations[0].count, report.bad_vertex_links, report.components), (1, 1, 1));

    let report = analyse(&cubes(&[[0, 0, 0], [2, 0, 0]]));
    assert_eq!(codes(&report.violations), ["several-components"]);
    assert_eq!((report.components, report.ball.answer), (2, Answer::No));
}

#[test]
fn three_tetrahedra_on_a_triangle() {
    let report = abstractly(&complex(6, &[[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5]]));
    assert_eq!(find(&report.violations, "non-manifold-facet").elements, [0, 1, 2]);
    assert!(!report.facet_manifold && !codes(&report.violations).contains(&"non-manifold-vertex"));
    assert_eq!(report.ball.answer, Answer::No);
}

#[test]
fn the_apex_of_a_cone_over_a_torus_is_no_manifold_point() {
    let torus = grid(5, 5, Glue::Straight, Glue::Straight);
    let apex = torus.positions.len() as u32;
    let cells: Vec<_> = torus.triangles.iter().map(|&[a, b, c]| [apex, a, b, c]).collect();
    let report = abstractly(&complex(apex as usize + 1, &cells));
    assert_eq!(codes(&report.violations), ["non-manifold-vertex"]);
    assert_eq!((&report.violations[0].elements[..], report.ball.answer), (&[apex][..], Answer::No));
    // Negative control: over a sphere the cone is a ball.
    let cells: Vec<_> = octahedron().triangles.iter().map(|&[a, b, c]| [6, a, b, c]).collect();
    let report = abstractly(&complex(7, &cells));
    assert_eq!((report.manifold, report.ball.answer), (true, Answer::Yes));
}

#[test]
fn closed_manifolds_are_no_balls_and_punctured_ones_are_not_taken_for_balls() {
    let simplex = complex(5, &[[1, 2, 3, 4], [0, 3, 2, 4], [0, 1, 3, 4], [0, 2, 1, 4], [0, 1, 2, 3]]);
    let report = abstractly(&simplex);
    assert!(report.manifold && report.orientable);
    assert_eq!((report.euler_characteristic, report.boundary.components), (0, 0));
    assert_eq!(report.ball.answer, Answer::No);
    let punctured = complex(5, &simplex.cells()[1..].iter().map(|c| c.map(|v| v.raw())).collect::<Vec<_>>());
    assert_eq!(abstractly(&punctured).ball.answer, Answer::Yes);

    // Sphere times circle and torus times circle without a tetrahedron: the boundary is a sphere, all
    // counts are those of a ball.
    for surface in [octahedron(), grid(4, 4, Glue::Straight, Glue::Straight)] {
        let closed = product(&surface, 4, true);
        let cells: Vec<_> = closed.cells()[1..].iter().map(|c| c.map(|v| v.raw())).collect();
        let report = abstractly(&complex(closed.vertex_count(), &cells));
        assert!(report.manifold && report.orientable);
        assert_eq!((report.boundary.genus, report.euler_characteristic), (Some(0), 1));
        assert_eq!(report.ball.answer, Answer::Unknown, "{}", report.ball.reason);
    }
}

#[test]
fn thick_surfaces() {
    let classes = [
        (grid(4, 4, Glue::Open, Glue::Open), Answer::Yes, Answer::Yes, true),
        (grid(4, 4, Glue::Straight, Glue::Open), Answer::No, Answer::Yes, true),
        (grid(4, 4, Glue::Reversed, Glue::Open), Answer::No, Answer::No, false),
        (grid(4, 4, Glue::Straight, Glue::Straight), Answer::No, Answer::No, true),
    ];
    for (surface, ball, handle_body, orientable) in classes {
        let report = abstractly(&product(&surface, 2, false));
        assert!(report.manifold, "{:?}", report.violations);
        assert_eq!((report.ball.answer, report.handle_body.answer), (ball, handle_body));
        assert_eq!(report.orientable, orientable);
        assert_eq!(codes(&report.violations).contains(&"non-orientable"), !orientable);
    }
}

#[test]
fn mirrored_and_turned_cells() {
    let mut volume = cubes_without([2, 2, 2], &[]);
    volume.tetrahedra[17].swap(0, 1);
    let report = analyse(&volume);
    assert_eq!(codes(&report.violations), ["inconsistent-orientation", "inverted-cell"]);
    assert!(report.violations.iter().all(|v| v.elements == [17]));
    assert_eq!((report.ball.answer, report.embedded.answer), (Answer::Yes, Answer::Yes));
    volume.tetrahedra[17].swap(0, 1);
    volume.tetrahedra.iter_mut().for_each(|cell| cell.swap(0, 1));
    let report = analyse(&volume);
    assert_eq!(codes(&report.violations), ["inverted-cell"]);
    assert_eq!((report.violations[0].count, report.embedded.answer), (48, Answer::Yes));
}

#[test]
fn a_folded_interior_is_not_embedded_but_a_ball() {
    let mut volume = cubes_without([2, 2, 2], &[]);
    let centre = volume.positions.iter().position(|p| *p == [1.0; 3]).unwrap();
    volume.positions[centre] = [3.0, 1.0, 1.0];
    let report = analyse(&volume);
    assert!(codes(&report.violations).contains(&"inverted-cell"));
    assert_eq!((report.embedded.answer, report.ball.answer), (Answer::No, Answer::Yes));
    assert!(report.ball.reason.contains("Whitehead"));
    volume.positions[centre] = [2.0, 1.0, 1.0];
    let report = analyse(&volume);
    assert!(codes(&report.violations).contains(&"degenerate-cell"));
    assert_eq!(report.embedded.answer, Answer::No);
}

/// A strip of cubes bent round an axis: past the full turn its ends overlap though every
/// tetrahedron is positive.
#[test]
fn positive_cells_alone_do_not_embed() {
    let bent = |turns: f64| {
        let mut volume = cubes_without([24, 1, 1], &[]);
        for point in &mut volume.positions {
            let angle = -std::f64::consts::TAU * turns * point[0] / 24.0;
            let radius = 5.0 + point[1];
            *point = [radius * angle.sin(), radius * angle.cos(), point[2]];
        }
        analyse(&volume)
    };
    let below = bent(0.9);
    let above = bent(1.2);
    for report in [&below, &above] {
        let geometry = report.geometry.as_ref().unwrap();
        assert!(geometry.positive_cells == 144 || geometry.negative_cells == 144);
        assert_eq!(report.ball.answer, Answer::Yes);
    }
    assert_eq!((below.embedded.answer, above.embedded.answer), (Answer::Yes, Answer::No));
    assert!(above.boundary_self_intersections.unwrap() > 0);
    let violation = find(&above.violations, "self-intersection");
    assert_eq!(violation.elements.len() % 6, 0);
}

#[test]
fn cells_that_are_no_cells() {
    let mut volume = cubes(&[[0, 0, 0]]);
    volume.tetrahedra.extend([[0, 1, 1, 2], volume.tetrahedra[3]]);
    let report = analyse(&volume);
    assert_eq!(codes(&report.violations), ["repeated-vertex", "duplicate-cell"]);
    assert_eq!(find(&report.violations, "duplicate-cell").elements, [7]);
    assert_eq!((report.manifold, report.ball.answer), (false, Answer::No));
    let report = abstractly(&complex(0, &[]));
    assert_eq!((codes(&report.violations), report.ball.answer), (vec!["no-cells"], Answer::No));
}
