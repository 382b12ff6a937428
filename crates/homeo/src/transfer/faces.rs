//! Values on triangles.

use std::sync::Arc;

use homeo_core::io::{Attribute, Values};

use super::correspondence::{Correspondence, Part};
use super::{Status, Transferred, has_no_number, is_label, is_same_row};
use crate::input::SourceMesh;

/// Averages by area, and labels with the largest area.
pub(super) fn by_area(known: &Correspondence, attribute: &Attribute) -> Transferred {
    let n = attribute.components;
    let mean = |parts: &[Part], value: &dyn Fn(usize) -> f64| -> f64 {
        let first = parts.first().map_or(f64::NAN, |part| value(part.source as usize));
        // One value all over stays as it is.
        if parts.iter().all(|part| value(part.source as usize) == first) {
            return first;
        }
        parts.iter().map(|part| part.of_section * value(part.source as usize)).sum()
    };
    let numbers = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        known
            .parts
            .iter()
            .flat_map(|parts| (0..n).map(move |i| (parts, i)))
            .map(|(parts, i)| mean(parts, &|row| value(n * row + i)))
            .collect()
    };
    let values = match &attribute.values {
        Values::F64(v) => Values::F64(numbers(&|i| v[i])),
        Values::F32(v) => Values::F32(numbers(&|i| v[i].into()).into_iter().map(|x| x as f32).collect()),
        Values::I64(v) if !is_label(attribute) => {
            Values::I64(numbers(&|i| v[i] as f64).into_iter().map(|x| x.round() as i64).collect())
        }
        Values::I64(v) => Values::I64(known.parts.iter().flat_map(|parts| largest(v, n, parts, 0)).collect()),
        Values::Text(v) => {
            let none: Arc<str> = "".into();
            Values::Text(known.parts.iter().flat_map(|parts| largest(v, n, parts, none.clone())).collect())
        }
    };
    let status = known.parts.iter().enumerate().map(|(t, parts)| {
        let rows = parts.iter().map(|part| part.source as usize);
        if parts.is_empty() || has_no_number(&values, n, t) {
            Status::Missing
        } else if rows.clone().all(|row| is_same_row(attribute, row, parts[0].source as usize)) {
            Status::Copied
        } else if is_label(attribute) {
            Status::Largest
        } else {
            Status::Interpolated
        }
    });
    Transferred { status: status.collect(), attribute: Attribute { values, ..attribute.clone() } }
}

/// The one value that all triangles have, on so many others.
pub(super) fn everywhere(attribute: &Attribute, count: usize) -> Transferred {
    fn repeated<T: Clone>(values: &[T], row: usize, count: usize) -> Vec<T> {
        values[..row].iter().cloned().cycle().take(row * count).collect()
    }
    let n = attribute.components;
    let values = match &attribute.values {
        Values::F64(v) => Values::F64(repeated(v, n, count)),
        Values::F32(v) => Values::F32(repeated(v, n, count)),
        Values::I64(v) => Values::I64(repeated(v, n, count)),
        Values::Text(v) => Values::Text(repeated(v, n, count)),
    };
    let is_missing = count > 0 && has_no_number(&values, n, 0);
    let status = if is_missing { Status::Missing } else { Status::Copied };
    Transferred { attribute: Attribute { values, ..attribute.clone() }, status: vec![status; count] }
}

/// The row of labels with the largest area; the first of equals.
fn largest<L: Clone + PartialEq>(labels: &[L], n: usize, parts: &[Part], missing: L) -> Vec<L> {
    let mut areas: Vec<(&[L], f64)> = Vec::new();
    for part in parts {
        let row = &labels[n * part.source as usize..n * (part.source as usize + 1)];
        match areas.iter_mut().find(|(other, _)| *other == row) {
            Some((_, area)) => *area += part.of_section,
            None => areas.push((row, part.of_section)),
        }
    }
    let best = areas.iter().fold(None, |best: Option<&(&[L], f64)>, other| match best {
        Some(best) if best.1 >= other.1 => Some(best),
        _ => Some(other),
    });
    best.map_or_else(|| vec![missing; n], |(row, _)| row.to_vec())
}

/// Masses per area, so that each face has the mass of the part of the source under it.
pub(super) fn by_mass(known: &Correspondence, attribute: &Attribute) -> Transferred {
    let n = attribute.components;
    let mean = |t: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        let mass =
            |part: &Part| value(part.source as usize) * area(known.source, part.source as usize) * part.of_source;
        known.parts[t].iter().map(mass).sum::<f64>() / area(known.section, t)
    };
    let numbers = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..known.parts.len())
            .flat_map(|t| (0..n).map(move |i| (t, i)))
            .map(|(t, i)| mean(t, &|row| value(n * row + i)))
            .collect()
    };
    let values = match &attribute.values {
        Values::F32(v) => Values::F32(numbers(&|i| v[i].into()).into_iter().map(|x| x as f32).collect()),
        Values::F64(v) => Values::F64(numbers(&|i| v[i])),
        other => other.clone(), // densities are floating-point numbers: checked before
    };
    let status = (0..known.parts.len())
        .map(|t| if has_no_number(&values, n, t) { Status::Missing } else { Status::Interpolated })
        .collect();
    Transferred { status, attribute: Attribute { values, ..attribute.clone() } }
}

fn area(mesh: &SourceMesh<3>, triangle: usize) -> f64 {
    let [a, b, c] = mesh.complex().cells()[triangle].map(|v| mesh.positions()[v.index()]);
    let (u, v) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    let cross = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
    0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}
