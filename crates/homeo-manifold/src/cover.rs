//! Coverings with few sheets.
//!
//! A covering of `k` sheets takes each tetrahedron `k` times. Tetrahedra of a sheet are joined through the faces of a
//! tree, and each other face leads from the sheets to the sheets by a permutation, such that the relations of the
//! fundamental group hold: round an edge one comes back to one's sheet. So connected coverings are the ways in which
//! the group permutes `k` sheets transitively, up to the names of sheets; they belong to the subgroups of index `k`, up
//! to conjugation.

use crate::group::{FundamentalGroup, Letter};
use crate::triangulation::Triangulation;
use thiserror::Error;

/// Why coverings are not listed.
#[derive(Debug, Error, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum CoverError {
    #[error("the triangulation has {pieces} pieces: cover them one by one")]
    NotConnected { pieces: usize },
    #[error("coverings with {sheets} sheets: at least one is needed, and at most {most} are gone through")]
    Sheets { sheets: usize, most: usize },
    #[error("the search was given up after {steps} steps: ask for fewer sheets, or simplify the triangulation first")]
    TooLong { steps: u64 },
}

const MOST_SHEETS: usize = 6;
const MOST_STEPS: u64 = 100_000_000;

/// All connected coverings with a number of sheets, up to isomorphism over the triangulation; vertices are cut off, so
/// a covering may be branched at vertices but not at inner edges.
///
/// Tetrahedron `t` in sheet `s` is the tetrahedron `t + n s` of a covering of `n` tetrahedra. The order of the
/// coverings is the same on each run.
///
/// Cost: up to `(k!)^g` steps for `g` generators, fewer the earlier the relations speak; for a handful of tetrahedra
/// and four sheets it is under a second.
///
/// # Errors
/// No or more than six sheets; a triangulation in pieces; a search of more than 100 million steps.
///
/// # Example
/// ```
/// use homeo_manifold::{Homology, covers, from_signature};
/// let tripus = from_signature("cPcbbbihq").unwrap();
/// let groups = covers(&tripus, 2).unwrap().iter().map(|cover| Homology::new(cover).to_string()).collect::<Vec<_>>();
/// assert_eq!(groups, ["3 Z"; 3]);
/// ```
pub fn covers(triangulation: &Triangulation, sheets: usize) -> Result<Vec<Triangulation>, CoverError> {
    if !(1..=MOST_SHEETS).contains(&sheets) {
        return Err(CoverError::Sheets { sheets, most: MOST_SHEETS });
    }
    let group = FundamentalGroup::new(triangulation);
    if group.pieces() != 1 {
        return Err(CoverError::NotConnected { pieces: group.pieces() });
    }
    let mut search = Search::new(&group, sheets);
    search.go_on()?;
    Ok(search.found.iter().map(|images| cover(triangulation, &group, &search.permutations, images)).collect())
}

/// Permutations for the generators, found one after the other; each is its number in a list of all.
struct Search<'a> {
    permutations: Vec<Vec<usize>>,
    /// The relations of which a generator is the last to be chosen.
    relations_of: Vec<Vec<&'a [Letter]>>,
    images: Vec<usize>,
    found: Vec<Vec<usize>>,
    steps: u64,
}

impl<'a> Search<'a> {
    fn new(group: &'a FundamentalGroup, sheets: usize) -> Self {
        let mut relations_of = vec![Vec::new(); group.generators().len()];
        for relation in group.relations() {
            if let Some(last) = relation.iter().map(|letter| letter.generator).max() {
                relations_of[last as usize].push(&relation[..]);
            }
        }
        Self { permutations: permutations(sheets), relations_of, images: Vec::new(), found: Vec::new(), steps: 0 }
    }

    fn go_on(&mut self) -> Result<(), CoverError> {
        self.steps += 1;
        if self.steps > MOST_STEPS {
            return Err(CoverError::TooLong { steps: MOST_STEPS });
        }
        if self.images.len() == self.relations_of.len() {
            if self.is_transitive() && self.is_least() {
                self.found.push(self.images.clone());
            }
            return Ok(());
        }
        let relations = self.images.len();
        for image in 0..self.permutations.len() {
            self.images.push(image);
            if self.relations_of[relations].iter().all(|relation| self.holds(relation)) {
                self.go_on()?;
            }
            self.images.pop();
        }
        Ok(())
    }

    fn holds(&self, relation: &[Letter]) -> bool {
        let image = |letter: &Letter| &self.permutations[self.images[letter.generator as usize]];
        let sheets = self.permutations[0].len();
        (0..sheets).all(|sheet| relation.iter().fold(sheet, |at, letter| passed(letter, image(letter), at)) == sheet)
    }

    fn is_transitive(&self) -> bool {
        let mut reached = vec![false; self.permutations[0].len()];
        let mut waiting = vec![0];
        while let Some(sheet) = waiting.pop() {
            if !std::mem::replace(&mut reached[sheet], true) {
                waiting.extend(self.images.iter().map(|&image| self.permutations[image][sheet]));
            }
        }
        // Permutations of finitely many sheets: what is reached forwards is reached backwards.
        reached.into_iter().all(|reached| reached)
    }

    /// Whether no renaming of sheets makes the list of permutations less.
    fn is_least(&self) -> bool {
        let conjugated = |names: &[usize], image: usize| {
            let mut result = vec![0; names.len()];
            self.permutations[image].iter().enumerate().for_each(|(sheet, &to)| result[names[sheet]] = names[to]);
            result
        };
        self.permutations.iter().all(|names| {
            let renamed = self.images.iter().map(|&image| conjugated(names, image));
            renamed.ge(self.images.iter().map(|&image| self.permutations[image].clone()))
        })
    }
}

/// The sheet after a letter is passed.
fn passed(letter: &Letter, permutation: &[usize], sheet: usize) -> usize {
    if letter.is_inverse { permutation.iter().position(|&to| to == sheet).unwrap_or(sheet) } else { permutation[sheet] }
}

/// All permutations of some numbers, ascending.
fn permutations(count: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for _ in 0..count {
        let longer = |begun: &Vec<usize>| {
            let begun = begun.clone();
            let free = (0..count).filter(|next| !begun.contains(next)).collect::<Vec<_>>();
            free.into_iter().map(move |next| [&begun[..], &[next]].concat())
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

fn cover(
    triangulation: &Triangulation,
    group: &FundamentalGroup,
    permutations: &[Vec<usize>],
    images: &[usize],
) -> Triangulation {
    let (size, sheets) = (triangulation.len(), permutations[0].len());
    let at = |tetrahedron: u32, sheet: usize| tetrahedron + (size * sheet) as u32;
    let mut cover = Triangulation::new(size * sheets);
    for (tetrahedron, face) in triangulation.faces() {
        let Some(there) = triangulation.neighbour(tetrahedron, face) else { continue };
        for sheet in 0..sheets {
            let to = match group.letter(tetrahedron, face) {
                None => sheet,
                Some(letter) => passed(&letter, &permutations[images[letter.generator as usize]], sheet),
            };
            if cover.neighbour(at(tetrahedron, sheet), face).is_none() {
                let glued = cover.glue(at(tetrahedron, sheet), face, at(there.tetrahedron, to), there.corners);
                debug_assert!(glued.is_ok(), "{glued:?}");
            }
        }
    }
    cover
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::homology::Homology;
    use crate::record::read_records;
    use crate::signature::{components, from_signature};
    use crate::skeleton::Skeleton;
    use std::collections::BTreeMap;

    fn groups(covers: &[Triangulation]) -> BTreeMap<String, u64> {
        let mut groups = BTreeMap::new();
        covers.iter().for_each(|cover| *groups.entry(Homology::new(cover).to_string()).or_default() += 1);
        groups
    }

    #[test]
    fn covers_are_those_of_the_census() {
        let mut texts = vec![include_str!("../../../testdata/hyperbolic/census.json")];
        texts.push(include_str!("../../../testdata/hyperbolic/tripus.json"));
        let mut compared = [0; 5];
        for text in texts {
            let file: serde_json::Value = serde_json::from_str(text).unwrap();
            for (number, record) in read_records(text).unwrap().into_iter().enumerate() {
                let row = file["triangulations"].get(number).unwrap_or(&file["triangulation"]);
                for stated in row["covers"].as_array().into_iter().flatten() {
                    let sheets = stated[0].as_u64().unwrap() as usize;
                    let covers = covers(&record.triangulation, sheets).unwrap();
                    let expected: BTreeMap<String, u64> =
                        serde_json::from_value::<Vec<_>>(stated[1].clone()).unwrap().into_iter().collect();
                    assert_eq!(groups(&covers), expected, "{:?}, {sheets} sheets", record.signature);
                    assert!(covers.iter().all(|cover| components(cover).len() == 1));
                    compared[sheets] += 1;
                }
            }
        }
        assert!(compared[2] > 10 && compared[3] > 10 && compared[4] > 2, "{compared:?}");
    }

    #[test]
    fn edges_are_covered_and_not_branched() {
        let figure_eight = from_signature("cPcbbbiht").unwrap();
        let degrees = |triangulation: &Triangulation| {
            let skeleton = Skeleton::new(triangulation);
            skeleton.edges().iter().map(|edge| edge.corners.len()).collect::<Vec<_>>()
        };
        for sheets in 1..=4 {
            for cover in covers(&figure_eight, sheets).unwrap() {
                assert_eq!(degrees(&cover), vec![6; 2 * sheets]);
            }
        }
        assert_eq!(covers(&figure_eight, 1).unwrap(), std::slice::from_ref(&figure_eight));
        // The group of the knot has one subgroup of index 2 and one of index 3, up to conjugation, and two of index 4.
        let counts = [2, 3, 4].map(|sheets| covers(&figure_eight, sheets).unwrap().len());
        assert_eq!(counts, [1, 1, 2]);
    }

    #[test]
    fn what_cannot_be_covered_is_refused() {
        let two = Triangulation::new(2);
        assert_eq!(covers(&two, 2), Err(CoverError::NotConnected { pieces: 2 }));
        assert_eq!(covers(&two, 7), Err(CoverError::Sheets { sheets: 7, most: 6 }));
        assert_eq!(covers(&two, 0), Err(CoverError::Sheets { sheets: 0, most: 6 }));
        // No cover of a ball but itself.
        assert!(covers(&Triangulation::new(1), 2).unwrap().is_empty());
    }
}
