//! Constructions of maps, one folder each.

pub mod foliation;
