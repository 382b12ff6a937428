//! The texture of a surface that changes.

use std::collections::HashMap;

use homeo_core::number::{Interval, Scalar};
use homeo_core::predicate::{Sign, orient2d};

use super::outline::Outline;
use super::stage::key;
use super::surface::Surface;
use super::{Texture, TexturedSurface};
use crate::construct::shell::prism::sides;
use crate::map::Shell;

type Point = [f64; 3];
type Place = [f64; 2];

/// Coordinates of corners, the charts, and the texture that moved vertices get theirs from.
///
/// Every index belongs to one vertex; indices of one vertex with equal coordinates are one.
pub(super) struct Atlas {
    pub coordinates: Vec<Place>,
    /// The index of each corner of each triangle, by the triangle's number.
    pub corners: Vec<[u32; 3]>,
    /// The chart of each triangle: charts are what is connected without seams.
    pub charts: Vec<u32>,
    /// The orientation that most triangles of each chart have.
    signs: Vec<Sign>,
    pub outline: Outline,
    first: First,
}

/// The texture to begin with, on the surface to begin with, in the shell.
struct First {
    shell: Shell,
    corners: Vec<[Place; 3]>,
    charts: Vec<u32>,
}

impl Atlas {
    /// The texture of a surface; its indices are known to exist.
    pub fn new(shell: &Shell, start: &TexturedSurface, texture: &Texture, surface: &Surface) -> Self {
        let mut numbers = HashMap::new();
        let mut coordinates = Vec::new();
        let mut number = |vertex: u32, index: u32| {
            let place = texture.coordinates[index as usize];
            *numbers.entry((vertex, key(place))).or_insert_with(|| {
                coordinates.push(place);
                coordinates.len() as u32 - 1
            })
        };
        let corner = |(t, indices): (usize, &[u32; 3])| -> [u32; 3] {
            std::array::from_fn(|k| number(surface.triangles[t][k], indices[k]))
        };
        let corners: Vec<[u32; 3]> = texture.corners.iter().enumerate().map(corner).collect();
        let places: Vec<[Place; 3]> = corners.iter().map(|c| c.map(|index| coordinates[index as usize])).collect();
        let shell = Shell::from_parts(start.surface.clone(), shell.parts().clone());
        let first = First { shell, corners: places, charts: Vec::new() };
        let mut atlas =
            Self { coordinates, corners, charts: Vec::new(), signs: Vec::new(), outline: Outline::default(), first };
        atlas.find_charts(surface);
        atlas
    }

    fn find_charts(&mut self, surface: &Surface) {
        let mut charts = vec![u32::MAX; self.corners.len()];
        let mut balance = Vec::new();
        for t in surface.existing() {
            if charts[t as usize] == u32::MAX {
                let chart = balance.len() as u32;
                balance.push(self.fill_chart(surface, t, chart, &mut charts));
            }
        }
        self.signs =
            balance.into_iter().map(|sum: i64| if sum < 0 { Sign::Negative } else { Sign::Positive }).collect();
        self.first.charts.clone_from(&charts);
        self.charts = charts;
    }

    /// Numbers a chart and adds its boundary to the outline. Returns how many more triangles are positive than negative.
    fn fill_chart(&mut self, surface: &Surface, seed: u32, chart: u32, charts: &mut [u32]) -> i64 {
        let mut waiting = vec![seed];
        let mut balance = 0;
        charts[seed as usize] = chart;
        while let Some(t) = waiting.pop() {
            balance += match self.orientation(self.corners[t as usize], |index| self.place(index)) {
                Sign::Positive => 1,
                Sign::Zero => 0,
                Sign::Negative => -1,
            };
            for ([a, b], [i, j]) in
                sides(surface.triangles[t as usize]).into_iter().zip(sides(self.corners[t as usize]))
            {
                match surface.left_of(b, a) {
                    Some(other) if !self.is_seam(surface, [a, b], [t, other]) => {
                        if std::mem::replace(&mut charts[other as usize], chart) == u32::MAX {
                            waiting.push(other);
                        }
                    }
                    _ => self.outline.add(i, j),
                }
            }
        }
        balance
    }

    pub fn place(&self, index: u32) -> Place {
        self.coordinates[index as usize]
    }

    /// The index of a vertex in a triangle.
    pub fn mark(&self, surface: &Surface, triangle: u32, vertex: u32) -> Option<u32> {
        let k = surface.triangles[triangle as usize].iter().position(|&v| v == vertex)?;
        Some(self.corners[triangle as usize][k])
    }

    /// Whether the two triangles of an edge have different indices at it.
    pub fn is_seam(&self, surface: &Surface, edge: [u32; 2], triangles: [u32; 2]) -> bool {
        edge.into_iter().any(|v| self.mark(surface, triangles[0], v) != self.mark(surface, triangles[1], v))
    }

    fn orientation(&self, marks: [u32; 3], place: impl Fn(u32) -> Place) -> Sign {
        let [a, b, c] = marks.map(place);
        orient2d(a, b, c)
    }

    /// Whether a triangle with these indices has the orientation of a chart.
    pub fn fits(&self, chart: u32, marks: [u32; 3], place: impl Fn(u32) -> Place) -> bool {
        self.orientation(marks, place) == self.signs[chart as usize]
    }

    /// The first texture at the point over which a point of the shell lies, and its chart: the triangle is certain, the
    /// place rounded.
    pub fn first_texture(&self, point: Point) -> Option<(u32, Place)> {
        let First { shell, corners, charts } = &self.first;
        let at = shell.on_source(point).ok()?;
        let values = corners[at.triangle as usize];
        let weights = at.weights.each_ref().map(Interval::near);
        let place: Place = [0, 1].map(|i| (0..3).map(|k| weights[k] * values[k][i]).sum());
        place.iter().all(|x| x.is_finite()).then_some((charts[at.triangle as usize], place))
    }

    /// The texture of the given triangles, with its indices numbered anew.
    pub fn finished(&self, kept: &[u32]) -> Texture {
        let mut number = vec![u32::MAX; self.coordinates.len()];
        let mut texture = Texture::default();
        for &t in kept {
            texture.corners.push(self.corners[t as usize].map(|index| {
                if number[index as usize] == u32::MAX {
                    number[index as usize] = texture.coordinates.len() as u32;
                    texture.coordinates.push(self.place(index));
                }
                number[index as usize]
            }));
        }
        texture
    }
}
