//! The structure of a triangulation, or of another one of the same manifold.

use std::collections::HashSet;

use homeo::progress::Progress;
use homeo_manifold::hyperbolic::{Canonical, NoMetric, NotCanonical, Structure, find_canonical};
use homeo_manifold::simplify::{Simplifier, SimplifyError, without_inner_vertices};
use homeo_manifold::{FundamentalGroup, Homology, Links, Skeleton, Triangulation, signature};
use serde_json::json;

use super::input::Input;
use crate::args::HyperbolicArgs;
use crate::failure::{Exit, Failure, Result};
use crate::session::Session;

/// A triangulation with its structure.
pub struct Found {
    /// The one that has the structure.
    pub triangulation: Triangulation,
    /// Its classes.
    pub skeleton: Skeleton,
    /// The structure, proved.
    pub structure: Structure,
    /// How many other triangulations were tried before, different ones.
    pub tried: usize,
    /// The canonical decomposition, if it was found.
    pub canonical: std::result::Result<Canonical, NotCanonical>,
}

/// Any triangulation of the manifold with its structure, proved; and how many others were tried before.
struct Metric {
    triangulation: Triangulation,
    structure: Structure,
    tried: usize,
}

/// The genera of the boundary components that cut-off vertices leave, in ascending order; spheres are inner points.
pub fn genera(triangulation: &Triangulation) -> Vec<usize> {
    let links = Links::new(triangulation, &Skeleton::new(triangulation));
    let mut genera: Vec<usize> =
        links.all().iter().filter(|link| !link.is_sphere()).filter_map(|link| link.genus()).collect();
    genera.sort_unstable();
    genera
}

/// Finds and proves the structure of a manifold, and the canonical decomposition; takes this for a mesh, or if it is asked for.
///
/// # Errors
/// With exit code 3 where it is proved that there is none, with 4 where none was found.
pub fn structure(session: &Session, input: &Input, options: &HyperbolicArgs) -> Result<Found> {
    let metric = any_structure(session, input, options.retriangulate, options.tries)?;
    session.stage("canonical");
    let tries = 10 * options.tries.max(1);
    let canonical = find_canonical(&metric.triangulation, &metric.structure, tries, || session.check().is_ok());
    session.check()?;
    let taken = match &canonical {
        Ok(canonical) if options.canonical || input.is_free => {
            unless_same(&metric.triangulation, &canonical.triangulation)?;
            let (triangulation, structure) = (canonical.triangulation.clone(), canonical.structure.clone());
            Metric { triangulation, structure, tried: metric.tried }
        }
        Err(reason) if options.canonical => {
            let message = format!("{}: {reason}\n  nothing was written; without --canonical it is", input.name);
            return Err(Failure::limits("not-canonical", message));
        }
        _ => metric,
    };
    let Metric { triangulation, structure, tried } = taken;
    Ok(Found { skeleton: Skeleton::new(&triangulation), triangulation, structure, tried, canonical })
}

fn any_structure(session: &Session, input: &Input, retriangulate: bool, tries: usize) -> Result<Metric> {
    session.stage("metric");
    let refusal = match attempt(input.triangulation.clone(), 0) {
        Ok(found) => return Ok(found),
        Err(refusal) => refusal,
    };
    session.check()?;
    let may_go_on = retriangulate || input.is_free || !refusal.is_proved();
    if is_about_manifold(&refusal, &input.triangulation) {
        return Err(refused(input, &refusal, may_go_on, 0));
    }
    if let Some(rank) = FundamentalGroup::new(&input.triangulation).free_rank() {
        return Err(free_group(input, &refusal, rank));
    }
    session.check()?;
    if !may_go_on {
        return Err(refused(input, &refusal, false, 0));
    }
    session.stage("retriangulate");
    let tried = match others(session, input, tries)? {
        Ok(found) => {
            unless_same(&input.triangulation, &found.triangulation)?;
            return Ok(found);
        }
        Err(tried) => tried,
    };
    Err(refused(input, &refusal, true, tried))
}

fn attempt(triangulation: Triangulation, tried: usize) -> std::result::Result<Metric, NoMetric> {
    let structure = Structure::find(&triangulation, &Skeleton::new(&triangulation))?;
    Ok(Metric { triangulation, structure, tried })
}

/// Other triangulations of the manifold, each once; how many where none has a structure.
fn others(session: &Session, input: &Input, tries: usize) -> Result<std::result::Result<Metric, usize>> {
    let unfit = |error: SimplifyError| Failure::limits("not-simplified", format!("{}: {error}", input.name));
    let start = without_inner_vertices(&input.triangulation).map_err(unfit)?;
    let mut simplifier = Simplifier::new(&start, session.common.seed).map_err(unfit)?;
    let mut seen = HashSet::from([signature(&input.triangulation)]);
    let mut candidate = simplifier.best().clone();
    for number in 0..tries {
        session.check()?;
        if seen.insert(signature(&candidate))
            && let Ok(found) = attempt(candidate, seen.len() - 1)
        {
            return Ok(Ok(found));
        }
        candidate = simplifier.shaken(1 + number % 8);
    }
    Ok(Err(seen.len() - 1))
}

/// Whether a refusal is one of the manifold, whatever its triangulation.
fn is_about_manifold(refusal: &NoMetric, triangulation: &Triangulation) -> bool {
    match refusal {
        NoMetric::Empty | NoMetric::OpenFace { .. } | NoMetric::ReversedEdge { .. } | NoMetric::NotOrientable => true,
        // Inner points can be taken away; other components of the boundary stay.
        NoMetric::VertexLink { .. } => {
            let genera = genera(triangulation);
            genera.is_empty() || genera.iter().any(|&genus| genus < 2)
        }
        NoMetric::LowDegree { .. } | NoMetric::NoAngles { .. } | NoMetric::Escapes { .. } => false,
        NoMetric::Degenerate { .. } | NoMetric::NotFound { .. } | NoMetric::NotProved { .. } => false,
    }
}

/// The failure for a refusal: the input's fault where it is proved and nothing else was to be tried.
fn refused(input: &Input, refusal: &NoMetric, went_on: bool, tried: usize) -> Failure {
    let is_settled = is_about_manifold(refusal, &input.triangulation) || refusal.is_proved() && !went_on;
    let (exit, code) = if is_settled { (Exit::Input, "no-metric") } else { (Exit::Limits, "no-metric-found") };
    let size = input.triangulation.len();
    let mut message = format!("{}: {refusal}", input.name);
    if is_settled && !is_about_manifold(refusal, &input.triangulation) {
        message.push_str("\n  --retriangulate looks for other triangulations of the manifold");
    } else if !is_settled {
        message.push_str(&format!(
            "\n  this is a triangulation with {size} tetrahedra; {tried} more of the manifold were tried, none has a \
             structure. That proves nothing of the manifold: try more with --tries, or another --seed"
        ));
    }
    let fields = json!({"proved": refusal.is_proved(), "tetrahedra": size, "tried": tried, "signature": signature(&input.triangulation)});
    Failure::new(exit, code, message).with("refusal", fields)
}

fn free_group(input: &Input, refusal: &NoMetric, rank: usize) -> Failure {
    let message = format!(
        "{}: the fundamental group is free of rank {rank}, like that of a handle body: a geodesic boundary component would have a \
         group of a closed surface in it, and all subgroups of free groups are free, so no triangulation has a structure.\n  \
         Give a solid whose boundary cannot be compressed, as the outside of a knotted graph. (This triangulation: {refusal})",
        input.name
    );
    Failure::input("no-metric", message).with("refusal", json!({"proved": true, "free_rank": rank}))
}

/// Moves keep the manifold; anything else is a bug here.
fn unless_same(before: &Triangulation, after: &Triangulation) -> Result<()> {
    let invariants = |triangulation| (Homology::new(triangulation).to_string(), genera(triangulation));
    let (before, after) = (invariants(before), invariants(after));
    if before == after {
        return Ok(());
    }
    Err(Failure::bug(format!("another triangulation has other invariants: {before:?} became {after:?}")))
}
