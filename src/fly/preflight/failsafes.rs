//! The vehicle's failsafes, and how the pilot takes over, as findings.

use super::situation::Situation;
use crate::fly::finding::{Finding, Level};
use crate::fly::parameters::{failsafe_declaration, takeover_declaration};

pub(super) fn failsafes(situation: &Situation<'_>) -> Vec<Finding> {
    let said = failsafe_declaration(situation.parameters, situation.own_system);
    let warning = |text: String| {
        let remedy = "set the parameter on the vehicle, or accept it knowingly";
        Finding::warning("failsafe", "a declared and safe end", text, remedy)
    };
    let failsafes = said.into_iter().map(|sentence| match sentence.level {
        Level::Ok => Finding::ok("failsafe", "a declared and safe end", sentence.text),
        Level::Awaited | Level::Warning | Level::Refusal => warning(sentence.text),
    });
    let takeover = takeover_declaration(situation.parameters).into_iter().map(|sentence| {
        let expected = "a pilot who can take over";
        match sentence.level {
            Level::Ok => Finding::ok(TAKEOVER, expected, sentence.text),
            _ => Finding::warning(
                TAKEOVER,
                expected,
                sentence.text,
                "set one up, or fly where nobody needs it",
            ),
        }
    });
    failsafes.chain(takeover).collect()
}

/// Subject of the findings on how the pilot takes over.
pub(super) const TAKEOVER: &str = "pilot's takeover";
