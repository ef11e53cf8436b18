//! Whether ArduPilot's fence is in force in flight.

use super::Parameters;

/// State of the fence by FENCE_ENABLE and FENCE_AUTOENABLE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::fly) enum FenceSwitch {
    /// FENCE_ENABLE
    On,
    /// off now; FENCE_AUTOENABLE enables it at arming (3) or after takeoff (1 and 2)
    OnInFlight,
    /// stays off
    Off,
    /// this one did not answer, and the other does not enable it
    Unknown(&'static str),
}

impl FenceSwitch {
    /// From a vehicle's parameters. Copters before 4.6 have no FENCE_AUTOENABLE; where the vehicle says so, it is off.
    pub(in crate::fly) fn of(parameters: &Parameters) -> Self {
        let is_set = |name: &str| parameters.get(name).map(|value| value >= 0.5);
        let is_absent = parameters.absent.iter().any(|name| name == AUTO);
        match (is_set(NOW), is_set(AUTO)) {
            (Some(true), _) => Self::On,
            (_, Some(true)) => Self::OnInFlight,
            (None, _) => Self::Unknown(NOW),
            (Some(false), Some(false)) => Self::Off,
            (Some(false), None) if is_absent => Self::Off,
            (Some(false), None) => Self::Unknown(AUTO),
        }
    }
}

const NOW: &str = "FENCE_ENABLE";
const AUTO: &str = "FENCE_AUTOENABLE";
