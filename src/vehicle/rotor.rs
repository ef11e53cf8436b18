//! Rotors and the map from their thrusts to force and torque.

use nalgebra::{Matrix4xX, Vector3, Vector4};

/// Sense of rotation seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spin {
    /// clockwise: the drag of the air pushes the body counter-clockwise, about +z
    Cw,
    /// counter-clockwise: pushes the body about -z
    Ccw,
}

impl Spin {
    /// Sign of the reaction torque on the body about +z.
    #[must_use]
    pub fn yaw_sign(self) -> f64 {
        match self {
            Self::Cw => 1.0,
            Self::Ccw => -1.0,
        }
    }
}

/// One rotor, thrust along body +z.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotor {
    /// name for reports
    pub name: String,
    /// hub, m, body FLU
    pub position_m: Vector3<f64>,
    /// seen from above
    pub spin: Spin,
}

/// `F = B T`: from rotor thrusts (N) to `[Fz tau_x tau_y tau_z]` (N, N m) at the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixer {
    /// 4 x rotors
    pub matrix: Matrix4xX<f64>,
}

impl Mixer {
    /// `torque_per_thrust_m` is the rotor's drag torque per thrust, N m per N.
    #[must_use]
    pub fn new(rotors: &[Rotor], center_of_mass_m: Vector3<f64>, torque_per_thrust_m: f64) -> Self {
        let mut matrix = Matrix4xX::zeros(rotors.len());
        for (column, rotor) in rotors.iter().enumerate() {
            let arm = rotor.position_m - center_of_mass_m;
            // r x (T e_z) = (r_y T, -r_x T, 0)
            matrix[(0, column)] = 1.0;
            matrix[(1, column)] = arm.y;
            matrix[(2, column)] = -arm.x;
            matrix[(3, column)] = rotor.spin.yaw_sign() * torque_per_thrust_m;
        }
        Self { matrix }
    }

    /// Force and torque from one thrust a rotor; thrusts beyond the rotor count are ignored.
    #[must_use]
    pub fn wrench(&self, thrusts_n: &[f64]) -> Vector4<f64> {
        let mut sum = Vector4::zeros();
        for (column, thrust) in self.matrix.column_iter().zip(thrusts_n) {
            sum += column * *thrust;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_rotor_rolls_right_and_cw_yaws_left() {
        let rotors = [Rotor { name: "left".into(), position_m: Vector3::new(0.0, 0.2, 0.0), spin: Spin::Cw }];
        let wrench = Mixer::new(&rotors, Vector3::zeros(), 0.01).wrench(&[5.0]);
        // thrust on the left (+y) lifts the left side: positive roll about x in FLU
        assert!((wrench - Vector4::new(5.0, 1.0, 0.0, 0.05)).norm() < 1e-12);
    }
}
