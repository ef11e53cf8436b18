//! COMMAND_LONG and COMMAND_INT.

use crate::wire::command::{ARM_BY_FORCE, CUSTOM_MODE, SET_MESSAGE_INTERVAL};
use std::time::Duration;

use mavlink::dialects::ardupilotmega::{COMMAND_ACK_DATA, MESSAGE_INTERVAL_DATA, MavResult, MavSeverity};

use super::message::Message;
use super::streams::IntervalRefusal;
use super::{Mode, Vehicle};
use crate::autopilot::Numbering;
use crate::units::whole;
use crate::wire::Payload;
use crate::wire::message_id::{AUTOPILOT_VERSION, HEARTBEAT, HOME_POSITION};

/// MAV_CMD.
mod cmd {
    pub(super) const LOITER_UNLIMITED: u16 = 17;
    pub(super) const RETURN_TO_LAUNCH: u16 = 20;
    pub(super) const LAND: u16 = 21;
    pub(super) const TAKEOFF: u16 = 22;
    pub(super) const DO_SET_MODE: u16 = 176;
    pub(super) const DO_SET_HOME: u16 = 179;
    pub(super) const DO_FLIGHT_TERMINATION: u16 = 185;
    pub(super) const PREFLIGHT_REBOOT: u16 = 246;
    pub(super) const ARM_DISARM: u16 = 400;
    pub(super) const GET_HOME_POSITION: u16 = 410;
    pub(super) const GET_MESSAGE_INTERVAL: u16 = 510;
    pub(super) const REQUEST_MESSAGE: u16 = 512;
    pub(super) const REQUEST_CAPABILITIES: u16 = 520;
}

/// A command from a ground station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Command {
    number: u16,
    target: (u8, u8),
    /// param1 to param4 and param7, the fifth here
    params: [f64; 5],
}

impl Command {
    pub(super) fn long(payload: Payload) -> Self {
        let [p1, p2, p3, p4, _, _, p7] = payload.f32s(0);
        Self {
            number: payload.u16(28),
            target: (payload.u8(30), payload.u8(31)),
            params: [p1, p2, p3, p4, p7],
        }
    }

    pub(super) fn int(payload: Payload) -> Self {
        let [p1, p2, p3, p4] = payload.f32s(0);
        Self {
            number: payload.u16(28),
            target: (payload.u8(30), payload.u8(31)),
            params: [p1, p2, p3, p4, payload.f32(24)],
        }
    }
}

/// A parameter as a whole number that is not negative.
fn id_of(param: f64) -> u32 {
    u32::try_from(whole(param)).unwrap_or(u32::MAX)
}

impl Vehicle {
    /// Does what a command asks and acknowledges it.
    pub(super) fn command(&mut self, link: usize, command: &Command, sender: (u8, u8), now: Duration) {
        if !self.is_for_us(command.target) {
            return;
        }
        let answer = self.obey(link, command, now);
        self.acknowledge(link, command.number, answer, sender);
        if command.number == cmd::PREFLIGHT_REBOOT && answer == MavResult::MAV_RESULT_ACCEPTED {
            self.reboot();
        }
    }

    pub(super) fn acknowledge(&mut self, link: usize, number: u16, answer: MavResult, to: (u8, u8)) {
        let (target_system, target_component) = to;
        let message =
            COMMAND_ACK_DATA { result: answer, target_system, target_component, ..COMMAND_ACK_DATA::DEFAULT };
        // of any command, also of one that the dialect does not know
        self.send(link, &Message::from(message).with_bytes(0, number.to_le_bytes()));
    }

    fn obey(&mut self, link: usize, command: &Command, now: Duration) -> MavResult {
        let [p1, p2, p3, p4, p7] = command.params;
        match command.number {
            cmd::ARM_DISARM if p1 >= 0.5 => self.autopilot.arm(p2 == f64::from(ARM_BY_FORCE), now),
            cmd::ARM_DISARM => self.autopilot.disarm(p2 == f64::from(ARM_BY_FORCE)),
            cmd::DO_SET_MODE => self.do_set_mode([p1, p2, p3], now),
            cmd::TAKEOFF => self.autopilot.take_off(p7, now),
            cmd::LAND => self.autopilot.set_mode(Mode::Land, now),
            cmd::RETURN_TO_LAUNCH => self.autopilot.set_mode(Mode::Return, now),
            cmd::LOITER_UNLIMITED => self.autopilot.set_mode(Mode::Hold, now),
            cmd::DO_SET_HOME if p1 == 1.0 && self.autopilot.estimator.is_good(now) => {
                self.autopilot.home_m = Some(self.autopilot.estimator.state.position_m);
                MavResult::MAV_RESULT_ACCEPTED
            }
            cmd::DO_FLIGHT_TERMINATION if p1 >= 0.5 => {
                self.autopilot.switch_off("Terminated");
                MavResult::MAV_RESULT_ACCEPTED
            }
            cmd::PREFLIGHT_REBOOT if self.autopilot.is_armed() => MavResult::MAV_RESULT_DENIED,
            cmd::PREFLIGHT_REBOOT => MavResult::MAV_RESULT_ACCEPTED,
            SET_MESSAGE_INTERVAL => self.set_message_interval(link, id_of(p1), p2, [p3, p4, p7]),
            cmd::GET_MESSAGE_INTERVAL => self.get_message_interval(link, id_of(p1)),
            cmd::REQUEST_MESSAGE => self.request_message(link, id_of(p1)),
            cmd::REQUEST_CAPABILITIES => self.request_message(link, AUTOPILOT_VERSION),
            cmd::GET_HOME_POSITION => self.request_message(link, HOME_POSITION),
            _ => MavResult::MAV_RESULT_UNSUPPORTED,
        }
    }

    /// PX4: main and sub mode in the second and third parameter; ArduPilot: the mode's number in the second.
    fn do_set_mode(&mut self, [flags, main, sub]: [f64; 3], now: Duration) -> MavResult {
        if whole(flags) & i32::from(CUSTOM_MODE) == 0 {
            return MavResult::MAV_RESULT_DENIED;
        }
        let custom_mode = match self.settings.autopilot.stack().numbering {
            Numbering::MainAndSub => (id_of(main) & 0xFF) << 16 | (id_of(sub) & 0xFF) << 24,
            Numbering::Whole => id_of(main),
        };
        self.set_custom_mode(custom_mode, now)
    }

    /// A mode by its number in HEARTBEAT.
    pub(super) fn set_custom_mode(&mut self, custom_mode: u32, now: Duration) -> MavResult {
        let kind = self.settings.autopilot;
        match Mode::from_custom_mode(kind, custom_mode) {
            Some(mode) => self.autopilot.set_mode(mode, now),
            None if kind.is_px4() => MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
            None => MavResult::MAV_RESULT_FAILED,
        }
    }

    fn set_message_interval(
        &mut self,
        link: usize,
        id: u32,
        interval_us: f64,
        unused: [f64; 3],
    ) -> MavResult {
        let px4 = self.settings.autopilot.is_px4();
        // the parameters that mean nothing yet must be zero or absent; ArduPilot looks at the third alone
        let looked_at = if px4 { &unused[..] } else { &unused[..1] };
        if looked_at.iter().any(|param| *param != 0.0 && !param.is_nan()) {
            return if px4 { MavResult::MAV_RESULT_FAILED } else { MavResult::MAV_RESULT_DENIED };
        }
        if id == HEARTBEAT {
            return if px4 { MavResult::MAV_RESULT_FAILED } else { MavResult::MAV_RESULT_DENIED };
        }
        let Some(streams) = self.links.get_mut(link).map(|link| &mut link.streams) else {
            return MavResult::MAV_RESULT_FAILED;
        };
        match streams.set_interval(id, interval_us) {
            Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
            Err(_) if px4 => MavResult::MAV_RESULT_FAILED,
            Err(refusal) => {
                if refusal == IntervalRefusal::UnknownMessage {
                    self.autopilot
                        .say(MavSeverity::MAV_SEVERITY_INFO, format!("No ap_message for mavlink id ({id})"));
                }
                MavResult::MAV_RESULT_DENIED
            }
        }
    }

    fn get_message_interval(&mut self, link: usize, id: u32) -> MavResult {
        // zero: not available
        let interval_us = self.links.get(link).and_then(|link| link.streams.interval_us(id)).unwrap_or(0);
        let message_id = u16::try_from(id).unwrap_or(u16::MAX);
        self.send(link, &Message::from(MESSAGE_INTERVAL_DATA { interval_us, message_id }));
        MavResult::MAV_RESULT_ACCEPTED
    }

    fn request_message(&mut self, link: usize, id: u32) -> MavResult {
        let known = self.links.get(link).is_some_and(|link| link.streams.has(id)) || id == HEARTBEAT;
        if !known {
            return if self.settings.autopilot.is_px4() {
                MavResult::MAV_RESULT_DENIED
            } else {
                MavResult::MAV_RESULT_FAILED
            };
        }
        self.send_now(link, id);
        MavResult::MAV_RESULT_ACCEPTED
    }
}
