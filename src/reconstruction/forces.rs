//! The force problem: velocity, attitude's error and the error of the autopilot's velocity along time, and what makes the
//! specific force.
//!
//! States: velocity (world, m/s), error of the autopilot's attitude (body, rad: true = stated (1 + [phi]x)), position (m,
//! not used here), error of the autopilot's velocity (world, m/s).

use std::sync::Arc;

use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::arrow::{STATE, State};
use super::cells::{Cells, LATENESS_S, STEP_S, airframe};
use super::error::ReconstructionError;
use super::fit::{Problem, Unknown};
use super::residuals::{Group, Residuals};
use crate::physics::{Airframe, Condition, Effect, Input, MAX_ROTORS, Own, Rotors, State as Motion, effect_wrench};
use crate::recording::Recording;
use crate::vehicle::Vehicle;

/// Where each part of a state begins.
const VELOCITY: usize = 0;
const TILT: usize = 3;
const ERROR: usize = 9;

/// Indices of the parameters that every problem has.
const SCALE: usize = 0;
const BIAS: usize = 1;
const LATE_FORCE: usize = 4;
const LAG: usize = 5;
const LATE_ATTITUDE: usize = 6;
const BASE: usize = 7;

/// Share of the accelerometer that the autopilot's velocity integrates, and its forgetting, 1/s.
const SHARED: f64 = 0.9;
/// See [`SHARED`].
const FORGET_1_S: f64 = 0.5;

/// What all equations look at.
#[derive(Debug)]
struct Flight {
    cells: Cells,
    airframe: Airframe,
    mass_kg: f64,
    gravity_m_s2: f64,
    effects: Vec<(&'static dyn Effect, usize)>,
    intervals: Vec<usize>,
}

fn part(state: &State, at: usize) -> Vector3<f64> {
    state.fixed_rows::<3>(at).into_owned()
}

impl Flight {
    /// Attitude in the middle of a cell, and the specific force that the states mean, body.
    fn kinematic(&self, cell: usize, (a, b): (&State, &State), theta: &[f64]) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let tilt = (part(a, TILT) + part(b, TILT)) / 2.0 + self.cells.rate_rad_s[cell] * theta[LATE_ATTITUDE];
        let attitude = self.cells.attitude[cell] * UnitQuaternion::from_scaled_axis(tilt);
        let acceleration = (part(b, VELOCITY) - part(a, VELOCITY)) / STEP_S + Vector3::z() * self.gravity_m_s2;
        (attitude, attitude.inverse_transform_vector(&acceleration))
    }

    /// The specific force that thrust and effects make, body.
    fn modelled(&self, cell: usize, (a, b): (&State, &State), attitude: UnitQuaternion<f64>, theta: &[f64]) -> Vector3<f64> {
        let thrust_n = self.cells.thrust_n(cell, theta[LAG], theta[LATE_FORCE]);
        let state = Motion {
            position_m: self.cells.position_m[cell],
            velocity_m_s: (part(a, VELOCITY) + part(b, VELOCITY)) / 2.0,
            attitude,
            rates_rad_s: self.cells.rate_rad_s[cell],
        };
        let mut speed = [0.0; MAX_ROTORS];
        for (speed, thrust) in speed.iter_mut().zip(&thrust_n).take(self.airframe.rotor_count()) {
            *speed = self.airframe.relative_speed_of_thrust(*thrust);
        }
        let input = Input {
            time_s: self.cells.time_s[cell] + STEP_S / 2.0,
            speed_command: speed,
            speed_rate_1_s: [0.0; MAX_ROTORS],
            wind_m_s: Vector3::zeros(),
            battery_voltage_v: None,
        };
        let rotors = Rotors { speed, acceleration_1_s: [0.0; MAX_ROTORS], thrust_n };
        let own = |(effect, at): &(&'static dyn Effect, usize)| &theta[*at..*at + effect.parameters().len()];
        let mut wind_m_s = Vector3::zeros();
        for entry in &self.effects {
            wind_m_s += entry.0.wind_m_s(&input, &Own { parameters: own(entry), states: &[], rates: &mut [] });
        }
        let at = Condition::new(&self.airframe, &state, &input, wind_m_s);
        let mut force_n = Vector3::z() * thrust_n.iter().sum::<f64>() * theta[SCALE];
        for entry in &self.effects {
            let mut own = Own { parameters: own(entry), states: &[], rates: &mut [] };
            force_n += effect_wrench(entry.0, &at, &rotors, &mut own).force_n;
        }
        force_n / self.mass_kg
    }
}

/// The equation of motion: kinematic less modelled specific force, m/s^2.
#[derive(Debug)]
struct Process {
    flight: Arc<Flight>,
    parameters: Vec<usize>,
}

const MOVES: [usize; 12] = [0, 1, 2, 3, 4, 5, 12, 13, 14, 15, 16, 17];

impl Residuals for Process {
    fn intervals(&self) -> &[usize] {
        &self.flight.intervals
    }
    fn states(&self) -> &[usize] {
        &MOVES
    }
    fn parameters(&self) -> &[usize] {
        &self.parameters
    }
    fn residual(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> SVector<f64, 3> {
        let (attitude, force) = self.flight.kinematic(row, (a, b), theta);
        force - self.flight.modelled(row, (a, b), attitude, theta)
    }
}

/// The accelerometer against the kinematic force, m/s^2.
#[derive(Debug)]
struct Accelerometer {
    flight: Arc<Flight>,
    intervals: Vec<usize>,
}

impl Residuals for Accelerometer {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }
    fn states(&self) -> &[usize] {
        &MOVES
    }
    fn parameters(&self) -> &[usize] {
        &[BIAS, BIAS + 1, BIAS + 2, LATE_ATTITUDE]
    }
    fn residual(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> SVector<f64, 3> {
        let cell = self.intervals[row];
        let Some((mean, _)) = self.flight.cells.specific_force_m_s2[cell] else { return SVector::zeros() };
        mean - Vector3::from_row_slice(&theta[BIAS..BIAS + 3]) - self.flight.kinematic(cell, (a, b), theta).1
    }
    fn weight(&self, row: usize) -> f64 {
        self.flight.cells.specific_force_m_s2[self.intervals[row]].map_or(0.0, |(_, count)| count.sqrt())
    }
}

/// A part of the state that changes little from one instant to the next.
#[derive(Debug)]
struct Walk {
    flight: Arc<Flight>,
    states: [usize; 6],
}

impl Residuals for Walk {
    fn intervals(&self) -> &[usize] {
        &self.flight.intervals
    }
    fn states(&self) -> &[usize] {
        &self.states
    }
    fn parameters(&self) -> &[usize] {
        &[]
    }
    fn residual(&self, _row: usize, a: &State, b: &State, _theta: &[f64]) -> SVector<f64, 3> {
        part(b, self.states[0]) - part(a, self.states[0])
    }
}

/// A part of the first state, about nought.
#[derive(Debug)]
struct Start([usize; 3]);

impl Residuals for Start {
    fn intervals(&self) -> &[usize] {
        &[0]
    }
    fn states(&self) -> &[usize] {
        &self.0
    }
    fn parameters(&self) -> &[usize] {
        &[]
    }
    fn residual(&self, _row: usize, a: &State, _b: &State, _theta: &[f64]) -> SVector<f64, 3> {
        part(a, self.0[0])
    }
}

/// The autopilot integrates the same accelerometer with its own attitude, so the error of its velocity takes in what that
/// has of noise and lean: `e' = 0.9 (R (a - b) + g - v') - 0.5 e`.
#[derive(Debug)]
struct Mechanization {
    flight: Arc<Flight>,
}

const VELOCITY_AND_ERROR: [usize; 12] = [0, 1, 2, 9, 10, 11, 12, 13, 14, 21, 22, 23];

impl Residuals for Mechanization {
    fn intervals(&self) -> &[usize] {
        &self.flight.intervals
    }
    fn states(&self) -> &[usize] {
        &VELOCITY_AND_ERROR
    }
    fn parameters(&self) -> &[usize] {
        &[BIAS, BIAS + 1, BIAS + 2]
    }
    fn residual(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> SVector<f64, 3> {
        let cells = &self.flight.cells;
        let taken = cells.specific_force_m_s2[row].map_or_else(Vector3::zeros, |(mean, _)| {
            let felt = mean - Vector3::from_row_slice(&theta[BIAS..BIAS + 3]);
            cells.attitude[row] * felt
                - Vector3::z() * self.flight.gravity_m_s2
                - (part(b, VELOCITY) - part(a, VELOCITY)) / STEP_S
        });
        part(b, ERROR) - part(a, ERROR) * (1.0 - STEP_S * FORGET_1_S) - taken * (SHARED * STEP_S)
    }
}

/// The autopilot's velocity: the true one and its error, m/s.
#[derive(Debug)]
struct EstimatedVelocity {
    flight: Arc<Flight>,
    intervals: Vec<usize>,
}

impl Residuals for EstimatedVelocity {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }
    fn states(&self) -> &[usize] {
        &VELOCITY_AND_ERROR
    }
    fn parameters(&self) -> &[usize] {
        &[]
    }
    fn residual(&self, row: usize, a: &State, b: &State, _theta: &[f64]) -> SVector<f64, 3> {
        let (_, share, seen) = self.flight.cells.velocity_m_s[row];
        let of = |at: usize| part(a, at) * (1.0 - share) + part(b, at) * share;
        seen - of(VELOCITY) - of(ERROR)
    }
}

/// The force problem of a flight with these effects, and which of its parameters are free.
///
/// # Errors
/// [`ReconstructionError`] where the recording lacks a stream, or a flight.
pub fn force_problem(
    recording: &Recording,
    vehicle: &Vehicle,
    effects: &[&'static dyn Effect],
) -> Result<(Problem, Vec<usize>), ReconstructionError> {
    let cells = Cells::of(recording, vehicle)?;
    let lag_s = vehicle.propulsion.mean_time_constant_s();
    let unknown = |name, mean, std| Unknown { name, mean, std };
    let mut unknowns = vec![
        unknown("scale", 1.0, f64::INFINITY),
        unknown("bias_x", 0.0, 0.3),
        unknown("bias_y", 0.0, 0.3),
        unknown("bias_z", 0.0, 0.3),
        unknown("late_force", LATENESS_S, 0.002),
        unknown("lag", lag_s.unwrap_or(0.05), if lag_s.is_some() { 0.005 } else { 0.03 }),
        unknown("late_attitude", 0.0, 0.01),
    ];
    let mut placed = Vec::new();
    for effect in effects {
        placed.push((*effect, unknowns.len()));
        let is_drag = effect.id() == "linear_drag";
        for parameter in effect.parameters() {
            let mean = if is_drag { 0.3 * vehicle.body.mass_kg } else { 0.0 };
            unknowns.push(unknown(parameter.name, mean, f64::INFINITY));
        }
    }
    let count = cells.len();
    let flight = Arc::new(Flight {
        airframe: airframe(vehicle)?,
        mass_kg: vehicle.body.mass_kg,
        gravity_m_s2: vehicle.gravity_m_s2,
        effects: placed,
        intervals: (0..count).collect(),
        cells,
    });
    let cells = &flight.cells;
    let mut states = vec![State::zeros(); count + 1];
    for (state, velocity) in states.iter_mut().zip(&cells.borders_m_s) {
        state.fixed_rows_mut::<3>(VELOCITY).copy_from(velocity);
    }
    let noise = cells.accelerometer_noise_m_s2;
    let quiet = noise.max() < 0.1;
    let walk_of = |first: usize| [first, first + 1, first + 2, STATE + first, STATE + first + 1, STATE + first + 2];
    let physics = [SCALE, LATE_FORCE, LAG, LATE_ATTITUDE].into_iter().chain(BASE..unknowns.len());
    let felt = (0..count).filter(|cell| cells.specific_force_m_s2[*cell].is_some()).collect();
    let seen = cells.velocity_m_s.iter().map(|(cell, ..)| *cell).collect();
    let root = STEP_S.sqrt();
    let group = |name, form: Box<dyn Residuals>, sigma: Vector3<f64>, floor: Option<Vector3<f64>>, learned_in| Group {
        form,
        name,
        sigma,
        floor,
        learned_in,
    };
    let groups = vec![
        group(
            "process",
            Box::new(Process { flight: flight.clone(), parameters: physics.collect() }),
            Vector3::new(0.02, 0.02, 0.1),
            Some(Vector3::repeat(0.004)),
            (4, 99),
        ),
        group(
            "accelerometer",
            Box::new(Accelerometer { flight: flight.clone(), intervals: felt }),
            noise / if quiet { 0.3 } else { 0.85 },
            Some(noise * 0.9),
            (2, 4),
        ),
        group(
            "drift",
            Box::new(Walk { flight: flight.clone(), states: walk_of(TILT) }),
            Vector3::new(0.004, 0.004, 0.002) * root * if quiet { 0.1 } else { 1.0 },
            Some(Vector3::repeat(1e-4 * root)),
            (4, 99),
        ),
        group("tilt at the start", Box::new(Start([3, 4, 5])), Vector3::new(0.02, 0.02, 0.06), None, (0, 0)),
        group("error at the start", Box::new(Start([9, 10, 11])), Vector3::repeat(0.3), None, (0, 0)),
        group(
            "mechanization",
            Box::new(Mechanization { flight: flight.clone() }),
            Vector3::repeat(if quiet { 0.01 } else { 0.1 } * (2.0 * STEP_S).sqrt()),
            Some(Vector3::repeat(2e-5)),
            (4, 99),
        ),
        group(
            "velocity",
            Box::new(EstimatedVelocity { flight: flight.clone(), intervals: seen }),
            Vector3::repeat(0.003),
            None,
            (0, 0),
        ),
    ];
    let free = (0..unknowns.len()).collect();
    let time_s = flight.cells.time_s.clone();
    Ok((Problem { time_s, states, groups, unknowns, process: 0 }, free))
}
