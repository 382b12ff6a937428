//! Reading a hyperbolic structure back.

use homeo_manifold::hyperbolic::{Approximation, Method, Structure, Tetrahedron, prove};
use homeo_manifold::{Permutation, Skeleton, Triangulation};
use serde_json::Value;

use super::read::{File, MapFileError};

/// A hyperbolic structure that a file holds, and the triangulation that it is of.
#[derive(Clone, Debug)]
pub struct StoredStructure {
    /// The gluings, as they are stored.
    pub triangulation: Triangulation,
    /// The structure, proved again from the stored lengths.
    pub structure: Structure,
    /// What the file says of its source; no claim rests on it.
    pub name: String,
}

/// The kind that the manifest of a map file names, if it can be read: it says which reader to take.
///
/// ```
/// assert_eq!(homeo::certificate::kind_of(b"no archive"), None);
/// ```
pub fn kind_of(bytes: &[u8]) -> Option<String> {
    let manifest = File::open(bytes).ok()?.manifest().ok()?;
    manifest.get("kind").and_then(Value::as_str).map(str::to_owned)
}

/// Reads a file of kind `hyperbolic`.
///
/// Cost: that of a proof, `O(#T + #E^3)`; a file with more than 1000 edges is refused, as by the checker.
///
/// # Errors
/// [`MapFileError`]: what is damaged, and [`MapFileError::Inconsistent`] where there is no structure near the stored lengths.
///
/// # Example
/// ```
/// use homeo::certificate::{Provenance, read_hyperbolic, write_hyperbolic};
/// use homeo_manifold::{Skeleton, from_signature, hyperbolic::Structure};
/// let tripus = from_signature("cPcbbbihq")?;
/// let structure = Structure::find(&tripus, &Skeleton::new(&tripus))?;
/// let mut file = std::io::Cursor::new(Vec::new());
/// write_hyperbolic(&tripus, &structure, &Provenance::default(), &mut file)?;
/// let read = read_hyperbolic(&file.into_inner())?;
/// assert_eq!(read.triangulation, tripus);
/// assert!(read.structure.volume().holds(6.451990270835033));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_hyperbolic(bytes: &[u8]) -> Result<StoredStructure, MapFileError> {
    let mut file = File::open(bytes)?;
    let manifest = file.manifest()?;
    let text = |key: &str| manifest.get(key).and_then(Value::as_str).unwrap_or_default();
    if (text("format"), text("kind")) != ("homeo", "hyperbolic") || manifest.get("version") != Some(&Value::from(1)) {
        return Err(MapFileError::Manifest(
            "is not that of a hyperbolic structure of format `homeo`, version 1".to_owned(),
        ));
    }
    let name = manifest.pointer("/source/name").and_then(Value::as_str).unwrap_or_default().to_owned();
    let triangulation = glued(&file.rows::<u32, 5>("gluings")?)?;
    let cosh = file.array::<f64>("cosh_lengths", 1)?;
    let structure = proved(&triangulation, &cosh)?;
    Ok(StoredStructure { triangulation, structure, name })
}

fn inconsistent(what: impl Into<String>) -> MapFileError {
    MapFileError::Inconsistent(what.into())
}

fn glued(rows: &[[u32; 5]]) -> Result<Triangulation, MapFileError> {
    if rows.is_empty() || !rows.len().is_multiple_of(4) {
        return Err(inconsistent("gluings have four rows for each tetrahedron"));
    }
    let mut triangulation = Triangulation::new(rows.len() / 4);
    for (number, &[other, a, b, c, d]) in rows.iter().enumerate() {
        let at_row = |what: &str| inconsistent(format!("row {number} of gluings {what}"));
        let images = [a, b, c, d].map(|image| u8::try_from(image).unwrap_or(u8::MAX));
        let corners = Permutation::new(images).ok_or_else(|| at_row("is no permutation"))?;
        let (tetrahedron, face) = ((number / 4) as u32, (number % 4) as u8);
        match triangulation.neighbour(tetrahedron, face) {
            Some(there) if there.tetrahedron == other && there.corners == corners => {}
            Some(_) => return Err(at_row("contradicts the one of the other side")),
            None => {
                triangulation.glue(tetrahedron, face, other, corners).map_err(|e| at_row(&format!("cannot be: {e}")))?
            }
        }
    }
    Ok(triangulation)
}

/// Edges of a structure at most; matrices are dense.
const MOST_EDGES: usize = 1000;

fn proved(triangulation: &Triangulation, cosh: &[f64]) -> Result<Structure, MapFileError> {
    let skeleton = Skeleton::new(triangulation);
    if cosh.len() != skeleton.edges().len() || cosh.len() > MOST_EDGES {
        let count = skeleton.edges().len();
        return Err(inconsistent(format!("{count} edges need as many lengths, at most {MOST_EDGES}")));
    }
    if let Some(edge) = cosh.iter().position(|cosh| !(*cosh > 1.0 && cosh.is_finite())) {
        return Err(inconsistent(format!("edge {edge} has no length")));
    }
    let approximation = Approximation {
        lengths: cosh.iter().map(|cosh| cosh.acosh()).collect(),
        curvature: curvature(triangulation, &skeleton, cosh),
        steps: 0,
        method: Method::Newton,
    };
    prove(triangulation, &skeleton, approximation).map_err(|refusal| inconsistent(refusal.to_string()))
}

/// How far angle sums are from 2π.
fn curvature(triangulation: &Triangulation, skeleton: &Skeleton, cosh: &[f64]) -> f64 {
    let mut excess = vec![-std::f64::consts::TAU; cosh.len()];
    for tetrahedron in 0..triangulation.len() as u32 {
        let edges = skeleton.edges_of(tetrahedron).map(|edge| edge as usize);
        let angles = Tetrahedron::new(edges.map(|edge| cosh[edge])).extended_angles();
        edges.into_iter().zip(angles).for_each(|(edge, angle)| excess[edge] += angle);
    }
    excess.iter().fold(0.0, |largest, excess| excess.abs().max(largest))
}
