//! Fewer prisms: collapses, flips and thicker columns, each accepted only if the shell stays valid.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::directions::{dot, minus};
use super::layer::{Layer, area_and_sides};
use super::prism::{Column, Failure};
use crate::progress::Progress;

/// Middle triangles with a larger energy are not made, unless there were such before.
const LARGEST_ENERGY: f64 = 30.0;

/// The energy of a triangle: 2 for an equilateral one, without bound for flat ones (MIPS).
fn energy(layer: &Layer, corners: [u32; 3]) -> f64 {
    let (doubled_area, sides) = area_and_sides(corners.map(|v| layer.columns[v as usize][1]));
    sides / (3f64.sqrt() * doubled_area)
}

fn worst_energy(layer: &Layer, prisms: impl Iterator<Item = [u32; 3]>) -> f64 {
    prisms.map(|corners| energy(layer, corners)).fold(0.0, f64::max)
}

fn squared_length(layer: &Layer, a: u32, b: u32) -> f64 {
    let edge = minus(layer.columns[a as usize][1], layer.columns[b as usize][1]);
    edge.iter().map(|x| x * x).sum()
}

/// Collapses edges, the shortest first, until none can be, `enough` prisms are left or the work is cancelled. Returns
/// how many were.
pub(super) fn collapse_edges(layer: &mut Layer, enough: usize, progress: &dyn Progress) -> usize {
    let mut queue = BinaryHeap::new();
    let push = |layer: &Layer, queue: &mut BinaryHeap<_>, a: u32, b: u32| {
        let (a, b) = (a.min(b), a.max(b));
        queue.push(Reverse((squared_length(layer, a, b).to_bits(), a, b)));
    };
    for column in 0..layer.columns.len() as u32 {
        for other in layer.neighbours(column).into_iter().filter(|&other| other > column) {
            push(layer, &mut queue, column, other);
        }
    }
    let mut prisms = layer.count();
    let mut collapsed = 0;
    while let Some(Reverse((_, a, b))) = queue.pop() {
        if prisms <= enough || progress.is_cancelled() {
            break;
        }
        let Some(kept) = [(a, b), (b, a)].into_iter().find(|&(gone, kept)| collapse(layer, gone, kept)) else {
            continue;
        };
        let kept = kept.1;
        collapsed += 1;
        prisms -= 2;
        for other in layer.neighbours(kept) {
            push(layer, &mut queue, kept, other);
        }
    }
    collapsed
}

/// Moves column `gone` into its neighbour `kept`, if the shell stays valid.
fn collapse(layer: &mut Layer, gone: u32, kept: u32) -> bool {
    if !is_free(layer, gone) || !layer.kept.may_go(gone, kept) || !is_link_fit(layer, gone, kept) {
        return false;
    }
    let old = layer.around[gone as usize].clone();
    let moved = |prism: &u32| layer.prisms[*prism as usize].map(|v| if v == gone { kept } else { v });
    let is_kept = |prism: &&u32| !layer.prisms[**prism as usize].contains(&kept);
    let new: Vec<[u32; 3]> = old.iter().filter(is_kept).map(moved).collect();
    let before = worst_energy(layer, old.iter().map(|&p| layer.prisms[p as usize]));
    if worst_energy(layer, new.iter().copied()) > before.max(LARGEST_ENERGY) {
        return false;
    }
    let is_done = replace(layer, &old, &new);
    if is_done {
        layer.kept.collapse(gone, kept);
    }
    is_done
}

/// Replaces prisms by others if the shell stays valid; where new ones are not positive, with shorter columns, if the layer
/// allows that.
///
/// Columns that lean, as they do along sharp edges, make prisms positive only if they are short beside the triangles'
/// heights, and growth has made them as long as they could be.
fn replace(layer: &mut Layer, old: &[u32], new: &[[u32; 3]]) -> bool {
    match layer.replace(old, new) {
        Ok(()) => return true,
        Err((Failure::Volume, _)) if layer.may_shorten => {}
        Err(_) => return false,
    }
    let mut shorter: Vec<(u32, Column)> = Vec::new();
    let is_positive = new.iter().all(|&corners| shorten(layer, corners, &mut shorter));
    // A column that became shorter for one prism may spoil another.
    let holds = is_positive && new.iter().all(|&corners| layer.prism(corners).check_volumes().is_ok()) && {
        let mut touched: Vec<u32> =
            shorter.iter().flat_map(|(column, _)| &layer.around[*column as usize]).copied().collect();
        touched.sort_unstable();
        touched.dedup();
        touched.retain(|prism| !old.contains(prism));
        let unchanged = touched.iter().map(|&prism| layer.prisms[prism as usize]);
        let new: Vec<[u32; 3]> = new.iter().copied().chain(unchanged).collect();
        let old: Vec<u32> = old.iter().copied().chain(touched).collect();
        layer.replace(&old, &new).is_ok()
    };
    if !holds {
        for (column, before) in shorter.into_iter().rev() {
            layer.columns[column as usize] = before;
        }
    }
    holds
}

/// Halves the longest columns of a prism until it is positive; `shorter` gets those that change, with what they were.
fn shorten(layer: &mut Layer, corners: [u32; 3], shorter: &mut Vec<(u32, Column)>) -> bool {
    for _ in 0..MOST_HALVINGS {
        let Err((_, slab)) = layer.prism(corners).check_volumes() else { return true };
        let level = 2 * slab;
        let longest = corners.iter().map(|&v| reach(layer, v, level)).fold(0.0, f64::max);
        for column in corners {
            if is_free(layer, column) && reach(layer, column, level) > 0.6 * longest {
                let before = layer.columns[column as usize];
                shorter.push((column, before));
                layer.columns[column as usize][level] =
                    [0, 1, 2].map(|axis| 0.5 * (before[1][axis] + before[level][axis]));
            }
        }
    }
    false
}

/// How often the columns of a prism are halved for an operation.
const MOST_HALVINGS: usize = 4;

/// Whether a column may be changed: not on the boundary, and of some length.
fn is_free(layer: &Layer, column: u32) -> bool {
    !layer.is_frozen[column as usize] && !layer.is_pinched(column)
}

/// The link condition: the two columns exist, and share just the two neighbours opposite their edge.
fn is_link_fit(layer: &Layer, a: u32, b: u32) -> bool {
    let (first, second) = (layer.neighbours(a), layer.neighbours(b));
    let common: Vec<&u32> = first.iter().filter(|v| second.binary_search(v).is_ok()).collect();
    // Of a tetrahedron nothing may be taken away.
    first.binary_search(&b).is_ok() && common.len() == 2 && first.len() + second.len() > 6
}

/// Flips edges where that lowers the worse of the two energies. Returns how many were.
pub(super) fn flip_edges(layer: &mut Layer) -> usize {
    let mut flipped = 0;
    for prism in 0..layer.prisms.len() as u32 {
        for side in 0..3 {
            flipped += usize::from(layer.exists[prism as usize] && flip(layer, prism, side));
        }
    }
    flipped
}

fn flip(layer: &mut Layer, prism: u32, side: usize) -> bool {
    let corners = layer.prisms[prism as usize];
    let [a, b, c] = [side, (side + 1) % 3, (side + 2) % 3].map(|k| corners[k]);
    let beyond = layer.around[a as usize]
        .iter()
        .copied()
        .find(|&other| other != prism && layer.prisms[other as usize].contains(&b));
    // Each edge from the prism with the smaller number.
    let Some(other) = beyond.filter(|&other| other > prism) else { return false };
    let Some(d) = layer.prisms[other as usize].into_iter().find(|&v| v != a && v != b) else { return false };
    if layer.kept.is_edge(a, b)
        || layer.neighbours(c).binary_search(&d).is_ok()
        || layer.around[a as usize].len() < 4
        || layer.around[b as usize].len() < 4
    {
        return false;
    }
    let new = [[a, d, c], [d, b, c]];
    let before = energy(layer, corners).max(energy(layer, layer.prisms[other as usize]));
    worst_energy(layer, new.into_iter()) < 0.999 * before && replace(layer, &[prism, other], &new)
}

/// Makes columns up to half as long again as their neighbours on average, at most `target` on either side.
pub(super) fn thicken(layer: &mut Layer, target: f64) -> usize {
    let mut grown = 0;
    for column in 0..layer.columns.len() as u32 {
        if layer.around[column as usize].is_empty() || !is_free(layer, column) {
            continue;
        }
        let neighbours = layer.neighbours(column);
        for level in [0, 2] {
            let average = neighbours.iter().map(|&v| reach(layer, v, level)).sum::<f64>() / neighbours.len() as f64;
            let wanted = (1.5 * average).min(target);
            let is_longer = wanted > 1.001 * reach(layer, column, level);
            grown += usize::from(is_longer && stretch(layer, column, level, wanted));
        }
    }
    grown
}

/// Moves columns towards the middle of their neighbours where that lowers the worst energy round them, and turns
/// them towards their neighbours' directions. Returns how many moved.
pub(super) fn smooth(layer: &mut Layer, progress: &dyn Progress) -> usize {
    let mut moved = 0;
    for column in 0..layer.columns.len() as u32 {
        if progress.is_cancelled() {
            break;
        }
        if layer.around[column as usize].is_empty() || !is_free(layer, column) {
            continue;
        }
        let neighbours = layer.neighbours(column);
        let is_fixed = layer.kept.is_fixed(column);
        moved += usize::from(!is_fixed && pan(layer, column, &neighbours));
        moved += usize::from(turn(layer, column, &neighbours));
    }
    moved
}

/// Shifts a column along the surface: towards the centroid of its neighbours, as far as possible of 1, 1/2 and 1/4.
fn pan(layer: &mut Layer, column: u32, neighbours: &[u32]) -> bool {
    let before = layer.columns[column as usize];
    let centroid = mean(neighbours.iter().map(|&v| layer.columns[v as usize][1]));
    let [bottom, middle, top] = before;
    let (pillar, step) = (minus(top, bottom), minus(centroid, middle));
    let along = dot(step, pillar) / dot(pillar, pillar);
    let step: [f64; 3] = std::array::from_fn(|axis| step[axis] - along * pillar[axis]);
    let prisms = layer.around[column as usize].clone();
    let worst = |layer: &Layer| worst_energy(layer, prisms.iter().map(|&p| layer.prisms[p as usize]));
    let energy_before = worst(layer);
    [1.0, 0.5, 0.25].into_iter().any(|share| {
        let shifted = before.map(|p| std::array::from_fn(|axis| p[axis] + share * step[axis]));
        let Some(shifted) = layer.with_middle_on_surface(column, shifted) else { return false };
        layer.columns[column as usize] = shifted;
        let is_better = worst(layer) < 0.99 * energy_before && layer.recheck(column).is_ok();
        if !is_better {
            layer.columns[column as usize] = before;
        }
        is_better
    })
}

/// Gives a column the mean direction of its neighbours, half of it, or leaves it.
fn turn(layer: &mut Layer, column: u32, neighbours: &[u32]) -> bool {
    let before = layer.columns[column as usize];
    let unit = |v: [f64; 3]| {
        let length = dot(v, v).sqrt();
        v.map(|x| x / length)
    };
    let direction = |layer: &Layer, v: u32| unit(minus(layer.columns[v as usize][2], layer.columns[v as usize][0]));
    let own = direction(layer, column);
    let wanted = mean(neighbours.iter().filter(|&&v| !layer.is_pinched(v)).map(|&v| direction(layer, v)));
    if !wanted.iter().all(|x| x.is_finite()) || dot(unit(wanted), own) > 0.9999 {
        return false;
    }
    let [down, up] = [reach(layer, column, 0), reach(layer, column, 2)];
    [1.0, 0.5].into_iter().any(|share| {
        let turned = unit([0, 1, 2].map(|axis| own[axis] + share * (wanted[axis] - own[axis])));
        let at = |by: f64| [0, 1, 2].map(|axis| before[1][axis] + by * turned[axis]);
        layer.columns[column as usize] = [at(-down), before[1], at(up)];
        let is_valid = layer.recheck(column).is_ok();
        if !is_valid {
            layer.columns[column as usize] = before;
        }
        is_valid
    })
}

fn mean(points: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let (sum, count) =
        points.fold(([0.0; 3], 0.0), |(sum, count), p| ([0, 1, 2].map(|axis| sum[axis] + p[axis]), count + 1.0));
    sum.map(|x| x / count)
}

/// How far bottom or top is from the middle.
fn reach(layer: &Layer, column: u32, level: usize) -> f64 {
    let [.., middle, _] = layer.columns[column as usize];
    let step = minus(layer.columns[column as usize][level], middle);
    step.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Moves bottom or top along its pillar, if the shell stays valid.
fn stretch(layer: &mut Layer, column: u32, level: usize, wanted: f64) -> bool {
    let before = layer.columns[column as usize];
    let factor = wanted / reach(layer, column, level);
    let step = minus(before[level], before[1]);
    layer.columns[column as usize][level] = [0, 1, 2].map(|axis| before[1][axis] + factor * step[axis]);
    let is_valid = layer.recheck(column).is_ok();
    if !is_valid {
        layer.columns[column as usize] = before;
    }
    is_valid
}
