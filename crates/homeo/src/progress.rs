//! Progress and cancellation, in one argument.

/// Told about the stages of long work, and asked whether to go on.
pub trait Progress {
    /// A stage begins. Names are plain: read, check, prepare, harmonic, order, directions, smooth, …
    fn stage(&self, _name: &'static str) {}

    /// Whether the work should stop. Asked between steps, so that it takes effect within seconds.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// No report and no cancellation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}
