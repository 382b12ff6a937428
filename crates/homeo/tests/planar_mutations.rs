//! Attack on the certificates of composite harmonic maps: each mutation is rejected or proved harmless.
//!
//! A mutation changes a number, an index, a sign or an order, or swaps, drops or doubles an element. What the checker
//! still certifies must be a homeomorphism by an oracle that knows nothing of degrees: triangles are pairwise disjoint,
//! add up to the area, and meet along edges with the same vertices.
#![allow(clippy::print_stdout)]

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use homeo::certificate::{Provenance, write_harmonic};
use homeo::construct::harmonic::{HarmonicParams, harmonic_map};
use homeo::map::{Circuit, HalfParts, HarmonicMap, Middle, SHARE_BITS};
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
    seams: Vec<[u32; 2]>,
    halves: [HalfParts; 2],
}

impl Arrays {
    fn verdict(&self) -> Result<Verdict, homeo_verify::Unreadable> {
        let [source, target] = self.halves.clone();
        let middle = match self.circuit() {
            Some(circuit) if !self.seams.is_empty() => Middle::slit(circuit, self.middle[0].clone()),
            _ => Middle::new(self.middle.clone()),
        };
        let map = HarmonicMap::new(middle, source, target);
        let mut bytes = Cursor::new(Vec::new());
        write_harmonic(&map, &Provenance::default(), &mut bytes).expect("memory can be written");
        verify_bytes(bytes.get_ref())
    }

    fn sizes(&self) -> Vec<usize> {
        self.halves[0].domain.rings().iter().map(Vec::len).collect()
    }

    fn circuit(&self) -> Option<Circuit> {
        Circuit::new(&self.sizes(), &self.seams)
    }
}

fn maps() -> Vec<(&'static str, Arrays)> {
    let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    let arrow = vec![vec![[0.0, 0.0], [1.0, 0.0], [0.3, 0.2], [0.0, 1.0]]];
    let hole = vec![[0.4, 0.4], [0.4, 0.6], [0.6, 0.4]];
    let turned = vec![[0.6, 0.4], [0.4, 0.4], [0.4, 0.6]];
    let with = |hole: &Vec<Point2>| vec![square[0].clone(), hole.clone()];
    let two_holes = |x: f64, y: f64| {
        let moved = |x: f64| [[x, y], [x, y + 0.2], [x + 0.2, y]].to_vec();
        vec![square[0].clone(), moved(x), moved(x + 0.4)]
    };
    let slit = ("two holes", two_holes(0.2, 0.4), two_holes(0.1, 0.3));
    [("polygon", square.clone(), arrow), ("annulus", with(&hole), with(&turned)), slit]
        .map(|(name, source, target)| {
            let pair = DomainPair::new(source, target).expect("a pair");
            let params = HarmonicParams { triangles: 6, ..HarmonicParams::default() };
            let map = harmonic_map(&pair, params, &Silent).expect("a map");
            let halves = [map.source_half().parts().clone(), map.target_half().parts().clone()];
            let seams = map.middle().circuit().map_or_else(Vec::new, |circuit| circuit.seams().to_vec());
            (name, Arrays { middle: map.middle().rings().to_vec(), seams, halves })
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
    for rule in ["H1", "H2", "H3", "H4", "H5", "H6"] {
        let found = counts.get(&format!("refuted by {rule}")).copied().unwrap_or(0);
        assert!(found >= 10, "only {found} mutations fail by {rule}: the test tests little");
    }
    let harmless = counts.get("harmless").copied().unwrap_or(0);
    assert!((100..3 * MUTATIONS / 2).contains(&harmless), "{harmless} are harmless");
}

/// What was changed; nothing if this change is none.
fn mutate(arrays: &mut Arrays, random: &mut Random) -> Option<String> {
    let side = random.below(2);
    let kind = random.below(19);
    if kind > 12 {
        mutate_seams(arrays, side, kind, random)?;
        return Some(format!("kind {kind} on side {side}"));
    }
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

/// Where seams run and what they join.
fn mutate_seams(arrays: &mut Arrays, side: usize, kind: usize, random: &mut Random) -> Option<()> {
    let half = &mut arrays.halves[side];
    let (count, corners) = (half.seam_points.len(), half.domain.vertex_count());
    if count == 0 {
        return None;
    }
    let (a, b) = (random.below(count), random.below(count));
    match kind {
        13 => change(&mut half.seam_points[a], random),
        14 => half.seam_points.swap(a, b),
        15 => match random.below(2) {
            0 => drop(half.seam_points.remove(a)),
            _ => half.seam_points.push(half.seam_points[a]),
        },
        16 => {
            let seam = random.below(arrays.seams.len());
            arrays.seams[seam][random.below(2)] = random.below(corners) as u32;
            // Files with other seams than a tree of them are attacked elsewhere: this library does not write them.
            arrays.circuit()?;
        }
        17 => match random.below(2) {
            0 => arrays.seams.swap(0, 1),
            _ => random.pick(&mut arrays.seams)?.swap(0, 1),
        },
        _ => {
            // Both sides alike: a point takes another share.
            let twins = twins(&arrays.sizes(), &arrays.seams);
            let half = &mut arrays.halves[side];
            let inside: Vec<usize> = (0..half.boundary.len())
                .filter(|&row| half.boundary[row].share > 0 && twins[half.boundary[row].edge as usize].is_some())
                .collect();
            let row = inside[random.below(inside.len())];
            let (share, edge) = (half.boundary[row].share, half.boundary[row].edge);
            let is_twin = |&k: &usize| {
                Some(half.boundary[k].edge as usize) == twins[edge as usize]
                    && half.boundary[k].share + share == 1 << SHARE_BITS
            };
            let twin = inside.iter().copied().find(is_twin)?;
            let new = [share / 2, share + 1, share - 1, 1 << 29][random.below(4)];
            half.boundary[row].share = new;
            half.boundary[twin].share = (1 << SHARE_BITS) - new;
        }
    }
    Some(())
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

/// The sides of the walk along a slit domain: where each begins, and the seam that it follows, if it does, and whether back.
/// Along a ring, and from each end of a seam round what hangs on it.
fn sides(sizes: &[usize], seams: &[[u32; 2]]) -> Vec<(u32, Option<(usize, bool)>)> {
    fn around(
        from: usize,
        sizes: &[usize],
        seams: &[[u32; 2]],
        is_nested: bool,
        out: &mut Vec<(u32, Option<(usize, bool)>)>,
    ) {
        let mut first = 0;
        let ring = sizes.iter().position(|&size| {
            first += size;
            from < first
        });
        let size = sizes[ring.expect("the vertex exists")];
        first -= size;
        for step in 0..size {
            out.push(((first + (from - first + step) % size) as u32, None));
            let to = (first + (from - first + step + 1) % size) as u32;
            let seam = seams.iter().position(|ends| ends.contains(&to));
            if let (Some(seam), false) = (seam, is_nested && step + 1 == size) {
                let is_back = seams[seam][1] == to;
                let other = seams[seam][usize::from(!is_back)];
                out.push((to, Some((seam, is_back))));
                around(other as usize, sizes, seams, true, out);
                out.push((other, Some((seam, !is_back))));
            }
        }
    }
    let mut out = Vec::new();
    around(0, sizes, seams, false, &mut out);
    out
}

/// The other side of the seam of each side.
fn twins(sizes: &[usize], seams: &[[u32; 2]]) -> Vec<Option<usize>> {
    let sides = sides(sizes, seams);
    let twin = |seam: Option<(usize, bool)>| {
        let (number, is_back) = seam?;
        sides.iter().position(|side| side.1 == Some((number, !is_back)))
    };
    sides.iter().map(|side| twin(side.1)).collect()
}

/// Where the points inside seams lie, if both sides list the same.
fn on_seams(half: &HalfParts, sides: &[(u32, Option<(usize, bool)>)]) -> Result<BTreeMap<usize, Exact>, String> {
    let mut listed: BTreeMap<(usize, bool), Vec<(u32, usize)>> = BTreeMap::new();
    for (row, point) in half.boundary.iter().enumerate().filter(|(_, point)| point.share > 0) {
        if let Some((seam, is_back)) = sides[point.edge as usize].1 {
            let share = if is_back { (1 << SHARE_BITS) - point.share } else { point.share };
            listed.entry((seam, is_back)).or_default().push((share, row));
        }
    }
    listed.values_mut().for_each(|points| points.sort_unstable());
    let mut places = BTreeMap::new();
    let mut points = half.seam_points.iter();
    for (key, there) in listed.iter().filter(|(key, _)| !key.1) {
        let back = listed.get(&(key.0, true)).ok_or("a seam has one side")?;
        let shares = |points: &[(u32, usize)]| points.iter().map(|point| point.0).collect::<Vec<_>>();
        if shares(there) != shares(back) {
            return Err("the sides of a seam differ".to_owned());
        }
        for (a, b) in there.iter().zip(back) {
            let place = exact(points.next().ok_or("points are missing")?);
            places.insert(a.1, place.clone());
            places.insert(b.1, place);
        }
    }
    if points.next().is_some() { Err("there are more points".to_owned()) } else { Ok(places) }
}

/// By the oracle: both triangulations tile their domains and the middle, glued alike, also along seams.
fn is_homeomorphism(arrays: &Arrays) -> Result<(), String> {
    let is_cylinder = arrays.middle.len() == 2;
    let is_slit = !arrays.seams.is_empty();
    let middle: Vec<Vec<Exact>> = arrays.middle.iter().map(|ring| ring.iter().map(exact).collect()).collect();
    for half in &arrays.halves {
        let rings: Vec<Vec<Exact>> = half.domain.rings().iter().map(|ring| ring.iter().map(exact).collect()).collect();
        let (mut domain, mut seam) = (rings.clone(), BTreeMap::new());
        if is_slit {
            let sides = sides(&arrays.sizes(), &arrays.seams);
            domain = vec![sides.iter().map(|side| rings.concat()[side.0 as usize].clone()).collect()];
            seam = on_seams(half, &sides)?;
        }
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
            None => seam.get(&(v as usize)).cloned().unwrap_or_else(|| on_edge(&domain, v as usize, false)),
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
        tile(&corners, &area_of(&rings), &[0]).map_err(|what| format!("in the domain {what}"))?;
        // The band between heights 0 and 1 has area 1 for each turn.
        let (area, turns): (Rational, &[i64]) =
            if is_cylinder { (Rational::from(2), &[-2, -1, 0, 1, 2]) } else { (area_of(&middle), &[0]) };
        let together: Vec<[Exact; 3]> =
            images.iter().map(|t| if is_cylinder { in_first_turn(t) } else { t.clone() }).collect();
        tile(&together, &area, turns).map_err(|what| format!("in the middle {what}"))?;
        glued_alike(half, &images, is_cylinder)?;
        if is_slit {
            boundary_is_open(half)?;
        }
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

/// Each point of a slit domain's boundary has an edge to the next that is in one triangle only.
fn boundary_is_open(half: &HalfParts) -> Result<(), String> {
    let edges: BTreeSet<[u32; 2]> = half.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let count = half.boundary.len() as u32;
    let is_open = |v: u32| edges.contains(&[v, (v + 1) % count]) && !edges.contains(&[(v + 1) % count, v]);
    if (0..count).all(is_open) { Ok(()) } else { Err("a part of the boundary is not open".to_owned()) }
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
