//! `homeo info`: everything that a construction will demand of a file, with all that is wrong.

mod gluing;
mod image;
mod mesh;
mod polygons;

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::io::Format;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::InfoArgs;
use crate::failure::{Failure, Result};
use crate::session::Session;

/// Looks at a file of any kind that homeo knows.
pub fn run(session: &Session, options: &InfoArgs) -> Result<Answer> {
    let path = options.input.as_path();
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if ["png", "jpg", "jpeg"].contains(&extension.as_str()) {
        return image::describe(&read(session, path)?, path);
    }
    if extension == "svg" {
        session.fact("input", json!({"path": path.display().to_string()}));
        let rings = crate::warp::polygons::rings(path)?;
        let value = if rings.len() == 1 { json!(rings[0]) } else { json!({"outer": rings[0], "holes": rings[1..]}) };
        return polygons::describe(session, &value, path);
    }
    if Format::of_path(path) == Some(Format::Json) {
        let bytes = read(session, path)?;
        let value: Value = serde_json::from_slice(&bytes)
            .map_err(|e| Failure::input("bad-syntax", format!("{}: {e}", path.display())))?;
        if gluing::is_gluing(&value) {
            return gluing::describe(session, &value, path);
        }
        if polygons::is_polygons(&value) {
            return polygons::describe(session, &value, path);
        }
    }
    mesh::describe(session, options)
}

fn read(session: &Session, path: &Path) -> Result<Vec<u8>> {
    session.stage("read");
    session.fact("input", json!({"path": path.display().to_string()}));
    std::fs::read(path).map_err(|e| Failure::input("cannot-open", format!("{} cannot be read: {e}", path.display())))
}

/// A violation found here, in the form of those of the library.
fn violation(code: &str, severity: &str, kind: &str, elements: Vec<u32>, count: usize, message: String) -> Value {
    json!({
        "code": code, "severity": severity, "kind": kind, "elements": elements, "count": count, "message": message,
    })
}

/// The lines for people on what is wrong.
fn violations_text(violations: &[Value]) -> String {
    if violations.is_empty() {
        return "violations: none\n".to_owned();
    }
    let mut text = "violations\n".to_owned();
    for violation in violations {
        let field = |name: &str| violation[name].as_str().unwrap_or_default();
        text.push_str(&format!("  {:7}  {}: {}\n", field("severity"), field("code"), field("message")));
    }
    text
}
