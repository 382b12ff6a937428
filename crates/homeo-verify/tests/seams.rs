//! Composite harmonic maps of domains with several holes: what a file must say of seams (rule H6), and of the rest.
//!
//! The domain is a grid without two of its squares, slit open from square to square by hand.
mod support;

use homeo_verify::{Unreadable, Verdict, verify_bytes};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use support::write::{npy, sha256, zip};

type Point = [f64; 2];

/// A grid point; those on seams are there from above and from below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Node {
    x: u32,
    y: u32,
    is_above: bool,
}

const SIZE: [u32; 2] = [7, 5];
/// Left lower corners of the squares that are left out.
const HOLES: [[u32; 2]; 2] = [[1, 2], [5, 2]];
const WHOLE: u32 = 1 << 30;
/// The shares of the two points inside the second seam.
const SHARES: [u32; 2] = [WHOLE / 4, WHOLE / 8 * 5];

#[derive(Clone)]
struct Half {
    points: Vec<Point>,
    boundary: Vec<[u32; 3]>,
    seam_points: Vec<Point>,
    inner: Vec<Point>,
    images: Vec<Point>,
    triangles: Vec<[u32; 3]>,
}

#[derive(Clone)]
struct Arrays {
    target: &'static str,
    sizes: Vec<u32>,
    seams: Vec<[u32; 2]>,
    middle: Vec<Point>,
    halves: [Half; 2],
}

/// Whether a point is on a seam: at height 2 from the left side to the first hole, and from there to the second.
fn is_on_seam(x: u32, y: u32) -> bool {
    y == 2 && x <= 5
}

fn rings() -> Vec<Vec<[u32; 2]>> {
    let [width, height] = SIZE;
    let below = (0..width).map(|x| [x, 0]).chain((0..height).map(|y| [width, y]));
    let above = (1..=width).rev().map(|x| [x, height]).chain((1..=height).rev().map(|y| [0, y]));
    let hole = |[x, y]: [u32; 2]| vec![[x, y], [x, y + 1], [x + 1, y + 1], [x + 1, y]];
    [below.chain(above).collect()].into_iter().chain(HOLES.map(hole)).collect()
}

/// The walk along the slit domain: rows of the boundary and their nodes.
fn walk() -> Vec<([u32; 3], Node)> {
    let rings = rings();
    let mut rows: Vec<(u32, [u32; 2], bool)> = Vec::new();
    let outer = &rings[0];
    let cut = outer.iter().position(|&p| p == [0, 2]).expect("the seam begins there");
    rows.extend(outer[..=cut].iter().map(|&p| (0, p, true)));
    rows.extend(rings[1].iter().map(|&p| (0, p, true)));
    rows.extend([(SHARES[0], [3, 2], true), (SHARES[1], [4, 2], true)]);
    rows.extend(rings[2].iter().map(|&p| (0, p, true)));
    rows.extend([(0, [5, 2], false), (WHOLE - SHARES[1], [4, 2], false), (WHOLE - SHARES[0], [3, 2], false)]);
    rows.extend([(0, [2, 2], false), (0, [1, 2], false), (0, [0, 2], false)]);
    rows.extend(outer[cut + 1..].iter().map(|&p| (0, p, true)));
    let mut side = 0;
    let row = |(k, (share, [x, y], above)): (usize, (u32, [u32; 2], bool))| {
        side += u32::from(share == 0 && k > 0);
        ([0, side, share], Node { x, y, is_above: above || !is_on_seam(x, y) })
    };
    rows.into_iter().enumerate().map(row).collect()
}

/// The triangles of all squares but the holes, as nodes.
fn triangles() -> Vec<[Node; 3]> {
    let squares = (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| [x, y])).filter(|square| !HOLES.contains(square));
    let in_square = |[x, y]: [u32; 2]| {
        let node = |dx: u32, dy: u32| Node { x: x + dx, y: y + dy, is_above: y >= 2 || !is_on_seam(x + dx, y + dy) };
        [[node(0, 0), node(1, 0), node(1, 1)], [node(0, 0), node(1, 1), node(0, 1)]]
    };
    squares.flat_map(in_square).collect()
}

/// Averages of neighbours, by repeated averaging.
fn flattened(fixed: &[Point], count: usize, triangles: &[[u32; 3]]) -> Vec<Point> {
    let mut neighbours = vec![BTreeSet::new(); fixed.len() + count];
    for corners in triangles {
        (0..3).for_each(|k| neighbours[corners[k] as usize].extend(corners.map(|v| v as usize)));
    }
    let mut images = fixed.to_vec();
    images.resize(fixed.len() + count, [0.0; 2]);
    for _ in 0..2000 {
        for v in fixed.len()..images.len() {
            let others: Vec<Point> = neighbours[v].iter().filter(|&&u| u != v).map(|&u| images[u]).collect();
            images[v] = [0, 1].map(|k| others.iter().map(|p| p[k]).sum::<f64>() / others.len() as f64);
        }
    }
    images.split_off(fixed.len())
}

/// From the grid onto a sheared one.
fn two_holes() -> Arrays {
    let walk = walk();
    let sides = walk.iter().filter(|row| row.0[2] == 0).count();
    let corner = |k: usize| [(TAU * k as f64 / sides as f64).cos(), (TAU * k as f64 / sides as f64).sin()];
    let middle: Vec<Point> = (0..sides).map(corner).collect();
    let fixed: Vec<Point> = walk
        .iter()
        .map(|&([_, side, share], _)| {
            let (a, b) = (middle[side as usize], middle[(side as usize + 1) % sides]);
            [0, 1].map(|k| a[k] + (b[k] - a[k]) * f64::from(share) / f64::from(WHOLE))
        })
        .collect();
    let mut numbers: BTreeMap<Node, u32> = walk.iter().zip(0..).map(|(row, number)| (row.1, number)).collect();
    let inner: Vec<Node> = triangles().concat().into_iter().collect::<BTreeSet<Node>>().into_iter().collect();
    let inner: Vec<Node> = inner.into_iter().filter(|node| !numbers.contains_key(node)).collect();
    numbers.extend(inner.iter().zip(walk.len() as u32..).map(|(&node, number)| (node, number)));
    let triangles: Vec<[u32; 3]> = triangles().iter().map(|corners| corners.map(|node| numbers[&node])).collect();
    let images = flattened(&fixed, inner.len(), &triangles);
    let half = |place: &dyn Fn(u32, u32) -> Point| Half {
        points: rings().concat().iter().map(|&[x, y]| place(x, y)).collect(),
        boundary: walk.iter().map(|row| row.0).collect(),
        seam_points: vec![place(3, 2), place(4, 2)],
        inner: inner.iter().map(|node| place(node.x, node.y)).collect(),
        images: images.clone(),
        triangles: triangles.clone(),
    };
    let plain = |x: u32, y: u32| [f64::from(x), f64::from(y)];
    let sheared = |x: u32, y: u32| [f64::from(x) + 0.25 * f64::from(y), f64::from(y) - 0.125 * f64::from(x)];
    let vertex = |p: [u32; 2]| rings().concat().iter().position(|&q| q == p).expect("a vertex") as u32;
    Arrays {
        target: "domain",
        sizes: rings().iter().map(|ring| ring.len() as u32).collect(),
        seams: vec![[vertex([0, 2]), vertex([1, 2])], [vertex([2, 2]), vertex([5, 2])]],
        middle,
        halves: [half(&plain), half(&sheared)],
    }
}

impl Arrays {
    fn verdict(&self) -> Result<Verdict, Unreadable> {
        verify_bytes(&zip(&self.entries()))
    }

    fn entries(&self) -> Vec<(String, Vec<u8>)> {
        let floats = |points: &[Point]| points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let numbers = |numbers: &[u32]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
        let source = &self.halves[0].points;
        let counts = [source.len() as u64, 2, self.sizes.len() as u64];
        let mut hashed: Vec<u8> = counts.iter().flat_map(|x| x.to_le_bytes()).collect();
        hashed.extend(floats(source));
        hashed.extend(numbers(&self.sizes));
        let manifest = json!({
            "format": "homeo", "version": 1, "kind": "composite-harmonic", "dimension": 2, "target": self.target,
            "centre": null,
            "source": {"vertices": source.len(), "cells": self.sizes.len(), "content_sha256": sha256(&hashed)},
        });
        let mut entries = vec![("manifest.json".to_owned(), manifest.to_string().into_bytes())];
        let mut add = |name: &str, kind: &str, shape: String, content: Vec<u8>| {
            entries.push((format!("{name}.npy"), npy(kind, &shape, &content)));
        };
        add("source_rings", "<u4", format!("({},)", self.sizes.len()), numbers(&self.sizes));
        add("seams", "<u4", format!("({}, 2)", self.seams.len()), numbers(self.seams.as_flattened()));
        add("middle_points", "<f8", format!("({}, 2)", self.middle.len()), floats(&self.middle));
        for (name, half) in ["source", "target"].into_iter().zip(&self.halves) {
            for (what, points) in [
                ("points", &half.points),
                ("seam_points", &half.seam_points),
                ("inner", &half.inner),
                ("images", &half.images),
            ] {
                add(&format!("{name}_{what}"), "<f8", format!("({}, 2)", points.len()), floats(points));
            }
            for (what, rows) in [("boundary", &half.boundary), ("triangles", &half.triangles)] {
                add(&format!("{name}_{what}"), "<u4", format!("({}, 3)", rows.len()), numbers(rows.as_flattened()));
            }
        }
        entries
    }
}

/// By which rule a changed map is refuted; `certified` or `unreadable` otherwise.
fn outcome(change: impl Fn(&mut Arrays)) -> &'static str {
    let mut arrays = two_holes();
    change(&mut arrays);
    match arrays.verdict() {
        Ok(Verdict::Certified(_)) => "certified",
        Ok(Verdict::Refuted(witness)) => witness.rule,
        Ok(Verdict::Undecided(_)) => "undecided",
        Err(_) => "unreadable",
    }
}

/// The row of a share on the forward or the backward side of the second seam.
fn row(half: &Half, share: u32) -> usize {
    half.boundary.iter().position(|row| row[2] == share).expect("a point inside a seam")
}

#[test]
fn a_slit_domain_is_certified() {
    match two_holes().verdict() {
        Ok(Verdict::Certified(claim)) => {
            assert_eq!((claim.kind.as_str(), claim.target.as_str()), ("composite-harmonic", "domain"));
            assert!(
                claim.statement.contains("in 3 ring(s)") && claim.statement.contains("H1-H6"),
                "{}",
                claim.statement
            );
            assert!(
                claim.checked.iter().any(|(what, count)| what.contains("H6") && *count == 4),
                "{:?}",
                claim.checked
            );
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn both_sides_of_a_seam_have_the_same_points() {
    for side in [0, 1] {
        for share in [SHARES[0], SHARES[1], WHOLE - SHARES[0], WHOLE - SHARES[1]] {
            for new in [share + 1, share - 1] {
                // On one side only, and on both.
                let one = |half: &mut Half, share: u32, new: u32| {
                    let row = row(half, share);
                    half.boundary[row][2] = new;
                };
                assert_eq!(outcome(|a| one(&mut a.halves[side], share, new)), "H6");
                let both = |a: &mut Arrays| {
                    one(&mut a.halves[side], share, new);
                    one(&mut a.halves[side], WHOLE - share, WHOLE - new);
                };
                assert_eq!(outcome(both), "certified");
            }
        }
        assert_eq!(outcome(|a| a.halves[side].seam_points.truncate(1)), "H6");
        assert_eq!(outcome(|a| a.halves[side].seam_points.push([3.5, 2.0])), "H6");
        assert_eq!(outcome(|a| a.halves[side].seam_points[0][1] = f64::NAN), "H2");
    }
}

#[test]
fn seam_points_lie_where_triangles_are_positive() {
    for side in [0, 1] {
        // A seam may run anywhere as long as triangles are positive.
        assert_eq!(outcome(|a| a.halves[side].seam_points[0][1] += 0.25), "certified");
        assert_eq!(outcome(|a| a.halves[side].seam_points[0][1] += 1.25), "H4");
        assert_eq!(outcome(|a| a.halves[side].seam_points.swap(0, 1)), "H4");
        assert_eq!(outcome(|a| a.halves[side].seam_points[1] = a.halves[side].points[0]), "H4");
    }
}

#[test]
fn seams_join_the_rings_as_a_tree() {
    let [[a, b], [c, d]] = two_holes().seams[..] else { panic!("two seams") };
    for (seams, expected) in [
        // The order of seams does not matter, nor the direction of one without points.
        (vec![[c, d], [a, b]], "certified"),
        (vec![[b, a], [c, d]], "certified"),
        // Its points come in its direction.
        (vec![[a, b], [d, c]], "H4"),
        // Two seams at a vertex; a seam to itself; a vertex that does not exist.
        (vec![[a, b], [b, d]], "H6"),
        (vec![[a, b], [a, d]], "H6"),
        (vec![[a, b], [c, c]], "H6"),
        (vec![[a, b], [c, 99]], "H6"),
        (vec![[u32::MAX, b], [c, d]], "H6"),
        // Within a ring; the same rings twice.
        (vec![[0, 5], [c, d]], "H6"),
        (vec![[a, b], [0, c]], "H6"),
        // A tree with other ends: points are not on the sides of seams any more, or triangles not where they were.
        (vec![[a + 1, b], [c, d]], "H6"),
        (vec![[a, b], [c, d + 1]], "H4"),
        // Other numbers of seams than the middle has corners for.
        (vec![[a, b]], "unreadable"),
        (vec![], "unreadable"),
        (vec![[a, b], [c, d], [0, d + 2]], "unreadable"),
    ] {
        let found = outcome(|arrays| arrays.seams.clone_from(&seams));
        assert_eq!(found, expected, "{seams:?}");
    }
    // Without seams, and with as many corners of the middle.
    let unslit = |a: &mut Arrays| {
        a.seams.clear();
        a.middle.truncate(a.halves[0].points.len());
    };
    assert_eq!(outcome(unslit), "H6");
    for target in ["polygon", "annulus", "disk"] {
        assert_eq!(outcome(|a| a.target = target), "unreadable", "{target}");
    }
    for gone in ["seams.npy", "source_seam_points.npy", "target_seam_points.npy"] {
        let entries: Vec<_> = two_holes().entries().into_iter().filter(|entry| entry.0 != gone).collect();
        assert!(verify_bytes(&zip(&entries)).is_err(), "without {gone}");
    }
}

#[test]
fn triangles_are_glued_along_the_walk() {
    for side in [0, 1] {
        // A triangle takes the copy of a seam's point on the wrong side: same place, another point of the middle.
        let torn = |a: &mut Arrays| {
            let half = &mut a.halves[side];
            let [above, below] = [SHARES[0], WHOLE - SHARES[0]].map(|share| row(half, share) as u32);
            let corner = half.triangles.as_flattened_mut().iter_mut().find(|v| **v == above).expect("it has a corner");
            *corner = below;
        };
        assert_eq!(outcome(torn), "H3");
        // All of them do: the two copies change their names.
        let exchanged = |a: &mut Arrays| {
            let half = &mut a.halves[side];
            let [above, below] = [SHARES[0], WHOLE - SHARES[0]].map(|share| row(half, share) as u32);
            for v in half.triangles.as_flattened_mut() {
                *v = if *v == above {
                    below
                } else if *v == below {
                    above
                } else {
                    *v
                };
            }
        };
        assert_eq!(outcome(exchanged), "H3");
        assert_eq!(outcome(|a| a.halves[side].triangles[3].swap(0, 1)), "H3");
        assert_eq!(outcome(|a| a.halves[side].triangles.truncate(9)), "H3");
        assert_eq!(outcome(|a| a.halves[side].images.swap(0, 1)), "H5");
        assert_eq!(outcome(|a| a.halves[side].inner.swap(0, 1)), "H4");
        assert_eq!(outcome(|a| a.halves[side].boundary.swap(4, 5)), "H2");
    }
    assert_eq!(outcome(|a| a.middle.swap(4, 5)), "D");
    assert_eq!(outcome(|a| a.middle[7][0] = f64::INFINITY), "H1");
}
