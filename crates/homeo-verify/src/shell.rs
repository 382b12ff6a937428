//! Rules L1 to L6: the projection of a surface along the pillars of a prismatic shell.
//!
//! *Theorem* (`docs/theory/shells.md`). Under these rules the map `phi` from the abstract shell into space is one-to-one
//! over the source surface `T`, and its inverse followed by the projection `pi` along the pillars is a homeomorphism
//! from `T` onto the middle surface `M`.
//!
//! A *corner* is a point of a column: its number and its level, 0 bottom, 1 middle, 2 top. A pinched column has
//! level 0 only. Slab `2 q` is the lower, slab `2 q + 1` the upper half of prism `q`. Witnesses count prisms after the
//! triangles, and columns after the vertices of the source; those of another section come last.
//!
//! Surfaces may have boundary edges, which both have in common. A directed boundary edge is known by its slot; as no two
//! boundary vertices are at one point, also by the point where it starts.
//!
//! Round a surface that may cross itself, the file lists which triangle belongs to which prism. The rules then speak of
//! these *pairs* only, and the rules I1 to I4 say what makes the list complete. The rules E1 and E2 are for shells that claim
//! not to overlap themselves.

mod pairs;
mod skin;

use crate::complex::{Complex, UnionFind};
use crate::links::check_manifold;
use crate::map_file::{MapFile, ShellData};
use crate::number::{
    Exact, Point, exact_orientation, in_finest_units, is_flat_triangle, orientation_3d, steps_orientation,
};
use crate::source::check_finite;
use crate::triangles::{
    Bounds, BoxTree, Triangle, bounds, count_crossings, have_common_area, triangles_meet, triangles_meet_beyond,
};
use crate::verdict::{Checked, Stop, check, decidable, refuted};
use dashu_int::IBig;
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BTreeSet};

/// A point of a column.
type Corner = (u32, usize);

/// The boundary edges of a surface by the bits of the point where they start: those of the end, and the slot.
type Boundary = BTreeMap<[u64; 3], ([u64; 3], usize)>;

/// The source `T` and the prisms over `M`, both oriented surfaces.
struct Shell<'a> {
    positions: &'a [Point],
    source: Complex,
    levels: &'a [Vec<Point>; 3],
    prisms: Complex,
    /// The boundary edges, as slots of the source and of the prisms.
    boundary: Vec<[usize; 2]>,
    /// The boxes of the source's triangles.
    triangles: BoxTree,
    /// The triangles and prisms that belong together; all do where there is no list.
    pairs: Option<&'a [[u32; 2]]>,
}

/// Checks all rules of a shell for its source, and for the other section if there is one: then the projection of the one,
/// followed by the inverse of the other's, is a homeomorphism too.
pub(crate) fn check_shell(map: &MapFile, data: &ShellData) -> Checked<Vec<(&'static str, u64)>> {
    let mut checked = check_section(&map.positions, &map.cells, data)?;
    if let Some((positions, cells)) = &data.section {
        let counts = [map.cells.len() / 3, map.positions.len()];
        let others = check_section(positions, cells, data).map_err(|stop| number_section(stop, data, counts))?;
        checked.iter_mut().zip(others).for_each(|((_, count), (_, more))| *count += more);
    }
    Ok(checked)
}

/// Checks all rules of a shell for a surface in it.
fn check_section(positions: &[Point], cells: &[u32], data: &ShellData) -> Checked<Vec<(&'static str, u64)>> {
    check_finite(positions)?;
    let source = check_surface(cells, positions.len(), "source")?;
    let corners = |cell: &[u32]| [0, 1, 2].map(|i| positions[cell[i] as usize]);
    for (c, cell) in source.cells().enumerate() {
        let [p, q, r] = corners(cell);
        check(!is_flat_triangle(p, q, r), "L1", "a triangle has area zero", &[c], cell)?;
    }
    let counted_after_source = |stop| count_after(stop, source.count(), positions.len());
    let levels = &data.levels;
    levels.iter().try_for_each(|level| check_finite(level)).map_err(counted_after_source)?;
    let prisms = check_surface(&data.prisms, levels[0].len(), "middle surface").map_err(counted_after_source)?;
    let of_source = boundary_by_points(&source, positions, "source")?;
    let of_middle = boundary_by_points(&prisms, &levels[1], "middle surface").map_err(counted_after_source)?;
    check_included(&of_source, &of_middle, &source, "source")?;
    check_included(&of_middle, &of_source, &prisms, "middle surface").map_err(counted_after_source)?;
    let boundary = of_source.values().zip(of_middle.values()).map(|(a, b)| [a.1, b.1]).collect();
    let boxes: Vec<_> = source.cells().map(|cell| bounds(&corners(cell))).collect();
    let triangles = BoxTree::new(&boxes);
    let shell = Shell { positions, source, levels, prisms, boundary, triangles, pairs: data.pairs.as_deref() };
    let tetrahedra = shell.check_tetrahedra()?;
    let pairs = shell.check_pairs()?;
    let mut checked = vec![
        ("vertices and columns with finite coordinates (rule S1)", (positions.len() + levels[0].len()) as u64),
        ("triangles of the source, an oriented surface (rules S2, L1)", shell.source.count() as u64),
        ("prisms over the middle, an oriented surface (rules S2, L1)", shell.prisms.count() as u64),
        ("boundary edges that both surfaces have (rule L1)", shell.boundary.len() as u64),
        ("positive tetrahedra (rule L2)", tetrahedra),
        ("bottom and top triangles that the source avoids (rule L3)", shell.check_bottom_and_top()?),
        ("wall triangles over boundary edges that the source keeps inside of (rule L3)", shell.check_walls()?),
        ("slabs whose pillars cross the source in the positive sense (rule L4)", shell.check_pillars()?),
        ("components of the source with a point that the shell covers once (rule L5)", shell.check_preimages()?),
        ("components of the middle with a fibre that meets the source once (rule L6)", shell.check_fibres()?),
    ];
    if data.is_embedded {
        checked.push(("triangles of the shell's surface, covered once (rules E1, E2)", shell.check_skin()?));
    }
    checked.extend(pairs.map(|count| ("pairs of a triangle and a prism, none missing (rules I1-I4)", count)));
    Ok(checked)
}

/// The witness with the numbers that the section's triangles and vertices have: behind those of source and shell.
fn number_section(stop: Stop, data: &ShellData, [source_cells, source_vertices]: [usize; 2]) -> Stop {
    let Stop::Refuted(mut witness) = stop else { return stop };
    let Some((positions, cells)) = &data.section else { return Stop::Refuted(witness) };
    let renumbered = |number: u32, own: usize, source: usize, of_shell: usize| match (number as usize).checked_sub(own)
    {
        None => number.saturating_add((source + of_shell) as u32),
        Some(in_shell) => (source + in_shell) as u32,
    };
    let (prisms, columns) = (data.prisms.len() / 3, data.levels[0].len());
    witness.cells.iter_mut().for_each(|c| *c = renumbered(*c, cells.len() / 3, source_cells, prisms));
    witness.vertices.iter_mut().for_each(|v| *v = renumbered(*v, positions.len(), source_vertices, columns));
    witness.message = format!("the other section in the place of the source: {}", witness.message);
    Stop::Refuted(witness)
}

/// S2 and L1: indices, and an oriented surface by its links.
fn check_surface(cells: &[u32], vertex_count: usize, what: &str) -> Checked<Complex> {
    let surface = Complex::new(3, cells.to_vec(), vertex_count, ["S2", "L1"])?;
    surface.check_sides("L1", |_, _| true, |_| true)?;
    check_manifold(&surface, what, "L1")?;
    Ok(surface)
}

/// The ends of an edge in the direction of its triangle.
fn edge(surface: &Complex, slot: usize) -> [u32; 2] {
    [1, 2].map(|i| surface.cell(slot / 3)[(slot + i) % 3])
}

/// L1: no two boundary vertices are at one point. In a surface by links, each of them starts one boundary edge.
fn boundary_by_points(surface: &Complex, points: &[Point], what: &str) -> Checked<Boundary> {
    let mut boundary = Boundary::new();
    for slot in surface.boundary_slots() {
        let [start, end] = edge(surface, slot).map(|v| points[v as usize].map(|x| (x + 0.0).to_bits())); // 0 for -0
        if let Some((_, other)) = boundary.insert(start, (end, slot)) {
            let message = format!("{what}: two vertices of the boundary are at the same point");
            let vertices = [other, slot].map(|slot| edge(surface, slot)[0]);
            return Err(refuted("L1", message, &[other / 3, slot / 3], &vertices));
        }
    }
    Ok(boundary)
}

/// L1: the boundary edges of a surface are some of those of the other surface.
fn check_included(boundary: &Boundary, other: &Boundary, surface: &Complex, what: &str) -> Checked {
    let is_missing = |(start, (end, _)): &(&_, &([u64; 3], usize))| other.get(*start).is_none_or(|e| e.0 != *end);
    let Some((_, &(_, slot))) = boundary.iter().find(is_missing) else { return Ok(()) };
    let message = format!("{what}: a boundary edge is none of the other surface");
    Err(refuted("L1", message, &[slot / 3], &edge(surface, slot)))
}

/// The witness with the numbers that prisms and columns have behind the source's triangles and vertices.
fn count_after(stop: Stop, triangle_count: usize, vertex_count: usize) -> Stop {
    let Stop::Refuted(mut witness) = stop else { return stop };
    witness.cells.iter_mut().for_each(|c| *c = c.saturating_add(triangle_count as u32));
    witness.vertices.iter_mut().for_each(|v| *v = v.saturating_add(vertex_count as u32));
    Stop::Refuted(witness)
}

impl Shell<'_> {
    /// A rule of the shell alone fails.
    fn refuted(&self, rule: &'static str, message: &str, q: usize) -> Stop {
        let stop = refuted(rule, message, &[q], self.prisms.cell(q));
        count_after(stop, self.source.count(), self.positions.len())
    }

    /// A rule about a source triangle and a prism fails.
    fn refuted_between(&self, rule: &'static str, message: &str, c: usize, q: usize) -> Stop {
        refuted(rule, message, &[c, self.source.count() + q], self.source.cell(c))
    }

    fn triangle(&self, c: usize) -> Triangle {
        let cell = self.source.cell(c);
        [0, 1, 2].map(|i| self.positions[cell[i] as usize])
    }

    fn are_paired(&self, c: usize, q: usize) -> bool {
        self.pairs.is_none_or(|pairs| pairs.binary_search(&[c as u32, q as u32]).is_ok())
    }

    /// The triangles that belong to a prism and whose boxes meet this one.
    fn triangles_of(&self, q: usize, region: &Bounds) -> Vec<usize> {
        let mut near = self.triangles.meeting(region);
        near.retain(|&c| self.are_paired(c, q));
        near
    }

    fn point(&self, (column, level): Corner) -> Point {
        self.levels[level][column as usize]
    }

    fn is_pinched(&self, column: u32) -> bool {
        self.point((column, 0)) == self.point((column, 1)) && self.point((column, 1)) == self.point((column, 2))
    }

    /// The columns of the slab's prism and the slab's lower level.
    fn slab(&self, slab: usize) -> (&[u32], usize) {
        (self.prisms.cell(slab / 2), slab % 2)
    }

    fn slab_count(&self) -> usize {
        2 * self.prisms.count()
    }

    fn slab_points(&self, slab: usize) -> [Point; 6] {
        let (cell, low) = self.slab(slab);
        [0, 1, 2, 3, 4, 5].map(|i| self.point((cell[i % 3], low + i / 3)))
    }

    /// The pillars of a slab that are no points.
    fn pillars(&self, slab: usize) -> impl Iterator<Item = [Point; 2]> {
        let (cell, low) = self.slab(slab);
        let columns = cell.iter().filter(|&&v| !self.is_pinched(v));
        columns.map(move |&v| [self.point((v, low)), self.point((v, low + 1))])
    }

    /// The tetrahedra of L2: on each pillar, with an end of the next column and one of the column after that.
    fn tetrahedra(&self, slab: usize) -> Vec<[Corner; 4]> {
        let (cell, low) = self.slab(slab);
        let ends = |v: u32| if self.is_pinched(v) { vec![(v, 0)] } else { vec![(v, low), (v, low + 1)] };
        let mut tetrahedra = vec![];
        for [v, next, last] in [0, 1, 2].map(|i| [0, 1, 2].map(|j| cell[(i + j) % 3])) {
            for x in ends(next).into_iter().filter(|_| !self.is_pinched(v)) {
                tetrahedra.extend(ends(last).into_iter().map(|y| [(v, low), (v, low + 1), x, y]));
            }
        }
        tetrahedra
    }

    /// Those that the slab consists of: columns before the pillar's give their low point, those after it their high one.
    fn decomposition(&self, slab: usize) -> Vec<[Corner; 4]> {
        let mut tetrahedra = self.tetrahedra(slab);
        let is_chosen = |pillar: Corner, (v, level): Corner| self.is_pinched(v) || (level > pillar.1) == (v > pillar.0);
        tetrahedra.retain(|t| is_chosen(t[0], t[2]) && is_chosen(t[0], t[3]));
        tetrahedra
    }

    /// The triangles with corners on the side of a prism's slab, anticlockwise from inside; none has two equal points.
    fn walls(&self, prism_slot: usize, low: usize) -> Vec<Triangle> {
        let [i, j] = edge(&self.prisms, prism_slot);
        let side = [(i, low), (i, low + 1), (j, low + 1), (j, low)].map(|corner| self.point(corner));
        let walls = [0, 1, 2, 3].map(|n| [1, 2, 3].map(|k| side[(n + k) % 4]));
        walls.into_iter().filter(|[a, b, c]| a != b && b != c && c != a).collect()
    }

    /// L2: at most one column of a prism is pinched, and all tetrahedra are positive. Returns their number.
    fn check_tetrahedra(&self) -> Checked<u64> {
        let mut count = 0;
        for slab in 0..self.slab_count() {
            let tetrahedra = self.tetrahedra(slab);
            if self.pillars(slab).count() < 2 {
                return Err(self.refuted("L2", "more than one column of a prism is pinched", slab / 2));
            }
            for [a, b, c, d] in tetrahedra.iter().map(|t| t.map(|corner| self.point(corner))) {
                if orientation_3d(a, b, c, d) != Ordering::Greater {
                    return Err(self.refuted("L2", "a tetrahedron of a prism is flat or turned over", slab / 2));
                }
            }
            count += tetrahedra.len() as u64;
        }
        Ok(count)
    }

    /// L3: source triangles avoid bottom and top, except in common corners that are pinched. Returns the triangles there.
    fn check_bottom_and_top(&self) -> Checked<u64> {
        for (q, cell) in self.prisms.cells().enumerate() {
            let pinched = cell.iter().find(|&&v| self.is_pinched(v)).map(|&v| self.point((v, 0)));
            for level in [0, 2] {
                let end = [0, 1, 2].map(|i| self.point((cell[i], level)));
                for c in self.triangles_of(q, &bounds(&end)) {
                    let triangle = self.triangle(c);
                    let do_meet = match pinched.filter(|p| triangle.contains(p)) {
                        Some(p) => triangles_meet_beyond(p, &triangle, &end),
                        None => triangles_meet(&triangle, &end),
                    };
                    if do_meet {
                        let message = "a triangle of the source meets the bottom or the top of a prism";
                        return Err(self.refuted_between("L3", message, c, q));
                    }
                }
            }
        }
        Ok(2 * self.prisms.count() as u64)
    }

    /// L3: source triangles lie inside of the walls over boundary edges and meet them in common vertices and edges only.
    /// Returns the number of wall triangles.
    fn check_walls(&self) -> Checked<u64> {
        const MEETS: &str = "a triangle of the source meets the wall over a boundary edge";
        const LEAVES: &str = "a triangle of the source does not lie inside of the wall over its boundary edge";
        let mut count = 0;
        for &[slot, prism_slot] in &self.boundary {
            let [v, w] = edge(&self.source, slot);
            let third = self.triangle(slot / 3)[slot % 3];
            for low in [0, 1] {
                for wall in &self.walls(prism_slot, low) {
                    count += 1;
                    for c in self.triangles_of(prism_slot / 3, &bounds(wall)) {
                        let (cell, triangle) = (self.source.cell(c), self.triangle(c));
                        let ends = [v, w].into_iter().filter(|end| cell.contains(end));
                        let common = ends.map(|end| self.positions[end as usize]).filter(|p| wall.contains(p));
                        let common: Vec<Point> = common.collect();
                        let (is_allowed, message) = match common[..] {
                            // The triangle at the edge; strictly inside, it meets the wall in nothing else.
                            [_, _] => (orientation_3d(wall[0], wall[1], wall[2], third) == Ordering::Greater, LEAVES),
                            [p] => (!triangles_meet_beyond(p, &triangle, wall), MEETS),
                            _ => (!triangles_meet(&triangle, wall), MEETS),
                        };
                        if !is_allowed {
                            return Err(self.refuted_between("L3", message, c, prism_slot / 3));
                        }
                    }
                }
            }
        }
        Ok(count)
    }

    /// L4: pillars cross the source triangles that have an area in the slab from below. Returns the number of slabs.
    fn check_pillars(&self) -> Checked<u64> {
        for slab in 0..self.slab_count() {
            for c in self.triangles_of(slab / 2, &bounds(&self.slab_points(slab))) {
                let triangle = self.triangle(c);
                let [p, q, r] = triangle;
                let is_from_below = |pillar| steps_orientation([[p, q], [p, r], pillar]) == Ordering::Greater;
                if self.pillars(slab).all(is_from_below) {
                    continue;
                }
                let points = |t: &[Corner; 4]| t.map(|corner| self.point(corner));
                if self.tetrahedra(slab).iter().any(|t| have_common_area(&points(t), &triangle)) {
                    let message = "a triangle of the source has an area in a prism but is not crossed from below";
                    return Err(self.refuted_between("L4", message, c, slab / 2));
                }
            }
        }
        Ok(self.slab_count() as u64)
    }

    /// L5: each component of the source has a point with one preimage. As all tetrahedra are positive, a point with
    /// another number, in any position, refutes it for the whole component. Returns the number of components.
    fn check_preimages(&self) -> Checked<u64> {
        let boxes: Vec<_> = (0..self.slab_count()).map(|slab| bounds(&self.slab_points(slab))).collect();
        let slabs = BoxTree::new(&boxes);
        let firsts = first_cells(&self.source);
        for &c in &firsts {
            let triangle = self.triangle(c);
            let mut near = slabs.meeting(&bounds(&triangle));
            near.retain(|slab| self.are_paired(c, slab / 2));
            try_weights(|weights| {
                let carriers = self.carriers_over(&triangle, weights, &near);
                let message = format!("a point of the source has {} preimages in the shell", carriers.len());
                check(carriers.len() == 1, "L5", &message, &[c], self.source.cell(c))?;
                Ok(carriers.iter().all(|carrier| carrier.len() >= 3))
            })?;
        }
        Ok(firsts.len() as u64)
    }

    /// The preimages of a point of a triangle: the corners that have a positive weight there.
    fn carriers_over(&self, triangle: &Triangle, weights: [u16; 3], slabs: &[usize]) -> BTreeSet<Vec<Corner>> {
        let sum: u16 = weights.iter().sum();
        let point = combination(triangle, weights);
        let mut carriers = BTreeSet::new();
        for tetrahedron in slabs.iter().flat_map(|&slab| self.decomposition(slab)) {
            let [a, b, c, d] = &tetrahedron.map(|corner| scaled(self.point(corner), sum));
            let faces = [[&point, b, c, d], [a, &point, c, d], [a, b, &point, d], [a, b, c, &point]];
            let signs = faces.map(|[a, b, c, d]| exact_orientation(a, b, c, d));
            if !signs.contains(&Ordering::Less) {
                let carrier = (0..4).filter(|&i| signs[i] == Ordering::Greater).map(|i| tetrahedron[i]);
                let mut carrier: Vec<Corner> = carrier.collect();
                carrier.sort_unstable();
                carriers.insert(carrier);
            }
        }
        carriers
    }

    /// L6: over each component of the middle a fibre meets the source once. By the other rules all fibres in general
    /// position meet it as often as one of them. Returns the number of components.
    fn check_fibres(&self) -> Checked<u64> {
        let firsts = first_cells(&self.prisms);
        for &q in &firsts {
            let points = [self.slab_points(2 * q), self.slab_points(2 * q + 1)];
            let near = self.triangles_of(q, &bounds(points.as_flattened()));
            try_weights(|weights| {
                let (fibre, sum) = (self.fibre(q, weights), weights.iter().sum());
                let corners = |c: usize| self.triangle(c).map(|p| scaled(p, sum));
                // Each triangle counts: two of them in one place are two parts of the source.
                let crossings: Option<Vec<usize>> =
                    near.iter().map(|&c| count_crossings(&fibre, &corners(c))).collect();
                let Some(crossings) = crossings else { return Ok(false) };
                let count: usize = crossings.iter().sum();
                let message = format!("a fibre meets the source in {count} points");
                if count == 1 { Ok(true) } else { Err(self.refuted("L6", &message, q)) }
            })?;
        }
        Ok(firsts.len() as u64)
    }

    /// The points in which the fibre over a point of a prism bends, from bottom to top: in each slab one column after
    /// the other is raised, the last one first.
    fn fibre(&self, q: usize, weights: [u16; 3]) -> Vec<Exact> {
        let cell = self.prisms.cell(q);
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&i| Reverse(cell[i]));
        let mut levels = [0; 3];
        let mut points = vec![combination(&[0, 1, 2].map(|i| self.point((cell[i], levels[i]))), weights)];
        for i in order.into_iter().chain(order) {
            levels[i] += 1;
            if !self.is_pinched(cell[i]) {
                points.push(combination(&[0, 1, 2].map(|i| self.point((cell[i], levels[i]))), weights));
            }
        }
        points
    }
}

/// The first cell of each component.
fn first_cells(complex: &Complex) -> Vec<usize> {
    let mut components = UnionFind::new(complex.count());
    complex.inner_facets().for_each(|(a, b)| components.join(a / 3, b / 3));
    (0..complex.count()).filter(|&c| components.find(c) == c).collect()
}

/// Tries points inside a triangle until one is in general position. They lie on a conic: few on a line.
fn try_weights(mut is_general: impl FnMut([u16; 3]) -> Checked<bool>) -> Checked {
    for k in 0..50 {
        if is_general([997, 1009 + 31 * k, 1013 + k * k])? {
            return Ok(());
        }
    }
    let message = "50 points of a triangle or a prism are all in special position";
    decidable(false, message, "renumber the triangles or the prisms, so that another one comes first")
}

/// A point in finest units, times a whole number.
fn scaled(point: Point, factor: u16) -> Exact {
    point.map(|x| in_finest_units(x) * factor)
}

/// The sum of the corners of a triangle with these weights.
fn combination(triangle: &Triangle, weights: [u16; 3]) -> Exact {
    let term = |axis: usize, i: usize| in_finest_units(triangle[i][axis]) * weights[i];
    [0, 1, 2].map(|axis| (0..3).map(|i| term(axis, i)).sum::<IBig>())
}
