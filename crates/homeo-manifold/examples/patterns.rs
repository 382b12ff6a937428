//! Times cutting patterns of random disks with a million triangles, for three kinds of boundaries.
//! `cargo run --release -p homeo-manifold --example patterns -- [TRIANGLES]`
#![allow(clippy::print_stdout)] // this is its purpose

use homeo_manifold::bundle::{Diagonal, Side, Walls, cutting_pattern};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let count: usize = std::env::args().nth(1).map_or(Ok(1_000_000), |text| text.parse())?;
    println!("| boundary | disk | triangles | walls, s | pattern, s |");
    println!("|---|---|---:|---:|---:|");
    for (name, disk) in [("grid, random diagonals", grid(count)), ("random, by ears and splits", random_disk(count))] {
        let start = Instant::now();
        let walls = Walls::new(&disk)?;
        let neighbours = start.elapsed().as_secs_f64();
        for boundary in ["free", "the same everywhere", "random"] {
            let mut random = Random(7);
            let prescribed: Vec<(Side, Diagonal)> = match boundary {
                "free" => Vec::new(),
                "random" => walls.open_sides().map(|side| (side, random.diagonal())).collect(),
                _ => walls.open_sides().map(|side| (side, Diagonal::Rising)).collect(),
            };
            let start = Instant::now();
            let pattern = cutting_pattern(&walls, &prescribed)?;
            let seconds = start.elapsed().as_secs_f64();
            if !pattern.iter().all(|sides| sides.contains(&Diagonal::Rising) && sides.contains(&Diagonal::Falling)) {
                return Err("a triangle has three times the same".into());
            }
            println!("| {boundary} | {name} | {} | {neighbours:.2} | {seconds:.2} |", disk.len());
        }
    }
    Ok(())
}

/// A multiplicative generator of random numbers.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % count as u64) as usize
    }

    fn diagonal(&mut self) -> Diagonal {
        if self.below(2) == 0 { Diagonal::Rising } else { Diagonal::Falling }
    }
}

/// A square of squares, each cut along one of its diagonals.
fn grid(count: usize) -> Vec<[u32; 3]> {
    let (side, mut random) = (((count / 2) as f64).sqrt().ceil() as u32, Random(1));
    let at = |i: u32, j: u32| i * (side + 1) + j;
    let mut triangles = Vec::with_capacity(2 * (side * side) as usize);
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        triangles.extend(if random.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    triangles
}

/// Starting from one triangle, by new triangles at random places of the boundary and by splitting random triangles in three.
fn random_disk(count: usize) -> Vec<[u32; 3]> {
    let (mut triangles, mut random, mut vertices) = (vec![[0, 1, 2]], Random(3), 3_u32);
    let mut boundary = vec![[0, 1], [1, 2], [2, 0]];
    while triangles.len() < count {
        if random.below(2) == 0 {
            let number = random.below(boundary.len());
            let [a, b] = boundary[number];
            triangles.push([b, a, vertices]);
            boundary[number] = [a, vertices];
            boundary.push([vertices, b]);
        } else {
            let number = random.below(triangles.len());
            let [a, b, c] = triangles[number];
            triangles[number] = [a, b, vertices];
            triangles.extend([[b, c, vertices], [c, a, vertices]]);
        }
        vertices += 1;
    }
    triangles
}
