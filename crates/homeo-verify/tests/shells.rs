//! Shells: valid ones, a negative control for every rule L1 to L6, and random mutations judged by an oracle.

mod support;

use homeo_verify::{Verdict, verify_bytes};
use serde_json::json;
use support::mutants::{change_cells, change_points, is_small, judge, mutate};
use support::random::Random;
use support::shells::{
    all_shells, around, bare_hexagon, boundary, closed_shells, hexagon, icosphere, is_valid, joined, octahedron,
    open_shells, over_plane, shell, starred, tetrahedron, triangle, turned,
};
use support::{Map, assert_refuted, write};

#[test]
fn all_valid_shells_are_certified() {
    for (name, map) in all_shells() {
        match verify_bytes(&map.bytes()) {
            Ok(Verdict::Certified(claim)) => {
                assert_eq!([&claim.kind[..], &claim.target], ["shell"; 2], "{name}");
                assert!(claim.statement.contains("theorem on shells, rules L1-L6"), "{}", claim.statement);
                assert!(!format!("{claim:?}").contains("closed"), "{claim:?}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn the_oracle_accepts_the_same_shells() {
    for (name, map) in small_shells() {
        assert!(is_valid(&map), "{name}");
    }
}

#[test]
fn any_scale_of_coordinates_is_certified() {
    for (name, map) in small_shells() {
        for scale in [2f64.powi(-1060), 2f64.powi(-400), 1e-3, 2f64.powi(300), 2f64.powi(1000)] {
            let mut map = map.clone();
            map.positions.iter_mut().chain(map.levels.iter_mut().flatten()).flatten().for_each(|x| *x *= scale);
            let verdict = verify_bytes(&map.signed_bytes());
            assert!(matches!(verdict, Ok(Verdict::Certified(_))), "{name} times {scale}: {verdict:?}");
        }
    }
}

/// Vertices in no triangle and columns in no prism are no part of the claim; but they have to be finite.
#[test]
fn unused_vertices_and_columns_are_ignored() {
    let mut map = named("octahedron");
    map.positions.push(vec![9.0; 3]);
    map.levels.iter_mut().for_each(|level| level.push(vec![0.1; 3]));
    assert!(matches!(verify_bytes(&map.signed_bytes()), Ok(Verdict::Certified(_))));
    map.levels[1][6][0] = f64::NAN;
    assert_refuted(&map, "S1", "finite");
}

fn small_shells() -> Vec<(&'static str, Map)> {
    all_shells().into_iter().filter(|(_, map)| is_small(map)).collect()
}

fn named(name: &str) -> Map {
    all_shells().into_iter().find(|(other, _)| *other == name).expect("a name from the list").1
}

#[track_caller]
fn assert_unreadable(bytes: &[u8], words: &str) {
    match verify_bytes(bytes) {
        Err(error) => assert!(error.message.contains(words), "{error}"),
        Ok(verdict) => panic!("readable: {verdict:?}"),
    }
}

#[test]
fn containers_of_shells() {
    let edit = |key: &str, value: serde_json::Value, words: &str| {
        let mut map = named("octahedron");
        map.manifest[key] = value;
        assert_unreadable(&map.bytes(), words);
    };
    edit("kind", json!("foliation"), "belong together");
    edit("kind", json!("piecewise-linear"), "belong together");
    edit("target", json!("square"), "belong together");
    edit("target", json!("disk"), "centre");
    edit("target", json!("cube"), "dimension");
    edit("dimension", json!(3), "dimension");
    edit("centre", json!({"cell": 0, "length": 1}), "centre");
    let map = named("octahedron");
    for name in ["shell_bottom", "shell_middle", "shell_top", "prisms"] {
        let mut entries = write::entries(&map);
        entries.retain(|entry| entry.0 != format!("{name}.npy"));
        assert_unreadable(&write::zip(&entries), &format!("{name} is missing"));
    }
    for name in ["cells.npy", "parents.npy", "lengths.npy", "target_positions.npy"] {
        let mut entries = write::entries(&map);
        entries.push((name.to_owned(), vec![]));
        assert_unreadable(&write::zip(&entries), "does not belong");
    }
    for level in 0..3 {
        let mut map = map.clone();
        map.levels[level].pop();
        assert_unreadable(&map.bytes(), "header");
    }
}

#[test]
fn rules_s1_and_s2() {
    let mut map = named("octahedron");
    map.positions[3][1] = f64::INFINITY;
    assert_eq!(assert_refuted(&map, "S1", "finite").vertices, [3]);
    for level in 0..3 {
        let mut map = named("octahedron");
        map.levels[level][2][0] = f64::NAN;
        assert_eq!(assert_refuted(&map, "S1", "finite").vertices, [6 + 2]);
    }
    let mut map = named("octahedron");
    map.source_cells[5][2] = 6;
    assert_eq!(assert_refuted(&map, "S2", "exist").cells, [5]);
    let mut map = named("octahedron");
    map.prisms[5][2] = u32::MAX;
    assert_eq!(assert_refuted(&map, "S2", "exist").cells, [8 + 5]);
    let mut map = named("octahedron");
    map.prisms[5][2] = map.prisms[5][1];
    assert_refuted(&map, "S2", "twice");
}

#[test]
fn rule_l1_oriented_surfaces() {
    let mut flipped = named("octahedron");
    flipped.source_cells[3].swap(0, 1);
    assert_refuted(&flipped, "L1", "same side");
    let mut flipped = named("octahedron");
    flipped.prisms[3].swap(0, 1);
    let witness = assert_refuted(&flipped, "L1", "same side");
    assert!(witness.cells.contains(&(8 + 3)) && witness.points.len() == 2, "{witness:?}");
    let mut open = named("octahedron");
    open.source_cells.pop();
    assert_refuted(&open, "L1", "source: a boundary edge is none");
    let mut open = named("octahedron");
    open.prisms.pop();
    assert_refuted(&open, "L1", "middle surface: a boundary edge is none");
    let mut three = named("octahedron");
    three.source_cells.push(vec![0, 2, 1]);
    assert_refuted(&three, "L1", "share");
    let mut pillow = named("octahedron");
    pillow.source_cells = vec![vec![0, 1, 2], vec![2, 1, 0]];
    assert_refuted(&pillow, "S2", "same vertices");
    let mut flat = named("octahedron");
    flat.positions[4] = vec![0.5, 0.5, 0.0];
    assert_refuted(&flat, "L1", "area zero");
    let glue = |cells: &mut Vec<Vec<u32>>| cells.iter_mut().flatten().filter(|v| **v == 6).for_each(|v| *v = 0);
    let mut glued = named("two that overlap");
    glue(&mut glued.source_cells);
    assert_eq!(assert_refuted(&glued, "L1", "not connected").vertices, [0]);
    let mut glued = named("two that overlap");
    glue(&mut glued.prisms);
    assert_eq!(assert_refuted(&glued, "L1", "not connected").vertices, [10]);
}

#[test]
fn rule_l1_common_boundary() {
    let h = hexagon(1);
    for (v, axis) in [(0, 0), (1, 1), (3, 2)] {
        let mut moved = named("hexagon");
        moved.levels[1][v][axis] = moved.levels[1][v][axis].next_up();
        assert_refuted(&moved, "L1", "is none of the other surface");
    }
    let mut negative_zero = named("hexagon");
    (negative_zero.positions[0][1], negative_zero.levels[1][0][2]) = (-0.0, -0.0);
    assert!(matches!(verify_bytes(&negative_zero.signed_bytes()), Ok(Verdict::Certified(_))));
    let mut split = h.clone();
    split.0.push([3.0, 1.5, 0.25]);
    split.1[0] = [0, 7, 6];
    split.1.push([7, 1, 6]);
    assert!(matches!(verify_bytes(&over_plane(&split, &split, [-2.0, 2.0]).bytes()), Ok(Verdict::Certified(_))));
    assert_refuted(&over_plane(&split, &h, [-2.0, 2.0]), "L1", "source: a boundary edge is none");
    assert_refuted(&over_plane(&h, &split, [-2.0, 2.0]), "L1", "source: a boundary edge is none");
    let two = joined(&h, &h, [20.0, 0.0, 0.0]);
    let witness = assert_refuted(&over_plane(&h, &two, [-2.0, 2.0]), "L1", "middle surface: a boundary edge is none");
    assert!(witness.cells[0] >= 12 && witness.vertices.iter().all(|v| *v >= 14), "{witness:?}");
    let mut turned_over = named("hexagon");
    turned_over.source_cells.iter_mut().for_each(|cell| cell.swap(0, 1));
    assert_refuted(&turned_over, "L1", "source: a boundary edge is none");
    let touching = joined(&h, &h, [8.0, 0.0, 0.25]);
    let witness = assert_refuted(&over_plane(&touching, &touching, [-2.0, 2.0]), "L1", "source: two vertices");
    assert_eq!(witness.vertices, [0, 7 + 3]);
    let witness = assert_refuted(&over_plane(&h, &touching, [-2.0, 2.0]), "L1", "middle surface: two vertices");
    assert_eq!(witness.vertices, [7, 7 + 7 + 3]);
    let mut fans = named("hexagon");
    fans.source_cells = vec![fans.source_cells[0].clone(), fans.source_cells[3].clone()];
    assert_eq!(assert_refuted(&fans, "L1", "not connected").vertices, [6]);
    let mut strip = named("hexagon");
    strip.source_cells = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 0, 4], [4, 0, 1]].map(|cell| cell.to_vec()).to_vec();
    assert_refuted(&strip, "L1", "same side"); // one-sided
}

#[test]
fn rule_l2_positive_tetrahedra() {
    let mut inverted = named("octahedron");
    inverted.levels.swap(0, 2);
    assert_refuted(&inverted, "L2", "turned over");
    let mut inside_out = named("octahedron");
    inside_out.prisms.iter_mut().for_each(|prism| prism.swap(0, 1));
    assert_refuted(&inside_out, "L2", "turned over");
    let mut sheared = named("octahedron");
    sheared.levels[2][4] = vec![1.5, 1.5, 0.0];
    assert_refuted(&sheared, "L2", "turned over");
    for level in [0, 2] {
        let mut half_pinched = named("octahedron");
        half_pinched.levels[level][4] = half_pinched.levels[1][4].clone();
        assert_refuted(&half_pinched, "L2", "flat");
    }
    let mut pinched = named("octahedron, pinched");
    (0..3).for_each(|level| pinched.levels[level][0] = vec![1., 0., 0.]);
    assert_refuted(&pinched, "L2", "more than one");
}

#[test]
fn rule_l3_source_between_bottom_and_top() {
    let mut map = named("sphere in an icosahedron");
    let point = map.positions[0].clone();
    for factor in [1.5, 1.4, 0.5] {
        map.positions[0] = point.iter().map(|x| factor * x).collect();
        let witness = assert_refuted(&map, "L3", "meets");
        assert!(witness.vertices.contains(&0) && witness.cells[1] >= 320, "{witness:?}");
    }
    let mut touching = named("octahedron");
    touching.positions[4] = touching.levels[2][4].clone();
    assert_refuted(&touching, "L3", "meets");
    let mut other_corner = named("octahedron, pinched");
    other_corner.positions[4][2] += 1e-9;
    assert_refuted(&other_corner, "L3", "meets");
    let mut same_level = named("octahedron, pinched");
    same_level.levels[2][0] = vec![0.999, 0., 0.];
    same_level.levels[1][0] = vec![0.9, 0., 0.];
    assert_refuted(&same_level, "L3", "meets"); // beyond the pinched corner
}

#[test]
fn rule_l3_source_inside_of_walls() {
    let (h, t) = (hexagon(1), triangle());
    let fine = over_plane(&hexagon(2), &bare_hexagon(), [-2.0, 2.0]);
    let with = |v: usize, point: [f64; 3]| {
        let mut map = fine.clone();
        map.positions[v] = point.to_vec();
        map
    };
    // Through a wall: triangles without vertices on the boundary, and with one.
    assert!(assert_refuted(&with(12, [5.0, 5.0, 0.5]), "L3", "meets the wall").vertices.contains(&12));
    assert!(assert_refuted(&with(7, [4.0, 2.5, 0.5]), "L3", "meets the wall").vertices.contains(&7));
    // Only up to the wall: inside a wall triangle, in the edge, in an end of the edge.
    for point in [[3.0, 1.5, 1.0], [3.0, 1.5, 0.25], [-4.0, 0.0, -0.25]] {
        assert!(assert_refuted(&with(12, point), "L3", "meets the wall").vertices.contains(&12));
    }
    // The triangle at the edge upright, in the plane of the wall, above or below.
    for z in [1.0, -1.0] {
        let mut upright = over_plane(&starred(&h), &h, [-2.0, 2.0]);
        upright.positions[7] = vec![3.0, 1.5, z];
        assert_eq!(assert_refuted(&upright, "L3", "does not lie inside").cells, [0, 18]);
    }
    // A wall that leans over the surface: x + 2 y = 4 - z over the edge from 0 to 1.
    for (level, height) in [(2, 3.0), (0, -3.0)] {
        let mut leaning = over_plane(&starred(&t), &t, [-3.0, 3.0]);
        leaning.levels[level].iter_mut().for_each(|p| (0..2).for_each(|x| p[x] *= 0.25));
        leaning.positions[3] = vec![1.0, 1.0, 0.25 * height];
        leaning.sign();
        assert!(matches!(verify_bytes(&leaning.bytes()), Ok(Verdict::Certified(_))));
        leaning.positions[3][2] = 0.5 * height;
        assert_eq!(assert_refuted(&leaning, "L3", "does not lie inside").cells, [0, 3]);
    }
    // Leaning away it is no obstacle.
    let mut away = over_plane(&starred(&t), &t, [-3.0, 3.0]);
    [0, 2].iter().for_each(|&level| away.levels[level].iter_mut().for_each(|p| (0..2).for_each(|x| p[x] *= 2.0)));
    assert!(matches!(verify_bytes(&away.signed_bytes()), Ok(Verdict::Certified(_))));
    // Over a pinched column the walls are triangles.
    let mut pinched = named("hexagon, pinched at the boundary");
    pinched.positions[6] = vec![3.0, 1.5, 0.25];
    assert_refuted(&pinched, "L1", "area zero");
    pinched.positions[6] = vec![3.0, 1.5, 0.375];
    assert_refuted(&pinched, "L3", "does not lie inside");
}

#[test]
fn rule_l4_pillars_cross_from_below() {
    let mut folded = named("sphere in an icosahedron");
    let cell = folded.source_cells[100].clone();
    // Beyond the opposite edge: the triangle turns over.
    let [a, b, c] = [0, 1, 2].map(|i| folded.positions[cell[i] as usize].clone());
    folded.positions[cell[0] as usize] = (0..3).map(|x| 0.75 * (b[x] + c[x]) - 0.5 * a[x]).collect();
    assert_refuted(&folded, "L4", "not crossed");
    let mut inside_out = named("octahedron");
    inside_out.source_cells.iter_mut().for_each(|cell| cell.swap(0, 1));
    assert_refuted(&inside_out, "L4", "not crossed");
    let t = tetrahedron();
    assert_refuted(&around(&turned(&t, 1.0), &t, [0.25, 4.0]), "L4", "not crossed");
}

#[test]
fn rule_l5_the_shell_covers_the_source_once() {
    let o = octahedron();
    let mut far = named("octahedron");
    far.positions.iter_mut().for_each(|p| p[0] += 100.0);
    assert_refuted(&far, "L5", "has 0 preimages");
    let twice = joined(&o, &o, [0.0; 3]);
    let level = |factor: f64| -> Vec<[f64; 3]> { twice.0.iter().map(|p| p.map(|x| factor * x)).collect() };
    let covered_twice = shell(&o, &twice.1, [&level(0.75), &twice.0, &level(1.25)]);
    assert_refuted(&covered_twice, "L5", "has 2 preimages");
    let mut second = named("two that overlap");
    second.positions.iter_mut().skip(6).for_each(|p| p[2] += 50.0);
    let witness = assert_refuted(&second, "L5", "has 0 preimages");
    assert_eq!(witness.cells, [8], "the first triangle of the second component");
}

#[test]
fn rule_l6_fibres_meet_the_source_once() {
    let o = octahedron();
    let inner = (o.0.iter().map(|p| p.map(|x| 0.75 * x)).collect(), o.1.clone());
    assert_refuted(&around(&joined(&o, &inner, [0.0; 3]), &o, [0.5, 1.5]), "L6", "in 2 points");
    // The same surface twice in one place: each point of it still has one preimage.
    assert_refuted(&around(&joined(&o, &o, [0.0; 3]), &o, [0.5, 1.5]), "L6", "in 2 points");
    let mut empty = named("two that overlap");
    empty.source_cells.truncate(8);
    let witness = assert_refuted(&empty, "L6", "in 0 points");
    assert_eq!(witness.cells, [8 + 8], "the first prism of the second component");
    let mut nothing = named("octahedron");
    nothing.source_cells.clear();
    assert_refuted(&nothing, "L6", "in 0 points");
}

#[test]
fn sources_finer_and_coarser_than_the_shell() {
    let fine = around(&turned(&icosphere(3), 1.0), &icosphere(0), [0.8, 1.4]);
    assert!(matches!(verify_bytes(&fine.bytes()), Ok(Verdict::Certified(_))));
    let coarse = around(&icosphere(1), &icosphere(2), [0.75, 1.25]);
    assert!(matches!(verify_bytes(&coarse.bytes()), Ok(Verdict::Certified(_))));
}

/// Two octahedra with a common corner, where both shells are pinched. The surface touches itself there, but the corner
/// is two vertices of the source, one for each column.
#[test]
fn surfaces_that_touch_in_a_pinched_corner() {
    let o = octahedron();
    let mut map = around(&joined(&o, &o, [2.0, 0.0, 0.0]), &joined(&o, &o, [2.0, 0.0, 0.0]), [1.0, 1.0]);
    for (v, middle) in map.levels[1].clone().into_iter().enumerate() {
        let centre = if v < 6 { 0.0 } else { 2.0 };
        for (level, factor) in [(0, 0.75), (2, 1.25)] {
            map.levels[level][v] = vec![centre + factor * (middle[0] - centre), factor * middle[1], factor * middle[2]];
            if v == 0 || v == 7 {
                map.levels[level][v] = middle.clone();
            }
        }
    }
    map.sign();
    assert!(is_valid(&map) && matches!(verify_bytes(&map.bytes()), Ok(Verdict::Certified(_))));
    map.levels[2][0][0] += 0.25;
    assert_refuted(&map, "L2", "flat");
    (map.levels[0][0], map.levels[1][0]) = (vec![0.75, 0., 0.], vec![1., 0., 0.]);
    assert_refuted(&map, "L3", "meets");
}

// Mutations.

const MUTANTS: usize = 3500;
const OPEN_MUTANTS: usize = 1500;
const SECTION_MUTANTS: usize = 800;

/// Moves a vertex and the column there alike, so that boundaries stay the same.
fn mutate_both(random: &mut Random, map: &mut Map) -> &'static str {
    let v = random.below(map.positions.len().min(map.levels[0].len()));
    let (from, level) = (map.positions[v].clone(), random.below(4));
    change_points(random, &mut map.positions[v..=v]);
    if random.below(3) > 0 {
        let factor = *random.pick(&[0.5, 1.0, 2.0]);
        map.positions[v] = from.iter().map(|x| x + factor * (random.unit() - 0.5)).collect();
    }
    let step: Vec<f64> = map.positions[v].iter().zip(&from).map(|(a, b)| a - b).collect();
    for (l, points) in map.levels.iter_mut().enumerate().filter(|(l, points)| *l != level && points[v] != from) {
        points[v].iter_mut().zip(&step).for_each(|(x, step)| *x += step * if l == 1 { 0.0 } else { 1.0 });
    }
    map.levels.iter_mut().filter(|points| points[v] == from).for_each(|points| points[v] = map.positions[v].clone());
    "vertex and column alike"
}

/// Moves a source vertex inside, if there is one, to a point in special position at a wall, or makes a wall lean.
fn mutate_at_wall(random: &mut Random, map: &mut Map) -> &'static str {
    let [i, j] = random.pick(&boundary(&map.prisms)).map(|v| v as usize);
    let level = 2 * random.below(2);
    if random.below(3) == 0 {
        let step = [0; 3].map(|_| 4.0 * (random.unit() - 0.5));
        [i, j].iter().for_each(|&v| (0..3).for_each(|x| map.levels[level][v][x] += step[x]));
        return "walls";
    }
    let (along, up) = (*random.pick(&[-0.25, 0.0, 0.5, 0.875, 1.0]), *random.pick(&[0.0, 0.0, 0.25, 0.375]));
    let at = |v: usize, x: usize| (1.0 - up) * map.levels[1][v][x] + up * map.levels[level][v][x];
    let point: Vec<f64> = (0..3).map(|x| (1.0 - along) * at(i, x) + along * at(j, x)).collect();
    let on_boundary = boundary(&map.source_cells).concat();
    let inside: Vec<usize> = (0..map.positions.len()).filter(|&v| !on_boundary.contains(&(v as u32))).collect();
    let v = if inside.is_empty() { i } else { *random.pick(&inside) };
    map.positions[v] = point;
    if random.below(2) == 0 {
        map.positions[v].iter_mut().for_each(|x| *x *= 0.875);
    }
    "source vertex at a wall"
}

#[test]
fn mutants_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let shells = closed_shells().into_iter().filter(|(_, map)| is_small(map) && map.prisms.len() <= 12).collect();
    let tally = judge(shells, MUTANTS, 11, mutate);
    assert!(tally.kinds.len() == 8 && tally.kinds.values().all(|counts| counts.iter().sum::<usize>() >= 100));
}

#[test]
fn mutants_of_open_shells_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let shells = open_shells().into_iter().filter(|(_, map)| is_small(map)).collect();
    let tally = judge(shells, OPEN_MUTANTS, 12, |random, map| match random.below(8) {
        0..4 => mutate(random, map),
        4 | 5 => mutate_both(random, map),
        _ => mutate_at_wall(random, map),
    });
    assert!(tally.kinds.len() == 11 && tally.kinds.values().all(|counts| counts.iter().sum::<usize>() >= 20));
    let both = tally.kinds["vertex and column alike"];
    assert!(both[0] >= 100 && both[1] >= 50, "{both:?}");
    for words in ["meets the wall", "does not lie inside", "is none of the other", "two vertices of the boundary"] {
        let count: usize = tally.rules.iter().filter(|(rule, _)| rule.contains(words)).map(|(_, n)| n).sum();
        assert!(count >= 10, "{words}: {count}");
    }
}

/// The same shells, with their source as the other section.
fn with_sections() -> Vec<(&'static str, Map)> {
    let mut shells: Vec<(&str, Map)> = all_shells().into_iter().filter(|(_, map)| is_small(map)).collect();
    for (_, map) in &mut shells {
        map.section = Some((map.positions.clone(), map.source_cells.clone()));
        map.manifest["target"] = json!("section");
    }
    shells
}

#[test]
fn sections_are_certified() {
    for (name, map) in with_sections() {
        let Ok(Verdict::Certified(claim)) = verify_bytes(&map.bytes()) else { panic!("{name}") };
        let count = map.source_cells.len();
        assert_eq!(claim.target, "section");
        assert!(
            claim.statement.contains(&format!("{count} triangles onto the other section of")),
            "{}",
            claim.statement
        );
        let triangles = claim.checked.iter().find(|(what, _)| what.starts_with("triangles of the source"));
        assert_eq!(triangles.map(|(_, n)| *n), Some(2 * count as u64), "both surfaces are checked");
    }
    let (_, mut map) = with_sections().remove(0);
    map.manifest["target"] = json!("shell");
    assert_unreadable(&map.bytes(), "does not belong");
    (map.manifest["target"], map.section) = (json!("section"), None);
    assert_unreadable(&map.bytes(), "section_positions");
}

/// Elements of the section are numbered behind those of source and shell.
#[test]
fn witnesses_on_the_section() {
    let (_, mut map) = with_sections().into_iter().find(|(name, _)| *name == "octahedron").expect("it is there");
    let (vertices, columns) = (map.positions.len() as u32, map.levels[0].len() as u32);
    let section = map.section.as_mut().expect("it has one");
    section.0[2] = vec![f64::NAN, 0.0, 0.0];
    let witness = assert_refuted(&map, "S1", "the other section");
    assert_eq!(witness.vertices, [vertices + columns + 2]);
    let (source, prisms) = (map.source_cells.len() as u32, map.prisms.len() as u32);
    let section = map.section.as_mut().expect("it has one");
    section.0[2] = map.positions[2].iter().map(|x| 4.0 * x).collect();
    let witness = assert_refuted(&map, "L3", "the other section");
    assert!(
        witness.cells[0] >= source + prisms && (source..source + prisms).contains(&witness.cells[1]),
        "{witness:?}"
    );
}

#[test]
fn mutants_of_sections_are_certified_exactly_when_the_oracle_finds_them_valid() {
    let tally = judge(with_sections(), SECTION_MUTANTS, 13, |random, map| {
        let columns = map.levels[0].len();
        let (positions, cells) = map.section.as_mut().expect("it has one");
        match random.below(4) {
            0 | 1 => {
                change_points(random, positions);
                "section positions"
            }
            2 => {
                change_cells(random, cells, positions.len());
                "section triangles"
            }
            _ => {
                let (level, v) = (random.below(3), random.below(columns));
                change_points(random, &mut map.levels[level][v..=v]);
                "points of columns"
            }
        }
    });
    assert!(tally.kinds.len() == 3 && tally.kinds.values().all(|counts| counts[0] >= 10 && counts[1] >= 50));
}
