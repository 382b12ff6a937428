//! Rules T9 and T10: paths are those of a section over the edges of the base, and its indices are those stated.
//!
//! *Theorem.* Tetrahedra over a triangle follow one another round a solid torus, each without one vertex of the last and with a
//! new one. Counted in the order in which they come, vertices are joined if their numbers differ by at most three, and a closed
//! path turns about the torus as often as its differences add up to `3 N`. (Proof: `docs/theory/bundles.md`, theorems 2 and 10.)

use super::data::{BundleData, SectionData};
use crate::complex::Complex;
use crate::verdict::{Checked, check, refuted};
use std::collections::HashMap;

/// Applies the rules and counts what was checked.
pub(super) fn check_section(
    data: &BundleData,
    section: &SectionData,
    base: &Complex,
    characteristic: i64,
) -> Checked<Vec<(&'static str, u64)>> {
    let paths = Paths::new(data, section, base)?;
    let each = 3 * data.layers as usize;
    let mut at_vertices = vec![0; data.vertex_count];
    for (triangle, tetrahedra) in data.tetrahedra.chunks_exact(each).enumerate() {
        let corners = data.triangles[triangle];
        let index = paths.index(triangle, corners, tetrahedra)?;
        let missed = corners.into_iter().find(|&vertex| paths.start(vertex).is_none());
        if let Some(vertex) = missed {
            at_vertices[vertex as usize] += index;
        }
        let (index, stated) = (if missed.is_some() { 0 } else { index }, section.triangle_indices[triangle]);
        check(index == stated, "T10", &format!("the index is {index}, not {stated}"), &[triangle], &[])?;
    }
    for (vertex, (index, stated)) in (0..).zip(at_vertices.iter().zip(&section.vertex_indices)) {
        check(index == stated, "T10", &format!("the index is {index}, not {stated}"), &[], &[vertex])?;
    }
    check_sum(section, characteristic)?;
    let met = (0..data.vertex_count as u32).filter(|&vertex| paths.start(vertex).is_some()).count();
    Ok(vec![
        ("fibres that the section meets once (rule T9)", met as u64),
        ("paths over edges between them (rule T9)", paths.over.len() as u64),
        ("triangles and vertices with the stated index (rule T10)", (data.triangles.len() + data.vertex_count) as u64),
    ])
}

/// The end of rule T10, which follows from the rest of it.
fn check_sum(section: &SectionData, characteristic: i64) -> Checked {
    let sum: i128 =
        section.triangle_indices.iter().chain(&section.vertex_indices).map(|&index| i128::from(index)).sum();
    let message = format!("the indices add up to {sum}, not {characteristic}");
    check(sum == i128::from(characteristic), "T10", &message, &[], &[])
}

/// Where a section meets fibres, and its paths by the ends of their edges, the lesser first.
struct Paths<'a> {
    layers: u32,
    levels: &'a [u32],
    over: HashMap<[u32; 2], &'a [u32]>,
}

impl<'a> Paths<'a> {
    /// Rule T9, but for the steps of the paths.
    fn new(data: &BundleData, section: &'a SectionData, base: &Complex) -> Checked<Self> {
        let mut paths = Self { layers: data.layers, levels: &section.levels, over: HashMap::new() };
        if let Some(vertex) = section.levels.iter().position(|&level| level > data.layers) {
            return Err(refuted("T9", "there is no such level", &[], &[vertex as u32]));
        }
        let mut rest = section.path_vertices.as_slice();
        for &length in &section.path_lengths {
            let path = rest.split_off(..length as usize).unwrap_or_default();
            let (Some(&first), Some(&last)) = (path.first(), path.last()) else {
                return Err(refuted("T9", "a path has no vertices", &[], &[]));
            };
            let ends = [first, last].map(|vertex| vertex / data.layers);
            let is_met = [first, last].into_iter().zip(ends).all(|(end, vertex)| paths.start(vertex) == Some(end));
            check(is_met, "T9", "a path ends elsewhere than at the section", &[], &ends)?;
            let is_new = ends[0] < ends[1] && paths.over.insert(ends, path).is_none();
            check(is_new, "T9", "a path does not go to a greater vertex, or its edge has two", &[], &ends)?;
        }
        check(rest.is_empty(), "T9", "there are vertices after the last path", &[], &[])?;
        let mut count = 0;
        for (slot, _) in base.inner_facets() {
            let face = base.facet(slot);
            let ends = [face[0].min(face[1]), face[0].max(face[1])];
            let met = ends.iter().filter(|&&vertex| paths.start(vertex).is_some()).count();
            check(met > 0, "T9", "neighbours are both without a level", &[slot / 3], &ends)?;
            let has_path = paths.over.contains_key(&ends);
            check(has_path == (met == 2), "T9", "an edge between levels has no path", &[slot / 3], &ends)?;
            count += usize::from(has_path);
        }
        check(count == paths.over.len(), "T9", "a path is over no edge", &[], &[])?;
        Ok(paths)
    }

    /// The vertex of the bundle where the section meets the fibre over a vertex of the base.
    fn start(&self, vertex: u32) -> Option<u32> {
        let level = self.levels.get(vertex as usize).filter(|&&level| level < self.layers)?;
        Some(vertex * self.layers + level)
    }

    /// How often the paths round a triangle turn about the solid torus over it; with any path to level 0 of a corner that
    /// the section does not meet, which is the same from both sides of its edge.
    fn index(&self, triangle: usize, corners: [u32; 3], tetrahedra: &[[u32; 4]]) -> Checked<i64> {
        let no_torus = || refuted("T10", "the tetrahedra do not follow one another round a torus", &[triangle], &[]);
        let torus = Torus::new(corners, self.layers, tetrahedra).ok_or_else(no_torus)?;
        let length = |path: &[u32]| {
            let message = "vertices that follow on a path have no tetrahedron in common over a triangle at its edge";
            let mut steps = path
                .windows(2)
                .map(|step| torus.step([step[0], step[1]]).ok_or_else(|| refuted("T9", message, &[triangle], step)));
            steps.try_fold(0, |sum, step| Checked::Ok(sum + step?))
        };
        let mut sum = 0;
        for k in 0..3 {
            let [from, to] = [corners[k], corners[(k + 1) % 3]];
            sum += match (self.start(from), self.start(to)) {
                (Some(start), None) => length(&torus.spoke(start, to).ok_or_else(no_torus)?)?,
                (None, Some(start)) => -length(&torus.spoke(start, from).ok_or_else(no_torus)?)?,
                _ if from < to => length(self.over[&[from, to]])?,
                _ => -length(self.over[&[to, from]])?,
            };
        }
        let fibre: Vec<u32> = (0..=self.layers).map(|level| corners[0] * self.layers + level % self.layers).collect();
        let turn = length(&fibre)?;
        let is_turn = turn.unsigned_abs() == 3 * u64::from(self.layers) && sum % turn == 0;
        if is_turn { Ok(sum / turn) } else { Err(no_torus()) }
    }
}

/// The tetrahedra over a triangle, by the numbers of their vertices.
struct Torus {
    corners: [u32; 3],
    layers: u32,
    /// Of level `j` over corner `k`, in place `N k + j`.
    numbers: Vec<i64>,
}

impl Torus {
    fn new(corners: [u32; 3], layers: u32, tetrahedra: &[[u32; 4]]) -> Option<Self> {
        const NONE: i64 = -1;
        let mut torus = Self { corners, layers, numbers: vec![NONE; 3 * layers as usize] };
        let ring = ring(tetrahedra)?;
        for (number, &here) in (0..).zip(&ring) {
            let before = tetrahedra[ring[(number + ring.len() - 1) % ring.len()]];
            let mut new = tetrahedra[here].into_iter().filter(|vertex| !before.contains(vertex));
            let place = torus.place(new.next()?)?;
            (std::mem::replace(&mut torus.numbers[place], number as i64) == NONE).then_some(())?;
        }
        // Each has its own new vertex and the three before.
        let is_behind = |number: usize, vertex: u32| {
            let place = torus.place(vertex)?;
            Some((number as i64 - torus.numbers[place]).rem_euclid(3 * i64::from(layers)) <= 3)
        };
        let mut all = ring.iter().enumerate().flat_map(|(number, &here)| tetrahedra[here].map(|v| (number, v)));
        all.all(|(number, vertex)| is_behind(number, vertex) == Some(true)).then_some(torus)
    }

    fn place(&self, vertex: u32) -> Option<usize> {
        let corner = self.corners.iter().position(|&corner| corner == vertex / self.layers)?;
        Some(corner * self.layers as usize + (vertex % self.layers) as usize)
    }

    /// What the number grows by from a vertex to another that is joined with it.
    fn step(&self, [from, to]: [u32; 2]) -> Option<i64> {
        let count = 3 * i64::from(self.layers);
        let up = (self.numbers[self.place(to)?] - self.numbers[self.place(from)?]).rem_euclid(count);
        [up, up - count].into_iter().find(|step| (1..=3).contains(&step.abs()))
    }

    /// Up the fibre from a vertex to the first that is joined with level 0 over another corner, and on to this.
    fn spoke(&self, start: u32, to: u32) -> Option<Vec<u32>> {
        let (vertex, end) = (start / self.layers, to * self.layers);
        let mut path = Vec::new();
        for level in (0..self.layers).map(|up| (start + up) % self.layers) {
            path.push(vertex * self.layers + level);
            if self.step([vertex * self.layers + level, end]).is_some() {
                path.push(end);
                return Some(path);
            }
        }
        None
    }
}

/// Tetrahedra in the order in which they share faces; nothing where they are no ring.
fn ring(tetrahedra: &[[u32; 4]]) -> Option<Vec<usize>> {
    let mut faces = Vec::with_capacity(4 * tetrahedra.len());
    for (number, corners) in tetrahedra.iter().enumerate() {
        for omitted in 0..4 {
            let mut face = [1, 2, 3].map(|k| corners[(omitted + k) % 4]);
            face.sort_unstable();
            faces.push((face, number));
        }
    }
    faces.sort_unstable();
    let mut beside = vec![[None; 2]; tetrahedra.len()];
    for pair in faces.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        for (here, other) in [(pair[0].1, pair[1].1), (pair[1].1, pair[0].1)] {
            *beside[here].iter_mut().find(|slot| slot.is_none())? = Some(other);
        }
    }
    let (mut order, mut before) = (vec![0], beside.first()?[0]?);
    while order.len() <= tetrahedra.len() {
        let here = *order.last()?;
        let next = beside[here].into_iter().flatten().find(|&next| next != before)?;
        if next == 0 {
            break;
        }
        order.push(next);
        before = here;
    }
    (order.len() == tetrahedra.len()).then_some(order)
}

/// Tetrahedra that are no ring are refuted by T5 before, and wrong sums by the rest of T10: their negative controls are here.
#[cfg(test)]
mod tests {
    use super::*;

    /// Three layers over a triangle, numbered as theorem 2 does: vertex `x` is level `x / 3` over corner `x % 3`.
    fn torus() -> Vec<[u32; 4]> {
        (0..9).map(|first| [0, 1, 2, 3].map(|step| (first + step) % 9).map(|x| x % 3 * 3 + x / 3)).collect()
    }

    #[test]
    fn tetrahedra_that_are_no_ring_are_found() {
        let found = |tetrahedra: &[[u32; 4]]| Torus::new([0, 1, 2], 3, tetrahedra);
        let whole = torus();
        let steps = found(&whole).map(|torus| [torus.step([0, 1]), torus.step([0, 3]), torus.step([0, 0])]);
        assert!(matches!(steps, Some([Some(3), Some(1), None] | [Some(-3), Some(-1), None])), "{steps:?}");
        assert!(found(&whole[1..]).is_none(), "open");
        let mut other = whole.clone();
        other[4] = other[3];
        assert!(found(&other).is_none(), "one twice");
        let elsewhere = whole.iter().map(|four| four.map(|v| v + 9)).collect::<Vec<_>>();
        assert!(found(&elsewhere).is_none(), "over other corners");
        let fan: Vec<[u32; 4]> = (0..7).map(|k| [7, 8, k, (k + 1) % 7]).collect();
        assert!(found(&fan).is_none(), "round an edge");
    }

    #[test]
    fn indices_add_up_to_the_characteristic_or_are_refuted() {
        let section = |triangle_indices, vertex_indices| SectionData {
            levels: vec![],
            path_lengths: vec![],
            path_vertices: vec![],
            triangle_indices,
            vertex_indices,
        };
        assert!(check_sum(&section(vec![3, -2], vec![0, 1]), 2).is_ok());
        assert!(check_sum(&section(vec![3, -2], vec![0, 0]), 2).is_err());
        assert!(check_sum(&section(vec![i64::MAX, i64::MAX], vec![2, 2]), 2).is_err());
    }
}
