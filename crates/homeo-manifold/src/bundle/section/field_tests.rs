//! Sections of fields of vectors: their indices are the rotation numbers of the fields.

use super::super::surfaces::torus;
use super::super::tangent::TangentBundle;
use super::tests::sphere;
use super::*;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{PI, TAU};

pub(super) type Vector = [f64; 3];

pub(super) struct Surface {
    pub places: Vec<Vector>,
    pub triangles: Vec<[u32; 3]>,
}

/// A torus about the z-axis, a little bent so that nothing is in special position.
pub(super) fn round_torus(a: u32, b: u32) -> Surface {
    let place = |i: u32, j: u32| {
        let (u, v) = (TAU * (f64::from(i) + 0.13) / f64::from(a), TAU * (f64::from(j) + 0.29) / f64::from(b));
        let radius = 2.0 + (0.8 + 0.05 * (3.0 * u).sin()) * v.cos();
        [radius * u.cos(), radius * u.sin(), 0.8 * v.sin() + 0.1 * u.cos()]
    };
    let places = (0..a).flat_map(|i| (0..b).map(move |j| place(i, j))).collect();
    Surface { places, triangles: torus(a, b) }
}

pub(super) fn ball() -> Surface {
    let (places, triangles) = sphere();
    // Neither round nor symmetric.
    let bent = |p: Vector| [1.1 * p[0] + 0.1 * p[1] * p[2], p[1] - 0.2 * p[0] * p[0], 0.8 * p[2] + 0.15 * p[0]];
    Surface { places: places.into_iter().map(bent).collect(), triangles }
}

pub(super) fn random(count: usize, seed: u64) -> Vec<Vector> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| [next(), next(), next()]).collect()
}

/// The rotation number of a field round each triangle, by complex numbers and from the definition: no fans, no sides, no bundle.
struct Rotation {
    triangles: Vec<[u32; 3]>,
    /// The direction along each directed edge at its start, as an angle; and the scaled angle of each corner.
    along: HashMap<[u32; 2], f64>,
    corners: Vec<[f64; 3]>,
    directions: Vec<Option<f64>>,
}

pub(super) fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(super) fn product(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn normal(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn length(a: Vector) -> f64 {
    product(a, a).sqrt()
}

impl Rotation {
    fn new(surface: &Surface, vectors: &[Vector]) -> Self {
        let Surface { places, triangles } = surface;
        let count = places.len();
        let mut after: Vec<HashMap<u32, (u32, f64)>> = vec![HashMap::new(); count];
        let mut normals = vec![[0.0; 3]; count];
        for corners in triangles {
            for k in 0..3 {
                let [v, a, b] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
                let [e, f] = [a, b].map(|w| minus(places[w as usize], places[v as usize]));
                let angle = (product(e, f) / (length(e) * length(f))).clamp(-1.0, 1.0).acos();
                after[v as usize].insert(a, (b, angle));
                let n = normal(e, f);
                let weight = angle / length(n);
                normals[v as usize] = [0, 1, 2].map(|axis| normals[v as usize][axis] + weight * n[axis]);
            }
        }
        let mut along = HashMap::new();
        let mut directions = Vec::new();
        for (v, fan) in after.iter().enumerate() {
            let total: f64 = fan.values().map(|(_, angle)| angle).sum();
            let first = *fan.keys().min().unwrap();
            let (mut here, mut sum, mut direction) = (first, 0.0, None);
            let flat = |w: Vector| {
                let share = product(w, normals[v]) / product(normals[v], normals[v]);
                [0, 1, 2].map(|k| w[k] - share * normals[v][k])
            };
            let field = flat(vectors[v]);
            let is_zero = length(field) <= 1e-12 * length(vectors[v]);
            loop {
                let (next, angle) = fan[&here];
                along.insert([v as u32, here], sum * TAU / total);
                // Projected, the field is between two edges if it is on the left of one and on the right of the other.
                let [e, f] = [here, next].map(|w| flat(minus(places[w as usize], places[v])));
                let on_left = |a: Vector, b: Vector| product(normal(a, b), normals[v]) >= 0.0;
                if !is_zero && direction.is_none() && on_left(e, field) && on_left(field, f) && on_left(e, f) {
                    let between =
                        |a: Vector, b: Vector| (product(a, b) / (length(a) * length(b))).clamp(-1.0, 1.0).acos();
                    direction = Some((sum + angle * between(e, field) / between(e, f)) * TAU / total);
                }
                sum += angle;
                here = next;
                if here == first {
                    break;
                }
            }
            assert_eq!(direction.is_none(), is_zero, "vertex {v}");
            directions.push(direction);
        }
        let scaled = |corners: &[u32; 3]| {
            [0, 1, 2].map(|k: usize| {
                let [v, a, b] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
                (along[&[v, b]] - along[&[v, a]]).rem_euclid(TAU)
            })
        };
        let corners = triangles.iter().map(scaled).collect();
        Self { triangles: triangles.clone(), along, corners, directions }
    }

    fn turn(&self, from: u32, to: u32) -> f64 {
        let [start, end] = [from, to].map(|v| self.directions[v as usize].unwrap());
        let carried = start - self.along[&[from, to]] + self.along[&[to, from]] + PI;
        // The argument of a quotient of unit complex numbers.
        (end - carried).sin().atan2((end - carried).cos())
    }

    /// The indices of all triangles, and of the vertices without direction.
    fn indices(&self) -> (Vec<i64>, BTreeMap<u32, i64>) {
        let mut sums = BTreeMap::new();
        let mut indices = vec![0; self.triangles.len()];
        for (number, corners) in self.triangles.iter().enumerate() {
            let is_zero = |v: u32| self.directions[v as usize].is_none();
            let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
            let turns: f64 =
                edges.iter().filter(|(a, b)| !is_zero(*a) && !is_zero(*b)).map(|&(a, b)| self.turn(a, b)).sum();
            let curvature: f64 = self.corners[number].iter().sum::<f64>() - PI;
            match corners.iter().find(|&&v| is_zero(v)) {
                Some(&v) => *sums.entry(v).or_insert(0.0) += turns + curvature,
                None => indices[number] = whole(turns + curvature),
            }
        }
        (indices, sums.into_iter().map(|(v, sum)| (v, whole(sum))).collect())
    }
}

pub(super) fn whole(angle: f64) -> i64 {
    let turns = angle / TAU;
    assert!((turns - turns.round()).abs() < 1e-7, "{turns} turns");
    turns.round() as i64
}

/// The indices of a section, added up over the triangles of the surface that was given.
fn by_parents(tangent: &TangentBundle, section: &Section, count: usize) -> Vec<i64> {
    let mut indices = vec![0; count];
    for (triangle, index) in section.singularities() {
        indices[tangent.parents[triangle as usize] as usize] += index;
    }
    indices
}

/// By the tetrahedra alone the indices are the same.
pub(super) fn unless_wound(tangent: &TangentBundle, section: &Section) {
    let bundle = &tangent.bundle;
    let wound = WoundPaths::new(bundle.triangles(), bundle.layers(), &bundle.tetrahedra(), &section.paths()).unwrap();
    let indices: Vec<i64> = (0..bundle.triangles().len() as u32).map(|t| section.index(t)).collect();
    assert_eq!((wound.triangles, wound.vertices), (indices, section.singular_vertices()));
}

#[test]
fn indices_are_the_rotation_numbers_of_random_fields() {
    let (mut singular, mut elsewhere, mut fields) = (0, 0, 0);
    for (surface, characteristic) in [(ball(), 2), (round_torus(9, 7), 0)] {
        for layers in [3, 8, 13] {
            let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), layers).unwrap();
            for seed in 0..6 {
                let mut vectors = random(surface.places.len(), seed);
                if seed % 2 == 1 {
                    vectors[5] = [0.0; 3];
                }
                let section = Section::of_field(&tangent, &surface.places, &vectors).unwrap();
                let (triangles, vertices) = Rotation::new(&surface, &vectors).indices();
                let found = by_parents(&tangent, &section, triangles.len());
                if seed % 2 == 0 {
                    assert_eq!(found, triangles, "{layers} layers, seed {seed}");
                } else {
                    // Round a zero the triangles of the surface may be cut: their indices count together.
                    let star: Vec<bool> = surface.triangles.iter().map(|corners| corners.contains(&5)).collect();
                    let inside = |list: &[i64], at: bool| -> i64 {
                        list.iter().zip(&star).filter(|(_, is_in)| **is_in == at).map(|(index, _)| index).sum()
                    };
                    let outside = |list: &[i64]| -> Vec<i64> {
                        list.iter().zip(&star).map(|(index, is_in)| if *is_in { 0 } else { *index }).collect()
                    };
                    let zero: i64 = section.singular_vertices().iter().map(|(_, index)| index).sum();
                    assert_eq!(inside(&found, true) + zero, vertices[&5]);
                    assert_eq!(outside(&found), triangles);
                }
                let all: i64 = section.singularities().chain(section.singular_vertices()).map(|(_, index)| index).sum();
                assert_eq!(all, characteristic);
                unless_wound(&tangent, &section);
                // Negative control: the shortest turns in the bundle are not those of the field.
                let levels = section.levels().iter().map(|level| level.unwrap_or(0)).collect();
                let shortest = Section::new(&tangent.bundle, levels).unwrap();
                elsewhere += usize::from(by_parents(&tangent, &shortest, triangles.len()) != found);
                singular += found.iter().filter(|index| **index != 0).count();
                fields += 1;
            }
        }
    }
    assert!(fields == 36 && singular > 1000 && elsewhere > 30, "{fields}, {singular}, {elsewhere}");
}

/// The part of a vector along the surface is taken by the section itself: the gradient of a height is the height's axis.
#[test]
fn heights_have_their_maxima_minima_and_saddles() {
    let surface = round_torus(23, 16);
    let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), 8).unwrap();
    let section = Section::of_field(&tangent, &surface.places, &vec![[1.0, 0.05, 0.02]; surface.places.len()]).unwrap();
    let mut indices: Vec<i64> = section.singularities().map(|(_, index)| index).collect();
    indices.sort_unstable();
    assert_eq!(indices, [-1, -1, 1, 1]);
    // The poles of a symmetric sphere are vertices, where the field is zero.
    let (places, triangles) = sphere();
    let tangent = TangentBundle::new(&triangles, places.len(), 8).unwrap();
    let section = Section::of_field(&tangent, &places, &vec![[0.0, 0.0, 1.0]; places.len()]).unwrap();
    assert_eq!(section.singular_vertices(), [(4, 1), (5, 1)]);
    assert_eq!(section.singularities().count(), 0);
    assert!(
        section.levels()[4].is_none() && section.levels().iter().flatten().count() == tangent.bundle.vertex_count() - 2
    );
    unless_wound(&tangent, &section);
}

/// The field conj(z)^k on the parameters of a torus: a zero of index -k.
fn saddle(surface: &Surface, (a, b): (u32, u32), centre: [f64; 2], order: i32) -> Vec<Vector> {
    let vector = |i: u32, j: u32| {
        let [x, y] = [f64::from(i) - centre[0], f64::from(j) - centre[1]];
        // The six neighbours of a vertex are equally far from one another: then twice their angles stay below half a turn.
        let [x, y] = [x - 0.5 * y, 0.75_f64.sqrt() * y];
        let angle = -f64::from(order) * y.atan2(x);
        let size = if x == 0.0 && y == 0.0 { 0.0 } else { 1.0 };
        let at = |i: u32, j: u32| surface.places[(i % a * b + j % b) as usize];
        let [along, across] = [(i + 1, j, i + a - 1, j), (i, j + 1, i, j + b - 1)].map(|(i, j, k, l)| {
            let edge = minus(at(i, j), at(k, l));
            edge.map(|x| x / length(edge))
        });
        [0, 1, 2].map(|k| size * (angle.cos() * along[k] + angle.sin() * across[k]))
    };
    (0..a).flat_map(|i| (0..b).map(move |j| (i, j))).map(|(i, j)| vector(i, j)).collect()
}

#[test]
fn monkey_saddles_have_index_minus_two() {
    let surface = round_torus(24, 18);
    let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), 8).unwrap();
    for (order, expected) in [(-1, 1), (1, -1), (2, -2), (-2, 2)] {
        let at_vertex = saddle(&surface, (24, 18), [12.0, 9.0], order);
        let section = Section::of_field(&tangent, &surface.places, &at_vertex).unwrap();
        assert_eq!(section.singular_vertices(), [(12 * 18 + 9, expected)]);
        unless_wound(&tangent, &section);
        // In the middle of a triangle: it and those next to it have the index together.
        let within = saddle(&surface, (24, 18), [11.7, 8.6], order);
        let section = Section::of_field(&tangent, &surface.places, &within).unwrap();
        let near =
            |corners: [u32; 3]| corners.iter().all(|v| (9..=14).contains(&(v / 18)) && (6..=11).contains(&(v % 18)));
        let here =
            section.singularities().filter(|(t, _)| near(surface.triangles[tangent.parents[*t as usize] as usize]));
        assert_eq!(here.map(|(_, index)| index).sum::<i64>(), expected);
        unless_wound(&tangent, &section);
    }
}

#[test]
fn fields_that_say_nothing_of_an_index_are_refused_with_their_elements() {
    let surface = ball();
    let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), 5).unwrap();
    let [a, b, _] = surface.triangles[0];
    let mut vectors = random(surface.places.len(), 3);
    [vectors[a as usize], vectors[b as usize]] = [[0.0; 3]; 2];
    let refused = Section::of_field(&tangent, &surface.places, &vectors).unwrap_err();
    let (SectionError::Zeros { first, second } | SectionError::Opposite { first, second }) = refused else {
        panic!("{refused}")
    };
    assert_eq!([first.min(second), first.max(second)], [a.min(b), a.max(b)]);
    assert!(matches!(refused, SectionError::Zeros { .. }));
    // Both along their edge, and towards each other.
    let edge = minus(surface.places[b as usize], surface.places[a as usize]);
    vectors[a as usize] = edge;
    vectors[b as usize] = edge.map(|x| -x);
    let refused = Section::of_field(&tangent, &surface.places, &vectors).unwrap_err();
    let SectionError::Opposite { first, second } = refused else { panic!("{refused}") };
    assert_eq!([first.min(second), first.max(second)], [a.min(b), a.max(b)]);
    vectors[a as usize][1] = f64::NAN;
    assert_eq!(
        Section::of_field(&tangent, &surface.places, &vectors).unwrap_err(),
        SectionError::NoDirection { vertex: a }
    );
    let short = Section::of_field(&tangent, &surface.places, &vectors[1..]).unwrap_err();
    assert!(matches!(short, SectionError::Count { .. }));
}

/// Negative control of the check by tetrahedra: what is changed in paths is found, or changes an index.
#[test]
fn paths_that_are_changed_are_found() {
    let surface = round_torus(5, 4);
    let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), 6).unwrap();
    let section = Section::of_field(&tangent, &surface.places, &random(surface.places.len(), 8)).unwrap();
    let (bundle, paths) = (&tangent.bundle, section.paths());
    let tetrahedra = bundle.tetrahedra();
    let wound = |paths: &[Vec<u32>]| WoundPaths::new(bundle.triangles(), 6, &tetrahedra, paths);
    let right = wound(&paths).unwrap();
    let (mut faults, mut indices) = (0, 0);
    for number in 0..paths.len() {
        let mut moved = paths.clone();
        let last = moved[number].len() - 1;
        let end = moved[number][last];
        moved[number][last] = end / 6 * 6 + (end + 1) % 6;
        faults += usize::from(matches!(wound(&moved), Err(PathFault::Twice { .. } | PathFault::NoEdge { .. })));
        // Once more round the fibre: a path still, and two indices change.
        let mut longer = paths.clone();
        longer[number].extend((1..=6).map(|step| end / 6 * 6 + (end % 6 + step) % 6));
        let other = wound(&longer).unwrap();
        let changed = other.triangles.iter().zip(&right.triangles).filter(|(a, b)| (*a - *b).abs() == 1).count();
        indices += usize::from(changed == 2);
        let mut missing = paths.clone();
        missing.remove(number);
        faults += usize::from(matches!(wound(&missing), Err(PathFault::NoPath { .. })));
    }
    assert_eq!((faults, indices), (2 * paths.len(), paths.len()));
}

/// Squares of tiny vectors vanished, so that they were taken for zeros; those of large ones were infinite.
#[test]
fn neither_the_size_of_the_surface_nor_that_of_vectors_counts() {
    let surface = ball();
    let tangent = TangentBundle::new(&surface.triangles, surface.places.len(), 8).unwrap();
    let vectors = random(surface.places.len(), 3);
    let scaled = |vectors: &[Vector], exponent: i32| -> Vec<Vector> {
        vectors.iter().map(|vector| vector.map(|x| x * 2_f64.powi(exponent))).collect()
    };
    let section = Section::of_field(&tangent, &surface.places, &vectors).unwrap();
    assert!(section.singularities().count() > 10);
    for (of_places, of_vectors) in [(0, -700), (0, 700), (-400, 0), (300, 0), (-1000, -1000)] {
        let (places, vectors) = (scaled(&surface.places, of_places), scaled(&vectors, of_vectors));
        let other = Section::of_field(&tangent, &places, &vectors).unwrap();
        assert_eq!((other.levels(), other.paths()), (section.levels(), section.paths()), "{of_places} {of_vectors}");
    }
}
