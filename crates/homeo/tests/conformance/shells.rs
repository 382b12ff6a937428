//! Shells round closed surfaces: certified, there and back exactly, and the same when written and read.

use std::collections::HashMap;
use std::io::Cursor;

use homeo::certificate::{Provenance, StoredMap, read_map, write_shell};
use homeo::construct::shell::{ShellParams, build};
use homeo::input::SourceMesh;
use homeo::map::{Shell, ShellEvaluationError};
use homeo::progress::Silent;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::Rational;
use homeo_verify::{Verdict, verify_bytes};

/// A closed surface of triangles.
pub struct Surface {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    fn mesh(&self) -> SourceMesh<3> {
        let complex = SimplicialComplex::from_indices(self.positions.len(), &self.triangles).expect("vertices exist");
        SourceMesh::new(self.positions.clone(), complex)
    }
}

/// An octahedron, its triangles cut into four `levels` times, bulged to a bumpy sphere.
pub fn sphere(levels: usize) -> Surface {
    let mut positions: Vec<[f64; 3]> = Vec::new();
    for axis in 0..3 {
        positions.extend([1.0, -1.0].map(|sign| std::array::from_fn(|k| if k == axis { sign } else { 0.0 })));
    }
    let mut triangles: Vec<[u32; 3]> = (0..8u32)
        .map(|octant| {
            let [a, b, c] = [0, 1, 2].map(|axis| 2 * axis + (octant >> axis & 1));
            if octant.count_ones() % 2 == 0 { [a, b, c] } else { [a, c, b] }
        })
        .collect();
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |positions: &mut Vec<[f64; 3]>, a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum: [f64; 3] = std::array::from_fn(|k| positions[a as usize][k] + positions[b as usize][k]);
                let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                positions.push(sum.map(|x| x / length));
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(x, y)| middle(&mut positions, x, y));
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = finer;
    }
    for p in &mut positions {
        let bump = 1.0 + 0.125 * (5.0 * p[0]).sin() * (4.0 * p[1]).cos();
        *p = p.map(|x| x * bump);
    }
    Surface { positions, triangles }
}

/// Four cubes in a chain round a point whose link is no star: no direction leaves the surface there.
pub fn singular() -> Surface {
    cubes(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]])
}

/// A fifth cube makes the next corner such a point too: no prism bears both.
pub fn singular_neighbours() -> Surface {
    cubes(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 1]])
}

/// The surface of a union of cubes.
fn cubes(cubes: &[[i32; 3]]) -> Surface {
    let mut numbers: HashMap<[i32; 3], u32> = HashMap::new();
    let mut surface = Surface { positions: Vec::new(), triangles: Vec::new() };
    for &cube in cubes {
        for axis in 0..3 {
            for side in [0, 1] {
                let mut beyond = cube;
                beyond[axis] += 2 * side - 1;
                if cubes.contains(&beyond) {
                    continue;
                }
                let corner = |u: i32, v: i32| {
                    let mut corner = cube;
                    corner[axis] += side;
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    corner
                };
                let mut quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(|corner| {
                    *numbers.entry(corner).or_insert_with(|| {
                        surface.positions.push(corner.map(f64::from));
                        surface.positions.len() as u32 - 1
                    })
                });
                if side == 0 {
                    quad.reverse();
                }
                let [a, b, c, d] = quad;
                surface.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    surface
}

/// A shell with this many rounds of simplification.
pub fn built(surface: &Surface, rounds: usize) -> Shell {
    let params = ShellParams { rounds, ..ShellParams::default() };
    build(&surface.mesh(), &params, &Silent).expect("a shell").0
}

/// The shell's map file.
pub fn bytes_of(shell: &Shell) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_shell(shell, &Provenance::default(), &mut bytes).expect("memory can be written");
    bytes.into_inner()
}

fn read(bytes: &[u8]) -> Shell {
    match read_map(bytes) {
        Ok(StoredMap::Shell(shell)) => shell,
        other => panic!("a shell was written: {other:?}"),
    }
}

fn check(surface: &Surface, rounds: usize) {
    let shell = crate::in_threads(1, || built(surface, rounds));
    let bytes = bytes_of(&shell);
    let again = crate::in_threads(2, || built(surface, rounds));
    assert!(bytes == bytes_of(&again), "the file differs when built again with two threads");
    let stored = read(&bytes);
    assert!(bytes == bytes_of(&stored), "the file differs when read and written");
    match verify_bytes(&bytes) {
        Ok(Verdict::Certified(claim)) => assert_eq!(claim.kind, "shell", "what is claimed"),
        other => panic!("not certified: {other:?}"),
    }
    for point in on_surface(surface) {
        let middle = stored.to_middle_exact(&point).and_then(|at| stored.unproject_exact(&at)).expect("in the shell");
        let back = stored.project_exact(&middle).and_then(|at| stored.to_source_exact(&at)).expect("on the middle");
        assert_eq!(back.point, point, "there and back");
        if rounds == 0 {
            assert_eq!(middle, point, "the middle is the source");
        }
        check_enclosures(&stored, point.each_ref().map(Rational::to_f64));
    }
    let far = stored.to_middle([100.0; 3]);
    assert_eq!(far.unwrap_err(), ShellEvaluationError::Outside, "far away");
}

/// Floating-point images of a point hold the exact ones, closely.
fn check_enclosures(shell: &Shell, place: [f64; 3]) {
    let Ok(at) = shell.project_exact(&crate::points::exact(place)) else { return };
    let enclosed = shell.project(place).expect("the exact projection exists");
    assert_eq!(enclosed.prism, at.prism, "the prism");
    for (interval, exact) in enclosed.weights.iter().zip(&at.weights).chain([(&enclosed.height, &at.height)]) {
        let [low, high] = [interval.low(), interval.high()].map(|end| Rational::from_f64(end).expect("finite"));
        assert!(low <= *exact && *exact <= high, "{interval:?} does not hold {exact}");
        assert!(interval.high() - interval.low() < 1e-9, "{interval:?} says nothing");
    }
    let images = [
        (shell.to_middle(place), shell.to_section_exact(&at)),
        (shell.to_section(place), shell.to_section_exact(&at)),
        (shell.to_source(place), shell.to_source_exact(&at)),
    ];
    for (near, exact) in images {
        let (near, exact) = (near.expect("an image"), exact.expect("an image").point);
        for axis in 0..3 {
            let miss = &crate::points::exact(near.point)[axis] - &exact[axis];
            assert!(miss.to_f64().abs() <= near.radius, "{near:?} does not hold {exact:?}");
        }
        assert!(near.radius < 1e-9, "{near:?} says little");
    }
}

/// Vertices, and a point inside each triangle.
fn on_surface(surface: &Surface) -> Vec<[Rational; 3]> {
    let exact = |p: [f64; 3]| crate::points::exact(p);
    let mut points: Vec<[Rational; 3]> = surface.positions.iter().map(|&p| exact(p)).collect();
    let weights: [Rational; 3] = ["1/2", "1/3", "1/6"].map(|w| w.parse().expect("a fraction"));
    for triangle in &surface.triangles {
        let corners = triangle.map(|v| exact(surface.positions[v as usize]));
        points.push(std::array::from_fn(|k| (0..3).map(|i| &weights[i] * &corners[i][k]).sum()));
    }
    points
}

#[test]
fn first_shell_of_a_sphere() {
    check(&sphere(1), 0);
}

#[test]
fn simplified_shell_of_a_sphere() {
    check(&sphere(3), 30);
}

#[test]
fn first_shell_at_a_singular_vertex() {
    check(&singular(), 0);
}

#[test]
fn shells_at_singular_neighbours() {
    check(&singular_neighbours(), 0);
    check(&singular_neighbours(), 30);
    let pinched = |surface: &Surface| {
        let parts = built(surface, 0).parts().clone();
        (0..parts.middle.len()).filter(|&v| parts.bottom[v] == parts.top[v]).count()
    };
    assert_eq!([pinched(&singular()), pinched(&singular_neighbours())], [1, 2]);
}

#[test]
fn simplified_shell_at_a_singular_vertex() {
    check(&singular(), 30);
}
