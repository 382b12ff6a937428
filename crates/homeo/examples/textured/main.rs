//! The textured model of the tutorial, and its picture:
//!
//! ```text
//! cargo run --release -p homeo --example textured -- model testdata/meshes
//! cargo run --release -p homeo --example textured -- picture testdata/meshes/knot.obj small.obj knot.png
//! ```
//!
//! The first writes `knot.obj` with `knot.mtl` and `knot.png`, and `knot.ply`, the same mesh with fields. The second
//! draws meshes side by side, with their triangles and, in red, the seams of their texture.

mod model;
mod pattern;
mod picture;
mod png;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["model", folder] => model::write(Path::new(folder)),
        ["picture", meshes @ .., image] if !meshes.is_empty() => picture::write(meshes, Path::new(image)),
        _ => Err("give `model FOLDER` or `picture MESH... IMAGE.png`".into()),
    }
}
