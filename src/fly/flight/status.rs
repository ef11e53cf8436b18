//! Status of a flight for a display.

use std::time::Duration;

use super::phase::Phase;
use super::state::Flight;
use crate::fly::health::BatteryLevel;
use crate::fly::safety::Lead;

/// A stall is shown for so long.
pub(super) const STALL_SHOWN: Duration = Duration::from_secs(5);

/// Status for a display.
#[derive(Debug, Clone, PartialEq)]
pub struct Status {
    /// name of the phase
    pub phase: &'static str,
    /// off the ground by our orders
    pub airborne: bool,
    /// ended before its time
    pub aborted: bool,
    /// s along the trajectory, and all of it
    pub progress_s: Option<(f64, f64)>,
    /// the vehicle's mode by its name
    pub mode: Option<String>,
    /// motors may turn
    pub armed: bool,
    /// period flown, of how many
    pub period: (u32, u32),
    /// distance to the reference, m
    pub tracking_m: f64,
    /// time since the vehicle was heard, s
    pub link_age_s: Option<f64>,
    /// how long this program or its computer stood still, s; `None` if it did not lately
    pub stall_s: Option<f64>,
    /// low or worse by the autopilot's own judgement
    pub battery_is_low: bool,
    /// percent
    pub battery_percent: Option<i8>,
    /// V
    pub battery_v: Option<f64>,
    /// x, y, z, m, world, local
    pub position_m: Option<[f64; 3]>,
    /// the same, m/s
    pub velocity_m_s: Option<[f64; 3]>,
    /// roll, pitch, yaw of the body (forward, left, up) in the world, rad
    pub euler_rad: Option<[f64; 3]>,
    /// faults of the estimate
    pub estimator_faults: Vec<String>,
    /// time for which the estimate has been good; `None` without a report
    pub estimate_good_for: Option<Duration>,
    /// the vehicle's own checks; `None` without a report
    pub may_arm: Option<bool>,
    /// the operator's word for arming is waited for
    pub awaits_word: bool,
    /// its parts that are on and not healthy
    pub unhealthy: Vec<&'static str>,
}

impl Flight {
    /// For a display.
    #[must_use]
    pub fn status(&self, now: Duration) -> Status {
        let telemetry = self.contact.as_ref().map(|contact| &contact.telemetry);
        let state = telemetry.and_then(|telemetry| Some((telemetry.stack(), telemetry.state?.value)));
        let motion = telemetry.and_then(|telemetry| telemetry.motion);
        let system = telemetry.and_then(|telemetry| Some(&telemetry.system.as_ref()?.value));
        Status {
            phase: self.phase.name(),
            airborne: self.phase.is_airborne(),
            aborted: self.cause.is_some(),
            progress_s: self.progress_s(now),
            mode: state.map(|(stack, state)| stack.mode_name(state.custom_mode)),
            armed: state.is_some_and(|(_, state)| state.armed),
            period: (self.flown.periods, self.sortie.course.repeats()),
            tracking_m: self.watch.tracking.latest_m(),
            link_age_s: telemetry.map(|telemetry| now.saturating_sub(telemetry.heard).as_secs_f64()),
            stall_s: self.late_stall_s(now),
            battery_is_low: self.battery_level() > BatteryLevel::Good,
            battery_percent: telemetry.and_then(|telemetry| telemetry.battery?.value.1),
            battery_v: telemetry.and_then(|telemetry| telemetry.battery_v),
            position_m: motion.map(|motion| motion.value.position_m.into()),
            velocity_m_s: motion.map(|motion| motion.value.velocity_m_s.into()),
            euler_rad: telemetry.and_then(|telemetry| telemetry.attitude).map(|attitude| {
                let (roll, pitch, yaw) = attitude.value.0.euler_angles();
                [roll, pitch, yaw]
            }),
            estimator_faults: telemetry.map(|telemetry| telemetry.estimator_faults(now)).unwrap_or_default(),
            estimate_good_for: telemetry
                .and_then(|telemetry| Some(now.saturating_sub(telemetry.estimator_good_since?))),
            may_arm: system.and_then(|system| system.may_arm),
            awaits_word: self.awaits_word(),
            unhealthy: system.map(|system| system.unhealthy.clone()).unwrap_or_default(),
        }
    }

    /// The longest stall that ended within the last seconds, s.
    pub(super) fn late_stall_s(&self, now: Duration) -> Option<f64> {
        let late = self.stall.filter(|(ended, _)| now.saturating_sub(*ended) < STALL_SHOWN);
        late.map(|(_, gap)| gap.as_secs_f64())
    }

    fn progress_s(&self, now: Duration) -> Option<(f64, f64)> {
        match (&self.phase, &self.guide.lead) {
            (Phase::Course, Lead::Along(track)) => {
                Some((track.clock.at(now).along_s, track.path.duration_s()))
            }
            _ => None,
        }
    }
}
