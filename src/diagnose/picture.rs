//! Which picture shows an effect.

use super::channels::AXES;
use super::followed::Followed;

/// The picture that shows an effect: what it does to one of these channels, over a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picture {
    /// the abscissa
    pub over: Over,
    /// channels on which it acts, of which the one with the largest part is shown: 0..2 force, 3..5 torque
    pub of: &'static [usize],
}

/// The abscissa of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// time
    Time,
    /// height over the ground
    Altitude,
    /// airspeed along the axis of the force
    Airspeed,
    /// airspeed along x for a torque about y, and along y for one about x
    AirspeedAcross,
    /// airspeed along body z
    AirspeedUp,
    /// its norm
    Speed,
    /// thrust of all rotors
    Thrust,
    /// thrust of the rotor that the effect is about
    OneRotor,
    /// voltage
    Voltage,
    /// body rate about the axis of the torque
    Rate,
    /// body rate about z
    YawRate,
    /// cosine of the heading for the force along x, sine for that along y
    Heading,
}

impl Picture {
    /// Over time, of every channel.
    pub const TIME: Self = Self { over: Over::Time, of: &[0, 1, 2, 3, 4, 5] };

    /// The same of these channels over something else.
    #[must_use]
    pub const fn of(of: &'static [usize], over: Over) -> Self {
        Self { over, of }
    }
}

impl Over {
    /// The state for a channel; `rotor` (from 0) is the one that the effect is about.
    pub(super) fn state(self, channel: usize, rotor: Option<usize>) -> Followed {
        let axis = (channel % AXES) % 3;
        match self {
            Self::Time => Followed::Time,
            Self::Altitude => Followed::Altitude,
            Self::Airspeed => Followed::Airspeed(axis),
            Self::AirspeedAcross => Followed::Airspeed(if axis == 0 { 1 } else { 0 }),
            Self::AirspeedUp => Followed::Airspeed(2),
            Self::Speed => Followed::Speed,
            Self::Thrust => Followed::Thrust,
            Self::OneRotor => rotor.map_or(Followed::Time, Followed::Rotor),
            Self::Voltage => Followed::Voltage,
            Self::Rate => Followed::Rate(axis),
            Self::YawRate => Followed::Rate(2),
            Self::Heading if axis == 0 => Followed::YawCos,
            Self::Heading => Followed::YawSin,
        }
    }
}
