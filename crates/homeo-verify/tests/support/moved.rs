//! Meshes that have moved, and by definition whether they may: all pairs of cells, rational numbers.

use super::clip::{Rational, cross, dot, minus, normal, rational, within_tetrahedron, within_triangle};
use super::oracle::manifold_type;
use super::{Map, write};
use dashu_ratio::RBig;
use serde_json::json;

type Place = [f64; 3];

/// Points and cells.
type Mesh = (Vec<Place>, Vec<Vec<u32>>);

/// The map file of a mesh that moves point by point.
pub fn moved((positions, cells): &Mesh, change: impl Fn(Place) -> Place) -> Map {
    let rows = |points: &[Place]| points.iter().map(|p| p.to_vec()).collect();
    let mut map = Map::new("moved-mesh", "space", rows(positions), cells.clone());
    map.manifest["dimension"] = json!(cells[0].len() - 1);
    map.target_positions = rows(&positions.iter().map(|&p| change(p)).collect::<Vec<_>>());
    map.sign();
    map
}

/// Prisms of three tetrahedra each, over triangles in two layers.
fn prism([a, b, c]: [u32; 3], layers: [impl Fn(u32) -> u32; 2]) -> Vec<Vec<u32>> {
    let [low, high] = layers;
    vec![
        vec![low(a), low(b), low(c), high(c)],
        vec![low(a), low(b), high(b), high(c)],
        vec![low(a), high(a), high(b), high(c)],
    ]
}

/// A box of unit cubes of six tetrahedra each, where `keep` says so.
fn cubes(size: [u32; 3], keep: impl Fn([u32; 3]) -> bool) -> Mesh {
    let [nx, ny, nz] = size.map(|n| n + 1);
    let mut mesh: Mesh = (vec![], vec![]);
    let all = (0..nx * ny * nz).map(|k| [k % nx, k / nx % ny, k / nx / ny]);
    mesh.0.extend(all.clone().map(|p| p.map(f64::from)));
    for p in all.filter(|&p| (0..3).all(|k| p[k] < size[k]) && keep(p)) {
        for [x, y, z] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let mut corner = p;
            let mut cell = vec![p];
            for axis in [x, y, z] {
                corner[axis] += 1;
                cell.push(corner);
            }
            mesh.1.push(cell.into_iter().map(|[i, j, k]| (k * ny + j) * nx + i).collect());
        }
    }
    mesh
}

/// A tetrahedron with a tetrahedral hollow.
fn hollow() -> Mesh {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0]];
    let mut mesh: Mesh = (corners.map(|p: Place| p.map(|x| 4.0 * x)).to_vec(), vec![]);
    mesh.0.extend(corners);
    for face in [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]] {
        mesh.1.extend(prism(face, [|v| v, |v| v + 4]));
    }
    mesh
}

/// A ring of prisms.
fn ring() -> Mesh {
    let around = [[4.0, 0.0], [-2.0, 3.0], [-2.0, -3.0]];
    let place = |[x, y]: [f64; 2]| [[0.5 * x, 0.5 * y, 0.0], [x, y, -1.0], [x, y, 1.0]];
    let mut mesh: Mesh = (around.into_iter().flat_map(place).collect(), vec![]);
    for turn in 0..3 {
        mesh.1.extend(prism([0, 1, 2], [3 * turn, 3 * ((turn + 1) % 3)].map(|first| move |v: u32| first + v)));
    }
    mesh
}

/// A strip of triangles that is closed after some half turns: an annulus or a Moebius strip.
fn strip(half_turns: u32) -> Mesh {
    const STEPS: u32 = 7;
    let mut mesh: Mesh = (vec![], vec![]);
    for k in 0..STEPS {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(STEPS);
        let turn = 0.5 * angle * f64::from(half_turns);
        mesh.0.extend([-1.0, 1.0].map(|side: f64| {
            let r = 4.0 + side * turn.cos();
            [r * angle.cos(), r * angle.sin(), side * turn.sin()]
        }));
        let [a, b] = [2 * k, 2 * k + 1];
        let next = [2 * k + 2, 2 * k + 3];
        let [c, d] = match k + 1 == STEPS {
            true if half_turns % 2 == 1 => [1, 0],
            true => [0, 1],
            false => next,
        };
        mesh.1.extend([vec![a, b, d], vec![a, d, c]]);
    }
    mesh
}

/// A piece of a plane, bumpy or not, of so many squares along its sides.
fn sheet(size: u32, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let n = size + 1;
    let place = |k: u32| [f64::from(k % n), f64::from(k / n)];
    let points = (0..n * n).map(place).map(|[x, y]| [x, y, height(x, y)]).collect();
    let squares = (0..n * size).filter(|k| k % n < size);
    (points, squares.flat_map(|k| [vec![k, k + 1, k + n + 1], vec![k, k + n + 1, k + n]]).collect())
}

fn octahedron(centre: Place) -> Mesh {
    let axes = (0..6).map(|k| [0, 1, 2].map(|i| centre[i] + if i == k / 2 { 1.0 - 2.0 * (k % 2) as f64 } else { 0.0 }));
    let faces = (0..8u32).map(|k| vec![k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)]);
    (axes.collect(), faces.collect())
}

fn joined((points, cells): Mesh, other: Mesh) -> Mesh {
    let first = points.len() as u32;
    let shifted = other.1.iter().map(|cell| cell.iter().map(|v| v + first).collect());
    ([points, other.0].concat(), cells.into_iter().chain(shifted).collect())
}

/// A twist round the third axis, and a bend.
pub fn twisted([x, y, z]: Place) -> Place {
    let (sin, cos) = (0.1 * z).sin_cos();
    [cos * x - sin * y + 0.02 * z * z, sin * x + cos * y, 1.25 * z + 0.125 * x]
}

/// A bar with two prongs.
pub fn fork() -> Mesh {
    cubes([3, 2, 1], |[x, y, _]| y == 0 || x != 1)
}

/// Its prongs bent towards one another, up to one step of the last place.
fn almost_closed([x, y, z]: Place) -> Place {
    let bend = 0.5 * (y - 1.0).max(0.0);
    [if x < 1.5 { (x + bend).next_down() } else { x - bend }, y, z]
}

/// Valid maps of all kinds.
pub fn moved_meshes() -> Vec<(&'static str, Map)> {
    let single: Mesh = (vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], vec![vec![0, 1, 2, 3]]);
    // One step of the last place above the ground.
    let sliver: Mesh = (
        vec![[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.25, 1.25, 1.0f64.next_up()], [1.25, 1.25, 0.0]],
        vec![vec![0, 1, 2, 3], vec![0, 1, 2, 4]],
    );
    let turn = |p: Place| [p[1], p[2], p[0]];
    let two_sheets = joined(sheet(1, |_, _| 0.0), sheet(1, |_, _| 0.0f64.next_up()));
    vec![
        ("one tetrahedron", moved(&single, twisted)),
        ("a tetrahedron that stays", moved(&single, |p| p)),
        ("a flat one, its neighbour of the other sign", moved(&sliver, turn)),
        ("a cube", moved(&cubes([1, 1, 1], |_| true), twisted)),
        ("a fork whose prongs almost touch", moved(&fork(), almost_closed)),
        ("a hollow body", moved(&hollow(), twisted)),
        ("a ring", moved(&ring(), twisted)),
        ("a triangle", moved(&(single.0[..3].to_vec(), vec![vec![0, 1, 2]]), twisted)),
        ("a sheet", moved(&sheet(3, |_, _| 0.0), |[x, y, _]| [x, y, 0.25 * x * y])),
        ("a bumpy sheet", moved(&sheet(3, |x, y| (x * 1.5).sin() + y), |[x, y, _]| [x, y, 1.0])),
        ("two sheets that almost touch", moved(&two_sheets, |[x, y, z]| [y, x, z])),
        ("a sphere in a sphere", moved(&joined(scaled(octahedron([0.0; 3]), 4.0), octahedron([0.25; 3])), twisted)),
        ("an annulus", moved(&strip(0), twisted)),
        ("a Moebius strip", moved(&strip(1), twisted)),
        ("a strip with a whole turn", moved(&strip(2), twisted)),
    ]
}

fn scaled((points, cells): Mesh, factor: f64) -> Mesh {
    (points.into_iter().map(|p| p.map(|x| factor * x)).collect(), cells)
}

// The oracle.

/// Whether the map of a file is one-to-one and, for tetrahedra, keeps their signs, and the file says what it holds.
pub fn is_valid(map: &Map) -> bool {
    let size = map.size();
    let finite = |rows: &[Vec<f64>]| rows.iter().flatten().all(|x| x.is_finite());
    let is_whole = finite(&map.positions) && finite(&map.target_positions) && manifest_is_right(map, size);
    if !is_whole || map.source_cells.iter().flatten().any(|&v| v as usize >= map.positions.len()) {
        return false;
    }
    let components = manifold_type(&map.source_cells).map_or(0, |found| found.0);
    let is_right = if size == 4 { components == 1 } else { components > 0 };
    is_right
        && (size == 3 || keeps_signs(map))
        && is_injective(&map.positions, &map.source_cells)
        && is_injective(&map.target_positions, &map.source_cells)
}

fn manifest_is_right(map: &Map, size: usize) -> bool {
    let m = &map.manifest;
    let fields = ["kind", "target", "dimension", "centre", "source", "format", "version"];
    fields.iter().all(|field| m.as_object().is_some_and(|top| top.contains_key(*field)))
        && (m["kind"] == "moved-mesh" && m["target"] == "space" && m["format"] == "homeo" && m["version"] == 1)
        && (m["dimension"] == 2 || m["dimension"] == 3)
        && m["centre"].is_null()
        && map.target_positions.len() == map.positions.len()
        && map.source_cells.iter().all(|cell| cell.len() == size)
        && m["source"]["vertices"] == map.positions.len()
        && m["source"]["cells"] == map.source_cells.len()
        && m["source"]["content_sha256"] == write::content_hash(map)
}

fn corners(points: &[Vec<f64>], cell: &[u32]) -> Vec<Rational> {
    cell.iter().map(|&v| rational([0, 1, 2].map(|k| points[v as usize][k]))).collect()
}

/// Six times the volume of a tetrahedron.
fn volume(points: &[Vec<f64>], cell: &[u32]) -> RBig {
    let [a, b, c, d] = <[Rational; 4]>::try_from(corners(points, cell)).expect("four corners");
    dot(&minus(&b, &a), &cross(&minus(&c, &a), &minus(&d, &a)))
}

fn keeps_signs(map: &Map) -> bool {
    let signs = |points: &[Vec<f64>]| -> Vec<bool> {
        map.source_cells.iter().map(|cell| volume(points, cell) > RBig::ZERO).collect()
    };
    signs(&map.positions) == signs(&map.target_positions)
}

/// Whether cells are not flat, and any two have no more in common than their common vertices span.
pub fn is_injective(points: &[Vec<f64>], cells: &[Vec<u32>]) -> bool {
    let is_flat = |cell: &Vec<u32>| match &corners(points, cell)[..] {
        [a, b, c] => normal(&[a.clone(), b.clone(), c.clone()]) == [RBig::ZERO; 3],
        _ => volume(points, cell) == RBig::ZERO,
    };
    let are_far = |a: &[u32], b: &[u32]| {
        let range = |cell: &[u32], k: usize| {
            let at = |&v: &u32| points[v as usize][k];
            [cell.iter().map(at).fold(f64::INFINITY, f64::min), cell.iter().map(at).fold(f64::NEG_INFINITY, f64::max)]
        };
        (0..3).any(|k| range(a, k)[1] < range(b, k)[0] || range(b, k)[1] < range(a, k)[0])
    };
    let meet_well =
        |a: &Vec<u32>, b: &Vec<u32>| are_far(a, b) || meet_in_face(points, a, b) && meet_in_face(points, b, a);
    !cells.iter().any(is_flat) && (0..cells.len()).all(|i| (0..i).all(|j| meet_well(&cells[i], &cells[j])))
}

/// Whether all that the boundary of one cell has in common with another cell is in the face that they share.
fn meet_in_face(points: &[Vec<f64>], cell: &[u32], other: &[u32]) -> bool {
    let others = corners(points, other);
    let facets: Vec<Vec<u32>> = match cell {
        [..] if cell.len() == 3 => vec![cell.to_vec()],
        _ => (0..4).map(|i| cell.iter().copied().filter(|&v| v != cell[i]).collect()).collect(),
    };
    facets.iter().all(|facet| {
        let polygon = corners(points, facet);
        let common = match &others[..] {
            [a, b, c] => within_triangle(&polygon, &[a.clone(), b.clone(), c.clone()]),
            [a, b, c, d] => within_tetrahedron(&polygon, &[a.clone(), b.clone(), c.clone(), d.clone()]),
            _ => unreachable!("cells have three or four corners"),
        };
        let apart: Vec<usize> = (0..3).filter(|&i| !other.contains(&facet[i])).collect();
        common.iter().all(|p| apart.iter().all(|&i| share(&polygon, i, p) == RBig::ZERO))
    })
}

/// The barycentric coordinate of a point of a triangle at a corner, up to a factor.
fn share(triangle: &[Rational], i: usize, p: &Rational) -> RBig {
    let (a, b) = (&triangle[(i + 1) % 3], &triangle[(i + 2) % 3]);
    let up = normal(&[triangle[0].clone(), triangle[1].clone(), triangle[2].clone()]);
    dot(&up, &cross(&minus(b, a), &minus(p, a)))
}
