//! What a planner is asked for, and what it gives.

use super::bounds::Bound;
use super::check::{CheckReport, Violation};
use super::criterion::Criterion;
use super::feasible::{Conflict, StartPlace};
use super::noise::NoiseModel;
use crate::trajectory::{FourierTrajectory, SizeError};

/// Request to the planner.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRequest {
    /// T of (18), s
    pub period_s: f64,
    /// N of (18)
    pub harmonics: u32,
    /// number of periods
    pub repeats: u32,
    /// where the series starts and ends
    pub start: StartPlace,
    /// what is minimised
    pub criterion: Criterion,
    /// for the standard errors, and for D- and A-optimality
    pub noise: NoiseModel,
    /// seed of the random starts
    pub seed: u64,
    /// number of random starts
    pub starts: u64,
    /// whether a vehicle that receives no more setpoints is to come to rest inside the room, if the criterion permits
    /// it
    pub rests_inside: bool,
}

impl Default for PlanRequest {
    /// The paper's series, five periods, sixteen starts; as in the paper, the end of setpoints is not considered.
    fn default() -> Self {
        Self {
            period_s: 10.0,
            harmonics: 5,
            repeats: 5,
            start: StartPlace::default(),
            criterion: Criterion::Cond,
            noise: NoiseModel::default(),
            seed: 1,
            starts: 16,
            rests_inside: false,
        }
    }
}

/// Assessment of a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// cond(W), `W` of (20)
    pub condition_number: f64,
    /// cond(W) with columns of unit norm
    pub scaled_condition_number: f64,
    /// standard errors of the parameters in the order of `Theta`, relative to [`parameter_scale`](super::parameter_scale); `None` if the flight
    /// does not determine all of them
    pub standard_errors: Option<[f64; 7]>,
    /// the flight time for the standard errors, s
    pub flight_s: f64,
    /// bounds over one period
    pub check: CheckReport,
    /// share (0 to 1) of the rotor commands at a rotor's bound when it is flown in simulation; `None` where it cannot be
    pub share_at_bound: Option<f64>,
}

/// A planned trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// the series (18)
    pub trajectory: FourierTrajectory,
    /// the criterion's value: a condition number, or a relative standard error
    pub criterion_value: f64,
    /// its assessment
    pub assessment: Assessment,
    /// the condition that a vehicle without setpoints comes to rest inside the room; `None` if it was not requested, or
    /// if its cost was too high
    pub rest: Option<RestInside>,
}

/// The condition that a vehicle without setpoints comes to rest inside the room.
#[derive(Debug, Clone, PartialEq)]
pub struct RestInside {
    /// distance of its rotors at rest inside the room, m; negative: outside
    pub inside_m: f64,
    /// bounds in addition to those of the limits; also for the transitions to the series and back
    pub bounds: Vec<Bound>,
}

/// Errors of the planner.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// a number of the request is out of range
    #[error("{name}: expected {expected}, got {came}")]
    Request {
        /// which
        name: &'static str,
        /// what was expected
        expected: &'static str,
        /// what was given
        came: String,
    },
    /// a flight that is too long or too large
    #[error(transparent)]
    Size(#[from] SizeError),
    /// limits that cannot be kept
    #[error("limits in conflict: {0}")]
    Conflict(#[from] Conflict),
    /// the search ended outside a bound
    #[error(
        "no trajectory within the limits was found in {starts} starts; the best one breaks one: {violation}"
    )]
    OutsideLimits {
        /// number of tried starts
        starts: u64,
        /// the first broken bound
        violation: Violation,
    },
    /// no motion inside the limits determines all parameters
    #[error("no motion inside the limits determines all seven parameters")]
    NotDetermined,
}
