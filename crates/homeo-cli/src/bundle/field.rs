//! A field of vectors on the surface as a section of its bundle: where it is read, what is told of it.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, MeshFile, Values};
use homeo_manifold::bundle::{Section, SectionError, TangentBundle, WoundPaths};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::points;
use crate::session::Session;
use crate::text::{Lines, counted};

/// Singular elements that people see.
const MOST_SHOWN: usize = 8;

/// The section of a field and its indices on the surface that was read.
pub struct FieldSection {
    pub name: String,
    pub vectors: Vec<[f64; 3]>,
    /// The level over each vertex of the base, but for singular ones.
    pub levels: Vec<Option<u32>>,
    /// A path over each edge of the base whose ends have levels.
    pub paths: Vec<Vec<u32>>,
    /// The index of each triangle of the base.
    pub base_indices: Vec<i64>,
    /// Triangles of the surface with an index other than 0.
    pub triangles: Vec<(u32, i64)>,
    /// Vertices where the field is zero, and their indices.
    pub vertices: Vec<(u32, i64)>,
}

/// The vectors that an option names: a file, or a field that the mesh carries.
///
/// # Errors
/// A file that cannot be read; no such field, and which there are; another number of vectors.
pub fn vectors(name: &str, mesh: &MeshFile) -> Result<Vec<[f64; 3]>> {
    let extension = Path::new(name).extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let rows = match extension.as_deref() {
        Some("csv" | "npy") => from_file(Path::new(name))?,
        _ => carried(name, mesh)?,
    };
    let count = mesh.vertex_count;
    if rows.len() == count {
        return Ok(rows);
    }
    let message = format!("{name} has {} vectors for {count} vertices: give one for each vertex", rows.len());
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

fn carried(name: &str, mesh: &MeshFile) -> Result<Vec<[f64; 3]>> {
    if let Some(attribute) = mesh.attribute(name, Element::Vertex)
        && attribute.components == 3
        && let Some(numbers) = numbers(&attribute.values)
    {
        return Ok(numbers.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect());
    }
    let is_field = |attribute: &&Attribute| {
        attribute.components == 3 && attribute.element == Element::Vertex && numbers(&attribute.values).is_some()
    };
    let names: Vec<&str> = mesh.attributes.iter().filter(is_field).map(|attribute| attribute.name.as_str()).collect();
    let there = match names.as_slice() {
        [] => "it carries none at its vertices; give a file .csv or .npy".to_owned(),
        names => format!("its fields of vectors at vertices are {}", names.join(", ")),
    };
    let message = match mesh.attributes.iter().find(|attribute| attribute.name == name) {
        Some(other) => format!(
            "{name} has {} at the {} of the mesh: a section needs 3 at its vertices; {there}",
            counted(other.components, "number", "numbers"),
            other.element.plural()
        ),
        None => format!("the mesh has no field of the name {name}; {there}"),
    };
    Err(Failure::input("unfit-field", message))
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
        (name, vectors): (&str, Vec<[f64; 3]>),
        tangent: &TangentBundle,
        tetrahedra: &[[u32; 4]],
        positions: &[[f64; 3]],
    ) -> Result<Self> {
        session.stage("field");
        let section = Section::of_field(tangent, positions, &vectors).map_err(unfit)?;
        let base = tangent.bundle.triangles();
        let base_indices: Vec<i64> = (0..base.len() as u32).map(|triangle| section.index(triangle)).collect();
        let (paths, vertices) = (section.paths(), section.singular_vertices());
        session.stage("section");
        let wound = WoundPaths::new(base, tangent.bundle.layers(), tetrahedra, &paths)
            .map_err(|fault| Failure::bug(format!("the paths are not those of a section: {fault}")))?;
        if wound.triangles != base_indices || wound.vertices != vertices {
            return Err(Failure::bug("the paths of the section do not wind as its indices say"));
        }
        session.check()?;
        let mut sums = std::collections::BTreeMap::new();
        for (&parent, &index) in tangent.parents.iter().zip(&base_indices).filter(|(_, index)| **index != 0) {
            *sums.entry(parent).or_insert(0) += index;
        }
        let triangles = sums.into_iter().filter(|&(_, index)| index != 0).collect();
        let levels = section.levels().to_vec();
        Ok(Self { name: name.to_owned(), vectors, levels, paths, base_indices, triangles, vertices })
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
            "longest_path": self.paths.iter().map(|path| path.len() - 1).max(),
            "checked": {"fibres": self.levels.iter().flatten().count(), "paths": self.paths.len()},
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
            format!("{} over edges, checked by the tetrahedra alone", counted(self.paths.len(), "path", "paths")),
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
        mesh.attributes = vec![
            attribute("index", Element::Vertex, 1, dense(positions.len(), &self.vertices)),
            attribute("field", Element::Vertex, 3, Values::F64(self.vectors.as_flattened().to_vec())),
            attribute("index", Element::Polygon, 1, dense(triangles.len(), &self.triangles)),
        ];
        mesh
    }
}

fn unfit(error: SectionError) -> Failure {
    let elements = match error {
        SectionError::Zeros { first, second } | SectionError::Opposite { first, second } => json!([first, second]),
        SectionError::NoDirection { vertex } | SectionError::Flat { vertex } => json!([vertex]),
        _ => json!([]),
    };
    Failure::input("unfit-field", error.to_string()).with("elements", elements)
}
