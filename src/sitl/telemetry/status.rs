//! Health, mode, battery, clocks.

use mavlink::dialects::ardupilotmega::{
    AUTOPILOT_VERSION_DATA, BATTERY_STATUS_DATA, CURRENT_EVENT_SEQUENCE_DATA, CURRENT_MODE_DATA,
    EKF_STATUS_REPORT_DATA, ESTIMATOR_STATUS_DATA, EXTENDED_SYS_STATE_DATA, EkfStatusFlags,
    EstimatorStatusFlags, FirmwareVersionType, HEARTBEAT_DATA, LINK_NODE_STATUS_DATA, MavBatteryFault,
    MavBatteryType, MavEventCurrentSequenceFlags, MavLandedState, MavModeFlag, MavProtocolCapability,
    MavState, MavSysStatusSensor, MavSysStatusSensorExtended, RC_CHANNELS_DATA, SYS_STATUS_DATA,
    SYSTEM_TIME_DATA, TIMESYNC_DATA,
};

use super::super::Mode;
use super::super::battery::Charge;
use super::super::guidance::Task;
use super::super::message::Message;
use super::super::ping::ping;
use super::field::{nanoseconds, ushort};
use super::scene::Scene;
use super::source::Telemetry;
use crate::autopilot::{Release, multirotor_type};
use crate::units::{narrow, whole};

/// Version of the protocol that a heartbeat gives.
pub(in crate::sitl) const PROTOCOL: u8 = 3;

/// Gyroscope, accelerometer, compass, barometer, GPS, rate and attitude control, outputs, estimator.
const SENSORS: MavSysStatusSensor = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_GYRO
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_ACCEL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_MAG)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_GPS)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_YAW_POSITION)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_AHRS);

/// What a good estimate knows: attitude, velocities, positions and their predictions.
const ESTIMATE_GOOD: EstimatorStatusFlags = ESTIMATE_HEIGHT_ONLY
    .union(EstimatorStatusFlags::ESTIMATOR_VELOCITY_HORIZ)
    .union(EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_REL)
    .union(EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_ABS)
    .union(EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_REL)
    .union(EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_ABS);
const ESTIMATE_HEIGHT_ONLY: EstimatorStatusFlags = EstimatorStatusFlags::ESTIMATOR_ATTITUDE
    .union(EstimatorStatusFlags::ESTIMATOR_VELOCITY_VERT)
    .union(EstimatorStatusFlags::ESTIMATOR_POS_VERT_ABS);

/// Missions and commands in integers, local setpoints, MAVLink 2, file transfer, fence.
const CAPABILITIES: MavProtocolCapability = MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_INT
    .union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_COMMAND_INT)
    .union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED)
    .union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MAVLINK2)
    .union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_FTP)
    .union(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_FENCE);

impl Telemetry {
    pub(super) fn heartbeat(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        let sticks = MavModeFlag::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED;
        let guided = MavModeFlag::MAV_MODE_FLAG_GUIDED_ENABLED;
        let own = match (self.kind.is_px4(), autopilot.mode) {
            (true, mode) if mode.is_manual() => sticks,
            (true, _) => MavModeFlag::MAV_MODE_FLAG_AUTO_ENABLED | guided,
            (false, Mode::Guided | Mode::Return) => sticks | guided,
            (false, _) => sticks,
        };
        let stabilized = MavModeFlag::MAV_MODE_FLAG_STABILIZE_ENABLED;
        let mut base_mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | stabilized | own;
        base_mode.set(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, autopilot.is_armed());
        let flying = if self.kind.is_px4() { autopilot.is_armed() } else { !autopilot.is_landed() };
        let system_status = match (autopilot.safety.is_active(self.kind.is_px4()), flying) {
            (true, _) => MavState::MAV_STATE_CRITICAL,
            (false, true) => MavState::MAV_STATE_ACTIVE,
            (false, false) => MavState::MAV_STATE_STANDBY,
        };
        Message::from(HEARTBEAT_DATA {
            custom_mode: autopilot.mode.custom_mode(self.kind).unwrap_or(0),
            mavtype: multirotor_type(self.rotor_count),
            autopilot: self.kind.stack().mav_autopilot,
            base_mode,
            system_status,
            mavlink_version: PROTOCOL,
        })
    }

    pub(super) fn sys_status(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        let position = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL;
        let battery = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_BATTERY;
        let checks = MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK;
        let height = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL;
        let mut present = SENSORS | height | position | battery;
        let receiver = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_RC_RECEIVER;
        present.set(receiver, autopilot.safety.has_transmitter());
        let mut health = present;
        health.set(position, autopilot.estimator.is_good(scene.at.now));
        health.set(battery, autopilot.safety.charge() == Charge::Ok);
        // PX4 shows its arming checks in the health alone
        present.set(checks, !self.kind.is_px4());
        health.set(checks, autopilot.arming_refusals(scene.at.now).is_empty());
        Message::from(SYS_STATUS_DATA {
            onboard_control_sensors_present: present,
            onboard_control_sensors_enabled: present,
            onboard_control_sensors_health: health,
            load: 150,
            voltage_battery: ushort(autopilot.battery.volts() * 1e3),
            current_battery: -1,
            battery_remaining: percent(autopilot.battery.remaining()),
            onboard_control_sensors_present_extended: MavSysStatusSensorExtended::empty(),
            onboard_control_sensors_enabled_extended: MavSysStatusSensorExtended::empty(),
            onboard_control_sensors_health_extended: MavSysStatusSensorExtended::empty(),
            ..SYS_STATUS_DATA::DEFAULT
        })
    }

    pub(super) fn battery_status(&self, scene: &Scene) -> Message {
        let battery = &scene.autopilot.battery;
        let mut voltages = [u16::MAX; 10];
        voltages[0] = ushort(battery.volts() * 1e3);
        Message::from(BATTERY_STATUS_DATA {
            current_consumed: -1,
            energy_consumed: -1,
            temperature: i16::MAX,
            voltages,
            current_battery: -1,
            mavtype: MavBatteryType::MAV_BATTERY_TYPE_LIPO,
            battery_remaining: percent(battery.remaining()),
            charge_state: scene.autopilot.safety.charge().mav(),
            fault_bitmask: MavBatteryFault::empty(),
            ..BATTERY_STATUS_DATA::DEFAULT
        })
    }

    pub(super) fn system_time(&self, scene: &Scene) -> Message {
        Message::from(SYSTEM_TIME_DATA {
            time_unix_usec: self.boot_unix_us + scene.us(0.0),
            time_boot_ms: scene.ms(0.0),
        })
    }

    pub(super) fn ping(&mut self, scene: &Scene) -> Message {
        self.pings += 1;
        ping(scene.us(0.0), self.pings, (0, 0))
    }

    pub(super) fn link_node_status(&self, scene: &Scene) -> Message {
        Message::from(LINK_NODE_STATUS_DATA { timestamp: scene.us(0.0), ..LINK_NODE_STATUS_DATA::DEFAULT })
    }

    pub(super) fn current_event_sequence() -> Message {
        Message::from(CURRENT_EVENT_SEQUENCE_DATA {
            sequence: 0,
            flags: MavEventCurrentSequenceFlags::empty(),
        })
    }

    pub(super) fn autopilot_version(&self) -> Message {
        let parameters = if self.kind.is_px4() {
            MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
        } else {
            MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
        };
        let Release { major, minor } = self.kind.release();
        let version = [major, minor, 0, FirmwareVersionType::FIRMWARE_VERSION_TYPE_OFFICIAL as u8];
        Message::from(AUTOPILOT_VERSION_DATA {
            capabilities: CAPABILITIES | parameters,
            uid: 1,
            flight_sw_version: u32::from_be_bytes(version),
            uid2: self.uid2,
            ..AUTOPILOT_VERSION_DATA::DEFAULT
        })
    }

    pub(super) fn extended_sys_state(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        let landed_state = match (autopilot.is_landed(), autopilot.guidance.task) {
            (true, _) => MavLandedState::MAV_LANDED_STATE_ON_GROUND,
            (false, Task::Takeoff(_)) => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
            (false, Task::Land) => MavLandedState::MAV_LANDED_STATE_LANDING,
            (false, _) => MavLandedState::MAV_LANDED_STATE_IN_AIR,
        };
        Message::from(EXTENDED_SYS_STATE_DATA { landed_state, ..EXTENDED_SYS_STATE_DATA::DEFAULT })
    }

    pub(super) fn current_mode(&self, scene: &Scene) -> Message {
        let number = |mode: Mode| mode.custom_mode(self.kind).unwrap_or(0);
        let autopilot = scene.autopilot;
        Message::from(CURRENT_MODE_DATA {
            custom_mode: number(autopilot.mode),
            intended_custom_mode: number(autopilot.intended),
            ..CURRENT_MODE_DATA::DEFAULT
        })
    }

    /// PX4's.
    pub(super) fn estimator_status(&self, scene: &Scene) -> Message {
        let estimator = &scene.autopilot.estimator;
        let ratio = narrow(estimator.test_ratio(scene.at.now));
        let good = estimator.is_good(scene.at.now);
        let mut flags = if good { ESTIMATE_GOOD } else { ESTIMATE_HEIGHT_ONLY };
        // PX4 says so also of a vehicle that stands on the ground
        flags.set(EstimatorStatusFlags::ESTIMATOR_CONST_POS_MODE, scene.autopilot.is_landed());
        Message::from(ESTIMATOR_STATUS_DATA {
            time_usec: scene.us(0.0),
            vel_ratio: ratio,
            pos_horiz_ratio: ratio,
            pos_vert_ratio: 0.05,
            mag_ratio: 0.05,
            hagl_ratio: f32::NAN,
            tas_ratio: f32::NAN,
            pos_horiz_accuracy: if good { 0.3 } else { 50.0 },
            pos_vert_accuracy: 0.4,
            flags,
        })
    }

    /// ArduPilot's: its flags are PX4's.
    pub(super) fn ekf_status_report(&self, scene: &Scene) -> Message {
        let estimator = &scene.autopilot.estimator;
        let ratio = narrow(estimator.test_ratio(scene.at.now));
        let good = estimator.is_good(scene.at.now);
        let flags = if good { ESTIMATE_GOOD } else { ESTIMATE_HEIGHT_ONLY };
        let mut flags = EkfStatusFlags::from_bits_retain(flags.bits());
        flags.set(EkfStatusFlags::EKF_CONST_POS_MODE, !good);
        Message::from(EKF_STATUS_REPORT_DATA {
            velocity_variance: ratio,
            pos_horiz_variance: ratio,
            pos_vert_variance: 0.05,
            compass_variance: 0.05,
            flags,
            ..EKF_STATUS_REPORT_DATA::DEFAULT
        })
    }

    /// Sticks centred, mode switch in the middle.
    pub(super) fn rc_channels(&self, scene: &Scene) -> Message {
        const CENTRE: u16 = 1500;
        const NONE: u16 = u16::MAX;
        Message::from(RC_CHANNELS_DATA {
            time_boot_ms: scene.ms(0.0),
            chan1_raw: CENTRE,
            chan2_raw: CENTRE,
            chan3_raw: CENTRE,
            chan4_raw: CENTRE,
            chan5_raw: CENTRE,
            chan6_raw: CENTRE,
            chan7_raw: CENTRE,
            chan8_raw: CENTRE,
            chan9_raw: NONE,
            chan10_raw: NONE,
            chan11_raw: NONE,
            chan12_raw: NONE,
            chan13_raw: NONE,
            chan14_raw: NONE,
            chan15_raw: NONE,
            chan16_raw: NONE,
            chan17_raw: NONE,
            chan18_raw: NONE,
            chancount: 8,
            rssi: 254,
        })
    }

    /// A TIMESYNC that asks: nanoseconds since boot.
    pub(super) fn timesync(now: std::time::Duration) -> Message {
        Message::from(TIMESYNC_DATA { ts1: nanoseconds(now), ..TIMESYNC_DATA::DEFAULT })
    }

    /// The answer to a TIMESYNC that asks.
    pub(in super::super) fn timesync_answer(
        now: std::time::Duration,
        asked: i64,
        (target_system, target_component): (u8, u8),
    ) -> Message {
        Message::from(TIMESYNC_DATA { tc1: nanoseconds(now), ts1: asked, target_system, target_component })
    }
}

fn percent(share: f64) -> i8 {
    i8::try_from(whole(100.0 * share)).unwrap_or(-1)
}
