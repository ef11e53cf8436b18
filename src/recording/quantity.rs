//! What a stream holds.

/// What a stream holds. Units SI, body FLU, world NWU; the width is the number of values a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// quaternion w x y z, body to world (4)
    Attitude,
    /// roll and yaw only, rad, where pitch is not logged (2)
    RollYaw,
    /// body rates, rad/s (3)
    AngularRate,
    /// what an accelerometer feels, body, m/s^2, about +9.81 on z in hover (3)
    SpecificForce,
    /// world acceleration without gravity, m/s^2 (3)
    WorldAcceleration,
    /// world, m (3)
    Position,
    /// world, m/s (3)
    Velocity,
    /// world, m/s, as a satellite receiver measures it: raw, not the vehicle's estimate (3)
    GpsVelocity,
    /// above the standard atmosphere's sea level, by air pressure, m (1)
    BarometricHeight,
    /// actuator outputs as recorded: 0..1 or microseconds (one a channel)
    ActuatorCommand,
    /// actuator outputs before the firmware's battery correction (one a channel)
    ActuatorDemand,
    /// force and torque on the body where the log holds them: Fz, tau_x, tau_y, tau_z; N, N m (4)
    Wrench,
    /// measured rotor speed, rad/s (one a rotor)
    RotorSpeed,
    /// V (1)
    BatteryVoltage,
    /// A (1)
    BatteryCurrent,
    /// filtered voltage over that of a full battery, by which the autopilot divides its outputs (1)
    BatteryCompensation,
    /// commanded world position, m (3)
    PositionSetpoint,
    /// commanded world velocity, m/s (3)
    VelocitySetpoint,
    /// commanded world acceleration, m/s^2 (3)
    AccelerationSetpoint,
    /// commanded yaw about up, rad (1)
    YawSetpoint,
    /// commanded yaw rate about up, rad/s (1)
    YawRateSetpoint,
    /// commanded attitude, quaternion w x y z (4)
    AttitudeSetpoint,
    /// commanded body rates, rad/s (3)
    AngularRateSetpoint,
    /// commanded collective thrust, 0..1 (1)
    ThrustSetpoint,
    /// commanded torque before the mixer, body, each axis -1..1 of the autopilot's own scale (3)
    TorqueSetpoint,
    /// commanded force before the mixer, body, each axis -1..1 of the autopilot's own scale, positive on z in hover (3)
    ThrustVectorSetpoint,
    /// MAV_LANDED_STATE as a number: 1 on ground, 2 in air, 3 taking off, 4 landing (1)
    LandedState,
    /// 1 armed, 0 disarmed (1)
    Armed,
    /// autopilot's custom mode number (1)
    Mode,
}

impl Quantity {
    /// Name as in files and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Attitude => "attitude",
            Self::RollYaw => "roll_yaw",
            Self::AngularRate => "angular_rate",
            Self::SpecificForce => "specific_force",
            Self::WorldAcceleration => "world_acceleration",
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::GpsVelocity => "gps_velocity",
            Self::BarometricHeight => "barometric_height",
            Self::ActuatorCommand => "actuator_command",
            Self::ActuatorDemand => "actuator_demand",
            Self::Wrench => "wrench",
            Self::RotorSpeed => "rotor_speed",
            Self::BatteryVoltage => "battery_voltage",
            Self::BatteryCurrent => "battery_current",
            Self::BatteryCompensation => "battery_compensation",
            Self::PositionSetpoint => "position_setpoint",
            Self::VelocitySetpoint => "velocity_setpoint",
            Self::AccelerationSetpoint => "acceleration_setpoint",
            Self::YawSetpoint => "yaw_setpoint",
            Self::YawRateSetpoint => "yaw_rate_setpoint",
            Self::AttitudeSetpoint => "attitude_setpoint",
            Self::AngularRateSetpoint => "angular_rate_setpoint",
            Self::ThrustSetpoint => "thrust_setpoint",
            Self::TorqueSetpoint => "torque_setpoint",
            Self::ThrustVectorSetpoint => "thrust_vector",
            Self::LandedState => "landed_state",
            Self::Armed => "armed",
            Self::Mode => "mode",
        }
    }
}
