//! The deliberately broken files of the development data, where they are at hand.

use super::data::folder;
use super::plain_readers::read;
use super::{codes, find};
use crate::mesh::{TetrahedronComplex, TriangleComplex};
use crate::topology::*;

/// Files whose fault is one of shape, with the codes that name it.
const EXPECTED: [(&str, &[&str]); 21] = [
    ("nonmanifold_edge.obj", &["non-manifold-edge"]),
    ("nonmanifold_vertex.obj", &["non-manifold-vertex"]),
    ("self_intersecting_two_spheres.off", &["several-components", "self-intersection"]),
    // Its label says that the tube crosses itself, but no edge meets a triangle there: it is closer to
    // itself than to its core, no more.
    ("self_intersecting_fat_trefoil.obj", &[]),
    ("self_intersecting_pulled_vertex.obj", &["self-intersection"]),
    ("inconsistent_orientation.obj", &["inconsistent-orientation"]),
    ("inside_out.obj", &["inside-out"]),
    ("duplicate_faces.off", &["duplicate-cell"]),
    ("repeated_index_faces.obj", &["repeated-vertex"]),
    ("zero_area_face.obj", &["degenerate-cell", "self-intersection"]),
    ("isolated_vertices.obj", &["isolated-vertex"]),
    ("moebius.obj", &["non-orientable", "open-boundary"]),
    ("klein.obj", &["non-orientable", "self-intersection"]),
    ("huge_1e30.obj", &["extreme-scale"]),
    ("tiny_1e-30.obj", &["extreme-scale"]),
    ("offset_1e8.obj", &["extreme-scale"]),
    ("one_face_missing.off", &["open-boundary"]),
    ("two_components.obj", &["several-components"]),
    ("tet_inverted.mesh", &["inverted-cell"]),
    ("tet_nonmanifold_edge.mesh", &["non-manifold-edge"]),
    ("tet_flat.mesh", &["degenerate-cell"]),
];

#[test]
fn broken_files_are_named_by_their_fault() {
    let Some(folder) = folder() else { return };
    let options = Options { intersections: Intersections::Find };
    let mut wrong = Vec::new();
    for (file, expected) in EXPECTED {
        let mesh = read(&folder.join("surfaces/invalid").join(file)).unwrap();
        let vertices = mesh.positions.len();
        let violations = if mesh.tetrahedra.is_empty() {
            let complex = TriangleComplex::from_indices(vertices, &mesh.triangles).unwrap();
            analyse_triangles(&mesh.positions, &complex, options).violations
        } else {
            let complex = TetrahedronComplex::from_indices(vertices, &mesh.tetrahedra).unwrap();
            analyse_tetrahedra(&mesh.positions, &complex, options).violations
        };
        if codes(&violations) != expected {
            wrong.push(format!("{file}: {violations:?}"));
        }
        if file == "inconsistent_orientation.obj" {
            let turned = find(&violations, "inconsistent-orientation");
            assert!(turned.elements.iter().all(|cell| cell % 7 == turned.elements[0] % 7), "every seventh");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
