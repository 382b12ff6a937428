//! A Laplacian with one vertex held, factored once.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

use super::SolveError;

/// The Laplacian of the edges of triangles, each with as many units of weight as triangles have it; vertex 0 is held at 0.
#[derive(Debug)]
pub struct GroundedLaplacian {
    factor: Llt<usize, f64>,
}

impl GroundedLaplacian {
    /// Of triangles with corners among `vertex_count` vertices, all of them joined by triangles.
    ///
    /// # Errors
    /// Some vertex is not joined to vertex 0.
    ///
    /// # Complexity
    /// One sparse factorization.
    pub fn of_triangles(vertex_count: usize, triangles: &[[u32; 3]]) -> Result<Self, SolveError> {
        let mut triplets = Vec::with_capacity(9 * triangles.len());
        for corners in triangles {
            for k in 0..3 {
                let (i, j) = (corners[k] as usize, corners[(k + 1) % 3] as usize);
                triplets.extend([Triplet::new(i, i, 1.0), Triplet::new(j, j, 1.0)]);
                // Vertex 0 is held: its row and column go.
                if i > 0 && j > 0 {
                    triplets.push(Triplet::new(i.max(j), i.min(j), -1.0));
                }
            }
        }
        let failed = |what: &str| SolveError::new(what);
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(vertex_count, vertex_count, &triplets)
            .map_err(|_| failed("the matrix could not be built"))?;
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower)
            .map_err(|_| failed("the symbolic factorization failed"))?;
        let factor = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower)
            .map_err(|_| failed("the triangles fall into pieces, or leave vertices out"))?;
        Ok(Self { factor })
    }

    /// Solves `L x = load` for three columns (#V by 3).
    pub fn solve(&self, mut load: Mat<f64>) -> Vec<[f64; 3]> {
        (0..load.ncols()).for_each(|m| load[(0, m)] = 0.0);
        let solution = self.factor.solve(&load);
        (0..load.nrows()).map(|i| [0, 1, 2].map(|m| solution[(i, m)])).collect()
    }
}
