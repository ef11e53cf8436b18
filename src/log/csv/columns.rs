//! The mapping of columns where none is given.

use super::mapping::{AttitudeForm, AxisFrame, CsvMapping, CsvQuantity, CsvTime, CsvUnit};
use crate::recording::Quantity;

/// Each quantity with its columns; `configs/csv/default.toml` says the same for users.
const COLUMNS: &[(Quantity, &[&str])] = &[
    (Quantity::Position, &["position_x_m", "position_y_m", "position_z_m"]),
    (Quantity::Attitude, &["attitude_w", "attitude_x", "attitude_y", "attitude_z"]),
    (Quantity::RollYaw, &["roll_rad", "yaw_rad"]),
    (Quantity::Velocity, &["velocity_x_m_s", "velocity_y_m_s", "velocity_z_m_s"]),
    (Quantity::AngularRate, &["rate_x_rad_s", "rate_y_rad_s", "rate_z_rad_s"]),
    (Quantity::SpecificForce, &["specific_force_x_m_s2", "specific_force_y_m_s2", "specific_force_z_m_s2"]),
    (
        Quantity::WorldAcceleration,
        &["acceleration_world_x_m_s2", "acceleration_world_y_m_s2", "acceleration_world_z_m_s2"],
    ),
    (Quantity::RotorSpeed, &["rotor_{n}_speed_rad_s"]),
    (Quantity::ActuatorCommand, &["motor_{n}_command"]),
    (Quantity::ActuatorDemand, &["motor_{n}_demand"]),
    (Quantity::BatteryVoltage, &["battery_V"]),
    (Quantity::BatteryCurrent, &["battery_A"]),
    (
        Quantity::PositionSetpoint,
        &["setpoint_position_x_m", "setpoint_position_y_m", "setpoint_position_z_m"],
    ),
    (
        Quantity::VelocitySetpoint,
        &["setpoint_velocity_x_m_s", "setpoint_velocity_y_m_s", "setpoint_velocity_z_m_s"],
    ),
    (
        Quantity::AccelerationSetpoint,
        &["setpoint_acceleration_x_m_s2", "setpoint_acceleration_y_m_s2", "setpoint_acceleration_z_m_s2"],
    ),
    (Quantity::YawSetpoint, &["setpoint_yaw_rad"]),
    (Quantity::LandedState, &["landed_state"]),
    (Quantity::Armed, &["armed"]),
];

impl Default for CsvMapping {
    /// The columns that `configs/csv/default.toml` lists: all optional but `time_s`, SI, body FLU, world NWU.
    fn default() -> Self {
        let quantity = |(quantity, columns): &(Quantity, &[&str])| CsvQuantity {
            quantity: *quantity,
            instance: 0,
            columns: columns.iter().map(|column| (*column).to_owned()).collect(),
            form: AttitudeForm::Quaternion,
            frame: AxisFrame::FluNwu,
            unit: CsvUnit::Si,
            scale: 1.0,
            missing: Vec::new(),
            optional: true,
        };
        Self {
            delimiter: None,
            time: CsvTime { column: "time_s".to_owned(), unit: CsvUnit::Si, scale: 1.0 },
            quantities: COLUMNS.iter().map(quantity).collect(),
        }
    }
}
