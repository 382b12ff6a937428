//! The three answers, and the reason to stop early: a witness (a rule fails), or an obstacle (this checker cannot decide).

use serde::{Serialize, Serializer};
use std::fmt;

/// What the checker answers about a readable map file.
///
/// # Example
/// ```
/// use homeo_verify::Verdict;
/// let is_certified = |verdict: &Verdict| matches!(verdict, Verdict::Certified(_));
/// ```
#[must_use]
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "verdict", rename_all = "lowercase")]
pub enum Verdict {
    /// Every hypothesis of the theorem holds: the stored map is a homeomorphism.
    Certified(Claim),
    /// A rule fails; the witness shows where.
    Refuted(Witness),
    /// The rules are beyond this checker's means; the obstacle says what to change.
    Undecided(Obstacle),
}

/// What has been established.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// The claim in words, with the theorem that was applied.
    pub statement: String,
    /// `foliation`, `piecewise-linear`, `shell`, `composite-harmonic`, `composite-mean-value`, `complex-barycentric`,
    /// `hyperbolic`, `unit-tangent-bundle`, `moved-mesh` or `composite-cage`.
    pub kind: String,
    /// `square`, `disk`, `cube`, `ball`, `shell`, `section`, `immersed-shell`, `embedded-shell`, `polygon`,
    /// `annulus`, `domain`, `geodesic-boundary`, `canonical-decomposition`, `unit-tangent-bundle`,
    /// `unit-tangent-bundle-with-section`, `space` or `polyhedron`.
    pub target: String,
    /// What was checked, and how many times.
    #[serde(serialize_with = "as_object")]
    pub checked: Vec<(&'static str, u64)>,
    /// SHA-256 of the source mesh as stored, in lower-case hexadecimal digits.
    pub source_sha256: String,
    /// What the claim does not say.
    pub limits: Vec<String>,
}

fn as_object<S: Serializer>(pairs: &[(&str, u64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().copied())
}

/// Where a rule of `docs/certificate-format-v1.md` or `docs/theory/shells.md` fails.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Witness {
    /// The rule's name, for instance `"5"` or `"S3"`.
    pub rule: &'static str,
    /// What is wrong, in words.
    pub message: String,
    /// Cells concerned: of the source for the rules S and 8, of the refined complex for the others. For shells source
    /// triangles come first, then prisms.
    pub cells: Vec<u32>,
    /// Vertices concerned, in the numbering of the refined complex. For shells source vertices come first, then columns.
    pub vertices: Vec<u32>,
    /// Where those vertices lie (rounded), to be drawn; empty when they have no finite place.
    pub points: Vec<[f64; 3]>,
}

/// Why there is no answer, and what would help.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Obstacle {
    /// What stopped the check.
    pub message: String,
    /// What to change in the file.
    pub remedy: String,
}

/// The bytes are not a map file of version 1: none of the three verdicts.
///
/// # Example
/// ```
/// let error = homeo_verify::verify_bytes(b"not a map").unwrap_err();
/// assert!(error.to_string().contains("zip"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreadable {
    /// Which convention of the container is broken.
    pub message: String,
}

impl fmt::Display for Unreadable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "unreadable map file: {}", self.message)
    }
}

impl std::error::Error for Unreadable {}

/// The container rule that fails.
pub(crate) fn unreadable(message: impl Into<String>) -> Unreadable {
    Unreadable { message: message.into() }
}

/// Goes on if a container rule holds.
pub(crate) fn readable(holds: bool, message: &str) -> Result<(), Unreadable> {
    if holds { Ok(()) } else { Err(unreadable(message)) }
}

/// Why a check stops before its end.
pub(crate) enum Stop {
    Refuted(Witness),
    Undecided(Obstacle),
}

/// The result of checking one rule.
pub(crate) type Checked<T = ()> = Result<T, Stop>;

/// The witness of a rule that fails.
pub(crate) fn refuted(rule: &'static str, message: impl Into<String>, cells: &[usize], vertices: &[u32]) -> Stop {
    let cells = cells.iter().map(|&c| u32::try_from(c).unwrap_or(u32::MAX)).collect();
    Stop::Refuted(Witness { rule, message: message.into(), cells, vertices: vertices.to_vec(), points: vec![] })
}

/// A rule fails at a point that is no vertex.
pub(crate) fn refuted_at(rule: &'static str, message: String, at: [f64; 3]) -> Stop {
    Stop::Refuted(Witness { rule, message, cells: vec![], vertices: vec![], points: vec![at] })
}

/// Goes on if a rule holds.
pub(crate) fn check(holds: bool, rule: &'static str, message: &str, cells: &[usize], vertices: &[u32]) -> Checked {
    if holds { Ok(()) } else { Err(refuted(rule, message, cells, vertices)) }
}

/// Goes on if this checker has the means to.
pub(crate) fn decidable(holds: bool, message: &str, remedy: &str) -> Checked {
    if holds { Ok(()) } else { Err(Stop::Undecided(Obstacle { message: message.into(), remedy: remedy.into() })) }
}
