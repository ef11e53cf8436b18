//! Pulse widths that the autopilot puts out.

use crate::sitl::Firmware;
use crate::units::whole;
use crate::vehicle::{Actuator, PwmRange, Vehicle as Description};

/// ArduPilot's MOT_SPIN_MIN and MOT_SPIN_MAX.
pub(super) const SPIN: (f64, f64) = (0.15, 0.95);
/// PX4's PWM_MAIN_DISn.
const PX4_OFF_US: f64 = 900.0;

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
            let span_us = (max_us - min_us) / (SPIN.1 - SPIN.0);
            Self { min_us, max_us, off_us: min_us - SPIN.0 * span_us }
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
