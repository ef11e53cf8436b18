//! Outputs and rotor speeds.

use mavlink::dialects::ardupilotmega::{
    ACTUATOR_OUTPUT_STATUS_DATA, ESC_INFO_DATA, ESC_STATUS_DATA, ESC_TELEMETRY_1_TO_4_DATA,
    EscConnectionType, SERVO_OUTPUT_RAW_DATA,
};

use super::super::message::Message;
use super::field::ushort;
use super::scene::Scene;
use super::source::Telemetry;
use crate::physics::MAX_ROTORS;
use crate::units::{narrow, rad_s_from_rpm, whole};

/// Rotors of one message of ESC telemetry.
const BATCH: usize = 4;

impl Telemetry {
    /// The time wraps after 71.6 minutes: it has 32 bits.
    pub(super) fn servo_output_raw(&self, scene: &Scene) -> Message {
        let mut outputs = [0; 8];
        outputs[..MAX_ROTORS].copy_from_slice(&scene.at.pulses_us);
        outputs[self.rotor_count.min(8)..].fill(0);
        let [servo1_raw, servo2_raw, servo3_raw, servo4_raw, servo5_raw, servo6_raw, servo7_raw, servo8_raw] =
            outputs;
        Message::from(SERVO_OUTPUT_RAW_DATA {
            time_usec: u32::try_from(scene.us(self.skew.actuator_s) & u64::from(u32::MAX)).unwrap_or(0),
            servo1_raw,
            servo2_raw,
            servo3_raw,
            servo4_raw,
            servo5_raw,
            servo6_raw,
            servo7_raw,
            servo8_raw,
            ..SERVO_OUTPUT_RAW_DATA::DEFAULT
        })
    }

    /// PX4 sends the same pulses here, and in `active` their number.
    pub(super) fn actuator_output_status(&self, scene: &Scene) -> Message {
        let mut actuator = [0.0; 32];
        for (output, pulse) in actuator.iter_mut().zip(&scene.at.pulses_us).take(self.rotor_count) {
            *output = f32::from(*pulse);
        }
        Message::from(ACTUATOR_OUTPUT_STATUS_DATA {
            time_usec: scene.us(self.skew.actuator_s),
            active: u32::try_from(self.rotor_count).unwrap_or(0),
            actuator,
        })
    }

    /// Revolutions per minute of the first four rotors, not known ones as zero.
    fn rpm(scene: &Scene) -> [i32; BATCH] {
        let speeds = scene.at.shown.rotor_speed_rad_s.unwrap_or_default();
        std::array::from_fn(|rotor| whole(speeds[rotor] / rad_s_from_rpm(1.0)))
    }

    pub(super) fn esc_status(&self, scene: &Scene) -> Option<Message> {
        scene.at.shown.rotor_speed_rad_s?;
        Some(Message::from(ESC_STATUS_DATA {
            time_usec: scene.us(self.skew.rotor_speed_s),
            rpm: Self::rpm(scene),
            voltage: [narrow(scene.autopilot.battery.volts()); BATCH],
            current: [f32::NAN; BATCH],
            index: 0,
        }))
    }

    pub(super) fn esc_info(&self, scene: &Scene) -> Message {
        let count = u8::try_from(self.rotor_count).unwrap_or(0);
        Message::from(ESC_INFO_DATA {
            time_usec: scene.us(0.0),
            temperature: [i16::MAX; BATCH],
            count,
            connection_type: EscConnectionType::ESC_CONNECTION_TYPE_DSHOT,
            // every ESC is online
            info: (1_u8 << count.min(7)) - 1,
            ..ESC_INFO_DATA::DEFAULT
        })
    }

    /// Where there is no ESC telemetry ArduPilot's simulator sends zeros.
    pub(super) fn esc_telemetry(&self, scene: &Scene) -> Message {
        if !self.esc_telemetry {
            return Message::from(ESC_TELEMETRY_1_TO_4_DATA::DEFAULT);
        }
        Message::from(ESC_TELEMETRY_1_TO_4_DATA {
            // hundredths of a volt
            voltage: [ushort(1e2 * scene.autopilot.battery.volts()); BATCH],
            rpm: Self::rpm(scene).map(|rpm| ushort(f64::from(rpm))),
            ..ESC_TELEMETRY_1_TO_4_DATA::DEFAULT
        })
    }
}
