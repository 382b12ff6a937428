//! Directions of the leaves: one vector per cell, in barycentric offsets.
//!
//! The order of the cells fixes the sign of every offset: positive where leaves enter through the
//! facet opposite that vertex, negative where they leave, zero along a parallel facet. Within these
//! signs the direction is free. [`Flow::smooth`] makes neighbouring directions alike (constrained
//! Gauss-Seidel with clamping) and turns facets round where both sides press against them;
//! [`Flow::quantize`] rounds to small whole numbers that add up to zero exactly.

use homeo_core::mesh::{Adjacency, CELL_EDGES, CellId, SimplicialComplex, VertexId};

use super::front::Surroundings;

/// What the positive offsets of a stored direction add up to, and the negative ones in magnitude.
///
/// Exact coordinates along a leaf grow by up to seven bits per cell with this.
pub const OFFSET_SUM: i32 = 120;

/// Smoothing keeps each offset at least this fraction of the sum, so that no leaf is nearly
/// parallel to a facet that it crosses.
const LEAST_FRACTION: f32 = 1.0 / 40.0;

/// A direction field under construction.
pub struct Flow<'a, const K: usize> {
    adjacency: &'a Adjacency<K>,
    corners: &'a [[VertexId; K]],
    /// Edge vectors from the first vertex of each cell to the others, `#C by 3 by 3`.
    spans: Vec<[[f32; 3]; 3]>,
    /// Per cell and facet: 1 inflow, -1 outflow, 0 parallel.
    signs: Vec<[i8; K]>,
    /// Unit vectors.
    vectors: Vec<[f32; 3]>,
    /// Size of the guiding field's gradient: how many leaves should pass.
    densities: Vec<f32>,
    /// A topological order: flow goes from lower to higher keys.
    keys: Vec<f64>,
    /// Per cell, a bit for each facet that its direction was clamped against in the last sweep.
    clamped: Vec<u8>,
    /// Cells without a direction of their own (the centre).
    skip: Option<CellId>,
}

impl<'a, const K: usize> Flow<'a, K> {
    /// The field of an order (`position` of each cell in it), near the given vectors within the signs.
    pub fn new(
        complex: &'a SimplicialComplex<K>,
        positions: &[[f64; 3]],
        adjacency: &'a Adjacency<K>,
        surroundings: &Surroundings,
        position: &[u32],
        wanted: &[[f32; 3]],
    ) -> Self {
        let signs: Vec<[i8; K]> = complex
            .cell_ids()
            .map(|cell| std::array::from_fn(|i| sign(adjacency, surroundings, position, cell, i)))
            .collect();
        let spans = complex.cells().iter().map(|cell| spans(cell.map(|v| positions[v.index()]))).collect();
        let mut flow = Self {
            adjacency,
            corners: complex.cells(),
            spans,
            vectors: vec![[0.0; 3]; signs.len()],
            densities: wanted.iter().map(|w| dot(*w, *w).sqrt()).collect(),
            clamped: vec![0; signs.len()],
            keys: position.iter().map(|&p| f64::from(p)).collect(),
            skip: surroundings.centre.map(|(cell, _)| cell),
            signs,
        };
        for index in 0..flow.signs.len() {
            let (offsets, _) = flow.constrained(index, wanted[index]);
            flow.vectors[index] = normalized(combine(&flow.spans[index], &offsets));
        }
        flow
    }

    /// One sweep of constrained smoothing over all cells.
    pub fn smooth(&mut self) {
        for index in 0..self.vectors.len() {
            let cell = CellId::new(index);
            if self.skip == Some(cell) {
                continue;
            }
            let mut wanted = [0.0f32; 3];
            for i in 0..K {
                let far = self.adjacency.across(cell, i);
                if far.is_some() {
                    let vector = self.vectors[far.cell().index()];
                    (0..3).for_each(|axis| wanted[axis] += vector[axis]);
                }
            }
            let (offsets, clamped) = self.constrained(index, wanted);
            let vector = normalized(combine(&self.spans[index], &offsets));
            if vector.iter().all(|x| x.is_finite()) {
                self.vectors[index] = vector;
                self.clamped[index] = clamped;
            }
        }
    }

    /// Offsets of a wanted vector, clamped to the signs of the cell, and which were clamped.
    ///
    /// The positive offsets add up to 1 and the negative ones to -1.
    fn constrained(&self, index: usize, wanted: [f32; 3]) -> ([f32; K], u8) {
        let offsets = offsets::<K>(&self.spans[index], wanted);
        let signs = self.signs[index];
        let scale = offsets.iter().map(|o| o.abs()).sum::<f32>() / 2.0;
        if !(scale > 0.0 && scale.is_finite()) {
            return (balanced(signs.map(f32::from)), 0);
        }
        let mut clamped = 0;
        let kept = std::array::from_fn(|i| {
            let along = offsets[i] * f32::from(signs[i]) / scale;
            clamped |= u8::from(signs[i] != 0 && along <= LEAST_FRACTION) << i;
            along.max(LEAST_FRACTION) * f32::from(signs[i])
        });
        (balanced(kept), clamped)
    }

    /// Turns round the facets that both neighbours were clamped against, where bipolarity allows.
    ///
    /// Gives the number of facets turned.
    pub fn turn_facets(&mut self) -> usize {
        let mut turned = 0;
        for index in 0..self.signs.len() {
            for i in 0..K {
                if self.clamped[index] >> i & 1 == 0 {
                    continue;
                }
                let far = self.adjacency.across(CellId::new(index), i);
                let both = far.is_some()
                    && self.skip != Some(far.cell())
                    && self.clamped[far.cell().index()] >> far.opposite() & 1 == 1;
                // Turning may have changed this cell's own signs meanwhile.
                if both && self.signs[index][i] < 0 && self.try_turn(index, i) {
                    turned += 1;
                }
            }
        }
        turned
    }

    /// Lets leaves cross outflow facet `i` of a cell the other way, if the field stays bipolar.
    ///
    /// Locally: turning changes who is source and who is sink only for the two cells, around the
    /// facet's own vertices and edges. The count of sources stays 1 exactly when the cell stops being
    /// a source where its neighbour becomes one; the same for sinks.
    /// Globally: it is enough that one of the two cells can move past the other in the order without
    /// passing another neighbour.
    fn try_turn(&mut self, index: usize, i: usize) -> bool {
        let far = self.adjacency.across(CellId::new(index), i);
        let (other, j) = (far.cell().index(), far.opposite());
        let Some(moved) = self.moved_key(index, i, other, j) else { return false };
        let (here, there) = (self.signs[index], self.signs[other]);
        let alone = |signs: [i8; K], except: usize, sign: i8| (0..K).all(|k| k == except || signs[k] != sign);
        if alone(here, i, -1) || alone(there, j, 1) {
            return false;
        }
        if !self.stays_bipolar(index, i, other, j) {
            return false;
        }
        self.signs[index][i] = 1;
        self.signs[other][j] = -1;
        match moved {
            Moved::Forward(key) => self.keys[index] = key,
            Moved::Back(key) => self.keys[other] = key,
        }
        true
    }

    /// A new key for one of two neighbours such that the first comes after the second.
    fn moved_key(&self, index: usize, i: usize, other: usize, j: usize) -> Option<Moved> {
        let between = |low: f64, high: f64| {
            let middle = low + (high - low) / 2.0;
            let middle = if high == f64::INFINITY {
                low + 1.0
            } else if low == f64::NEG_INFINITY {
                high - 1.0
            } else {
                middle
            };
            (low < middle && middle < high).then_some(middle)
        };
        let neighbour_keys = |cell: usize, except: usize, sign: i8| {
            (0..K).filter(move |&k| k != except && self.signs[cell][k] == sign).filter_map(move |k| {
                let far = self.adjacency.across(CellId::new(cell), k);
                (far.is_some() && self.skip != Some(far.cell())).then(|| self.keys[far.cell().index()])
            })
        };
        let first_after = neighbour_keys(index, i, -1).fold(f64::INFINITY, f64::min);
        if let Some(key) = between(self.keys[other], first_after) {
            return Some(Moved::Forward(key));
        }
        let last_before = neighbour_keys(other, j, 1).fold(f64::NEG_INFINITY, f64::max);
        between(last_before, self.keys[index]).map(Moved::Back)
    }

    fn stays_bipolar(&self, index: usize, i: usize, other: usize, j: usize) -> bool {
        let matching = self.matching(index, i, other, j);
        // Whether no facet of the cell that contains a face, the shared one aside, has the sign.
        let free_of = |signs: [i8; K], shared: usize, face: u8, sign: i8| {
            (0..K).all(|k| k == shared || face >> k & 1 == 1 || signs[k] != sign)
        };
        let (here, there) = (self.signs[index], self.signs[other]);
        let agree = |face_here: u8| {
            let face_there = (0..K).filter(|k| face_here >> k & 1 == 1).fold(0, |face, k| face | 1 << matching[k]);
            let was_source = free_of(here, i, face_here, 1);
            let becomes_source = free_of(there, j, face_there, 1);
            let was_sink = free_of(there, j, face_there, -1);
            let becomes_sink = free_of(here, i, face_here, -1);
            was_source == becomes_source && was_sink == becomes_sink
        };
        let vertices = (0..K).filter(|&k| k != i).all(|k| agree(1 << k));
        let edges = || CELL_EDGES.iter().filter(|edge| !edge.contains(&i)).all(|&[a, b]| agree(1 << a | 1 << b));
        vertices && (K < 4 || edges())
    }

    /// For each local vertex of the shared facet, its number in the other cell.
    fn matching(&self, index: usize, i: usize, other: usize, j: usize) -> [usize; K] {
        let (here, there) = (self.corners[index], self.corners[other]);
        let mut matching = [j; K];
        for k in (0..K).filter(|&k| k != i) {
            matching[k] = (0..K)
                .find(|&l| l != j && there[l] == here[k])
                .expect("neighbours share the facet (please report this)");
        }
        matching
    }

    /// Directions as whole numbers that add up to zero, the positive ones to [`OFFSET_SUM`], and the
    /// length of each (in the mesh's units).
    ///
    /// The offsets of a cell are the *fluxes* through its facets, and zero sum means that what comes in
    /// goes out. So a positive flux on every facet that is conserved in every cell makes the map keep
    /// the measure of leaves: they neither pile up nor thin out systematically. Fluxes are found along
    /// the order: what comes into a cell is divided among its outflow facets as the smoothed vectors want.
    pub fn quantize(&self) -> (Vec<[i8; K]>, Vec<f64>) {
        let wanted = self.wanted_fluxes();
        let mut fluxes = wanted.clone();
        let mut order: Vec<CellId> = (0..self.signs.len()).map(CellId::new).collect();
        order.sort_unstable_by(|a, b| self.keys[a.index()].total_cmp(&self.keys[b.index()]));
        let mut directions = vec![[0; K]; self.signs.len()];
        let mut lengths = vec![0.0; self.signs.len()];
        for cell in order.into_iter().filter(|&cell| self.skip != Some(cell)) {
            let index = cell.index();
            let signs = self.signs[index];
            let sum =
                |fluxes: &[f32; K], sign: i8| (0..K).filter(|&i| signs[i] == sign).map(|i| fluxes[i]).sum::<f32>();
            let factor = sum(&fluxes[index], 1) / sum(&wanted[index], -1);
            for i in (0..K).filter(|&i| signs[i] < 0) {
                // Bounds keep single precision from running out on extreme meshes.
                let flux = (wanted[index][i] * factor).clamp(1e-30, 1e30);
                fluxes[index][i] = flux;
                let far = self.adjacency.across(cell, i);
                if far.is_some() {
                    fluxes[far.cell().index()][far.opposite()] = flux;
                }
            }
            let offsets = balanced(std::array::from_fn(|i| fluxes[index][i] * f32::from(signs[i])));
            directions[index] = rounded_offsets(&offsets, &signs);
            let vector = combine(&self.spans[index], &directions[index].map(f32::from));
            lengths[index] = vector.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>().sqrt();
        }
        (directions, lengths)
    }

    /// The flux through each facet that the vectors want, not below a fraction of what passes the cells.
    fn wanted_fluxes(&self) -> Vec<[f32; K]> {
        let own: Vec<[f32; K]> = (0..self.signs.len())
            .map(|index| {
                let density = self.densities[index].max(f32::MIN_POSITIVE);
                let fluxes = facet_fluxes::<K>(&self.spans[index], self.vectors[index]);
                let passing = fluxes.iter().map(|f| f.abs()).sum::<f32>() / 2.0;
                std::array::from_fn(|i| {
                    let along = fluxes[i] * f32::from(self.signs[index][i]);
                    (along.max(LEAST_FRACTION * passing) * density).clamp(1e-30, 1e30)
                })
            })
            .collect();
        (0..own.len())
            .map(|index| {
                std::array::from_fn(|i| {
                    let far = self.adjacency.across(CellId::new(index), i);
                    match far {
                        far if far.is_some() && self.skip != Some(far.cell()) => {
                            (own[index][i] + own[far.cell().index()][far.opposite()]) / 2.0
                        }
                        _ => own[index][i],
                    }
                })
            })
            .collect()
    }
}

enum Moved {
    /// The first cell moves after the second.
    Forward(f64),
    /// The second cell moves before the first.
    Back(f64),
}

/// Sign of the offset for facet `i` of a cell, from the order.
fn sign<const K: usize>(
    adjacency: &Adjacency<K>,
    surroundings: &Surroundings,
    position: &[u32],
    cell: CellId,
    i: usize,
) -> i8 {
    let far = adjacency.across(cell, i);
    if far.is_none() {
        let bit = 1 << i;
        let is = |mask: &[u8]| i8::from(mask[cell.index()] & bit != 0);
        return is(&surroundings.source) - is(&surroundings.sink);
    }
    let is_centre = |c: CellId| surroundings.centre.is_some_and(|(centre, _)| centre == c);
    let key = |c: CellId| match surroundings.centre {
        Some((centre, super::front::Side::Source)) if centre == c => -1,
        _ => i64::from(position[c.index()]),
    };
    if is_centre(cell) {
        return 0;
    }
    if key(far.cell()) < key(cell) { 1 } else { -1 }
}

/// Edge vectors from the first corner (the third is 0 for a triangle).
fn spans<const K: usize>(corners: [[f64; 3]; K]) -> [[f32; 3]; 3] {
    let mut spans = [[0.0; 3]; 3];
    for i in 1..K {
        spans[i - 1] = std::array::from_fn(|axis| (corners[i][axis] - corners[0][axis]) as f32);
    }
    spans
}

/// The vector that offsets stand for.
fn combine<const K: usize>(spans: &[[f32; 3]; 3], offsets: &[f32; K]) -> [f32; 3] {
    std::array::from_fn(|axis| (1..K).map(|i| offsets[i] * spans[i - 1][axis]).sum())
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Offsets that stand for a vector (its projection, for a triangle), up to a positive factor.
fn offsets<const K: usize>(spans: &[[f32; 3]; 3], vector: [f32; 3]) -> [f32; K] {
    let mut offsets = [0.0; K];
    if K == 4 {
        let normals = [cross(spans[1], spans[2]), cross(spans[2], spans[0]), cross(spans[0], spans[1])];
        let orientation = dot(spans[0], normals[0]).signum();
        (0..3).for_each(|i| offsets[i + 1] = dot(normals[i], vector) * orientation);
    } else {
        let normal = cross(spans[0], spans[1]);
        offsets[1] = dot(cross(spans[1], normal), vector);
        offsets[2] = dot(cross(normal, spans[0]), vector);
    }
    offsets[0] = -offsets[1..].iter().sum::<f32>();
    offsets
}

/// Flux of a vector into the cell through each facet (twice the measure times the normal component).
fn facet_fluxes<const K: usize>(spans: &[[f32; 3]; 3], vector: [f32; 3]) -> [f32; K] {
    let offsets = offsets::<K>(spans, vector);
    if K == 4 {
        return offsets;
    }
    let normal = cross(spans[0], spans[1]);
    let size = dot(normal, normal).sqrt().max(f32::MIN_POSITIVE);
    offsets.map(|o| 2.0 * o / size)
}

/// Scales the positive offsets to add up to 1 and the negative ones to -1.
fn balanced<const K: usize>(offsets: [f32; K]) -> [f32; K] {
    let inward: f32 = offsets.iter().map(|o| o.max(0.0)).sum();
    let outward: f32 = offsets.iter().map(|o| (-o).max(0.0)).sum();
    offsets.map(|o| if o > 0.0 { o / inward } else { o / outward })
}

fn normalized(vector: [f32; 3]) -> [f32; 3] {
    let length = dot(vector, vector).sqrt();
    vector.map(|x| x / length)
}

/// Whole numbers with the given signs, near `OFFSET_SUM` times the offsets, that add up to zero.
fn rounded_offsets<const K: usize>(offsets: &[f32; K], signs: &[i8; K]) -> [i8; K] {
    let mut rounded = [0i32; K];
    for sign in [1i8, -1] {
        let members = || (0..K).filter(|&i| signs[i] == sign);
        for i in members() {
            rounded[i] = ((offsets[i].abs() * OFFSET_SUM as f32).round() as i32).clamp(1, OFFSET_SUM);
        }
        if let Some(largest) = members().max_by_key(|&i| rounded[i]) {
            let excess = members().map(|i| rounded[i]).sum::<i32>() - OFFSET_SUM;
            rounded[largest] -= excess;
            debug_assert!(rounded[largest] > 0, "three offsets of at least 1 fit into the sum");
        }
    }
    std::array::from_fn(|i| rounded[i] as i8 * signs[i])
}
