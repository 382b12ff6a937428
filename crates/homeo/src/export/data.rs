//! What a report is made from.

use crate::map::ShellParts;

/// The shape that the map goes onto, with the coordinates in which images are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetShape {
    /// The square `[0, 1]²`.
    Square,
    /// The round disk of radius 1 about the origin.
    Disk,
    /// The cube `[0, 1]³`.
    Cube,
    /// The round ball of radius 1 about the origin.
    Ball,
    /// The middle surface of a shell, in the space of the source.
    Middle,
    /// Another section of a shell, in the space of the source.
    Section,
}

impl TargetShape {
    /// Dimension of the shape, 2 or 3.
    pub fn dimension(self) -> usize {
        match self {
            Self::Square | Self::Disk | Self::Middle | Self::Section => 2,
            Self::Cube | Self::Ball => 3,
        }
    }

    /// Dimension of the space that the shape is drawn in, 2 or 3.
    pub(super) fn space_dimension(self) -> usize {
        if self.is_in_shell() { 3 } else { self.dimension() }
    }

    /// Whether it is a surface in a shell.
    pub(super) fn is_in_shell(self) -> bool {
        matches!(self, Self::Middle | Self::Section)
    }

    /// The name in running text: `square`, `disk`, `cube`, `ball`, `middle surface`, `section`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Disk => "disk",
            Self::Cube => "cube",
            Self::Ball => "ball",
            Self::Middle => "middle surface",
            Self::Section => "section",
        }
    }
}

/// The verdict of the checker, in words that a reader without the theory understands.
#[derive(Clone, Debug, Default)]
pub struct VerdictWords {
    /// Whether the certificate was checked and holds.
    pub holds: bool,
    /// One sentence, the first thing that the page says.
    pub headline: String,
    /// What was proved, sentence by sentence (or, where it does not hold, what stands against it).
    pub sentences: Vec<String>,
    /// What was checked, and how many of it.
    pub checked: Vec<(String, u64)>,
    /// What is *not* claimed.
    pub limits: Vec<String>,
}

/// Cells of the source complex: triangles for a two-dimensional target, tetrahedra for a three-dimensional one.
#[derive(Clone, Debug)]
pub enum CellList {
    /// Triangles by their vertices.
    Triangles(Vec<[u32; 3]>),
    /// Tetrahedra by their vertices, with `det(b - a, c - a, d - a) > 0`.
    Tetrahedra(Vec<[u32; 4]>),
}

impl CellList {
    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Triangles(cells) => cells.len(),
            Self::Tetrahedra(cells) => cells.len(),
        }
    }

    /// Whether there is no cell.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Dimension of the cells, 2 or 3.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Triangles(_) => 2,
            Self::Tetrahedra(_) => 3,
        }
    }

    /// The cells as slices of vertices.
    pub(super) fn iter(&self) -> Box<dyn Iterator<Item = &[u32]> + '_> {
        match self {
            Self::Triangles(cells) => Box::new(cells.iter().map(<[u32; 3]>::as_slice)),
            Self::Tetrahedra(cells) => Box::new(cells.iter().map(<[u32; 4]>::as_slice)),
        }
    }
}

/// The source mesh together with the image of each vertex.
#[derive(Clone, Debug)]
pub struct CellMesh {
    /// `#V` coordinates in the source, in the units of the input file.
    pub positions: Vec<[f64; 3]>,
    /// `#V` images in the target; the third coordinate is 0 for square and disk.
    pub images: Vec<[f64; 3]>,
    /// The cells.
    pub cells: CellList,
}

/// One leaf of the foliation as a polyline in the source and as a polyline in the target.
///
/// Where the two have equally many points, point `i` of one is shown as corresponding to point `i` of the
/// other; otherwise points correspond by their share of the polyline's length.
#[derive(Clone, Debug, Default)]
pub struct Leaf {
    /// Points in the source.
    pub source: Vec<[f64; 3]>,
    /// Points in the target.
    pub target: Vec<[f64; 3]>,
}

/// What a report on a shell shows besides the projection.
#[derive(Clone, Debug)]
pub struct ShellPicture {
    /// Layers and prisms.
    pub parts: ShellParts,
    /// For each cell the prism that it lies in.
    pub prism_of_cell: Vec<u32>,
    /// For each vertex its place on the middle surface.
    pub middle_of_vertex: Vec<[f64; 3]>,
    /// How many triangles the image has.
    pub image_triangles: usize,
}

/// All that a report shows. Nothing in it is computed by the report except pictures and statistics.
#[derive(Clone, Debug)]
pub struct ReportData {
    /// Heading, for example `spot_low_tg.mesh onto the cube`.
    pub title: String,
    /// A line below the heading, for example the construction and the program's version.
    pub subtitle: String,
    /// The target.
    pub target: TargetShape,
    /// What was proved and what was not.
    pub verdict: VerdictWords,
    /// Label and value, shown as a table in this order.
    pub facts: Vec<(String, String)>,
    /// Stage and its wall-clock seconds, shown as bars in this order. A stage named `total` is the sum line.
    pub stage_seconds: Vec<(String, f64)>,
    /// Mesh and images.
    pub cells: CellMesh,
    /// Some leaves; may be empty.
    pub leaves: Vec<Leaf>,
    /// For each cell the ratio (at least 1) of the largest to the smallest singular value of the linear map
    /// on it; infinite where the cell collapses. Empty where it was not computed.
    pub distortion: Vec<f64>,
    /// With the targets [`TargetShape::Middle`] and [`TargetShape::Section`] the shell; otherwise nothing.
    pub shell: Option<ShellPicture>,
}

impl ReportData {
    /// The first contradiction in the data, in words.
    pub(super) fn check(&self) -> Result<(), String> {
        let mesh = &self.cells;
        let vertices = mesh.positions.len();
        if mesh.images.len() != vertices {
            return Err(format!("{vertices} vertices but {} images", mesh.images.len()));
        }
        if mesh.cells.dimension() != self.target.dimension() {
            let (have, name) = (mesh.cells.dimension(), self.target.name());
            return Err(format!("cells of dimension {have} cannot be mapped onto the {name}"));
        }
        if mesh.cells.is_empty() {
            return Err("the mesh has no cells".into());
        }
        if !self.distortion.is_empty() && self.distortion.len() != mesh.cells.len() {
            return Err(format!("{} cells but {} distortions", mesh.cells.len(), self.distortion.len()));
        }
        for (cell, corners) in mesh.cells.iter().enumerate() {
            if let Some(missing) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
                return Err(format!("cell {cell} names vertex {missing}, but there are {vertices} vertices"));
            }
        }
        for (what, points) in [("position", &mesh.positions), ("image", &mesh.images)] {
            if let Some(vertex) = first_not_finite(points) {
                return Err(format!("the {what} of vertex {vertex} is not finite"));
            }
        }
        for (index, leaf) in self.leaves.iter().enumerate() {
            if first_not_finite(&leaf.source).or(first_not_finite(&leaf.target)).is_some() {
                return Err(format!("leaf {index} has a coordinate that is not finite"));
            }
        }
        match &self.shell {
            None if self.target.is_in_shell() => Err(format!("there is a {}, but no shell", self.target.name())),
            Some(_) if !self.target.is_in_shell() => {
                Err(format!("there is a shell, but the target is the {}", self.target.name()))
            }
            Some(shell) => shell.check(mesh.cells.len(), vertices),
            None => Ok(()),
        }
    }
}

impl ShellPicture {
    fn check(&self, cells: usize, vertices: usize) -> Result<(), String> {
        let ShellParts { bottom, middle, top, prisms, .. } = &self.parts;
        if bottom.len() != middle.len() || top.len() != middle.len() {
            return Err("the layers differ in the number of their points".into());
        }
        if let Some(prism) = prisms.iter().position(|columns| columns.iter().any(|&v| v as usize >= middle.len())) {
            return Err(format!("prism {prism} has a column that does not exist"));
        }
        if self.prism_of_cell.len() != cells {
            return Err(format!("{cells} cells, but the prisms of {}", self.prism_of_cell.len()));
        }
        if let Some(cell) = self.prism_of_cell.iter().position(|&prism| prism as usize >= prisms.len()) {
            return Err(format!("cell {cell} lies in a prism that does not exist"));
        }
        if self.middle_of_vertex.len() != vertices {
            return Err(format!(
                "{vertices} vertices, but the places on the middle surface of {}",
                self.middle_of_vertex.len()
            ));
        }
        if let Some(vertex) = first_not_finite(&self.middle_of_vertex) {
            return Err(format!("the place of vertex {vertex} on the middle surface is not finite"));
        }
        match [bottom, middle, top].into_iter().find_map(|points| first_not_finite(points)) {
            Some(column) => Err(format!("column {column} has a coordinate that is not finite")),
            None => Ok(()),
        }
    }
}

/// Index of the first point with a coordinate that is NaN or infinite.
fn first_not_finite(points: &[[f64; 3]]) -> Option<usize> {
    points.iter().position(|point| point.iter().any(|coordinate| !coordinate.is_finite()))
}
