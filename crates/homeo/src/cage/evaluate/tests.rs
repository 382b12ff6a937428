//! Images and preimages under maps between cages.

use super::super::CagePair;
use super::*;
use crate::progress::Silent;
use crate::shape::StraightPolyhedra;

type Point3 = [f64; 3];

const SIDES: [[u32; 3]; 8] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];

/// Two pyramids over a square, the upper one below it if its top is low.
fn dart(top: f64) -> Vec<Point3> {
    vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, top], [0.0, 0.0, -1.5]]
}

/// Maps that have a certificate, by `homeo-verify`.
fn maps() -> Vec<CageMap> {
    let block = |bend: f64| {
        let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.25], [1.0, 2.0], [0.0, 2.0]];
        let corners = [0.0, 1.5].into_iter().flat_map(|z| outline.map(|[x, y]| [x, y, z]));
        corners
            .map(|[x, y, z]: Point3| {
                [x + bend * 0.2 * y * z, y - bend * 0.15 * x * x + bend * 0.1 * z, z + bend * 0.1 * x * y]
            })
            .collect::<Vec<Point3>>()
    };
    let top = [[6, 7, 9], [7, 8, 9], [6, 9, 11], [9, 10, 11]];
    let walls = (0..6u32).flat_map(|k| [[k, (k + 1) % 6, (k + 1) % 6 + 6], [k, (k + 1) % 6 + 6, k + 6]]);
    let faces = top.into_iter().chain(top.map(|[a, b, c]: [u32; 3]| [a - 6, c - 6, b - 6])).chain(walls).collect();
    let between = |from: Vec<Point3>, to: Vec<Point3>, triangles: Vec<[u32; 3]>, steps: usize| {
        let path = StraightPolyhedra::new(from.clone(), to.clone()).unwrap();
        CageMap::along(&CagePair::new(from, to, triangles).unwrap(), &path, steps).unwrap()
    };
    vec![
        between(dart(-0.6), dart(0.3), SIDES.to_vec(), 1),
        between(dart(0.3), dart(0.5), SIDES.map(|[a, b, c]| [b, a, c]).to_vec(), 3),
        between(block(0.0), block(1.0), faces, 1),
    ]
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }

    /// A point of a grid in the box about a cage, often on planes of faces; or any point.
    fn near(&mut self, points: &[Point3]) -> Point3 {
        let is_on_grid = self.unit() < 0.5;
        [0, 1, 2].map(|k| {
            let all = || points.iter().map(|p| p[k]);
            let [low, high] = [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)];
            let t = self.unit();
            if is_on_grid { (4.0 * (low + t * (high - low))).round() / 4.0 } else { low + t * (high - low) }
        })
    }
}

fn miss(a: Point3, b: Point3) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

/// Against coordinates in doubles, there and back. Points on the cage come back, too, if rounding leaves them on it.
#[test]
fn images_and_preimages_lie_within_their_radii() {
    let mut random = Random(3);
    for (map, most) in maps().into_iter().zip([1e-11, 1e-8, 1e-10]) {
        let evaluator = CageEvaluator::new(&map);
        let (mut inside, mut outside) = (0, 0);
        while inside < 200 {
            let at = random.near(&map.stages()[0]);
            let image = match evaluator.forward(at) {
                Ok(image) => image,
                Err(error) => {
                    assert_eq!(error, CageEvaluationError::OutsideSource, "{at:?}");
                    outside += 1;
                    continue;
                }
            };
            let expected = map.forward(&[at], &Silent).unwrap()[0];
            assert!(miss(expected, image.point) <= image.radius + 1e-12, "{at:?} {image:?} {expected:?}");
            assert!(image.radius < most, "{at:?} {image:?}");
            if along_triangle([&map.stages()[0]; 2], map.triangles(), at).is_some() {
                assert!(image.radius < 1e-15, "{at:?}");
                continue;
            }
            inside += 1;
            let back = evaluator.inverse(image.point).unwrap();
            assert!(miss(back.point, at) <= back.radius + 10.0 * image.radius, "{at:?} {image:?} {back:?}");
            assert!(back.radius < 10.0 * most, "{at:?} {back:?}");
        }
        assert!(outside > 5, "{outside}");
    }
}

/// Vertices go to vertices, both ways, and what is outside has no image.
#[test]
fn the_cage_goes_along_its_triangles() {
    for map in maps() {
        let evaluator = CageEvaluator::new(&map);
        let (first, last) = (&map.stages()[0], &map.stages()[map.step_count()]);
        for (&from, &to) in first.iter().zip(last) {
            assert_eq!(evaluator.forward(from), Ok(Enclosed { point: to, radius: 0.0 }));
            assert_eq!(evaluator.inverse(to), Ok(Enclosed { point: from, radius: 0.0 }));
        }
        assert_eq!(evaluator.forward([9.0; 3]), Err(CageEvaluationError::OutsideSource));
        assert_eq!(evaluator.inverse([9.0; 3]), Err(CageEvaluationError::OutsideTarget));
        assert_eq!(evaluator.inverse([f64::NAN; 3]), Err(CageEvaluationError::NotFinite));
    }
}

/// Against differences.
#[test]
fn derivatives_are_those_of_images() {
    for (map, at) in maps().iter().zip([[0.1, 0.2, -0.9], [0.1, 0.2, -0.3], [0.6, 0.5, 0.7]]) {
        let evaluator = CageEvaluator::new(map);
        let found = evaluator.jacobian(at).unwrap();
        for k in 0..3 {
            let moved = |by: f64| {
                let mut place = at;
                place[k] += by;
                evaluator.forward(place).unwrap().point
            };
            let (ahead, behind) = (moved(1e-4), moved(-1e-4));
            for row in 0..3 {
                let expected = (ahead[row] - behind[row]) / 2e-4;
                assert!((found[row][k] - expected).abs() < 1e-5, "{row} {k} {} {expected}", found[row][k]);
            }
        }
        assert_eq!(evaluator.jacobian([9.0; 3]), None);
    }
}

/// What is not near is not proved to be.
#[test]
fn wrong_preimages_are_not_proved() {
    let map = &maps()[2];
    let evaluator = CageEvaluator::new(map);
    for at in [[0.5, 0.5, 0.5], [0.4, 1.6, 1.0], [1.5, 0.7, 0.3]] {
        let image = evaluator.forward(at).unwrap();
        let proved = evaluator.prove_near(0, at, image).unwrap();
        assert!(proved.radius < 1e-9, "{proved:?}");
        let aside = [at[0] + 1e-6, at[1], at[2]];
        let found = evaluator.prove_near(0, aside, image);
        assert!(found.is_none_or(|found| found.radius > 1e-6 / 4.0), "{found:?}");
        let there = evaluator.steps[0].enclose(cube(aside, 1e-7));
        assert!(!crosses(&there, image), "ten times too far");
        assert!(crosses(&evaluator.steps[0].enclose(cube(at, 1e-7)), image));
    }
}
