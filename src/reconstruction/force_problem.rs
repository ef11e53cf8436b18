//! The force problem of a flight: its states, its parameters with their priors, its residuals with their noise.

use std::sync::Arc;

use nalgebra::Vector3;

use super::blocks::State;
use super::cells::{Cells, QUIET_M_S2};
use super::error::ReconstructionError;
use super::forces::{Flight, MOST_TERMS, MOST_VALUES, Process, Term};
use super::place::STEP_S;
use super::places::{BASE, ERROR, TILT, VELOCITY};
use super::problem::{Problem, Unknown};
use super::residuals::{Group, Residuals};
use super::sensors::{
    ACCELEROMETER_TURN_STD_S, Accelerometer, EstimatedVelocity, Mechanization, ReceiverVelocity, Start,
    TiltWalk,
};
use super::thrusts::LATENESS_S;
use crate::physics::Airframe;
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// What is known of the rotors' answer to their commands beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownLag {
    /// s, between the stamp of a command and the rotors
    pub delay_s: f64,
    /// s, first order
    pub lag_s: f64,
    /// s, standard deviation of the lag
    pub lag_std_s: f64,
    /// of the lag, as [`crate::physics::ActuationLatency::uneven`]; it is held
    pub uneven: f64,
}

/// Standard deviation of the lateness of the commands, s. An autopilot stamps its outputs within its loop, 2.5 ms at
/// 400 Hz.
const LATE_STD_S: f64 = 0.002;
/// Standard deviation of the lateness of the attitude, s. A message is sent up to a period of 20 ms after what it
/// tells.
const LATE_ATTITUDE_STD_S: f64 = 0.01;
/// Standard deviation of what stamps leave open of the lateness of the autopilot's velocity, s. A message is sent up
/// to a period of 20 ms after what it tells.
const LATE_VELOCITY_STD_S: f64 = 0.01;
/// Standard deviation of the lateness of the receiver's velocity beside the one that the autopilot's velocity tells,
/// s. Autopilots allow for 0.1 to 0.2 s of delay of a receiver; this is the error of that.
const LATE_RECEIVER_STD_S: f64 = 0.05;
/// A receiver's velocity has at least this much noise, m/s: its resolution, and what is slow in its errors.
const RECEIVER_FLOOR_M_S: f64 = 0.03;
/// Standard deviation of the accelerometer's bias, m/s^2. The makers state 20 mg of offset (ICM-42688-P, data sheet,
/// table 2), and temperature adds to it.
const BIAS_STD_M_S2: f64 = 0.3;

/// The force problem of a flight with these effects.
///
/// # Errors
/// [`ReconstructionError`] where the recording lacks a stream, or a flight.
pub fn force_problem(
    signals: &Signals,
    vehicle: &Vehicle,
    known: KnownLag,
    mut terms: Vec<Term>,
) -> Result<Problem, ReconstructionError> {
    let unknown = |name, mean, std| Unknown { name, mean, std };
    let mut unknowns = vec![
        unknown("scale", 1.0, f64::INFINITY),
        unknown("bias_x", 0.0, BIAS_STD_M_S2),
        unknown("bias_y", 0.0, BIAS_STD_M_S2),
        unknown("bias_z", 0.0, BIAS_STD_M_S2),
        unknown("late_force", LATENESS_S + known.delay_s, LATE_STD_S),
        unknown("lag", known.lag_s, known.lag_std_s),
        unknown("late_attitude", 0.0, LATE_ATTITUDE_STD_S),
        unknown("late_velocity", 0.0, LATE_VELOCITY_STD_S),
        unknown("late_receiver", 0.0, LATE_RECEIVER_STD_S),
        unknown("turned", 0.0, ACCELEROMETER_TURN_STD_S),
    ];
    debug_assert_eq!(unknowns.len(), BASE);
    for term in &mut terms {
        term.first = unknowns.len();
        for &slot in &term.free {
            let all = term.effect.parameters().iter().chain(term.effect.finer_parameters());
            let name = all.map(|parameter| parameter.name).nth(slot).unwrap_or("");
            unknowns.push(unknown(name, term.values[slot], f64::INFINITY));
        }
    }
    if terms.len() > MOST_TERMS || terms.iter().any(|term| term.values.len() > MOST_VALUES) {
        return Err(ReconstructionError::TooMany);
    }
    let cells = Cells::of(signals, vehicle, known.uneven)?;
    let airframe = Airframe::new(vehicle).map_err(|error| ReconstructionError::Vehicle(error.to_string()))?;
    let intervals = (0..cells.len()).collect();
    let flight = Arc::new(Flight { airframe, terms, intervals, cells });
    let cells = &flight.cells;
    let states = cells.borders_m_s.iter().map(|velocity| {
        let mut state = State::zeros();
        state.fixed_rows_mut::<3>(VELOCITY).copy_from(velocity);
        state
    });
    Ok(Problem {
        time_s: cells.time_s.clone(),
        states: states.collect(),
        groups: groups(&flight),
        path: None,
        unknowns,
        process: 0,
    })
}

fn group(form: impl Residuals + 'static, sigma: Vector3<f64>) -> Group {
    Group { form: Box::new(form), sigma, floor: None, learned_in: (0, 0) }
}

/// First the accelerometer's level with that of the process held, then the others with the accelerometer's held: both at once
/// are one ridge.
fn groups(flight: &Arc<Flight>) -> Vec<Group> {
    const ONWARD: usize = 99;
    let cells = &flight.cells;
    let noise = cells.accelerometer_noise_m_s2;
    let quiet = noise.max() < QUIET_M_S2;
    let felt = (0..cells.len()).filter(|cell| cells.specific_force_m_s2[*cell].is_some()).collect();
    let seen = cells.velocity_m_s.iter().map(|(cell, ..)| *cell).collect();
    let root = STEP_S.sqrt();
    let learned =
        |group: Group, floor: Vector3<f64>, learned_in| Group { floor: Some(floor), learned_in, ..group };
    let process = group(Process::new(flight.clone()), Vector3::new(0.02, 0.02, 0.1));
    let accelerometer = Accelerometer { flight: flight.clone(), intervals: felt };
    let accelerometer = group(accelerometer, noise / if quiet { 0.3 } else { 0.85 });
    let walk = Vector3::new(0.004, 0.004, 0.002) * root * if quiet { 0.1 } else { 1.0 };
    let drift = group(TiltWalk(flight.clone()), walk);
    let driving = Vector3::repeat(if quiet { 0.01 } else { 0.1 } * (2.0 * STEP_S).sqrt());
    let mechanization = group(Mechanization(flight.clone()), driving);
    let velocity = EstimatedVelocity { flight: flight.clone(), intervals: seen };
    let by_receiver = cells.receiver.samples.iter().map(|seen| seen.cell).collect();
    let receiver = ReceiverVelocity { flight: flight.clone(), intervals: by_receiver };
    let receiver = group(receiver, Vector3::repeat(0.1));
    let mut groups = vec![
        learned(process, Vector3::repeat(0.004), (4, ONWARD)),
        learned(accelerometer, noise * 0.9, (2, 4)),
        learned(drift, Vector3::repeat(1e-4 * root), (4, ONWARD)),
        group(Start(TILT), Vector3::new(0.02, 0.02, 0.06)),
        group(Start(ERROR), Vector3::repeat(0.3)),
        learned(mechanization, Vector3::repeat(2e-5), (4, ONWARD)),
        group(velocity, Vector3::repeat(0.003)),
    ];
    if !cells.receiver.samples.is_empty() {
        groups.push(learned(receiver, Vector3::repeat(RECEIVER_FLOOR_M_S), (4, ONWARD)));
    }
    groups
}
