//! Times the checker on large shells: spheres of 20 * 4^n triangles, in the shell of another sphere.
//!
//! `cargo run --release -p homeo-verify --example large_shell -- 6` (82k triangles).
#![allow(clippy::print_stdout)]

#[path = "../tests/support/mod.rs"]
mod support;

use homeo_verify::verify_bytes;
use std::time::Instant;
use support::shells::{around, icosphere, turned};

fn main() {
    let steps: usize = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(6);
    let sphere = icosphere(steps);
    for (name, middle, heights) in [
        ("itself", icosphere(steps), [0.9, 1.1]),
        ("a coarser sphere", icosphere(steps.saturating_sub(2)), [0.9, 1.1]),
        ("an icosahedron", icosphere(0), [0.8, 1.4]),
    ] {
        let source = if middle.1.len() == sphere.1.len() { sphere.clone() } else { turned(&sphere, 1.0) };
        let bytes = around(&source, &middle, heights).bytes();
        let start = Instant::now();
        let verdict = format!("{:?}", verify_bytes(&bytes));
        let (seconds, prisms) = (start.elapsed().as_secs_f64(), middle.1.len());
        let verdict = &verdict[..verdict.len().min(40)];
        println!("{} triangles in {name} ({prisms} prisms): {seconds:.2} s, {verdict}...", source.1.len());
    }
}
