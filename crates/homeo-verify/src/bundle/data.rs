//! Container rules of unit tangent bundles: which arrays there are, and the hash of the base.

use crate::archive::Archive;
use crate::manifest::{Manifest, Target};
use crate::map_file::source_hash;
use crate::npy::{Array, I8, U4};
use crate::verdict::{Unreadable, readable};

/// The arrays of a unit tangent bundle. Shapes are right; values are still unchecked.
pub(crate) struct BundleData {
    /// The vertices of the base.
    pub(crate) vertex_count: usize,
    /// The corners of the triangles of the base.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The number of edges of each fibre.
    pub(crate) layers: u32,
    /// The slopes of the walls over the sides of each triangle.
    pub(crate) slopes: Vec<[u32; 3]>,
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    /// With the target `unit-tangent-bundle-with-section`.
    pub(crate) section: Option<SectionData>,
}

/// The arrays of a section over the edges of the base.
pub(crate) struct SectionData {
    /// The level over each vertex of the base; the number of layers where there is none.
    pub(crate) levels: Vec<u32>,
    /// How many vertices each path has, and the vertices of all.
    pub(crate) path_lengths: Vec<u32>,
    pub(crate) path_vertices: Vec<u32>,
    /// The indices of the triangles, and of the vertices, of the base.
    pub(crate) triangle_indices: Vec<i64>,
    pub(crate) vertex_indices: Vec<i64>,
}

impl SectionData {
    fn read(archive: &mut Archive, vertices: usize, triangles: usize) -> Result<Self, Unreadable> {
        let mut numbers = |name, rows| Array::take(archive, name)?.read(U4, rows, 1);
        Ok(Self {
            levels: numbers("section_levels", Some(vertices))?,
            path_lengths: numbers("section_path_lengths", None)?,
            path_vertices: numbers("section_path_vertices", None)?,
            triangle_indices: Array::take(archive, "triangle_indices")?.read(I8, Some(triangles), 1)?,
            vertex_indices: Array::take(archive, "vertex_indices")?.read(I8, Some(vertices), 1)?,
        })
    }

    /// What rules T9 and T10 add to the claim.
    fn statement(&self) -> String {
        let singular = |indices: &[i64]| indices.iter().filter(|&&index| index != 0).count();
        format!(
            " The paths in the file give a section of it over the {} edges between vertices with a level; the section goes on over \
             the surface but for {} triangles and {} vertices, where it turns as often as their indices say; these add up to the \
             Euler characteristic.",
            self.path_lengths.len(),
            singular(&self.triangle_indices),
            singular(&self.vertex_indices)
        )
    }
}

impl BundleData {
    /// The claim in words.
    pub(crate) fn statement(&self, theorem: &str) -> String {
        let (tetrahedra, triangles) = (self.tetrahedra.len(), self.triangles.len());
        let section = self.section.as_ref().map(SectionData::statement).unwrap_or_default();
        format!(
            "The mesh of {tetrahedra} tetrahedra is a closed oriented 3-manifold, and a bundle of circles of {} edges over the \
             surface of {triangles} triangles in the file. Its Euler number is the Euler characteristic of the surface, so it \
             is isomorphic to the bundle of unit tangent vectors ({theorem}).{section}",
            self.layers
        )
    }

    /// Takes the arrays out of an archive.
    pub(crate) fn read(archive: &mut Archive, manifest: &Manifest) -> Result<Self, Unreadable> {
        let base = Array::take(archive, "base_triangles")?;
        let source = &manifest.source;
        let hash = source_hash([source.vertices, 3, source.cells], &[&base]);
        let triangles = base.read(U4, None, 3)?.as_chunks().0.to_vec();
        readable(triangles.len() == source.cells, "base_triangles has another number of rows than the manifest says")?;
        readable(hash == source.content_sha256, "base_triangles does not have the stated content_sha256")?;
        let layers = Array::take(archive, "layers")?.read(U4, Some(1), 1)?[0];
        let slopes = Array::take(archive, "slopes")?.read(U4, Some(triangles.len()), 3)?.as_chunks().0.to_vec();
        let tetrahedra = Array::take(archive, "tetrahedra")?.read(U4, None, 4)?.as_chunks().0.to_vec();
        let has_section = manifest.target == Target::UnitTangentBundleWithSection;
        let section = has_section.then(|| SectionData::read(archive, source.vertices, triangles.len())).transpose()?;
        Ok(Self { vertex_count: source.vertices, triangles, layers, slopes, tetrahedra, section })
    }
}
