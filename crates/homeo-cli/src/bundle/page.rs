//! The page of a bundle.

use std::path::Path;

use homeo::export::{BundleReport, FieldPicture, VerdictWords, write_bundle_page};
use homeo::progress::Progress;
use homeo_verify::Claim;

use super::Made;
use crate::failure::Result;
use crate::outputs::Outputs;
use crate::session::Session;
use crate::text::file_name;

/// So many indices are listed.
const MOST_INDICES: usize = 40;

/// Stages the page.
///
/// # Errors
/// When it cannot be written.
pub fn stage(
    session: &Session,
    path: &Path,
    input: &Path,
    (made, positions, triangles): (&Made, &[[f64; 3]], &[[u32; 3]]),
    claim: &Claim,
    outputs: &mut Outputs,
) -> Result<()> {
    session.stage("report");
    let verdict = VerdictWords {
        holds: true,
        headline: format!("A closed 3-manifold, the unit tangent bundle of a surface of genus {}", made.genus()),
        sentences: vec![claim.statement.clone()],
        checked: claim.checked.iter().map(|&(what, count)| (what.to_owned(), count)).collect(),
        limits: claim.limits.clone(),
    };
    let seconds: Vec<(String, f64)> = session.seconds().into_iter().map(|(name, s)| (name.to_owned(), s)).collect();
    let read = positions.len() - made.middles;
    let vectors = made.field.as_ref().map(|field| field.at_vertices(read)).unwrap_or_default();
    let field = made.field.as_ref().map(|field| FieldPicture {
        vectors: &vectors,
        triangles: &field.triangles,
        vertices: &field.vertices,
        paths: &field.section.paths,
    });
    let report = BundleReport {
        title: &format!("Unit tangent bundle of {}", file_name(input)),
        subtitle: &format!("homeo {}", env!("CARGO_PKG_VERSION")),
        verdict: &verdict,
        tangent: &made.tangent,
        positions,
        triangles,
        field,
        facts: &facts(made),
        stage_seconds: &seconds,
    };
    outputs.stage(session, path, |out| write_bundle_page(&report, out).map_err(|e| e.to_string()))?;
    session.check()
}

fn facts(made: &Made) -> Vec<(String, String)> {
    let base = &made.tangent.bundle;
    let fact = |label: &str, value: String| (label.to_owned(), value);
    let mut facts = vec![
        fact("genus", made.genus().to_string()),
        fact("Euler number", made.euler_number.to_string()),
        fact("first homology", made.homology.to_string()),
        fact("tetrahedra", made.tetrahedra.len().to_string()),
        fact("vertices", made.vertex_count().to_string()),
        fact("edges of a fibre", base.layers().to_string()),
        fact("triangles of the base", base.triangles().len().to_string()),
        fact("paths of the cut", made.tangent.cuts.len().to_string()),
    ];
    if let Some(field) = &made.field {
        facts.push(fact("field", field.name.clone()));
        facts.push(fact("sum of its indices", field.sum().to_string()));
        let elements = field.vertices.iter().map(|found| ("vertex", found));
        let elements = elements.chain(field.triangles.iter().map(|found| ("triangle", found)));
        for (kind, (element, index)) in elements.take(MOST_INDICES) {
            facts.push(fact(&format!("index of {kind} {element}"), format!("{index:+}")));
        }
        let count = field.vertices.len() + field.triangles.len();
        if count > MOST_INDICES {
            facts.push(fact("more that are singular", format!("{} (in the file of --indices)", count - MOST_INDICES)));
        }
    }
    facts
}
