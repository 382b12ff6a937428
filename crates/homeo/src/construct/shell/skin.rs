//! The skin of a shell: its bottoms, its tops and the walls over its boundary.
//!
//! A shell whose skin does not cross or touch itself, and is covered once at one point of each of its components, does not
//! overlap itself (docs/theory/shells.md). The skin changes with every operation, so its index does too.

use homeo_core::predicate::{triangles_meet, triangles_meet_beyond_edge, triangles_meet_beyond_vertex};
use rstar::{AABB, RTree, RTreeObject};

use super::prism::{Column, is_pinched, sides};

type Point = [f64; 3];

/// What a triangle of the skin belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// It is bottom or top of a prism.
    Prism(u32),
    /// It is one of the triangles over the side of a prism in the boundary.
    Wall(u32),
}

impl Owner {
    /// The prism that can be made thinner.
    pub fn prism(self) -> u32 {
        match self {
            Self::Prism(prism) | Self::Wall(prism) => prism,
        }
    }
}

/// A triangle of the skin.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Face {
    pub owner: Owner,
    /// The slab to which it belongs.
    pub slab: usize,
    /// Column and level; of a pinched column the middle one.
    names: [(u32, u8); 3],
    points: [Point; 3],
}

impl RTreeObject for Face {
    type Envelope = AABB<Point>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_points(&self.points)
    }
}

impl Face {
    fn new(owner: Owner, slab: usize, corners: [(u32, u8); 3], columns: &[Column]) -> Self {
        let named = |(column, level): (u32, u8)| {
            if is_pinched(columns[column as usize]) { (column, 1) } else { (column, level) }
        };
        let points = corners.map(|(column, level)| columns[column as usize][level as usize]);
        Self { owner, slab, names: corners.map(named), points }
    }

    /// Bottom and top of a prism.
    pub fn caps(prism: u32, corners: [u32; 3], columns: &[Column]) -> [Self; 2] {
        [0, 1].map(|slab| {
            let level = 2 * slab as u8;
            Self::new(Owner::Prism(prism), slab, corners.map(|column| (column, level)), columns)
        })
    }

    /// The triangles over the side of a prism from column `a` to column `b`, for either diagonal.
    pub fn walls(prism: u32, [a, b]: [u32; 2], columns: &[Column]) -> Vec<Self> {
        let of_slab = |slab: usize| {
            let (low, high) = (slab as u8, slab as u8 + 1);
            let quad = [(a, low), (b, low), (b, high), (a, high)];
            let cut = (0..4).map(move |n| [1, 2, 3].map(|k| quad[(n + k) % 4]));
            cut.map(move |corners| Self::new(Owner::Wall(prism), slab, corners, columns))
        };
        let is_triangle = |face: &Self| {
            let [a, b, c] = face.names;
            a != b && b != c && c != a
        };
        (0..2).flat_map(of_slab).filter(is_triangle).collect()
    }

    /// Whether two triangles meet in more than the corners that they have in common. Bottom and top of one prism do not, by
    /// L2, nor do the walls over one side but where they are meant to.
    fn clashes(&self, other: &Self) -> bool {
        if self.owner == other.owner {
            return false;
        }
        let common: Vec<[usize; 2]> = (0..3)
            .flat_map(|k| (0..3).map(move |l| [k, l]))
            .filter(|&[k, l]| self.names[k] == other.names[l])
            .collect();
        let rest = |points: [Point; 3], k: usize| [points[(k + 1) % 3], points[(k + 2) % 3]];
        match common[..] {
            [] => triangles_meet(self.points, other.points),
            [[k, l]] => triangles_meet_beyond_vertex(self.points[k], rest(self.points, k), rest(other.points, l)),
            [[k, l], [m, n]] => triangles_meet_beyond_edge(
                [self.points[k], self.points[m]],
                self.points[3 - k - m],
                other.points[3 - l - n],
            ),
            _ => true,
        }
    }
}

/// All triangles of the skin, to be asked which of them meet others.
pub(super) struct Skin {
    tree: RTree<Face>,
    /// Bottom and top of each prism, as they are in the tree.
    caps: Vec<Option<[Face; 2]>>,
}

impl Skin {
    /// The skin of the given prisms, with the boundary sides of each.
    pub fn new(prisms: &[[u32; 3]], columns: &[Column], is_boundary: impl Fn([u32; 2]) -> bool) -> Self {
        let caps: Vec<Option<[Face; 2]>> =
            (0u32..).zip(prisms).map(|(prism, &corners)| Some(Face::caps(prism, corners, columns))).collect();
        let walls = (0u32..).zip(prisms).flat_map(|(prism, &corners)| {
            let sides = sides(corners).into_iter().filter(|&side| is_boundary(side));
            sides.flat_map(move |side| Face::walls(prism, side, columns)).collect::<Vec<_>>()
        });
        let faces = caps.iter().flatten().flatten().cloned().chain(walls).collect();
        Self { tree: RTree::bulk_load(faces), caps }
    }

    /// The triangles that meet others where they should not.
    pub fn clashing(&self) -> impl Iterator<Item = &Face> {
        self.tree.iter().filter(|face| self.near(face).any(|other| face.clashes(other)))
    }

    fn near(&self, face: &Face) -> impl Iterator<Item = &Face> {
        self.tree.locate_in_envelope_intersecting(face.envelope())
    }

    /// Whether bottoms and tops can take the place of those of the prisms `old`.
    pub fn admits(&self, old: &[u32], new: &[[Face; 2]]) -> bool {
        let goes = |other: &&Face| matches!(other.owner, Owner::Prism(prism) if old.contains(&prism));
        let faces: Vec<&Face> = new.iter().flatten().collect();
        let is_free = |face: &Face| !self.near(face).any(|other| !goes(&other) && face.clashes(other));
        let are_apart = |(k, face): (usize, &&Face)| !faces[..k].iter().any(|other| face.clashes(other));
        faces.iter().all(|face| is_free(face)) && faces.iter().enumerate().all(are_apart)
    }

    /// Puts them there.
    pub fn replace(&mut self, old: &[u32], new: Vec<[Face; 2]>) {
        for &prism in old {
            for face in self.caps[prism as usize].take().into_iter().flatten() {
                let removed = self.tree.remove(&face);
                debug_assert!(removed.is_some(), "what is listed is in the tree");
            }
        }
        for caps in new {
            caps.iter().for_each(|face| self.tree.insert(face.clone()));
            let prism = caps[0].owner.prism();
            self.caps[prism as usize] = Some(caps);
        }
    }
}
