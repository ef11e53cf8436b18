//! Design of the flight that best separates the effects that the previous flights cannot separate.

use super::envelope::flown_limits;
use super::error::NextError;
use super::flight::{Inseparable, NextFlight, Pair};
use super::foresight::{self, Foresight, Question};
use super::search;
use super::settings::NextSettings;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::signature::LatencyKind;
use crate::diagnose::signatures::{latency_kind, signature_of};
use crate::diagnose::trace::Trace;
use crate::diagnose::trace_error::TraceError;
use crate::signals::Signals;
use crate::vehicle::{Limits, Vehicle};

/// Designs the next flight for an explanation of `flights`. `vehicle` gives the limits. If it states none, those of the
/// previous flights are kept. `step` is called after each of at most [`NextSettings::work`] steps, from several threads.
///
/// # Errors
/// [`NextError`] where there is nothing to distinguish, or no room to do it in.
pub fn design(
    explanation: &Explanation,
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &NextSettings,
    step: &(dyn Fn() + Sync),
) -> Result<NextFlight, NextError> {
    let _stage = tracing::info_span!("design", flights = flights.len()).entered();
    let traces = traces(flights, vehicle, settings)?;
    let (mut questions, mut inseparable) = questions(explanation, &traces);
    let limits_are_flown = vehicle.limits == Limits::default();
    let limits = if limits_are_flown { flown_limits(flights) } else { vehicle.limits };
    if let Some(first) = questions.first().map(|question| question.named) {
        let foresight = Foresight::new(explanation, &traces, &questions, settings);
        let most = search::probed(&foresight, &limits, vehicle, settings);
        if most.is_empty() {
            return Err(NextError::NoRoom(first));
        }
        let told: Vec<bool> = most.iter().map(|most| *most > SAME_SIGMA).collect();
        let same = questions.iter().zip(&told).filter(|(_, told)| !**told);
        inseparable.extend(same.filter_map(|(question, _)| {
            Some(Inseparable { named: question.named, other: question.other()?, why: SAME })
        }));
        let mut told = told.into_iter();
        questions.retain(|_| told.next().unwrap_or(false));
    }
    if questions.is_empty() {
        return Err(if inseparable.is_empty() {
            NextError::NothingToTell
        } else {
            NextError::Inseparable(inseparable)
        });
    }
    let foresight = Foresight::new(explanation, &traces, &questions, settings);
    let (trajectory, distances) = search::best(&foresight, &limits, vehicle, (settings, step))
        .ok_or(NextError::NoRoom(questions[0].named))?;
    let mut pairs: Vec<Pair> = questions
        .iter()
        .zip(distances)
        .map(|(question, after)| Pair {
            named: question.named,
            other: question.other(),
            now: question.now,
            after,
        })
        .collect();
    pairs.sort_by(|a, b| a.after.total_cmp(&b.after));
    Ok(NextFlight {
        trajectory,
        repeats: settings.repeats,
        seconds: f64::from(settings.repeats) * settings.period_s,
        limits,
        limits_are_flown,
        pairs,
        inseparable,
    })
}

/// Distance, in standard deviations, of a named effect from another one or, with `None`, from zero. `None` if the
/// effect was not named or the other was not tested.
///
/// # Errors
/// [`TraceError`] where the flights lack streams.
pub fn told_apart(
    (explanation, named): (&Explanation, &str),
    other: Option<&'static str>,
    (flights, vehicle): (&[Signals], &Vehicle),
    settings: &NextSettings,
) -> Result<Option<f64>, TraceError> {
    let traces = traces(flights, vehicle, settings)?;
    let Some(named) = explanation.named.iter().map(|named| named.id).find(|id| *id == named) else {
        return Ok(None);
    };
    let question = match other {
        Some(other) => foresight::question(explanation, &traces, (named, other)),
        None => foresight::size(explanation, named),
    };
    Ok(question.map(|question| question.now))
}

fn traces(flights: &[Signals], vehicle: &Vehicle, settings: &NextSettings) -> Result<Vec<Trace>, TraceError> {
    flights.iter().map(|signals| Trace::new(signals, vehicle, settings.half_width_s)).collect()
}

/// Two effects whose distance stays below this many standard deviations in every tried flight have the same effect on
/// the vehicle. A tenth of what tells two effects apart: a hundred such flights would be needed.
const SAME_SIGMA: f64 = 0.5;
const SAME: &str = "in every flight inside the limits both have the same effect on the vehicle";
const BY_WEIGHING: &str =
    "weigh the vehicle before and after, swap the pack in between, and record the battery's voltage";
const BY_STATING: &str =
    "state the motors' time constant (time_constant under [propulsion]), of which nothing is known here";
const NOT_TRIED: &str = "what it would do in another flight is not known";

/// A delay of a vehicle whose motors' lag is not stated.
fn is_of_unstated_motors(named: &str, explanation: &Explanation) -> bool {
    let propulsion = &explanation.search.after.base.vehicle.propulsion;
    latency_kind(named) == Some(LatencyKind::Delay) && propulsion.mean_time_constant_s().is_none()
}

/// The pairs of all confusable sets, and those among them that no trajectory separates. If all names are certain, the
/// one with the smallest significance.
fn questions(explanation: &Explanation, traces: &[Trace]) -> (Vec<Question>, Vec<Inseparable>) {
    let (mut asked, mut inseparable): (Vec<Question>, Vec<Inseparable>) = (Vec::new(), Vec::new());
    for named in &explanation.named {
        for other in named.confusable_with.iter().map(|other| other.id) {
            let known = |a: &str, b: &str| a == named.id && b == other;
            if asked.iter().any(|q| q.other().is_some_and(|of| known(q.named, of)))
                || inseparable.iter().any(|pair| known(pair.named, pair.other))
            {
                continue;
            }
            let pair = [named.id, other];
            let role = |id: &&str| signature_of(id).map(|signature| signature.role);
            // however far it is from a lag, the motors' own may be all of it
            if is_of_unstated_motors(named.id, explanation) {
                inseparable.push(Inseparable { named: named.id, other, why: BY_STATING });
                continue;
            }
            let still = pair.iter().all(|id| role(id).is_some_and(|role| !role.by_motion))
                || pair.iter().any(|id| role(id).is_some_and(|role| role.moment.is_some()));
            let question = (!still).then(|| foresight::question(explanation, traces, (named.id, other)));
            match question {
                Some(Some(question)) => asked.push(question),
                found => {
                    let why = if found.is_none() { BY_WEIGHING } else { NOT_TRIED };
                    inseparable.push(Inseparable { named: named.id, other, why });
                }
            }
        }
    }
    if asked.is_empty() && inseparable.is_empty() {
        asked.extend(foresight::least_known(explanation));
    }
    (asked, inseparable)
}
