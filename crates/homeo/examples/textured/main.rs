//! The textured model of the tutorial, and its picture:
//!
//! ```text
//! cargo run --release -p homeo --example textured -- model testdata/meshes
//! cargo run --release -p homeo --example textured -- picture testdata/meshes/knot.obj small.obj knot.png
//! cargo run --release -p homeo --example textured -- sheet testdata/meshes
//! cargo run --release -p homeo --example textured -- patches testdata/meshes/sheet.obj face.obj patches.png
//! ```
//!
//! The first writes `knot.obj` with `knot.mtl` and `knot.png`, and `knot.ply`, the same mesh with fields. The second
//! draws meshes side by side, with their triangles and, in red, the seams of their texture. The third writes a textured patch; the
//! fourth draws patches, each as large as fits and from the side that most of it faces.

mod model;
mod pattern;
mod picture;
mod png;
mod sheet;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["model", folder] => model::write(Path::new(folder)),
        ["picture", meshes @ .., image] if !meshes.is_empty() => picture::write(meshes, Path::new(image)),
        ["sheet", folder] => sheet::write(Path::new(folder)),
        ["patches", meshes @ .., image] if !meshes.is_empty() => picture::write_patches(meshes, Path::new(image)),
        _ => Err("give `model FOLDER`, `sheet FOLDER`, or `picture` or `patches` and `MESH... IMAGE.png`".into()),
    }
}
