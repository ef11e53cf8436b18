//! How a pilot takes over the vehicle: the switch, the sticks, and how the motors are stopped.

use super::Parameters;
use super::sentence::Sentence;
use crate::autopilot::{KillSwitch, POSITIONS, Stack};
use crate::fly::finding::Level;

/// How the pilot takes over, or that it could not be determined; about `mode switch` and `kill switch`.
#[must_use]
pub fn takeover_declaration(parameters: &Parameters) -> Vec<Sentence> {
    let (switch, kill) = match parameters.autopilot.stack() {
        Some(stack) => (mode_switch(stack, parameters), kill_switch(stack, parameters)),
        None => {
            let text = "How a pilot takes over could not be determined: the parameters of this autopilot are not known to \
                 mavid.";
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
    format!("{what} could not be determined: {names} did not answer. Try it before the flight.")
}

fn mode_switch(stack: &Stack, parameters: &Parameters) -> Result<String, String> {
    let switches = &stack.pilot;
    if let Some((name, off)) = switches.no_transmitter
        && whole(parameters, name) == Some(off)
    {
        return Err(format!("No transmitter can take over: its input is switched off ({name} = {off})."));
    }
    let name = switches.mode_channel;
    let channel = whole(parameters, name).ok_or_else(|| not_told("The pilot's mode switch", name))?;
    if channel <= 0 {
        return Err(format!("The pilot has no mode switch ({name} = 0): a ground station alone takes over."));
    }
    took_over(&format!("channel {channel} ({name})"), &modes(stack, parameters), stack)
}

/// The modes to which the positions of the switch lead, in words, each mode once.
fn modes(stack: &Stack, parameters: &Parameters) -> Vec<String> {
    let mut modes: Vec<String> = Vec::new();
    let named = |position| {
        let value = whole(parameters, &stack.pilot.positions.name(position))?;
        match stack.mode_of_switch(value) {
            Some(mode) => Some(mode.title.to_owned()),
            None if stack.pilot.shows_unknown => Some(stack.mode_name(u32::try_from(value).ok()?)),
            None => None,
        }
    };
    for mode in POSITIONS.filter_map(named) {
        if !modes.contains(&mode) {
            modes.push(mode);
        }
    }
    modes
}

/// By the switch on a channel, to its modes beside ours.
fn took_over(channel: &str, modes: &[String], stack: &Stack) -> Result<String, String> {
    let ours = stack.wishes.external.title;
    let others: Vec<&str> = modes.iter().map(String::as_str).filter(|mode| *mode != ours).collect();
    if others.is_empty() {
        let (first, last) = (stack.pilot.positions.name(*POSITIONS.start()), POSITIONS.end());
        return Err(format!(
            "The pilot's mode switch is {channel}, but its modes could not be determined ({first} to {last} hold no \
             mode other than ours)."
        ));
    }
    Ok(format!("The pilot takes over by the mode switch, {channel}: to {}.", others.join(", ")))
}

fn kill_switch(stack: &Stack, parameters: &Parameters) -> Result<String, String> {
    match &stack.pilot.kill {
        KillSwitch::Channel(name) => match whole(parameters, name) {
            None => Err(not_told("The pilot's kill switch", name)),
            Some(channel) if channel > 0 => {
                Ok(format!("The pilot's kill switch is channel {channel} ({name})."))
            }
            Some(_) => Err(format!("The pilot has no kill switch ({name} = 0).")),
        },
        KillSwitch::Option { option, channels, stops } => {
            let name = |channel: u8| option.name(channel.into());
            let options: Vec<(u8, i32)> = channels
                .clone()
                .filter_map(|channel| Some((channel, whole(parameters, &name(channel))?)))
                .collect();
            match options.iter().find(|(_, option)| stops.contains(option)) {
                Some((channel, option)) => Ok(format!(
                    "The pilot's kill switch is channel {channel} ({} = {option}).",
                    name(*channel)
                )),
                None if options.is_empty() => {
                    let (first, last) = (name(*channels.start()), name(*channels.end()));
                    Err(not_told("The pilot's kill switch", &format!("{first} to {last}")))
                }
                None => {
                    let [one, other] = stops;
                    let any = format!("{}x{}", option.before, option.after);
                    Err(format!("The pilot has no kill switch (no {any} is {one} or {other})."))
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;

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
                assert!(level == Level::Warning && text.contains("could not be determined"), "{text}");
            }
        }
        let none = said(Autopilot::Px4, &[("RC_MAP_FLTMODE", 0.0), ("RC_MAP_KILL_SW", 0.0)]);
        assert!(
            none.iter().all(|(level, text)| *level == Level::Warning && text.contains("has no")),
            "{none:?}"
        );
        let ours = said(Autopilot::Px4, &[("RC_MAP_FLTMODE", 5.0), ("COM_FLTMODE1", 7.0)]);
        assert!(ours[0].1.contains("no mode other than ours"), "{ours:?}");
    }
}
