//! The files of a bundle: tetrahedra or gluings as JSON, a mesh.

use std::io::{BufWriter, Write};
use std::path::Path;

use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, Format, MeshFile, Values, WriteOptions, write_mesh_to};
use homeo_manifold::bundle::TangentBundle;
use homeo_manifold::write_record;
use serde_json::{Value, json};

use super::Made;
use super::field::FieldSection;
use crate::failure::{Failure, Result};
use crate::outputs::Outputs;
use crate::session::Session;

/// What a file holds, by its extension.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Certificate,
    Tetrahedra,
    Gluings,
    Mesh(Format),
}

impl Kind {
    /// Refuses names of files that cannot hold tetrahedra.
    pub fn of(path: &Path, gluings: bool) -> Result<Self> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let kind = match (extension.as_deref(), Format::of_path(path)) {
            (Some("json"), _) if gluings => return Ok(Self::Gluings),
            (Some("json"), _) => Self::Tetrahedra,
            (Some("homeo"), _) => Self::Certificate,
            (_, Some(format @ (Format::Medit | Format::Msh | Format::Vtk | Format::Vtu))) => Self::Mesh(format),
            _ => {
                let message = format!("{}: give .json, .homeo, .mesh, .msh, .vtk or .vtu", path.display());
                return Err(Failure::usage(message));
            }
        };
        match gluings {
            true => Err(Failure::usage("--gluings is for an output that ends in .json")),
            false => Ok(kind),
        }
    }
}

/// Stages a file; `positions` are those of the surface that was read. Certificates are staged where they are checked.
///
/// # Errors
/// When it cannot be written.
pub fn stage(
    session: &Session,
    path: &Path,
    kind: Kind,
    made: &Made,
    positions: &[[f64; 3]],
    outputs: &mut Outputs,
) -> Result<()> {
    session.stage("write");
    match kind {
        Kind::Certificate => Ok(()),
        Kind::Tetrahedra => {
            outputs.stage(session, path, |out| write_tetrahedra(made, out).map_err(|e| e.to_string())).map(|_| ())
        }
        Kind::Gluings => {
            let text = write_record(&made.triangulation);
            outputs.stage(session, path, |out| out.write_all(text.as_bytes()).map_err(|e| e.to_string())).map(|_| ())
        }
        Kind::Mesh(format) => {
            let losses = stage_mesh(session, path, format, &mesh(made, positions), outputs)?;
            session.fact("losses", losses);
            Ok(())
        }
    }
}

/// The format of a surface that holds fields at triangles.
///
/// # Errors
/// Wrong usage for any other.
pub fn surface_format(path: &Path) -> Result<Format> {
    match Format::of_path(path) {
        Some(format @ (Format::Ply | Format::Vtk | Format::Vtu)) => Ok(format),
        _ => Err(Failure::usage(format!("{}: give .ply, .vtk or .vtu", path.display()))),
    }
}

/// Stages the surface with its fields.
///
/// # Errors
/// When it cannot be written.
pub fn stage_surface(
    session: &Session,
    path: &Path,
    format: Format,
    mesh: &MeshFile,
    outputs: &mut Outputs,
) -> Result<()> {
    stage_mesh(session, path, format, mesh, outputs).map(|_| ())
}

/// Stages a mesh; says what its format cannot hold.
fn stage_mesh(
    session: &Session,
    path: &Path,
    format: Format,
    mesh: &MeshFile,
    outputs: &mut Outputs,
) -> Result<Vec<String>> {
    let mut losses = Vec::new();
    outputs.stage(session, path, |out| {
        losses = write_mesh_to(out, format, mesh, &WriteOptions::default()).map_err(|e| e.to_string())?.losses;
        Ok(())
    })?;
    losses.iter().for_each(|loss| session.display().note(&format!("{}: {loss}", path.display())));
    Ok(losses)
}

/// One row on each line, so that large files can be read by eye and compared.
fn write_tetrahedra(made: &Made, out: &mut BufWriter<std::fs::File>) -> std::io::Result<()> {
    let bundle = &made.tangent.bundle;
    let described = json!({
        "vertices": made.vertex_count(), "layers": bundle.layers(), "fibre": "vertex v * layers + level",
        "euler_number": made.euler_number, "cuts": made.tangent.cuts, "middles": made.middles, "added": added(&made.tangent),
    });
    let text = described.to_string();
    // All of it but the closing brace.
    write!(out, "{}", text.strip_suffix('}').unwrap_or(&text))?;
    write_rows(out, "base", bundle.triangles())?;
    write_rows(out, "slopes", bundle.slopes())?;
    write_rows(out, "parents", &made.tangent.parents.iter().map(|&parent| [parent]).collect::<Vec<_>>())?;
    if let Some(field) = &made.field {
        write_section(field, out)?;
    }
    write_rows(out, "tets", &made.tetrahedra)?;
    writeln!(out, "\n}}")
}

/// The levels of a section, null where there is none, its paths over edges, and its indices on the surface that was read.
fn write_section(field: &FieldSection, out: &mut BufWriter<std::fs::File>) -> std::io::Result<()> {
    let levels = field.section.levels.iter().map(|level| level.map_or(Value::Null, Value::from)).collect::<Value>();
    let pairs =
        |list: &[(u32, i64)]| json!(list.iter().map(|&(element, index)| json!([element, index])).collect::<Vec<_>>());
    write!(out, ",\n\"section\": {{\"levels\": {levels}, \"singular_triangles\": {}, ", pairs(&field.triangles))?;
    write!(out, "\"singular_vertices\": {}, \"paths\": [", pairs(&field.vertices))?;
    for (number, path) in field.section.paths.iter().enumerate() {
        write!(out, "{}\n{path:?}", if number == 0 { "" } else { "," })?;
    }
    write!(out, "]}}")
}

fn write_rows<const K: usize>(
    out: &mut BufWriter<std::fs::File>,
    name: &str,
    rows: &[[u32; K]],
) -> std::io::Result<()> {
    write!(out, ",\n\"{name}\": [")?;
    for (number, row) in rows.iter().enumerate() {
        let comma = if number == 0 { "" } else { "," };
        match row.as_slice() {
            [single] => write!(out, "{comma}{single}")?,
            row => write!(out, "{comma}\n{row:?}")?,
        }
    }
    write!(out, "]")
}

/// For each vertex of the base that the surface does not have: older vertices, and their weights.
fn added(tangent: &TangentBundle) -> Value {
    tangent.added.iter().map(|carrier| json!({"vertices": carrier.vertices, "weights": carrier.weights})).collect()
}

/// The mesh with its vertices where those of the base are, and these and the levels as attributes.
fn mesh(made: &Made, positions: &[[f64; 3]]) -> MeshFile {
    let (bundle, mut points) = (&made.tangent.bundle, positions.to_vec());
    for carrier in &made.tangent.added {
        points.push(carrier.point(&points));
    }
    let layers = bundle.layers() as usize;
    let places = points.iter().flat_map(|point| std::iter::repeat_n(*point, layers)).collect();
    let mut mesh = MeshFile::from_tetrahedra(places, made.tetrahedra.clone());
    let attribute = |name: &str, of: &dyn Fn(usize) -> usize| Attribute {
        name: name.to_owned(),
        element: Element::Vertex,
        components: 1,
        values: Values::I64((0..made.vertex_count()).map(|vertex| of(vertex) as i64).collect()),
    };
    mesh.attributes = vec![attribute("base", &|vertex| vertex / layers), attribute("level", &|vertex| vertex % layers)];
    if let Some(field) = &made.field {
        let is_met = |vertex: usize| field.section.levels[vertex / layers] == Some((vertex % layers) as u32);
        mesh.attributes.push(attribute("section", &|vertex| usize::from(is_met(vertex))));
        // Three tetrahedra for each level stand over a triangle.
        let indices =
            field.section.triangle_indices.iter().flat_map(|&index| std::iter::repeat_n(index, 3 * layers)).collect();
        let (name, values) = ("index".to_owned(), Values::I64(indices));
        mesh.attributes.push(Attribute { name, element: Element::Tetrahedron, components: 1, values });
    }
    mesh
}
