//! What the vehicle was told to do, and what its controllers made of it.

use super::row::{Moment, Row, Way, When};
use super::turns::{Turn, attitude, same, upward, yaw};
use crate::recording::Quantity;

/// What the position controller is given, and what it makes of that.
const TRAJECTORY: &[&str] = &["trajectory_setpoint", "vehicle_local_position_setpoint"];
const ATTITUDE: &[&str] = &["vehicle_attitude_setpoint"];
const RATES: &[&str] = &["vehicle_rates_setpoint"];

const THRUST: &[Way] = &[
    Way { fields: &["thrust_body[2]"], turn: Turn::By(upward) },
    Way { fields: &["thrust"], turn: Turn::By(same) },
];

const fn published(
    topics: &'static [&'static str],
    quantity: Quantity,
    ways: &'static [Way],
    when: &'static [When],
) -> Row {
    Row { topics, quantity, ways, when, moment: Moment::Published }
}

pub(super) const ROWS: &[Row] = &[
    published(
        TRAJECTORY,
        Quantity::PositionSetpoint,
        &[
            Way { fields: &["position[0]", "position[1]", "position[2]"], turn: Turn::HalfTurn },
            Way { fields: &["x", "y", "z"], turn: Turn::HalfTurn },
        ],
        &[],
    ),
    published(
        TRAJECTORY,
        Quantity::VelocitySetpoint,
        &[
            Way { fields: &["velocity[0]", "velocity[1]", "velocity[2]"], turn: Turn::HalfTurn },
            Way { fields: &["vx", "vy", "vz"], turn: Turn::HalfTurn },
        ],
        &[],
    ),
    published(
        TRAJECTORY,
        Quantity::AccelerationSetpoint,
        &[
            Way { fields: &["acceleration[0]", "acceleration[1]", "acceleration[2]"], turn: Turn::HalfTurn },
            Way { fields: &["acc_x", "acc_y", "acc_z"], turn: Turn::HalfTurn },
        ],
        &[],
    ),
    published(TRAJECTORY, Quantity::YawSetpoint, &[Way { fields: &["yaw"], turn: Turn::By(yaw) }], &[]),
    published(
        TRAJECTORY,
        Quantity::YawRateSetpoint,
        &[Way { fields: &["yawspeed"], turn: Turn::By(yaw) }],
        &[],
    ),
    published(
        ATTITUDE,
        Quantity::AttitudeSetpoint,
        &[Way { fields: &["q_d[0]", "q_d[1]", "q_d[2]", "q_d[3]"], turn: Turn::By(attitude) }],
        &[When::Set("q_d_valid")],
    ),
    published(ATTITUDE, Quantity::ThrustSetpoint, THRUST, &[]),
    published(
        RATES,
        Quantity::AngularRateSetpoint,
        &[Way { fields: &["roll", "pitch", "yaw"], turn: Turn::HalfTurn }],
        &[],
    ),
    published(RATES, Quantity::ThrustSetpoint, THRUST, &[]),
];
