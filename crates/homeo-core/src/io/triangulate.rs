//! Cutting polygons into triangles, on request only.

use super::mesh_file::{Attribute, Element, MeshFile, PolygonList, Values};

/// A mesh whose polygons are triangles, and where they come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangulated {
    /// The mesh; vertices and tetrahedra are those of the original, in the same order.
    pub mesh: MeshFile,
    /// For each triangle the polygon it was cut from.
    pub polygon_of_triangle: Vec<u32>,
}

impl MeshFile {
    /// The same mesh with every polygon of more than three corners cut into a fan of triangles
    /// around its corner of lowest vertex index.
    ///
    /// The choice depends on indices only, never on coordinates, so a polygon is cut in the same way
    /// in every mesh with this connectivity. The union of the triangles is the polygon where it is
    /// planar and convex. Triangles keep the order of their polygons; attributes of polygons and
    /// corners are carried over.
    ///
    /// # Example
    /// ```
    /// use homeo_core::io::{Format, read_mesh_bytes};
    /// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 1\n";
    /// let quad = read_mesh_bytes(Format::Obj, "quad.obj".as_ref(), text)?;
    /// let cut = quad.triangulated();
    /// assert_eq!(cut.mesh.polygons.polygon(0), [0, 1, 2]);
    /// assert_eq!(cut.mesh.polygons.polygon(1), [0, 2, 3]);
    /// assert_eq!(cut.polygon_of_triangle, [0, 0]);
    /// # Ok::<(), homeo_core::io::ReadError>(())
    /// ```
    pub fn triangulated(&self) -> Triangulated {
        let corners = fan_corners(&self.polygons);
        let polygon_of_triangle: Vec<u32> = corners.iter().map(|&(_, polygon)| polygon).collect();
        let old_corners: Vec<u32> = corners.iter().flat_map(|&(corners, _)| corners).collect();
        let attributes = self.attributes.iter().map(|attribute| match attribute.element {
            Element::Polygon => attribute.gathered(&polygon_of_triangle),
            Element::Corner => attribute.gathered(&old_corners),
            Element::Vertex | Element::Tetrahedron => attribute.clone(),
        });
        let starts = if polygon_of_triangle.is_empty() { 0..0 } else { 0..old_corners.len() as u32 + 1 };
        let polygons = PolygonList {
            starts: starts.step_by(3).collect(),
            corners: old_corners.iter().map(|&corner| self.polygons.corners[corner as usize]).collect(),
        };
        let mesh = MeshFile {
            positions: self.positions.clone(),
            vertex_count: self.vertex_count,
            space: self.space,
            polygons,
            tetrahedra: self.tetrahedra.clone(),
            attributes: attributes.collect(),
            names: self.names.clone(),
            material_libraries: self.material_libraries.clone(),
            losses: self.losses.clone(),
        };
        Triangulated { mesh, polygon_of_triangle }
    }
}

impl Attribute {
    /// The rows at `indices`, in that order.
    pub(super) fn gathered(&self, indices: &[u32]) -> Self {
        fn rows<T: Clone>(values: &[T], indices: &[u32], components: usize) -> Vec<T> {
            let mut gathered = Vec::with_capacity(indices.len() * components);
            for &index in indices {
                let start = index as usize * components;
                gathered.extend_from_slice(&values[start..start + components]);
            }
            gathered
        }
        let values = match &self.values {
            Values::F64(values) => Values::F64(rows(values, indices, self.components)),
            Values::F32(values) => Values::F32(rows(values, indices, self.components)),
            Values::I64(values) => Values::I64(rows(values, indices, self.components)),
            Values::Text(values) => Values::Text(rows(values, indices, self.components)),
        };
        Self { name: self.name.clone(), element: self.element, components: self.components, values }
    }
}

/// The triangles of all fans by vertices, each with its polygon.
pub(super) fn fan_triangles(polygons: &PolygonList) -> Vec<([u32; 3], u32)> {
    let vertices = |corners: [u32; 3]| corners.map(|corner| polygons.corners[corner as usize]);
    fan_corners(polygons).into_iter().map(|(corners, polygon)| (vertices(corners), polygon)).collect()
}

/// The triangles of all fans by corners, each with its polygon; a triangle stays as it is.
fn fan_corners(polygons: &PolygonList) -> Vec<([u32; 3], u32)> {
    let mut triangles = Vec::with_capacity(polygons.corners.len().saturating_sub(2 * polygons.len()));
    for (index, pair) in polygons.starts.windows(2).enumerate() {
        let (start, count) = (pair[0], pair[1] - pair[0]);
        if count == 3 {
            triangles.push(([start, start + 1, start + 2], index as u32));
            continue;
        }
        let vertices = &polygons.corners[pair[0] as usize..pair[1] as usize];
        let apex = (0..count).min_by_key(|&corner| vertices[corner as usize]).unwrap_or(0);
        // Widened: the sum of two corner numbers may exceed 32 bits.
        let corner = |step: u32| start + ((u64::from(apex) + u64::from(step)) % u64::from(count)) as u32;
        triangles.extend(
            (1..count.saturating_sub(1)).map(|step| ([apex + start, corner(step), corner(step + 1)], index as u32)),
        );
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_of_polygons_and_corners_follow_their_triangles() {
        let mut polygons = PolygonList::default();
        polygons.push(&[5, 3, 4]);
        polygons.push(&[4, 2, 0, 1, 3]);
        let attribute = |name: &str, element, values| Attribute { name: name.into(), element, components: 1, values };
        let mesh = MeshFile {
            positions: vec![[0.0; 3]; 6],
            vertex_count: 6,
            space: 3,
            polygons,
            attributes: vec![
                attribute("tag", Element::Polygon, Values::I64(vec![7, 8])),
                attribute("corner", Element::Corner, Values::I64((0..8).collect())),
            ],
            ..MeshFile::default()
        };
        let Triangulated { mesh, polygon_of_triangle } = mesh.triangulated();
        assert_eq!(mesh.check(), Ok(()));
        assert_eq!(polygon_of_triangle, [0, 1, 1, 1]);
        assert_eq!(mesh.polygons.corners, [5, 3, 4, 0, 1, 3, 0, 3, 4, 0, 4, 2]);
        assert_eq!(mesh.attributes[0].values, Values::I64(vec![7, 8, 8, 8]));
        assert_eq!(mesh.attributes[1].values, Values::I64(vec![0, 1, 2, 5, 6, 7, 5, 7, 3, 5, 3, 4]));
    }
}
