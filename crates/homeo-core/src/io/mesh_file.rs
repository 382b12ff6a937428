//! What a mesh file says, before any interpretation.

/// Polygons of any size, stored one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonList {
    /// Where each polygon starts in `corners`; one more entry than polygons (or empty).
    pub starts: Vec<u32>,
    /// The vertices of all corners.
    pub corners: Vec<u32>,
}

impl PolygonList {
    /// How many polygons there are.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The vertices of polygon `index`.
    pub fn polygon(&self, index: usize) -> &[u32] {
        &self.corners[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// Adds a polygon at the end.
    pub fn push(&mut self, corners: &[u32]) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.corners.extend_from_slice(corners);
        self.starts.push(self.corners.len() as u32);
    }
}

/// What the rows of an [`Attribute`] belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Element {
    /// One row for each vertex.
    Vertex,
    /// One row for each polygon.
    Polygon,
    /// One row for each corner of each polygon (texture coordinates with seams live here).
    Corner,
    /// One row for each tetrahedron.
    Tetrahedron,
}

/// The numbers or texts of an [`Attribute`].
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Double precision.
    F64(Vec<f64>),
    /// Single precision, kept as such.
    F32(Vec<f32>),
    /// Whole numbers (tags, labels, colours).
    I64(Vec<i64>),
    /// Texts (groups, materials).
    Text(Vec<String>),
}

impl Values {
    /// How many entries there are, rows times components.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(v) => v.len(),
            Self::F32(v) => v.len(),
            Self::I64(v) => v.len(),
            Self::Text(v) => v.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A named quantity on vertices, polygons, corners or tetrahedra.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// The name as in the file; readers use `texture`, `normal`, `color`, `group`, `material` and
    /// `tag` where the format has such a notion without a name of its own.
    pub name: String,
    /// What each row belongs to.
    pub element: Element,
    /// Entries per row.
    pub components: usize,
    /// `rows × components` entries, row by row. A missing floating-point entry is NaN.
    pub values: Values,
}

/// A tag that the file gives a name to (a physical group of Gmsh, say).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhysicalName {
    /// 0 for points, 1 for curves, 2 for surfaces, 3 for volumes.
    pub dimension: u8,
    /// The tag.
    pub tag: i64,
    /// The name.
    pub name: String,
}

/// What a mesh file says, in the file's order.
///
/// Invariant: all corners and tetrahedra name existing vertices, coordinates are finite, attribute
/// lengths match their elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// Coordinates, `#V by 3`; the third is 0 where the file is planar.
    pub positions: Vec<[f64; 3]>,
    /// Coordinates per vertex in the file: 2 or 3.
    pub space: usize,
    /// Surface elements (in a volume mesh: tagged boundary faces).
    pub polygons: PolygonList,
    /// Volume elements.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Fields, tags, texture coordinates, groups.
    pub attributes: Vec<Attribute>,
    /// Names of tags.
    pub names: Vec<PhysicalName>,
    /// What the reader could not keep, one sentence each (for the user's eyes).
    pub losses: Vec<String>,
}
