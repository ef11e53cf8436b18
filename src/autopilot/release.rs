//! Releases of an autopilot.

use std::fmt;

/// Major and minor number of a release; later ones are greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Release {
    /// the 4 of 4.6
    pub major: u8,
    /// the 6 of 4.6
    pub minor: u8,
}

impl Release {
    /// A release by its two numbers.
    #[must_use]
    pub const fn new(major: u8, minor: u8) -> Self {
        Self { major, minor }
    }
}

impl fmt::Display for Release {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}
