//! One negative control for every rule: a map that breaks this rule and is refuted by its name.

mod support;

use homeo_verify::{Verdict, Witness, verify_bytes};
use support::build::{all_maps, cube_grid, square_grid};
use support::{Map, Refinement};

fn map(name: &str) -> Map {
    all_maps().into_iter().find(|(other, _)| *other == name).expect("a name from the list").1
}

fn refute(map: &Map) -> Witness {
    match verify_bytes(&map.signed_bytes()) {
        Ok(Verdict::Refuted(witness)) => witness,
        other => panic!("not refuted: {other:?}"),
    }
}

#[track_caller]
fn assert_refuted(map: &Map, rule: &str, words: &str) -> Witness {
    let witness = refute(map);
    assert_eq!(witness.rule, rule, "{witness:?}");
    assert!(witness.message.contains(words), "{witness:?}");
    witness
}

/// A map with this source; the rest is never reached.
fn source(target: &str, positions: &[[f64; 3]], cells: &[&[u32]]) -> Map {
    let positions = positions.iter().map(|p| p.to_vec()).collect();
    let cells: Vec<Vec<u32>> = cells.iter().map(|cell| cell.to_vec()).collect();
    let mut map = Map::new("piecewise-linear", target, positions, cells);
    map.target_positions = vec![vec![0.0; map.size() - 1]; map.positions.len()];
    map
}

/// One triangle with carriers and cells of a refinement.
fn refined_triangle(carriers: &[([u32; 3], [i64; 3])], cells: &[[u32; 3]]) -> Map {
    let mut map = source("square", &[[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]], &[&[0, 1, 2]]);
    map.refinement = Some(Refinement {
        carrier_vertices: carriers.iter().map(|c| c.0.to_vec()).collect(),
        carrier_weights: carriers.iter().map(|c| c.1.to_vec()).collect(),
        cells: cells.iter().map(|c| c.to_vec()).collect(),
        parents: vec![0; cells.len()],
    });
    map.target_positions = vec![vec![0.0; 2]; 3 + carriers.len()];
    map
}

const TETRAHEDRON: [[f64; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [0.2, 0.2, 0.5]];

#[test]
fn rule_s1_coordinates_are_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut map = map("cube of six");
        map.positions[3][1] = bad;
        assert_eq!(assert_refuted(&map, "S1", "finite").vertices, [3]);
    }
}

#[test]
fn rule_s2_cells_have_different_existing_vertices() {
    let mut outside = map("square");
    outside.source_cells[5][2] = 16;
    assert_eq!(assert_refuted(&outside, "S2", "exist").cells, [5]);
    let mut largest = map("square");
    largest.source_cells[5][2] = u32::MAX;
    assert_refuted(&largest, "S2", "exist");
    let mut twice = map("square");
    twice.source_cells[5][2] = twice.source_cells[5][0];
    assert_refuted(&twice, "S2", "twice");
    let same = source("square", &TETRAHEDRON, &[&[0, 1, 2], &[2, 1, 0]]);
    assert_eq!(assert_refuted(&same, "S2", "same vertices").cells, [0, 1]);
}

#[test]
fn rule_s3_cells_are_positive() {
    let mut turned = map("cube of six");
    turned.source_cells[2].swap(0, 1);
    assert_eq!(assert_refuted(&turned, "S3", "oriented").cells, [2]);
    let mut flat = map("ball");
    flat.positions[3][2] = 0.0;
    assert_refuted(&flat, "S3", "oriented");
    let flat = source("square", &[[0., 0., 0.], [1., 2., 3.], [2., 4., 6.]], &[&[0, 1, 2]]);
    assert_eq!(assert_refuted(&flat, "S3", "area").points.len(), 3);
}

#[test]
fn rule_s4_neighbours_lie_on_opposite_sides() {
    let map = source("cube", &TETRAHEDRON, &[&[0, 1, 2, 3], &[0, 1, 2, 4]]);
    assert_eq!(assert_refuted(&map, "S4", "same side").cells, [0, 1]);
}

#[test]
fn rule_8_links_and_topology_of_the_source() {
    let (positions, cells) = cube_grid(3);
    let mut hollow = Map::new("piecewise-linear", "cube", positions, cells);
    hollow.source_cells.drain(13 * 6..14 * 6);
    hollow.target_positions = vec![vec![0.0; 3]; 64];
    assert_refuted(&hollow, "8", "not a ball");

    let (positions, cells) = square_grid(3);
    let mut annulus = Map::new("piecewise-linear", "square", positions, cells);
    annulus.source_cells.drain(8..10);
    annulus.target_positions = vec![vec![0.0; 2]; 16];
    assert_refuted(&annulus, "8", "not a ball");

    let plane = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.], [1., 1., 5.]];
    assert_refuted(&source("square", &plane, &[&[0, 1, 2], &[0, 3, 4]]), "8", "around a face of 1");
    assert_refuted(&source("square", &plane, &[&[0, 1, 2], &[0, 1, 4], &[0, 1, 5]]), "8", "share a facet");
    let apart = source("square", &plane, &[&[0, 1, 2], &[3, 4, 5]]);
    assert_refuted(&apart, "8", "not a ball");

    let space = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
    let at_an_edge = source("cube", &space, &[&[0, 1, 2, 3], &[0, 1, 4, 5]]);
    assert_eq!(assert_refuted(&at_an_edge, "8", "around a face of 2").vertices, [0, 1]);
}

/// A cone over an annulus of triangles: connected through facets everywhere, but the apex has no disk around it.
#[test]
fn rule_8_vertex_links_are_spheres_or_disks() {
    let ring =
        |radius: f64, z: f64| [[1., 0.], [0., 1.], [-1., 0.], [0., -1.]].map(|[x, y]| [radius * x, radius * y, z]);
    let positions: Vec<[f64; 3]> = [[0., 0., 0.]].into_iter().chain(ring(1., 1.)).chain(ring(2., 1.)).collect();
    let mut cells: Vec<[u32; 4]> = vec![];
    for i in 0..4 {
        let (a, b) = (1 + i, 1 + (i + 1) % 4);
        cells.extend([[0, a, a + 4, b], [0, b, a + 4, b + 4]]);
    }
    let cells: Vec<&[u32]> = cells.iter().map(|cell| &cell[..]).collect();
    assert_eq!(assert_refuted(&source("cube", &positions, &cells), "8", "link of vertex").vertices, [0]);
}

#[test]
fn rule_r1_carriers() {
    let edit = |change: fn(&mut Refinement)| {
        let mut map = map("square, refined");
        change(map.refinement.as_mut().expect("refined"));
        assert_refuted(&map, "R1", "carrier");
    };
    edit(|r| r.carrier_weights[1][0] = -1);
    edit(|r| r.carrier_weights[1] = vec![0; 3]);
    edit(|r| r.carrier_vertices[1] = vec![4, 4, 8]);
    edit(|r| r.carrier_vertices[0][2] = 9);
    edit(|r| r.carrier_weights[2][0] = i64::MIN);
}

#[test]
fn rule_r2_cells_lie_in_their_parents() {
    let mut missing = map("square, refined");
    missing.refinement.as_mut().expect("refined").parents[3] = 8;
    assert_refuted(&missing, "R2", "parent");
    let mut other = map("square, refined");
    other.refinement.as_mut().expect("refined").parents[12] = 2;
    assert_refuted(&other, "R2", "lie in its parent");
    let mut outside = map("square, refined");
    outside.cells_mut()[0][0] = 12;
    assert_refuted(&outside, "R2", "exist");
}

#[test]
fn rule_r3_cells_have_the_orientation_of_their_parents() {
    let mut map = map("cube, refined");
    map.cells_mut()[7].swap(1, 2);
    assert_eq!(assert_refuted(&map, "R3", "turned").cells, [7]);
    let flat = refined_triangle(&[([0, 1, 0], [1, 1, 0])], &[[0, 3, 1], [0, 1, 2]]);
    assert_refuted(&flat, "R3", "flat");
}

#[test]
fn rule_r4_volumes_add_up_to_one() {
    let corners = [([0, 0, 0], [1, 0, 0]), ([1, 0, 0], [2, 0, 0]), ([2, 0, 0], [9, 0, 0])];
    assert_refuted(&refined_triangle(&corners, &[[0, 1, 2], [3, 4, 5]]), "R4", "volume");
    assert_refuted(&refined_triangle(&[([0, 1, 0], [1, 1, 0])], &[[0, 3, 2]]), "R4", "volume");
    assert_refuted(&refined_triangle(&[], &[]), "R4", "volume");
}

#[test]
fn rule_r5_children_do_not_fold() {
    let middles = [([0, 2, 0], [1, 1, 0]), ([1, 2, 0], [1, 1, 0])];
    let map = refined_triangle(&middles, &[[0, 1, 3], [0, 1, 4]]);
    assert_eq!(assert_refuted(&map, "R5", "same side").cells, [0, 1]);
}

#[test]
fn rule_r6_inner_facets_have_two_cells() {
    let mut map = refined_triangle(&[([1, 2, 0], [1, 1, 0])], &[[0, 1, 4], [0, 4, 2], [1, 3, 2]]);
    map.positions.push(vec![4.0, 4.0, 0.0]);
    map.source_cells.push(vec![1, 3, 2]);
    map.target_positions.push(vec![0.0; 2]);
    map.refinement.as_mut().expect("refined").parents[2] = 1;
    assert_refuted(&map, "R6", "one cell only");
}

#[test]
fn rule_1_rows_and_lengths() {
    let mut unbalanced = map("cube of 48");
    unbalanced.directions[30][2] += 1;
    assert_eq!(assert_refuted(&unbalanced, "1", "sum to zero").cells, [30]);
    let mut wrapping = map("square");
    wrapping.directions[4] = vec![127, 127, 2]; // 256 wraps to zero in eight bits
    assert_refuted(&wrapping, "1", "sum to zero");
    let mut resting = map("disk");
    resting.directions[0] = vec![0; 3];
    assert_refuted(&resting, "1", "only the centre");
    let mut moving = map("disk");
    let centre = moving.manifest["centre"]["cell"].as_u64().expect("a cell") as usize;
    moving.directions[centre] = vec![1, 1, -2];
    assert_refuted(&moving, "1", "only the centre");
    let mut short = map("ball, refined");
    short.lengths[2] = 0;
    assert_refuted(&short, "1", "length");
}

#[test]
fn rule_2_leaves_cross_every_inner_facet() {
    let mut map_with_rest = map("square from a hexagon");
    map_with_rest.directions[1] = vec![0, 1, -1];
    assert_refuted(&map_with_rest, "2", "no leaf crosses");
    let mut against = map("cube of six");
    against.directions[3].iter_mut().for_each(|d| *d = -*d);
    assert_refuted(&against, "2", "no leaf crosses");
    let middles = [([0, 2, 0], [1, 1, 0]), ([1, 2, 0], [1, 1, 0]), ([0, 1, 2], [1, 1, 1])];
    assert_refuted(&refined_triangle(&middles, &[[0, 1, 3], [0, 1, 4], [0, 1, 5]]), "2", "share a facet");
}

#[test]
fn rule_3_centre() {
    let mut missing = map("ball");
    missing.manifest["centre"]["cell"] = 13.into();
    assert_refuted(&missing, "3", "exist");
    for name in ["ball", "disk, refined"] {
        let mut backwards = map(name);
        backwards.directions.iter_mut().flatten().for_each(|d| *d = -*d);
        assert_refuted(&backwards, "3", "source or sink");
    }
    let mut parallel = map("disk");
    let rim = support::build::boundary(parallel.cells());
    let (c, i) = (0..parallel.cells().len())
        .flat_map(|c| (0..3).map(move |i| (c, i)))
        .find(|&(c, i)| {
            let facet: Vec<u32> = (0..3).filter(|&j| j != i).map(|j| parallel.cells()[c][j]).collect();
            let inflow = parallel.directions[c].iter().filter(|d| **d > 0).count();
            inflow == 2 && rim.contains(&facet.into_iter().collect())
        })
        .expect("a cell with an inflow facet besides the one in the boundary");
    parallel.directions[c] = parallel.directions[c].iter().map(|d| d.signum()).collect();
    parallel.directions[c][i] = 0;
    assert_eq!(assert_refuted(&parallel, "3", "source or sink").cells, [c as u32]);
    let (positions, cells) = square_grid(1);
    let mut at_the_rim = Map::new("foliation", "disk", positions, cells);
    at_the_rim.directions = vec![vec![0, 0, 0], vec![1, 1, -2]];
    at_the_rim.lengths = vec![1, 1];
    at_the_rim.manifest["centre"] = serde_json::json!({"cell": 0, "length": 1});
    assert_refuted(&at_the_rim, "3", "lies in the boundary");
}

/// Six triangles around a vertex, the leaves running round it.
#[test]
fn rule_4_no_circles() {
    let mut map = map("square from a hexagon");
    map.directions = vec![vec![0, -1, 1]; 6]; // facet 2 is shared with the cell before, facet 1 with the next
    let witness = assert_refuted(&map, "4", "circle");
    assert_eq!(witness.cells.len(), 6);
}

#[test]
fn rule_5_vertices() {
    let mut map = map("square from a hexagon");
    // Leaves come in through the rim in cells 0 and 3, which are both first around the middle.
    let (first, between, last) = (vec![2, -1, -1], vec![-1, -1, 2], vec![-2, 1, 1]);
    map.directions = [&first, &between, &last, &first, &between, &last].map(Vec::clone).to_vec();
    let witness = assert_refuted(&map, "5", "places around");
    assert_eq!(witness.vertices.len(), 1);
}

/// Turning the flow across a single facet is seen by the edges of that facet.
#[test]
fn rule_5_edges() {
    let valid = map("cube of 48");
    let mut found = 0;
    for c in 0..valid.cells().len() {
        for i in 0..4 {
            let mut map = valid.clone();
            if turn_facet(&mut map, c, i)
                && let Ok(Verdict::Refuted(witness)) = verify_bytes(&map.signed_bytes())
            {
                found += usize::from(witness.rule == "5" && witness.vertices.len() == 2);
                assert!(["4", "5"].contains(&witness.rule), "{witness:?}");
            }
        }
    }
    assert!(found >= 40, "edges were the witness only {found} times");
}

/// Turns the flow across facet `i` of cell `c` in both its cells.
fn turn_facet(map: &mut Map, c: usize, i: usize) -> bool {
    let facet: Vec<u32> = (0..4).filter(|&j| j != i).map(|j| map.cells()[c][j]).collect();
    let opposite = |cell: &Vec<u32>| cell.iter().position(|v| !facet.contains(v));
    let cells: Vec<Vec<u32>> = map.cells().clone();
    let sides: Vec<usize> = (0..cells.len()).filter(|&d| facet.iter().all(|v| cells[d].contains(v))).collect();
    sides.len() == 2
        && sides.iter().all(|&d| support::build::turn(&mut map.directions[d], opposite(&cells[d]).expect("a facet")))
}

/// Source and sink facets of the hexagon meet in vertex 1; the leaves run both ways round the middle.
#[test]
fn rule_6_source_and_sink_are_apart() {
    let mut map = map("square from a hexagon");
    map.directions =
        vec![vec![2, -1, -1], vec![-2, 1, 1], vec![0, -1, 1], vec![0, -1, 1], vec![0, -1, 1], vec![0, -1, 1]];
    // In cell i facet 0 is on the rim, facet 1 is shared with the next cell, facet 2 with the cell before.
    (2..6).for_each(|c| map.directions[c] = vec![0, 1, -1]);
    assert_eq!(assert_refuted(&map, "6", "source and a sink").vertices, [1]);
}

#[test]
fn rule_7_arc_and_circle() {
    let edit = |name: &str, words: &str, change: fn(&mut Map)| {
        let mut map = map(name);
        change(&mut map);
        assert_refuted(&map, "7", words);
    };
    edit("square", "increase", |map| map.section_coordinates.swap(1, 2));
    edit("square", "increase", |map| map.section_coordinates[1][0] = f64::NAN);
    edit("square", "increase", |map| map.section_coordinates[1][0] = 0.0);
    edit("square", "begin or end", |map| map.section_coordinates[0][0] = -0.25);
    edit("square", "begin or end", |map| map.section_coordinates[3][0] = 1.5);
    edit("square", "each source edge", |map| map.section_vertices.swap(1, 2));
    edit("square", "each source edge", |map| {
        map.section_vertices.pop();
        map.section_coordinates.pop();
    });
    edit("disk", "each source edge", |map| map.section_vertices.swap(0, 1));
    edit("disk", "begin or end", |map| map.section_coordinates.last_mut().expect("a row")[0] = 4.0);
    edit("disk", "begin or end", |map| map.section_coordinates[0][0] = -0.5);
    edit("disk", "each source edge", |map| {
        map.section_vertices.clear();
        map.section_coordinates.clear();
    });
}

#[test]
fn rule_7_square() {
    let edit = |words: &str, change: fn(&mut Map)| {
        let mut map = map("cube of 48");
        change(&mut map);
        assert_refuted(&map, "7", words);
    };
    edit("flat", |map| {
        let inner = map.section_coordinates.iter().position(|p| p[0] == 0.5 && p[1] == 0.5).expect("a vertex");
        map.section_coordinates[inner] = vec![0.5, 0.0];
    });
    edit("same side", |map| {
        let inner = map.section_coordinates.iter().position(|p| p[0] == 0.5 && p[1] == 0.5).expect("a vertex");
        map.section_coordinates[inner] = vec![0.1, 0.9];
    });
    edit("not finite", |map| map.section_coordinates[0][1] = f64::INFINITY);
    edit("side of the box", |map| map.section_coordinates[1][0] = 0.001);
    edit("side of the box", |map| map.section_coordinates.iter_mut().for_each(|p| p[0] *= 2.0));
    edit("twice", |map| map.section_vertices[0] = map.section_vertices[1]);
    edit("twice, or one that does not exist", |map| map.section_vertices[0] = 1 << 30);
    edit("not those", |map| map.section_vertices[0] = 26);
}

/// A fan of eight triangles whose rim runs twice round the square.
#[test]
fn rule_p_boundary_runs_once_round() {
    let rim = (0..8).map(|i| [f64::from(i).cos(), f64::from(i).sin(), 0.0]);
    let positions: Vec<[f64; 3]> = rim.chain([[0.0; 3]]).collect();
    let cells: Vec<[u32; 3]> = (0..8).map(|i| [8, i, (i + 1) % 8]).collect();
    let mut map = source("square", &positions, &cells.iter().map(|cell| &cell[..]).collect::<Vec<_>>());
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    map.target_positions = (0..8).map(|i| corners[i % 4].to_vec()).chain([vec![0.5, 0.5]]).collect();
    assert_refuted(&map, "P", "exactly once");
}

#[test]
fn rule_p_cells_and_sides() {
    let edit = |name: &str, words: &str, change: fn(&mut Map)| {
        let mut map = map(name);
        change(&mut map);
        assert_refuted(&map, "P", words);
    };
    edit("piecewise-linear square", "flat", |map| map.target_positions[4] = vec![0.0, 0.5]);
    edit("piecewise-linear cube", "same side", |map| map.target_positions[13] = vec![0.5, 0.5, 1.5]);
    edit("piecewise-linear cube", "not finite", |map| map.target_positions[13][2] = f64::NAN);
    edit("piecewise-linear cube", "side of the box", |map| map.target_positions[0][2] = -1e-300);
    edit("piecewise-linear square", "side of the box", |map| {
        map.target_positions.iter_mut().flatten().for_each(|x| *x *= 0.5);
    });
}

#[test]
fn undecided_when_denominators_grow_too_long() {
    let count = 100;
    let weight = |i: i64| i64::MAX / count * i - 7 * i * i;
    let carriers: Vec<([u32; 3], [i64; 3])> =
        (1..count).map(|i| ([1, 2, 0], [i64::MAX - weight(i) - 11 * i, weight(i), 0])).collect();
    let path: Vec<u32> = [1].into_iter().chain(3..3 + carriers.len() as u32).chain([2]).collect();
    let cells: Vec<[u32; 3]> = path.windows(2).map(|step| [0, step[0], step[1]]).collect();
    // In this order the sum does not telescope.
    let cells: Vec<[u32; 3]> = cells.iter().step_by(2).chain(cells.iter().skip(1).step_by(2)).copied().collect();
    match verify_bytes(&refined_triangle(&carriers, &cells).signed_bytes()) {
        Ok(Verdict::Undecided(obstacle)) => assert!(obstacle.remedy.contains("powers of two")),
        other => panic!("{other:?}"),
    }
}
