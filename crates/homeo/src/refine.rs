//! Subdivision of a mesh by stars, with every new vertex known exactly.
//!
//! A simplex is *starred* when a vertex is put at its centroid and joined to the boundary of its
//! surroundings. [`RefinedMesh::star`] stars any set of cells, facets and edges at once: inside a
//! cell first the cell, then its facets, then its edges in the order of their ids. What happens on a
//! facet depends on that facet alone, so neighbours agree.
//!
//! Vertices are kept as [`Carrier`]s, whole-number weights on vertices of the source mesh: the
//! refined mesh is exact although its coordinates in `f64` ([`RefinedMesh::positions`]) are rounded
//! and serve as a guide only.

use homeo_core::mesh::{Adjacency, CELL_EDGES, CellId, EdgeIndex, Facet, SimplicialComplex, VertexId};

use crate::input::SourceMesh;

/// A point of the source mesh: `sum(weights[i] * vertices[i]) / sum(weights)`.
///
/// Invariant: weights are not negative, some are positive, and their greatest common divisor is 1.
/// Entries of weight 0 repeat an arbitrary vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Carrier<const K: usize> {
    /// Source vertices.
    pub vertices: [VertexId; K],
    /// Their weights.
    pub weights: [i64; K],
}

/// Weights beyond this are refused, so that determinants of weights fit 128 bits.
const LARGEST_WEIGHT: i64 = 1 << 24;

/// Refinement went so deep that the weights of a vertex became too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("refined too deep: a vertex would need a weight of more than 24 bits")]
pub struct TooDeep;

impl<const K: usize> Carrier<K> {
    /// A source vertex itself.
    pub fn vertex(vertex: VertexId) -> Self {
        let mut weights = [0; K];
        weights[0] = 1;
        Self { vertices: [vertex; K], weights }
    }

    /// The vertices of positive weight, with their weights.
    pub fn terms(&self) -> impl Iterator<Item = (VertexId, i64)> + '_ {
        self.vertices.iter().copied().zip(self.weights).filter(|&(_, weight)| weight != 0)
    }

    /// Sum of the weights.
    pub fn total(&self) -> i64 {
        self.weights.iter().sum()
    }

    /// The centroid of points of one source cell.
    fn centroid(points: &[Self]) -> Result<Self, TooDeep> {
        let common = points.iter().try_fold(1, |common, p| lcm(common, p.total()))?;
        let mut sum = Self { vertices: [VertexId::new(0); K], weights: [0; K] };
        let mut used = 0;
        for point in points {
            let factor = common / point.total();
            for (vertex, weight) in point.terms() {
                let slot = match sum.vertices[..used].iter().position(|&v| v == vertex) {
                    Some(slot) => slot,
                    None => {
                        assert!(used < K, "the points of a carrier lie in one source cell (please report this)");
                        sum.vertices[used] = vertex;
                        used += 1;
                        used - 1
                    }
                };
                sum.weights[slot] += weight * factor;
            }
        }
        let divisor = sum.weights.iter().fold(0, |d, &w| gcd(d, w));
        sum.weights.iter_mut().for_each(|w| *w /= divisor);
        for slot in used..K {
            sum.vertices[slot] = sum.vertices[0];
        }
        if sum.total() > LARGEST_WEIGHT { Err(TooDeep) } else { Ok(sum) }
    }

    /// The point in `f64`, rounded.
    fn position(&self, source: &[[f64; 3]]) -> [f64; 3] {
        let total = self.total() as f64;
        let mut sum = [0.0; 3];
        for (vertex, weight) in self.terms() {
            for axis in 0..3 {
                sum[axis] += source[vertex.index()][axis] * (weight as f64 / total);
            }
        }
        sum
    }
}

fn gcd(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

fn lcm(a: i64, b: i64) -> Result<i64, TooDeep> {
    let product = (a / gcd(a, b)).checked_mul(b).ok_or(TooDeep)?;
    if product > LARGEST_WEIGHT << 8 { Err(TooDeep) } else { Ok(product) }
}

/// A subdivision of a source mesh.
#[derive(Clone, Debug)]
pub struct RefinedMesh<const K: usize> {
    complex: SimplicialComplex<K>,
    positions: Vec<[f64; 3]>,
    source_vertex_count: usize,
    added: Vec<Carrier<K>>,
    parents: Vec<CellId>,
}

/// Which simplices to star. Facets are given by one side.
#[derive(Clone, Debug)]
pub struct Stars {
    /// For each cell, whether its centroid becomes a vertex.
    pub cells: Vec<bool>,
    /// For each cell, a bit for each facet to be starred (either side counts; tetrahedra only).
    pub facets: Vec<u8>,
    /// For each edge, whether its midpoint becomes a vertex.
    pub edges: Vec<bool>,
}

impl Stars {
    /// None, for a mesh of that many cells and edges.
    pub fn none(cell_count: usize, edge_count: usize) -> Self {
        Self { cells: vec![false; cell_count], facets: vec![0; cell_count], edges: vec![false; edge_count] }
    }

    /// Whether nothing is to be starred.
    pub fn is_empty(&self) -> bool {
        !self.cells.contains(&true) && self.facets.iter().all(|&bits| bits == 0) && !self.edges.contains(&true)
    }
}

const UNMARKED: u32 = u32::MAX;

impl<const K: usize> RefinedMesh<K> {
    /// The source mesh itself.
    pub fn unrefined(source: &SourceMesh<K>) -> Self {
        Self {
            complex: source.complex().clone(),
            positions: source.positions().to_vec(),
            source_vertex_count: source.positions().len(),
            added: Vec::new(),
            parents: source.complex().cell_ids().collect(),
        }
    }

    /// A refined mesh from its data, as a map file holds them.
    ///
    /// # Errors
    /// A sentence, when the data do not fit together: children of a source cell follow one another,
    /// their vertices lie in it, and they are not flat.
    pub fn from_parts(
        source: &SourceMesh<K>,
        complex: SimplicialComplex<K>,
        added: Vec<Carrier<K>>,
        parents: Vec<CellId>,
    ) -> Result<Self, String> {
        let source_vertex_count = source.positions().len();
        let source_cells = source.complex().cells();
        if complex.vertex_count() != source_vertex_count + added.len() || complex.cell_count() != parents.len() {
            return Err("each added vertex needs a carrier and each cell a parent".to_owned());
        }
        for (row, carrier) in added.iter().enumerate() {
            let weights_fit = carrier.weights.iter().all(|w| (0..=LARGEST_WEIGHT).contains(w)) && carrier.total() > 0;
            if !weights_fit || carrier.vertices.iter().any(|v| v.index() >= source_vertex_count) {
                return Err(format!("carrier {row} is no point of the source mesh"));
            }
        }
        let mut positions = source.positions().to_vec();
        positions.extend(added.iter().map(|carrier| carrier.position(source.positions())));
        let mesh = Self { complex, positions, source_vertex_count, added, parents };
        let ascending = mesh.parents.windows(2).all(|w| w[0] <= w[1] && w[1].index() <= w[0].index() + 1);
        let ends = (mesh.parents.first().map(|p| p.index()), mesh.parents.last().map(|p| p.index() + 1));
        if !ascending || ends != (Some(0), Some(source_cells.len())) {
            return Err(
                "the children of each source cell must follow one another, in the order of the source".to_owned()
            );
        }
        for (cell, corners) in mesh.complex.cells().iter().enumerate() {
            let parent = source_cells[mesh.parents[cell].index()];
            let inside = |v: &VertexId| mesh.carrier(*v).terms().all(|(vertex, _)| parent.contains(&vertex));
            if !corners.iter().all(inside) {
                return Err(format!("cell {cell} does not lie in its parent"));
            }
            if *corners != parent && mesh.is_flat(corners, parent) {
                return Err(format!("cell {cell} is flat"));
            }
        }
        Ok(mesh)
    }

    /// The same subdivision of a source that differs in the order of cells and vertices alone: `vertices` and
    /// `cells` give the numbers in `source` of those of the present one. Also returns the present numbers of all
    /// cells in their new order.
    pub(crate) fn renumbered(
        &self,
        source: &SourceMesh<K>,
        vertices: &[VertexId],
        cells: &[CellId],
    ) -> (Self, Vec<CellId>) {
        let vertex = |v: VertexId| vertices.get(v.index()).copied().unwrap_or(v);
        let mut order: Vec<CellId> = self.complex.cell_ids().collect();
        // Children of one cell follow one another already, and stay in their order.
        order.sort_by_key(|cell| cells[self.parents[cell.index()].index()]);
        let corners = order.iter().map(|&cell| self.complex.cell(cell).map(vertex)).collect();
        let mut positions = source.positions().to_vec();
        positions.extend_from_slice(&self.positions[self.source_vertex_count..]);
        let carried =
            |carrier: &Carrier<K>| Carrier { vertices: carrier.vertices.map(vertex), weights: carrier.weights };
        let mesh = Self {
            complex: SimplicialComplex::new(positions.len(), corners).expect("as many vertices as before"),
            positions,
            source_vertex_count: self.source_vertex_count,
            added: self.added.iter().map(carried).collect(),
            parents: order.iter().map(|cell| cells[self.parents[cell.index()].index()]).collect(),
        };
        (mesh, order)
    }

    /// The cells.
    pub fn complex(&self) -> &SimplicialComplex<K> {
        &self.complex
    }

    /// Coordinates, `#V by 3`: exact for source vertices, rounded for added ones.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The added vertices; the first of them has number [`source_vertex_count`](Self::source_vertex_count).
    pub fn added(&self) -> &[Carrier<K>] {
        &self.added
    }

    /// How many vertices the source has.
    pub fn source_vertex_count(&self) -> usize {
        self.source_vertex_count
    }

    /// The source cell that each cell lies in.
    pub fn parents(&self) -> &[CellId] {
        &self.parents
    }

    /// Whether nothing was refined.
    pub fn is_unrefined(&self) -> bool {
        self.added.is_empty()
    }

    /// Where `vertex` lies in the source.
    pub fn carrier(&self, vertex: VertexId) -> Carrier<K> {
        match vertex.index().checked_sub(self.source_vertex_count) {
            None => Carrier::vertex(vertex),
            Some(added) => self.added[added],
        }
    }

    /// Whether a child of `parent` has no volume.
    fn is_flat(&self, corners: &[VertexId; K], parent: [VertexId; K]) -> bool {
        let weight = |carrier: &Carrier<K>, vertex: VertexId| {
            carrier.terms().find(|&(v, _)| v == vertex).map_or(0, |(_, weight)| i128::from(weight))
        };
        let rows = corners.map(|v| {
            let carrier = self.carrier(v);
            parent.map(|corner| weight(&carrier, corner))
        });
        determinant(&rows, (1 << K) - 1) == 0
    }

    fn add_vertex(&mut self, simplex: &[VertexId], source: &SourceMesh<K>) -> Result<u32, TooDeep> {
        let mut points = [Carrier::vertex(VertexId::new(0)); K];
        for (point, &vertex) in points.iter_mut().zip(simplex) {
            *point = self.carrier(vertex);
        }
        let carrier = Carrier::centroid(&points[..simplex.len()])?;
        self.positions.push(carrier.position(source.positions()));
        self.added.push(carrier);
        Ok((self.positions.len() - 1) as u32)
    }

    /// Stars the given simplices and returns, for each new cell, the cell that it came from.
    ///
    /// Cells keep their order; the children of a cell follow one another. Orientation is kept.
    ///
    /// # Errors
    /// [`TooDeep`]; the mesh is then left as it was.
    pub fn star(
        &mut self,
        source: &SourceMesh<K>,
        adjacency: &Adjacency<K>,
        edges: &EdgeIndex<K>,
        stars: &Stars,
    ) -> Result<Vec<CellId>, TooDeep> {
        let vertices_before = self.positions.len();
        let result = self.mark_and_subdivide(source, adjacency, edges, stars);
        if result.is_err() {
            self.positions.truncate(vertices_before);
            self.added.truncate(vertices_before - self.source_vertex_count);
        }
        result
    }

    fn mark_and_subdivide(
        &mut self,
        source: &SourceMesh<K>,
        adjacency: &Adjacency<K>,
        edges: &EdgeIndex<K>,
        stars: &Stars,
    ) -> Result<Vec<CellId>, TooDeep> {
        let cell_count = self.complex.cell_count();
        let mut edge_vertex = vec![UNMARKED; edges.len()];
        for (edge, ends) in edges.ends().iter().enumerate().filter(|&(edge, _)| stars.edges[edge]) {
            edge_vertex[edge] = self.add_vertex(ends, source)?;
        }
        let mut facet_vertex = vec![[UNMARKED; K]; if K == 4 { cell_count } else { 0 }];
        for cell in (0..facet_vertex.len()).map(CellId::new) {
            for i in (0..K).filter(|&i| stars.facets[cell.index()] >> i & 1 == 1) {
                if facet_vertex[cell.index()][i] == UNMARKED {
                    let facet: Vec<_> = self.complex.facet_vertices(cell, i).collect();
                    let vertex = self.add_vertex(&facet, source)?;
                    facet_vertex[cell.index()][i] = vertex;
                    let far = adjacency.across(cell, i);
                    if far.is_some() {
                        facet_vertex[far.cell().index()][far.opposite()] = vertex;
                    }
                }
            }
        }
        let mut cell_vertex = vec![UNMARKED; cell_count];
        for cell in (0..cell_count).filter(|&cell| stars.cells[cell]) {
            let corners = self.complex.cells()[cell];
            cell_vertex[cell] = self.add_vertex(&corners, source)?;
        }

        let mut cells = Vec::with_capacity(cell_count);
        let mut origins = Vec::with_capacity(cell_count);
        let mut children = Vec::new();
        for cell in (0..cell_count).map(CellId::new) {
            let corners = self.complex.cell(cell);
            children.clear();
            children.push(corners);
            if cell_vertex[cell.index()] != UNMARKED {
                star_in(&mut children, &corners, cell_vertex[cell.index()]);
            }
            for (i, &vertex) in facet_vertex.get(cell.index()).iter().flat_map(|row| row.iter().enumerate()) {
                if vertex != UNMARKED {
                    let facet: Vec<_> = (0..K).filter(|&j| j != i).map(|j| corners[j]).collect();
                    star_in(&mut children, &facet, vertex);
                }
            }
            let mut marked = [(UNMARKED, 0); 6];
            let mut count = 0;
            for (local, edge) in edges.of_cell(cell).iter().enumerate() {
                if edge_vertex[edge.index()] != UNMARKED {
                    marked[count] = (edge.raw(), local);
                    count += 1;
                }
            }
            marked[..count].sort_unstable();
            for &(edge, local) in &marked[..count] {
                let [a, b] = CELL_EDGES[local];
                star_in(&mut children, &[corners[a], corners[b]], edge_vertex[edge as usize]);
            }
            cells.extend_from_slice(&children);
            origins.resize(cells.len(), cell);
        }
        self.parents = origins.iter().map(|origin| self.parents[origin.index()]).collect();
        self.complex = SimplicialComplex::new(self.positions.len(), cells)
            .expect("stars only name vertices that exist (please report this)");
        Ok(origins)
    }
}

/// Determinant of the last rows in the columns that a mask names, by expansion.
fn determinant<const K: usize>(rows: &[[i128; K]; K], columns: u8) -> i128 {
    let row = K - columns.count_ones() as usize;
    if columns == 0 {
        return 1;
    }
    let used = (0..K).filter(|&j| columns >> j & 1 == 1);
    used.enumerate()
        .filter(|&(_, j)| rows[row][j] != 0)
        .map(|(number, j)| {
            let minor = rows[row][j] * determinant(rows, columns & !(1 << j));
            if number % 2 == 0 { minor } else { -minor }
        })
        .sum()
}

/// Replaces each child that contains `simplex` by its star from `vertex`.
fn star_in<const K: usize>(children: &mut Vec<[VertexId; K]>, simplex: &[VertexId], vertex: u32) {
    for index in 0..children.len() {
        let child = children[index];
        if !simplex.iter().all(|v| child.contains(v)) {
            continue;
        }
        for (number, old) in simplex.iter().enumerate() {
            let part = child.map(|v| if v == *old { VertexId::from(vertex) } else { v });
            if number == 0 {
                children[index] = part;
            } else {
                children.push(part);
            }
        }
    }
}

/// Simplices that join boundary to boundary through the interior: interior edges with both ends on
/// the boundary and interior facets with all vertices on it whose edges all are boundary edges.
///
/// Once these are starred, every interior edge has an end in the interior and no cell has more than
/// one boundary facet, unless the mesh is a single cell.
pub fn spanning_simplices<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    edges: &EdgeIndex<K>,
) -> Stars {
    let on_boundary = adjacency.boundary_vertices(complex);
    let mut stars = Stars::none(complex.cell_count(), edges.len());
    for (star, ends) in stars.edges.iter_mut().zip(edges.ends()) {
        *star = ends.iter().all(|v| on_boundary[v.index()]);
    }
    for facet in adjacency.boundary_facets() {
        for local in facet_edges::<K>(facet) {
            stars.edges[edges.of_cell(facet.cell())[local].index()] = false;
        }
    }
    if K == 4 {
        for cell in complex.cell_ids() {
            for i in 0..K {
                let facet = Facet::new(cell, i);
                let spans = adjacency.across(cell, i).is_some()
                    && complex.facet_vertices(cell, i).all(|v| on_boundary[v.index()])
                    && facet_edges::<K>(facet).all(|local| !stars.edges[edges.of_cell(cell)[local].index()]);
                stars.facets[cell.index()] |= u8::from(spans) << i;
            }
        }
    }
    stars
}

/// Local numbers of the edges of a facet of a cell.
pub fn facet_edges<const K: usize>(facet: Facet) -> impl Iterator<Item = usize> {
    (0..EdgeIndex::<K>::PER_CELL).filter(move |&local| !CELL_EDGES[local].contains(&facet.opposite()))
}
