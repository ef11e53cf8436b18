//! Expected relative standard errors of a flight.
//!
//! The simulated controller flies the planned trajectory once with its usual noise. The flight is recorded without
//! noise and conditioned as a recording is: the jitter of the commands is a nuisance of the identification and must be
//! present. A controller does not track exactly: its attitude lags behind, and the fifth harmonic may be flown larger
//! than planned by a third. The rows of that flight are those of the identification, with all its nuisances. The noise
//! is that of [`NoiseModel`], coloured by the kernel.

use super::noise::{NoiseModel, RowMotion, RowSpacing, parameter_scale};
use crate::estimate::{expected_covariance, theta_of};
use crate::recording::{Quantity, Recording};
use crate::regression::{WeakMotion, weak_rows};
use crate::signals::{ConditionSettings, Signals, ThrustPreference, WeakKernel, condition, stride};
use crate::simulate::{FlightSettings, Reference, TelemetrySettings, Truth, simulate_flight};
use crate::trajectory::FourierTrajectory;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// The part of a flight that is used for identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightSpan {
    /// flown time of the series, s
    pub flown_s: f64,
    /// time left out at its beginning, s
    pub left_out_s: f64,
}

/// Commands nearer to a bound than this are at the bound (-). A pulse width of 1 us is as much.
const COMMAND_STEP: f64 = 1e-3;

/// Transition from hover to the series, s. Longer would hide the beginning of the series, shorter would jump.
const RAMP_S: f64 = 0.5;

/// Standard errors over repeated flights of the parameters in the order of `Theta`, relative to [`parameter_scale`],
/// identified from commands. `None` if the controller cannot fly the series or the flight does not determine all
/// parameters.
#[must_use]
pub fn expected_standard_errors(
    series: &FourierTrajectory,
    vehicle: &Vehicle,
    noise: &NoiseModel,
    span: FlightSpan,
) -> Option<[f64; 7]> {
    let flown = simulated(series, vehicle, span.flown_s, 1.0)?;
    let settings = ConditionSettings {
        transient_s: Some(span.left_out_s),
        weak_half_width_s: noise.kernel_half_width_s,
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&flown, vehicle, &settings).ok()?;
    let kernel = WeakKernel::new(noise.kernel_half_width_s, signals.grid.step_s);
    let motion = WeakMotion::measured(&signals, &kernel, vehicle.gravity_m_s2);
    let rows = weak_rows(&signals, &motion, &kernel);
    let stride = stride(signals.grid.step_s);
    let centers = kernel.centers(&signals.usable, stride);
    let tilting: Vec<[f64; 3]> =
        centers.iter().map(|at| tilting(&signals, *at, vehicle.gravity_m_s2)).collect();
    let tilting = std::array::from_fn(|axis| tilting.iter().map(|factors| factors[axis]).collect());
    let rate = |at: usize| motion.omega.as_ref().map_or(0.0, |omega| omega[at].xy().norm());
    let motion = RowMotion { tilting, turning_rad_s: centers.into_iter().map(rate).collect() };
    let spacing = RowSpacing { kernel: &kernel, step_s: signals.grid.step_s, stride };
    let noise = noise.of_rows(vehicle, &spacing, motion);
    let covariance = expected_covariance(&[rows], &theta_of(&vehicle.body), &noise)?;
    let scale = parameter_scale(vehicle);
    Some(std::array::from_fn(|k| covariance[(k, k)].sqrt() / scale[k]))
}

/// The series flown by the simulated controller with this share of its usual noise, recorded without noise. `None` if
/// it cannot be flown.
fn simulated(
    series: &FourierTrajectory,
    vehicle: &Vehicle,
    flown_s: f64,
    control_noise_scale: f64,
) -> Option<Recording> {
    let reference = Reference { trajectory: series.clone(), hover_s: 0.0, ramp_s: RAMP_S };
    let telemetry = TelemetrySettings { noise_scale: 0.0, loss: 0.0, ..TelemetrySettings::default() };
    let settings =
        FlightSettings { duration_s: flown_s, control_noise_scale, telemetry, ..FlightSettings::default() };
    let flown = simulate_flight(Truth::clean(vehicle.clone()), vehicle, &reference, &settings);
    flown.ok().map(|flown| flown.recording)
}

/// Share (0 to 1) of the rotor commands at a bound of the rotor in two simulated periods of the series without noise.
/// It includes the commands that the controller adds to the plan. `None` if the series cannot be flown.
#[must_use]
pub fn share_at_bound(series: &FourierTrajectory, vehicle: &Vehicle) -> Option<f64> {
    let flown = simulated(series, vehicle, 2.0 * series.period_s, 0.0)?;
    let lowest = FlightSettings::default().command_min;
    let commands = || {
        let streams = flown.streams.iter().filter(|(key, _)| key.quantity == Quantity::ActuatorCommand);
        streams.flat_map(|(_, stream)| &stream.values).map(|value| vehicle.propulsion.normalized(*value))
    };
    let at_bound = commands().filter(|u| *u >= 1.0 - COMMAND_STEP || *u <= lowest + COMMAND_STEP).count();
    Some(at_bound as f64 / commands().count().max(1) as f64)
}

/// What a noisy tilt in hover becomes about body x, y, z: the angle is inverse to the thrust, and its share
/// about body z is the slope of the thrust axis towards the heading, which is at right angles to body y.
fn tilting(signals: &Signals, at: usize, gravity_m_s2: f64) -> [f64; 3] {
    let (Some(attitude), Some(force)) = (&signals.attitude, &signals.specific_force) else {
        return [1.0, 1.0, 0.0];
    };
    let (up, left) = (attitude[at] * Vector3::z(), attitude[at] * Vector3::y());
    let sine = up.dot(&Vector3::new(left.y, -left.x, 0.0).normalize());
    let angle = gravity_m_s2 / force[at].norm();
    [angle, angle, angle * sine / (1.0 - sine * sine).sqrt()]
}
