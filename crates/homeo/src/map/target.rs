//! The standard shapes.

use std::fmt;
use std::str::FromStr;

/// What a mesh is mapped onto.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// `[0, 1]^2`.
    Square,
    /// The unit disk; its exact form is the diamond `|x| + |y| <= 1`.
    Disk,
    /// `[0, 1]^3`.
    Cube,
    /// The unit ball; its exact form is the tetrahedron [`BALL_CORNERS`]` / 2`.
    Ball,
}

/// Twice the vertices of the tetrahedron that is the exact form of the ball (positively oriented).
pub const BALL_CORNERS: [[i32; 3]; 4] = [[1, 1, 1], [1, -1, -1], [-1, -1, 1], [-1, 1, -1]];

impl Target {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Square, Self::Disk, Self::Cube, Self::Ball];

    /// Its dimension, 2 or 3.
    pub fn dimension(self) -> usize {
        match self {
            Self::Square | Self::Disk => 2,
            Self::Cube | Self::Ball => 3,
        }
    }

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Disk => "disk",
            Self::Cube => "cube",
            Self::Ball => "ball",
        }
    }

    /// Whether leaves run to a centre.
    pub fn is_radial(self) -> bool {
        matches!(self, Self::Disk | Self::Ball)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is no target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not one of square, disk, cube, ball")]
pub struct UnknownTarget(pub String);

impl FromStr for Target {
    type Err = UnknownTarget;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::ALL.into_iter().find(|t| t.name() == text).ok_or_else(|| UnknownTarget(text.to_owned()))
    }
}
