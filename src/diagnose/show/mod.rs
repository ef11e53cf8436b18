//! The better model on flights that it has not seen.
//!
//! Everything is frozen as it was identified, but for what belongs to a moment (when a load was dropped).
//! `before` is the rigid body identified on the same flights without effects, so that no effect is paid
//! for by a wrong mass. Intervals come from resampled blocks of the flight, the same for both models.

mod bootstrap;
mod carried;
mod closed_loop;
mod floor;
mod open_loop;
mod other_vehicle;
mod split;
mod weak;

pub use bootstrap::{Compared, Interval};
pub use closed_loop::ClosedLoop;
pub use floor::{command_noise, state_noise};
pub use open_loop::{OpenLoop, WINDOWS_S};
pub use other_vehicle::{Agreement, Difference, OtherVehicle, differing};
pub use split::{Split, split_last_periods};

use super::base::Base;
use super::empirical::Empirical;
use super::explain::ExplainSettings;
use super::explanation::Explanation;
use super::trace::{Trace, TraceError};
use crate::compare::CompareError;
use crate::log::Recording;
use crate::physics::PhysicsError;
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use bootstrap::Blocks;
use carried::{Pair, carried_over, pair};

/// A flight that was not used.
#[derive(Debug, Clone, Copy)]
pub struct HeldOut<'a> {
    /// by which it is called in messages
    pub name: &'a str,
    /// conditioned with the vehicle file that the others were conditioned with
    pub signals: &'a Signals,
    /// with its setpoints, for the closed loop; `None`: it is left out
    pub recording: Option<&'a Recording>,
}

/// How it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShowSettings {
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
    /// s, length of the resampled blocks
    pub block_s: f64,
    /// resamplings
    pub draws: usize,
    /// of resamplings and noise
    pub seed: u64,
    /// the held-out part belongs to the flight that was explained
    pub same_flight: bool,
}

impl Default for ShowSettings {
    fn default() -> Self {
        Self {
            half_width_s: ExplainSettings::default().half_width_s,
            block_s: 2.0,
            draws: 400,
            seed: 1,
            same_flight: false,
        }
    }
}

/// The fit on flights that were not used.
#[derive(Debug, Clone)]
pub struct Shown {
    /// how many flights
    pub flights: usize,
    /// blocks that the intervals come from
    pub blocks: usize,
    /// open-loop prediction, one entry a length of window; none where `no_open_loop` says why
    pub open_loop: Vec<OpenLoop>,
    /// why nothing could be played back
    pub no_open_loop: Option<String>,
    /// mean over the four quantities at 0.5 s of `100 (1 - after/before)`
    pub improvement_percent: Option<Interval>,
    /// residual of the weak form, N and N m, in the order of [`super::CHANNEL_NAMES`]
    pub weak: Vec<Option<Compared>>,
    /// flown again from the recorded setpoints; `Err`: why not
    pub closed_loop: Result<ClosedLoop, String>,
    /// the held-out flights' own values against those of the model
    pub agreement: Vec<Agreement>,
    /// why the held-out flights cannot be of the identified vehicle
    pub other_vehicle: Option<OtherVehicle>,
    /// what was not simply kept, and what is not known
    pub notes: Vec<String>,
}

impl Shown {
    /// Open loop over windows of 0.5 s.
    #[must_use]
    pub fn half_second(&self) -> Option<&OpenLoop> {
        self.open_loop.iter().find(|of| (of.window_s - 0.5).abs() < 1e-9)
    }
}

/// Why nothing can be shown.
#[derive(Debug, thiserror::Error)]
pub enum ShowError {
    /// nothing to show on
    #[error("expected at least one flight to show the model on, got none")]
    NoFlight,
    /// streams are missing
    #[error("{flight}: {source}")]
    Trace {
        /// which flight
        flight: String,
        /// why
        source: TraceError,
    },
    /// cannot be played back
    #[error("{flight}: {source}")]
    Compare {
        /// which flight
        flight: String,
        /// why
        source: CompareError,
    },
    /// too little flight
    #[error(
        "{flight}: {seconds:.1} s of flight can be used, at least {needed_s:.0} s are needed to show a fit"
    )]
    TooShort {
        /// which flight
        flight: String,
        /// s that can be used
        seconds: f64,
        /// s needed
        needed_s: f64,
    },
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

/// Least flight that errors are averaged over, s.
const LEAST_S: f64 = 3.0;

/// A held-out flight made ready.
struct Ready<'a> {
    flight: &'a HeldOut<'a>,
    trace: Trace,
    pair: Pair,
}

/// Shows the explained model on flights that were not used, against the rigid body alone. `empirical` acts
/// beside the better model where no mechanism was found.
///
/// # Errors
/// [`ShowError`] where a flight lacks streams or is too short.
pub fn on_holdout(
    (explanation, empirical): (&Explanation, Option<&Empirical>),
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &ShowSettings,
) -> Result<Shown, ShowError> {
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = carried_over((explanation, empirical), (flight, &trace), vehicle, settings)?;
        ready.push(Ready { flight, trace, pair });
    }
    if ready.is_empty() {
        return Err(ShowError::NoFlight);
    }
    let mut notes: Vec<String> = ready.iter().flat_map(|ready| ready.pair.notes.clone()).collect();
    // what cannot be played back still has its residuals
    let (open_loop, improvement_percent, blocks, no_open_loop) =
        match open_loop::open_loop(&ready, empirical, settings) {
            Ok((open_loop, improvement, blocks)) => (open_loop, improvement, blocks, None),
            Err(why @ ShowError::Compare { .. }) => (Vec::new(), None, 0, Some(why.to_string())),
            Err(other) => return Err(other),
        };
    let weak = weak::residuals(&ready, explanation, empirical, settings)?;
    let (agreement, other_vehicle) = other_vehicle::judged(&ready, explanation, &weak, settings.same_flight)?;
    let closed_loop = closed_loop::flown_again(&ready, empirical, vehicle, settings);
    notes.push(
        "the floor is what white noise of the sensors and of the logged commands would leave of a model that is right; noise that an autopilot's estimator has smoothed is not in it"
            .to_owned(),
    );
    Ok(Shown {
        flights: ready.len(),
        blocks,
        open_loop,
        no_open_loop,
        improvement_percent,
        weak: weak.compared,
        closed_loop,
        agreement,
        other_vehicle,
        notes,
    })
}

/// The same open-loop errors on the flights that were used, so that both can stand side by side.
///
/// # Errors
/// [`ShowError`] where a flight cannot be played back.
pub fn on_identification(
    (explanation, empirical): (&Explanation, Option<&Empirical>),
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &ShowSettings,
) -> Result<(Vec<OpenLoop>, Option<Interval>), ShowError> {
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = pair((explanation, empirical), vehicle, trace.command_period_s);
        ready.push(Ready { flight, trace, pair });
    }
    let (open_loop, improvement, _) = open_loop::open_loop(&ready, empirical, settings)?;
    Ok((open_loop, improvement))
}

fn trace_of(flight: &HeldOut, vehicle: &Vehicle, settings: &ShowSettings) -> Result<Trace, ShowError> {
    let trace = Trace::new(flight.signals, vehicle, settings.half_width_s)
        .map_err(|source| ShowError::Trace { flight: flight.name.to_owned(), source })?;
    let seconds = flight.signals.usable.iter().filter(|usable| **usable).count() as f64 * trace.grid.step_s;
    if seconds < LEAST_S {
        return Err(ShowError::TooShort { flight: flight.name.to_owned(), seconds, needed_s: LEAST_S });
    }
    Ok(trace)
}

/// A base's model with its latency as effects.
fn flown(base: &Base) -> Result<crate::physics::Model, PhysicsError> {
    base.model(&base.latency_effects())
}
