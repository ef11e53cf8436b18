//! Attitude, rates and the inertial unit.

use mavlink::dialects::ardupilotmega::{
    ATTITUDE_DATA, ATTITUDE_QUATERNION_DATA, ATTITUDE_TARGET_DATA, AttitudeTargetTypemask, HIGHRES_IMU_DATA,
    HighresImuUpdatedFlags, RAW_IMU_DATA, SCALED_IMU2_DATA,
};

use super::super::demand::frd;
use super::super::message::Message;
use super::field::short;
use super::scene::Scene;
use super::source::Telemetry;
use crate::frames::{Attitude, frd_ned_from_attitude, yaw_from_ned};
use crate::units::{STANDARD_GRAVITY_M_S2, narrow};
use crate::wire::message_id as ids;

/// Bits of accelerations and rates.
const FIELDS_UPDATED: u16 = 0b11_1111;
/// Degrees Celsius.
const TEMPERATURE: i16 = 25;
/// Earth's field where the vehicle flies, world (north, west, up), gauss.
const FIELD_GAUSS: [f64; 3] = [0.21, 0.0, -0.43];

impl Telemetry {
    pub(super) fn attitude(&self, scene: &Scene) -> Message {
        let (roll, pitch, yaw) = scene.measured.attitude.euler_angles();
        let [rollspeed, pitchspeed, yawspeed] = rates(scene);
        Message::from(ATTITUDE_DATA {
            time_boot_ms: scene.ms(self.skew.attitude_s),
            // the half turn about x mirrors pitch and yaw
            roll: narrow(roll),
            pitch: narrow(-pitch),
            yaw: narrow(yaw_from_ned(yaw)),
            rollspeed,
            pitchspeed,
            yawspeed,
        })
    }

    pub(super) fn attitude_quaternion(&self, scene: &Scene) -> Message {
        let [q1, q2, q3, q4] = frd_ned_from_attitude(Attitude(scene.measured.attitude)).map(narrow);
        let [rollspeed, pitchspeed, yawspeed] = rates(scene);
        Message::from(ATTITUDE_QUATERNION_DATA {
            time_boot_ms: scene.ms(self.skew.attitude_s),
            q1,
            q2,
            q3,
            q4,
            rollspeed,
            pitchspeed,
            yawspeed,
            ..ATTITUDE_QUATERNION_DATA::DEFAULT
        })
    }

    pub(super) fn attitude_target(&self, scene: &Scene) -> Message {
        let wanted = scene.autopilot.cascade.inner_loop_setpoint();
        let [body_roll_rate, body_pitch_rate, body_yaw_rate] = frd(wanted.rates_rad_s).map(narrow);
        Message::from(ATTITUDE_TARGET_DATA {
            time_boot_ms: scene.ms(0.0),
            q: frd_ned_from_attitude(Attitude(wanted.attitude)).map(narrow),
            body_roll_rate,
            body_pitch_rate,
            body_yaw_rate,
            thrust: narrow((wanted.thrust_n / scene.autopilot.thrust_max_n).clamp(0.0, 1.0)),
            type_mask: AttitudeTargetTypemask::empty(),
        })
    }

    fn magnetometer(scene: &Scene) -> [f64; 3] {
        frd(scene.measured.attitude.inverse_transform_vector(&FIELD_GAUSS.into()))
    }

    pub(super) fn highres_imu(&mut self, scene: &Scene) -> Message {
        let force = self.noise.measure_force(&mut self.rng, &scene.at.shown.specific_force_m_s2);
        let [xacc, yacc, zacc] = frd(force).map(narrow);
        let [xgyro, ygyro, zgyro] = rates(scene);
        let [xmag, ymag, zmag] = Self::magnetometer(scene).map(narrow);
        Message::from(HIGHRES_IMU_DATA {
            time_usec: scene.us(self.skew.imu_s),
            xacc,
            yacc,
            zacc,
            xgyro,
            ygyro,
            zgyro,
            xmag,
            ymag,
            zmag,
            temperature: TEMPERATURE.into(),
            fields_updated: HighresImuUpdatedFlags::from_bits_retain(FIELDS_UPDATED),
            ..HIGHRES_IMU_DATA::DEFAULT
        })
    }

    /// RAW_IMU and SCALED_IMU2: milli-g, mrad/s and milligauss in sixteen bits.
    pub(super) fn raw_imu(&mut self, id: u32, scene: &Scene) -> Message {
        let force = self.noise.measure_force(&mut self.rng, &scene.at.shown.specific_force_m_s2);
        let [xacc, yacc, zacc] = frd(force).map(|a| short(1e3 * a / STANDARD_GRAVITY_M_S2));
        let [xgyro, ygyro, zgyro] = frd(scene.measured.rates_rad_s).map(|w| short(1e3 * w));
        let [xmag, ymag, zmag] = Self::magnetometer(scene).map(|b| short(1e3 * b));
        // hundredths of a degree Celsius
        let temperature = 100 * TEMPERATURE;
        if id == ids::RAW_IMU {
            let time_usec = scene.us(self.skew.imu_s);
            return Message::from(RAW_IMU_DATA {
                time_usec,
                xacc,
                yacc,
                zacc,
                xgyro,
                ygyro,
                zgyro,
                xmag,
                ymag,
                zmag,
                id: 0,
                temperature,
            });
        }
        let time_boot_ms = scene.ms(self.skew.imu_s);
        Message::from(SCALED_IMU2_DATA {
            time_boot_ms,
            xacc,
            yacc,
            zacc,
            xgyro,
            ygyro,
            zgyro,
            xmag,
            ymag,
            zmag,
            temperature,
        })
    }
}

/// Body rates (FRD), rad/s.
fn rates(scene: &Scene) -> [f32; 3] {
    frd(scene.measured.rates_rad_s).map(narrow)
}
