//! The next flight: the trajectory inside the vehicle's limits that tells best apart what the flights so far
//! cannot.
//!
//! For every pair (an effect that was named, another that could stand for it) the expected distance is
//! `d^2 = theta' X' (I - P) X theta`, X the effect's weak-form columns less all that nuisances can do, P the
//! projection onto the other effect's columns: the noncentrality of the test between the two
//! (T-optimality). The smallest distance of all pairs is made as large as the limits allow.

mod envelope;
mod foresight;
mod search;

pub use envelope::flown_limits;

use super::explain::ExplainSettings;
use super::explanation::Explanation;
use super::trace::{Trace, TraceError};
use crate::physics::PhysicsError;
use crate::signals::Signals;
use crate::trajectory::FourierTrajectory;
use crate::vehicle::{Limits, Vehicle};
use foresight::{Foresight, Question};

/// What the next flight may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextSettings {
    /// s
    pub period_s: f64,
    /// of the series (18)
    pub harmonics: u32,
    /// periods that will be flown; comparing periods with each other needs four
    pub repeats: u32,
    /// random starts
    pub starts: u64,
    /// moves of each start
    pub moves: u32,
    /// same seed, same flight
    pub seed: u64,
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
}

impl Default for NextSettings {
    fn default() -> Self {
        Self {
            period_s: 10.0,
            harmonics: 5,
            repeats: 6,
            starts: 4,
            moves: 120,
            seed: 1,
            half_width_s: ExplainSettings::default().half_width_s,
        }
    }
}

/// Two effects that can be taken for each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// the one that was named
    pub named: &'static str,
    /// the other
    pub other: &'static str,
    /// standard deviations by which the flights so far tell them apart
    pub now: f64,
    /// and the next flight alone, if what was named is there at its size
    pub after: f64,
}

/// What to fly.
#[derive(Debug, Clone, PartialEq)]
pub struct NextFlight {
    /// one period
    pub trajectory: FourierTrajectory,
    /// how often
    pub repeats: u32,
    /// s, all periods
    pub seconds: f64,
    /// limits that it keeps
    pub limits: Limits,
    /// the limits are those of the flights so far, because the vehicle file has none
    pub limits_are_flown: bool,
    /// the worst pair first
    pub pairs: Vec<Pair>,
}

impl NextFlight {
    /// For people: what it will bring.
    #[must_use]
    pub fn sentence(&self) -> String {
        let pairs: Vec<String> = self
            .pairs
            .iter()
            .map(|pair| {
                format!(
                    "{} from {}: now {:.1} sigma, after {:.0} s of this {:.1} sigma",
                    pair.named, pair.other, pair.now, self.seconds, pair.after
                )
            })
            .collect();
        pairs.join("; ")
    }
}

/// Why there is no next flight.
#[derive(Debug, thiserror::Error)]
pub enum NextError {
    /// nothing to tell apart
    #[error("no effect was named that another could stand for: there is nothing to tell apart")]
    NothingToTell,
    /// only by other means
    #[error(
        "lag and delay of the rotors differ above the trajectory's frequencies: rotor speed telemetry, or doublets of 5 Hz and more, tell them apart"
    )]
    LatencyOnly,
    /// bound to a moment or to the battery
    #[error(
        "no trajectory tells {named} from {other}: weigh the vehicle before and after, swap the pack in between, and record the battery's voltage"
    )]
    NotByMotion {
        /// the one that was named
        named: &'static str,
        /// the other
        other: &'static str,
    },
    /// limits without room
    #[error("no trajectory inside the limits tells {named} from {other}")]
    NoRoom {
        /// the one that was named
        named: &'static str,
        /// the other
        other: &'static str,
    },
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

/// Designs the next flight for an explanation of `flights`. `vehicle` gives the limits; where it states none,
/// those of the flights so far are kept.
///
/// # Errors
/// [`NextError`] where there is nothing to tell apart, or no room to do it in.
pub fn design(
    explanation: &Explanation,
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &NextSettings,
) -> Result<NextFlight, NextError> {
    let traces: Vec<Trace> = flights
        .iter()
        .map(|signals| Trace::new(signals, vehicle, settings.half_width_s))
        .collect::<Result<_, _>>()?;
    let questions = questions(explanation, &traces)?;
    let limits_are_flown = vehicle.limits == Limits::default();
    let limits = if limits_are_flown { flown_limits(flights) } else { vehicle.limits };
    let foresight = Foresight::new(explanation, &traces, &questions, settings);
    let (trajectory, distances) = search::best(&foresight, &limits, vehicle, settings).ok_or_else(|| {
        let Question { named, candidate, .. } = &questions[0];
        NextError::NoRoom { named, other: candidate.id }
    })?;
    let mut pairs: Vec<Pair> = questions
        .iter()
        .zip(distances)
        .map(|(question, after)| Pair {
            named: question.named,
            other: question.candidate.id,
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
    })
}

/// Effects that depend on when, not on how the vehicle moves.
const NOT_BY_MOTION: [&str; 2] = ["mass_change", "battery_sag"];

/// The pairs of the confusable sets; where every name is certain, the pair that is nearest to each other.
fn questions(explanation: &Explanation, traces: &[Trace]) -> Result<Vec<Question>, NextError> {
    let all = foresight::questions(explanation, traces);
    let in_set = |question: &Question| {
        explanation
            .named
            .iter()
            .filter(|named| named.id == question.named)
            .any(|named| named.confusable_with.iter().any(|other| other.id == question.candidate.id))
    };
    let mut sets: Vec<Question> = all.iter().filter(|question| in_set(question)).cloned().collect();
    let by_motion = |question: &Question| {
        ![question.named, question.candidate.id].iter().any(|id| NOT_BY_MOTION.contains(id))
    };
    if let Some(Question { named, candidate, .. }) = sets.first().filter(|_| !sets.iter().any(by_motion)) {
        return Err(NextError::NotByMotion { named, other: candidate.id });
    }
    sets.retain(by_motion);
    if sets.is_empty() {
        let nearest = all.into_iter().filter(by_motion).min_by(|a, b| a.now.total_cmp(&b.now));
        sets.extend(nearest);
    }
    if sets.is_empty() {
        let latency = explanation.named.iter().any(|named| !named.confusable_with.is_empty());
        return Err(if latency { NextError::LatencyOnly } else { NextError::NothingToTell });
    }
    Ok(sets)
}
