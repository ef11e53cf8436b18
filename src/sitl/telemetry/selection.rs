//! The message of an id as it is now.

use super::scene::{Scene, Snapshot};
use super::source::Telemetry;
use crate::sitl::autopilot::Autopilot;
use crate::sitl::message::Message;
use crate::wire::message_id as ids;

impl Telemetry {
    /// The message of this id as it is now; `None` where the vehicle has nothing to say.
    pub(in crate::sitl) fn message(
        &mut self,
        id: u32,
        at: &Snapshot,
        autopilot: &Autopilot,
    ) -> Option<Message> {
        let mut measured = self.noise.measure(&mut self.rng, &at.shown.state);
        measured.position_m += autopilot.estimator.shift_m();
        let scene = Scene { at, autopilot, measured };
        let has_origin = autopilot.estimator.is_warm(at.now);
        Some(match id {
            ids::HEARTBEAT => self.heartbeat(&scene),
            ids::SYS_STATUS => self.sys_status(&scene),
            ids::SYSTEM_TIME => self.system_time(&scene),
            ids::PING => self.ping(&scene),
            ids::LINK_NODE_STATUS => self.link_node_status(&scene),
            ids::BATTERY_STATUS => self.battery_status(&scene),
            ids::AUTOPILOT_VERSION => self.autopilot_version(),
            ids::EXTENDED_SYS_STATE => self.extended_sys_state(&scene),
            ids::CURRENT_MODE => self.current_mode(&scene),
            ids::CURRENT_EVENT_SEQUENCE => Self::current_event_sequence(),
            ids::TIMESYNC => Self::timesync(at.now),
            ids::ESTIMATOR_STATUS => self.estimator_status(&scene),
            ids::EKF_STATUS_REPORT => self.ekf_status_report(&scene),
            ids::RC_CHANNELS if autopilot.safety.has_transmitter() => self.rc_channels(&scene),
            ids::ATTITUDE => self.attitude(&scene),
            ids::ATTITUDE_QUATERNION => self.attitude_quaternion(&scene),
            ids::ATTITUDE_TARGET if autopilot.is_armed() => self.attitude_target(&scene),
            ids::HIGHRES_IMU => self.highres_imu(&scene),
            ids::RAW_IMU | ids::SCALED_IMU2 => self.raw_imu(id, &scene),
            ids::SERVO_OUTPUT_RAW => self.servo_output_raw(&scene),
            ids::ACTUATOR_OUTPUT_STATUS => self.actuator_output_status(&scene),
            ids::ESC_STATUS if self.esc_telemetry => self.esc_status(&scene)?,
            ids::ESC_INFO if self.esc_telemetry => self.esc_info(&scene),
            ids::ESC_TELEMETRY_1_TO_4 => self.esc_telemetry(&scene),
            ids::GPS_RAW_INT => self.gps_raw_int(&scene),
            ids::LOCAL_POSITION_NED if has_origin => self.local_position_ned(&scene),
            ids::ODOMETRY if has_origin => self.odometry(&scene),
            ids::GLOBAL_POSITION_INT if has_origin => self.global_position_int(&scene),
            ids::GPS_GLOBAL_ORIGIN if has_origin => self.gps_global_origin(&scene),
            ids::HOME_POSITION => self.home_position(&scene)?,
            ids::ALTITUDE if has_origin => self.altitude(&scene),
            ids::VFR_HUD => self.vfr_hud(&scene),
            ids::POSITION_TARGET_LOCAL_NED if autopilot.is_armed() => self.position_target(&scene),
            _ => return None,
        })
    }
}
