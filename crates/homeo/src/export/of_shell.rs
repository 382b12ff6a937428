//! What a report shows of a shell.

use super::data::ShellPicture;
use super::overlay::{Overlay, overlay};
use super::{Leaf, ReportData, TargetShape, VerdictWords};
use crate::map::{Shell, ShellParts};

/// How many pillars a report draws at most.
const PILLARS: usize = 4000;

/// The drawable part of a report on a shell: the source cut along the prisms, its places on the middle surface, the
/// distortion of the projection, layers and pillars. Facts and seconds are empty and for the caller to add.
///
/// # Complexity
/// Linear in the pairs of a source triangle and a slab whose boxes meet, in parallel.
pub fn report_of_shell(shell: &Shell, title: &str, subtitle: &str, verdict: VerdictWords) -> ReportData {
    let Overlay { mesh, prisms, distortion } = overlay(shell);
    ReportData {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        target: TargetShape::Middle,
        verdict,
        facts: Vec::new(),
        stage_seconds: Vec::new(),
        cells: mesh,
        leaves: pillars(shell.parts()),
        distortion,
        shell: Some(ShellPicture { parts: shell.parts().clone(), prism_of_cell: prisms }),
    }
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
