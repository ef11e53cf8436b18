//! Which software flies.

/// Which software flies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Autopilot {
    /// not said in the recording (CSV)
    #[default]
    Unknown,
    /// PX4
    Px4,
    /// ArduPilot
    ArduPilot,
    /// another MAVLink autopilot
    Other,
}
