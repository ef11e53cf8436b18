//! From an order or a question to the message that carries it.

use mavlink::dialects::ardupilotmega::{
    self as dialect, COMMAND_LONG_DATA, HEARTBEAT_DATA, MISSION_ACK_DATA, MISSION_REQUEST_INT_DATA,
    MISSION_REQUEST_LIST_DATA, MavAutopilot, MavMessage, MavMissionResult, MavMissionType, MavModeFlag,
    MavState, MavType, PARAM_REQUEST_READ_DATA, TIMESYNC_DATA,
};
use mavlink::types::CharArray;

use super::order::Order;
use super::range::ParameterName;
use super::vehicle::Target;

const FENCE: MavMissionType = MavMissionType::MAV_MISSION_TYPE_FENCE;

impl Target {
    /// `COMMAND_LONG`; `confirmation` counts how often the same order was sent before.
    #[must_use]
    pub fn command(self, order: &Order, confirmation: u8) -> MavMessage {
        let [param1, param2, param3, param4, param5, param6, param7] = order.parameters();
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            param3,
            param4,
            param5,
            param6,
            param7,
            command: order.command(),
            target_system: self.system_byte(),
            target_component: self.component.0,
            confirmation,
        })
    }

    /// `PARAM_REQUEST_READ`: a parameter by its name.
    #[must_use]
    pub fn parameter_request(self, name: &ParameterName) -> MavMessage {
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            // by the name alone
            param_index: -1,
            target_system: self.system_byte(),
            target_component: self.component.0,
            param_id: CharArray::from(name.text()),
        })
    }

    /// `MISSION_REQUEST_LIST`: how many items the fence has.
    #[must_use]
    pub fn fence_request(self) -> MavMessage {
        MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
            target_system: self.system_byte(),
            target_component: self.component.0,
            mission_type: FENCE,
        })
    }

    /// `MISSION_REQUEST_INT`: an item of the fence, counted from 0.
    #[must_use]
    pub fn fence_item_request(self, seq: u16) -> MavMessage {
        MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
            seq,
            target_system: self.system_byte(),
            target_component: self.component.0,
            mission_type: FENCE,
        })
    }

    /// `MISSION_ACK`: the fence came.
    #[must_use]
    pub fn fence_thanks(self) -> MavMessage {
        MavMessage::MISSION_ACK(MISSION_ACK_DATA {
            target_system: self.system_byte(),
            target_component: self.component.0,
            mavtype: MavMissionResult::MAV_MISSION_ACCEPTED,
            mission_type: FENCE,
            ..Default::default()
        })
    }
}

/// `TIMESYNC` that asks: the answer of any system carries the same `number` in `ts1`.
#[must_use]
pub fn timesync(number: i64) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { ts1: number, ..Default::default() })
}

/// A ground station's HEARTBEAT.
#[must_use]
pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_GCS,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: dialect::MINOR_MAVLINK_VERSION,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::{Mode, PX4};
    use crate::wire::{ComponentId, SystemId};

    #[test]
    fn a_command_names_its_vehicle() {
        let target = Target::new(SystemId(3), ComponentId(1)).unwrap();
        let order = Order::set_mode(&PX4, Mode::Hold);
        let MavMessage::COMMAND_LONG(data) = target.command(&order, 2) else { panic!() };
        assert_eq!((data.target_system, data.target_component, data.confirmation), (3, 1, 2));
        assert_eq!((data.param1, data.param2, data.param3), (1.0, 4.0, 3.0));
    }
}
