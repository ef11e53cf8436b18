//! Detection of another station that commands the vehicle.

use crate::wire::message_id::{
    HEARTBEAT, SET_ATTITUDE_TARGET, SET_POSITION_TARGET_GLOBAL_INT, SET_POSITION_TARGET_LOCAL_NED,
};
use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use crate::autopilot::{LastSetpoint, Stack};
use crate::fly::outcome::Cause;
use crate::fly::setpoint::Setpoint;
use crate::fly::target::Target;
use crate::wire::{ComponentId, Frame, SystemId};

/// Distance from all of our targets beyond which a reported target is not ours, m. PX4 reports our targets exactly,
/// ArduPilot some centimetres further on. With less ours would be taken for foreign; a foreign target that near does
/// no harm.
const FOREIGN_M: f64 = 0.25;
/// Largest delay of a report; after a silence it is larger by the silence.
const DELAY: Duration = Duration::from_secs(1);
/// Longest time for which the vehicle may follow one of our setpoints.
const OLDEST: Duration = Duration::from_secs(9);
/// Steps in the search for the time by which a setpoint was extrapolated.
const STEPS: u32 = 10;
/// Longest time in which a queue that a silence has filled is emptied.
const DRAINS: Duration = Duration::from_secs(20);
/// Number of foreign reports within a time for a detection. Setpoints of another station between ours are followed for
/// an instant each: of 30 reports of a PX4 that received 20 of them a second between 50 of ours, 3 showed them. Without
/// them, no report did.
const REPORTS: usize = 2;
const WINDOW: Duration = Duration::from_secs(3);

/// Messages that carry setpoints, with the offset of their target.
const SETPOINTS: [(u32, usize); 3] =
    [(SET_ATTITUDE_TARGET, 36), (SET_POSITION_TARGET_LOCAL_NED, 50), (SET_POSITION_TARGET_GLOBAL_INT, 50)];

/// Detection of a second station.
#[derive(Debug)]
pub struct Masters {
    own: (SystemId, ComponentId),
    sent: VecDeque<(Duration, Setpoint)>,
    reported: Option<Duration>,
    /// time of each foreign report, and the distance of our nearest target, m
    foreign: VecDeque<(Duration, f64)>,
    /// a silence and when it ended
    silence: Option<(Duration, Duration)>,
}

impl Masters {
    /// For a ground station of these ids.
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Self {
        Self {
            own: (system, component),
            sent: VecDeque::new(),
            reported: None,
            foreign: VecDeque::new(),
            silence: None,
        }
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

    /// Notes the setpoint that is sent at `now`.
    pub fn record_setpoint(&mut self, now: Duration, setpoint: Setpoint) {
        self.sent.push_back((now, setpoint));
        while self.sent.front().is_some_and(|(at, _)| now.saturating_sub(*at) > OLDEST) {
            self.sent.pop_front();
        }
    }

    /// Checks the target that the vehicle reports, m, world; `None` for one that is not a position.
    pub fn check(
        &mut self,
        now: Duration,
        target_m: Option<Vector3<f64>>,
        stack: &'static Stack,
    ) -> Option<Cause> {
        let silent = now.saturating_sub(self.reported.replace(now).unwrap_or(now));
        let before = self.silence.filter(|(_, ended)| now.saturating_sub(*ended) <= DRAINS);
        if before.is_none_or(|(lasted, _)| silent >= lasted) {
            self.silence = Some((silent, now));
        }
        let late = DELAY + self.silence.map_or(Duration::ZERO, |(lasted, _)| lasted);
        // while ours do not arrive the last is flown for so long: by the time-out's default
        let alone = stack.setpoints.timeout_default;
        let age = |at: Duration| now.saturating_sub(at);
        let ours = self.sent.iter().filter(|(at, _)| age(*at) <= late + alone);
        let away_m = match target_m {
            Some(target_m) => {
                let moved = |at: Duration| match stack.setpoints.last_setpoint {
                    LastSetpoint::MovedOn => (age(at).saturating_sub(late), age(at).min(alone)),
                    LastSetpoint::Held => (Duration::ZERO, Duration::ZERO),
                };
                ours.map(|(at, setpoint)| away_m(setpoint, &target_m, moved(*at))).min_by(f64::total_cmp)?
            }
            // ours always are one
            None => f64::INFINITY,
        };
        if away_m > FOREIGN_M {
            self.foreign.push_back((now, away_m));
        }
        while self.foreign.front().is_some_and(|(at, _)| now.saturating_sub(*at) > WINDOW) {
            self.foreign.pop_front();
        }
        (self.foreign.len() >= REPORTS).then(|| {
            let nearest_m = self.foreign.iter().map(|(_, away_m)| *away_m).fold(f64::INFINITY, f64::min);
            Cause::SecondMaster(if nearest_m.is_finite() {
                format!("the vehicle repeatedly reports targets {nearest_m:.2} m and more from ours")
            } else {
                "the vehicle repeatedly reports targets that are not positions; ours are positions".to_owned()
            })
        })
    }
}

/// Distance of a target from the setpoint after an extrapolation for some time of a span, m.
fn away_m(setpoint: &Setpoint, target_m: &Vector3<f64>, (least, most): (Duration, Duration)) -> f64 {
    let (least_s, span_s) = (least.as_secs_f64(), most.saturating_sub(least).as_secs_f64());
    let steps = if span_s > 0.0 { STEPS } else { 0 };
    (0..=steps)
        .map(|step| {
            let s = least_s + span_s * f64::from(step) / f64::from(STEPS);
            let gone_m = setpoint.velocity_m_s * s + setpoint.acceleration_m_s2 * (0.5 * s * s);
            (setpoint.position_m + gone_m - target_m).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::{ARDUPILOT, PX4};
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
            let message = Setpoint::hold(ms(0), &place).message(target).unwrap();
            assert_eq!(heard(&message, 254).is_some(), ours);
        }
    }

    fn ours(t: u64) -> Setpoint {
        let velocity_m_s = Vector3::new(3.0, 0.0, 0.0);
        let place = Place { position_m: Vector3::new(3e-3 * t as f64, 0.0, 1.0), yaw_rad: 0.0 };
        Setpoint { velocity_m_s, ..Setpoint::hold(ms(t), &place) }
    }

    /// Our setpoints each 20 ms, and each 50 ms a report of the target that `reported` has at a time.
    fn heard_of(
        stack: &'static Stack,
        (from, to): (u64, u64),
        reported: impl Fn(u64) -> Option<Vector3<f64>>,
    ) -> Option<u64> {
        let mut masters = Masters::new(SystemId(255), ComponentId(190));
        (from..to).step_by(10).find(|&t| {
            if t % 20 == 0 {
                masters.record_setpoint(ms(t), ours(t));
            }
            t % 50 == 0 && masters.check(ms(t), reported(t), stack).is_some()
        })
    }

    #[test]
    fn a_target_that_is_late_is_ours_and_one_elsewhere_is_not() {
        let elsewhere = |t: u64| ours(t).position_m + Vector3::new(0.0, 0.4, 0.0);
        for stack in [&PX4, &ARDUPILOT] {
            let late = |t: u64| Some(ours(t.max(1800) - 800).position_m);
            assert_eq!(heard_of(stack, (1000, 9000), late), None);
            assert_eq!(heard_of(stack, (1000, 9000), |t| Some(elsewhere(t))), Some(1050));
            assert_eq!(heard_of(stack, (1000, 9000), |_| None), Some(1050), "a velocity alone");
        }
    }

    #[test]
    fn bursts_of_another_between_ours_are_seen_and_single_ones_are_not() {
        let at = |t: u64| (t / 50).is_multiple_of(3);
        let beside = |t: u64, foreign: bool| {
            Some(ours(t).position_m + Vector3::new(0.0, if foreign { 0.9 } else { 0.0 }, 0.0))
        };
        // one and a half seconds in which each third report shows the other's
        let burst = heard_of(&PX4, (1000, 9000), |t| beside(t, (4000..5500).contains(&t) && at(t)));
        assert!(burst.is_some_and(|t| t < 5000), "{burst:?}");
        assert_eq!(heard_of(&PX4, (1000, 20_000), |t| beside(t, t % 4000 == 0)), None);
    }

    #[test]
    fn ardupilot_moves_a_target_on_while_nothing_new_comes_and_px4_does_not() {
        // ours are lost for half a second of each second, and the vehicle continues along the velocity
        let started = |t: u64| t - t % 1000;
        let coasting = |t: u64| {
            let from = ours(started(t));
            Some(from.position_m + from.velocity_m_s * (1e-3 * (t % 1000) as f64) + Vector3::y() * 0.1)
        };
        assert_eq!(heard_of(&ARDUPILOT, (1000, 9000), coasting), None);
        let ahead = |t: u64| Some(ours(t + 400).position_m);
        assert_eq!(heard_of(&PX4, (1000, 9000), ahead), Some(1050));
    }

    #[test]
    fn what_a_silence_held_back_is_ours() {
        let mut masters = Masters::new(SystemId(255), ComponentId(190));
        for t in (1000..6000).step_by(20) {
            masters.record_setpoint(ms(t), ours(t));
            if t < 2000 {
                assert!(masters.check(ms(t), Some(ours(t).position_m), &PX4).is_none());
            }
        }
        // four seconds of reports at once
        for t in (2000..6000).step_by(50) {
            assert!(masters.check(ms(6000), Some(ours(t).position_m), &PX4).is_none());
        }
    }
}
