//! Two triangulations of a convex polygon, laid over one another; only who crosses whom matters, not where.

use std::collections::HashMap;

/// The common refinement of two triangulations of a convex polygon without inner vertices.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Overlay {
    /// Where chords cross; numbered after the corners of the polygon.
    pub crossings: Vec<Crossing>,
    /// Convex cells, counter-clockwise; none has three corners in a line, in either triangulation.
    pub cells: Vec<Vec<u32>>,
}

/// A crossing of a chord of the first triangulation and one of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// The ends of both chords.
    pub chords: [[u32; 2]; 2],
    /// At which part of each chord: crossings divide it evenly.
    pub shares: [f64; 2],
}

/// A triangulation, by the triangle to the left of each directed edge.
struct Fan {
    count: u32,
    apexes: HashMap<[u32; 2], u32>,
    chords: Vec<[u32; 2]>,
}

impl Fan {
    fn new(count: u32, triangles: &[[u32; 3]]) -> Self {
        let turned = |corners: &[u32; 3]| [0, 1, 2].map(|k| [0, 1, 2].map(|step| corners[(k + step) % 3]));
        let apexes: HashMap<[u32; 2], u32> =
            triangles.iter().flat_map(turned).map(|[a, b, apex]| ([a, b], apex)).collect();
        let mut chords: Vec<[u32; 2]> =
            apexes.keys().copied().filter(|&[a, b]| a < b && apexes.contains_key(&[b, a])).collect();
        chords.sort_unstable();
        Self { count, apexes, chords }
    }

    /// The chords, from the lower to the higher corner, that a straight line from corner to corner crosses, in order.
    fn crossed(&self, [from, to]: [u32; 2]) -> Vec<[u32; 2]> {
        let ahead = |corner: u32| (corner + self.count - from) % self.count;
        let mut crossed = Vec::new();
        let mut right = (from + 1) % self.count;
        // Round the first corner to the triangle that the line enters.
        let mut left = loop {
            let Some(&left) = self.apexes.get(&[from, right]) else { return crossed };
            match ahead(left) {
                there if there > ahead(to) && ahead(right) < ahead(to) => break left,
                _ => right = left,
            }
        };
        while let Some(&apex) = self.apexes.get(&[left, right]) {
            crossed.push([left.min(right), left.max(right)]);
            match ahead(apex).cmp(&ahead(to)) {
                std::cmp::Ordering::Less => right = apex,
                std::cmp::Ordering::Equal => break,
                std::cmp::Ordering::Greater => left = apex,
            }
        }
        crossed
    }
}

impl Overlay {
    /// Lays two triangulations of a polygon with `count` corners over one another.
    ///
    /// # Complexity
    /// Linear in the number of crossings, which is at most quadratic in that of corners.
    pub fn new(count: usize, triangles: [&[[u32; 3]]; 2]) -> Self {
        let fans = triangles.map(|triangles| Fan::new(count as u32, triangles));
        let crossed = [0, 1].map(|side| {
            let chords = fans[side].chords.iter();
            chords.map(|&chord| fans[1 - side].crossed(chord)).collect::<Vec<Vec<[u32; 2]>>>()
        });
        let share = |place: usize, chord: &[[u32; 2]]| (place + 1) as f64 / (chord.len() + 1) as f64;
        let mut crossings = Vec::new();
        let mut numbers = HashMap::new();
        for (first, others) in fans[0].chords.iter().zip(&crossed[0]) {
            for (place, second) in others.iter().enumerate() {
                numbers.insert([*first, *second], (count + crossings.len()) as u32);
                crossings.push(Crossing { chords: [*first, *second], shares: [share(place, others), 0.0] });
            }
        }
        for (second, others) in fans[1].chords.iter().zip(&crossed[1]) {
            for (place, first) in others.iter().enumerate() {
                if let Some(&number) = numbers.get(&[*first, *second]) {
                    crossings[number as usize - count].shares[1] = share(place, others);
                }
            }
        }
        let lines = [0, 1].map(|side| {
            let line = |(chord, others): (&[u32; 2], &Vec<[u32; 2]>)| {
                let key = |other: &[u32; 2]| if side == 0 { [*chord, *other] } else { [*other, *chord] };
                let between = others.iter().filter_map(|other| numbers.get(&key(other)).copied());
                std::iter::once(chord[0]).chain(between).chain([chord[1]]).collect::<Vec<u32>>()
            };
            fans[side].chords.iter().zip(&crossed[side]).map(line).collect::<Vec<_>>()
        });
        let cells = cells(&neighbours(count as u32, &crossings, &lines), count as u32);
        Self { crossings, cells }
    }
}

/// The neighbours of each corner and crossing, counter-clockwise, those of a corner from the next corner to the one before.
fn neighbours(count: u32, crossings: &[Crossing], lines: &[Vec<Vec<u32>>; 2]) -> Vec<Vec<u32>> {
    let ahead = |corner: u32, of: u32| (corner + count - of) % count;
    let mut fans: Vec<Vec<(u32, u32)>> =
        (0..count).map(|i| vec![(1, (i + 1) % count), (count - 1, (i + count - 1) % count)]).collect();
    let mut around: Vec<[u32; 4]> = vec![[0; 4]; crossings.len()];
    for (side, line) in (0..2).flat_map(|side| lines[side].iter().map(move |line| (side, line))) {
        let (from, to) = (line[0], line[line.len() - 1]);
        fans[from as usize].push((ahead(to, from), line[1]));
        fans[to as usize].push((ahead(from, to), line[line.len() - 2]));
        for three in line.windows(3) {
            let number = (three[1] - count) as usize;
            let [[a, b], [c, _]] = crossings[number].chords;
            let is_right = a < c && c < b;
            // Round a crossing: on along the first chord, to its left, back, to its right.
            let [forward, back] = match (side, is_right) {
                (0, _) => [0, 2],
                (_, true) => [1, 3],
                (_, false) => [3, 1],
            };
            around[number][forward] = three[2];
            around[number][back] = three[0];
        }
    }
    let sorted = |mut fan: Vec<(u32, u32)>| {
        // A chord of both triangulations is one edge.
        fan.sort_unstable();
        fan.dedup();
        fan.into_iter().map(|(_, neighbour)| neighbour).collect::<Vec<u32>>()
    };
    fans.into_iter().map(sorted).chain(around.into_iter().map(Vec::from)).collect()
}

/// The faces of a planar graph to the left of its directed edges, but for the outer one.
fn cells(neighbours: &[Vec<u32>], count: u32) -> Vec<Vec<u32>> {
    let mut places = HashMap::new();
    for (from, fan) in neighbours.iter().enumerate() {
        places.extend(fan.iter().enumerate().map(|(place, &to)| ([from as u32, to], place)));
    }
    let mut is_done: Vec<Vec<bool>> = neighbours.iter().map(|fan| vec![false; fan.len()]).collect();
    let mut cells = Vec::new();
    for start in 0..neighbours.len() as u32 {
        for first in 0..neighbours[start as usize].len() {
            // The way back from a corner to the one before has the outside to its left.
            let is_outer = start < count && first + 1 == neighbours[start as usize].len();
            if is_outer || is_done[start as usize][first] {
                continue;
            }
            let mut cell = Vec::new();
            let (mut here, mut place) = (start, first);
            while !std::mem::replace(&mut is_done[here as usize][place], true) {
                cell.push(here);
                let there = neighbours[here as usize][place];
                let Some(back) = places.get(&[there, here]) else { break };
                let fan = neighbours[there as usize].len();
                (here, place) = (there, (back + fan - 1) % fan);
            }
            cells.push(cell);
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_of_a_square_cross_once() {
        let overlay = Overlay::new(4, [&[[0, 1, 2], [0, 2, 3]], &[[1, 2, 3], [1, 3, 0]]]);
        let crossing = Crossing { chords: [[0, 2], [1, 3]], shares: [0.5, 0.5] };
        assert_eq!(overlay.crossings, [crossing]);
        assert_eq!(overlay.cells, [[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 3, 4]]);
    }

    #[test]
    fn the_same_triangles_are_the_cells() {
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
        let overlay = Overlay::new(5, [&fan, &fan]);
        assert!(overlay.crossings.is_empty());
        assert_eq!(overlay.cells, fan);
    }

    #[test]
    fn fans_cross_as_often_as_places_say() {
        // The chord from 0 to i crosses those from 1 to beyond i.
        let n = 9u32;
        let first: Vec<[u32; 3]> = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        let second: Vec<[u32; 3]> = (2..n).map(|i| [1, i, (i + 1) % n]).collect();
        let overlay = Overlay::new(n as usize, [&first, &second]);
        let expected: u32 = (2..n - 1).map(|i| n - 1 - i).sum();
        assert_eq!(overlay.crossings.len(), expected as usize);
        let corners: usize = overlay.cells.iter().map(Vec::len).sum();
        // Euler: edges twice, less those of the boundary, are the sides of cells.
        let edges = corners.midpoint(n as usize);
        assert_eq!(n as usize + overlay.crossings.len() + overlay.cells.len(), edges + 1);
    }
}
