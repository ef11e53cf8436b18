//! A parameter's value in a message: PX4 puts the bytes of whole numbers in the place of the float, ArduPilot their value.

use mavlink::dialects::ardupilotmega::MavParamType;

use super::peer::Peer;
use crate::wire::message_id::PARAM_VALUE;
use crate::wire::{Frame, Payload};

/// Types whose values are whole numbers, by their number in messages.
const WHOLE: [(u8, MavParamType); 6] = [
    (1, MavParamType::MAV_PARAM_TYPE_UINT8),
    (2, MavParamType::MAV_PARAM_TYPE_INT8),
    (3, MavParamType::MAV_PARAM_TYPE_UINT16),
    (4, MavParamType::MAV_PARAM_TYPE_INT16),
    (5, MavParamType::MAV_PARAM_TYPE_UINT32),
    (6, MavParamType::MAV_PARAM_TYPE_INT32),
];

/// A parameter as its vehicle has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ParameterValue {
    pub(super) value: f64,
    pub(super) of_type: MavParamType,
    is_whole: bool,
}

impl ParameterValue {
    /// Name and value, if a frame is this vehicle's PARAM_VALUE.
    pub(super) fn heard(peer: &Peer, frame: &Frame<'_>) -> Option<(String, Self)> {
        let payload = frame.payload();
        let is = peer.is_from(frame) && frame.header().message_id == PARAM_VALUE;
        is.then(|| (payload.text(8, 16), Self::read(peer, payload)))
    }

    fn read(peer: &Peer, payload: Payload<'_>) -> Self {
        let whole = WHOLE.iter().find(|(number, _)| *number == payload.u8(24));
        let of_type = whole.map_or(MavParamType::MAV_PARAM_TYPE_REAL32, |(_, of_type)| *of_type);
        let value = match (peer.is_px4(), whole.map(|(number, _)| *number)) {
            (true, Some(1)) => f64::from(payload.u8(0)),
            (true, Some(2)) => f64::from(i8::from_le_bytes([payload.u8(0)])),
            (true, Some(3)) => f64::from(payload.u16(0)),
            (true, Some(4)) => f64::from(payload.i16(0)),
            (true, Some(5)) => f64::from(payload.u32(0)),
            (true, Some(_)) => f64::from(payload.i32(0)),
            _ => payload.f32(0),
        };
        Self { value, of_type, is_whole: whole.is_some() }
    }

    /// Whether it takes whole numbers alone.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Another value of the same parameter, as PARAM_SET has it.
    #[expect(clippy::cast_possible_truncation, reason = "the message has no more room")]
    pub(super) fn encoded(&self, peer: &Peer, value: f64) -> f32 {
        if peer.is_px4() && self.is_whole {
            return f32::from_le_bytes((value.round() as i32).to_le_bytes());
        }
        value as f32
    }
}
