//! Maps from landmarks: points of a picture and where they go.

use std::collections::HashMap;

use homeo_core::planar::{DomainError, PlanarDomain, Point2};
use homeo_core::predicate::{Sign, orient2d};
use spade::{DelaunayTriangulation, Triangulation};

use crate::map::{BoundaryPoint, HalfParts, HarmonicMap, Middle};

/// A point and its image.
pub type Landmark = [Point2; 2];

/// Why there is no map. Landmarks are numbered from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LandmarkError {
    /// They span no triangle.
    #[error("{0} landmarks on one line: three that are not are needed")]
    Flat(usize),
    /// Two of them are the same point.
    #[error("landmarks {0} and {1} are the same point")]
    Same(usize, usize),
    /// A coordinate is not finite, or far too large or small.
    #[error("landmark {0} is no point: {1}")]
    NoPoint(usize, String),
    /// Triangles between landmarks are turned over: the warp would fold there.
    #[error(
        "the warp folds: of {of} triangles between landmarks {} are turned over or flat, the first between landmarks {}, \
         {} and {}; move these landmarks, or remove them",
        folded.len(), folded[0][0], folded[0][1], folded[0][2]
    )]
    Folded {
        /// The landmarks at their corners.
        folded: Vec<[usize; 3]>,
        /// How many triangles there are.
        of: usize,
    },
    /// No triangle is turned over, but the images of the outermost landmarks bound no domain.
    #[error("the images of the outermost landmarks cross: {0}")]
    Outline(DomainError),
}

/// The map that is affine on the triangles of a Delaunay triangulation of the landmarks.
///
/// It is stored like a composite harmonic map, with the target itself in the middle, and certified by the same rules.
///
/// # Errors
/// [`LandmarkError::Folded`] names every triangle that is turned over, decided exactly.
///
/// ```
/// use homeo::construct::harmonic::{LandmarkError, landmark_map};
/// let at = |x: f64, y: f64, u: f64, v: f64| [[x, y], [u, v]];
/// let corners = [at(0.0, 0.0, 0.0, 0.0), at(2.0, 0.0, 2.0, 0.0), at(2.0, 2.0, 2.0, 2.0), at(0.0, 2.0, 0.0, 2.0)];
/// let with = |inner| landmark_map(&[&corners[..], &[inner]].concat());
/// assert!(with(at(1.0, 1.0, 1.5, 0.5)).is_ok());
/// assert!(matches!(with(at(1.0, 1.0, 3.0, 1.0)), Err(LandmarkError::Folded { of: 4, .. })));
/// ```
pub fn landmark_map(landmarks: &[Landmark]) -> Result<HarmonicMap, LandmarkError> {
    let (triangles, outline) = triangulate(landmarks)?;
    let image = |v: usize| landmarks[v][1];
    let is_folded = |t: &&[usize; 3]| orient2d(image(t[0]), image(t[1]), image(t[2])) != Sign::Positive;
    let folded: Vec<[usize; 3]> = triangles.iter().filter(is_folded).copied().collect();
    if !folded.is_empty() {
        return Err(LandmarkError::Folded { folded, of: triangles.len() });
    }
    let domain = |side: usize| {
        PlanarDomain::new(vec![outline.iter().map(|&v| landmarks[v][side]).collect()]).map_err(LandmarkError::Outline)
    };
    let (source, target) = (domain(0)?, domain(1)?);
    // Vertices of the outline first, in its order.
    let mut number = vec![u32::MAX; landmarks.len()];
    let mut order = outline.clone();
    outline.iter().enumerate().for_each(|(k, &v)| number[v] = k as u32);
    for v in (0..landmarks.len()).filter(|v| !outline.contains(v)) {
        number[v] = order.len() as u32;
        order.push(v);
    }
    let boundary: Vec<BoundaryPoint> =
        (0..outline.len() as u32).map(|edge| BoundaryPoint { ring: 0, edge, share: 0 }).collect();
    let inner = |side: usize| order[outline.len()..].iter().map(|&v| landmarks[v][side]).collect::<Vec<Point2>>();
    let half = |domain: PlanarDomain, side: usize| HalfParts {
        domain,
        boundary: boundary.clone(),
        seam_points: Vec::new(),
        inner: inner(side),
        images: inner(1),
        triangles: triangles.iter().map(|t| t.map(|v| number[v])).collect(),
        shifts: Vec::new(),
    };
    let middle = Middle::new(target.rings().to_vec());
    Ok(HarmonicMap::new(middle, half(source, 0), half(target, 1)))
}

/// A Delaunay triangulation, and its outline counter-clockwise.
fn triangulate(landmarks: &[Landmark]) -> Result<(Vec<[usize; 3]>, Vec<usize>), LandmarkError> {
    let mut numbers: HashMap<[u64; 2], usize> = HashMap::new();
    let mut plane = DelaunayTriangulation::<spade::Point2<f64>>::new();
    for (k, [point, image]) in landmarks.iter().enumerate() {
        if let Some(x) = image.iter().find(|x| !x.is_finite()) {
            return Err(LandmarkError::NoPoint(k, format!("{x} is not finite")));
        }
        // Zero has two signs.
        let point = point.map(|x| x + 0.0);
        if let Some(&first) = numbers.get(&point.map(f64::to_bits)) {
            return Err(LandmarkError::Same(first, k));
        }
        numbers.insert(point.map(f64::to_bits), k);
        plane.insert(spade::Point2::new(point[0], point[1])).map_err(|e| LandmarkError::NoPoint(k, e.to_string()))?;
    }
    let number = |p: spade::Point2<f64>| numbers[&[(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()]];
    let triangles: Vec<[usize; 3]> =
        plane.inner_faces().map(|face| face.vertices().map(|v| number(v.position()))).collect();
    if triangles.is_empty() {
        return Err(LandmarkError::Flat(landmarks.len()));
    }
    // Hull edges have the outside on their left: the outline runs against them.
    let mut outline: Vec<usize> = plane.convex_hull().map(|edge| number(edge.from().position())).collect();
    outline.reverse();
    Ok((triangles, outline))
}
