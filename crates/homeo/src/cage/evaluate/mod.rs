//! Images and preimages under maps between cages, with bounds of their errors.

use super::enclosure::{Form, Step};
use super::inside::{along_triangle, contains, is_fit};
use super::map::CageMap;
use crate::map::Enclosed;

type Point3 = [f64; 3];
type Region = [Form; 3];

/// Why a point has no image under a map between cages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CageEvaluationError {
    /// A coordinate is not finite, or not zero and not between `2^-300` and `2^300` in size.
    #[error("the point has a coordinate that is not a finite number of reasonable size")]
    NotFinite,
    /// The point is not in the source cage, exactly.
    #[error("the point lies outside the source cage")]
    OutsideSource,
    /// The point is not in the target cage, exactly.
    #[error("the point lies outside the target cage")]
    OutsideTarget,
    /// Enclosures grew too large.
    #[error(
        "the image after step {0} is not known: the point is too near to an edge or a vertex of the cage, and not on it"
    )]
    TooWide(usize),
    /// The preimage was not proved to be near the point found.
    #[error("the preimage under step {0} is not proved: it is too near to the cage, and not on it")]
    NotProved(usize),
}

/// The steps of a map, ready to be evaluated both ways.
///
/// # Example
/// ```
/// use homeo::cage::{CageEvaluator, CageMap, CagePair};
/// use homeo::shape::StraightPolyhedra;
/// let tent = |top| vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0], top];
/// let triangles = vec![[0, 3, 2], [0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
/// let cages = CagePair::new(tent([0.0, 0.0, 3.0]), tent([1.0, 0.0, 3.0]), triangles)?;
/// let path = StraightPolyhedra::new(cages.source().to_vec(), cages.target().to_vec())?;
/// let map = CageMap::along(&cages, &path, 1)?;
/// let evaluator = CageEvaluator::new(&map);
/// let image = evaluator.forward([0.5, 0.25, 1.0])?;
/// let back = evaluator.inverse(image.point)?;
/// assert!(image.radius < 1e-11 && back.radius < 1e-10);
/// assert!((back.point[0] - 0.5).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CageEvaluator<'a> {
    map: &'a CageMap,
    steps: Vec<Step>,
    /// From each cage to the one before: near the inverse, to begin the search for it with.
    backward: Vec<Step>,
    /// The extent of each cage, roughly.
    sizes: Vec<f64>,
}

impl<'a> CageEvaluator<'a> {
    /// What is computed once for all points.
    pub fn new(map: &'a CageMap) -> Self {
        let step = |from: &[Point3], to: &[Point3]| Step::new(from, to, map.triangles());
        let steps = map.stages().windows(2).map(|pair| step(&pair[0], &pair[1])).collect();
        let backward = map.stages().windows(2).map(|pair| step(&pair[1], &pair[0])).collect();
        Self { map, steps, backward, sizes: map.stages().iter().map(|stage| extent(stage)).collect() }
    }

    /// Image of a point inside of the source cage or on it.
    ///
    /// # Guarantee
    /// The exact image lies within the radius. Points on triangles are sent along their triangle, in rationals.
    ///
    /// # Errors
    /// When the point is not in the source, exactly; or enclosures became useless, near edges and vertices of a cage.
    ///
    /// # Complexity
    /// Linear in triangles and steps.
    pub fn forward(&self, point: Point3) -> Result<Enclosed, CageEvaluationError> {
        if let Some(image) = self.on_cage([0, self.steps.len()], point, CageEvaluationError::OutsideSource)? {
            return Ok(image);
        }
        let mut here: Region = point.map(Form::exact);
        for (number, step) in self.steps.iter().enumerate() {
            here = step.enclose(here);
            if !is_known(&here) {
                return Err(CageEvaluationError::TooWide(number));
            }
        }
        Ok(enclosed(&here))
    }

    /// The point whose image is given.
    ///
    /// # Guarantee
    /// If every step is a homeomorphism of the insides, as a certificate says, the exact preimage lies within the radius. It is
    /// proved by Miranda's theorem: of a cube about the point found every pair of opposite faces goes to different
    /// sides of what is given.
    ///
    /// # Errors
    /// When the point is not in the target, exactly; or the preimage is not proved, near to a cage.
    ///
    /// # Complexity
    /// Some ten times [`forward`](Self::forward).
    pub fn inverse(&self, point: Point3) -> Result<Enclosed, CageEvaluationError> {
        if let Some(preimage) = self.on_cage([self.steps.len(), 0], point, CageEvaluationError::OutsideTarget)? {
            return Ok(preimage);
        }
        let mut here = Enclosed { point, radius: 0.0 };
        for number in (0..self.steps.len()).rev() {
            let found = self.newton(number, here.point).and_then(|at| self.prove_near(number, at, here));
            here = found.ok_or(CageEvaluationError::NotProved(number))?;
        }
        Ok(here)
    }

    /// The derivative at a point inside of the source, rounded; rows are the gradients of the coordinates of the image. `None`
    /// outside, and too near to the cage.
    pub fn jacobian(&self, point: Point3) -> Option<[[f64; 3]; 3]> {
        let (mut at, mut product) = (point, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        check_coordinates(point).ok().filter(|()| contains(self.stage(0), self.map.triangles(), point))?;
        for number in 0..self.steps.len() {
            let (next, own) = self.linear(number, at)?;
            at = next;
            product = own.map(|row| [0, 1, 2].map(|k| (0..3).map(|l| row[l] * product[l][k]).sum()));
        }
        Some(product)
    }

    /// Where a point on one cage is on another; none inside, the error outside.
    fn on_cage(
        &self,
        [from, to]: [usize; 2],
        point: Point3,
        outside: CageEvaluationError,
    ) -> Result<Option<Enclosed>, CageEvaluationError> {
        check_coordinates(point)?;
        let triangles = self.map.triangles();
        match along_triangle([self.stage(from), self.stage(to)], triangles, point) {
            None if !contains(self.stage(from), triangles, point) => Err(outside),
            found => Ok(found),
        }
    }

    /// Value and derivative of a step, rounded; none where too little is known.
    fn linear(&self, number: usize, at: Point3) -> Option<(Point3, [[f64; 3]; 3])> {
        let by = SMALL * self.sizes[number];
        let there = self.steps[number].enclose(cube(at, by));
        is_known(&there).then(|| (there.map(|c| c.middle), there.map(|c| c.slopes.map(|x| x / by))))
    }

    fn stage(&self, number: usize) -> &[Point3] {
        &self.map.stages()[number]
    }

    /// A point inside of a cage whose image under the step from it is as near as rounding allows.
    fn newton(&self, number: usize, image: Point3) -> Option<Point3> {
        let is_inside =
            |at: &Point3| at.iter().all(|x| x.is_finite()) && contains(self.stage(number), self.map.triangles(), *at);
        let linear = |at: Point3| {
            let (there, derivative) = self.linear(number, at)?;
            Some(([0, 1, 2].map(|k| image[k] - there[k]), derivative))
        };
        let guess = self.backward[number].enclose(image.map(Form::exact)).map(|c| c.middle);
        let mut at =
            [guess, image].into_iter().chain(self.centres(number)).find(|at| is_inside(at) && linear(*at).is_some())?;
        let (mut miss, mut derivative) = linear(at)?;
        let rounding = 4.0 * f64::EPSILON * self.sizes[number + 1];
        for _ in 0..60 {
            if norm(miss) < rounding {
                break;
            }
            let inverse = inverted(derivative)?;
            let way = [0, 1, 2].map(|k| (0..3).map(|l| inverse[k][l] * miss[l]).sum::<f64>());
            // Shorter and shorter, until it is an improvement inside.
            let attempts = (0..30).map(|halvings| 0.5f64.powi(halvings));
            let better = attempts.map(|part| [0, 1, 2].map(|k| at[k] + part * way[k])).find_map(|next| {
                let (next_miss, next_derivative) = is_inside(&next).then(|| linear(next)).flatten()?;
                (norm(next_miss) < norm(miss)).then_some((next, next_miss, next_derivative))
            });
            let Some(next) = better else { break };
            (at, miss, derivative) = next;
        }
        Some(at)
    }

    /// Points inside of a cage, perhaps: a little below the middles of its triangles, on either side.
    fn centres(&self, number: usize) -> impl Iterator<Item = Point3> {
        let points = self.stage(number);
        self.map.triangles().iter().flat_map(move |triangle| {
            let [a, b, c] = triangle.map(|v| points[v as usize]);
            let middle = [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0);
            let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
            let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            let scale = 0.1 / norm(normal).sqrt();
            [-scale, scale].map(|by| [0, 1, 2].map(|k| middle[k] + by * normal[k]))
        })
    }

    /// That the preimage of what is enclosed is near a point.
    fn prove_near(&self, number: usize, point: Point3, image: Enclosed) -> Option<Enclosed> {
        let step = &self.steps[number];
        let mut radius = 4.0 * f64::EPSILON * self.sizes[number] + image.radius;
        for _ in 0..40 {
            let about = cube(point, radius);
            if !step.is_clear(about) || !contains(self.stage(number), self.map.triangles(), point) {
                return None;
            }
            let there = step.enclose(about);
            if is_known(&there) && crosses(&there, image) {
                return Some(Enclosed { point, radius });
            }
            radius *= 2.0;
        }
        None
    }
}

/// Of the size of a cage: the cube in which derivatives are taken.
const SMALL: f64 = 1e-7;

/// Whether the faces of a cube lie on different sides of what is enclosed, each pair in one of three directions.
fn crosses(there: &Region, image: Enclosed) -> bool {
    let Some(inverse) = inverted(there.map(|c| c.slopes)) else { return false };
    let missed = [0, 1, 2].map(|k| (there[k] - Form::exact(image.point[k])).widened(image.radius));
    (0..3).all(|k| {
        let row = [0, 1, 2].map(|l| Form::exact(inverse[k][l]) * missed[l]);
        let along = row[0] + row[1] + row[2];
        // On the face where coordinate `k` is 1, and where it is -1.
        let others = along.deviation() - along.slopes[k].abs();
        let rounded = 8.0 * f64::EPSILON * (along.deviation() + along.middle.abs());
        along.slopes[k] > along.middle.abs() + others + rounded
    })
}

fn extent(points: &[Point3]) -> f64 {
    let from = points.first().copied().unwrap_or_default();
    points.iter().map(|p| norm([0, 1, 2].map(|k| p[k] - from[k]))).fold(0.0, f64::max)
}

fn cube(at: Point3, by: f64) -> Region {
    [0, 1, 2].map(|k| Form::about(at[k], by, k))
}

fn is_known(at: &Region) -> bool {
    at.iter().all(|c| c.deviation().is_finite() && c.middle.is_finite())
}

fn enclosed(at: &Region) -> Enclosed {
    let radius = at.iter().map(|c| c.deviation()).fold(0.0, f64::max);
    Enclosed { point: at.map(|c| c.middle), radius }
}

fn check_coordinates(point: Point3) -> Result<(), CageEvaluationError> {
    if is_fit(&point) { Ok(()) } else { Err(CageEvaluationError::NotFinite) }
}

fn inverted(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|k| m[0][k] * minor(0, k)).sum();
    let inverse = [0, 1, 2].map(|i| [0, 1, 2].map(|j| minor(j, i) / determinant));
    inverse.iter().flatten().all(|x| x.is_finite()).then_some(inverse)
}

fn norm(a: Point3) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

#[cfg(test)]
mod tests;
