//! ArduCopter's parameters: defaults, and what follows from the vehicle.

use super::parameter::{Parameter, decided, defaults_of, parameter};
use super::pulses::{Pulses, spin};
use super::thrust::{expo, hover_share};
use crate::autopilot::ParameterType::{Int16 as H, Int32 as I};
use crate::autopilot::{ARDUPILOT, FRAMES, Frame, FrameMotor, Release};
use crate::vehicle::{Rotor, Spin, Vehicle as Description};

/// Cosine of the largest angle between a rotor and a frame's motor that are the same, 15 degrees.
const SAME_BEARING: f64 = 0.966;

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

/// FRAME_CLASS and FRAME_TYPE of the frame whose motors are in the rotors' order, else the scripting matrix.
fn frame(rotors: &[Rotor]) -> (f64, f64) {
    let is_at = |(rotor, motor): (&Rotor, &FrameMotor)| {
        let (forward, left) = motor.place();
        let place = rotor.position_m.xy().normalize();
        place.x * forward + place.y * left > SAME_BEARING && (rotor.spin == Spin::Ccw) == motor.ccw
    };
    let fits =
        |frame: &&Frame| frame.motors.len() == rotors.len() && rotors.iter().zip(frame.motors).all(is_at);
    let found = FRAMES.iter().find(fits);
    found.map_or((15.0, 0.0), |frame| {
        (f64::from(frame.class), frame.types.first().map_or(0.0, |kind| f64::from(*kind)))
    })
}
