//! `homeo hyperbolic`: the hyperbolic metric of glued tetrahedra or of a solid, with its certificate.

mod input;
pub mod picture;
mod search;
mod solid;
mod words;

use std::path::Path;

use homeo::certificate::{Provenance, write_hyperbolic};
use serde_json::json;

use crate::answer::Answer;
use crate::args::HyperbolicArgs;
use crate::failure::Result;
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::session::Session;
use input::Input;
use search::Found;

/// Finds the metric, proves it, has the proof checked, and stages the files.
pub fn run(session: &Session, options: &HyperbolicArgs, outputs: &mut Outputs) -> Result<Answer> {
    check_outputs(options)?;
    let input = input::read(session, options)?;
    let found = search::structure(session, &input, options)?;
    session.check()?;
    let provenance = provenance(session, options, &input, &found);
    let claim = proof::write_and_check(session, options.output.as_deref(), outputs, |mut out| {
        write_hyperbolic(&found.triangulation, &found.structure, &provenance, &mut out)
    })?;
    if let Some(path) = &options.picture {
        let placed = (&found.triangulation, &found.skeleton, &found.structure);
        picture::stage(session, options, path, placed, outputs)?;
    }
    if let Some(path) = &options.report {
        let made = (&found.triangulation, &found.structure);
        picture::stage_page(session, path, &input.name, made, &claim, outputs)?;
    }
    session.end_stage();
    let fields = words::fields(options, &found, &claim);
    Ok(Answer::new(fields, words::text(session, options, &input, &found, &claim)))
}

fn check_outputs(options: &HyperbolicArgs) -> Result<()> {
    let inputs: Vec<&Path> = options.input.as_deref().into_iter().collect();
    options.picture.as_deref().map(picture::Format::of_path).transpose()?;
    let outputs = [&options.output, &options.report, &options.picture].into_iter().filter_map(|path| path.as_deref());
    check_targets(&outputs.collect::<Vec<_>>(), &inputs)
}

fn provenance(session: &Session, options: &HyperbolicArgs, input: &Input, found: &Found) -> Provenance {
    Provenance {
        source_name: input.name.clone(),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({
            "entry": options.entry, "retriangulate": options.retriangulate, "canonical": options.canonical, "tries": options.tries,
            "seed": session.common.seed, "tried": found.tried,
        }),
    }
}
