//! The states on which a residual may depend.

use crate::vehicle::AXIS_NAMES;

/// A state on which a residual may depend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Followed {
    /// world z, m
    Altitude,
    /// world x, m
    WorldX,
    /// world y, m
    WorldY,
    /// velocity through the air along a body axis (0 x, 1 y, 2 z), m/s
    Airspeed(usize),
    /// its norm, m/s
    Speed,
    /// commanded thrust of all rotors, N
    Thrust,
    /// N/s
    ThrustRate,
    /// commanded thrust of one rotor, N
    Rotor(usize),
    /// V
    Voltage,
    /// s, vehicle clock
    Time,
    /// sine of the yaw angle (-)
    YawSin,
    /// cosine of the yaw angle (-)
    YawCos,
    /// body rate about x, y, z, rad/s; about z it is the yaw rate
    Rate(usize),
    /// rate of change of the torque about x, y, z that the motion needs, N m/s; no residual is searched along it
    TorqueRate(usize),
}

impl Followed {
    /// As in JSON; rotors count from 1.
    #[must_use]
    pub fn name(self) -> String {
        let axis = |axis: usize| AXIS_NAMES.get(axis).copied().unwrap_or("?");
        match self {
            Self::Altitude => "world_z".into(),
            Self::WorldX => "world_x".into(),
            Self::WorldY => "world_y".into(),
            Self::Airspeed(along) => format!("airspeed_{}", axis(along)),
            Self::Speed => "airspeed".into(),
            Self::Thrust => "thrust".into(),
            Self::ThrustRate => "thrust_rate".into(),
            Self::Rotor(rotor) => format!("rotor_{}", rotor + 1),
            Self::Voltage => "voltage".into(),
            Self::Time => "time".into(),
            Self::YawSin => "yaw_sin".into(),
            Self::YawCos => "yaw_cos".into(),
            Self::Rate(about) => format!("rate_{}", axis(about)),
            Self::TorqueRate(about) => format!("torque_rate_{}", axis(about)),
        }
    }

    /// SI
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Altitude | Self::WorldX | Self::WorldY => "m",
            Self::Airspeed(_) | Self::Speed => "m/s",
            Self::Thrust | Self::Rotor(_) => "N",
            Self::ThrustRate => "N/s",
            Self::Voltage => "V",
            Self::Time => "s",
            Self::YawSin | Self::YawCos => "-",
            Self::Rate(_) => "rad/s",
            Self::TorqueRate(_) => "N m/s",
        }
    }

    /// Whether a state is of the commands: their own noise is in the residual as well, which then follows them.
    pub(in crate::diagnose) fn is_commanded(self) -> bool {
        matches!(self, Self::Thrust | Self::ThrustRate | Self::Rotor(_))
    }

    /// Whether a state is slow: each value occurs once in a flight, so periods are not replicates of it.
    pub(in crate::diagnose) fn is_slow(self) -> bool {
        matches!(self, Self::Time | Self::Voltage)
    }
}
