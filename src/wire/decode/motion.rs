//! Attitude, rates, position and velocity as the vehicle estimates them.

use super::samples::Samples;
use crate::frames::{
    Attitude, attitude_from_euler_frd_ned, attitude_from_frd_ned, body_from_frd, world_from_ned,
};
use crate::recording::Quantity;
use crate::wire::frame::Payload;
use crate::wire::mav_frame::{BODY_NED, LOCAL_NED};

const BODY_FRD: u8 = 12;

/// Offset of ODOMETRY's frames and counter, behind its two covariances.
const ODOMETRY_FRAME_ID: usize = 228;

pub(super) fn wxyz(attitude: Attitude) -> [f64; 4] {
    let q = attitude.0.quaternion();
    [q.w, q.i, q.j, q.k]
}

pub(super) fn xyz(vector: nalgebra::Vector3<f64>) -> [f64; 3] {
    vector.into()
}

pub(super) fn attitude(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let [roll, pitch, yaw] = payload.f32s(4);
    if roll.is_finite() && pitch.is_finite() && yaw.is_finite() {
        samples.give(Quantity::Attitude, 0, &wxyz(attitude_from_euler_frd_ned(roll, pitch, yaw)));
    }
    samples.give(Quantity::AngularRate, 0, &xyz(body_from_frd(payload.f32s(16)).0));
}

pub(super) fn attitude_quaternion(payload: Payload<'_>, samples: &mut Samples<'_>) {
    if let Some(attitude) = attitude_from_frd_ned(payload.f32s(4)) {
        samples.give(Quantity::Attitude, 0, &wxyz(attitude));
    }
    samples.give(Quantity::AngularRate, 0, &xyz(body_from_frd(payload.f32s(20)).0));
}

pub(super) fn local_position_ned(payload: Payload<'_>, samples: &mut Samples<'_>) {
    samples.give(Quantity::Position, 0, &xyz(world_from_ned(payload.f32s(4)).0));
    samples.give(Quantity::Velocity, 0, &xyz(world_from_ned(payload.f32s(16)).0));
}

/// Fix in three dimensions, GPS_FIX_TYPE.
const FIX_3D: u8 = 3;

/// Speed over ground and course; without a fix, or where the receiver tells none, nothing. The vertical velocity is not in it.
pub(super) fn gps_raw_int(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let (speed_cm_s, course_cdeg, fix) = (payload.u16(24), payload.u16(26), payload.u8(28));
    if fix < FIX_3D || speed_cm_s == u16::MAX || course_cdeg == u16::MAX {
        return samples.nothing_told();
    }
    let (sin, cos) = (f64::from(course_cdeg) / 100.0).to_radians().sin_cos();
    let speed_m_s = f64::from(speed_cm_s) / 100.0;
    samples.give(Quantity::GpsVelocity, 0, &[speed_m_s * cos, -speed_m_s * sin, f64::NAN]);
}

/// Only with the pose in NED; velocity in NED or in the body, as `child_frame_id` says.
pub(super) fn odometry(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let (frame, child_frame) = (payload.u8(ODOMETRY_FRAME_ID), payload.u8(ODOMETRY_FRAME_ID + 1));
    if frame != LOCAL_NED {
        samples.unusable();
        return;
    }
    samples.give(Quantity::Position, 0, &xyz(world_from_ned(payload.f32s(8)).0));
    let attitude = attitude_from_frd_ned(payload.f32s(20));
    if let Some(attitude) = attitude {
        samples.give(Quantity::Attitude, 0, &wxyz(attitude));
    }
    let sent_velocity = payload.f32s(36);
    match (child_frame, attitude) {
        (LOCAL_NED, _) => samples.give(Quantity::Velocity, 0, &xyz(world_from_ned(sent_velocity).0)),
        (BODY_NED | BODY_FRD, Some(attitude)) => {
            let velocity = attitude.to_world(body_from_frd(sent_velocity));
            samples.give(Quantity::Velocity, 0, &xyz(velocity.0));
        }
        _ => samples.unusable(),
    }
    samples.give(Quantity::AngularRate, 0, &xyz(body_from_frd(payload.f32s(48)).0));
}

/// Counts up when the estimate jumps.
pub(super) fn odometry_reset_counter(payload: Payload<'_>) -> u8 {
    payload.u8(ODOMETRY_FRAME_ID + 2)
}
