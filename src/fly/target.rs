//! Whom commands are for, and the messages that carry them.

use mavlink::dialects::ardupilotmega::{
    self as dialect, COMMAND_LONG_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag,
    MavState, MavType,
};

use super::modes::{Mode, Stack};
use crate::log::{ComponentId, SystemId};

/// The one vehicle that is commanded. Zero, MAVLink's "everybody", cannot be one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// its system
    pub system: SystemId,
    /// its autopilot's component
    pub component: ComponentId,
}

impl Target {
    /// A vehicle; `None` for the broadcast id 0 and for ids that commands have no room for (above 255).
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Option<Self> {
        (1..=255).contains(&system.0).then_some(Self { system, component })
    }

    /// The system id as messages carry it.
    #[must_use]
    pub fn system_byte(self) -> u8 {
        u8::try_from(self.system.0).unwrap_or(u8::MAX)
    }

    /// `COMMAND_LONG`.
    #[must_use]
    pub fn command(self, order: &Order, confirmation: u8) -> MavMessage {
        let [param1, param2, param3, param4, param5, param6, param7] = order.parameters;
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            param3,
            param4,
            param5,
            param6,
            param7,
            command: order.command,
            target_system: self.system_byte(),
            target_component: self.component.0,
            confirmation,
        })
    }
}

/// A command before it is sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// which
    pub command: MavCmd,
    /// its seven parameters, in MAVLink's units
    pub parameters: [f32; 7],
}

/// The typed magic of `MAV_CMD_COMPONENT_ARM_DISARM` that stops the motors in flight.
const FORCE: f32 = 21_196.0;
/// `MAV_MODE_FLAG_CUSTOM_MODE_ENABLED` as a parameter.
const CUSTOM_MODE: f32 = 1.0;

impl Order {
    /// To enter a mode.
    #[must_use]
    pub fn set_mode(stack: Stack, mode: Mode) -> Self {
        let (main, sub) = stack.mode_parameters(mode);
        Self {
            command: MavCmd::MAV_CMD_DO_SET_MODE,
            parameters: [CUSTOM_MODE, main, sub, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// To arm or disarm, as the autopilot's own checks allow.
    #[must_use]
    pub fn arm(arm: bool) -> Self {
        let value = if arm { 1.0 } else { 0.0 };
        Self {
            command: MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
            parameters: [value, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// To stop the motors now, wherever the vehicle is.
    #[must_use]
    pub fn kill() -> Self {
        Self {
            command: MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
            parameters: [0.0, FORCE, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// ArduCopter's takeoff in GUIDED, m above home.
    #[must_use]
    pub fn takeoff(height_m: f32) -> Self {
        Self { command: MavCmd::MAV_CMD_NAV_TAKEOFF, parameters: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m] }
    }

    /// To send one message now; ids are far below what a float holds exactly.
    #[must_use]
    pub fn request_message(message_id: u16) -> Self {
        let id = f32::from(message_id);
        Self { command: MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters: [id, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] }
    }

    /// It only asks: it changes no mode, arms, disarms and moves nothing.
    #[must_use]
    pub fn is_question(&self) -> bool {
        matches!(self.command, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL | MavCmd::MAV_CMD_REQUEST_MESSAGE)
    }

    /// Its name for messages, without `MAV_CMD_`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{:?}", self.command).trim_start_matches("MAV_CMD_").to_owned()
    }
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

    #[test]
    fn nobody_and_everybody_is_no_target() {
        assert!(Target::new(SystemId(0), ComponentId(1)).is_none());
        assert!(Target::new(SystemId(256), ComponentId(1)).is_none());
    }

    #[test]
    fn a_command_names_its_vehicle() {
        let target = Target::new(SystemId(3), ComponentId(1)).unwrap();
        let order = Order::set_mode(Stack::Px4, Mode::Hold);
        let MavMessage::COMMAND_LONG(data) = target.command(&order, 2) else { panic!() };
        assert_eq!((data.target_system, data.target_component, data.confirmation), (3, 1, 2));
        assert_eq!((data.param1, data.param2, data.param3), (1.0, 4.0, 3.0));
        assert_eq!(order.name(), "DO_SET_MODE");
    }

    #[test]
    fn only_a_kill_is_forced() {
        assert_eq!(Order::arm(false).parameters[1], 0.0);
        assert_eq!(Order::kill().parameters[..2], [0.0, 21_196.0]);
    }
}
