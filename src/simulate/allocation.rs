//! From force and torque wanted to rotor commands.

use nalgebra::{SMatrix, SVector, Vector4};

use super::SimulateError;
use crate::physics::MAX_ROTORS;
use crate::vehicle::{Propulsion, Vehicle};

/// The pseudo-inverse of a vehicle's mixer and of its thrust law.
#[derive(Debug, Clone)]
pub struct Allocation {
    /// thrusts from `[Fz tau]`
    inverse: SMatrix<f64, MAX_ROTORS, 4>,
    rotor_count: usize,
    propulsion: Propulsion,
    command_min: f64,
}

impl Allocation {
    /// Commands stay within `command_min` to 1.
    ///
    /// # Errors
    /// If the rotors do not span thrust and three torques.
    pub fn new(vehicle: &Vehicle, command_min: f64) -> Result<Self, SimulateError> {
        let mixer = vehicle.mixer().matrix;
        let rotor_count = mixer.ncols();
        let failed = SimulateError::Allocation { rotors: rotor_count };
        if rotor_count > MAX_ROTORS || mixer.rank(1e-9) < 4 {
            return Err(failed);
        }
        let pseudo_inverse = mixer.pseudo_inverse(1e-12).map_err(|_| failed)?;
        let mut inverse = SMatrix::<f64, MAX_ROTORS, 4>::zeros();
        inverse.rows_mut(0, rotor_count).copy_from(&pseudo_inverse);
        Ok(Self { inverse, rotor_count, propulsion: vehicle.propulsion, command_min })
    }

    /// Rotor thrusts (N) for `[Fz tau]` (N, N m); may be negative.
    pub fn thrusts_n(&self, wanted: &Vector4<f64>) -> SVector<f64, MAX_ROTORS> {
        self.inverse * wanted
    }

    /// Normalised commands u for `[Fz tau]` (N, N m).
    pub fn commands(&self, wanted: &Vector4<f64>) -> [f64; MAX_ROTORS] {
        let thrusts_n = self.thrusts_n(wanted);
        let mut commands = [0.0; MAX_ROTORS];
        for (command, thrust_n) in commands.iter_mut().zip(thrusts_n.iter()).take(self.rotor_count) {
            *command = self.propulsion.command_from_thrust(*thrust_n).clamp(self.command_min, 1.0);
        }
        commands
    }
}
