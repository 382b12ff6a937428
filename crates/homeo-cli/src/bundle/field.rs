//! A field of vectors on the surface as a section of its bundle: where it is read, what is told of it.

use std::path::Path;

use homeo::certificate::StoredSection;
use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, MeshFile, Values};
use homeo_manifold::bundle::{MiddleSurface, Section, SectionError, TangentBundle, WoundPaths};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::points;
use crate::session::Session;
use crate::text::{Lines, counted};

/// Singular elements that people see.
const MOST_SHOWN: usize = 8;

/// A field of vectors as it was given.
pub enum Vectors {
    AtVertices(Vec<[f64; 3]>),
    OnTriangles(Vec<[f64; 3]>),
}

/// The section of a field and its indices on the surface that was read.
pub struct FieldSection {
    pub name: String,
    pub vectors: Vectors,
    /// As the certificate has it.
    pub section: StoredSection,
    /// Triangles of the surface with an index other than 0.
    pub triangles: Vec<(u32, i64)>,
    /// Vertices where the field is zero, and their indices; for vectors on triangles those with an index other than 0.
    pub vertices: Vec<(u32, i64)>,
}

/// The vectors that an option names: a file, or a field that the mesh carries; `triangles` is how many there are.
///
/// # Errors
/// A file that cannot be read; no such field, and which there are; another number of vectors.
pub fn vectors(name: &str, mesh: &MeshFile, triangles: usize) -> Result<Vectors> {
    let extension = Path::new(name).extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let (rows, element) = match extension.as_deref() {
        Some("csv" | "npy") => (from_file(Path::new(name))?, None),
        _ => carried(name, mesh).map(|(rows, element)| (rows, Some(element)))?,
    };
    let vertices = mesh.vertex_count;
    if rows.len() == vertices && element != Some(Element::Polygon) {
        return Ok(Vectors::AtVertices(rows));
    }
    if rows.len() == triangles && element != Some(Element::Vertex) {
        return Ok(Vectors::OnTriangles(rows));
    }
    let message = format!(
        "{name} has {} vectors for {vertices} vertices and {triangles} triangles: give one for each vertex, or one for each \
         triangle",
        rows.len()
    );
    Err(Failure::input("unfit-field", message))
}

fn from_file(path: &Path) -> Result<Vec<[f64; 3]>> {
    let table = points::read(path)?;
    if table.columns == 3 {
        return Ok(table.rows);
    }
    let message = format!("{} has {} columns: vectors in space have 3, x, y and z", path.display(), table.columns);
    Err(Failure::input("unfit-field", message))
}

/// The field of this name, at vertices if there are two.
fn carried(name: &str, mesh: &MeshFile) -> Result<(Vec<[f64; 3]>, Element)> {
    const ELEMENTS: [Element; 2] = [Element::Vertex, Element::Polygon];
    for element in ELEMENTS {
        if let Some(attribute) = mesh.attribute(name, element)
            && attribute.components == 3
            && let Some(numbers) = numbers(&attribute.values)
        {
            return Ok((numbers.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect(), element));
        }
    }
    let is_field = |attribute: &&Attribute| {
        attribute.components == 3 && ELEMENTS.contains(&attribute.element) && numbers(&attribute.values).is_some()
    };
    let names: Vec<&str> = mesh.attributes.iter().filter(is_field).map(|attribute| attribute.name.as_str()).collect();
    let there = match names.as_slice() {
        [] => "it carries none at its vertices or triangles; give a file .csv or .npy".to_owned(),
        names => format!("its fields of vectors are {}", names.join(", ")),
    };
    let message = match mesh.attributes.iter().find(|attribute| attribute.name == name) {
        Some(other) => format!(
            "{name} has {} at the {} of the mesh: a section needs 3 at its vertices or triangles; {there}",
            counted(other.components, "number", "numbers"),
            other.element.plural()
        ),
        None => format!("the mesh has no field of the name {name}; {there}"),
    };
    Err(Failure::input("unfit-field", message))
}

/// The surface of middles, where vectors are on triangles.
///
/// # Errors
/// A surface that is not closed.
pub fn middles(vectors: Option<&Vectors>, triangles: &[[u32; 3]], count: usize) -> Result<Option<MiddleSurface>> {
    let is_needed = matches!(vectors, Some(Vectors::OnTriangles(_)));
    is_needed.then(|| MiddleSurface::new(triangles, count).map_err(unfit)).transpose()
}

fn numbers(values: &Values) -> Option<Vec<f64>> {
    match values {
        Values::F64(numbers) => Some(numbers.clone()),
        Values::F32(numbers) => Some(numbers.iter().map(|&x| f64::from(x)).collect()),
        Values::I64(numbers) => Some(numbers.iter().map(|&x| x as f64).collect()),
        Values::Text(_) => None,
    }
}

impl FieldSection {
    /// The section of a field, checked by its paths and the tetrahedra alone.
    ///
    /// # Errors
    /// Vectors that say nothing of an index, with their vertices; [`Exit::Bug`](crate::failure::Exit::Bug) where the check
    /// does not hold.
    pub fn new(
        session: &Session,
        (name, vectors): (&str, Vectors),
        (tangent, middles): (&TangentBundle, Option<&MiddleSurface>),
        tetrahedra: &[[u32; 4]],
        positions: &[[f64; 3]],
    ) -> Result<Self> {
        session.stage("field");
        let section = match (&vectors, middles) {
            (Vectors::OnTriangles(rows), Some(middles)) => middles.section(tangent, positions, rows),
            (Vectors::OnTriangles(rows) | Vectors::AtVertices(rows), _) => Section::of_field(tangent, positions, rows),
        };
        let section = section.map_err(unfit)?;
        let stored = StoredSection::new(&section);
        session.stage("section");
        let wound = WoundPaths::new(tangent.bundle.triangles(), tangent.bundle.layers(), tetrahedra, &stored.paths)
            .map_err(|fault| Failure::bug(format!("the paths are not those of a section: {fault}")))?;
        if wound.triangles != stored.triangle_indices || wound.vertices != section.singular_vertices() {
            return Err(Failure::bug("the paths of the section do not wind as its indices say"));
        }
        session.check()?;
        let (triangles, vertices) = match middles {
            Some(middles) => (Vec::new(), sparse(middles.indices(tangent, &section))),
            None => (by_parents(tangent, &stored), section.singular_vertices()),
        };
        Ok(Self { name: name.to_owned(), vectors, section: stored, triangles, vertices })
    }

    fn is_on_triangles(&self) -> bool {
        matches!(self.vectors, Vectors::OnTriangles(_))
    }

    /// The vectors at the vertices of the surface below the bundle, but for added ones; for vectors on triangles they are at
    /// its middles, which come after the vertices that were read.
    pub fn at_vertices(&self, read: usize) -> Vec<[f64; 3]> {
        match &self.vectors {
            Vectors::AtVertices(rows) => rows.clone(),
            Vectors::OnTriangles(rows) => std::iter::repeat_n([0.0; 3], read).chain(rows.iter().copied()).collect(),
        }
    }

    /// Of all indices.
    pub fn sum(&self) -> i64 {
        self.triangles.iter().chain(&self.vertices).map(|(_, index)| index).sum()
    }

    /// For the answer as JSON.
    pub fn described(&self, euler_characteristic: i64) -> Value {
        let list = |of: &str, elements: &[(u32, i64)]| -> Value {
            elements.iter().map(|(element, index)| json!({of: element, "index": index})).collect()
        };
        json!({
            "name": self.name,
            "singular_triangles": list("triangle", &self.triangles),
            "singular_vertices": list("vertex", &self.vertices),
            "sum": self.sum(),
            "euler_characteristic": euler_characteristic,
            "vectors": if self.is_on_triangles() { "triangles" } else { "vertices" },
            "longest_path": self.section.paths.iter().map(|path| path.len() - 1).max(),
            "checked": {"fibres": self.section.levels.iter().flatten().count(), "paths": self.section.paths.len()},
        })
    }

    /// For the answer in words.
    pub fn tell(&self, lines: &mut Lines) {
        let sum = format!("{} singular, indices add up to {}", self.triangles.len() + self.vertices.len(), self.sum());
        lines.add("field", format!("{}: {sum}", self.name));
        let triangles = self.triangles.iter().map(|(element, index)| ("triangle", element, index));
        let vertices = self.vertices.iter().map(|(element, index)| ("vertex", element, index));
        let all: Vec<_> = vertices.chain(triangles).collect();
        for (kind, element, index) in all.iter().take(MOST_SHOWN) {
            lines.add("", format!("{kind} {element}: index {index:+}"));
        }
        if all.len() > MOST_SHOWN {
            lines.add("", format!("and {} more (--json has all)", all.len() - MOST_SHOWN));
        }
        lines.add(
            "section",
            format!(
                "{} over edges, checked by the tetrahedra alone",
                counted(self.section.paths.len(), "path", "paths")
            ),
        );
    }

    /// The surface with the field and the indices of its triangles and vertices.
    pub fn surface(&self, positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> MeshFile {
        let mut mesh = MeshFile::from_triangles(positions.to_vec(), triangles);
        let dense = |count: usize, sparse: &[(u32, i64)]| {
            let mut all = vec![0; count];
            sparse.iter().for_each(|&(element, index)| all[element as usize] = index);
            Values::I64(all)
        };
        let attribute =
            |name: &str, element, components, values| Attribute { name: name.to_owned(), element, components, values };
        let field =
            |element, rows: &[[f64; 3]]| attribute("field", element, 3, Values::F64(rows.as_flattened().to_vec()));
        mesh.attributes = vec![
            attribute("index", Element::Vertex, 1, dense(positions.len(), &self.vertices)),
            match &self.vectors {
                Vectors::AtVertices(rows) => field(Element::Vertex, rows),
                Vectors::OnTriangles(rows) => field(Element::Polygon, rows),
            },
            attribute("index", Element::Polygon, 1, dense(triangles.len(), &self.triangles)),
        ];
        mesh
    }
}

/// The indices of the triangles of a surface, added up over what they were cut into.
fn by_parents(tangent: &TangentBundle, section: &StoredSection) -> Vec<(u32, i64)> {
    let mut sums = std::collections::BTreeMap::new();
    for (&parent, &index) in tangent.parents.iter().zip(&section.triangle_indices).filter(|(_, index)| **index != 0) {
        *sums.entry(parent).or_insert(0) += index;
    }
    sums.into_iter().filter(|&(_, index)| index != 0).collect()
}

fn sparse(indices: Vec<i64>) -> Vec<(u32, i64)> {
    (0..).zip(indices).filter(|&(_, index)| index != 0).collect()
}

/// The refusal, with its elements.
pub fn unfit(error: SectionError) -> Failure {
    let elements = match error {
        SectionError::Zeros { first, second }
        | SectionError::Opposite { first, second }
        | SectionError::OppositeTriangles { first, second } => json!([first, second]),
        SectionError::NoDirection { vertex } | SectionError::Flat { vertex } => json!([vertex]),
        SectionError::NoVector { triangle } | SectionError::FlatTriangle { triangle } => json!([triangle]),
        _ => json!([]),
    };
    Failure::input("unfit-field", error.to_string()).with("elements", elements)
}
