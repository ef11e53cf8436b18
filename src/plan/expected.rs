//! What the flight will determine, and how well: relative standard errors before it is flown.
//!
//! The planned trajectory is flown once without noise, by the simulated controller, and conditioned as a
//! recording is. A controller does not track exactly: its attitude lags behind, and the fifth harmonic may
//! be flown larger than planned by a third. The rows of that flight are those of the identification, with
//! all its nuisances; the noise is that of [`NoiseModel`], coloured by the kernel.

use super::noise::{NoiseModel, RowSpacing, parameter_scale};
use crate::estimate::{expected_covariance, theta_of};
use crate::regression::{WeakMotion, weak_rows};
use crate::signals::{ConditionSettings, Signals, ThrustPreference, WeakKernel, condition, stride};
use crate::simulate::{FlightSettings, Reference, TelemetrySettings, Truth, simulate_flight};
use crate::trajectory::FourierTrajectory;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Which part of a series' flight is identified from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightSpan {
    /// s of the series that are flown
    pub flown_s: f64,
    /// s of it that are left out at the beginning
    pub left_out_s: f64,
}

/// Change-over from hover to the series, s.
const RAMP_S: f64 = 0.5;

/// Standard errors over repeated flights of the parameters in the order of `Theta`, relative to
/// [`parameter_scale`], identified from commands. `None` where the controller cannot fly the series or
/// the flight does not determine all of them.
#[must_use]
pub fn expected_standard_errors(
    series: &FourierTrajectory,
    vehicle: &Vehicle,
    noise: &NoiseModel,
    span: FlightSpan,
) -> Option<[f64; 7]> {
    let reference = Reference { trajectory: series.clone(), hover_s: 0.0, ramp_s: RAMP_S };
    let telemetry = TelemetrySettings { noise_scale: 0.0, loss: 0.0, ..TelemetrySettings::default() };
    let settings = FlightSettings {
        duration_s: span.flown_s,
        control_noise_scale: 0.0,
        telemetry,
        ..FlightSettings::default()
    };
    let flown = simulate_flight(Truth::clean(vehicle.clone()), vehicle, &reference, &settings).ok()?;
    let settings = ConditionSettings {
        transient_s: Some(span.left_out_s),
        weak_half_width_s: noise.kernel_half_width_s,
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&flown.recording, vehicle, &settings).ok()?;
    let kernel = WeakKernel::new(noise.kernel_half_width_s, signals.grid.step_s);
    let motion = WeakMotion::measured(&signals, &kernel, vehicle.gravity_m_s2);
    let rows = weak_rows(&signals, &motion, &kernel);
    let stride = stride(signals.grid.step_s);
    let centers = kernel.centers(&signals.usable, stride);
    let tilting: Vec<[f64; 3]> =
        centers.into_iter().map(|at| tilting(&signals, at, vehicle.gravity_m_s2)).collect();
    let tilting = std::array::from_fn(|axis| tilting.iter().map(|factors| factors[axis]).collect());
    let spacing = RowSpacing { kernel: &kernel, step_s: signals.grid.step_s, stride };
    let noise = noise.of_rows(vehicle, &spacing, tilting);
    let covariance = expected_covariance(&[rows], &theta_of(&vehicle.body), &noise)?;
    let scale = parameter_scale(vehicle);
    Some(std::array::from_fn(|k| covariance[(k, k)].sqrt() / scale[k]))
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
