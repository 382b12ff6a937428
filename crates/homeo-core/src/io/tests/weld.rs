//! Welding: what becomes one, what stays, and what is told about it.

use crate::io::{
    Attribute, DifferingAttribute, Element, Format, MeshFile, PolygonList, Values, WeldReport, read_mesh_bytes,
};
use crate::mesh::{TetrahedronComplex, TriangleComplex};
use crate::topology::{Answer, Options, Violation, analyse_tetrahedra, analyse_triangles};

const A: [f64; 3] = [0.0, 0.0, 0.0];
const B: [f64; 3] = [1.0, 0.0, 0.0];
const C: [f64; 3] = [0.0, 1.0, 0.0];
const D: [f64; 3] = [0.0, 0.0, 1.0];
const E: [f64; 3] = [1.0, 1.0, 1.0];

fn attribute(name: &str, element: Element, components: usize, values: Values) -> Attribute {
    Attribute { name: name.into(), element, components, values }
}

/// Two triangles with a common side and six vertices.
fn two_triangles() -> MeshFile {
    MeshFile::from_triangles(vec![A, B, C, B, E, C], &[[0, 1, 2], [3, 4, 5]])
}

fn of_code<'a>(violations: &'a [Violation], code: &str) -> &'a Violation {
    violations.iter().find(|violation| violation.code == code).expect(code)
}

#[test]
fn the_first_vertex_stays_and_order_is_kept() {
    let mut mesh = two_triangles();
    let report = mesh.weld();
    assert_eq!(mesh.check(), Ok(()));
    assert_eq!((mesh.positions, mesh.vertex_count), (vec![A, B, C, E], 4));
    assert_eq!(mesh.polygons.corners, [0, 1, 2, 1, 3, 2]);
    let expected = WeldReport {
        merged: 2,
        examples: vec![[1, 3], [2, 5]],
        new_vertices: vec![0, 1, 2, 1, 3, 2],
        ..WeldReport::default()
    };
    assert_eq!(report, expected);
}

#[test]
fn a_second_weld_changes_nothing() {
    let mut mesh = two_triangles();
    mesh.weld();
    let once = mesh.clone();
    let report = mesh.weld();
    assert_eq!(mesh, once);
    assert_eq!(report, WeldReport { new_vertices: vec![0, 1, 2, 3], ..WeldReport::default() });
}

#[test]
fn zeros_of_both_signs_are_equal_and_neighbouring_numbers_are_not() {
    let least = f64::from_bits(1);
    let mut mesh = MeshFile::from_triangles(
        vec![[-0.0, 0.0, -0.0], B, C, A, D, E, [least, 0.0, 0.0], [1.0f64.next_up(), 0.0, 0.0]],
        &[[0, 1, 2], [3, 4, 5], [6, 7, 1]],
    );
    let report = mesh.weld();
    assert_eq!((report.merged, report.examples), (1, vec![[0, 3]]));
    let bits = mesh.positions[0].map(f64::to_bits);
    assert_eq!(bits, [(-0.0f64).to_bits(), 0, (-0.0f64).to_bits()], "the first keeps its bits");
}

#[test]
fn vertices_of_no_element_are_left_alone() {
    let mut mesh = MeshFile::from_triangles(vec![A, A, B, C, A, B], &[[1, 2, 3]]);
    let before = mesh.clone();
    assert_eq!(mesh.weld().merged, 0);
    assert_eq!(mesh, before);
    let mut mesh = MeshFile::from_triangles(vec![A, A, B, C, A, B, D], &[[1, 2, 3], [4, 5, 6]]);
    let report = mesh.weld();
    assert_eq!(report.examples, [[1, 4], [2, 5]]);
    assert_eq!(mesh.positions, [A, A, B, C, D]);
    assert_eq!(mesh.polygons.corners, [1, 2, 3, 1, 2, 4]);
}

#[test]
fn attributes_that_disagree_are_named_and_the_first_value_stays() {
    let mut mesh = two_triangles();
    let texts = ["a", "b", "c", "b", "e", "x"].map(Into::into).to_vec();
    mesh.attributes = vec![
        attribute("same", Element::Vertex, 1, Values::F64(vec![0.0, -0.0, f64::NAN, 0.0, 4.0, f64::NAN])),
        attribute("label", Element::Vertex, 1, Values::Text(texts)),
        attribute("uv", Element::Vertex, 2, Values::F32(vec![0., 0., 1., 0., 0., 1., 1., 9., 1., 1., 8., 1.])),
        attribute("tag", Element::Vertex, 1, Values::I64(vec![0, 1, 2, 1, 4, 2])),
        attribute("missing", Element::Vertex, 1, Values::F64(vec![0.0, 1.0, 2.0, f64::NAN, 4.0, 2.0])),
        attribute("tag", Element::Polygon, 1, Values::I64(vec![5, 6])),
    ];
    let report = mesh.weld();
    assert_eq!(mesh.check(), Ok(()));
    let lost = |name: &str, vertices, first| DifferingAttribute { name: name.into(), vertices, first };
    assert_eq!(report.differing, [lost("label", 1, [2, 5]), lost("uv", 2, [1, 3]), lost("missing", 1, [1, 3])]);
    assert_eq!(mesh.attributes[1].values, Values::Text(["a", "b", "c", "e"].map(Into::into).to_vec()));
    assert_eq!(mesh.attributes[2].values, Values::F32(vec![0., 0., 1., 0., 0., 1., 1., 1.]));
    assert_eq!(mesh.attributes[3].values, Values::I64(vec![0, 1, 2, 4]));
    assert_eq!(mesh.attributes[5].values, Values::I64(vec![5, 6]));
}

#[test]
fn seams_on_corners_are_kept() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
        vt 0 0\nvt 1 0\nvt 0 1\nvt 5 0\nvt 5 5\nvt 0 5\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
    let mut mesh = read_mesh_bytes(Format::Obj, "seam.obj".as_ref(), text).unwrap();
    let texture = mesh.attribute("texture", Element::Corner).cloned();
    assert!(texture.is_some());
    let report = mesh.weld();
    assert_eq!((report.merged, report.differing.len()), (2, 0));
    assert_eq!(mesh.attribute("texture", Element::Corner).cloned(), texture);
}

#[test]
fn elements_that_collapse_are_named_and_stay() {
    // The third triangle named a vertex twice before, the second does so by welding.
    let mut mesh = MeshFile::from_triangles(vec![A, B, C, A, B, A], &[[0, 1, 2], [3, 4, 5], [0, 0, 1]]);
    let report = mesh.weld();
    assert_eq!((report.collapsed_polygons, report.merged), (vec![1], 3));
    assert_eq!(mesh.polygons.corners, [0, 1, 2, 0, 1, 0, 0, 0, 1]);
    let complex = TriangleComplex::from_indices(3, &[[0, 1, 2], [0, 1, 0], [0, 0, 1]]).unwrap();
    let found = analyse_triangles(&mesh.positions, &complex, Options::default());
    assert_eq!(of_code(&found.violations, "repeated-vertex").elements, [1, 2]);
    let circle = |vertex: u32| [f64::from(vertex % 29), 0.0, 1.0];
    let mut mesh = MeshFile { vertex_count: 30, space: 3, positions: (0..30).map(circle).collect(), ..mesh };
    mesh.polygons = PolygonList::default();
    mesh.polygons.push(&(0..29).collect::<Vec<_>>());
    mesh.polygons.push(&(0..30).collect::<Vec<_>>());
    assert_eq!(mesh.weld().collapsed_polygons, [1]);
    let mut mesh = MeshFile::from_tetrahedra(vec![A, B, C, D, D, E], vec![[0, 1, 2, 3], [1, 4, 3, 5]]);
    assert_eq!(mesh.weld().collapsed_tetrahedra, [1]);
    assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 3, 3, 4]]);
}

#[test]
fn tetrahedra_apart_become_a_ball() {
    let mut mesh = MeshFile::from_tetrahedra(vec![A, B, C, D, B, C, D, E], vec![[0, 1, 2, 3], [4, 5, 6, 7]]);
    let analyse = |mesh: &MeshFile| {
        let complex = TetrahedronComplex::from_indices(mesh.vertex_count, &mesh.tetrahedra).unwrap();
        analyse_tetrahedra(&mesh.positions, &complex, Options::default())
    };
    let report = analyse(&mesh);
    let said = of_code(&report.violations, "coincident-vertices");
    assert!(said.elements == [4, 5, 6] && said.message.contains("`--weld`"));
    mesh.polygons.push(&[1, 2, 3]);
    mesh.polygons.push(&[4, 5, 6]);
    assert_eq!(mesh.weld().merged, 3);
    let report = analyse(&mesh);
    assert_eq!((report.ball.answer, report.violations.len()), (Answer::Yes, 0));
    assert_eq!(mesh.polygons.corners, [1, 2, 3, 1, 2, 3]);
}

#[test]
fn nothing_happens_without_coordinates_or_elements() {
    let mut mesh = MeshFile { vertex_count: 4, tetrahedra: vec![[0, 1, 2, 3]], ..MeshFile::default() };
    let before = mesh.clone();
    assert_eq!(mesh.weld(), WeldReport { new_vertices: vec![0, 1, 2, 3], ..WeldReport::default() });
    assert_eq!(mesh, before);
    assert_eq!(MeshFile::default().weld(), WeldReport::default());
}

/// Agrees with the definition: compare each vertex with all earlier ones.
#[test]
fn welding_agrees_with_all_pairs() {
    let mut state = 7u64;
    let mut next = |limit: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % limit
    };
    for _ in 0..50 {
        let count = 40;
        let positions: Vec<_> = (0..count).map(|_| [0; 3].map(|_: i32| [0.0, -0.0, 1.0][next(3) as usize])).collect();
        let triangles: Vec<_> = (0..30).map(|_| [0; 3].map(|_: i32| next(count) as u32)).collect();
        let mut mesh = MeshFile::from_triangles(positions.clone(), &triangles);
        let report = mesh.weld();
        assert_eq!(mesh.check(), Ok(()));
        let is_used = |v: u32| triangles.iter().flatten().any(|&corner| corner == v);
        let first = |v: u32| {
            let joins = |&u: &u32| is_used(u) && is_used(v) && positions[u as usize] == positions[v as usize];
            (0..v).find(joins).unwrap_or(v)
        };
        let kept: Vec<u32> = (0..count as u32).filter(|&v| first(v) == v).collect();
        let expected = (0..count as u32).map(|v| kept.iter().position(|&k| k == first(v)).unwrap() as u32);
        assert_eq!(report.new_vertices, expected.collect::<Vec<_>>());
        assert_eq!(report.merged, count as usize - kept.len());
        let moved = triangles.iter().flatten().map(|&v| report.new_vertices[v as usize]);
        assert_eq!(mesh.polygons.corners, moved.collect::<Vec<_>>());
    }
}
