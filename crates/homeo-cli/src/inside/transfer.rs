//! `homeo transfer`: what a mesh file says, moved along the pillars of a shell.

use std::path::Path;

use homeo::certificate::{Provenance, StoredMap};
use homeo::input::SourceMesh;
use homeo::map::Shell;
use homeo::progress::Progress;
use homeo_verify::{Claim, Verdict, Witness, verify_bytes};
use serde_json::json;

use super::{Targets, attributes, mesh_file, stage_mesh};
use crate::answer::Answer;
use crate::args::TransferArgs;
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Cells, MeshInput, Requested, source_mesh};
use crate::outputs::Outputs;
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, stages};

/// Moves attributes from one section of a shell to another.
pub fn run(session: &Session, options: &TransferArgs, outputs: &mut Outputs) -> Result<Answer> {
    let targets = Targets { mesh: &options.output, map: None };
    let inputs: Vec<&Path> =
        [&options.map, &options.from].into_iter().chain(&options.onto).map(|p| p.as_path()).collect();
    let format = targets.check(&inputs)?;
    let (map, claim) = proof::open_certified(session, &options.map)?;
    let StoredMap::Shell(shell) = map else {
        let message = "the map is no shell: transfer needs one, as made by `homeo shell`, `simplify` or `remesh`";
        return Err(Failure::input("wrong-kind", message));
    };
    if shell.parts().pairs.is_some() {
        let message =
            "this shell is one of a surface that may cross itself (--immersed), which transfer does not support";
        return Err(Failure::input("wrong-kind", message));
    }
    let (shell, claim) = joined(session, options, shell, claim)?;
    let from = read(session, requested(options), &options.from)?;
    require_same(&options.from, &source_of(&from)?, shell.source())?;
    let moved = attributes::moved(session, &shell, &from.file.attributes, &options.density)?;
    if moved.is_empty() {
        session.display().note(&format!("{} has no attributes to transfer", options.from.display()));
    }
    let described = attributes::described(&moved);
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(&claim));
    attributes::tell(&moved, &mut lines);
    let Some(section) = shell.section() else { return Err(Failure::bug("the section is gone")) };
    let file = mesh_file(section, attributes::for_file(moved, options.status), &from.file);
    stage_mesh(session, targets.mesh, format, &file, outputs)?;
    session.end_stage();
    lines.add("time", stages(&session.seconds()));
    targets.written().iter().for_each(|path| lines.add("written", path.display()));
    let fields = json!({
        "certificate": proof::claim_json(&claim),
        "transfer": described,
        "output": targets.mesh.display().to_string(),
    });
    let heading = format!("{} moved through {}", options.from.display(), options.map.display());
    Ok(Answer::new(fields, lines.below(&heading)))
}

/// The shell with the section to transfer to, certified.
fn joined(session: &Session, options: &TransferArgs, shell: Shell, claim: Claim) -> Result<(Shell, Claim)> {
    let stored = shell.section().cloned();
    let parts = shell.parts().clone();
    let onto = match &options.onto {
        Some(path) => Some(source_of(&read(session, requested(options), path)?)?),
        None if options.inverse => Some(shell.source().clone()),
        None => None,
    };
    let from = match (options.inverse, stored) {
        (false, _) => None,
        (true, Some(section)) => Some(section),
        (true, None) => return Err(no_section(&options.map)),
    };
    if onto.is_none() && shell.section().is_none() {
        return Err(no_section(&options.map));
    }
    let Some(onto) = onto else { return Ok((shell, claim)) };
    let source = from.unwrap_or_else(|| shell.source().clone());
    let shell = Shell::from_parts(source, parts).with_section(onto);
    let claim = certified(session, options, &shell)?;
    Ok((shell, claim))
}

fn no_section(map: &Path) -> Failure {
    let message = format!(
        "{} is a shell with one surface: give the surface to transfer to with --onto, or a map made by `homeo simplify` or `homeo remesh`",
        map.display()
    );
    Failure::input("no-section", message)
}

/// The proof for a surface that was not in the file.
fn certified(session: &Session, options: &TransferArgs, shell: &Shell) -> Result<Claim> {
    session.stage("certificate");
    let mut bytes = std::io::Cursor::new(Vec::new());
    homeo::certificate::write_shell(shell, &Provenance::default(), &mut bytes)
        .map_err(|e| Failure::bug(e.to_string()))?;
    let what = options.onto.as_ref().unwrap_or(&options.map).display();
    let claim = match verify_bytes(bytes.get_ref()) {
        Ok(Verdict::Certified(claim)) => claim,
        Ok(Verdict::Refuted(witness)) => {
            return Err(no_section_because(shell, &what.to_string(), &witness));
        }
        Ok(Verdict::Undecided(obstacle)) => return Err(proof::undecided(&obstacle)),
        Err(error) => return Err(Failure::bug(error.to_string())),
    };
    session.check()?;
    Ok(claim)
}

/// Says which elements of the surface's own file are concerned; a witness counts them after those of source and shell.
fn no_section_because(shell: &Shell, what: &str, witness: &Witness) -> Failure {
    let own = |numbers: &[u32], first: usize| -> Vec<u32> {
        numbers.iter().filter_map(|&number| number.checked_sub(first as u32)).collect()
    };
    let (source, parts) = (shell.source(), shell.parts());
    let triangles = own(&witness.cells, source.complex().cell_count() + parts.prisms.len());
    let vertices = own(&witness.vertices, source.positions().len() + parts.middle.len());
    let message = format!(
        "{what} is no section of the shell, at its triangles {triangles:?} with the vertices {vertices:?}: {}",
        proof::witness_text(witness)
    );
    let elements = json!({"triangles": triangles, "vertices": vertices});
    Failure::input("no-section", message).with("witness", proof::witness_json(witness)).with("elements", elements)
}

fn requested(options: &TransferArgs) -> Requested {
    Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient }
}

/// Reads a mesh whose attributes are moved, or to which they are.
pub fn read(session: &Session, requested: Requested, path: &Path) -> Result<MeshInput> {
    let mesh = mesh_input::read(session, path, requested)?;
    mesh.changes.iter().chain(&mesh.file.losses).for_each(|note| session.display().note(note));
    crate::refuse::unless_simplices(&mesh, requested.triangulate)?;
    Ok(mesh)
}

/// The surface of a file.
pub fn source_of(mesh: &MeshInput) -> Result<SourceMesh<3>> {
    match &mesh.cells {
        Cells::Triangles(complex) => Ok(source_mesh(&mesh.file, complex)),
        Cells::Tetrahedra(_) => Err(Failure::input("wrong-dimension", "surfaces of triangles are needed, not volumes")),
    }
}

/// Attributes belong to numbered vertices and triangles: the mesh has to be the very one of the map.
pub fn require_same(path: &Path, mesh: &SourceMesh<3>, wanted: &SourceMesh<3>) -> Result<()> {
    let (p, q) = (mesh.positions(), wanted.positions());
    let (s, t) = (mesh.complex().cells(), wanted.complex().cells());
    let difference = if (p.len(), s.len()) != (q.len(), t.len()) {
        Some(format!("{} vertices and {} triangles instead of {} and {}", p.len(), s.len(), q.len(), t.len()))
    } else if let Some(v) = (0..p.len()).find(|&v| p[v].map(f64::to_bits) != q[v].map(f64::to_bits)) {
        Some(format!("vertex {v} at {:?} instead of {:?}", p[v], q[v]))
    } else {
        (0..s.len()).find(|&c| s[c] != t[c]).map(|c| format!("another triangle {c}"))
    };
    match difference {
        None => Ok(()),
        Some(what) => {
            let message = format!(
                "{} is not the mesh of the map: it has {what}; give the mesh that the map was made of, with the same --weld, --triangulate and --orient",
                path.display()
            );
            Err(Failure::input("other-mesh", message))
        }
    }
}
