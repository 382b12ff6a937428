//! Analysis of tetrahedral meshes.

use super::ball::{Facts, Placement, decide_ball, decide_embedded};
use super::connectivity::{Corners, Sheets};
use super::gluing::{Gluing, ProperCells};
use super::intersections::self_intersections;
use super::links::{EdgeCounts, bad_links, split_edges};
use super::measure::{AngleTracker, Point, Points, coincident, cross, dot, norm};
use super::report::{Intersections, Options, VolumeBoundary, VolumeGeometry, VolumeReport};
use super::shape::{SurfaceShape, vertices_on_crowded_facets};
use super::surface::{report_cells, report_coincident, report_components, report_orientation};
use super::violation::{ElementKind, Severity, Violations};
use crate::mesh::{Facet, TetrahedronComplex, TriangleComplex, VertexId};
use crate::predicate::{Sign, orient3d};

/// How many pieces of the boundary a report lists.
const MOST_PIECES: usize = 100;

/// Says what a tetrahedral mesh is, with all violations.
///
/// `positions` holds one point for each vertex, or nothing for an abstract complex.
///
/// # Guarantee
/// Counts, signs, yes-or-no answers and violations are exact for the stored numbers; angles and
/// volumes are estimates in `f64`. Nothing is repaired.
///
/// # Complexity
/// Linear in the number of cells, but for a sort of the vertices by coordinates and the search for
/// self-intersections of the boundary.
///
/// ```
/// use homeo_core::{mesh::TetrahedronComplex, topology::{Answer, Options, analyse_tetrahedra}};
/// let complex = TetrahedronComplex::from_indices(4, &[[0, 1, 2, 3]]).unwrap();
/// let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let report = analyse_tetrahedra(&points, &complex, Options::default());
/// assert_eq!(report.ball.answer, Answer::Yes);
/// ```
pub fn analyse_tetrahedra(positions: &[Point], complex: &TetrahedronComplex, options: Options) -> VolumeReport {
    let mut violations = Violations::default();
    let points = Points::checked(positions, complex.vertex_count(), &mut violations);
    let parts = Anatomy::new(complex);
    report_cells(&parts.proper, complex.cell_count(), &mut violations);
    parts.report_connectivity(&mut violations);

    let signs = points.map(|points| exact_signs(points, complex));
    let geometry = points.zip(signs.as_deref()).map(|(points, signs)| {
        report_signs(complex, signs, &parts.proper, &mut violations);
        measure(points, complex, signs)
    });
    let facts = parts.facts();
    let mut placement = points.zip(signs.as_deref()).map(|(points, signs)| parts.placement(points, signs));
    if let (Some(points), Some(placement)) = (points, &mut placement) {
        let same = coincident(points.positions);
        report_coincident(&same, &mut violations);
        placement.boundary_vertices_merged = parts.merged_on_boundary(&same);
        let undecided = placement.uniform && placement.flat_cells == 0 && facts.components == 1;
        if undecided || options.intersections == Intersections::Find {
            placement.boundary_intersections = Some(parts.find_intersections(points, &mut violations));
        }
    }
    let embedded = decide_embedded(&facts, placement.as_ref());
    let (ball, handle_body) = decide_ball(&facts, &embedded, &parts.proper);
    let facet_manifold = parts.proper.gluing.crowded.is_empty() && parts.proper.is_complete();
    let vertex_manifold = parts.bad_links.is_empty();
    VolumeReport {
        vertices: complex.vertex_count(),
        edges: parts.edges.total,
        faces: parts.proper.gluing.facet_count,
        cells: complex.cell_count(),
        isolated_vertices: complex.vertex_count() - parts.used_vertices,
        components: parts.components,
        facet_manifold,
        vertex_manifold,
        manifold: facet_manifold && vertex_manifold,
        bad_vertex_links: parts.bad_links.len(),
        orientable: facts.orientable,
        consistently_oriented: parts.sheets.consistent.iter().all(|&c| c),
        euler_characteristic: facts.euler_characteristic,
        interior_vertices: parts.used_vertices - parts.skin.originals.len(),
        boundary: parts.skin.describe(),
        cells_with_all_vertices_on_boundary: parts.cells_on_boundary(),
        interior_edges_between_boundary_vertices: parts.edges.between_boundary_vertices - parts.skin.gluing.facet_count,
        interior_faces_with_all_vertices_on_boundary: parts.interior_faces_on_boundary(),
        geometry,
        boundary_self_intersections: placement.and_then(|placement| placement.boundary_intersections),
        embedded,
        ball,
        handle_body,
        violations: violations.into_vec(),
    }
}

/// The boundary as a surface with vertices numbered anew.
struct Skin {
    complex: TriangleComplex,
    gluing: Gluing<3>,
    shape: SurfaceShape,
    /// The vertices of the mesh, ascending.
    originals: Vec<u32>,
}

impl Skin {
    /// The triangles of exactly one cell, outwards where the cells, turned as the sheets say, are positive.
    fn new(proper: &ProperCells<'_, 4>, sheets: &Sheets) -> Self {
        let on_boundary = &proper.gluing.on_boundary;
        let originals: Vec<u32> = (0..on_boundary.len() as u32).filter(|&v| on_boundary[v as usize]).collect();
        let mut numbers = vec![0u32; on_boundary.len()];
        for (number, &vertex) in originals.iter().enumerate() {
            numbers[vertex as usize] = number as u32;
        }
        let outward = |facet: Facet| {
            let mut triangle = [VertexId::from(0); 3];
            let vertices = proper.complex.facet_vertices(facet.cell(), facet.opposite());
            for (corner, vertex) in triangle.iter_mut().zip(vertices) {
                *corner = VertexId::from(numbers[vertex.index()]);
            }
            if (facet.opposite() % 2 == 1) != sheets.turned[facet.cell().index()] {
                triangle.swap(1, 2);
            }
            triangle
        };
        let triangles = proper.gluing.boundary_facets().map(outward).collect();
        let complex = TriangleComplex::new(originals.len(), triangles)
            .expect("boundary vertices are numbered below their count; please report this");
        let gluing = Gluing::new(&complex);
        let shape = SurfaceShape::new(&complex, &gluing);
        Self { complex, gluing, shape, originals }
    }

    /// Whether it is a closed surface.
    fn is_closed_manifold(&self) -> bool {
        self.shape.manifold && self.gluing.boundary_count == 0
    }

    fn describe(&self) -> VolumeBoundary {
        let is_surface = self.is_closed_manifold() && self.shape.orientable();
        let genera = self.shape.pieces.iter().filter(|_| is_surface).filter_map(|piece| piece.genus());
        VolumeBoundary {
            vertices: self.originals.len(),
            edges: self.gluing.facet_count,
            faces: self.complex.cell_count(),
            manifold: self.is_closed_manifold(),
            components: self.shape.components,
            genus: is_surface.then(|| genera.clone().sum()),
            genera: genera.take(MOST_PIECES).collect(),
        }
    }
}

/// Everything about a tetrahedral complex that does not need coordinates.
struct Anatomy<'a> {
    proper: ProperCells<'a, 4>,
    corners: Corners,
    sheets: Sheets,
    components: usize,
    edges: EdgeCounts,
    bad_links: Vec<u32>,
    skin: Skin,
    used_vertices: usize,
}

impl<'a> Anatomy<'a> {
    fn new(complex: &'a TetrahedronComplex) -> Self {
        let proper = ProperCells::new(complex);
        let corners = Corners::new(&proper.complex);
        let sheets = Sheets::new(&proper.gluing);
        let components = sheets.components(&proper.complex);
        let edges = EdgeCounts::new(&proper.complex, &corners, &proper.gluing.on_boundary);
        let bad_links = bad_links(&proper.complex, &proper.gluing, &corners, &edges.at);
        let skin = Skin::new(&proper, &sheets);
        let used_vertices = (0..complex.vertex_count()).filter(|&v| !corners.at(v).is_empty()).count();
        Self { proper, corners, sheets, components, edges, bad_links, skin, used_vertices }
    }

    fn facts(&self) -> Facts {
        let faces = self.proper.gluing.facet_count as i64;
        let cells = self.proper.complex.cell_count() as i64;
        Facts {
            complete: self.proper.is_complete(),
            components: self.components,
            crowded_facets: self.proper.gluing.crowded.len(),
            bad_links: self.bad_links.len(),
            orientable: self.sheets.contradictions.is_empty(),
            boundary_components: self.skin.shape.components,
            boundary_genus: self.skin.describe().genus,
            euler_characteristic: self.used_vertices as i64 - self.edges.total as i64 + faces - cells,
        }
    }

    fn report_connectivity(&self, violations: &mut Violations) {
        let (complex, gluing) = (&self.proper.complex, &self.proper.gluing);
        let triple = |group: &Vec<Facet>| {
            let mut vertices = [0; 3];
            let facet = group[0];
            for (slot, vertex) in vertices.iter_mut().zip(complex.facet_vertices(facet.cell(), facet.opposite())) {
                *slot = vertex.raw();
            }
            vertices.sort_unstable();
            vertices
        };
        let crowded: Vec<_> = gluing.crowded.iter().map(triple).collect();
        let advice = "more than two tetrahedra have this triangle, so that some overlap; take the superfluous ones out";
        violations.add("non-manifold-facet", Severity::Error, ElementKind::Facet, &crowded, advice);

        let excused = vertices_on_crowded_facets(complex, gluing);
        let bad: Vec<u32> = self.bad_links.iter().copied().filter(|v| excused.binary_search(v).is_err()).collect();
        let edges = split_edges(complex, gluing, &self.corners, &bad);
        let advice = "the tetrahedra at this edge hang together by the edge only; split the edge in two, or fill the \
                      gap between them";
        violations.add("non-manifold-edge", Severity::Error, ElementKind::Edge, &edges, advice);
        let mut ends: Vec<u32> = edges.iter().flatten().copied().collect();
        ends.sort_unstable();
        let pinched: Vec<_> = bad.iter().filter(|v| ends.binary_search(v).is_err()).map(|&v| [v]).collect();
        let advice = "its link is neither a sphere nor a disk: the tetrahedra there touch in a point only, or do not \
                      close up to a ball; split the vertex, or mesh its neighbourhood again";
        violations.add("non-manifold-vertex", Severity::Error, ElementKind::Vertex, &pinched, advice);
        report_orientation(&self.proper, &self.sheets, violations);
        let advice = "in no tetrahedron; drop it, or leave it out when reading";
        violations.add("isolated-vertex", Severity::Warning, ElementKind::Vertex, &self.corners.isolated(), advice);
        report_components(self.components, violations);
    }

    fn placement(&self, points: Points<'_>, signs: &[Sign]) -> Placement {
        let turned_sign = |cell: usize| {
            let sign = signs[self.proper.original(cell as u32) as usize];
            if self.sheets.turned[cell] { sign.reversed() } else { sign }
        };
        let cells = self.proper.complex.cell_count();
        let first = if cells > 0 { turned_sign(0) } else { Sign::Zero };
        let uniform = first != Sign::Zero && (0..cells).all(|cell| turned_sign(cell) == first);
        let shape = &self.skin.shape;
        let cells = shape.sheet_cells();
        let is_outer = |&piece: &usize| {
            let triangles = cells.triangles(piece, &self.skin.complex);
            let originals = triangles.map(|triangle| triangle.map(|v| self.skin.originals[v] as usize));
            points.enclosed_volume(originals).0 == first
        };
        // Only asked for where it decides something.
        let outer_pieces = if uniform { (0..shape.pieces.len()).filter(is_outer).count() } else { 0 };
        let flat_cells = signs.iter().filter(|&&sign| sign == Sign::Zero).count();
        Placement { uniform, flat_cells, boundary_intersections: None, boundary_vertices_merged: 0, outer_pieces }
    }

    /// How many boundary vertices lie at the point of another one.
    fn merged_on_boundary(&self, same: &[[u32; 2]]) -> usize {
        let on_boundary = |&v: &u32| self.proper.gluing.on_boundary[v as usize];
        let groups = same.chunk_by(|a, b| a[0] == b[0]);
        let count = |group: &[[u32; 2]]| {
            let copies = group.iter().map(|pair| pair[1]);
            copies.chain([group[0][0]]).filter(on_boundary).count().saturating_sub(1)
        };
        groups.map(count).sum()
    }

    fn find_intersections(&self, points: Points<'_>, violations: &mut Violations) -> usize {
        let positions: Vec<Point> = self.skin.originals.iter().map(|&v| points.positions[v as usize]).collect();
        let found = self_intersections(&positions, &self.skin.complex);
        let name = |pair: &[crate::mesh::CellId; 2]| {
            let [a, b] = pair.map(|cell| self.skin.complex.cell(cell).map(|v| self.skin.originals[v.index()]));
            [a[0], a[1], a[2], b[0], b[1], b[2]]
        };
        let listed: Vec<_> = found.pairs.iter().take(super::MOST_LISTED).map(name).collect();
        let advice = "they meet away from their common corners; move their vertices apart, or mesh the solid again";
        let kind = ElementKind::FacetPair;
        violations.add_counted("self-intersection", Severity::Error, kind, &listed, found.pairs.len(), advice);
        found.pairs.len()
    }

    fn cells_on_boundary(&self) -> usize {
        let on_boundary = &self.proper.gluing.on_boundary;
        self.proper.complex.cells().iter().filter(|cell| cell.iter().all(|v| on_boundary[v.index()])).count()
    }

    /// Triangles of two or more cells with all vertices on the boundary.
    fn interior_faces_on_boundary(&self) -> usize {
        let gluing = &self.proper.gluing;
        let all_on_boundary = |facet: Facet| {
            let mut vertices = self.proper.complex.facet_vertices(facet.cell(), facet.opposite());
            vertices.all(|v| gluing.on_boundary[v.index()])
        };
        let glued = self.proper.complex.cell_ids().flat_map(|cell| {
            let lower = move |&i: &usize| {
                let across = gluing.across[cell.index()][i];
                across.is_some() && across.cell() > cell
            };
            (0..4).filter(lower).map(move |i| Facet::new(cell, i))
        });
        let crowded = gluing.crowded.iter().map(|group| group[0]);
        glued.chain(crowded).filter(|&facet| all_on_boundary(facet)).count()
    }
}

/// The exact sign of each cell.
fn exact_signs(points: Points<'_>, complex: &TetrahedronComplex) -> Vec<Sign> {
    let sign = |cell: &[VertexId; 4]| {
        let [a, b, c, d] = cell.map(|v| points.positions[v.index()]);
        orient3d(a, b, c, d)
    };
    complex.cells().iter().map(sign).collect()
}

fn report_signs(
    complex: &TetrahedronComplex,
    signs: &[Sign],
    proper: &ProperCells<'_, 4>,
    violations: &mut Violations,
) {
    let of_sign = |wanted: Sign| {
        (0..complex.cell_count() as u32)
            .filter(|&cell| signs[cell as usize] == wanted && proper.repeating.binary_search(&cell).is_err())
            .map(|cell| [cell])
            .collect::<Vec<_>>()
    };
    let advice = "volume zero, exactly: the corners lie in a plane; move a corner, or collapse an edge";
    violations.add("degenerate-cell", Severity::Error, ElementKind::Cell, &of_sign(Sign::Zero), advice);
    let inverted = of_sign(Sign::Negative);
    let advice = if inverted.len() == complex.cell_count() {
        "negative volume, all of them: the vertices are listed in mirrored order; swap two vertices of each (`--orient` \
         does it)"
    } else {
        "negative volume: turned inside out, or listed in mirrored order; move a corner, or swap two vertices \
         (`--orient`) where the neighbours agree"
    };
    violations.add("inverted-cell", Severity::Error, ElementKind::Cell, &inverted, advice);
}

fn measure(points: Points<'_>, complex: &TetrahedronComplex, signs: &[Sign]) -> VolumeGeometry {
    let count = |wanted: Sign| signs.iter().filter(|&&sign| sign == wanted).count();
    let (mut dihedral, mut corners) = (AngleTracker::new(), AngleTracker::new());
    let mut volume = 0.0;
    for (cell, _) in complex.cells().iter().zip(signs).filter(|&(_, &sign)| sign != Sign::Zero) {
        volume += measure_cell(points, cell.map(VertexId::index), &mut dihedral, &mut corners);
    }
    VolumeGeometry {
        lowest: points.hull.low,
        highest: points.hull.high,
        diagonal: points.diagonal,
        volume: volume / 6.0 / points.scale / points.scale / points.scale,
        positive_cells: count(Sign::Positive),
        negative_cells: count(Sign::Negative),
        flat_cells: count(Sign::Zero),
        dihedral_angles: dihedral.range(),
        triangle_angles: corners.range(),
    }
}

/// Adds the angles of a tetrahedron; returns six times its volume.
///
/// Normals of two faces have a vector product of length `|edge| * |det|`, where `det` is six times
/// the volume; this gives the sine without subtracting.
fn measure_cell(
    points: Points<'_>,
    [a, b, c, d]: [usize; 4],
    dihedral: &mut AngleTracker,
    corners: &mut AngleTracker,
) -> f64 {
    let [ab, ac, ad] = [b, c, d].map(|v| points.vector(a, v));
    let [bc, bd, cd] = [points.vector(b, c), points.vector(b, d), points.vector(c, d)];
    // Normals of the faces opposite a, b, c, d, outwards for positive cells.
    let [na, nb, nc, nd] = [cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)];
    let determinant = dot(na, ab);
    for (edge, m, n) in [(ab, nc, nd), (ac, nb, nd), (ad, nb, nc), (bc, na, nd), (bd, na, nc), (cd, na, nb)] {
        dihedral.add(-dot(m, n), norm(edge) * determinant);
    }
    for (normal, x, y, z) in [(na, bc, cd, bd), (nb, ac, cd, ad), (nc, ab, bd, ad), (nd, ab, bc, ac)] {
        // The triangle has the sides x, y and their sum z.
        let double_area = norm(normal);
        corners.add(dot(x, z), double_area);
        corners.add(dot(y, z), double_area);
        corners.add(-dot(x, y), double_area);
    }
    determinant
}
