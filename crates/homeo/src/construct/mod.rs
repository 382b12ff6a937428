//! Constructions of maps, one folder each.

mod crease;
pub mod foliation;
pub mod harmonic;
pub mod section;
pub mod shell;
