//! Values at vertices and corners.

use std::collections::HashMap;
use std::sync::Arc;

use homeo_core::io::{Attribute, Values};

use super::correspondence::{At, Correspondence, Side};
use super::{Status, Transferred, has_no_number, is_label, is_same_row};
use crate::input::SourceMesh;

/// Values at the vertices of the section.
pub(super) fn at_vertices(known: &Correspondence, attribute: &Attribute) -> Transferred {
    let mut places: Vec<Option<At>> = vec![None; known.section.positions().len()];
    for (cell, corners) in known.section.complex().cells().iter().zip(&known.corners) {
        for (v, at) in cell.iter().zip(corners) {
            let place = &mut places[v.index()];
            if place.is_none_or(|before| before.corner().is_none()) {
                *place = at.or(*place);
            }
        }
    }
    read_at_vertices(known.source, attribute, &places)
}

/// The values of an attribute of vertices at some places of the source.
pub(super) fn read_at_vertices(source: &SourceMesh<3>, attribute: &Attribute, places: &[Option<At>]) -> Transferred {
    evaluated(attribute, places, |at| source.complex().cells()[at.triangle as usize].map(|v| v.index()))
}

/// The values of an attribute of corners at some places of the source, each from the side of its triangle.
pub(super) fn read_at_corners(attribute: &Attribute, places: &[Option<At>]) -> Transferred {
    evaluated(attribute, places, |at| [0, 1, 2].map(|k| 3 * at.triangle as usize + k))
}

/// The values of an attribute of triangles at those of some places.
pub(super) fn read_at_triangles(attribute: &Attribute, places: &[Option<At>]) -> Transferred {
    evaluated(attribute, places, |at| [at.triangle as usize; 3])
}

/// Values at the corners of the section's triangles, each from the side of its triangle.
pub(super) fn at_corners(known: &Correspondence, attribute: &Attribute) -> Transferred {
    let mut moved = read_at_corners(attribute, known.corners.as_flattened());
    let seams = Seams::new(known.source, attribute);
    for (triangle, crossed) in known.crossed.iter().enumerate() {
        if crossed.iter().any(|&side| seams.is_seam(side)) {
            moved.status[3 * triangle..3 * triangle + 3].fill(Status::Split);
        }
    }
    moved
}

/// Where an attribute of corners jumps from one triangle to the next.
pub(super) struct Seams<'k> {
    source: &'k SourceMesh<3>,
    attribute: &'k Attribute,
    /// The sides across which triangles meet.
    beyond: HashMap<[u32; 2], Side>,
}

impl<'k> Seams<'k> {
    pub fn new(source: &'k SourceMesh<3>, attribute: &'k Attribute) -> Self {
        let mut beyond = HashMap::new();
        for (t, cell) in source.complex().cells().iter().enumerate() {
            for k in 0..3 {
                let [a, b] = [1, 2].map(|i| cell[(k + i) % 3].raw());
                beyond.insert([a, b], (t as u32, k));
            }
        }
        Self { source, attribute, beyond }
    }

    /// Whether the values at the ends of a side differ from those of the triangle beyond; also where there is none.
    fn is_seam(&self, side: Side) -> bool {
        self.across(side).is_none()
    }

    /// The triangle beyond a side, unless there is a seam.
    fn across(&self, (triangle, k): Side) -> Option<u32> {
        let cell = self.source.complex().cells()[triangle as usize];
        let [a, b] = [1, 2].map(|i| (k + i) % 3);
        let &(other, l) = self.beyond.get(&[cell[b].raw(), cell[a].raw()])?;
        let row = |triangle: u32, corner: usize| 3 * triangle as usize + corner;
        let is_same = |p: usize, q: usize| is_same_row(self.attribute, row(triangle, p), row(other, q));
        (is_same(a, (l + 2) % 3) && is_same(b, (l + 1) % 3)).then_some(other)
    }

    /// The chart of each triangle: triangles that meet across other sides than seams are in one.
    pub fn charts(&self) -> Vec<usize> {
        let count = self.source.complex().cell_count();
        let mut charts = vec![usize::MAX; count];
        for first in 0..count {
            let mut waiting = vec![first as u32];
            while let Some(triangle) = waiting.pop() {
                if charts[triangle as usize] != usize::MAX {
                    continue;
                }
                charts[triangle as usize] = first;
                waiting.extend((0..3).filter_map(|k| self.across((triangle, k))));
            }
        }
        charts
    }
}

/// The values at some places; `rows` gives the rows of the attribute at the corners of a place's triangle.
fn evaluated(attribute: &Attribute, places: &[Option<At>], rows: impl Fn(&At) -> [usize; 3]) -> Transferred {
    let n = attribute.components;
    let entries = || places.iter().flat_map(|place| (0..n).map(move |i| (place.as_ref(), i)));
    let numbers = |missing: f64, value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let number = |(place, i): (Option<&At>, usize)| {
            place.map_or(missing, |at| linear(at, rows(at).map(|row| value(n * row + i))))
        };
        entries().map(number).collect()
    };
    let nearest = |at: &At| rows(at)[at.nearest()];
    let values = match &attribute.values {
        Values::F64(v) => Values::F64(numbers(f64::NAN, &|i| v[i])),
        Values::F32(v) => Values::F32(numbers(f64::NAN, &|i| v[i].into()).into_iter().map(|x| x as f32).collect()),
        // Colours are numbers, all other whole numbers are labels.
        Values::I64(v) if !is_label(attribute) => {
            Values::I64(numbers(0.0, &|i| v[i] as f64).into_iter().map(|x| x.round() as i64).collect())
        }
        Values::I64(v) => Values::I64(entries().map(|(at, i)| at.map_or(0, |at| v[n * nearest(at) + i])).collect()),
        Values::Text(v) => {
            let none: Arc<str> = "".into();
            let label =
                |(at, i): (Option<&At>, usize)| at.map_or_else(|| none.clone(), |at| v[n * nearest(at) + i].clone());
            Values::Text(entries().map(label).collect())
        }
    };
    let status = |(row, place): (usize, &Option<At>)| match place {
        None => Status::Missing,
        Some(_) if has_no_number(&values, n, row) => Status::Missing,
        Some(at) if at.corner().is_some() => Status::Copied,
        Some(at) if is_label(attribute) => {
            let rows = rows(at);
            let agree = (0..3).all(|k| at.weights[k] == 0.0 || is_same_row(attribute, rows[k], nearest(at)));
            if agree { Status::Copied } else { Status::Largest }
        }
        Some(_) => Status::Interpolated,
    };
    let status = places.iter().enumerate().map(status).collect();
    Transferred { attribute: Attribute { values, ..attribute.clone() }, status }
}

/// The value at a place, given those at the corners of its triangle. A corner's own value is not touched by others.
fn linear(at: &At, values: [f64; 3]) -> f64 {
    match at.corner() {
        Some(k) => values[k],
        None => (0..3).filter(|&k| at.weights[k] != 0.0).map(|k| at.weights[k] * values[k]).sum(),
    }
}
