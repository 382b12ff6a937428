//! Bundles over surfaces of genus 0, 1 and 2, free to be wrong.

use super::random::Random;
use super::write::{npy, sha256, zip};
use homeo_verify::{Unreadable, Verdict, verify_bytes};
use serde_json::json;
use std::collections::HashMap;

/// The arrays of a bundle, free to be wrong.
#[derive(Clone, Debug, Default)]
pub struct Arrays {
    pub name: &'static str,
    pub vertices: usize,
    pub triangles: Vec<[u32; 3]>,
    pub layers: u32,
    pub slopes: Vec<[u32; 3]>,
    pub tetrahedra: Vec<[u32; 4]>,
    pub section: Option<SectionArrays>,
}

/// The arrays of a section, likewise; a path is a list of vertices of the bundle.
#[derive(Clone, Debug, Default)]
pub struct SectionArrays {
    pub levels: Vec<u32>,
    pub paths: Vec<Vec<u32>>,
    /// What the lengths of paths are said to be more than they are.
    pub excess: Vec<i64>,
    pub triangle_indices: Vec<i64>,
    pub vertex_indices: Vec<i64>,
}

impl SectionArrays {
    fn entries(&self) -> Vec<(String, Vec<u8>)> {
        let lengths: Vec<u32> =
            self.paths.iter().zip(&self.excess).map(|(path, excess)| (path.len() as i64 + excess) as u32).collect();
        let unsigned = |name: &str, numbers: &[u32]| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            (format!("{name}.npy"), npy("<u4", &format!("({},)", numbers.len()), &bytes))
        };
        let signed = |name: &str, numbers: &[i64]| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            (format!("{name}.npy"), npy("<i8", &format!("({},)", numbers.len()), &bytes))
        };
        vec![
            unsigned("section_levels", &self.levels),
            unsigned("section_path_lengths", &lengths),
            unsigned("section_path_vertices", &self.paths.concat()),
            signed("triangle_indices", &self.triangle_indices),
            signed("vertex_indices", &self.vertex_indices),
        ]
    }
}

impl Arrays {
    pub fn verdict(&self) -> Result<Verdict, Unreadable> {
        let bytes = |numbers: &[u32]| -> Vec<u8> { numbers.iter().flat_map(|x| x.to_le_bytes()).collect() };
        let base = bytes(self.triangles.as_flattened());
        let counts = [self.vertices as u64, 3, self.triangles.len() as u64];
        let mut hashed: Vec<u8> = counts.iter().flat_map(|x| x.to_le_bytes()).collect();
        hashed.extend(&base);
        let manifest = json!({
            "format": "homeo", "version": 1, "kind": "unit-tangent-bundle", "dimension": 3,
            "target": if self.section.is_some() { "unit-tangent-bundle-with-section" } else { "unit-tangent-bundle" },
            "centre": null,
            "source": {
                "name": self.name, "vertices": self.vertices, "cells": self.triangles.len(), "content_sha256": sha256(&hashed),
            },
        });
        let table = |name: &str, rows: usize, columns: usize, bytes: &[u8]| {
            (format!("{name}.npy"), npy("<u4", &format!("({rows}, {columns})"), bytes))
        };
        let mut entries = vec![
            ("manifest.json".to_owned(), manifest.to_string().into_bytes()),
            table("base_triangles", self.triangles.len(), 3, &base),
            ("layers.npy".to_owned(), npy("<u4", "(1,)", &self.layers.to_le_bytes())),
            table("slopes", self.slopes.len(), 3, &bytes(self.slopes.as_flattened())),
            table("tetrahedra", self.tetrahedra.len(), 4, &bytes(self.tetrahedra.as_flattened())),
        ];
        entries.extend(self.section.iter().flat_map(SectionArrays::entries));
        verify_bytes(&zip(&entries))
    }

    pub fn characteristic(&self) -> i64 {
        self.vertices as i64 - self.triangles.len() as i64 / 2
    }

    /// The surface with slopes whose sums have random signs and this Euler number, random where that is free.
    pub fn with_slopes(mut self, layers: u32, euler_number: i64, random: &mut Random) -> Self {
        self.layers = layers;
        let count = self.triangles.len() as i64;
        let positive = (count + 2 * i64::from(layers) * euler_number) / 2;
        assert!((0..=count).contains(&positive), "too few triangles for {layers} layers");
        let mut sums: Vec<u32> =
            (0..count).map(|number| if number < positive { layers - 1 } else { layers - 2 }).collect();
        (1..sums.len()).rev().for_each(|k| sums.swap(k, random.below(k + 1)));
        let sides = sides(&self.triangles);
        let across = |t: usize, k: usize| {
            let [a, b] = ends(&self.triangles, t, k);
            sides[&[b, a]]
        };
        // A tree of triangles; slopes off the tree are free, those to parents follow from the leaves on.
        let (mut order, mut entry) = (vec![0], vec![None; self.triangles.len()]);
        let mut next = 0;
        while let Some(&here) = order.get(next) {
            next += 1;
            for (there, side) in (0..3).map(|k| across(here, k)) {
                if there != 0 && entry[there].is_none() {
                    entry[there] = Some(side);
                    order.push(there);
                }
            }
        }
        self.slopes = vec![[0; 3]; self.triangles.len()];
        let set = |slopes: &mut Vec<[u32; 3]>, t: usize, k: usize, slope: u32| {
            let (other, side) = across(t, k);
            slopes[t][k] = slope % layers;
            slopes[other][side] = (2 * layers - 1 - slope % layers) % layers;
        };
        for (t, k) in (0..self.triangles.len()).flat_map(|t| (0..3).map(move |k| (t, k))) {
            set(&mut self.slopes, t, k, random.below(layers as usize) as u32);
        }
        for &t in order.iter().rev() {
            if let Some(side) = entry[t] {
                let others: u32 = self.slopes[t].iter().sum::<u32>() - self.slopes[t][side];
                set(&mut self.slopes, t, side, sums[t] + 2 * layers - others % layers);
            }
        }
        self.tetrahedra = (0..self.triangles.len()).flat_map(|t| self.tetrahedra_over(t)).collect();
        self
    }

    /// Whether two vertices of the bundle over a triangle are joined, by the definition of slopes.
    pub fn is_edge(&self, triangle: usize, [a, b]: [u32; 2]) -> bool {
        let (n, corners) = (self.layers, self.triangles[triangle]);
        let corner = |vertex: u32| corners.iter().position(|&corner| corner == vertex / n);
        let (Some(i), Some(j)) = (corner(a), corner(b)) else { return false };
        let rise = |from: u32, to: u32| (to % n + n - from % n) % n;
        match (j + 3 - i) % 3 {
            0 => rise(a, b) == 1 || rise(b, a) == 1,
            1 => [0, 1].contains(&((rise(a, b) + n - self.slopes[triangle][i]) % n)),
            _ => [0, 1].contains(&((rise(b, a) + n - self.slopes[triangle][j]) % n)),
        }
    }

    /// All sets of four vertices over a triangle of which each two are joined, with both levels of one corner first, lower one before, and
    /// the other corners in the order of the triangle.
    pub fn tetrahedra_over(&self, triangle: usize) -> Vec<[u32; 4]> {
        let (n, corners) = (self.layers, self.triangles[triangle]);
        let mut all = vec![];
        for k in 0..3 {
            let [u, v, w] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
            for (level, second, third) in (0..n).flat_map(|a| (0..n).flat_map(move |b| (0..n).map(move |c| (a, b, c))))
            {
                let four = [u * n + level, u * n + (level + 1) % n, v * n + second, w * n + third];
                let pairs = [[0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
                if pairs.iter().all(|&[i, j]| self.is_edge(triangle, [four[i], four[j]])) {
                    all.push(four);
                }
            }
        }
        all
    }
}

pub fn ends(triangles: &[[u32; 3]], t: usize, k: usize) -> [u32; 2] {
    [triangles[t][k], triangles[t][(k + 1) % 3]]
}

/// The triangle and side along each directed edge.
pub fn sides(triangles: &[[u32; 3]]) -> HashMap<[u32; 2], (usize, usize)> {
    (0..triangles.len())
        .flat_map(|t| (0..3).map(move |k| (t, k)))
        .map(|(t, k)| (ends(triangles, t, k), (t, k)))
        .collect()
}

pub fn surface(name: &'static str, triangles: Vec<[u32; 3]>) -> Arrays {
    let vertices = triangles.iter().flatten().max().map_or(0, |&most| most as usize + 1);
    Arrays { name, vertices, triangles, ..Arrays::default() }
}

pub fn icosahedron() -> Arrays {
    let around = |k: u32| 1 + k % 5;
    let below = |k: u32| 6 + k % 5;
    let triangles = (0..5).flat_map(|k| {
        [
            [0, around(k), around(k + 1)],
            [around(k), below(k), around(k + 1)],
            [around(k + 1), below(k), below(k + 1)],
            [11, below(k + 1), below(k)],
        ]
    });
    surface("sphere", triangles.collect())
}

pub fn torus(a: u32, b: u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| i % a * b + j % b;
    (0..a)
        .flat_map(|i| (0..b).map(move |j| (i, j)))
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
        .collect()
}

/// Two tori of 4 by 4 squares, joined where both lack a triangle.
pub fn pretzel() -> Arrays {
    let mut triangles = torus(4, 4);
    let [a, b, c] = triangles.remove(0);
    let mut other = torus(4, 4);
    let [d, e, f] = other.remove(0);
    let glued = HashMap::from([(d, a), (e, c), (f, b)]);
    let mut names = HashMap::new();
    for triangle in &mut other {
        for vertex in triangle {
            let count = names.len() as u32;
            *vertex = glued.get(vertex).copied().unwrap_or_else(|| *names.entry(*vertex).or_insert(16 + count));
        }
    }
    triangles.extend(other);
    surface("pretzel", triangles)
}

/// Bundles over surfaces of genus 0, 1 and 2, with several numbers of layers.
pub fn bundles() -> Vec<Arrays> {
    let cases = [
        (icosahedron(), 3),
        (icosahedron(), 5),
        (surface("torus", torus(3, 3)), 3),
        (surface("torus", torus(3, 4)), 4),
        (surface("torus", torus(4, 4)), 7),
        (pretzel(), 3),
        (pretzel(), 6),
    ];
    let with_slopes = |(number, (surface, layers)): (usize, (Arrays, u32))| {
        let characteristic = surface.characteristic();
        surface.with_slopes(layers, characteristic, &mut Random(number as u64))
    };
    cases.into_iter().enumerate().map(with_slopes).collect()
}
