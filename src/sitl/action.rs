//! What a failsafe does.

use super::Mode;

/// What a failsafe does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    /// says so and goes on
    Warn,
    /// changes to this mode
    Enter(Mode),
    /// shows this mode but nobody holds the sticks: descends where it is
    Descend(Mode),
    /// rotors off
    Terminate,
}
