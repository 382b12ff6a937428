//! Exact rationals, enclosing intervals, and what formulas over both need.

mod interval;
mod lazy;
mod rational;
mod scalar;

pub use interval::Interval;
pub use lazy::Lazy;
pub use rational::{ParseRationalError, Rational};
pub use scalar::Scalar;
