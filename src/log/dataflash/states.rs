//! States, which logs write when they change and streams hold all the time.

use crate::recording::Quantity;
use crate::recording::landed::{IN_AIR, ON_GROUND};

/// A state is given again after this long, s.
const AGAIN_S: f64 = 1.0;

/// LogEvent of ArduPilot: what it means, if anything.
const EVENTS: &[(f64, Meaning)] = &[
    (10.0, Meaning::State(Quantity::Armed, 1.0)),
    (11.0, Meaning::State(Quantity::Armed, 0.0)),
    // auto armed: the throttle was raised, which only an armed vehicle follows. Logs can lack the event of arming
    (15.0, Meaning::State(Quantity::Armed, 1.0)),
    // landing complete, and airborne
    (18.0, Meaning::State(Quantity::LandedState, ON_GROUND)),
    (28.0, Meaning::State(Quantity::LandedState, IN_AIR)),
    // the estimate of height and of yaw jumped
    (60.0, Meaning::Jump),
    (62.0, Meaning::Jump),
];

/// Beginnings of texts by which a vehicle that is not armed says why it will not arm.
const REFUSALS: [&str; 2] = ["PreArm: ", "Arm: "];

/// Whether a text is one of a vehicle that is not armed.
pub(super) fn is_refusal_to_arm(text: &str) -> bool {
    REFUSALS.iter().any(|beginning| text.starts_with(beginning))
}

/// What an event means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    State(Quantity, f64),
    Jump,
}

/// What an event means, if it is known.
pub(super) fn meaning(event: f64) -> Option<Meaning> {
    EVENTS.iter().find(|(number, _)| *number == event).map(|(_, meaning)| *meaning)
}

/// States as they stand.
#[derive(Debug, Default)]
pub(super) struct States {
    known: Vec<(Quantity, f64)>,
    given_s: f64,
}

impl States {
    /// Takes a state; says whether it is the first word of it.
    pub(super) fn set(&mut self, quantity: Quantity, value: f64) -> bool {
        match self.known.iter_mut().find(|(known, _)| *known == quantity) {
            Some((_, known)) => *known = value,
            None => {
                self.known.push((quantity, value));
                return true;
            }
        }
        false
    }

    /// Whether this is the last word of it.
    pub(super) fn is(&self, quantity: Quantity, value: f64) -> bool {
        self.known.contains(&(quantity, value))
    }

    /// What is to be given again at this time, s.
    pub(super) fn due(&mut self, time_s: f64) -> &[(Quantity, f64)] {
        if time_s - self.given_s < AGAIN_S {
            return &[];
        }
        self.given_s = time_s;
        &self.known
    }
}
