//! Attack on the certificates of composite harmonic maps: each mutation is rejected or proved harmless.
//!
//! A mutation changes a number, an index, a sign or an order, or swaps, drops or doubles an element. What the checker
//! still certifies must be a homeomorphism by an oracle that knows nothing of degrees: triangles are pairwise disjoint,
//! add up to the area, and meet along edges with the same vertices.
#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::io::Cursor;

use homeo::certificate::{Provenance, write_harmonic};
use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
use homeo::map::{HalfParts, HarmonicMap, Middle, SHARE_BITS};
use homeo::progress::Silent;
use homeo_core::number::Rational;
use homeo_core::planar::{DomainPair, Point2};
use homeo_core::predicate::Sign;
use homeo_verify::{Verdict, verify_bytes};

const MUTATIONS: usize = 1_500;

/// The arrays of a map, free to be wrong.
#[derive(Clone)]
struct Arrays {
    middle: Vec<Vec<Point2>>,
    halves: [HalfParts; 2],
}

impl Arrays {
    fn verdict(&self) -> Result<Verdict, homeo_verify::Unreadable> {
        let [source, target] = self.halves.clone();
        let map = HarmonicMap::new(Middle::new(self.middle.clone()), source, target);
        let mut bytes = Cursor::new(Vec::new());
        write_harmonic(&map, &Provenance::default(), &mut bytes).expect("memory can be written");
        verify_bytes(bytes.get_ref())
    }
}

fn maps() -> Vec<(&'static str, Arrays)> {
    let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.3, 0.2], [0.0, 1.0]]];
    let hole = vec![[0.4, 0.4], [0.4, 0.6], [0.6, 0.4]];
    let turned = vec![[0.6, 0.4], [0.4, 0.4], [0.4, 0.6]];
    let with = |hole: &Vec<Point2>| vec![square[0].clone(), hole.clone()];
    [("polygon", square.clone(), arrow), ("annulus", with(&hole), with(&turned))]
        .map(|(name, source, target)| {
            let pair = DomainPair::new(source, target).expect("a pair");
            let params = HarmonicParams { triangles: 6, ..HarmonicParams::default() };
            let map = harmonic_map(&pair, params, &Silent).expect("a map");
            let halves = [map.source_half().parts().clone(), map.target_half().parts().clone()];
            (name, Arrays { middle: map.middle().rings().to_vec(), halves })
        })
        .into()
}

#[test]
fn every_mutation_is_rejected_or_harmless() {
    let mut counts = BTreeMap::<String, usize>::new();
    for (name, valid) in maps() {
        assert!(matches!(valid.verdict(), Ok(Verdict::Certified(_))), "{name} is valid to begin with");
        is_homeomorphism(&valid).unwrap_or_else(|what| panic!("{name} is valid to begin with: {what}"));
        let mut random = Random(11);
        let mut done = 0;
        while done < MUTATIONS {
            let mut mutant = valid.clone();
            let Some(what) = mutate(&mut mutant, &mut random) else { continue };
            done += 1;
            let outcome = match mutant.verdict() {
                Err(_) => "unreadable".to_owned(),
                Ok(Verdict::Refuted(witness)) => format!("refuted by {}", witness.rule),
                Ok(Verdict::Undecided(_)) => "undecided".to_owned(),
                Ok(Verdict::Certified(_)) => match is_homeomorphism(&mutant) {
                    Ok(()) => "harmless".to_owned(),
                    Err(problem) => panic!("{name}: {what} was certified although {problem}"),
                },
            };
            *counts.entry(outcome).or_default() += 1;
        }
    }
    counts.iter().for_each(|(outcome, count)| println!("{count:>6} {outcome}"));
    for rule in ["H1", "H2", "H3", "H4", "H5"] {
        let found = counts.get(&format!("refuted by {rule}")).copied().unwrap_or(0);
        assert!(found >= 10, "only {found} mutations fail by {rule}: the test tests little");
    }
    let harmless = counts.get("harmless").copied().unwrap_or(0);
    assert!((100..2 * MUTATIONS).contains(&harmless), "{harmless} are harmless");
}

/// What was changed; nothing if this change is none.
fn mutate(arrays: &mut Arrays, random: &mut Random) -> Option<String> {
    let side = random.below(2);
    let kind = random.below(13);
    let half = &mut arrays.halves[side];
    let rows = half.triangles.len();
    let (t, u, corner) = (random.below(rows), random.below(rows), random.below(3));
    match kind {
        0 => change(random.pick(&mut half.inner)?, random),
        1 => change(random.pick(&mut half.images)?, random),
        2 => {
            let ring = random.below(arrays.middle.len());
            change(random.pick(&mut arrays.middle[ring])?, random);
        }
        3 => half.triangles[t][corner] = random.below(half.boundary.len() + half.inner.len()) as u32,
        4 => half.triangles[t].swap(corner, (corner + 1) % 3),
        5 => half.triangles.swap(t, u), // without the shifts: on a cylinder they belong to their triangles
        6 => {
            half.triangles.remove(t);
            if !half.shifts.is_empty() {
                half.shifts.remove(t);
            }
        }
        7 => {
            half.triangles.push(half.triangles[t]);
            if !half.shifts.is_empty() {
                half.shifts.push(half.shifts[t]);
            }
        }
        8 => {
            let row = random.below(half.boundary.len());
            let share = &mut half.boundary[row].share;
            *share = [0, *share / 2, *share + 1, (1 << SHARE_BITS) - 1, 1 << 29][random.below(5)];
        }
        9 => {
            let (a, b) = (random.below(half.boundary.len()), random.below(half.boundary.len()));
            half.boundary.swap(a, b);
        }
        10 => {
            let shift = half.shifts.get_mut(t)?;
            shift[corner] += if random.below(2) == 0 { 1 } else { -1 };
        }
        11 => {
            // A whole triangle a turn further: the same map.
            let shift = half.shifts.get_mut(t)?;
            shift.iter_mut().for_each(|s| *s += 1);
        }
        _ => {
            let (a, b) = (random.below(half.images.len().max(1)), random.below(half.images.len().max(1)));
            if a >= half.images.len() || b >= half.images.len() {
                return None;
            }
            half.images.swap(a, b);
        }
    }
    Some(format!("kind {kind} on side {side}, triangle {t}"))
}

/// A little, a lot, or a sign.
fn change(point: &mut Point2, random: &mut Random) {
    let axis = random.below(2);
    point[axis] = match random.below(5) {
        0 => -point[axis],
        1 => point[axis] + 1.0,
        2 => point[axis] * 1.01,
        3 => f64::from_bits(point[axis].to_bits() ^ 1 << random.below(64)),
        _ => point[axis] + 0.2,
    };
}

type Exact = [Rational; 2];

/// By the oracle: both triangulations tile their domains and the middle, glued alike.
fn is_homeomorphism(arrays: &Arrays) -> Result<(), String> {
    let is_cylinder = arrays.middle.len() == 2;
    let middle: Vec<Vec<Exact>> = arrays.middle.iter().map(|ring| ring.iter().map(exact).collect()).collect();
    for half in &arrays.halves {
        let domain: Vec<Vec<Exact>> = half.domain.rings().iter().map(|ring| ring.iter().map(exact).collect()).collect();
        let on_edge = |rings: &[Vec<Exact>], k: usize, advance: bool| {
            let point = half.boundary[k];
            let ring = &rings[point.ring as usize];
            let (a, mut b) = (ring[point.edge as usize].clone(), ring[(point.edge as usize + 1) % ring.len()].clone());
            if advance && point.edge as usize + 1 == ring.len() {
                b[0] = &b[0] + &Rational::from(if point.ring == 0 { 1 } else { -1 });
            }
            let share = &Rational::from(i64::from(point.share)) / &Rational::from(1i64 << SHARE_BITS);
            [0, 1].map(|axis| &a[axis] + &(&share * &(&b[axis] - &a[axis])))
        };
        let place = |v: u32| match (v as usize).checked_sub(half.boundary.len()) {
            Some(inner) => exact(&half.inner[inner]),
            None => on_edge(&domain, v as usize, false),
        };
        let image = |t: usize, k: usize| {
            let v = half.triangles[t][k] as usize;
            let mut point = match v.checked_sub(half.boundary.len()) {
                Some(inner) => exact(&half.images[inner]),
                None => on_edge(&middle, v, is_cylinder),
            };
            if is_cylinder {
                point[0] = &point[0] + &Rational::from(i64::from(half.shifts[t][k]));
            }
            point
        };
        let corners: Vec<[Exact; 3]> = half.triangles.iter().map(|t| t.map(place)).collect();
        let images: Vec<[Exact; 3]> = (0..corners.len()).map(|t| [0, 1, 2].map(|k| image(t, k))).collect();
        tile(&corners, &area_of(&domain), &[0]).map_err(|what| format!("in the domain {what}"))?;
        // The band between heights 0 and 1 has area 1 for each turn.
        let (area, turns): (Rational, &[i64]) =
            if is_cylinder { (Rational::from(2), &[-2, -1, 0, 1, 2]) } else { (area_of(&middle), &[0]) };
        let together: Vec<[Exact; 3]> =
            images.iter().map(|t| if is_cylinder { in_first_turn(t) } else { t.clone() }).collect();
        tile(&together, &area, turns).map_err(|what| format!("in the middle {what}"))?;
        glued_alike(half, &images, is_cylinder)?;
    }
    Ok(())
}

fn exact(point: &Point2) -> Exact {
    point.map(|x| Rational::from_f64(x).expect("finite"))
}

fn cross(a: &Exact, b: &Exact, c: &Exact) -> Rational {
    let step = |p: &Exact, axis: usize| &p[axis] - &a[axis];
    &(&step(b, 0) * &step(c, 1)) - &(&step(b, 1) * &step(c, 0))
}

/// Twice the area that rings bound.
fn area_of(rings: &[Vec<Exact>]) -> Rational {
    let origin = [Rational::ZERO, Rational::ZERO];
    let edges = rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| (&ring[i], &ring[(i + 1) % ring.len()])));
    edges.map(|(a, b)| cross(&origin, a, b)).sum()
}

/// A triangle moved by whole turns so that its first corner lies in the first one.
fn in_first_turn(triangle: &[Exact; 3]) -> [Exact; 3] {
    let turn = Rational::from(triangle[0][0].to_f64().floor() as i64);
    triangle.clone().map(|[x, y]| [&x - &turn, y])
}

/// Triangles are positive, disjoint (also when moved by turns), and add up to twice the area.
fn tile(triangles: &[[Exact; 3]], double_area: &Rational, turns: &[i64]) -> Result<(), String> {
    let areas: Vec<Rational> = triangles.iter().map(|[a, b, c]| cross(a, b, c)).collect();
    if let Some(t) = areas.iter().position(|area| area.sign() != Sign::Positive) {
        return Err(format!("triangle {t} is not positive"));
    }
    if areas.iter().cloned().sum::<Rational>() != *double_area {
        return Err("the triangles do not add up to the area".to_owned());
    }
    for (i, first) in triangles.iter().enumerate() {
        for (j, second) in triangles.iter().enumerate().skip(i) {
            for &turn in turns.iter().filter(|&&turn| i != j || turn != 0) {
                let moved = second.clone().map(|[x, y]| [&x + &Rational::from(turn), y]);
                if overlap(first, &moved) {
                    return Err(format!("triangles {i} and {j} overlap"));
                }
            }
        }
    }
    Ok(())
}

/// Whether the insides of two positive triangles meet: no edge of either has the other on its right.
fn overlap(first: &[Exact; 3], second: &[Exact; 3]) -> bool {
    let separates = |one: &[Exact; 3], other: &[Exact; 3]| {
        (0..3).any(|k| other.iter().all(|p| cross(&one[k], &one[(k + 1) % 3], p).sign() != Sign::Positive))
    };
    !separates(first, second) && !separates(second, first)
}

/// Triangles with an edge in common in the domain have the same vertices there, and images with it in common too, up to
/// one turn for both ends.
fn glued_alike(half: &HalfParts, images: &[[Exact; 3]], is_cylinder: bool) -> Result<(), String> {
    let mut edges = BTreeMap::new();
    for (t, corners) in half.triangles.iter().enumerate() {
        for k in 0..3 {
            if edges.insert([corners[k], corners[(k + 1) % 3]], (t, k)).is_some() {
                return Err("two triangles use an edge alike".to_owned());
            }
        }
    }
    let mut open = 0;
    for (&[a, b], &(t, k)) in &edges {
        let Some(&(u, l)) = edges.get(&[b, a]) else {
            open += 1;
            continue;
        };
        let here = [&images[t][k], &images[t][(k + 1) % 3]];
        let there = [&images[u][(l + 1) % 3], &images[u][l]];
        let turns = [0, 1].map(|end| &here[end][0] - &there[end][0]);
        let same_height = (0..2).all(|end| here[end][1] == there[end][1]);
        if turns[0] != turns[1] || !same_height || !is_cylinder && !turns[0].is_zero() {
            return Err("an edge has two images".to_owned());
        }
    }
    // Disjoint triangles that fill the domain and share all but so many edges: those lie on the boundary.
    if open == half.boundary.len() { Ok(()) } else { Err(format!("{open} edges have one triangle")) }
}

/// Splitmix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn pick<'a, T>(&mut self, from: &'a mut [T]) -> Option<&'a mut T> {
        let n = from.len();
        if n == 0 { None } else { from.get_mut(self.below(n)) }
    }
}
