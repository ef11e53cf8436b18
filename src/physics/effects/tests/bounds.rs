//! Bounds scale with mass and arm as dimensional analysis has it.

use super::fixtures::vehicle;
use crate::physics::effects::{ALL, by_id};
use crate::physics::{Bounds, REFERENCE_SIZE};
use crate::vehicle::VehicleSize;

/// A racer with 3-inch propellers.
const RACER: VehicleSize = VehicleSize { mass_kg: 0.1, arm_m: 0.06 };
/// A hexarotor that carries cameras.
const HEXAROTOR: VehicleSize = VehicleSize { mass_kg: 15.0, arm_m: 0.6 };

fn bounds(id: &str, name: &str) -> Bounds {
    let parameters = by_id(id).unwrap().parameters();
    parameters.iter().find(|parameter| parameter.name == name).unwrap().bounds
}

fn near((a, b): (f64, f64), (c, d): (f64, f64)) -> bool {
    let same = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(y.abs());
    same(a, c) && same(b, d)
}

/// A quantity with kilogram in its unit, which N has too, goes with the mass: gravity and the rotors' tip speed are
/// the same for all vehicles. Nothing else does.
#[test]
fn what_has_a_mass_in_its_unit_goes_with_the_mass() {
    for effect in ALL {
        for parameter in effect.parameters().iter().chain(effect.finer_parameters()) {
            let has_mass = parameter.unit.contains('N') || parameter.unit.contains("kg");
            let (mass_power, _) = parameter.bounds.powers();
            assert_eq!(mass_power == 1, has_mass, "{} {}", effect.id(), parameter.name);
        }
    }
}

#[test]
fn the_scaling_written_out() {
    for size in [REFERENCE_SIZE, RACER, HEXAROTOR] {
        let (m, l) = (size.mass_kg / 1.0, size.arm_m / 0.15);
        for (id, name, expected) in [
            // drag is a share of the weight at a speed, m g / v; at its square, m g / v^2
            ("linear_drag", "dx", (0.0, 5.0 * m)),
            ("inflow", "kz", (0.0, 5.0 * m)),
            ("quadratic_drag", "cx", (0.0, 2.0 * m)),
            ("translational_lift", "kh", (0.0, m)),
            // a torque that grows with the airspeed, m g l / v
            ("blade_flapping", "k", (-0.2 * m * l, 0.2 * m * l)),
            // hubs move with w l, their drag m g / v acts at l
            ("angular_damping", "bx", (0.0, m * l * l)),
            // an inertia, m l^2
            ("rotor_inertia", "jr", (0.0, 0.01 * m * l * l)),
            // loads and lines that the vehicle can lift
            ("slung_load", "mass", (0.0, 5.0 * m)),
            // not more than nearly all of the vehicle
            ("mass_change", "delta", (-0.8 * m, 2.0 * m)),
            ("tether", "line_mass", (0.0, 0.5 * m)),
            ("tether", "stiffness", (0.0, 1000.0 * m)),
            // places in the airframe
            ("com_offset", "x", (-0.1 * l, 0.1 * l)),
            ("imu_offset", "x", (-0.1 * l, 0.1 * l)),
            ("ceiling_effect", "a2", (0.0, l)),
            // the environment and the sampling
            ("steady_wind", "north", (-20.0, 20.0)),
            ("slung_load", "length", (0.05, 20.0)),
            ("tether", "length", (0.5, 500.0)),
            ("transport_delay", "delay", (0.0, 0.3)),
        ] {
            let at = bounds(id, name).at(&size);
            assert!(near(at, expected), "{id} {name} at {size:?}: {at:?}, expected {expected:?}");
        }
    }
}

#[test]
fn a_racer_and_a_hexarotor_have_bounds_of_their_own() {
    let within = |id, name, size: &VehicleSize, value: f64| {
        let (least, greatest) = bounds(id, name).at(size);
        // not so wide that anything is possible, not so narrow that the bound decides
        assert!(
            least <= value && 3.0 * value < greatest && greatest < 2000.0 * value,
            "{id} {name} {size:?}"
        );
    };
    for size in [RACER, HEXAROTOR] {
        let (m, l) = (size.mass_kg, size.arm_m);
        // 0.3 1/s and 0.05 1/m are usual; rates are damped in a fifth of a second, with I = 0.2 m l^2
        within("linear_drag", "dx", &size, 0.3 * m);
        within("quadratic_drag", "cx", &size, 0.05 * m);
        within("angular_damping", "bx", &size, 0.2 * m * l * l / 0.2);
        // a rotor of a fiftieth of the mass and half the arm, as a rod
        within("rotor_inertia", "jr", &size, m / 50.0 * (0.5 * l).powi(2) / 3.0);
        within("com_offset", "x", &size, 0.05 * l);
        within("slung_load", "mass", &size, 0.1 * m);
    }
    // what a vehicle of 2 kg may have would be ten times the racer's weight at 2 m/s
    assert!(bounds("linear_drag", "dx").at(&RACER).1 < 1.0);
    assert!(bounds("slung_load", "mass").at(&HEXAROTOR).1 > 5.0);
}

/// Vehicles of 1 to 3 kg: no value is refused that was possible when bounds were the same for all.
#[test]
fn vehicles_of_the_reference_size_and_above_have_the_bounds_as_written_or_wider() {
    // PX4's SIH quadrotor, Iris, QBall 2, X500, ArduPilot's SITL quadrotor
    for (mass_kg, arm_m) in [(1.06, 0.283), (1.545, 0.247), (1.79, 0.2), (2.064, 0.246), (2.8, 0.35)] {
        let size = VehicleSize { mass_kg, arm_m };
        for effect in ALL {
            for parameter in effect.parameters() {
                let (written, at) = (parameter.bounds.at(&REFERENCE_SIZE), parameter.bounds.at(&size));
                let holds = at.0 <= written.0 && at.1 >= written.1;
                assert!(holds, "{} {} at {size:?}: {at:?}", effect.id(), parameter.name);
            }
        }
    }
}

#[test]
fn a_vehicle_without_arms_has_bounds_all_the_same() {
    let mut coaxial = vehicle();
    for rotor in &mut coaxial.rotors {
        rotor.position_m.x = coaxial.body.center_of_mass_m.x;
        rotor.position_m.y = coaxial.body.center_of_mass_m.y;
    }
    assert_eq!(coaxial.size().arm_m, 0.165);
    coaxial.propulsion.rotor_radius_m = None;
    assert_eq!(coaxial.size().arm_m, 0.01);
}
