//! The independent checker of homeo's map files.
//!
//! It reads a `.homeo` file and re-establishes, from the stored numbers alone and in exact arithmetic, that the map
//! is a homeomorphism. It shares no code with the constructions. `docs/certificate-format-v1.md` is its
//! specification; every comment "rule X" refers to it. The order of reading:
//!
//! 1. `archive`, `npy`, `manifest`, `map_file`: bytes to arrays, hostile input;
//! 2. `complex`, `links`, `number`: neighbours, manifolds, exact signs;
//! 3. `source` (rules S, 8), `subdivision` (R), `foliation` (1-6, 8), `section` (7), `piecewise_linear` (P, 7);
//! 4. `triangles`, `shell` (L1-L6, of `docs/theory/shells.md`);
//! 5. `rings` (D), `harmonic` (H1-H5), `circuit` (H6, of `docs/theory/polygons.md`);
//! 6. `composite` (C1-C3, of `docs/theory/composite.md`), `ball`, `mean_value`: numbers and formulas of C3 and K3;
//! 7. `complex_barycentric` (K1-K3, of `docs/theory/complex.md`), `mean_value/speeds`: what speeds add;
//! 8. `hyperbolic` (Y1-Y8, of `docs/theory/hyperbolic.md`);
//! 9. `bundle` (T1-T10, of `docs/theory/bundles.md`);
//! 10. `moved` (M1-M5, of `docs/theory/cages.md`).
//!
//! # Complexity
//! Time `O(N log N)` for `N` cells (it sorts facets and edges); memory about ten times the bytes of the file. For
//! shells also the number of pairs, of a source triangle and a prism, whose boxes meet; for moved meshes that of pairs of
//! boundary triangles. Composite mean value maps and complex maps: for each
//! step some hundred to thousand boxes for each vertex, each of `O(N)`; on all processors.

mod affine;
mod archive;
mod ball;
mod bundle;
mod cage;
mod circuit;
mod complex;
mod complex_barycentric;
mod composite;
mod foliation;
mod harmonic;
mod hyperbolic;
mod links;
mod manifest;
mod map_file;
mod mean_value;
mod moved;
mod npy;
mod number;
mod parallel;
mod piecewise_linear;
mod rings;
mod section;
mod shell;
mod source;
mod subdivision;
mod triangles;
mod verdict;

pub use verdict::{Claim, Obstacle, Unreadable, Verdict, Witness};

use manifest::{Kind, Target};
use map_file::{MapData, MapFile};
use std::path::Path;
use verdict::{Checked, Stop, unreadable};

/// Reads and checks a map file.
///
/// # Errors
/// [`Unreadable`] when the file cannot be read or breaks a container rule.
///
/// # Example
/// ```no_run
/// let verdict = homeo_verify::verify_file("spot.homeo".as_ref())?;
/// println!("{verdict:?}");
/// # Ok::<(), homeo_verify::Unreadable>(())
/// ```
pub fn verify_file(path: &Path) -> Result<Verdict, Unreadable> {
    let bytes = std::fs::read(path).map_err(|error| unreadable(format!("{}: {error}", path.display())))?;
    verify_bytes(&bytes)
}

/// Checks a map file that is already in memory.
///
/// # Errors
/// [`Unreadable`] when the bytes break a container rule.
///
/// # Example
/// ```
/// assert!(homeo_verify::verify_bytes(&[]).is_err());
/// ```
pub fn verify_bytes(bytes: &[u8]) -> Result<Verdict, Unreadable> {
    let map = MapFile::read(bytes)?;
    Ok(match check_map(&map) {
        Ok(claim) => Verdict::Certified(claim),
        Err(Stop::Undecided(obstacle)) => Verdict::Undecided(obstacle),
        Err(Stop::Refuted(mut witness)) => {
            if witness.points.is_empty() {
                let places: Option<Vec<_>> = witness.vertices.iter().map(|&v| map.place(v)).collect();
                witness.points = places.unwrap_or_default();
            }
            Verdict::Refuted(witness)
        }
    })
}

/// Whether a map is about a given mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SourceMatch {
    /// Bit for bit the mesh of the map.
    Same,
    /// Another mesh; the text says where it first differs.
    Different(String),
}

/// Compares the source stored in a map file with a mesh, bit for bit; `cells` lists the cells one after the other.
///
/// # Errors
/// [`Unreadable`] when the bytes break a container rule.
///
/// # Example
/// ```no_run
/// # let (bytes, positions, cells) = (vec![], vec![[0.0; 3]; 4], vec![0, 1, 2, 3]);
/// use homeo_verify::{SourceMatch, compare_source};
/// assert_eq!(compare_source(&bytes, &positions, &cells, 4)?, SourceMatch::Same);
/// # Ok::<(), homeo_verify::Unreadable>(())
/// ```
pub fn compare_source(
    bytes: &[u8],
    positions: &[[f64; 3]],
    cells: &[u32],
    vertices_per_cell: usize,
) -> Result<SourceMatch, Unreadable> {
    let map = MapFile::read(bytes)?;
    let bits = |points: &[[f64; 3]], v: usize| points[v].map(f64::to_bits);
    let size = map.manifest.cell_size();
    let difference = if vertices_per_cell != size {
        Some(format!("cells of {size} vertices, not {vertices_per_cell}"))
    } else if (positions.len(), cells.len()) != (map.positions.len(), map.cells.len()) {
        Some(format!("{} vertices and {} cells", map.positions.len(), map.cells.len() / size))
    } else if let Some(v) = (0..positions.len()).find(|&v| bits(positions, v) != bits(&map.positions, v)) {
        Some(format!("vertex {v} at {:?}, not {:?}", map.positions[v], positions[v]))
    } else {
        let place = (0..cells.len()).find(|&i| cells[i] != map.cells[i]);
        place.map(|i| format!("another cell {}", i / vertices_per_cell))
    };
    Ok(match difference {
        None => SourceMatch::Same,
        Some(text) => SourceMatch::Different(format!("the map's source has {text}")),
    })
}

/// Compares the source of a map between planar domains with a polygon, bit for bit.
///
/// # Errors
/// [`Unreadable`] when the bytes break a container rule.
///
/// # Example
/// ```no_run
/// # let (bytes, rings) = (vec![], vec![vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]);
/// use homeo_verify::{SourceMatch, compare_polygon};
/// assert_eq!(compare_polygon(&bytes, &rings)?, SourceMatch::Same);
/// # Ok::<(), homeo_verify::Unreadable>(())
/// ```
pub fn compare_polygon(bytes: &[u8], rings: &[Vec<[f64; 2]>]) -> Result<SourceMatch, Unreadable> {
    let map = MapFile::read(bytes)?;
    let different = |text: String| Ok(SourceMatch::Different(format!("the map's source {text}")));
    let (ring_sizes, points) = match &map.data {
        MapData::Harmonic(data) => (&data.ring_sizes, &data.source_points),
        MapData::Composite(data) => (&data.ring_sizes, &data.stages[0]),
        MapData::Complex(data) => (&data.ring_sizes, &data.domains[0]),
        _ => return different("is a mesh".to_owned()),
    };
    let sizes: Vec<usize> = rings.iter().map(Vec::len).collect();
    if !sizes.iter().copied().eq(ring_sizes.iter().map(|&n| n as usize)) {
        return different(format!("has rings of {ring_sizes:?} vertices"));
    }
    let bits = |[x, y, _]: [f64; 3]| [x.to_bits(), y.to_bits()];
    let same = |(a, b): (&[f64; 2], &[f64; 3])| a.map(f64::to_bits) == bits(*b);
    match rings.iter().flatten().zip(points).position(|pair| !same(pair)) {
        None => Ok(SourceMatch::Same),
        Some(v) => different(format!("has vertex {v} at {:?}", &points[v][..2])),
    }
}

/// What most maps between planar domains do on edges.
const LINEAR: &str = "is linear on every edge";

/// Applies every rule and puts the claim into words.
fn check_map(map: &MapFile) -> Checked<Claim> {
    let checked = check_rules(map)?;
    let is_immersed = map.manifest.target == Target::ImmersedShell;
    let is_embedded = map.manifest.target == Target::EmbeddedShell;
    let is_canonical = map.manifest.target == Target::CanonicalDecomposition;
    let has_section = map.manifest.target == Target::UnitTangentBundleWithSection;
    let (kind, theorem) = match map.manifest.kind {
        Kind::Foliation => ("foliation", "theorem on locally bipolar foliations, rules 1-8"),
        Kind::PiecewiseLinear => ("piecewise-linear", "degree theorem for piecewise-linear maps, rules 8 and P"),
        Kind::Shell if is_immersed => ("shell", "theorem on immersed shells, rules L1-L6 and I1-I4"),
        Kind::Shell if is_embedded => ("shell", "theorem on shells, rules L1-L6, E1 and E2"),
        Kind::Shell => ("shell", "theorem on shells, rules L1-L6"),
        Kind::CompositeHarmonic if map.manifest.target == Target::Domain => {
            ("composite-harmonic", "theorem on composite harmonic maps, rules D and H1-H6")
        }
        Kind::CompositeHarmonic => ("composite-harmonic", "theorem on composite harmonic maps, rules D and H1-H5"),
        Kind::CompositeMeanValue => ("composite-mean-value", "theorem on composite mean value maps, rules D and C1-C3"),
        Kind::ComplexBarycentric => ("complex-barycentric", "theorem on complex maps with speeds, rules D and K1-K3"),
        Kind::Hyperbolic if is_canonical => {
            ("hyperbolic", "theorems on glued truncated tetrahedra and tilts, rules Y1-Y8")
        }
        Kind::Hyperbolic => ("hyperbolic", "theorem on glued truncated tetrahedra, rules Y1-Y7"),
        Kind::UnitTangentBundle if has_section => ("unit-tangent-bundle", "theorem on circle bundles, rules T1-T10"),
        Kind::UnitTangentBundle => ("unit-tangent-bundle", "theorem on circle bundles, rules T1-T8"),
        Kind::MovedMesh => ("moved-mesh", "theorem on moved meshes, rules M1-M5"),
        Kind::CompositeCage => ("composite-cage", "theorem on maps between cages, rules Q1-Q3"),
    };
    let (target, onto) = match map.manifest.target {
        Target::Square => ("square", "square [0,1]^2"),
        Target::Cube => ("cube", "cube [0,1]^3"),
        Target::Disk => ("disk", "diamond |x| + |y| <= 1, and by a fixed homeomorphism onto the unit disk"),
        Target::Ball => ("ball", "tetrahedron of the format, and by a fixed homeomorphism onto a round ball"),
        Target::Shell => ("shell", "middle surface"),
        Target::Section => ("section", "other section"),
        Target::ImmersedShell => ("immersed-shell", "middle surface"),
        Target::EmbeddedShell => ("embedded-shell", "middle surface"),
        Target::Polygon => ("polygon", "target polygon"),
        Target::Annulus => ("annulus", "target polygon with a hole"),
        Target::Domain => ("domain", "target polygon with holes"),
        Target::GeodesicBoundary => ("geodesic-boundary", "manifold"),
        Target::CanonicalDecomposition => ("canonical-decomposition", "manifold"),
        Target::UnitTangentBundle => ("unit-tangent-bundle", "surface"),
        Target::UnitTangentBundleWithSection => ("unit-tangent-bundle-with-section", "surface"),
        Target::Space => ("space", "moved mesh"),
        Target::Polyhedron => ("polyhedron", "target cage"),
    };
    let (vertices, cells) = (map.positions.len(), map.cells.len() / map.manifest.cell_size());
    let mut statement = format!(
        "The stored map is a homeomorphism from the complex of {vertices} vertices and {cells} cells onto the \
         {onto} ({theorem})."
    );
    let mut overlaps =
        "Whether cells of the source overlap in space is a property of the input mesh and was not decided.";
    if let MapData::Shell(shell) = &map.data {
        statement = format!(
            "The projection along the pillars is a homeomorphism from the surface of {vertices} vertices and {cells} \
             triangles onto the {onto} of {} ({theorem}).",
            match &shell.section {
                None => format!("{} prisms", shell.prisms.len() / 3),
                Some((points, cells)) => format!("{} vertices and {} triangles", points.len(), cells.len() / 3),
            }
        );
        overlaps = "Away from the sections the shell may overlap itself in space; whether it does was not decided.";
        if is_embedded {
            statement.push_str(" The shell does not overlap itself: no point of space is in it twice.");
            overlaps = "Nothing is said of the size of the shell.";
        }
        if is_immersed {
            statement.push_str(
                " Both are meant as abstract surfaces, glued from their triangles: in space they may cross themselves.",
            );
            overlaps = "Surface and shell may cross themselves in space; whether they do was not decided. A point of \
                        space where sheets cross has an image for each of them.";
        }
    }
    let planar = match &map.data {
        MapData::Harmonic(data) => Some((data.ring_sizes.len(), String::new(), LINEAR)),
        MapData::Composite(data) => Some((data.ring_sizes.len(), format!("{} ", in_steps(data.tilings.len())), LINEAR)),
        MapData::Complex(data) => {
            Some((data.ring_sizes.len(), String::new(), "runs along every edge at its stored speed"))
        }
        _ => None,
    };
    if let Some((rings, steps, on_edges)) = planar {
        statement = format!(
            "The stored map is a homeomorphism {steps}from the domain of {vertices} vertices in {rings} ring(s) onto the \
             {onto}; it {on_edges} ({theorem})."
        );
        overlaps = "Nothing is said of how much it distorts.";
    }
    if let MapData::Hyperbolic(data) = &map.data {
        let (tetrahedra, edges) = (data.gluings.len() / 4, data.cosh_lengths.len());
        statement = format!(
            "The manifold of {tetrahedra} glued tetrahedra, its vertices cut off, has a complete hyperbolic structure with \
             totally geodesic boundary, made of truncated tetrahedra; the hyperbolic cosines of the lengths of its {edges} \
             edges are in the stated box, and are the only ones there ({theorem})."
        );
        if is_canonical {
            statement.push_str(
                " The tetrahedra are the cells of its canonical decomposition: two manifolds with such a claim are homeomorphic \
                 if and only if their gluings are the same up to the names of tetrahedra and corners.",
            );
        }
        overlaps = "By Mostow and Prasad it is the only such structure of the manifold; the checker relies on this theorem for it.";
    }
    if let MapData::Bundle(data) = &map.data {
        statement = data.statement(theorem);
        overlaps = "That oriented circle bundles are classified by their Euler number is a theorem that the checker relies on.";
    }
    if let MapData::Moved(_) = &map.data {
        statement = moved::statement(map, theorem);
        overlaps = "Nothing is said of how much it distorts.";
    }
    if let MapData::Cages(later) = &map.data {
        statement = format!(
            "The stored map is a homeomorphism {} from the inside of the cage of {vertices} vertices and {cells} triangles \
             onto that of the {onto}; it is linear on every triangle ({theorem}).",
            in_steps(later.len())
        );
        overlaps = "Nothing is said of how much it distorts.";
    }
    let limits = [
        match &map.data {
            MapData::Cages(_) => "The claim is about the exact mean value maps of the cages in the file.",
            MapData::Moved(_) => {
                "The claim is about the two meshes in the file, and not about what moved the one to the other."
            }
            MapData::Bundle(_) => {
                "The claim is about the surface and the tetrahedra in the file, as abstract complexes."
            }
            MapData::Hyperbolic(_) => "The claim is about the gluing in the file and the box round the stored numbers.",
            MapData::Composite(_) => "The claim is about the exact mean value maps of the polygons in the file.",
            MapData::Complex(_) => "The claim is about the exact complex map of the polygons and speeds in the file.",
            _ => "The claim is about the complex with these cells and the exact rational map that the file defines.",
        },
        overlaps,
        match &map.data {
            MapData::Hyperbolic(_) => "Angles and volume that a program prints are not in the file.",
            MapData::Bundle(_) => "Homology that a program prints is not in the file.",
            _ => "Evaluation in floating point approximates this map; it is not the certified object.",
        },
    ];
    Ok(Claim {
        statement,
        kind: kind.to_owned(),
        target: target.to_owned(),
        checked,
        source_sha256: map.manifest.source.content_sha256.clone(),
        limits: limits.map(str::to_owned).to_vec(),
    })
}

fn in_steps(count: usize) -> String {
    if count == 1 { "in one step".to_owned() } else { format!("in {count} steps") }
}

/// Applies every rule and counts what was checked.
fn check_rules(map: &MapFile) -> Checked<Vec<(&'static str, u64)>> {
    if let MapData::Shell(data) = &map.data {
        return shell::check_shell(map, data);
    }
    if let MapData::Harmonic(data) = &map.data {
        return harmonic::check_harmonic(data);
    }
    if let MapData::Composite(data) = &map.data {
        return composite::check_composite(data);
    }
    if let MapData::Complex(data) = &map.data {
        return complex_barycentric::check_complex(data);
    }
    if let MapData::Hyperbolic(data) = &map.data {
        let is_canonical = map.manifest.target == Target::CanonicalDecomposition;
        return hyperbolic::check_hyperbolic(data, map.manifest.source.vertices, is_canonical);
    }
    if let MapData::Bundle(data) = &map.data {
        return bundle::check_bundle(data);
    }
    if let MapData::Moved(after) = &map.data {
        return moved::check_moved(map, after);
    }
    if let MapData::Cages(later) = &map.data {
        return cage::check_cages(map, later);
    }
    let source = source::check_source(map)?;
    let refined = match &map.refinement {
        Some(refinement) => Some(subdivision::check_subdivision(map, refinement, &source)?),
        None => None,
    };
    let complex = refined.as_ref().unwrap_or(&source);
    let mut checked = vec![
        ("source vertices with finite coordinates (rule S1)", map.positions.len() as u64),
        ("source cells, oriented and with manifold links (rules S2-S4, 8)", source.count() as u64),
        ("cells of the subdivision (rules R1-R6)", refined.as_ref().map_or(0, |r| r.count() as u64)),
    ];
    match &map.data {
        MapData::Foliation(data) => {
            let centre = map.manifest.centre.as_ref().map(|centre| centre.cell);
            checked.extend(foliation::check_foliation(complex, data, centre, map.manifest.target)?);
        }
        MapData::PiecewiseLinear(images) => {
            piecewise_linear::check_onto_box(complex, |v| images[v as usize], "P")?;
            checked.push(("image cells with the right sign (rule P)", complex.count() as u64));
        }
        MapData::Shell(_) | MapData::Harmonic(_) | MapData::Composite(_) => {} // above
        MapData::Complex(_) | MapData::Hyperbolic(_) | MapData::Bundle(_) => {} // above
        MapData::Moved(_) | MapData::Cages(_) => {}                            // above
    }
    Ok(checked)
}
