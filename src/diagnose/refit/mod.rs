//! Rigid body and effects refitted together by multiple shooting: the model is simulated over short segments,
//! each from a free initial state, and compared with the measured velocity, attitude and rates.
//!
//! It rests on other equations than the weak form (simulation, not integrals of measured derivatives; no
//! accelerometer), so that its agreement with it is a check. It shares the weak form's regressors for
//! nothing but the start.
//!
//! It is a check, not the estimate: its rotor torques are the logged commands, whose jitter acts as noise on
//! the right-hand side and makes inertia some percent too large, which the weak form, with the commands on
//! the left, avoids. Lags, heights and other nonlinear parameters it finds as well or better.

mod parameters;
mod segments;
mod solve;

use super::explanation::Explanation;
use super::fit::Fitted;
use super::trace::{Trace, TraceError};
use crate::physics::PhysicsError;
use crate::signals::Signals;
use crate::simulate::SimulateError;
use crate::vehicle::Vehicle;
use parameters::Unknowns;

/// How it is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefitSettings {
    /// s, length of a segment
    pub segment_s: f64,
    /// s between the instants that are compared
    pub every_s: f64,
    /// most segments, evenly spread over the flights; bounds the cost
    pub most_segments: usize,
    /// Gauss-Newton passes
    pub passes: u32,
    /// residuals beyond so many standard deviations count less (Huber)
    pub huber: f64,
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
}

impl Default for RefitSettings {
    fn default() -> Self {
        let half_width_s = super::explain::ExplainSettings::default().half_width_s;
        Self { segment_s: 0.5, every_s: 0.05, most_segments: 120, passes: 3, huber: 3.0, half_width_s }
    }
}

/// One parameter by both ways.
#[derive(Debug, Clone, PartialEq)]
pub struct Refitted {
    /// `mass`, `ixx` ..., `latency`, or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// by the weak form
    pub weak: f64,
    /// its standard error
    pub weak_std: f64,
    /// by multiple shooting
    pub shooting: f64,
    /// its standard error, from the spread of the segments' scores
    pub shooting_std: f64,
}

impl Refitted {
    /// Difference in standard errors of the difference, taken as independent.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        (self.shooting - self.weak) / self.weak_std.hypot(self.shooting_std)
    }
}

/// The joint refit.
#[derive(Debug, Clone)]
pub struct Refit {
    /// every estimated parameter
    pub parameters: Vec<Refitted>,
    /// segments that were simulated
    pub segments: usize,
    /// mean squared residual over its own noise, at the start and at the end
    pub cost: (f64, f64),
}

/// Why there is no refit.
#[derive(Debug, thiserror::Error)]
pub enum RefitError {
    /// velocity, attitude and rates must be known
    #[error("multiple shooting needs velocity, attitude and body rates")]
    NotMeasured,
    /// no initial value for them
    #[error("effect {id} has states of its own, whose start no segment knows")]
    OwnStates {
        /// which
        id: &'static str,
    },
    /// too little flight
    #[error("only {segments} segments of {segment_s} s fit into the flights, at least {needed} are needed")]
    TooShort {
        /// that fit
        segments: usize,
        /// s
        segment_s: f64,
        /// needed
        needed: usize,
    },
    /// no mass distribution has it
    #[error(
        "the identified inertia is that of no body (one principal moment exceeds the sum of the others): a refit that keeps to physics cannot start from it"
    )]
    NoBody,
    /// the information is singular
    #[error("the segments do not determine all parameters")]
    NotDetermined,
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// the model cannot be simulated
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Fewest segments that a spread can be taken of.
const LEAST_SEGMENTS: usize = 12;

/// Refits what an explanation found on the flights that it was found in.
///
/// # Errors
/// [`RefitError`] where the flights do not allow it.
pub fn refit(
    explanation: &Explanation,
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &RefitSettings,
) -> Result<Refit, RefitError> {
    let traces: Vec<Trace> = flights
        .iter()
        .map(|signals| Trace::new(signals, vehicle, settings.half_width_s))
        .collect::<Result<_, _>>()?;
    if !traces.iter().all(|trace| trace.known.velocity && trace.known.attitude) {
        return Err(RefitError::NotMeasured);
    }
    let fitted = &explanation.search.after;
    let airframe = crate::physics::Airframe::new(&fitted.base.vehicle)?;
    if let Some(own) = fitted.base.present.iter().find(|of| of.effect.state_count(&airframe) > 0) {
        return Err(RefitError::OwnStates { id: own.effect.id() });
    }
    let unknowns = Unknowns::of(&fitted.base).ok_or(RefitError::NoBody)?;
    let segments = segments::cut(&traces, settings);
    if segments.len() < LEAST_SEGMENTS {
        let (segments, segment_s) = (segments.len(), settings.segment_s);
        return Err(RefitError::TooShort { segments, segment_s, needed: LEAST_SEGMENTS });
    }
    let noise: Vec<_> = flights.iter().map(super::show::state_noise).collect();
    let solution = solve::solve((&traces, &noise), &segments, &unknowns, settings)?;
    let weak = weak_values(fitted, &unknowns);
    let values = unknowns.natural(&solution.point);
    let parameters = unknowns
        .names()
        .into_iter()
        .enumerate()
        .map(|(index, (name, unit))| Refitted {
            name,
            unit,
            weak: weak[index].0,
            weak_std: weak[index].1,
            shooting: values[index],
            shooting_std: solution.covariance[(index, index)].max(0.0).sqrt(),
        })
        .collect();
    Ok(Refit { parameters, segments: segments.len(), cost: solution.cost })
}

/// Values and standard errors of the weak form, in the order of the unknowns.
fn weak_values(fitted: &Fitted, unknowns: &Unknowns) -> Vec<(f64, f64)> {
    let start = unknowns.natural(&unknowns.start());
    let columns = unknowns.weak_columns(fitted);
    start
        .into_iter()
        .zip(columns)
        .map(|(value, column)| {
            let std = column.map_or(f64::INFINITY, |index| fitted.covariance[(index, index)].max(0.0).sqrt());
            (value, std)
        })
        .collect()
}
