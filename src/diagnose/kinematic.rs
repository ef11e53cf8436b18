//! The force by the derivative of velocity, with the attitude.

use super::trace::Trace;
use nalgebra::Vector3;
use std::ops::Range;

impl Trace {
    /// Kinematic specific force `K1(v_b) + K(w x v_b + g R' e_z)` at every row, body, m/s^2; `None`
    /// without attitude and velocity.
    #[must_use]
    pub fn weak_kinematic(&self) -> Option<[Vec<f64>; 3]> {
        if !(self.known.attitude && self.known.velocity) {
            return None;
        }
        let all = 0..self.rows();
        let velocity: Vec<Vector3<f64>> =
            self.states[self.reach(&all)].iter().map(|state| state.velocity_m_s).collect();
        Some(self.weak_acceleration(&velocity, &(Vector3::z() * self.gravity_m_s2), &all))
    }

    /// `K1(R'v) + K(w x R'v + R'a)` at some of the rows, body, m/s^2, with the measured attitude `R` and rates `w`: of `v' + a`
    /// for a velocity (world, m/s, one entry for each instant that these rows reach) and a constant acceleration (world, m/s^2).
    pub(super) fn weak_acceleration(
        &self,
        velocity_m_s: &[Vector3<f64>],
        constant_m_s2: &Vector3<f64>,
        rows: &Range<usize>,
    ) -> [Vec<f64>; 3] {
        let (mut body, mut rest) = (Vec::new(), Vec::new());
        for (state, velocity) in self.states[self.reach(rows)].iter().zip(velocity_m_s) {
            let velocity = state.attitude.inverse_transform_vector(velocity);
            let constant = state.attitude.inverse_transform_vector(constant_m_s2);
            rest.push(state.rates_rad_s.cross(&velocity) + constant);
            body.push(velocity);
        }
        let mut derivative = self.weak_vector_in(1, &body, rows);
        for (axis, rest) in derivative.iter_mut().zip(&self.weak_vector_in(0, &rest, rows)) {
            axis.iter_mut().zip(rest).for_each(|(d, r)| *d += r);
        }
        derivative
    }
}
