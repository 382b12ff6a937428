//! Images of points under composite mean value maps.

use homeo_core::planar::{PlanarDomain, Point2};
use rayon::prelude::*;

use super::device::{CHANGED, FETCHED, Gpu, MOST_IN_PASS, PARAMETERS, READ};
use super::error::GpuError;
use super::frame::Frame;
use crate::composite::CompositeMap;
use crate::map::PlanarBijection;

pub(super) const PROGRAM: &str = include_str!("images.wgsl");

/// Points times edges times steps in one pass: longer ones some drivers take for hung.
const MOST_WORK: usize = 1 << 31;
/// What the program writes in the place of a first coordinate: left to the processor, and outside.
const IS_LEFT: f32 = 4.0;
const IS_OUTSIDE: f32 = 8.0;
/// Errors in units of `f32::EPSILON` times the length of the way: of weights, and of sums for each vertex.
const ERRORS_OF_WEIGHTS: f64 = 32.0;
const ERRORS_OF_SUMS: f64 = 0.25;
/// The resolution of places in the frame.
const RESOLUTION: f64 = 1.0 / (1u64 << 36) as f64;

/// The place of a vertex, its displacement, and 1 if an edge ends here or 0 where a ring begins.
type Entry = [f32; 8];

/// Images of points by a graphics processor.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuImages {
    /// For each point its image; `None` outside the source.
    pub points: Vec<Option<Point2>>,
    /// How many points were left to the processor, being close to an edge or a vertex of one of the domains.
    pub left_to_cpu: usize,
    /// By how much images may differ from those in doubles, in either coordinate and in the unit of the domains: stated and
    /// tested, not proved.
    pub error: f64,
}

impl Gpu {
    /// Images of many points under a composite map: those of [`PlanarBijection::forward_along`], to a stated error.
    ///
    /// # Guarantee
    /// None that is proved. Images are found in single precision, to an error of
    /// `32 + #V / 4` times `f32::EPSILON` times the length of the way, the sum over steps of the largest displacement of a
    /// vertex, and `2^-36` of half the map's extent for each step. Where a vertex is nearer than `2^-13` of half the extent, or
    /// the half tangent of an edge is above `2^12`, or positive and negative weights cancel to below a sixteenth,
    /// points are left to the processor, in doubles.
    ///
    /// # Errors
    /// The device gives up, or one domain does not fit into a buffer.
    ///
    /// # Complexity
    /// Points times vertices times steps on the device; 16 bytes each way for each point.
    ///
    /// ```
    /// use homeo::composite::{CompositeMap, PartitionParams};
    /// use homeo::gpu::{Gpu, GpuError};
    /// use homeo::progress::Silent;
    /// use homeo::shape::LinearPath;
    /// use homeo_core::planar::DomainPair;
    /// let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    /// let kite = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.4, 0.4], [0.0, 1.0]]];
    /// let path = LinearPath::between(&DomainPair::new(square, kite).unwrap()).unwrap();
    /// let (map, _) = CompositeMap::build(&path, &PartitionParams::default(), &Silent).unwrap();
    /// match Gpu::new() {
    ///     Ok(gpu) => {
    ///         let images = gpu.images(&map, &[[0.7, 0.6], [2.0, 0.0]])?;
    ///         let expected = map.forward([0.7, 0.6]).unwrap().point;
    ///         let found = images.points[0].unwrap();
    ///         assert!((0..2).all(|k| (found[k] - expected[k]).abs() <= images.error));
    ///         assert!(images.error < 1e-5 && images.points[1].is_none());
    ///     }
    ///     Err(GpuError::NoAdapter(_)) => {} // no Vulkan driver on this machine
    ///     Err(error) => return Err(error),
    /// }
    /// # Ok::<(), GpuError>(())
    /// ```
    pub fn images(&self, map: &CompositeMap, points: &[Point2]) -> Result<GpuImages, GpuError> {
        let frame = Frame::about(map.domains());
        let mut found = vec![None; points.len()];
        let mut left = Vec::new();
        self.guarded(|| {
            Pass::new(self, map, frame, points.len())?.run(points, |first, places| {
                left.extend((first..).zip(places).filter(|(_, place)| place[0] == IS_LEFT).map(|(number, _)| number));
                found[first..].par_iter_mut().zip(places).for_each(|(image, &place)| {
                    *image = (place[0] < IS_LEFT).then(|| frame.join(place));
                });
            })
        })?;
        let again: Vec<Point2> = left.iter().map(|&number| points[number]).collect();
        let mut images = vec![None; again.len()];
        map.forward_along(&again, &mut images);
        left.iter().zip(images).for_each(|(&number, image)| found[number] = image);
        Ok(GpuImages { points: found, left_to_cpu: left.len(), error: error(map, frame) })
    }
}

/// By how much images may differ from those in doubles.
fn error(map: &CompositeMap, frame: Frame) -> f64 {
    let farthest = |[from, to]: [&PlanarDomain; 2]| {
        let ways = from.vertices().zip(to.vertices()).map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1]));
        ways.fold(0.0, f64::max)
    };
    let way: f64 = map.domains().windows(2).map(|pair| farthest([&pair[0], &pair[1]])).sum();
    let factor = ERRORS_OF_WEIGHTS + ERRORS_OF_SUMS * map.source().vertex_count() as f64;
    factor * f64::from(f32::EPSILON) * way + RESOLUTION * frame.half() * map.step_count() as f64
}

/// Buffers for the passes of one call.
struct Pass<'a> {
    gpu: &'a Gpu,
    map: &'a CompositeMap,
    frame: Frame,
    /// Entries of a domain.
    entries: usize,
    /// Points in one pass.
    points: usize,
    /// Steps in one pass.
    steps: usize,
    parameters: wgpu::Buffer,
    domains: wgpu::Buffer,
    places: wgpu::Buffer,
    results: wgpu::Buffer,
}

impl<'a> Pass<'a> {
    fn new(gpu: &'a Gpu, map: &'a CompositeMap, frame: Frame, count: usize) -> Result<Self, GpuError> {
        let source = &map.domains()[0];
        let entries = source.vertex_count() + source.rings().len();
        let bytes = (entries * size_of::<Entry>()) as u64;
        if bytes > gpu.most_bytes {
            return Err(GpuError::DomainTooLarge { vertices: source.vertex_count(), bytes, most: gpu.most_bytes });
        }
        let room = (gpu.most_bytes as usize / size_of::<[f32; 4]>()).min(MOST_IN_PASS);
        let points = count.min(room).min(MOST_WORK / entries).max(1);
        let steps = map.step_count().min((gpu.most_bytes / bytes) as usize).min(MOST_WORK / (points * entries)).max(1);
        let room = (points * size_of::<[f32; 4]>()) as u64;
        let parameters = gpu.buffer(16, PARAMETERS);
        let domains = gpu.buffer(bytes * steps as u64, READ);
        let (places, results) = (gpu.buffer(room, CHANGED), gpu.buffer(room, FETCHED));
        Ok(Self { gpu, map, frame, entries, points, steps, parameters, domains, places, results })
    }

    /// Sends all points through all steps; `receive` is given where the points begin that arrive, and their places.
    fn run(&self, points: &[Point2], mut receive: impl FnMut(usize, &[[f32; 4]])) -> Result<(), GpuError> {
        let batches: Vec<Vec<Entry>> = (0..self.map.step_count()).step_by(self.steps).map(|s| self.batch(s)).collect();
        let [low, high] = self.map.domains()[0].bounds();
        let is_near = |p: Point2| (0..2).all(|k| low[k] <= p[k] && p[k] <= high[k]);
        let start = |&point: &Point2| if is_near(point) { self.frame.split(point) } else { [IS_OUTSIDE; 4] };
        for (number, points) in points.chunks(self.points).enumerate() {
            let places: Vec<[f32; 4]> = points.par_iter().map(start).collect();
            self.gpu.write(&self.places, &places);
            for (number, batch) in batches.iter().enumerate() {
                self.gpu.write(&self.domains, batch);
                let steps = batch.len() / self.entries;
                let parameters = [points.len(), self.entries, steps, usize::from(number == 0)].map(|x| x as u32);
                self.gpu.write(&self.parameters, &parameters);
                let buffers = [&self.parameters, &self.domains, &self.places];
                self.gpu.start(&self.gpu.images, &buffers, points.len());
            }
            let first = number * self.points;
            self.gpu.fetch(&self.places, &self.results, points.len(), |places| receive(first, places))?;
        }
        Ok(())
    }

    /// Entries of the domains of some steps.
    fn batch(&self, first: usize) -> Vec<Entry> {
        let domains = &self.map.domains()[first..];
        let pairs = domains.windows(2).take(self.steps);
        let rings = pairs.flat_map(|pair| pair[0].rings().iter().zip(pair[1].rings()));
        rings.flat_map(|(from, to)| (0..=from.len()).map(move |k| self.entry(from, to, k))).collect()
    }

    fn entry(&self, from: &[Point2], to: &[Point2], k: usize) -> Entry {
        let vertex = k % from.len();
        let (p, q) = (from[vertex], to[vertex]);
        let [x, y, rest_x, rest_y] = self.frame.split(p);
        let [way_x, way_y] = self.frame.scaled([q[0] - p[0], q[1] - p[1]]);
        [x, y, rest_x, rest_y, way_x, way_y, if k == 0 { 0.0 } else { 1.0 }, 0.0]
    }
}
