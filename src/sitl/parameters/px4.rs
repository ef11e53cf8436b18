//! PX4's parameters: defaults, and what follows from the vehicle.

use super::parameter::{Parameter, decided, defaults_of, parameter};
use super::pulses::Pulses;
use super::thrust::{expo, hover_share};
use crate::autopilot::ParameterType::{Int32 as I, Real32 as R};
use crate::autopilot::{PX4, Release};
use crate::frames::{Body, frd_from_body};
use crate::vehicle::{Spin, Vehicle as Description};

/// Defaults for a vehicle.
pub(super) fn defaults(
    vehicle: &Description,
    pulses: &Pulses,
    system: u8,
    release: Release,
) -> Vec<Parameter> {
    let mut list = defaults_of(&PX4, release);
    list.push(parameter("MAV_SYS_ID".into(), I, system.into()));
    let of_vehicle = [
        ("THR_MDL_FAC", expo(vehicle)),
        ("MPC_THR_HOVER", hover_share(vehicle)),
        ("CA_ROTOR_COUNT", vehicle.rotors.len() as f64),
    ];
    list.extend(of_vehicle.into_iter().filter_map(|(name, value)| decided(&PX4, name, value)));
    for (rotor, hub) in vehicle.rotors.iter().enumerate() {
        let [px, py, pz] = frd_from_body(Body(hub.position_m));
        // KM > 0 turns counter-clockwise
        let km = match hub.spin {
            Spin::Ccw => vehicle.propulsion.torque_per_thrust_m,
            Spin::Cw => -vehicle.propulsion.torque_per_thrust_m,
        };
        let own = [
            ("PX", px),
            ("PY", py),
            ("PZ", pz),
            ("AX", 0.0),
            ("AY", 0.0),
            ("AZ", -1.0),
            ("CT", 6.5),
            ("KM", km),
        ];
        for (end, value) in own {
            // + 0.0 turns a negative zero into zero
            list.push(parameter(format!("CA_ROTOR{rotor}_{end}"), R, value + 0.0));
        }
    }
    for output in 1..=8_u8 {
        let is_motor = usize::from(output) <= vehicle.rotors.len();
        let function = if is_motor { PX4.outputs.motor(usize::from(output) - 1) } else { 0.0 };
        let own =
            [("FUNC", function), ("MIN", pulses.min_us), ("MAX", pulses.max_us), ("DIS", pulses.off_us)];
        for (name, value) in own {
            list.push(parameter(format!("PWM_MAIN_{name}{output}"), I, value));
        }
    }
    list
}
