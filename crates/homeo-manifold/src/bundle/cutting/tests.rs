//! Patterns against brute force, and obstructions that are minimal.

use super::super::walls::{Side, Walls};
use super::{Diagonal, cutting_pattern};
use proptest::prelude::*;

/// A connected surface of `count` triangles: each is glued by one side to an earlier one; then some more sides.
fn random_surface(count: usize, seeds: &[u32]) -> Walls {
    let mut walls = Walls::new(&(0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>()).unwrap();
    for triangle in 1..count as u32 {
        let open: Vec<_> = walls.open_sides().filter(|side| side.triangle < triangle).collect();
        let place = seeds[triangle as usize] as usize;
        walls.join(open[place % open.len()], Side::new(triangle, (place % 3) as u8));
    }
    for &seed in seeds.iter().skip(count) {
        let open: Vec<_> = walls.open_sides().collect();
        let (a, b) = (seed as usize % 97 % open.len().max(1), seed as usize / 97 % open.len().max(1));
        if open.len() > 4 && open[a].triangle != open[b].triangle {
            walls.join(open[a], open[b]);
        }
    }
    walls
}

fn is_valid(walls: &Walls, prescribed: &[(Side, Diagonal)], pattern: &[[Diagonal; 3]]) -> bool {
    let at = |side: Side| pattern[side.triangle as usize][usize::from(side.side)];
    let agree = walls.sides().all(|side| walls.across(side).is_none_or(|other| at(other) == -at(side)));
    let mixed = pattern.iter().all(|sides| sides.iter().any(|&side| side != sides[0]));
    agree && mixed && prescribed.iter().all(|&(side, diagonal)| at(side) == diagonal)
}

/// Whether any of all assignments is a pattern.
fn has_pattern(walls: &Walls, prescribed: &[(Side, Diagonal)]) -> bool {
    let fixed = |side| prescribed.iter().any(|&(other, _)| other == side);
    let chosen: Vec<_> =
        walls.sides().filter(|&side| !fixed(side) && walls.across(side).is_none_or(|other| side < other)).collect();
    (0..1_u32 << chosen.len()).any(|bits| {
        let mut pattern = vec![[Diagonal::Rising; 3]; walls.len()];
        let free = chosen
            .iter()
            .enumerate()
            .map(|(bit, &side)| (side, if bits >> bit & 1 == 1 { Diagonal::Rising } else { Diagonal::Falling }));
        for (side, diagonal) in free.chain(prescribed.iter().copied()) {
            pattern[side.triangle as usize][usize::from(side.side)] = diagonal;
            if let Some(other) = walls.across(side) {
                pattern[other.triangle as usize][usize::from(other.side)] = -diagonal;
            }
        }
        is_valid(walls, prescribed, &pattern)
    })
}

fn prescriptions(walls: &Walls, kind: u32, seeds: &[u32]) -> Vec<(Side, Diagonal)> {
    let diagonal = |seed: u32| if seed.is_multiple_of(2) { Diagonal::Rising } else { Diagonal::Falling };
    let all = walls.open_sides().zip(seeds.iter().cycle().skip(3));
    match kind {
        0 => all.map(|(side, &seed)| (side, diagonal(seed / 5))).collect(),
        1 => all.map(|(side, _)| (side, diagonal(seeds[0]))).collect(),
        2 => Vec::new(),
        _ => all.filter(|&(_, seed)| seed % 3 != 0).map(|(side, &seed)| (side, diagonal(seed / 7))).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A pattern is found exactly when brute force finds one, and an obstruction is minimal.
    #[test]
    fn patterns_are_found_whenever_there_are_any(
        count in 1_usize..6, kind in 0_u32..4, seeds in prop::collection::vec(0_u32..100_000, 6..9),
    ) {
        let walls = random_surface(count, &seeds);
        let prescribed = prescriptions(&walls, kind, &seeds);
        match cutting_pattern(&walls, &prescribed) {
            Ok(pattern) => prop_assert!(is_valid(&walls, &prescribed, &pattern)),
            Err(obstruction) => {
                prop_assert!(!has_pattern(&walls, &prescribed));
                for &left_out in &obstruction.triangles {
                    let rest: Vec<_> = prescribed.iter().copied().filter(|(side, _)| side.triangle != left_out).collect();
                    let mut without = walls.clone();
                    (0..3).for_each(|side| without.cut(Side::new(left_out, side)));
                    prop_assert!(has_pattern(&without, &rest));
                }
            }
        }
    }
}

#[test]
fn both_answers_occur_in_the_random_surfaces() {
    // The property above would hold for an empty set of obstructions, too.
    let mut found = [0, 0];
    for seed in 0..2000_u32 {
        let seeds: Vec<_> =
            (0..8).map(|i| seed.wrapping_mul(2_654_435_761).wrapping_add(i * 40_503) % 99_991).collect();
        let walls = random_surface(1 + seed as usize % 5, &seeds);
        let answer = cutting_pattern(&walls, &prescriptions(&walls, seed % 4, &seeds));
        found[usize::from(answer.is_err())] += 1;
    }
    assert!(found[0] > 1000 && found[1] > 50, "{found:?}");
}

#[test]
fn a_fan_without_a_vertex_inside_is_an_obstruction_and_with_one_is_none() {
    let fan: Vec<_> = (1..7).map(|i| [0, i, i + 1]).collect();
    let walls = Walls::new(&fan).unwrap();
    let rising: Vec<_> = walls.open_sides().map(|side| (side, Diagonal::Rising)).collect();
    assert_eq!(cutting_pattern(&walls, &rising).unwrap_err().triangles.len(), 6);
    let closed = Walls::new(&[fan, vec![[0, 7, 1]]].concat()).unwrap();
    let rising: Vec<_> = closed.open_sides().map(|side| (side, Diagonal::Rising)).collect();
    let pattern = cutting_pattern(&closed, &rising).unwrap();
    assert!(is_valid(&closed, &rising, &pattern));
}
