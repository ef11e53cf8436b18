//! The start gate: the trajectory begins once the vehicle stands still at its start.

use std::time::Duration;

use super::state::Flight;
use crate::fly::health::BatteryLevel;
use crate::fly::outcome::{Cause, Level};
use crate::fly::setpoint::wrapped;

/// Largest distance to the start at first, m. 0.3 m and 0.2 m/s stayed shut in 6 of 27 simulated flights, so the gate
/// adapts.
const NEAR_M: f64 = 0.3;
/// Largest speed at first, m/s. See above.
const SLOW_M_S: f64 = 0.2;
/// Largest error of the heading, rad. A heading that is further off turns the trajectory in the room.
const TURNED_RAD: f64 = 0.15;
/// Time for which it must satisfy these limits.
const HOLDS: Duration = Duration::from_secs(1);
/// Factor on the largest deviation in the observed hover. With it the gate opened in 68 of 68 simulated flights.
const SPARE: f64 = 1.25;
/// Largest share of the tracking limit that is ever allowed. A start further off would leave too little of the limit
/// for the trajectory.
const SHARE_OF_TRACKING: f64 = 0.6;
/// Largest speed that is ever allowed, m/s. A vehicle that drifts faster is not at hover.
const FAST_M_S: f64 = 0.6;

impl Flight {
    pub(super) fn gate(&mut self, now: Duration) {
        let (allowed_m, allowed_m_s) = self.gate_allows(now);
        let missing = self.gate_misses(now, (allowed_m, allowed_m_s));
        if !missing.is_empty()
            && let Some(lift) = &mut self.lift
        {
            lift.clear();
        }
        if self.gate.open.update(now, missing.is_empty()) >= HOLDS {
            self.weigh(now);
            self.begin_course(now);
        } else if now.saturating_sub(self.entered) > self.sortie.settings.reach_timeout {
            let remedy = "allow more with --gate-distance and --gate-speed where the room permits, or have the vehicle \
                          hold its position better";
            self.end(
                now,
                Cause::NotReached(format!("the start gate stays shut: {} ({remedy})", missing.join("; "))),
            );
        }
    }

    /// Allowed distance (m) and speed (m/s): those of the operator, the usual ones, or those that the vehicle has shown
    /// in hover.
    fn gate_allows(&mut self, now: Duration) -> (f64, f64) {
        let settings = &self.sortie.settings;
        let (most_m, most_m_s) = (SHARE_OF_TRACKING * settings.tracking_max_m, FAST_M_S);
        let (stated_m, stated_m_s) = (settings.gate_m, settings.gate_m_s);
        if let (Some(start), Some(here), Some((_, velocity_m_s))) =
            (self.start(), self.place_now(), self.motion_now())
        {
            self.gate.watch(now, (here.position_m - start.position_m).norm(), velocity_m_s.norm());
        }
        let worst = self.gate.worst(now);
        let grown = |usual: f64, worst: f64, most: f64| (SPARE * worst).clamp(usual, most.max(usual));
        let (hover_m, hover_m_s) = worst.map_or((NEAR_M, SLOW_M_S), |(off_m, speed_m_s)| {
            (grown(NEAR_M, off_m, most_m), grown(SLOW_M_S, speed_m_s, most_m_s))
        });
        let allowed = (stated_m.unwrap_or(hover_m), stated_m_s.unwrap_or(hover_m_s));
        if (allowed.0 > NEAR_M && stated_m.is_none() || allowed.1 > SLOW_M_S && stated_m_s.is_none())
            && !std::mem::replace(&mut self.gate.is_reported, true)
        {
            let text = format!(
                "it does not hover more precisely: the start gate opens within {:.2} m and {:.2} m/s instead of \
                 {NEAR_M} m \
                 and {SLOW_M_S} m/s",
                allowed.0, allowed.1
            );
            self.note(now, Level::Warning, "gate", text);
        }
        allowed
    }

    fn gate_misses(&self, now: Duration, (allowed_m, allowed_m_s): (f64, f64)) -> Vec<String> {
        let (Some(start), Some(here), Some((_, velocity_m_s))) =
            (self.start(), self.place_now(), self.motion_now())
        else {
            return vec!["its position is not known".to_owned()];
        };
        let mut missing = Vec::new();
        let off_m = (here.position_m - start.position_m).norm();
        if off_m > allowed_m {
            missing.push(format!("{off_m:.2} m off the start, {allowed_m:.2} m are allowed"));
        }
        let speed_m_s = velocity_m_s.norm();
        if speed_m_s > allowed_m_s {
            missing.push(format!("{speed_m_s:.2} m/s, {allowed_m_s:.2} m/s are allowed"));
        }
        let turned_rad = wrapped(here.yaw_rad - start.yaw_rad).abs();
        if turned_rad > TURNED_RAD {
            missing.push(format!("heading {turned_rad:.2} rad off, {TURNED_RAD} rad are allowed"));
        }
        if let Some(contact) = &self.contact {
            missing.extend(contact.telemetry.estimator_faults(now));
        }
        if self.battery_level() > BatteryLevel::Good {
            missing.push("the battery is low".to_owned());
        }
        if self.watch.is_paused() {
            missing.push("nothing is heard of the vehicle".to_owned());
        }
        if self.known.is_in_doubt() {
            missing.push("its mode is not known since a silence".to_owned());
        }
        missing
    }
}
