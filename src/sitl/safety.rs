//! What the failsafes know.

use std::time::Duration;

use super::Mode;
use super::battery::Charge;
use super::fence::Breach;

/// What the failsafes know.
#[derive(Debug)]
pub(super) struct Safety {
    /// a pilot holds the sticks
    pub(super) transmitter: bool,
    pub(super) last_setpoint: Option<Duration>,
    pub(super) setpoints_lost: bool,
    pub(super) ground_seen: Option<Duration>,
    pub(super) ground_lost: bool,
    pub(super) position_lost: bool,
    pub(super) charge: Charge,
    pub(super) breach: Breach,
    /// PX4: another failsafe than that of setpoints flies, until a mode is chosen
    pub(super) overrides: bool,
    /// PX4: the mode that a failsafe continues to when it has held
    pub(super) later: Option<(Duration, Mode)>,
    /// PX4: the fence's action has begun and no mode was chosen since
    pub(super) fence_acts: bool,
}

impl Safety {
    pub(super) fn new(transmitter: bool) -> Self {
        Self {
            transmitter,
            last_setpoint: None,
            setpoints_lost: false,
            ground_seen: None,
            ground_lost: false,
            position_lost: false,
            charge: Charge::Ok,
            breach: Breach::default(),
            overrides: false,
            later: None,
            fence_acts: false,
        }
    }

    pub(super) fn setpoint_came(&mut self, now: Duration) {
        self.last_setpoint = Some(now);
    }

    pub(super) fn pilot_is_there(&mut self) {
        self.transmitter = true;
    }

    pub(super) fn has_transmitter(&self) -> bool {
        self.transmitter
    }

    /// A mode was chosen: what was lost in the one before no longer matters.
    pub(super) fn mode_chosen(&mut self) {
        self.setpoints_lost = false;
        self.overrides = false;
        self.later = None;
        self.fence_acts = false;
    }

    pub(super) fn disarmed(&mut self) {
        self.mode_chosen();
        self.position_lost = false;
    }

    pub(super) fn charge(&self) -> Charge {
        self.charge
    }

    /// Some failsafe is active. ArduPilot counts a low battery among them, whatever BATT_FS_LOW_ACT makes of it.
    pub(super) fn is_active(&self, px4: bool) -> bool {
        let charge = if px4 { Charge::Critical } else { Charge::Low };
        self.setpoints_lost || self.position_lost || self.overrides || self.charge >= charge
    }
}
