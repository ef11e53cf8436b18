//! The equation of motion of the force problem: what thrust and effects make of velocity and attitude.
//!
//! States: velocity (world, m/s), error of the autopilot's attitude (body, rad: true = stated (1 + [phi]x)), error of the
//! autopilot's velocity (world, m/s).

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::blocks::{Columns, Pair, STATE, State, WIDTH};
use super::cells::Cells;
use super::place::STEP_S;
use super::places::{LAG, LATE_ATTITUDE, LATE_FORCE, SCALE, TILT, VELOCITY};
use super::residuals::{Residuals, Row};
use crate::physics::{
    Airframe, Condition, Effect, Input, MAX_ROTORS, Own, Rotors, State as Motion, effects_wrench,
};

/// Steps of the derivatives by differences: m/s and rad. Small against what sensors resolve and large against
/// rounding: the difference is exact to six digits.
const MOVED: f64 = 1e-5;
/// Steps of latenesses and lags, s. Small against a cell and large against rounding.
const MOVED_S: f64 = 1e-4;
/// Values that an effect has at most.
pub(super) const MOST_VALUES: usize = 16;
/// Effects that a problem has at most.
pub(super) const MOST_TERMS: usize = 16;

/// An effect of the force problem.
#[derive(Debug, Clone)]
pub struct Term {
    /// its equation
    pub effect: &'static dyn Effect,
    /// values, in the order of its parameters
    pub values: Vec<f64>,
    /// slots of the values that are estimated
    pub free: Vec<usize>,
    /// steps of their derivatives by differences, one each
    pub steps: Vec<f64>,
    /// index of the first estimated value among the parameters
    pub(super) first: usize,
}

impl Term {
    /// An effect at these values, of which `free` are estimated; `steps` are those of the derivatives by them.
    #[must_use]
    pub fn new(effect: &'static dyn Effect, values: Vec<f64>, free: Vec<usize>, steps: Vec<f64>) -> Self {
        Self { effect, values, free, steps, first: 0 }
    }

    fn put(&self, theta: &[f64], values: &mut [f64; MOST_VALUES]) {
        for (value, of) in values.iter_mut().zip(&self.values) {
            *value = *of;
        }
        for (place, &slot) in self.free.iter().enumerate() {
            values[slot] = theta[self.first + place];
        }
    }
}

/// Values of each term.
type Values = [[f64; MOST_VALUES]; MOST_TERMS];

/// What all equations look at.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) cells: Cells,
    pub(super) airframe: Airframe,
    pub(super) terms: Vec<Term>,
    pub(super) intervals: Vec<usize>,
}

/// Three components of a state.
pub(super) fn part(state: &State, at: usize) -> Vector3<f64> {
    state.fixed_rows::<3>(at).into_owned()
}

/// What both states say of the motion in a cell.
pub(super) struct Kinematics {
    velocity_m_s: Vector3<f64>,
    tilt_rad: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    /// world to body
    pub(super) to_body: Matrix3<f64>,
    /// specific force, body, m/s^2
    pub(super) force_m_s2: Vector3<f64>,
    /// its derivative by the tilt
    pub(super) by_tilt: Matrix3<f64>,
}

impl Flight {
    pub(super) fn kinematics(&self, cell: usize, (a, b): (&State, &State), theta: &[f64]) -> Kinematics {
        let tilt_rad =
            (part(a, TILT) + part(b, TILT)) / 2.0 + self.cells.rate_rad_s[cell] * theta[LATE_ATTITUDE];
        let attitude = self.tilted(cell, &tilt_rad);
        let up = Vector3::z() * self.airframe.gravity_m_s2;
        let acceleration = (part(b, VELOCITY) - part(a, VELOCITY)) / STEP_S + up;
        let to_body = attitude.to_rotation_matrix().matrix().transpose();
        let force_m_s2 = to_body * acceleration;
        // right Jacobian of the rotation, to first order in the small tilt
        let turning = Matrix3::identity() - tilt_rad.cross_matrix() / 2.0;
        let by_tilt = force_m_s2.cross_matrix() * turning;
        let velocity_m_s = (part(a, VELOCITY) + part(b, VELOCITY)) / 2.0;
        Kinematics { velocity_m_s, tilt_rad, attitude, to_body, force_m_s2, by_tilt }
    }

    fn tilted(&self, cell: usize, tilt_rad: &Vector3<f64>) -> UnitQuaternion<f64> {
        self.cells.attitude[cell] * UnitQuaternion::from_scaled_axis(*tilt_rad)
    }

    /// The rotors in a cell behind lag and lateness, s.
    fn rotors(&self, cell: usize, lag_s: f64, late_s: f64) -> Rotors {
        let thrust_n = self.cells.thrusts.behind(cell, lag_s, late_s);
        let mut speed = [0.0; MAX_ROTORS];
        for (speed, thrust) in speed.iter_mut().zip(&thrust_n).take(self.airframe.rotor_count()) {
            *speed = self.airframe.relative_speed_of_thrust(*thrust);
        }
        Rotors { speed, acceleration_1_s: [0.0; MAX_ROTORS], thrust_n }
    }

    /// Values of the terms at parameters.
    fn values(&self, theta: &[f64]) -> Values {
        let mut values = [[0.0; MOST_VALUES]; MOST_TERMS];
        values.iter_mut().zip(&self.terms).for_each(|(values, term)| term.put(theta, values));
        values
    }

    /// The specific force that thrust and effects make, body, m/s^2, at a scale of nominal over true mass.
    fn modelled(
        &self,
        cell: usize,
        (velocity_m_s, attitude): (Vector3<f64>, UnitQuaternion<f64>),
        rotors: &Rotors,
        (scale, values): (f64, &Values),
    ) -> Vector3<f64> {
        let cells = &self.cells;
        let rates_rad_s = cells.rate_rad_s[cell];
        let state = Motion { position_m: cells.position_m[cell], velocity_m_s, attitude, rates_rad_s };
        let input = Input {
            time_s: cells.time_s[cell] + STEP_S / 2.0,
            speed_command: rotors.speed,
            speed_rate_1_s: [0.0; MAX_ROTORS],
            wind_m_s: Vector3::zeros(),
            battery_voltage_v: cells.battery_voltage_v.as_ref().map(|all| all[cell]),
        };
        let effects =
            self.terms.iter().zip(values).map(|(term, values)| (term.effect, &values[..term.values.len()]));
        let wind = |(effect, parameters): (&'static dyn Effect, &[f64])| {
            effect.wind_m_s(&input, &Own { parameters, states: &[], rates: &mut [] })
        };
        let at = Condition::new(&self.airframe, &state, &input, effects.clone().map(wind).sum());
        let effects = effects.map(|(effect, parameters)| (effect as &dyn Effect, parameters));
        let force_n = effects_wrench(effects, &at, rotors).force_n;
        force_n * (scale / self.airframe.mass_kg)
    }
}

/// The equation of motion: kinematic less modelled specific force, m/s^2.
#[derive(Debug)]
pub(super) struct Process {
    flight: std::sync::Arc<Flight>,
    /// cells whose commands are known
    intervals: Vec<usize>,
    parameters: Vec<usize>,
}

impl Process {
    pub(super) fn new(flight: std::sync::Arc<Flight>) -> Self {
        let own = flight.terms.iter().flat_map(|term| term.first..term.first + term.free.len());
        let parameters = [SCALE, LATE_FORCE, LAG, LATE_ATTITUDE].into_iter().chain(own).collect();
        let cells = &flight.cells;
        let intervals = (0..cells.len()).filter(|cell| cells.driven[*cell]).collect();
        Self { intervals, parameters, flight }
    }
}

impl Residuals for Process {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }

    fn parameters(&self) -> &[usize] {
        &self.parameters
    }

    fn row(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Row {
        let cell = self.intervals[row];
        let flight = &*self.flight;
        let mut values = flight.values(theta);
        let linear = self.linear(cell, (a, b), theta, &values);
        let Linear { motion, rotors, here, by_tilt, .. } = &linear;
        let (motion_of, scale) = ((motion.velocity_m_s, motion.attitude), theta[SCALE]);
        let mut by_parameters = Columns::<WIDTH>::zeros(self.parameters.len());
        by_parameters.set_column(0, &(-here / scale));
        for (column, lag_s, late_s) in
            [(1, theta[LAG], theta[LATE_FORCE] + MOVED_S), (2, theta[LAG] + MOVED_S, theta[LATE_FORCE])]
        {
            let rotors = flight.rotors(cell, lag_s, late_s);
            let there = flight.modelled(cell, motion_of, &rotors, (scale, &values));
            by_parameters.set_column(column, &((here - there) / MOVED_S));
        }
        by_parameters.set_column(3, &(by_tilt * flight.cells.rate_rad_s[cell]));
        let mut column = 4;
        for (at, term) in flight.terms.iter().enumerate() {
            for (&slot, step) in term.free.iter().zip(&term.steps) {
                let kept = values[at][slot];
                values[at][slot] = kept + step;
                let there = flight.modelled(cell, motion_of, rotors, (scale, &values));
                values[at][slot] = kept;
                by_parameters.set_column(column, &((here - there) / *step));
                column += 1;
            }
        }
        Row { residual: motion.force_m_s2 - here, by_states: linear.by_states(), by_parameters }
    }

    fn by_states(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Pair {
        self.linear(self.intervals[row], (a, b), theta, &self.flight.values(theta)).by_states()
    }
}

/// The equation of motion in a cell, linearised by the states.
struct Linear {
    motion: Kinematics,
    rotors: Rotors,
    /// modelled, m/s^2
    here: Vector3<f64>,
    by_velocity: Matrix3<f64>,
    by_tilt: Matrix3<f64>,
}

impl Process {
    fn linear(&self, cell: usize, states: (&State, &State), theta: &[f64], values: &Values) -> Linear {
        let flight = &*self.flight;
        let motion = flight.kinematics(cell, states, theta);
        let rotors = flight.rotors(cell, theta[LAG], theta[LATE_FORCE]);
        let (velocity, attitude) = (motion.velocity_m_s, motion.attitude);
        let modelled =
            |velocity, attitude| flight.modelled(cell, (velocity, attitude), &rotors, (theta[SCALE], values));
        let here = modelled(velocity, attitude);
        let mut by_velocity = Matrix3::zeros();
        let mut by_tilt = motion.by_tilt;
        for axis in 0..3 {
            let mut moved = velocity;
            moved[axis] += MOVED;
            let there = modelled(moved, attitude);
            by_velocity.set_column(axis, &((here - there) / MOVED));
            let mut tilt = motion.tilt_rad;
            tilt[axis] += MOVED;
            let there = modelled(velocity, flight.tilted(cell, &tilt));
            let mut column = by_tilt.column_mut(axis);
            column += (here - there) / MOVED;
        }
        Linear { motion, rotors, here, by_velocity, by_tilt }
    }
}

impl Linear {
    fn by_states(&self) -> Pair {
        let mut by_states = Pair::zeros();
        let (half, to_body) = (self.by_velocity / 2.0, self.motion.to_body);
        let mut put =
            |at: usize, block: &Matrix3<f64>| by_states.fixed_view_mut::<3, 3>(0, at).copy_from(block);
        put(VELOCITY, &(half - to_body / STEP_S));
        put(STATE + VELOCITY, &(half + to_body / STEP_S));
        put(TILT, &(self.by_tilt / 2.0));
        put(STATE + TILT, &(self.by_tilt / 2.0));
        by_states
    }
}
