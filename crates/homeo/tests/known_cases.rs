//! Cases of the literature: barycentric maps that are not one-to-one, and a composite of a thousand steps.

use homeo::composite::{
    CompositeMap, JacobianLimits, JacobianVerdict, PartitionParams, Tiling, bound_jacobian, triangulate,
};
use homeo::coordinates::{
    DiscreteHarmonic, HarmonicCoordinates, MaximumEntropy, MeanValue, PlanarCoordinates, PositiveMeanValue, ThreePoint,
    Wachspress,
};
use homeo::harmonic::ElementParams;
use homeo::progress::Silent;
use homeo::shape::LinearPath;
use homeo_core::number::Rational;
use homeo_core::planar::{DomainPair, PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};

fn domain(ring: &[Point2]) -> PlanarDomain {
    PlanarDomain::new(vec![ring.to_vec()]).unwrap()
}

fn verdict(source: &[Point2], target: &[Point2]) -> JacobianVerdict {
    let domain = domain(source);
    let tiling = triangulate(&domain).unwrap();
    bound_jacobian(&domain, &tiling, target, &JacobianLimits::default()).unwrap()
}

/// A square round the origin, on its corner.
const DIAMOND: [Point2; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// The square with its third corner at `(place, 0)`.
fn dart(place: f64) -> [Point2; 4] {
    [DIAMOND[0], DIAMOND[1], [place, 0.0], DIAMOND[3]]
}

/// Every kind of coordinates that is linear on edges, and how far its values may be from those of its definition.
fn kinds(domain: &PlanarDomain) -> Vec<(&'static str, Box<dyn PlanarCoordinates>, f64)> {
    let family = |p: f64| Box::new(ThreePoint::new(domain, p).unwrap());
    let harmonic = HarmonicCoordinates::new(domain, &ElementParams::default()).unwrap();
    let defect = harmonic.boundary_defect();
    assert!(defect < 0.01, "harmonic coordinates are known well enough: {defect}");
    vec![
        ("Wachspress", Box::new(Wachspress::new(domain).unwrap()), 1e-12),
        ("discrete harmonic", Box::new(DiscreteHarmonic::new(domain).unwrap()), 1e-12),
        ("p = -1", family(-1.0), 1e-12),
        ("p = 1/2", family(0.5), 1e-12),
        ("p = 1", family(1.0), 1e-12),
        ("p = 3", family(3.0), 1e-12),
        ("mean value", Box::new(MeanValue::new(domain)), 1e-12),
        ("positive mean value", Box::new(PositiveMeanValue::new(domain)), 1e-12),
        ("maximum entropy", Box::new(MaximumEntropy::new(domain)), 1e-12),
        ("harmonic", Box::new(harmonic), 2.0 * defect),
    ]
}

/// Whether a square of half width `radius` round a point lies in the open notch of the dart, exactly. The notch is the
/// triangle by which the dart is less than its convex hull: what lies in it is outside the dart.
fn is_in_notch(dart: &[Point2; 4], [x, y]: Point2, radius: f64) -> bool {
    let corners =
        [[x - radius, y - radius], [x + radius, y - radius], [x + radius, y + radius], [x - radius, y + radius]];
    let sides = [[dart[1], dart[3]], [dart[3], dart[2]], [dart[2], dart[1]]];
    // A triangle is convex: the corners stand for the square.
    corners.iter().all(|&corner| sides.iter().all(|&[from, to]| orient2d(from, to, corner) == Sign::Positive))
}

/// Section 2.1.2 of Schneider 2017, after Jacobson 2012, for `phi_3(0) < 1/2`.
///
/// A quarter turn maps the square onto itself and each vertex to the next. Every kind is defined by the polygon alone and
/// turns with it; so its four values at the origin are equal, 1/4 each, by symmetry and without any arithmetic. Then
/// `f(0) = ((1 + w) / 4, 0)` for the third corner moved to `(w, 0)`, which is to the left of it for `w > 1/3`: in the notch,
/// outside the dart. But a one-to-one continuous map that sends the boundary onto that of the dart sends nothing outside.
/// What is computed is compared with this, by as much as each kind may be wrong.
#[test]
fn no_kind_of_coordinates_maps_a_square_onto_a_dart() {
    let target = dart(0.5);
    let square = domain(&DIAMOND);
    let mut tried = 0;
    for (name, kind, error) in kinds(&square) {
        let mut values = [0.0; 4];
        kind.values_into([0.0, 0.0], &mut values).unwrap();
        assert!(values.iter().all(|value| (value - 0.25).abs() <= error), "{name}: {values:?}, by symmetry 1/4 each");
        let image = |target: &[Point2; 4]| -> Point2 {
            std::array::from_fn(|k| (0..4).map(|i| values[i] * target[i][k]).sum::<f64>())
        };
        assert!(is_in_notch(&target, image(&target), 4.0 * error + 1e-12), "{name}: {:?}", image(&target));
        // The control: for w < 1/3 the image is in the dart, and not in the notch.
        assert!(!is_in_notch(&dart(0.25), image(&dart(0.25)), 0.0), "{name}");
        assert!(domain(&dart(0.25)).contains(image(&dart(0.25))), "{name}");
        tried += 1;
    }
    assert_eq!(tried, 10, "all kinds");
}

/// The same for mean value coordinates with nothing taken for granted: the image of the origin is enclosed, and the
/// determinant is proved to be negative somewhere. Halfway to where it is refuted a map is proved.
#[test]
fn the_mean_value_map_onto_a_dart_is_refuted_twice() {
    let square = domain(&DIAMOND);
    let tiling = triangulate(&square).unwrap();
    let map = CompositeMap::from_domains(vec![square, domain(&dart(0.5))], vec![tiling]).unwrap();
    let image = map.forward([0.0, 0.0]).unwrap();
    assert!(image.radius < 1e-9 && is_in_notch(&dart(0.5), image.point, image.radius), "{image:?}");
    let JacobianVerdict::Negative { point, at_most, .. } = verdict(&DIAMOND, &dart(0.5)) else { panic!("not refuted") };
    assert!(at_most < 0.0 && domain(&DIAMOND).contains(point), "{point:?}: {at_most}");
    assert!(matches!(verdict(&DIAMOND, &dart(-0.5)), JacobianVerdict::Positive { .. }), "a control");
}

/// A convex pentagon, and another one, near a triangle, for which the mean value map folds. Found by descent from random
/// pentagons: see `docs/results/curves.md`. Near `(0.07, -0.02)` the determinant is -0.06 of the ratio of areas.
const PENTAGON: [Point2; 5] = [[1.3, 25.0], [-36.0, 14.6], [0.97, -0.76], [1.19, 1.23], [1.3, 3.2]];
const NARROW: [Point2; 5] = [[1.0, 1.0], [0.001, 0.002], [0.0, 0.0], [0.001, -0.002], [1.0, -1.0]];

/// What is proved of the map of the pentagons, in triangles round a point near the fold: corners are looked at first.
fn pentagons() -> JacobianVerdict {
    let triangles = (0..5).map(|k| [k, (k + 1) % 5, 5]).collect();
    let tiling = Tiling { added: vec![[0.07, -0.02]], triangles };
    bound_jacobian(&domain(&PENTAGON), &tiling, &NARROW, &JacobianLimits::default()).unwrap()
}

fn is_strictly_convex(ring: &[Point2]) -> bool {
    let n = ring.len();
    (0..n).all(|i| orient2d(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) == Sign::Positive)
}

fn exact(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

/// Twice the area of a triangle, and its gradient by the third corner.
fn doubled_area(a: &Point2, b: &Point2, point: &[Rational; 2]) -> (Rational, [Rational; 2]) {
    let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(exact);
    let (dx, dy) = (&bx - &ax, &by - &ay);
    let area = &dx * &(&point[1] - &ay) - &dy * &(&point[0] - &ax);
    (area, [-dy, dx])
}

/// The exact sign of the determinant of the Wachspress map of strictly convex polygons: weights `A_i`, the area of the corner
/// at vertex `i`, over the areas that the point makes with both edges there, multiplied by those of all edges.
fn wachspress_sign(source: &[Point2], target: &[Point2], point: Point2) -> Sign {
    let (n, at) = (source.len(), point.map(exact));
    let heights: Vec<_> = (0..n).map(|i| doubled_area(&source[i], &source[(i + 1) % n], &at)).collect();
    let weight = |i: usize| {
        let before = (i + n - 1) % n;
        let (corner, _) = doubled_area(&source[before], &source[i], &source[(i + 1) % n].map(exact));
        let product = |skip: usize| -> Rational {
            let kept = (0..n).filter(|&j| j != i && j != before && j != skip);
            kept.fold(corner.clone(), |all, j| &all * &heights[j].0)
        };
        let slope = |k: usize| -> Rational {
            (0..n).filter(|&j| j != i && j != before).map(|j| &product(j) * &heights[j].1[k]).sum()
        };
        (product(n), [slope(0), slope(1)])
    };
    let weights: Vec<_> = (0..n).map(weight).collect();
    let total: Rational = weights.iter().map(|(w, _)| w.clone()).sum();
    // The square of the total times the derivative: a positive factor.
    let entry = |k: usize, l: usize| -> Rational {
        let total_slope: Rational = weights.iter().map(|(_, g)| g[l].clone()).sum();
        let term = |i: usize| (&weights[i].1[l] * &total - &weights[i].0 * &total_slope) * exact(target[i][k]);
        (0..n).map(term).sum()
    };
    (&entry(0, 0) * &entry(1, 1) - &entry(0, 1) * &entry(1, 0)).sign()
}

/// Section 2.1.1: a mean value map between convex pentagons that folds, where the Wachspress map does not. That it does not
/// anywhere is a theorem (Floater, Kosinka 2010); here its determinant is looked at exactly, at the fold and on a grid.
#[test]
fn a_mean_value_map_of_convex_pentagons_folds_and_the_wachspress_map_does_not() {
    assert!(is_strictly_convex(&PENTAGON) && is_strictly_convex(&NARROW));
    let JacobianVerdict::Negative { point, at_most, .. } = pentagons() else { panic!("not refuted") };
    assert!(at_most < -1e-4 && domain(&PENTAGON).contains(point), "{point:?}: {at_most}");
    assert_eq!(wachspress_sign(&PENTAGON, &NARROW, point), Sign::Positive, "at the fold {point:?}");
    let mut looked = 0;
    for i in 0..40 {
        for j in 0..40 {
            let at = [-36.0 + 37.3 * f64::from(i) / 40.0, -0.76 + 25.76 * f64::from(j) / 40.0];
            let is_inside = (0..5).all(|k| orient2d(PENTAGON[k], PENTAGON[(k + 1) % 5], at) == Sign::Positive);
            if is_inside {
                looked += 1;
                assert_eq!(wachspress_sign(&PENTAGON, &NARROW, at), Sign::Positive, "{at:?}");
            }
        }
    }
    assert!(looked > 300, "the grid meets the pentagon: {looked}");
    // Controls: two images exchanged turn the exact sign; the identity is proved.
    let mut crossed = NARROW;
    crossed.swap(0, 4);
    assert_eq!(wachspress_sign(&PENTAGON, &crossed, [0.0, 0.0]), Sign::Negative);
    assert!(matches!(verdict(&PENTAGON, &PENTAGON), JacobianVerdict::Positive { .. }));
}

/// Nested squares, whose inner one turns by a right angle along straight paths: figure 4.6.
fn nested_squares() -> DomainPair {
    let outer = vec![[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let inner = vec![[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    let mut turned = inner.clone();
    turned.rotate_left(1);
    DomainPair::new(vec![outer.clone(), inner], vec![outer, turned]).unwrap()
}

fn uniform(steps: usize) -> Result<(CompositeMap, f64), homeo::composite::PartitionError> {
    let limits = JacobianLimits { sharpness: 0.0, ..JacobianLimits::default() };
    let params = PartitionParams { steps, limits, ..PartitionParams::default() };
    let times: Vec<f64> = (0..=steps).map(|k| k as f64 / steps as f64).collect();
    let path = LinearPath::between(&nested_squares()).unwrap();
    CompositeMap::at_times(&path, &times, &params, &Silent).map(|(map, info)| (map, info.least_determinant))
}

/// Figure 4.6 has 1000 steps: `homeo/examples/curve_tables.rs` proves them; here there are fewer, to be fast.
#[test]
fn an_inner_square_turns_by_a_right_angle() {
    let (map, least) = uniform(100).unwrap();
    assert!(map.step_count() == 100 && least > 0.0, "{least}");
    let image = map.forward([1.0, -1.0]).unwrap();
    assert_eq!(image.point, [-1.0, -1.0], "the corner of the inner square");
    assert!(uniform(1).is_err(), "one step folds: a control");
}

/// Triangles change where is looked, not what is true: with those made by rule the fold may be missed, but nothing is proved.
#[test]
fn the_fold_of_the_pentagons_is_never_proved_away() {
    assert!(!matches!(verdict(&PENTAGON, &NARROW), JacobianVerdict::Positive { .. }));
    let domain = domain(&PENTAGON);
    for triangles in [vec![[2, 3, 4], [2, 4, 0], [2, 0, 1]], vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]] {
        let tiling = Tiling { added: vec![], triangles };
        let limits = JacobianLimits { boxes_per_chart: 20_000, sharpness: 0.0 };
        let verdict = bound_jacobian(&domain, &tiling, &NARROW, &limits).unwrap();
        assert!(!matches!(verdict, JacobianVerdict::Positive { .. }), "{verdict:?}");
    }
}
