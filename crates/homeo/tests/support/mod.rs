//! Surfaces that the tests generate.
#![allow(dead_code, reason = "every test uses some of them")]

use homeo::input::SourceMesh;
use homeo_core::mesh::SimplicialComplex;

pub type Point = [f64; 3];

pub fn surface(positions: Vec<Point>, triangles: &[[u32; 3]]) -> SourceMesh<3> {
    let complex = SimplicialComplex::from_indices(positions.len(), triangles).expect("indices");
    SourceMesh::new(positions, complex)
}

/// A strip rolled up in more than two turns: its sheets lie close over one another, with one orientation.
pub fn roll(turns: f64, n: u32) -> SourceMesh<3> {
    let point = |i: u32| {
        let angle = f64::from(i / 3) / f64::from(n) * turns * std::f64::consts::TAU;
        let radius = 1.0 + 0.05 * angle / std::f64::consts::TAU;
        [radius * angle.cos(), radius * angle.sin(), 0.4 * f64::from(i % 3)]
    };
    let squares = (0..n).flat_map(|i| (0..2).map(move |j| 3 * i + j));
    let triangles: Vec<[u32; 3]> = squares.flat_map(|v| [[v, v + 3, v + 4], [v, v + 4, v + 1]]).collect();
    surface((0..3 * (n + 1)).map(point).collect(), &triangles)
}

/// A sphere of `n` by `m` quadrilaterals round an axis.
pub fn sphere(n: u32, m: u32, radius: f64) -> SourceMesh<3> {
    let point = |i: u32, j: u32| {
        let [s, t] = [[i, n], [2 * j, m]].map(|[k, of]| std::f64::consts::PI * f64::from(k) / f64::from(of));
        [s.sin() * t.cos(), s.sin() * t.sin(), s.cos()].map(|x| radius * x)
    };
    let mut points: Vec<Point> = (1..n).flat_map(|i| (0..m).map(move |j| point(i, j))).collect();
    points.extend([[0.0, 0.0, radius], [0.0, 0.0, -radius]]);
    let at = |i: u32, j: u32| (i - 1) * m + j % m;
    let poles = (n - 1) * m;
    let caps = (0..m).flat_map(|j| [[poles, at(1, j), at(1, j + 1)], [poles + 1, at(n - 1, j + 1), at(n - 1, j)]]);
    let squares = (1..n - 1).flat_map(|i| (0..m).map(move |j| (i, j)));
    let sides = squares
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    surface(points, &caps.chain(sides).collect::<Vec<_>>())
}

/// Several surfaces as one.
pub fn together(parts: &[SourceMesh<3>]) -> SourceMesh<3> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for part in parts {
        let shift = points.len() as u32;
        triangles.extend(part.complex().cells().iter().map(|cell| cell.map(|v| v.raw() + shift)));
        points.extend_from_slice(part.positions());
    }
    surface(points, &triangles)
}

/// A torus of `n` by `m` quadrilaterals, its tube modulated `bumps` times.
pub fn torus(n: u32, m: u32, bumps: f64) -> SourceMesh<3> {
    let point = |k: u32| {
        let turn = std::f64::consts::TAU;
        let (s, t) = (turn * f64::from(k / m) / f64::from(n), turn * f64::from(k % m) / f64::from(m));
        let r = 0.3 + 0.05 * (bumps * s).sin();
        [(1.0 + r * t.cos()) * s.cos(), (1.0 + r * t.cos()) * s.sin(), r * t.sin()]
    };
    let triangles: Vec<[u32; 3]> = (0..n * m)
        .flat_map(|k| {
            let (i, j) = (k / m, k % m);
            let at = |i: u32, j: u32| i % n * m + j % m;
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    surface((0..n * m).map(point).collect(), &triangles)
}

/// A box cut into `n^2` squares per side and turned, so that no two normals of its sides are exactly perpendicular.
pub fn turned_box(n: i32) -> SourceMesh<3> {
    let mut numbers = std::collections::BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
        let mut number = |u: i32, v: i32| {
            let mut grid = [0; 3];
            grid[axis] = side * n;
            grid[(axis + 1) % 3] = u;
            grid[(axis + 2) % 3] = v;
            *numbers.entry(grid).or_insert_with(|| {
                let [x, y, z] = grid.map(|g| f64::from(g) / f64::from(n));
                let (x, y) = (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
                positions.push([x, 0.36 * z + 0.48 * y, 1.7 * z - 0.2 * y]);
                positions.len() as u32 - 1
            })
        };
        for (u, v) in (0..n).flat_map(|u| (0..n).map(move |v| (u, v))) {
            let [a, b, c, d] = [number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)];
            triangles.extend(if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    // The linear map turns the box over or not; the outside is where the normals have to point.
    let mesh = surface(positions, &triangles);
    if signed_volume(&mesh) > 0.0 { mesh } else { reversed(&mesh) }
}

pub fn signed_volume(mesh: &SourceMesh<3>) -> f64 {
    let corner = |v: homeo_core::mesh::VertexId| mesh.positions()[v.index()];
    let volume = |[a, b, c]: [Point; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.complex().cells().iter().map(|cell| volume(cell.map(corner))).sum()
}

pub fn reversed(mesh: &SourceMesh<3>) -> SourceMesh<3> {
    let triangles: Vec<[u32; 3]> =
        mesh.complex().cells().iter().map(|cell| [cell[0].raw(), cell[2].raw(), cell[1].raw()]).collect();
    surface(mesh.positions().to_vec(), &triangles)
}

/// Four cubes one after the other, twisted round the origin, where normals of all six directions meet: no direction
/// sees them all.
pub fn twisted_cubes() -> SourceMesh<3> {
    let cubes = [[0, 0, 0], [-1, 0, 0], [-1, -1, 0], [-1, -1, -1]];
    let mut numbers = std::collections::BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for (cube, axis, side) in
        cubes.iter().flat_map(|cube| (0..3).flat_map(move |axis| [(cube, axis, 0), (cube, axis, 1)]))
    {
        let mut beyond = *cube;
        beyond[axis] += 2 * side - 1;
        if cubes.contains(&beyond) {
            continue;
        }
        let mut number = |u: i32, v: i32| {
            let mut corner = *cube;
            corner[axis] += side;
            corner[(axis + 1) % 3] += u;
            corner[(axis + 2) % 3] += v;
            *numbers.entry(corner).or_insert_with(|| {
                positions.push(corner.map(f64::from));
                positions.len() as u32 - 1
            })
        };
        let [a, b, c, d] = [number(0, 0), number(1, 0), number(1, 1), number(0, 1)];
        triangles.extend(if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
    }
    surface(positions, &triangles)
}

/// A bent tube with two boundary loops.
pub fn half_torus() -> SourceMesh<3> {
    let whole = torus(20, 12, 3.0);
    let inside = |cell: &&[homeo_core::mesh::VertexId; 3]| cell.iter().all(|v| whole.positions()[v.index()][0] > -0.2);
    let triangles: Vec<[u32; 3]> =
        whole.complex().cells().iter().filter(inside).map(|cell| cell.map(|v| v.raw())).collect();
    surface(whole.positions().to_vec(), &triangles)
}
