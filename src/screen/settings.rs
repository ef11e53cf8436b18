//! How a log is screened.

use crate::draft::Given;

/// How a log is screened.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScreenSettings {
    /// mass, and size and frame if the log's parameters do not have them; `None`: no effect is searched
    pub vehicle: Option<Given>,
    /// how much of the log is used
    pub bounds: Bounds,
}

/// How much of a log is used. Time and memory grow with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// longest log, bytes
    pub bytes: usize,
    /// stamps and values of flight that are held; each takes eight bytes
    pub numbers: usize,
    /// instants of flight in which effects are searched; their rate is that of the log's inertial unit, up to 500 a second
    pub searched: usize,
}

impl Default for Bounds {
    /// Without a search of effects, a tenth of a second of one core; with it, at most some two seconds.
    fn default() -> Self {
        Self { bytes: 64 << 20, numbers: 600_000, searched: 3000 }
    }
}
