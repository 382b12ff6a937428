//! From one disk to another that is mapped onto the same shape.

use homeo_core::io::{Attribute, Element};

use super::correspondence::At;
use super::places::{Composite, Place};
use super::points::{Seams, read_at_corners, read_at_triangles, read_at_vertices};
use super::{Status, TransferError, Transferred, check_rows};
use crate::input::SourceMesh;
use crate::map::Foliation;
use crate::progress::Progress;

/// Reads the attributes of one disk off for another: both are mapped onto one shape, and the composite of one map and the
/// inverse of the other says where.
///
/// At each vertex of `onto` values of vertices are read at the corresponding point of `from`, linear in its triangle;
/// labels are those of the nearest corner there. Values of corners are read likewise, each from the side of its triangle.
/// Values of triangles are those of the triangle of `from` in which the middle of the triangle of `onto` lies. What is a
/// label is the same as for [`transfer`](super::transfer).
///
/// # Guarantee
/// Which triangle a point lies in, which side of an edge a corner is on, and which points are vertices is decided exactly;
/// weights are rounded once. A value at a vertex that corresponds to a vertex is a copy, bit for bit. A triangle is
/// [`Split`](Status::Split) where its corners lie in different charts; one that crosses a seam between two parts of one
/// chart, or lies over a chart between its corners, is not noticed, as there is no overlay. Results do not depend on the
/// number of threads.
///
/// # Errors
/// The targets differ, an attribute does not fit the source of `from`, or the run was stopped.
///
/// # Complexity
/// One exact evaluation each way for each vertex of `onto`, if there are values of vertices or corners, and for each
/// triangle, if there are values of these; for a corner on an edge or vertex of `from` some more.
///
/// # References
/// Schneider 2017, chapter 8.
///
/// # Example
/// ```
/// use homeo::construct::foliation::{FoliationParams, build};
/// use homeo::input::SourceMesh;
/// use homeo::map::Target;
/// use homeo::progress::Silent;
/// use homeo::transfer::transfer_across;
/// use homeo_core::io::{Attribute, Element, Values};
/// use homeo_core::mesh::TriangleComplex;
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.4, 0.0]];
/// let cells = TriangleComplex::from_indices(5, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])?;
/// let mesh = SourceMesh::new(corners, cells);
/// let (map, _) = build(&mesh, Target::Disk, &FoliationParams::default(), &Silent)?;
/// let values = Values::F64(vec![0.1, 0.2, 0.3, 0.4, 0.5]);
/// let heat = Attribute { name: "heat".to_owned(), element: Element::Vertex, components: 1, values };
/// assert_eq!(transfer_across(&map, &map, &[heat.clone()], &Silent)?[0].attribute, heat);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn transfer_across(
    from: &Foliation<3>,
    onto: &Foliation<3>,
    attributes: &[Attribute],
    progress: &(dyn Progress + Sync),
) -> Result<Vec<Transferred>, TransferError> {
    if from.target() != onto.target() {
        return Err(TransferError::Targets { from: from.target(), onto: onto.target() });
    }
    attributes.iter().try_for_each(|attribute| check_rows(from.source(), attribute))?;
    let composite = Composite::new(from, onto);
    let any = |element: Element| attributes.iter().any(|attribute| attribute.element == element);
    let on_points = any(Element::Vertex) || any(Element::Corner);
    let vertices = if on_points { composite.of_vertices(progress)? } else { Vec::new() };
    let corners = if any(Element::Corner) { composite.of_corners(&vertices, progress)? } else { Vec::new() };
    let middles = if any(Element::Polygon) { composite.of_middles(progress)? } else { Vec::new() };
    let vertices: Vec<Option<At>> = vertices.iter().map(|place| place.as_ref().map(rounded)).collect();
    let moved = |attribute: &Attribute| match attribute.element {
        Element::Vertex => Some(read_at_vertices(from.source(), attribute, &vertices)),
        Element::Polygon => Some(read_at_triangles(attribute, &middles)),
        Element::Corner => Some(at_corners(from.source(), attribute, &corners)),
        Element::Tetrahedron => None,
    };
    Ok(attributes.iter().filter_map(moved).collect())
}

fn rounded((cell, weights): &Place) -> At {
    At { triangle: cell.raw(), weights: weights.each_ref().map(|weight| weight.to_f64()) }
}

/// Values at corners; triangles with corners in different charts are marked.
fn at_corners(from: &SourceMesh<3>, attribute: &Attribute, corners: &[[Option<At>; 3]]) -> Transferred {
    let mut moved = read_at_corners(attribute, corners.as_flattened());
    let charts = Seams::new(from, attribute).charts();
    for (triangle, places) in corners.iter().enumerate() {
        let [a, b, c] = places.map(|at| at.map(|at| charts[at.triangle as usize]));
        if a != b || b != c {
            moved.status[3 * triangle..3 * triangle + 3].fill(Status::Split);
        }
    }
    moved
}
