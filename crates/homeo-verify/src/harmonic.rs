//! Rules H1-H6: a composite harmonic map is a homeomorphism between planar domains.
//!
//! *Theorem* (by degree). Let triangles be glued along edges so that every edge has at most two of them, and those with
//! one form the given closed polygons. If all triangles are counter-clockwise in the plane, and the polygons there wind
//! once round every point of a domain and not at all round others, the triangles tile the domain, edge to edge. The same
//! holds on a flat cylinder, and for triangles that are glued along seams as well. Source and target are each tiled by
//! triangles whose images tile one middle, and on every edge both go linearly to the same segment, and so do both sides of
//! every seam: so source to middle to target is a homeomorphism, linear on every edge.
//! (Proof: `docs/theory/polygons.md`.)

use crate::circuit::Circuit;
use crate::map_file::{HalfData, HarmonicData};
use crate::number::{FINEST_BITS, Point, in_finest_units, orientation_2d};
use crate::rings::Rings;
use crate::verdict::{Checked, check, refuted};
use dashu_int::IBig;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Shares of edges are in units of `2^-30`.
const SHARE_BITS: usize = 30;

/// A point of the plane in units of `2^-(FINEST_BITS + SHARE_BITS)`.
type Exact2 = [IBig; 2];

/// Applies the rules and counts what was checked.
pub(crate) fn check_harmonic(data: &HarmonicData) -> Checked<Vec<(&'static str, u64)>> {
    let points = [&data.source_points, &data.target_points, &data.middle_points];
    let is_finite = |p: &Point| p.iter().all(|x| x.is_finite());
    check(points.into_iter().flatten().all(is_finite), "H1", "a vertex of a polygon is not finite", &[], &[])?;
    let [source, target] = [points[0], points[1]].map(|points| Rings { points, sizes: &data.ring_sizes });
    source.check_domain("source")?;
    target.check_domain("target")?;
    let circuit = if data.ring_sizes.len() > 2 { Some(Circuit::new(data)?) } else { None };
    // Slit open, both domains have one ring, as the middle.
    let slit_size = [data.middle_points.len() as u32];
    let sizes = if circuit.is_some() { &slit_size } else { &data.ring_sizes[..] };
    let middle = Rings { points: &data.middle_points, sizes };
    match data.is_cylinder {
        true => check_cylinder(&middle)?,
        false => middle.check_domain("middle")?,
    }
    for (name, points, data_of_half) in
        [("source", &data.source_points, &data.halves[0]), ("target", &data.target_points, &data.halves[1])]
    {
        let outline = circuit.as_ref().map_or_else(|| points.clone(), |circuit| circuit.outline(points));
        let domain = &Rings { points: &outline, sizes };
        let (middle, circuit, is_cylinder) = (&middle, circuit.as_ref(), data.is_cylinder);
        Half { name, domain, middle, circuit, seam: BTreeMap::new(), data: data_of_half, is_cylinder }.check()?;
    }
    let triangles = data.halves.iter().map(|half| half.triangles.len() as u64 / 3).sum();
    let boundary = data.halves.iter().map(|half| half.boundary.len() as u64 / 3).sum();
    let edges = points.map(|points| points.len() as u64).iter().sum();
    let mut checked = vec![
        ("edges of source, target and middle that meet in common ends only (rule D)", edges),
        ("points of the triangulations on edges of the polygons (rule H2)", boundary),
        ("triangles, glued along edges and round the polygons (rule H3)", triangles),
        ("triangles that are counter-clockwise, and so are their images (rules H4, H5)", triangles),
    ];
    if circuit.is_some() {
        checked.push(("seams with the same points on both sides (rule H6)", 2 * data.seams.len() as u64));
    }
    Ok(checked)
}

/// Rule H1 for a cylinder, whose first coordinate counts modulo 1: the outer ring runs once round at height 0, the inner
/// one once back at height 1.
fn check_cylinder(middle: &Rings) -> Checked {
    let rule = |holds: bool| check(holds, "H1", "a ring of the middle does not run once round the cylinder", &[], &[]);
    let ahead = |p: Point| in_finest_units(p[0]);
    for (ring, height) in [(0, 0.0), (1, 1.0)] {
        let points = middle.ring(ring);
        let [first, last] = [points[0], points[points.len() - 1]];
        let is_forward = |a: Point, b: Point| if ring == 0 { a[0] < b[0] } else { a[0] > b[0] };
        rule(points.iter().all(|p| p[1] == height) && points.windows(2).all(|w| is_forward(w[0], w[1])))?;
        let length = if ring == 0 { ahead(last) - ahead(first) } else { ahead(first) - ahead(last) };
        rule(length < IBig::ONE << FINEST_BITS)?;
    }
    Ok(())
}

/// A triangulated domain and its images in the middle.
struct Half<'a> {
    name: &'static str,
    /// Its vertices along the rings of the middle.
    domain: &'a Rings<'a>,
    middle: &'a Rings<'a>,
    circuit: Option<&'a Circuit>,
    /// Where points inside seams lie.
    seam: BTreeMap<u32, Point>,
    data: &'a HalfData,
    is_cylinder: bool,
}

impl Half<'_> {
    fn check(&mut self) -> Checked {
        let data = self.data;
        let rule = |holds: bool, rule, message: &str| {
            check(holds, rule, &format!("{message} ({}'s triangulation)", self.name), &[], &[])
        };
        let finite = data.inner.iter().chain(&data.images).chain(&data.seam_points).flatten().all(|x| x.is_finite());
        rule(finite, "H2", "a vertex is not finite")?;
        let next = self.check_boundary()?;
        if let Some(circuit) = self.circuit {
            self.seam = circuit.places(data, self.name)?;
        }
        let count = next.len() + data.inner.len();
        rule(
            data.triangles.iter().all(|&v| (v as usize) < count),
            "H3",
            "a triangle has a vertex that does not exist",
        )?;
        self.check_gluing(&next)?;
        for (t, corners) in data.triangles.as_chunks::<3>().0.iter().enumerate() {
            let holds = self.orientation(corners, None) == Ordering::Greater;
            let message = format!("a triangle is turned over or flat ({}'s triangulation)", self.name);
            check(holds, "H4", &message, &[t], corners)?;
            let holds = self.orientation(corners, Some(t)) == Ordering::Greater;
            let message = format!("the image of a triangle is turned over or flat ({}'s triangulation)", self.name);
            check(holds, "H5", &message, &[t], corners)?;
        }
        Ok(())
    }

    /// Rule H2: points on the boundary go along the edges in order, and begin every edge. The next one of each.
    fn check_boundary(&self) -> Checked<Vec<u32>> {
        let rows = self.data.boundary.as_chunks::<3>().0;
        let message = format!("points on the boundary do not go along its edges in order ({})", self.name);
        let rule = |holds: bool, row: usize| check(holds, "H2", &message, &[], &[row as u32]);
        let mut next: Vec<u32> = (1..=rows.len() as u32).collect();
        let (mut edges, mut first) = (0, 0);
        for (row, &[ring, edge, share]) in rows.iter().enumerate() {
            let before = row.checked_sub(1).map(|before| rows[before]);
            rule((share as usize) < 1 << SHARE_BITS, row)?;
            match before {
                Some([r, e, s]) if (r, e) == (ring, edge) => rule(s < share, row)?,
                _ => {
                    // The beginning of the next edge.
                    let size = |r: u32| self.domain.sizes.get(r as usize).copied().unwrap_or(0);
                    let expected = match before {
                        None => [0, 0],
                        Some([r, e, _]) if e + 1 < size(r) => [r, e + 1],
                        Some([r, _, _]) => {
                            next[row - 1] = first;
                            first = row as u32;
                            [r + 1, 0]
                        }
                    };
                    rule([ring, edge] == expected && edge < size(ring) && share == 0, row)?;
                    edges += 1;
                }
            }
        }
        rule(edges == self.domain.points.len(), rows.len())?;
        next[rows.len() - 1] = first;
        Ok(next)
    }

    /// Rule H3: every edge has two triangles on opposite sides, or one, and is then a part of the boundary, all of which
    /// are. On a cylinder the corners' shifts agree across edges, and along the boundary with its rings.
    fn check_gluing(&self, next: &[u32]) -> Checked {
        let mut edges: BTreeMap<[u32; 2], (usize, i32)> = BTreeMap::new();
        for (t, corners) in self.data.triangles.as_chunks::<3>().0.iter().enumerate() {
            for k in 0..3 {
                let l = (k + 1) % 3;
                let jump = if self.is_cylinder { self.shift(t, l) - self.shift(t, k) } else { 0 };
                let is_new = edges.insert([corners[k], corners[l]], (t, jump)).is_none();
                check(is_new, "H3", &format!("two triangles use an edge alike ({})", self.name), &[t], corners)?;
            }
        }
        let rows = self.data.boundary.as_chunks::<3>().0;
        let mut parts = 0;
        for (&[a, b], &(t, jump)) in &edges {
            let refuse = |message: &str| Err(refuted("H3", format!("{message} ({})", self.name), &[t], &[a, b]));
            match edges.get(&[b, a]) {
                Some(&(_, back)) if jump + back != 0 => return refuse("shifts do not agree across an edge"),
                Some(_) => {}
                None if next.get(a as usize) != Some(&b) => {
                    return refuse("an edge with one triangle is no part of the boundary");
                }
                None => {
                    // The ring's end is a turn ahead of its beginning, or behind.
                    let begins_ring = b <= a;
                    let forward = if rows[a as usize][0] == 0 { 1 } else { -1 };
                    if self.is_cylinder && jump != if begins_ring { forward } else { 0 } {
                        return refuse("shifts do not agree with the boundary");
                    }
                    parts += 1;
                }
            }
        }
        let message = format!("a part of the boundary has no triangle ({})", self.name);
        check(parts == next.len(), "H3", &message, &[], &[])
    }

    fn shift(&self, triangle: usize, corner: usize) -> i32 {
        self.data.shifts[3 * triangle + corner].into()
    }

    /// The orientation of a triangle, or of its image if its number is given.
    fn orientation(&self, corners: &[u32; 3], image_of: Option<usize>) -> Ordering {
        let boundary = self.data.boundary.as_chunks::<3>().0;
        let inner = if image_of.is_some() { &self.data.images } else { &self.data.inner };
        let doubles = corners.map(|v| match boundary.get(v as usize) {
            Some(_) if image_of.is_none() && self.seam.contains_key(&v) => Some(self.seam[&v]),
            Some(&[ring, edge, 0]) => Some(self.ring(ring, image_of.is_some())[edge as usize]),
            Some(_) => None,
            None => Some(inner[v as usize - boundary.len()]),
        });
        match doubles {
            [Some(a), Some(b), Some(c)] if !(self.is_cylinder && image_of.is_some()) => orientation_2d(a, b, c),
            _ => {
                let [a, b, c] = [0, 1, 2].map(|k| self.exact(corners[k], image_of.map(|t| (t, k))));
                let step = |p: &Exact2, axis: usize| &p[axis] - &a[axis];
                (step(&b, 0) * step(&c, 1) - step(&b, 1) * step(&c, 0)).cmp(&IBig::ZERO)
            }
        }
    }

    fn ring(&self, ring: u32, is_image: bool) -> &[Point] {
        if is_image { self.middle.ring(ring as usize) } else { self.domain.ring(ring as usize) }
    }

    /// Where a vertex lies, or its image as this corner of this triangle.
    fn exact(&self, vertex: u32, image_of: Option<(usize, usize)>) -> Exact2 {
        let units = |p: Point| [0, 1].map(|axis| in_finest_units(p[axis]));
        let one_turn = IBig::ONE << FINEST_BITS;
        let boundary = self.data.boundary.as_chunks::<3>().0;
        if let (Some(&point), None) = (self.seam.get(&vertex), image_of) {
            return units(point).map(|x| x << SHARE_BITS);
        }
        let mut point = match boundary.get(vertex as usize) {
            Some(&[ring, edge, share]) => {
                let points = self.ring(ring, image_of.is_some());
                let (i, j) = (edge as usize, (edge as usize + 1) % points.len());
                let (from, mut to) = (units(points[i]), units(points[j]));
                if self.is_cylinder && image_of.is_some() && j == 0 {
                    to[0] += if ring == 0 { one_turn.clone() } else { -&one_turn };
                }
                let share = IBig::from(share);
                [0, 1].map(|axis| (&from[axis] << SHARE_BITS) + &share * (&to[axis] - &from[axis]))
            }
            None => {
                let inner = if image_of.is_some() { &self.data.images } else { &self.data.inner };
                units(inner[vertex as usize - boundary.len()]).map(|x| x << SHARE_BITS)
            }
        };
        if let (true, Some((triangle, corner))) = (self.is_cylinder, image_of) {
            point[0] += (one_turn * self.shift(triangle, corner)) << SHARE_BITS;
        }
        point
    }
}
