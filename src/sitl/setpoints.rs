//! Setpoints as they come in.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavSeverity;
use nalgebra::Vector3;

use super::Mode;
use super::autopilot::Autopilot;
use super::demand::{AttitudeDemand, Demand, Refusal};
use super::guidance::Task;
use crate::wire::Payload;

impl Autopilot {
    /// SET_ATTITUDE_TARGET.
    pub(super) fn take_attitude(&mut self, payload: Payload, now: Duration) {
        let state = self.estimator.state;
        if self.kind.is_px4() {
            let Some(demand) = AttitudeDemand::px4(payload) else { return };
            self.safety.setpoint_came(now);
            if self.mode == Mode::Guided {
                self.guidance.begin(Task::Turn(demand, now), &state);
            }
            return;
        }
        if self.mode != Mode::Guided || !self.is_armed() {
            return;
        }
        let task = AttitudeDemand::ardupilot(payload, self.tuning.thrust_field);
        self.guidance.begin(task.map_or(Task::Hold, |demand| Task::Turn(demand, now)), &state);
    }

    /// SET_POSITION_TARGET_LOCAL_NED.
    pub(super) fn take_setpoint(&mut self, payload: Payload, now: Duration) {
        let state = self.estimator.state;
        let demand = Demand::read(self.kind, payload, &state);
        if self.kind.is_px4() {
            match demand {
                Ok(demand) => {
                    self.safety.setpoint_came(now);
                    if self.mode == Mode::Guided {
                        let task = if demand.is_complete() { Task::Direct(demand) } else { Task::Hold };
                        self.guidance.begin(task, &state);
                    }
                }
                Err(Refusal::Frame(frame)) => {
                    let text = format!("SET_POSITION_TARGET_LOCAL_NED coordinate frame {frame} unsupported");
                    self.say(MavSeverity::MAV_SEVERITY_ERROR, text);
                }
                Err(_) => {}
            }
            return;
        }
        if self.mode != Mode::Guided || !self.is_armed() || self.is_landed() {
            return;
        }
        match demand {
            // outside the fence: dropped, nobody is told
            Ok(demand) if self.is_fenced_out(&demand.motion.position_m) => {}
            Ok(demand) => self.guidance.begin(Task::Shaped(demand, now), &state),
            Err(_) => self.guidance.begin(Task::Hold, &state),
        }
    }

    /// A destination is; a velocity has none.
    fn is_fenced_out(&self, position_m: &Vector3<f64>) -> bool {
        let home_m = self.home_m.unwrap_or_else(Vector3::zeros);
        let rules = self.tuning.fence;
        position_m.x.is_finite()
            && rules.is_some_and(|rules| self.fence.breach(&rules, position_m, &home_m).is_any())
    }
}
