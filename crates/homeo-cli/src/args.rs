//! The command line as clap sees it. Nothing here is validated beyond single values.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Certified bijective maps between shapes.
#[derive(Debug, Parser)]
#[command(name = "homeo", version, propagate_version = true, max_term_width = 100, after_help = EXIT_CODES)]
pub struct Arguments {
    #[command(flatten)]
    pub common: Common,
    #[command(subcommand)]
    pub verb: Verb,
}

const EXIT_CODES: &str = "\
Example:
  homeo map testdata/meshes/spot.mesh --onto cube -o spot.homeo

Exit codes: 0 done, 1 a bug in homeo, 2 wrong usage, 3 the input is not what the verb needs,
4 no map within the limits given (nothing is written), 5 a certificate does not hold.";

/// Options of every verb.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Common options")]
pub struct Common {
    /// Print one JSON object on standard output, and nothing else there
    #[arg(long, global = true)]
    pub json: bool,
    /// Say nothing on standard error but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more on standard error (-vv: still more)
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
    /// Threads to use; results do not depend on it [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Seed of everything random; the same seed gives the same bytes
    #[arg(long, global = true, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Write what happens to FILE, with times
    #[arg(long, global = true, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Stop after S seconds with exit code 4 (`shell`: with what there is, if anything)
    #[arg(long, global = true, value_name = "S", value_parser = positive_seconds)]
    pub timeout: Option<f64>,
    /// Stop with exit code 4 when more memory is in use (bytes, or with K, M, G)
    #[arg(long, global = true, value_name = "BYTES", value_parser = bytes)]
    pub memory: Option<u64>,
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Say everything about a mesh (or polygons, a gluing, an image) that a construction will demand
    Info(InfoArgs),
    /// Map a disk onto the square or disk, or a ball onto the cube or ball, one-to-one and onto
    Map(MapArgs),
    /// Make a prismatic shell round a surface, with its one-to-one projection
    Shell(ShellArgs),
    /// A surface with fewer triangles, with the one-to-one map onto it and everything that the file says
    Simplify(SimplifyArgs),
    /// A surface with triangles of about equal size, likewise
    Remesh(RemeshArgs),
    /// Move attributes from one surface in a shell to another
    Transfer(TransferArgs),
    /// The map of a shell as two meshes with one connectivity
    Pl(PlArgs),
    /// Warp a picture or points as a polygon moves, a mesh as a cage moves, and never fold
    Warp(WarpArgs),
    /// The frames between, as a polygon moves with the picture in it
    Morph(MorphArgs),
    /// Closed curves between two others, by curvature
    Blend(BlendArgs),
    /// Make the unit tangent bundle of a closed surface, as a closed mesh of tetrahedra
    Bundle(BundleArgs),
    /// The hyperbolic metric with geodesic boundary of glued tetrahedra, or of a solid, with a proof
    Hyperbolic(HyperbolicArgs),
    /// Images of points under a map, or under its inverse
    Eval(EvalArgs),
    /// Images of points under one map and back under another onto the same shape
    Compose(ComposeArgs),
    /// Check the certificate of a map, independently of how it was made
    Verify(VerifyArgs),
    /// Show a map, a shell or a hyperbolic structure: one HTML page that needs nothing else
    Report(ReportArgs),
}

impl Verb {
    /// The verb as typed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Info(_) => "info",
            Self::Map(_) => "map",
            Self::Shell(_) => "shell",
            Self::Simplify(_) => "simplify",
            Self::Remesh(_) => "remesh",
            Self::Transfer(_) => "transfer",
            Self::Pl(_) => "pl",
            Self::Warp(_) => "warp",
            Self::Morph(_) => "morph",
            Self::Blend(_) => "blend",
            Self::Bundle(_) => "bundle",
            Self::Hyperbolic(_) => "hyperbolic",
            Self::Eval(_) => "eval",
            Self::Compose(_) => "compose",
            Self::Verify(_) => "verify",
            Self::Report(_) => "report",
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = "Example:\n  homeo info testdata/meshes/spot.mesh --json")]
pub struct InfoArgs {
    /// OBJ, PLY, STL, OFF; MSH, MEDIT, VTK, VTU; JSON facets, polygons or gluings; SVG; PNG, JPEG
    #[arg(value_name = "MESH")]
    pub input: PathBuf,
    /// Look for triangles that meet where they should not (always done where a ball is to be decided)
    #[arg(long)]
    pub intersections: bool,
    /// First merge vertices of a mesh at exactly the same point, as `map --weld` does
    #[arg(long)]
    pub weld: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo map testdata/meshes/spot.mesh --onto cube -o spot.homeo --vtu spot.vtu
  homeo map testdata/meshes/face.obj --onto disk -o face.homeo

The certificate is checked on the bytes that were written; only then do they get their name.
--regions takes {\"corners\": [a, b, c, d]} for the square, {\"source\": [[a, b, c], ...],
\"sink\": [...]} for the cube, {\"centre\": cell} for disk and ball; numbers count from 0,
those of vertices after --weld.")]
pub struct MapArgs {
    /// A surface that is a disk, or a tetrahedral mesh that is a ball
    #[arg(value_name = "MESH")]
    pub input: PathBuf,
    /// What to map onto
    #[arg(long, value_enum)]
    pub onto: TargetName,
    /// The map file to write
    #[arg(short, long, value_name = "MAP.homeo")]
    pub output: Option<PathBuf>,
    /// Write one self-contained HTML page that shows the map
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write the mesh with image coordinates and distortion as fields (.vtu or .vtk)
    #[arg(long, value_name = "FILE")]
    pub vtu: Option<PathBuf>,
    /// Regions that the map must use (JSON, see below)
    #[arg(long, value_name = "FILE.json")]
    pub regions: Option<PathBuf>,
    /// Refinements before giving up
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub refinements: usize,
    /// Runs of the front before each refinement
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = at_least_one)]
    pub restarts: usize,
    /// Sweeps of smoothing
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub smoothing: usize,
    /// Merge vertices at exactly the same point into the first of them (reported)
    #[arg(long)]
    pub weld: bool,
    /// Cut polygons of more than three corners into triangles
    #[arg(long)]
    pub triangulate: bool,
    /// Turn triangles, or reorder tetrahedra, so that all are oriented alike (reported)
    #[arg(long)]
    pub orient: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo shell testdata/meshes/torus.obj -o torus.homeo --report torus.html

The certificate is checked on the bytes that were written; only then do they get their name.
The middle surface of the first shell is the surface itself; simplification takes prisms away.
When --timeout is reached then, the shell so far is checked and written.")]
pub struct ShellArgs {
    /// A surface, closed or open, that does not cross or touch itself; with --immersed it may cross itself
    #[arg(value_name = "MESH")]
    pub input: PathBuf,
    /// The map file to write
    #[arg(short, long, value_name = "OUT.homeo")]
    pub output: Option<PathBuf>,
    /// Largest distance of bottom and top from the middle, relative to the longest side of the bounding box
    #[arg(long, value_name = "T", default_value_t = 0.1, value_parser = positive)]
    pub thickness: f64,
    /// Stop when no more than N prisms are left [default: as few as possible]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub prisms: usize,
    /// Rounds of simplification at most; with 0 the middle surface is the surface itself
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub rounds: usize,
    /// Let the surface cross itself in space: the map is one of abstract surfaces, and the certificate says so
    #[arg(long, conflicts_with = "embedded")]
    pub immersed: bool,
    /// A shell that does not overlap itself anywhere, as nested cages have to be; it is thinner where sheets are close
    #[arg(long)]
    pub embedded: bool,
    /// Let no pillar come farther than A degrees from the normal of a triangle that it crosses, where none was before
    #[arg(long, value_name = "A", default_value_t = 89.95, value_parser = right_angle)]
    pub largest_angle: f64,
    /// Keep edges in the middle surface, as chains, where the normals of their triangles differ by more than A degrees
    #[arg(long, value_name = "A", value_parser = degrees)]
    pub features: Option<f64>,
    /// Vertices that stay vertices of the middle surface: a JSON list of their numbers from 0, after --weld
    #[arg(long, value_name = "FILE.json")]
    pub frozen: Option<PathBuf>,
    /// Write one self-contained HTML page that shows the shell
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Also write bottom, middle and top as PREFIX_bottom.obj, PREFIX_middle.obj, PREFIX_top.obj
    #[arg(long, value_name = "PREFIX")]
    pub layers: Option<PathBuf>,
    /// Merge vertices at exactly the same point into the first of them (reported)
    #[arg(long)]
    pub weld: bool,
    /// Cut polygons of more than three corners into triangles
    #[arg(long)]
    pub triangulate: bool,
    /// Turn triangles so that neighbours are oriented alike (reported)
    #[arg(long)]
    pub orient: bool,
}

/// What `simplify` and `remesh` have in common.
#[derive(Debug, Args)]
pub struct InsideArgs {
    /// A surface, closed or open, that does not cross or touch itself
    #[arg(value_name = "MESH")]
    pub input: PathBuf,
    /// The surface to write (.obj, .ply, .off, .stl, .vtu, .vtk), with all attributes of MESH that the format can hold
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Also write the map from MESH onto OUT, with its certificate
    #[arg(long, value_name = "MAP.homeo")]
    pub map: Option<PathBuf>,
    /// How far the surface may move: largest distance of the shell's bottom and top from its middle, relative to the longest
    /// side of the bounding box [default: 0.1]
    #[arg(long, value_name = "T", value_parser = positive)]
    pub thickness: Option<f64>,
    /// Keep edges as chains where the normals of their triangles differ by more than A degrees
    #[arg(long, value_name = "A", value_parser = degrees)]
    pub features: Option<f64>,
    /// An attribute of triangles that is a mass per area: its total is kept (may be repeated)
    #[arg(long, value_name = "NAME")]
    pub density: Vec<String>,
    /// Write NAME_status beside each attribute: 0 copied, 1 interpolated, 2 largest share, 3 split by a seam, 4 missing
    #[arg(long)]
    pub status: bool,
    /// Merge vertices at exactly the same point into the first of them (reported)
    #[arg(long)]
    pub weld: bool,
    /// Cut polygons of more than three corners into triangles
    #[arg(long)]
    pub triangulate: bool,
    /// Turn triangles so that neighbours are oriented alike (reported)
    #[arg(long)]
    pub orient: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo simplify testdata/meshes/torus.obj --to 10% -o small.obj --map small.homeo

The result lies in a prismatic shell of MESH and is crossed by its pillars once: the map onto it is
one-to-one and onto, which is proved before anything is written. It does not cross itself. Texture
coordinates keep their seams, and no triangle of them is turned over that was not before.")]
pub struct SimplifyArgs {
    #[command(flatten)]
    pub common: InsideArgs,
    /// Stop at so many triangles: a number, or a share such as 2% [default: as few as --error allows]
    #[arg(long, value_name = "N|P%", required_unless_present = "error")]
    pub to: Option<Amount>,
    /// Put no vertex farther than this from the planes of its triangles (root mean square, in units of MESH)
    #[arg(long, value_name = "E", value_parser = positive)]
    pub error: Option<f64>,
    /// Make a shell whose pillars come no farther than A degrees from normals, as `shell --largest-angle` [default: 89.95;
    /// where --to is not reached then, 60 as well, and the better one is kept, unless --thickness is given]
    #[arg(long, value_name = "A", value_parser = right_angle)]
    pub largest_angle: Option<f64>,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo remesh testdata/meshes/torus.obj --edge 0.2 -o even.ply --map even.homeo
  homeo remesh testdata/meshes/torus.obj --edge 0.3 --adaptive 0.002 -o finer_where_it_bends.ply

As for `simplify`, the map onto the result is one-to-one and onto, proved before anything is written.")]
pub struct RemeshArgs {
    #[command(flatten)]
    pub common: InsideArgs,
    /// The wanted length of edges, in units of MESH [default: the mean length of its edges]
    #[arg(long, value_name = "L", value_parser = positive)]
    pub edge: Option<f64>,
    /// An attribute of vertices that gives the wanted length of edges there, in units of MESH
    #[arg(long, value_name = "NAME", conflicts_with_all = ["edge", "adaptive"])]
    pub sizing: Option<String>,
    /// Shorter edges where the surface bends, down to a tenth of --edge: chords stay within about E of it, in units of MESH
    #[arg(long, value_name = "E", value_parser = positive)]
    pub adaptive: Option<f64>,
    /// How often edges are split, collapsed and flipped, and vertices moved
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = at_least_one)]
    pub iterations: usize,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo simplify testdata/meshes/torus.obj --to 10% -o small.obj --map small.homeo
  homeo transfer small.homeo --from testdata/meshes/torus.obj -o again.vtu
  homeo transfer small.homeo --from small.obj --inverse -o back.vtu

Every value that is written has a status: copied, interpolated, largest share of several labels,
split (the value jumps inside the triangle), or missing; the answer counts them.")]
pub struct TransferArgs {
    /// A shell, as made by `shell`, `simplify` or `remesh`
    #[arg(value_name = "MAP")]
    pub map: PathBuf,
    /// The mesh that has the attributes: the very one that the map was made of (with --inverse, the one it leads to)
    #[arg(long, value_name = "MESH")]
    pub from: PathBuf,
    /// Another surface that lies in the shell [default: the one in the map]
    #[arg(long, value_name = "MESH", conflicts_with = "inverse")]
    pub onto: Option<PathBuf>,
    /// From the surface in the map back to its source
    #[arg(long)]
    pub inverse: bool,
    /// The mesh to write
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// An attribute of triangles that is a mass per area: its total is kept (may be repeated)
    #[arg(long, value_name = "NAME")]
    pub density: Vec<String>,
    /// Write NAME_status beside each attribute: 0 copied, 1 interpolated, 2 largest share, 3 split by a seam, 4 missing
    #[arg(long)]
    pub status: bool,
    /// Merge vertices of the meshes as `simplify --weld` does
    #[arg(long)]
    pub weld: bool,
    /// Cut their polygons as `simplify --triangulate` does
    #[arg(long)]
    pub triangulate: bool,
    /// Orient them as `simplify --orient` does
    #[arg(long)]
    pub orient: bool,
}

/// How many triangles are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    Number(usize),
    /// In percent.
    Share(f64),
}

impl Amount {
    /// The number, of so many.
    pub fn of(self, all: usize) -> usize {
        match self {
            Self::Number(number) => number,
            Self::Share(percent) => (all as f64 * percent / 100.0).round() as usize,
        }
    }
}

impl std::fmt::Display for Amount {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(formatter, "{number}"),
            Self::Share(percent) => write!(formatter, "{percent}%"),
        }
    }
}

impl std::str::FromStr for Amount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "a number of triangles, or a share such as 2% is needed".to_owned();
        match text.strip_suffix('%') {
            Some(percent) => match percent.trim().parse::<f64>() {
                Ok(percent) if (0.0..=100.0).contains(&percent) => Ok(Self::Share(percent)),
                _ => Err(wrong()),
            },
            None => text.parse().map(Self::Number).map_err(|_| wrong()),
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo simplify testdata/meshes/torus.obj --to 10% -o small.obj --map small.homeo
  homeo pl small.homeo -o source.ply --image section.ply --exact weights.csv

The two files have the same vertices and triangles, in the same order; on each triangle the map is
affine. They are the exact common refinement of both surfaces, with positions rounded to doubles;
rounding may turn very small triangles over, and how many is said. source_triangle and
section_triangle say which triangle of each surface a triangle lies in. --exact writes, for each
vertex, where it is on both without any error: a triangle and three rationals.
The image of a map made by `shell` is the middle surface. Maps made by `map` are not supported yet.")]
pub struct PlArgs {
    /// A map made by `simplify --map`, `remesh --map` or `shell`
    #[arg(value_name = "MAP")]
    pub map: PathBuf,
    /// The refined source to write (.ply, .vtu, .vtk, .obj, .off)
    #[arg(short, long, value_name = "SOURCE")]
    pub output: PathBuf,
    /// Its image to write, likewise
    #[arg(long, value_name = "IMAGE")]
    pub image: PathBuf,
    /// Also write the exact weights of all vertices
    #[arg(long, value_name = "FILE.csv")]
    pub exact: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo bundle testdata/meshes/torus.obj -o torus_bundle.json
  homeo bundle testdata/meshes/torus.obj --layers 5 -o torus_bundle.homeo
  homeo verify torus_bundle.homeo
  homeo bundle testdata/meshes/torus.obj --field testdata/fields/torus_height.csv --report torus_bundle.html

Vertex v * layers + level of the mesh lies on that level of the circle over vertex v of the base, which is MESH with
some edges split where it was too coarse. That the mesh is the bundle is checked before anything is written.
The mesh has no place in space: in mesh formats its vertices lie where those of the base are.")]
pub struct BundleArgs {
    /// A closed, connected, oriented surface; it may cross itself
    #[arg(value_name = "MESH")]
    pub input: PathBuf,
    /// Tetrahedra as .json, a certificate as .homeo, or a mesh format for volumes (.mesh, .msh, .vtk, .vtu)
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// A field of vectors to be made a section: the name of one at the vertices or triangles of MESH, or a file .csv or
    /// .npy with one for each
    #[arg(long, value_name = "FIELD")]
    pub field: Option<String>,
    /// The surface with the indices of the field at its triangles and vertices (.ply, .vtk, .vtu)
    #[arg(long, value_name = "SURFACE", requires = "field")]
    pub indices: Option<PathBuf>,
    /// A page with pictures and what was proved, for a browser
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
    /// Edges of the circle over each vertex
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(3..))]
    pub layers: u32,
    /// Write .json as {"tetrahedra", "gluings"}, with a row for each face
    #[arg(long)]
    pub gluings: bool,
    /// Merge vertices at exactly the same point into the first of them (reported)
    #[arg(long)]
    pub weld: bool,
    /// Cut polygons of more than three corners into triangles
    #[arg(long)]
    pub triangulate: bool,
    /// Turn triangles so that neighbours are oriented alike (reported)
    #[arg(long)]
    pub orient: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo map testdata/meshes/spot.mesh --onto cube -o spot.homeo
  homeo eval spot.homeo --points testdata/points/spot.csv -o images.csv
  homeo eval spot.homeo --points testdata/points/cube.csv --inverse --exact

Points are .npy (float64, n by d) or .csv with the header x,y,z or x,y. Without -o the answer is
CSV on standard output. --exact reads and writes rationals p/q (or decimals, which are exact); for
disk and ball it is about their polyhedral forms, the diamond and the tetrahedron. Under a shell,
points of it go along their pillar lines to the middle surface, with --inverse to the source.")]
pub struct EvalArgs {
    /// The map
    #[arg(value_name = "MAP")]
    pub map: PathBuf,
    /// The points
    #[arg(long, value_name = "P")]
    pub points: PathBuf,
    /// From the target back to the mesh
    #[arg(long)]
    pub inverse: bool,
    /// In rationals, without any error (CSV only)
    #[arg(long)]
    pub exact: bool,
    /// What a point outside the domain gives
    #[arg(long, value_enum, default_value_t = Outside::Error)]
    pub outside: Outside,
    /// The file to write (.npy or .csv)
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo map testdata/meshes/spot.mesh --onto cube -o spot.homeo
  homeo map testdata/meshes/spot.mesh --onto cube --seed 2 -o again.homeo
  homeo compose spot.homeo again.homeo --points testdata/points/spot.csv -o moved.csv
  homeo map testdata/meshes/sheet.obj --onto square -o sheet.homeo
  homeo map testdata/meshes/face.obj --onto square -o face.homeo
  homeo compose sheet.homeo face.homeo --from testdata/meshes/sheet.obj --onto testdata/meshes/face.obj -o dressed.obj

The composite of a certified map and the inverse of another is one-to-one and onto. Both files are
checked first. In floating point an answer is the image, with its error, of a point of the common
shape that is off by the other error that is reported; --exact is without any.

With --from and --onto (disks only) what MESH_A says at its vertices, corners and triangles is read off at the places
that correspond to those of MESH_B, and written as fields of MESH_B beside its own; where it has one of that name, with
the prefix from_. Which triangle a place lies in is decided exactly.")]
pub struct ComposeArgs {
    /// The map that points take first
    #[arg(value_name = "A")]
    pub first: PathBuf,
    /// The map that they take back, onto the same shape
    #[arg(value_name = "B")]
    pub second: PathBuf,
    /// Points of the source of A
    #[arg(long, value_name = "P", required_unless_present = "from", conflicts_with = "from")]
    pub points: Option<PathBuf>,
    /// In rationals, without any error (CSV only)
    #[arg(long, conflicts_with = "from")]
    pub exact: bool,
    /// What a point outside the source of A gives
    #[arg(long, value_enum, default_value_t = Outside::Error, conflicts_with = "from")]
    pub outside: Outside,
    /// The file to write: .npy or .csv for points, a mesh for --from
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub across: AcrossArgs,
}

/// Meshes between which fields are moved.
#[derive(Debug, Args)]
pub struct AcrossArgs {
    /// The mesh that has the fields: the very one that A was made of
    #[arg(long, value_name = "MESH_A", requires = "onto", requires = "output")]
    pub from: Option<PathBuf>,
    /// The mesh that gets them: the very one that B was made of
    #[arg(long, value_name = "MESH_B", requires = "from")]
    pub onto: Option<PathBuf>,
    /// Write NAME_status beside each field: 0 copied, 1 interpolated, 2 nearest corner, 3 split by a seam, 4 missing
    #[arg(long, requires = "from")]
    pub status: bool,
    /// Merge vertices of the meshes as `map --weld` does
    #[arg(long, requires = "from")]
    pub weld: bool,
    /// Cut their polygons as `map --triangulate` does
    #[arg(long, requires = "from")]
    pub triangulate: bool,
    /// Orient them as `map --orient` does
    #[arg(long, requires = "from")]
    pub orient: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo map testdata/meshes/face.obj --onto square -o face.homeo
  homeo verify face.homeo --source testdata/meshes/face.obj")]
pub struct VerifyArgs {
    /// The map
    #[arg(value_name = "MAP")]
    pub map: PathBuf,
    /// Also require that the map is about this very mesh
    #[arg(long, value_name = "MESH")]
    pub source: Option<PathBuf>,
    /// Merge vertices of that mesh as `map --weld` does
    #[arg(long, requires = "source")]
    pub weld: bool,
    /// Cut the polygons of that mesh as `map --triangulate` does
    #[arg(long, requires = "source")]
    pub triangulate: bool,
    /// Orient that mesh as `map --orient` does
    #[arg(long, requires = "source")]
    pub orient: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo map testdata/meshes/face.obj --onto disk -o face.homeo
  homeo report face.homeo -o face.html

The map is a foliation, a shell or one between polygons. The page shows source and image side by side with the
same pattern on both, the distortion, and level sets and leaves, or the layers and pillars of the shell; of a
hyperbolic structure it shows the fundamental domain, with lengths, angles and side pairings.")]
pub struct ReportArgs {
    /// The map, a shell, or a hyperbolic structure
    #[arg(value_name = "MAP")]
    pub map: PathBuf,
    /// The page to write
    #[arg(short, long, value_name = "FILE.html")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  homeo warp testdata/images/checker.png --from testdata/polygons/square.json --to testdata/polygons/arrow.json -o warped.png
  homeo warp testdata/points/star.csv --pair testdata/polygons/star_to_circle.json -o moved.csv --map star.homeo
  homeo warp testdata/images/checker.png --pair testdata/polygons/hole_turned.json --method mean-value -o smooth.png
  homeo warp testdata/points/star.csv --pair testdata/polygons/star_to_circle.json --method complex --degree 4 -o one_step.csv
  homeo warp testdata/meshes/spot.mesh --from testdata/cages/bar.obj --to testdata/cages/bar_twisted.obj -o twisted.vtu --map twisted.homeo
  homeo warp testdata/points/tent.csv --from testdata/cages/tent.obj --to testdata/cages/tent_leaning.obj -o moved.csv --map tent.homeo

Polygons are JSON lists [[x, y], ...]; with a hole {\"outer\": [...], \"inner\": [...]}, with several
{\"outer\": [...], \"holes\": [[...], ...]}; a pair is {\"source\": ..., \"target\": ...}. Or they are the shapes of an SVG drawing, in its order, in pixels. Vertices correspond by number. What lies outside the target becomes
transparent. With --landmarks the map is affine on the triangles between them; landmarks whose triangles
turn over would fold the picture and are refused by name. Cages are closed triangle meshes, and a mesh that moves with one is
checked exactly; of points that move with --map the smooth map of all of the inside is proved, which takes seconds for
ten triangles and many minutes for fifty. The map's certificate is checked before anything is written; `homeo verify` checks it again.")]
pub struct WarpArgs {
    /// A picture (PNG, JPEG; 8 or 16 bits, with opacity or without) or points of the plane (.csv, .npy); with cages a mesh or
    /// points in space
    #[arg(value_name = "INPUT")]
    pub input: PathBuf,
    /// Points and where they go, in place of polygons: a table with the columns x,y,u,v
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["pair", "from"])]
    pub landmarks: Option<PathBuf>,
    /// What has moved, in a format by its extension; a mesh with all its data
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Cages: steps at first [default: 1]
    #[arg(long, value_name = "N", value_parser = steps)]
    pub steps: Option<usize>,
    /// Cages: while the mesh is folded, or the map of points has no certificate, steps are doubled up to this [default: 64]
    #[arg(long, value_name = "N", value_parser = steps)]
    pub most_steps: Option<usize>,
    /// Keep the map with its certificate
    #[arg(long, value_name = "MAP.homeo")]
    pub map: Option<PathBuf>,
    /// How the inside follows [default: harmonic with polygons, mean-value with cages]
    #[arg(long, value_enum, value_name = "METHOD", conflicts_with = "landmarks")]
    pub method: Option<MethodName>,
    /// Complex maps: degree of the speeds along the edges, from 1 (linear) to 8 [default: 4]
    #[arg(long, value_name = "N", value_parser = degree)]
    pub degree: Option<usize>,
    /// What samples a picture: the processor, or a graphics processor (8 bits); maps are made and proved by the first
    #[cfg(feature = "gpu")]
    #[arg(long, value_enum, value_name = "DEVICE", default_value_t = DeviceName::Cpu)]
    pub device: DeviceName,
    #[command(flatten)]
    pub polygons: PolygonArgs,
    /// Save where every pixel of the result comes from, as float32 of shape (height, width, 2): what `remap` takes
    #[arg(long, value_name = "FIELD.npy")]
    pub field: Option<PathBuf>,
}

/// Polygons that move, and how a picture moves with them.
#[derive(Debug, Args)]
pub struct PolygonArgs {
    /// The polygon before it moves
    #[arg(long, value_name = "A.json", requires = "to", conflicts_with = "pair")]
    pub from: Option<PathBuf>,
    /// The polygon after it has moved
    #[arg(long, value_name = "B.json")]
    pub to: Option<PathBuf>,
    /// Both in one file
    #[arg(long, value_name = "PAIR.json")]
    pub pair: Option<PathBuf>,
    /// Where the polygons lie on a picture [default: pixels with --from, fit with --pair]
    #[arg(long, value_enum, value_name = "HOW")]
    pub coordinates: Option<Coordinates>,
    /// How a picture is read between its pixels
    #[arg(long, value_enum, value_name = "FILTER", default_value_t = FilterName::Bicubic)]
    pub filter: FilterName,
    /// Harmonic maps: about how many triangles they have on either side [default: 10000]
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub triangles: Option<usize>,
    /// Harmonic maps: the convex polygon between source and target [default: lengths]
    #[arg(long, value_enum, value_name = "SHAPE")]
    pub middle: Option<MiddleName>,
    /// Polygons with one hole, with --method mean-value any number: by how much the rim turns [default: the pair's `winding_hint`, or as little as possible]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub turn: Option<f64>,
    /// How polygons or cages move, for the frames of a morph and for mean value maps; cages: straight or angles
    #[arg(long, value_enum, value_name = "PATH", default_value_t = PathName::Auto)]
    pub path: PathName,
}

impl PolygonArgs {
    /// About how many triangles a harmonic map has on either side.
    pub fn triangles(&self) -> usize {
        self.triangles.unwrap_or(10_000)
    }

    /// The middle of a harmonic map.
    pub fn middle(&self) -> MiddleName {
        self.middle.unwrap_or(MiddleName::Lengths)
    }

    /// The first option that is given and says something of harmonic maps only.
    pub fn harmonic_option(&self) -> Option<&'static str> {
        let given = [("--triangles", self.triangles.is_some()), ("--middle", self.middle.is_some())];
        given.into_iter().find_map(|(name, is_given)| is_given.then_some(name))
    }
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  homeo morph testdata/images/checker.png --pair testdata/polygons/star_to_circle.json --frames 8 -o morph.gif
  homeo morph testdata/images/checker.png --pair testdata/polygons/hole_turned.json --frames 5 -o frame.png --separate

Each frame is the picture moved from the first polygon to one between both, by a map whose certificate was
checked. Where polygons in between cross themselves, there is no such frame: exit code 4.")]
pub struct MorphArgs {
    /// A picture (PNG, JPEG; 8 or 16 bits, with opacity or without)
    #[arg(value_name = "PICTURE")]
    pub input: PathBuf,
    #[command(flatten)]
    pub polygons: PolygonArgs,
    /// .gif (256 colours), .png (animated, all colours), or .json for the polygons in between
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// How many frames, the first and the last included
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub frames: u32,
    /// How long it takes, in seconds
    #[arg(long, value_name = "S", default_value_t = 2.0, value_parser = positive_seconds)]
    pub duration: f64,
    /// One file for each frame, numbered before the extension (.png or .jpg)
    #[arg(long)]
    pub separate: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:
  homeo blend testdata/polygons/ellipse.json testdata/polygons/bean.json --frames 9 -o blend.svg
  homeo blend testdata/polygons/ellipse.json testdata/polygons/bean.json --spline 24 -o splines.json

Curves are JSON lists [[x, y], ...] of samples, or a path of an SVG drawing, dense ones and as many as one likes; the first ones correspond.
Every curve between is closed; whether it meets itself is tested exactly, and said. With --spline each frame of the
.json also has \"spline\": {\"control\": [[x, y], ...], \"distance\": d}, the control points of a uniform closed cubic
B-spline and the greatest distance of a sample from it; whether curves meet themselves is still said of the samples. A
file of the form {\"control\": [[x, y], ...]} is such a spline itself.")]
pub struct BlendArgs {
    /// The first curve
    #[arg(value_name = "A.json")]
    pub from: PathBuf,
    /// The last curve
    #[arg(value_name = "B.json")]
    pub to: PathBuf,
    /// All curves: .json, or .svg for a drawing
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// How many curves, the first and the last included
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub frames: u32,
    /// Fit a closed cubic B-spline of N control points to each curve: written to .json, drawn in .svg as Bezier pieces
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "50", value_parser = control_points)]
    pub spline: Option<usize>,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  homeo hyperbolic testdata/hyperbolic/tripus.json -o tripus.homeo --report tripus.html
  homeo hyperbolic testdata/hyperbolic/census.json --entry dLQbcccdefo --json
  homeo hyperbolic --signature cPcbbbihq --picture tripus.glb --depth 1

INPUT is a record of glued tetrahedra (JSON), a file with an isomorphism signature, or a tetrahedral mesh of
a solid whose boundary has genus 2 or more everywhere. The vertices of a gluing are cut off and leave the boundary. The
metric is unique; lengths, angles and volume are printed with bounds. A triangulation that is proved to have none
gives exit code 3, one of which nothing is known exit code 4.")]
pub struct HyperbolicArgs {
    /// Glued tetrahedra (.json), an isomorphism signature in a file, or a tetrahedral mesh
    #[arg(value_name = "INPUT", required_unless_present = "signature", conflicts_with = "signature")]
    pub input: Option<PathBuf>,
    /// The isomorphism signature of a triangulation, in place of a file
    #[arg(long, value_name = "ISOSIG")]
    pub signature: Option<String>,
    /// Which record of a file with several, by the isoSig that it states
    #[arg(long, value_name = "ISOSIG", conflicts_with = "signature")]
    pub entry: Option<String>,
    /// The certificate to write
    #[arg(short, long, value_name = "OUT.homeo")]
    pub output: Option<PathBuf>,
    /// Write one self-contained HTML page with the fundamental domain
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
    /// Write the faces of the fundamental domain for other viewers (.glb or .gltf)
    #[arg(long, value_name = "OUT.glb")]
    pub picture: Option<PathBuf>,
    /// In which model of hyperbolic space the picture is
    #[arg(long, value_enum, value_name = "MODEL", default_value_t = ModelName::Ball)]
    pub model: ModelName,
    /// Show the universal cover up to so many faces away from the fundamental domain in the picture
    #[arg(long, value_name = "D", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=4))]
    pub depth: u8,
    /// Look for other triangulations of the manifold where a record is refused, as is always done for a mesh
    #[arg(long)]
    pub retriangulate: bool,
    /// Take the canonical decomposition, which depends on the manifold alone, as is done for a mesh where its cells are tetrahedra
    #[arg(long)]
    pub canonical: bool,
    /// How many other triangulations are tried for a metric before giving up; ten times as many for the canonical decomposition
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub tries: usize,
}

/// Models of hyperbolic space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModelName {
    /// The unit ball
    Ball,
    /// The upper half-space
    HalfSpace,
}

/// How the inside follows polygons or cages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Piecewise linear: polygons through a convex one, for every pair and with exact images; tetrahedra from their boundary
    Harmonic,
    /// Smooth: by mean value coordinates from one polygon or cage to the next on the way, as many as it takes
    MeanValue,
    /// Smooth, in one step, for polygons: mean value coordinates with speeds along the edges; exists for fewer pairs
    Complex,
}

/// How a polygon becomes another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PathName {
    /// The first that gives polygons which do not cross themselves: angles, straight, turning, simple; with a hole turning
    /// first
    Auto,
    /// Every vertex on a straight line
    Straight,
    /// Edge lengths and angles change evenly: turned parts turn and do not shrink
    Angles,
    /// Parts of the length change evenly, and turning angles nearly so: for dense samples of curves; no hole
    Curvature,
    /// Every ring turns about its middle, and changes straight in its turning frame
    Turning,
    /// Polygons never cross themselves; one hole at most
    Simple,
}

/// Where polygons lie on a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Coordinates {
    /// In pixels, right and down from the upper left corner
    Pixels,
    /// Both polygons in the middle of the picture, as large as they fit, y upwards
    Fit,
}

/// What samples pictures.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceName {
    Cpu,
    Gpu,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilterName {
    Linear,
    Bicubic,
    Lanczos,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MiddleName {
    /// On a circle, arcs by the averages of the edges' lengths
    Lengths,
    /// A regular polygon
    Regular,
    /// Begun as lengths, then moved so that the map keeps angles better; with one hole as lengths
    Optimized,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TargetName {
    Square,
    Disk,
    Cube,
    Ball,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Outside {
    /// An error that names the row
    Error,
    /// A row of NaN, and a count on standard error
    Nan,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("a number above 0 is needed".to_owned()),
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(angle) if (0.0..=180.0).contains(&angle) => Ok(angle),
        _ => Err("an angle between 0 and 180 degrees is needed".to_owned()),
    }
}

fn right_angle(text: &str) -> Result<f64, String> {
    degrees(text)
        .ok()
        .filter(|angle| *angle <= 90.0)
        .ok_or_else(|| "an angle between 0 and 90 degrees is needed".to_owned())
}

fn positive_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds <= 1e9 => Ok(seconds),
        _ => Err("a number of seconds above 0 is needed".to_owned()),
    }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|&n| n >= 1).ok_or_else(|| "a whole number from 1 on is needed".to_owned())
}

fn degree(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|n| (1..=8).contains(n)).ok_or_else(|| "a whole number from 1 to 8 is needed".to_owned())
}

fn control_points(text: &str) -> Result<usize, String> {
    let is_sensible = |n: &usize| (4..=2_000).contains(n);
    text.parse().ok().filter(is_sensible).ok_or_else(|| "a whole number from 4 to 2000 is needed".to_owned())
}

fn steps(text: &str) -> Result<usize, String> {
    let is_sensible = |n: &usize| (1..=100_000).contains(n);
    text.parse().ok().filter(is_sensible).ok_or_else(|| "a whole number from 1 to 100000 is needed".to_owned())
}

fn bytes(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.trim_end_matches(['B', 'b', 'i']) {
        short if short.ends_with(['K', 'k']) => (&short[..short.len() - 1], 1 << 10),
        short if short.ends_with(['M', 'm']) => (&short[..short.len() - 1], 1 << 20),
        short if short.ends_with(['G', 'g']) => (&short[..short.len() - 1], 1 << 30),
        short => (short, 1u64),
    };
    let count = digits.parse::<u64>().ok().filter(|&n| n > 0).and_then(|n| n.checked_mul(unit));
    count.ok_or_else(|| "a number of bytes above 0 is needed, such as 500M or 2G".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn amounts_are_numbers_or_shares() {
        assert_eq!("2%".parse::<Amount>().map(|amount| amount.of(1000)), Ok(20));
        assert_eq!("120".parse::<Amount>().map(|amount| amount.of(1000)), Ok(120));
        assert!(["-1", "101%", "%", "2 percent"].iter().all(|text| text.parse::<Amount>().is_err()));
    }

    #[test]
    fn sizes_have_units() {
        assert_eq!(bytes("2G"), Ok(2 << 30));
        assert_eq!(bytes("500MB"), Ok(500 << 20));
        assert_eq!(bytes("10KiB"), Ok(10 << 10));
        assert_eq!(bytes("12345"), Ok(12345));
        assert!(bytes("0").is_err() && bytes("G").is_err() && bytes("-1").is_err() && bytes("99999999999G").is_err());
    }
}
