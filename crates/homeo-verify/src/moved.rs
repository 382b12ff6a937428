//! Rules M1 to M5: a mesh whose vertices have moved, tetrahedra or a surface. The map that is linear on its cells is a
//! homeomorphism from the mesh before onto the mesh after, as sets of points in space.
//!
//! *Theorem* (`docs/theory/cages.md`). Let every vertex link of a connected complex of tetrahedra be a sphere or a disk. If
//! all cells are positive when ordered consistently, no two triangles of the boundary meet but in common vertices and
//! edges, and exactly one piece of the boundary encloses a positive volume, then the linear map to space is one-to-one.
//! It is applied before and after.

use crate::complex::{Complex, UnionFind};
use crate::links::check_manifold;
use crate::map_file::MapFile;
use crate::number::{Point, in_finest_units, is_flat_triangle, orientation_3d};
use crate::source::check_finite;
use crate::triangles::{BoxTree, bounds, do_clash};
use crate::verdict::{Checked, Stop, check, refuted};
use dashu_int::IBig;
use std::cmp::Ordering;

/// The claim in words.
pub(crate) fn statement(map: &MapFile, theorem: &str) -> String {
    let size = map.manifest.cell_size();
    let (what, kept) = match size {
        4 => ("tetrahedra", "linear on every cell, and keeps orientation"),
        _ => ("triangles", "linear on every cell"),
    };
    format!(
        "The stored map is a homeomorphism from the mesh of {} vertices and {} {what} onto the mesh of the same cells whose \
         vertices have moved, as sets of points in space; it is {kept} ({theorem}). Neither mesh meets itself.",
        map.positions.len(),
        map.cells.len() / size,
    )
}

/// Where the vertices are, and what is said of it.
pub(crate) struct Placement<'a> {
    pub(crate) points: &'a [Point],
    pub(crate) when: &'a str,
    /// The rule on cells, and that on triangles.
    pub(crate) rules: [&'static str; 2],
}

/// Applies the rules to a mesh with vertices before and after, as many.
pub(crate) fn check_moved(map: &MapFile, after: &[Point]) -> Checked<Vec<(&'static str, u64)>> {
    let before = Placement { points: &map.positions, when: "before it moves", rules: ["M2", "M4"] };
    let after = Placement { points: after, when: "after it has moved", rules: ["M3", "M5"] };
    check_finite(before.points)?;
    let size = map.manifest.cell_size();
    let complex = Complex::new(size, map.cells.clone(), before.points.len(), ["S2", "M1"])?;
    // M1: a manifold, for tetrahedra in one piece.
    let found = check_manifold(&complex, "the mesh", "M1")?;
    let is_whole = found.components == 1 || size == 3 && found.components > 1;
    check(is_whole, "M1", &format!("the mesh has {} pieces", found.components), &[], &[])?;
    // M2: not flat before, neighbours on opposite sides.
    let signs = check_signs(&complex, &before)?;
    complex.check_sides("M2", |_, _| size == 4, |c| signs[c] == Ordering::Greater)?;
    after.drawn(check_kept(&complex, &signs, &after))?;
    // M4 and M5: the surface, or the boundary of the volume.
    let skin = Skin::new(&complex, &signs)?;
    skin.check(&before)?;
    after.drawn(skin.check(&after))?;
    let cells_checked = match size {
        4 => "source tetrahedra with manifold links that are not flat and keep their sign (rules S2, M1-M3)",
        _ => "source triangles with manifold links that are not flat (rules S2, M1-M3)",
    };
    Ok(vec![
        ("source vertices, finite before and after (rules S1, M3)", before.points.len() as u64),
        (cells_checked, complex.count() as u64),
        ("triangles that meet in common vertices and edges only, before and after (rules M4, M5)", skin.count()),
        ("pieces of the boundary: the outer one, and cavities (rules M4, M5)", skin.piece_count()),
    ])
}

/// M3: vertices are finite after, cells not flat, and tetrahedra keep their signs.
fn check_kept(complex: &Complex, signs: &[Ordering], after: &Placement) -> Checked {
    for (v, point) in (0..).zip(after.points) {
        let is_finite = point.iter().all(|x| x.is_finite());
        check(is_finite, "M3", "a vertex has moved to a coordinate that is not finite", &[], &[v])?;
    }
    let now = check_signs(complex, after)?;
    match (0..complex.count()).find(|&c| now[c] != signs[c]) {
        Some(c) => Err(refuted("M3", "a cell is turned over", &[c], complex.cell(c))),
        None => Ok(()),
    }
}

/// The signs of tetrahedra, none of them zero; triangles, which have area, count as positive.
pub(crate) fn check_signs(complex: &Complex, placement: &Placement) -> Checked<Vec<Ordering>> {
    let mut signs = Vec::with_capacity(complex.count());
    for (c, cell) in complex.cells().enumerate() {
        let at = |i: usize| placement.points[cell[i] as usize];
        let sign = match cell.len() {
            4 => orientation_3d(at(0), at(1), at(2), at(3)),
            _ if is_flat_triangle(at(0), at(1), at(2)) => Ordering::Equal,
            _ => Ordering::Greater,
        };
        if sign == Ordering::Equal {
            return Err(refuted(placement.rules[0], format!("a cell is flat {}", placement.when), &[c], cell));
        }
        signs.push(sign);
    }
    Ok(signs)
}

/// The triangles of a surface, or of the boundary of a volume, seen from inside of it.
pub(crate) struct Skin {
    faces: Vec<[u32; 3]>,
    /// The cell of each.
    cells: Vec<usize>,
    /// For volumes the piece of the boundary that each belongs to, by its first triangle.
    pieces: Option<Vec<usize>>,
}

impl Skin {
    fn new(complex: &Complex, signs: &[Ordering]) -> Checked<Self> {
        if complex.size == 3 {
            let faces = complex.cells().map(|cell| [cell[0], cell[1], cell[2]]).collect();
            return Ok(Skin { faces, cells: (0..complex.count()).collect(), pieces: None });
        }
        let outward = |slot: usize| {
            let [a, b, c] = [0, 1, 2].map(|i| complex.facet(slot)[i]);
            let is_outward = complex.induces_sorted_order(slot) == (signs[slot / 4] == Ordering::Greater);
            if is_outward { [a, b, c] } else { [a, c, b] }
        };
        let boundary = complex.facet_complex(complex.boundary_slots())?;
        let mut parts = UnionFind::new(boundary.count());
        boundary.inner_facets().for_each(|(a, b)| parts.join(a / 3, b / 3));
        Ok(Skin {
            faces: complex.boundary_slots().map(outward).collect(),
            cells: complex.boundary_slots().map(|slot| slot / 4).collect(),
            pieces: Some((0..boundary.count()).map(|face| parts.find(face)).collect()),
        })
    }

    /// Of a closed surface in one piece, which encloses what it is the boundary of.
    pub(crate) fn of_cage(complex: &Complex) -> Self {
        let faces: Vec<_> = complex.cells().map(|cell| [cell[0], cell[1], cell[2]]).collect();
        let cells = (0..faces.len()).collect();
        Skin { pieces: Some(vec![0; faces.len()]), faces, cells }
    }

    fn count(&self) -> u64 {
        self.faces.len() as u64
    }

    fn piece_count(&self) -> u64 {
        self.pieces.iter().flatten().enumerate().filter(|(face, piece)| face == *piece).count() as u64
    }

    /// No triangles meet but in common vertices and edges; of a boundary, one piece encloses a positive volume.
    pub(crate) fn check(&self, placement: &Placement) -> Checked {
        let at = |v: u32| placement.points[v as usize];
        let boxes: Vec<_> = self.faces.iter().map(|face| bounds(&face.map(at))).collect();
        let tree = BoxTree::new(&boxes);
        for a in 0..self.faces.len() {
            let mut earlier = tree.meeting(&boxes[a]).into_iter().take_while(|&b| b < a);
            if let Some(b) = earlier.find(|&b| do_clash([&self.faces[a], &self.faces[b]], at)) {
                let message = format!("two triangles meet {}", placement.when);
                let (cells, vertices) = ([b, a].map(|face| self.cells[face]), [self.faces[b], self.faces[a]].concat());
                return Err(refuted(placement.rules[1], message, &cells, &vertices));
            }
        }
        self.pieces.as_ref().map_or(Ok(()), |pieces| self.check_pieces(pieces, placement))
    }

    /// All pieces of the boundary but one enclose a volume that is not positive.
    fn check_pieces(&self, pieces: &[usize], placement: &Placement) -> Checked {
        // Up to a factor.
        let mut volumes = vec![IBig::ZERO; self.faces.len()];
        for (face, &piece) in self.faces.iter().zip(pieces) {
            let [a, b, c] = face.map(|v| placement.points[v as usize].map(in_finest_units));
            let minor = |x: usize, y: usize| &b[x] * &c[y] - &b[y] * &c[x];
            volumes[piece] += &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
        }
        let outer: Vec<usize> = (0..volumes.len()).filter(|&piece| volumes[piece] > IBig::ZERO).collect();
        let message = format!("{} pieces of the boundary enclose a positive volume {}", outer.len(), placement.when);
        let cells: Vec<usize> = outer.iter().map(|&piece| self.cells[piece]).collect();
        check(outer.len() == 1, placement.rules[1], &message, &cells, &[])
    }
}

impl Placement<'_> {
    /// A witness is drawn here.
    pub(crate) fn drawn(&self, checked: Checked) -> Checked {
        checked.map_err(|stop| match stop {
            Stop::Refuted(mut witness) => {
                let places: Vec<Point> = witness.vertices.iter().map(|&v| self.points[v as usize]).collect();
                if places.iter().flatten().all(|x| x.is_finite()) {
                    witness.points = places;
                }
                Stop::Refuted(witness)
            }
            undecided => undecided,
        })
    }
}

/// No map file that is small enough to be written by hand breaks the sentence on pieces alone; its negative controls are here.
#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Point; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// How many pieces of two tetrahedra, the second within or beside the first, enclose a positive volume, where that is refused.
    fn refused(turned: [bool; 2], offset: f64) -> Option<String> {
        let outward = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        let of = |body: u32| outward.map(|face| face.map(|v| 4 * body + v));
        let turn = |[a, b, c]: [u32; 3], is_turned: bool| if is_turned { [a, c, b] } else { [a, b, c] };
        let faces = [0, 1].into_iter().flat_map(|k| of(k as u32).map(|face| turn(face, turned[k]))).collect();
        let second = CORNERS.map(|p| p.map(|x| 0.125 + 0.125 * x + offset));
        let points = [CORNERS, second].concat();
        let skin = Skin { faces, cells: (0..8).collect(), pieces: Some(vec![0, 0, 0, 0, 4, 4, 4, 4]) };
        match skin.check(&Placement { points: &points, when: "now", rules: ["M2", "M4"] }) {
            Err(Stop::Refuted(witness)) => Some(witness.message),
            _ => None,
        }
    }

    #[test]
    fn one_piece_encloses_a_positive_volume() {
        for offset in [0.0, 4.0] {
            assert_eq!(refused([false, true], offset), None);
            assert_eq!(refused([true, false], offset), None);
            assert!(refused([false, false], offset).is_some_and(|message| message.starts_with("2 pieces")));
            assert!(refused([true, true], offset).is_some_and(|message| message.starts_with("0 pieces")));
        }
    }
}
