//! Tiny meshes with numbers that decimals do not hold, shared by the tests.

use crate::io::{Attribute, Element, Encoding, Format, MeshFile, PhysicalName, Values, WriteOptions, write_mesh_to};

/// Numbers that a careless writer changes.
pub const HARD: [f64; 12] = [
    0.1,
    1.0 / 3.0,
    1e-300,
    -0.0,
    4.9e-324,
    f64::MAX,
    -2.0 / 3.0,
    123_456_789.123_456_79,
    f64::EPSILON,
    0.0,
    1e22,
    -7.0,
];

/// A tetrahedron's worth of vertices.
pub fn hard_positions() -> Vec<[f64; 3]> {
    HARD.as_chunks::<3>().0.to_vec()
}

pub fn attribute(name: &str, element: Element, components: usize, values: Values) -> Attribute {
    Attribute { name: name.to_string(), element, components, values }
}

/// Two triangles and a quadrilateral.
pub fn surface() -> MeshFile {
    let mut mesh = MeshFile::from_triangles(hard_positions(), &[[0, 1, 2], [2, 1, 3]]);
    mesh.polygons.push(&[0, 1, 3, 2]);
    mesh
}

/// Two tetrahedra and a face of them.
pub fn volume() -> MeshFile {
    let mut mesh = MeshFile::from_tetrahedra(hard_positions(), vec![[0, 1, 2, 3], [3, 2, 1, 0]]);
    mesh.polygons.push(&[0, 1, 2]);
    mesh
}

pub fn texts(texts: &[&str]) -> Values {
    Values::Text(texts.iter().map(|&text| text.into()).collect())
}

/// A surface with all that the format holds.
pub fn rich_surface(format: Format) -> MeshFile {
    let mut mesh = surface();
    let hard = |count: usize| Values::F64(HARD.iter().copied().cycle().take(count).collect());
    mesh.attributes = match format {
        Format::Obj => {
            mesh.material_libraries = vec!["a file.mtl".to_string()];
            vec![
                attribute("color", Element::Vertex, 3, hard(12)),
                attribute("texture", Element::Corner, 2, hard(20)),
                attribute("normal", Element::Corner, 3, hard(30)),
                attribute("object", Element::Polygon, 1, texts(&["a", "a", "b"])),
                attribute("group", Element::Polygon, 1, texts(&["", "left side", "ü"])),
                attribute("smoothing", Element::Polygon, 1, texts(&["off", "1", "1"])),
                attribute("material", Element::Polygon, 1, texts(&["red", "red", "blue"])),
            ]
        }
        Format::Off => vec![
            attribute("normal", Element::Vertex, 3, hard(12)),
            attribute("color", Element::Vertex, 4, hard(16)),
            attribute("texture", Element::Vertex, 2, hard(8)),
            attribute("color", Element::Polygon, 3, Values::I64(vec![0, 1, 2, 255, 254, 253, 7, 8, 9])),
        ],
        Format::Ply => vec![
            attribute("normal", Element::Vertex, 3, hard(12)),
            attribute("color", Element::Vertex, 4, Values::I64((0..16).collect())),
            attribute("heat", Element::Vertex, 1, Values::F32(vec![0.1, -0.0, f32::MAX, 1e-45])),
            attribute("vector", Element::Vertex, 5, hard(20)),
            attribute("texture", Element::Corner, 2, hard(20)),
            attribute("corner", Element::Corner, 1, Values::I64((-5..5).collect())),
            attribute("tag", Element::Polygon, 1, Values::I64(vec![-1, 70_000, 3])),
        ],
        Format::Vtk | Format::Vtu => vec![
            attribute("a name with blanks", Element::Vertex, 1, hard(4)),
            attribute("single", Element::Vertex, 2, Values::F32(vec![0.1; 8])),
            attribute("tag", Element::Polygon, 1, Values::I64(vec![i64::MIN, i64::MAX, 0])),
            attribute("vector<&>", Element::Polygon, 3, hard(9)),
        ],
        Format::Msh => vec![
            attribute("tag", Element::Polygon, 1, Values::I64(vec![3, -4, 5])),
            attribute("entity", Element::Polygon, 1, Values::I64(vec![1, 2, 2])),
            attribute("velocity", Element::Vertex, 3, hard(12)),
            attribute("pressure", Element::Polygon, 1, hard(3)),
        ],
        Format::Medit => vec![
            attribute("tag", Element::Vertex, 1, Values::I64(vec![0, 1, 2, -3])),
            attribute("tag", Element::Polygon, 1, Values::I64(vec![1, 2, 3])),
        ],
        Format::Stl | Format::Json => Vec::new(),
    };
    mesh
}

/// A volume with all that the format holds.
pub fn rich_volume(format: Format) -> MeshFile {
    let mut mesh = volume();
    let tags = || Values::I64(vec![7, 8]);
    mesh.attributes = match format {
        Format::Vtk | Format::Vtu => vec![
            attribute("tag", Element::Polygon, 1, Values::I64(vec![5])),
            attribute("tag", Element::Tetrahedron, 1, tags()),
        ],
        Format::Medit => vec![
            attribute("tag", Element::Polygon, 1, Values::I64(vec![5])),
            attribute("tag", Element::Tetrahedron, 1, tags()),
        ],
        Format::Msh => {
            let name = |dimension, tag, name: &str| PhysicalName { dimension, tag, name: name.to_string() };
            mesh.names = vec![name(2, 5, "the outer wall"), name(3, 7, "core")];
            vec![
                attribute("tag", Element::Polygon, 1, Values::I64(vec![5])),
                attribute("tag", Element::Tetrahedron, 1, tags()),
                attribute("entity", Element::Tetrahedron, 1, tags()),
                attribute("stress", Element::Polygon, 1, Values::F64(vec![0.1])),
                attribute("stress", Element::Tetrahedron, 1, Values::F64(vec![1e-300, -0.0])),
            ]
        }
        _ => Vec::new(),
    };
    mesh
}

/// Whether the format has a binary variant that homeo writes.
pub fn encodings(format: Format) -> &'static [Encoding] {
    match format {
        Format::Ply | Format::Vtk | Format::Vtu | Format::Msh => &[Encoding::Text, Encoding::Binary, Encoding::Auto],
        _ => &[Encoding::Text, Encoding::Auto],
    }
}

pub fn written(format: Format, mesh: &MeshFile, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_mesh_to(&mut bytes, format, mesh, &WriteOptions { encoding }).unwrap();
    bytes
}

/// One valid file for each format and encoding, with all that it holds.
pub fn files() -> Vec<(Format, Vec<u8>)> {
    let mut files = Vec::new();
    for format in Format::ALL {
        for &encoding in encodings(format) {
            let surface = rich_surface(format);
            let surface = if format == Format::Json { surface.triangulated().mesh } else { surface };
            files.push((format, written(format, &surface, encoding)));
            if !matches!(format, Format::Obj | Format::Off | Format::Ply | Format::Stl) {
                files.push((format, written(format, &rich_volume(format), encoding)));
            }
        }
    }
    let flat = MeshFile::from_triangles(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]], &[[0, 1, 2]]);
    files.push((Format::Stl, written(Format::Stl, &flat, Encoding::Binary)));
    files.extend(super::formats::SAMPLES.iter().map(|&(format, bytes)| (format, bytes.to_vec())));
    files
}
