//! The shells in which `homeo simplify` and `homeo remesh` work, and which of them is kept.

use std::cell::Cell;

use homeo::construct::section::{
    Attempt, InShellError, SimplifiedInShell, SimplifyEnd, SimplifyParams, TexturedSurface, shells_in_turn,
    simplify_in_shells,
};
use homeo::construct::shell::ShellParams;
use homeo::progress::Progress;
use serde_json::{Value, json};

use super::make::explain;
use crate::args::{InsideArgs, SimplifyArgs};
use crate::failure::Result;
use crate::session::Session;
use crate::shell;
use crate::text::Lines;

/// The shell to begin with.
pub fn usual(options: &InsideArgs) -> ShellParams {
    let [usual, _] = shells_in_turn();
    ShellParams { thickness: options.thickness.unwrap_or(usual.thickness), ..usual }
}

/// Simplifies a surface in the shell that is asked for, or in the first that allows so few triangles.
///
/// The time limit ends the run as long as there is no section, and the search for a better one afterwards.
pub fn search(
    session: &Session,
    start: &TexturedSurface,
    options: &SimplifyArgs,
    params: &SimplifyParams,
) -> Result<SimplifiedInShell> {
    let [_, steep] = shells_in_turn();
    let mut first = usual(&options.common);
    if let Some(angle) = options.largest_angle {
        first.largest_angle = angle.to_radians();
    }
    let is_asked_for = options.largest_angle.is_some() || options.common.thickness.is_some();
    // Without a number of triangles the error ends it, in any shell.
    let others = if is_asked_for || options.to.is_none() { vec![] } else { vec![steep] };
    let progress = Searching { session, is_again: Cell::new(false) };
    let found = simplify_in_shells(start, &first, &others, params, &progress).map_err(|error| match error {
        InShellError::Shell(error) => shell::explain(session, &error),
        InShellError::Section(error) => explain(error),
    })?;
    if progress.is_again.get() && session.let_time_end_run() {
        session.display().note("the time limit cut the search in another shell short: the best section so far is kept");
    }
    Ok(found)
}

/// The session, with a time limit that ends the search and not the run once there is a section.
struct Searching<'s> {
    session: &'s Session,
    is_again: Cell<bool>,
}

impl Progress for Searching<'_> {
    fn stage(&self, name: &'static str) {
        if name == "again" && !self.is_again.replace(true) {
            self.session.let_time_end_work();
        }
        self.session.stage(name);
    }

    fn is_cancelled(&self) -> bool {
        self.session.is_cancelled()
    }
}

/// The shells that were tried, if there were several.
pub fn tell(found: &SimplifiedInShell, lines: &mut Lines) {
    for (number, attempt) in found.attempts.iter().enumerate().filter(|_| found.attempts.len() > 1) {
        let label = if number == found.kept { "shell kept" } else { "shell tried" };
        let angle = attempt.largest_angle.to_degrees();
        let outcome = match &attempt.outcome {
            Ok(outcome) => format!("{} triangles in {} prisms", outcome.triangles, outcome.prisms),
            Err(error) => format!("none: {error}"),
        };
        lines.add(label, format!("{outcome} (largest angle {angle:.2} degrees)"));
    }
}

/// The shells that were tried, for JSON.
pub fn described(found: &SimplifiedInShell) -> Value {
    let described = |attempt: &Attempt| {
        let angle = (attempt.largest_angle.to_degrees() * 1e9).round() / 1e9;
        let outcome = attempt.outcome.as_ref();
        json!({
            "largest_angle": angle,
            "prisms": outcome.ok().map(|outcome| outcome.prisms),
            "triangles": outcome.ok().map(|outcome| outcome.triangles),
            "cut_short": outcome.is_ok_and(|outcome| outcome.end == SimplifyEnd::Cancelled),
            "error": outcome.err().map(ToString::to_string),
        })
    };
    found.attempts.iter().map(described).collect()
}
