//! The vehicle that is spoken to.
#![expect(deprecated, reason = "older autopilots know the older command alone")]

use mavlink::dialects::ardupilotmega::{
    COMMAND_LONG_DATA, FILE_TRANSFER_PROTOCOL_DATA, LOG_REQUEST_DATA_DATA, LOG_REQUEST_END_DATA,
    LOG_REQUEST_LIST_DATA, MavCmd, MavMessage, MavParamType, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA,
};

use super::FetchError;
use crate::autopilot::Autopilot;
use crate::wire::file_transfer::Transfer;
use crate::wire::message_id::{
    AUTOPILOT_VERSION, COMMAND_ACK, FILE_TRANSFER_PROTOCOL, LOG_DATA, LOG_ENTRY, SYSTEM_TIME,
};
use crate::wire::{Frame, Vehicle};

/// Bytes of one LOG_DATA.
pub(super) const LOG_DATA_BYTES: usize = 90;

/// The vehicle that is spoken to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peer {
    vehicle: Vehicle,
    system: u8,
}

/// LOG_ENTRY.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LogEntry {
    pub(super) id: u16,
    pub(super) count: u16,
    pub(super) last: u16,
    pub(super) time_s: u32,
    pub(super) size: u32,
}

/// LOG_DATA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LogData<'a> {
    pub(super) id: u16,
    pub(super) offset: u32,
    /// of [`LOG_DATA_BYTES`] at most; zeros at its end may be missing
    pub(super) data: &'a [u8],
    pub(super) count: usize,
}

impl Peer {
    pub(super) fn of(vehicle: Vehicle) -> Result<Self, FetchError> {
        let system = u8::try_from(vehicle.system.0).ok().filter(|system| *system > 0);
        let system = system.ok_or(FetchError::NoTarget(vehicle.system.0))?;
        Ok(Self { vehicle, system })
    }

    pub(super) fn is_px4(&self) -> bool {
        self.vehicle.autopilot == Autopilot::Px4
    }

    pub(super) fn is_from(&self, frame: &Frame<'_>) -> bool {
        let header = frame.header();
        header.system == self.vehicle.system && header.component == self.vehicle.component
    }

    /// A request of the file transfer.
    pub(super) fn transfer(&self, request: &Transfer<'_>) -> MavMessage {
        MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: self.system,
            target_component: self.vehicle.component.0,
            payload: request.bytes(),
        })
    }

    /// LOG_REQUEST_LIST, both ends included.
    pub(super) fn request_list(&self, start: u16, end: u16) -> MavMessage {
        MavMessage::LOG_REQUEST_LIST(LOG_REQUEST_LIST_DATA {
            start,
            end,
            target_system: self.system,
            target_component: self.vehicle.component.0,
        })
    }

    /// LOG_REQUEST_DATA.
    pub(super) fn request_data(&self, id: u16, offset: u32, count: u32) -> MavMessage {
        MavMessage::LOG_REQUEST_DATA(LOG_REQUEST_DATA_DATA {
            ofs: offset,
            count,
            id,
            target_system: self.system,
            target_component: self.vehicle.component.0,
        })
    }

    /// LOG_REQUEST_END.
    pub(super) fn request_end(&self) -> MavMessage {
        MavMessage::LOG_REQUEST_END(LOG_REQUEST_END_DATA {
            target_system: self.system,
            target_component: self.vehicle.component.0,
        })
    }

    /// A request for AUTOPILOT_VERSION.
    pub(super) fn request_version(&self) -> MavMessage {
        self.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, AUTOPILOT_VERSION as f32)
    }

    /// A request for SYSTEM_TIME.
    pub(super) fn request_system_time(&self) -> MavMessage {
        self.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, SYSTEM_TIME as f32)
    }

    /// The older one of the version.
    pub(super) fn request_capabilities(&self) -> MavMessage {
        self.command(MavCmd::MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1.0)
    }

    /// The order to start the autopilot anew.
    pub(super) fn restart(&self) -> MavMessage {
        self.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1.0)
    }

    /// MAV_RESULT of that order, if it is this vehicle's answer.
    pub(super) fn heard_restart(&self, frame: &Frame<'_>) -> Option<u8> {
        let payload = frame.payload();
        let is = self.is_from(frame) && frame.header().message_id == COMMAND_ACK;
        let ordered = u32::from(payload.u16(0)) == MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u32;
        (is && ordered).then(|| payload.u8(2))
    }

    fn command(&self, command: MavCmd, param1: f32) -> MavMessage {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            command,
            target_system: self.system,
            target_component: self.vehicle.component.0,
            ..Default::default()
        })
    }

    /// PARAM_REQUEST_READ by name.
    pub(super) fn request_parameter(&self, name: &str) -> MavMessage {
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index: -1,
            target_system: self.system,
            target_component: self.vehicle.component.0,
            param_id: name.into(),
        })
    }

    /// PARAM_SET with the value as the autopilot encodes it.
    pub(super) fn set_parameter(&self, name: &str, value: f32, of_type: MavParamType) -> MavMessage {
        MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: value,
            target_system: self.system,
            target_component: self.vehicle.component.0,
            param_id: name.into(),
            param_type: of_type,
        })
    }

    /// An answer of the file transfer, if it is one of this vehicle.
    pub(super) fn heard_transfer<'a>(&self, frame: &Frame<'a>) -> Option<Transfer<'a>> {
        let is = self.is_from(frame) && frame.header().message_id == FILE_TRANSFER_PROTOCOL;
        is.then(|| Transfer::read(frame.payload()))
    }

    pub(super) fn heard_entry(&self, frame: &Frame<'_>) -> Option<LogEntry> {
        let payload = frame.payload();
        let is = self.is_from(frame) && frame.header().message_id == LOG_ENTRY;
        is.then(|| LogEntry {
            time_s: payload.u32(0),
            size: payload.u32(4),
            id: payload.u16(8),
            count: payload.u16(10),
            last: payload.u16(12),
        })
    }

    pub(super) fn heard_data<'a>(&self, frame: &Frame<'a>) -> Option<LogData<'a>> {
        let payload = frame.payload();
        let is = self.is_from(frame) && frame.header().message_id == LOG_DATA;
        is.then(|| LogData {
            offset: payload.u32(0),
            id: payload.u16(4),
            count: usize::from(payload.u8(6)).min(LOG_DATA_BYTES),
            data: payload.0.get(7..).unwrap_or(&[]),
        })
    }
}
