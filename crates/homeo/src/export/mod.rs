//! The report: one HTML page that shows a map and says what was proved about it.
//!
//! [`write_report`] takes a [`ReportData`] and writes a page that needs no network, no server and no
//! other file. The page repeats the verdict in words, with counts and with the limits of the claim,
//! and draws source and target side by side. Everything that is drawn is a *display*: coordinates are
//! rounded to 16 bits per axis and the map is interpolated linearly in each cell, so nothing in the
//! page is evidence for the claim. The evidence is the map file, which `homeo verify` checks.
//!
//! # Example
//! ```
//! use homeo::export::{CellList, CellMesh, ReportData, TargetShape, VerdictWords, write_report};
//!
//! let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let data = ReportData {
//!     title: "Two triangles onto the square".into(),
//!     subtitle: "the identity".into(),
//!     target: TargetShape::Square,
//!     verdict: VerdictWords { holds: true, headline: "The map is one-to-one and onto".into(), ..Default::default() },
//!     facts: vec![("triangles".into(), "2".into())],
//!     stage_seconds: Vec::new(),
//!     cells: CellMesh {
//!         positions: square.clone(),
//!         images: square,
//!         cells: CellList::Triangles(vec![[0, 1, 2], [0, 2, 3]]),
//!     },
//!     leaves: Vec::new(),
//!     distortion: vec![1.0, 1.0],
//!     shell: None,
//! };
//! let mut page = Vec::new();
//! write_report(&data, &mut page)?;
//! assert!(page.starts_with(b"<!doctype html>"));
//! # Ok::<(), std::io::Error>(())
//! ```

mod bundle;
mod chart;
mod cover;
mod data;
mod facets;
mod glb;
mod histogram;
mod hyperbolic;
mod leaves;
mod levels;
mod marching;
mod of_map;
mod of_shell;
mod overlay;
mod pack;
mod page;
mod planar;
mod scene;
mod simplify;
#[cfg(test)]
mod tests;

pub use bundle::{BundleReport, FieldPicture, write_bundle_page};
pub use cover::{CoverPicture, FaceKind, Model};
pub use data::{CellList, CellMesh, Leaf, ReportData, ShellPicture, TargetShape, VerdictWords};
pub use glb::{write_glb, write_gltf};
pub use hyperbolic::{HyperbolicReport, write_hyperbolic_page};
pub use of_map::report_of_map;
pub use of_shell::report_of_shell;
pub use planar::planar_page;

use std::io::{self, Write};

/// Writes the report as one HTML page.
///
/// # Errors
/// Those of `out`, and [`io::ErrorKind::InvalidInput`] where the data contradict themselves: a cell that
/// names a missing vertex, arrays of different lengths, or a coordinate that is not finite. In that case
/// nothing has been written.
///
/// # Complexity
/// Linear in the cells times the number of level sets (at most 21). The page stays near ten megabytes:
/// what does not fit is thinned out, and the page says so.
pub fn write_report(data: &ReportData, out: &mut impl Write) -> io::Result<()> {
    data.check().map_err(|message| io::Error::new(io::ErrorKind::InvalidInput, message))?;
    let scene = scene::Scene::build(data);
    page::write_page(data, &scene, out)
}
