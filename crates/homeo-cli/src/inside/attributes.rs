//! What the source's file says, moved to the section, and what is said about that.

use homeo::map::Shell;
use homeo::progress::Progress;
use homeo::transfer::{Status, TransferError, Transferred, transfer};
use homeo_core::io::{Attribute, Values};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::session::Session;
use crate::text::Lines;

/// Moves attributes to the section of a shell. Where there are none, the overlay is not made.
///
/// # Errors
/// When a density is none, or the run was stopped.
pub fn moved(
    session: &Session,
    shell: &Shell,
    attributes: &[Attribute],
    densities: &[String],
) -> Result<Vec<Transferred>> {
    if attributes.is_empty() && densities.is_empty() {
        return Ok(Vec::new());
    }
    session.stage("transfer");
    let moved = transfer(shell, attributes, densities, session).map_err(|error| explain(session, &error))?;
    session.check()?;
    Ok(moved)
}

/// The failure for attributes that were not transferred.
pub fn explain(session: &Session, error: &TransferError) -> Failure {
    match error {
        TransferError::NoDensity(_) => Failure::input("no-density", error.to_string()),
        TransferError::Targets { .. } => Failure::input("targets", error.to_string()),
        TransferError::Cancelled => session.stopped(),
        TransferError::Rows { .. } | TransferError::NoSection | TransferError::NoImage { .. } => {
            Failure::bug(error.to_string())
        }
    }
}

/// The attributes to be written; with their statuses, as numbers, where that is asked for.
pub fn for_file(moved: Vec<Transferred>, with_status: bool) -> Vec<Attribute> {
    let mut attributes = Vec::new();
    for Transferred { attribute, status } in moved {
        if with_status {
            let number =
                |status: &Status| Status::ALL.iter().position(|other| other == status).unwrap_or_default() as i64;
            attributes.push(Attribute {
                name: format!("{}_status", attribute.name),
                element: attribute.element,
                components: 1,
                values: Values::I64(status.iter().map(number).collect()),
            });
        }
        attributes.push(attribute);
    }
    attributes
}

/// One object for each attribute: how many values rest on what.
pub fn described(moved: &[Transferred]) -> Value {
    let one = |moved: &Transferred| {
        let mut described = json!({"name": moved.attribute.name, "element": moved.attribute.element.plural()});
        for status in Status::ALL {
            described[status.name()] = json!(moved.count(status));
        }
        described
    };
    moved.iter().map(one).collect()
}

/// A line for each attribute.
pub fn tell(moved: &[Transferred], lines: &mut Lines) {
    for moved in moved {
        let counts: Vec<String> = Status::ALL
            .into_iter()
            .map(|status| (moved.count(status), status.name()))
            .filter(|(count, _)| *count > 0)
            .map(|(count, name)| format!("{count} {name}"))
            .collect();
        let (name, element) = (&moved.attribute.name, moved.attribute.element.plural());
        lines.add("transferred", format!("{name} on {element}: {}", counts.join(", ")));
    }
}
