//! Squares that become arrows: what complex maps do where the mean value map folds.
//!
//! Usage: `cargo run --release -p homeo --example complex_table -- [PICTURE.svg]`
//!
//! Prints one row of a Markdown table for each arrow: what is proved of linear speeds, of the best speeds of some degrees,
//! and how many steps a composite mean value map takes. The picture shows grids in one arrow under both maps.
#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::fmt::Write;
use std::time::Instant;

use homeo::complex::{ComplexError, ComplexMap, ComplexParams, EdgeSpeeds, bound_complex_jacobian};
use homeo::composite::{CompositeMap, JacobianLimits, JacobianVerdict, PartitionParams};
use homeo::coordinates::{MeanValue, PlanarCoordinates};
use homeo::progress::Silent;
use homeo::shape::LinearPath;
use homeo_core::planar::{DomainPair, Point2};

const DEGREES: [usize; 3] = [2, 4, 6];
/// The corner of the arrow in the picture.
const SHOWN: f64 = 0.4;
/// Lines of the grid, and points on each.
const LINES: usize = 16;
const POINTS: usize = 64;

fn arrow(corner: f64) -> Result<DomainPair, Box<dyn Error>> {
    let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    Ok(DomainPair::new(square, vec![vec![[0.0, 0.0], [1.0, 0.0], [corner, corner], [0.0, 1.0]]])?)
}

fn row(corner: f64) -> Result<String, Box<dyn Error>> {
    let pair = arrow(corner)?;
    let mut row = format!("| {corner} |");
    match bound_complex_jacobian(&pair, &EdgeSpeeds::linear(4), &JacobianLimits::default())? {
        JacobianVerdict::Positive { least, .. } => write!(row, " {least:.1e} |")?,
        JacobianVerdict::Negative { .. } => write!(row, " folds |")?,
        JacobianVerdict::Undecided { .. } => write!(row, " undecided |")?,
    }
    for degree in DEGREES {
        let start = Instant::now();
        let found = ComplexMap::build(&pair, &ComplexParams { degree, ..ComplexParams::default() }, &Silent);
        let seconds = start.elapsed().as_secs_f64();
        match found {
            Ok((_, info)) => write!(
                row,
                " {:.1e} ({:.3}); {} | {seconds:.2} |",
                info.least_determinant, info.sampled[0], info.boxes
            )?,
            Err(ComplexError::Folds { .. }) => write!(row, " folds | {seconds:.2} |")?,
            Err(ComplexError::Undecided { .. }) => write!(row, " undecided | {seconds:.2} |")?,
            Err(error) => return Err(error.into()),
        }
    }
    let (composite, _) = CompositeMap::build(&LinearPath::between(&pair)?, &PartitionParams::default(), &Silent)?;
    write!(row, " {} |", composite.step_count())?;
    Ok(row)
}

/// A grid of the square under a map, as paths.
fn grid(map: &dyn Fn(Point2) -> Result<Point2, Box<dyn Error>>, shift: f64) -> Result<String, Box<dyn Error>> {
    let mut paths = String::new();
    for line in 0..=2 * LINES + 1 {
        let place = (line / 2) as f64 / LINES as f64;
        write!(paths, "<path d=\"")?;
        for k in 0..=POINTS {
            let along = k as f64 / POINTS as f64;
            let [x, y] = map(if line % 2 == 0 { [place, along] } else { [along, place] })?;
            let letter = if k == 0 { 'M' } else { 'L' };
            write!(paths, "{letter}{:.1} {:.1}", shift + 280.0 * x, 300.0 - 280.0 * y)?;
        }
        writeln!(paths, "\"/>")?;
    }
    Ok(paths)
}

fn picture() -> Result<String, Box<dyn Error>> {
    let pair = arrow(SHOWN)?;
    let (map, _) = ComplexMap::build(&pair, &ComplexParams::default(), &Silent)?;
    let kind = MeanValue::new(&pair.source);
    let images = &pair.target.rings()[0];
    let mean_value = |point: Point2| {
        let mut values = [0.0; 4];
        kind.values_into(point, &mut values)?;
        Ok([0, 1].map(|k| values.iter().zip(images).map(|(value, image)| value * image[k]).sum()))
    };
    let complex = |point: Point2| Ok(map.forward(point)?.point);
    let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 330\" font-family=\"sans-serif\" font-size=\"14\">";
    let style = "fill=\"none\" stroke=\"#808080\" stroke-width=\".8\"";
    Ok(format!(
        "{head}\n<g {style}>\n{}{}</g>\n<g fill=\"#808080\">\n<text x=\"20\" y=\"322\">linear speeds: folds at the inner \
         corner</text>\n<text x=\"340\" y=\"322\">speeds of degree 4: proved to be one-to-one</text>\n</g>\n</svg>\n",
        grid(&mean_value, 20.0)?,
        grid(&complex, 340.0)?,
    ))
}

fn main() -> Result<(), Box<dyn Error>> {
    if let Some(path) = std::env::args().nth(1) {
        std::fs::write(path, picture()?)?;
    }
    print!("| corner | linear |");
    DEGREES.iter().for_each(|degree| print!(" degree {degree} | s |"));
    println!(" composite: steps |\n|---:|---|---|---:|---|---:|---|---:|---:|");
    for corner in [0.8, 0.6, 0.5, 0.45, 0.4, 0.35, 0.3, 0.2] {
        println!("{}", row(corner)?);
    }
    Ok(())
}
