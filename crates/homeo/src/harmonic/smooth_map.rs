//! Smooth composite harmonic maps: to a convex polygon by boundary elements, and back by Newton's method.

use homeo_core::planar::{DomainPair, PlanarDomain, Point2};

use super::condition::{BoundaryData, Profile};
use super::{BoundaryElementFunctions, BoundaryElements, ElementParams, HarmonicFunctionError, HarmonicFunctions};
use crate::construct::harmonic::{HarmonicError, HarmonicParams, MiddleShape, harmonic_map};
use crate::map::planar_distortion::{Matrix, determinant, inverse, product};
use crate::map::{Distortion, HarmonicMap, PlanarBijection};
use crate::progress::Progress;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothParams {
    /// How edges are divided.
    pub elements: ElementParams,
    /// The convex polygon between source and target.
    pub middle: MiddleShape,
    /// How the target's edges run along those of the middle (section 5.4); the source's run linearly.
    pub target_profile: Profile,
    /// About how many triangles the piecewise-linear map has with which every search begins.
    pub triangles: usize,
}

impl Default for SmoothParams {
    fn default() -> Self {
        Self {
            elements: ElementParams::default(),
            middle: MiddleShape::default(),
            target_profile: Profile::default(),
            triangles: 2_000,
        }
    }
}

/// Why there is no smooth map, or no image.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SmoothMapError {
    /// The domains have holes: no convex polygon lies between them.
    #[error("the domain has {0} holes; smooth composite harmonic maps are made for none")]
    HasHoles(usize),
    /// The piecewise-linear map, with which searches begin, could not be made.
    #[error(transparent)]
    Guess(#[from] HarmonicError),
    /// The harmonic functions could not be found or evaluated.
    #[error(transparent)]
    Functions(#[from] HarmonicFunctionError),
    /// Newton's method ended where the equation is missed by more than the defect of the method.
    #[error("no image of {point:?} was found: the best misses by {residual:e} in the middle; take more elements")]
    NotFound {
        /// What was asked for.
        point: Point2,
        /// By how much the images in the middle, which is about as large as 1, differ.
        residual: f64,
    },
    /// The Jacobian of one half is not positive there, which it is for the true harmonic map.
    #[error("the map folds at {point:?}, where the approximation is too coarse; take more elements")]
    Folded {
        /// Where in the source.
        point: Point2,
    },
}

/// An image without a bound of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothImage {
    /// The image.
    pub point: Point2,
    /// By how much both points differ in the middle: rounding inside; up to the defect beside the boundary.
    pub residual: f64,
}

/// What is known about a smooth map: that it is undecided whether it is one-to-one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("undecided: an approximation that misses its boundary values by about {defect:e}; {remedy}")]
pub struct SmoothVerdict {
    /// The largest [boundary defect](BoundaryElementFunctions::boundary_defect) of both halves.
    pub defect: f64,
    /// How to get a decided map.
    pub remedy: &'static str,
}

/// The composite harmonic map of two polygons by boundary elements: smooth inside, and not certified.
///
/// Both domains are mapped to one convex polygon; the map goes there from the source, and back to the target by inverting
/// the other half. The true harmonic maps are one-to-one (Radó, Kneser, Choquet), but the approximations meet their
/// boundary values to a defect only: whether this map is one-to-one is undecided, and [`verdict`](Self::verdict) says so.
/// It is no [`PlanarBijection`]: its answers have no bound of the error. For a certified map take [`harmonic_map`].
///
/// # Inverting a half
/// Newton's method, with steps halved until they stay inside and gain. It begins at the image under the piecewise-linear
/// map; where that fails, along the segment of the middle that leads from the image of an inner point, in short parts. The
/// source (section 5.2) refines a triangulation, or minimizes in its triangles.
///
/// # Complexity
/// Two dense factorizations; for a point some 5 evaluations of the boundary elements.
///
/// ```
/// use homeo::harmonic::{SmoothHarmonicMap, SmoothParams};
/// use homeo::progress::Silent;
/// use homeo_core::planar::DomainPair;
/// let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let arrow = vec![[0.0, 0.0], [1.0, 0.0], [0.4, 0.3], [0.0, 1.0]];
/// let pair = DomainPair::new(vec![square], vec![arrow])?;
/// let map = SmoothHarmonicMap::new(&pair, &SmoothParams::default(), &Silent)?;
/// let image = map.forward([0.5, 0.5])?;
/// let back = map.inverse(image.point)?;
/// assert!((back.point[0] - 0.5).abs() < 1e-9);
/// assert!(map.verdict().defect > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SmoothHarmonicMap {
    halves: [BoundaryElementFunctions; 2],
    profiles: [Profile; 2],
    defect: f64,
    guess: HarmonicMap,
    /// In either domain: a point well inside, where searches begin again.
    anchors: [Point2; 2],
}

/// Newton's method ends here: the middle is about as large as 1.
const CLOSE_ENOUGH: f64 = 1e-13;
const MOST_STEPS: usize = 40;
const MOST_HALVINGS: usize = 30;
/// Parts of a segment are no shorter than this share of it.
const SHORTEST_PART: f64 = 1e-3;

impl SmoothHarmonicMap {
    /// Makes both halves and the piecewise-linear map.
    ///
    /// # Errors
    /// The domains have holes, or [`SmoothMapError::Guess`] and [`SmoothMapError::Functions`] say what failed.
    pub fn new(pair: &DomainPair, params: &SmoothParams, progress: &impl Progress) -> Result<Self, SmoothMapError> {
        let holes = pair.source.rings().len() - 1;
        if holes > 0 {
            return Err(SmoothMapError::HasHoles(holes));
        }
        let linear = HarmonicParams { triangles: params.triangles, middle: params.middle, turn_degrees: None };
        let guess = harmonic_map(pair, linear, progress)?;
        let profiles = [Profile::Linear, params.target_profile];
        let half = |domain: &PlanarDomain, profile| {
            progress.stage("elements");
            if progress.is_cancelled() {
                return Err(SmoothMapError::Guess(HarmonicError::Cancelled));
            }
            let data = BoundaryData::new(&guess.middle().rings()[0], profile)?;
            Ok(BoundaryElements::new(domain, &params.elements)?.solve(&data)?)
        };
        let halves = [half(&pair.source, profiles[0])?, half(&pair.target, profiles[1])?];
        let defect = halves[0].boundary_defect().max(halves[1].boundary_defect());
        let anchors = [guess.source_half(), guess.target_half()].map(anchor);
        Ok(Self { halves, profiles, defect, guess, anchors })
    }

    /// The convex polygon between source and target.
    pub fn middle(&self) -> &[Point2] {
        &self.guess.middle().rings()[0]
    }

    /// Both halves, to the middle: coordinates of the image of a point of the source, and of the target.
    pub fn halves(&self) -> &[BoundaryElementFunctions; 2] {
        &self.halves
    }

    /// What is known: always that it is undecided whether the map is one-to-one.
    pub fn verdict(&self) -> SmoothVerdict {
        SmoothVerdict {
            defect: self.defect,
            remedy: "take the piecewise-linear composite harmonic map, which is certified",
        }
    }

    /// Image of a point of the source; on edges it is the exact one, rounded.
    ///
    /// # Errors
    /// The point is not in the source, or no image was found.
    pub fn forward(&self, point: Point2) -> Result<SmoothImage, SmoothMapError> {
        let guess = self.guess.forward(point).ok().map(|image| image.point);
        self.carry(point, 0, guess)
    }

    /// The point of the source whose image is given; on edges the exact one, rounded.
    ///
    /// # Errors
    /// The point is not in the target, or no preimage was found.
    pub fn inverse(&self, point: Point2) -> Result<SmoothImage, SmoothMapError> {
        let guess = self.guess.inverse(point).ok().map(|image| image.point);
        self.carry(point, 1, guess)
    }

    /// The Jacobian of the map at a point of the source, rows `[df/dx, df/dy]`.
    ///
    /// # Errors
    /// As [`forward`](Self::forward); there is none where elements meet; the approximation folds there.
    pub fn jacobian(&self, point: Point2) -> Result<[[f64; 2]; 2], SmoothMapError> {
        let image = self.forward(point)?;
        let [(_, here), (_, there)] = [self.at(0, point)?, self.at(1, image.point)?];
        if [here, there].iter().any(|slopes| determinant(*slopes) <= 0.0) {
            return Err(SmoothMapError::Folded { point });
        }
        Ok(product(inverse(there), here))
    }

    /// A distortion of the map at a point of the source.
    ///
    /// # Errors
    /// As [`jacobian`](Self::jacobian).
    pub fn distortion(&self, point: Point2, kind: Distortion) -> Result<f64, SmoothMapError> {
        Ok(kind.of(self.jacobian(point)?))
    }

    /// Image in the middle and Jacobian.
    fn at(&self, half: usize, point: Point2) -> Result<(Point2, Matrix), HarmonicFunctionError> {
        let (mut values, mut gradients) = ([0.0; 2], [[0.0; 2]; 2]);
        self.halves[half].gradients_into(point, &mut values, &mut gradients)?;
        Ok((values, gradients))
    }

    fn carry(&self, point: Point2, from: usize, guess: Option<Point2>) -> Result<SmoothImage, SmoothMapError> {
        let to = 1 - from;
        if let Some((edge, share)) = self.halves[from].edge_of(point)? {
            let there = self.profiles[to].share_of(self.profiles[from].at(share));
            let ring = &self.halves[to].domain().rings()[0];
            let (a, b) = (ring[edge], ring[(edge + 1) % ring.len()]);
            return Ok(SmoothImage { point: [0, 1].map(|k| a[k] * (1.0 - there) + b[k] * there), residual: 0.0 });
        }
        let mut wanted = [0.0; 2];
        self.halves[from].values_into(point, &mut wanted)?;
        let begun = guess.and_then(|guess| self.newton(to, guess, wanted));
        let found = match begun {
            Some(image) if image.residual <= CLOSE_ENOUGH => Some(image),
            other => {
                [other, self.follow(to, wanted)].into_iter().flatten().min_by(|a, b| a.residual.total_cmp(&b.residual))
            }
        };
        match found {
            Some(image) if image.residual <= self.defect.max(CLOSE_ENOUGH) => Ok(image),
            other => {
                Err(SmoothMapError::NotFound { point, residual: other.map_or(f64::INFINITY, |image| image.residual) })
            }
        }
    }

    /// The best point that Newton's method finds for an image in the middle, staying inside.
    fn newton(&self, half: usize, begin: Point2, wanted: Point2) -> Option<SmoothImage> {
        let (mut point, (mut image, mut slopes)) = (begin, self.at(half, begin).ok()?);
        let missed = |image: Point2| (wanted[0] - image[0]).hypot(wanted[1] - image[1]);
        for _ in 0..MOST_STEPS {
            let residual = missed(image);
            if residual <= CLOSE_ENOUGH || determinant(slopes) == 0.0 {
                break;
            }
            let [first, second] = inverse(slopes);
            let [u, v] = [wanted[0] - image[0], wanted[1] - image[1]];
            let step = [first[0] * u + first[1] * v, second[0] * u + second[1] * v];
            let gains = |halvings: usize| {
                let share = 0.5f64.powi(halvings as i32);
                let tried = [0, 1].map(|k| point[k] + share * step[k]);
                let found = self.at(half, tried).ok()?;
                (missed(found.0) < (1.0 - 1e-4 * share) * residual).then_some((tried, found))
            };
            let Some((tried, found)) = (0..=MOST_HALVINGS).find_map(gains) else { break };
            (point, (image, slopes)) = (tried, found);
        }
        Some(SmoothImage { point, residual: missed(image) })
    }

    /// The same along the segment from the image of the anchor: it lies in the middle, which is convex.
    fn follow(&self, half: usize, wanted: Point2) -> Option<SmoothImage> {
        let mut here = SmoothImage { point: self.anchors[half], residual: 0.0 };
        let (begin, _) = self.at(half, here.point).ok()?;
        let (mut gone, mut part) = (0.0f64, 0.25);
        while gone < 1.0 && part >= SHORTEST_PART {
            let next = (gone + part).min(1.0);
            let on_way = [0, 1].map(|k| begin[k] + next * (wanted[k] - begin[k]));
            match self.newton(half, here.point, on_way) {
                Some(found) if found.residual <= CLOSE_ENOUGH => (here, gone, part) = (found, next, 2.0 * part),
                _ => part *= 0.5,
            }
        }
        // Beside the boundary the last part may lead out of the image: as near as it comes.
        if gone < 1.0 { self.newton(half, here.point, wanted) } else { Some(here) }
    }
}

/// The centre of the triangle whose image in the middle is the nearest to the origin, which is inside.
fn anchor(half: &crate::map::Half) -> Point2 {
    let centre = |corners: [Point2; 3]| [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0);
    let size = |t: &usize| {
        let [x, y] = centre(half.image(*t));
        x.hypot(y)
    };
    let triangles = &half.parts().triangles;
    let nearest = (0..triangles.len()).min_by(|s, t| size(s).total_cmp(&size(t))).unwrap_or(0);
    centre(triangles[nearest].map(|v| half.position(v)))
}
