//! Which reader each message's payload goes to.

use super::samples::Samples;
use super::source::Source;
use super::{actuators, imu, motion, setpoints, status};
use crate::wire::frame::Payload;

impl Source {
    /// Gives the samples that a payload of this message holds.
    pub(super) fn decode(self, payload: Payload<'_>, samples: &mut Samples<'_>) {
        match self {
            Self::Heartbeat => status::heartbeat(payload, samples),
            Self::SysStatus => status::sys_status(payload, samples),
            Self::SystemTime | Self::ParamValue | Self::Statustext => nothing(payload, samples),
            Self::GpsRawInt => motion::gps_raw_int(payload, samples),
            Self::ScaledImu | Self::ScaledImu2 | Self::ScaledImu3 => imu::scaled_imu(payload, samples),
            Self::RawImu => imu::raw_imu(payload, samples),
            Self::Attitude => motion::attitude(payload, samples),
            Self::AttitudeQuaternion => motion::attitude_quaternion(payload, samples),
            Self::LocalPositionNed => motion::local_position_ned(payload, samples),
            Self::ServoOutputRaw => actuators::servo_output_raw(payload, samples),
            Self::SetAttitudeTarget => setpoints::set_attitude_target(payload, samples),
            Self::AttitudeTarget => setpoints::attitude_target(payload, samples),
            Self::SetPositionTargetLocalNed => setpoints::set_position_target_local_ned(payload, samples),
            Self::PositionTargetLocalNed => setpoints::position_target_local_ned(payload, samples),
            Self::HighresImu => imu::highres_imu(payload, samples),
            Self::BatteryStatus => status::battery_status(payload, samples),
            Self::ExtendedSysState => status::extended_sys_state(payload, samples),
            Self::EscStatus => actuators::esc_status(payload, samples),
            Self::Odometry => motion::odometry(payload, samples),
            Self::ActuatorOutputStatus => actuators::actuator_output_status(payload, samples),
            Self::CurrentMode => status::current_mode(payload, samples),
            Self::EscTelemetry1To4 | Self::EscTelemetry5To8 | Self::EscTelemetry9To12 => {
                actuators::esc_telemetry(payload, samples)
            }
        }
    }
}

/// For messages that hold no samples.
fn nothing(_: Payload<'_>, _: &mut Samples<'_>) {}
