//! What was tried, in the order in which it is told.

use crate::diagnose::{EffectTerm, GyroscopicShare, Tested, refused_by};
use crate::text::significant;
use crate::vehicle::Vehicle;

use super::ExplainStudy;

/// Rivals of a step that are told.
const RIVALS: usize = 4;
/// Candidates about the final model that are told, the strongest first.
const LAST: usize = 12;

/// Why a rival was not taken.
const EXPLAINS_LESS: &str = "explains less than the one taken";
/// Why an effect that passes by itself is not in the model.
const NOT_TOGETHER: &str = "does not hold in a fit together with the others";

/// When an effect was tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TriedAs {
    /// taken in this step, from 1
    Taken(usize),
    /// would have passed in that step
    Rival,
    /// about the final model: not named
    Left,
}

/// One effect that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// when, and how that ended
    pub tried_as: TriedAs,
    /// identifier of the effect
    pub id: &'static str,
    /// which of its forms: the parameters that were estimated, and what was set
    pub form: String,
    /// normal deviate of the evidence
    pub z: f64,
    /// share of the residual energy
    pub gain: f64,
    /// chance over blocks of the flight
    pub p_cluster: f64,
    /// why it is not in the model; `None`: it is
    pub refused: Option<&'static str>,
}

impl Tried {
    fn new(tried_as: TriedAs, tested: &Tested, (refused, vehicle): (Option<&'static str>, &Vehicle)) -> Self {
        let of = &tested.evidence;
        let form = tested.candidate.parts.last().map_or_else(String::new, |part| form(part, vehicle));
        Self {
            tried_as,
            id: tested.candidate.id,
            form,
            z: of.z,
            gain: of.gain,
            p_cluster: of.p_cluster,
            refused,
        }
    }
}

/// Names of what is estimated of an effect, and what is set and is not zero: `cx, cy; by_face 1`.
fn form(term: &EffectTerm, vehicle: &Vehicle) -> String {
    let is_free = |slot: &usize| term.free.contains(slot);
    let name = |slot: usize| term.parameter(slot).map(|parameter| parameter.name.to_owned());
    let set = |slot: usize| {
        let (parameter, value) = (term.parameter(slot)?, term.values[slot]);
        let motor = vehicle.rotor_of(value).filter(|_| parameter.is_rotor());
        let unit = if parameter.unit == "-" { "" } else { parameter.unit };
        match motor {
            Some(index) => Some(vehicle.motor_words(index)),
            // three digits, without zeros at the end
            None if value != 0.0 => {
                let short: f64 = significant(value, 3).parse().unwrap_or(value);
                Some(format!("{} {short} {unit}", parameter.name).trim_end().to_owned())
            }
            None => None,
        }
    };
    let slots = 0..term.values.len();
    let free: Vec<String> = slots.clone().filter(is_free).filter_map(name).collect();
    let fixed = slots.filter(|slot| !is_free(slot)).filter_map(set);
    std::iter::once(free.join(", "))
        .chain(fixed)
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("; ")
}

impl ExplainStudy {
    /// Where a simulator leaves the gyroscopic torque out: the share that acts.
    #[must_use]
    pub fn gyroscopic(&self) -> Option<GyroscopicShare> {
        self.fitted().gyroscopic()
    }

    /// What was taken, step by step with its rivals, and what was tried about the final model.
    #[must_use]
    pub fn tried(&self) -> Vec<Tried> {
        let search = &self.explanation.search;
        let vehicle = self.vehicle();
        let mut all = Vec::new();
        for (index, step) in search.steps.iter().enumerate() {
            all.push(Tried::new(TriedAs::Taken(index + 1), &step.taken, (None, vehicle)));
            let rivals = step.rivals.iter().take(RIVALS);
            all.extend(rivals.map(|rival| Tried::new(TriedAs::Rival, rival, (Some(EXPLAINS_LESS), vehicle))));
        }
        let mut last: Vec<&Tested> = search.last.iter().collect();
        last.sort_by(|a, b| b.evidence.z.abs().total_cmp(&a.evidence.z.abs()));
        let (gates, count) = (&self.given.settings.gates, search.last.len() as f64);
        let refused = |tested: &Tested| {
            refused_by(tested, &search.after, gates, count).map_or(NOT_TOGETHER, |gate| gate.words())
        };
        let left = last.into_iter().take(LAST);
        all.extend(left.map(|tested| Tried::new(TriedAs::Left, tested, (Some(refused(tested)), vehicle))));
        all
    }
}
