//! All triangulations of a few tetrahedra.
//!
//! Every connected gluing has a labelling in which a face, unless it was glued before, leads to a new tetrahedron by
//! the identity or to one that is known (see [`signature`](mod@crate::signature)). These labellings are gone through
//! one by one; of those that are the same up to names, one is kept by its signature. For three tetrahedra they are
//! 24,057, in place of the 6,928,416 labelled gluings.

use crate::link::Links;
use crate::permutation::Permutation;
use crate::signature::signature_and_automorphisms;
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;
use std::collections::BTreeMap;
use thiserror::Error;

/// What the links of all vertices have to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AllowedLinks {
    /// Any closed surface.
    Any,
    /// Surfaces of genus 1 and above: cut off, they can be cusps and geodesic boundary.
    TorusOrHigher,
    /// Surfaces of genus 2 and above: cut off, they can be geodesic boundary.
    Higher,
}

impl AllowedLinks {
    fn least_genus(self) -> usize {
        match self {
            Self::Any => 0,
            Self::TorusOrHigher => 1,
            Self::Higher => 2,
        }
    }
}

/// A triangulation that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enumerated {
    /// Its signature.
    pub signature: String,
    /// The triangulation, labelled as its signature has it.
    pub triangulation: Triangulation,
    /// In how many ways it is like itself, mirror images counted.
    pub automorphisms: usize,
    /// The genera of its links, ascending.
    pub genera: Vec<usize>,
}

impl Enumerated {
    /// The number of gluings with odd permutations alone that are this one, its mirror image counted, when tetrahedra
    /// and corners have names: names can be chosen in `n! 2 12^n` ways, and automorphisms make some of them equal.
    ///
    /// ```
    /// use homeo_manifold::{AllowedLinks, enumerate};
    /// // One tetrahedron: three ways to pair its faces, three odd permutations for each of two pairs.
    /// let all = enumerate(1, AllowedLinks::Any)?;
    /// assert_eq!(all.iter().map(|found| found.labelled_count()).sum::<u128>(), 27);
    /// # Ok::<(), homeo_manifold::EnumerationError>(())
    /// ```
    pub fn labelled_count(&self) -> u128 {
        let names = (1..=self.triangulation.len() as u128).fold(2, |product, n| product * n * 12);
        names / self.automorphisms as u128
    }
}

/// Why there is no enumeration.
#[derive(Debug, Error, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum EnumerationError {
    #[error("{tetrahedra} tetrahedra are too many to go through: at most {most}")]
    TooMany { tetrahedra: usize, most: usize },
}

/// Each tetrahedron multiplies the time by 50 and more.
const MOST_TETRAHEDRA: usize = 6;

/// All connected closed orientable triangulations of some tetrahedra, up to names and mirror images, with links as
/// wanted; by signature, ascending.
///
/// In an orientable triangulation no edge is glued to itself end for end: going round it, one would come back to a
/// tetrahedron with the edge turned, and the sense of going round kept, so that space is turned.
///
/// Cost: 24 thousand labellings for three tetrahedra, 1.3 million for four, 80 million for five: tenths of a
/// second, under half a minute, half an hour.
///
/// # Errors
/// [`EnumerationError::TooMany`] above six tetrahedra.
///
/// # Example
/// ```
/// use homeo_manifold::{AllowedLinks, enumerate};
/// let found = enumerate(2, AllowedLinks::Higher)?;
/// assert_eq!(found.len(), 8);
/// assert!(found.iter().any(|found| found.signature == "cPcbbbihq"));
/// # Ok::<(), homeo_manifold::EnumerationError>(())
/// ```
pub fn enumerate(tetrahedra: usize, links: AllowedLinks) -> Result<Vec<Enumerated>, EnumerationError> {
    if tetrahedra > MOST_TETRAHEDRA {
        return Err(EnumerationError::TooMany { tetrahedra, most: MOST_TETRAHEDRA });
    }
    let mut found = BTreeMap::new();
    for_each_labelling(tetrahedra, &mut |triangulation| {
        let Some(genera) = genera(triangulation, links.least_genus()) else { return };
        let Some((signature, automorphisms)) = signature_and_automorphisms(triangulation) else { return };
        // The first labelling met need not be that of the signature.
        found.entry(signature).or_insert((automorphisms, genera));
    });
    let decoded = found.into_iter().filter_map(|(signature, (automorphisms, genera))| {
        let triangulation = crate::signature::from_signature(&signature).ok()?;
        Some(Enumerated { signature, triangulation, automorphisms, genera })
    });
    Ok(decoded.collect())
}

/// The genera of the links, ascending, if none is too low.
fn genera(triangulation: &Triangulation, least: usize) -> Option<Vec<usize>> {
    let skeleton = Skeleton::new(triangulation);
    // The Euler characteristics of the links add up to twice the edges less the tetrahedra.
    let (edges, vertices) = (skeleton.edges().len() as i64, skeleton.vertex_count() as i64);
    if edges - triangulation.len() as i64 > vertices * (1 - least as i64) {
        return None;
    }
    let links = Links::new(triangulation, &skeleton);
    let mut genera = links.all().iter().map(|link| link.genus()).collect::<Option<Vec<_>>>()?;
    genera.sort_unstable();
    (genera.first().is_some_and(|&lowest| lowest >= least)).then_some(genera)
}

/// Calls back with each closed connected oriented gluing in each labelling that its signature chooses from.
fn for_each_labelling(tetrahedra: usize, visit: &mut impl FnMut(&Triangulation)) {
    if tetrahedra > 0 {
        let permutations = Permutation::all().collect();
        let triangulation = Triangulation::new(tetrahedra);
        Labelling { triangulation, agrees: vec![true; tetrahedra], known: 1, permutations }.go_on(0, visit);
    }
}

struct Labelling {
    triangulation: Triangulation,
    /// Whether the corners of each known tetrahedron agree with the orientation of the first.
    agrees: Vec<bool>,
    known: u32,
    permutations: Vec<Permutation>,
}

impl Labelling {
    /// Glues the faces from a place on in all ways; `place` is four times the tetrahedron, and the face.
    fn go_on(&mut self, place: u32, visit: &mut impl FnMut(&Triangulation)) {
        let is_open = |place: &u32| self.triangulation.neighbour(place / 4, (place % 4) as u8).is_none();
        let Some(place) = (place..4 * self.known).find(is_open) else {
            if self.known as usize == self.triangulation.len() {
                visit(&self.triangulation);
            }
            return;
        };
        if (self.known as usize) < self.triangulation.len() {
            // The identity reverses orientation: the new tetrahedron is on the other side of the face.
            self.agrees[self.known as usize] = !self.agrees[(place / 4) as usize];
            self.known += 1;
            self.glued(place, self.known - 1, Permutation::IDENTITY, visit);
            self.known -= 1;
        }
        for other in place + 1..4 * self.known {
            let (there, face) = (other / 4, (other % 4) as u8);
            if self.triangulation.neighbour(there, face).is_some() {
                continue;
            }
            let is_odd = self.agrees[(place / 4) as usize] == self.agrees[there as usize];
            for which in 0..self.permutations.len() {
                let corners = self.permutations[which];
                if corners.image((place % 4) as u8) == face && corners.is_even() != is_odd {
                    self.glued(place, there, corners, visit);
                }
            }
        }
    }

    /// Goes on with a face glued, and opens it again.
    fn glued(&mut self, place: u32, there: u32, corners: Permutation, visit: &mut impl FnMut(&Triangulation)) {
        let (tetrahedron, face) = (place / 4, (place % 4) as u8);
        if self.triangulation.glue(tetrahedron, face, there, corners).is_ok() {
            self.go_on(place + 1, visit);
            self.triangulation.unglue(tetrahedron, face);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::homology::Homology;
    use crate::record::{read_record, read_records};
    use std::collections::BTreeSet;

    fn labelled(found: &[Enumerated]) -> u128 {
        found.iter().map(Enumerated::labelled_count).sum()
    }

    fn of_genera(found: &[Enumerated], genera: &[usize]) -> Vec<Enumerated> {
        found.iter().filter(|found| found.genera == genera).cloned().collect()
    }

    /// Counts labelled gluings by definition: all pairings of faces, three odd permutations for each pair.
    fn labelled_by_definition(tetrahedra: usize) -> (u128, u128) {
        let odd: Vec<_> = Permutation::all().filter(|p| !p.is_even()).collect();
        let (mut all, mut of_genus_two) = (0, 0);
        fn go_on(triangulation: &mut Triangulation, odd: &[Permutation], counts: &mut (u128, u128)) {
            let Some((t, f)) = triangulation.boundary_faces().next() else {
                counts.0 += 1;
                counts.1 += u128::from(genera(triangulation, 2).is_some_and(|genera| genera == [2]));
                return;
            };
            let others: Vec<_> = triangulation.boundary_faces().skip(1).collect();
            for (other, face) in others {
                for &corners in odd.iter().filter(|corners| corners.image(f) == face) {
                    triangulation.glue(t, f, other, corners).unwrap();
                    go_on(triangulation, odd, counts);
                    triangulation.unglue(t, f);
                }
            }
        }
        let mut counts = (0, 0);
        go_on(&mut Triangulation::new(tetrahedra), &odd, &mut counts);
        all += counts.0;
        of_genus_two += counts.1;
        (all, of_genus_two)
    }

    #[test]
    fn one_and_two_tetrahedra_are_complete() {
        let one = enumerate(1, AllowedLinks::Any).unwrap();
        assert_eq!((one.len(), labelled(&one)), (4, 27));
        assert!(enumerate(1, AllowedLinks::Higher).unwrap().is_empty());
        let two = enumerate(2, AllowedLinks::Any).unwrap();
        let (all, of_genus_two) = labelled_by_definition(2);
        assert_eq!((all, of_genus_two), (8_505, 2_208));
        // Gluings in two pieces are 27 times 27.
        assert_eq!(labelled(&two), all - 27 * 27);
        let higher = enumerate(2, AllowedLinks::Higher).unwrap();
        assert_eq!(higher, of_genera(&two, &[2]));
        assert_eq!((higher.len(), labelled(&higher)), (8, of_genus_two));
    }

    /// The homology of those whose links are spheres, each group once.
    fn of_closed_manifolds(tetrahedra: usize) -> Vec<String> {
        let found = enumerate(tetrahedra, AllowedLinks::Any).unwrap();
        let closed = found.iter().filter(|found| found.genera.iter().all(|&genus| genus == 0));
        closed.map(|found| Homology::new(&found.triangulation).to_string()).collect()
    }

    #[test]
    fn closed_manifolds_of_one_and_two_tetrahedra_are_those_of_the_literature() {
        // The 3-sphere twice, the lens spaces L(4,1) and L(5,2).
        let mut one = of_closed_manifolds(1);
        one.sort_unstable();
        assert_eq!(one, ["0", "0", "Z_4", "Z_5"]);
        // The 3-sphere, the 3-sphere modulo the quaternions, a sphere times a circle, L(2,1), L(3,1), L(5,1), L(7,2),
        // L(8,3).
        let two: BTreeSet<_> = of_closed_manifolds(2).into_iter().collect();
        let expected = ["0", "2 Z_2", "Z", "Z_2", "Z_3", "Z_5", "Z_7", "Z_8"];
        assert_eq!(two, expected.map(str::to_owned).into());
    }

    #[test]
    fn three_tetrahedra_are_complete() {
        let three = enumerate(3, AllowedLinks::Any).unwrap();
        // 11!! pairings, 3^6 permutations, less those in pieces of 2 and 1 and of 1, 1 and 1 tetrahedra.
        let all: u128 = 11 * 9 * 7 * 5 * 3 * 729;
        assert_eq!(all, 7_577_955);
        assert_eq!(labelled(&three), all - 3 * 27 * (8_505 - 27 * 27) - 27 * 27 * 27);
        let labellings: usize = three.iter().map(|found| 24 * 3 / found.automorphisms).sum();
        let mut visited = 0;
        for_each_labelling(3, &mut |_| visited += 1);
        assert_eq!((visited, labellings), (24_057, 24_057));

        let (genus_three, genus_two) = (of_genera(&three, &[3]), of_genera(&three, &[2]));
        assert_eq!((genus_three.len(), labelled(&genus_three)), (74, 1_410_048));
        assert_eq!((genus_two.len(), labelled(&genus_two)), (166, 2_668_032));
        let higher = enumerate(3, AllowedLinks::Higher).unwrap();
        assert_eq!(higher.len(), 74 + 166);
        let with_torus = enumerate(3, AllowedLinks::TorusOrHigher).unwrap();
        let cusped = of_genera(&with_torus, &[1, 2]);
        assert_eq!(cusped.iter().map(|found| &found.signature[..]).collect::<Vec<_>>(), ["dLQacccjjkg"]);
    }

    #[test]
    fn the_census_is_among_them() {
        let census = include_str!("../../../testdata/hyperbolic/census.json");
        let tripus = include_str!("../../../testdata/hyperbolic/tripus.json");
        let all: Vec<_> = [2, 3].into_iter().flat_map(|n| enumerate(n, AllowedLinks::Higher).unwrap()).collect();
        let signatures: BTreeSet<_> = all.iter().map(|found| found.signature.clone()).collect();
        let mut records = read_records(census).unwrap();
        records.push(read_record(tripus).unwrap());
        assert_eq!(records.len(), 17);
        assert!(records.iter().all(|record| signatures.contains(record.signature.as_ref().unwrap())));
        // The three that tend to no curvature without reaching it; one of another number of tetrahedra is not there.
        assert!(["dLQacccjcog", "dLQacccjjwc", "dLQacccjkfr"].iter().all(|&escape| signatures.contains(escape)));
        assert!(!signatures.contains("cPcbbbiht"));
    }

    #[test]
    fn too_many_are_refused() {
        let error = EnumerationError::TooMany { tetrahedra: 7, most: 6 };
        assert_eq!(enumerate(7, AllowedLinks::Any), Err(error));
        assert_eq!(enumerate(0, AllowedLinks::Any), Ok(Vec::new()));
    }
}
