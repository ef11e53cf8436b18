//! Laws that hold for every effect: symmetry, and what takes energy out.

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::fixtures::*;
use crate::physics::effects::*;
use crate::physics::{ActiveEffect, Airframe, Condition, Effect, Input, Rotors, State};

proptest! {
    /// Turning world, state and wind about the vertical changes nothing that the body feels.
    #[test]
    fn no_heading_is_preferred(
        state in any_state(),
        wind_m_s in any_vector(3.0),
        yaw in -3.0..3.0_f64,
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.05..0.95, 3),
    ) {
        let vehicle = vehicle();
        let airframe = Airframe::new(&vehicle).unwrap();
        let input = Input { battery_voltage_v: Some(15.0), ..Input::from_commands(&airframe, 1.0, &commands) };
        let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw);
        let turned = State {
            position_m: turn * state.position_m,
            velocity_m_s: turn * state.velocity_m_s,
            attitude: turn * state.attitude,
            ..state
        };
        for effect in ALL {
            let theta = within_bounds(*effect, &shares);
            let here = Condition::new(&airframe, &state, &input, wind_m_s);
            let there = Condition::new(&airframe, &turned, &input, turn * wind_m_s);
            let (a, b) = (wrench_of(*effect, &here, &rotors, &theta), wrench_of(*effect, &there, &rotors, &theta));
            prop_assert!(size(&(a - b)) < 1e-9 * (1.0 + size(&a)), "{}", effect.id());
        }
    }

    /// A symmetric vehicle in the mirror (y turned round) is pushed as the mirror shows it.
    #[test]
    fn left_and_right_are_alike(
        state in any_state(),
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.05..0.95, 3),
    ) {
        let mut vehicle = vehicle();
        vehicle.body.center_of_mass_m.y = 0.0;
        let airframe = Airframe::new(&vehicle).unwrap();
        let mirror = |v: Vector3<f64>| Vector3::new(v.x, -v.y, v.z);
        // what turns is turned round about the two axes in the mirror's plane
        let mirror_turn = |v: Vector3<f64>| Vector3::new(-v.x, v.y, -v.z);
        let mirrored = State {
            position_m: mirror(state.position_m),
            velocity_m_s: mirror(state.velocity_m_s),
            attitude: UnitQuaternion::from_scaled_axis(mirror_turn(state.attitude.scaled_axis())),
            rates_rad_s: mirror_turn(state.rates_rad_s),
        };
        let swapped = [commands[1], commands[0], commands[3], commands[2]];
        let of = |state: &State, commands: &[f64], effect: &dyn Effect, theta: &[f64]| {
            let input =
                Input { battery_voltage_v: Some(15.0), ..Input::from_commands(&airframe, 1.0, commands) };
            let at = Condition::new(&airframe, state, &input, Vector3::zeros());
            wrench_of(effect, &at, &Rotors::as_commanded(&airframe, &input.speed_command), theta)
        };
        for effect in ALL {
            let theta = within_bounds(*effect, &shares);
            let mut seen = theta.clone();
            effect.sided().iter().for_each(|slot| seen[*slot] = -theta[*slot]);
            // the number of a rotor: the one on the other side
            if effect.id() == "weak_rotor" {
                seen[0] = [1.0, 0.0, 3.0, 2.0, 4.0, 5.0, 6.0, 7.0][
                    (0..8_usize).find(|i| (*i as f64 - theta[0]).abs() < 0.5).unwrap_or(7)
                ];
            }
            let real = of(&state, &commands, *effect, &theta);
            let image = of(&mirrored, &swapped, *effect, &seen);
            let difference = (image.force_n - mirror(real.force_n)).norm()
                + (image.torque_nm - mirror_turn(real.torque_nm)).norm();
            prop_assert!(
                difference < 1e-9 * (1.0 + size(&real)),
                "{}: its mirror image is another force: if a parameter has a side, name it in `sided`",
                effect.id()
            );
        }
    }

    /// In still air drag, inflow and damping only take energy out.
    #[test]
    fn drag_dissipates(
        state in any_state(),
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.0..1.0, 3),
    ) {
        let vehicle = vehicle();
        let airframe = Airframe::new(&vehicle).unwrap();
        let input = Input::from_commands(&airframe, 1.0, &commands);
        let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
        let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
        let effects: [&dyn Effect; 4] = [&LinearDrag, &QuadraticDrag, &Inflow, &AngularDamping];
        for effect in effects {
            let wrench = wrench_of(effect, &at, &rotors, &within_bounds(effect, &shares));
            let power_w = wrench.force_n.dot(&at.air_velocity_m_s) + wrench.torque_nm.dot(&state.rates_rad_s);
            prop_assert!(power_w <= 1e-12, "{} {power_w} W", effect.id());
        }
    }

    /// The gyroscopic torque of rotors at constant speed does no work.
    #[test]
    fn gyroscopic_torque_does_no_work(state in any_state(), commands in prop::collection::vec(0.2..1.0, 4)) {
        let vehicle = vehicle();
        let airframe = Airframe::new(&vehicle).unwrap();
        let input = Input::from_commands(&airframe, 1.0, &commands);
        let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
        let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
        let wrench = wrench_of(&RotorInertia, &at, &rotors, &[5e-5]);
        prop_assert!(wrench.torque_nm.dot(&state.rates_rad_s).abs() < 1e-12);
        prop_assert!(wrench.force_n.norm() == 0.0);
    }
}

/// No effect creates force on a vehicle at rest far from everything, but those that stand for a change
/// of the vehicle itself.
#[test]
fn effects_of_motion_vanish_at_rest() {
    let at_rest = State::at_rest(Vector3::new(0.0, 0.0, 40.0), 0.0);
    let of_the_vehicle = [
        "battery_sag",
        "thrust_curve",
        "weak_rotor",
        "com_offset",
        "thrust_tilt",
        "slung_load",
        "mass_change",
        "tether",
        "ceiling_effect",
    ];
    for effect in ALL.iter().filter(|effect| !of_the_vehicle.contains(&effect.id())) {
        let theta = within_bounds(*effect, &[0.5, 0.5, 0.5]);
        let change = evaluate(vec![ActiveEffect::new(*effect, &theta).unwrap()], &at_rest)
            - evaluate(vec![], &at_rest);
        let wind_drag = matches!(effect.id(), "steady_wind" | "gust");
        assert!(wind_drag || size(&change) < 1e-3, "{}: {change:?}", effect.id());
    }
}
