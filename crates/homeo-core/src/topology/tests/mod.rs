//! Tests of the analysis by class of mesh.

mod data;
mod plain_readers;
