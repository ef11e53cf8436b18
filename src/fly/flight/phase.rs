//! The phases of a flight.

use super::checking::Checking;
use super::leaving::Leaving;

/// A phase of the flight.
#[derive(Debug)]
pub(super) enum Phase {
    /// search for the vehicle
    Connect,
    /// checks before the flight
    Check(Checking),
    /// setpoints before OFFBOARD
    Prime,
    /// our mode is ordered; the vehicle is in the mode in which it was found
    Engage,
    /// in our mode, until the estimator is good
    Ready,
    /// arming is ordered
    Arm,
    /// climb from the ground
    Climb,
    /// transfer to the begin of the course
    Transfer,
    /// until it hovers there
    Gate,
    /// the trajectory
    Course,
    /// hold, landing or return, in the vehicle's own mode
    Leave(Leaving),
    /// nothing is received: nothing is sent until something is
    Lost,
    /// hands off
    Watch,
    /// over
    Done,
}

impl Phase {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Connect => "connect",
            Self::Check(_) => "check",
            Self::Prime => "stream",
            Self::Engage => "engage",
            Self::Ready => "ready",
            Self::Arm => "arm",
            Self::Climb => "take off",
            Self::Transfer => "go to start",
            Self::Gate => "start gate",
            Self::Course => "trajectory",
            Self::Leave(leaving) => leaving.name(),
            Self::Lost => "link lost",
            Self::Watch => "hands off",
            Self::Done => "over",
        }
    }

    /// Whether our mode is engaged and we send setpoints.
    pub(super) fn is_ours(&self) -> bool {
        matches!(self, Self::Ready | Self::Arm | Self::Climb | Self::Transfer | Self::Gate | Self::Course)
    }

    /// Whether the vehicle may be off the ground by our orders.
    pub(super) fn is_airborne(&self) -> bool {
        matches!(
            self,
            Self::Climb
                | Self::Transfer
                | Self::Gate
                | Self::Course
                | Self::Leave(_)
                | Self::Lost
                | Self::Watch
        )
    }
}
