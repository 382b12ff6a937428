//! Names of places: what has one name is at one place, wherever it is seen from.
//!
//! Most corners of cells are recognized by their names, without any arithmetic. One place may have several names, where
//! surfaces touch in special position; then numbers decide.
//!
//! Why a name has one place: the sides of a cell that meet in a corner lie on different lines, as cells are strictly convex.
//! Two sides of one piece meet in a point of the surface: a vertex, the point where an edge crosses the plane of a face, or
//! that where the line of an edge of a tetrahedron crosses the triangle's plane. The projection of the surface is
//! one-to-one, so that point has one place, whichever piece it was found in. A side of the source and one of the section
//! cross in one point of the prism in which both are straight.

/// A point of a column, as a number: the column and its level.
pub(super) type Post = u32;

/// A side of a piece: 0 to 2 for the edge opposite to that corner of the triangle, 3 to 6 for the face opposite to that
/// corner, less 3, of the tetrahedron. A side on both counts as one on the edge.
pub(super) type Side = u8;

/// A point of a surface where its triangles and the tetrahedra are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Origin {
    Vertex(u32),
    /// Where an edge crosses a face.
    OnEdge([u32; 2], [Post; 3]),
    /// Where an edge of tetrahedra crosses a triangle.
    InTriangle(u32, [Post; 2]),
}

/// A straight line within a prism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Line {
    /// An edge, as it would go on in a tetrahedron of the prism.
    Edge([u32; 2], u8),
    /// Where a triangle crosses a face.
    Face(u32, [Post; 3]),
}

/// A name of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Name {
    Source(Origin),
    Section(Origin),
    /// A line of the source and one of the section: known in one prism only.
    Crossing(Line, Line),
}

/// The names of a corner, two at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Names([Option<Name>; 2]);

impl Names {
    /// Those of a point of a piece of the source, or of the section, or of both.
    pub fn of_corner(source: Option<Origin>, section: Option<Origin>) -> Option<Self> {
        let names = [source.map(Name::Source), section.map(Name::Section)];
        (names != [None, None]).then_some(Self(names))
    }

    /// That of a crossing.
    pub fn of_crossing(source: Option<Line>, section: Option<Line>) -> Self {
        Self([source.zip(section).map(|(source, section)| Name::Crossing(source, section)), None])
    }

    pub fn iter(self) -> impl Iterator<Item = Name> {
        self.0.into_iter().flatten()
    }
}

/// The triangle and the tetrahedron of a piece, by what is the same for its neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Maker {
    pub triangle: u32,
    /// The triangle's corners.
    pub vertices: [u32; 3],
    /// Which tetrahedron of the prism.
    pub tetrahedron: u8,
    /// Its corners.
    pub posts: [Post; 4],
}

impl Maker {
    /// The point of two sides that meet, of which none is a corner of the triangle unless both are edges.
    pub fn origin(&self, a: Side, b: Side) -> Origin {
        match (a.min(b), a.max(b)) {
            (a, b) if b < 3 => Origin::Vertex(self.vertices[usize::from(3 - a - b)]),
            (a, b) if a < 3 => Origin::OnEdge(self.edge(a), self.face(b)),
            (a, b) => Origin::InTriangle(self.triangle, self.posts_but([a - 3, b - 3])),
        }
    }

    /// The line of a side.
    pub fn line(&self, side: Side) -> Line {
        match side {
            0..3 => Line::Edge(self.edge(side), self.tetrahedron),
            _ => Line::Face(self.triangle, self.face(side)),
        }
    }

    fn edge(&self, opposite: Side) -> [u32; 2] {
        let k = usize::from(opposite);
        let [a, b] = [(k + 1) % 3, (k + 2) % 3].map(|k| self.vertices[k]);
        [a.min(b), a.max(b)]
    }

    fn face(&self, side: Side) -> [Post; 3] {
        self.posts_but([side - 3])
    }

    /// The corners of the tetrahedron but some, ascending.
    fn posts_but<const M: usize, const N: usize>(&self, without: [u8; M]) -> [Post; N] {
        let mut kept = (0..4u8).filter(|i| !without.contains(i)).map(|i| self.posts[usize::from(i)]);
        let mut posts = std::array::from_fn(|_| kept.next().unwrap_or_default());
        posts.sort_unstable();
        posts
    }
}
