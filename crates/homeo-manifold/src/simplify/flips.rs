//! All triangulations that are one move away.

use super::SimplifyError;
use super::editor::{Editor, corner_at};
use super::moves::{four_to_four, three_to_two, two_to_three};
use crate::skeleton::EDGES;
use crate::triangulation::Triangulation;

/// The triangulations of the same manifold that one move makes at any of some faces, each a tetrahedron and the corner opposite:
/// moves 2-3 there, and moves 3-2 and 4-4 at the edges of these faces.
///
/// Two of them may be the same up to names.
///
/// # Errors
/// When faces are open or an edge is reversed.
///
/// # Complexity
/// `O(#T)` for each face.
///
/// # Example
/// ```
/// use homeo_manifold::{from_signature, simplify::flips};
/// let tripus = from_signature("cPcbbbihq")?;
/// // One edge of degree 12: nothing but a move 2-3.
/// let near = flips(&tripus, &[(0, 3)])?;
/// assert_eq!(near.iter().map(|near| near.len()).collect::<Vec<_>>(), [3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn flips(triangulation: &Triangulation, faces: &[(u32, u8)]) -> Result<Vec<Triangulation>, SimplifyError> {
    let mut found = Vec::new();
    for &(tetrahedron, face) in faces {
        let mut editor = Editor::new(triangulation)?;
        if two_to_three(&mut editor, tetrahedron, face).is_some() {
            found.push(editor.finished());
        }
        for [a, b] in EDGES.into_iter().filter(|ends| !ends.contains(&face)) {
            let edge = corner_at(tetrahedron, a, b);
            let mut editor = Editor::new(triangulation)?;
            if three_to_two(&mut editor, edge) {
                found.push(editor.finished());
            }
            // The octahedron round an edge has two other diagonals.
            for edge in [edge, edge.turned()] {
                let mut editor = Editor::new(triangulation)?;
                if four_to_four(&mut editor, edge) {
                    found.push(editor.finished());
                }
            }
        }
    }
    Ok(found)
}
