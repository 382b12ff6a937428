//! Meshes and points in space that move with a cage, and tetrahedral meshes that follow their boundary.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use homeo::cage::{
    CageError, CageMap, CagePair, DeformError, Deformed, Moved, Steps, Verdict, deform, harmonic_extension, judge,
};
use homeo::certificate::{Provenance, write_cages, write_moved};
use homeo::progress::Progress;
use homeo::shape::{PolyhedronPath, StraightPolyhedra, TurningPolyhedra};
use homeo_core::io::Format;
use homeo_core::mesh::TetrahedronComplex;
use homeo_verify::Claim;
use serde_json::json;

use super::moved::{Input, refused, write};
use crate::answer::Answer;
use crate::args::{MethodName, PathName, WarpArgs};
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Cells, MeshInput, Requested};
use crate::outputs::{Outputs, check_targets};
use crate::points::PointFormat;
use crate::proof;
use crate::refuse;
use crate::session::Session;
use crate::text::{Lines, file_name, stages};

/// Whether cages are asked for, not polygons.
pub fn is_wanted(options: &WarpArgs) -> bool {
    // Polygons are JSON, and so are some meshes without coordinates.
    let is_mesh = |path: &Path| Format::of_path(path).is_some() && path.extension().is_none_or(|e| e != "json");
    let paths = [&options.polygons.from, &options.polygons.to];
    paths.into_iter().flatten().any(|path| is_mesh(path))
}

/// Refuses options of cages where polygons are given.
pub fn refuse_options(options: &WarpArgs) -> Result<()> {
    let given = [("--steps", options.steps.is_some()), ("--most-steps", options.most_steps.is_some())];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((name, _)) => {
            Err(Failure::usage(format!("{name} is for cages: closed triangle meshes as --from and --to")))
        }
        None => Ok(()),
    }
}

/// Moves a mesh or points, and judges what comes out.
pub fn run(session: &Session, options: &WarpArgs, outputs: &mut Outputs) -> Result<Answer> {
    check_options(options)?;
    if options.method == Some(MethodName::Harmonic) {
        return run_harmonic(session, options, outputs);
    }
    let (Some(from), Some(to)) = (&options.polygons.from, &options.polygons.to) else {
        return Err(Failure::usage("give --from and --to: the cages before and after"));
    };
    let cages = read_cages(session, from, to)?;
    let input = Input::read(session, &options.input)?;
    session.stage("check");
    input.refuse_unless_sound()?;
    session.stage("warp");
    let path = path_of(options, &cages)?;
    let steps = Steps {
        first: options.steps.unwrap_or(1),
        most: options.most_steps.unwrap_or(Steps::default().most).max(options.steps.unwrap_or(1)),
    };
    if let (Some(map), Moved::Points) = (&options.map, input.moved()) {
        return run_points(session, options, (&cages, path.as_ref()), input, (steps, map), outputs);
    }
    let done = deform(&cages, path.as_ref(), input.moved(), input.positions(), steps, session)
        .map_err(|error| explain(session, &error))?;
    if let Some(failure) = refused(&done.verdict, Some(done.steps), &input) {
        return Err(failure);
    }
    let claim = certify(session, options, &input, &done, outputs)?;
    finish(session, options, input, done, claim, outputs)
}

/// The map is proved for the inside of the cage.
fn refuse_points_outside(cages: &CagePair, input: &Input, path: &Path) -> Result<()> {
    let outside: Vec<usize> =
        (0..).zip(input.positions()).filter(|(_, at)| !cages.contains(**at)).map(|(number, _)| number).collect();
    let Some(first) = outside.first() else { return Ok(()) };
    let others = if outside.len() > 1 { format!(", as are {} others", outside.len() - 1) } else { String::new() };
    let message = format!(
        "{}: row {} is outside of the cage{others}: the map that --map keeps is one of its inside",
        path.display(),
        first + 1
    );
    Err(Failure::input("outside", message).with("row", first + 1).with("rows_without_image", outside.len()))
}

/// Points move by the map between the insides of the cages, which is kept: in as many steps as its certificate takes.
fn run_points(
    session: &Session,
    options: &WarpArgs,
    (cages, path): (&CagePair, &dyn PolyhedronPath),
    input: Input,
    (steps, kept): (Steps, &Path),
    outputs: &mut Outputs,
) -> Result<Answer> {
    refuse_points_outside(cages, &input, &options.input)?;
    let mut count = steps.first;
    let (map, bytes, claim) = loop {
        let map = CageMap::along(cages, path, count).map_err(|error| explain(session, &error))?;
        let mut file = Cursor::new(Vec::new());
        write_cages(&map, &provenance(options, count), &mut file).map_err(|e| Failure::bug(e.to_string()))?;
        session.stage("certificate");
        let decided = proof::decide(file.get_ref());
        session.check()?;
        match decided {
            Ok(claim) => break (map, file.into_inner(), claim),
            Err(_) if 2 * count <= steps.most => count *= 2,
            Err(failure) => return Err(failure.with("steps", count)),
        }
    };
    session.stage("warp");
    let positions = map.forward(input.positions(), session).map_err(|error| explain(session, &error))?;
    proof::keep(session, kept, outputs, &bytes)?;
    let done = Deformed { positions, steps: count, verdict: Verdict::NothingToJudge, crossing_cage: None };
    finish(session, options, input, done, Some(claim), outputs)
}

/// A tetrahedral mesh follows its boundary.
fn run_harmonic(session: &Session, options: &WarpArgs, outputs: &mut Outputs) -> Result<Answer> {
    let Some(to) = &options.polygons.to else {
        return Err(Failure::usage("give --to: the boundary of the mesh after it has moved"));
    };
    if options.polygons.from.is_some() || options.steps.is_some() || options.polygons.path != PathName::Auto {
        return Err(Failure::usage("--method harmonic takes --to alone: it makes one step from the mesh itself"));
    }
    let surface = mesh_input::read(session, to, Requested::default())?;
    let input = Input::read(session, &options.input)?;
    session.stage("check");
    input.refuse_unless_sound()?;
    let Moved::Volume(complex) = input.moved() else {
        return Err(Failure::input("no-volume", "--method harmonic moves tetrahedral meshes; give cages for others"));
    };
    session.stage("warp");
    let after = boundary_places(complex, &input, &surface)?;
    let positions = harmonic_extension(complex, input.positions(), &after)
        .map_err(|error| Failure::limits("no-map", format!("{error}; nothing was written")))?;
    let verdict = judge(input.moved(), input.positions(), &positions);
    if let Some(failure) = refused(&verdict, None, &input) {
        return Err(failure);
    }
    let done = Deformed { positions, steps: 1, verdict, crossing_cage: None };
    let claim = certify(session, options, &input, &done, outputs)?;
    finish(session, options, input, done, claim, outputs)
}

/// Where the boundary goes: the surface has the vertices of the mesh, or those on its boundary, in the same order.
fn boundary_places(complex: &TetrahedronComplex, input: &Input, surface: &MeshInput) -> Result<Vec<[f64; 3]>> {
    let places = &surface.file.positions;
    if places.len() == complex.vertex_count() {
        return Ok(places.clone());
    }
    let adjacency = complex.adjacency().map_err(|e| Failure::input("non-manifold-facet", e.to_string()))?;
    let is_boundary = adjacency.boundary_vertices(complex);
    let count = is_boundary.iter().filter(|&&b| b).count();
    if places.len() != count {
        let message = format!(
            "the surface has {} vertices; it must have those of the mesh ({}), or those on its boundary ({count}), in \
             the same order",
            places.len(),
            complex.vertex_count()
        );
        return Err(Failure::input("counts-differ", message));
    }
    let mut after = input.positions().to_vec();
    let boundary = (0..after.len()).filter(|&v| is_boundary[v]);
    boundary.zip(places).for_each(|(v, place)| after[v] = *place);
    Ok(after)
}

fn check_options(options: &WarpArgs) -> Result<()> {
    let refused = [
        ("--method complex", options.method == Some(MethodName::Complex)),
        ("--degree", options.degree.is_some()),
        ("--landmarks", options.landmarks.is_some()),
        ("--pair", options.polygons.pair.is_some()),
        ("--field", options.field.is_some()),
        ("--triangles", options.polygons.triangles.is_some()),
        ("--middle", options.polygons.middle.is_some()),
    ];
    if let Some((name, _)) = refused.iter().find(|(_, is_given)| *is_given) {
        return Err(Failure::usage(format!("{name} is for polygons, not for cages")));
    }
    #[cfg(feature = "gpu")]
    if options.device == crate::args::DeviceName::Gpu {
        return Err(Failure::usage(super::device::ONLY_PICTURES));
    }
    let outputs: Vec<&Path> = [&options.output, &options.map].into_iter().filter_map(|path| path.as_deref()).collect();
    if outputs.is_empty() {
        return Err(Failure::usage("give -o OUT for what has moved, or --map for the map"));
    }
    let mut inputs = vec![options.input.as_path()];
    inputs.extend([&options.polygons.from, &options.polygons.to].into_iter().flatten().map(|path| path.as_path()));
    check_targets(&outputs, &inputs)?;
    if super::picture::is_picture(&options.input) {
        return Err(Failure::usage("pictures move with polygons; cages move meshes and points in space"));
    }
    let are_points = PointFormat::of_path(&options.input).is_ok();
    match &options.output {
        Some(output) if are_points => PointFormat::of_path(output).map(|_| ()),
        Some(output) if Format::of_path(output).is_none() => {
            Err(Failure::usage(format!("{}: the extension names no mesh format", output.display())))
        }
        _ => Ok(()),
    }
}

fn read_cages(session: &Session, from: &Path, to: &Path) -> Result<CagePair> {
    let [before, after] = [read_cage(session, from)?, read_cage(session, to)?];
    session.check()?;
    CagePair::of_meshes([before.0, after.0], [before.1, after.1]).map_err(|error| {
        let code = match &error {
            CageError::VertexCounts { .. } => "counts-differ",
            CageError::OtherTriangles { .. } => "other-triangles",
            CageError::NotClosed { .. } => "not-closed",
            CageError::NotEmbedded { violation, .. } => violation.code,
        };
        let failure = Failure::input(code, format!("{} and {}: {error}", from.display(), to.display()));
        match error {
            CageError::NotEmbedded { violation, .. } => failure.with("violations", json!([violation])),
            _ => failure,
        }
    })
}

type Surface = (Vec<[f64; 3]>, Vec<[u32; 3]>);

fn read_cage(session: &Session, path: &Path) -> Result<Surface> {
    let mesh = mesh_input::read(session, path, Requested::default())?;
    refuse::unless_simplices(&mesh, false)?;
    match mesh.cells {
        Cells::Triangles(complex) => {
            let triangles = complex.cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
            Ok((mesh.file.positions, triangles))
        }
        Cells::Tetrahedra(_) => {
            let message = format!("{} is a tetrahedral mesh; a cage is a closed triangle mesh", path.display());
            Err(Failure::input("no-surface", message))
        }
    }
}

fn path_of(options: &WarpArgs, cages: &CagePair) -> Result<Box<dyn PolyhedronPath>> {
    let (source, target) = (cages.source().to_vec(), cages.target().to_vec());
    let failed = |error: homeo::shape::PolyhedronPathError| Failure::input("no-path", error.to_string());
    Ok(match options.polygons.path {
        PathName::Auto | PathName::Straight => Box::new(StraightPolyhedra::new(source, target).map_err(failed)?),
        PathName::Angles => Box::new(TurningPolyhedra::new(source, target, cages.triangles()).map_err(failed)?),
        PathName::Curvature | PathName::Turning | PathName::Simple => {
            let message = "--path curvature, turning and simple are for polygons; cages take straight or angles";
            return Err(Failure::usage(message));
        }
    })
}

fn explain(session: &Session, error: &DeformError) -> Failure {
    match error {
        DeformError::Cancelled => session.stopped(),
        _ => Failure::limits("no-map", format!("{error}; nothing was written")),
    }
}

/// Writes the map of a mesh, if it is to be kept, and has it checked before anything else is written.
fn certify(
    session: &Session,
    options: &WarpArgs,
    input: &Input,
    done: &Deformed,
    outputs: &mut Outputs,
) -> Result<Option<Claim>> {
    let Some(path) = &options.map else { return Ok(None) };
    let map = input.map(&done.positions)?;
    let provenance = provenance(options, done.steps);
    proof::write_and_decide(session, path, outputs, |mut out| write_moved(&map, &provenance, &mut out)).map(Some)
}

fn provenance(options: &WarpArgs, steps: usize) -> Provenance {
    let cages = [&options.polygons.from, &options.polygons.to].map(|path| path.as_deref().map(file_name));
    let method = if options.method == Some(MethodName::Harmonic) { "harmonic" } else { "mean-value" };
    Provenance {
        source_name: file_name(&options.input),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({"method": method, "from": cages[0], "to": cages[1], "steps": steps}),
    }
}

fn finish(
    session: &Session,
    options: &WarpArgs,
    input: Input,
    done: Deformed,
    claim: Option<Claim>,
    outputs: &mut Outputs,
) -> Result<Answer> {
    session.check()?;
    let moved = input.described();
    let checked = input.checked();
    if let Some(output) = &options.output {
        write(session, input, done.positions, output, outputs)?;
    }
    session.end_stage();
    let mut lines = Lines::default();
    if let Some(claim) = &claim {
        lines.add("certificate", proof::holds(claim));
    }
    lines.add("moved", &moved);
    let is_judged = done.verdict != Verdict::NothingToJudge;
    if is_judged || claim.is_none() {
        lines.add("checked", if is_judged { checked } else { "nothing: points make no mesh that could fold" });
    }
    lines.add("steps", done.steps);
    if let Some(time) = done.crossing_cage {
        lines.add("cages", format!("the one at time {time} meets itself; the check of the mesh does not rest on it"));
    }
    lines.add("time", stages(&session.seconds()));
    for path in [&options.output, &options.map].into_iter().flatten() {
        lines.add("written", path.display());
    }
    let shown = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let fields = json!({
        "target": if options.method == Some(MethodName::Harmonic) { "boundary" } else { "cage" },
        "steps": done.steps, "crossing_cage": done.crossing_cage,
        "checked": {"holds": is_judged, "statement": if is_judged { Some(checked) } else { None }},
        "certificate": claim.as_ref().map(proof::claim_json),
        "quality": {"moved": moved}, "output": shown(&options.output), "map": shown(&options.map),
    });
    Ok(Answer::new(fields, lines.below(&format!("{} warped", options.input.display()))))
}
