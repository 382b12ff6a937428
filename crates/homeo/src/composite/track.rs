//! Images in doubles, and preimages of points that follow one another closely: each search begins at the result before.

use homeo_core::planar::Point2;
use rayon::prelude::*;

use super::chart::Step;
use super::map::CompositeMap;
use crate::coordinates::MeanValue;
use crate::map::PlanarBijection;

/// A search has ended when the image is as near as this, as a part of the target's size.
const TOLERANCE: f64 = 1e-10;
/// Where this many steps of Newton's method are not enough, the search with a proof takes over.
const NEWTON_STEPS: usize = 8;

/// The points that the last one passed on its way, from the source to the target.
pub(super) struct Track<'a> {
    map: &'a CompositeMap,
    /// Points of each domain but the last, with the inverse of the derivative of the step there; empty if nothing is known.
    last: Vec<(Point2, [Point2; 2])>,
    /// The point of the target.
    end: Point2,
    tolerance: f64,
}

impl<'a> Track<'a> {
    pub fn new(map: &'a CompositeMap) -> Self {
        let [low, high] = map.target().bounds();
        let tolerance = TOLERANCE * (high[0] - low[0]).max(high[1] - low[1]);
        Self { map, last: Vec::new(), end: [0.0; 2], tolerance }
    }

    /// The preimage of a point; `None` outside the target, and where there is no answer.
    pub fn preimage(&mut self, point: Point2) -> Option<Point2> {
        if !self.map.target().contains(point) {
            return None;
        }
        let found = self.search(point);
        if found.is_none() {
            self.last.clear();
        }
        found.or_else(|| self.map.inverse(point).ok().map(|answer| answer.point))
    }

    /// Step by step backwards; each step inverted near where it was for the point before.
    fn search(&mut self, point: Point2) -> Option<Point2> {
        let (mut here, mut end) = (point, self.end);
        let steps = self.map.steps();
        let mut passed = Vec::with_capacity(steps.len());
        for (number, (step, domain)) in steps.iter().zip(self.map.domains()).enumerate().rev() {
            let guess = match self.last.get(number) {
                Some(&(at, inverse)) => {
                    let way = apply(inverse, [here[0] - end[0], here[1] - end[1]]);
                    end = at;
                    [at[0] + way[0], at[1] + way[1]]
                }
                None => plain_value(&self.map.backward()[number], here)?.0,
            };
            let (at, inverse) = newton(step, guess, here, self.tolerance)?;
            // The only preimage is in the domain; what is outside is none.
            if !domain.contains(at) {
                return None;
            }
            passed.push((at, inverse));
            here = at;
        }
        passed.reverse();
        (self.last, self.end) = (passed, point);
        Some(here)
    }
}

fn apply([first, second]: [Point2; 2], v: Point2) -> Point2 {
    [first[0] * v[0] + first[1] * v[1], second[0] * v[0] + second[1] * v[1]]
}

/// Images of points in doubles; `None` outside the source, and where there is no answer. Points go through every step
/// together: see [`MeanValue::apply`].
pub(super) fn images(map: &CompositeMap, points: &[Point2]) -> Vec<Option<Point2>> {
    let inside: Vec<bool> = points.par_iter().map(|&point| map.source().contains(point)).collect();
    let mut at: Vec<Point2> = points.iter().zip(&inside).filter(|(_, is_in)| **is_in).map(|(&p, _)| p).collect();
    for (step, domain) in map.steps().iter().zip(map.domains()) {
        match MeanValue::new(domain).apply(&at, &step.images) {
            Ok(next) => at = next,
            // Only of points that are not finite, which no step makes of others.
            Err(_) => return vec![None; points.len()],
        }
    }
    let mut found = at.into_iter();
    inside.into_iter().map(|is_in| if is_in { found.next() } else { None }).collect()
}

/// A point that goes near another, and the inverse of the derivative there.
fn newton(step: &Step, mut at: Point2, wanted: Point2, tolerance: f64) -> Option<(Point2, [Point2; 2])> {
    for _ in 0..NEWTON_STEPS {
        let (image, [[a, b], [c, d]]) = plain_value(step, at)?;
        let determinant = a * d - b * c;
        let inverse = [[d / determinant, -b / determinant], [-c / determinant, a / determinant]];
        let miss = [wanted[0] - image[0], wanted[1] - image[1]];
        if miss[0].abs().max(miss[1].abs()) < tolerance {
            return (determinant > 0.0).then_some((at, inverse));
        }
        let way = apply(inverse, miss);
        at = [at[0] + way[0], at[1] + way[1]];
    }
    None
}

/// The mean value map and its derivative, without charts: `None` where a divisor is zero.
///
/// With the vectors `a`, `b` to the ends of an edge, `t = a x b / (r r' + a . b)`, or `(r r' - a . b) / a x b`, its half tangent,
/// it adds `t (p / r + q / r')` to the sums of images, and the same with 1 in the place of images to those of weights.
fn plain_value(step: &Step, at: Point2) -> Option<(Point2, [Point2; 2])> {
    let seen = |vertex: usize| {
        let [x, y] = step.points[vertex];
        let vector = [x - at[0], y - at[1]];
        let distance = (vector[0] * vector[0] + vector[1] * vector[1]).sqrt();
        (vector, distance, 1.0 / distance)
    };
    // Weights, then both coordinates of images: value and gradient each.
    let mut sums = [[0.0; 3]; 3];
    let mut from = seen(0);
    for (i, &next) in step.next.iter().enumerate() {
        let to = seen(next as usize);
        let ((a, r, inverse), (b, s, other)) = (from, to);
        let (sine, cosine, product) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1], r * s);
        let t = if cosine < 0.0 { (product - cosine) / sine } else { sine / (product + cosine) };
        // Gradients: (1 + t^2) / 2 times that of the angle, and `a / r^3` of `1 / r`.
        let rate = 0.5 + 0.5 * t * t;
        let (near, far) = (inverse * inverse, other * other);
        let turned = [b[1] * far - a[1] * near, a[0] * near - b[0] * far].map(|x| rate * x);
        let shares = [(inverse, a, near, step.images[i]), (other, b, far, step.images[next as usize])];
        for (inverse, vector, square, image) in shares {
            let weight = t * inverse;
            let slope = |k: usize| turned[k] * inverse + weight * square * vector[k];
            let weight = [weight, slope(0), slope(1)];
            for k in 0..3 {
                sums[0][k] += weight[k];
                sums[1][k] += weight[k] * image[0];
                sums[2][k] += weight[k] * image[1];
            }
        }
        // Vertices are numbered ring after ring.
        from = if next as usize == i + 1 {
            to
        } else if i + 1 < step.points.len() {
            seen(i + 1)
        } else {
            to
        };
    }
    let [weight, x, y] = sums;
    let image = [x[0] / weight[0], y[0] / weight[0]];
    let row = |sum: [f64; 3], value: f64| [1, 2].map(|k| (sum[k] - value * weight[k]) / weight[0]);
    let derivative = [row(x, image[0]), row(y, image[1])];
    image.iter().chain(derivative.as_flattened()).all(|x| x.is_finite()).then_some((image, derivative))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::composite::PartitionParams;
    use crate::progress::Silent;
    use crate::shape::TurningPath;
    use homeo_core::planar::DomainPair;

    #[test]
    fn rows_have_the_preimages_that_are_proved() {
        let ring = |scale: f64, turn: f64| -> Vec<Point2> {
            let corner = |k: usize| {
                let angle = turn + std::f64::consts::FRAC_PI_2 * k as f64;
                [scale * angle.cos(), scale * angle.sin()]
            };
            (0..4).map(corner).collect()
        };
        let hole = |turn: f64| ring(0.4, turn).into_iter().rev().collect::<Vec<_>>();
        let rings = |turn: f64| vec![ring(2.0, 0.0), hole(turn)];
        let pair = DomainPair::new(rings(0.0), rings(0.3)).unwrap();
        let (map, _) =
            CompositeMap::build(&TurningPath::between(&pair, &[]).unwrap(), &PartitionParams::default(), &Silent)
                .unwrap();
        let (mut inside, mut outside, mut by_search) = (0, 0, 0);
        let mut track = Track::new(&map);
        let mut forth = 0;
        for row in 0..40 {
            let points: Vec<Point2> =
                (0..160).map(|k| [f64::from(k) * 0.03 - 2.4, f64::from(row) * 0.11 - 2.2]).collect();
            let mut found = vec![None; points.len()];
            map.inverse_along(&points, &mut found);
            for (&point, found) in points.iter().zip(found) {
                let Some(found) = found else {
                    assert!(!pair.target.contains(point), "{point:?}");
                    outside += 1;
                    continue;
                };
                by_search += usize::from(track.search(point).is_some());
                let proved = map.inverse(point).unwrap();
                let miss = (0..2).map(|k| (found[k] - proved.point[k]).abs()).fold(0.0, f64::max);
                assert!(miss < 1e-8 + proved.radius, "{point:?}: {found:?}, not {proved:?}");
                inside += 1;
                let mut image = [None];
                map.forward_along(&[found], &mut image);
                // A point on the boundary may come back outside.
                let Some(image) = image[0] else { continue };
                assert!((0..2).all(|k| (image[k] - point[k]).abs() < 1e-8), "{point:?} comes from {found:?}");
                forth += 1;
            }
        }
        assert!(inside > 2000 && outside > 2000 && forth + 100 > inside, "{inside} {outside} {forth}");
        assert!(by_search * 100 > inside * 99, "the search fails for {} of {inside}", inside - by_search);
    }
}
