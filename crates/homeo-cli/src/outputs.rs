//! Output files: written under a temporary name beside the target, renamed when everything is well.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result};
use crate::session::Session;

/// Files that wait for their names.
#[derive(Default)]
pub struct Outputs {
    staged: Vec<(PathBuf, PathBuf)>,
}

/// Refuses a path that cannot become a file, before any work is done.
///
/// # Errors
/// When its folder is missing, or it is a folder, or the input itself.
pub fn check_target(path: &Path, inputs: &[&Path]) -> Result<()> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Failure::usage(format!(
            "cannot write {}: there is no folder {}",
            path.display(),
            folder.display()
        )));
    }
    if path.is_dir() || path.file_name().is_none() {
        return Err(Failure::usage(format!("cannot write {}: it is a folder", path.display())));
    }
    match inputs.iter().find(|input| is_same(input, path)) {
        Some(_) => Err(Failure::usage(format!("{} is an input; give another name to write to", path.display()))),
        None => Ok(()),
    }
}

/// The same for several files, which must not be one and the same: the second would take the place of the first.
///
/// # Errors
/// When one cannot become a file, or two are the same.
pub fn check_targets(paths: &[&Path], inputs: &[&Path]) -> Result<()> {
    for (number, path) in paths.iter().enumerate() {
        check_target(path, inputs)?;
        if paths[..number].iter().any(|other| is_same(other, path)) {
            return Err(Failure::usage(format!("two outputs have the name {}", path.display())));
        }
    }
    Ok(())
}

/// Whether two names are those of one file, which need not be there yet; different links to a folder count as one.
pub fn is_same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        path.canonicalize().ok().or_else(|| Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?)))
    };
    place(a).is_some_and(|a| place(b) == Some(a))
}

/// The folder that a file is in.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

impl Outputs {
    /// Writes the content of `path` under a temporary name; returns that name.
    ///
    /// # Errors
    /// When it cannot be written; then nothing is left behind.
    pub fn stage(
        &mut self,
        session: &Session,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<File>) -> std::result::Result<(), String>,
    ) -> Result<PathBuf> {
        let partial = partial_path(path);
        session.register_partial(partial.clone());
        let failed =
            |what: String| Failure::limits("cannot-write", format!("{} cannot be written: {what}", path.display()));
        let file = File::options().read(true).write(true).create(true).truncate(true).open(&partial);
        let mut out = BufWriter::with_capacity(1 << 16, file.map_err(|e| failed(e.to_string()))?);
        write(&mut out).map_err(failed)?;
        out.flush().and_then(|()| out.get_ref().sync_all()).map_err(|e| failed(e.to_string()))?;
        self.staged.push((partial.clone(), path.to_path_buf()));
        Ok(partial)
    }

    /// Gives all files their names. To be called when nothing can stop the run any more.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn commit(self, session: &Session) -> Result<()> {
        for (partial, path) in self.staged {
            std::fs::rename(&partial, &path).map_err(|e| {
                Failure::limits("cannot-write", format!("{} cannot be put in place: {e}", path.display()))
            })?;
            session.forget_partial(&partial);
        }
        Ok(())
    }
}

fn partial_path(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".partial-{}", std::process::id()));
    path.with_file_name(name)
}
