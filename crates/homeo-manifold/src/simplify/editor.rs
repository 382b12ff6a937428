//! A closed triangulation while it is changed.

use super::SimplifyError;
use crate::link::Links;
use crate::permutation::Permutation;
use crate::skeleton::{EDGES, EdgeCorner, Skeleton};
use crate::triangulation::{Gluing, Triangulation};

/// A closed triangulation in which tetrahedra are taken away and added; vertices keep their names.
pub(super) struct Editor {
    triangulation: Triangulation,
    /// The vertices at the corners of each tetrahedron.
    vertices: Vec<[u32; 4]>,
    is_alive: Vec<bool>,
    dead: Vec<u32>,
    /// Whether a vertex is to stay: its link is no sphere.
    is_truncated: Vec<bool>,
    /// For searches of stars: the number of the last that came by.
    seen_by: Vec<[u32; 4]>,
    searches: u32,
}

impl Editor {
    pub(super) fn new(triangulation: &Triangulation) -> Result<Self, SimplifyError> {
        if let Some((tetrahedron, face)) = triangulation.boundary_faces().next() {
            return Err(SimplifyError::Open { tetrahedron, face });
        }
        let skeleton = Skeleton::new(triangulation);
        if let Some(edge) = skeleton.edges().iter().find(|edge| edge.is_reversed) {
            return Err(SimplifyError::Reversed {
                tetrahedron: edge.corners[0].tetrahedron,
                edge: edge.corners[0].edge(),
            });
        }
        let links = Links::new(triangulation, &skeleton);
        let count = triangulation.len();
        Ok(Self {
            triangulation: triangulation.clone(),
            vertices: (0..count as u32).map(|tetrahedron| skeleton.vertices_of(tetrahedron)).collect(),
            is_alive: vec![true; count],
            dead: Vec::new(),
            is_truncated: links.all().iter().map(|link| !link.is_sphere()).collect(),
            seen_by: vec![[0; 4]; count],
            searches: 0,
        })
    }

    /// The tetrahedra that are there.
    pub(super) fn len(&self) -> usize {
        self.is_alive.len() - self.dead.len()
    }

    /// One more than the greatest number of a tetrahedron.
    pub(super) fn slots(&self) -> u32 {
        self.is_alive.len() as u32
    }

    pub(super) fn is_alive(&self, tetrahedron: u32) -> bool {
        self.is_alive[tetrahedron as usize]
    }

    /// The vertices at the corners of a tetrahedron.
    pub(super) fn vertices(&self, tetrahedron: u32) -> [u32; 4] {
        self.vertices[tetrahedron as usize]
    }

    pub(super) fn vertex(&self, tetrahedron: u32, corner: u8) -> u32 {
        self.vertices[tetrahedron as usize][usize::from(corner)]
    }

    pub(super) fn is_truncated(&self, vertex: u32) -> bool {
        self.is_truncated[vertex as usize]
    }

    /// What is across a face; there is always something.
    pub(super) fn across(&self, tetrahedron: u32, face: u8) -> Gluing {
        let gluing = self.triangulation.neighbour(tetrahedron, face);
        debug_assert!(gluing.is_some(), "face {face} of tetrahedron {tetrahedron} is open");
        gluing.unwrap_or(Gluing { tetrahedron, corners: Permutation::IDENTITY })
    }

    pub(super) fn is_open(&self, tetrahedron: u32, face: u8) -> bool {
        self.triangulation.neighbour(tetrahedron, face).is_none()
    }

    /// The tetrahedra round an edge, if there are at most `most`.
    pub(super) fn ring(&self, first: EdgeCorner, most: usize) -> Option<Vec<EdgeCorner>> {
        let mut ring = vec![first];
        let mut here = first;
        loop {
            here = here.next(&self.triangulation)?;
            if here == first {
                return Some(ring);
            }
            if ring.len() == most {
                return None;
            }
            ring.push(here);
        }
    }

    /// A name of an edge: the least tetrahedron with its edge among those round it.
    pub(super) fn edge_name(&self, tetrahedron: u32, a: u8, b: u8) -> (u32, u8) {
        let name = |corner: &EdgeCorner| (corner.tetrahedron, corner.edge() as u8);
        let ring = self.ring(corner_at(tetrahedron, a, b), usize::MAX).unwrap_or_default();
        ring.iter().map(name).min().unwrap_or((tetrahedron, 6))
    }

    /// A name of a triangle: the lesser of its two sides.
    pub(super) fn face_name(&self, tetrahedron: u32, face: u8) -> (u32, u8) {
        let other = self.across(tetrahedron, face);
        (tetrahedron, face).min((other.tetrahedron, other.corners.image(face)))
    }

    /// All corners that belong to the vertex of a corner.
    pub(super) fn star(&mut self, tetrahedron: u32, corner: u8) -> Vec<(u32, u8)> {
        self.searches += 1;
        let mut star = vec![(tetrahedron, corner)];
        self.seen_by[tetrahedron as usize][usize::from(corner)] = self.searches;
        let mut next = 0;
        while let Some(&(tetrahedron, corner)) = star.get(next) {
            next += 1;
            for face in (0..4).filter(|&face| face != corner) {
                let gluing = self.across(tetrahedron, face);
                let there = (gluing.tetrahedron, gluing.corners.image(corner));
                let seen = &mut self.seen_by[there.0 as usize][usize::from(there.1)];
                if std::mem::replace(seen, self.searches) != self.searches {
                    star.push(there);
                }
            }
        }
        star
    }

    pub(super) fn rename(&mut self, corners: &[(u32, u8)], vertex: u32) {
        for &(tetrahedron, corner) in corners {
            self.vertices[tetrahedron as usize][usize::from(corner)] = vertex;
        }
    }

    pub(super) fn open(&mut self, tetrahedron: u32, face: u8) -> Gluing {
        let gluing = self.across(tetrahedron, face);
        self.triangulation.unglue(tetrahedron, face);
        gluing
    }

    pub(super) fn glue(&mut self, tetrahedron: u32, face: u8, other: u32, corners: Permutation) {
        let result = self.triangulation.glue(tetrahedron, face, other, corners);
        debug_assert!(result.is_ok(), "{result:?}");
    }

    /// Takes away a tetrahedron; its faces are open then.
    pub(super) fn kill(&mut self, tetrahedron: u32) {
        for face in 0..4 {
            self.triangulation.unglue(tetrahedron, face);
        }
        self.is_alive[tetrahedron as usize] = false;
        self.dead.push(tetrahedron);
    }

    /// A new tetrahedron with these vertices and open faces.
    pub(super) fn add(&mut self, vertices: [u32; 4]) -> u32 {
        if let Some(tetrahedron) = self.dead.pop() {
            self.is_alive[tetrahedron as usize] = true;
            self.vertices[tetrahedron as usize] = vertices;
            return tetrahedron;
        }
        self.vertices.push(vertices);
        self.is_alive.push(true);
        self.seen_by.push([0; 4]);
        self.triangulation.add_tetrahedron()
    }

    /// The triangulation as it is, numbered without gaps.
    pub(super) fn finished(&self) -> Triangulation {
        let mut numbers = vec![u32::MAX; self.is_alive.len()];
        let alive = (0..self.slots()).filter(|&tetrahedron| self.is_alive(tetrahedron));
        for (number, tetrahedron) in alive.enumerate() {
            numbers[tetrahedron as usize] = number as u32;
        }
        let mut result = Triangulation::new(self.len());
        for tetrahedron in (0..self.slots()).filter(|&tetrahedron| self.is_alive(tetrahedron)) {
            for face in 0..4 {
                let gluing = self.across(tetrahedron, face);
                let (here, there) = (numbers[tetrahedron as usize], numbers[gluing.tetrahedron as usize]);
                if result.neighbour(here, face).is_none() {
                    let glued = result.glue(here, face, there, gluing.corners);
                    debug_assert!(glued.is_ok(), "{glued:?}");
                }
            }
        }
        result
    }
}

/// An edge of a tetrahedron, from corner `a` to corner `b`.
pub(super) fn corner_at(tetrahedron: u32, a: u8, b: u8) -> EdgeCorner {
    let [c, d] = EDGES[5 - crate::skeleton::edge_between(a, b)];
    let corners = Permutation::new([a, b, c, d]);
    debug_assert!(corners.is_some(), "{a} and {b} are no edge");
    EdgeCorner { tetrahedron, corners: corners.unwrap_or(Permutation::IDENTITY) }
}

/// Sets that are joined; joining two that are one already is told.
pub(super) struct Joined<T> {
    pairs: Vec<(T, usize)>,
    sets: usize,
}

impl<T: PartialEq> Joined<T> {
    pub(super) fn new() -> Self {
        Self { pairs: Vec::new(), sets: 0 }
    }

    /// Whether the two were apart.
    pub(super) fn join(&mut self, a: T, b: T) -> bool {
        let (a, b) = (self.set_of(a), self.set_of(b));
        for (_, set) in &mut self.pairs {
            if *set == a {
                *set = b;
            }
        }
        a != b
    }

    fn set_of(&mut self, item: T) -> usize {
        if let Some((_, set)) = self.pairs.iter().find(|(known, _)| *known == item) {
            return *set;
        }
        self.sets += 1;
        self.pairs.push((item, self.sets));
        self.sets
    }
}
