//! The bounds that an autopilot puts on the motion, and how hard it brakes.

/// What a limit bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name says what is bounded")]
pub enum Bounded {
    HorizontalSpeed,
    ClimbSpeed,
    DescentSpeed,
    HorizontalAcceleration,
    VerticalAcceleration,
    HorizontalJerk,
    VerticalJerk,
    Tilt,
    YawRate,
}

impl Bounded {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::HorizontalSpeed => "horizontal speed",
            Self::ClimbSpeed => "climb speed",
            Self::DescentSpeed => "descent speed",
            Self::HorizontalAcceleration => "horizontal acceleration",
            Self::VerticalAcceleration => "vertical acceleration",
            Self::HorizontalJerk => "horizontal jerk",
            Self::VerticalJerk => "vertical jerk",
            Self::Tilt => "tilt",
            Self::YawRate => "yaw rate",
        }
    }

    /// SI, but degrees for angles.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::HorizontalSpeed | Self::ClimbSpeed | Self::DescentSpeed => "m/s",
            Self::HorizontalAcceleration | Self::VerticalAcceleration => "m/s^2",
            Self::HorizontalJerk | Self::VerticalJerk => "m/s^3",
            Self::Tilt => "deg",
            Self::YawRate => "deg/s",
        }
    }
}

/// Parameters that say how hard a vehicle brakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Braking {
    /// acceleration in the plane
    pub horizontal: &'static str,
    /// acceleration up or down: the least of these
    pub vertical: &'static [&'static str],
    /// greatest tilt
    pub tilt: &'static str,
}
