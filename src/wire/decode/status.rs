//! Mode, arming, battery, parameters.

use super::samples::Samples;
use crate::autopilot::Autopilot;
use crate::recording::Quantity;
use crate::units::{amperes_from_ca, volts_from_mv};
use crate::wire::frame::Payload;
use crate::wire::heartbeat::{ARMED, BASE_MODE_AT};

/// Centiamperes by which the autopilots say that they do not know: MAVLink's -1, and PX4's -1 A.
const CURRENT_UNKNOWN_CA: [i16; 2] = [-1, -100];

/// Read by its bytes: an enumeration value newer than the dialect must not hide the mode.
pub(super) fn heartbeat(payload: Payload<'_>, samples: &mut Samples<'_>) {
    samples.give(Quantity::Mode, 0, &[payload.u32(0).into()]);
    samples.give(Quantity::Armed, 0, &[if payload.u8(BASE_MODE_AT) & ARMED == 0 { 0.0 } else { 1.0 }]);
}

pub(super) fn current_mode(payload: Payload<'_>, samples: &mut Samples<'_>) {
    samples.give(Quantity::Mode, 0, &[payload.u32(0).into()]);
}

/// 0 is "not known", and no sample.
pub(super) fn extended_sys_state(payload: Payload<'_>, samples: &mut Samples<'_>) {
    match payload.u8(1) {
        0 => {}
        state => samples.give(Quantity::LandedState, 0, &[state.into()]),
    }
}

pub(super) fn sys_status(payload: Payload<'_>, samples: &mut Samples<'_>) {
    if payload.u16(14) != u16::MAX {
        samples.give(Quantity::BatteryVoltage, 0, &[volts_from_mv(payload.u16(14).into())]);
    }
    current(payload.i16(16), 0, samples);
}

/// The sum of the cells. A battery whose cells are not measured apart has it all in the first; extension
/// cells (11 to 14) are absent where zero.
pub(super) fn battery_status(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let id = payload.u8(32);
    let cells = (0..10).map(|cell| payload.u16(10 + 2 * cell)).filter(|cell| *cell != u16::MAX);
    let further = (0..4).map(|cell| payload.u16(41 + 2 * cell)).filter(|cell| !matches!(*cell, 0 | u16::MAX));
    let known =
        cells.chain(further).fold(None, |sum: Option<f64>, cell| Some(sum.unwrap_or(0.0) + f64::from(cell)));
    if let Some(millivolts) = known {
        samples.give(Quantity::BatteryVoltage, id, &[volts_from_mv(millivolts)]);
    }
    current(payload.i16(30), id, samples);
}

fn current(centiamperes: i16, instance: u8, samples: &mut Samples<'_>) {
    if !CURRENT_UNKNOWN_CA.contains(&centiamperes) {
        samples.give(Quantity::BatteryCurrent, instance, &[amperes_from_ca(centiamperes.into())]);
    }
}

pub(super) fn parameter_name(payload: Payload<'_>) -> String {
    payload.text(8, 16)
}

/// PX4 puts an integer's bytes into the float; ArduPilot puts its value there.
pub(super) fn parameter_value(payload: Payload<'_>, autopilot: Autopilot) -> f64 {
    if autopilot != Autopilot::Px4 {
        return payload.f32(0);
    }
    match payload.u8(24) {
        1 => payload.u8(0).into(),
        2 => f64::from(i8::from_le_bytes([payload.u8(0)])),
        3 => payload.u16(0).into(),
        4 => payload.i16(0).into(),
        5 => payload.u32(0).into(),
        6 => payload.i32(0).into(),
        _ => payload.f32(0),
    }
}
