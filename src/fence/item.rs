//! One item of a mission of type fence.

use crate::frames::Geodetic;

/// MAV_CMD_NAV_FENCE_*: corner of a polygon to stay in.
pub const POLYGON_INSIDE: u16 = 5001;
/// Corner of a polygon to stay out of.
pub const POLYGON_OUTSIDE: u16 = 5002;
/// A circle to stay in.
pub const CIRCLE_INSIDE: u16 = 5003;
/// A circle to stay out of.
pub const CIRCLE_OUTSIDE: u16 = 5004;

/// One item of a mission of type fence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FenceItem {
    /// MAV_CMD_NAV_FENCE_*
    pub command: u16,
    /// corners of its polygon, or radius in m
    pub parameter: f64,
    /// a corner, or the centre
    pub place: Geodetic,
}
