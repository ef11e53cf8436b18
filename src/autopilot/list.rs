//! The autopilots that are known here.

use super::ardupilot::ARDUPILOT;
use super::kind::Autopilot;
use super::px4::PX4;
use super::stack::Stack;

/// All that have a table.
pub static STACKS: [&Stack; 2] = [&PX4, &ARDUPILOT];

impl Autopilot {
    /// All that is known of it; `None` for one without a table.
    #[must_use]
    pub fn stack(self) -> Option<&'static Stack> {
        STACKS.into_iter().find(|stack| stack.autopilot == self)
    }

    /// The autopilot of a HEARTBEAT's MAV_AUTOPILOT.
    #[must_use]
    pub fn of_heartbeat(mav_autopilot: u8) -> Self {
        let known = STACKS.into_iter().find(|stack| stack.mav_autopilot as u32 == u32::from(mav_autopilot));
        known.map_or(Self::Other, |stack| stack.autopilot)
    }

    /// Its name in files.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            _ => self.stack().map_or("other", |stack| stack.id),
        }
    }

    /// The autopilot of a name in a file; [`Autopilot::Unknown`] for any other text.
    #[must_use]
    pub fn of_id(id: &str) -> Self {
        let known = STACKS.into_iter().find(|stack| stack.id == id);
        let other = if id == "other" { Self::Other } else { Self::Unknown };
        known.map_or(other, |stack| stack.autopilot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::{FlownBy, Mode};
    use mavlink::dialects::ardupilotmega::CopterMode;

    const WISHES: [Mode; 4] = [Mode::External, Mode::Hold, Mode::Land, Mode::Return];

    #[test]
    fn what_is_asked_for_is_what_is_recognised() {
        for stack in STACKS {
            for wish in WISHES {
                let (main, sub) = stack.mode_parameters(wish);
                let custom = stack.numbering.number(main, sub);
                assert!(stack.is_in(wish, custom), "{} {wish:?}", stack.name);
                assert_eq!(stack.mode_name(custom), stack.name_of(wish));
                assert_eq!(WISHES.iter().filter(|other| stack.is_in(**other, custom)).count(), 1);
                let flown_by = if wish == Mode::External { FlownBy::Companion } else { FlownBy::Autopilot };
                assert_eq!(stack.mode(custom).map(|mode| mode.flown_by), Some(flown_by), "{wish:?}");
            }
        }
    }

    #[test]
    fn a_table_has_each_number_name_and_switch_once() {
        for stack in STACKS {
            for (at, mode) in stack.modes.iter().enumerate() {
                assert_eq!(stack.mode(mode.number), Some(mode), "{}", stack.name);
                assert_eq!(stack.modes.iter().position(|other| other.name == mode.name), Some(at));
                if let Some(switch) = mode.switch {
                    assert_eq!(stack.mode_of_switch(switch), Some(mode), "{}", stack.name);
                }
                let (main, sub) = stack.numbering.parts(mode.number);
                assert_eq!(stack.numbering.number(main, sub), mode.number, "{}", mode.name);
            }
        }
    }

    #[test]
    fn arducopter_has_the_modes_of_the_message_definitions() {
        let defined: Vec<(u32, String)> = (0..=u8::MAX)
            .filter_map(|number| Some((u32::from(number), num_traits::FromPrimitive::from_u8(number)?)))
            .map(|(number, mode): (u32, CopterMode)| {
                (number, format!("{mode:?}").trim_start_matches("COPTER_MODE_").to_owned())
            })
            .collect();
        let listed: Vec<(u32, String)> =
            ARDUPILOT.modes.iter().map(|mode| (mode.number, mode.name.to_owned())).collect();
        assert_eq!(listed, defined);
    }

    #[test]
    fn autopilots_have_the_numbers_of_the_message_definitions() {
        assert_eq!(Autopilot::of_heartbeat(12), Autopilot::Px4);
        assert_eq!(Autopilot::of_heartbeat(3), Autopilot::ArduPilot);
        assert_eq!(Autopilot::of_heartbeat(18), Autopilot::Other);
    }

    #[test]
    fn a_pilots_loiter_is_not_our_hold() {
        assert!(!ARDUPILOT.is_in(Mode::Hold, 5));
    }

    #[test]
    fn unknown_modes_keep_their_number() {
        assert_eq!(ARDUPILOT.mode_name(77), "mode 0x4d");
    }

    #[test]
    fn a_name_in_a_file_is_read_back() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot, Autopilot::Other, Autopilot::Unknown] {
            assert_eq!(Autopilot::of_id(autopilot.id()), autopilot);
        }
    }
}
