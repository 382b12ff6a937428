//! The section map and its inverse.

use dashu_int::IBig;
use homeo_core::mesh::{Adjacency, Facet, VertexId};
use homeo_core::number::Rational;
use homeo_core::predicate::{Sign, orient2d};
use homeo_core::spatial::{Aabb, Tree};

use super::FoliationParts;

/// Map of the source region, exact at vertices and linear in between.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// Square: an arc onto `[0, 1]`; vertices in order, parameters strictly increasing.
    Arc {
        /// Vertices along the arc.
        vertices: Vec<VertexId>,
        /// Their images.
        parameters: Vec<f64>,
    },
    /// Disk: the boundary loop onto `[0, 4)`; vertices in order, parameters strictly increasing from 0.
    Loop {
        /// Vertices round the loop.
        vertices: Vec<VertexId>,
        /// Their images.
        parameters: Vec<f64>,
    },
    /// Cube: a triangulated disk onto the unit square.
    Square {
        /// Vertices of the region.
        vertices: Vec<VertexId>,
        /// Their images.
        coordinates: Vec<[f64; 2]>,
    },
    /// Ball: the boundary of the centre cell, by its barycentric coordinates.
    Centre,
}

/// Look-up of a section in both directions.
#[derive(Debug)]
pub(super) struct SectionIndex {
    /// Number of each mesh vertex in the section.
    number: Vec<u32>,
    /// Source facets: for arcs in order along the arc, for the square as the tree numbers them.
    facets: Vec<Facet>,
    tree: Option<Tree>,
}

const ABSENT: u32 = u32::MAX;

impl SectionIndex {
    pub fn new<const K: usize>(parts: &FoliationParts<K>, adjacency: &Adjacency<K>) -> Self {
        let vertices = match &parts.section {
            Section::Arc { vertices, .. } | Section::Loop { vertices, .. } | Section::Square { vertices, .. } => {
                vertices
            }
            Section::Centre => return Self { number: Vec::new(), facets: Vec::new(), tree: None },
        };
        let complex = parts.mesh.complex();
        let mut number = vec![ABSENT; complex.vertex_count()];
        for (k, vertex) in vertices.iter().enumerate() {
            if let Some(slot) = number.get_mut(vertex.index()) {
                *slot = k as u32;
            }
        }
        let mut facets: Vec<Facet> =
            adjacency.boundary_facets().filter(|f| parts.directions[f.cell().index()][f.opposite()] > 0).collect();
        let mut tree = None;
        if let Section::Square { coordinates, .. } = &parts.section {
            let boxes: Vec<Aabb> = facets
                .iter()
                .map(|f| {
                    let corners: Vec<[f64; 3]> = complex
                        .facet_vertices(f.cell(), f.opposite())
                        .filter_map(|v| coordinates.get(number[v.index()] as usize))
                        .map(|&[x, y]| [x, y, 0.0])
                        .collect();
                    Aabb::of(&corners)
                })
                .collect();
            tree = Some(Tree::new(&boxes));
        } else {
            // Each edge is filed under its first vertex, so that bisection of parameters finds it.
            let last = vertices.len().saturating_sub(1) as u32;
            facets.sort_by_key(|f| {
                let ends: Vec<u32> =
                    complex.facet_vertices(f.cell(), f.opposite()).map(|v| number[v.index()]).collect();
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                if low == 0 && high == last && high > 1 { high } else { low }
            });
        }
        Self { number, facets, tree }
    }

    /// Parameters of the two ends of a source edge, in the order of its vertices.
    fn edge_parameters(&self, section: &Section, ends: [VertexId; 2]) -> [f64; 2] {
        let (parameters, closes) = match section {
            Section::Arc { parameters, .. } => (parameters, false),
            Section::Loop { parameters, .. } => (parameters, true),
            _ => return [0.0; 2],
        };
        let numbers = ends.map(|v| self.number[v.index()] as usize);
        let is_closing = closes && numbers.contains(&0) && numbers.contains(&(parameters.len() - 1));
        numbers.map(|n| if is_closing && n == 0 { 4.0 } else { parameters[n] })
    }

    /// Values of the section at the vertices of a source facet (arc parameter, or square coordinates).
    pub fn values(&self, section: &Section, corners: &[VertexId]) -> Vec<[f64; 2]> {
        match section {
            Section::Square { coordinates, .. } => {
                corners.iter().map(|v| coordinates[self.number[v.index()] as usize]).collect()
            }
            _ => self.edge_parameters(section, [corners[0], corners[1]]).map(|s| [s, 0.0]).to_vec(),
        }
    }

    /// The source edge whose parameters enclose `s`, and the parameters of its ends in facet order.
    pub fn edge_at<const K: usize>(
        &self,
        parts: &FoliationParts<K>,
        is_at_most: impl Fn(f64) -> bool,
    ) -> Option<(Facet, [f64; 2])> {
        let (Section::Arc { parameters, .. } | Section::Loop { parameters, .. }) = &parts.section else { return None };
        let after = parameters.partition_point(|&p| is_at_most(p));
        let facet = *self.facets.get(after.saturating_sub(1).min(self.facets.len().saturating_sub(1)))?;
        let ends: Vec<VertexId> = parts.mesh.complex().facet_vertices(facet.cell(), facet.opposite()).collect();
        Some((facet, self.edge_parameters(&parts.section, [ends[0], ends[1]])))
    }

    /// A source triangle of the cube whose image contains `q`, with its weights, exactly.
    pub fn triangle_at_exact<const K: usize>(
        &self,
        parts: &FoliationParts<K>,
        q: &[Rational; 2],
    ) -> Option<(Facet, [IBig; 3])> {
        let around = |value: &Rational| {
            let near = value.to_f64();
            (near.next_down(), near.next_up())
        };
        let (x, y) = (around(&q[0]), around(&q[1]));
        let region = Aabb::of(&[[x.0, y.0, 0.0], [x.1, y.1, 0.0]]);
        let mut found: Option<(Facet, [IBig; 3])> = None;
        self.tree.as_ref()?.query_box(&region, |t| {
            let facet = self.facets[t];
            if found.as_ref().is_none_or(|(best, _)| facet < *best)
                && let Some(weights) = exact_weights(&self.facet_values(parts, facet), q)
            {
                found = Some((facet, weights));
            }
        });
        found
    }

    /// Candidate triangles near a floating-point point, with the signs of their three sides.
    pub fn triangle_at<const K: usize>(&self, parts: &FoliationParts<K>, q: [f64; 2]) -> Option<(Facet, [Sign; 3])> {
        let mut found: Option<(Facet, [Sign; 3])> = None;
        self.tree.as_ref()?.query_point([q[0], q[1], 0.0], |t| {
            let facet = self.facets[t];
            if found.as_ref().is_some_and(|(best, _)| *best <= facet) {
                return;
            }
            let [a, b, c] = self.facet_values(parts, facet);
            let turn = orient2d(a, b, c);
            let signs = [orient2d(q, b, c), orient2d(a, q, c), orient2d(a, b, q)]
                .map(|s| if turn == Sign::Negative { s.reversed() } else { s });
            if signs.iter().all(|&s| s != Sign::Negative) {
                found = Some((facet, signs));
            }
        });
        found
    }

    /// Images of the corners of a source triangle, in facet order.
    pub fn facet_values<const K: usize>(&self, parts: &FoliationParts<K>, facet: Facet) -> [[f64; 2]; 3] {
        let corners: Vec<VertexId> = parts.mesh.complex().facet_vertices(facet.cell(), facet.opposite()).collect();
        let values = self.values(&parts.section, &corners);
        [values[0], values[1], values[2]]
    }
}

/// Weights of `q` in a triangle, up to a positive factor; `None` when it lies outside.
fn exact_weights(corners: &[[f64; 2]; 3], q: &[Rational; 2]) -> Option<[IBig; 3]> {
    let exact = |p: [f64; 2]| Some([Rational::from_f64(p[0])?, Rational::from_f64(p[1])?]);
    let [a, b, c] = [exact(corners[0])?, exact(corners[1])?, exact(corners[2])?];
    let area = |a: &[Rational; 2], b: &[Rational; 2], c: &[Rational; 2]| {
        &(&(&b[0] - &a[0]) * &(&c[1] - &a[1])) - &(&(&b[1] - &a[1]) * &(&c[0] - &a[0]))
    };
    let turn = area(&a, &b, &c).sign();
    let areas = [area(q, &b, &c), area(&a, q, &c), area(&a, &b, q)];
    if turn == Sign::Zero || areas.iter().any(|w| w.sign() == turn.reversed()) {
        return None;
    }
    let mut weights = super::exact::whole(&areas);
    if turn == Sign::Negative {
        weights = weights.map(|w| -w);
    }
    Some(weights)
}
