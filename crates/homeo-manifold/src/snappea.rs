//! The text files of SnapPea and SnapPy, as far as they tell how tetrahedra are glued.
//!
//! Such a file begins with `% Triangulation`, a name, the kind and volume of a hyperbolic structure, whether the
//! manifold is orientable, its Chern-Simons invariant, the numbers of torus and Klein bottle cusps and a line for each
//! cusp; then the number of tetrahedra, and for each of them its four neighbours, the four gluings as images of 0, 1,
//! 2, 3 without spaces, the cusps at its corners, four rows of 16 numbers (meridian and longitude), and a shape.
//! Source: "SnapPea Triangulation File Format", which comes with the SnapPea kernel. Structure, cusps, curves and
//! shapes are passed over in reading. In writing there are no cusps and no curves, which that page allows: SnapPea then
//! finds the cusps by itself, and takes vertices with spheres as links for inner points. SnapPea wants links that are
//! tori, Klein bottles and spheres; files with others are for programs with the same format and geodesic boundary.

use crate::link::Links;
use crate::permutation::Permutation;
use crate::skeleton::Skeleton;
use crate::triangulation::{Gluing, GluingError, Triangulation};
use std::fmt::Write;
use std::str::SplitWhitespace;
use thiserror::Error;

/// Why a file cannot be read or written.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum SnapPeaError {
    #[error("the first line is not `% Triangulation`: is it another kind of file?")]
    NoHeader,
    #[error("the file ends before {expected}")]
    Short { expected: &'static str },
    #[error("{found:?} stands in place of {expected}")]
    Unexpected { found: String, expected: &'static str },
    #[error("{count} tetrahedra are announced, and the file is too short for them")]
    TooManyTetrahedra { count: usize },
    #[error("tetrahedron {tetrahedron}: {found:?} is no permutation of 0123")]
    NoPermutation { tetrahedron: u32, found: String },
    #[error("tetrahedron {tetrahedron}, face {face}: {source}")]
    Gluing { tetrahedron: u32, face: u8, source: GluingError },
    #[error("tetrahedron {tetrahedron}, face {face}: the gluing is not that from its other side")]
    OneSided { tetrahedron: u32, face: u8 },
    #[error("face {face} of tetrahedron {tetrahedron} is boundary, which the format has not: write a record")]
    Boundary { tetrahedron: u32, face: u8 },
}

/// Reads the gluings of a triangulation file, and its name.
///
/// Text after `//` is a comment. Memory is within a small multiple of the text; cost: linear.
///
/// # Errors
/// What is wrong, with the tetrahedron.
///
/// # Example
/// ```
/// use homeo_manifold::{from_signature, read_snappea, write_snappea};
/// let figure_eight = from_signature("cPcbbbiht").unwrap();
/// let text = write_snappea(&figure_eight, "m004").unwrap();
/// assert_eq!(read_snappea(&text).unwrap(), ("m004".to_owned(), figure_eight));
/// ```
pub fn read_snappea(text: &str) -> Result<(String, Triangulation), SnapPeaError> {
    let text: String = text.lines().flat_map(|line| [line.split("//").next().unwrap_or_default(), "\n"]).collect();
    let (header, rest) = text.trim_start().split_once('\n').ok_or(SnapPeaError::NoHeader)?;
    if header.split_whitespace().ne(["%", "Triangulation"]) {
        return Err(SnapPeaError::NoHeader);
    }
    // A name may have spaces in it.
    let (name, rest) = rest.split_once('\n').ok_or(SnapPeaError::Short { expected: "the name" })?;
    let mut words = Words(rest.split_whitespace());
    words.pass_header()?;
    let count = words.number("the number of tetrahedra")?;
    // A tetrahedron takes more than a hundred characters.
    if count > text.len() {
        return Err(SnapPeaError::TooManyTetrahedra { count });
    }
    let triangulation = words.gluings(count)?;
    Ok((name.trim().to_owned(), triangulation))
}

/// Writes a closed triangulation, whatever its links; see the [module](self) for what SnapPea makes of it.
///
/// Line breaks in the name become spaces.
///
/// # Errors
/// [`SnapPeaError::Boundary`] if a face is not glued.
pub fn write_snappea(triangulation: &Triangulation, name: &str) -> Result<String, SnapPeaError> {
    if let Some((tetrahedron, face)) = triangulation.boundary_faces().next() {
        return Err(SnapPeaError::Boundary { tetrahedron, face });
    }
    let links = Links::new(triangulation, &Skeleton::new(triangulation));
    let orientability = if links.orientation().is_some() { "oriented_manifold" } else { "nonorientable_manifold" };
    let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text = format!("% Triangulation\n{name}\nnot_attempted 0.0\n{orientability}\nCS_unknown\n\n0 0\n\n");
    text.push_str(&format!("{}\n", triangulation.len()));
    for tetrahedron in 0..triangulation.len() as u32 {
        let across = (0..4).filter_map(|face| triangulation.neighbour(tetrahedron, face)).collect::<Vec<_>>();
        // Writing into a string does not fail.
        for there in &across {
            let _ = write!(text, " {:4}", there.tetrahedron);
        }
        text.push('\n');
        for there in &across {
            let _ = write!(text, " {:?}", there.corners);
        }
        text.push_str("\n  -1   -1   -1   -1\n");
        (0..4).for_each(|_| text.push_str("  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n"));
        text.push_str("  0.0 0.0\n\n");
    }
    Ok(text)
}

struct Words<'a>(SplitWhitespace<'a>);

impl<'a> Words<'a> {
    fn word(&mut self, expected: &'static str) -> Result<&'a str, SnapPeaError> {
        self.0.next().ok_or(SnapPeaError::Short { expected })
    }

    fn parsed<T: std::str::FromStr>(&mut self, expected: &'static str) -> Result<T, SnapPeaError> {
        let word = self.word(expected)?;
        word.parse().map_err(|_| SnapPeaError::Unexpected { found: word.to_owned(), expected })
    }

    fn number(&mut self, expected: &'static str) -> Result<usize, SnapPeaError> {
        self.parsed(expected)
    }

    /// Passes over all between the name and the number of tetrahedra.
    fn pass_header(&mut self) -> Result<(), SnapPeaError> {
        self.word("the kind of the structure")?;
        self.parsed::<f64>("the volume")?;
        self.word("whether the manifold is orientable")?;
        let chern_simons = self.word("CS_known or CS_unknown")?;
        match chern_simons {
            "CS_known" => _ = self.parsed::<f64>("the Chern-Simons invariant")?,
            "CS_unknown" => {}
            other => {
                let expected = "CS_known or CS_unknown";
                return Err(SnapPeaError::Unexpected { found: other.to_owned(), expected });
            }
        }
        let tori = self.number("the number of torus cusps")?;
        let bottles = self.number("the number of Klein bottle cusps")?;
        for _ in 0..tori.saturating_add(bottles) {
            self.word("the kind of a cusp")?;
            self.parsed::<f64>("the filling of a cusp")?;
            self.parsed::<f64>("the filling of a cusp")?;
        }
        Ok(())
    }

    fn gluings(&mut self, count: usize) -> Result<Triangulation, SnapPeaError> {
        let mut rows = Vec::new();
        for tetrahedron in 0..count as u32 {
            let mut neighbours = [0; 4];
            for neighbour in &mut neighbours {
                *neighbour = self.parsed::<u32>("a neighbour")?;
            }
            for (face, neighbour) in (0..4).zip(neighbours) {
                let word = self.word("a gluing")?;
                let found = || SnapPeaError::NoPermutation { tetrahedron, found: word.to_owned() };
                rows.push((tetrahedron, face, neighbour, permutation(word).ok_or_else(found)?));
            }
            for _ in 0..4 {
                self.parsed::<i64>("the cusp of a corner")?;
            }
            for _ in 0..64 {
                self.parsed::<i64>("a meridian or a longitude")?;
            }
            self.parsed::<f64>("a shape")?;
            self.parsed::<f64>("a shape")?;
        }
        glued(count, &rows)
    }
}

/// Glues faces that are given from both sides.
fn glued(count: usize, rows: &[(u32, u8, u32, Permutation)]) -> Result<Triangulation, SnapPeaError> {
    let mut triangulation = Triangulation::new(count);
    for &(tetrahedron, face, other, corners) in rows {
        match triangulation.neighbour(tetrahedron, face) {
            Some(known) if known != (Gluing { tetrahedron: other, corners }) => {
                return Err(SnapPeaError::OneSided { tetrahedron, face });
            }
            Some(_) => {}
            None => {
                let at = |source| SnapPeaError::Gluing { tetrahedron, face, source };
                triangulation.glue(tetrahedron, face, other, corners).map_err(at)?;
            }
        }
    }
    Ok(triangulation)
}

fn permutation(word: &str) -> Option<Permutation> {
    let digits: [u8; 4] = word.as_bytes().try_into().ok()?;
    Permutation::new(digits.map(|digit| digit.wrapping_sub(b'0')))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::read_records;
    use crate::sample::{Random, random_gluings};
    use crate::signature::signature;

    /// The complement of the figure eight knot in the layout of SnapPea's files, with a cusp, curves and shapes.
    const FIGURE_EIGHT: &str = "% Triangulation
m004 // the figure eight knot
geometric_solution  2.02988321
oriented_manifold
CS_known 0.00000000000000000000

1 0
    torus   0.000000000000   0.000000000000

2
   1    1    1    1
 0132 1230 2310 2103
   0    0    0    0
  0  0  0  0  0  0  0  0  1 -1  0  0 -1  0  1  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0.500000000000   0.866025403784

   0    0    0    0
 0132 3201 3012 2103
   0    0    0    0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0
  0.500000000000   0.866025403784
";

    #[test]
    fn a_file_of_the_figure_eight_knot_is_read() {
        let (name, triangulation) = read_snappea(FIGURE_EIGHT).unwrap();
        assert_eq!(name, "m004");
        assert_eq!(signature(&triangulation), "cPcbbbiht");
    }

    #[test]
    fn what_is_written_is_read() {
        let mut random = Random(31);
        let census = read_records(include_str!("../../../testdata/hyperbolic/census.json")).unwrap();
        let mut triangulations: Vec<_> = census.into_iter().map(|record| record.triangulation).collect();
        triangulations.extend((1..60).map(|tetrahedra| random_gluings(&mut random, tetrahedra, 0)));
        let mut unoriented = 0;
        for triangulation in triangulations {
            let text = write_snappea(&triangulation, "a name\nof two lines").unwrap();
            assert_eq!(read_snappea(&text).unwrap(), ("a name of two lines".to_owned(), triangulation));
            unoriented += usize::from(text.contains("nonorientable_manifold"));
        }
        assert!((1..70).contains(&unoriented), "{unoriented}");
        let boundary = SnapPeaError::Boundary { tetrahedron: 0, face: 0 };
        assert_eq!(write_snappea(&Triangulation::new(1), "ball"), Err(boundary));
    }

    #[test]
    fn wrong_files_are_refused() {
        let read = |from: &str, to: &str| read_snappea(&FIGURE_EIGHT.replacen(from, to, 1)).unwrap_err();
        assert_eq!(read("% Tri", "% tri"), SnapPeaError::NoHeader);
        assert_eq!(read_snappea(""), Err(SnapPeaError::NoHeader));
        let unexpected = |found: &str, expected| SnapPeaError::Unexpected { found: found.to_owned(), expected };
        assert_eq!(read("CS_known", "CS"), unexpected("CS", "CS_known or CS_unknown"));
        assert_eq!(read("\n2\n", "\n-2\n"), unexpected("-2", "the number of tetrahedra"));
        assert_eq!(read("\n2\n", "\n9999999\n"), SnapPeaError::TooManyTetrahedra { count: 9_999_999 });
        assert_eq!(read("\n2\n", "\n3\n"), SnapPeaError::Short { expected: "a neighbour" });
        assert_eq!(read("1 0\n", "999999999999 0\n"), SnapPeaError::Short { expected: "the filling of a cusp" });
        let no_permutation = SnapPeaError::NoPermutation { tetrahedron: 0, found: "1130".to_owned() };
        assert_eq!(read("1230", "1130"), no_permutation);
        assert_eq!(read("3012", "3021"), SnapPeaError::OneSided { tetrahedron: 1, face: 2 });
        let source = GluingError::NoTetrahedron { tetrahedron: 7, count: 2 };
        assert_eq!(read("   1    1", "   7    1"), SnapPeaError::Gluing { tetrahedron: 0, face: 0, source });
    }

    #[test]
    fn damaged_files_do_not_panic() {
        let (mut read, mut refused) = (0, 0);
        for place in 0..FIGURE_EIGHT.len() {
            for replacement in *b"09- x\n" {
                let mut damaged = FIGURE_EIGHT.as_bytes().to_vec();
                damaged[place] = replacement;
                match read_snappea(&String::from_utf8_lossy(&damaged)) {
                    Ok(_) => read += 1,
                    Err(_) => refused += 1,
                }
            }
            // Cut off within its last number the file still has a number there.
            assert!(place + 16 > FIGURE_EIGHT.len() || read_snappea(&FIGURE_EIGHT[..place]).is_err());
        }
        assert!(read > 1_000 && refused > 500, "{read} read, {refused} refused");
    }
}
