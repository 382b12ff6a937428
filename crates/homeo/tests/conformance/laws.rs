//! What every map must do, whatever made it.
//!
//! Laws give `Err` with the point where they are broken, so that the suite can also show that they
//! notice broken maps.

use std::collections::HashMap;

use homeo::map::{Bijection, Enclosed, EvaluationError, Target};
use homeo_core::number::Rational;

use crate::points::{Places, Point, SourcePoint, exact, is_in_target, is_on_target_boundary, rounded};

pub type Law = Result<(), String>;

macro_rules! require {
    ($condition:expr, $($message:tt)+) => {
        if !$condition {
            return Err(format!($($message)+));
        }
    };
}

/// What a map leads onto.
pub trait Image {
    fn contains(&self, point: &Point) -> bool;

    /// For a point in it.
    fn has_on_boundary(&self, point: &Point) -> bool;

    /// Whether points in floating point are those of a round form of it.
    fn is_round(&self) -> bool {
        false
    }

    /// The point in floating point that stands for an exact one, and the suite's own rounding of it.
    fn round(&self, point: &Point) -> ([f64; 3], f64) {
        (rounded(point), 0.0)
    }

    /// How many coordinates of its points change.
    fn dimension(&self) -> usize {
        3
    }

    /// What is said of these points outside.
    fn outside(&self) -> (EvaluationError, Vec<[f64; 3]>);
}

impl Image for Target {
    fn contains(&self, point: &Point) -> bool {
        is_in_target(*self, point)
    }

    fn has_on_boundary(&self, point: &Point) -> bool {
        is_on_target_boundary(*self, point)
    }

    fn is_round(&self) -> bool {
        self.is_radial()
    }

    fn round(&self, point: &Point) -> ([f64; 3], f64) {
        round_point(*self, point)
    }

    fn dimension(&self) -> usize {
        Target::dimension(*self)
    }

    fn outside(&self) -> (EvaluationError, Vec<[f64; 3]>) {
        let beyond = |axis: usize| std::array::from_fn(|k| if k == axis { 1.0 + 1e-9 } else { 0.0 });
        (EvaluationError::OutsideTarget(*self), (0..3).map(beyond).collect())
    }
}

impl<const K: usize> Image for Places<'_, K> {
    fn contains(&self, point: &Point) -> bool {
        self.is_in_mesh(point)
    }

    fn has_on_boundary(&self, point: &Point) -> bool {
        self.is_on_boundary(point)
    }

    fn outside(&self) -> (EvaluationError, Vec<[f64; 3]>) {
        (EvaluationError::OutsideMoved, self.far_points())
    }
}

fn evaluated<T>(result: Result<T, EvaluationError>, what: &str, at: &Point) -> Result<T, String> {
    result.map_err(|error| format!("{what} at {at:?}: {error}"))
}

/// `inverse(forward(p)) = p`, in the target, boundary onto boundary, different images of different points.
pub fn source_points_come_back(map: &dyn Bijection, onto: &dyn Image, points: &[SourcePoint]) -> Law {
    let mut images: HashMap<Point, &Point> = HashMap::new();
    for SourcePoint { at, on_boundary } in points {
        let image = evaluated(map.forward_exact(at), "forward", at)?;
        require!(onto.contains(&image), "{at:?} goes to {image:?}, outside the target");
        let is_boundary = onto.has_on_boundary(&image);
        require!(is_boundary == *on_boundary, "{at:?} (boundary: {on_boundary}) goes to {image:?}");
        let back = evaluated(map.inverse_exact(&image), "inverse", &image)?;
        require!(back == *at, "{at:?} goes to {image:?} and comes back as {back:?}");
        let first = images.entry(image.clone()).or_insert(at);
        require!(*first == at, "{first:?} and {at:?} both go to {image:?}");
    }
    Ok(())
}

/// `forward(inverse(q)) = q`, boundary from boundary, different preimages of different points.
pub fn target_points_come_back(
    map: &dyn Bijection,
    onto: &dyn Image,
    points: &[Point],
    is_on_source_boundary: &dyn Fn(&Point) -> bool,
) -> Law {
    let mut preimages: HashMap<Point, &Point> = HashMap::new();
    for at in points {
        let preimage = evaluated(map.inverse_exact(at), "inverse", at)?;
        let back = evaluated(map.forward_exact(&preimage), "forward", &preimage)?;
        require!(back == *at, "{at:?} comes from {preimage:?}, which goes to {back:?}");
        let is_boundary = onto.has_on_boundary(at);
        require!(is_on_source_boundary(&preimage) == is_boundary, "{at:?} (boundary: {is_boundary}) is {preimage:?}");
        let first = preimages.entry(preimage.clone()).or_insert(at);
        require!(*first == at, "{first:?} and {at:?} both come from {preimage:?}");
    }
    Ok(())
}

/// Rounding of the round disk and ball in the suite's own arithmetic.
const ROUND: f64 = 1e-14;

/// The round point that a point of the exact target stands for, and the suite's own rounding of it.
fn round_point(target: Target, q: &Point) -> ([f64; 3], f64) {
    let [x, y, z] = rounded(q);
    match target {
        Target::Square | Target::Cube => ([x, y, z], 0.0),
        Target::Disk => {
            let r = x.abs() + y.abs();
            if r == 0.0 {
                return ([0.0; 3], 0.0);
            }
            // Along the side on which it lies.
            let quarter = match (x > 0.0, y >= 0.0) {
                (true, true) => y / r,
                (false, true) if y > 0.0 => 1.0 - x / r,
                (false, _) if x < 0.0 => 2.0 - y / r,
                _ => 3.0 + x / r,
            };
            let (sin, cos) = (quarter * std::f64::consts::FRAC_PI_2).sin_cos();
            ([r * cos, r * sin, 0.0], ROUND)
        }
        Target::Ball => {
            let size = (x * x + y * y + z * z).sqrt();
            let planes = [x + y + z, x - y - z, -x - y + z, -x + y - z];
            let gauge = -2.0 * planes.into_iter().fold(f64::INFINITY, f64::min);
            if size == 0.0 { ([0.0; 3], 0.0) } else { ([x, y, z].map(|c| c / size * gauge), ROUND) }
        }
    }
}

fn is_sound(answer: &Enclosed) -> bool {
    answer.point.iter().all(|x| x.is_finite()) && answer.radius.is_finite() && answer.radius >= 0.0
}

/// Whether an answer encloses an exact point, with some slack.
fn encloses(answer: &Enclosed, at: &Point, slack: f64) -> bool {
    let reach = &Rational::from_f64(answer.radius).expect("finite") + &Rational::from_f64(slack).expect("finite");
    (0..3).all(|axis| {
        let off = &Rational::from_f64(answer.point[axis]).expect("finite") - &at[axis];
        off <= reach && -off <= reach
    })
}

fn is_near(answer: &Enclosed, to: [f64; 3], slack: f64) -> bool {
    (0..3).all(|axis| (answer.point[axis] - to[axis]).abs() <= answer.radius + slack)
}

/// Floating point encloses the exact image of each of the doubles that is a point of the mesh.
///
/// Doubles near the mesh get an answer too. Gives how many were compared.
pub fn floating_images_enclose(map: &dyn Bijection, onto: &dyn Image, points: &[SourcePoint]) -> Result<usize, String> {
    let mut compared = 0;
    for SourcePoint { at, .. } in points {
        let near = rounded(at);
        let answer = evaluated(map.forward(near), "forward in floating point", &exact(near))?;
        require!(is_sound(&answer), "forward at {near:?} gives {answer:?}");
        let Ok(image) = map.forward_exact(&exact(near)) else { continue };
        compared += 1;
        let (round, slack) = onto.round(&image);
        let agrees = if onto.is_round() { is_near(&answer, round, slack) } else { encloses(&answer, &image, 0.0) };
        require!(agrees, "forward at {near:?} gives {answer:?} but exactly {round:?}");
    }
    Ok(compared)
}

/// Floating point encloses exact preimages: of the very double onto square and cube, of the
/// polyhedral point that it stands for, with slack for what rounding it does, onto disk and ball.
///
/// Doubles near a mesh that has moved get an answer too.
pub fn floating_preimages_enclose(map: &dyn Bijection, onto: &dyn Image, points: &[Point]) -> Law {
    for at in points {
        let (near, _) = onto.round(at);
        let answer = evaluated(map.inverse(near), "inverse in floating point", &exact(near))?;
        require!(is_sound(&answer), "inverse at {near:?} gives {answer:?}");
        if onto.is_round() {
            let there = rounded(&evaluated(map.inverse_exact(at), "inverse", at)?);
            let slack = movement(map, onto, at, there)?;
            require!(
                is_near(&answer, there, slack),
                "inverse at {near:?} gives {answer:?}, not {there:?} within {slack:e}"
            );
        } else if onto.contains(&exact(near)) {
            let exactly = evaluated(map.inverse_exact(&exact(near)), "inverse", &exact(near))?;
            require!(
                encloses(&answer, &exactly, 0.0),
                "inverse at {near:?} gives {answer:?}, not {:?}",
                rounded(&exactly)
            );
        }
    }
    Ok(())
}

/// Far more than what the preimage moves when a point of the target moves by rounding.
fn movement(map: &dyn Bijection, onto: &dyn Image, at: &Point, there: [f64; 3]) -> Result<f64, String> {
    let step = Rational::from_f64(1e-10).expect("finite");
    let size = there.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut most = 1e-12 * size;
    for axis in 0..onto.dimension() {
        for sign in [1, -1] {
            let mut moved = at.clone();
            moved[axis] = &moved[axis] + &(&step * &Rational::from(sign));
            if let Ok(point) = map.inverse_exact(&moved) {
                let off = rounded(&point).iter().zip(there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                most = most.max(off);
            }
        }
    }
    Ok(most)
}

/// Two maps give the same answers to the last bit.
pub fn answers_are_the_same(
    [one, other]: [&dyn Bijection; 2],
    onto: &dyn Image,
    from: &[SourcePoint],
    to: &[Point],
) -> Law {
    for SourcePoint { at, .. } in from {
        require!(one.forward_exact(at) == other.forward_exact(at), "exact images of {at:?} differ");
        let near = rounded(at);
        require!(one.forward(near) == other.forward(near), "images of {near:?} differ");
    }
    for at in to {
        require!(one.inverse_exact(at) == other.inverse_exact(at), "exact preimages of {at:?} differ");
        let (near, _) = onto.round(at);
        require!(one.inverse(near) == other.inverse(near), "preimages of {near:?} differ");
    }
    Ok(())
}

/// Points outside get an error, and what is no number too.
pub fn outside_is_refused(map: &dyn Bijection, onto: &dyn Image, far: [f64; 3]) -> Law {
    for broken in [f64::NAN, f64::INFINITY] {
        require!(map.forward([broken, 0.0, 0.0]) == Err(EvaluationError::NotFinite), "forward takes {broken}");
        require!(map.inverse([0.0, broken, 0.0]) == Err(EvaluationError::NotFinite), "inverse takes {broken}");
    }
    require!(map.forward(far) == Err(EvaluationError::OutsideSource), "forward takes {far:?}");
    require!(map.forward_exact(&exact(far)) == Err(EvaluationError::OutsideSource), "forward takes {far:?}");
    let (error, points) = onto.outside();
    for point in points {
        require!(map.inverse(point) == Err(error.clone()), "inverse takes {point:?}");
        require!(map.inverse_exact(&exact(point)) == Err(error.clone()), "inverse takes {point:?}");
    }
    Ok(())
}
