//! Tetrahedra and the gluings of their faces.

use crate::permutation::Permutation;
use thiserror::Error;

/// What is on the other side of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Gluing {
    /// The tetrahedron there.
    pub tetrahedron: u32,
    /// Where the corners go: those of the face to those that they are glued to, and the corner opposite the face to the
    /// corner opposite the other face.
    pub corners: Permutation,
}

/// Tetrahedra whose faces are glued in pairs; faces that are not glued are boundary.
///
/// Faces are named by the corner opposite. Corners are 0 to 3; edges and vertices are computed by
/// [`Skeleton`](crate::Skeleton).
///
/// # Example
/// ```
/// use homeo_manifold::{GluingError, Permutation, Triangulation};
/// let mut pillow = Triangulation::new(2);
/// pillow.glue(0, 3, 1, Permutation::IDENTITY)?;
/// assert_eq!(pillow.boundary_faces().count(), 6);
/// assert_eq!(pillow.neighbour(1, 3).unwrap().tetrahedron, 0);
/// let taken = pillow.glue(1, 3, 1, Permutation::transposition(2, 3));
/// assert!(matches!(taken, Err(GluingError::FaceTaken { tetrahedron: 1, face: 3 })));
/// # Ok::<(), GluingError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Triangulation {
    neighbours: Vec<[Option<Gluing>; 4]>,
}

/// Why faces cannot be glued.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum GluingError {
    #[error("there is no tetrahedron {tetrahedron}: they are counted from 0 to {count} less one")]
    NoTetrahedron { tetrahedron: u32, count: usize },
    #[error("tetrahedron {tetrahedron} has no face {face}: faces are named by the corner opposite, 0 to 3")]
    NoFace { tetrahedron: u32, face: u8 },
    #[error("face {face} of tetrahedron {tetrahedron} is glued already: a face has one other side")]
    FaceTaken { tetrahedron: u32, face: u8 },
    #[error("face {face} of tetrahedron {tetrahedron} would be glued to itself: glue it to another face, or to none")]
    FaceToItself { tetrahedron: u32, face: u8 },
}

impl Triangulation {
    /// Tetrahedra of which none is glued to any.
    pub fn new(tetrahedra: usize) -> Self {
        Self { neighbours: vec![[None; 4]; tetrahedra] }
    }

    /// Tetrahedra with gluings `(tetrahedron, face, other tetrahedron, corners)`, each given from one side.
    ///
    /// # Errors
    /// The first gluing that is not possible.
    pub fn from_gluings(tetrahedra: usize, gluings: &[(u32, u8, u32, Permutation)]) -> Result<Self, GluingError> {
        let mut triangulation = Self::new(tetrahedra);
        for &(tetrahedron, face, other, corners) in gluings {
            triangulation.glue(tetrahedron, face, other, corners)?;
        }
        Ok(triangulation)
    }

    /// Glues a face to the face of `other` opposite `corners.image(face)`, from both sides.
    ///
    /// # Errors
    /// When there is no such tetrahedron or face, when one of the faces is glued, or when they are the same.
    pub fn glue(&mut self, tetrahedron: u32, face: u8, other: u32, corners: Permutation) -> Result<(), GluingError> {
        let count = self.len();
        let is_missing = |&tetrahedron: &u32| tetrahedron as usize >= count;
        if let Some(tetrahedron) = [tetrahedron, other].into_iter().find(is_missing) {
            return Err(GluingError::NoTetrahedron { tetrahedron, count });
        }
        if face > 3 {
            return Err(GluingError::NoFace { tetrahedron, face });
        }
        let other_face = corners.image(face);
        if (tetrahedron, face) == (other, other_face) {
            return Err(GluingError::FaceToItself { tetrahedron, face });
        }
        let is_taken = |&(tetrahedron, face): &(u32, u8)| self.neighbour(tetrahedron, face).is_some();
        if let Some((tetrahedron, face)) = [(tetrahedron, face), (other, other_face)].into_iter().find(is_taken) {
            return Err(GluingError::FaceTaken { tetrahedron, face });
        }
        *self.slot(tetrahedron, face) = Some(Gluing { tetrahedron: other, corners });
        *self.slot(other, other_face) = Some(Gluing { tetrahedron, corners: corners.inverse() });
        Ok(())
    }

    /// Opens a face on both sides; what was on the other side, if it was glued.
    pub fn unglue(&mut self, tetrahedron: u32, face: u8) -> Option<Gluing> {
        let gluing = self.slot(tetrahedron, face).take()?;
        *self.slot(gluing.tetrahedron, gluing.corners.image(face)) = None;
        Some(gluing)
    }

    /// Adds a tetrahedron that is not glued; its number.
    pub fn add_tetrahedron(&mut self) -> u32 {
        self.neighbours.push([None; 4]);
        self.neighbours.len() as u32 - 1
    }

    /// The number of tetrahedra.
    pub fn len(&self) -> usize {
        self.neighbours.len()
    }

    /// Whether there are no tetrahedra.
    pub fn is_empty(&self) -> bool {
        self.neighbours.is_empty()
    }

    /// What is on the other side of a face; nothing if it is boundary.
    pub fn neighbour(&self, tetrahedron: u32, face: u8) -> Option<Gluing> {
        self.neighbours[tetrahedron as usize][usize::from(face)]
    }

    /// The faces that are not glued, as (tetrahedron, opposite corner).
    pub fn boundary_faces(&self) -> impl Iterator<Item = (u32, u8)> + '_ {
        self.faces().filter(|&(tetrahedron, face)| self.neighbour(tetrahedron, face).is_none())
    }

    /// All faces of all tetrahedra, as (tetrahedron, opposite corner); glued ones from both sides.
    pub fn faces(&self) -> impl Iterator<Item = (u32, u8)> + use<> {
        (0..self.len() as u32).flat_map(|tetrahedron| (0..4).map(move |face| (tetrahedron, face)))
    }

    /// Whether every face is glued.
    pub fn is_closed(&self) -> bool {
        self.boundary_faces().next().is_none()
    }

    fn slot(&mut self, tetrahedron: u32, face: u8) -> &mut Option<Gluing> {
        &mut self.neighbours[tetrahedron as usize][usize::from(face)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gluing_is_there_from_both_sides_until_it_is_opened() -> Result<(), GluingError> {
        let mut triangulation = Triangulation::new(2);
        let corners = Permutation::all().nth(10).unwrap();
        triangulation.glue(0, 2, 1, corners)?;
        let there = triangulation.neighbour(0, 2).unwrap();
        let back = triangulation.neighbour(1, corners.image(2)).unwrap();
        assert_eq!((there.tetrahedron, back.tetrahedron), (1, 0));
        assert_eq!(there.corners * back.corners, Permutation::IDENTITY);
        assert_eq!(triangulation.unglue(1, corners.image(2)), Some(back));
        assert_eq!(triangulation, Triangulation::new(2));
        Ok(())
    }

    #[test]
    fn impossible_gluings_are_named() {
        let mut one = Triangulation::new(1);
        let identity = Permutation::IDENTITY;
        assert_eq!(one.glue(0, 1, 2, identity), Err(GluingError::NoTetrahedron { tetrahedron: 2, count: 1 }));
        assert_eq!(one.glue(0, 4, 0, identity), Err(GluingError::NoFace { tetrahedron: 0, face: 4 }));
        assert_eq!(one.glue(0, 1, 0, identity), Err(GluingError::FaceToItself { tetrahedron: 0, face: 1 }));
    }
}
