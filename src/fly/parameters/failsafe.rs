//! The vehicle's failsafes, in sentences.

use super::sentence::Sentence;
use super::{Parameters, failsafe_ardupilot, failsafe_px4};
use crate::autopilot::Autopilot;
use crate::fly::finding::Level;

/// Reactions of the vehicle to a loss of the link, the transmitter, the battery or the fence, from its parameters.
/// `own_system` is the ground station's MAVLink system id.
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
