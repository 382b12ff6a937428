//! Library.

pub mod export;
