//! Actuator outputs and rotor speeds.

use super::samples::Samples;
use super::source::Source;
use crate::recording::Quantity;
use crate::units::rad_s_from_rpm;
use crate::wire::frame::Payload;

/// Eight channels of a port in microseconds (or whatever the output protocol counts), sixteen where the
/// sender knows the extension. 65535 is no output.
pub(super) fn servo_output_raw(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let channels: [f64; 16] = std::array::from_fn(|channel| {
        let offset = if channel < 8 { 4 + 2 * channel } else { 21 + 2 * (channel - 8) };
        match payload.u16(offset) {
            u16::MAX => f64::NAN,
            output => output.into(),
        }
    });
    samples.give(Quantity::ActuatorCommand, payload.u8(20), used(&channels));
}

/// Up to 32 outputs, 0..1 or -1..1 or microseconds. `active` is not looked at: MAVLink makes it a mask of
/// channels, PX4 sends their number.
pub(super) fn actuator_output_status(payload: Payload<'_>, samples: &mut Samples<'_>) {
    samples.give(Quantity::ActuatorCommand, 0, used(&payload.f32s::<32>(12)));
}

/// Four speeds from ESC `index` on, which is the instance.
pub(super) fn esc_status(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let speeds: [f64; 4] = std::array::from_fn(|esc| rad_s_from_rpm(payload.i32(8 + 4 * esc).into()));
    samples.give(Quantity::RotorSpeed, payload.u8(56), &speeds);
}

/// Four speeds; the instance is the first ESC's number from zero.
pub(super) fn esc_telemetry(payload: Payload<'_>, samples: &mut Samples<'_>) {
    let first = match samples.source {
        Source::EscTelemetry5To8 => 4,
        Source::EscTelemetry9To12 => 8,
        _ => 0,
    };
    let speeds: [f64; 4] = std::array::from_fn(|esc| rad_s_from_rpm(payload.u16(24 + 2 * esc).into()));
    samples.give(Quantity::RotorSpeed, first, &speeds);
}

/// Channels up to the last one that puts out something, at least one.
fn used(channels: &[f64]) -> &[f64] {
    let last = channels.iter().rposition(|output| *output != 0.0).unwrap_or(0);
    &channels[..=last]
}
