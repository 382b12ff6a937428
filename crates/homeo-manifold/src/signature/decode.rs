//! The triangulation of a signature.

use super::{BOUNDARY, CHARACTERS, KNOWN, LARGE, NEW};
use crate::permutation::Permutation;
use crate::triangulation::{GluingError, Triangulation};
use thiserror::Error;

/// Why a string is no signature.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum SignatureError {
    #[error("character {place}, {found:?}, is none of a signature: they are letters, digits, + and -")]
    Character { place: usize, found: char },
    #[error("the signature ends early, after {length} characters: is a part of it missing?")]
    Short { length: usize },
    #[error(
        "character {place} announces {count} tetrahedra or more: the signature is too short for them, or they are too many"
    )]
    Size { place: usize, count: u64 },
    #[error("character {place} does not say what is across three faces, given those before it")]
    Faces { place: usize },
    #[error("character {place} names tetrahedron {destination}, which is not there yet")]
    Destination { place: usize, destination: u64 },
    #[error("character {place} is no permutation: its value is {value}, above 23")]
    Permutation { place: usize, value: u8 },
    #[error("character {place} makes a gluing that is not possible: {source}")]
    Gluing { place: usize, source: GluingError },
}

/// The triangulation that a signature stands for, labelled as the signature has it.
///
/// Strings that are not the least ones of their triangulation are read as well. Spaces round the string are passed
/// over. Memory is within a small multiple of the string; cost: linear.
///
/// # Errors
/// What is wrong, with the character, counted from 0.
///
/// # Example
/// ```
/// use homeo_manifold::{from_signature, signature};
/// let figure_eight_sister = from_signature("cPcbbbdxm")?;
/// assert_eq!(figure_eight_sister.len(), 2);
/// assert_eq!(signature(&figure_eight_sister), "cPcbbbdxm");
/// assert!(from_signature("cPcbbbdx").is_err());
/// # Ok::<(), homeo_manifold::SignatureError>(())
/// ```
pub fn from_signature(signature: &str) -> Result<Triangulation, SignatureError> {
    let mut reader = Reader::new(signature)?;
    let mut triangulation = Triangulation::default();
    while reader.place < reader.values.len() {
        component(&mut reader, &mut triangulation)?;
    }
    Ok(triangulation)
}

struct Reader {
    values: Vec<u8>,
    place: usize,
}

impl Reader {
    fn new(signature: &str) -> Result<Self, SignatureError> {
        let value = |(place, found): (usize, char)| {
            let value = CHARACTERS.iter().position(|&character| char::from(character) == found);
            value.map(|value| value as u8).ok_or(SignatureError::Character { place, found })
        };
        let values = signature.trim().chars().enumerate().map(value).collect::<Result<Vec<_>, _>>()?;
        if values.is_empty() {
            return Err(SignatureError::Short { length: 0 });
        }
        Ok(Self { values, place: 0 })
    }

    fn value(&mut self) -> Result<u8, SignatureError> {
        let value = self.values.get(self.place).copied().ok_or(SignatureError::Short { length: self.values.len() })?;
        self.place += 1;
        Ok(value)
    }

    /// A number of several characters, the lowest first; nothing above what 64 bits hold.
    fn number(&mut self, width: usize) -> Result<Option<u64>, SignatureError> {
        let mut number = Some(0_u64);
        for place in 0..width {
            let value = u64::from(self.value()?);
            let shifted = value.checked_shl(6 * place as u32).filter(|shifted| shifted >> (6 * place) == value);
            number = if value == 0 { number } else { number.zip(shifted).map(|(number, shifted)| number | shifted) };
        }
        Ok(number)
    }

    /// The number of tetrahedra, and the width of numbers.
    fn size(&mut self, before: usize) -> Result<(u32, usize), SignatureError> {
        let place = self.place;
        let mut width = 1;
        let mut count = Some(u64::from(self.value()?));
        if count == Some(LARGE as u64) {
            width = usize::from(self.value()?);
            count = self.number(width)?;
        }
        // Each character speaks of at most three faces, and each of these has at most one other side.
        let most = 6 * (self.values.len() - self.place) as u64 / 4;
        let room = most.min((u32::MAX as u64).saturating_sub(before as u64));
        let count = count.unwrap_or(u64::MAX);
        if count > room {
            return Err(SignatureError::Size { place, count });
        }
        Ok((count as u32, width))
    }

    /// What is across the faces of `count` tetrahedra.
    fn actions(&mut self, count: u32) -> Result<Vec<u8>, SignatureError> {
        let (mut actions, mut faces, mut known) = (Vec::new(), 4 * u64::from(count), 1);
        while faces > 0 {
            let place = self.place;
            let packed = self.value()?;
            for action in [packed & 3, packed >> 2 & 3, packed >> 4 & 3] {
                let taken = if action == BOUNDARY { 1 } else { 2 };
                // After the last face zeros fill the character.
                let is_over = faces == 0;
                if is_over && action == 0 {
                    continue;
                }
                known += u64::from(action == NEW);
                if action > KNOWN || faces < taken || known > u64::from(count) {
                    return Err(SignatureError::Faces { place });
                }
                faces -= taken;
                actions.push(action);
            }
        }
        Ok(actions)
    }
}

/// The parts of a component's string.
struct Code {
    count: u32,
    actions: Vec<u8>,
    /// The tetrahedra and the permutations of gluings to known tetrahedra.
    joins: Vec<(u64, u8)>,
    width: usize,
    /// Where the actions, the tetrahedra and the permutations begin.
    starts: [usize; 3],
}

impl Code {
    fn read(reader: &mut Reader, before: usize) -> Result<Self, SignatureError> {
        let (count, width) = reader.size(before)?;
        let actions_start = reader.place;
        let actions = reader.actions(count)?;
        let joins_start = reader.place;
        let joins = actions.iter().filter(|&&action| action == KNOWN).count();
        let mut destinations = Vec::new();
        for _ in 0..joins {
            destinations.push(reader.number(width)?.unwrap_or(u64::MAX));
        }
        let starts = [actions_start, joins_start, reader.place];
        let permutations = (0..joins).map(|_| reader.value()).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { count, actions, joins: destinations.into_iter().zip(permutations).collect(), width, starts })
    }

    /// The gluing of a number to one of the known tetrahedra; the place of its permutation in the string.
    fn join(&self, number: usize, known: u32) -> Result<(u32, Permutation, usize), SignatureError> {
        let [_, joins_start, permutations_start] = self.starts;
        let Some(&(destination, value)) = self.joins.get(number) else {
            return Err(SignatureError::Faces { place: joins_start });
        };
        let place = permutations_start + number;
        let corners = Permutation::all().nth(usize::from(value));
        let corners = corners.ok_or(SignatureError::Permutation { place, value })?;
        if destination >= u64::from(known) {
            return Err(SignatureError::Destination { place: joins_start + number * self.width, destination });
        }
        Ok((destination as u32, corners, place))
    }
}

/// Reads one component and adds it.
fn component(reader: &mut Reader, triangulation: &mut Triangulation) -> Result<(), SignatureError> {
    let before = triangulation.len();
    let code = Code::read(reader, before)?;
    for _ in 0..code.count {
        triangulation.add_tetrahedron();
    }
    let before = before as u32;
    let mut actions = code.actions.iter().enumerate();
    let (mut known, mut joined) = (1, 0);
    for (tetrahedron, face) in (0..code.count).flat_map(|tetrahedron| (0..4).map(move |face| (tetrahedron, face))) {
        if triangulation.neighbour(before + tetrahedron, face).is_some() {
            continue;
        }
        let next = actions.next().filter(|_| tetrahedron < known);
        let (number, &action) = next.ok_or(SignatureError::Faces { place: code.starts[1] - 1 })?;
        let (there, corners, place) = match action {
            BOUNDARY => continue,
            NEW => (known, Permutation::IDENTITY, code.starts[0] + number / 3),
            _ => code.join(joined, known)?,
        };
        known += u32::from(action == NEW);
        joined += usize::from(action == KNOWN);
        let glued = triangulation.glue(before + tetrahedron, face, before + there, corners);
        glued.map_err(|source| SignatureError::Gluing { place, source })?;
    }
    Ok(())
}
