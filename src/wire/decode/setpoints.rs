//! What the vehicle was told to do.

use super::motion::{wxyz, xyz};
use super::samples::Samples;
use super::source::Source;
use crate::frames::{attitude_from_frd_ned, body_from_frd, world_from_ned, yaw_from_ned};
use crate::recording::Quantity;
use crate::wire::frame::{Payload, SystemId};
use crate::wire::mav_frame::{FORCE_SET, LOCAL_NED};

/// Bits of POSITION_TARGET_TYPEMASK: three for each vector, then force instead of acceleration, yaw, yaw rate.
const IGNORE_YAW: u16 = 1 << 10;
const IGNORE_YAW_RATE: u16 = 1 << 11;
/// Bits of ATTITUDE_TARGET_TYPEMASK: three for the rates, then these.
const IGNORE_THRUST: u8 = 1 << 6;
const IGNORE_ATTITUDE: u8 = 1 << 7;

/// Whether a ground station's setpoint is for this vehicle: addressed to it or to all.
pub(super) fn is_for(source: Source, payload: Payload<'_>, vehicle: SystemId) -> bool {
    let offset = if source == Source::SetAttitudeTarget { 36 } else { 50 };
    let target = payload.u8(offset);
    target == 0 || SystemId(target.into()) == vehicle
}

pub(super) fn position_target_local_ned(payload: Payload<'_>, samples: &mut Samples<'_>) {
    position_target(payload, payload.u8(50), samples);
}

pub(super) fn set_position_target_local_ned(payload: Payload<'_>, samples: &mut Samples<'_>) {
    position_target(payload, payload.u8(52), samples);
}

fn position_target(payload: Payload<'_>, frame: u8, samples: &mut Samples<'_>) {
    if frame != LOCAL_NED {
        samples.unusable();
        return;
    }
    let mask = payload.u16(48);
    let vectors = [
        (Quantity::PositionSetpoint, 4, mask & 0b111),
        (Quantity::VelocitySetpoint, 16, (mask >> 3) & 0b111),
        (Quantity::AccelerationSetpoint, 28, if mask & FORCE_SET == 0 { (mask >> 6) & 0b111 } else { 0b111 }),
    ];
    for (quantity, offset, ignored) in vectors {
        let mut ned: [f64; 3] = payload.f32s(offset);
        ignore(&mut ned, ignored);
        samples.give(quantity, 0, &xyz(world_from_ned(ned).0));
    }
    if mask & IGNORE_YAW == 0 {
        samples.give(Quantity::YawSetpoint, 0, &[yaw_from_ned(payload.f32(40))]);
    }
    if mask & IGNORE_YAW_RATE == 0 {
        samples.give(Quantity::YawRateSetpoint, 0, &[yaw_from_ned(payload.f32(44))]);
    }
    samples.given = true; // a setpoint that ignores everything is whole
}

pub(super) fn attitude_target(payload: Payload<'_>, samples: &mut Samples<'_>) {
    target_attitude(payload, payload.u8(36), samples);
}

pub(super) fn set_attitude_target(payload: Payload<'_>, samples: &mut Samples<'_>) {
    target_attitude(payload, payload.u8(38), samples);
}

fn target_attitude(payload: Payload<'_>, mask: u8, samples: &mut Samples<'_>) {
    if mask & IGNORE_ATTITUDE == 0
        && let Some(attitude) = attitude_from_frd_ned(payload.f32s(4))
    {
        samples.give(Quantity::AttitudeSetpoint, 0, &wxyz(attitude));
    }
    let mut rates: [f64; 3] = payload.f32s(20);
    ignore(&mut rates, (mask & 0b111).into());
    samples.give(Quantity::AngularRateSetpoint, 0, &xyz(body_from_frd(rates).0));
    if mask & IGNORE_THRUST == 0 {
        samples.give(Quantity::ThrustSetpoint, 0, &[payload.f32(32)]);
    }
    samples.given = true;
}

fn ignore(vector: &mut [f64; 3], ignored: u16) {
    for (axis, value) in vector.iter_mut().enumerate() {
        if ignored & (1 << axis) != 0 {
            *value = f64::NAN;
        }
    }
}
