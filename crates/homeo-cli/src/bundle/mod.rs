//! `homeo bundle`: the unit tangent bundle of a closed surface as a mesh, with its certificate.

mod field;
mod files;
mod page;
mod refuse;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use homeo::certificate::{Provenance, write_bundle};
use homeo::progress::Progress;
use homeo_core::mesh::TetrahedronComplex;
use homeo_manifold::bundle::{BundleError, MiddleSurface, TangentBundle};
use homeo_manifold::{Homology, Triangulation};
use homeo_verify::Claim;
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::args::BundleArgs;
use crate::failure::{Failure, Result};
use crate::mesh_input::{self, Requested};
use crate::outputs::{Outputs, check_targets};
use crate::proof;
use crate::session::Session;
use crate::text::{Lines, file_name, stages};
use field::FieldSection;
use files::Kind;

/// Tetrahedra take some hundred bytes each on the way.
const MOST_TETRAHEDRA: u128 = 1 << 28;

/// Makes a bundle, has it proved and stages its file.
pub fn run(session: &Session, options: &BundleArgs, outputs: &mut Outputs) -> Result<Answer> {
    let kind = options.output.as_deref().map(|path| Kind::of(path, options.gluings)).transpose()?;
    check_outputs(options)?;
    let format = options.indices.as_deref().map(files::surface_format).transpose()?;
    let requested = Requested { weld: options.weld, triangulate: options.triangulate, orient: options.orient };
    let mesh = mesh_input::read(session, &options.input, requested)?;
    for note in mesh.changes.iter().chain(&mesh.file.losses) {
        session.display().note(note);
    }
    session.stage("check");
    let complex = refuse::unfit(session, &mesh, options.triangulate)?;
    session.check()?;
    let corners: Vec<[u32; 3]> = complex.cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
    let read = |name| field::vectors(name, &mesh.file, corners.len());
    let vectors = options.field.as_deref().map(read).transpose()?;
    session.stage("bundle");
    let middles = field::middles(vectors.as_ref(), &corners, complex.vertex_count())?;
    let below = Below::new(middles.as_ref(), &corners, &mesh.file.positions)?;
    unless_too_large(below.triangles.len(), below.positions.len(), options.layers)?;
    let tangent = TangentBundle::new(&below.triangles, below.positions.len(), options.layers).map_err(explain)?;
    session.check()?;
    session.stage("homology");
    let mut made = Made::new(tangent)?;
    session.check()?;
    if let Some(field) = options.field.as_deref().zip(vectors) {
        let over = (&made.tangent, middles.as_ref());
        made.field = Some(FieldSection::new(session, field, over, &made.tetrahedra, &mesh.file.positions)?);
        made.middles = below.positions.len() - mesh.file.positions.len();
    }
    let provenance = Provenance {
        source_name: file_name(&options.input),
        program: format!("homeo {}", env!("CARGO_PKG_VERSION")),
        options: json!({
            "layers": options.layers, "field": options.field.as_deref().map(|name| file_name(Path::new(name))),
            "weld": options.weld, "triangulate": options.triangulate, "orient": options.orient,
        }),
    };
    let map_path = options.output.as_deref().filter(|_| kind == Some(Kind::Certificate));
    let claim = proof::write_and_check(session, map_path, outputs, |mut out| {
        write_bundle(&made.tangent.bundle, made.field.as_ref().map(|field| &field.section), &provenance, &mut out)
    })?;
    if let (Some(path), Some(kind)) = (&options.output, kind) {
        files::stage(session, path, kind, &made, &below.positions, outputs)?;
    }
    if let (Some(path), Some(format), Some(field)) = (&options.indices, format, &made.field) {
        files::stage_surface(session, path, format, &field.surface(&mesh.file.positions, &corners), outputs)?;
    }
    if let Some(path) = &options.report {
        page::stage(session, path, &options.input, (&made, &below.positions, &below.triangles), &claim, outputs)?;
    }
    session.end_stage();
    let fields = json!({
        "target": claim.target,
        "certificate": proof::claim_json(&claim),
        "bundle": made.described(),
        "field": made.field.as_ref().map(|field| field.described(made.euler_number)),
        "output": shown(&options.output),
        "indices": shown(&options.indices),
        "report": shown(&options.report),
    });
    Ok(Answer::new(fields, words(session, options, &made, &claim)))
}

fn check_outputs(options: &BundleArgs) -> Result<()> {
    let outputs = [&options.output, &options.indices, &options.report].into_iter().filter_map(|path| path.as_deref());
    // A field may be a file too.
    let inputs = [Some(options.input.as_path()), options.field.as_deref().map(Path::new)];
    check_targets(&outputs.collect::<Vec<_>>(), &inputs.into_iter().flatten().collect::<Vec<_>>())
}

fn shown(path: &Option<PathBuf>) -> Option<String> {
    path.as_ref().map(|path| path.display().to_string())
}

/// The surface of which the bundle is made: that which was read, or that of its middles.
struct Below<'a> {
    triangles: Cow<'a, [[u32; 3]]>,
    positions: Cow<'a, [[f64; 3]]>,
}

impl<'a> Below<'a> {
    fn new(middles: Option<&'a MiddleSurface>, triangles: &'a [[u32; 3]], positions: &'a [[f64; 3]]) -> Result<Self> {
        let Some(middles) = middles else {
            return Ok(Self { triangles: triangles.into(), positions: positions.into() });
        };
        let positions = middles.places(positions).map_err(field::unfit)?;
        Ok(Self { triangles: middles.triangles().into(), positions: positions.into() })
    }
}

/// A bundle and what is told of it.
struct Made {
    tangent: TangentBundle,
    tetrahedra: Vec<[u32; 4]>,
    triangulation: Triangulation,
    euler_number: i64,
    homology: Homology,
    field: Option<FieldSection>,
    /// Vertices of the base that are middles of triangles.
    middles: usize,
}

impl Made {
    fn new(tangent: TangentBundle) -> Result<Self> {
        let bug = |what: &dyn std::fmt::Display| Failure::bug(format!("the bundle is no closed mesh: {what}"));
        let tetrahedra = tangent.bundle.tetrahedra();
        let vertices = tangent.bundle.vertex_count() * tangent.bundle.layers() as usize;
        let complex = TetrahedronComplex::from_indices(vertices, &tetrahedra).map_err(|error| bug(&error))?;
        let triangulation = Triangulation::from_complex(&complex).map_err(|error| bug(&error))?;
        let euler_number = tangent.bundle.euler_number().ok_or_else(|| bug(&"its base has a boundary"))?;
        let homology = Homology::new(&triangulation);
        Ok(Self { tangent, tetrahedra, triangulation, euler_number, homology, field: None, middles: 0 })
    }

    fn vertex_count(&self) -> usize {
        self.tangent.bundle.vertex_count() * self.tangent.bundle.layers() as usize
    }

    fn genus(&self) -> i64 {
        1 - self.euler_number / 2
    }

    fn described(&self) -> Value {
        json!({
            "genus": self.genus(), "euler_number": self.euler_number, "layers": self.tangent.bundle.layers(),
            "tetrahedra": self.tetrahedra.len(), "vertices": self.vertex_count(), "h1": self.homology.to_string(),
            "base": {
                "vertices": self.tangent.bundle.vertex_count(), "triangles": self.tangent.bundle.triangles().len(),
                "added": self.tangent.added.len(), "middles": self.middles,
            },
        })
    }
}

/// Refuses bundles that no machine can hold before room is asked for, which would end the program.
fn unless_too_large(triangles: usize, vertices: usize, layers: u32) -> Result<()> {
    let (triangles, layers) = (triangles as u128, u128::from(layers));
    // Paths have `layers * |characteristic|` edges or more in all, and each edge that is split adds two triangles.
    let twice_characteristic = (2 * vertices as u128).abs_diff(triangles);
    let tetrahedra = 3 * layers * (triangles + layers * twice_characteristic);
    if tetrahedra <= MOST_TETRAHEDRA {
        return Ok(());
    }
    let message = format!("{tetrahedra} tetrahedra may be needed, more than {MOST_TETRAHEDRA}; take fewer --layers");
    Err(Failure::limits("too-large", message))
}

/// What the topology report lets through is a surface; the sizes are left.
fn explain(error: BundleError) -> Failure {
    match error {
        BundleError::TooMany { .. } => Failure::limits("too-large", error.to_string()),
        BundleError::NotManifold { vertex } => {
            Failure::input("unfit-input", error.to_string()).with("elements", json!([vertex]))
        }
        _ => Failure::input("unfit-input", error.to_string()),
    }
}

fn words(session: &Session, options: &BundleArgs, made: &Made, claim: &Claim) -> String {
    let base = &made.tangent.bundle;
    let mut lines = Lines::default();
    lines.add("certificate", proof::holds(claim));
    lines.add("genus", made.genus());
    lines.add("Euler number", made.euler_number);
    lines.add("mesh", format!("{} vertices, {} tetrahedra", made.vertex_count(), made.tetrahedra.len()));
    let middles = if made.middles > 0 { format!(" ({} middles of triangles)", made.middles) } else { String::new() };
    let added = match made.tangent.added.len() {
        0 => middles,
        added => format!("{middles} ({added} added)"),
    };
    lines.add("base", format!("{} vertices{added}, {} triangles", base.vertex_count(), base.triangles().len()));
    lines.add("fibres", format!("{} edges each", base.layers()));
    lines.add("homology", format!("H1 = {}", made.homology));
    made.field.iter().for_each(|field| field.tell(&mut lines));
    lines.add("time", stages(&session.seconds()));
    let written: Vec<&PathBuf> = [&options.output, &options.indices, &options.report].into_iter().flatten().collect();
    written.iter().for_each(|path| lines.add("written", path.display()));
    if written.is_empty() {
        lines.add("written", "nothing: give -o FILE.json, FILE.homeo or a mesh format");
    }
    lines.below(&format!(
        "unit tangent bundle of {}: a circle bundle with its Euler number, proved",
        options.input.display()
    ))
}
