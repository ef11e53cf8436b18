//! All that is known of one autopilot.

use mavlink::dialects::ardupilotmega::MavAutopilot;

use super::failsafe::Failsafe;
use super::geometry::Geometry;
use super::kind::Autopilot;
use super::limits::{Bounded, Braking};
use super::logging::Logging;
use super::modes::{FlightMode, Mode, Numbering, Wishes};
use super::outputs::Outputs;
use super::parameters::ParameterTable;
use super::pilot::PilotSwitches;
use super::setpoints::SetpointRules;

/// All that is known of one autopilot, a "flight stack" in MAVLink's words.
#[derive(Debug)]
pub struct Stack {
    /// which
    pub autopilot: Autopilot,
    /// its name in sentences
    pub name: &'static str,
    /// its name in files and on the command line
    pub id: &'static str,
    /// the same in words, for help
    pub vehicles: &'static str,
    /// in a HEARTBEAT
    pub mav_autopilot: MavAutopilot,
    /// how a mode is written
    pub numbering: Numbering,
    /// all modes of a multirotor
    pub modes: &'static [FlightMode],
    /// those that a flight asks for
    pub wishes: Wishes,
    /// how it flies setpoints
    pub setpoints: SetpointRules,
    /// names, units, renames
    pub parameters: ParameterTable,
    /// what it does by itself
    pub failsafes: &'static [Failsafe],
    /// limits that a trajectory must keep: what is bounded, and the parameter
    pub limits: &'static [(Bounded, &'static str)],
    /// how hard it brakes
    pub braking: Braking,
    /// from commands to rotors
    pub outputs: Outputs,
    /// where the rotors are
    pub geometry: Geometry,
    /// how to make it log what identification needs, as the end of a sentence that begins with what to do
    pub logging: &'static str,
    /// parameters of logging
    pub log_settings: Logging,
    /// how a pilot takes over
    pub pilot: PilotSwitches,
    /// parameters that say what gives the height, with the value of motion capture or a camera
    pub height_by_pose: &'static [(&'static str, f64)],
}

/// There is one table of each autopilot.
impl PartialEq for Stack {
    fn eq(&self, other: &Self) -> bool {
        self.autopilot == other.autopilot
    }
}

impl Eq for Stack {}

impl Stack {
    /// Main and sub mode as `MAV_CMD_DO_SET_MODE` wants them in its second and third parameter.
    #[must_use]
    pub fn mode_parameters(&self, wish: Mode) -> (u8, u8) {
        self.numbering.parts(self.number_of(wish))
    }

    /// `custom_mode` of a HEARTBEAT or CURRENT_MODE in this mode.
    #[must_use]
    pub fn number_of(&self, wish: Mode) -> u32 {
        self.wishes.of(wish).number
    }

    /// Whether `custom_mode` of a HEARTBEAT or CURRENT_MODE is this mode.
    #[must_use]
    pub fn is_in(&self, wish: Mode, custom_mode: u32) -> bool {
        custom_mode == self.number_of(wish)
    }

    /// The mode of a `custom_mode`; `None` for one that is not known here.
    #[must_use]
    pub fn mode(&self, custom_mode: u32) -> Option<&'static FlightMode> {
        self.modes.iter().find(|mode| mode.number == custom_mode)
    }

    /// The mode to which a mode switch leads; `None` for a value that is not known here.
    #[must_use]
    pub fn mode_of_switch(&self, value: i32) -> Option<&'static FlightMode> {
        self.modes.iter().find(|mode| mode.switch == Some(value))
    }

    /// The autopilot's own name of a mode, or its number.
    #[must_use]
    pub fn mode_name(&self, custom_mode: u32) -> String {
        self.mode(custom_mode).map_or_else(|| format!("mode {custom_mode:#x}"), |mode| mode.name.to_owned())
    }

    /// The failsafe that a parameter governs; `parameter` is the older name.
    #[must_use]
    pub fn failsafe(&self, parameter: &str) -> Option<&'static Failsafe> {
        self.failsafes.iter().find(|failsafe| failsafe.parameter == parameter)
    }

    /// Whether motion capture or a camera gives the height, by the value of each parameter; `None` where no parameter that says
    /// so is known.
    #[must_use]
    pub fn has_height_by_pose(&self, value: impl Fn(&str) -> Option<f64>) -> Option<bool> {
        self.height_by_pose.iter().find_map(|(name, pose)| Some(value(name)?.round() == *pose))
    }

    /// The autopilot's own name of what is asked for.
    #[must_use]
    pub fn name_of(&self, wish: Mode) -> &'static str {
        self.wishes.of(wish).name
    }
}
