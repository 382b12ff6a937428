//! Sections of unit tangent bundles: random ones with random paths are certified, and mutations are refuted exactly where an
//! oracle finds a flaw. It knows nothing of tetrahedra: edges and turns are those of the slopes.
#![allow(clippy::print_stdout)]

mod support;

use homeo_verify::Verdict;
use std::collections::{BTreeMap, HashMap};
use support::bundles::{Arrays, SectionArrays, bundles, sides};
use support::random::Random;

/// Of each section.
const MUTATIONS: usize = 200;

/// Twice what a step turns by, over a triangle, in levels: along a fibre by one, along an edge of slope `m` or `m + 1` by half a
/// level down or up; nothing where the two are not joined.
fn turn(arrays: &Arrays, triangle: usize, [a, b]: [u32; 2]) -> Option<i64> {
    let (n, corners) = (arrays.layers, arrays.triangles[triangle]);
    let corner = |vertex: u32| corners.iter().position(|&corner| corner == vertex / n);
    let (i, j) = (corner(a)?, corner(b)?);
    let rise = |from: u32, to: u32| (to % n + n - from % n) % n;
    let across = |a, b, slope| match (rise(a, b) + n - slope) % n {
        0 => Some(-1),
        1 => Some(1),
        _ => None,
    };
    match (j + 3 - i) % 3 {
        0 if rise(a, b) == 1 => Some(2),
        0 if rise(b, a) == 1 => Some(-2),
        0 => None,
        1 => across(a, b, arrays.slopes[triangle][i]),
        _ => across(b, a, arrays.slopes[triangle][j]).map(|turn| -turn),
    }
}

/// The indices of triangles and vertices by theorem 3, or what is wrong with levels and paths.
fn indices(arrays: &Arrays, section: &SectionArrays) -> Result<(Vec<i64>, Vec<i64>), String> {
    let n = arrays.layers;
    if section.levels.iter().any(|&level| level > n) || section.excess.iter().any(|&excess| excess != 0) {
        return Err("there is no such level, or lengths are wrong".to_owned());
    }
    let start = |vertex: u32| Some(section.levels[vertex as usize]).filter(|&level| level < n).map(|l| vertex * n + l);
    let sides = sides(&arrays.triangles);
    let mut turns = HashMap::new();
    for path in &section.paths {
        let (Some(first), Some(last)) = (path.first(), path.last()) else { return Err("an empty path".to_owned()) };
        let ends = [first / n, last / n];
        let Some(&(triangle, _)) = sides.get(&ends) else { return Err("over no edge".to_owned()) };
        if ends[0] > ends[1] || path.iter().any(|vertex| !ends.contains(&(vertex / n))) {
            return Err("not over its edge, or backwards".to_owned());
        }
        if start(ends[0]) != Some(*first) || start(ends[1]) != Some(*last) {
            return Err("it ends elsewhere".to_owned());
        }
        let sum: Option<i64> = path.windows(2).map(|step| turn(arrays, triangle, [step[0], step[1]])).sum();
        let Some(sum) = sum else { return Err("a step along no edge".to_owned()) };
        if turns.insert(ends, sum).is_some() {
            return Err("an edge has two paths".to_owned());
        }
    }
    let (mut of_triangles, mut of_vertices) = (vec![0; arrays.triangles.len()], vec![0; arrays.vertices]);
    for (triangle, corners) in arrays.triangles.iter().enumerate() {
        let twice: u32 = 2 * arrays.slopes[triangle].iter().sum::<u32>() + 3;
        // Twice the sum of slopes and halves: 1 or -1 modulo twice the layers.
        let mut sum = if twice % (2 * n) == 1 { 1 } else { -1 };
        let mut missed = None;
        for k in 0..3 {
            let [a, b] = [corners[k], corners[(k + 1) % 3]];
            match (start(a), start(b)) {
                (None, None) => return Err("neighbours without a level".to_owned()),
                (None, _) => missed = Some(a),
                (_, None) => {}
                _ => match (turns.get(&[a, b]), turns.get(&[b, a])) {
                    (Some(turn), _) => sum += turn,
                    (_, Some(turn)) => sum -= turn,
                    _ => return Err("an edge has no path".to_owned()),
                },
            }
        }
        match missed {
            Some(vertex) => of_vertices[vertex as usize] += sum,
            None => of_triangles[triangle] = sum,
        }
    }
    let whole = |sums: Vec<i64>| -> Result<Vec<i64>, String> {
        let twice = 2 * i64::from(n);
        sums.into_iter().map(|sum| if sum % twice == 0 { Ok(sum / twice) } else { Err("no turn".to_owned()) }).collect()
    };
    Ok((whole(of_triangles)?, whole(of_vertices)?))
}

fn flaw(arrays: &Arrays) -> Option<String> {
    let section = arrays.section.as_ref()?;
    match indices(arrays, section) {
        Err(flaw) => Some(flaw),
        Ok((triangles, vertices)) => {
            let is_stated = triangles == section.triangle_indices && vertices == section.vertex_indices;
            (!is_stated).then(|| "other indices".to_owned())
        }
    }
}

/// A path between two levels over an edge of a triangle that goes up and down fibres and across, at random.
fn path(arrays: &Arrays, triangle: usize, [from, to]: [u32; 2], random: &mut Random) -> Vec<u32> {
    let n = arrays.layers;
    let mut path = vec![from];
    let walk = |path: &mut Vec<u32>, steps: usize, is_up: bool| {
        for _ in 0..steps {
            let here = path[path.len() - 1];
            path.push(here / n * n + (here + if is_up { 1 } else { n - 1 }) % n);
        }
    };
    let crossings = if random.below(4) == 0 { 3 } else { 1 };
    for crossing in 0..crossings {
        let (steps, is_up) = (random.below(n as usize), random.below(2) == 0);
        walk(&mut path, steps, is_up);
        let (here, other) = (path[path.len() - 1], [to, from][crossing % 2] / n);
        let joined: Vec<u32> =
            (other * n..(other + 1) * n).filter(|&v| turn(arrays, triangle, [here, v]).is_some()).collect();
        path.push(*random.pick(&joined));
    }
    let is_up = random.below(2) == 0;
    let here = path[path.len() - 1];
    let steps = if is_up { (to % n + n - here % n) % n } else { (here % n + n - to % n) % n };
    let rounds = if random.below(5) == 0 { n } else { 0 };
    walk(&mut path, (steps + rounds) as usize, is_up);
    path
}

/// The bundle with random levels, none at some vertices that are no neighbours, random paths and their indices.
fn with_section(mut arrays: Arrays, random: &mut Random) -> Arrays {
    let (n, sides) = (arrays.layers, sides(&arrays.triangles));
    let mut levels: Vec<u32> = (0..arrays.vertices).map(|_| random.below(n as usize) as u32).collect();
    for vertex in 0..arrays.vertices as u32 {
        let is_alone = sides.keys().filter(|[a, _]| *a == vertex).all(|[_, b]| levels[*b as usize] < n);
        if is_alone && random.below(5) == 0 {
            levels[vertex as usize] = n;
        }
    }
    let mut edges: Vec<[u32; 2]> = sides.keys().filter(|[a, b]| a < b).copied().collect();
    edges.sort_unstable();
    edges.retain(|edge| edge.iter().all(|&v| levels[v as usize] < n));
    let paths: Vec<Vec<u32>> = (edges.iter())
        .map(|edge| path(&arrays, sides[edge].0, edge.map(|v| v * n + levels[v as usize]), random))
        .collect();
    let mut section = SectionArrays { levels, excess: vec![0; paths.len()], paths, ..SectionArrays::default() };
    (section.triangle_indices, section.vertex_indices) = indices(&arrays, &section).unwrap();
    arrays.section = Some(section);
    arrays
}

fn sections() -> Vec<Arrays> {
    let with = |(number, arrays): (u64, Arrays)| {
        (0..3).map(|more| with_section(arrays.clone(), &mut Random(10 * number + more))).collect::<Vec<_>>()
    };
    (0..).zip(bundles()).flat_map(with).collect()
}

#[test]
fn true_sections_are_certified() {
    let (mut missed, mut singular, mut most) = (0, 0, 0);
    for arrays in sections() {
        let section = arrays.section.clone().unwrap();
        match arrays.verdict() {
            Ok(Verdict::Certified(claim)) => {
                assert_eq!(claim.target, "unit-tangent-bundle-with-section");
                assert!(claim.statement.contains("T1-T10") && claim.checked.iter().all(|(_, count)| *count > 0));
            }
            other => panic!("{} with {} layers: {other:?}", arrays.name, arrays.layers),
        }
        let all = section.triangle_indices.iter().chain(&section.vertex_indices);
        assert_eq!(all.clone().sum::<i64>(), arrays.characteristic());
        missed += section.levels.iter().filter(|&&level| level == arrays.layers).count();
        singular += all.clone().filter(|index| **index != 0).count();
        most = most.max(all.map(|index| index.abs()).max().unwrap());
    }
    assert!(missed > 30 && singular > 200 && most >= 2, "{missed}, {singular}, {most}");
}

#[test]
fn arrays_of_other_lengths_are_unreadable() {
    let mut arrays = sections().remove(0);
    arrays.section.as_mut().unwrap().levels.pop();
    assert!(arrays.verdict().unwrap_err().message.contains("section_levels"));
}

#[test]
fn mutations_are_refuted_where_the_oracle_finds_a_flaw() {
    let mut counts = BTreeMap::<String, usize>::new();
    for (number, valid) in sections().into_iter().enumerate() {
        let mut random = Random(900 + number as u64);
        for _ in 0..MUTATIONS {
            let mut mutant = valid.clone();
            let what = mutate(&mut mutant, &mut random);
            let outcome = match (mutant.verdict(), flaw(&mutant)) {
                (Ok(Verdict::Refuted(witness)), Some(_)) => format!("refuted by {}", witness.rule),
                (Ok(Verdict::Certified(_)), None) => "harmless".to_owned(),
                (verdict, flaw) => panic!("{}: {what} is {verdict:?}, but {flaw:?}", valid.name),
            };
            *counts.entry(outcome).or_default() += 1;
        }
    }
    counts.iter().for_each(|(outcome, count)| println!("{count:>6} {outcome}"));
    for outcome in ["refuted by T9", "refuted by T10", "harmless"] {
        let found = counts.get(outcome).copied().unwrap_or(0);
        assert!(found >= 300, "only {found} mutations are {outcome}: the test tests little");
    }
    assert_eq!(counts.len(), 3, "{counts:?}");
}

/// Changes something of the section, and says what.
fn mutate(arrays: &mut Arrays, random: &mut Random) -> String {
    let n = arrays.layers;
    let whole = arrays.clone();
    let each = 3 * n as usize;
    let tetrahedra = &mut arrays.tetrahedra;
    let section = arrays.section.as_mut().unwrap();
    let (vertex, triangle) = (random.below(section.levels.len()), random.below(section.triangle_indices.len()));
    let (number, other) = (random.below(section.paths.len()), random.below(section.paths.len()));
    let place = random.below(section.paths[number].len());
    let kind = random.below(18);
    let round = |path: &mut Vec<u32>| {
        let end = path[path.len() - 1];
        path.extend((1..=n).map(|step| end / n * n + (end + step) % n));
    };
    match kind {
        0 => section.levels[vertex] = random.below(n as usize + 2) as u32,
        1 => section.paths[number][place] = random.below(section.levels.len() * n as usize) as u32,
        2 => drop(section.paths[number].remove(place)),
        3 => {
            let here = section.paths[number][place];
            section.paths[number].insert(place, here);
        }
        4 => round(&mut section.paths[number]),
        5 => {
            round(&mut section.paths[number]);
            (section.triangle_indices, section.vertex_indices) = indices(&whole, section).unwrap();
        }
        6 => {
            // There and back again.
            let here = section.paths[number][place];
            let next = here / n * n + (here + 1) % n;
            section.paths[number].splice(place..place, [here, next]);
        }
        7 => section.triangle_indices[triangle] += random.below(3) as i64 - 1,
        8 => section.vertex_indices[vertex] += random.below(3) as i64 - 1,
        9 => {
            section.triangle_indices[triangle] += 1;
            section.vertex_indices[vertex] -= 1;
        }
        10 => section.paths[number].reverse(),
        11 => section.paths.swap(number, other),
        12 => {
            section.paths.remove(number);
            section.excess.remove(number);
        }
        13 => {
            let path = section.paths[other].clone();
            section.paths.push(path);
            section.excess.push(0);
        }
        14 => section.excess[number] += random.below(3) as i64 - 1,
        15 => {
            // Another path over the same edge.
            let ends = [section.paths[number][0], section.paths[number][section.paths[number].len() - 1]];
            let (triangle, _) = sides(&whole.triangles)[&ends.map(|end| end / n)];
            section.paths[number] = path(&whole, triangle, ends, random);
        }
        16 => {
            let row = triangle * each;
            tetrahedra.swap(row + random.below(each), row + random.below(each));
        }
        _ => {
            // A vertex of the third corner in the path.
            let third = whole.triangles[triangle].map(|corner| corner * n + random.below(n as usize) as u32);
            section.paths[number].insert(place, *random.pick(&third));
        }
    }
    format!("kind {kind} at path {number}, triangle {triangle}, vertex {vertex}")
}
