//! Whether anybody else commands the vehicle.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use super::Sustained;
use crate::fly::outcome::Cause;
use crate::fly::target::Target;
use crate::log::{ComponentId, Frame, SystemId};

/// A reported target this far from all of ours is not ours.
const FOREIGN_M: f64 = 1.0;
/// Reports come later than what they report.
const DELAY: Duration = Duration::from_secs(1);
const PATIENCE: Duration = Duration::from_millis(500);

const HEARTBEAT: u32 = 0;
/// SET_ATTITUDE_TARGET, SET_POSITION_TARGET_LOCAL_NED, SET_POSITION_TARGET_GLOBAL_INT with the offset of
/// their target.
const SETPOINTS: [(u32, usize); 3] = [(82, 36), (84, 50), (86, 50)];

/// Watches for a second master.
#[derive(Debug)]
pub struct Masters {
    own: (SystemId, ComponentId),
    told: VecDeque<(Duration, Vector3<f64>)>,
    foreign: Sustained,
}

impl Masters {
    /// For a ground station of these ids.
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Self {
        Self { own: (system, component), told: VecDeque::new(), foreign: Sustained::default() }
    }

    /// Takes a frame that is not the vehicle's own: a heartbeat with our ids, or setpoints for our vehicle.
    #[must_use]
    pub fn hear(&self, frame: Frame<'_>, target: Target) -> Option<Cause> {
        let header = frame.header();
        let sender = (header.system, header.component);
        if header.message_id == HEARTBEAT && sender == self.own {
            let (system, component) = sender;
            return Some(Cause::SecondMaster(format!(
                "a heartbeat with our own ids, system {system} component {component}"
            )));
        }
        let (_, offset) = SETPOINTS.iter().find(|(id, _)| *id == header.message_id)?;
        let addressee = frame.payload().u8(*offset);
        (addressee == 0 || addressee == target.system_byte()).then(|| {
            let (system, component) = sender;
            Cause::SecondMaster(format!("setpoints from system {system} component {component}"))
        })
    }

    /// What the vehicle is told at `now`, m, world.
    pub fn told(&mut self, now: Duration, position_m: Vector3<f64>) {
        self.told.push_back((now, position_m));
        while self.told.front().is_some_and(|(at, _)| now.saturating_sub(*at) > DELAY) {
            self.told.pop_front();
        }
    }

    /// Takes the target that the vehicle says it flies to, m, world.
    pub fn check(&mut self, now: Duration, target_m: &Vector3<f64>) -> Option<Cause> {
        let nearest_m = self.told.iter().map(|(_, told)| (told - target_m).norm()).min_by(f64::total_cmp)?;
        (self.foreign.update(now, nearest_m > FOREIGN_M) > PATIENCE)
            .then(|| Cause::SecondMaster(format!("the vehicle flies to a target {nearest_m:.2} m from ours")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fly::setpoint::{Place, Setpoint};
    use crate::fly::target::heartbeat;
    use mavlink::dialects::ardupilotmega::MavMessage;
    use mavlink::{MAVLinkV2MessageRaw, MavHeader};

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    fn heard(message: &MavMessage, system_id: u32) -> Option<Cause> {
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(MavHeader { system_id, component_id: 190, sequence: 0 }, message);
        let masters = Masters::new(SystemId(255), ComponentId(190));
        let target = Target::new(SystemId(1), ComponentId(1)).unwrap();
        masters.hear(Frame::at_start(raw.raw_bytes()).unwrap(), target)
    }

    #[test]
    fn a_listener_is_no_master_and_one_with_our_ids_is() {
        assert!(heard(&heartbeat(), 254).is_none());
        assert!(heard(&heartbeat(), 255).is_some());
    }

    #[test]
    fn setpoints_of_others_for_our_vehicle_are_seen() {
        let place = Place { position_m: Vector3::zeros(), yaw_rad: 0.0 };
        for (system, ours) in [(1, true), (2, false)] {
            let target = Target::new(SystemId(system), ComponentId(1)).unwrap();
            let message = Setpoint::hold(ms(0), &place).message(target);
            assert_eq!(heard(&message, 254).is_some(), ours);
        }
    }

    #[test]
    fn a_target_that_is_late_is_ours_and_one_elsewhere_is_not() {
        let mut masters = Masters::new(SystemId(255), ComponentId(190));
        let place = |t: u64| Vector3::new(3e-3 * t as f64, 0.0, 1.0);
        for t in (1000..3000).step_by(20) {
            masters.told(ms(t), place(t));
            assert!(masters.check(ms(t), &place(t - 400)).is_none());
        }
        let elsewhere = place(3000) + Vector3::new(0.0, 2.0, 0.0);
        assert!(masters.check(ms(3000), &elsewhere).is_none());
        assert!(masters.check(ms(3600), &elsewhere).is_some());
    }
}
