//! From a checked mesh to a foliation: the order of the steps and what happens when one fails.

use std::time::Instant;

use homeo_core::mesh::{Adjacency, CellId, EdgeIndex, Facet, SimplicialComplex, VertexId};

use super::boundary::{BoundarySurface, boundary_loop, facet_masks, marked_facets};
use super::directions::Flow;
use super::field::{cell_means, field_between, guiding_field, ranks, smoothed_gradients};
use super::front::{Front, Side, Stuck, Surroundings, positions_in};
use super::numbering::CurveNumbering;
use super::{FoliationError, FoliationInfo, FoliationParams, RequestedRegions, regions, section};
use crate::input::SourceMesh;
use crate::map::{Centre, Foliation, FoliationParts, Section, Target};
use crate::progress::Progress;
use crate::refine::{RefinedMesh, Stars, spanning_simplices};

/// Up to which value of the Fiedler vector the caps of a cube grow, until the source has an embedding.
const CAP_FRACTIONS: [f64; 4] = [0.25, 0.1, 0.03, 0.0];

/// A mesh with everything that the steps ask of it.
struct Stage<const K: usize> {
    mesh: RefinedMesh<K>,
    adjacency: Adjacency<K>,
    edges: EdgeIndex<K>,
    /// Coordinates scaled into the unit box; they guide and prove nothing.
    guide: Vec<[f64; 3]>,
}

impl<const K: usize> Stage<K> {
    fn new(mesh: RefinedMesh<K>) -> Result<Self, FoliationError> {
        let adjacency = mesh.complex().adjacency().map_err(|crowded| FoliationError::Input(crowded.to_string()))?;
        let edges = mesh.complex().edges();
        let guide = unit_box(mesh.positions());
        Ok(Self { mesh, adjacency, edges, guide })
    }

    /// Stars simplices; masks of boundary facets follow their facets.
    fn star(
        &mut self,
        source: &SourceMesh<K>,
        stars: &Stars,
        masks: &mut [Vec<u8>],
    ) -> Result<Vec<CellId>, FoliationError> {
        let origins = self.mesh.star(source, &self.adjacency, &self.edges, stars)?;
        let before: Vec<Vec<u8>> = masks.to_vec();
        *self = Self::new(std::mem::replace(&mut self.mesh, RefinedMesh::unrefined(source)))?;
        for (mask, before) in masks.iter_mut().zip(before) {
            // A cell has at most one boundary facet here, so its children's boundary facets are parts of it.
            *mask = facet_masks(
                self.mesh.complex().cell_count(),
                self.adjacency.boundary_facets().filter(|f| before[origins[f.cell().index()].index()] != 0),
            );
        }
        Ok(origins)
    }

    /// Stars all simplices that span from boundary to boundary. Whatever contains one of the new vertices has a
    /// vertex inside, so that none is left to be starred again.
    fn unspan(&mut self, source: &SourceMesh<K>, masks: &mut [Vec<u8>]) -> Result<(), FoliationError> {
        let stars = spanning_simplices(self.mesh.complex(), &self.adjacency, &self.edges);
        if !stars.is_empty() {
            self.star(source, &stars, masks)?;
        }
        Ok(())
    }

    fn no_stars(&self) -> Stars {
        Stars::none(self.mesh.complex().cell_count(), self.edges.len())
    }
}

fn unit_box(positions: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    }
    let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let scale = if extent > 0.0 && extent.is_finite() { extent } else { 1.0 };
    positions.iter().map(|p| std::array::from_fn(|axis| (p[axis] - low[axis]) / scale)).collect()
}

/// One run of the construction.
struct Build<'a, const K: usize> {
    source: &'a SourceMesh<K>,
    target: Target,
    params: &'a FoliationParams,
    progress: &'a dyn Progress,
    info: FoliationInfo,
    clock: Instant,
}

/// Builds the map; see the module's documentation.
pub(super) fn build<const K: usize>(
    source: &SourceMesh<K>,
    target: Target,
    params: &FoliationParams,
    progress: &dyn Progress,
) -> Result<(Foliation<K>, FoliationInfo), FoliationError> {
    let info = FoliationInfo::default();
    // Regions that the user names are named, and complained about, in the numbering of the source.
    let is_free = params.regions == RequestedRegions::default();
    let numbering = is_free.then(|| CurveNumbering::new(source));
    let renumbered = numbering.as_ref().map_or(source, |numbering| &numbering.source);
    let mut build = Build { source: renumbered, target, params, progress, info, clock: Instant::now() };
    let (mut parts, mut adjacency) = build.run()?;
    if let Some(numbering) = &numbering {
        (parts, adjacency) = numbering.restored(source, &parts, &adjacency);
    }
    Ok((Foliation::from_parts(source.clone(), adjacency, parts), build.info))
}

impl<const K: usize> Build<'_, K> {
    fn begin(&mut self, stage: &'static str) -> Result<(), FoliationError> {
        self.end();
        self.clock = Instant::now();
        self.info.seconds.push((stage, 0.0));
        self.progress.stage(stage);
        self.check_limits()
    }

    fn end(&mut self) {
        if let Some((_, seconds)) = self.info.seconds.last_mut() {
            *seconds = self.clock.elapsed().as_secs_f64();
        }
    }

    fn check_limits(&self) -> Result<(), FoliationError> {
        if self.progress.is_cancelled() { Err(FoliationError::Cancelled(self.info.clone())) } else { Ok(()) }
    }

    fn run(&mut self) -> Result<(FoliationParts<K>, Adjacency<K>), FoliationError> {
        self.begin("prepare")?;
        let mut stage = Stage::new(RefinedMesh::unrefined(self.source))?;
        if K == 3 && boundary_loop(stage.mesh.complex(), &stage.adjacency).is_empty() {
            let what = "the boundary is not one loop round triangles of one orientation: the surface is no disk";
            return Err(FoliationError::Input(what.to_owned()));
        }
        stage.unspan(self.source, &mut [])?;
        let mut surroundings = self.surround(&mut stage)?;
        let (order, field) = self.order(&mut stage, &mut surroundings)?;

        self.begin("directions")?;
        let complex = stage.mesh.complex();
        let position = positions_in(&order, complex.cell_count());
        let wanted = smoothed_gradients(complex, &stage.guide, &field);
        let mut flow = Flow::new(complex, &stage.guide, &stage.adjacency, &surroundings, &position, &wanted);
        self.begin("smooth")?;
        for _ in 0..self.params.smoothing_sweeps {
            flow.smooth();
            self.info.facets_turned += flow.turn_facets();
            self.check_limits()?;
        }
        let (directions, lengths) = flow.quantize();
        drop(flow);

        self.begin("section")?;
        let section = self.section(&stage, &surroundings)?;
        let (lengths, unit) = whole_lengths(&lengths);
        let centre = surroundings.centre.map(|(cell, _)| {
            let radius = inradius(stage.mesh.complex().cell(cell).map(|v| stage.guide[v.index()]));
            Centre { cell, length: ((radius / unit).round() as u32).max(1) }
        });
        self.end();
        self.info.cells = stage.mesh.complex().cell_count();
        self.info.vertices = stage.mesh.complex().vertex_count();
        let Stage { mesh, adjacency, .. } = stage;
        let parts =
            FoliationParts { target: self.target, mesh, directions, lengths, length_unit: unit, centre, section };
        Ok((parts, adjacency))
    }

    /// Chooses regions or a centre, refining where the mesh is too coarse for them.
    fn surround(&mut self, stage: &mut Stage<K>) -> Result<Surroundings, FoliationError> {
        match self.target {
            Target::Disk | Target::Ball => self.surround_centre(stage),
            Target::Square => loop {
                let requested = self.params.regions.corners;
                match regions::square_sides(stage.mesh.complex(), &stage.adjacency, &stage.guide, requested) {
                    Err(regions::RegionError::TooCoarse) => self.barycentric(stage)?,
                    other => return Ok(other?),
                }
            },
            Target::Cube => self.surround_caps(stage),
        }
    }

    /// Caps of a cube whose source has an embedding; smaller ones where the usual have none.
    fn surround_caps(&mut self, stage: &mut Stage<K>) -> Result<Surroundings, FoliationError> {
        let mut fractions = CAP_FRACTIONS.iter();
        let mut fraction = fractions.next();
        loop {
            let requested = &self.params.regions;
            let share = fraction.copied().unwrap_or(0.0);
            let caps = regions::cube_caps(stage.mesh.complex(), &stage.adjacency, &stage.guide, requested, share);
            let mut surroundings = match caps {
                Err(regions::RegionError::TooCoarse) => {
                    self.barycentric(stage)?;
                    continue;
                }
                other => other?,
            };
            self.unchord(stage, &mut surroundings)?;
            fraction = fractions.next();
            match self.section(stage, &surroundings) {
                Err(FoliationError::Section(_)) if fraction.is_some() && requested.source.is_none() => {}
                Err(error) => return Err(error),
                Ok(_) => return Ok(surroundings),
            }
        }
    }

    /// Refines a mesh that is too coarse for two regions; once is enough for disks and balls.
    fn barycentric(&mut self, stage: &mut Stage<K>) -> Result<(), FoliationError> {
        let children: usize = (1..=K).product();
        let cells = stage.mesh.complex().cell_count();
        if self.info.barycentric_refinements >= 2 || cells > self.params.most_cells / children {
            return Err(regions::RegionError::TooCoarse.into());
        }
        let mut stars = stage.no_stars();
        stars.cells.fill(true);
        stars.edges.fill(true);
        if K == 4 {
            stars.facets.fill(15);
        }
        stage.star(self.source, &stars, &mut [])?;
        self.info.barycentric_refinements += 1;
        Ok(())
    }

    /// Stars the interior edges of the source region that join its boundary to itself: they would
    /// flatten triangles of Tutte's embedding.
    fn unchord(&mut self, stage: &mut Stage<K>, surroundings: &mut Surroundings) -> Result<(), FoliationError> {
        loop {
            let surface = BoundarySurface::new(stage.mesh.complex(), marked_facets(&surroundings.source).collect());
            let adjacency = surface.triangles.adjacency().map_err(|c| FoliationError::Input(c.to_string()))?;
            let edges = surface.triangles.edges();
            let mut chords = spanning_simplices(&surface.triangles, &adjacency, &edges).edges;
            if boundary_loop(&surface.triangles, &adjacency).len() == 3 {
                // The square has four corners.
                chords.fill(true);
            }
            let mut stars = stage.no_stars();
            for (ends, _) in edges.ends().iter().zip(&chords).filter(|&(_, &chord)| chord) {
                let [a, b] = ends.map(|v| surface.vertices[v.index()]);
                if let Some(edge) = stage.edges.between(a, b) {
                    stars.edges[edge.index()] = true;
                }
            }
            let masks = [&mut surroundings.source, &mut surroundings.sink];
            let mut carried = masks.map(std::mem::take);
            let done = stars.is_empty();
            if !done {
                stage.star(self.source, &stars, &mut carried)?;
                stage.unspan(self.source, &mut carried)?;
            }
            [surroundings.source, surroundings.sink] = carried;
            if done {
                return Ok(());
            }
        }
    }

    fn surround_centre(&mut self, stage: &mut Stage<K>) -> Result<Surroundings, FoliationError> {
        // The section decides where leaves begin: on the boundary of a disk, in the centre of a ball.
        let side = if self.target == Target::Ball { Side::Source } else { Side::Sink };
        let wanted = self.params.regions.centre;
        if let Some(cell) = wanted.filter(|&cell| cell as usize >= self.source.complex().cell_count()) {
            let message = format!("centre {cell} is no cell of the mesh");
            return Err(regions::RegionError::Requested(message).into());
        }
        let parents = stage.mesh.parents();
        let allowed = |cell: CellId| wanted.is_none_or(|w| parents[cell.index()].raw() == w);
        let complex = stage.mesh.complex();
        let (mut cell, distance) = regions::centre(complex, &stage.adjacency, &stage.edges, &stage.guide, &allowed);
        if distance <= 0.0 {
            cell = self.nest_cell(stage, cell)?;
        }
        Ok(regions::radial(stage.mesh.complex(), &stage.adjacency, cell, side))
    }

    /// Makes a cell strictly inside another one, by starring it `K` times.
    fn nest_cell(&mut self, stage: &mut Stage<K>, cell: CellId) -> Result<CellId, FoliationError> {
        let mut inner = cell;
        for corner in 0..K {
            let mut stars = stage.no_stars();
            stars.cells[inner.index()] = true;
            stage.star(self.source, &stars, &mut [])?;
            // Children follow one another; child `k` has its vertex `k` at the new point.
            inner = CellId::new(inner.index() + corner);
        }
        Ok(inner)
    }

    /// Finds an order, by restarts and refinement where the front gets stuck.
    fn order(
        &mut self,
        stage: &mut Stage<K>,
        surroundings: &mut Surroundings,
    ) -> Result<(Vec<CellId>, Vec<f64>), FoliationError> {
        loop {
            self.begin("harmonic")?;
            let field = self.field(stage, surroundings);
            self.begin("order")?;
            let mut values = cell_means(stage.mesh.complex(), &field);
            let mut least: Option<Vec<CellId>> = None;
            for attempt in 0..self.attempts(stage) {
                self.check_limits()?;
                if attempt == 2 {
                    // Another field takes another way round what the first one got stuck on.
                    values = cell_means(stage.mesh.complex(), &self.steep_field(stage, surroundings));
                }
                match advance(stage, surroundings, &values, attempt, self.params.seed) {
                    Ok(order) => return Ok((order, field)),
                    Err(stuck) => {
                        self.info.restarts += 1;
                        if least.as_ref().is_none_or(|best| stuck.remaining.len() < best.len()) {
                            least = Some(stuck.remaining);
                        }
                    }
                }
            }
            self.refine_stuck(stage, surroundings, &least.unwrap_or_default())?;
        }
    }

    /// Runs of the front before refinement: fewer on large meshes, where each takes seconds.
    fn attempts(&self, stage: &Stage<K>) -> usize {
        let affordable = 4_000_000 / stage.mesh.complex().cell_count().max(1);
        self.params.restarts.clamp(1, affordable.max(4))
    }

    fn field(&self, stage: &Stage<K>, surroundings: &Surroundings) -> Vec<f64> {
        let [source, sink] =
            [&surroundings.source, &surroundings.sink].map(|masks| marked_facets(masks).collect::<Vec<_>>());
        let centre = surroundings.centre.map(|(cell, _)| cell);
        guiding_field(stage.mesh.complex(), &stage.guide, &stage.edges, &source, &sink, centre)
    }

    fn steep_field(&self, stage: &Stage<K>, surroundings: &Surroundings) -> Vec<f64> {
        let complex = stage.mesh.complex();
        let mut ends = [&surroundings.source, &surroundings.sink].map(|masks| facet_vertices(complex, masks));
        if let Some((centre, side)) = surroundings.centre {
            ends[usize::from(side == Side::Sink)] = complex.cell(centre).to_vec();
        }
        field_between(complex, &stage.guide, &stage.edges, &ends[0], &ends[1])
    }

    /// Refines round the cells that a front could not take, or everything after several such tries.
    fn refine_stuck(
        &mut self,
        stage: &mut Stage<K>,
        surroundings: &mut Surroundings,
        stuck: &[CellId],
    ) -> Result<(), FoliationError> {
        let refinements = self.info.local_refinements + self.info.barycentric_refinements;
        let cells = stage.mesh.complex().cell_count();
        let everything = self.info.local_refinements >= 2 * (self.info.barycentric_refinements + 1);
        let parts = if K == 4 { 24 } else { 6 };
        let after = if everything { parts * cells } else { cells + parts * stuck.len() };
        if refinements >= self.params.refinements || after > self.params.most_cells {
            self.end();
            self.info.stuck_cells = stuck.len();
            self.info.cells = cells;
            return Err(FoliationError::Stuck(self.info.clone()));
        }
        self.begin("prepare")?;
        let mut stars = stage.no_stars();
        let everything = self.info.local_refinements >= 2 * (self.info.barycentric_refinements + 1);
        let chosen: Vec<CellId> = if everything { stage.mesh.complex().cell_ids().collect() } else { stuck.to_vec() };
        for &cell in chosen.iter().filter(|&&cell| surroundings.centre.is_none_or(|(centre, _)| centre != cell)) {
            stars.cells[cell.index()] = true;
            stage.edges.of_cell(cell).iter().for_each(|edge| stars.edges[edge.index()] = true);
            if K == 4 {
                stars.facets[cell.index()] = 15;
            }
        }
        if let Some((centre, _)) = surroundings.centre {
            // The centre stays whole.
            stage.edges.of_cell(centre).iter().for_each(|edge| stars.edges[edge.index()] = false);
            for i in 0..K {
                let far = stage.adjacency.across(centre, i);
                if K == 4 && far.is_some() {
                    stars.facets[far.cell().index()] &= !(1 << far.opposite());
                }
            }
        }
        if everything {
            self.info.barycentric_refinements += 1;
        } else {
            self.info.local_refinements += 1;
        }
        let mut carried = [std::mem::take(&mut surroundings.source), std::mem::take(&mut surroundings.sink)];
        let origins = stage.star(self.source, &stars, &mut carried)?;
        [surroundings.source, surroundings.sink] = carried;
        if let Some((centre, side)) = surroundings.centre {
            let moved = origins.iter().position(|&origin| origin == centre).map(CellId::new);
            surroundings.centre = moved.map(|cell| (cell, side));
        }
        Ok(())
    }

    fn section(&self, stage: &Stage<K>, surroundings: &Surroundings) -> Result<Section, FoliationError> {
        let (complex, adjacency) = (stage.mesh.complex(), &stage.adjacency);
        Ok(match self.target {
            Target::Square => section::square_section(complex, adjacency, &stage.guide, &surroundings.source),
            Target::Disk => section::disk_section(complex, adjacency, &stage.guide),
            Target::Cube => {
                let facets: Vec<Facet> = marked_facets(&surroundings.source).collect();
                section::cube_section(&BoundarySurface::new(complex, facets), &stage.guide)?
            }
            Target::Ball => Section::Centre,
        })
    }
}

/// The vertices of the facets that a mask per cell marks, ascending.
fn facet_vertices<const K: usize>(complex: &SimplicialComplex<K>, masks: &[u8]) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> =
        marked_facets(masks).flat_map(|f| complex.facet_vertices(f.cell(), f.opposite()).collect::<Vec<_>>()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// One run of the front: from the source or from the sink, with the field or a disturbed one.
fn advance<const K: usize>(
    stage: &Stage<K>,
    surroundings: &Surroundings,
    values: &[f64],
    attempt: usize,
    seed: u64,
) -> Result<Vec<CellId>, Stuck> {
    let noise = if attempt < 4 { 0.0 } else { 0.02 * (attempt / 2 - 1) as f64 };
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let disturbed = |index: usize, value: f64| value + noise * (high - low) * (unit_random(seed, attempt, index) - 0.5);
    let backwards = attempt % 2 == 1;
    let sign = if backwards { -1.0 } else { 1.0 };
    let values: Vec<f64> = values.iter().enumerate().map(|(i, &v)| sign * disturbed(i, v)).collect();
    let ends = if backwards { surroundings.reversed() } else { surroundings.clone() };
    let front = Front::new(stage.mesh.complex(), &stage.adjacency, &stage.edges, &ends);
    let mut order = front.advance(&ranks(&values))?;
    if backwards {
        order.reverse();
    }
    Ok(order)
}

/// A number in `[0, 1)` that depends on its arguments alone (SplitMix64).
fn unit_random(seed: u64, attempt: usize, index: usize) -> f64 {
    let mut z = seed ^ (attempt as u64) << 48 ^ index as u64;
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
}

/// Lengths as whole numbers of at most 31 bits, at least 1, and the unit.
fn whole_lengths(lengths: &[f64]) -> (Vec<u32>, f64) {
    let longest = lengths.iter().copied().filter(|h| h.is_finite()).fold(0.0, f64::max);
    let unit = if longest > 0.0 { longest / f64::from(1u32 << 31) } else { 1.0 };
    (lengths.iter().map(|&h| if h.is_finite() { ((h / unit).round() as u32).max(1) } else { 1 }).collect(), unit)
}

/// Radius of the inscribed circle or sphere.
fn inradius<const K: usize>(corners: [[f64; 3]; K]) -> f64 {
    let (gradients, _) = super::field::gradients(corners);
    // The distance from the centre to a facet is the radius, and the heights are 1 / |gradient|.
    1.0 / gradients.iter().map(|&g| super::field::dot(g, g).sqrt()).sum::<f64>()
}
