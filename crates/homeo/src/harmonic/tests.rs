//! True harmonic functions: errors, orders of convergence, controls that must fail.

use std::f64::consts::PI;

use homeo_core::planar::{PlanarDomain, Point2};

use super::*;

/// A polygon that is not convex, without symmetry.
pub(super) fn dart() -> PlanarDomain {
    PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, -0.3], [2.3, 1.7], [1.1, 0.9], [0.2, 1.5]]]).unwrap()
}

pub(super) fn ring() -> PlanarDomain {
    let hole = vec![[-0.5, -0.4], [-0.3, 0.6], [0.7, 0.5], [0.4, -0.5]];
    PlanarDomain::new(vec![vec![[-2.0, -2.0], [2.0, -2.0], [2.5, 2.0], [-2.0, 1.5]], hole]).unwrap()
}

/// Points of a grid inside, not on the boundary.
pub(super) fn inside(domain: &PlanarDomain, n: usize) -> Vec<Point2> {
    let [low, high] = domain.bounds();
    let at = |i: usize, axis: usize| low[axis] + (high[axis] - low[axis]) * (i as f64 + 0.37) / n as f64;
    let grid = (0..n * n).map(|k| [at(k % n, 0), at(k / n, 1)]);
    grid.filter(|&p| domain.contains(p)).collect()
}

fn params(per_half_edge: usize, grading: f64) -> ElementParams {
    ElementParams { per_half_edge, longest: f64::INFINITY, grading }
}

/// The real and the imaginary part of `(x + i y)^k`, and their gradients.
fn power(k: i32, [x, y]: Point2) -> ([f64; 2], [Point2; 2]) {
    let (r, t, n) = (x.hypot(y), y.atan2(x), f64::from(k));
    let [value, slope] = [(k, 1.0), (k - 1, n)].map(|(k, factor)| {
        let angle = f64::from(k) * t;
        [factor * r.powi(k) * angle.cos(), factor * r.powi(k) * angle.sin()]
    });
    (value, [[slope[0], -slope[1]], [slope[1], slope[0]]])
}

/// The largest errors of values and gradients.
fn errors(
    functions: &dyn HarmonicFunctions,
    points: &[Point2],
    truth: impl Fn(Point2) -> ([f64; 2], [Point2; 2]),
) -> [f64; 2] {
    let (mut values, mut gradients, mut worst) = ([0.0; 2], [[0.0; 2]; 2], [0.0f64; 2]);
    for &point in points {
        functions.gradients_into(point, &mut values, &mut gradients).unwrap();
        let (true_values, true_gradients) = truth(point);
        for f in 0..2 {
            worst[0] = worst[0].max((values[f] - true_values[f]).abs());
            (0..2).for_each(|k| worst[1] = worst[1].max((gradients[f][k] - true_gradients[f][k]).abs()));
        }
    }
    worst
}

fn polynomial_errors(k: i32, n: usize, is_wrong: bool) -> [f64; 2] {
    let domain = dart();
    let elements = BoundaryElements::new(&domain, &params(n, 1.0)).unwrap();
    let functions = elements.solve_sampled(2, |p, values| values.copy_from_slice(&power(k, p).0)).unwrap();
    let functions = if is_wrong { functions.with_wrong_sign() } else { functions };
    errors(&functions, &inside(&domain, 12), |p| power(k, p))
}

#[test]
fn linear_and_quadratic_polynomials_are_reproduced_to_rounding() {
    for (k, n) in [(1, 1), (1, 8), (2, 1), (2, 8)] {
        let [value, gradient] = polynomial_errors(k, n, false);
        assert!(value < 1e-12 && gradient < 1e-11, "{k} {n}: {value:e} {gradient:e}");
    }
}

#[test]
fn harmonic_polynomials_converge_with_order_three() {
    for k in 3..=6 {
        let [coarse, fine] = [polynomial_errors(k, 8, false), polynomial_errors(k, 32, false)];
        let order = [0, 1].map(|i| 0.5 * (coarse[i] / fine[i]).log2());
        assert!(order[0] > 3.0 && order[1] > 2.0, "{k}: {coarse:?} {fine:?} {order:?}");
        // The domain reaches 2.9 from the origin.
        assert!(fine[0] < 1e-6 * 2.9f64.powi(k), "{k}: {fine:?}");
    }
}

#[test]
fn the_wrong_sign_of_the_kernel_fails() {
    for k in 1..=4 {
        let [coarse, fine] = [polynomial_errors(k, 8, true), polynomial_errors(k, 16, true)];
        assert!(fine[0] > 0.1 && (coarse[0] / fine[0]).log2() < 0.5, "{k}: {coarse:?} {fine:?}");
    }
}

/// The function of the corner of an L: it vanishes on both edges at the corner.
fn corner([x, y]: Point2) -> ([f64; 2], [Point2; 2]) {
    let (r, t) = (x.hypot(y), y.atan2(x).rem_euclid(2.0 * PI));
    let (value, a) = (r.powf(2.0 / 3.0) * (2.0 / 3.0 * t).sin(), 2.0 / 3.0 * r.powf(-1.0 / 3.0));
    let gradient = [-a * (t / 3.0).sin(), a * (t / 3.0).cos()];
    ([value; 2], [gradient; 2])
}

#[test]
fn the_singular_function_of_a_corner_needs_graded_elements() {
    let ell = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.0, -1.0]];
    let domain = PlanarDomain::new(vec![ell]).unwrap();
    let run = |n: usize, grading: f64| {
        let elements = BoundaryElements::new(&domain, &params(n, grading)).unwrap();
        let functions = elements.solve_sampled(2, |p, values| values.copy_from_slice(&corner(p).0)).unwrap();
        errors(&functions, &inside(&domain, 9), corner)
    };
    for grading in [3.0, 4.0] {
        let [coarse, fine] = [run(4, grading), run(32, grading)];
        let order = [0, 1].map(|i| (coarse[i] / fine[i]).log2() / 3.0);
        assert!(order[0] > 2.8 && order[1] > 2.8, "{grading}: {coarse:?} {fine:?} {order:?}");
    }
    // The control: with equal elements the order is lost.
    let [coarse, fine] = [run(4, 1.0), run(32, 1.0)];
    assert!((coarse[0] / fine[0]).log2() / 3.0 < 1.8, "{coarse:?} {fine:?}");
}

#[test]
fn logarithms_round_holes_converge() {
    let domain = ring();
    let truth = |[x, y]: Point2| {
        let s = x * x + y * y;
        ([0.5 * s.ln(); 2], [[x / s, y / s]; 2])
    };
    let run = |n: usize| {
        let elements = BoundaryElements::new(&domain, &params(n, 1.0)).unwrap();
        let functions = elements.solve_sampled(2, |p, values| values.copy_from_slice(&truth(p).0)).unwrap();
        errors(&functions, &inside(&domain, 12), truth)
    };
    let [coarse, fine] = [run(4), run(32)];
    let order = [0, 1].map(|i| (coarse[i] / fine[i]).log2() / 3.0);
    assert!(order[0] > 3.0 && order[1] > 2.0, "{coarse:?} {fine:?} {order:?}");
}

#[test]
fn values_reach_the_boundary_and_the_defect_tells_by_how_much() {
    let domain = dart();
    let mut defects = Vec::new();
    for n in [4, 8, 16] {
        let elements = BoundaryElements::new(&domain, &params(n, 4.0)).unwrap();
        let functions = elements.solve(&BoundaryData::hats(5)).unwrap();
        let defect = functions.boundary_defect();
        let mut tried = 0;
        for share in [0.1, 0.35, 0.8] {
            for (vertex, [a, b]) in domain.edges().enumerate() {
                for height in [1e-6, 1e-9, 1e-12, 1e-15] {
                    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                    let point = [a[0] + share * dx - height * dy, a[1] + share * dy + height * dx];
                    let mut values = [0.0; 5];
                    if functions.values_into(point, &mut values).is_err() {
                        continue;
                    }
                    tried += 1;
                    let truth = [vertex, (vertex + 1) % 5].map(|v| values[v]);
                    let miss = (truth[0] - (1.0 - share)).abs().max((truth[1] - share).abs());
                    assert!(miss <= 1.5 * defect + 10.0 * height, "{n} {point:?}: {miss:e} {defect:e}");
                }
            }
        }
        assert!(tried > 40, "{tried}");
        defects.push(defect);
    }
    assert!(defects[0] > 3.0 * defects[1] && defects[1] > 3.0 * defects[2], "{defects:?}");
}

#[test]
fn gradients_are_those_of_the_values() {
    let domain = ring();
    let data: Vec<[f64; 2]> = domain.vertices().map(|[x, y]| [x * y, (3.0 * x).sin() + y]).collect();
    for profile in [Profile::Linear, Profile::Quadratic] {
        let elements = BoundaryElements::new(&domain, &ElementParams::default()).unwrap();
        let functions = elements.solve(&BoundaryData::new(&data, profile).unwrap()).unwrap();
        let sides = [
            EdgeCondition::Values([0.0, 1.0]),
            EdgeCondition::NoFlux,
            EdgeCondition::Values([2.0, 2.0]),
            EdgeCondition::NoFlux,
            EdgeCondition::NoFlux,
            EdgeCondition::NoFlux,
            EdgeCondition::NoFlux,
            EdgeCondition::Values([1.0, 0.0]),
        ];
        let mixed = solve_mixed(&domain, &ElementParams::default(), &sides).unwrap();
        for functions in [&functions, &mixed] {
            let n = functions.function_count();
            let (mut values, mut gradients) = (vec![0.0; n], vec![[0.0; 2]; n]);
            for point in inside(&domain, 7) {
                functions.gradients_into(point, &mut values, &mut gradients).unwrap();
                for axis in 0..2 {
                    let mut at = |step: f64| {
                        let mut moved = point;
                        moved[axis] += step;
                        functions.values_into(moved, &mut values).unwrap();
                        values.clone()
                    };
                    let (ahead, behind) = (at(1e-5), at(-1e-5));
                    for f in 0..n {
                        let slope = (ahead[f] - behind[f]) / 2e-5;
                        let miss = (slope - gradients[f][axis]).abs();
                        assert!(miss < 1e-6, "{profile:?} {point:?}: {slope} {}", gradients[f][axis]);
                    }
                }
            }
        }
    }
}

/// On a rectangle the coordinate functions are `x` and `y` themselves.
#[test]
fn four_corners_go_to_the_unit_square() {
    use EdgeCondition::{NoFlux, Values};
    let rectangle = vec![[1.0, 1.0], [2.0, 1.0], [4.0, 1.0], [4.0, 2.0], [1.0, 2.0]];
    let domain = PlanarDomain::new(vec![rectangle]).unwrap();
    let across = [NoFlux, NoFlux, Values([1.0; 2]), NoFlux, Values([0.0; 2])];
    let up = [Values([0.0; 2]), Values([0.0; 2]), NoFlux, Values([1.0; 2]), NoFlux];
    for (sides, truth) in [(across, 0), (up, 1)] {
        let function = solve_mixed(&domain, &ElementParams::default(), &sides).unwrap();
        for point in inside(&domain, 9).into_iter().chain([[3.0, 1.0], [1.5, 2.0]]) {
            let mut value = [0.0];
            function.values_into(point, &mut value).unwrap();
            let true_value = [(point[0] - 1.0) / 3.0, point[1] - 1.0][truth];
            assert!((value[0] - true_value).abs() < 1e-10, "{point:?} {value:?}");
        }
    }
    assert_eq!(
        solve_mixed(&domain, &ElementParams::default(), &[NoFlux; 5]).err(),
        Some(HarmonicFunctionError::NothingGiven)
    );
}

#[test]
fn bad_questions_are_refused_by_name() {
    let domain = dart();
    let error = |params: ElementParams| BoundaryElements::new(&domain, &params).err();
    assert!(matches!(error(params(0, 1.0)), Some(HarmonicFunctionError::BadParameter { name: "per_half_edge", .. })));
    assert!(matches!(error(params(1, 0.5)), Some(HarmonicFunctionError::BadParameter { name: "grading", .. })));
    assert!(matches!(error(params(5_000, 1.0)), Some(HarmonicFunctionError::TooLarge { .. })));
    let bad = BoundaryData::new(&[[0.0], [f64::NAN]], Profile::Linear);
    assert!(matches!(bad, Err(HarmonicFunctionError::BadData { entry: 1, .. })));
    let elements = BoundaryElements::new(&domain, &params(1, 1.0)).unwrap();
    assert!(matches!(elements.solve(&BoundaryData::hats(4)), Err(HarmonicFunctionError::WrongLength { .. })));
    let none = elements.solve(&BoundaryData::new::<0>(&[], Profile::Linear).unwrap()).unwrap();
    assert_eq!(none.values_into([1.0, 0.4], &mut []), Ok(()));
    let functions = elements.solve(&BoundaryData::hats(5)).unwrap();
    let mut values = [0.0; 5];
    let outside = functions.values_into([1.1, 1.0], &mut values);
    assert_eq!(outside, Err(HarmonicFunctionError::Outside { point: [1.1, 1.0] }));
    let at_vertex = functions.gradients_into([0.0, 0.0], &mut values, &mut [[0.0; 2]; 5]);
    assert_eq!(at_vertex, Err(HarmonicFunctionError::NoGradient { point: [0.0, 0.0] }));
    assert_eq!(values, [1.0, 0.0, 0.0, 0.0, 0.0]);
}

/// Three methods that have nothing in common but the data.
#[test]
fn methods_agree_and_come_closer() {
    for domain in [dart(), ring()] {
        let n = domain.vertex_count();
        let data = BoundaryData::hats(n);
        let params = ElementParams { per_half_edge: 12, ..ElementParams::default() };
        let truth = BoundaryElements::new(&domain, &params).unwrap().solve(&data).unwrap();
        assert!(truth.boundary_defect() < 1e-3);
        let miss = |other: &dyn HarmonicFunctions| {
            let (mut a, mut b, mut worst) = (vec![0.0; n], vec![0.0; n], 0.0f64);
            for point in inside(&domain, 15) {
                truth.values_into(point, &mut a).unwrap();
                other.values_into(point, &mut b).unwrap();
                a.iter().zip(&b).for_each(|(a, b)| worst = worst.max((a - b).abs()));
            }
            worst
        };
        let finite = [500, 8_000].map(|triangles| miss(&FiniteElements::new(&domain, &data, triangles).unwrap()));
        assert!(finite[1] < 2e-2 && finite[0] > 3.0 * finite[1], "{finite:?}");
        let sited = [50, 300].map(|sites| {
            let params = FundamentalParams { sites, ..FundamentalParams::default() };
            miss(&FundamentalSolutions::new(&domain, &data, &params).unwrap())
        });
        assert!(sited[1] < 2e-2 && sited[0] > 2.0 * sited[1], "{sited:?}");
        let coarse = ElementParams { per_half_edge: 2, longest: f64::INFINITY, ..ElementParams::default() };
        let coarse = miss(&BoundaryElements::new(&domain, &coarse).unwrap().solve(&data).unwrap());
        let fine = miss(&BoundaryElements::new(&domain, &ElementParams::default()).unwrap().solve(&data).unwrap());
        assert!(fine < 1e-3 && coarse > 5.0 * fine, "{coarse:e} {fine:e}");
        // The control: other data.
        let mut other = data.clone();
        other.values.rotate_left(1);
        assert!(miss(&FiniteElements::new(&domain, &other, 500).unwrap()) > 0.1);
    }
}

#[test]
fn gradients_of_fundamental_solutions_are_those_of_the_values() {
    let domain = dart();
    let functions = FundamentalSolutions::new(&domain, &BoundaryData::hats(5), &FundamentalParams::default()).unwrap();
    let (mut values, mut gradients, mut moved) = ([0.0; 5], [[0.0; 2]; 5], [0.0; 5]);
    for point in inside(&domain, 6) {
        for axis in 0..2 {
            let mut there = point;
            there[axis] += 1e-7;
            functions.values_into(there, &mut moved).unwrap();
            functions.gradients_into(point, &mut values, &mut gradients).unwrap();
            for f in 0..5 {
                let slope = (moved[f] - values[f]) / 1e-7;
                assert!((slope - gradients[f][axis]).abs() < 1e-4, "{point:?} {f} {slope} {:?}", gradients[f]);
            }
        }
    }
    let bad = FundamentalParams { nodes_per_site: 1, ..FundamentalParams::default() };
    let error = FundamentalSolutions::new(&domain, &BoundaryData::hats(5), &bad).err();
    assert!(matches!(error, Some(HarmonicFunctionError::BadParameter { name: "nodes_per_site", .. })));
}

/// Where elements meet, beside the edge: angles of both add up, however the point is rounded.
#[test]
fn beside_nodes_functions_sum_to_one() {
    let mut tried = 0;
    for domain in [dart(), ring()] {
        let n = domain.vertex_count();
        let params = ElementParams { per_half_edge: 3, longest: f64::INFINITY, grading: 2.0 };
        let functions = BoundaryElements::new(&domain, &params).unwrap().solve(&BoundaryData::hats(n)).unwrap();
        let (defect, mut values) = (functions.boundary_defect(), vec![0.0; n]);
        let mut first = 0;
        for ring in domain.rings() {
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                for share in [0.5 / 9.0, 2.0 / 9.0, 0.5, 1.0 - 2.0 / 9.0, 1.0 - 0.5 / 9.0] {
                    let point = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                    if functions.values_into(point, &mut values).is_err() {
                        continue;
                    }
                    assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-13, "{point:?} {values:?}");
                    assert!((values[first + i] - 1.0 + share).abs() < 2.0 * defect + 1e-12, "{point:?} {values:?}");
                    tried += 1;
                }
            }
            first += ring.len();
        }
    }
    assert!(tried > 20, "{tried}");
}
