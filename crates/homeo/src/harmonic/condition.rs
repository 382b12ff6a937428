//! What is given on the boundary.

use super::{HarmonicFunctionError, check_length};

/// How values go from one end of an edge to the other, by the share `s` of its length from its first vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// `(1 - s) a + s b`.
    #[default]
    Linear,
    /// `(1 - s^2) a + s^2 b` (section 5.4): values are denser at the first end.
    Quadratic,
}

impl Profile {
    /// How far the values have gone at a share of the edge.
    pub(super) fn at(self, share: f64) -> f64 {
        match self {
            Self::Linear => share,
            Self::Quadratic => share * share,
        }
    }

    /// The share at which values have gone so far: the other way round.
    pub(super) fn share_of(self, gone: f64) -> f64 {
        match self {
            Self::Linear => gone,
            Self::Quadratic => gone.sqrt(),
        }
    }

    /// The same on an element from `middle - half` to `middle + half`: coefficients of 1, `t` and `t^2`.
    pub(super) fn on(self, middle: f64, half: f64) -> [f64; 3] {
        match self {
            Self::Linear => [middle, half, 0.0],
            Self::Quadratic => [middle * middle, 2.0 * middle * half, half * half],
        }
    }
}

/// Values of some functions at the vertices of a domain, and how they run along edges.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryData {
    pub(super) functions: usize,
    pub(super) values: Vec<f64>,
    pub(super) profile: Profile,
}

impl BoundaryData {
    /// Of values of `F` functions at every vertex, ring after ring (#V by #F).
    ///
    /// # Errors
    /// A value is not finite.
    pub fn new<const F: usize>(values: &[[f64; F]], profile: Profile) -> Result<Self, HarmonicFunctionError> {
        Self::of_list(F, values.iter().flatten().copied().collect(), profile)
    }

    /// One function for each of `vertices` vertices: 1 there and 0 at all others.
    pub fn hats(vertices: usize) -> Self {
        let values = (0..vertices * vertices).map(|i| if i % (vertices + 1) == 0 { 1.0 } else { 0.0 }).collect();
        Self { functions: vertices, values, profile: Profile::Linear }
    }

    fn of_list(functions: usize, values: Vec<f64>, profile: Profile) -> Result<Self, HarmonicFunctionError> {
        match values.iter().position(|v| !v.is_finite()) {
            Some(entry) => Err(HarmonicFunctionError::BadData { entry, value: values[entry] }),
            None => Ok(Self { functions, values, profile }),
        }
    }

    /// How many functions there are.
    pub fn function_count(&self) -> usize {
        self.functions
    }

    pub(super) fn check(&self, vertices: usize) -> Result<(), HarmonicFunctionError> {
        check_length(self.values.len(), vertices * self.functions)
    }

    /// Values at a vertex (#F).
    pub(super) fn at_vertex(&self, vertex: usize) -> &[f64] {
        &self.values[vertex * self.functions..(vertex + 1) * self.functions]
    }
}

/// What is given on an edge for one function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeCondition {
    /// Values at both ends, linear between them.
    Values([f64; 2]),
    /// No flow across: the normal derivative is 0.
    NoFlux,
}
