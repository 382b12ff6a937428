//! Making one vertex of those at the same point, on request only.

use std::collections::HashMap;

use super::mesh_file::{Attribute, Element, MeshFile, Values};

/// How many pairs of vertices a [`WeldReport`] lists as examples.
const MOST_EXAMPLES: usize = 10;

/// What [`MeshFile::weld`] did. Vertices and elements are numbered as before, unless said otherwise.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WeldReport {
    /// How many vertices became an earlier one.
    pub merged: usize,
    /// The first ten of them, each as the vertex it became and itself.
    pub examples: Vec<[u32; 2]>,
    /// For each vertex its number afterwards.
    pub new_vertices: Vec<u32>,
    /// Vertex attributes of which values were lost, in the mesh's order.
    pub differing: Vec<DifferingAttribute>,
    /// Polygons that name a vertex twice now and did not before, ascending.
    pub collapsed_polygons: Vec<u32>,
    /// Tetrahedra that name a vertex twice now and did not before, ascending.
    pub collapsed_tetrahedra: Vec<u32>,
}

/// A vertex attribute whose values differed between vertices that became one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DifferingAttribute {
    /// Its name.
    pub name: String,
    /// How many vertices lost a value that the vertex they became does not have.
    pub vertices: usize,
    /// The first of these vertices, after the vertex it became.
    pub first: [u32; 2],
}

impl MeshFile {
    /// Makes one vertex of all that elements use at exactly the same point: the first of them.
    ///
    /// # Guarantee
    /// Coordinates are compared bit for bit, but for 0 and -0, which are equal; no tolerance is
    /// involved. The other vertices keep their order, as all elements do. A vertex that no element
    /// uses stays as it is, whatever its point. Data of corners (texture coordinates with seams), of
    /// polygons and of tetrahedra is untouched. Of data on vertices the values of the first vertex
    /// stay, and each attribute that loses other values by this is reported. An element that names a
    /// vertex twice afterwards is reported, not dropped. A mesh without coordinates does not change.
    ///
    /// # Complexity
    /// Linear in the size of the mesh, but for a sort of the corners of large polygons.
    ///
    /// # Example
    /// ```
    /// use homeo_core::io::{Format, read_mesh_bytes};
    /// // Two triangles that touch along a side without a common vertex.
    /// let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    /// let mut mesh = read_mesh_bytes(Format::Obj, "two.obj".as_ref(), text)?;
    /// let report = mesh.weld();
    /// assert_eq!((report.merged, report.examples), (2, vec![[1, 3], [2, 5]]));
    /// assert_eq!(mesh.polygons.corners, [0, 1, 2, 1, 3, 2]);
    /// # Ok::<(), homeo_core::io::ReadError>(())
    /// ```
    pub fn weld(&mut self) -> WeldReport {
        let plan = Plan::new(self);
        if plan.pairs.is_empty() {
            return WeldReport { new_vertices: plan.new_vertices, ..WeldReport::default() };
        }
        let on_vertices = self.attributes.iter_mut().filter(|attribute| attribute.element == Element::Vertex);
        let mut differing = Vec::new();
        for attribute in on_vertices {
            differing.extend(difference(attribute, &plan.pairs));
            *attribute = attribute.gathered(&plan.kept);
        }
        self.positions = plan.kept.iter().map(|&vertex| self.positions[vertex as usize]).collect();
        self.vertex_count = plan.kept.len();
        WeldReport {
            merged: plan.pairs.len(),
            collapsed_polygons: self.renumber_polygons(&plan.new_vertices),
            collapsed_tetrahedra: self.renumber_tetrahedra(&plan.new_vertices),
            examples: plan.pairs.into_iter().take(MOST_EXAMPLES).collect(),
            new_vertices: plan.new_vertices,
            differing,
        }
    }

    /// Renumbers the corners of polygons; returns the polygons that name a vertex twice by it.
    fn renumber_polygons(&mut self, new_vertices: &[u32]) -> Vec<u32> {
        let mut collapsed = Vec::new();
        for (index, pair) in self.polygons.starts.windows(2).enumerate() {
            let corners = &mut self.polygons.corners[pair[0] as usize..pair[1] as usize];
            let was_proper = !has_repeats(corners);
            corners.iter_mut().for_each(|corner| *corner = new_vertices[*corner as usize]);
            if was_proper && has_repeats(corners) {
                collapsed.push(index as u32);
            }
        }
        collapsed
    }

    /// Renumbers the vertices of tetrahedra; returns the tetrahedra that name a vertex twice by it.
    fn renumber_tetrahedra(&mut self, new_vertices: &[u32]) -> Vec<u32> {
        let mut collapsed = Vec::new();
        for (index, cell) in self.tetrahedra.iter_mut().enumerate() {
            let was_proper = !has_repeats(cell);
            *cell = cell.map(|vertex| new_vertices[vertex as usize]);
            if was_proper && has_repeats(cell) {
                collapsed.push(index as u32);
            }
        }
        collapsed
    }
}

/// Which vertices become which.
struct Plan {
    /// The vertices that stay, ascending.
    kept: Vec<u32>,
    /// For each vertex its number afterwards.
    new_vertices: Vec<u32>,
    /// The vertices that go, ascending, each after the one it becomes.
    pairs: Vec<[u32; 2]>,
}

impl Plan {
    fn new(mesh: &MeshFile) -> Self {
        let is_used = used_vertices(mesh);
        let mut first_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
        let mut plan =
            Self { kept: Vec::new(), new_vertices: Vec::with_capacity(mesh.vertex_count), pairs: Vec::new() };
        for vertex in 0..mesh.vertex_count as u32 {
            let position = mesh.positions.get(vertex as usize).filter(|_| is_used[vertex as usize]);
            // Adding 0 turns -0 into 0 and changes nothing else.
            let key = position.map(|position| position.map(|x| (x + 0.0).to_bits()));
            let first = key.map_or(vertex, |key| *first_at.entry(key).or_insert(vertex));
            if first == vertex {
                plan.new_vertices.push(plan.kept.len() as u32);
                plan.kept.push(vertex);
            } else {
                plan.new_vertices.push(plan.new_vertices[first as usize]);
                plan.pairs.push([first, vertex]);
            }
        }
        plan
    }
}

fn used_vertices(mesh: &MeshFile) -> Vec<bool> {
    let mut is_used = vec![false; mesh.vertex_count];
    let corners = mesh.polygons.corners.iter().chain(mesh.tetrahedra.iter().flatten());
    corners.for_each(|&vertex| is_used[vertex as usize] = true);
    is_used
}

/// Whether a vertex occurs twice.
fn has_repeats(vertices: &[u32]) -> bool {
    // Elements have three or four vertices as a rule: nothing to allocate for.
    if vertices.len() <= 16 {
        return (1..vertices.len()).any(|i| vertices[..i].contains(&vertices[i]));
    }
    let mut sorted = vertices.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// What of an attribute is lost where the second of each pair becomes the first.
fn difference(attribute: &Attribute, pairs: &[[u32; 2]]) -> Option<DifferingAttribute> {
    let mut differing = pairs.iter().filter(|&&[kept, merged]| !has_equal_rows(attribute, kept, merged));
    let &first = differing.next()?;
    Some(DifferingAttribute { name: attribute.name.clone(), vertices: 1 + differing.count(), first })
}

/// Whether two rows say the same; an entry that is missing (NaN) equals another one that is.
fn has_equal_rows(attribute: &Attribute, first: u32, second: u32) -> bool {
    fn equal<T>(values: &[T], [a, b]: [usize; 2], width: usize, same: impl Fn(&T, &T) -> bool) -> bool {
        let (left, right) = (&values[a * width..(a + 1) * width], &values[b * width..(b + 1) * width]);
        left.iter().zip(right).all(|(x, y)| same(x, y))
    }
    let (rows, width) = ([first as usize, second as usize], attribute.components);
    match &attribute.values {
        Values::F64(values) => equal(values, rows, width, |x, y| x == y || (x.is_nan() && y.is_nan())),
        Values::F32(values) => equal(values, rows, width, |x, y| x == y || (x.is_nan() && y.is_nan())),
        Values::I64(values) => equal(values, rows, width, |x, y| x == y),
        Values::Text(values) => equal(values, rows, width, |x, y| x == y),
    }
}
