//! Rules 1 to 6, and the regions of rule 8: the leaves of a simplicial foliation.
//!
//! *Theorem* (`docs/certificate-format-v1.md`). Under the rules 1, 2, 4, 5 and 6 the foliated complex is
//! homeomorphic to `source region x [0, 1]` by `p -> (start of its leaf, length behind p / length of the leaf)`.

use crate::complex::{Complex, is_same_face, place};
use crate::links::{Shape, check_manifold};
use crate::manifest::Target;
use crate::map_file::FoliationData;
use crate::section::check_section;
use crate::verdict::{Checked, check, refuted};

/// The cells with the directions of their leaves.
struct Foliation<'a> {
    complex: &'a Complex,
    data: &'a FoliationData,
    centre: Option<usize>,
}

/// Checks all rules of a foliation; `complex` is the refined one.
pub(crate) fn check_foliation(
    complex: &Complex,
    data: &FoliationData,
    centre: Option<usize>,
    target: Target,
) -> Checked<Vec<(&'static str, u64)>> {
    check(centre.is_none_or(|c| c < complex.count()), "3", "the centre does not exist", &[], &[])?;
    let foliation = Foliation { complex, data, centre };
    foliation.check_rows()?;
    let crossings = foliation.check_crossings()?;
    let regions = [1, -1, 0].map(|sign| foliation.single_facets(sign));
    foliation.check_radial(&regions, target)?;
    foliation.check_acyclic()?;
    let [vertices, edges] = complex.small_faces();
    let bipolar = foliation.check_bipolar(edges)? + foliation.check_bipolar(vertices)?;
    foliation.check_regions_apart(&regions)?;
    let source = foliation.check_region_shapes(&regions, target)?;
    check_section(&source, data, target)?;
    Ok(vec![
        ("direction rows that sum to zero, with lengths of at least 1 (rule 1)", complex.count() as u64),
        ("facets crossed from one cell into the next (rule 2)", crossings),
        ("source facets", regions[0].len() as u64),
        ("sink facets", regions[1].len() as u64),
        ("parallel facets", regions[2].len() as u64),
        ("vertices and edges that are locally bipolar (rule 5)", bipolar),
        ("vertices of the section (rule 7)", data.section_vertices.len() as u64),
    ])
}

impl Foliation<'_> {
    /// Positive where leaves enter the slot's cell, negative where they leave it.
    fn sign(&self, slot: usize) -> i8 {
        self.data.directions[slot].signum()
    }

    /// The same facet as a slot of the foliated cell beyond.
    fn across(&self, slot: usize) -> Option<usize> {
        self.complex.across(slot).filter(|other| !self.centre.is_some_and(|c| self.complex.slots(c).contains(other)))
    }

    /// The foliated cells beyond the facets of a cell that have this sign.
    fn beyond(&self, c: usize, sign: i8) -> impl Iterator<Item = usize> {
        let slots = self.complex.slots(c).filter(move |&slot| self.sign(slot) == sign);
        slots.filter_map(|slot| self.across(slot)).map(|other| other / self.complex.size)
    }

    /// The slots of this sign that have no other foliated cell: a region, by which leaves begin (1), end (-1), or pass (0).
    fn single_facets(&self, sign: i8) -> Vec<usize> {
        let cells = (0..self.complex.count()).filter(|&c| Some(c) != self.centre);
        let slots = cells.flat_map(|c| self.complex.slots(c));
        slots.filter(|&slot| self.sign(slot) == sign && self.across(slot).is_none()).collect()
    }

    /// Rule 1: rows sum to zero, only the centre's row is zero, lengths are at least 1.
    fn check_rows(&self) -> Checked {
        let rows = self.data.directions.chunks_exact(self.complex.size);
        for (c, (row, cell)) in rows.zip(self.complex.cells()).enumerate() {
            let sum: i32 = row.iter().map(|&d| i32::from(d)).sum();
            check(sum == 0, "1", "the direction of a cell does not sum to zero", &[c], cell)?;
            let is_rest = row.iter().all(|&d| d == 0);
            check(is_rest == (Some(c) == self.centre), "1", "only the centre has direction zero", &[c], cell)?;
            check(self.data.lengths[c] > 0, "1", "the length of a cell is zero", &[c], cell)?;
        }
        Ok(())
    }

    /// Rule 2: leaves cross every facet between two foliated cells. (At most two cells: see the complex.)
    fn check_crossings(&self) -> Checked<u64> {
        let is_foliated = |&(a, b): &(usize, usize)| self.across(a).is_some() && self.across(b).is_some();
        let mut count = 0;
        for (a, b) in self.complex.inner_facets().filter(is_foliated) {
            if self.sign(a) == 0 || self.sign(a) != -self.sign(b) {
                let cells = [a, b].map(|slot| slot / self.complex.size);
                return Err(refuted("2", "no leaf crosses the facet of two cells", &cells, &self.complex.facet(a)));
            }
            count += 1;
        }
        Ok(count)
    }

    /// Rule 3: around a centre, leaves run between its facets and the boundary, all of both.
    fn check_radial(&self, regions: &[Vec<usize>; 3], target: Target) -> Checked {
        let Some(centre) = self.centre else { return Ok(()) };
        let is_inside = self.complex.slots(centre).all(|slot| self.complex.across(slot).is_some());
        check(is_inside, "3", "a facet of the centre lies in the boundary", &[centre], self.complex.cell(centre))?;
        for &slot in regions.iter().flatten() {
            let is_at_centre = self.complex.across(slot).is_some(); // then the centre is the cell beyond
            let is_source = is_at_centre == (target == Target::Ball);
            let is_right = self.sign(slot) == if is_source { 1 } else { -1 };
            let message = "a facet of the centre or boundary is not the source or sink that the target asks for";
            check(is_right, "3", message, &[slot / self.complex.size], &self.complex.facet(slot))?;
        }
        Ok(())
    }

    /// Rule 4: no cycle of cells, each followed by the next across an outflow facet.
    fn check_acyclic(&self) -> Checked {
        let count = self.complex.count();
        let mut waiting: Vec<u8> = (0..count).map(|c| self.beyond(c, 1).count() as u8).collect();
        let mut ready: Vec<usize> = (0..count).filter(|&c| waiting[c] == 0).collect();
        while let Some(c) = ready.pop() {
            for next in self.beyond(c, -1) {
                waiting[next] -= 1; // counted above: rule 2 makes the facet an inflow facet of `next`
                if waiting[next] == 0 {
                    ready.push(next);
                }
            }
        }
        let Some(start) = (0..count).find(|&c| waiting[c] > 0) else { return Ok(()) };
        // A waiting cell has a waiting cell before it; after as many steps as cells we are on a cycle.
        let before = |c: usize| self.beyond(c, 1).find(|&d| waiting[d] > 0).unwrap_or(c);
        let mut cycle = vec![(0..count).fold(start, |c, _| before(c))];
        let mut c = before(cycle[0]);
        while c != cycle[0] {
            cycle.push(c);
            c = before(c);
        }
        Err(refuted("4", "leaves could run in a circle", &cycle, &[]))
    }

    /// Rule 5: around each vertex, and each edge of a tetrahedron, one cell or the source region comes first, and
    /// one cell or the sink region last. Returns the number of faces.
    fn check_bipolar(&self, kind: &[u8]) -> Checked<u64> {
        let (size, mut count) = (self.complex.size, 0);
        for group in self.complex.sorted_faces(kind).chunk_by(is_same_face) {
            let cells = group.iter().map(|&key| (place(key) / kind.len(), kind[place(key) % kind.len()]));
            let around: Vec<(usize, u8)> = cells.filter(|&(c, _)| Some(c) != self.centre).collect();
            let Some(&(c, mask)) = around.first() else { continue };
            count += 1;
            for (sign, what) in [(1, "begin"), (-1, "end")] {
                // The facets of a cell that contain the face are those opposite its vertices that are not in the face.
                let slots = |&(c, mask): &(usize, u8)| {
                    let slots = (0..size).filter(move |i| mask >> i & 1 == 0).map(move |i| size * c + i);
                    slots.filter(move |&slot| self.sign(slot) == sign)
                };
                let first = around.iter().filter(|&cell| slots(cell).next().is_none()).count();
                let is_on_region = around.iter().flat_map(slots).any(|slot| self.across(slot).is_none());
                let places = first + usize::from(is_on_region);
                if places != 1 {
                    let cells: Vec<usize> = around.iter().map(|&(c, _)| c).collect();
                    let message = format!("leaves {what} in {places} places around a face");
                    return Err(refuted("5", message, &cells, &self.complex.face(c, mask)));
                }
            }
        }
        Ok(count)
    }

    /// Rule 6: no vertex on both regions, and neither region is empty.
    fn check_regions_apart(&self, [source, sink, _]: &[Vec<usize>; 3]) -> Checked {
        let exist = !source.is_empty() && !sink.is_empty();
        check(exist, "6", "there is no source facet or no sink facet", &[], &[])?;
        let vertices_of = |slots: &[usize]| self.complex.vertices_of(slots.iter().map(|&s| self.complex.facet(s)));
        for (v, (on_source, on_sink)) in (0..).zip(vertices_of(source).into_iter().zip(vertices_of(sink))) {
            check(!(on_source && on_sink), "6", "a vertex lies on a source and a sink facet", &[], &[v])?;
        }
        Ok(())
    }

    /// Rule 8, last sentence: the regions have the topology of the target's. Returns the source region.
    fn check_region_shapes(&self, regions: &[Vec<usize>; 3], target: Target) -> Checked<Complex> {
        let [arc, two_arcs, circle] = [(1, 1, 2), (2, 2, 4), (1, 0, 0)];
        let [disk, annulus, sphere, nothing] = [(1, 1, 1), (1, 0, 2), (1, 2, 0), (0, 0, 0)];
        let (end, wall) = match target {
            Target::Square => (arc, two_arcs),
            Target::Cube => (disk, annulus),
            Target::Disk => (circle, nothing),
            Target::Ball => (sphere, nothing),
            _ => (nothing, nothing), // shells are no foliations
        };
        let expected = [("source region", end), ("sink region", end), ("parallel part", wall)];
        for (slots, (name, (components, euler, boundaries))) in regions.iter().zip(expected) {
            let found = check_manifold(&self.complex.facet_complex(slots.iter().copied())?, name, "8")?;
            let expected = Shape { components, euler, boundaries };
            let message = format!("the {name} has {found:?} instead of {expected:?}");
            check(found == expected, "8", &message, &[], &[])?;
        }
        self.complex.facet_complex(regions[0].iter().copied())
    }
}
