//! The paper's equations (1) to (4) with the attitude as a quaternion.

use nalgebra::{Matrix3, Quaternion, SymmetricEigen, Vector3};

use super::{PhysicsError, State, StateDerivative, Wrench};
use crate::vehicle::{RigidBody, gyroscopic_torque_nm};

/// Mass, inertia and gravity, ready for integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidBodyModel {
    /// kg
    pub mass_kg: f64,
    /// about the centre of mass, body, kg m^2
    pub inertia_kg_m2: Matrix3<f64>,
    /// its inverse
    pub inertia_inverse: Matrix3<f64>,
    /// share of the gyroscopic torque that acts
    pub gyroscopic: f64,
    /// m/s^2, along world -z
    pub gravity_m_s2: f64,
}

impl RigidBodyModel {
    /// # Errors
    /// If the mass is not positive, or the inertia is not symmetric and positive definite.
    pub fn new(body: &RigidBody, gravity_m_s2: f64) -> Result<Self, PhysicsError> {
        let (mass_kg, inertia, gyroscopic) = (body.mass_kg, body.inertia_kg_m2, body.gyroscopic);
        if !(mass_kg > 0.0 && mass_kg.is_finite()) {
            return Err(PhysicsError::Mass { mass_kg });
        }
        let i = &inertia;
        let came = [i[(0, 0)], i[(0, 1)], i[(0, 2)], i[(1, 1)], i[(1, 2)], i[(2, 2)]];
        let symmetric = (inertia - inertia.transpose()).norm() <= 1e-12 * inertia.norm();
        let inverse = inertia.cholesky().map(|factor| factor.inverse());
        match inverse {
            Some(inertia_inverse) if symmetric && inertia.iter().all(|x| x.is_finite()) => {
                Ok(Self { mass_kg, inertia_kg_m2: inertia, inertia_inverse, gyroscopic, gravity_m_s2 })
            }
            _ => Err(PhysicsError::Inertia { inertia_kg_m2: came }),
        }
    }

    /// (1) to (4): `v' = R F / m - g e_z`, `w' = I^-1 (tau - w x I w)`, `q' = q (0, w) / 2`.
    ///
    /// (1) is written there for the velocity in the body frame; turned into the world frame its
    /// `m S(w) v` cancels.
    #[must_use]
    #[inline(always)]
    pub fn derivative(&self, state: &State, wrench: &Wrench) -> StateDerivative {
        let w = &state.rates_rad_s;
        let spin = Quaternion::from_parts(0.0, *w * 0.5);
        let gravity = Vector3::new(0.0, 0.0, self.gravity_m_s2);
        // the quotient does not wait for the force
        let per_kg = 1.0 / self.mass_kg;
        StateDerivative {
            velocity_m_s: state.velocity_m_s,
            acceleration_m_s2: state.attitude * (wrench.force_n * per_kg) - gravity,
            quaternion_rate: state.attitude.quaternion() * spin,
            angular_acceleration_rad_s2: self.inertia_inverse
                * (wrench.torque_nm - gyroscopic_torque_nm(self.gyroscopic, &self.inertia_kg_m2, w)),
        }
    }

    /// Torque that a motion takes, `J w' + w x J w`, N m, body: of body rates, rad/s, and their derivative, rad/s^2.
    #[must_use]
    pub fn turning_torque_nm(&self, rates: &Vector3<f64>, turning: &Vector3<f64>) -> Vector3<f64> {
        self.inertia_kg_m2 * turning + gyroscopic_torque_nm(self.gyroscopic, &self.inertia_kg_m2, rates)
    }

    /// Total thrust that holds the vehicle level and still, N.
    #[must_use]
    pub fn weight_n(&self) -> f64 {
        self.mass_kg * self.gravity_m_s2
    }
}

/// Whether a positive mass distribution can have this inertia: `tr(I)/2 E - I` (the second moment
/// of mass, Wensing et al. 2018) has positive eigenvalues, which includes the triangle inequality.
#[must_use]
pub fn pseudo_inertia_is_positive(inertia_kg_m2: &Matrix3<f64>) -> bool {
    let second_moment = Matrix3::identity() * (inertia_kg_m2.trace() / 2.0) - inertia_kg_m2;
    SymmetricEigen::new(second_moment).eigenvalues.iter().all(|value| *value > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::skew;
    use nalgebra::UnitQuaternion;

    fn model() -> RigidBodyModel {
        let body = RigidBody {
            mass_kg: 1.8,
            inertia_kg_m2: Matrix3::new(
                0.012, -0.0008, 0.0001, -0.0008, 0.015, -0.0006, 0.0001, -0.0006, 0.08,
            ),
            center_of_mass_m: Vector3::zeros(),
            gyroscopic: 1.0,
        };
        RigidBodyModel::new(&body, 9.81).unwrap()
    }

    #[test]
    fn agrees_with_the_papers_body_frame_equations() {
        let model = model();
        let state = State {
            position_m: Vector3::new(1.0, 2.0, 3.0),
            velocity_m_s: Vector3::new(0.7, -1.2, 0.4),
            attitude: UnitQuaternion::from_euler_angles(0.3, -0.2, 1.4),
            rates_rad_s: Vector3::new(0.9, -0.5, 0.7),
        };
        let wrench =
            Wrench { force_n: Vector3::new(0.0, 0.0, 19.0), torque_nm: Vector3::new(0.1, -0.2, 0.05) };
        let change = model.derivative(&state, &wrench);
        let (w, v) = (state.rates_rad_s, state.body_velocity_m_s());
        // v_body' = R^T v_world' - w x v_body
        let v_rate = state.attitude.inverse_transform_vector(&change.acceleration_m_s2) - w.cross(&v);
        let left = v_rate * model.mass_kg
            + skew(&w) * v * model.mass_kg
            + state.attitude.inverse_transform_vector(&Vector3::z()) * model.weight_n();
        assert!((left - wrench.force_n).norm() < 1e-12);
        let left =
            model.inertia_kg_m2 * change.angular_acceleration_rad_s2 + skew(&w) * model.inertia_kg_m2 * w;
        assert!((left - wrench.torque_nm).norm() < 1e-12);
    }

    #[test]
    fn hover_thrust_holds_still_and_a_tilt_pushes_sideways() {
        let model = model();
        let mut state = State::at_rest(Vector3::zeros(), 0.4);
        let hover = Wrench::from_thrust_and_torque(&[model.weight_n(), 0.0, 0.0, 0.0].into());
        assert!(model.derivative(&state, &hover).acceleration_m_s2.norm() < 1e-12);
        // positive roll lifts the left side: thrust then pushes to the right, world -y when facing north
        state.attitude = UnitQuaternion::from_euler_angles(0.1, 0.0, 0.0);
        assert!(model.derivative(&state, &hover).acceleration_m_s2.y < -0.9);
        // positive pitch lowers the nose: forwards
        state.attitude = UnitQuaternion::from_euler_angles(0.0, 0.1, 0.0);
        assert!(model.derivative(&state, &hover).acceleration_m_s2.x > 0.9);
    }

    #[test]
    fn impossible_bodies_are_refused() {
        let good = RigidBody {
            mass_kg: 1.0,
            inertia_kg_m2: Matrix3::identity() * 0.01,
            center_of_mass_m: Vector3::zeros(),
            gyroscopic: 1.0,
        };
        assert!(RigidBodyModel::new(&RigidBody { mass_kg: -1.0, ..good.clone() }, 9.81).is_err());
        assert!(RigidBodyModel::new(&RigidBody { mass_kg: f64::NAN, ..good.clone() }, 9.81).is_err());
        let indefinite = Matrix3::from_diagonal(&Vector3::new(0.01, -0.01, 0.02));
        assert!(RigidBodyModel::new(&RigidBody { inertia_kg_m2: indefinite, ..good.clone() }, 9.81).is_err());
        let lopsided = Matrix3::new(0.01, 0.002, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.01);
        assert!(RigidBodyModel::new(&RigidBody { inertia_kg_m2: lopsided, ..good }, 9.81).is_err());
        // Izz above Ixx + Iyy: positive definite, but no distribution of mass has it
        assert!(!pseudo_inertia_is_positive(&Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 0.03))));
        assert!(pseudo_inertia_is_positive(&Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 0.019))));
    }
}
