//! Edges that stay edges: boundary, seams of a texture, and features.

use super::atlas::Atlas;
use super::shape::normal;
use super::surface::Surface;
use crate::construct::shell::directions::dot;

/// Why an edge is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// One triangle only: it may not change at all.
    Boundary,
    /// The texture is cut there.
    Seam,
    /// The angle between its triangles is large.
    Feature,
}

/// The kept edges at each vertex.
pub(super) struct Creases {
    at: Vec<Vec<(u32, Kind)>>,
}

impl Creases {
    pub fn new(surface: &Surface, atlas: Option<&Atlas>, feature_angle: Option<f64>) -> Self {
        let mut creases = Self { at: vec![Vec::new(); surface.positions.len()] };
        let is_feature = |left: u32, right: u32| {
            let cosine = dot(normal(surface.points(left)), normal(surface.points(right)));
            feature_angle.is_some_and(|angle| cosine < angle.cos())
        };
        for [a, b] in surface.edges() {
            let kind = match surface.both_sides(a, b) {
                None => Some(Kind::Boundary),
                Some([left, right]) if atlas.is_some_and(|atlas| atlas.is_seam(surface, [a, b], [left, right])) => {
                    Some(Kind::Seam)
                }
                Some([left, right]) => is_feature(left, right).then_some(Kind::Feature),
            };
            if let Some(kind) = kind {
                creases.at[a as usize].push((b, kind));
                creases.at[b as usize].push((a, kind));
            }
        }
        creases
    }

    /// The kept edges at a vertex.
    pub fn at(&self, vertex: u32) -> &[(u32, Kind)] {
        &self.at[vertex as usize]
    }

    /// Whether and why an edge is kept.
    pub fn kind(&self, a: u32, b: u32) -> Option<Kind> {
        self.at(a).iter().find(|(other, _)| *other == b).map(|(_, kind)| *kind)
    }

    /// The vertex before `middle` on the chain through it that goes on to `next`.
    pub fn before(&self, middle: u32, next: u32) -> Option<u32> {
        self.at(middle).iter().map(|(other, _)| *other).find(|&other| other != next)
    }

    /// The chain from `from` over `via` to `to` becomes the edge from `from` to `to`.
    pub fn shorten(&mut self, from: u32, via: u32, to: u32) {
        self.at[via as usize].clear();
        self.rename(from, via, to);
        self.rename(to, via, from);
    }

    /// The edge from `from` to `to`, if it is kept, becomes the chain over the new vertex `via`.
    pub fn lengthen(&mut self, from: u32, via: u32, to: u32) {
        let kind = self.kind(from, to);
        self.at.resize(self.at.len().max(via as usize + 1), Vec::new());
        if let Some(kind) = kind {
            self.at[via as usize] = vec![(from, kind), (to, kind)];
            self.rename(from, to, via);
            self.rename(to, from, via);
        }
    }

    fn rename(&mut self, at: u32, old: u32, new: u32) {
        for (other, _) in &mut self.at[at as usize] {
            if *other == old {
                *other = new;
            }
        }
    }
}
