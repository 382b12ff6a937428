//! Composite mean value maps between cages: their Jacobian determinants, up to faces, edges and vertices.

mod arctangent;
mod chart;
mod cover;
mod determinant;
mod inside;
mod jet;
mod outline;
#[cfg(test)]
mod tests;
