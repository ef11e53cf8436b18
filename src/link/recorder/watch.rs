//! Notices that a vehicle arms, disarms or changes its mode.

use crate::wire::heartbeat::{ARMED, AUTOPILOT_AT, BASE_MODE_AT, NO_AUTOPILOT};
use crate::wire::message_id::HEARTBEAT;
use std::collections::BTreeMap;

use crate::wire::{ComponentId, Frame, SystemId};

/// Vehicles watched.
const VEHICLES: usize = 64;

/// Notices that a vehicle arms, disarms or changes its mode, from the bytes of its HEARTBEAT: an enum value
/// that the dialect does not know must not hide it.
#[derive(Debug, Default)]
pub(super) struct ModeWatch {
    states: BTreeMap<(SystemId, ComponentId), (bool, u32)>,
}

impl ModeWatch {
    /// Whether this frame tells a change; the first HEARTBEAT of a vehicle is one.
    pub fn changed(&mut self, frame: &Frame<'_>) -> bool {
        let (header, payload) = (frame.header(), frame.payload());
        if header.message_id != HEARTBEAT || payload.u8(AUTOPILOT_AT) == NO_AUTOPILOT {
            return false;
        }
        let key = (header.system, header.component);
        let state = (payload.u8(BASE_MODE_AT) & ARMED != 0, payload.u32(0));
        if self.states.get(&key) == Some(&state) {
            return false;
        }
        if self.states.len() < VEHICLES || self.states.contains_key(&key) {
            self.states.insert(key, state);
        }
        true
    }
}
