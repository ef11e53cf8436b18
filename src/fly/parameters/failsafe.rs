//! What the vehicle will do by itself, in sentences.

use super::{Parameters, failsafe_ardupilot, failsafe_px4};
use crate::fly::finding::Level;
use crate::log::Autopilot;

/// One thing that may happen and what the vehicle then does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sentence {
    /// what may happen, such as `setpoints stop`
    pub about: &'static str,
    /// [`Level::Warning`] where the outcome is unknown or not what a flight test wants
    pub level: Level,
    /// for the operator
    pub text: String,
}

/// What the vehicle will do if the link, the transmitter, the battery or the fence fails, from the
/// parameters that it sent. `own_system` is the ground station's MAVLink system id.
#[must_use]
pub fn failsafe_declaration(parameters: &Parameters, own_system: u8) -> Vec<Sentence> {
    match parameters.autopilot {
        Autopilot::Px4 => failsafe_px4::declaration(parameters),
        Autopilot::ArduPilot => failsafe_ardupilot::declaration(parameters, own_system),
        Autopilot::Other | Autopilot::Unknown => vec![Sentence {
            about: "link",
            level: Level::Warning,
            text: "What the vehicle does if the link is lost is unknown: this autopilot's failsafe \
                   parameters are not known here."
                .into(),
        }],
    }
}

/// A value of a parameter, what the vehicle does then, and whether that is what a flight test wants.
pub(super) type Choice = (i32, &'static str, Level);

/// Builds one sentence from parameters that may not have answered.
pub(super) struct Topic<'a> {
    pub parameters: &'a Parameters,
    pub about: &'static str,
}

impl Topic<'_> {
    /// A sentence.
    pub fn say(&self, level: Level, text: impl Into<String>) -> Sentence {
        Sentence { about: self.about, level, text: text.into() }
    }

    /// What cannot be told, and why.
    pub fn unknown(&self, what: &str, name: &str) -> Sentence {
        let name = self.parameters.name_of(name);
        let absent = self.parameters.absent.iter().any(|absent| absent == name);
        let why = if absent { "the vehicle has no parameter" } else { "no answer came for parameter" };
        self.say(Level::Warning, format!("{what}: unknown, because {why} {name}."))
    }

    /// `what` completed by what the value of `name` means.
    pub fn choose(&self, what: &str, name: &str, choices: &[Choice]) -> Sentence {
        let Some(value) = self.parameters.get(name) else { return self.unknown(what, name) };
        let shown = self.parameters.name_of(name);
        let found = choices.iter().find(|(choice, ..)| (value - f64::from(*choice)).abs() < 0.5);
        match found {
            Some((_, does, level)) => self.say(*level, format!("{what}: it {does} ({shown} = {value}).")),
            None => self.say(
                Level::Warning,
                format!("{what}: unknown, because {shown} = {value} has no meaning known here."),
            ),
        }
    }

    /// `name`'s value with its unit, or that it is not known.
    pub fn number(&self, name: &str, unit: &str) -> String {
        let shown = self.parameters.name_of(name);
        match self.parameters.get(name) {
            Some(value) => {
                format!("{} {unit} ({shown})", rounded(self.parameters.in_own_unit(name, value)))
            }
            None => format!("an unknown time or size ({shown} did not answer)"),
        }
    }
}

/// Single-precision values without the digits that come from widening them.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// Whether a bit of a bit mask is set.
pub(in crate::fly) fn has_bit(value: f64, bit: u32) -> bool {
    // a mask of at most 24 bits is a whole number in single precision
    let scaled = (value / f64::from(1_u32 << bit)).floor();
    (scaled / 2.0).fract() > 0.25
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(autopilot: Autopilot, values: &[(&str, f64)]) -> Parameters {
        Parameters {
            autopilot,
            values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Parameters::default()
        }
    }

    fn about<'a>(sentences: &'a [Sentence], about: &str) -> &'a Sentence {
        sentences.iter().find(|sentence| sentence.about == about).unwrap()
    }

    #[test]
    fn bits_are_read_from_floats() {
        assert!(has_bit(4.0, 2) && !has_bit(4.0, 1) && has_bit(7.0, 2) && !has_bit(8.0, 2));
    }

    #[test]
    fn px4_says_what_follows_when_setpoints_stop() {
        let safe = with(Autopilot::Px4, &[("COM_OF_LOSS_T", 1.0), ("COM_OBL_RC_ACT", 4.0)]);
        let said = failsafe_declaration(&safe, 255);
        let stop = about(&said, "setpoints stop");
        assert_eq!(stop.level, Level::Ok);
        assert!(stop.text.contains("lands") && stop.text.contains("1 s (COM_OF_LOSS_T)"), "{}", stop.text);
        let default = with(Autopilot::Px4, &[("COM_OF_LOSS_T", 1.0), ("COM_OBL_RC_ACT", 0.0)]);
        assert_eq!(about(&failsafe_declaration(&default, 255), "setpoints stop").level, Level::Warning);
    }

    #[test]
    fn what_did_not_answer_is_said() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
            let said = failsafe_declaration(&with(autopilot, &[]), 255);
            assert!(said.len() >= 5);
            for sentence in &said {
                assert_eq!(sentence.level, Level::Warning, "{sentence:?}");
                assert!(sentence.text.contains("unknown"), "{sentence:?}");
            }
        }
    }

    #[test]
    fn ardupilot_notices_only_the_ground_station_it_was_told() {
        let values = [("FS_GCS_ENABLE", 1.0), ("FS_GCS_TIMEOUT", 5.0), ("MAV_GCS_SYSID", 255.0)];
        let parameters = with(Autopilot::ArduPilot, &values);
        let heard = failsafe_declaration(&parameters, 255);
        assert_eq!(about(&heard, "ground station lost").level, Level::Ok);
        let unheard = failsafe_declaration(&parameters, 254);
        let sentence = about(&unheard, "ground station lost");
        assert_eq!(sentence.level, Level::Warning);
        assert!(sentence.text.contains("MAV_GCS_SYSID"), "{}", sentence.text);
    }
}
