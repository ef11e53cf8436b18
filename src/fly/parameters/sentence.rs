//! Sentences about the vehicle's failsafes, from parameters that may not have answered.

use super::Parameters;
use crate::autopilot::Choice;
use crate::fly::finding::Level;

/// An event and the vehicle's reaction to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sentence {
    /// the event, such as `setpoints stop`
    pub about: &'static str,
    /// [`Level::Warning`] if the reaction is unknown or not suitable for a flight test
    pub level: Level,
    /// for the operator
    pub text: String,
}

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

    /// A sentence about an unknown reaction, with the reason.
    pub fn unknown(&self, what: &str, name: &str) -> Sentence {
        let name = self.parameters.name_of(name);
        let absent = self.parameters.absent.iter().any(|absent| absent == name);
        let why = if absent { "the vehicle has no parameter" } else { "no answer came for parameter" };
        self.say(Level::Warning, format!("{what}: unknown, because {why} {name}."))
    }

    /// `what`, completed by the meaning of the value of `name`.
    pub fn choose(&self, what: &str, name: &str) -> Sentence {
        let Some(value) = self.parameters.get(name) else { return self.unknown(what, name) };
        let shown = self.parameters.name_of(name);
        let failsafe = self.parameters.autopilot.stack().and_then(|stack| stack.failsafe(name));
        match failsafe.and_then(|failsafe| failsafe.choice(value)) {
            Some(Choice { does, reaction, .. }) => {
                let level = if reaction.is_safe() { Level::Ok } else { Level::Warning };
                self.say(level, format!("{what}: it {does} ({shown} = {value})."))
            }
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
