//! How the vehicle moves: sensors, and the estimator's state.

use super::row::{Moment, Row, Way, When};
use super::turns::{Turn, attitude, body_over_time, same};
use crate::recording::Quantity;

const ATTITUDE: &[&str] = &["q[0]", "q[1]", "q[2]", "q[3]"];
const XYZ: &[&str] = &["xyz[0]", "xyz[1]", "xyz[2]"];
const POSITION: &[&str] = &["x", "y", "z"];
const POSITION_ARRAY: &[&str] = &["position[0]", "position[1]", "position[2]"];
const VELOCITY: &[&str] = &["vx", "vy", "vz"];
const VELOCITY_ARRAY: &[&str] = &["velocity[0]", "velocity[1]", "velocity[2]"];
const GPS_VELOCITY: &[&str] = &["vel_n_m_s", "vel_e_m_s", "vel_d_m_s"];

const ESTIMATE: &[&str] = &["vehicle_odometry"];
/// Poses that come from outside of the vehicle.
const POSES: &[&str] = &["vehicle_mocap_odometry", "vehicle_visual_odometry"];
const RECEIVERS: &[&str] = &["vehicle_gps_position", "sensor_gps"];

/// `pose_frame` of north, east, down, and until 1.13 `local_frame`.
const NED: &[When] = &[When::Is("pose_frame", 1.0), When::Is("local_frame", 0.0)];

const fn row(
    topics: &'static [&'static str],
    quantity: Quantity,
    ways: &'static [Way],
    when: &'static [When],
    moment: Moment,
) -> Row {
    Row { topics, quantity, ways, when, moment }
}

pub(super) const ROWS: &[Row] = &[
    row(
        &["vehicle_attitude"],
        Quantity::Attitude,
        &[Way { fields: ATTITUDE, turn: Turn::By(attitude) }],
        &[],
        Moment::Sampled,
    ),
    // until 1.8 the rates stood beside the attitude
    row(
        &["vehicle_attitude"],
        Quantity::AngularRate,
        &[Way { fields: &["rollspeed", "pitchspeed", "yawspeed"], turn: Turn::HalfTurn }],
        &[],
        Moment::Sampled,
    ),
    row(
        &["vehicle_angular_velocity"],
        Quantity::AngularRate,
        &[Way { fields: XYZ, turn: Turn::HalfTurn }],
        &[],
        Moment::Sampled,
    ),
    row(
        &["vehicle_acceleration"],
        Quantity::SpecificForce,
        &[Way { fields: XYZ, turn: Turn::HalfTurn }],
        &[],
        Moment::Sampled,
    ),
    row(
        &["sensor_combined"],
        Quantity::AngularRate,
        &[Way { fields: &["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"], turn: Turn::HalfTurn }],
        &[],
        Moment::MeanOver("gyro_integral_dt"),
    ),
    row(
        &["sensor_combined"],
        Quantity::SpecificForce,
        &[Way {
            fields: &["accelerometer_m_s2[0]", "accelerometer_m_s2[1]", "accelerometer_m_s2[2]"],
            turn: Turn::HalfTurn,
        }],
        &[],
        Moment::LaterMeanOver {
            later: "accelerometer_timestamp_relative",
            over: "accelerometer_integral_dt",
        },
    ),
    row(
        &["vehicle_imu"],
        Quantity::AngularRate,
        &[Way {
            fields: &["delta_angle[0]", "delta_angle[1]", "delta_angle[2]", "delta_angle_dt"],
            turn: Turn::By(body_over_time),
        }],
        &[],
        Moment::MeanOver("delta_angle_dt"),
    ),
    row(
        &["vehicle_imu"],
        Quantity::SpecificForce,
        &[Way {
            fields: &["delta_velocity[0]", "delta_velocity[1]", "delta_velocity[2]", "delta_velocity_dt"],
            turn: Turn::By(body_over_time),
        }],
        &[],
        Moment::MeanOver("delta_velocity_dt"),
    ),
    row(
        &["vehicle_local_position"],
        Quantity::Position,
        &[Way { fields: POSITION, turn: Turn::HalfTurn }],
        &[When::Set("xy_valid"), When::Set("z_valid")],
        Moment::Sampled,
    ),
    row(
        &["vehicle_local_position"],
        Quantity::Velocity,
        &[Way { fields: VELOCITY, turn: Turn::HalfTurn }],
        &[When::Set("v_xy_valid"), When::Set("v_z_valid")],
        Moment::Sampled,
    ),
    row(
        ESTIMATE,
        Quantity::Position,
        &[
            Way { fields: POSITION_ARRAY, turn: Turn::HalfTurn },
            Way { fields: POSITION, turn: Turn::HalfTurn },
        ],
        NED,
        Moment::Sampled,
    ),
    row(
        ESTIMATE,
        Quantity::Velocity,
        &[Way { fields: VELOCITY_ARRAY, turn: Turn::HalfTurn }],
        &[When::Is("velocity_frame", 1.0)],
        Moment::Sampled,
    ),
    row(
        ESTIMATE,
        Quantity::Attitude,
        &[Way { fields: ATTITUDE, turn: Turn::By(attitude) }],
        NED,
        Moment::Sampled,
    ),
    row(
        POSES,
        Quantity::Position,
        &[
            Way { fields: POSITION_ARRAY, turn: Turn::HalfTurn },
            Way { fields: POSITION, turn: Turn::HalfTurn },
        ],
        NED,
        Moment::Sampled,
    ),
    row(
        POSES,
        Quantity::Attitude,
        &[Way { fields: ATTITUDE, turn: Turn::By(attitude) }],
        NED,
        Moment::Sampled,
    ),
    // motion capture until 1.8
    row(
        &["att_pos_mocap", "vehicle_vision_position"],
        Quantity::Position,
        &[Way { fields: POSITION, turn: Turn::HalfTurn }],
        &[When::Set("xy_valid"), When::Set("z_valid")],
        Moment::Sampled,
    ),
    row(
        &["att_pos_mocap", "vehicle_vision_attitude"],
        Quantity::Attitude,
        &[Way { fields: ATTITUDE, turn: Turn::By(attitude) }],
        &[],
        Moment::Sampled,
    ),
    row(
        RECEIVERS,
        Quantity::GpsVelocity,
        &[Way { fields: GPS_VELOCITY, turn: Turn::HalfTurn }],
        &[When::Set("vel_ned_valid")],
        Moment::Sampled,
    ),
    row(
        &["vehicle_air_data"],
        Quantity::BarometricHeight,
        &[Way { fields: &["baro_alt_meter"], turn: Turn::By(same) }],
        &[],
        Moment::Sampled,
    ),
    // until 1.7
    row(
        &["sensor_combined"],
        Quantity::BarometricHeight,
        &[Way { fields: &["baro_alt_meter"], turn: Turn::By(same) }],
        &[],
        Moment::LaterMeanOver { later: "baro_timestamp_relative", over: "none" },
    ),
];
