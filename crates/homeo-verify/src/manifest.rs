//! Container rules: `manifest.json`, which says what the arrays claim to be.

use crate::verdict::{Unreadable, readable, unreadable};
use serde::{Deserialize, de::IgnoredAny};
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// The canonical domain that the map claims to reach.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Target {
    Square,
    Disk,
    Cube,
    Ball,
    /// The middle surface of a shell.
    Shell,
    /// Another section of a shell.
    Section,
    /// The middle surface of a shell round a surface that may cross itself.
    #[serde(rename = "immersed-shell")]
    ImmersedShell,
    /// The middle surface of a shell that does not overlap itself in space.
    #[serde(rename = "embedded-shell")]
    EmbeddedShell,
    /// A planar domain without holes.
    Polygon,
    /// A planar domain with one hole.
    Annulus,
    /// A planar domain with several holes.
    Domain,
    /// A hyperbolic structure with geodesic boundary.
    #[serde(rename = "geodesic-boundary")]
    GeodesicBoundary,
    /// The same, on the canonical decomposition of the manifold.
    #[serde(rename = "canonical-decomposition")]
    CanonicalDecomposition,
    /// The unit tangent bundle of a surface.
    #[serde(rename = "unit-tangent-bundle")]
    UnitTangentBundle,
    /// The same, with a section of it over the edges of the surface.
    #[serde(rename = "unit-tangent-bundle-with-section")]
    UnitTangentBundleWithSection,
    /// Where a mesh has moved to.
    Space,
    /// The inside of a closed triangle mesh.
    Polyhedron,
}

impl Target {
    /// Whether maps of kind `shell` reach it, and no others.
    pub(crate) fn is_in_shell(self) -> bool {
        matches!(self, Target::Shell | Target::Section | Target::ImmersedShell | Target::EmbeddedShell)
    }

    /// Whether maps between planar domains reach it, and no others.
    pub(crate) fn is_planar(self) -> bool {
        matches!(self, Target::Polygon | Target::Annulus | Target::Domain)
    }

    /// Whether hyperbolic structures reach it, and no maps.
    pub(crate) fn is_geodesic(self) -> bool {
        matches!(self, Target::GeodesicBoundary | Target::CanonicalDecomposition)
    }

    /// Whether unit tangent bundles reach it, and no maps.
    pub(crate) fn is_bundle(self) -> bool {
        matches!(self, Target::UnitTangentBundle | Target::UnitTangentBundleWithSection)
    }

    /// Vertices of a cell: three or four. In space, a surface and a volume may move: [`Manifest::cell_size`].
    fn largest_cell_size(self) -> usize {
        let is_solid = matches!(self, Target::Cube | Target::Ball | Target::Space);
        let is_solid = is_solid || self.is_geodesic() || self.is_bundle();
        if is_solid { 4 } else { 3 }
    }
}

/// What the arrays define.
#[derive(PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kind {
    Foliation,
    PiecewiseLinear,
    Shell,
    CompositeHarmonic,
    CompositeMeanValue,
    ComplexBarycentric,
    Hyperbolic,
    UnitTangentBundle,
    MovedMesh,
    CompositeCage,
}

/// What the manifest claims.
#[derive(Deserialize)]
pub(crate) struct Manifest {
    pub(crate) kind: Kind,
    dimension: usize,
    pub(crate) target: Target,
    #[serde(deserialize_with = "Option::deserialize")] // it may be null, but not absent
    pub(crate) centre: Option<Centre>,
    pub(crate) source: Source,
    #[serde(flatten)]
    others: BTreeMap<String, IgnoredAny>,
}

/// The cell in which the leaves of disk and ball meet.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Centre {
    pub(crate) cell: usize,
    #[serde(rename = "length")]
    _length: NonZeroU32, // that it is at least 1 is all that matters
}

/// The mesh that the map is about.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Source {
    pub(crate) vertices: usize,
    pub(crate) cells: usize,
    pub(crate) content_sha256: String,
    #[serde(rename = "name", default)]
    _name: IgnoredAny,
}

/// Fields that are checked before the others, and fields on which no claim rests.
const OTHER_FIELDS: [&str; 4] = ["format", "version", "length_unit", "construction"];

impl Manifest {
    /// Reads the manifest; every departure from the format is an error.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, Unreadable> {
        readable(bytes.len() <= 1 << 20, "manifest.json is longer than 1 MiB")?;
        let not_json = |error| unreadable(format!("manifest.json is not JSON: {error}"));
        let value: Value = serde_json::from_slice(bytes).map_err(not_json)?;
        readable(count_keys(&value) == count_colons(bytes), "manifest.json repeats a key")?;
        readable(value["format"] == "homeo", "the format is not \"homeo\"")?;
        readable(value["version"] == 1, "this checker reads version 1 only")?;
        // Serde would also take a list of the values for an object, and {"text": null} for a text.
        let are_texts = value["kind"].is_string() && value["target"].is_string();
        readable(are_texts, "kind or target is missing or not a text")?;
        let are_objects = value["source"].is_object() && !value["centre"].is_array();
        readable(are_objects, "source or centre is not an object")?;
        let not_as_stated = |error| unreadable(format!("manifest.json is not as the format says: {error}"));
        let manifest: Manifest = serde_json::from_slice(bytes).map_err(not_as_stated)?;
        let is_known = |key: &String| OTHER_FIELDS.contains(&key.as_str()) || key.starts_with("note_");
        if let Some(key) = manifest.others.keys().find(|key| !is_known(key)) {
            return Err(unreadable(format!("manifest.json has an unknown field {key:?}")));
        }
        let largest = manifest.target.largest_cell_size();
        let is_surface = manifest.target == Target::Space && manifest.dimension == 2;
        readable(is_surface || manifest.dimension == largest - 1, "dimension and target disagree")?;
        let is_radial = matches!(manifest.target, Target::Disk | Target::Ball);
        readable(is_radial == manifest.centre.is_some(), "a centre belongs to disk and ball, and to no other target")?;
        let is_possible = !is_radial || manifest.kind == Kind::Foliation;
        readable(is_possible, "only a foliation can reach the disk or the ball")?;
        let is_shell = manifest.kind == Kind::Shell;
        readable(is_shell == manifest.target.is_in_shell(), "kind shell and the targets of shells belong together")?;
        let is_planar =
            matches!(manifest.kind, Kind::CompositeHarmonic | Kind::CompositeMeanValue | Kind::ComplexBarycentric);
        let message = "composite and complex maps and planar targets belong together";
        readable(is_planar == manifest.target.is_planar(), message)?;
        let is_hyperbolic = manifest.kind == Kind::Hyperbolic;
        let is_geodesic = manifest.target.is_geodesic();
        readable(is_hyperbolic == is_geodesic, "kind hyperbolic and the targets of such structures belong together")?;
        let is_bundle = manifest.kind == Kind::UnitTangentBundle;
        let has_bundle = manifest.target.is_bundle();
        readable(is_bundle == has_bundle, "kind unit-tangent-bundle and the targets of bundles belong together")?;
        let is_moved = manifest.kind == Kind::MovedMesh;
        readable(is_moved == (manifest.target == Target::Space), "kind moved-mesh and target space belong together")?;
        let is_between_cages = manifest.kind == Kind::CompositeCage;
        let is_polyhedron = manifest.target == Target::Polyhedron;
        readable(is_between_cages == is_polyhedron, "kind composite-cage and target polyhedron belong together")?;
        Ok(manifest)
    }

    /// Vertices of a cell: three or four.
    pub(crate) fn cell_size(&self) -> usize {
        self.dimension + 1
    }
}

/// The number of keys that the parser kept.
fn count_keys(value: &Value) -> usize {
    match value {
        Value::Object(object) => object.len() + object.values().map(count_keys).sum::<usize>(),
        Value::Array(array) => array.iter().map(count_keys).sum(),
        _ => 0,
    }
}

/// The number of keys in valid JSON text: colons that are not inside a string.
fn count_colons(bytes: &[u8]) -> usize {
    let (mut colons, mut inside, mut escaped) = (0, false, false);
    for &byte in bytes {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if inside => escaped = true,
            b'"' => inside = !inside,
            b':' if !inside => colons += 1,
            _ => {}
        }
    }
    colons
}
