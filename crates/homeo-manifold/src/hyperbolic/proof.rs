//! Proofs that a structure exists, and where it is.
//!
//! *Theorem (Krawczyk).* Let `F` be the angle sums less 2π as functions of the hyperbolic cosines `c` of the lengths, `X` a box
//! round `x`, `J` an enclosure of the derivatives of `F` on `X`, and `C` a matrix. If
//!
//! ```text
//! K = x - C F(x) + (I - C J) (X - x)
//! ```
//!
//! lies inside of `X`, touching none of its sides, then `F` has exactly one zero in `X`, and it lies in `K`. If moreover `Δ > 0`
//! for all tetrahedra on all of `X`, the zero makes truncated tetrahedra that fit round every edge: a complete hyperbolic
//! structure with totally geodesic boundary, unique by Mostow and Prasad. (`docs/theory/hyperbolic.md`)

use super::dense;
use super::enclosure::Enclosure;
use super::equations::Equations;
use super::refusal::{NoMetric, check_topology};
use super::solve::{Approximation, solve};
use super::volume::Volumes;
use crate::skeleton::Skeleton;
use crate::triangulation::Triangulation;

/// So many sizes of the box are tried, each 16 times the one before.
const SIZES: i32 = 6;

/// A proved structure with geodesic boundary. All enclosures hold the exact values.
///
/// # Example
/// ```
/// use homeo_manifold::hyperbolic::Structure;
/// use homeo_manifold::{Permutation, Skeleton, Triangulation};
/// let rows = [(0, [1, 2, 3, 0]), (1, [3, 0, 1, 2]), (2, [0, 3, 2, 1]), (3, [0, 2, 1, 3])];
/// let rows = rows.map(|(face, images)| (0, face, 1, Permutation::new(images).unwrap()));
/// let tripus = Triangulation::from_gluings(2, &rows)?;
/// let structure = Structure::find(&tripus, &Skeleton::new(&tripus))?;
/// assert!(structure.angles()[1][4].holds(std::f64::consts::FRAC_PI_6));
/// let volume = structure.volume();
/// assert!(volume.width() < 1e-10 && volume.low() < 6.451_990_270_84 && volume.high() > 6.451_990_270_83);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    approximation: Approximation,
    centre: Vec<f64>,
    radius: f64,
    cosh: Vec<Enclosure>,
    lengths: Vec<Enclosure>,
    angles: Vec<[Enclosure; 6]>,
    volumes: Vec<Enclosure>,
}

impl Structure {
    /// Finds and proves the structure of a triangulation.
    ///
    /// # Guarantee
    /// There is exactly one structure in which the tetrahedra are truncated ones, and its lengths, angles and volume are in the
    /// enclosures.
    ///
    /// # Errors
    /// As [`solve`], and [`NoMetric::NotProved`] when rounding is too coarse for a proof.
    pub fn find(triangulation: &Triangulation, skeleton: &Skeleton) -> Result<Self, NoMetric> {
        let approximation = solve(triangulation, skeleton)?;
        prove(triangulation, skeleton, approximation)
    }

    /// What was found before it was proved.
    pub fn approximation(&self) -> &Approximation {
        &self.approximation
    }

    /// The hyperbolic cosines of the lengths round which the proof was made: the centre of the box.
    pub fn centre(&self) -> &[f64] {
        &self.centre
    }

    /// Half the side of the box: each hyperbolic cosine is nearer than this to its value in [`centre`](Self::centre).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The hyperbolic cosine of the length of each edge.
    pub fn cosh_lengths(&self) -> &[Enclosure] {
        &self.cosh
    }

    /// The length of each edge.
    pub fn lengths(&self) -> &[Enclosure] {
        &self.lengths
    }

    /// The dihedral angles of each tetrahedron, in radians, in the order of [`EDGES`](crate::skeleton::EDGES).
    pub fn angles(&self) -> &[[Enclosure; 6]] {
        &self.angles
    }

    /// The volume of each tetrahedron.
    pub fn volumes(&self) -> &[Enclosure] {
        &self.volumes
    }

    /// The volume of the manifold.
    pub fn volume(&self) -> Enclosure {
        self.volumes.iter().fold(Enclosure::exact(0.0), |sum, &volume| sum + volume)
    }
}

/// Proves that there is a structure near lengths.
///
/// # Guarantee
/// As [`Structure::find`], whatever the lengths are.
///
/// # Errors
/// When the topology allows no structure, and [`NoMetric::NotProved`] when Krawczyk's test fails for all boxes tried: round
/// lengths that are not near a solution it always does.
///
/// # Complexity
/// `O(#T + #E^3)`.
pub fn prove(
    triangulation: &Triangulation,
    skeleton: &Skeleton,
    approximation: Approximation,
) -> Result<Structure, NoMetric> {
    check_topology(triangulation, skeleton)?;
    let not_proved = NoMetric::NotProved { curvature: approximation.curvature };
    let equations = Equations::new(skeleton);
    if approximation.lengths.len() != equations.edges() {
        return Err(not_proved);
    }
    let Some(box_found) = Test::new(&equations, &approximation.lengths).and_then(|test| test.search()) else {
        return Err(not_proved);
    };
    let BoxFound { centre, radius, cosh } = box_found;
    let tetrahedra: Vec<_> = equations.tetrahedra(&cosh).collect();
    let volumes = Volumes::new();
    Ok(Structure {
        approximation,
        centre,
        radius,
        lengths: cosh.iter().map(|cosh| cosh.inverse_cosh()).collect(),
        angles: tetrahedra.iter().map(|tetrahedron| tetrahedron.angles()).collect(),
        volumes: tetrahedra.iter().map(|tetrahedron| volumes.of(tetrahedron)).collect(),
        cosh,
    })
}

/// Krawczyk's test round a point.
struct Test<'a> {
    equations: &'a Equations,
    centre: Vec<f64>,
    /// The matrix `C`, row by row.
    inverse: Vec<f64>,
    /// `C F(x)`.
    correction: Vec<Enclosure>,
}

/// A box for which the test succeeds, and what is in it.
struct BoxFound {
    centre: Vec<f64>,
    radius: f64,
    cosh: Vec<Enclosure>,
}

impl<'a> Test<'a> {
    fn new(equations: &'a Equations, lengths: &[f64]) -> Option<Self> {
        let size = equations.edges();
        let mut values = equations.zero(0.0, 0.0);
        equations.near(lengths, &mut values);
        let lower = dense::factor(&values.slopes, size, 0.0)?;
        let mut inverse = dense::inverse(&lower, size);
        // Slopes are by lengths there, by hyperbolic cosines here: dc = sinh l dl.
        for (row, length) in inverse.chunks_exact_mut(size).zip(lengths) {
            row.iter_mut().for_each(|entry| *entry *= length.sinh());
        }
        let centre = lengths.iter().map(|length| length.cosh()).collect();
        let mut test = Self { equations, centre, inverse, correction: vec![] };
        // One step more, with angles that are better than those of the search.
        test.correct();
        test.centre.iter_mut().zip(&test.correction).for_each(|(centre, step)| *centre -= step.middle());
        test.correct();
        test.correction.iter().all(|step| step.magnitude().is_finite()).then_some(test)
    }

    fn correct(&mut self) {
        let points: Vec<Enclosure> = self.centre.iter().map(|&x| Enclosure::exact(x)).collect();
        let excess = self.equations.sure(&points).excess;
        let row = |row: &[f64]| {
            row.iter().zip(&excess).fold(Enclosure::exact(0.0), |sum, (&c, &f)| sum + Enclosure::exact(c) * f)
        };
        self.correction = self.inverse.chunks_exact(self.centre.len()).map(row).collect();
    }

    /// Tries boxes from small to large.
    fn search(self) -> Option<BoxFound> {
        let step = self.correction.iter().map(|step| step.magnitude()).fold(1e-15, f64::max);
        let (radius, first) = (0..SIZES).map(|size| 4.0 * step * 16f64.powi(size)).find_map(|radius| {
            let wide: Vec<Enclosure> = self.centre.iter().map(|x| Enclosure::between(x - radius, x + radius)).collect();
            let image = self.image(&wide)?;
            let is_inside = image.iter().zip(&wide).all(|(image, wide)| image.is_inside(*wide));
            is_inside.then_some((radius, image))
        })?;
        // The zero is in the image; slopes between it and the centre give a narrower one.
        let hull = |(image, &x): (&Enclosure, &f64)| Enclosure::between(image.low().min(x), image.high().max(x));
        let second = self.image(&first.iter().zip(&self.centre).map(hull).collect::<Vec<_>>())?;
        let cosh = first.iter().zip(second).map(|(a, b)| a.common(b)).collect::<Option<Vec<_>>>()?;
        Some(BoxFound { centre: self.centre, radius, cosh })
    }

    /// `K`; nothing unless all tetrahedra are proper on the whole box.
    fn image(&self, wide: &[Enclosure]) -> Option<Vec<Enclosure>> {
        let size = self.centre.len();
        if wide.iter().any(|cosh| cosh.low() <= 1.0) {
            return None;
        }
        let values = self.equations.sure(wide);
        if values.flat.is_some() {
            return None;
        }
        let offsets: Vec<Enclosure> = wide.iter().zip(&self.centre).map(|(w, &x)| *w - Enclosure::exact(x)).collect();
        let image = (0..size).map(|row| {
            let mut sum = Enclosure::exact(self.centre[row]) - self.correction[row];
            for (column, &offset) in offsets.iter().enumerate() {
                let mut defect = Enclosure::exact(f64::from(u8::from(row == column)));
                for k in 0..size {
                    defect = defect - Enclosure::exact(self.inverse[row * size + k]) * values.slopes[k * size + column];
                }
                sum = sum + defect * offset;
            }
            sum
        });
        Some(image.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::testing;

    #[test]
    fn known_angles_lengths_and_volumes_are_in_narrow_enclosures() {
        let mut count = 0;
        for entry in testing::census() {
            let Some(known) = &entry.geometry else { continue };
            let skeleton = Skeleton::new(&entry.triangulation);
            let found = Structure::find(&entry.triangulation, &skeleton).unwrap();
            // Known values are rounded to a double.
            let near = |found: Enclosure, known: f64| {
                let rounding = 2.0 * f64::EPSILON * known;
                found.low() - rounding <= known && known <= found.high() + rounding && found.width() < 1e-10
            };
            for tetrahedron in 0..entry.triangulation.len() {
                for edge in 0..6 {
                    assert!(near(found.angles()[tetrahedron][edge], known.angles[tetrahedron][edge]), "{}", entry.name);
                    let class = skeleton.edges_of(tetrahedron as u32)[edge] as usize;
                    assert!(near(found.lengths()[class], known.lengths[tetrahedron][edge]), "{}", entry.name);
                }
            }
            assert!(near(found.volume(), known.volume), "{} {:?} {}", entry.name, found.volume(), known.volume);
            count += 1;
        }
        assert!(count >= 10, "{count}");
    }

    /// Negative control: near is not enough, and what only tends to a solution has no proof.
    #[test]
    fn nothing_is_proved_away_from_a_solution() {
        let (mut moved, mut escaping) = (0, 0);
        for entry in testing::census() {
            let skeleton = Skeleton::new(&entry.triangulation);
            let edges = skeleton.edges().len();
            let with = |lengths| Approximation {
                lengths,
                curvature: 0.0,
                steps: 0,
                method: crate::hyperbolic::Method::Newton,
            };
            match solve(&entry.triangulation, &skeleton) {
                Ok(found) => {
                    for edge in 0..edges {
                        let mut lengths = found.lengths.clone();
                        lengths[edge] += 0.2;
                        match prove(&entry.triangulation, &skeleton, with(lengths)) {
                            Err(refusal) => assert!(matches!(refusal, NoMetric::NotProved { .. })),
                            // A wide box may reach back to the solution.
                            Ok(proved) => assert!((proved.lengths()[edge].middle() - found.lengths[edge]).abs() < 1e-6),
                        }
                        moved += 1;
                    }
                }
                Err(NoMetric::NoAngles { obstruction }) => {
                    for length in [4.0, 8.0, 12.0] {
                        let lengths = obstruction.weights().iter().map(|&z| 0.7 + length * z as f64).collect();
                        assert!(prove(&entry.triangulation, &skeleton, with(lengths)).is_err());
                        escaping += 1;
                    }
                }
                Err(_) => {}
            }
        }
        assert!(moved >= 15 && escaping >= 6, "{moved} {escaping}");
    }
}
