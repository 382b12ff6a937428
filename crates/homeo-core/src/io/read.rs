//! From a path or bytes to a mesh, by format.

use std::path::Path;

use super::error::{Fault, Outcome, Place, ReadError};
use super::mesh_file::MeshFile;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ, `.obj`.
    Obj,
    /// Stanford PLY, `.ply`.
    Ply,
    /// Stereolithography STL, `.stl`.
    Stl,
    /// Object File Format, `.off`.
    Off,
    /// Gmsh MSH, `.msh`.
    Msh,
    /// MEDIT, `.mesh`.
    Medit,
    /// VTK legacy, `.vtk`.
    Vtk,
    /// VTK XML unstructured grid, `.vtu`.
    Vtu,
    /// Facet lists in JSON, `.json`.
    Json,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 9] =
        [Self::Obj, Self::Ply, Self::Stl, Self::Off, Self::Msh, Self::Medit, Self::Vtk, Self::Vtu, Self::Json];

    /// The extension of its files, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Msh => "msh",
            Self::Medit => "mesh",
            Self::Vtk => "vtk",
            Self::Vtu => "vtu",
            Self::Json => "json",
        }
    }

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Msh => "Gmsh MSH",
            Self::Medit => "MEDIT",
            Self::Vtk => "VTK legacy",
            Self::Vtu => "VTU",
            Self::Json => "JSON facet list",
        }
    }

    /// The format that the path's extension names, whatever its case.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.extension() == extension)
    }
}

/// The sentence for a path whose extension names no format.
pub(super) fn unknown_format(path: &Path) -> String {
    let known: Vec<String> = Format::ALL.iter().map(|format| format!(".{}", format.extension())).collect();
    let known = known.join(", ");
    match path.extension() {
        Some(extension) => {
            let extension = extension.to_string_lossy();
            format!("the extension \".{}\" names no known mesh format; known are {known}", extension.escape_debug())
        }
        None => format!("the file name has no extension; known are {known}"),
    }
}

/// Reads a mesh file in the format of the path's extension.
///
/// Memory stays within a small multiple of the file's size. Vertices and elements keep their order;
/// what the file says and [`MeshFile`] cannot hold is listed in [`MeshFile::losses`].
///
/// # Errors
/// The code of the error is `unknown-format` (extension), `cannot-open` (operating system) or what
/// [`read_mesh_bytes`] gives.
///
/// # Example
/// ```
/// let error = homeo_core::io::read_mesh("part.docx".as_ref()).unwrap_err();
/// assert_eq!(error.code, "unknown-format");
/// ```
pub fn read_mesh(path: &Path) -> Result<MeshFile, ReadError> {
    let Some(format) = Format::of_path(path) else {
        return Err(Fault::of_file("unknown-format", unknown_format(path)).in_file(path));
    };
    match std::fs::read(path) {
        Ok(bytes) => read_mesh_bytes(format, path, &bytes),
        Err(source) => Err(ReadError {
            path: path.to_path_buf(),
            place: Place::File,
            code: "cannot-open",
            message: format!("the file cannot be read: {source}"),
            source: Some(source),
        }),
    }
}

/// Reads the bytes of a mesh file; `path` is for messages only.
///
/// # Errors
/// | code | what |
/// |---|---|
/// | `empty-file` | no bytes, or separators only |
/// | `unexpected-end` | the file ends too early, or announces more than it can hold |
/// | `bad-header` | the file is not of this format |
/// | `bad-number` | a number is expected and something else found |
/// | `bad-syntax` | a section or statement is not as the format wants it |
/// | `non-finite-coordinate` | NaN, infinity, or beyond double precision |
/// | `index-out-of-range` | an element names a vertex that does not exist |
/// | `index-zero` | index 0 in a format that counts from 1 |
/// | `too-few-corners` | a polygon with fewer than three corners |
/// | `too-large` | more than 32 bits can number |
/// | `unsupported-element` | a hexahedron or a 10-node tetrahedron, say; the message names it |
/// | `unsupported-variant` | a variant of the format that is not read; the message names it |
/// | `no-elements` | neither polygons nor tetrahedra |
///
/// # Example
/// ```
/// use homeo_core::io::{Format, Place, read_mesh_bytes};
/// let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n";
/// let error = read_mesh_bytes(Format::Off, "part.off".as_ref(), text).unwrap_err();
/// assert_eq!((error.code, error.place), ("non-finite-coordinate", Place::Line(5)));
/// ```
pub fn read_mesh_bytes(format: Format, path: &Path, bytes: &[u8]) -> Result<MeshFile, ReadError> {
    read_format(format, bytes).map_err(|fault| fault.in_file(path))
}

fn read_format(format: Format, bytes: &[u8]) -> Outcome<MeshFile> {
    if bytes.iter().all(|&byte| super::scan::is_blank(byte)) {
        return Err(Fault::of_file("empty-file", "the file is empty"));
    }
    let mut mesh = match format {
        Format::Obj => super::obj::read(bytes),
        Format::Off => super::off::read(bytes),
        Format::Stl => super::stl::read(bytes),
        Format::Medit => super::medit::read(bytes),
        Format::Msh => super::msh::read(bytes),
        Format::Vtk => super::vtk::read(bytes),
        Format::Vtu => super::vtu::read(bytes),
        Format::Ply => super::ply::read(bytes),
        Format::Json => super::facets::read(bytes),
    }?;
    if mesh.polygons.is_empty() && mesh.tetrahedra.is_empty() {
        let message = "the file holds neither polygons nor tetrahedra";
        return Err(Fault::of_file("no-elements", message));
    }
    if mesh.space != 0 {
        mesh.vertex_count = mesh.positions.len();
    }
    debug_assert_eq!(mesh.check(), Ok(()));
    Ok(mesh)
}
