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

    /// Rotor thrusts (N) for what of `[Fz tau]` (N, N m) the rotors can give.
    fn possible_n(&self, wanted: &Vector4<f64>) -> SVector<f64, MAX_ROTORS> {
        let least_n = self.propulsion.thrust_from_command_n(self.command_min);
        let most_n = self.propulsion.thrust_from_command_n(1.0);
        let within = |thrusts_n: &SVector<f64, MAX_ROTORS>| {
            thrusts_n.iter().take(self.rotor_count).all(|n| (least_n..=most_n).contains(n))
        };
        let all_n = self.thrusts_n(wanted);
        if within(&all_n) {
            return all_n;
        }
        let mut turning_n = self.thrusts_n(&Vector4::new(0.0, wanted[1], wanted[2], 0.0));
        let spread = |thrusts_n: &SVector<f64, MAX_ROTORS>| {
            let used = thrusts_n.rows(0, self.rotor_count);
            (used.min(), used.max())
        };
        let (lowest_n, highest_n) = spread(&turning_n);
        turning_n *= ((most_n - least_n) / (highest_n - lowest_n).max(f64::MIN_POSITIVE)).min(1.0);
        let (lowest_n, highest_n) = spread(&turning_n);
        // rotors share the thrust alike but for what the vehicle's arms ask of them
        let unit_n = self.thrusts_n(&Vector4::new(1.0, 0.0, 0.0, 0.0));
        let (least_lift_n, most_lift_n) = spread(&unit_n);
        let mean_n = f64::midpoint(least_lift_n, most_lift_n).max(f64::MIN_POSITIVE);
        let (least_kept_n, most_kept_n) = (least_n - lowest_n, most_n - highest_n);
        let kept_n = (wanted[0] * mean_n).min(most_kept_n).max(least_kept_n);
        let upright_n = turning_n + unit_n * (kept_n / mean_n);
        let yawing_n = self.thrusts_n(&Vector4::new(0.0, 0.0, 0.0, wanted[3]));
        let room = |(upright_n, yaw_n): (&f64, &f64)| {
            let to_bound_n = if *yaw_n > 0.0 { most_n - upright_n } else { least_n - upright_n };
            if *yaw_n == 0.0 { 1.0 } else { (to_bound_n / yaw_n).clamp(0.0, 1.0) }
        };
        let pairs = upright_n.iter().zip(yawing_n.iter()).take(self.rotor_count);
        upright_n + yawing_n * pairs.map(room).fold(1.0, f64::min)
    }

    /// Normalised commands u for `[Fz tau]` (N, N m). Where the rotors cannot give all of it, roll and pitch come first,
    /// then the thrust, and yaw gets what is left: a vehicle that cannot lift as asked stays upright.
    pub fn commands(&self, wanted: &Vector4<f64>) -> [f64; MAX_ROTORS] {
        let thrusts_n = self.possible_n(wanted);
        let mut commands = [0.0; MAX_ROTORS];
        for (command, thrust_n) in commands.iter_mut().zip(thrusts_n.iter()).take(self.rotor_count) {
            *command = self.propulsion.command_from_thrust(*thrust_n).clamp(self.command_min, 1.0);
        }
        commands
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random_vehicle;

    #[test]
    fn what_the_rotors_cannot_give_is_taken_from_yaw_and_thrust_before_roll_and_pitch() {
        let vehicle = random_vehicle(3).truth;
        let allocation = Allocation::new(&vehicle, 0.02).unwrap();
        let count = vehicle.rotors.len();
        let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
        let arm_m = vehicle.rotors[0].position_m.x;
        let given = |wanted: &Vector4<f64>| {
            let thrusts_n = allocation.possible_n(wanted);
            let least_n = vehicle.propulsion.thrust_from_command_n(0.02);
            let most_n = vehicle.propulsion.thrust_from_command_n(1.0);
            let used = thrusts_n.rows(0, count);
            assert!(used.min() > least_n - 1e-9 && used.max() < most_n + 1e-9, "{used}");
            vehicle.mixer().matrix * used
        };
        // within the rotors' reach all of it comes
        let gentle = Vector4::new(weight_n, 0.1 * weight_n * arm_m, -0.05 * weight_n * arm_m, 0.0);
        assert!((given(&gentle) - gentle).norm() < 1e-9);
        // more lift than there is: roll and pitch stay whole, thrust does not
        let steep = Vector4::new(9.0 * weight_n, gentle[1], gentle[2], 0.0);
        let steep_given = given(&steep);
        assert!((steep_given.rows(1, 2) - steep.rows(1, 2)).norm() < 1e-9, "{steep_given}");
        assert!(steep_given[0] > 1.5 * weight_n && steep_given[0] < 4.1 * weight_n);
        // more yaw than there is: thrust, roll and pitch stay whole, yaw keeps its sign
        let spun = Vector4::new(weight_n, gentle[1], gentle[2], weight_n);
        let spun_given = given(&spun);
        assert!((spun_given.rows(0, 3) - spun.rows(0, 3)).norm() < 1e-9, "{spun_given}");
        assert!(spun_given[3] > 0.0 && spun_given[3] < spun[3]);
        // more roll than there is: as much as there is, in its direction
        let rolled = given(&Vector4::new(weight_n, 99.0 * weight_n, 0.0, 0.0));
        assert!(rolled[1] > weight_n * arm_m && rolled[2].abs() < 1e-9);
    }
}
