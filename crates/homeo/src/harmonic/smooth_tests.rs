//! Smooth composite maps: there and back, symmetry, convergence, controls that must fail.

use homeo_core::planar::{DomainPair, Point2};

use super::tests::{dart, inside, ring};
use super::*;
use crate::construct::harmonic::{HarmonicParams, MiddleShape, harmonic_map};
use crate::map::{Distortion, PlanarBijection};
use crate::progress::Silent;

fn star() -> Vec<Point2> {
    vec![[1.0, 0.0], [2.0, 0.4], [1.6, 2.0], [0.2, 2.2], [0.3, 1.1]]
}

fn pair() -> DomainPair {
    DomainPair::new(dart().rings().to_vec(), vec![star()]).unwrap()
}

fn map_of(pair: &DomainPair, per_half_edge: usize) -> SmoothHarmonicMap {
    let elements = ElementParams { per_half_edge, ..ElementParams::default() };
    SmoothHarmonicMap::new(pair, &SmoothParams { elements, ..SmoothParams::default() }, &Silent).unwrap()
}

fn distance(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn similar_polygons_are_mapped_by_the_similarity() {
    let turned = |[x, y]: Point2| [1.0 - 4.0 * y, 4.0 * x - 2.0];
    let target = dart().vertices().map(turned).collect();
    let map = map_of(&DomainPair::new(dart().rings().to_vec(), vec![target]).unwrap(), 4);
    let points = inside(&dart(), 9);
    assert!(points.len() > 30);
    for point in points {
        let image = map.forward(point).unwrap();
        assert!(distance(image.point, turned(point)) < 1e-10, "{point:?} {image:?}");
        assert!((map.distortion(point, Distortion::Conformal).unwrap() - 2.0).abs() < 1e-9);
        assert!((map.distortion(point, Distortion::Isometric).unwrap() - 4.0).abs() < 1e-9);
    }
}

#[test]
fn points_go_there_and_back_and_the_map_is_symmetric() {
    let pair = pair();
    let (map, other) = (map_of(&pair, 4), map_of(&DomainPair::new(vec![star()], dart().rings().to_vec()).unwrap(), 4));
    let mut tried = 0;
    for point in inside(&dart(), 12) {
        let image = map.forward(point).unwrap();
        assert!(image.residual < 1e-12 && pair.target.contains(image.point), "{point:?} {image:?}");
        let [back, same] = [map.inverse(image.point).unwrap(), other.forward(image.point).unwrap()];
        assert!(distance(back.point, point) < 1e-9, "{point:?} {back:?}");
        assert!(distance(same.point, point) < 1e-9, "{point:?} {same:?}");
        // The control: a point that is not the image does not come back.
        let off = map.inverse([image.point[0] + 1e-6, image.point[1]]).map_or(1.0, |back| distance(back.point, point));
        assert!(off > 1e-8, "{point:?} {off:e}");
        tried += 1;
    }
    assert!(tried > 60, "{tried}");
}

#[test]
fn edges_are_mapped_as_their_profile_says() {
    let params = SmoothParams { target_profile: Profile::Quadratic, ..SmoothParams::default() };
    let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let kite = vec![[0.0, 0.0], [4.0, 0.0], [3.0, 3.0], [0.0, 4.0]];
    let pair = DomainPair::new(vec![square], vec![kite]).unwrap();
    let map = SmoothHarmonicMap::new(&pair, &params, &Silent).unwrap();
    assert_eq!(map.forward([0.25, 0.0]).unwrap(), SmoothImage { point: [2.0, 0.0], residual: 0.0 });
    assert_eq!(map.inverse([2.0, 0.0]).unwrap(), SmoothImage { point: [0.25, 0.0], residual: 0.0 });
    let beside = map.forward([0.25, 1e-3]).unwrap();
    assert!(distance(beside.point, [2.0, 0.0]) < 0.02, "{beside:?}");
    let linear = SmoothHarmonicMap::new(&pair, &SmoothParams::default(), &Silent).unwrap();
    assert!(distance(linear.forward([0.25, 1e-3]).unwrap().point, [1.0, 0.0]) < 0.02);
}

#[test]
fn jacobians_are_those_of_the_map_and_positive() {
    let map = map_of(&pair(), 4);
    for point in inside(&dart(), 6) {
        let jacobian = map.jacobian(point).unwrap();
        assert!(Distortion::Conformal.of(jacobian).is_finite());
        for axis in 0..2 {
            let [ahead, behind] = [1e-6, -1e-6].map(|step| {
                let mut moved = point;
                moved[axis] += step;
                map.forward(moved).unwrap().point
            });
            for k in 0..2 {
                let slope = (ahead[k] - behind[k]) / 2e-6;
                assert!((slope - jacobian[k][axis]).abs() < 1e-4, "{point:?} {slope} {jacobian:?}");
            }
        }
    }
}

#[test]
fn piecewise_linear_maps_come_closer_to_the_smooth_one() {
    let (pair, points) = (pair(), inside(&dart(), 10));
    let map = map_of(&pair, 8);
    let miss = |triangles, middle| {
        let linear = harmonic_map(&pair, HarmonicParams { triangles, middle, turn_degrees: None }, &Silent).unwrap();
        let of = |&point: &Point2| distance(linear.forward(point).unwrap().point, map.forward(point).unwrap().point);
        points.iter().map(of).fold(0.0, f64::max)
    };
    let [coarse, fine] = [300, 20_000].map(|triangles| miss(triangles, MiddleShape::AveragedLengths));
    assert!(fine < 0.02 && coarse > 3.0 * fine, "{coarse:e} {fine:e}");
    // The control: over another middle it is another map.
    let other = miss(20_000, MiddleShape::Regular);
    assert!(other > 3.0 * fine, "{other:e} {fine:e}");
}

#[test]
fn what_has_no_image_is_refused_and_the_verdict_is_undecided() {
    let map = map_of(&pair(), 2);
    let outside = SmoothMapError::Functions(HarmonicFunctionError::Outside { point: [9.0, 9.0] });
    assert_eq!(map.forward([9.0, 9.0]), Err(outside));
    assert!(map.verdict().to_string().starts_with("undecided") && map.verdict().defect > 1e-6);
    let holed = DomainPair::new(ring().rings().to_vec(), ring().rings().to_vec()).unwrap();
    let error = SmoothHarmonicMap::new(&holed, &SmoothParams::default(), &Silent).err();
    assert_eq!(error, Some(SmoothMapError::HasHoles(1)));
}
