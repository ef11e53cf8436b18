//! Identification from the weak form: mass, inertia, actuation latency and trim torques together.

use super::expected::NoiseTerm;
use super::problem::{Channel, Problem, Solution};
use super::theta::{THETA, Theta, ThetaCovariance};
use crate::regression::{CHANNELS, WeakRows};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// Columns: Theta, latency of the torques, latency of the thrust, three trim torques, three damping
/// coefficients, the share of the commands' jitter that the rotors do not follow (less one half), and
/// drag along body z (three: by the body's own motion, by wind from north and west), and where asked for
/// the second-order term of a delay.
///
/// Thrust has a latency of its own because drag along z looks like a (negative) one; damping is there
/// because it, too, would be taken for a negative latency of the torques.
const LATENCY: usize = THETA;
const FORCE_LATENCY: usize = THETA + 1;
const TRIM: usize = THETA + 2;
const DAMPING: usize = THETA + 5;
pub(super) const JITTER: usize = THETA + 8;
const HEAVE: usize = THETA + 9;
const CURVATURE: usize = THETA + 12;
/// Gyroscopic torques with coefficients of their own, the last columns.
const GYROSCOPIC: usize = 3;
/// Standard deviations of the priors of the drag along body z per mass, 1/s, and of its force by a wind per mass,
/// m/s^2. Rotors have 0.3 to 0.6 1/s (inflow), and identification flights are rarely flown in more than 5 m/s of
/// wind. Wider priors cost precision of the mass, narrower ones bias it in wind.
const HEAVE_STD: [f64; 3] = [1.0, 2.5, 2.5];
/// Standard deviation of the prior of the share of the jitter that the rotors average: 1/sqrt(12), uniform between 0
/// and 1.
pub const JITTER_STD: f64 = 0.288_675; // 1/sqrt(12)

/// How the body follows the recorded command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Latency {
    /// s, lag and delay together
    pub total_s: f64,
    /// s, standard error
    pub std_s: f64,
    /// its kind, if the flight determines it
    pub kind: LatencyKind,
}

/// A first-order lag attenuates, a pure delay does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LatencyKind {
    /// too short to be determined
    Undetermined,
    /// first-order
    Lag,
    /// transport delay
    Delay,
    /// s of delay; the rest is lag
    Both {
        /// s
        delay_s: f64,
    },
}

/// An estimate of the weak form.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakEstimate {
    /// `[m Ixx Ixy Ixz Iyy Iyz Izz]`; NaN for parameters without a column
    pub theta: Theta,
    /// allows for coloured residuals
    pub covariance: ThetaCovariance,
    /// N m about body x, y, z, constant over the flight
    pub trim_torque_nm: [f64; 3],
    /// its standard error, N m
    pub trim_std_nm: [f64; 3],
    /// the first-order latency coefficient, s, with its standard error
    pub latency: (f64, f64),
    /// the whole solution
    pub solution: Solution,
    /// names of the equations that are measured, in the order of the solution's channels
    pub channels: Vec<&'static str>,
    /// share of each channel's variance that the rigid body explains, same order (-)
    pub explained: Vec<f64>,
}

/// Solves the weak form of one or several flights of a vehicle. `None` without a single row.
#[must_use]
pub fn solve_weak(flights: &[WeakRows], start: &Theta) -> Option<WeakEstimate> {
    solve_with(flights, start, false)
}

/// Expected covariance of the weak form's `Theta` over repeated flights, with all nuisances, for known and independent
/// noises (outputs in N and N m, channels as in [`CHANNELS`]). `None` if a parameter has no column.
#[must_use]
pub fn expected_covariance(
    flights: &[WeakRows],
    theta: &Theta,
    noise: &[NoiseTerm],
) -> Option<ThetaCovariance> {
    let problem = assemble(flights, theta, false);
    let measured: Vec<usize> = (0..CHANNELS).filter(|&c| is_measured(flights, c)).collect();
    let place = |channel: usize| measured.iter().position(|other| *other == channel);
    let noise: Vec<NoiseTerm> = noise
        .iter()
        .map(|term| {
            let reaches = term.reaches.iter();
            let reaches = reaches.filter_map(|(channel, factors)| Some((place(*channel)?, factors.clone())));
            NoiseTerm { reaches: reaches.collect(), ..term.clone() }
        })
        .collect();
    let covariance = problem.expected_covariance(&noise);
    let of_theta = covariance.view_range(..THETA.min(covariance.nrows()), ..THETA.min(covariance.ncols()));
    let known = of_theta.nrows() == THETA && (0..THETA).all(|i| of_theta[(i, i)] > 0.0);
    known.then(|| ThetaCovariance::from_fn(|i, j| of_theta[(i, j)]))
}

/// Newton passes on the latency column, which depends on the inertia that is estimated together with it. The column
/// depends weakly on the inertia; the number only limits the time.
const PASSES: usize = 4;

fn solve_with(flights: &[WeakRows], start: &Theta, curvature: bool) -> Option<WeakEstimate> {
    let nothing_measured = (0..CHANNELS).all(|channel| !is_measured(flights, channel));
    if nothing_measured || flights.iter().all(|rows| rows.time_s.is_empty()) {
        return None;
    }
    let mut theta = *start;
    for _ in 1..PASSES {
        let estimate = assemble(flights, &theta, curvature).estimate();
        for (value, new) in theta.iter_mut().zip(estimate.iter()).filter(|(_, new)| **new != 0.0) {
            *value = *new;
        }
    }
    let problem = assemble(flights, &theta, curvature);
    let solution = problem.solve();
    Some(WeakEstimate {
        theta: Theta::from_fn(|i, _| solution.theta[i]),
        covariance: solution.covariance.fixed_view::<THETA, THETA>(0, 0).into(),
        trim_torque_nm: std::array::from_fn(|i| solution.theta[TRIM + i]),
        trim_std_nm: std::array::from_fn(|i| solution.covariance[(TRIM + i, TRIM + i)].sqrt()),
        latency: (solution.theta[LATENCY], solution.covariance[(LATENCY, LATENCY)].sqrt()),
        channels: measured_channels(flights),
        explained: explained(&problem, &solution),
        solution,
    })
}

/// Lag or delay: a first-order lag `F_command = F + tau F'` has no second-order term, a delay d has
/// `d^2/2 F''`. The coefficients c1, c2 of both together give `d = c1 - sqrt(c1^2 - 2 c2)`.
#[must_use]
pub fn latency(flights: &[WeakRows], start: &Theta) -> Option<Latency> {
    let estimate = solve_with(flights, start, true)?;
    let solution = &estimate.solution;
    let (c1, c2) = (solution.theta[LATENCY], solution.theta[CURVATURE]);
    let (s1, s2) =
        (solution.covariance[(LATENCY, LATENCY)].sqrt(), solution.covariance[(CURVATURE, CURVATURE)].sqrt());
    let against_lag = (c2 / s2).abs();
    // the delta method: c2 - c1^2/2 takes its error from both
    let cross = solution.covariance[(LATENCY, CURVATURE)];
    let spread = (s2 * s2 + c1 * c1 * s1 * s1 - 2.0 * c1 * cross).max(0.0).sqrt();
    let against_delay = ((c2 - 0.5 * c1 * c1) / spread).abs();
    let kind = match (against_lag > 4.0, against_delay > 4.0) {
        (false, true) if c1 > 0.0 => LatencyKind::Lag,
        (true, false) => LatencyKind::Delay,
        (true, true) if c1 * c1 > 2.0 * c2 && c1 > 0.0 => {
            LatencyKind::Both { delay_s: c1 - (c1 * c1 - 2.0 * c2).sqrt() }
        }
        _ => LatencyKind::Undetermined,
    };
    Some(Latency { total_s: c1, std_s: s1, kind })
}

/// Stacks the flights into one problem; columns are not scaled here (the solver scales them).
fn assemble(flights: &[WeakRows], theta: &Theta, curvature: bool) -> Problem {
    let rows: usize = flights.iter().map(|flight| flight.time_s.len()).sum();
    let is_free = flights.iter().any(|flight| !flight.gyroscopic.is_empty());
    let columns = CURVATURE + usize::from(curvature) + if is_free { GYROSCOPIC } else { 0 };
    let theta = theta.map(|value| if value.is_finite() { value } else { 0.0 });
    let mut channels = Vec::new();
    for channel in 0..CHANNELS {
        if !is_measured(flights, channel) {
            continue;
        }
        let x = design((flights, curvature), &theta, channel, (rows, columns));
        let y = DVector::from_iterator(
            rows,
            flights.iter().flat_map(|flight| flight.output.iter().map(|output| output[channel])),
        );
        channels.push(Channel { y, x });
    }
    let mut runs = Vec::new();
    let mut before = 0;
    for flight in flights {
        runs.extend(flight.runs.iter().map(|run| run.start + before..run.end + before));
        before += flight.time_s.len();
    }
    Problem { channels, runs, priors: priors(theta[0]), overlap: 8 }
}

/// Priors of the nuisances: column and standard deviation.
pub(super) fn priors(mass_kg: f64) -> Vec<(usize, f64)> {
    let heave = HEAVE_STD.iter().enumerate().map(|(i, std)| (HEAVE + i, std * mass_kg));
    std::iter::once((JITTER, JITTER_STD)).chain(heave).collect()
}

fn design(
    (flights, curvature): (&[WeakRows], bool),
    theta: &Theta,
    channel: usize,
    (rows, columns): (usize, usize),
) -> DMatrix<f64> {
    let mut x = DMatrix::zeros(rows, columns);
    let series = |order: usize| flights.iter().flat_map(move |flight| flight.regressor[order].iter());
    let rates = flights.iter().flat_map(|flight| flight.rate.iter());
    let jitters = flights.iter().flat_map(|flight| flight.jitter.iter());
    let heaves = flights.iter().flat_map(|flight| flight.heave.iter());
    for (row, (((((phi, first), second), rate), jitter), heave)) in
        series(0).zip(series(1)).zip(series(2)).zip(rates).zip(jitters).zip(heaves).enumerate()
    {
        for parameter in 0..THETA {
            x[(row, parameter)] = phi[(channel, parameter)];
        }
        x[(row, JITTER)] = jitter[channel];
        if channel == 0 {
            x[(row, FORCE_LATENCY)] = dot_row(first, channel, theta);
            for (i, value) in heave.iter().enumerate() {
                x[(row, HEAVE + i)] = *value;
            }
            continue;
        }
        x[(row, LATENCY)] = dot_row(first, channel, theta);
        if curvature {
            x[(row, CURVATURE)] = dot_row(second, channel, theta);
        }
        x[(row, TRIM + channel - 1)] = 1.0;
        x[(row, DAMPING + channel - 1)] = rate[channel - 1];
    }
    let mut first = 0;
    for flight in flights.iter().filter(|_| channel > 0) {
        for (row, gyroscopic) in flight.gyroscopic.iter().enumerate() {
            x[(first + row, columns - GYROSCOPIC + channel - 1)] = gyroscopic[channel - 1];
        }
        first += flight.time_s.len();
    }
    x
}

/// Whether an equation is measured: its row of the regressor is not empty.
fn is_measured(flights: &[WeakRows], channel: usize) -> bool {
    flights.iter().any(|rows| rows.regressor[0].iter().any(|phi| phi.row(channel).norm_squared() > 0.0))
}

/// Share of each channel's variance that the rigid body explains, without the part of nuisances.
fn explained(problem: &Problem, solution: &Solution) -> Vec<f64> {
    let body: DVector<f64> = DVector::from_fn(problem.parameters(), |i, _| {
        if i < THETA && solution.theta[i].is_finite() { solution.theta[i] } else { 0.0 }
    });
    let nuisances = DVector::from_fn(problem.parameters(), |i, _| {
        if i >= THETA && solution.theta[i].is_finite() { solution.theta[i] } else { 0.0 }
    });
    problem
        .channels
        .iter()
        .map(|channel| {
            let left = &channel.y - &channel.x * &nuisances;
            let residual = &left - &channel.x * &body;
            1.0 - residual.variance() / left.variance().max(f64::MIN_POSITIVE)
        })
        .collect()
}

fn measured_channels(flights: &[WeakRows]) -> Vec<&'static str> {
    ["force_z", "torque_x", "torque_y", "torque_z"]
        .into_iter()
        .enumerate()
        .filter(|(channel, _)| is_measured(flights, *channel))
        .map(|(_, name)| name)
        .collect()
}

fn dot_row(phi: &SMatrix<f64, CHANNELS, THETA>, row: usize, theta: &SVector<f64, THETA>) -> f64 {
    (0..THETA).map(|i| phi[(row, i)] * theta[i]).sum()
}
