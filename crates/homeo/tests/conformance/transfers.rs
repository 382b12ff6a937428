//! Transfer of attributes to another section, against the exact map.

use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Silent;
use homeo::transfer::{Status, TransferError, Transferred, transfer};
use homeo_core::io::{Attribute, Element, Values};
use homeo_core::mesh::SimplicialComplex;

use crate::shells::{built, sphere};

/// A bumpy sphere onto the middle surface of its shell, as another section.
fn onto_middle() -> Shell {
    let shell = built(&sphere(3), 30);
    let parts = shell.parts().clone();
    let complex = SimplicialComplex::from_indices(parts.middle.len(), &parts.prisms).expect("columns exist");
    shell.with_section(SourceMesh::new(parts.middle, complex))
}

fn attribute(name: &str, element: Element, components: usize, values: Values) -> Attribute {
    Attribute { name: name.to_owned(), element, components, values }
}

fn moved(shell: &Shell, attribute: Attribute, densities: &[String]) -> Transferred {
    transfer(shell, &[attribute], densities, &Silent).expect("transferred").remove(0)
}

fn doubles(moved: &Transferred) -> &[f64] {
    match &moved.attribute.values {
        Values::F64(values) => values,
        other => panic!("doubles stay doubles: {other:?}"),
    }
}

#[test]
fn fields_on_vertices_are_interpolated_at_the_exact_place() {
    let shell = onto_middle();
    let positions = shell.source().positions().as_flattened().to_vec();
    let moved = moved(&shell, attribute("place", Element::Vertex, 3, Values::F64(positions)), &[]);
    let section = shell.section().expect("it has one");
    assert_eq!(moved.status.len(), section.positions().len());
    assert_eq!(moved.count(Status::Copied) + moved.count(Status::Interpolated), moved.status.len());
    for (v, place) in section.positions().iter().enumerate() {
        let image = shell.to_source(*place).expect("in the shell").point;
        for axis in 0..3 {
            assert!((doubles(&moved)[3 * v + axis] - image[axis]).abs() < 1e-12, "vertex {v}");
        }
    }
}

#[test]
fn what_is_the_same_everywhere_is_copied() {
    let shell = onto_middle();
    let (vertices, triangles) = (shell.source().positions().len(), shell.source().complex().cell_count());
    let cases = [
        attribute("part", Element::Polygon, 1, Values::Text(vec!["hull".into(); triangles])),
        attribute("tag", Element::Polygon, 1, Values::I64(vec![7; triangles])),
        attribute("heat", Element::Polygon, 1, Values::F32(vec![0.1; triangles])),
        attribute("label", Element::Vertex, 1, Values::I64(vec![3; vertices])),
    ];
    for case in cases {
        let moved = moved(&shell, case.clone(), &[]);
        assert_eq!(moved.count(Status::Copied), moved.status.len(), "{}", case.name);
        let is_same = match (&case.values, &moved.attribute.values) {
            (Values::Text(a), Values::Text(b)) => b.iter().all(|x| *x == a[0]),
            (Values::I64(a), Values::I64(b)) => b.iter().all(|x| *x == a[0]),
            (Values::F32(a), Values::F32(b)) => b.iter().all(|x| *x == a[0]),
            _ => false,
        };
        assert!(is_same, "{}", case.name);
    }
}

#[test]
fn labels_go_by_the_largest_area_and_say_so() {
    let shell = onto_middle();
    let source = shell.source();
    let is_up = |corners: [homeo_core::mesh::VertexId; 3]| {
        i64::from(corners.iter().map(|v| source.positions()[v.index()][2]).sum::<f64>() > 0.0)
    };
    let labels: Vec<i64> = source.complex().cells().iter().map(|&cell| is_up(cell)).collect();
    let moved = moved(&shell, attribute("side", Element::Polygon, 1, Values::I64(labels)), &[]);
    let (copied, largest) = (moved.count(Status::Copied), moved.count(Status::Largest));
    assert!(copied > 0 && largest > 0 && copied + largest == moved.status.len(), "{copied} {largest}");
}

#[test]
fn mass_is_conserved() {
    let shell = onto_middle();
    let density: Vec<f64> = (0..shell.source().complex().cell_count()).map(|t| 1.0 + (t % 5) as f64).collect();
    let mass = |mesh: &SourceMesh<3>, density: &[f64]| -> f64 {
        let area = |cell: &[homeo_core::mesh::VertexId; 3]| {
            let [a, b, c] = cell.map(|v| mesh.positions()[v.index()]);
            let (u, v) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
            let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        mesh.complex().cells().iter().zip(density).map(|(cell, density)| density * area(cell)).sum()
    };
    let named = attribute("rho", Element::Polygon, 1, Values::F64(density.clone()));
    let moved_mass = moved(&shell, named.clone(), &["rho".to_owned()]);
    let (before, section) = (mass(shell.source(), &density), shell.section().expect("it has one"));
    assert!((mass(section, doubles(&moved_mass)) - before).abs() < 1e-12 * before);
    // Negative control: averages do not conserve it, as the areas differ.
    let averaged = moved(&shell, named, &[]);
    assert!((mass(section, doubles(&averaged)) - before).abs() > 1e-6 * before);
}

/// Longitude and height, cut open along a meridian: 0 and 2 pi meet there.
fn texture(shell: &Shell) -> Vec<f64> {
    let turn = std::f64::consts::TAU;
    let of_cell = |cell: &[homeo_core::mesh::VertexId; 3]| {
        let places = cell.map(|v| shell.source().positions()[v.index()]);
        let angles = places.map(|p| p[1].atan2(p[0]).rem_euclid(turn));
        let high = angles.iter().any(|a| *a > 0.75 * turn);
        let unrolled = angles.map(|a| if high && a < 0.25 * turn { a + turn } else { a });
        [0, 1, 2].map(|k| [unrolled[k], places[k][2]])
    };
    shell.source().complex().cells().iter().flat_map(of_cell).flatten().collect()
}

#[test]
fn textures_are_taken_from_the_own_side_of_a_seam() {
    let shell = onto_middle();
    let values = texture(&shell);
    let moved = moved(&shell, attribute("texture", Element::Corner, 2, Values::F64(values.clone())), &[]);
    let section = shell.section().expect("it has one");
    let split = moved.count(Status::Split);
    assert!(
        split > 0 && split.is_multiple_of(3) && split < moved.status.len() / 2,
        "{split} of {}",
        moved.status.len()
    );
    assert_eq!(moved.count(Status::Missing), 0);
    for (row, uv) in doubles(&moved).chunks_exact(2).enumerate() {
        let v = section.complex().cells()[row / 3][row % 3];
        let place = shell.to_source(section.positions()[v.index()]).expect("in the shell").point;
        assert!((uv[1] - place[2]).abs() < 1e-12, "the height is continuous");
    }
    let seam = std::f64::consts::TAU;
    for (triangle, status) in moved.status.chunks_exact(3).enumerate() {
        let longitudes = [0, 1, 2].map(|k| doubles(&moved)[2 * (3 * triangle + k)]);
        let spread = longitudes.iter().fold(0.0f64, |s, a| s.max((a - longitudes[0]).abs()));
        assert!(status.contains(&Status::Split) || spread < 0.6 * seam, "triangle {triangle} spans {spread}");
    }
}

#[test]
fn what_cannot_be_transferred_is_said() {
    let shell = onto_middle();
    let short = attribute("short", Element::Vertex, 1, Values::F64(vec![0.0; 3]));
    let error = transfer(&shell, &[short], &[], &Silent).unwrap_err();
    assert!(matches!(error, TransferError::Rows { found: 3, .. }), "{error}");
    let error = transfer(&shell, &[], &["rho".to_owned()], &Silent).unwrap_err();
    assert_eq!(error, TransferError::NoDensity("rho".to_owned()));
    let without = built(&sphere(1), 0);
    assert_eq!(transfer(&without, &[], &[], &Silent).unwrap_err(), TransferError::NoSection);
    let mut heat = vec![1.0; shell.source().positions().len()];
    heat[0] = f64::NAN;
    let moved = moved(&shell, attribute("heat", Element::Vertex, 1, Values::F64(heat)), &[]);
    let missing = doubles(&moved).iter().filter(|x| x.is_nan()).count();
    assert_eq!(moved.count(Status::Missing), missing, "no number, no value");
}
