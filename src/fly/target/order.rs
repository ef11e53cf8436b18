//! The commands that are given.

use crate::wire::command::{ARM_BY_FORCE, CUSTOM_MODE};
use mavlink::dialects::ardupilotmega::MavCmd;

use super::range::{MessageId, OutOfRange, Period, TakeoffHeight};
use crate::autopilot::{Mode, Stack};

/// A command before it is sent. Whatever can be written here is in range: its parameters come from the variant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Order {
    /// `MAV_CMD_DO_SET_MODE`: to enter a mode
    SetMode(&'static Stack, Mode),
    /// `MAV_CMD_COMPONENT_ARM_DISARM`: to arm, as the autopilot's own checks allow
    Arm,
    /// the same: to disarm, as the autopilot's own checks allow
    Disarm,
    /// the same, forced: to stop the motors now, wherever the vehicle is
    Kill,
    /// `MAV_CMD_NAV_TAKEOFF`: ArduCopter's takeoff in GUIDED
    Takeoff(TakeoffHeight),
    /// `MAV_CMD_SET_MESSAGE_INTERVAL`: to send a message again and again
    Interval(MessageId, Period),
    /// `MAV_CMD_REQUEST_MESSAGE`: to send a message now
    Request(MessageId),
}

impl Order {
    /// To enter a mode.
    #[must_use]
    pub fn set_mode(stack: &'static Stack, mode: Mode) -> Self {
        Self::SetMode(stack, mode)
    }

    /// To arm or disarm, as the autopilot's own checks allow.
    #[must_use]
    pub fn arm(arm: bool) -> Self {
        if arm { Self::Arm } else { Self::Disarm }
    }

    /// To stop the motors now, wherever the vehicle is.
    #[must_use]
    pub fn kill() -> Self {
        Self::Kill
    }

    /// ArduCopter's takeoff in GUIDED, m above home.
    ///
    /// # Errors
    /// No takeoff goes to that height.
    pub fn takeoff(height_m: f64) -> Result<Self, OutOfRange> {
        TakeoffHeight::new(height_m).map(Self::Takeoff)
    }

    /// To send a message again and again.
    #[must_use]
    pub fn interval(message: impl Into<MessageId>, period: Period) -> Self {
        Self::Interval(message.into(), period)
    }

    /// To send one message now.
    #[must_use]
    pub fn request_message(message: impl Into<MessageId>) -> Self {
        Self::Request(message.into())
    }

    /// Which command it is.
    #[must_use]
    pub fn command(&self) -> MavCmd {
        match self {
            Self::SetMode(..) => MavCmd::MAV_CMD_DO_SET_MODE,
            Self::Arm | Self::Disarm | Self::Kill => MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
            Self::Takeoff(_) => MavCmd::MAV_CMD_NAV_TAKEOFF,
            Self::Interval(..) => MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
            Self::Request(_) => MavCmd::MAV_CMD_REQUEST_MESSAGE,
        }
    }

    /// Its seven parameters, in MAVLink's units. What a command does not use is zero: PX4 takes a third, fourth or
    /// seventh parameter of `MAV_CMD_SET_MESSAGE_INTERVAL` that is anything else for another command.
    #[must_use]
    pub fn parameters(&self) -> [f32; 7] {
        match self {
            Self::SetMode(stack, mode) => {
                let (main, sub) = stack.mode_parameters(*mode);
                [f32::from(CUSTOM_MODE), main.into(), sub.into(), 0.0, 0.0, 0.0, 0.0]
            }
            Self::Arm => [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            Self::Disarm => [0.0; 7],
            Self::Kill => [0.0, ARM_BY_FORCE, 0.0, 0.0, 0.0, 0.0, 0.0],
            Self::Takeoff(height) => [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height.parameter()],
            Self::Interval(message, period) => {
                [message.parameter(), period.parameter(), 0.0, 0.0, 0.0, 0.0, 0.0]
            }
            Self::Request(message) => [message.parameter(), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// It only asks: it changes no mode, arms, disarms and moves nothing.
    #[must_use]
    pub fn is_question(&self) -> bool {
        match self {
            Self::Interval(..) | Self::Request(_) => true,
            Self::SetMode(..) | Self::Arm | Self::Disarm | Self::Kill | Self::Takeoff(_) => false,
        }
    }

    /// Its name for messages, without `MAV_CMD_`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{:?}", self.command()).trim_start_matches("MAV_CMD_").to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::PX4;

    #[test]
    fn only_a_kill_is_forced() {
        assert_eq!(Order::arm(false).parameters()[1], 0.0);
        assert_eq!(Order::kill().parameters()[..2], [0.0, 21_196.0]);
        assert_eq!(Order::set_mode(&PX4, Mode::Hold).name(), "DO_SET_MODE");
    }
}
