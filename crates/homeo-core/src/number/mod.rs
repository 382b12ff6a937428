//! Exact rationals and enclosing intervals.

mod rational;

pub use rational::{ParseRationalError, Rational};
