//! ArduCopter's parameters: defaults, what follows from the vehicle, and the names and units of 4.6 and 4.7.

use super::parameter::ParameterType::{Int8 as B, Int16 as H, Int32 as I, Real32 as R};
use super::parameter::{Parameter, Row, parameter, rows};
use super::pulses::{Pulses, SPIN};
use super::thrust::{expo, hover_share};
use crate::autopilot::Release;
use crate::vehicle::{Rotor, Spin, Vehicle as Description};

const COMMON: &[Row] = &[
    ("ATC_ANG_PIT_P", R, 4.5),
    ("ATC_ANG_RLL_P", R, 4.5),
    ("ATC_ANG_YAW_P", R, 4.5),
    ("ATC_RAT_PIT_D", R, 0.0036),
    ("ATC_RAT_PIT_I", R, 0.135),
    ("ATC_RAT_PIT_P", R, 0.135),
    ("ATC_RAT_RLL_D", R, 0.0036),
    ("ATC_RAT_RLL_I", R, 0.135),
    ("ATC_RAT_RLL_P", R, 0.135),
    ("ATC_RAT_YAW_P", R, 0.18),
    ("BATT_CAPACITY", I, 3300.0),
    ("BATT_CRT_VOLT", R, 0.0),
    ("BATT_FS_CRT_ACT", B, 0.0),
    ("BATT_FS_LOW_ACT", B, 0.0),
    ("BATT_LOW_VOLT", R, 10.5),
    ("BATT_MONITOR", B, 4.0),
    ("DISARM_DELAY", B, 10.0),
    ("EK3_ENABLE", B, 1.0),
    ("FENCE_ACTION", B, 1.0),
    ("FENCE_ALT_MAX", R, 100.0),
    ("FENCE_ALT_MIN", R, -10.0),
    ("FENCE_ENABLE", B, 0.0),
    ("FENCE_MARGIN", R, 2.0),
    ("FENCE_RADIUS", R, 300.0),
    ("FENCE_TOTAL", B, 0.0),
    ("FENCE_TYPE", B, 7.0),
    ("FLTMODE1", B, 0.0),
    ("FLTMODE2", B, 0.0),
    ("FLTMODE3", B, 0.0),
    ("FLTMODE4", B, 0.0),
    ("FLTMODE5", B, 0.0),
    ("FLTMODE6", B, 0.0),
    ("FLTMODE_CH", B, 5.0),
    ("FS_EKF_ACTION", B, 1.0),
    ("FS_EKF_THRESH", R, 0.8),
    ("FS_GCS_ENABLE", B, 0.0),
    ("FS_GCS_TIMEOUT", R, 5.0),
    ("FS_OPTIONS", I, 16.0),
    ("FS_THR_ENABLE", B, 0.0),
    ("GUID_OPTIONS", I, 0.0),
    ("GUID_TIMEOUT", R, 3.0),
    ("INS_ACCEL_FILTER", H, 20.0),
    ("INS_GYRO_FILTER", H, 20.0),
    ("LOG_BITMASK", I, 176_126.0),
    ("MOT_BAT_IDX", B, 0.0),
    ("MOT_BAT_VOLT_MAX", R, 0.0),
    ("MOT_BAT_VOLT_MIN", R, 0.0),
    ("MOT_HOVER_LEARN", B, 2.0),
    ("MOT_OPTIONS", H, 0.0),
    ("MOT_PWM_TYPE", B, 0.0),
    ("MOT_SLEW_DN_TIME", R, 0.0),
    ("MOT_SLEW_UP_TIME", R, 0.0),
    ("MOT_SPIN_ARM", R, 0.10),
    ("MOT_SPIN_MAX", R, SPIN.1),
    ("MOT_SPIN_MIN", R, SPIN.0),
    ("SCHED_LOOP_RATE", H, 400.0),
    ("SERVO_BLH_POLES", B, 14.0),
    ("WP_YAW_BEHAVIOR", B, 2.0),
];

/// Names and units up to 4.6: centimetres, centidegrees.
const UP_TO_4_6: &[Row] = &[
    ("ANGLE_MAX", H, 3000.0),
    ("ARMING_CHECK", I, 1.0),
    ("ATC_ACCEL_P_MAX", R, 110_000.0),
    ("ATC_ACCEL_R_MAX", R, 110_000.0),
    ("ATC_ACCEL_Y_MAX", R, 27_000.0),
    ("LAND_ALT_LOW", H, 1000.0),
    ("LAND_SPEED", H, 50.0),
    ("LAND_SPEED_HIGH", H, 0.0),
    ("LOIT_SPEED", R, 1250.0),
    ("PILOT_SPEED_UP", H, 250.0),
    ("PSC_JERK_XY", R, 5.0),
    ("PSC_JERK_Z", R, 5.0),
    ("PSC_POSXY_P", R, 1.0),
    ("PSC_POSZ_P", R, 1.0),
    ("PSC_VELXY_P", R, 2.0),
    ("RTL_ALT", R, 1500.0),
    ("RTL_ALT_FINAL", H, 0.0),
    ("RTL_CLIMB_MIN", H, 0.0),
    ("RTL_CONE_SLOPE", R, 3.0),
    ("RTL_SPEED", H, 0.0),
    ("SYSID_ENFORCE", B, 0.0),
    ("SYSID_MYGCS", H, 255.0),
    ("WPNAV_ACCEL", R, 250.0),
    ("WPNAV_ACCEL_Z", R, 100.0),
    ("WPNAV_JERK", R, 1.0),
    ("WPNAV_RADIUS", R, 200.0),
    ("WPNAV_SPEED", R, 1000.0),
    ("WPNAV_SPEED_DN", R, 150.0),
    ("WPNAV_SPEED_UP", R, 250.0),
];

/// Names and units from 4.7 on: metres, degrees; the arming checks are those to skip.
const FROM_4_7: &[Row] = &[
    ("ARMING_SKIPCHK", I, 0.0),
    ("ATC_ACC_P_MAX", R, 1100.0),
    ("ATC_ACC_R_MAX", R, 1100.0),
    ("ATC_ACC_Y_MAX", R, 270.0),
    ("ATC_ANGLE_MAX", R, 30.0),
    ("LAND_ALT_LOW_M", R, 10.0),
    ("LAND_SPD_HIGH_MS", R, 0.0),
    ("LAND_SPD_MS", R, 0.5),
    ("LOIT_SPEED_MS", R, 12.5),
    ("MAV_GCS_SYSID", I, 255.0),
    ("MAV_GCS_SYSID_HI", I, 0.0),
    ("MAV_OPTIONS", I, 0.0),
    ("PILOT_SPD_UP", R, 2.5),
    ("PSC_D_POS_P", R, 1.0),
    ("PSC_D_JERK", R, 5.0),
    ("PSC_NE_JERK", R, 5.0),
    ("PSC_NE_POS_P", R, 1.0),
    ("PSC_NE_VEL_P", R, 2.0),
    ("RTL_ALT_FINAL_M", R, 0.0),
    ("RTL_ALT_M", R, 15.0),
    ("RTL_CLIMB_MIN_M", R, 0.0),
    ("RTL_CONE_SLOPE", R, 3.0),
    ("RTL_SPEED_MS", R, 0.0),
    ("WP_ACC", R, 2.5),
    ("WP_ACC_Z", R, 1.0),
    ("WP_JERK", R, 1.0),
    ("WP_RADIUS_M", R, 2.0),
    ("WP_SPD", R, 10.0),
    ("WP_SPD_DN", R, 1.5),
    ("WP_SPD_UP", R, 2.5),
];

/// Defaults for a vehicle.
pub(super) fn defaults(
    vehicle: &Description,
    pulses: &Pulses,
    system: u8,
    release: Release,
) -> Vec<Parameter> {
    let (renamed, own_system, streams) = if release < Release::new(4, 7) {
        (UP_TO_4_6, "SYSID_THISMAV", "SR0_")
    } else {
        (FROM_4_7, "MAV_SYSID", "MAV1_")
    };
    let mut list: Vec<Parameter> = rows(COMMON).chain(rows(renamed)).collect();
    list.push(parameter(own_system.into(), I, system.into()));
    for group in ["RAW_SENS", "EXT_STAT", "RC_CHAN", "POSITION", "EXTRA1", "EXTRA2", "EXTRA3", "PARAMS"] {
        list.push(parameter(format!("{streams}{group}"), H, 0.0));
    }
    // no switch has a function
    list.extend((5..=16).map(|channel| parameter(format!("RC{channel}_OPTION"), H, 0.0)));
    let span_us = (pulses.max_us - pulses.min_us) / (SPIN.1 - SPIN.0);
    let (class, kind) = frame(&vehicle.rotors);
    let own = [
        ("MOT_PWM_MIN", H, pulses.off_us),
        ("MOT_PWM_MAX", H, pulses.off_us + span_us),
        ("MOT_THST_EXPO", R, expo(vehicle)),
        ("MOT_THST_HOVER", R, hover_share(vehicle)),
        ("FRAME_CLASS", B, class),
        ("FRAME_TYPE", B, kind),
    ];
    list.extend(own.map(|(name, kind, value)| parameter(name.to_owned(), kind, value)));
    for output in 1..=8_u8 {
        let is_motor = usize::from(output) <= vehicle.rotors.len();
        let function = if is_motor { 32.0 + f64::from(output) } else { 0.0 };
        for (end, value) in
            [("FUNCTION", function), ("MIN", 1100.0), ("MAX", 1900.0), ("TRIM", 1500.0), ("REVERSED", 0.0)]
        {
            list.push(parameter(format!("SERVO{output}_{end}"), H, value));
        }
    }
    list
}

/// FRAME_CLASS and FRAME_TYPE: quad X where the rotors are in its order (front right and rear left
/// counter-clockwise, front left and rear right clockwise), else a class by the number of rotors, or for four
/// rotors the scripting matrix.
fn frame(rotors: &[Rotor]) -> (f64, f64) {
    const QUAD_X: [(f64, f64, Spin); 4] =
        [(1.0, -1.0, Spin::Ccw), (-1.0, 1.0, Spin::Ccw), (1.0, 1.0, Spin::Cw), (-1.0, -1.0, Spin::Cw)];
    let is_quad_x = rotors.len() == QUAD_X.len()
        && rotors.iter().zip(QUAD_X).all(|(rotor, (forward, left, spin))| {
            rotor.position_m.x * forward > 0.0 && rotor.position_m.y * left > 0.0 && rotor.spin == spin
        });
    match rotors.len() {
        4 if is_quad_x => (1.0, 1.0),
        6 => (2.0, 1.0),
        8 => (3.0, 1.0),
        _ => (15.0, 0.0),
    }
}
