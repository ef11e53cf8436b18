//! ArduCopter's parameters: defaults, and what follows from the vehicle.

use super::parameter::{Parameter, decided, defaults_of, parameter};
use super::pulses::{Pulses, spin};
use super::thrust::{expo, hover_share};
use crate::autopilot::ParameterType::{Int16 as H, Int32 as I};
use crate::autopilot::{ARDUPILOT, QUAD_X, Release};
use crate::vehicle::{Rotor, Spin, Vehicle as Description};

/// Defaults for a vehicle.
pub(super) fn defaults(
    vehicle: &Description,
    pulses: &Pulses,
    system: u8,
    release: Release,
) -> Vec<Parameter> {
    let (own_system, streams) =
        if release < Release::new(4, 7) { ("SYSID_THISMAV", "SR0_") } else { ("MAV_SYSID", "MAV1_") };
    let mut list = defaults_of(&ARDUPILOT, release);
    list.push(parameter(own_system.into(), I, system.into()));
    for group in ["RAW_SENS", "EXT_STAT", "RC_CHAN", "POSITION", "EXTRA1", "EXTRA2", "EXTRA3", "PARAMS"] {
        list.push(parameter(format!("{streams}{group}"), H, 0.0));
    }
    // no switch has a function
    list.extend((5..=16).map(|channel| parameter(format!("RC{channel}_OPTION"), H, 0.0)));
    let (none, full) = spin();
    let span_us = (pulses.max_us - pulses.min_us) / (full - none);
    let (class, kind) = frame(&vehicle.rotors);
    let of_vehicle = [
        ("MOT_PWM_MIN", pulses.off_us),
        ("MOT_PWM_MAX", pulses.off_us + span_us),
        ("MOT_THST_EXPO", expo(vehicle)),
        ("MOT_THST_HOVER", hover_share(vehicle)),
        ("FRAME_CLASS", class),
        ("FRAME_TYPE", kind),
    ];
    list.extend(of_vehicle.into_iter().filter_map(|(name, value)| decided(&ARDUPILOT, name, value)));
    for output in 1..=8_u8 {
        let is_motor = usize::from(output) <= vehicle.rotors.len();
        let function = if is_motor { ARDUPILOT.outputs.motor(usize::from(output) - 1) } else { 0.0 };
        for (end, value) in
            [("FUNCTION", function), ("MIN", 1100.0), ("MAX", 1900.0), ("TRIM", 1500.0), ("REVERSED", 0.0)]
        {
            list.push(parameter(format!("SERVO{output}_{end}"), H, value));
        }
    }
    list
}

/// FRAME_CLASS and FRAME_TYPE: quad X where the rotors are in its order, else a class by the number of rotors, or for four
/// rotors the scripting matrix.
fn frame(rotors: &[Rotor]) -> (f64, f64) {
    let is_quad_x = rotors.len() == QUAD_X.len()
        && rotors.iter().zip(QUAD_X).all(|(rotor, (forward, left, ccw))| {
            rotor.position_m.x * forward > 0.0
                && rotor.position_m.y * left > 0.0
                && (rotor.spin == Spin::Ccw) == ccw
        });
    match rotors.len() {
        4 if is_quad_x => (1.0, 1.0),
        6 => (2.0, 1.0),
        8 => (3.0, 1.0),
        _ => (15.0, 0.0),
    }
}
