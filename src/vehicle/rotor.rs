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

impl Rotor {
    /// The motor as people call it: by the autopilot's number, and by its place, `motor 2 (rear left)`. `index` counts from 0, in the
    /// order of the vehicle's description, which is that of the autopilot's motors.
    #[must_use]
    pub fn motor_words(&self, index: usize) -> String {
        format!("motor {} ({})", index + 1, self.place_words())
    }

    /// Its place: its name without underscores; where the name has a number, which another count may have given, where it is.
    #[must_use]
    pub fn place_words(&self) -> String {
        let says_where = !self.name.is_empty() && !self.name.contains(|letter: char| letter.is_ascii_digit());
        if says_where {
            self.name.replace('_', " ")
        } else {
            direction_words(self.position_m.into()).to_owned()
        }
    }
}

/// Where a rotor is, in words; forward, left, up, any unit.
#[must_use]
pub fn direction_words([forward, left, _]: [f64; 3]) -> &'static str {
    const PLACES: [(f64, &str); 9] = [
        (-157.5, "rear"),
        (-112.5, "rear right"),
        (-67.5, "right"),
        (-22.5, "front right"),
        (22.5, "front"),
        (67.5, "front left"),
        (112.5, "left"),
        (157.5, "rear left"),
        (f64::INFINITY, "rear"),
    ];
    let direction_deg = left.atan2(forward).to_degrees();
    PLACES.iter().find(|(end_deg, _)| direction_deg < *end_deg).map_or("at no place", |(_, words)| words)
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
    fn a_motor_is_told_by_the_number_of_the_autopilot_and_its_place() {
        let rotor = |name: &str| Rotor {
            name: name.to_owned(),
            position_m: Vector3::new(-0.3, 0.2, 0.0),
            spin: Spin::Cw,
        };
        assert_eq!(rotor("rear_left").motor_words(1), "motor 2 (rear left)");
        // a number of another count is not repeated
        assert_eq!(rotor("rotor_1").motor_words(1), "motor 2 (rear left)");
        assert_eq!(rotor("").motor_words(0), "motor 1 (rear left)");
    }

    #[test]
    fn a_place_is_said_in_words() {
        let said = [[1.0, 0.0], [0.2, -0.2], [-1.0, 0.01], [0.0, 1.0], [-0.3, 0.2]]
            .map(|[x, y]| direction_words([x, y, 0.0]));
        assert_eq!(said, ["front", "front right", "rear", "left", "rear left"]);
    }

    #[test]
    fn left_rotor_rolls_right_and_cw_yaws_left() {
        let rotors = [Rotor { name: "left".into(), position_m: Vector3::new(0.0, 0.2, 0.0), spin: Spin::Cw }];
        let wrench = Mixer::new(&rotors, Vector3::zeros(), 0.01).wrench(&[5.0]);
        // thrust on the left (+y) lifts the left side: positive roll about x in FLU
        assert!((wrench - Vector4::new(5.0, 1.0, 0.0, 0.05)).norm() < 1e-12);
    }
}
