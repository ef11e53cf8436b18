//! What one may want to know of a vehicle, one entry a quantity: how well the log will tell it, or why not and what to do.

use super::evidence::Evidence;
use super::forecast::Forecast;
use super::inspection::Outlook;
use super::missing_streams::{Lack, Need, lack, remedy};
use super::outlook::judged;
use super::quantity::{ExpectedParameter, QuantitySummary};
use crate::diagnose::signatures::{DeterminedBy, EFFECT_QUANTITIES, EffectQuantity};
use crate::diagnose::{Expected, ExpectedError, LEAST_FLIGHT_S, NAME_Z, SignificantAmount};
use crate::recording::Quantity;

/// A quantity's standard error as a share of its usual size up to which it is told: an effect of usual size is then four
/// standard errors from nothing, which is what `explain` asks for.
const TOLD: f64 = 1.0 / NAME_Z;

/// One of them.
struct Asked {
    /// as in documents
    name: &'static str,
    of: Of,
    /// what to fly for more of it
    fly: &'static str,
}

/// Whose parameter a quantity is.
#[derive(Clone, Copy)]
enum Of {
    /// of the rigid body, at these places among its parameters
    Body(&'static [usize]),
    /// of an effect
    Effect(DeterminedBy),
}

const OF_THE_BODY: [Asked; 2] = [
    Asked { name: "mass", of: Of::Body(&[0]), fly: "a trajectory of `mavid plan`" },
    Asked {
        name: "inertia",
        of: Of::Body(&[1, 4, 6]),
        fly: "a trajectory of `mavid plan`: it turns about all axes",
    },
];

impl Asked {
    fn of_effect(wanted: &EffectQuantity) -> Self {
        Self { name: wanted.name, of: Of::Effect(wanted.determined_by), fly: wanted.fly }
    }

    fn needs(&self) -> &'static [Need] {
        match self.of {
            Of::Body(places) => Need::of_body(places[0]),
            Of::Effect(determined_by) => Need::of(determined_by),
        }
    }
}

/// What is known of a log's future results.
pub(super) struct Outcome<'a> {
    pub evidence: &'a Evidence<'a>,
    /// of the rigid body, in `Theta`'s order
    pub body: &'a [Outlook],
    /// of the liveliest window; `None` where that could not be tried
    pub foreseen: Option<&'a Forecast>,
    /// the liveliest window is not all of the flight
    pub at_most: bool,
}

/// One entry a quantity, in the order of the page.
pub(super) fn quantities(outcome: &Outcome<'_>) -> Vec<QuantitySummary> {
    let effects = EFFECT_QUANTITIES.iter().map(Asked::of_effect);
    OF_THE_BODY.into_iter().chain(effects).map(|asked| outcome.of(&asked)).collect()
}

impl Outcome<'_> {
    fn of(&self, asked: &Asked) -> QuantitySummary {
        let evidence = self.evidence;
        let lack = lack(evidence, asked.needs());
        let none = QuantitySummary {
            name: asked.name,
            status: "no",
            expected: Vec::new(),
            at_most: false,
            reason: None,
            fly: None,
            set: None,
        };
        if evidence.is_of_other_kind() || !evidence.holds_streams() {
            return QuantitySummary { reason: evidence.nothing(), ..none };
        }
        if let Some(reason) = evidence.nothing().filter(|_| evidence.steps_back.is_some()) {
            return QuantitySummary { reason: Some(reason), ..none };
        }
        if let Some(reason) = evidence.grounded() {
            let set = lack.map(|lack| lack.set);
            return QuantitySummary { reason: Some(reason), fly: Some(asked.fly), set, ..none };
        }
        if let Some(Lack { reason, set }) = lack {
            return QuantitySummary { reason: Some(reason), set: Some(set), ..none };
        }
        if let Some(reason) = evidence.nothing() {
            // another flight mends neither a vehicle file nor damage
            let is_mended = !(evidence.is_contradicted() || evidence.has_other_actuators())
                && evidence.damage.is_none()
                && !evidence.undefined;
            let fly = is_mended.then_some(asked.fly);
            return QuantitySummary { reason: Some(reason), fly, ..none };
        }
        match asked.of {
            Of::Body(places) => self.body((asked, places), none),
            Of::Effect(_) => self.effect(asked, none),
        }
    }

    /// Mass and inertia, by what identification would say.
    fn body(&self, (asked, places): (&Asked, &[usize]), none: QuantitySummary) -> QuantitySummary {
        let by_window = || {
            let (vehicle, body) = self.evidence.assumed?;
            Some((0..self.body.len()).map(|index| judged(vehicle, body, index)).collect::<Vec<_>>())
        };
        let by_window = by_window();
        let judged = by_window.as_deref().unwrap_or(self.body);
        let parts = || places.iter().filter_map(|index| judged.get(*index));
        let known = parts().filter_map(|part| {
            Some(ExpectedParameter {
                parameter: part.name,
                std: part.std.filter(|_| by_window.is_none()),
                unit: part.unit,
                std_relative: part.std_relative?,
                of: "value",
            })
        });
        let expected: Vec<ExpectedParameter> = known.collect();
        let missing: Vec<&Outlook> = parts().filter(|part| part.status == "not_determined").collect();
        let status = match (expected.len(), missing.len()) {
            (0, 0) => "possible",
            (_, 0) => "yes",
            (some, not) if some > 0 || not < places.len() => "partly",
            _ => "no",
        };
        // what to fly is told beside it
        let why = |part: &&Outlook| Some(part.reason.as_ref()?.split(';').next()?.to_owned());
        let told = |part: &&Outlook| Some(format!("{}: {}", part.name, why(part)?));
        let first = missing.first().and_then(why);
        let is_of_all = missing.len() == places.len() && missing.iter().all(|part| why(part) == first);
        let reasons: Vec<String> =
            if is_of_all { first.into_iter().collect() } else { missing.iter().filter_map(told).collect() };
        let at_most = self.at_most && by_window.is_some() && !expected.is_empty();
        let reason = (!reasons.is_empty()).then(|| reasons.join("; "));
        let fly = reason.is_some().then_some(asked.fly);
        QuantitySummary { status, expected, at_most, reason, fly, ..none }
    }

    /// It needs the voltage, which was recorded: a monitor is there.
    fn has_unused_voltage(&self, asked: &Asked) -> bool {
        let mut streams = self.evidence.streams.iter();
        asked.needs().last() == Some(&Need::Voltage)
            && streams.any(|(key, ..)| key.quantity == Quantity::BatteryVoltage)
    }

    /// The others, by the columns of their effects.
    fn effect(&self, asked: &Asked, none: QuantitySummary) -> QuantitySummary {
        let effects = self.foreseen.map(|foreseen| (&foreseen.effects, foreseen.assumed));
        let (errors, assumed) = match effects {
            Some((Ok(errors), assumed)) => (errors, assumed),
            Some((Err(why), _)) => {
                return QuantitySummary { reason: Some(why.clone()), fly: Some(asked.fly), ..none };
            }
            None if self.evidence.assessment.flight.usable_s < LEAST_FLIGHT_S => {
                let reason = format!(
                    "{:.1} s of flight can be used, at least {LEAST_FLIGHT_S:.0} s are needed",
                    self.evidence.assessment.flight.usable_s
                );
                return QuantitySummary { reason: Some(reason), fly: Some(asked.fly), ..none };
            }
            None => return QuantitySummary { status: "possible", ..none },
        };
        let of =
            errors.iter().find(|error: &&ExpectedError| error.quantity == asked.name).map(|error| &error.of);
        match of {
            Some(Expected::Known { parameter, std, of_usual, unit, shown }) => {
                // one that is larger than usual is told by a flight that would not tell a usual one
                let shown = shown.filter(|_| *of_usual > TOLD);
                let usual = std / of_usual;
                let (parameter, std) = shown.map_or((*parameter, *std), |shown| (shown.parameter, shown.std));
                let std_relative = std / usual;
                let (std, unit) = if assumed { without_mass(std, unit) } else { (Some(std), *unit) };
                let expected = ExpectedParameter { parameter, std, unit, std_relative, of: "usual" };
                let is_told = std_relative <= TOLD && shown.is_none();
                // what stands out is in the errors of all, and which effect it is only a search tells
                let holds = beyond(shown, errors.iter().any(ExpectedError::stands_out));
                let size = match std_relative.recip() {
                    within if within < 1.0 => "less than one standard error".to_owned(),
                    errors => format!("{errors:.1} standard errors"),
                };
                let reason = format!("an effect of usual size would be {size}{holds}");
                let not = if shown.is_some() { "partly" } else { "no" };
                QuantitySummary {
                    status: if is_told { "yes" } else { not },
                    expected: vec![expected],
                    at_most: self.at_most,
                    reason: (!is_told).then_some(reason),
                    fly: (!is_told).then_some(asked.fly),
                    ..none
                }
            }
            Some(Expected::Lacks { .. }) if self.has_unused_voltage(asked) => {
                let holds = self.evidence.still(Quantity::BatteryVoltage);
                let reason = holds.map_or("no battery voltage that can be used".to_owned(), |hold| {
                    format!("the values of the battery's voltage in this log {hold}")
                });
                QuantitySummary { reason: Some(reason), fly: Some(asked.fly), ..none }
            }
            Some(Expected::Lacks { what, why }) => {
                // what to record is told beside it
                let why = why.split(';').next().unwrap_or_default();
                let reason = format!("no {what} that can be used: {why}");
                QuantitySummary { reason: Some(reason), set: remedy(self.evidence, asked.needs()), ..none }
            }
            Some(Expected::Measured) => {
                let reason = "rotor speeds are measured, and contain it".to_owned();
                QuantitySummary { reason: Some(reason), ..none }
            }
            Some(Expected::Confused) => {
                let reason = "this flight cannot tell it from mass, inertia and latency".to_owned();
                QuantitySummary { reason: Some(reason), fly: Some(asked.fly), ..none }
            }
            None => QuantitySummary { status: "possible", ..none },
        }
    }
}

/// What is to be said of something that stands out of the flight: this quantity, or another one.
fn beyond(shown: Option<SignificantAmount>, stands_out: bool) -> String {
    match shown {
        Some(shown) => format!(
            "; but the residual would correspond to {:.1} standard errors of this effect: `explain` searches for its cause",
            shown.deviates
        ),
        None if stands_out => "; better once what stands out of this flight is known".to_owned(),
        None => String::new(),
    }
}

/// A standard error for an assumed mass of 1 kg: what goes with the mass is told for each kilogram, and what goes with the
/// size is not told.
fn without_mass(std: f64, unit: &'static str) -> (Option<f64>, &'static str) {
    match unit {
        "N/(m/s)" => (Some(std), "1/s"),
        "m" => (None, "m"),
        same => (Some(std), same),
    }
}
