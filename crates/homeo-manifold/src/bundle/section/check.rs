//! Whether paths are those of a section, and its indices: from lists of tetrahedra and paths, with nothing else.

use std::collections::HashMap;
use thiserror::Error;

/// What the paths of a section wind round the fibres: its indices once more, by another way than [`super::Section::index`].
///
/// The tetrahedra over a triangle are passed one after the other across the faces that they share. A vertex that comes again
/// is another copy: so edges get numbers of copies that they go on by, which add up to 0 round each triangle, and closed
/// paths theirs; round a fibre it is 1 or -1. Slopes, connections and levels play no role.
///
/// # Example
/// ```
/// use homeo_manifold::bundle::{Section, TangentBundle, WoundPaths};
/// let sphere = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let bundle = TangentBundle::new(&sphere, 4, 8)?.bundle;
/// let section = Section::new(&bundle, vec![0; bundle.vertex_count()])?;
/// let wound = WoundPaths::new(bundle.triangles(), 8, &bundle.tetrahedra(), &section.paths())?;
/// let indices: Vec<i64> = (0..bundle.triangles().len() as u32).map(|triangle| section.index(triangle)).collect();
/// assert_eq!(wound.triangles, indices);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WoundPaths {
    /// The indices of the triangles below; 0 at vertices without a section.
    pub triangles: Vec<i64>,
    /// The vertices without a section, in order, and their indices.
    pub vertices: Vec<(u32, i64)>,
}

/// Why paths are not those of a section.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum PathFault {
    #[error("there are {given} tetrahedra, not {wanted}")]
    Count { given: usize, wanted: usize },
    #[error(
        "vertex {vertex} of triangle {triangle} is too large: with {layers} layers vertices of tetrahedra go beyond 2^32"
    )]
    TooLarge { triangle: u32, vertex: u32, layers: u32 },
    #[error("the tetrahedra over triangle {triangle} do not follow one another round a solid torus")]
    NoTorus { triangle: u32 },
    #[error("the paths meet the fibre over vertex {vertex} at {first} and at {second}: a section meets it once")]
    Twice { vertex: u32, first: u32, second: u32 },
    #[error("a path has fewer than two vertices")]
    Short,
    #[error(
        "vertices {first} and {second} follow each other on a path, but no tetrahedron over triangle {triangle} has both"
    )]
    NoEdge { triangle: u32, first: u32, second: u32 },
    #[error("there is no path over the edge from vertex {first} to vertex {second}, which have a section")]
    NoPath { first: u32, second: u32 },
    #[error("vertices {first} and {second} are neighbours, and both have no section")]
    Gap { first: u32, second: u32 },
}

impl WoundPaths {
    /// For the triangles of a base, tetrahedra (`3 N #F by 4`, those over triangle `t` from row `3 N t` on) whose vertex
    /// `v N + level` is over vertex `v`, and one path of vertices for each edge of which both ends have a section.
    ///
    /// Cost: linear.
    ///
    /// # Errors
    /// What is no path of edges over its own edge, what meets a fibre twice, tetrahedra that are no solid tori.
    pub fn new(base: &[[u32; 3]], layers: u32, tetrahedra: &[[u32; 4]], paths: &[Vec<u32>]) -> Result<Self, PathFault> {
        let wanted = 3 * layers as usize * base.len();
        if layers == 0 || tetrahedra.len() != wanted {
            return Err(PathFault::Count { given: tetrahedra.len(), wanted });
        }
        let section = Marked::new(layers, paths)?;
        let mut wound = Self { triangles: vec![0; base.len()], vertices: Vec::new() };
        let mut sums = std::collections::BTreeMap::new();
        let pieces = tetrahedra.chunks(3 * layers as usize);
        for ((triangle, corners), piece) in (0..).zip(base).zip(pieces) {
            let has_vertices = |vertex: &&u32| (u64::from(**vertex) + 1) * u64::from(layers) <= 1 << 32;
            if let Some(&vertex) = corners.iter().find(|vertex| !has_vertices(vertex)) {
                return Err(PathFault::TooLarge { triangle, vertex, layers });
            }
            let steps = steps(piece).ok_or(PathFault::NoTorus { triangle })?;
            let index = section.winding(triangle, *corners, &steps)?;
            match corners.iter().find(|vertex| !section.at.contains_key(vertex)) {
                Some(&vertex) => *sums.entry(vertex).or_insert(0) += index,
                None => wound.triangles[triangle as usize] = index,
            }
        }
        wound.vertices = sums.into_iter().collect();
        Ok(wound)
    }
}

/// Where paths meet fibres, and the paths by the ends of their edges.
struct Marked<'p> {
    layers: u32,
    at: HashMap<u32, u32>,
    over: HashMap<[u32; 2], &'p [u32]>,
}

impl<'p> Marked<'p> {
    fn new(layers: u32, paths: &'p [Vec<u32>]) -> Result<Self, PathFault> {
        let mut marked = Self { layers, at: HashMap::new(), over: HashMap::new() };
        for path in paths {
            let [first, .., last] = path[..] else { return Err(PathFault::Short) };
            for end in [first, last] {
                let vertex = end / layers;
                let known = *marked.at.entry(vertex).or_insert(end);
                if known != end {
                    return Err(PathFault::Twice { vertex, first: known, second: end });
                }
            }
            marked.over.insert([first / layers, last / layers], path);
        }
        Ok(marked)
    }

    /// The index of a triangle, by the numbers of copies that its edges go on by.
    fn winding(&self, triangle: u32, corners: [u32; 3], steps: &HashMap<[u32; 2], i64>) -> Result<i64, PathFault> {
        let mut sum = 0;
        for k in 0..3 {
            let ends @ [from, to] = [corners[k], corners[(k + 1) % 3]];
            let (path, is_backwards) = match (self.over.get(&ends), self.over.get(&[to, from])) {
                (Some(path), _) => (path.to_vec(), false),
                (None, Some(path)) => (path.to_vec(), true),
                (None, None) if !self.at.contains_key(&to) => (self.spoke(from, to, steps)?, false),
                (None, None) if !self.at.contains_key(&from) => (self.spoke(to, from, steps)?, true),
                (None, None) => return Err(PathFault::NoPath { first: from, second: to }),
            };
            let length = length(triangle, &path, steps)?;
            sum += if is_backwards { -length } else { length };
        }
        let fibre: Vec<u32> = (0..=self.layers).map(|level| corners[0] * self.layers + level % self.layers).collect();
        match length(triangle, &fibre, steps)? {
            unit @ (1 | -1) => Ok(sum * unit),
            _ => Err(PathFault::NoTorus { triangle }),
        }
    }

    /// Any path to level 0 over a vertex without a section: the same from both sides, so that it counts for nothing.
    fn spoke(&self, from: u32, to: u32, steps: &HashMap<[u32; 2], i64>) -> Result<Vec<u32>, PathFault> {
        let gap = PathFault::Gap { first: from, second: to };
        let Some(start) = self.at.get(&from).map(|vertex| vertex % self.layers) else { return Err(gap) };
        let end = to * self.layers;
        let mut path = Vec::new();
        for level in start..start + self.layers {
            let vertex = from * self.layers + level % self.layers;
            path.push(vertex);
            if steps.contains_key(&[vertex, end]) {
                path.push(end);
                return Ok(path);
            }
        }
        Err(gap)
    }
}

fn length(triangle: u32, path: &[u32], steps: &HashMap<[u32; 2], i64>) -> Result<i64, PathFault> {
    let step = |pair: &[u32]| {
        let fault = PathFault::NoEdge { triangle, first: pair[0], second: pair[1] };
        steps.get(&[pair[0], pair[1]]).copied().ok_or(fault)
    };
    path.windows(2).map(step).sum()
}

/// The number of copies that each directed edge goes on by; nothing where tetrahedra do not follow one another in a ring, or
/// an edge has two numbers.
fn steps(tetrahedra: &[[u32; 4]]) -> Option<HashMap<[u32; 2], i64>> {
    let ring = ring(tetrahedra)?;
    let mut copies: HashMap<u32, i64> = tetrahedra[ring[0]].iter().map(|&vertex| (vertex, 0)).collect();
    let mut steps = HashMap::new();
    // Once round with new copies of what has come before, and once more to compare.
    for pair in ring.iter().cycle().take(2 * ring.len() + 1).collect::<Vec<_>>().windows(2) {
        let [before, here] = [tetrahedra[*pair[0]], tetrahedra[*pair[1]]];
        for vertex in here.into_iter().filter(|vertex| !before.contains(vertex)) {
            copies.entry(vertex).and_modify(|copy| *copy += 1).or_insert(0);
        }
        for (a, b) in here.into_iter().flat_map(|a| here.into_iter().map(move |b| (a, b))).filter(|(a, b)| a != b) {
            let step = copies[&b] - copies[&a];
            if *steps.entry([a, b]).or_insert(step) != step {
                return None;
            }
        }
    }
    Some(steps)
}

/// Tetrahedra in the order in which they share faces, each with two others.
fn ring(tetrahedra: &[[u32; 4]]) -> Option<Vec<usize>> {
    let mut owners: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    for (number, corners) in tetrahedra.iter().enumerate() {
        for omitted in 0..4 {
            let mut face = [1, 2, 3].map(|k| corners[(omitted + k) % 4]);
            face.sort_unstable();
            owners.entry(face).or_default().push(number);
        }
    }
    let mut neighbours = vec![Vec::new(); tetrahedra.len()];
    for pair in owners.values().filter(|owners| owners.len() > 1) {
        let [a, b] = pair[..] else { return None };
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    let mut ring = vec![0];
    let mut before = usize::MAX;
    while ring.len() <= tetrahedra.len() {
        let here = ring[ring.len() - 1];
        let [a, b] = neighbours[here][..] else { return None };
        // Start along the lesser, so that the order does not depend on that of the table.
        let next = if before == usize::MAX {
            a.min(b)
        } else if a == before {
            b
        } else {
            a
        };
        if next == 0 {
            break;
        }
        before = here;
        ring.push(next);
    }
    (ring.len() == tetrahedra.len()).then_some(ring)
}
