//! Any bytes as Vtu: an error or a mesh that keeps its invariant, never a panic.
#![no_main]

use homeo_core::io::{Format, read_mesh_bytes};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(mesh) = read_mesh_bytes(Format::Vtu, "fuzz".as_ref(), bytes) {
        assert_eq!(mesh.check(), Ok(()));
    }
});
