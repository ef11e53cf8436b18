//! What drives the vehicle: motor commands, outputs, rotor speeds, battery.

use super::row::{Moment, Row, Way, When};
use super::turns::{Turn, channels, not_negative, outputs, positive, speeds, speeds_by_motor, thrust};
use crate::recording::Quantity;

const BATTERY: &[&str] = &["battery_status"];
const CONNECTED: &[When] = &[When::Set("connected")];

pub(super) const ROWS: &[Row] = &[
    // thrust of each motor, 0..1, before the thrust curve; since 1.13
    Row {
        topics: &["actuator_motors"],
        quantity: Quantity::ActuatorCommand,
        ways: &[Way { fields: &["control[*]"], turn: Turn::By(channels) }],
        when: &[],
        moment: Moment::Published,
    },
    // pulse widths, or whatever the output protocol counts
    Row {
        topics: &["actuator_outputs"],
        quantity: Quantity::ActuatorCommand,
        ways: &[Way { fields: &["noutputs", "output[*]"], turn: Turn::By(outputs) }],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: &["esc_status"],
        quantity: Quantity::RotorSpeed,
        ways: &[
            Way {
                fields: &["esc_count", "esc_online_flags", "esc[*].esc_rpm", "esc[*].actuator_function"],
                turn: Turn::By(speeds_by_motor),
            },
            Way { fields: &["esc_count", "esc[*].esc_rpm"], turn: Turn::By(speeds) },
        ],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: BATTERY,
        quantity: Quantity::BatteryVoltage,
        ways: &[Way { fields: &["voltage_v"], turn: Turn::By(positive) }],
        when: CONNECTED,
        moment: Moment::Published,
    },
    Row {
        topics: BATTERY,
        quantity: Quantity::BatteryCurrent,
        ways: &[Way { fields: &["current_a"], turn: Turn::By(not_negative) }],
        when: CONNECTED,
        moment: Moment::Published,
    },
    // before the allocation to the motors; since 1.14
    Row {
        topics: &["vehicle_torque_setpoint"],
        quantity: Quantity::TorqueSetpoint,
        ways: &[Way { fields: &["xyz[0]", "xyz[1]", "xyz[2]"], turn: Turn::HalfTurn }],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: &["vehicle_thrust_setpoint"],
        quantity: Quantity::ThrustVectorSetpoint,
        ways: &[Way { fields: &["xyz[0]", "xyz[1]", "xyz[2]"], turn: Turn::HalfTurn }],
        when: &[],
        moment: Moment::Published,
    },
    // roll, pitch, yaw and thrust until 1.13
    Row {
        topics: &["actuator_controls_0"],
        quantity: Quantity::TorqueSetpoint,
        ways: &[Way { fields: &["control[0]", "control[1]", "control[2]"], turn: Turn::HalfTurn }],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: &["actuator_controls_0"],
        quantity: Quantity::ThrustVectorSetpoint,
        ways: &[Way { fields: &["control[3]"], turn: Turn::By(thrust) }],
        when: &[],
        moment: Moment::Published,
    },
];
