//! Pulse widths that the autopilot puts out.

use crate::autopilot::ARDUPILOT;
use crate::sitl::Firmware;
use crate::units::whole;
use crate::vehicle::{Actuator, PwmRange, Vehicle as Description};

/// PX4's PWM_MAIN_DISn.
const PX4_OFF_US: f64 = 900.0;

/// ArduPilot's MOT_SPIN_MIN and MOT_SPIN_MAX: shares of the pulse range at none and at full command.
pub(super) fn spin() -> (f64, f64) {
    let default = |name| ARDUPILOT.parameters.find(name).and_then(|entry| entry.default).unwrap_or(0.0);
    (default("MOT_SPIN_MIN"), default("MOT_SPIN_MAX"))
}

/// Pulse widths that the autopilot puts out, microseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::sitl) struct Pulses {
    /// u = 0
    pub(in crate::sitl) min_us: f64,
    /// u = 1
    pub(in crate::sitl) max_us: f64,
    /// disarmed
    pub(in crate::sitl) off_us: f64,
}

impl Pulses {
    /// Those of the vehicle's file; where it has none the autopilot's defaults.
    pub(in crate::sitl) fn of(vehicle: &Description, autopilot: Firmware) -> Self {
        let stated = match vehicle.propulsion.actuator {
            Actuator::Pwm(range) => range,
            Actuator::Speed | Actuator::Thrust => None,
        };
        if autopilot.is_px4() {
            let PwmRange { min_us, max_us } = stated.unwrap_or(PwmRange { min_us: 1000.0, max_us: 2000.0 });
            Self { min_us, max_us, off_us: PX4_OFF_US.min(min_us) }
        } else {
            let PwmRange { min_us, max_us } = stated.unwrap_or(PwmRange { min_us: 1150.0, max_us: 1950.0 });
            let (none, full) = spin();
            let span_us = (max_us - min_us) / (full - none);
            Self { min_us, max_us, off_us: min_us - none * span_us }
        }
    }

    /// The pulse of a normalised output, whole microseconds.
    pub(in crate::sitl) fn pulse_us(&self, u: f64) -> u16 {
        u16::try_from(whole(self.min_us + u * (self.max_us - self.min_us))).unwrap_or(0)
    }

    /// The pulse of a disarmed output.
    pub(in crate::sitl) fn off_pulse_us(&self) -> u16 {
        u16::try_from(whole(self.off_us)).unwrap_or(0)
    }

    /// The normalised output of a pulse.
    pub(in crate::sitl) fn output(&self, pulse_us: u16) -> f64 {
        (f64::from(pulse_us) - self.min_us) / (self.max_us - self.min_us)
    }
}
