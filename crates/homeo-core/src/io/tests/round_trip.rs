//! What is written reads back bit for bit.

use super::samples::{encodings, rich_surface, rich_volume, surface, texts, volume, written};
use crate::io::{
    Element, Encoding, Format, MeshFile, Values, WriteOptions, read_mesh, read_mesh_bytes, write_mesh, write_mesh_to,
};

/// Bits of all coordinates: `==` does not tell -0 from 0.
fn bits(mesh: &MeshFile) -> Vec<u64> {
    mesh.positions.iter().flatten().map(|x| x.to_bits()).collect()
}

fn assert_same(found: &MeshFile, expected: &MeshFile, context: &str) {
    assert_eq!(bits(found), bits(expected), "{context}");
    assert_eq!(found, expected, "{context}");
    for (a, b) in found.attributes.iter().zip(&expected.attributes) {
        if let (Values::F64(a), Values::F64(b)) = (&a.values, &b.values) {
            assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{context}");
        }
    }
}

#[test]
fn every_format_gives_back_all_that_it_holds() {
    for format in Format::ALL.into_iter().filter(|&format| format != Format::Stl) {
        for &encoding in encodings(format) {
            for mesh in [surface(), volume(), rich_surface(format), rich_volume(format)] {
                let is_surface_format = matches!(format, Format::Obj | Format::Off | Format::Ply);
                if is_surface_format && mesh.is_volume() {
                    continue;
                }
                let mesh = if format == Format::Json { mesh.triangulated().mesh } else { mesh };
                let mut bytes = Vec::new();
                let report = write_mesh_to(&mut bytes, format, &mesh, &WriteOptions { encoding }).unwrap();
                assert_eq!(report.losses, [""; 0], "{format:?} {encoding:?}");
                let found = read_mesh_bytes(format, "sample".as_ref(), &bytes).unwrap();
                assert_same(&found, &mesh, &format!("{format:?} {encoding:?}"));
            }
        }
    }
}

#[test]
fn stl_text_keeps_double_precision() {
    let mesh = surface();
    let found = read_mesh_bytes(Format::Stl, "s.stl".as_ref(), &written(Format::Stl, &mesh, Encoding::Auto)).unwrap();
    let cut = mesh.triangulated().mesh;
    let corners = |mesh: &MeshFile| -> Vec<[f64; 3]> {
        mesh.polygons.corners.iter().map(|&vertex| mesh.positions[vertex as usize]).collect()
    };
    assert_eq!(corners(&found), corners(&cut));
}

#[test]
fn planar_coordinates_stay_planar_where_the_format_has_them() {
    let mut mesh = MeshFile::from_triangles(vec![[0.1, 0.2, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
    mesh.space = 2;
    for format in [Format::Medit, Format::Ply, Format::Json] {
        let bytes = written(format, &mesh, Encoding::Auto);
        assert_same(&read_mesh_bytes(format, "p".as_ref(), &bytes).unwrap(), &mesh, format.name());
    }
    for format in [Format::Obj, Format::Off, Format::Vtk, Format::Vtu, Format::Msh, Format::Stl] {
        let report = write_mesh_to(&mut Vec::new(), format, &mesh, &WriteOptions::default()).unwrap();
        assert!(report.losses.iter().any(|loss| loss.contains("third was written as 0")), "{format:?}");
    }
}

#[test]
fn losses_are_reported_by_name() {
    let mut mesh = rich_volume(Format::Msh);
    mesh.attributes.push(super::samples::attribute("zone", Element::Polygon, 1, texts(&["a"])));
    mesh.material_libraries.push("a.mtl".to_string());
    let report = |format| write_mesh_to(&mut Vec::new(), format, &mesh, &WriteOptions::default()).unwrap().losses;
    for format in [Format::Obj, Format::Vtu, Format::Vtk, Format::Medit, Format::Json, Format::Ply] {
        let losses = report(format).join("\n");
        assert!(losses.contains("\"zone\" on polygons"), "{losses}");
        assert!(losses.contains("2 names of tags"), "{losses}");
        assert!(format == Format::Obj || losses.contains("material libraries"), "{losses}");
    }
    assert!(report(Format::Obj).join("\n").contains("cannot hold the 2 tetrahedra"));
    assert!(report(Format::Vtu).join("\n").contains("\"entity\" was filled with 0 on polygons"));
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |format, mesh: &MeshFile, encoding| {
        write_mesh_to(&mut Vec::new(), format, mesh, &WriteOptions { encoding }).unwrap_err().to_string()
    };
    let mut tetrahedra = volume();
    tetrahedra.polygons = Default::default();
    assert!(refused(Format::Obj, &tetrahedra, Encoding::Auto).contains("surfaces only"));
    assert!(refused(Format::Off, &surface(), Encoding::Binary).contains("as text only"));
    assert!(refused(Format::Stl, &surface(), Encoding::Binary).contains("too large for binary STL"));
    let mut pentagon = surface();
    pentagon.polygons.push(&[0, 1, 2, 3, 1]);
    assert!(refused(Format::Medit, &pentagon, Encoding::Auto).contains("5 corners"));
    assert!(refused(Format::Msh, &pentagon, Encoding::Auto).contains("5 corners"));
    assert!(refused(Format::Json, &pentagon, Encoding::Auto).contains("triangulate first"));
    let mut broken = surface();
    broken.polygons.corners[0] = 99;
    assert!(refused(Format::Obj, &broken, Encoding::Auto).contains("names vertex 99 of 4"));
    let mut nameless = surface();
    (nameless.space, nameless.positions) = (0, Vec::new());
    assert!(refused(Format::Obj, &nameless, Encoding::Auto).contains("needs coordinates"));
}

#[test]
fn files_appear_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("homeo-io-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("Surface.OBJ");
    write_mesh(&path, &surface(), &WriteOptions::default()).unwrap();
    assert_eq!(read_mesh(&path).unwrap(), surface());
    let mut tetrahedra = volume();
    tetrahedra.polygons = Default::default();
    assert!(write_mesh(&path, &tetrahedra, &WriteOptions::default()).is_err());
    assert_eq!(read_mesh(&path).unwrap(), surface());
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}
