//! Whether a fundamental group is free: generators are eliminated, and exchanged for others where relations get shorter.

use super::{FundamentalGroup, Letter};

/// Words are not made longer than this in all.
const MOST_LETTERS: usize = 1 << 16;

type Word = Vec<Letter>;

impl FundamentalGroup {
    /// The rank of the group, where the search shows that it is free; otherwise nothing, and it may be free or not.
    ///
    /// A relation in which a generator occurs just once expresses it by the others, so that both can be left out; if no relation
    /// is left, the group is free on the generators that are left (Tietze). Before, generators are exchanged for others that
    /// make relations shorter: Whitehead's automorphisms multiply some by one, on one side or both. For one relation between
    /// up to six generators this decides whether the group is free (Whitehead 1936).
    ///
    /// A free group has no subgroup that is the group of a closed surface of positive genus, so a compact manifold with such a
    /// group, a handle body for example, has no hyperbolic structure with geodesic boundary: boundary components would be such
    /// subgroups.
    ///
    /// Cost: a round is some thousand times the letters of all relations for six generators, the square of their number times the
    /// letters for more; there are at most as many rounds as letters, and at most 65,536 letters.
    ///
    /// # Example
    /// ```
    /// use homeo_manifold::{FundamentalGroup, from_signature};
    /// let handle_body = FundamentalGroup::new(&from_signature("dLQabccbjcn")?);
    /// assert_eq!(handle_body.free_rank(), Some(2));
    /// let tripus = FundamentalGroup::new(&from_signature("cPcbbbihq")?);
    /// assert_eq!(tripus.free_rank(), None);
    /// # Ok::<(), homeo_manifold::SignatureError>(())
    /// ```
    pub fn free_rank(&self) -> Option<usize> {
        let mut words: Vec<Word> = self.relations.iter().map(|word| reduced(word)).collect();
        let mut live: Vec<u32> = (0..self.generators.len() as u32).collect();
        loop {
            words.retain(|word| !word.is_empty());
            if words.is_empty() {
                return Some(live.len());
            }
            words.sort_by_key(Vec::len);
            let place = words.iter().enumerate().find_map(|(number, word)| Some((number, single(word)?)));
            match place {
                Some((number, place)) => {
                    let word = words.swap_remove(number);
                    let (generator, value) = solved(&word, place);
                    words.iter_mut().for_each(|word| *word = reduced(&substituted(word, generator, &value)));
                    live.retain(|&other| other != generator);
                }
                None => words = shorter(&words, &live)?,
            }
            if letters(&words) > MOST_LETTERS {
                return None;
            }
        }
    }
}

fn letters(words: &[Word]) -> usize {
    words.iter().map(Vec::len).sum()
}

/// Up to so many generators all of Whitehead's automorphisms are tried, for more those that change a single generator.
const ALL_EXCHANGED: usize = 6;

/// The relations after the first of Whitehead's automorphisms that makes them shorter.
fn shorter(words: &[Word], live: &[u32]) -> Option<Vec<Word>> {
    let others = live.len().saturating_sub(1);
    let codes: Vec<Code> = match live.len() {
        ..=ALL_EXCHANGED => (1..1 << (2 * others)).map(|sides| (0, sides)).collect(),
        _ => (0..others).flat_map(|first| (1..4).map(move |sides| (first, sides))).collect(),
    };
    let multipliers =
        live.iter().flat_map(|&generator| [false, true].map(|is_inverse| Letter { generator, is_inverse }));
    multipliers.flat_map(|by| codes.iter().map(move |&code| (by, code))).find_map(|(by, code)| {
        let image: Vec<Word> = words.iter().map(|word| reduced(&exchanged(word, live, by, code))).collect();
        (letters(&image) < letters(words)).then_some(image)
    })
}

/// A number of a generator, and two bits for each from it on: whether the letter follows, and whether its inverse comes before.
type Code = (usize, u64);

/// The image under the automorphism that multiplies generators by a letter; that of the letter is not counted.
fn exchanged(word: &[Letter], live: &[u32], by: Letter, (first, code): Code) -> Word {
    let back = Letter { is_inverse: !by.is_inverse, ..by };
    let mut result = Word::with_capacity(3 * word.len());
    for &letter in word {
        let place = live.iter().filter(|&&other| other != by.generator).position(|&other| other == letter.generator);
        let offset = place.and_then(|place| place.checked_sub(first)).filter(|&offset| offset < ALL_EXCHANGED);
        let sides = offset.map_or(0, |offset| code >> (2 * offset) & 3);
        let (before, after) = if letter.is_inverse { (sides & 1, sides & 2) } else { (sides & 2, sides & 1) };
        // The inverse of `b^-1 x b` is `b^-1 x^-1 b`.
        if before != 0 {
            result.push(back);
        }
        result.push(letter);
        if after != 0 {
            result.push(by);
        }
    }
    result
}

/// The place of a letter whose generator occurs nowhere else in the word.
fn single(word: &[Letter]) -> Option<usize> {
    let times = |letter: &Letter| word.iter().filter(|other| other.generator == letter.generator).count();
    word.iter().position(|letter| times(letter) == 1)
}

/// What the generator at a place is equal to by a relation: `u g v = 1` says `g = u^-1 v^-1`, the inverse of `v u`.
fn solved(word: &[Letter], place: usize) -> (u32, Word) {
    let (before, after) = (&word[..place], &word[place + 1..]);
    let others: Word = after.iter().chain(before).copied().collect();
    let value = if word[place].is_inverse { others } else { inverse(&others) };
    (word[place].generator, value)
}

fn inverse(word: &[Letter]) -> Word {
    word.iter().rev().map(|letter| Letter { is_inverse: !letter.is_inverse, ..*letter }).collect()
}

fn substituted(word: &[Letter], generator: u32, value: &[Letter]) -> Word {
    let back = inverse(value);
    let mut result = Word::with_capacity(word.len());
    for letter in word {
        match (letter.generator == generator, letter.is_inverse) {
            (false, _) => result.push(*letter),
            (true, false) => result.extend_from_slice(value),
            (true, true) => result.extend_from_slice(&back),
        }
    }
    result
}

/// The word without letters beside their inverses, the last and the first letter being neighbours.
fn reduced(word: &[Letter]) -> Word {
    let cancel = |a: &Letter, b: &Letter| a.generator == b.generator && a.is_inverse != b.is_inverse;
    let mut result = Word::with_capacity(word.len());
    for letter in word {
        match result.last() {
            Some(last) if cancel(last, letter) => {
                result.pop();
            }
            _ => result.push(*letter),
        }
    }
    let ends = result.iter().zip(result.iter().rev()).take(result.len() / 2);
    let turns = ends.take_while(|(first, last)| cancel(first, last)).count();
    result[turns..result.len() - turns].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Homology;
    use crate::hyperbolic::testing;
    use crate::signature::from_signature;

    /// Where there is a structure, the group contains that of a surface; where it is said to be free, its homology is.
    #[test]
    fn groups_are_free_for_handle_bodies_and_never_with_a_structure() {
        let (mut free, mut structures) = (0, 0);
        for entry in testing::census() {
            let rank = FundamentalGroup::new(&entry.triangulation).free_rank();
            if entry.geometry.is_some() {
                assert_eq!(rank, None, "{}", entry.name);
                structures += 1;
            }
            if let Some(rank) = rank {
                let homology = Homology::new(&entry.triangulation);
                assert_eq!((homology.rank(), homology.torsion().len()), (rank, 0), "{}", entry.name);
                free += 1;
            }
        }
        assert!(free >= 2 && structures >= 10, "{free} {structures}");
    }

    #[test]
    fn words_cancel_round_their_ends() {
        let letter = |generator, is_inverse| Letter { generator, is_inverse };
        let word = [letter(0, false), letter(1, false), letter(1, true), letter(2, false), letter(0, true)];
        assert_eq!(reduced(&word), [letter(2, false)]);
        assert_eq!(solved(&[letter(0, false), letter(1, true)], 1), (1, vec![letter(0, false)]));
    }

    #[test]
    fn a_group_with_torsion_or_of_a_knot_is_not_free() {
        let figure_eight = from_signature("cPcbbbiht").unwrap();
        assert_eq!(FundamentalGroup::new(&figure_eight).free_rank(), None);
        let flip = crate::Permutation::new([1, 0, 3, 2]).unwrap();
        let reversed = crate::Triangulation::from_gluings(1, &[(0, 3, 0, flip)]).unwrap();
        assert_eq!(FundamentalGroup::new(&reversed).free_rank(), None);
    }
}
