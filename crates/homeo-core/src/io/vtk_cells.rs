//! The cells of VTK files, legacy and XML alike.

use super::build::{close_polygon, left_out};
use super::mesh_file::{Attribute, Element, MeshFile, Values};

/// What became of the cells of a file.
#[derive(Default)]
pub(super) struct Cells {
    /// The cell of each polygon and of each tetrahedron.
    polygon_cells: Vec<u32>,
    tetrahedron_cells: Vec<u32>,
    count: usize,
    points: usize,
    lines: usize,
    strips: usize,
}

/// A cell that cannot be taken.
pub(super) struct BadCell {
    pub code: &'static str,
    pub message: String,
    /// Which of its corners is wrong.
    pub corner: usize,
}

impl Cells {
    /// How many cells were pushed.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Makes room for `count` tetrahedra.
    pub fn reserve_tetrahedra(&mut self, count: usize, mesh: &mut MeshFile) {
        mesh.tetrahedra.reserve_exact(count);
        self.tetrahedron_cells.reserve_exact(count);
    }

    /// Adds a cell by its VTK type; its corners must be below `vertices`.
    pub fn push(&mut self, kind: i64, corners: &[u32], vertices: usize, mesh: &mut MeshFile) -> Result<(), BadCell> {
        let cell = self.count;
        let bad = |code, message: String| BadCell { code, message, corner: 0 };
        if let Some(corner) = corners.iter().position(|&index| index as usize >= vertices) {
            let index = match corners[corner] {
                u32::MAX => "an index that does not fit 32 bits".to_string(),
                index => format!("vertex {index}"),
            };
            let message = format!("cell {cell} names {index}, but there are {vertices} vertices, numbered from 0");
            return Err(BadCell { code: "index-out-of-range", message, corner });
        }
        let needs = |count: usize| match corners.len() {
            found if found == count => Ok(()),
            found => {
                Err(bad("bad-syntax", format!("cell {cell} of type {kind} has {found} corners instead of {count}")))
            }
        };
        if mesh.polygons.corners.len() + 3 * corners.len() >= u32::MAX as usize || cell >= u32::MAX as usize {
            return Err(bad("too-large", "there are more cells than 32 bits can number".to_string()));
        }
        match kind {
            0 => {}
            1 | 2 => self.points += 1,
            3 | 4 => self.lines += 1,
            5 | 8 | 9 => needs(if kind == 5 { 3 } else { 4 })?,
            10 => needs(4)?,
            6 | 7 if corners.len() < 3 => {
                let message = format!("cell {cell} has {} corners; it needs at least three", corners.len());
                return Err(bad("too-few-corners", message));
            }
            6 | 7 => {}
            _ => return Err(bad("unsupported-element", unsupported(cell, kind))),
        }
        match (kind, corners) {
            (5 | 7 | 9, _) => self.push_polygon(corners, mesh),
            (8, &[a, b, c, d]) => self.push_polygon(&[a, b, d, c], mesh),
            (10, &[a, b, c, d]) => {
                mesh.tetrahedra.push([a, b, c, d]);
                self.tetrahedron_cells.push(cell as u32);
            }
            (6, _) => self.push_strip(corners, mesh),
            _ => {}
        }
        self.count += 1;
        Ok(())
    }

    fn push_polygon(&mut self, corners: &[u32], mesh: &mut MeshFile) {
        mesh.polygons.corners.extend_from_slice(corners);
        close_polygon(&mut mesh.polygons);
        self.polygon_cells.push(self.count as u32);
    }

    /// A strip is its triangles, every second one turned round.
    fn push_strip(&mut self, corners: &[u32], mesh: &mut MeshFile) {
        self.strips += 1;
        for (index, triple) in corners.windows(3).enumerate() {
            let &[a, b, c] = triple else { continue };
            self.push_polygon(&if index % 2 == 0 { [a, b, c] } else { [b, a, c] }, mesh);
        }
    }

    /// The parts of an attribute of cells on polygons and on tetrahedra.
    pub fn split(&self, name: &str, components: usize, values: Values) -> Vec<Attribute> {
        let of = |element, values| Attribute { name: name.to_string(), element, components, values };
        if self.tetrahedron_cells.len() == self.count {
            return vec![of(Element::Tetrahedron, values)];
        }
        if self.polygon_cells.len() == self.count && self.strips == 0 {
            return vec![of(Element::Polygon, values)];
        }
        let whole = of(Element::Polygon, values);
        let mut parts = Vec::new();
        for (element, cells) in
            [(Element::Polygon, &self.polygon_cells), (Element::Tetrahedron, &self.tetrahedron_cells)]
        {
            if !cells.is_empty() {
                parts.push(Attribute { element, ..whole.gathered(cells) });
            }
        }
        parts
    }

    /// Sentences on what was left out or changed.
    pub fn losses(&self) -> Vec<String> {
        let mut losses = Vec::new();
        losses.extend((self.points > 0).then(|| left_out(self.points, "point cell", "point cells")));
        losses.extend((self.lines > 0).then(|| left_out(self.lines, "line cell", "line cells")));
        losses.extend((self.strips > 0).then(|| format!("{} triangle strips were cut into triangles", self.strips)));
        losses
    }
}

fn unsupported(cell: usize, kind: i64) -> String {
    let name = match kind {
        11 => "a voxel",
        12 => "an 8-node hexahedron",
        13 => "a 6-node wedge",
        14 => "a 5-node pyramid",
        15 | 16 => "a prism",
        21 => "a 3-node edge",
        22 => "a 6-node triangle",
        23 => "an 8-node quadrilateral",
        24 => "a 10-node tetrahedron",
        25 => "a 20-node hexahedron",
        26 => "a 15-node wedge",
        27 => "a 13-node pyramid",
        28 => "a 9-node quadrilateral",
        29 => "a 27-node hexahedron",
        30..=37 => "an element of second order",
        42 => "a polyhedron",
        51..=67 => "an element of higher order",
        68..=82 => "a Lagrange or Bezier element",
        _ => "of a type that is not known",
    };
    format!("cell {cell} is {name} (VTK type {kind}); homeo reads triangles, polygons and 4-node tetrahedra")
}
