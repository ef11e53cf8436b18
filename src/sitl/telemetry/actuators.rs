//! Outputs and rotor speeds.

use super::super::message::Message;
use super::super::message_id as ids;
use super::field::ushort;
use super::scene::Scene;
use super::source::Telemetry;
use crate::physics::MAX_ROTORS;
use crate::units::{rad_s_from_rpm, whole};

/// Rotors of one message of ESC telemetry.
const BATCH: usize = 4;
/// ESC_CONNECTION_TYPE_DSHOT
const DSHOT: u8 = 5;

impl Telemetry {
    /// The time wraps after 71.6 minutes: it has 32 bits.
    pub(super) fn servo_output_raw(&self, scene: &Scene) -> Message {
        let time_us = u32::try_from(scene.us(self.skew.actuator_s) & u64::from(u32::MAX)).unwrap_or(0);
        let mut outputs = [0; 8];
        outputs[..MAX_ROTORS].copy_from_slice(&scene.at.pulses_us);
        outputs[self.rotor_count.min(8)..].fill(0);
        Message::new(ids::SERVO_OUTPUT_RAW).u32(time_us).u16s(&outputs).u8(0).u16s(&[0; 8])
    }

    /// PX4 sends the same pulses here, and in `active` their number.
    pub(super) fn actuator_output_status(&self, scene: &Scene) -> Message {
        let mut outputs = [0.0; 32];
        for (output, pulse) in outputs.iter_mut().zip(&scene.at.pulses_us).take(self.rotor_count) {
            *output = f64::from(*pulse);
        }
        Message::new(ids::ACTUATOR_OUTPUT_STATUS)
            .u64(scene.us(self.skew.actuator_s))
            .u32(u32::try_from(self.rotor_count).unwrap_or(0))
            .f32s(&outputs)
    }

    /// Revolutions per minute of the first four rotors, not known ones as zero.
    fn rpm(scene: &Scene) -> [i32; BATCH] {
        let speeds = scene.at.shown.rotor_speed_rad_s.unwrap_or_default();
        std::array::from_fn(|rotor| whole(speeds[rotor] / rad_s_from_rpm(1.0)))
    }

    pub(super) fn esc_status(&self, scene: &Scene) -> Option<Message> {
        scene.at.shown.rotor_speed_rad_s?;
        let volts = [scene.autopilot.battery.volts(); BATCH];
        let message = Message::new(ids::ESC_STATUS).u64(scene.us(self.skew.rotor_speed_s));
        let message = Self::rpm(scene).iter().fold(message, |message, rpm| message.i32(*rpm));
        Some(message.f32s(&volts).f32s(&[f64::NAN; BATCH]).u8(0))
    }

    pub(super) fn esc_info(&self, scene: &Scene) -> Message {
        let count = u8::try_from(self.rotor_count).unwrap_or(0);
        let message = Message::new(ids::ESC_INFO).u64(scene.us(0.0));
        let message = (0..BATCH).fold(message, |message, _| message.u32(0)).u16(0).u16s(&[0; BATCH]);
        let message = (0..BATCH).fold(message, |message, _| message.i16(i16::MAX));
        // every ESC is online
        message.u8(0).u8(count).u8(DSHOT).u8((1_u8 << count.min(7)) - 1)
    }

    /// Where there is no ESC telemetry ArduPilot's simulator sends zeros.
    pub(super) fn esc_telemetry(&self, scene: &Scene) -> Message {
        let rpm = if self.esc_telemetry { Self::rpm(scene) } else { [0; BATCH] };
        let rpm = rpm.map(|rpm| ushort(f64::from(rpm)));
        let volts_cv = if self.esc_telemetry { ushort(1e2 * scene.autopilot.battery.volts()) } else { 0 };
        Message::new(ids::ESC_TELEMETRY_1_TO_4)
            .u16s(&[volts_cv; BATCH])
            .u16s(&[0; BATCH])
            .u16s(&[0; BATCH])
            .u16s(&rpm)
            .u16s(&[0; BATCH])
            .text(b"", BATCH)
    }
}
