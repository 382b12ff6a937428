//! Analysis of triangle meshes.

use super::gluing::ProperCells;
use super::intersections::find_with;
use super::measure::{AngleTracker, Point, Points, coincident, cross, dot, norm};
use super::report::{BoundaryLoop, Intersections, Options, SurfaceGeometry, SurfacePart, SurfaceReport};
use super::shape::SurfaceShape;
use super::violation::{ElementKind, Severity, Violations};
use crate::mesh::{CellId, Facet, TriangleComplex, VertexId};
use crate::predicate::{Sign, is_degenerate_triangle};
use crate::spatial::{Aabb, Tree};

/// How many pieces a report lists.
const MOST_PARTS: usize = 100;

/// How many boundary loops a report lists.
const MOST_LOOPS: usize = 1000;

/// Says what a triangle mesh is, with all violations.
///
/// `positions` holds one point for each vertex, or nothing for an abstract complex.
///
/// # Guarantee
/// Counts, yes-or-no answers and violations are exact for the stored numbers; angles, areas, lengths
/// and volumes are estimates in `f64`. Nothing is repaired.
///
/// # Complexity
/// Linear in the number of triangles, but for a sort of the vertices by coordinates and the search
/// for self-intersections.
///
/// ```
/// use homeo_core::{mesh::TriangleComplex, topology::{Options, analyse_triangles}};
/// let tetrahedron = TriangleComplex::from_indices(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
/// let report = analyse_triangles(&[], &tetrahedron, Options::default());
/// assert!(report.is_sphere && report.violations.is_empty());
/// ```
pub fn analyse_triangles(positions: &[Point], complex: &TriangleComplex, options: Options) -> SurfaceReport {
    let mut violations = Violations::default();
    let points = Points::checked(positions, complex.vertex_count(), &mut violations);
    let proper = ProperCells::new(complex);
    let shape = SurfaceShape::new(&proper.complex, &proper.gluing);
    let is_open = proper.gluing.boundary_count > 0;
    let consistent = shape.sheets.consistent.iter().all(|&c| c);
    report_cells(&proper, complex.cell_count(), &mut violations);
    report_connectivity(&proper, &shape, &mut violations);

    let volumes = points.map_or_else(Vec::new, |points| enclosed_volumes(points, &proper.complex, &shape));
    let geometry = points.map(|points| measure(points, complex, &proper, &volumes, &mut violations));
    report_inside_out(&proper, &shape, &volumes, &mut violations);
    let same = points.map_or_else(Vec::new, |points| coincident(points.positions));
    report_coincident(&same, &mut violations);
    let self_intersections = points
        .filter(|_| options.intersections == Intersections::Find)
        .map(|points| find_intersections(points, complex, &same, &mut violations));

    let edge_manifold = proper.gluing.crowded.is_empty() && proper.is_complete();
    let vertex_manifold = shape.pinched.is_empty() && proper.gluing.crowded.is_empty();
    let manifold = edge_manifold && vertex_manifold;
    let (edges, faces) = (proper.gluing.facet_count, proper.complex.cell_count());
    let euler_characteristic = shape.used_vertices as i64 - edges as i64 + faces as i64;
    let loops = proper.gluing.crowded.is_empty().then(|| describe_loops(&proper, &shape, points));
    let loop_count = loops.is_some().then_some(shape.loops.len());
    let genus: Option<i64> = shape.pieces.iter().map(|piece| piece.genus()).sum();
    let in_one_piece = manifold && shape.components == 1;
    SurfaceReport {
        vertices: complex.vertex_count(),
        edges,
        faces: complex.cell_count(),
        isolated_vertices: complex.vertex_count() - shape.used_vertices,
        components: shape.components,
        edge_manifold,
        vertex_manifold,
        manifold,
        orientable: shape.orientable(),
        consistently_oriented: consistent,
        closed: faces > 0 && !is_open,
        boundary_edges: proper.gluing.boundary_count,
        boundary: loops,
        boundary_loops: loop_count,
        euler_characteristic,
        genus: genus.filter(|_| manifold && faces > 0),
        is_disk: in_one_piece && loop_count == Some(1) && euler_characteristic == 1,
        is_sphere: in_one_piece && !is_open && euler_characteristic == 2,
        parts: parts(&proper, &shape, &volumes),
        geometry,
        self_intersections,
        violations: violations.into_vec(),
    }
}

/// Cells that are no cells, and vertices of none.
pub(super) fn report_cells<const K: usize>(proper: &ProperCells<'_, K>, cells: usize, violations: &mut Violations) {
    use ElementKind::Cell;
    let rows = |list: &[u32]| list.iter().map(|&cell| [cell]).collect::<Vec<_>>();
    if cells == 0 {
        let message = "there are no cells, only vertices: nothing can be made of them".to_owned();
        violations.add_general("no-cells", Severity::Error, 1, message);
    }
    let advice = "a cell must name different vertices; drop it (it has no area or volume)";
    violations.add("repeated-vertex", Severity::Error, Cell, &rows(&proper.repeating), advice);
    let advice = "the same vertices as an earlier cell; drop the copies";
    violations.add("duplicate-cell", Severity::Error, Cell, &rows(&proper.duplicates), advice);
}

fn report_connectivity(proper: &ProperCells<'_, 3>, shape: &SurfaceShape, violations: &mut Violations) {
    let complex = &proper.complex;
    let mut crowded: Vec<[u32; 2]> = proper.gluing.crowded.iter().map(|group| edge_of(complex, group[0])).collect();
    crowded.sort_unstable();
    let advice = "an edge of a surface has one or two triangles, here there are more; take the superfluous sheet off, \
                  or give each sheet vertices of its own";
    violations.add("non-manifold-edge", Severity::Error, ElementKind::Edge, &crowded, advice);
    let advice = "the triangles there form several fans that touch in a point; give each fan a vertex of its own";
    violations.add("non-manifold-vertex", Severity::Error, ElementKind::Vertex, &shape.pinched, advice);
    report_orientation(proper, &shape.sheets, violations);
    let advice = "in no triangle; drop it, or leave it out when reading";
    violations.add("isolated-vertex", Severity::Warning, ElementKind::Vertex, &shape.corners.isolated(), advice);
    report_components(shape.components, violations);
    let mut open: Vec<[u32; 2]> = proper.gluing.boundary_facets().map(|facet| edge_of(complex, facet)).collect();
    open.sort_unstable();
    let advice = "only one triangle there: the surface is open. Where a closed one is asked for, fill the hole";
    violations.add("open-boundary", Severity::Info, ElementKind::Edge, &open, advice);
}

pub(super) fn report_orientation<const K: usize>(
    proper: &ProperCells<'_, K>,
    sheets: &super::connectivity::Sheets,
    violations: &mut Violations,
) {
    let pairs: Vec<_> = sheets.contradictions.iter().map(|pair| pair.map(|cell| proper.original(cell))).collect();
    let advice = "going round the mesh turns left into right, seen where these meet; no choice of orientation is \
                  consistent. Cut the mesh open, or pass to its oriented double cover";
    violations.add("non-orientable", Severity::Error, ElementKind::CellPair, &pairs, advice);
    if pairs.is_empty() && !sheets.consistent.iter().all(|&c| c) {
        let turn: Vec<_> = sheets.cells_to_turn().into_iter().map(|cell| [proper.original(cell)]).collect();
        let advice = "turned the other way than their neighbours; swap two of their vertices (`--orient` does it)";
        violations.add("inconsistent-orientation", Severity::Error, ElementKind::Cell, &turn, advice);
    }
}

pub(super) fn report_components(components: usize, violations: &mut Violations) {
    if components > 1 {
        let message =
            format!("the mesh falls into {components} pieces: where one piece is asked for, pass them one by one");
        violations.add_general("several-components", Severity::Warning, components, message);
    }
}

pub(super) fn report_coincident(pairs: &[[u32; 2]], violations: &mut Violations) {
    let vertices: Vec<_> = pairs.iter().map(|&[_, v]| [v]).collect();
    let advice = "at exactly the same point as an earlier vertex; merge them (`--weld` does it where cells use both) \
                  unless the mesh is cut there on purpose";
    violations.add("coincident-vertices", Severity::Warning, ElementKind::Vertex, &vertices, advice);
}

fn edge_of(complex: &TriangleComplex, facet: Facet) -> [u32; 2] {
    let mut ends = [0; 2];
    for (end, vertex) in ends.iter_mut().zip(complex.facet_vertices(facet.cell(), facet.opposite())) {
        *end = vertex.raw();
    }
    ends.sort_unstable();
    ends
}

/// What a closed piece encloses.
struct Enclosed {
    sign: Sign,
    volume: f64,
    hull: Aabb,
}

/// For each piece of a manifold, what it encloses if it is closed and turns consistently.
fn enclosed_volumes(points: Points<'_>, complex: &TriangleComplex, shape: &SurfaceShape) -> Vec<Option<Enclosed>> {
    let cells = shape.sheet_cells();
    let enclosed = |sheet: usize| {
        let triangles = cells.triangles(sheet, complex);
        let (sign, volume) = points.enclosed_volume(triangles.clone());
        let hulls = triangles.map(|triangle| Aabb::of(&triangle.map(|v| points.positions[v])));
        Enclosed { sign, volume, hull: hulls.fold(Aabb::EMPTY, |all, one| all.joined(&one)) }
    };
    let pieces = shape.pieces.iter().enumerate();
    pieces.map(|(i, piece)| (piece.loops == 0 && shape.sheets.consistent[i]).then(|| enclosed(i))).collect()
}

/// The first pieces of a manifold.
fn parts(proper: &ProperCells<'_, 3>, shape: &SurfaceShape, volumes: &[Option<Enclosed>]) -> Vec<SurfacePart> {
    let describe = |(index, piece): (usize, &super::shape::Piece)| SurfacePart {
        cell: proper.original(piece.lowest_cell),
        vertices: piece.vertices,
        faces: piece.faces,
        boundary_loops: piece.loops,
        euler_characteristic: piece.euler_characteristic(),
        orientable: piece.orientable,
        genus: piece.genus(),
        enclosed_volume: volumes.get(index).and_then(Option::as_ref).map(|enclosed| enclosed.volume),
    };
    shape.pieces.iter().take(MOST_PARTS).enumerate().map(describe).collect()
}

/// Closed pieces whose normals point inwards, cavities apart: a negative piece is taken for the wall
/// of a cavity where the bounding box of another closed piece surrounds its own.
fn report_inside_out(
    proper: &ProperCells<'_, 3>,
    shape: &SurfaceShape,
    volumes: &[Option<Enclosed>],
    violations: &mut Violations,
) {
    let hulls: Vec<Aabb> = volumes.iter().flatten().map(|enclosed| enclosed.hull).collect();
    let tree = Tree::new(&hulls);
    let is_cavity = |own: &Aabb| {
        let mut is_surrounded = false;
        tree.query_box(own, |other| is_surrounded |= hulls[other].surrounds(own));
        is_surrounded
    };
    let mut inverted = Vec::new();
    for (piece, enclosed) in shape.pieces.iter().zip(volumes) {
        if enclosed.as_ref().is_some_and(|e| e.sign == Sign::Negative && !is_cavity(&e.hull)) {
            inverted.push([proper.original(piece.lowest_cell)]);
        }
    }
    let advice = "the closed surface of this triangle has its normals inwards (it encloses a negative volume); swap two \
                  vertices of each of its triangles";
    violations.add("inside-out", Severity::Warning, ElementKind::Cell, &inverted, advice);
}

/// Angles, areas and exact degeneracy.
fn measure(
    points: Points<'_>,
    complex: &TriangleComplex,
    proper: &ProperCells<'_, 3>,
    volumes: &[Option<Enclosed>],
    violations: &mut Violations,
) -> SurfaceGeometry {
    let is_flat = |cell: &[VertexId; 3]| {
        let [a, b, c] = cell.map(|v| points.positions[v.index()]);
        is_degenerate_triangle(a, b, c)
    };
    let cells = complex.cells().iter().enumerate();
    let flat: Vec<[u32; 1]> = cells.filter(|(_, cell)| is_flat(cell)).map(|(index, _)| [index as u32]).collect();
    let reported: Vec<_> = flat.iter().copied().filter(|[c]| proper.repeating.binary_search(c).is_err()).collect();
    let advice = "area zero, exactly: the corners lie on a line; move a corner, or collapse the shortest edge";
    violations.add("degenerate-cell", Severity::Error, ElementKind::Cell, &reported, advice);

    let mut corners = AngleTracker::new();
    let mut area = 0.0;
    let normals: Vec<Point> = (proper.complex.cells().iter())
        .map(|cell| {
            let [a, b, c] = cell.map(VertexId::index);
            let [x, y, z] = [points.vector(a, b), points.vector(b, c), points.vector(c, a)];
            let normal = cross(x, y);
            let double_area = norm(normal);
            area += double_area / 2.0;
            [(x, z), (y, x), (z, y)].iter().for_each(|&(u, v)| corners.add(-dot(u, v), double_area));
            normal
        })
        .collect();
    let volumes: Vec<f64> = volumes.iter().flatten().map(|enclosed| enclosed.volume).collect();
    SurfaceGeometry {
        lowest: points.hull.low,
        highest: points.hull.high,
        diagonal: points.diagonal,
        area: area / points.scale / points.scale,
        flat_cells: flat.len(),
        triangle_angles: corners.range(),
        dihedral_angles: dihedral_angles(proper, &normals).range(),
        enclosed_volume: (!volumes.is_empty()).then(|| volumes.iter().sum()),
    }
}

fn dihedral_angles(proper: &ProperCells<'_, 3>, normals: &[Point]) -> AngleTracker {
    let mut angles = AngleTracker::new();
    for (cell, row) in proper.gluing.across.iter().enumerate() {
        for (i, facet) in row.iter().enumerate().filter(|(_, facet)| facet.is_some()) {
            let other = facet.cell().index();
            if cell < other {
                let (a, b) = (normals[cell], normals[other]);
                let along = dot(a, b);
                angles.add(if proper.gluing.agrees(cell, i) { -along } else { along }, norm(cross(a, b)));
            }
        }
    }
    angles
}

fn describe_loops(proper: &ProperCells<'_, 3>, shape: &SurfaceShape, points: Option<Points<'_>>) -> Vec<BoundaryLoop> {
    let length_of = |points: Points<'_>, facet: &Facet| {
        let [a, b] = edge_of(&proper.complex, *facet).map(|v| v as usize);
        norm(points.vector(a, b)) / points.scale
    };
    let describe = |facets: &Vec<Facet>| BoundaryLoop {
        edges: facets.len(),
        length: points.map(|points| facets.iter().map(|facet| length_of(points, facet)).sum()),
        vertex: edge_of(&proper.complex, facets[0])[0],
    };
    shape.loops.iter().take(MOST_LOOPS).map(|boundary| describe(&boundary.facets)).collect()
}

fn find_intersections(
    points: Points<'_>,
    complex: &TriangleComplex,
    same: &[[u32; 2]],
    violations: &mut Violations,
) -> usize {
    let found = find_with(points.positions, complex, same);
    let listed: Vec<_> = found.pairs.iter().map(|pair| pair.map(CellId::raw)).collect();
    let advice = match found.complete {
        true => "these triangles meet away from their common corners; move their vertices apart",
        false => "these triangles meet away from their common corners, and the search stopped there; move them apart",
    };
    violations.add("self-intersection", Severity::Error, ElementKind::CellPair, &listed, advice);
    found.pairs.len()
}
