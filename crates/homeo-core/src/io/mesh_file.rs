//! What a mesh file says, before any interpretation.

use std::sync::Arc;

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

    /// All polygons in order.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + '_ {
        self.starts.windows(2).map(|pair| &self.corners[pair[0] as usize..pair[1] as usize])
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

impl Element {
    /// The word for several of them.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Vertex => "vertices",
            Self::Polygon => "polygons",
            Self::Corner => "corners",
            Self::Tetrahedron => "tetrahedra",
        }
    }
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
    /// Texts (groups, materials); equal texts share their memory.
    Text(Vec<Arc<str>>),
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
    /// Coordinates, `#V by 3`; the third is 0 where the file is planar. Empty where `space` is 0.
    pub positions: Vec<[f64; 3]>,
    /// How many vertices there are; the length of `positions` unless `space` is 0.
    pub vertex_count: usize,
    /// Coordinates per vertex in the file: 2 or 3, or 0 where the file gives connectivity only.
    pub space: usize,
    /// Surface elements (in a volume mesh: tagged boundary faces).
    pub polygons: PolygonList,
    /// Volume elements.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Fields, tags, texture coordinates, groups.
    pub attributes: Vec<Attribute>,
    /// Names of tags.
    pub names: Vec<PhysicalName>,
    /// Files with the materials that the attribute `material` names (the `mtllib` of OBJ).
    pub material_libraries: Vec<String>,
    /// What the reader could not keep, one sentence each (for the user's eyes).
    pub losses: Vec<String>,
}

impl MeshFile {
    /// A surface of triangles in space.
    pub fn from_triangles(positions: Vec<[f64; 3]>, triangles: &[[u32; 3]]) -> Self {
        let mut polygons = PolygonList::default();
        triangles.iter().for_each(|triangle| polygons.push(triangle));
        Self { vertex_count: positions.len(), positions, space: 3, polygons, ..Self::default() }
    }

    /// A volume of tetrahedra in space.
    pub fn from_tetrahedra(positions: Vec<[f64; 3]>, tetrahedra: Vec<[u32; 4]>) -> Self {
        Self { vertex_count: positions.len(), positions, space: 3, tetrahedra, ..Self::default() }
    }

    /// Whether there are tetrahedra; the polygons are then tagged faces of them.
    pub fn is_volume(&self) -> bool {
        !self.tetrahedra.is_empty()
    }

    /// How many elements of a kind there are.
    pub fn count(&self, element: Element) -> usize {
        match element {
            Element::Vertex => self.vertex_count,
            Element::Polygon => self.polygons.len(),
            Element::Corner => self.polygons.corners.len(),
            Element::Tetrahedron => self.tetrahedra.len(),
        }
    }

    /// The attribute of that name on that kind of element.
    pub fn attribute(&self, name: &str, element: Element) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name && attribute.element == element)
    }

    /// Whether the invariant of this type holds.
    ///
    /// # Errors
    /// A sentence on the first thing that breaks it.
    pub fn check(&self) -> Result<(), String> {
        self.check_vertices()?;
        self.check_polygons()?;
        let stray = self.tetrahedra.iter().flatten().find(|&&vertex| vertex as usize >= self.vertex_count);
        if let Some(vertex) = stray {
            return Err(format!("a tetrahedron names vertex {vertex} of {}", self.vertex_count));
        }
        for attribute in &self.attributes {
            let expected = self.count(attribute.element).saturating_mul(attribute.components);
            if attribute.components == 0 || attribute.values.len() != expected {
                let Attribute { name, components, values, .. } = attribute;
                let found = values.len();
                return Err(format!(
                    "attribute \"{name}\" with {components} components has {found} entries instead of {expected}"
                ));
            }
        }
        Ok(())
    }

    fn check_vertices(&self) -> Result<(), String> {
        let expected = if self.space == 0 { 0 } else { self.vertex_count };
        if self.positions.len() != expected {
            return Err(format!("there are {} positions instead of {expected}", self.positions.len()));
        }
        if self.space == 1 || self.space > 3 {
            return Err(format!("vertices have {} coordinates instead of 0, 2 or 3", self.space));
        }
        if self.vertex_count >= u32::MAX as usize {
            return Err(format!("there are {} vertices, more than 32 bits can number", self.vertex_count));
        }
        match self.positions.iter().position(|position| position.iter().any(|x| !x.is_finite())) {
            Some(vertex) => Err(format!("vertex {vertex} has a coordinate that is not finite")),
            None => Ok(()),
        }
    }

    fn check_polygons(&self) -> Result<(), String> {
        let PolygonList { starts, corners } = &self.polygons;
        let ends_meet = match (starts.first(), starts.last()) {
            (Some(&first), Some(&last)) => first == 0 && last as usize == corners.len(),
            _ => corners.is_empty(),
        };
        if !ends_meet || starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err("the starts of the polygons do not partition the corners".to_string());
        }
        match corners.iter().find(|&&vertex| vertex as usize >= self.vertex_count) {
            Some(vertex) => Err(format!("a polygon names vertex {vertex} of {}", self.vertex_count)),
            None => Ok(()),
        }
    }
}
