//! Accelerometer and gyroscope.

use super::motion::xyz;
use super::samples::Samples;
use crate::autopilot::Autopilot;
use crate::frames::body_from_frd;
use crate::recording::Quantity;
use crate::units::{m_s2_from_milli_g, rad_s_from_mrad_s};
use crate::wire::frame::Payload;

/// HIGHRES_IMU.fields_updated: which values are new.
const ACCELERATION_UPDATED: u16 = 0b111;
const RATE_UPDATED: u16 = 0b111 << 3;

/// SI already; a value that is not new is not a sample. A sender that leaves the mask zero does not use it.
pub(super) fn highres_imu(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let (updated, id) = (payload.u16(60), payload.u8(62));
    let is_new = |mask: u16| updated == 0 || updated & mask == mask;
    if is_new(ACCELERATION_UPDATED) {
        samples.give(Quantity::SpecificForce, id, &xyz(body_from_frd(payload.f32s(8)).0));
    }
    if is_new(RATE_UPDATED) {
        samples.give(Quantity::AngularRate, id, &xyz(body_from_frd(payload.f32s(20)).0));
    }
}

/// SCALED_IMU, 2 and 3: milli-g and mrad/s in sixteen bits.
pub(super) fn scaled_imu(payload: Payload<'_>, samples: &mut Samples<'_>) {
    sixteen_bits(payload, 4, 0, samples);
}

/// ArduPilot sends milli-g and mrad/s here as in SCALED_IMU. MAVLink says sensor counts, and another
/// autopilot's scale is not known.
pub(super) fn raw_imu(payload: Payload<'_>, samples: &mut Samples<'_>) {
    if samples.vehicle.autopilot == Autopilot::ArduPilot {
        sixteen_bits(payload, 8, payload.u8(26), samples);
    } else {
        samples.unusable();
    }
}

fn sixteen_bits(payload: Payload<'_>, offset: usize, instance: u8, samples: &mut Samples<'_>) {
    let triple =
        |start: usize| -> [f64; 3] { std::array::from_fn(|axis| payload.i16(start + 2 * axis).into()) };
    let force = body_from_frd(triple(offset).map(m_s2_from_milli_g));
    let rate = body_from_frd(triple(offset + 6).map(rad_s_from_mrad_s));
    samples.give(Quantity::SpecificForce, instance, &xyz(force.0));
    samples.give(Quantity::AngularRate, instance, &xyz(rate.0));
}
