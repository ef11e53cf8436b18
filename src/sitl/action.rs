//! What a failsafe does.

use super::Mode;
use crate::autopilot::Reaction;

/// What a failsafe does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    /// says so and continues
    Warn,
    /// changes to this mode
    Enter(Mode),
    /// shows this mode but nobody holds the sticks: descends where it is
    Descend(Mode),
    /// rotors off
    Terminate,
}

impl Action {
    /// PX4's way to do it.
    pub(super) fn of_px4(reaction: Reaction) -> Self {
        Self::of(reaction, Mode::Hold)
    }

    /// ArduPilot's way to do it. It has no smart return here: it returns as it can.
    pub(super) fn of_ardupilot(reaction: Reaction) -> Self {
        Self::of(reaction, Mode::Brake)
    }

    fn of(reaction: Reaction, hold: Mode) -> Self {
        match reaction {
            Reaction::Nothing => Self::Warn,
            Reaction::Hold => Self::Enter(hold),
            Reaction::Return => Self::Enter(Mode::Return),
            Reaction::Land => Self::Enter(Mode::Land),
            Reaction::Position => Self::Descend(Mode::Position),
            Reaction::Altitude => Self::Descend(Mode::Altitude),
            Reaction::Stabilized => Self::Descend(Mode::Stabilize),
            Reaction::StopMotors => Self::Terminate,
        }
    }
}
