//! The connections of a vehicle, and what each is taken for.

/// Which connection of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub usize);

/// What PX4 takes whoever is at the other end for; ArduPilot makes no difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkRole {
    /// port 14550: attitude, position, servo outputs at 50 Hz, no inertial unit
    GroundStation,
    /// port 14540: what a companion computer needs
    Onboard,
}
