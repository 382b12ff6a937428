//! Work inside a shell: `homeo simplify`, `homeo remesh`, `homeo transfer`, `homeo pl`; and `homeo compose` of what a mesh
//! carries, which is a transfer too.
//!
//! The first three end alike: a surface in the shell is certified as the image of the source, what the source's file says is
//! moved to it, and both are written.

mod across;
mod attributes;
mod make;
mod pl;
mod shells;
mod sizing;
mod texture;
mod transfer;

pub use across::run as across;
pub use make::{remesh, simplify};
pub use pl::run as pl;
pub use transfer::run as transfer;

use std::path::{Path, PathBuf};

use homeo::certificate::{Provenance, write_shell};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Progress;
use homeo_core::io::{Attribute, Format, MeshFile, WriteOptions, read_mesh_bytes, write_mesh_to};
use homeo_verify::Claim;

use crate::failure::{Failure, Result};
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::session::Session;

/// Where things go.
struct Targets<'a> {
    mesh: &'a Path,
    map: Option<&'a Path>,
}

impl Targets<'_> {
    /// Refuses names that cannot be written to.
    fn check(&self, inputs: &[&Path]) -> Result<Format> {
        check_targets(&self.paths().collect::<Vec<_>>(), inputs)?;
        match Format::of_path(self.mesh) {
            Some(Format::Json) | None => {
                let message =
                    format!("{}: give a name that ends in .obj, .ply, .off, .stl, .vtu or .vtk", self.mesh.display());
                Err(Failure::usage(message))
            }
            Some(format) => Ok(format),
        }
    }

    fn paths(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(self.mesh).chain(self.map)
    }

    fn written(&self) -> Vec<PathBuf> {
        self.paths().map(Path::to_path_buf).collect()
    }
}

/// Has the map from the source onto the section checked, on the bytes of its file.
fn certify(
    session: &Session,
    shell: &Shell,
    provenance: &Provenance,
    path: Option<&Path>,
    outputs: &mut Outputs,
) -> Result<Claim> {
    proof::write_and_check(session, path, outputs, |mut out| write_shell(shell, provenance, &mut out))
}

/// The mesh of a surface, with what is known on it.
fn mesh_file(surface: &SourceMesh<3>, attributes: Vec<Attribute>, original: &MeshFile) -> MeshFile {
    let triangles: Vec<[u32; 3]> = surface.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
    MeshFile {
        attributes,
        names: original.names.clone(),
        material_libraries: original.material_libraries.clone(),
        ..MeshFile::from_triangles(surface.positions().to_vec(), &triangles)
    }
}

/// Writes a mesh under a temporary name and reads it back; notes what the format could not hold.
fn stage_mesh(session: &Session, path: &Path, format: Format, mesh: &MeshFile, outputs: &mut Outputs) -> Result<()> {
    session.stage("write");
    let losses = staged(session, path, format, mesh, outputs)?;
    session.fact("losses", losses);
    Ok(())
}

/// The same, for one mesh of several; gives what the format could not hold.
fn staged(
    session: &Session,
    path: &Path,
    format: Format,
    mesh: &MeshFile,
    outputs: &mut Outputs,
) -> Result<Vec<String>> {
    let mut losses = Vec::new();
    let partial = outputs.stage(session, path, |out| {
        let report = write_mesh_to(out, format, mesh, &WriteOptions::default()).map_err(|e| e.to_string())?;
        losses = report.losses;
        Ok(())
    })?;
    let unreadable = |what: String| Failure::bug(format!("{} cannot be read back: {what}", path.display()));
    let bytes = std::fs::read(&partial).map_err(|e| unreadable(e.to_string()))?;
    let back = read_mesh_bytes(format, path, &bytes).map_err(|e| unreadable(e.to_string()))?;
    if back.positions != mesh.positions || back.polygons != mesh.polygons {
        losses.push(format!(
            "{} does not hold the surface bit for bit, so the certificate is about the surface in the map file only",
            format.name()
        ));
    }
    for loss in &losses {
        session.display().note(&format!("{}: {loss}", path.display()));
    }
    session.check()?;
    Ok(losses)
}
