//! What is wrong with a mesh, in a form for programs and for people.

use serde::Serialize;

/// How many groups of elements a violation lists.
pub const MOST_LISTED: usize = 10;

/// Whether a violation keeps constructions from using the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// A construction that needs what is violated refuses the mesh.
    Error,
    /// Worth knowing; constructions go on.
    Warning,
    /// A property, not a fault: it matters where the opposite is asked for.
    Info,
}

/// What the elements of a violation are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ElementKind {
    /// Vertices.
    Vertex,
    /// Edges, each by its two vertices.
    Edge,
    /// Triangles of a volume mesh, each by its three vertices.
    Facet,
    /// Triangles of a surface, tetrahedra of a volume.
    Cell,
    /// Pairs of cells.
    CellPair,
    /// Triangles of the boundary of a volume in pairs, six vertices for each pair.
    FacetPair,
    /// Nothing in particular.
    Mesh,
}

impl ElementKind {
    /// How many numbers name one element.
    pub fn width(self) -> usize {
        match self {
            Self::Vertex | Self::Cell => 1,
            Self::Edge | Self::CellPair => 2,
            Self::Facet => 3,
            Self::FacetPair => 6,
            Self::Mesh => 0,
        }
    }
}

/// One kind of fault and where it occurs.
///
/// | code | what it says |
/// |---|---|
/// | `positions-do-not-match` | there are coordinates, but not one point for each vertex |
/// | `coordinate-out-of-range` | not finite, or magnitude outside `2^-300..2^300`: signs would not be exact |
/// | `extreme-scale` | (warning) tiny, huge, or far from the origin for its size |
/// | `repeated-vertex` | a cell names a vertex twice |
/// | `duplicate-cell` | the same vertices as an earlier cell |
/// | `degenerate-cell` | area or volume zero, exactly |
/// | `inverted-cell` | a tetrahedron of negative volume |
/// | `non-manifold-facet` | a triangle of more than two tetrahedra |
/// | `non-manifold-edge` | the cells around an edge form more than one fan |
/// | `non-manifold-vertex` | the same for a vertex, where no edge or facet at it is to blame |
/// | `inconsistent-orientation` | neighbours turn opposite ways |
/// | `non-orientable` | no choice of turns is consistent |
/// | `isolated-vertex` | (warning) a vertex of no cell |
/// | `coincident-vertices` | (warning) vertices at one point |
/// | `several-components` | (warning) the mesh falls apart |
/// | `inside-out` | (warning) a closed surface whose normals point inwards |
/// | `open-boundary` | (info) a surface that is not closed |
/// | `self-intersection` | triangles that meet where they have no common vertex or edge |
/// | `no-cells` | there is nothing but vertices |
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Violation {
    /// The stable name of the fault.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// What `elements` are.
    pub kind: ElementKind,
    /// The first of the elements, each as [`ElementKind::width`] numbers.
    pub elements: Vec<u32>,
    /// How many elements there are in all.
    pub count: usize,
    /// What is wrong and what to do about it.
    pub message: String,
}

/// All violations of a mesh, in the order in which they were looked for.
#[derive(Default)]
pub(super) struct Violations(Vec<Violation>);

impl Violations {
    /// Adds a violation, unless `groups` is empty. `advice` says what is wrong with them and what to
    /// do; the elements are named in front of it.
    pub(super) fn add<const WIDTH: usize>(
        &mut self,
        code: &'static str,
        severity: Severity,
        kind: ElementKind,
        groups: &[[u32; WIDTH]],
        advice: &str,
    ) {
        self.add_counted(code, severity, kind, groups, groups.len(), advice);
    }

    /// Same, where `groups` are only some of `count` elements.
    pub(super) fn add_counted<const WIDTH: usize>(
        &mut self,
        code: &'static str,
        severity: Severity,
        kind: ElementKind,
        groups: &[[u32; WIDTH]],
        count: usize,
        advice: &str,
    ) {
        debug_assert_eq!(kind.width(), WIDTH);
        if count == 0 {
            return;
        }
        let listed = &groups[..groups.len().min(MOST_LISTED)];
        self.0.push(Violation {
            code,
            severity,
            kind,
            elements: listed.iter().flatten().copied().collect(),
            count,
            message: format!("{}: {advice}", named(kind, listed, count)),
        });
    }

    /// Adds a violation of the mesh as a whole.
    pub(super) fn add_general(&mut self, code: &'static str, severity: Severity, count: usize, message: String) {
        self.0.push(Violation { code, severity, kind: ElementKind::Mesh, elements: Vec::new(), count, message });
    }

    pub(super) fn into_vec(self) -> Vec<Violation> {
        self.0
    }
}

/// The names of the first three elements, and how many more there are.
fn named<const WIDTH: usize>(kind: ElementKind, listed: &[[u32; WIDTH]], count: usize) -> String {
    let (one, many, inner) = match kind {
        ElementKind::Vertex => ("vertex", "vertices", ""),
        ElementKind::Edge => ("edge", "edges", "-"),
        ElementKind::Facet => ("facet", "facets", "-"),
        ElementKind::Cell => ("cell", "cells", ""),
        ElementKind::CellPair => ("cells", "pairs of cells", " and "),
        ElementKind::FacetPair => ("boundary triangles", "pairs of boundary triangles", "-"),
        ElementKind::Mesh => ("mesh", "mesh", ""),
    };
    let name = |group: &[u32; WIDTH]| {
        let join = |part: &[u32]| part.iter().map(u32::to_string).collect::<Vec<_>>().join(inner);
        if kind == ElementKind::FacetPair {
            format!("{} and {}", join(&group[..WIDTH / 2]), join(&group[WIDTH / 2..]))
        } else {
            join(group)
        }
    };
    let names: Vec<_> = listed.iter().take(3).map(name).collect();
    if count == 1 {
        format!("{one} {}", names.join(", "))
    } else {
        let more = if count > names.len() { ", ..." } else { "" };
        format!("{count} {many} ({}{more})", names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_named_and_counted() {
        let mut violations = Violations::default();
        violations.add::<1>("isolated-vertex", Severity::Warning, ElementKind::Vertex, &[], "never said");
        violations.add("isolated-vertex", Severity::Warning, ElementKind::Vertex, &[[7]], "in no cell");
        let edges: Vec<[u32; 2]> = (0..12).map(|i| [i, i + 1]).collect();
        violations.add("non-manifold-edge", Severity::Error, ElementKind::Edge, &edges, "split it");
        let list = violations.into_vec();
        assert_eq!(list[0].message, "vertex 7: in no cell");
        assert_eq!(list[1].message, "12 edges (0-1, 1-2, 2-3, ...): split it");
        assert_eq!((list[1].count, list[1].elements.len()), (12, 20));
    }
}
