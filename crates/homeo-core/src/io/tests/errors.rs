//! Every code of an error, and the place it names.

use crate::io::{Format, Place, read_mesh, read_mesh_bytes};

fn error(format: Format, bytes: &[u8]) -> (&'static str, Place) {
    let error = read_mesh_bytes(format, "broken".as_ref(), bytes).unwrap_err();
    assert!(error.to_string().starts_with("broken: "), "{error}");
    (error.code, error.place)
}

fn check(format: Format, cases: &[(&str, &str, u64)]) {
    for &(text, code, line) in cases {
        let (found, place) = error(format, text.as_bytes());
        assert_eq!(found, code, "{text}");
        let expected = if line == 0 { Place::File } else { Place::Line(line) };
        assert_eq!(place, expected, "{text}");
    }
}

#[test]
fn paths() {
    for (path, code) in [("a.xyz", "unknown-format"), ("mesh", "unknown-format"), ("missing.OBJ", "cannot-open")] {
        assert_eq!(read_mesh(path.as_ref()).unwrap_err().code, code);
    }
    let message = read_mesh("a.xyz".as_ref()).unwrap_err().to_string();
    assert!(message.contains(".xyz") && message.contains(".obj") && message.contains(".vtu"), "{message}");
}

#[test]
fn empty_files() {
    for format in Format::ALL {
        for bytes in [&b""[..], b" \r\n\t\n"] {
            assert_eq!(error(format, bytes), ("empty-file", Place::File));
        }
    }
}

#[test]
fn obj() {
    check(
        Format::Obj,
        &[
            ("v 0 0 0\nv 1 0 0\nv 0 nan 0\n", "non-finite-coordinate", 3),
            ("v 0 0 1e999\n", "non-finite-coordinate", 1),
            ("v 0 0 0\n\nf 1 1 2\n", "index-out-of-range", 3),
            ("v 0 0 0\nf 1 1 -2\n", "index-out-of-range", 2),
            ("v 0 0 0\nf 1 1 9999999999\n", "index-out-of-range", 2),
            ("v 0 0 0\nf 1 0 1\n", "index-zero", 2),
            ("v 0 0 0\nf 1/1 1 1\n", "index-out-of-range", 2),
            ("v 0 0 0\nf 1 1\n", "too-few-corners", 2),
            ("v 0 0 x\n", "bad-number", 1),
            ("v 0 0 0\nf 1 a 1\n", "bad-number", 2),
            ("v 0\n", "bad-syntax", 1),
            ("v 0 0 0\n", "no-elements", 0),
            ("not an obj file\n", "no-elements", 0),
        ],
    );
}

#[test]
fn off() {
    check(
        Format::Off,
        &[
            ("PFF\n", "bad-header", 1),
            ("4OFF\n", "unsupported-variant", 1),
            ("OFF BINARY\n", "unsupported-variant", 1),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "unexpected-end", 0),
            ("OFF\n4000000000 1 0\n0 0 0\n", "unexpected-end", 2),
            ("OFF\n5000000000 1 0\n0 0 0\n", "too-large", 2),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "index-out-of-range", 6),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "index-out-of-range", 6),
            ("OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "non-finite-coordinate", 4),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1    \n", "too-few-corners", 6),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n9\n", "bad-syntax", 7),
            ("OFF\n1 0 0\n0 0 0\n", "no-elements", 0),
        ]
        .map(|(text, code, line)| (text, code, if code == "unexpected-end" && line == 0 { 6 } else { line })),
    );
}

#[test]
fn stl() {
    check(
        Format::Stl,
        &[
            ("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "unexpected-end", 4),
            ("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "non-finite-coordinate", 4),
            ("solid\nfacet normal 0 0 1\nouter loop\nendloop\n", "bad-syntax", 4),
            ("solid\nfacet normal 0 0 a\n", "bad-number", 2),
            ("solid\nendsolid\n", "no-elements", 0),
        ],
    );
    assert_eq!(error(Format::Stl, b"not solid"), ("unexpected-end", Place::Byte(9)));
    let mut bytes = vec![0; 84 + 50];
    bytes[80] = 2;
    assert_eq!(error(Format::Stl, &bytes).0, "unexpected-end");
    bytes[80] = 1;
    bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(error(Format::Stl, &bytes), ("non-finite-coordinate", Place::Byte(96)));
}

#[test]
fn medit() {
    let start = "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\n";
    let with = |rest: &str| format!("{start}{rest}");
    for (rest, code, line) in [
        ("Triangles\n2\n1 1 1 0\n1 2 1 0\n", "index-out-of-range", 9),
        ("Tetrahedra\n1\n1 1 0 1 0\n", "index-zero", 8),
        ("Triangles\n9000\n1 1 1 0\n", "unexpected-end", 7),
        ("Triangles\n9000000000\n1 1 1 0\n", "too-large", 7),
        ("Hexahedra\n1\n1 1 1 1 1 1 1 1 0\n", "unsupported-element", 7),
        ("TetrahedraP2\n1\n1 1 1 1 1 1 1 1 1 1 0\n", "unsupported-element", 7),
        ("Triangles\n1\n1 1 x 0\n", "bad-number", 8),
        ("17\n", "bad-syntax", 6),
        ("End\n", "no-elements", 0),
    ] {
        check(Format::Medit, &[(&with(rest), code, line)]);
    }
    check(
        Format::Medit,
        &[
            ("Mesh 2\n", "bad-header", 1),
            ("MeshVersionFormatted 9\n", "unsupported-variant", 1),
            ("MeshVersionFormatted 2\nDimension 4\n", "unsupported-variant", 2),
            ("MeshVersionFormatted 2\nVertices\n1\n", "bad-header", 2),
            ("MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 inf 0\n", "non-finite-coordinate", 5),
        ],
    );
}

#[test]
fn msh() {
    let head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    let nodes = "$Nodes\n2\n1 0 0 0\n2 0 0 0\n$EndNodes\n";
    for (rest, code, line) in [
        (format!("{nodes}$Elements\n1\n1 2 2 0 0 1 2 3\n$EndElements\n"), "index-out-of-range", 11),
        (format!("{nodes}$Elements\n1\n1 11 2 0 0 1 2 1 2 1 2 1 2 1 2\n$EndElements\n"), "unsupported-element", 11),
        (format!("{nodes}$Elements\n900000\n1 2 2 0 0 1 2 1\n"), "unexpected-end", 10),
        (format!("{nodes}$Elements\n1\n1 2 2 0 0 1 2 1\n"), "unexpected-end", 11),
        ("$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n".to_string(), "bad-syntax", 7),
        ("$Nodes\n1\n1 0 nan 0\n$EndNodes\n".to_string(), "non-finite-coordinate", 6),
        ("$Nodes\n1\n1 0 zero 0\n$EndNodes\n".to_string(), "bad-number", 6),
        (nodes.to_string(), "no-elements", 0),
    ] {
        check(Format::Msh, &[(&format!("{head}{rest}"), code, line)]);
    }
    check(
        Format::Msh,
        &[
            ("$Nodes\n", "bad-header", 1),
            ("$MeshFormat\n4 0 8\n", "unsupported-variant", 2),
            ("$MeshFormat\n2.2 0 4\n", "unsupported-variant", 2),
        ],
    );
    let named = read_mesh_bytes(
        Format::Msh,
        "a.msh".as_ref(),
        format!("{head}{nodes}$Elements\n1\n1 11 2 0 0 1 2 1 2 1 2 1 2 1 2\n").as_bytes(),
    );
    assert!(named.unwrap_err().message.contains("a 10-node tetrahedron"));
}

#[test]
fn vtk() {
    let head = "# vtk DataFile Version 3.0\n\nASCII\n";
    let points = "DATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n0 0 0\n";
    for (rest, code) in [
        ("DATASET STRUCTURED_POINTS\n".to_string(), "unsupported-variant"),
        (format!("{points}CELLS 1 4\n3 0 0 1\nCELL_TYPES 1\n5\n"), "index-out-of-range"),
        (format!("{points}CELLS 1 4\n3 0 0 -1\nCELL_TYPES 1\n5\n"), "index-out-of-range"),
        (format!("{points}CELLS 1 9\n8 0 0 0 0 0 0 0 0\nCELL_TYPES 1\n12\n"), "unsupported-element"),
        (format!("{points}CELLS 1 3\n2 0 0\nCELL_TYPES 1\n7\n"), "too-few-corners"),
        (format!("{points}CELLS 1 4\n2 0 0 0\nCELL_TYPES 1\n5\n"), "bad-syntax"),
        (format!("{points}CELLS 1 4\n3 0 0 0\n"), "unexpected-end"),
        (format!("{points}CELLS 1 400\n3 0 0 0\n"), "unexpected-end"),
        (format!("{points}CELLS 1 4\n3 0 0 0\nCELL_TYPES 1\nx\n"), "bad-number"),
        ("DATASET POLYDATA\nPOINTS 1 double\n0 0 nan\n".to_string(), "non-finite-coordinate"),
        ("DATASET POLYDATA\nPOINTS 5000000000 double\n0 0 0\n".to_string(), "too-large"),
        (points.to_string(), "no-elements"),
    ] {
        assert_eq!(error(Format::Vtk, format!("{head}{rest}").as_bytes()).0, code, "{rest}");
    }
    check(
        Format::Vtk,
        &[
            ("vtk\n", "bad-header", 1),
            ("# vtk DataFile Version 9.0\n\n", "unsupported-variant", 1),
            ("# vtk DataFile Version 3.0\n\nTEXT\n", "bad-header", 3),
        ],
    );
}

#[test]
fn vtu() {
    let sample = String::from_utf8(super::formats::SAMPLES.iter().find(|s| s.0 == Format::Vtu).unwrap().1.to_vec());
    let sample = sample.unwrap();
    for (from, to, code) in [
        ("VTKFile", "VTXFile", "bad-header"),
        ("\"UnstructuredGrid\"", "\"PolyData\"", "unsupported-variant"),
        ("byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order", "unsupported-variant"),
        ("0.1 0 0", "0.1 0 nan", "non-finite-coordinate"),
        ("0.1 0 0", "0.1 0 zero", "bad-number"),
        ("0 1 2 3<", "0 1 2 4<", "index-out-of-range"),
        (">10<", ">12<", "unsupported-element"),
        ("NumberOfPoints=\"4\"", "NumberOfPoints=\"400\"", "unexpected-end"),
        ("NumberOfPoints=\"4\"", "NumberOfPoints=\"5000000000\"", "too-large"),
        ("NumberOfPoints=\"4\"", "NumberOfPoints=\"3\"", "bad-syntax"),
        ("</VTKFile>", "", "unexpected-end"),
        ("Piece ", "Peace ", "bad-syntax"),
    ] {
        assert_eq!(error(Format::Vtu, sample.replace(from, to).as_bytes()).0, code, "{to}");
    }
}

#[test]
fn ply() {
    let sample = String::from_utf8(super::formats::SAMPLES.iter().find(|s| s.0 == Format::Ply).unwrap().1.to_vec());
    let sample = sample.unwrap();
    for (from, to, code, line) in [
        ("ply\n", "plx\n", "bad-header", 1),
        ("ascii", "text", "unsupported-variant", 2),
        ("short part", "shorter part", "bad-header", 14),
        ("element vertex 3", "element vertex 300000", "unexpected-end", 17 + 1),
        ("element vertex 3", "element vertex 5000000000", "too-large", 17 + 1),
        ("1 0 0 4", "1 0 inf 4", "non-finite-coordinate", 20),
        ("1 0 0 4", "1 0 zero 4", "bad-number", 20),
        ("3 0 1 2", "3 0 1 3", "index-out-of-range", 22),
        ("3 0 1 2", "2 0 1", "too-few-corners", 22),
        ("\n0 1\n", "\n0   ", "unexpected-end", 23),
    ] {
        check(Format::Ply, &[(&sample.replacen(from, to, 1), code, line)]);
    }
    let no_faces = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nend_header\n1 2\n";
    check(Format::Ply, &[(no_faces, "no-elements", 0)]);
    check(Format::Ply, &[("ply\nformat ascii 1.0\nend_header\n", "bad-header", 0)]);
}

#[test]
fn json() {
    check(
        Format::Json,
        &[
            ("[1, 2]", "bad-header", 1),
            ("{\"vertices\": 3,\n\"facets\": [[0, 1, 3]]}", "index-out-of-range", 2),
            ("{\"facets\": [[0, 1, 9999999999]]}", "index-out-of-range", 1),
            ("{\"facets\": [[0, 1, 2, 3, 4]]}", "unsupported-element", 1),
            ("{\"facets\": [[0, 1]]}", "unsupported-element", 1),
            ("{\"facets\": [[0, 1, x]]}", "bad-number", 1),
            ("{\"facets\": [[0, 1, 2]", "unexpected-end", 1),
            ("{\"facets\": [[0, 1, 2]] \"a\"}", "bad-syntax", 1),
            ("{\"vertices\": [[0, 0, 1e400]]}", "non-finite-coordinate", 1),
            ("{\"vertices\": 5000000000, \"facets\": [[0, 1, 2]]}", "too-large", 0),
            ("{\"vertices\": 3}", "no-elements", 0),
        ],
    );
}
