//! Messages from a ground station, by their fields' places on the wire: an enumeration value that the dialect
//! does not know loses nothing.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavSeverity;

use super::Vehicle;
use super::commands::Command;
use super::ping::ping;
use super::telemetry::Telemetry;
use crate::wire::message_id as id;
use crate::wire::{Frame, Payload};

/// MAV_TYPE_GCS
const GROUND_STATION: u8 = 6;

impl Vehicle {
    /// One checked frame of another system.
    pub(super) fn handle(&mut self, link: usize, frame: &Frame, now: Duration) {
        let header = frame.header();
        let payload = frame.payload();
        // a system id beyond eight bits cannot be answered by its number
        let sender = (u8::try_from(header.system.0).unwrap_or(0), header.component.0);
        match header.message_id {
            id::HEARTBEAT => self.heartbeat_of(link, frame, sender, now),
            id::COMMAND_LONG => self.command(link, &Command::long(payload), sender, now),
            id::COMMAND_INT => self.command(link, &Command::int(payload), sender, now),
            id::SET_MODE if payload.u8(4) == self.settings.system => {
                let answer = self.set_custom_mode(payload.u32(0), now);
                // ArduPilot acknowledges the message, PX4 the command that it becomes
                let number = if self.settings.autopilot.is_px4() { 176 } else { 11 };
                self.acknowledge(link, number, answer, sender);
            }
            id::SET_POSITION_TARGET_LOCAL_NED if self.is_for_us((payload.u8(50), payload.u8(51))) => {
                self.autopilot.take_setpoint(payload, now);
            }
            id::SET_ATTITUDE_TARGET if self.is_for_us((payload.u8(36), payload.u8(37))) => {
                self.autopilot.take_attitude(payload, now);
            }
            id::PARAM_REQUEST_LIST if self.is_for_us((payload.u8(0), payload.u8(1))) => {
                if let Some(link) = self.links.get_mut(link) {
                    link.start_download();
                }
            }
            id::PARAM_REQUEST_READ if self.is_for_us((payload.u8(2), payload.u8(3))) => {
                self.read_parameter(link, payload);
            }
            id::PARAM_SET if self.is_for_us((payload.u8(4), payload.u8(5))) => {
                self.set_parameter(link, payload, now);
            }
            id::REQUEST_DATA_STREAM if !self.settings.autopilot.is_px4() => {
                self.request_data_stream(link, payload);
            }
            id::SETUP_SIGNING if self.is_for_us((payload.u8(8), payload.u8(9))) => {
                self.set_up_signing(payload)
            }
            id::TIMESYNC if payload.u64(0) == 0 => {
                let asked = i64::from_le_bytes(payload.u64(8).to_le_bytes());
                self.send(link, &Telemetry::timesync_answer(now, asked, sender));
            }
            id::PING if payload.u8(12) == 0 => {
                self.send(link, &ping(payload.u64(0), payload.u32(8), sender));
            }
            id::FILE_TRANSFER_PROTOCOL
            | id::LOG_REQUEST_LIST
            | id::LOG_REQUEST_DATA
            | id::LOG_REQUEST_END => {
                self.ask_files(link, header.message_id, payload, sender);
            }
            id::MISSION_REQUEST_LIST
            | id::MISSION_REQUEST_INT
            | id::MISSION_COUNT
            | id::MISSION_CLEAR_ALL
            | id::MISSION_ACK
            | id::MISSION_ITEM_INT => {
                self.mission(link, header.message_id, payload, (sender, now));
            }
            _ => {}
        }
    }

    /// A ground station's heartbeat keeps its failsafe quiet, and ArduPilot passes it on to its other links.
    fn heartbeat_of(&mut self, link: usize, frame: &Frame, (system, _): (u8, u8), now: Duration) {
        if frame.payload().u8(4) == GROUND_STATION {
            self.autopilot.ground_station_seen(system, now);
        }
        if !self.settings.autopilot.is_px4() {
            let bytes = frame.bytes().to_vec();
            self.pass_on(&bytes, Some(link));
        }
    }

    fn read_parameter(&mut self, link: usize, payload: Payload) {
        let index = payload.i16(0);
        let at = match usize::try_from(index) {
            Ok(index) => Some(index),
            Err(_) => self.parameters.find(&payload.text(4, 16)),
        };
        if let Some(message) = at.and_then(|at| self.parameters.message(at)) {
            self.send(link, &message);
        }
    }

    fn set_parameter(&mut self, link: usize, payload: Payload, now: Duration) {
        let name = payload.text(6, 16);
        let px4 = self.settings.autopilot.is_px4();
        let Some(at) = self.parameters.find(&name) else {
            if px4 {
                self.autopilot.say(MavSeverity::MAV_SEVERITY_ERROR, format!("unknown param: {name}"));
            }
            return;
        };
        let Some(value) = self.parameters.decode(at, payload.u8(22), payload) else {
            if px4 {
                self.autopilot
                    .say(MavSeverity::MAV_SEVERITY_ERROR, format!("param types mismatch param: {name}"));
            }
            return;
        };
        self.parameters.set(&name, value);
        if let Some((kind, value)) = self.parameters.get(at) {
            self.keeper.parameter(now, &name, kind, value);
        }
        self.retune();
        if let Some(message) = self.parameters.message(at) {
            // ArduPilot tells every link
            if px4 { self.send(link, &message) } else { self.broadcast(&message) }
        }
        // PX4's controller looks at a value after it was taken and told
        if let Some(said) = self.parameters.constrain() {
            self.autopilot.say(MavSeverity::MAV_SEVERITY_CRITICAL, said.to_owned());
            self.retune();
        }
    }

    fn request_data_stream(&mut self, link: usize, payload: Payload) {
        if !self.is_for_us((payload.u8(2), payload.u8(3))) {
            return;
        }
        let rate_hz = if payload.u8(5) == 0 { 0.0 } else { f64::from(payload.u16(0)) };
        if let Some(link) = self.links.get_mut(link) {
            link.streams.set_group(payload.u8(4), rate_hz);
        }
    }
}
