//! Rules 1 to 6, and the regions of rule 8: the leaves of a simplicial foliation.
//!
//! *Theorem* (`docs/certificate-format-v1.md`). Under the rules 1, 2, 4, 5 and 6 the foliated complex is
//! homeomorphic to `source region x [0, 1]` by `p -> (start of its leaf, length behind p / length of the leaf)`.

use crate::complex::{Complex, is_same_face, place};
use crate::links::{Shape, check_manifold, shape};
use crate::manifest::Target;
use crate::map_file::FoliationData;
use crate::section::check_section;
use crate::verdict::{Checked, refuted};

/// A foliation with the facets by which leaves begin and end.
pub(crate) struct Foliation<'a> {
    pub(crate) complex: &'a Complex,
    data: &'a FoliationData,
    centre: Option<usize>,
    /// Slots by which leaves begin.
    pub(crate) source: Vec<usize>,
    /// Slots by which leaves end.
    sink: Vec<usize>,
    /// Slots in the boundary that leaves do not cross.
    parallel: Vec<usize>,
}

/// Checks all rules of a foliation; `complex` is the refined one.
pub(crate) fn check_foliation(
    complex: &Complex,
    data: &FoliationData,
    centre: Option<u64>,
    target: Target,
) -> Checked<Vec<(&'static str, u64)>> {
    let centre = centre.map(|c| usize::try_from(c).unwrap_or(usize::MAX));
    if let Some(c) = centre.filter(|&c| c >= complex.count()) {
        return refuted("3", format!("the centre, cell {c}, does not exist"), &[], &[]);
    }
    let mut foliation = Foliation { complex, data, centre, source: vec![], sink: vec![], parallel: vec![] };
    foliation.check_rows()?;
    let crossings = foliation.check_crossings()?;
    foliation.sort_single_facets();
    foliation.check_radial(target)?;
    foliation.check_acyclic()?;
    let on_source = foliation.vertices_of(&foliation.source);
    let on_sink = foliation.vertices_of(&foliation.sink);
    let [vertices, edges] = complex.small_faces();
    let bipolar = foliation.check_bipolar(edges)? + foliation.check_bipolar(vertices)?;
    foliation.check_regions_apart(&on_source, &on_sink)?;
    let region = foliation.check_region_shapes(target)?;
    check_section(&foliation, &region, data, target)?;
    Ok(vec![
        ("direction rows that sum to zero, with lengths of at least 1 (rule 1)", complex.count() as u64),
        ("facets crossed from one cell into the next (rule 2)", crossings),
        ("source facets", foliation.source.len() as u64),
        ("sink facets", foliation.sink.len() as u64),
        ("parallel facets", foliation.parallel.len() as u64),
        ("vertices and edges that are locally bipolar (rule 5)", bipolar),
        ("vertices of the section (rule 7)", data.section_vertices.len() as u64),
    ])
}

impl Foliation<'_> {
    fn sign(&self, slot: usize) -> i8 {
        self.data.directions[slot].signum()
    }

    fn row(&self, c: usize) -> &[i8] {
        &self.data.directions[c * self.complex.size..(c + 1) * self.complex.size]
    }

    fn foliated_cells(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.complex.count()).filter(|&c| Some(c) != self.centre)
    }

    /// The same facet as a slot of the foliated cell beyond.
    fn across(&self, slot: usize) -> Option<usize> {
        self.complex.across(slot).filter(|&other| Some(other / self.complex.size) != self.centre)
    }

    /// Rule 1: rows sum to zero, only the centre's row is zero, lengths are at least 1.
    fn check_rows(&self) -> Checked {
        for c in 0..self.complex.count() {
            let cell = self.complex.cell(c);
            if self.row(c).iter().map(|&d| i32::from(d)).sum::<i32>() != 0 {
                return refuted("1", format!("the direction of cell {c} does not sum to zero"), &[c], cell);
            }
            if self.row(c).iter().all(|&d| d == 0) != (Some(c) == self.centre) {
                return refuted("1", format!("only the centre has direction zero, not cell {c}"), &[c], cell);
            }
            if self.data.lengths[c] == 0 {
                return refuted("1", format!("the length of cell {c} is zero"), &[c], cell);
            }
        }
        Ok(())
    }

    /// Rule 2: leaves cross every facet between two foliated cells. (At most two cells: see the complex.)
    fn check_crossings(&self) -> Checked<u64> {
        let mut count = 0;
        for (a, b) in self.complex.inner_facets() {
            let (c, d) = (a / self.complex.size, b / self.complex.size);
            if Some(c) == self.centre || Some(d) == self.centre {
                continue;
            }
            if self.sign(a) == 0 || self.sign(a) != -self.sign(b) {
                let message = format!("no leaf crosses the facet between cells {c} and {d}");
                let (facet, length) = self.complex.facet(a);
                return refuted("2", message, &[c, d], &facet[..length]);
            }
            count += 1;
        }
        Ok(count)
    }

    /// Sorts the facets with one foliated cell into source, sink and parallel ones.
    fn sort_single_facets(&mut self) {
        let size = self.complex.size;
        let slots = self.foliated_cells().flat_map(|c| size * c..size * (c + 1));
        let single: Vec<usize> = slots.filter(|&slot| self.across(slot).is_none()).collect();
        let with_sign = |sign| single.iter().copied().filter(|&slot| self.sign(slot) == sign).collect();
        (self.source, self.sink, self.parallel) = (with_sign(1), with_sign(-1), with_sign(0));
    }

    /// Rule 3: around a centre, leaves run between its facets and the boundary, all of both.
    fn check_radial(&self, target: Target) -> Checked {
        let Some(centre) = self.centre else { return Ok(()) };
        let size = self.complex.size;
        if let Some(i) = (0..size).find(|&i| self.complex.beyond(centre, i).is_none()) {
            let (facet, length) = self.complex.facet(size * centre + i);
            return refuted("3", "a facet of the centre lies in the boundary", &[centre], &facet[..length]);
        }
        for &slot in self.source.iter().chain(&self.sink).chain(&self.parallel) {
            let at_centre = self.complex.across(slot).is_some(); // then the centre is the cell beyond
            let inwards = if target == Target::Ball { at_centre } else { !at_centre };
            if self.sign(slot) != if inwards { 1 } else { -1 } {
                let (facet, length) = self.complex.facet(slot);
                let message =
                    "a facet of the centre or the boundary is not the source or sink that the target asks for";
                return refuted("3", message, &[slot / size], &facet[..length]);
            }
        }
        Ok(())
    }

    /// Rule 4: no cycle of cells, each followed by the next across an outflow facet.
    fn check_acyclic(&self) -> Checked {
        let size = self.complex.size;
        let facets_of = |c: usize| size * c..size * (c + 1);
        let mut waiting = vec![0u8; self.complex.count()];
        for c in self.foliated_cells() {
            waiting[c] = facets_of(c).filter(|&s| self.sign(s) > 0 && self.across(s).is_some()).count() as u8;
        }
        let mut ready: Vec<usize> = self.foliated_cells().filter(|&c| waiting[c] == 0).collect();
        while let Some(c) = ready.pop() {
            for slot in facets_of(c).filter(|&slot| self.sign(slot) < 0) {
                let Some(next) = self.across(slot).map(|other| other / size) else { continue };
                waiting[next] -= 1; // counted above: rule 2 makes the facet an inflow facet of `next`
                if waiting[next] == 0 {
                    ready.push(next);
                }
            }
        }
        let Some(start) = self.foliated_cells().find(|&c| waiting[c] > 0) else { return Ok(()) };
        let before = |c: usize| {
            let inflow = facets_of(c).filter(|&slot| self.sign(slot) > 0);
            inflow.filter_map(|slot| self.across(slot)).map(|other| other / size).find(|&d| waiting[d] > 0)
        };
        // A waiting cell has a waiting cell before it; after as many steps as cells we are on a cycle.
        let walk = |c: usize| before(c).unwrap_or(c);
        let on_cycle = (0..self.complex.count()).fold(start, |c, _| walk(c));
        let mut cycle = vec![on_cycle];
        let mut c = walk(on_cycle);
        while c != on_cycle {
            cycle.push(c);
            c = walk(c);
        }
        refuted("4", format!("leaves could run in a circle through {} cells", cycle.len()), &cycle, &[])
    }

    fn vertices_of(&self, slots: &[usize]) -> Vec<bool> {
        let mut on = vec![false; self.complex.vertex_count];
        for &slot in slots {
            let (facet, length) = self.complex.facet(slot);
            facet[..length].iter().for_each(|&v| on[v as usize] = true);
        }
        on
    }

    /// Rule 5: around each vertex, and each edge of a tetrahedron, one cell or the source region comes first, and
    /// one cell or the sink region last. Returns the number of faces.
    fn check_bipolar(&self, kind: &[u8]) -> Checked<u64> {
        let (size, mut count) = (self.complex.size, 0);
        for group in self.complex.sorted_faces(kind).chunk_by(is_same_face) {
            let around: Vec<(usize, u8)> = group
                .iter()
                .map(|&key| (place(key) / kind.len(), kind[place(key) % kind.len()]))
                .filter(|&(c, _)| Some(c) != self.centre)
                .collect();
            count += u64::from(!around.is_empty());
            for (sign, what) in [(1, "begin"), (-1, "end")].iter().take_while(|_| !around.is_empty()) {
                // The facets of a cell that contain the face are those opposite its vertices that are not in the face.
                let slots =
                    |&(c, mask): &(usize, u8)| (0..size).filter(move |i| mask >> i & 1 == 0).map(move |i| size * c + i);
                let with_sign = |&slot: &usize| self.sign(slot) == *sign;
                let on_region = around.iter().flat_map(slots).filter(with_sign).any(|slot| self.across(slot).is_none());
                let first = around.iter().filter(|&cell| !slots(cell).any(|slot| with_sign(&slot))).count();
                if first + usize::from(on_region) != 1 {
                    let cells: Vec<usize> = around.iter().map(|&(c, _)| c).collect();
                    let (face, length) = self.complex.face(around[0].0, around[0].1);
                    let message = format!("leaves {what} in {} places around a face", first + usize::from(on_region));
                    return refuted("5", message, &cells, &face[..length]);
                }
            }
        }
        Ok(count)
    }

    /// Rule 6: no vertex on both regions, and neither region is empty.
    fn check_regions_apart(&self, on_source: &[bool], on_sink: &[bool]) -> Checked {
        if self.source.is_empty() || self.sink.is_empty() {
            return refuted("6", "there is no source facet or no sink facet", &[], &[]);
        }
        if let Some(v) = (0..on_source.len()).find(|&v| on_source[v] && on_sink[v]) {
            return refuted("6", format!("vertex {v} lies on a source and a sink facet"), &[], &[v as u32]);
        }
        Ok(())
    }

    /// Rule 8, last sentence: the regions have the topology of the target's. Returns the source region.
    fn check_region_shapes(&self, target: Target) -> Checked<Complex> {
        let [arc, two_arcs, circle] = [(1, 1, 2), (2, 2, 4), (1, 0, 0)];
        let [disk, annulus, sphere, nothing] = [(1, 1, 1), (1, 0, 2), (1, 2, 0), (0, 0, 0)];
        let (end, wall) = match target {
            Target::Square => (arc, two_arcs),
            Target::Cube => (disk, annulus),
            Target::Disk => (circle, nothing),
            Target::Ball => (sphere, nothing),
        };
        let regions = [("source", &self.source, end), ("sink", &self.sink, end), ("parallel", &self.parallel, wall)];
        for (name, slots, (components, euler, boundaries)) in regions {
            let region = self.complex.facet_complex(slots.iter().copied(), "8")?;
            let found = if region.size == 2 {
                shape(&region, 0, "8")? // at most two edges at a vertex: already a manifold
            } else {
                check_manifold(&region, "8", &format!("{name} region"))?
            };
            let expected = Shape { components, euler, boundaries };
            if found != expected {
                let message = format!("the {name} region has {found:?} instead of {expected:?}");
                return refuted("8", message, &[], &[]);
            }
        }
        self.complex.facet_complex(self.source.iter().copied(), "8")
    }
}
