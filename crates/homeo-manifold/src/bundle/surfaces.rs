//! Surfaces for tests.

use super::walls::{Side, Walls};

/// A torus of `a` by `b` squares, both at least 3.
pub(crate) fn torus(a: u32, b: u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| i % a * b + j % b;
    let square = move |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
    (0..a).flat_map(|i| (0..b).flat_map(move |j| square(i, j))).collect()
}

/// A surface of a genus: tori in a row, each joined with the next where a triangle of both is left out.
pub(crate) fn glued_handles(genus: u32) -> Vec<[u32; 3]> {
    let size = 5;
    let mut all = torus(size, size);
    for handle in 1..genus {
        let first = handle * size * size;
        let last = all.len() - 1;
        let hole = all.remove(last);
        let mut next: Vec<[u32; 3]> = torus(size, size).into_iter().map(|t| t.map(|v| v + first)).collect();
        // Its first triangle is left out, turned, and its corners are those of the hole.
        let door = next.remove(0);
        let turned = [door[0], door[2], door[1]];
        for triangle in &mut next {
            for vertex in triangle {
                if let Some(corner) = turned.iter().position(|corner| corner == vertex) {
                    *vertex = hole[corner];
                }
            }
        }
        all.extend(next);
    }
    compressed(all)
}

/// The same triangles with vertices numbered without gaps.
fn compressed(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut names: Vec<u32> = triangles.iter().flatten().copied().collect();
    names.sort_unstable();
    names.dedup();
    for vertex in triangles.iter_mut().flatten() {
        *vertex = names.partition_point(|&name| name < *vertex) as u32;
    }
    triangles
}

/// The number of pieces that triangles fall into, if all of them are disks; otherwise 0.
pub(crate) fn disks(triangles: &[[u32; 3]], walls: &Walls) -> usize {
    let mut piece = vec![usize::MAX; triangles.len()];
    let mut count = 0;
    for first in 0..triangles.len() {
        if piece[first] != usize::MAX {
            continue;
        }
        let mut members = vec![first as u32];
        piece[first] = count;
        let mut next = 0;
        while let Some(&triangle) = members.get(next) {
            next += 1;
            for other in (0..3).filter_map(|side| walls.across(Side::new(triangle, side))) {
                if piece[other.triangle as usize] == usize::MAX {
                    piece[other.triangle as usize] = count;
                    members.push(other.triangle);
                }
            }
        }
        if euler_characteristic(&members, walls) != 1 {
            return 0;
        }
        count += 1;
    }
    count
}

/// Of connected triangles: corners that meet across sides are one vertex, also where the surface touches itself.
fn euler_characteristic(members: &[u32], walls: &Walls) -> i64 {
    let mut corners = std::collections::BTreeSet::new();
    let mut vertices = 0;
    let mut sides = 0;
    for &triangle in members {
        for side in 0..3 {
            let across = walls.across(Side::new(triangle, side));
            sides += if across.is_some() { 1 } else { 2 };
            if corners.insert((triangle, side)) {
                vertices += 1;
                let mut waiting = vec![(triangle, side)];
                while let Some((triangle, corner)) = waiting.pop() {
                    // The side that starts here ends there across it, and the one that ends here starts there.
                    let after = walls.across(Side::new(triangle, corner)).map(|o| (o.triangle, (o.side + 1) % 3));
                    let before = walls.across(Side::new(triangle, (corner + 2) % 3)).map(|o| (o.triangle, o.side));
                    waiting.extend([after, before].into_iter().flatten().filter(|&next| corners.insert(next)));
                }
            }
        }
    }
    vertices - sides / 2 + members.len() as i64
}
