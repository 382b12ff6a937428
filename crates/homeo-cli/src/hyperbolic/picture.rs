//! Pictures and pages of hyperbolic structures.

use std::path::Path;

use homeo::export::{
    CoverPicture, HyperbolicReport, Model, VerdictWords, write_glb, write_gltf, write_hyperbolic_page,
};
use homeo::progress::Progress;
use homeo_manifold::hyperbolic::{Embedding, Structure};
use homeo_manifold::{Skeleton, Triangulation};
use homeo_verify::Claim;

use crate::args::{HyperbolicArgs, ModelName};
use crate::failure::{Failure, Result};
use crate::outputs::Outputs;
use crate::session::Session;

/// Parts of a side in pictures of few pieces, and how many those are.
const FINE: usize = 8;
const FEW_PIECES: usize = 200;
/// Parts of a side in pictures of many pieces.
const COARSE: usize = 3;

/// Which kind of file a picture is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Binary,
    Text,
}

impl Format {
    /// By the extension.
    ///
    /// # Errors
    /// When it is none of the two.
    pub fn of_path(path: &Path) -> Result<Self> {
        match path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase().as_str() {
            "glb" => Ok(Self::Binary),
            "gltf" => Ok(Self::Text),
            _ => Err(Failure::usage(format!("{}: pictures are written as .glb or .gltf", path.display()))),
        }
    }
}

/// Stages the picture.
///
/// # Errors
/// When it cannot be written.
pub fn stage(
    session: &Session,
    options: &HyperbolicArgs,
    path: &Path,
    (triangulation, skeleton, structure): (&Triangulation, &Skeleton, &Structure),
    outputs: &mut Outputs,
) -> Result<()> {
    session.stage("picture");
    let format = Format::of_path(path)?;
    let embedding = Embedding::new(triangulation, skeleton, structure)
        .ok_or_else(|| Failure::bug("a structure that was proved cannot be placed in space"))?;
    let depth = usize::from(options.depth);
    let model = match options.model {
        ModelName::Ball => Model::Ball,
        ModelName::HalfSpace => Model::HalfSpace,
    };
    let parts = if embedding.cover(depth).len() <= FEW_PIECES { FINE } else { COARSE };
    session.check()?;
    let picture = CoverPicture::new(&embedding, depth, model, parts);
    session.check()?;
    outputs.stage(session, path, |out| {
        let written = match format {
            Format::Binary => write_glb(&picture, out),
            Format::Text => write_gltf(&picture, out),
        };
        written.map_err(|e| e.to_string())
    })?;
    session.check()
}

/// Stages the page.
///
/// # Errors
/// When it cannot be written.
pub fn stage_page(
    session: &Session,
    path: &Path,
    title: &str,
    (triangulation, structure): (&Triangulation, &Structure),
    claim: &Claim,
    outputs: &mut Outputs,
) -> Result<()> {
    session.stage("report");
    let verdict = VerdictWords {
        holds: true,
        headline: "A hyperbolic metric with totally geodesic boundary, the only one".to_owned(),
        sentences: vec![claim.statement.clone()],
        checked: claim.checked.iter().map(|&(what, count)| (what.to_owned(), count)).collect(),
        limits: claim.limits.clone(),
    };
    let seconds: Vec<(String, f64)> = session.seconds().into_iter().map(|(name, s)| (name.to_owned(), s)).collect();
    let subtitle = format!("truncated tetrahedra, homeo {}", env!("CARGO_PKG_VERSION"));
    let report = HyperbolicReport {
        title,
        subtitle: &subtitle,
        verdict: &verdict,
        triangulation,
        structure,
        stage_seconds: &seconds,
    };
    outputs.stage(session, path, |out| write_hyperbolic_page(&report, out).map_err(|e| e.to_string()))?;
    session.check()
}
