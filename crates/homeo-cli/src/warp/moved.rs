//! What moves with a cage: a mesh with all its data, or points; and how it is refused or written.

use std::path::Path;

use homeo::cage::{Moved, Verdict, judge};
use homeo::certificate::MovedMap;
use homeo::input::SourceMesh;
use homeo::map::MovedMesh;
use homeo::progress::Progress;
use homeo_core::io::{Format, WriteOptions, read_mesh_bytes, write_mesh_to};
use serde_json::json;

use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Cells, MeshInput, Requested};
use crate::outputs::Outputs;
use crate::points::{self, PointFormat, Table, csv, npy};
use crate::refuse;
use crate::session::Session;

/// How many elements are listed.
const SHOWN: usize = 10;

/// What moves.
pub enum Input {
    Mesh(Box<MeshInput>),
    Points(Table<f64>),
}

impl Input {
    /// From a file of points or a mesh file.
    pub fn read(session: &Session, path: &Path) -> Result<Self> {
        if PointFormat::of_path(path).is_ok() {
            let table = points::read(path)?;
            if table.columns != 3 {
                let message = format!("{}: points in space have three coordinates", path.display());
                return Err(Failure::input("points", message));
            }
            session.fact("input", json!({"path": path.display().to_string(), "vertices": table.rows.len()}));
            return Ok(Self::Points(table));
        }
        let mesh = mesh_input::read(session, path, Requested::default())?;
        refuse::unless_simplices(&mesh, false)?;
        Ok(Self::Mesh(Box::new(mesh)))
    }

    /// The vertices or points.
    pub fn positions(&self) -> &[[f64; 3]] {
        match self {
            Self::Mesh(mesh) => &mesh.file.positions,
            Self::Points(table) => &table.rows,
        }
    }

    /// For the library.
    pub fn moved(&self) -> Moved<'_> {
        match self {
            Self::Points(_) => Moved::Points,
            Self::Mesh(mesh) => match &mesh.cells {
                Cells::Triangles(complex) => Moved::Surface(complex),
                Cells::Tetrahedra(complex) => Moved::Volume(complex),
            },
        }
    }

    /// The map onto the mesh with its vertices at these places.
    pub fn map(&self, after: &[[f64; 3]]) -> Result<MovedMap> {
        let (before, after) = (self.positions().to_vec(), after.to_vec());
        let map = match self.moved() {
            Moved::Points => return Err(Failure::usage("points make no mesh")),
            Moved::Surface(complex) => {
                MovedMesh::new(SourceMesh::new(before, complex.clone()), after).map(MovedMap::from)
            }
            Moved::Volume(complex) => {
                MovedMesh::new(SourceMesh::new(before, complex.clone()), after).map(MovedMap::from)
            }
        };
        map.map_err(|error| Failure::limits("no-map", format!("{error}; nothing was written")))
    }

    /// In words.
    pub fn described(&self) -> String {
        match self.moved() {
            Moved::Points => format!("{} points", self.positions().len()),
            Moved::Surface(complex) => format!("{} triangles", complex.cell_count()),
            Moved::Volume(complex) => format!("{} tetrahedra", complex.cell_count()),
        }
    }

    /// What is shown of a mesh that is sound.
    pub fn checked(&self) -> &'static str {
        match self.moved() {
            Moved::Volume(_) => {
                "all tetrahedra keep their sign and the boundary does not meet itself: the piecewise linear map is one-to-one"
            }
            _ => "the surface does not meet itself: the piecewise linear map is one-to-one",
        }
    }

    /// Refuses a mesh that is folded or meets itself before it moves.
    pub fn refuse_unless_sound(&self) -> Result<()> {
        let (code, what) = match judge(self.moved(), self.positions(), self.positions()) {
            Verdict::Embedded | Verdict::NothingToJudge => return Ok(()),
            Verdict::Folded { cells } => (
                "degenerate-cell",
                format!("{} cells have no area or volume, the first is {}", cells.len(), cells[0].index()),
            ),
            Verdict::Meets { pairs, count } => {
                let [a, b] = pairs.first().copied().unwrap_or_default();
                ("self-intersection", format!("{count} pairs of triangles meet, the first are {a:?} and {b:?}"))
            }
            Verdict::Merged { vertices } => ("coincident-vertices", format!("vertices {vertices:?} lie on one point")),
            Verdict::Undecided { reason } => ("not-embedded", reason),
        };
        let message = format!(
            "the mesh is not sound before it moves: {what}. Nothing could be said of it after; repair it (`homeo info` lists all), or move its vertices as points (.csv)"
        );
        Err(Failure::input(code, message))
    }
}

/// The failure for a mesh that is not sound after it has moved.
pub fn refused(verdict: &Verdict, steps: Option<usize>, input: &Input) -> Option<Failure> {
    let after = steps.map_or(String::new(), |n| format!(" after {n} {}", if n == 1 { "step" } else { "steps" }));
    let remedy = match steps {
        Some(_) => "give a larger --most-steps, --path angles, or a cage that fits less closely",
        None => "give --from and --to cages, with steps in between, or move the boundary less",
    };
    let failure = |what: String| Failure::limits("folded", format!("{what}{after}; {remedy}. Nothing was written"));
    let failure = match verdict {
        Verdict::Embedded | Verdict::NothingToJudge => return None,
        Verdict::Folded { cells } => {
            let shown: Vec<usize> = cells.iter().take(SHOWN).map(|cell| cell.index()).collect();
            let names: Vec<String> = shown.iter().take(3).map(usize::to_string).collect();
            let more = if cells.len() > names.len() { ", ..." } else { "" };
            let what = format!("{} cells ({}{more}) are turned over or flat", cells.len(), names.join(", "));
            failure(what).with("folded", json!(shown)).with("folded_count", cells.len())
        }
        Verdict::Meets { pairs, count } => {
            let [a, b] = pairs.first().copied().unwrap_or_default();
            let shown: Vec<_> = pairs.iter().take(SHOWN).collect();
            failure(format!("{count} pairs of triangles meet, the first are {a:?} and {b:?}, by their vertices"))
                .with("meeting", json!(shown))
                .with("meeting_count", *count)
        }
        Verdict::Merged { vertices } => {
            failure(format!("vertices {vertices:?} fall together")).with("merged", json!(vertices))
        }
        Verdict::Undecided { reason } => {
            failure(format!("it cannot be decided whether the moved mesh is sound: {reason}"))
        }
    };
    let failure = failure.with("moved", input.described());
    Some(match steps {
        Some(n) => failure.with("steps", n),
        None => failure,
    })
}

/// Writes what has moved, all else as it was.
pub fn write(
    session: &Session,
    input: Input,
    positions: Vec<[f64; 3]>,
    output: &Path,
    outputs: &mut Outputs,
) -> Result<()> {
    session.stage("write");
    match input {
        Input::Points(table) => {
            let table = Table { rows: positions, ..table };
            let bytes = match PointFormat::of_path(output)? {
                PointFormat::Npy => npy::encode(&table),
                PointFormat::Csv => csv::write_doubles(&table),
            };
            outputs.stage(session, output, |out| std::io::Write::write_all(out, &bytes).map_err(|e| e.to_string()))?;
            Ok(())
        }
        Input::Mesh(mesh) => write_mesh(session, *mesh, positions, output, outputs),
    }
}

fn write_mesh(
    session: &Session,
    mesh: MeshInput,
    positions: Vec<[f64; 3]>,
    output: &Path,
    outputs: &mut Outputs,
) -> Result<()> {
    let mut file = mesh.file;
    (file.positions, file.space) = (positions, 3);
    if file.attributes.iter().any(|attribute| attribute.name == "normal") {
        session.display().note("normals are kept as they were: compute them again for the moved mesh");
    }
    let format = Format::of_path(output).ok_or_else(|| Failure::usage("the output is no mesh format"))?;
    let mut losses = Vec::new();
    let partial = outputs.stage(session, output, |out| {
        let report = write_mesh_to(out, format, &file, &WriteOptions::default()).map_err(|e| e.to_string())?;
        losses = report.losses;
        Ok(())
    })?;
    let unreadable = |what: String| Failure::bug(format!("{} cannot be read back: {what}", output.display()));
    let bytes = std::fs::read(&partial).map_err(|e| unreadable(e.to_string()))?;
    let back = read_mesh_bytes(format, output, &bytes).map_err(|e| unreadable(e.to_string()))?;
    // What was checked are these numbers, and no others.
    if back.positions != file.positions || back.tetrahedra != file.tetrahedra {
        let message =
            format!("{} does not hold the mesh bit for bit; give a name with .ply, .vtu or .mesh", format.name());
        return Err(Failure::usage(message));
    }
    losses.iter().for_each(|loss| session.display().note(loss));
    session.fact("losses", losses);
    Ok(())
}
