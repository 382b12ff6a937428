//! Simplification in one shell after the other, where the first is not enough.
//!
//! How coarse a section can get is mostly decided by the directions of the pillars, so a shell whose pillars keep nearer to
//! the normals may allow fewer triangles, though it has more prisms; or more, so both are tried.

use super::{SectionError, SimplifyEnd, SimplifyInfo, SimplifyParams, TexturedSurface, simplify};
use crate::construct::shell::{ShellError, ShellParams, build};
use crate::map::Shell;
use crate::progress::Progress;

/// The largest angle between pillars and normals in the second shell of [`shells_in_turn`], in degrees.
const STEEP_ANGLE: f64 = 60.0;

/// One shell that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The largest angle between pillars and normals that was asked for, in radians.
    pub largest_angle: f64,
    /// What came of it, or why there was no shell.
    pub outcome: Result<Outcome, ShellError>,
}

/// What came of a shell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Prisms of the shell.
    pub prisms: usize,
    /// Triangles of the section in it.
    pub triangles: usize,
    /// Why its simplification ended.
    pub end: SimplifyEnd,
}

/// A section in the shell that allowed the fewest triangles.
#[derive(Debug)]
pub struct SimplifiedInShell {
    /// The shell, with the surface to begin with as its source.
    pub shell: Shell,
    /// The section.
    pub section: TexturedSurface,
    /// What happened during its simplification.
    pub info: SimplifyInfo,
    /// The number of this shell among the attempts, from 0.
    pub kept: usize,
    /// All attempts in turn.
    pub attempts: Vec<Attempt>,
}

/// Why there is no section, not even in the first shell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InShellError {
    /// A shell was not made.
    #[error(transparent)]
    Shell(#[from] ShellError),
    /// A section was not made.
    #[error(transparent)]
    Section(#[from] SectionError),
}

/// The shells in which `homeo simplify` looks for a section: the one that is usual for sections, then one whose pillars
/// come no farther than 60 degrees from normals.
///
/// The second had up to 4.4 times the prisms. On some smooth and bent surfaces sections in it are coarser; on a gear
/// that is twisted into a helix they were not. Columns of both have the usual thickness.
///
/// # Example
/// ```
/// let [usual, steep] = homeo::construct::section::shells_in_turn();
/// assert!(!usual.may_thin && steep.largest_angle < usual.largest_angle && steep.thickness == usual.thickness);
/// ```
pub fn shells_in_turn() -> [ShellParams; 2] {
    let usual = ShellParams { may_thin: false, ..ShellParams::default() };
    let steep = ShellParams { largest_angle: STEEP_ANGLE.to_radians(), ..usual.clone() };
    [usual, steep]
}

/// Makes a shell of a surface and [simplifies](simplify) the surface in it; and while there are not few enough triangles,
/// the same with the other shells in turn. Keeps the section with the fewest triangles, the first of several.
///
/// Stages are those of the shell, then `section`; for all of the other shells together, `again`. Stopped from outside
/// before there is a section, it ends as [`build`] and [`simplify`] do; later, with the best section so far.
///
/// # Guarantee
/// As for [`simplify`], in the shell that comes with the section. Which shells are tried and which is kept depends on the
/// surface and the parameters only, unless the work is stopped.
///
/// # Preconditions
/// Those of [`build`].
///
/// # Errors
/// When the first shell or the section in it was not made, or a parameter is out of range. That another shell was not
/// made is in its [`Attempt`].
///
/// # Complexity
/// That of [`build`] and [`simplify`] for each shell that is tried; two shells and two sections in memory.
///
/// # Example
/// ```
/// use homeo::construct::section::{self, SimplifyParams};
/// use homeo::{input::SourceMesh, progress::Silent};
/// use homeo_core::mesh::SimplicialComplex;
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let complex = SimplicialComplex::from_indices(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let source = SourceMesh::new(corners, complex).into();
/// let params = SimplifyParams { triangles: 2, ..SimplifyParams::default() };
/// let [usual, steep] = section::shells_in_turn();
/// let made = section::simplify_in_shells(&source, &usual, &[steep], &params, &Silent)?;
/// // No closed surface has fewer triangles, so both shells were tried, and the first one is kept.
/// assert_eq!((made.info.triangles, made.attempts.len(), made.kept), (4, 2, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simplify_in_shells(
    start: &TexturedSurface,
    first: &ShellParams,
    others: &[ShellParams],
    params: &SimplifyParams,
    progress: &dyn Progress,
) -> Result<SimplifiedInShell, InShellError> {
    let (shell, _) = build(&start.surface, first, progress)?;
    let (section, info) = simplify(&shell, start, params, &Named(progress, "section"))?;
    let attempts = vec![Attempt::of(first, Ok(outcome(&shell, &info)))];
    let mut best = SimplifiedInShell { shell, section, info, kept: 0, attempts };
    for other in others {
        if best.info.end != SimplifyEnd::Exhausted || progress.is_cancelled() {
            break;
        }
        best.try_shell(start, other, params, &Named(progress, "again"))?;
    }
    Ok(best)
}

impl SimplifiedInShell {
    fn try_shell(
        &mut self,
        start: &TexturedSurface,
        wanted: &ShellParams,
        params: &SimplifyParams,
        progress: &dyn Progress,
    ) -> Result<(), SectionError> {
        let shell = match build(&start.surface, wanted, progress) {
            Ok((shell, _)) => shell,
            Err(error) => {
                self.attempts.push(Attempt::of(wanted, Err(error)));
                return Ok(());
            }
        };
        let (section, info) = simplify(&shell, start, params, progress)?;
        self.attempts.push(Attempt::of(wanted, Ok(outcome(&shell, &info))));
        if info.triangles < self.info.triangles {
            (self.shell, self.section, self.info) = (shell, section, info);
            self.kept = self.attempts.len() - 1;
        }
        Ok(())
    }
}

impl Attempt {
    fn of(params: &ShellParams, outcome: Result<Outcome, ShellError>) -> Self {
        Self { largest_angle: params.largest_angle, outcome }
    }
}

fn outcome(shell: &Shell, info: &SimplifyInfo) -> Outcome {
    Outcome { prisms: shell.parts().prisms.len(), triangles: info.triangles, end: info.end }
}

/// Progress with one name for all stages.
struct Named<'p>(&'p dyn Progress, &'static str);

impl Progress for Named<'_> {
    fn stage(&self, _: &'static str) {
        self.0.stage(self.1);
    }

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}
