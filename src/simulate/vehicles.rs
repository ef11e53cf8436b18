//! Random vehicles: what one is, and what its maker says it is.

use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::physics::pseudo_inertia_is_positive;
use crate::units::GRAVITY_M_S2;
use crate::vehicle::{Actuator, Anchor, Limits, Propulsion, RigidBody, Rotor, Spin, ThrustLaw, Vehicle};

/// The vehicle that flies and the one that its maker states.
#[derive(Debug, Clone, PartialEq)]
pub struct VehiclePair {
    /// what flies
    pub truth: Vehicle,
    /// what identification is given: mass 5 % off at most, inertia 35 %, no products of inertia
    pub nominal: Vehicle,
}

/// A quadrotor with 0.4 to 3 kg and arms of 0.1 to 0.3 m whose actuator values command rotor speed.
///
/// Inertia is 0.16 to 0.36 of mass times arm squared with `Izz` 1.4 to 1.9 of the mean of the others,
/// the range of published vehicles from the Hummingbird to the QBall 2; products of inertia are up to
/// 5 % of `sqrt(Iii Ijj)`. Thrust coefficient and geometry are the same in both.
#[must_use]
pub fn random_vehicle(seed: u64) -> VehiclePair {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let size: f64 = rng.random();
    let mass_kg = 0.4 * (3.0_f64 / 0.4).powf(size);
    // heavy vehicles have long arms, within a scatter
    let arm_m = (0.1 + 0.2 * size + rng.random_range(-0.03..0.03)).clamp(0.1, 0.3);
    let inertia_kg_m2 = random_inertia(&mut rng, mass_kg * arm_m * arm_m);
    let truth = Vehicle {
        name: format!("random-{seed}"),
        body: RigidBody { mass_kg, inertia_kg_m2, center_of_mass_m: Vector3::zeros(), gyroscopic: 1.0 },
        propulsion: random_propulsion(&mut rng, mass_kg, arm_m),
        rotors: cross_rotors(arm_m),
        limits: Limits::default(),
        anchor: Anchor::Thrust,
        guesses: Vec::new(),
        gravity_m_s2: GRAVITY_M_S2,
    };
    let nominal_body = nominal_body(&mut rng, &truth.body);
    let nominal = Vehicle { name: format!("random-{seed}-nominal"), body: nominal_body, ..truth.clone() };
    VehiclePair { truth, nominal }
}

fn random_inertia(rng: &mut Pcg64Mcg, scale_kg_m2: f64) -> Matrix3<f64> {
    let ixx = scale_kg_m2 * rng.random_range(0.16..0.36);
    let iyy = ixx * rng.random_range(0.92..1.15);
    let izz = f64::midpoint(ixx, iyy) * rng.random_range(1.4..1.9);
    let mut product = |i: f64, j: f64| rng.random_range(-0.05..0.05) * (i * j).sqrt();
    let (ixy, ixz, iyz) = (product(ixx, iyy), product(ixx, izz), product(iyy, izz));
    let mut scale = 1.0;
    loop {
        let (xy, xz, yz) = (ixy * scale, ixz * scale, iyz * scale);
        let inertia = Matrix3::new(ixx, xy, xz, xy, iyy, yz, xz, yz, izz);
        // without products the triangle inequality holds by the ranges above, so this ends
        if pseudo_inertia_is_positive(&inertia) || scale < 1e-3 {
            return inertia;
        }
        scale *= 0.7;
    }
}

fn random_propulsion(rng: &mut Pcg64Mcg, mass_kg: f64, arm_m: f64) -> Propulsion {
    let thrust_to_weight = rng.random_range(2.0..4.0);
    let speed_max_rad_s = rng.random_range(900.0..1500.0);
    let thrust_max_n = thrust_to_weight * mass_kg * GRAVITY_M_S2 / 4.0;
    Propulsion {
        actuator: Actuator::Speed,
        law: ThrustLaw::Speed { speed_max_rad_s },
        thrust_coefficient: Some(thrust_max_n / (speed_max_rad_s * speed_max_rad_s)),
        torque_per_thrust_m: rng.random_range(0.014..0.045),
        rotor_radius_m: Some(arm_m * rng.random_range(0.55..0.7)),
        time_constant_s: None,
        time_constant_down_s: None,
    }
}

/// Front left, front right, rear right, rear left at 45 degrees; the diagonals turn alike.
fn cross_rotors(arm_m: f64) -> Vec<Rotor> {
    let d = arm_m * std::f64::consts::FRAC_1_SQRT_2;
    [
        ("front_left", d, d, Spin::Cw),
        ("front_right", d, -d, Spin::Ccw),
        ("rear_right", -d, -d, Spin::Cw),
        ("rear_left", -d, d, Spin::Ccw),
    ]
    .into_iter()
    .map(|(name, x, y, spin)| Rotor { name: name.into(), position_m: Vector3::new(x, y, 0.0), spin })
    .collect()
}

fn nominal_body(rng: &mut Pcg64Mcg, truth: &RigidBody) -> RigidBody {
    let i = &truth.inertia_kg_m2;
    let mass_kg = truth.mass_kg * rng.random_range(0.95..1.05);
    // a maker's roll and pitch inertia err together
    let about_xy = rng.random_range(0.68..1.32);
    let xx = i[(0, 0)] * about_xy * rng.random_range(0.98..1.02);
    let yy = i[(1, 1)] * about_xy * rng.random_range(0.98..1.02);
    let zz = (i[(2, 2)] * rng.random_range(0.65..1.35)).min(0.95 * (xx + yy));
    RigidBody {
        mass_kg,
        inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(xx, yy, zz)),
        center_of_mass_m: Vector3::zeros(),
        gyroscopic: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_vehicles_are_physical_and_their_makers_near_the_truth() {
        for seed in 0..200 {
            let VehiclePair { truth, nominal } = random_vehicle(seed);
            assert!((0.4..=3.0).contains(&truth.body.mass_kg));
            for body in [&truth.body, &nominal.body] {
                assert!(pseudo_inertia_is_positive(&body.inertia_kg_m2));
            }
            assert!((nominal.body.mass_kg / truth.body.mass_kg - 1.0).abs() <= 0.05);
            for axis in 0..3 {
                let ratio = nominal.body.inertia_kg_m2[(axis, axis)] / truth.body.inertia_kg_m2[(axis, axis)];
                assert!((ratio - 1.0).abs() <= 0.36, "seed {seed} axis {axis}: {ratio}");
            }
            assert_eq!(nominal.body.inertia_kg_m2[(0, 1)], 0.0);
            let hover = truth.propulsion.command_from_thrust(truth.body.mass_kg * 9.81 / 4.0);
            assert!((0.45..0.75).contains(&hover));
            assert_eq!(random_vehicle(seed), VehiclePair { truth, nominal });
        }
    }
}
