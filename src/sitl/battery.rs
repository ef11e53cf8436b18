//! A battery that falls linearly while the rotors turn.

use mavlink::dialects::ardupilotmega::MavBatteryChargeState;

use super::Settings;

/// Share of the first voltage that is gone when the battery is empty.
const SPAN: f64 = 0.25;

/// How full it is to its autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Charge {
    /// enough
    Ok,
    /// land soon
    Low,
    /// land now
    Critical,
}

impl Charge {
    /// In BATTERY_STATUS.
    pub(super) fn mav(self) -> MavBatteryChargeState {
        match self {
            Self::Ok => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK,
            Self::Low => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW,
            Self::Critical => MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_CRITICAL,
        }
    }
}

/// Where an autopilot draws the lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Thresholds {
    /// share of the capacity that remains
    Remaining {
        /// at most this is low
        low: f64,
        /// and this critical
        critical: f64,
    },
    /// voltage
    Volts {
        /// at most this is low
        low: f64,
        /// and this critical
        critical: f64,
    },
}

/// The battery.
#[derive(Debug, Clone, Copy)]
pub(super) struct Battery {
    full_v: f64,
    drop_v_s: f64,
    volts: f64,
}

impl Battery {
    pub(super) fn new(settings: &Settings) -> Self {
        Self { full_v: settings.battery_v, drop_v_s: settings.battery_drop_v_s, volts: settings.battery_v }
    }

    pub(super) fn volts(&self) -> f64 {
        self.volts
    }

    /// Voltage of a battery of `full_v` (V) that holds this share of its charge.
    pub(super) fn volts_at(full_v: f64, remaining: f64) -> f64 {
        full_v * (1.0 - SPAN * (1.0 - remaining))
    }

    /// Share of the charge that remains.
    pub(super) fn remaining(&self) -> f64 {
        (1.0 - (1.0 - self.volts / self.full_v) / SPAN).clamp(0.0, 1.0)
    }

    pub(super) fn set_remaining(&mut self, remaining: f64) {
        self.volts = Self::volts_at(self.full_v, remaining.clamp(0.0, 1.0));
    }

    /// Falls for a while, s.
    pub(super) fn drain(&mut self, time_s: f64) {
        self.volts = (self.volts - self.drop_v_s * time_s).max(0.0);
    }

    pub(super) fn charge(&self, thresholds: &Thresholds) -> Charge {
        let (value, low, critical) = match thresholds {
            Thresholds::Remaining { low, critical } => (self.remaining(), low, critical),
            Thresholds::Volts { low, critical } => (self.volts, low, critical),
        };
        if value <= *critical {
            Charge::Critical
        } else if value <= *low {
            Charge::Low
        } else {
            Charge::Ok
        }
    }
}
