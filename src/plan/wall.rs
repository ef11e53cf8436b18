//! The sides of a room: in words, and as a `[limits]` table has them.

use crate::vehicle::Limits;

/// A side of a room. The room lies evenly about its zero: one bound is for two opposite walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wall {
    /// along world x
    NorthOrSouth,
    /// along world y
    WestOrEast,
    /// below
    Floor,
    /// above
    Ceiling,
}

impl Wall {
    /// All sides, in the order of a `[limits]` table.
    pub const ALL: [Self; 4] = [Self::NorthOrSouth, Self::WestOrEast, Self::Floor, Self::Ceiling];

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::NorthOrSouth => "the wall to the north or south",
            Self::WestOrEast => "the wall to the west or east",
            Self::Floor => "the floor",
            Self::Ceiling => "the ceiling",
        }
    }

    /// Its key in a `[limits]` table.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::NorthOrSouth => "x_max_m",
            Self::WestOrEast => "y_max_m",
            Self::Floor => "z_min_m",
            Self::Ceiling => "z_max_m",
        }
    }

    /// Its distance from the zero of the room (m): to the side, or up. `None` where the limits do not state it.
    #[must_use]
    pub fn of(self, limits: &Limits) -> Option<f64> {
        match self {
            Self::NorthOrSouth => limits.x_max_m,
            Self::WestOrEast => limits.y_max_m,
            Self::Floor => limits.z_min_m,
            Self::Ceiling => limits.z_max_m,
        }
    }
}
