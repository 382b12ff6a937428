//! What a report shows of a shell.

use homeo_core::mesh::VertexId;

use super::data::{CellList, CellMesh, ShellPicture};
use super::overlay::{Overlay, overlay};
use super::{Leaf, ReportData, TargetShape, VerdictWords};
use crate::input::SourceMesh;
use crate::map::{Shell, ShellParts, distortions};
use crate::overlay::{Refinement, rounded_to};
use crate::progress::Silent;

/// How many pillars a report draws at most.
const PILLARS: usize = 4000;
/// How far from the exact ones positions may be drawn, as a part of the size.
const ACCURACY: f64 = 1e-6;
/// Parts with an area below this share of that of their triangle are not drawn.
const SLIVER: f64 = 1e-6;

/// The drawable part of a report on a shell: the source cut along the prisms, or along the triangles of the other section
/// if there is one, its places there or on the middle surface, the distortion of the map, layers and pillars. Facts and
/// seconds are empty and for the caller to add.
///
/// # Complexity
/// Linear in the pairs of a source triangle and a slab whose boxes meet, in parallel; with another section that of the
/// [common refinement](crate::overlay::refinement).
pub fn report_of_shell(shell: &Shell, title: &str, subtitle: &str, verdict: VerdictWords) -> ReportData {
    let (target, drawn) = match shell.section() {
        Some(section) => (TargetShape::Section, onto_section(shell, section)),
        None => (TargetShape::Middle, onto_middle(shell)),
    };
    ReportData {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        target,
        verdict,
        facts: Vec::new(),
        stage_seconds: Vec::new(),
        cells: drawn.mesh,
        leaves: pillars(shell.parts()),
        distortion: drawn.distortion,
        shell: Some(drawn.picture),
    }
}

/// A surface cut into parts, its image, and what belongs to them.
struct Drawn {
    mesh: CellMesh,
    distortion: Vec<f64>,
    picture: ShellPicture,
}

fn onto_middle(shell: &Shell) -> Drawn {
    let Overlay { mesh, prisms, distortion } = overlay(shell);
    let picture = ShellPicture {
        parts: shell.parts().clone(),
        prism_of_cell: prisms,
        middle_of_vertex: mesh.images.clone(),
        image_triangles: shell.parts().prisms.len(),
    };
    Drawn { mesh, distortion, picture }
}

fn onto_section(shell: &Shell, section: &SourceMesh<3>) -> Drawn {
    // Nobody stops it.
    let refined = rounded_to(ACCURACY, shell, &Silent).unwrap_or_default();
    let seen = seen(shell.source(), section, &refined);
    let triangles: Vec<[u32; 3]> = seen.iter().map(|&t| refined.triangles[t]).collect();
    let cells: Vec<[VertexId; 3]> =
        triangles.iter().map(|corners| corners.map(|v| VertexId::new(v as usize))).collect();
    let picture = ShellPicture {
        parts: shell.parts().clone(),
        prism_of_cell: seen.iter().map(|&t| refined.prisms[t]).collect(),
        middle_of_vertex: refined.middle,
        image_triangles: section.complex().cell_count(),
    };
    let distortion = distortions(&cells, &refined.source, &refined.section);
    let cells = CellList::Triangles(triangles);
    Drawn { mesh: CellMesh { positions: refined.source, images: refined.section, cells }, distortion, picture }
}

/// The triangles of a refinement that are large enough to be seen on both sides.
fn seen(source: &SourceMesh<3>, section: &SourceMesh<3>, refined: &Refinement) -> Vec<usize> {
    let corners =
        |mesh: &SourceMesh<3>, t: u32| mesh.complex().cells()[t as usize].map(|v| mesh.positions()[v.index()]);
    let is_seen = |t: &usize| {
        let [on_source, on_section] =
            [&refined.source, &refined.section].map(|points| area(refined.triangles[*t].map(|v| points[v as usize])));
        let [of_source, of_section] = refined.parents[*t];
        on_source > SLIVER * area(corners(source, of_source))
            && on_section > SLIVER * area(corners(section, of_section))
    };
    (0..refined.triangles.len()).filter(is_seen).collect()
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
    0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Bottom, middle and top of the columns that have a length.
fn pillars(parts: &ShellParts) -> Vec<Leaf> {
    let mut columns: Vec<u32> = parts.prisms.iter().flatten().copied().filter(|&v| !parts.is_pinched(v)).collect();
    columns.sort_unstable();
    columns.dedup();
    let stride = columns.len().div_ceil(PILLARS).max(1);
    let pillar = |v: u32| [&parts.bottom, &parts.middle, &parts.top].map(|points| points[v as usize]).to_vec();
    columns.into_iter().step_by(stride).map(|v| Leaf { source: pillar(v), target: pillar(v) }).collect()
}
