//! What the effects need to know of a vehicle, with the rotors in fixed-size arrays.

use nalgebra::{SMatrix, Vector3, Vector4};

use super::{MAX_ROTORS, PhysicsError, Wrench};
use crate::vehicle::{Propulsion, Vehicle};

/// Rotors about the centre of mass and the scale of hover.
///
/// Rotor speeds are carried relative to the hover speed, `n = Omega / Omega_hover`, because a
/// vehicle that is known by a thrust curve alone has no speed in rad/s. `T = T_hover n^2` in both cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Airframe {
    /// hub positions from the centre of mass, body, m
    arms_m: [Vector3<f64>; MAX_ROTORS],
    /// sign of the reaction torque about +z
    yaw_signs: [f64; MAX_ROTORS],
    rotor_count: usize,
    /// thrusts to `[Fz tau]`, the vehicle's mixer
    mixer: SMatrix<f64, 4, MAX_ROTORS>,
    /// kg, as the vehicle's description has it
    pub mass_kg: f64,
    /// m/s^2
    pub gravity_m_s2: f64,
    /// thrust law
    pub propulsion: Propulsion,
    /// m g / number of rotors, N: the scale of relative thrust and speed
    pub hover_thrust_n: f64,
    /// rotor speed that gives [`Self::hover_thrust_n`], rad/s; `None` where only a curve is known
    pub hover_speed_rad_s: Option<f64>,
}

impl Airframe {
    /// # Errors
    /// If the rotor count is 0 or above [`MAX_ROTORS`], the mass is not positive, or the thrust law
    /// gives no finite thrust.
    pub fn new(vehicle: &Vehicle) -> Result<Self, PhysicsError> {
        let count = vehicle.rotors.len();
        if count == 0 || count > MAX_ROTORS {
            return Err(PhysicsError::RotorCount { count });
        }
        let full_n = vehicle.propulsion.thrust_from_command_n(1.0);
        if !(full_n > 0.0 && full_n.is_finite()) {
            return Err(PhysicsError::Thrust { thrust_n: full_n });
        }
        let hover_thrust_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / count as f64;
        if !(hover_thrust_n > 0.0 && hover_thrust_n.is_finite()) {
            return Err(PhysicsError::Mass { mass_kg: vehicle.body.mass_kg });
        }
        let mut arms_m = [Vector3::zeros(); MAX_ROTORS];
        let mut yaw_signs = [0.0; MAX_ROTORS];
        for (slot, rotor) in vehicle.rotors.iter().enumerate() {
            arms_m[slot] = rotor.position_m - vehicle.body.center_of_mass_m;
            yaw_signs[slot] = rotor.spin.yaw_sign();
        }
        let mut mixer = SMatrix::<f64, 4, MAX_ROTORS>::zeros();
        mixer.columns_mut(0, count).copy_from(&vehicle.mixer().matrix);
        let hover_speed_rad_s =
            vehicle.propulsion.thrust_coefficient.map(|coefficient| (hover_thrust_n / coefficient).sqrt());
        Ok(Self {
            arms_m,
            yaw_signs,
            rotor_count: count,
            mixer,
            mass_kg: vehicle.body.mass_kg,
            gravity_m_s2: vehicle.gravity_m_s2,
            propulsion: vehicle.propulsion,
            hover_thrust_n,
            hover_speed_rad_s,
        })
    }

    /// Number of rotors.
    #[must_use]
    pub fn rotor_count(&self) -> usize {
        self.rotor_count
    }

    /// Hub positions from the centre of mass, body, m.
    #[must_use]
    #[inline]
    pub fn arms_m(&self) -> &[Vector3<f64>] {
        &self.arms_m[..self.rotor_count]
    }

    /// Sign of each rotor's reaction torque about +z.
    #[must_use]
    pub fn yaw_signs(&self) -> &[f64] {
        &self.yaw_signs[..self.rotor_count]
    }

    /// Relative rotor speed that a normalised command u in 0..1 asks for.
    #[must_use]
    pub fn relative_speed(&self, command: f64) -> f64 {
        self.relative_speed_of_thrust(self.propulsion.thrust_from_command_n(command))
    }

    /// Relative rotor speed that gives a thrust, N; 0 where it is negative.
    #[must_use]
    pub fn relative_speed_of_thrust(&self, thrust_n: f64) -> f64 {
        (thrust_n.max(0.0) / self.hover_thrust_n).sqrt()
    }

    /// Thrust of a rotor at a relative speed, N.
    #[must_use]
    #[inline]
    pub fn thrust_n(&self, relative_speed: f64) -> f64 {
        self.hover_thrust_n * relative_speed * relative_speed
    }

    /// Force and torque of rotor thrusts (N); those beyond the rotor count do nothing.
    #[must_use]
    #[inline(always)]
    pub fn thrust_wrench(&self, thrust_n: &[f64; MAX_ROTORS]) -> Wrench {
        let mut sum = Vector4::zeros();
        for (column, thrust) in self.mixer.column_iter().zip(thrust_n).take(self.rotor_count) {
            sum += column * *thrust;
        }
        Wrench::from_thrust_and_torque(&sum)
    }
}
