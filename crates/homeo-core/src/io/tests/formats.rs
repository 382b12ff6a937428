//! The corners of each format, as small files.

use super::samples::texts;
use crate::io::{Element, Format, MeshFile, Values, read_mesh_bytes};

/// Valid files; the other tests cut and change them.
pub const SAMPLES: &[(Format, &[u8])] = &[
    (Format::Obj, OBJ),
    (Format::Off, COFF),
    (Format::Ply, PLY),
    (Format::Stl, STL),
    (Format::Msh, MSH_41),
    (Format::Msh, MSH_22),
    (Format::Medit, MEDIT),
    (Format::Vtk, VTK_5),
    (Format::Vtk, VTK_POLY),
    (Format::Vtu, VTU),
    (Format::Vtu, VTU_ZLIB),
    (Format::Vtu, VTU_RAW),
    (Format::Json, JSON),
];

fn read(format: Format, bytes: &[u8]) -> MeshFile {
    let mesh = read_mesh_bytes(format, "sample".as_ref(), bytes).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(mesh.check(), Ok(()));
    mesh
}

fn polygons(mesh: &MeshFile) -> Vec<Vec<u32>> {
    mesh.polygons.iter().map(<[u32]>::to_vec).collect()
}

const OBJ: &[u8] =
    b"\xef\xbb\xbf# comment\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0 # here\r\nv 1 0 0\r\n\tv  1 \\\r\n 1 0\r\n\
v 0 1 0\r\nvt 0.1 0.2\r\nvt .5 1.\r\nvn 0 0 1\r\ng left right\r\nusemtl red\r\nf 1/1/1 2/2/1 3//1 4\r\ns off\r\n\
f -4 -3 -2\r\nl 1 2\r\nf 1 2 5\r\nv 0 0 1";

#[test]
fn obj_with_everything() {
    let mesh = read(Format::Obj, OBJ);
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(polygons(&mesh), [vec![0, 1, 2, 3], vec![0, 1, 2], vec![0, 1, 4]]);
    assert_eq!(mesh.material_libraries, ["a.mtl"]);
    assert_eq!(mesh.attribute("group", Element::Polygon).unwrap().values, texts(&["left right"; 3]));
    assert_eq!(mesh.attribute("smoothing", Element::Polygon).unwrap().values, texts(&["", "off", "off"]));
    let Values::F64(texture) = &mesh.attribute("texture", Element::Corner).unwrap().values else { panic!() };
    assert_eq!(texture[..4], [0.1, 0.2, 0.5, 1.0]);
    assert!(texture[4..].iter().all(|x| x.is_nan()) && texture.len() == 20);
    assert_eq!(mesh.losses, ["1 statement with points or lines was left out"]);
}

const COFF: &[u8] =
    b"COFF # comment\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n\n0 1 0 0 0 255 255\n3 0 1 2 0.5 0.5 0.5\n";

#[test]
fn off_variants() {
    let mesh = read(Format::Off, COFF);
    let color = mesh.attribute("color", Element::Vertex).unwrap();
    assert_eq!(
        (color.components, &color.values),
        (4, &Values::I64(vec![255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255]))
    );
    assert_eq!(mesh.attribute("color", Element::Polygon).unwrap().values, Values::F64(vec![0.5; 3]));
    for text in [
        &b"OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2"[..],
        b"3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n\r\n",
        b"OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n3\t0\t1\t2",
        b"\nOFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
    ] {
        assert_eq!(polygons(&read(Format::Off, text)), [[0, 1, 2]]);
    }
    let some = b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1 9 8 7\n";
    let Values::F64(colors) = &read(Format::Off, some).attributes[0].values.clone() else { panic!() };
    assert!(colors[..3].iter().all(|x| x.is_nan()) && colors[3..] == [9.0, 8.0, 7.0]);
}

const PLY: &[u8] =
    b"ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\nproperty float y\n\
property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
property list uchar int vertex_index\nproperty list uchar float texcoord\nproperty short part\nelement edge 1\n\
property int vertex1\nproperty int vertex2\nend_header\n0.1 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n\
3 0 1 2 6 0 0 1 0 0 1 -7\n0 1\n";

#[test]
fn ply_in_text() {
    let mesh = read(Format::Ply, PLY);
    assert_eq!(mesh.positions[0][0], 0.1);
    assert_eq!(mesh.attribute("color", Element::Vertex).unwrap().values, Values::I64((1..10).collect()));
    assert_eq!(mesh.attribute("texture", Element::Corner).unwrap().components, 2);
    assert_eq!(mesh.attribute("part", Element::Polygon).unwrap().values, Values::I64(vec![-7]));
    assert_eq!(mesh.losses, ["1 elements \"edge\" were left out"]);
}

#[test]
fn ply_big_endian() {
    let mut bytes =
        b"ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty float y\r\n\
element face 1\r\nproperty list ushort uint vertex_indices\r\nend_header\r\n"
            .to_vec();
    for x in [0.1_f64, 1.0, -0.0] {
        bytes.extend(x.to_be_bytes());
        bytes.extend(0.5_f32.to_be_bytes());
    }
    bytes.extend(3_u16.to_be_bytes());
    [2_u32, 1, 0].into_iter().for_each(|index| bytes.extend(index.to_be_bytes()));
    let mesh = read(Format::Ply, &bytes);
    assert_eq!((mesh.space, mesh.positions[0]), (2, [0.1, 0.5, 0.0]));
    assert_eq!(polygons(&mesh), [[2, 1, 0]]);
}

const STL: &[u8] =
    b"solid two words\n facet normal nan 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n\
  endloop\n endfacet\nendsolid two words\nSOLID b\nfacet normal 0 0 1\nOUTER LOOP\nvertex -0.0 0 0\nvertex 0 1 0\n\
vertex 1 1e-7 1\nendloop\nendfacet\nendsolid\n";

#[test]
fn stl_joins_equal_corners_only() {
    let mesh = read(Format::Stl, STL);
    assert_eq!(polygons(&mesh), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.attributes[0].values, texts(&["two words", "b"]));
    assert!(mesh.losses[0].contains("6 corners were joined into 4 vertices"));
}

#[test]
fn binary_stl_may_begin_with_solid() {
    let mut bytes = vec![b' '; 80];
    bytes[..5].copy_from_slice(b"solid");
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0_u8; 12]);
    for x in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend([7, 1]);
    let mesh = read(Format::Stl, &bytes);
    assert_eq!(mesh.attribute("attribute", Element::Polygon).unwrap().values, Values::I64(vec![263]));
    bytes.push(0);
    assert!(read(Format::Stl, &bytes).losses[0].contains("1 bytes behind"));
}

const MSH_22: &[u8] = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 9 \"outer wall\"\n3 4 \"core\"\n\
$EndPhysicalNames\n$Nodes\n4\n10 0 0 0\n3 1 0 0\n7 0 1 0\n100 0 0 1\n$EndNodes\n$Elements\n4\n1 15 2 0 1 10\n\
2 1 2 0 1 10 3\n3 2 2 9 1 10 7 3\n4 4 3 4 1 0 10 3 7 100\n$EndElements\n$Comments\nany text\n$EndComments\n\
$NodeData\n1\n\"heat\"\n1\n0.0\n3\n0\n1\n2\n3 0.25\n100 nan\n$EndNodeData\n";

#[test]
fn msh_with_gaps_in_the_numbers_of_nodes() {
    let mesh = read(Format::Msh, MSH_22);
    assert_eq!((polygons(&mesh), &mesh.tetrahedra), (vec![vec![0, 2, 1]], &vec![[0, 1, 2, 3]]));
    assert_eq!(mesh.attribute("tag", Element::Polygon).unwrap().values, Values::I64(vec![9]));
    assert_eq!(mesh.attribute("tag", Element::Tetrahedron).unwrap().values, Values::I64(vec![4]));
    assert_eq!(mesh.names[1].name, "core");
    let Values::F64(heat) = &mesh.attribute("heat", Element::Vertex).unwrap().values else { panic!() };
    assert!(heat[1] == 0.25 && heat[0].is_nan());
    assert_eq!(mesh.losses.len(), 3);
}

const MSH_41: &[u8] = b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 4 \"core\"\n$EndPhysicalNames\n\
$Entities\n1 0 1 1\n1 0 0 0 0\n5 0 0 0 1 1 1 1 9 0\n6 0 0 0 1 1 1 2 4 8 1 5\n$EndEntities\n$Nodes\n2 4 1 4\n\
2 5 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n3 6 0 1\n4\n0 0 1\n$EndNodes\n$Elements\n3 3 1 3\n0 1 15 1\n1 1\n2 5 2 1\n\
2 1 3 2\n3 6 4 1\n3 1 2 3 4\n$EndElements\n";

#[test]
fn msh_41_takes_tags_from_entities() {
    let mesh = read(Format::Msh, MSH_41);
    assert_eq!((polygons(&mesh), &mesh.tetrahedra), (vec![vec![0, 2, 1]], &vec![[0, 1, 2, 3]]));
    assert_eq!(mesh.attribute("tag", Element::Polygon).unwrap().values, Values::I64(vec![9]));
    assert_eq!(mesh.attribute("tag", Element::Tetrahedron).unwrap().values, Values::I64(vec![4]));
    assert_eq!(mesh.attribute("entity", Element::Tetrahedron).unwrap().values, Values::I64(vec![6]));
    assert!(mesh.losses.iter().any(|loss| loss.contains("second physical tag")));
}

#[test]
fn msh_41_in_binary() {
    let mut bytes = b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n".to_vec();
    let sizes = |bytes: &mut Vec<u8>, values: &[u64]| values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    let ints = |bytes: &mut Vec<u8>, values: &[i32]| values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    sizes(&mut bytes, &[1, 4, 1, 4]);
    ints(&mut bytes, &[3, 1, 0]);
    sizes(&mut bytes, &[4, 1, 2, 3, 4]);
    for x in [0.1_f64, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend(b"\n$EndNodes\n$Elements\n");
    sizes(&mut bytes, &[1, 1, 1, 1]);
    ints(&mut bytes, &[3, 1, 4]);
    sizes(&mut bytes, &[1, 1, 1, 2, 3, 4]);
    bytes.extend(b"\n$EndElements\n");
    let mesh = read(Format::Msh, &bytes);
    assert_eq!((mesh.positions[0][0], &mesh.tetrahedra), (0.1, &vec![[0, 1, 2, 3]]));
}

const MEDIT: &[u8] = b"MeshVersionFormatted 2 # comment\nDimension\n3\nTetrahedra\n1\n1 2 3 4 5\n\nVertices\n4\n0 0 0 0\n1 0 0 0\n\
0 1 0 0\n0 0 1 0\nTriangles 1\n1 2 3 7\nQuadrilaterals\n1\n1 2 3 4 8\nEdges\n1\n1 2 3\nRidges\n1\n1\nCorners 0\nRequiredVertices\n2\n1 2\nEnd\n";

#[test]
fn medit_sections_in_any_order() {
    let mesh = read(Format::Medit, MEDIT);
    assert_eq!((polygons(&mesh), &mesh.tetrahedra), (vec![vec![0, 1, 2], vec![0, 1, 2, 3]], &vec![[0, 1, 2, 3]]));
    assert_eq!(mesh.attribute("tag", Element::Polygon).unwrap().values, Values::I64(vec![7, 8]));
    assert_eq!(mesh.attribute("tag", Element::Vertex), None);
    assert_eq!(mesh.losses.len(), 3);
    // Found by damaging files: an empty section in front of all others.
    let empty = b"MeshVersionFormatted 1 Dimension 2 Triangles 0 Hexahedra 0 Vertices 3 0 0 0 1 0 0 0 1 0 Triangles 1 1 2 3 0 End";
    let mesh = read(Format::Medit, empty);
    assert_eq!((mesh.space, polygons(&mesh)), (2, vec![vec![0, 1, 2]]));
}

const VTK_5: &[u8] = b"# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\ntime 1 1 double\n0.5\n\
POINTS 5 float\n0.1 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\nMETADATA\nINFORMATION 0\n\nCELLS 6 16\nOFFSETS vtktypeint64\n0 4 7 9 13 15\n\
CONNECTIVITY vtktypeint64\n0 1 2 3\n0 1 2\n0 1\n0 1 2 3\n4 1\nCELL_TYPES 5\n10\n5\n3\n8\n3\n\
POINT_DATA 5\nSCALARS a%20name double\nLOOKUP_TABLE default\n1 2 3 4 5\nVECTORS v float\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n\
CELL_DATA 5\nFIELD FieldData 2\nid 1 5 int\n10 11 12 13 14\nword 1 5 string\na\nb\nc\nd\ne\n";

#[test]
fn vtk_version_5() {
    let bytes = String::from_utf8(VTK_5.to_vec()).unwrap().replace("CELLS 6 16", "CELLS 6 15");
    let mesh = read(Format::Vtk, bytes.as_bytes());
    assert_eq!((polygons(&mesh), &mesh.tetrahedra), (vec![vec![0, 1, 2], vec![0, 1, 3, 2]], &vec![[0, 1, 2, 3]]));
    assert_eq!(mesh.positions[0][0], 0.1);
    assert_eq!(mesh.attribute("a name", Element::Vertex).unwrap().values, Values::F64(vec![1.0, 2.0, 3.0, 4.0, 5.0]));
    assert_eq!(mesh.attribute("id", Element::Polygon).unwrap().values, Values::I64(vec![11, 13]));
    assert_eq!(mesh.attribute("id", Element::Tetrahedron).unwrap().values, Values::I64(vec![10]));
    assert_eq!(mesh.losses.len(), 3);
}

const VTK_POLY: &[u8] = b"# vtk DataFile Version 2.0\n\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\
VERTICES 1 2\n1 0\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\nCELL_DATA 3\nSCALARS s int 1\nLOOKUP_TABLE default\n1 2 3\n";

#[test]
fn vtk_polygons_and_strips() {
    let mesh = read(Format::Vtk, VTK_POLY);
    assert_eq!(polygons(&mesh), [vec![0, 1, 2, 3], vec![0, 1, 2], vec![2, 1, 3]]);
    assert_eq!(mesh.attribute("s", Element::Polygon).unwrap().values, Values::I64(vec![2, 3, 3]));
}

const VTU: &[u8] = b"<?xml version='1.0'?>\n<!-- a > b -->\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n\
<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells='1'>\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">\n\
0.1 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\n<PointData><DataArray Name=\"a&amp;b\" type='Int32' format=\"ascii\">1 2 3 4\
</DataArray></PointData><Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int64\" \
Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";

#[test]
fn vtu_in_text() {
    let mesh = read(Format::Vtu, VTU);
    assert_eq!((mesh.positions[0][0], &mesh.tetrahedra), (0.1, &vec![[0, 1, 2, 3]]));
    assert_eq!(mesh.attribute("a&b", Element::Vertex).unwrap().values, Values::I64(vec![1, 2, 3, 4]));
}

include!("vtu_samples.rs");

#[test]
fn vtu_appended_and_compressed() {
    for bytes in [VTU_ZLIB, VTU_RAW] {
        let mesh = read(Format::Vtu, bytes);
        assert_eq!((mesh.positions[0][0], &mesh.tetrahedra), (0.1, &vec![[0, 1, 2, 3]]));
    }
}

const JSON: &[u8] = b"{\"name\": \"a \\\" }\", \"vertices\": 5, \"more\": {\"x\": [1, {\"y\": null}]},\n\"facets\": [[0, 1, 2, 3], [1, 2, 3]]}\n";

#[test]
fn json_facets() {
    let mesh = read(Format::Json, JSON);
    assert_eq!((mesh.vertex_count, mesh.space, mesh.positions.len()), (5, 0, 0));
    assert_eq!((polygons(&mesh), &mesh.tetrahedra), (vec![vec![1, 2, 3]], &vec![[0, 1, 2, 3]]));
    let mesh = read(Format::Json, b"{\"tets\": [[0,1,2,9]]}");
    assert_eq!(mesh.vertex_count, 10);
}
