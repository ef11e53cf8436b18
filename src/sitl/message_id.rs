//! Ids of the messages that the vehicle sends.
#![expect(deprecated, reason = "autopilots and ground stations still speak them")]

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega as dialect;

pub(super) const HEARTBEAT: u32 = dialect::HEARTBEAT_DATA::ID;
pub(super) const SYS_STATUS: u32 = dialect::SYS_STATUS_DATA::ID;
pub(super) const SYSTEM_TIME: u32 = dialect::SYSTEM_TIME_DATA::ID;
pub(super) const PING: u32 = dialect::PING_DATA::ID;
pub(super) const LINK_NODE_STATUS: u32 = dialect::LINK_NODE_STATUS_DATA::ID;
pub(super) const GPS_RAW_INT: u32 = dialect::GPS_RAW_INT_DATA::ID;
pub(super) const RAW_IMU: u32 = dialect::RAW_IMU_DATA::ID;
pub(super) const ATTITUDE: u32 = dialect::ATTITUDE_DATA::ID;
pub(super) const ATTITUDE_QUATERNION: u32 = dialect::ATTITUDE_QUATERNION_DATA::ID;
pub(super) const LOCAL_POSITION_NED: u32 = dialect::LOCAL_POSITION_NED_DATA::ID;
pub(super) const GLOBAL_POSITION_INT: u32 = dialect::GLOBAL_POSITION_INT_DATA::ID;
pub(super) const SERVO_OUTPUT_RAW: u32 = dialect::SERVO_OUTPUT_RAW_DATA::ID;
pub(super) const GPS_GLOBAL_ORIGIN: u32 = dialect::GPS_GLOBAL_ORIGIN_DATA::ID;
pub(super) const RC_CHANNELS: u32 = dialect::RC_CHANNELS_DATA::ID;
pub(super) const VFR_HUD: u32 = dialect::VFR_HUD_DATA::ID;
pub(super) const ATTITUDE_TARGET: u32 = dialect::ATTITUDE_TARGET_DATA::ID;
pub(super) const POSITION_TARGET_LOCAL_NED: u32 = dialect::POSITION_TARGET_LOCAL_NED_DATA::ID;
pub(super) const HIGHRES_IMU: u32 = dialect::HIGHRES_IMU_DATA::ID;
pub(super) const TIMESYNC: u32 = dialect::TIMESYNC_DATA::ID;
pub(super) const SCALED_IMU2: u32 = dialect::SCALED_IMU2_DATA::ID;
pub(super) const ALTITUDE: u32 = dialect::ALTITUDE_DATA::ID;
pub(super) const BATTERY_STATUS: u32 = dialect::BATTERY_STATUS_DATA::ID;
pub(super) const AUTOPILOT_VERSION: u32 = dialect::AUTOPILOT_VERSION_DATA::ID;
pub(super) const EKF_STATUS_REPORT: u32 = dialect::EKF_STATUS_REPORT_DATA::ID;
pub(super) const RPM: u32 = dialect::RPM_DATA::ID;
pub(super) const ESTIMATOR_STATUS: u32 = dialect::ESTIMATOR_STATUS_DATA::ID;
pub(super) const HOME_POSITION: u32 = dialect::HOME_POSITION_DATA::ID;
pub(super) const EXTENDED_SYS_STATE: u32 = dialect::EXTENDED_SYS_STATE_DATA::ID;
pub(super) const ESC_INFO: u32 = dialect::ESC_INFO_DATA::ID;
pub(super) const ESC_STATUS: u32 = dialect::ESC_STATUS_DATA::ID;
pub(super) const ODOMETRY: u32 = dialect::ODOMETRY_DATA::ID;
pub(super) const ACTUATOR_OUTPUT_STATUS: u32 = dialect::ACTUATOR_OUTPUT_STATUS_DATA::ID;
pub(super) const CURRENT_EVENT_SEQUENCE: u32 = dialect::CURRENT_EVENT_SEQUENCE_DATA::ID;
pub(super) const CURRENT_MODE: u32 = dialect::CURRENT_MODE_DATA::ID;
pub(super) const ESC_TELEMETRY_1_TO_4: u32 = dialect::ESC_TELEMETRY_1_TO_4_DATA::ID;
