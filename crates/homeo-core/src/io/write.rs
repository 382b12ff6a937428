//! What all writers share: options, the report of losses, and the atomic write to a file.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::WriteError;
use super::mesh_file::{Attribute, Element, MeshFile};
use super::{Format, read::unknown_format};

/// How numbers are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// What loses nothing and most programs read: binary for PLY, VTK and VTU, binary for STL where
    /// all coordinates are single-precision numbers, text for the others.
    #[default]
    Auto,
    /// Text, the shortest decimals that read back bit for bit.
    Text,
    /// Binary; formats without a binary variant refuse it.
    Binary,
}

/// How to write a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// How numbers are stored.
    pub encoding: Encoding,
}

/// What became of a mesh that was written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriteReport {
    /// What the format could not hold, one sentence each (for the user's eyes).
    pub losses: Vec<String>,
}

/// Writes a mesh in the format of the path's extension.
///
/// The file appears whole or not at all: it is written under a temporary name in the same folder
/// and renamed.
///
/// # Errors
/// An unknown extension, a mesh that breaks the invariant of [`MeshFile`], a mesh of which the
/// format can hold nothing (tetrahedra in OBJ, say), an error of the operating system.
///
/// # Example
/// ```
/// use homeo_core::io::{MeshFile, WriteOptions, read_mesh, write_mesh};
/// let triangle = MeshFile::from_triangles(vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
/// let path = std::env::temp_dir().join(format!("homeo-doc-{}.off", std::process::id()));
/// let report = write_mesh(&path, &triangle, &WriteOptions::default())?;
/// assert!(report.losses.is_empty());
/// assert_eq!(read_mesh(&path)?, triangle);
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_mesh(path: &Path, mesh: &MeshFile, options: &WriteOptions) -> Result<WriteReport, WriteError> {
    let Some(format) = Format::of_path(path) else {
        return Err(WriteError { path: path.to_path_buf(), message: unknown_format(path), source: None });
    };
    let partial = partial_path(path);
    let result = write_partial(&partial, format, mesh, options).and_then(|report| {
        std::fs::rename(&partial, path).map_err(|e| WriteError::of_file(path, "the file cannot be put in place", e))?;
        Ok(report)
    });
    result.map_err(|mut error| {
        // Best effort: the error that matters is the first one.
        let _ = std::fs::remove_file(&partial);
        error.path = path.to_path_buf();
        error
    })
}

fn write_partial(
    partial: &Path,
    format: Format,
    mesh: &MeshFile,
    options: &WriteOptions,
) -> Result<WriteReport, WriteError> {
    let file = std::fs::File::create(partial).map_err(|e| WriteError::of_file(partial, "cannot create the file", e))?;
    let mut out = BufWriter::with_capacity(1 << 16, file);
    let report = write_mesh_to(&mut out, format, mesh, options)?;
    out.flush()?;
    Ok(report)
}

fn partial_path(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".partial-{}", std::process::id()));
    path.with_file_name(name)
}

/// Writes a mesh to any stream; see [`write_mesh`]. The stream is best buffered.
///
/// # Errors
/// As [`write_mesh`], with an empty path.
///
/// # Example
/// ```
/// use homeo_core::io::{Format, MeshFile, WriteOptions, write_mesh_to};
/// let triangle = MeshFile::from_triangles(vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
/// let mut text = Vec::new();
/// write_mesh_to(&mut text, Format::Obj, &triangle, &WriteOptions::default())?;
/// assert!(text.starts_with(b"v 0.1 0.0 0.0\n"));
/// # Ok::<(), homeo_core::io::WriteError>(())
/// ```
pub fn write_mesh_to(
    out: &mut dyn Write,
    format: Format,
    mesh: &MeshFile,
    options: &WriteOptions,
) -> Result<WriteReport, WriteError> {
    mesh.check().map_err(|message| WriteError::of_mesh(format!("the mesh cannot be written: {message}")))?;
    let mut parcel = Parcel::new(mesh, format);
    if mesh.space == 0 && format != Format::Json {
        return Err(WriteError::of_mesh(format!("{} needs coordinates, and this mesh has none", format.name())));
    }
    match format {
        Format::Off => super::off::write(out, &mut parcel, options)?,
        Format::Obj => super::obj_write::write(out, &mut parcel, options)?,
        Format::Stl => super::stl::write(out, &mut parcel, options)?,
        Format::Medit => super::medit_write::write(out, &mut parcel, options)?,
        Format::Msh => super::msh_write::write(out, &mut parcel, options)?,
        Format::Vtk => super::vtk_write::write(out, &mut parcel, options)?,
        Format::Vtu => super::vtu_write::write(out, &mut parcel, options)?,
        Format::Ply => super::ply_write::write(out, &mut parcel, options)?,
        Format::Json => super::facets::write(out, &mut parcel, options)?,
    }
    Ok(WriteReport { losses: parcel.finish() })
}

/// A mesh on its way into a file: keeps account of what the writer has taken.
pub(super) struct Parcel<'a> {
    pub mesh: &'a MeshFile,
    format: Format,
    taken: Vec<bool>,
    names_taken: bool,
    libraries_taken: bool,
    losses: Vec<String>,
}

impl<'a> Parcel<'a> {
    fn new(mesh: &'a MeshFile, format: Format) -> Self {
        let taken = vec![false; mesh.attributes.len()];
        Self { mesh, format, taken, names_taken: false, libraries_taken: false, losses: Vec::new() }
    }

    /// Takes the first attribute left that fits, for a writer that holds it without loss.
    pub fn take_where(&mut self, fits: impl Fn(&Attribute) -> bool) -> Option<&'a Attribute> {
        let attributes = &self.mesh.attributes;
        let index = (0..attributes.len()).find(|&index| !self.taken[index] && fits(&attributes[index]))?;
        self.taken[index] = true;
        Some(&attributes[index])
    }

    /// Takes the attribute of that name and kind, if it fits.
    pub fn take(&mut self, name: &str, element: Element, fits: impl Fn(&Attribute) -> bool) -> Option<&'a Attribute> {
        self.take_where(|attribute| attribute.name == name && attribute.element == element && fits(attribute))
    }

    /// Takes the names of tags.
    pub fn take_names(&mut self) {
        self.names_taken = true;
    }

    /// Takes the names of material libraries.
    pub fn take_libraries(&mut self) {
        self.libraries_taken = true;
    }

    /// Records a loss.
    pub fn lose(&mut self, sentence: impl Into<String>) {
        self.losses.push(sentence.into());
    }

    /// For formats of surfaces: tetrahedra are lost where there are polygons, an error where not.
    pub fn surface_only(&mut self) -> Result<(), WriteError> {
        let count = self.mesh.tetrahedra.len();
        if count > 0 && self.mesh.polygons.is_empty() {
            let name = self.format.name();
            return Err(WriteError::of_mesh(format!(
                "{name} holds surfaces only; write the {count} tetrahedra as VTU, VTK, MSH or MEDIT"
            )));
        }
        if count > 0 {
            self.lose(format!(
                "{} cannot hold the {count} tetrahedra; only the polygons were written",
                self.format.name()
            ));
        }
        Ok(())
    }

    /// For formats that always have three coordinates.
    pub fn three_coordinates(&mut self) {
        if self.mesh.space == 2 {
            self.lose(format!("{} has three coordinates; the third was written as 0", self.format.name()));
        }
    }

    /// For formats without a binary variant.
    pub fn text_only(&self, options: &WriteOptions) -> Result<(), WriteError> {
        match options.encoding {
            Encoding::Binary => Err(WriteError::of_mesh(format!("homeo writes {} as text only", self.format.name()))),
            Encoding::Auto | Encoding::Text => Ok(()),
        }
    }

    fn finish(mut self) -> Vec<String> {
        let name = self.format.name();
        for (attribute, _) in self.mesh.attributes.iter().zip(&self.taken).filter(|(_, taken)| !**taken) {
            let on = attribute.element.plural();
            self.losses
                .push(format!("{name} cannot hold the attribute \"{}\" on {on}; it was left out", attribute.name));
        }
        if !self.names_taken && !self.mesh.names.is_empty() {
            let count = self.mesh.names.len();
            self.losses.push(format!("{name} cannot hold the {count} names of tags; they were left out"));
        }
        if !self.libraries_taken && !self.mesh.material_libraries.is_empty() {
            self.losses.push(format!("{name} cannot name material libraries; they were left out"));
        }
        self.losses
    }
}
