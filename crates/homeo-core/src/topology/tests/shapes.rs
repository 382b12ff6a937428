//! Meshes built in code, one for each class.

use crate::mesh::{TetrahedronComplex, TriangleComplex};

pub type Point = [f64; 3];

/// A surface with coordinates.
#[derive(Clone)]
pub struct Surface {
    pub positions: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub fn complex(&self) -> TriangleComplex {
        TriangleComplex::from_indices(self.positions.len(), &self.triangles).unwrap()
    }

    /// Both surfaces, the second one moved.
    pub fn with(mut self, other: &Self, by: Point) -> Self {
        let shift = self.positions.len() as u32;
        self.positions.extend(other.positions.iter().map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]));
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + shift)));
        self
    }

    /// The same triangles the other way round.
    pub fn reversed(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    pub fn scaled(mut self, by: f64) -> Self {
        self.positions.iter_mut().flatten().for_each(|x| *x *= by);
        self
    }
}

pub fn tetrahedron() -> Surface {
    Surface {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    }
}

pub fn octahedron() -> Surface {
    let mut positions = Vec::new();
    for axis in 0..3 {
        for side in [1.0, -1.0] {
            let mut point = [0.0; 3];
            point[axis] = side;
            positions.push(point);
        }
    }
    let mut triangles = Vec::new();
    for (x, y, z) in (0..8).map(|i| (i & 1, i >> 1 & 1, i >> 2)) {
        let [a, b, c] = [x, 2 + y, 4 + z];
        triangles.push(if (x + y + z) % 2 == 0 { [a, b, c] } else { [a, c, b] });
    }
    Surface { positions, triangles }
}

/// What becomes of a strip of squares when its sides are glued.
#[derive(Clone, Copy, PartialEq)]
pub enum Glue {
    Open,
    Straight,
    Reversed,
}

/// A grid of `columns` by `rows` squares; the left and right sides glued as `across` says, bottom and
/// top as `along` says (straight or not at all). Coordinates are of no meaning.
pub fn grid(columns: u32, rows: u32, across: Glue, along: Glue) -> Surface {
    let (wide, high) = (columns + 1, rows + 1);
    let number = |mut i: u32, mut j: u32| {
        if across != Glue::Open && i == columns {
            i = 0;
            if across == Glue::Reversed {
                j = rows - j;
            }
        }
        if along == Glue::Straight && j == rows {
            j = 0;
        }
        j * wide + i
    };
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i, j + 1), number(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let renumber = |v: u32| used.binary_search(&v).unwrap() as u32;
    let triangles = triangles.into_iter().map(|t| t.map(renumber)).collect();
    let positions = used.iter().map(|&v| [f64::from(v % wide), f64::from(v / wide), 0.0]).collect();
    assert!(used.len() <= (wide * high) as usize);
    Surface { positions, triangles }
}

/// A torus of revolution, embedded, normals outwards.
pub fn torus(columns: u32, rows: u32) -> Surface {
    let mut surface = grid(columns, rows, Glue::Straight, Glue::Straight);
    for point in &mut surface.positions {
        let u = std::f64::consts::TAU * point[0] / f64::from(columns);
        let v = std::f64::consts::TAU * point[1] / f64::from(rows);
        *point = [(2.0 + v.cos()) * u.cos(), (2.0 + v.cos()) * u.sin(), v.sin()];
    }
    surface
}

/// A volume with coordinates.
#[derive(Clone)]
pub struct Volume {
    pub positions: Vec<Point>,
    pub tetrahedra: Vec<[u32; 4]>,
}

impl Volume {
    pub fn complex(&self) -> TetrahedronComplex {
        TetrahedronComplex::from_indices(self.positions.len(), &self.tetrahedra).unwrap()
    }
}

/// Unit cubes at whole coordinates, six positive tetrahedra each, that fit together.
pub fn cubes(corners: &[[i32; 3]]) -> Volume {
    const ORDERS: [([usize; 3], bool); 6] = [
        ([0, 1, 2], false),
        ([1, 2, 0], false),
        ([2, 0, 1], false),
        ([0, 2, 1], true),
        ([2, 1, 0], true),
        ([1, 0, 2], true),
    ];
    let mut points: Vec<[i32; 3]> = Vec::new();
    let mut paths = Vec::new();
    for &corner in corners {
        for (axes, is_odd) in ORDERS {
            let mut path = [corner; 4];
            for step in 0..3 {
                path[step + 1] = path[step];
                path[step + 1][axes[step]] += 1;
            }
            if is_odd {
                path.swap(2, 3);
            }
            points.extend(path);
            paths.push(path);
        }
    }
    points.sort_unstable();
    points.dedup();
    let number = |p: [i32; 3]| points.binary_search(&p).unwrap() as u32;
    Volume {
        positions: points.iter().map(|p| p.map(f64::from)).collect(),
        tetrahedra: paths.into_iter().map(|path| path.map(number)).collect(),
    }
}

/// All cubes of a box but some.
pub fn cubes_without(size: [i32; 3], holes: &[[i32; 3]]) -> Volume {
    let all = (0..size[0]).flat_map(|x| (0..size[1]).flat_map(move |y| (0..size[2]).map(move |z| [x, y, z])));
    cubes(&all.filter(|cube| !holes.contains(cube)).collect::<Vec<_>>())
}

/// The product of a triangle complex with a path of `layers` edges, or with a cycle of them.
pub fn product(surface: &Surface, layers: u32, is_cycle: bool) -> TetrahedronComplex {
    let base = surface.positions.len() as u32;
    let levels = if is_cycle { layers } else { layers + 1 };
    let at = |vertex: u32, level: u32| (level % levels) * base + vertex;
    let mut tetrahedra = Vec::new();
    for level in 0..layers {
        for triangle in &surface.triangles {
            let mut sorted = *triangle;
            sorted.sort_unstable();
            let [a, b, c] = sorted;
            let (low, high) = (level, level + 1);
            tetrahedra.push([at(a, low), at(b, low), at(c, low), at(c, high)]);
            tetrahedra.push([at(a, low), at(b, low), at(b, high), at(c, high)]);
            tetrahedra.push([at(a, low), at(a, high), at(b, high), at(c, high)]);
        }
    }
    TetrahedronComplex::from_indices((levels * base) as usize, &tetrahedra).unwrap()
}
