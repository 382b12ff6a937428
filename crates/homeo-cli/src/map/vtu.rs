//! The mesh with the map as fields, for ParaView and the like.

use std::path::Path;

use homeo::progress::Progress;
use homeo_core::io::{Attribute, Element, Format, MeshFile, Values, WriteOptions, write_mesh_to};

use crate::failure::{Failure, Result};
use crate::outputs::Outputs;
use crate::sampled::Images;
use crate::session::Session;

/// Refuses names whose format holds no fields.
///
/// # Errors
/// When the extension is neither .vtu nor .vtk.
pub fn check_name(path: &Path) -> Result<()> {
    match Format::of_path(path) {
        Some(Format::Vtu | Format::Vtk) => Ok(()),
        _ => Err(Failure::usage(format!("--vtu {}: the name must end in .vtu or .vtk", path.display()))),
    }
}

/// Stages the file: the fields of the input, and `image` on vertices, `distortion` on cells.
///
/// # Errors
/// When it cannot be written.
pub fn stage(session: &Session, path: &Path, mesh: &MeshFile, images: &Images, outputs: &mut Outputs) -> Result<()> {
    let format = Format::of_path(path).unwrap_or(Format::Vtu);
    let mut mesh = mesh.clone();
    mesh.losses.clear();
    let taken = |name: &str, element| mesh.attribute(name, element).is_some();
    let cells = if mesh.is_volume() { Element::Tetrahedron } else { Element::Polygon };
    let name = |plain: &str, element| if taken(plain, element) { format!("homeo_{plain}") } else { plain.to_owned() };
    let image = Attribute {
        name: name("image", Element::Vertex),
        element: Element::Vertex,
        components: 3,
        values: Values::F64(images.images.iter().flatten().copied().collect()),
    };
    let distortion = Attribute {
        name: name("distortion", cells),
        element: cells,
        components: 1,
        values: Values::F64(images.stretch.clone()),
    };
    mesh.attributes.extend([image, distortion]);
    let mut losses = Vec::new();
    outputs.stage(session, path, |out| {
        let report = write_mesh_to(out, format, &mesh, &WriteOptions::default()).map_err(|e| e.to_string())?;
        losses = report.losses;
        Ok(())
    })?;
    if session.is_cancelled() {
        return Err(session.stopped());
    }
    losses.iter().for_each(|loss| session.display().note(loss));
    Ok(())
}
