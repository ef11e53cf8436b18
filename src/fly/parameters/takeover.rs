//! How a pilot takes the vehicle over: by which switch, by which sticks, and how the motors are stopped.

use super::Parameters;
use super::sentence::Sentence;
use crate::autopilot::{ARDUPILOT, Autopilot, PX4, Stack};
use crate::fly::finding::Level;

/// Positions of a mode switch.
const POSITIONS: std::ops::RangeInclusive<u8> = 1..=6;
/// RCn_OPTION of ArduCopter that stop the motors, and channels that may have one.
const STOPS_MOTORS: [i32; 2] = [31, 165];
const CHANNELS: std::ops::RangeInclusive<u8> = 5..=16;

/// What is known of the pilot's way to take over, or that it could not be told; about `mode switch` and `kill switch`.
#[must_use]
pub fn takeover_declaration(parameters: &Parameters) -> Vec<Sentence> {
    let (switch, kill) = match parameters.autopilot {
        Autopilot::Px4 => (px4_switch(parameters), px4_kill(parameters)),
        Autopilot::ArduPilot => (ardupilot_switch(parameters), ardupilot_kill(parameters)),
        Autopilot::Other | Autopilot::Unknown => {
            let text =
                "How a pilot takes over could not be told: this autopilot's parameters are not known here.";
            (Err(text.to_owned()), Err(text.to_owned()))
        }
    };
    let sentence = |about, said: Result<String, String>| match said {
        Ok(text) => Sentence { about, level: Level::Ok, text },
        Err(text) => Sentence { about, level: Level::Warning, text },
    };
    vec![sentence("mode switch", switch), sentence("kill switch", kill)]
}

fn whole(parameters: &Parameters, name: &str) -> Option<i32> {
    parameters.get(name).map(crate::units::whole)
}

fn not_told(what: &str, names: &str) -> String {
    format!("{what} could not be told: {names} did not answer. Try it before the flight.")
}

/// The positions of a switch that have a mode, in words, each mode once.
fn modes(named: impl Fn(u8) -> Option<String>) -> Vec<String> {
    let mut modes: Vec<String> = Vec::new();
    for mode in POSITIONS.filter_map(named) {
        if !modes.contains(&mode) {
            modes.push(mode);
        }
    }
    modes
}

fn px4_switch(parameters: &Parameters) -> Result<String, String> {
    let input = whole(parameters, "COM_RC_IN_MODE");
    if input == Some(4) {
        return Err(
            "No transmitter can take over: its input is switched off (COM_RC_IN_MODE = 4).".to_owned()
        );
    }
    let channel = whole(parameters, "RC_MAP_FLTMODE")
        .ok_or_else(|| not_told("The pilot's mode switch", "RC_MAP_FLTMODE"))?;
    if channel <= 0 {
        return Err("The pilot has no mode switch (RC_MAP_FLTMODE = 0): a ground station alone takes over."
            .to_owned());
    }
    let modes = modes(|position| {
        let value = whole(parameters, &format!("COM_FLTMODE{position}"))?;
        PX4.mode_of_switch(value).map(|mode| mode.title.to_owned())
    });
    took_over(&format!("channel {channel} (RC_MAP_FLTMODE)"), &modes, &PX4, "COM_FLTMODE1 to 6")
}

fn ardupilot_switch(parameters: &Parameters) -> Result<String, String> {
    let channel =
        whole(parameters, "FLTMODE_CH").ok_or_else(|| not_told("The pilot's mode switch", "FLTMODE_CH"))?;
    if channel <= 0 {
        return Err(
            "The pilot has no mode switch (FLTMODE_CH = 0): a ground station alone takes over.".to_owned()
        );
    }
    let modes = modes(|position| {
        let value = u32::try_from(whole(parameters, &format!("FLTMODE{position}"))?).ok()?;
        Some(ARDUPILOT.mode_name(value))
    });
    took_over(&format!("channel {channel} (FLTMODE_CH)"), &modes, &ARDUPILOT, "FLTMODE1 to 6")
}

/// By the switch on a channel, to its modes beside ours.
fn took_over(channel: &str, modes: &[String], stack: &Stack, names: &str) -> Result<String, String> {
    let ours = stack.wishes.external.title;
    let others: Vec<&str> = modes.iter().map(String::as_str).filter(|mode| *mode != ours).collect();
    if others.is_empty() {
        return Err(format!(
            "The pilot's mode switch is {channel}, but where it leads could not be told ({names} say no mode but ours)."
        ));
    }
    Ok(format!("The pilot takes over by the mode switch, {channel}: to {}.", others.join(", ")))
}

fn px4_kill(parameters: &Parameters) -> Result<String, String> {
    match whole(parameters, "RC_MAP_KILL_SW") {
        None => Err(not_told("The pilot's kill switch", "RC_MAP_KILL_SW")),
        Some(channel) if channel > 0 => {
            Ok(format!("The pilot's kill switch is channel {channel} (RC_MAP_KILL_SW)."))
        }
        Some(_) => Err("The pilot has no kill switch (RC_MAP_KILL_SW = 0).".to_owned()),
    }
}

fn ardupilot_kill(parameters: &Parameters) -> Result<String, String> {
    let options: Vec<(u8, i32)> = CHANNELS
        .filter_map(|channel| Some((channel, whole(parameters, &format!("RC{channel}_OPTION"))?)))
        .collect();
    match options.iter().find(|(_, option)| STOPS_MOTORS.contains(option)) {
        Some((channel, option)) => {
            Ok(format!("The pilot's kill switch is channel {channel} (RC{channel}_OPTION = {option})."))
        }
        None if options.is_empty() => Err(not_told("The pilot's kill switch", "RC5_OPTION to RC16_OPTION")),
        None => Err("The pilot has no kill switch (no RCx_OPTION is 31 or 165).".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(autopilot: Autopilot, values: &[(&str, f64)]) -> [(Level, String); 2] {
        let values = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let parameters = Parameters { autopilot, values, ..Parameters::default() };
        let both = takeover_declaration(&parameters);
        [0, 1].map(|index| (both[index].level, both[index].text.clone()))
    }

    #[test]
    fn switches_are_named_with_their_channels() {
        let [switch, kill] = said(
            Autopilot::Px4,
            &[("RC_MAP_FLTMODE", 5.0), ("COM_FLTMODE1", 7.0), ("COM_FLTMODE6", 2.0), ("RC_MAP_KILL_SW", 7.0)],
        );
        assert!(switch.1.contains("channel 5") && switch.1.contains("to Position."), "{switch:?}");
        assert!(kill.1.contains("channel 7") && kill.0 == Level::Ok, "{kill:?}");
        let [switch, kill] = said(
            Autopilot::ArduPilot,
            &[("FLTMODE_CH", 5.0), ("FLTMODE1", 0.0), ("FLTMODE4", 5.0), ("RC9_OPTION", 31.0)],
        );
        assert!(switch.1.contains("STABILIZE, LOITER"), "{switch:?}");
        assert!(kill.1.contains("channel 9"), "{kill:?}");
    }

    #[test]
    fn what_is_missing_or_not_known_is_a_warning() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot, Autopilot::Other] {
            for (level, text) in said(autopilot, &[]) {
                assert!(level == Level::Warning && text.contains("could not be told"), "{text}");
            }
        }
        let none = said(Autopilot::Px4, &[("RC_MAP_FLTMODE", 0.0), ("RC_MAP_KILL_SW", 0.0)]);
        assert!(
            none.iter().all(|(level, text)| *level == Level::Warning && text.contains("has no")),
            "{none:?}"
        );
        let ours = said(Autopilot::Px4, &[("RC_MAP_FLTMODE", 5.0), ("COM_FLTMODE1", 7.0)]);
        assert!(ours[0].1.contains("no mode but ours"), "{ours:?}");
    }
}
