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

/// Two effects that can be taken for each other, or one and nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// the one that was named
    pub named: &'static str,
    /// the other; `None` where nothing could be taken for it: how far it stands out of the noise
    pub other: Option<&'static str>,
    /// standard deviations by which the flights so far tell them apart
    pub now: f64,
    /// and the next flight alone, if what was named is there at its size
    pub after: f64,
}

/// Two effects that no trajectory tells apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inseparable {
    /// the one that was named
    pub named: &'static str,
    /// the other
    pub other: &'static str,
    /// and what does
    pub why: &'static str,
}

impl std::fmt::Display for Inseparable {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "no trajectory tells {} from {}: {}", self.named, self.other, self.why)
    }
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
    /// what it cannot tell apart, nor any other
    pub inseparable: Vec<Inseparable>,
}

impl NextFlight {
    /// For people: what it will bring.
    #[must_use]
    pub fn sentence(&self) -> String {
        let after = |pair: &Pair| {
            format!("now {:.1} sigma, after {:.0} s of this {:.1} sigma", pair.now, self.seconds, pair.after)
        };
        let pairs = self.pairs.iter().map(|pair| match pair.other {
            Some(other) => {
                let better = if foresight::is_latency(pair.named) && pair.after < ENOUGH_SIGMA {
                    BY_SPEEDS
                } else {
                    ""
                };
                format!("{} from {other}: {}{better}", pair.named, after(pair))
            }
            None => format!("nothing stands for {}, which is known to: {}", pair.named, after(pair)),
        });
        pairs.chain(self.inseparable.iter().map(ToString::to_string)).collect::<Vec<_>>().join("; ")
    }
}

/// Why there is no next flight.
#[derive(Debug, thiserror::Error)]
pub enum NextError {
    /// nothing to tell apart
    #[error(
        "there is nothing to tell apart: nothing was named that could be taken for another effect, or that motion would show better"
    )]
    NothingToTell,
    /// only by other means
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Inseparable(Vec<Inseparable>),
    /// limits without room
    #[error("no flight inside the limits shows {0}")]
    NoRoom(&'static str),
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
    let (trajectory, distances) =
        search::best(&foresight, &limits, vehicle, settings).ok_or(NextError::NoRoom(questions[0].named))?;
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

/// Standard deviations by which flights tell a named effect from another that could stand for it, or, with `None`,
/// from nothing; `None` where the effect was not named or the other was not tried.
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

/// Below this many standard deviations in every flight that was tried, two effects do the same.
const SAME_SIGMA: f64 = 0.5;
/// Below this many standard deviations two effects are not told apart.
const ENOUGH_SIGMA: f64 = 5.0;
const BY_SPEEDS: &str = " (rotor speed telemetry, or doublets of 5 Hz and more, tell them apart)";
const SAME: &str = "in every flight inside the limits both do the same to the vehicle";
/// What neither depends on how the vehicle moves.
const NOT_BY_MOTION: [&str; 2] = ["mass_change", "battery_sag"];
const BY_WEIGHING: &str =
    "weigh the vehicle before and after, swap the pack in between, and record the battery's voltage";
const NOT_TRIED: &str = "what it would do in another flight is not known";

/// The pairs of all confusable sets, and of those what no trajectory tells apart; where every name is certain, the
/// one that is known worst.
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
            let still = pair.iter().all(|id| NOT_BY_MOTION.contains(id)) || pair.contains(&"mass_change");
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
