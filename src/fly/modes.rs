//! The flight modes that a flight needs, by the numbers that each autopilot gives them.

use crate::recording::Autopilot;

/// Whose rules the vehicle follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stack {
    /// PX4: setpoints are flown in OFFBOARD, which wants a stream of them before it is entered
    Px4,
    /// ArduCopter: setpoints are flown in GUIDED, after a takeoff by command
    ArduPilot,
}

/// What a flight asks a vehicle to be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// flies our setpoints: PX4 OFFBOARD, ArduCopter GUIDED
    External,
    /// stops where it is: PX4 AUTO.LOITER ("Hold"), ArduCopter BRAKE
    Hold,
    /// lands where it is
    Land,
    /// flies home and lands
    Return,
}

/// PX4: main mode in bits 16 to 23, sub mode in bits 24 to 31.
const fn px4(main: u32, sub: u32) -> u32 {
    main << 16 | sub << 24
}

const PX4_NAMES: [(u32, &str); 16] = [
    (px4(1, 0), "MANUAL"),
    (px4(2, 0), "ALTCTL"),
    (px4(3, 0), "POSCTL"),
    (px4(3, 1), "POSCTL.ORBIT"),
    (px4(3, 2), "POSCTL.SLOW"),
    (px4(4, 1), "AUTO.READY"),
    (px4(4, 2), "AUTO.TAKEOFF"),
    (px4(4, 3), "AUTO.LOITER"),
    (px4(4, 4), "AUTO.MISSION"),
    (px4(4, 5), "AUTO.RTL"),
    (px4(4, 6), "AUTO.LAND"),
    (px4(4, 9), "AUTO.PRECLAND"),
    (px4(5, 0), "ACRO"),
    (px4(6, 0), "OFFBOARD"),
    (px4(7, 0), "STABILIZED"),
    (px4(10, 0), "TERMINATION"),
];

const COPTER_NAMES: [(u32, &str); 25] = [
    (0, "STABILIZE"),
    (1, "ACRO"),
    (2, "ALT_HOLD"),
    (3, "AUTO"),
    (4, "GUIDED"),
    (5, "LOITER"),
    (6, "RTL"),
    (7, "CIRCLE"),
    (9, "LAND"),
    (11, "DRIFT"),
    (13, "SPORT"),
    (14, "FLIP"),
    (15, "AUTOTUNE"),
    (16, "POSHOLD"),
    (17, "BRAKE"),
    (18, "THROW"),
    (19, "AVOID_ADSB"),
    (20, "GUIDED_NOGPS"),
    (21, "SMART_RTL"),
    (22, "FLOWHOLD"),
    (23, "FOLLOW"),
    (24, "ZIGZAG"),
    (25, "SYSTEMID"),
    (26, "AUTOROTATE"),
    (27, "AUTO_RTL"),
];

impl Stack {
    /// The stack of an autopilot; `None` for one whose rules are not known here.
    #[must_use]
    pub fn of(autopilot: Autopilot) -> Option<Self> {
        match autopilot {
            Autopilot::Px4 => Some(Self::Px4),
            Autopilot::ArduPilot => Some(Self::ArduPilot),
            Autopilot::Unknown | Autopilot::Other => None,
        }
    }

    /// Its name for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Px4 => "PX4",
            Self::ArduPilot => "ArduPilot",
        }
    }

    /// Main and sub mode as `MAV_CMD_DO_SET_MODE` wants them in its second and third parameter.
    #[must_use]
    pub fn mode_parameters(self, mode: Mode) -> (u8, u8) {
        match (self, mode) {
            (Self::Px4, Mode::External) => (6, 0),
            (Self::Px4, Mode::Hold) => (4, 3),
            (Self::Px4, Mode::Land) => (4, 6),
            (Self::Px4, Mode::Return) => (4, 5),
            (Self::ArduPilot, Mode::External) => (4, 0),
            (Self::ArduPilot, Mode::Hold) => (17, 0),
            (Self::ArduPilot, Mode::Land) => (9, 0),
            (Self::ArduPilot, Mode::Return) => (6, 0),
        }
    }

    /// `custom_mode` of a HEARTBEAT or CURRENT_MODE in this mode.
    #[must_use]
    pub fn number_of(self, mode: Mode) -> u32 {
        match (self, mode) {
            (Self::Px4, Mode::External) => px4(6, 0),
            (Self::Px4, Mode::Hold) => px4(4, 3),
            (Self::Px4, Mode::Land) => px4(4, 6),
            (Self::Px4, Mode::Return) => px4(4, 5),
            (Self::ArduPilot, Mode::External) => 4,
            // LOITER holds too, and is never asked for: it is a pilot's
            (Self::ArduPilot, Mode::Hold) => 17,
            (Self::ArduPilot, Mode::Land) => 9,
            (Self::ArduPilot, Mode::Return) => 6,
        }
    }

    /// Whether `custom_mode` of a HEARTBEAT or CURRENT_MODE is this mode.
    #[must_use]
    pub fn is_in(self, mode: Mode, custom_mode: u32) -> bool {
        custom_mode == self.number_of(mode)
    }

    /// The autopilot's own name of a mode, or its number.
    #[must_use]
    pub fn mode_name(self, custom_mode: u32) -> String {
        let names: &[(u32, &str)] = match self {
            Self::Px4 => &PX4_NAMES,
            Self::ArduPilot => &COPTER_NAMES,
        };
        let known = names.iter().find(|(number, _)| *number == custom_mode);
        known.map_or_else(|| format!("mode {custom_mode:#x}"), |(_, name)| (*name).to_owned())
    }

    /// The autopilot's own name of what we ask for.
    #[must_use]
    pub fn name_of(self, mode: Mode) -> &'static str {
        match (self, mode) {
            (Self::Px4, Mode::External) => "OFFBOARD",
            (Self::Px4, Mode::Hold) => "AUTO.LOITER",
            (Self::Px4, Mode::Land) => "AUTO.LAND",
            (Self::Px4, Mode::Return) => "AUTO.RTL",
            (Self::ArduPilot, Mode::External) => "GUIDED",
            (Self::ArduPilot, Mode::Hold) => "BRAKE",
            (Self::ArduPilot, Mode::Land) => "LAND",
            (Self::ArduPilot, Mode::Return) => "RTL",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_is_what_is_recognised() {
        for stack in [Stack::Px4, Stack::ArduPilot] {
            for mode in [Mode::External, Mode::Hold, Mode::Land, Mode::Return] {
                let (main, sub) = stack.mode_parameters(mode);
                let custom = if stack == Stack::Px4 { px4(main.into(), sub.into()) } else { main.into() };
                assert!(stack.is_in(mode, custom), "{stack:?} {mode:?}");
                assert_eq!(stack.mode_name(custom), stack.name_of(mode));
                let others = [Mode::External, Mode::Hold, Mode::Land, Mode::Return];
                assert_eq!(others.iter().filter(|other| stack.is_in(**other, custom)).count(), 1);
            }
        }
    }

    #[test]
    fn a_pilots_loiter_is_not_our_hold() {
        assert!(!Stack::ArduPilot.is_in(Mode::Hold, 5));
    }

    #[test]
    fn unknown_modes_keep_their_number() {
        assert_eq!(Stack::ArduPilot.mode_name(77), "mode 0x4d");
    }
}
