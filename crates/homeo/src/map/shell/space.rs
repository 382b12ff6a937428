//! Points and lines among tetrahedra and triangles, for exact and for enclosing numbers.

use homeo_core::number::Scalar;
use homeo_core::predicate::Sign;

/// Rounding leaves a sign open. Never with exact numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Undecided;

pub(super) fn point_of<T: Scalar>(point: [f64; 3]) -> [T; 3] {
    point.map(T::from_f64)
}

pub(super) fn zero<T: Scalar>() -> T {
    T::from_f64(0.0)
}

pub(super) fn sum<'n, T: Scalar + 'n>(numbers: impl IntoIterator<Item = &'n T>) -> T {
    let mut numbers = numbers.into_iter();
    let first = numbers.next().map_or_else(zero, T::clone);
    numbers.fold(first, |sum, x| sum.plus(x))
}

/// `Some(true)` for all signs at least 0, `Some(false)` if one is certainly below, `None` if that is open.
pub(super) fn are_at_least_zero<'n, T: Scalar + 'n>(numbers: impl IntoIterator<Item = &'n T>) -> Option<bool> {
    let mut is_certain = true;
    for number in numbers {
        match number.sign() {
            Some(Sign::Negative) => return Some(false),
            Some(_) => {}
            None => is_certain = false,
        }
    }
    is_certain.then_some(true)
}

/// The point with the given weights of some corners.
pub(super) fn combination<T: Scalar>(weights: &[T], corners: &[[T; 3]]) -> [T; 3] {
    std::array::from_fn(|axis| {
        let terms: Vec<T> = weights.iter().zip(corners).map(|(w, corner)| w.times(&corner[axis])).collect();
        sum(&terms)
    })
}

fn negative<T: Scalar>(number: &T) -> T {
    zero::<T>().minus(number)
}

fn difference<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|axis| a[axis].minus(&b[axis]))
}

fn determinant<T: Scalar>(u: &[T; 3], v: &[T; 3], w: &[T; 3]) -> T {
    let minor = |y: usize, z: usize| v[y].times(&w[z]).minus(&v[z].times(&w[y]));
    sum(&[u[0].times(&minor(1, 2)), u[1].times(&minor(2, 0)), u[2].times(&minor(0, 1))])
}

/// Barycentric weights of a point of a tetrahedron of either orientation; `None` outside, and for flat ones.
pub(super) fn weights_in<T: Scalar>(corners: &[[T; 3]; 4], point: &[T; 3]) -> Result<Option<[T; 4]>, Undecided> {
    let [u, v, w] = [1, 2, 3].map(|k| difference(&corners[k], &corners[0]));
    let p = difference(point, &corners[0]);
    let mut whole = determinant(&u, &v, &w);
    let mut parts = [zero(), determinant(&p, &v, &w), determinant(&u, &p, &w), determinant(&u, &v, &p)];
    parts[0] = whole.minus(&sum(&parts));
    match whole.sign().ok_or(Undecided)? {
        Sign::Zero => return Ok(None),
        Sign::Positive => {}
        Sign::Negative => {
            whole = negative(&whole);
            parts = parts.each_ref().map(negative);
        }
    }
    match are_at_least_zero(&parts).ok_or(Undecided)? {
        true => Ok(Some(parts.map(|part| part.divide(&whole)))),
        false => Ok(None),
    }
}

/// The weights in a triangle of the point where a segment, not parallel to it, meets it.
pub(super) fn crossing<T: Scalar>(ends: [&[T; 3]; 2], corners: &[[T; 3]; 3]) -> Result<Option<[T; 3]>, Undecided> {
    let Some(meeting) = Meeting::new(ends, corners)? else { return Ok(None) };
    Ok(if meeting.is_inside().ok_or(Undecided)? { Some(meeting.weights()) } else { None })
}

/// The same, also where it is open whether the point lies on the segment and in the triangle.
pub(super) fn possible_crossing<T: Scalar>(
    ends: [&[T; 3]; 2],
    corners: &[[T; 3]; 3],
) -> Result<Option<[T; 3]>, Undecided> {
    let Some(meeting) = Meeting::new(ends, corners)? else { return Ok(None) };
    Ok(if meeting.is_inside() == Some(false) { None } else { Some(meeting.weights()) })
}

/// Where a line meets a plane.
struct Meeting<T> {
    /// The share of the segment before it, and the weights of the triangle's second and third corner, times the speed.
    parts: [T; 3],
    /// How fast the segment goes through the plane; positive.
    speed: T,
}

impl<T: Scalar> Meeting<T> {
    /// `None` for parallel ones.
    fn new([from, to]: [&[T; 3]; 2], corners: &[[T; 3]; 3]) -> Result<Option<Self>, Undecided> {
        let (u, v) = (difference(&corners[1], &corners[0]), difference(&corners[2], &corners[0]));
        let (step, base) = (difference(to, from), difference(from, &corners[0]));
        // base + t step = x u + y v
        let speed = determinant(&u, &v, &step);
        let (t, x, y) = (determinant(&u, &v, &base), determinant(&base, &v, &step), determinant(&u, &base, &step));
        Ok(match speed.sign().ok_or(Undecided)? {
            Sign::Zero => None,
            Sign::Positive => Some(Self { parts: [negative(&t), x, y], speed }),
            Sign::Negative => Some(Self { parts: [t, negative(&x), negative(&y)], speed: negative(&speed) }),
        })
    }

    /// Whether it lies on the segment and in the triangle; `None` where that is open.
    fn is_inside(&self) -> Option<bool> {
        let [t, x, y] = &self.parts;
        are_at_least_zero([t, &self.speed.minus(t), x, y, &self.speed.minus(x).minus(y)])
    }

    fn weights(&self) -> [T; 3] {
        let [_, x, y] = &self.parts;
        [self.speed.minus(x).minus(y), x.clone(), y.clone()].map(|part| part.divide(&self.speed))
    }
}
