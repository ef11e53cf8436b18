//! Attitude, rates and the inertial unit.

use super::super::demand::frd;
use super::super::message::Message;
use super::super::message_id as ids;
use super::field::short;
use super::scene::Scene;
use super::source::Telemetry;
use crate::frames::{Attitude, frd_ned_from_attitude, yaw_from_ned};
use crate::units::STANDARD_GRAVITY_M_S2;

/// HIGHRES_IMU.fields_updated: accelerations, rates, and the rest that is filled.
const FIELDS_UPDATED: u16 = 0b11_1111;
/// Earth's field where the vehicle flies, world (north, west, up), gauss.
const FIELD_GAUSS: [f64; 3] = [0.21, 0.0, -0.43];

impl Telemetry {
    pub(super) fn attitude(&self, scene: &Scene) -> Message {
        let (roll, pitch, yaw) = scene.seen.attitude.euler_angles();
        Message::new(ids::ATTITUDE)
            .u32(scene.ms(self.skew.attitude_s))
            // the half turn about x mirrors pitch and yaw
            .f32s(&[roll, -pitch, yaw_from_ned(yaw)])
            .f32s(&frd(scene.seen.rates_rad_s))
    }

    pub(super) fn attitude_quaternion(&self, scene: &Scene) -> Message {
        Message::new(ids::ATTITUDE_QUATERNION)
            .u32(scene.ms(self.skew.attitude_s))
            .f32s(&frd_ned_from_attitude(Attitude(scene.seen.attitude)))
            .f32s(&frd(scene.seen.rates_rad_s))
    }

    pub(super) fn attitude_target(&self, scene: &Scene) -> Message {
        let wanted = scene.autopilot.cascade.wanted();
        Message::new(ids::ATTITUDE_TARGET)
            .u32(scene.ms(0.0))
            .f32s(&frd_ned_from_attitude(Attitude(wanted.attitude)))
            .f32s(&frd(wanted.rates_rad_s))
            .f32((wanted.thrust_n / scene.autopilot.thrust_max_n).clamp(0.0, 1.0))
            .u8(0)
    }

    fn magnetometer(scene: &Scene) -> [f64; 3] {
        frd(scene.seen.attitude.inverse_transform_vector(&FIELD_GAUSS.into()))
    }

    pub(super) fn highres_imu(&mut self, scene: &Scene) -> Message {
        let force = self.noise.measure_force(&mut self.rng, &scene.at.shown.specific_force_m_s2);
        Message::new(ids::HIGHRES_IMU)
            .u64(scene.us(self.skew.imu_s))
            .f32s(&frd(force))
            .f32s(&frd(scene.seen.rates_rad_s))
            .f32s(&Self::magnetometer(scene))
            .f32s(&[0.0, 0.0, 0.0, 25.0])
            .u16(FIELDS_UPDATED)
            .u8(0)
    }

    /// RAW_IMU and SCALED_IMU2: milli-g, mrad/s and milligauss in sixteen bits.
    pub(super) fn raw_imu(&mut self, id: u32, scene: &Scene) -> Message {
        let force = self.noise.measure_force(&mut self.rng, &scene.at.shown.specific_force_m_s2);
        let values = [
            frd(force).map(|a| short(1e3 * a / STANDARD_GRAVITY_M_S2)),
            frd(scene.seen.rates_rad_s).map(|w| short(1e3 * w)),
            Self::magnetometer(scene).map(|b| short(1e3 * b)),
        ];
        let message = if id == ids::RAW_IMU {
            Message::new(id).u64(scene.us(self.skew.imu_s))
        } else {
            Message::new(id).u32(scene.ms(self.skew.imu_s))
        };
        let message = values.iter().flatten().fold(message, |message, value| message.i16(*value));
        let message = if id == ids::RAW_IMU { message.u8(0) } else { message };
        // hundredths of a degree Celsius
        message.i16(2500)
    }
}
