//! Seams: where domains with several holes are slit open, source and target alike.
//!
//! Seams run along edges of the triangulations and through inner vertices only. Edges between vertices that are already
//! on the boundary or on a seam are split first. Then every triangle has an inner vertex and neighbours share one: from
//! any vertex of a ring there is a way to any other, as long as seams do not part the domain, and a tree of them does not.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use homeo_core::planar::{PlanarDomain, Point2};

use super::mesh::Mesh;
use crate::map::{BoundaryPoint, Circuit, CircuitSide, SHARE_BITS};

/// Seams of a pair.
pub(super) struct Seams {
    /// The vertices that they join, numbered ring after ring, the same in source and target.
    pub ends: Vec<[u32; 2]>,
    /// The vertices of each triangulation on them, with the ends.
    pub routes: [Vec<Vec<u32>>; 2],
}

/// A triangulated domain on which seams are laid.
struct Sheet<'a> {
    mesh: &'a mut Mesh,
    /// The domain's vertices in the mesh.
    corners: Vec<u32>,
    /// Vertices on the boundary or on a seam.
    is_taken: Vec<bool>,
    routes: Vec<Vec<u32>>,
    neighbours: Vec<Vec<u32>>,
}

/// Shortest ways from a vertex.
struct Ways {
    lengths: Vec<f64>,
    before: Vec<u32>,
}

impl<'a> Sheet<'a> {
    fn new(boundary: &[BoundaryPoint], mesh: &'a mut Mesh) -> Self {
        let corners = (0..boundary.len() as u32).filter(|&row| boundary[row as usize].share == 0).collect();
        let is_taken = vec![true; boundary.len()];
        Self { mesh, corners, is_taken, routes: Vec::new(), neighbours: Vec::new() }
    }

    fn split_chords(&mut self) {
        self.is_taken.resize(self.mesh.len(), false);
        let links = self.routes.iter().flat_map(|route| route.windows(2));
        let links: HashSet<[u32; 2]> = links.map(|link| [link[0].min(link[1]), link[0].max(link[1])]).collect();
        let is_taken = &self.is_taken;
        self.mesh.split_chords(|ends| ends.iter().all(|&end| is_taken[end as usize]) && !links.contains(&ends));
        self.is_taken.resize(self.mesh.len(), false);
        self.neighbours = vec![Vec::new(); self.mesh.len()];
        for corners in &self.mesh.triangles {
            for k in 0..3 {
                // On the boundary an edge is in one triangle only, but no way goes along it.
                self.neighbours[corners[k] as usize].push(corners[(k + 1) % 3]);
            }
        }
    }

    /// Shortest ways through vertices that are not taken, as far as they are not longer than `most`.
    fn ways(&self, from: u32, most: f64) -> Ways {
        let mut ways = Ways { lengths: vec![f64::INFINITY; self.mesh.len()], before: vec![from; self.mesh.len()] };
        ways.lengths[from as usize] = 0.0;
        // Lengths are not negative: their bits are in the order of their values.
        let mut queue = BinaryHeap::from([Reverse((0u64, from))]);
        while let Some(Reverse((bits, here))) = queue.pop() {
            let length = f64::from_bits(bits);
            if length > ways.lengths[here as usize] || self.is_taken[here as usize] && here != from {
                continue;
            }
            for &next in &self.neighbours[here as usize] {
                let longer = length + distance(self.mesh.position(here), self.mesh.position(next));
                if longer < ways.lengths[next as usize] && longer <= most {
                    ways.lengths[next as usize] = longer;
                    ways.before[next as usize] = here;
                    queue.push(Reverse((longer.to_bits(), next)));
                }
            }
        }
        ways
    }

    fn lay(&mut self, route: Vec<u32>) {
        route.iter().for_each(|&vertex| self.is_taken[vertex as usize] = true);
        self.routes.push(route);
    }
}

impl Ways {
    fn to(&self, end: u32) -> Vec<u32> {
        let mut route = vec![end];
        let mut here = end;
        while self.lengths[here as usize] > 0.0 {
            here = self.before[here as usize];
            route.push(here);
        }
        route.reverse();
        route
    }
}

/// Joins all rings by seams, the shortest first, source and target taken together; then no edge but those of rings and
/// seams joins two of their vertices. None if rounding left no way.
pub(super) fn lay(domain: &PlanarDomain, halves: [(&[BoundaryPoint], &mut Mesh); 2]) -> Option<Seams> {
    let mut sheets = halves.map(|(boundary, mesh)| Sheet::new(boundary, mesh));
    let ring_of: Vec<usize> =
        domain.rings().iter().enumerate().flat_map(|(ring, points)| points.iter().map(move |_| ring)).collect();
    let mut is_joined = vec![false; domain.rings().len()];
    is_joined[0] = true;
    let mut is_free = vec![true; ring_of.len()];
    let mut ends = Vec::new();
    while ends.len() + 1 < is_joined.len() {
        sheets.iter_mut().for_each(Sheet::split_chords);
        let (from, to) = (0..ring_of.len()).filter(|&v| is_free[v]).partition(|&v| is_joined[ring_of[v]]);
        let (seam, routes) = shortest(&sheets, from, to)?;
        sheets.iter_mut().zip(routes).for_each(|(sheet, route)| sheet.lay(route));
        seam.iter().for_each(|&end| is_free[end] = false);
        is_joined[ring_of[seam[1]]] = true;
        ends.push(seam.map(|end| end as u32));
    }
    sheets.iter_mut().for_each(Sheet::split_chords);
    Some(Seams { ends, routes: sheets.map(|sheet| sheet.routes) })
}

/// The ways of one seam in source and target, and its ends.
type Found = ([usize; 2], [Vec<u32>; 2]);

/// The pair of vertices that is nearest in both together. A way is not shorter than a straight line: where these are longer
/// than what was found, nothing is looked for.
fn shortest(sheets: &[Sheet; 2], from: Vec<usize>, to: Vec<usize>) -> Option<Found> {
    let place = |side: usize, v: usize| sheets[side].mesh.position(sheets[side].corners[v]);
    let straight = |v: usize, w: usize| (0..2).map(|side| distance(place(side, v), place(side, w))).sum::<f64>();
    let least = |v: usize| to.iter().map(|&w| straight(v, w)).fold(f64::INFINITY, f64::min);
    let mut order: Vec<(f64, usize)> = from.into_iter().map(|v| (least(v), v)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: (f64, Option<Found>) = (f64::INFINITY, None);
    for (least, v) in order {
        if least >= best.0 {
            break;
        }
        let ways = [0, 1].map(|side| sheets[side].ways(sheets[side].corners[v], best.0));
        let ends = |w: usize| [0, 1].map(|side| sheets[side].corners[w]);
        let length = |w: usize| ends(w).iter().zip(&ways).map(|(&end, ways)| ways.lengths[end as usize]).sum::<f64>();
        for &w in &to {
            if length(w) < best.0 {
                let [a, b] = ends(w);
                best = (length(w), Some(([v, w], [ways[0].to(a), ways[1].to(b)])));
            }
        }
    }
    best.1
}

/// A boundary along a circuit, with the vertices of the mesh that it passes.
pub(super) struct Slit {
    pub boundary: Vec<BoundaryPoint>,
    pub walk: Vec<u32>,
    pub seam_points: Vec<Point2>,
    /// How long the sides of the circuit are.
    pub lengths: Vec<f64>,
}

/// The boundary of a mesh that is slit along such routes; `boundary` are its points on the rings.
pub(super) fn slit(circuit: &Circuit, boundary: &[BoundaryPoint], mesh: &Mesh, routes: &[Vec<u32>]) -> Slit {
    let begins: Vec<usize> = (0..boundary.len()).filter(|&row| boundary[row].share == 0).collect();
    let shares: Vec<Vec<u32>> = routes.iter().map(|route| shares_of(mesh, route)).collect();
    let seam_points =
        routes.iter().flat_map(|route| &route[1..route.len() - 1]).map(|&vertex| mesh.position(vertex)).collect();
    let mut slit = Slit { boundary: Vec::new(), walk: Vec::new(), seam_points, lengths: Vec::new() };
    for (edge, (&corner, side)) in circuit.corners().iter().zip(circuit.sides()).enumerate() {
        let mut push = |share: u32, vertex: u32| {
            slit.boundary.push(BoundaryPoint { ring: 0, edge: edge as u32, share });
            slit.walk.push(vertex);
        };
        let first = begins[corner as usize];
        match *side {
            CircuitSide::Edge => {
                push(0, first as u32);
                let inside = (first + 1..boundary.len()).take_while(|&row| boundary[row].share > 0);
                inside.for_each(|row| push(boundary[row].share, row as u32));
            }
            CircuitSide::Seam { number, is_back } => {
                let (route, shares) = (&routes[number as usize], &shares[number as usize]);
                let points = shares.iter().zip(route);
                match is_back {
                    false => points.take(route.len() - 1).for_each(|(&share, &vertex)| push(share, vertex)),
                    true => {
                        let back = points.skip(1).rev();
                        back.for_each(|(&share, &vertex)| push((1 << SHARE_BITS) - share, vertex));
                    }
                }
            }
        }
    }
    let ends = |k: usize| [slit.walk[k], slit.walk[(k + 1) % slit.walk.len()]].map(|vertex| mesh.position(vertex));
    slit.lengths = vec![0.0; circuit.sides().len()];
    for (k, point) in slit.boundary.iter().enumerate() {
        let [a, b] = ends(k);
        slit.lengths[point.edge as usize] += distance(a, b);
    }
    slit
}

/// By how much of its length each vertex of a route is ahead, in units of `2^-30`: increasing from 0 to `2^30`.
fn shares_of(mesh: &Mesh, route: &[u32]) -> Vec<u32> {
    let links = route.windows(2).map(|link| distance(mesh.position(link[0]), mesh.position(link[1])));
    let ahead: Vec<f64> = std::iter::once(0.0)
        .chain(links.scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        }))
        .collect();
    let (last, whole) = (route.len() - 1, 1u32 << SHARE_BITS);
    let mut before = 0;
    (0..=last)
        .map(|k| {
            let rounded = (ahead[k] / ahead[last] * f64::from(whole)).round() as u32;
            // Room is left for those before and after it.
            let least = if k == 0 { 0 } else { before + 1 };
            before = rounded.clamp(least, (whole - (last - k) as u32).max(least));
            before
        })
        .collect()
}

fn distance([a, b]: Point2, [c, d]: Point2) -> f64 {
    (c - a).hypot(d - b)
}
