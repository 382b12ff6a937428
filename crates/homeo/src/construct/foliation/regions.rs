//! Where leaves begin and end: source and sink regions on the boundary, or a centre.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use homeo_core::mesh::{Adjacency, CellId, EdgeIndex, Facet, SimplicialComplex, TriangleComplex};

use super::boundary::{BoundarySurface, boundary_loop, edge_end, edge_start, facet_masks};
use super::field::{cotangent_weights, difference, dot, gradients};
use super::front::{Side, Surroundings};
use crate::linear::GraphLaplacian;

/// Regions that the user asks for. All are facets given by their vertices, in the numbering of the
/// source mesh; what is left out is chosen automatically.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RequestedRegions {
    /// Square: the four boundary vertices that become corners, in order round the boundary.
    pub corners: Option<[u32; 4]>,
    /// Cube: boundary triangles of the source region.
    pub source: Option<Vec<[u32; 3]>>,
    /// Cube: boundary triangles of the sink region.
    pub sink: Option<Vec<[u32; 3]>>,
    /// Disk and ball: the cell that holds the centre.
    pub centre: Option<u32>,
}

/// Regions that cannot be used, or found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RegionError {
    /// A requested region does not exist or has the wrong topology.
    #[error("{0}")]
    Requested(String),
    /// No two disjoint regions exist: the boundary has too few facets.
    #[error("the boundary is too coarse for two separate regions")]
    TooCoarse,
}

/// The four sides of a square: source, parallel, sink, parallel, each a run of boundary facets.
pub(super) fn square_sides<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    positions: &[[f64; 3]],
    requested: Option<[u32; 4]>,
) -> Result<Surroundings, RegionError> {
    let facets = boundary_loop(complex, adjacency);
    let n = facets.len();
    if n < 4 {
        return Err(RegionError::TooCoarse);
    }
    let corners = match requested {
        Some(corners) => requested_corners(complex, &facets, corners)?,
        None => equal_arcs(complex, &facets, positions),
    };
    let arc = |side: usize| {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        let length = (to + n - from) % n;
        (0..length).map(move |k| (from + k) % n)
    };
    let count = complex.cell_count();
    Ok(Surroundings {
        source: facet_masks(count, arc(0).map(|k| facets[k])),
        sink: facet_masks(count, arc(2).map(|k| facets[k])),
        centre: None,
    })
}

fn requested_corners<const K: usize>(
    complex: &SimplicialComplex<K>,
    facets: &[Facet],
    corners: [u32; 4],
) -> Result<[usize; 4], RegionError> {
    let mut indices = [0; 4];
    for (index, corner) in indices.iter_mut().zip(corners) {
        *index = facets
            .iter()
            .position(|&f| edge_start(complex, f).raw() == corner)
            .ok_or_else(|| RegionError::Requested(format!("corner {corner} is no boundary vertex of the mesh")))?;
    }
    let turns = (0..4).filter(|&i| indices[(i + 1) % 4] <= indices[i]).count();
    if turns != 1 {
        return Err(RegionError::Requested(format!(
            "corners {corners:?} must be four different vertices in the order in which the boundary runs (mesh on the left)"
        )));
    }
    Ok(indices)
}

/// Four starting facets that cut the loop into arcs of nearly equal length, each with an edge.
pub(super) fn equal_arcs<const K: usize>(
    complex: &SimplicialComplex<K>,
    facets: &[Facet],
    positions: &[[f64; 3]],
) -> [usize; 4] {
    let n = facets.len();
    let mut reached = Vec::with_capacity(n + 1);
    reached.push(0.0);
    for &facet in facets {
        let [a, b] = [edge_start(complex, facet), edge_end(complex, facet)].map(|v| positions[v.index()]);
        let edge = difference(b, a);
        reached.push(reached[reached.len() - 1] + dot(edge, edge).sqrt());
    }
    let mut corners = [0; 4];
    for side in 1..4 {
        let aim = reached[n] * side as f64 / 4.0;
        let nearest = reached[..n].partition_point(|&r| r < aim);
        let nearest =
            if nearest > 0 && aim - reached[nearest - 1] < reached[nearest] - aim { nearest - 1 } else { nearest };
        corners[side] = nearest.clamp(corners[side - 1] + 1, n - (4 - side));
    }
    corners
}

/// Source and sink disks on the boundary of a volume, around the ends of its Fiedler vector.
pub(super) fn cube_caps<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    positions: &[[f64; 3]],
    requested: &RequestedRegions,
    share: f64,
) -> Result<Surroundings, RegionError> {
    let surface = BoundarySurface::new(complex, adjacency.boundary_facets().collect());
    let asked = |triangles: &Option<Vec<[u32; 3]>>| {
        triangles.as_ref().map(|triangles| requested_triangles(&surface, triangles)).transpose()
    };
    let (source, sink) = (asked(&requested.source)?, asked(&requested.sink)?);
    let field = fiedler_of_triangles(&surface, positions);
    let caps = match (source, sink) {
        (Some(source), Some(sink)) => [source, sink],
        (source, sink) => automatic_caps(&surface.triangles, &field, share, source, sink)?,
    };
    // The source's boundary runs round a square, with a vertex at each corner.
    if rim_length(&surface.triangles, &caps[0]) < 4 {
        return Err(match requested.source {
            None => RegionError::TooCoarse,
            Some(_) => RegionError::Requested("the source region needs at least four edges on its boundary".to_owned()),
        });
    }
    let count = complex.cell_count();
    let masks = caps.map(|cap| facet_masks(count, cap.iter().map(|&t| surface.facets[t])));
    let [source, sink] = masks;
    Ok(Surroundings { source, sink, centre: None })
}

/// How many edges a set of triangles has on its boundary.
fn rim_length(triangles: &TriangleComplex, chosen: &[usize]) -> usize {
    let Ok(adjacency) = triangles.adjacency() else { return 0 };
    let mut inside = vec![false; triangles.cell_count()];
    chosen.iter().for_each(|&t| inside[t] = true);
    let is_rim = |t: usize, i: usize| {
        let far = adjacency.across(CellId::new(t), i);
        far.is_none() || !inside[far.cell().index()]
    };
    chosen.iter().map(|&t| (0..3).filter(|&i| is_rim(t, i)).count()).sum()
}

fn requested_triangles(surface: &BoundarySurface, triangles: &[[u32; 3]]) -> Result<Vec<usize>, RegionError> {
    let sorted = |mut t: [u32; 3]| {
        t.sort_unstable();
        t
    };
    let mut known: Vec<([u32; 3], usize)> = (0..surface.facets.len())
        .map(|t| (sorted(surface.triangles.cells()[t].map(|v| surface.vertices[v.index()].raw())), t))
        .collect();
    known.sort_unstable();
    let found: Result<Vec<usize>, RegionError> = triangles
        .iter()
        .map(|&t| match known.binary_search_by_key(&sorted(t), |&(key, _)| key) {
            Ok(at) => Ok(known[at].1),
            Err(_) => Err(RegionError::Requested(format!("{t:?} is no boundary triangle of the mesh"))),
        })
        .collect();
    let found = found?;
    if found.is_empty() {
        return Err(RegionError::Requested("a region needs at least one triangle".to_owned()));
    }
    Ok(found)
}

/// Mean of the Fiedler vector over each triangle, in `[0, 1]`.
fn fiedler_of_triangles(surface: &BoundarySurface, positions: &[[f64; 3]]) -> Vec<f64> {
    let positions = surface.positions(positions);
    let triangles = &surface.triangles;
    let edges = triangles.edges();
    let weights = cotangent_weights(triangles, &positions, &edges);
    let laplacian = GraphLaplacian::new(triangles.vertex_count(), edges.ends(), &weights);
    let mut masses = vec![0.0; triangles.vertex_count()];
    for cell in triangles.cells() {
        let (_, area) = gradients(cell.map(|v| positions[v.index()]));
        cell.iter().for_each(|v| masses[v.index()] += if area > 0.0 { area } else { f64::MIN_POSITIVE });
    }
    let longest = longest_axis(&positions);
    let start: Vec<f64> = positions.iter().map(|p| p[longest]).collect();
    // The field only guides: when the solver fails, the coordinate along the longest axis will do.
    let field = laplacian.fiedler(&masses, &start).unwrap_or(start);
    triangles.cells().iter().map(|cell| cell.iter().map(|v| field[v.index()]).sum::<f64>() / 3.0).collect()
}

fn longest_axis(positions: &[[f64; 3]]) -> usize {
    let extent = |axis: usize| {
        let values = positions.iter().map(|p| p[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0)
}

/// Disks around the lowest and the highest triangle, up to the contours at `share` from either end.
///
/// Each cap grows triangle by triangle and stays a disk; the complement of a disk in a sphere is a
/// disk, and two disks without a common vertex leave an annulus. So no repair is needed.
fn automatic_caps(
    triangles: &TriangleComplex,
    field: &[f64],
    share: f64,
    source: Option<Vec<usize>>,
    sink: Option<Vec<usize>>,
) -> Result<[Vec<usize>; 2], RegionError> {
    let adjacency = triangles.adjacency().map_err(|_| RegionError::TooCoarse)?;
    let mut taken = vec![false; triangles.vertex_count()];
    let occupy = |taken: &mut Vec<bool>, cap: &[usize]| {
        cap.iter().flat_map(|&t| triangles.cells()[t]).for_each(|v| taken[v.index()] = true);
    };
    let seed = |values: &[f64], taken: &[bool]| {
        (0..values.len())
            .filter(|&t| triangles.cells()[t].iter().all(|v| !taken[v.index()]))
            .min_by(|&a, &b| values[a].total_cmp(&values[b]))
            .ok_or(RegionError::TooCoarse)
    };
    let falling: Vec<f64> = field.iter().map(|f| 1.0 - f).collect();
    if let Some(cap) = source.as_ref().or(sink.as_ref()) {
        occupy(&mut taken, cap);
    }
    // The other seed is reserved before the first cap grows.
    let (first_seed, second_seed) = match (&source, &sink) {
        (None, None) => {
            let first = seed(field, &taken)?;
            occupy(&mut taken, &[first]);
            let second = seed(&falling, &taken)?;
            taken.fill(false);
            occupy(&mut taken, &[second]);
            (first, second)
        }
        (Some(_), _) => (0, seed(&falling, &taken)?),
        (_, Some(_)) => (seed(field, &taken)?, 0),
    };
    let source = source.unwrap_or_else(|| grow_disk(triangles, &adjacency, field, share, first_seed, &taken));
    taken.fill(false);
    occupy(&mut taken, &source);
    let sink = sink.unwrap_or_else(|| grow_disk(triangles, &adjacency, &falling, share, second_seed, &taken));
    Ok([source, sink])
}

/// A disk of triangles that grows from `seed` by ascending value up to `share` and avoids taken vertices.
fn grow_disk(
    triangles: &TriangleComplex,
    adjacency: &Adjacency<3>,
    value: &[f64],
    share: f64,
    seed: usize,
    taken: &[bool],
) -> Vec<usize> {
    let key = |t: usize| Reverse((ordered(value[t]), t));
    let mut inside = vec![false; triangles.cell_count()];
    let mut touched = vec![false; triangles.vertex_count()];
    let mut disk = Vec::new();
    let mut queue = BinaryHeap::from([key(seed)]);
    while let Some(Reverse((_, t))) = queue.pop() {
        let cell = CellId::new(t);
        let corners = triangles.cell(cell);
        let shared: Vec<usize> = (0..3)
            .filter(|&i| {
                let far = adjacency.across(cell, i);
                far.is_some() && inside[far.cell().index()]
            })
            .collect();
        // One shared edge: the vertex opposite must be new. Two: the disk closes round a vertex.
        let stays_disk = match shared[..] {
            [] => disk.is_empty(),
            [edge] => !touched[corners[edge].index()],
            [_, _] => true,
            _ => false,
        };
        // At least two triangles, so that a boundary of four corners can be made.
        let notch = shared.len() == 2 && value[t] <= 1.2 * share;
        let wanted = value[t] <= share || notch || disk.len() < 2;
        if inside[t] || !stays_disk || !wanted || corners.iter().any(|v| taken[v.index()]) {
            continue;
        }
        inside[t] = true;
        disk.push(t);
        corners.iter().for_each(|v| touched[v.index()] = true);
        for i in 0..3 {
            let far = adjacency.across(cell, i);
            if far.is_some() && !inside[far.cell().index()] {
                queue.push(key(far.cell().index()));
            }
        }
    }
    disk
}

/// A total order of finite values that are not negative, as an integer.
fn ordered(value: f64) -> u64 {
    value.max(0.0).to_bits()
}

/// The whole boundary on one side and the cell farthest from it, or the requested one, on the other.
pub(super) fn centre<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    edges: &EdgeIndex<K>,
    positions: &[[f64; 3]],
    allowed: &dyn Fn(CellId) -> bool,
) -> (CellId, f64) {
    let distance = distance_from_boundary(complex, adjacency, edges, positions);
    complex
        .cell_ids()
        .filter(|&cell| allowed(cell))
        .map(|cell| (cell, complex.cell(cell).iter().map(|v| distance[v.index()]).fold(f64::MAX, f64::min)))
        .fold((CellId::new(0), -1.0), |best, next| if next.1 > best.1 { next } else { best })
}

/// Surroundings of a radial foliation.
pub(super) fn radial<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    centre: CellId,
    centre_side: Side,
) -> Surroundings {
    let count = complex.cell_count();
    let boundary = facet_masks(count, adjacency.boundary_facets());
    let none = vec![0; count];
    let (source, sink) = if centre_side == Side::Source { (none, boundary) } else { (boundary, none) };
    Surroundings { source, sink, centre: Some((centre, centre_side)) }
}

/// Length of the shortest edge path from each vertex to the boundary.
fn distance_from_boundary<const K: usize>(
    complex: &SimplicialComplex<K>,
    adjacency: &Adjacency<K>,
    edges: &EdgeIndex<K>,
    positions: &[[f64; 3]],
) -> Vec<f64> {
    let mut starts = vec![0u32; complex.vertex_count() + 1];
    edges.ends().iter().flatten().for_each(|v| starts[v.index() + 1] += 1);
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut fill = starts.clone();
    let mut neighbours = vec![(0u32, 0.0f64); 2 * edges.len()];
    for [a, b] in edges.ends() {
        let edge = difference(positions[a.index()], positions[b.index()]);
        let length = dot(edge, edge).sqrt();
        for (from, to) in [(a, b), (b, a)] {
            neighbours[fill[from.index()] as usize] = (to.raw(), length);
            fill[from.index()] += 1;
        }
    }
    let mut distance = vec![f64::INFINITY; complex.vertex_count()];
    let mut queue = BinaryHeap::new();
    for (vertex, _) in adjacency.boundary_vertices(complex).iter().enumerate().filter(|&(_, &on)| on) {
        distance[vertex] = 0.0;
        queue.push(Reverse((0, vertex)));
    }
    while let Some(Reverse((key, vertex))) = queue.pop() {
        if ordered(distance[vertex]) < key {
            continue;
        }
        for &(to, length) in &neighbours[starts[vertex] as usize..starts[vertex + 1] as usize] {
            let next = distance[vertex] + length;
            if next < distance[to as usize] {
                distance[to as usize] = next;
                queue.push(Reverse((ordered(next), to as usize)));
            }
        }
    }
    distance
}
