//! Constructions of maps, one folder each.

pub mod foliation;
pub mod shell;
