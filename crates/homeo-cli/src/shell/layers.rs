//! Bottom, middle and top of a shell as meshes, to be looked at.

use std::path::{Path, PathBuf};

use homeo::map::ShellParts;
use homeo_core::io::{Format, MeshFile, WriteOptions, write_mesh_to};

use crate::failure::Result;
use crate::outputs::Outputs;
use crate::session::Session;

/// Where the layers go.
pub fn paths(prefix: &Path) -> [PathBuf; 3] {
    ["bottom", "middle", "top"].map(|layer| {
        let mut path = prefix.as_os_str().to_owned();
        path.push(format!("_{layer}.obj"));
        path.into()
    })
}

/// Stages the files.
///
/// # Errors
/// When one cannot be written.
pub fn stage(session: &Session, paths: &[PathBuf; 3], parts: &ShellParts, outputs: &mut Outputs) -> Result<()> {
    for (path, points) in paths.iter().zip([&parts.bottom, &parts.middle, &parts.top]) {
        let mesh = MeshFile::from_triangles(points.clone(), &parts.prisms);
        outputs.stage(session, path, |out| {
            write_mesh_to(out, Format::Obj, &mesh, &WriteOptions::default()).map(|_| ()).map_err(|e| e.to_string())
        })?;
        session.check()?;
    }
    Ok(())
}
