//! `homeo compose --from --onto`: what a mesh file says, moved to another mesh with a map onto the same shape.

use std::path::Path;

use homeo::certificate::{FoliationMap, StoredMap};
use homeo::map::Foliation;
use homeo::progress::Progress;
use homeo::transfer::{Transferred, transfer_across};
use homeo_core::io::{Attribute, Element, MeshFile};
use serde_json::{Value, json};

use super::transfer::{read, require_same, source_of};
use super::{Targets, attributes, stage_mesh};
use crate::answer::Answer;
use crate::args::{AcrossArgs, ComposeArgs};
use crate::failure::{Failure, Result};
use crate::mesh_input::{MeshInput, Requested};
use crate::outputs::Outputs;
use crate::session::Session;
use crate::text::{Lines, stages};

/// Before the name of what is moved where the mesh has something of that name.
const PREFIX: &str = "from_";

/// Moves attributes from the source of one map to that of another.
pub fn run(
    session: &Session,
    options: &ComposeArgs,
    maps: [&StoredMap; 2],
    certificates: Value,
    outputs: &mut Outputs,
) -> Result<Answer> {
    let AcrossArgs { from: Some(from), onto: Some(onto), .. } = &options.across else {
        return Err(Failure::usage("--from and --onto go together"));
    };
    let Some(output) = &options.output else { return Err(Failure::usage("give -o OUT for the mesh")) };
    let targets = Targets { mesh: output, map: None };
    let format = targets.check(&[&options.first, &options.second, from, onto])?;
    let [there, here] = [surface(maps[0], &options.first)?, surface(maps[1], &options.second)?];
    let source = of_map(session, &options.across, from, there)?;
    let mesh = of_map(session, &options.across, onto, here)?;
    session.stage("transfer");
    let moved = transfer_across(there, here, &source.file.attributes, session)
        .map_err(|error| attributes::explain(session, &error))?;
    session.check()?;
    if moved.is_empty() {
        session.display().note(&format!("{} has no attributes to transfer", from.display()));
    }
    let (moved, renamed) = named(moved, &mesh.file);
    renamed.iter().for_each(|name| {
        session
            .display()
            .note(&format!("{} has its own {name}: the other one is called {PREFIX}{name}", onto.display()));
    });
    let described = attributes::described(&moved);
    let mut lines = Lines::default();
    attributes::tell(&moved, &mut lines);
    let file = joined(&mesh.file, &source.file, attributes::for_file(moved, options.across.status));
    stage_mesh(session, output, format, &file, outputs)?;
    session.end_stage();
    lines.add("time", stages(&session.seconds()));
    lines.add("written", output.display());
    let fields = json!({
        "certificates": certificates,
        "transfer": described,
        "renamed": renamed,
        "output": output.display().to_string(),
    });
    Ok(Answer::new(fields, lines.below(&format!("{} moved to {}", from.display(), onto.display()))))
}

fn surface<'m>(map: &'m StoredMap, path: &Path) -> Result<&'m Foliation<3>> {
    match map {
        StoredMap::Foliation(FoliationMap::Surface(map)) => Ok(map),
        _ => {
            let message = format!(
                "{} is no map of a surface: fields are moved between disks, by maps onto square or disk; --points takes \
                 maps of balls too",
                path.display()
            );
            Err(Failure::input("wrong-kind", message))
        }
    }
}

/// The file of a mesh, which must be the very one of the map.
fn of_map(session: &Session, options: &AcrossArgs, path: &Path, map: &Foliation<3>) -> Result<MeshInput> {
    let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
    let mesh = read(session, requested, path)?;
    require_same(path, &source_of(&mesh)?, map.source())?;
    Ok(mesh)
}

/// With another name what has the name of something that the mesh has already; and which these are.
fn named(mut moved: Vec<Transferred>, mesh: &MeshFile) -> (Vec<Transferred>, Vec<String>) {
    let mut renamed = Vec::new();
    let mut taken: Vec<(String, Element)> = mesh.attributes.iter().map(|a| (a.name.clone(), a.element)).collect();
    for Transferred { attribute, .. } in &mut moved {
        let original = attribute.name.clone();
        while taken.contains(&(attribute.name.clone(), attribute.element)) {
            attribute.name.insert_str(0, PREFIX);
        }
        if attribute.name != original {
            renamed.push(original);
        }
        taken.push((attribute.name.clone(), attribute.element));
    }
    (moved, renamed)
}

/// A mesh with all it has, and more; names of tags and files of materials come along.
fn joined(mesh: &MeshFile, source: &MeshFile, attributes: Vec<Attribute>) -> MeshFile {
    let mut joined = mesh.clone();
    joined.losses.clear();
    joined.attributes.extend(attributes);
    for name in &source.names {
        if !joined.names.iter().any(|other| (other.dimension, other.tag) == (name.dimension, name.tag)) {
            joined.names.push(name.clone());
        }
    }
    for library in &source.material_libraries {
        if !joined.material_libraries.contains(library) {
            joined.material_libraries.push(library.clone());
        }
    }
    joined
}
