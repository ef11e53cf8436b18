//! The phases of a flight.

use super::checking::Checking;
use super::leaving::Leaving;

/// Where in the flight.
#[derive(Debug)]
pub(super) enum Phase {
    /// until the vehicle is found
    Connect,
    /// until it may fly
    Check(Checking),
    /// setpoints before OFFBOARD
    Prime,
    /// our mode is asked for, of a vehicle that is in the one in which it was found
    Engage,
    /// in our mode, until the estimator is good
    Ready,
    /// arming is asked for
    Arm,
    /// up from the ground
    Climb,
    /// to where the course begins
    Transfer,
    /// until it stands still there
    Gate,
    /// along the trajectory
    Course,
    /// to hold, to the ground or home, in the vehicle's own mode
    Leave(Leaving),
    /// nothing is heard: nothing is sent until something is
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

    /// Our mode is engaged and setpoints are ours.
    pub(super) fn is_ours(&self) -> bool {
        matches!(self, Self::Ready | Self::Arm | Self::Climb | Self::Transfer | Self::Gate | Self::Course)
    }

    /// The vehicle may be off the ground by our doing.
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
