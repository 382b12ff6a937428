//! A surface that changes: triangles on vertices, with the triangles round each vertex.

use homeo_core::mesh::SimplicialComplex;

use crate::construct::shell::prism::sides;
use crate::input::SourceMesh;

type Point = [f64; 3];

/// See the module's documentation. Numbers of triangles and vertices that went away are not used again.
pub(super) struct Surface {
    pub positions: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    pub exists: Vec<bool>,
    /// The triangles at each vertex.
    pub around: Vec<Vec<u32>>,
    /// How many triangles exist.
    pub count: usize,
}

impl Surface {
    pub fn new(mesh: &SourceMesh<3>) -> Self {
        let triangles: Vec<[u32; 3]> = mesh.complex().cells().iter().map(|cell| cell.map(|v| v.raw())).collect();
        let mut around = vec![Vec::new(); mesh.positions().len()];
        for (t, corners) in (0..).zip(&triangles) {
            corners.iter().for_each(|&v| around[v as usize].push(t));
        }
        let count = triangles.len();
        Self { positions: mesh.positions().to_vec(), exists: vec![true; count], triangles, around, count }
    }

    pub fn point(&self, vertex: u32) -> Point {
        self.positions[vertex as usize]
    }

    pub fn points(&self, triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| self.point(v))
    }

    /// All triangles that exist, ascending.
    pub fn existing(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.triangles.len() as u32).filter(|&t| self.exists[t as usize])
    }

    /// Vertices that share a triangle with the given one, ascending.
    pub fn neighbours(&self, vertex: u32) -> Vec<u32> {
        let corners = self.around[vertex as usize].iter().flat_map(|&t| self.triangles[t as usize]);
        let mut found: Vec<u32> = corners.filter(|&other| other != vertex).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The triangle in which `to` follows `from`, if there is one.
    pub fn left_of(&self, from: u32, to: u32) -> Option<u32> {
        let runs = |t: &u32| sides(self.triangles[*t as usize]).contains(&[from, to]);
        self.around[from as usize].iter().copied().find(runs)
    }

    /// Both triangles of an edge: that in which `b` follows `a`, and the other one. `None` for boundary edges.
    pub fn both_sides(&self, a: u32, b: u32) -> Option<[u32; 2]> {
        Some([self.left_of(a, b)?, self.left_of(b, a)?])
    }

    /// The corner of a triangle that is neither `a` nor `b`.
    pub fn third(&self, triangle: u32, a: u32, b: u32) -> Option<u32> {
        self.triangles[triangle as usize].into_iter().find(|&v| v != a && v != b)
    }

    /// All edges with the lower number first, by triangles.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let all = self.existing().flat_map(|t| sides(self.triangles[t as usize]));
        let mut edges: Vec<[u32; 2]> = all.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Link condition: whether the edge can be collapsed and leaves a surface. The edge is to have two triangles, and at
    /// least one end off the boundary.
    pub fn can_collapse(&self, a: u32, b: u32) -> bool {
        let (first, second) = (self.neighbours(a), self.neighbours(b));
        let common = first.iter().filter(|v| second.binary_search(v).is_ok()).count();
        // Of a tetrahedron nothing may be taken away.
        common == 2 && first.len() + second.len() > 6 && self.both_sides(a, b).is_some()
    }

    pub fn remove(&mut self, triangle: u32) {
        for v in self.triangles[triangle as usize] {
            self.around[v as usize].retain(|&other| other != triangle);
        }
        self.count -= usize::from(std::mem::replace(&mut self.exists[triangle as usize], false));
    }

    /// Puts a triangle in the place of one that was removed, or after the last one.
    pub fn put(&mut self, triangle: u32, corners: [u32; 3]) {
        if triangle as usize == self.triangles.len() {
            self.triangles.push(corners);
            self.exists.push(false);
        }
        self.triangles[triangle as usize] = corners;
        self.exists[triangle as usize] = true;
        self.count += 1;
        corners.iter().for_each(|&v| self.around[v as usize].push(triangle));
    }

    /// Moves a vertex, or adds it if its number is the next one.
    pub fn place(&mut self, vertex: u32, point: Point) {
        if vertex as usize == self.positions.len() {
            self.positions.push(point);
            self.around.push(Vec::new());
        }
        self.positions[vertex as usize] = point;
    }

    /// A vertex whose triangles do not form one circle or path round it, or an edge of it with other than one or two
    /// triangles that run along it in opposite directions.
    pub fn singular_vertex(&self) -> Option<u32> {
        (0..self.around.len() as u32).find(|&v| !self.around[v as usize].is_empty() && !self.is_fan(v))
    }

    fn is_fan(&self, vertex: u32) -> bool {
        // Each triangle is an arrow of the vertex's link, from one neighbour to the next.
        let arrow = |&t: &u32| {
            let corners = self.triangles[t as usize];
            let k = corners.iter().position(|&v| v == vertex)?;
            let [a, b] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            (a != b && a != vertex && b != vertex).then_some([a, b])
        };
        let arrows: Option<Vec<[u32; 2]>> = self.around[vertex as usize].iter().map(arrow).collect();
        let Some(arrows) = arrows else { return false };
        let are_distinct = |end: usize| {
            let mut ends: Vec<u32> = arrows.iter().map(|arrow| arrow[end]).collect();
            ends.sort_unstable();
            ends.windows(2).all(|pair| pair[0] != pair[1])
        };
        if !are_distinct(0) || !are_distinct(1) {
            return false;
        }
        // From the start of the path, or from anywhere in a circle, all arrows are met.
        let first = arrows.iter().find(|arrow| arrows.iter().all(|other| other[1] != arrow[0])).unwrap_or(&arrows[0]);
        let mut here = first[0];
        let mut met = 0;
        while let Some(arrow) = arrows.iter().find(|arrow| arrow[0] == here).filter(|_| met < arrows.len()) {
            here = arrow[1];
            met += 1;
        }
        met == arrows.len()
    }

    /// The surface with vertices numbered anew, and for each of its triangles the number that it has here.
    pub fn finished(&self) -> (SourceMesh<3>, Vec<u32>) {
        let mut number = vec![u32::MAX; self.positions.len()];
        let mut positions = Vec::new();
        for v in (0..number.len()).filter(|&v| !self.around[v].is_empty()) {
            number[v] = positions.len() as u32;
            positions.push(self.positions[v]);
        }
        let kept: Vec<u32> = self.existing().collect();
        let corners = |&t: &u32| self.triangles[t as usize].map(|v| number[v as usize].into());
        let complex = SimplicialComplex::new(positions.len(), kept.iter().map(corners).collect());
        (SourceMesh::new(positions, complex.expect("every vertex of a triangle has a number")), kept)
    }
}
