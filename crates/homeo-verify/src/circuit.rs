//! Rule H6: domains with several holes are slit open along seams, and one closed walk goes along what is left.
//!
//! The walk follows the rings. At the end of a seam it goes over it, follows the other ring from there, and comes back on
//! the other side. Both sides of a seam are the same line: glued along all seams the slit domain is the domain again.

use crate::map_file::{HalfData, HarmonicData};
use crate::number::Point;
use crate::verdict::{Checked, check, refuted};
use std::collections::BTreeMap;

/// The walk along the boundary of a slit domain.
pub(crate) struct Circuit {
    /// The vertex at which each side begins.
    corners: Vec<u32>,
    /// Which sides are those of each seam: from its first end to its second, and back.
    seam_sides: Vec<[usize; 2]>,
}

impl Circuit {
    /// Follows the walk from the first edge on; it must be closed and pass every edge once, and every seam there and back.
    pub(crate) fn new(data: &HarmonicData) -> Checked<Self> {
        let count = data.source_points.len();
        // Side `v` is the edge from vertex `v`; after these come the sides of the seams.
        let mut starts: Vec<usize> = (0..count).collect();
        let mut begins: Vec<u32> = (0..count as u32).collect();
        for (number, ends) in data.seams.iter().enumerate() {
            let is_new = ends.iter().all(|&v| starts.get(v as usize) == Some(&(v as usize))) && ends[0] != ends[1];
            check(is_new, "H6", "a seam has no end of its own", &[number], ends)?;
            ends.iter().for_each(|&v| {
                starts[v as usize] = begins.len();
                begins.push(v);
            });
        }
        let mut after: Vec<usize> = vec![0; begins.len()];
        let mut first = 0;
        for &size in &data.ring_sizes {
            let ring = first..first + size as usize;
            ring.clone().for_each(|v| after[v] = starts[if v + 1 < ring.end { v + 1 } else { first }]);
            first = ring.end;
        }
        // Over a seam to its other end, and on along the ring there.
        (count..begins.len()).for_each(|side| after[side] = begins[count + ((side - count) ^ 1)] as usize);
        let mut place = vec![usize::MAX; begins.len()];
        let (mut corners, mut side) = (vec![], 0);
        while place[side] == usize::MAX {
            place[side] = corners.len();
            corners.push(begins[side]);
            side = after[side];
        }
        check(corners.len() == begins.len(), "H6", "seams do not join all rings as a tree", &[], &[])?;
        let seam_sides = place[count..].as_chunks().0.to_vec();
        Ok(Circuit { corners, seam_sides })
    }

    /// Where the corners lie.
    pub(crate) fn outline(&self, points: &[Point]) -> Vec<Point> {
        self.corners.iter().map(|&v| points[v as usize]).collect()
    }

    /// Where rows of the boundary lie, if inside seams: both sides of each have the same points, at the shares `s` and
    /// `1 - s`, and as many as there are places.
    pub(crate) fn places(&self, half: &HalfData, name: &str) -> Checked<BTreeMap<u32, Point>> {
        let refuse = |seam: usize| refuted("H6", format!("the sides of a seam differ ({name})"), &[seam], &[]);
        let mut inside: Vec<Vec<(u32, u32)>> = vec![vec![]; self.corners.len()];
        for (row, &[_, side, share]) in half.boundary.as_chunks::<3>().0.iter().enumerate() {
            if share > 0 {
                inside[side as usize].push((row as u32, share));
            }
        }
        let mut places = BTreeMap::new();
        let mut points = half.seam_points.iter();
        for (seam, &[there, back]) in self.seam_sides.iter().enumerate() {
            if inside[there].len() != inside[back].len() {
                return Err(refuse(seam));
            }
            for (&(row, share), &(opposite, rest)) in inside[there].iter().zip(inside[back].iter().rev()) {
                // Rule H2: shares are less than 2^30.
                let (true, Some(&point)) = (share + rest == 1 << 30, points.next()) else { return Err(refuse(seam)) };
                places.extend([(row, point), (opposite, point)]);
            }
        }
        let message = format!("there are more points than on seams ({name})");
        check(points.next().is_none(), "H6", &message, &[], &[])?;
        Ok(places)
    }
}
