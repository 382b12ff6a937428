//! The cells over one middle triangle as triangles with common vertices.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use homeo_core::number::{Interval, Lazy, Scalar};

use super::Cell;
use super::names::{Name, Origin};
use super::polygon::Place;
use super::rounding::Rounding;
use crate::map::Shell;

type Point = [f64; 3];

/// Intervals wider than this are replaced by exact values before places are compared.
const WIDE: f64 = 1e-9;

/// A vertex of the refinement in one prism.
pub(super) struct PatchVertex {
    /// A cell of the prism, and its corner there.
    pub seen_at: [u32; 2],
    pub on_source: Point,
    pub on_section: Point,
    pub on_middle: Point,
    pub border: Border,
    pub names: Vec<Name>,
}

/// Where on the border of its prism a vertex is.
pub(super) enum Border {
    Inside,
    /// Between two columns, in ascending order, with the weight of the second one.
    Side([u32; 2], Lazy),
    Column(u32),
}

/// The refinement in one prism.
pub(super) struct Patch {
    pub columns: [u32; 3],
    pub vertices: Vec<PatchVertex>,
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle, the one of the source and the one of the section that it lies in.
    pub parents: Vec<[u32; 2]>,
}

impl Patch {
    /// Joins the cells of a prism.
    pub fn new(shell: &Shell, prism: u32, cells: &[Cell], rounding: &Rounding) -> Self {
        let columns = shell.parts().prisms[prism as usize];
        let mut spots = Spots::default();
        let corners: Vec<Vec<u32>> = cells.iter().enumerate().map(|(k, cell)| spots.of_cell(k, cell)).collect();
        spots.join_equal();
        let (numbers, vertices) = spots.numbered(shell, columns, cells, rounding);
        let (mut triangles, mut parents) = (Vec::new(), Vec::new());
        for (cell, corners) in cells.iter().zip(&corners) {
            let corners: Vec<u32> = corners.iter().map(|&spot| numbers[spot as usize]).collect();
            for fan in fan(cell) {
                triangles.push(fan.map(|k| corners[k]));
                parents.push([cell.source, cell.section]);
            }
        }
        Self { columns, vertices, triangles, parents }
    }
}

/// Cuts a convex cell into triangles from that corner from which the smallest of them is largest, by rounded areas: any
/// corner will do.
fn fan(cell: &Cell) -> Vec<[usize; 3]> {
    let n = cell.corners.len();
    let places: Vec<[f64; 2]> = cell.corners.iter().map(|[a, b, _]| [a, b].map(middle)).collect();
    let area = |[a, b, c]: [usize; 3]| {
        let [u, v] = [b, c].map(|k| [0, 1].map(|axis| places[k][axis] - places[a][axis]));
        u[0] * v[1] - u[1] * v[0]
    };
    let from = |k: usize| (1..n - 1).map(move |i| [k, (k + i) % n, (k + i + 1) % n]);
    let smallest = |k: usize| from(k).map(area).fold(f64::INFINITY, f64::min);
    let best = (1..n).fold(0, |best, k| if smallest(k) > smallest(best) { k } else { best });
    from(best).collect()
}

fn middle(number: &Lazy) -> f64 {
    number.interval().middle_and_radius().0
}

/// Corners of cells, by what they are called; some of them the same, under the first of their numbers.
#[derive(Default)]
struct Spots {
    known: HashMap<Name, u32>,
    places: Vec<Place>,
    /// The cell and the corner that each was first seen as.
    seen_at: Vec<[u32; 2]>,
    names: Vec<Vec<Name>>,
    /// A smaller number of the same spot, or its own.
    smaller: Vec<u32>,
}

impl Spots {
    /// The numbers of the corners of a cell.
    fn of_cell(&mut self, number: usize, cell: &Cell) -> Vec<u32> {
        (0..cell.corners.len()).map(|k| self.of_corner(cell, [number as u32, k as u32])).collect()
    }

    fn of_corner(&mut self, cell: &Cell, seen_at: [u32; 2]) -> u32 {
        let names = cell.names[seen_at[1] as usize];
        let known = names.iter().find_map(|name| self.known.get(&name).copied());
        let spot = known.unwrap_or_else(|| {
            self.places.push(cell.corners[seen_at[1] as usize].clone());
            self.seen_at.push(seen_at);
            self.names.push(Vec::new());
            self.smaller.push(self.smaller.len() as u32);
            self.smaller.len() as u32 - 1
        });
        for name in names.iter() {
            match self.known.entry(name) {
                Entry::Occupied(entry) => {
                    let other = *entry.get();
                    self.join(spot, other);
                }
                Entry::Vacant(entry) => {
                    entry.insert(spot);
                    self.names[spot as usize].push(name);
                }
            }
        }
        spot
    }

    fn first(&self, mut spot: u32) -> u32 {
        while self.smaller[spot as usize] != spot {
            spot = self.smaller[spot as usize];
        }
        spot
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.smaller[a.max(b) as usize] = a.min(b);
    }

    /// Joins those at equal places: exact numbers decide where intervals meet.
    fn join_equal(&mut self) {
        let firsts: Vec<u32> = (0..self.places.len() as u32).filter(|&spot| self.first(spot) == spot).collect();
        let mut ranges: Vec<(Interval, u32)> = Vec::with_capacity(firsts.len());
        for spot in firsts {
            let place = &self.places[spot as usize];
            let is_wide = |number: &&Lazy| number.interval().middle_and_radius().1 > WIDE;
            place.iter().filter(is_wide).for_each(|number| _ = number.exact());
            ranges.push((across(place), spot));
        }
        ranges.sort_by(|(a, i), (b, j)| a.low().total_cmp(&b.low()).then(i.cmp(j)));
        for (k, (range, spot)) in ranges.iter().enumerate() {
            for (_, other) in ranges[k + 1..].iter().take_while(|(other, _)| other.low() <= range.high()) {
                if is_same(&self.places[*spot as usize], &self.places[*other as usize]) {
                    self.join(*spot, *other);
                }
            }
        }
    }

    /// For each spot its vertex, and the vertices in the order in which they were first seen.
    fn numbered(
        mut self,
        shell: &Shell,
        columns: [u32; 3],
        cells: &[Cell],
        rounding: &Rounding,
    ) -> (Vec<u32>, Vec<PatchVertex>) {
        let firsts: Vec<u32> = (0..self.places.len() as u32).map(|spot| self.first(spot)).collect();
        for (spot, &first) in firsts.iter().enumerate().filter(|(spot, first)| *spot != **first as usize) {
            let names = std::mem::take(&mut self.names[spot]);
            self.names[first as usize].extend(names);
        }
        let mut numbers = vec![0; firsts.len()];
        let mut vertices = Vec::new();
        for (spot, &first) in firsts.iter().enumerate() {
            if spot != first as usize {
                numbers[spot] = numbers[first as usize];
                continue;
            }
            numbers[spot] = vertices.len() as u32;
            let (place, names) = (&self.places[spot], std::mem::take(&mut self.names[spot]));
            let cell = &cells[self.seen_at[spot][0] as usize];
            let vertex_of = |wanted: fn(&Name) -> Option<u32>| names.iter().find_map(wanted);
            vertices.push(PatchVertex {
                seen_at: self.seen_at[spot],
                on_source: rounding.on_source(shell, cell, place, vertex_of(source_vertex)),
                on_section: rounding.on_section(shell, cell, place, vertex_of(section_vertex)),
                on_middle: rounding.on_middle(shell, cell.prism, place),
                border: border(columns, place),
                names,
            });
        }
        (numbers, vertices)
    }
}

fn source_vertex(name: &Name) -> Option<u32> {
    if let Name::Source(Origin::Vertex(v)) = name { Some(*v) } else { None }
}

fn section_vertex(name: &Name) -> Option<u32> {
    if let Name::Section(Origin::Vertex(v)) = name { Some(*v) } else { None }
}

/// How far along a line in no special direction a place is.
fn across([a, b, _]: &Place) -> Interval {
    let part = |number: &Lazy, factor: f64| number.interval().times(&Interval::from_f64(factor));
    part(a, 0.618).plus(&part(b, 0.271))
}

/// Whether two places are one: the third weights follow.
fn is_same(a: &Place, b: &Place) -> bool {
    let meet = |k: usize| {
        let [x, y] = [a, b].map(|place| place[k].interval());
        x.low() <= y.high() && y.low() <= x.high()
    };
    (0..3).all(meet) && (0..2).all(|k| a[k] == b[k])
}

fn border(columns: [u32; 3], place: &Place) -> Border {
    let held: Vec<usize> = (0..3).filter(|&k| !place[k].is_zero()).collect();
    match held.as_slice() {
        [k] => Border::Column(columns[*k]),
        [i, j] => {
            let (low, high) = if columns[*i] < columns[*j] { (*i, *j) } else { (*j, *i) };
            Border::Side([columns[low], columns[high]], place[high].clone())
        }
        _ => Border::Inside,
    }
}
