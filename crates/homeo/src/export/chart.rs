//! The disks from which a bundle is glued, laid out in the plane.

use homeo_manifold::bundle::{Side, TangentBundle, Walls};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Sweeps of the layout: each vertex inside goes to the mean of its neighbours.
const SWEEPS: usize = 400;

/// All disks, each in the unit disk.
pub(super) struct Charts {
    /// The corners of each triangle as vertices of its disk: those at cuts are there once for each side.
    pub corners: Vec<[u32; 3]>,
    /// Where these vertices are.
    pub points: Vec<[f64; 3]>,
    /// Which disk each is in.
    pub disks: Vec<u16>,
    /// Sides at the boundaries, in order round each disk, and the number of the cut each is on.
    pub boundary: Vec<(Side, u16)>,
}

impl Charts {
    /// The layout by means of neighbours with the boundary on the circle (Tutte). A display: nothing is proved of it.
    pub fn new(tangent: &TangentBundle) -> Option<Self> {
        let triangles = tangent.bundle.triangles();
        let mut walls = Walls::new(triangles).ok()?;
        let cut: HashMap<[u32; 2], u16> = (0..)
            .zip(&tangent.cuts)
            .flat_map(|(number, path)| {
                path.windows(2).map(move |step| ([step[0].min(step[1]), step[0].max(step[1])], number))
            })
            .collect();
        let key = |side: Side| {
            let [a, b] = ends(triangles, side);
            [a.min(b), a.max(b)]
        };
        walls
            .sides()
            .filter(|&side| cut.contains_key(&key(side)))
            .collect::<Vec<_>>()
            .into_iter()
            .for_each(|side| walls.cut(side));
        let (corners, count) = classes(&walls);
        let mut charts = Self { corners, points: vec![[0.0; 3]; count], disks: vec![0; count], boundary: Vec::new() };
        charts.go_round(&walls, |side| cut.get(&key(side)).copied().unwrap_or(0));
        charts.relax(&walls);
        Some(charts)
    }

    /// Puts each boundary onto the circle, and numbers the disks.
    fn go_round(&mut self, walls: &Walls, cut: impl Fn(Side) -> u16) {
        let next: HashMap<u32, Side> = walls
            .open_sides()
            .map(|side| (self.corners[side.triangle as usize][usize::from(side.side)], side))
            .collect();
        let mut seen = HashSet::new();
        let mut disk = 0;
        for first in walls.open_sides() {
            let mut path = Vec::new();
            let mut side = first;
            while seen.insert(side) {
                path.push(side);
                let end = self.corners[side.triangle as usize][usize::from(side.side + 1) % 3];
                let Some(&after) = next.get(&end) else { break };
                side = after;
            }
            for (number, side) in path.iter().enumerate() {
                let angle = TAU * number as f64 / path.len() as f64;
                let vertex = self.corners[side.triangle as usize][usize::from(side.side)] as usize;
                self.points[vertex] = [angle.cos(), angle.sin(), 0.0];
            }
            if let Some(side) = path.first() {
                self.mark(walls, side.triangle, disk);
                disk += 1;
            }
            self.boundary.extend(path.into_iter().map(|side| (side, cut(side))));
        }
    }

    fn mark(&mut self, walls: &Walls, first: u32, disk: u16) {
        let mut seen = HashSet::from([first]);
        let mut waiting = vec![first];
        while let Some(triangle) = waiting.pop() {
            self.corners[triangle as usize].iter().for_each(|&corner| self.disks[corner as usize] = disk);
            let others = (0..3).filter_map(|side| walls.across(Side::new(triangle, side)));
            waiting.extend(others.map(|other| other.triangle).filter(|&other| seen.insert(other)));
        }
    }

    fn relax(&mut self, walls: &Walls) {
        let fixed: HashSet<u32> =
            walls.open_sides().map(|side| self.corners[side.triangle as usize][usize::from(side.side)]).collect();
        let mut neighbours = vec![Vec::new(); self.points.len()];
        for corners in &self.corners {
            for k in 0..3 {
                neighbours[corners[k] as usize].push(corners[(k + 1) % 3]);
            }
        }
        for _ in 0..SWEEPS {
            for (vertex, around) in
                neighbours.iter().enumerate().filter(|(vertex, _)| !fixed.contains(&(*vertex as u32)))
            {
                let mean = |axis: usize| {
                    around.iter().map(|&other| self.points[other as usize][axis]).sum::<f64>() / around.len() as f64
                };
                // Overshooting halves the number of sweeps and more.
                let here = self.points[vertex];
                self.points[vertex] = [0, 1, 2].map(|axis| here[axis] + 1.7 * (mean(axis) - here[axis]));
            }
        }
    }
}

pub(super) fn ends(triangles: &[[u32; 3]], side: Side) -> [u32; 2] {
    let corners = triangles[side.triangle as usize];
    [corners[usize::from(side.side)], corners[usize::from(side.side + 1) % 3]]
}

/// Corners that meet across sides have the same number; how many numbers there are.
fn classes(walls: &Walls) -> (Vec<[u32; 3]>, usize) {
    let mut numbers = vec![[u32::MAX; 3]; walls.len()];
    let mut count = 0;
    for corner in walls.sides() {
        if numbers[corner.triangle as usize][usize::from(corner.side)] != u32::MAX {
            continue;
        }
        let mut waiting = vec![corner];
        while let Some(corner) = waiting.pop() {
            let slot = &mut numbers[corner.triangle as usize][usize::from(corner.side)];
            if *slot != u32::MAX {
                continue;
            }
            *slot = count;
            // The side that starts here ends there across it, and the one that ends here starts there.
            let after = walls.across(corner).map(|other| Side::new(other.triangle, (other.side + 1) % 3));
            let before = walls.across(Side::new(corner.triangle, (corner.side + 2) % 3));
            waiting.extend([after, before].into_iter().flatten());
        }
        count += 1;
    }
    (numbers, count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A torus is one disk, a sphere two; the layouts have no triangle turned over.
    #[test]
    fn disks_are_laid_out_without_folds() {
        let torus: Vec<[u32; 3]> = (0..7_u32)
            .flat_map(|i| (0..5_u32).map(move |j| (i, j)))
            .flat_map(|(i, j)| {
                let at = |i: u32, j: u32| i % 7 * 5 + j % 5;
                [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
            })
            .collect();
        let sphere: Vec<[u32; 3]> = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
        for (triangles, count, disks) in [(torus, 35, 1), (sphere, 6, 2)] {
            let tangent = TangentBundle::new(&triangles, count, 4).expect("a surface");
            let charts = Charts::new(&tangent).expect("charts");
            assert_eq!(charts.disks.iter().max().map(|most| most + 1), Some(disks));
            let area = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|corner| charts.points[corner as usize]);
                (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            };
            let areas: Vec<f64> = charts.corners.iter().map(area).collect();
            // Sides that cut corners off a disk leave flat triangles at the circle, but none is turned over.
            assert!(areas.iter().all(|&area| area > -1e-9), "{areas:?}");
            let mut regular: f64 = areas.iter().sum::<f64>() / 2.0;
            let polygon = |sides: f64| sides / 2.0 * (TAU / sides).sin();
            for disk in 0..disks {
                let of_disk =
                    |side: &&(Side, u16)| charts.disks[charts.corners[side.0.triangle as usize][0] as usize] == disk;
                regular -= polygon(charts.boundary.iter().filter(of_disk).count() as f64);
            }
            assert!(regular.abs() < 1e-9, "the triangles fill the polygons: {regular}");
        }
    }
}
