//! Edges of a surface under change that stay edges: boundary, seams of a texture, and features.

/// Why an edge is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::construct) enum Kind {
    /// One triangle only: it may not change at all.
    Boundary,
    /// The texture is cut there.
    Seam,
    /// The angle between its triangles is large.
    Feature,
}

/// The kept edges at each vertex.
pub(in crate::construct) struct Creases {
    at: Vec<Vec<(u32, Kind)>>,
}

impl Creases {
    /// Those of a surface with so many vertices; each edge once.
    pub fn new(vertices: usize, kept: impl IntoIterator<Item = ([u32; 2], Kind)>) -> Self {
        let mut at = vec![Vec::new(); vertices];
        for ([a, b], kind) in kept {
            at[a as usize].push((b, kind));
            at[b as usize].push((a, kind));
        }
        Self { at }
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
