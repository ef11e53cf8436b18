//! Measurement equations of the sensors and of the autopilot's estimate.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::blocks::{Columns, Pair, STATE, State, WIDTH};
use super::forces::{Flight, part};
use super::place::STEP_S;
use super::places::{BIAS, ERROR, LATE_ATTITUDE, LATE_RECEIVER, LATE_VELOCITY, TILT, TURNED, VELOCITY};
use super::receiver::ReceiverSample;
use super::residuals::{Residuals, Row};

/// Share of the accelerometer that the autopilot's velocity integrates. Estimators predict with the accelerometer and
/// correct the rest from the receiver; the learned noise level takes up an error of this.
const SHARED: f64 = 0.9;

/// Standard deviation of the time by which the body turns between a force and the frame of the accelerometer's sample of it, s. A sample is
/// a mean over 1 to 8 ms, and the simulator of an autopilot turns the body between force and sample by a step of its own (4 ms in
/// PX4's SIH, where without it the drag came out 0.02 to 0.07 N/(m/s) too small).
pub const ACCELEROMETER_TURN_STD_S: f64 = 0.003;

fn put(by_states: &mut Pair, at: usize, block: &Matrix3<f64>) {
    by_states.fixed_view_mut::<3, 3>(0, at).copy_from(block);
}

/// The accelerometer against the kinematic force, m/s^2.
#[derive(Debug)]
pub(super) struct Accelerometer {
    pub(super) flight: Arc<Flight>,
    pub(super) intervals: Vec<usize>,
}

impl Residuals for Accelerometer {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }

    fn parameters(&self) -> &[usize] {
        &[BIAS, BIAS + 1, BIAS + 2, LATE_ATTITUDE, TURNED]
    }

    fn shaped_by(&self) -> &[usize] {
        &[LATE_ATTITUDE, TURNED]
    }

    fn row(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Row {
        let cell = self.intervals[row];
        let motion = self.flight.kinematics(cell, (a, b), theta);
        let bias = Vector3::from_row_slice(&theta[BIAS..BIAS + 3]);
        let rate_rad_s = self.flight.cells.rate_rad_s[cell];
        // f + T (f x w), to first order in the small turn
        let turn = Matrix3::identity() - rate_rad_s.cross_matrix() * theta[TURNED];
        let felt_m_s2 = turn * motion.force_m_s2;
        let mean = self.flight.cells.specific_force_m_s2[cell].map_or(felt_m_s2, |(mean, _)| mean);
        let by_velocity = turn * motion.to_body / STEP_S;
        let by_tilt = turn * motion.by_tilt;
        let mut by_states = Pair::zeros();
        put(&mut by_states, VELOCITY, &by_velocity);
        put(&mut by_states, STATE + VELOCITY, &-by_velocity);
        put(&mut by_states, TILT, &(-by_tilt / 2.0));
        put(&mut by_states, STATE + TILT, &(-by_tilt / 2.0));
        let mut by_parameters = Columns::<WIDTH>::zeros(5);
        by_parameters.fixed_columns_mut::<3>(0).copy_from(&-Matrix3::identity());
        by_parameters.set_column(3, &(-by_tilt * rate_rad_s));
        by_parameters.set_column(4, &-motion.force_m_s2.cross(&rate_rad_s));
        Row { residual: mean - bias - felt_m_s2, by_states, by_parameters }
    }

    fn weight(&self, row: usize) -> f64 {
        self.flight.cells.specific_force_m_s2[self.intervals[row]].map_or(0.0, |(_, count)| count.sqrt())
    }
}

/// The error of the attitude changes little from one instant to the next, rad.
#[derive(Debug)]
pub(super) struct TiltWalk(pub(super) Arc<Flight>);

impl Residuals for TiltWalk {
    fn intervals(&self) -> &[usize] {
        &self.0.intervals
    }

    fn parameters(&self) -> &[usize] {
        &[]
    }

    fn row(&self, _row: usize, a: &State, b: &State, _theta: &[f64]) -> Row {
        let mut by_states = Pair::zeros();
        put(&mut by_states, TILT, &-Matrix3::identity());
        put(&mut by_states, STATE + TILT, &Matrix3::identity());
        Row { residual: part(b, TILT) - part(a, TILT), by_states, by_parameters: Columns::<WIDTH>::zeros(0) }
    }
}

/// A part of the first state, about nought.
#[derive(Debug)]
pub(super) struct Start(pub(super) usize);

impl Residuals for Start {
    fn intervals(&self) -> &[usize] {
        &[0]
    }

    fn parameters(&self) -> &[usize] {
        &[]
    }

    fn row(&self, _row: usize, a: &State, _b: &State, _theta: &[f64]) -> Row {
        let mut by_states = Pair::zeros();
        put(&mut by_states, self.0, &Matrix3::identity());
        Row { residual: part(a, self.0), by_states, by_parameters: Columns::<WIDTH>::zeros(0) }
    }
}

/// The autopilot integrates the same accelerometer with its own attitude, so the error of its velocity takes in what that
/// has of noise and lean: `e' = 0.9 (R (a - b) + g - v') - k e` with its forgetting `k`, m/s.
#[derive(Debug)]
pub(super) struct Mechanization(pub(super) Arc<Flight>);

impl Residuals for Mechanization {
    fn intervals(&self) -> &[usize] {
        &self.0.intervals
    }

    fn parameters(&self) -> &[usize] {
        &[BIAS, BIAS + 1, BIAS + 2]
    }

    fn shaped_by(&self) -> &[usize] {
        &[]
    }

    fn row(&self, cell: usize, a: &State, b: &State, theta: &[f64]) -> Row {
        let cells = &self.0.cells;
        let kept = 1.0 - STEP_S * cells.forgetting_1_s;
        let mut residual = part(b, ERROR) - part(a, ERROR) * kept;
        let mut by_states = Pair::zeros();
        put(&mut by_states, ERROR, &(-Matrix3::identity() * kept));
        put(&mut by_states, STATE + ERROR, &Matrix3::identity());
        let mut by_parameters = Columns::<WIDTH>::zeros(3);
        if let Some((mean, _)) = cells.specific_force_m_s2[cell] {
            let felt = mean - Vector3::from_row_slice(&theta[BIAS..BIAS + 3]);
            let up = Vector3::z() * self.0.airframe.gravity_m_s2;
            let taken = cells.attitude[cell] * felt - up - (part(b, VELOCITY) - part(a, VELOCITY)) / STEP_S;
            residual -= taken * (SHARED * STEP_S);
            put(&mut by_states, VELOCITY, &(-Matrix3::identity() * SHARED));
            put(&mut by_states, STATE + VELOCITY, &(Matrix3::identity() * SHARED));
            let turned = cells.attitude[cell].to_rotation_matrix().into_inner() * (SHARED * STEP_S);
            by_parameters.fixed_columns_mut::<3>(0).copy_from(&turned);
        }
        Row { residual, by_states, by_parameters }
    }
}

/// The autopilot's velocity: the true one and its error, m/s.
#[derive(Debug)]
pub(super) struct EstimatedVelocity {
    pub(super) flight: Arc<Flight>,
    pub(super) intervals: Vec<usize>,
}

impl Residuals for EstimatedVelocity {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }

    fn parameters(&self) -> &[usize] {
        &[LATE_VELOCITY]
    }

    fn shaped_by(&self) -> &[usize] {
        &[]
    }

    fn row(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Row {
        let (_, share, seen) = self.flight.cells.velocity_m_s[row];
        let of = |at: usize| part(a, at) * (1.0 - share) + part(b, at) * share;
        let mut by_states = Pair::zeros();
        for at in [VELOCITY, ERROR] {
            put(&mut by_states, at, &(-Matrix3::identity() * (1.0 - share)));
            put(&mut by_states, STATE + at, &(-Matrix3::identity() * share));
        }
        let acceleration = (part(b, VELOCITY) - part(a, VELOCITY)) / STEP_S;
        let mut by_parameters = Columns::<WIDTH>::zeros(1);
        by_parameters.set_column(0, &acceleration);
        let residual = seen - of(VELOCITY) - of(ERROR) + acceleration * theta[LATE_VELOCITY];
        Row { residual, by_states, by_parameters }
    }
}

/// A receiver's velocity: the true one, late, m/s.
#[derive(Debug)]
pub(super) struct ReceiverVelocity {
    pub(super) flight: Arc<Flight>,
    pub(super) intervals: Vec<usize>,
}

impl Residuals for ReceiverVelocity {
    fn intervals(&self) -> &[usize] {
        &self.intervals
    }

    fn parameters(&self) -> &[usize] {
        &[LATE_RECEIVER]
    }

    fn row(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Row {
        let ReceiverSample { share, velocity_m_s, climbs, .. } = self.flight.cells.receiver.samples[row];
        let share = share - theta[LATE_RECEIVER] / STEP_S;
        let told = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, if climbs { 1.0 } else { 0.0 }));
        let (before, after) = (part(a, VELOCITY), part(b, VELOCITY));
        let mut by_states = Pair::zeros();
        put(&mut by_states, VELOCITY, &(-told * (1.0 - share)));
        put(&mut by_states, STATE + VELOCITY, &(-told * share));
        let mut by_parameters = Columns::<WIDTH>::zeros(1);
        by_parameters.set_column(0, &(told * (after - before) / STEP_S));
        let residual = told * (velocity_m_s - before * (1.0 - share) - after * share);
        Row { residual, by_states, by_parameters }
    }
}
