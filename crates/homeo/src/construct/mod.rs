//! Constructions of maps, one folder each.

pub mod foliation;
pub mod section;
pub mod shell;
