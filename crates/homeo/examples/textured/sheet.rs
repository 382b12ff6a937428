//! A wavy square sheet with a texture, for the picture of fields that move from one patch to another.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

/// Quads along each side.
const QUADS: usize = 20;

/// Writes the sheet as OBJ.
pub fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut text = String::from("# A wavy square sheet, made for this project (CC0).\n");
    let part = |i: usize| i as f64 / QUADS as f64;
    for (x, y) in places().map(|[i, j]| (part(i), part(j))) {
        let height = 0.08 * (TAU * x).sin() * (TAU * y).cos();
        writeln!(text, "v {x} {y} {}", (1024.0 * height).round() / 1024.0)?;
    }
    for [i, j] in places() {
        writeln!(text, "vt {} {}", part(i), part(j))?;
    }
    for [i, j] in places().filter(|place| place.iter().all(|&i| i < QUADS)) {
        let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| i * (QUADS + 1) + j + 1);
        writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}")?;
    }
    std::fs::write(folder.join("sheet.obj"), text)?;
    Ok(())
}

fn places() -> impl Iterator<Item = [usize; 2]> {
    (0..=QUADS).flat_map(|i| (0..=QUADS).map(move |j| [i, j]))
}
