//! Rule 7: the section map is a homeomorphism from the source region onto an arc, a circle or a square.
//!
//! Arc and circle: a path through all edges of the region with strictly increasing coordinates.
//! Square: the theorem of [`crate::piecewise_linear`], one dimension down. Ball: nothing to check, since the
//! section is the boundary of the centre and goes to that of a fixed tetrahedron, vertex by vertex.

use crate::complex::Complex;
use crate::manifest::Target;
use crate::map_file::FoliationData;
use crate::piecewise_linear::check_onto_box;
use crate::verdict::{Checked, check, refuted};

/// Checks rule 7; `region` is the complex of the source facets, with the topology of rule 8.
pub(crate) fn check_section(region: &Complex, data: &FoliationData, target: Target) -> Checked {
    match target {
        Target::Square => check_path(region, data, false),
        Target::Disk => check_path(region, data, true),
        Target::Cube => check_square(region, data),
        _ => Ok(()), // the ball needs none, and shells are no foliations
    }
}

/// The section runs once along all source edges, and its coordinates strictly increase.
fn check_path(region: &Complex, data: &FoliationData, is_closed: bool) -> Checked {
    let path = &data.section_vertices;
    let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut steps: Vec<[u32; 2]> = path.windows(2).map(|step| edge(step[0], step[1])).collect();
    if let (true, Some(&first), Some(&last)) = (is_closed, path.first(), path.last()) {
        steps.push(edge(last, first));
    }
    let mut edges: Vec<[u32; 2]> = region.cells().map(|cell| edge(cell[0], cell[1])).collect();
    steps.sort_unstable();
    edges.sort_unstable();
    check(steps == edges, "7", "the section does not run through each source edge once", &[], &[])?;
    let numbers: Vec<f64> = data.section_coordinates.iter().map(|p| p[0]).collect();
    if let Some(i) = numbers.windows(2).position(|step| !matches!(step, [a, b] if a < b)) {
        return Err(refuted("7", "the section's coordinates do not increase", &[], &path[i..i + 2]));
    }
    let is_last = |x: f64| if is_closed { x < 4.0 } else { x == 1.0 };
    let ends_well = matches!(numbers[..], [first, .., last] if first == 0.0 && is_last(last));
    check(ends_well, "7", "the section's coordinates do not begin or end where they have to", &[], &[])
}

/// The section's vertices are those of the region, each once, and their images make a map onto the square.
fn check_square(region: &Complex, data: &FoliationData) -> Checked {
    let mut images = vec![None; region.vertex_count];
    for (&v, &image) in data.section_vertices.iter().zip(&data.section_coordinates) {
        match images.get_mut(v as usize) {
            Some(place @ None) => *place = Some(image),
            _ => return Err(refuted("7", "the section names a vertex twice, or one that does not exist", &[], &[v])),
        }
    }
    for (v, (is_used, image)) in (0..).zip(region.vertices_of(region.cells()).into_iter().zip(&images)) {
        let message = "the section's vertices are not those of the source region";
        check(is_used == image.is_some(), "7", message, &[], &[v])?;
    }
    check_onto_box(region, |v| images[v as usize].unwrap_or_default(), "7")
}
