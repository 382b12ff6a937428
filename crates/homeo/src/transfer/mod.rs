//! What is known on the source of a shell, moved to its other section: colours, fields, labels, texture coordinates.
//!
//! Theorem:     the map from source to section is a homeomorphism, and its [overlay](crate::overlay) says exactly which
//!              point of the source each vertex of the section is, and how much of each triangle lies over which other.
//! Source:      Jiang, Schneider, Zorin, Panozzo 2020 (doi 10.1145/3414685.3417769), section 4.
//! Differences: values are not sampled: which triangle a vertex lies on, and which triangles lie over one another, is
//!              decided exactly; every value has a [`Status`].
//! Arithmetic:  exact decisions; places, areas and values are rounded, at the end.
//! Cost:        that of the overlay.
//!
//! [`transfer_across`] does the same between two disks that are mapped onto one shape, by the exact composite of the maps
//! at vertices and middles; there is no overlay of these.

mod across;
mod correspondence;
mod faces;
mod places;
mod points;

use homeo_core::io::{Attribute, Element, Values};

use crate::input::SourceMesh;
use crate::map::{EvaluationError, Shell, Target};
use crate::progress::Progress;

pub use across::transfer_across;
use correspondence::Correspondence;

/// What a value on the section rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Status {
    /// A value of the source as it stands: the vertex is one of the source, or all triangles under the face agree.
    Copied,
    /// Between values of the source: linear in the source's triangle, or the average over the area of the face.
    Interpolated,
    /// The label with the largest share, of several.
    Largest,
    /// The value jumps inside the triangle (a texture seam, say): corners have the value on their own side, and the
    /// triangle as a whole has none.
    Split,
    /// There is no value: the vertex is in no triangle, or the source has none there.
    Missing,
}

impl Status {
    /// All of them; the place is the number that files use.
    pub const ALL: [Self; 5] = [Self::Copied, Self::Interpolated, Self::Largest, Self::Split, Self::Missing];

    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Copied => "copied",
            Self::Interpolated => "interpolated",
            Self::Largest => "largest",
            Self::Split => "split",
            Self::Missing => "missing",
        }
    }
}

/// An attribute on the section, and what each of its rows rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// The attribute, with as many rows as the section has such elements.
    pub attribute: Attribute,
    /// One for each row.
    pub status: Vec<Status>,
}

impl Transferred {
    /// How many rows have a status.
    pub fn count(&self, status: Status) -> usize {
        self.status.iter().filter(|&&other| other == status).count()
    }
}

/// Why nothing was transferred.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// The shell has no other section.
    #[error("the shell has no other section to transfer to")]
    NoSection,
    /// An attribute does not fit the source.
    #[error("attribute \"{name}\" has {found} rows, the source has {expected} {element}")]
    Rows {
        /// Its name.
        name: String,
        /// Its rows.
        found: usize,
        /// Those of the source.
        expected: usize,
        /// What they belong to.
        element: &'static str,
    },
    /// A density is no floating-point attribute of polygons.
    #[error("\"{0}\" is no floating-point attribute of triangles, so there is no mass to conserve")]
    NoDensity(String),
    /// Two maps do not lead to one shape.
    #[error("the maps lead to the {from} and the {onto}: make one of them anew onto the other's shape")]
    Targets {
        /// Where the source of the attributes is mapped.
        from: Target,
        /// Where the other mesh is mapped.
        onto: Target,
    },
    /// A point has no image, or no triangle was found on its side: a map comes from a damaged file.
    #[error("triangle {triangle} has a point without an image ({reason}): check both maps with `homeo verify`")]
    NoImage {
        /// The triangle of the mesh to transfer to.
        triangle: usize,
        /// Why.
        reason: EvaluationError,
    },
    /// Stopped from outside.
    #[error("stopped")]
    Cancelled,
}

/// Moves attributes of the source to the section. Attributes of tetrahedra are left out.
///
/// Floating-point values on vertices and corners are interpolated at the exact place of each vertex of the section; whole
/// numbers and texts are labels (but `color`, which is interpolated and rounded). On faces numbers are averaged by area and
/// labels go by the largest area. Attributes of faces that are named in `densities` are masses per area: their integral
/// over each face is that over the part of the source that lies under it, and the total stays the same up to rounding.
///
/// # Errors
/// See [`TransferError`].
///
/// # Complexity
/// That of the [overlay](crate::overlay::for_each_cell); linear if all attributes have one value on all triangles.
pub fn transfer(
    shell: &Shell,
    attributes: &[Attribute],
    densities: &[String],
    progress: &(dyn Progress + Sync),
) -> Result<Vec<Transferred>, TransferError> {
    let section = shell.section().ok_or(TransferError::NoSection)?;
    attributes.iter().try_for_each(|attribute| check_rows(shell.source(), attribute))?;
    let is_density = |attribute: &Attribute| {
        attribute.element == Element::Polygon && matches!(attribute.values, Values::F64(_) | Values::F32(_))
    };
    let named = |name: &String| attributes.iter().any(|attribute| attribute.name == *name && is_density(attribute));
    if let Some(name) = densities.iter().find(|name| !named(name)) {
        return Err(TransferError::NoDensity(name.clone()));
    }
    // What is the same on all triangles, as the only material of a model, needs no knowledge of places.
    let is_plain = |attribute: &Attribute| {
        let count = shell.source().complex().cell_count();
        let is_averaged = attribute.element == Element::Polygon && !densities.contains(&attribute.name);
        is_averaged && count > 0 && (1..count).all(|row| is_same_row(attribute, 0, row))
    };
    let known = if attributes.iter().all(is_plain) {
        None
    } else {
        Some(Correspondence::new(shell, section, progress).ok_or(TransferError::Cancelled)?)
    };
    let moved = |attribute: &Attribute| match (attribute.element, &known) {
        (Element::Tetrahedron, _) => None,
        _ if is_plain(attribute) => Some(faces::everywhere(attribute, section.complex().cell_count())),
        (_, None) => None, // all are plain
        (Element::Vertex, Some(known)) => Some(points::at_vertices(known, attribute)),
        (Element::Corner, Some(known)) => Some(points::at_corners(known, attribute)),
        (Element::Polygon, Some(known)) if densities.contains(&attribute.name) => {
            Some(faces::by_mass(known, attribute))
        }
        (Element::Polygon, Some(known)) => Some(faces::by_area(known, attribute)),
    };
    Ok(attributes.iter().filter_map(moved).collect())
}

fn check_rows(source: &SourceMesh<3>, attribute: &Attribute) -> Result<(), TransferError> {
    let triangles = source.complex().cell_count();
    let expected = match attribute.element {
        Element::Vertex => source.positions().len(),
        Element::Polygon => triangles,
        Element::Corner => 3 * triangles,
        Element::Tetrahedron => return Ok(()),
    };
    let found = attribute.values.len() / attribute.components.max(1);
    if found == expected && attribute.components > 0 {
        return Ok(());
    }
    Err(TransferError::Rows { name: attribute.name.clone(), found, expected, element: attribute.element.plural() })
}

/// Whether values are names that cannot be averaged: texts, and whole numbers but colours.
fn is_label(attribute: &Attribute) -> bool {
    match attribute.values {
        Values::Text(_) => true,
        Values::I64(_) => attribute.name != "color",
        Values::F64(_) | Values::F32(_) => false,
    }
}

/// Whether two rows of an attribute are the same, bit for bit.
fn is_same_row(attribute: &Attribute, p: usize, q: usize) -> bool {
    let row = |row: usize| attribute.components * row..attribute.components * (row + 1);
    match &attribute.values {
        Values::F64(v) => v[row(p)].iter().map(|x| x.to_bits()).eq(v[row(q)].iter().map(|x| x.to_bits())),
        Values::F32(v) => v[row(p)].iter().map(|x| x.to_bits()).eq(v[row(q)].iter().map(|x| x.to_bits())),
        Values::I64(v) => v[row(p)] == v[row(q)],
        Values::Text(v) => v[row(p)] == v[row(q)],
    }
}

/// Whether an entry of a row is not a number: there is no value.
fn has_no_number(values: &Values, components: usize, row: usize) -> bool {
    let row = components * row..components * (row + 1);
    match values {
        Values::F64(v) => v[row].iter().any(|x| x.is_nan()),
        Values::F32(v) => v[row].iter().any(|x| x.is_nan()),
        Values::I64(_) | Values::Text(_) => false,
    }
}
