//! A telemetry log of any length: ten-minute flights of a harmonic motion with half a minute on the ground between.

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use mavid::wire::MessageWriter;
use mavlink::dialects::ardupilotmega as dialect;

/// s of the sample period: 125 Hz, position at half of it.
pub const STEP_S: f64 = 0.008;
/// s from one take-off to the next.
pub const CYCLE_S: f64 = 630.0;
/// s of each cycle on the ground, at its beginning.
pub const GROUND_S: f64 = 30.0;

/// N that four rotors of configs/x500.toml give more for a command of one more, at hover.
const THRUST_SLOPE_N: f64 = 4.0 * 2.0 * 8.54858 * 0.77;

/// Writes a log of at least so many bytes; gives its length in seconds.
pub fn write_flight_log(path: &Path, bytes: u64) -> Result<f64, Box<dyn Error>> {
    let mut log = MessageWriter::new(std::io::BufWriter::new(std::fs::File::create(path)?));
    let (mut written, mut step) = (0_u64, 0_u32);
    while written < bytes {
        for message in messages_of_step(step) {
            written += log.write(1_700_000_000_000_000 + u64::from(step) * 8000, &message)? as u64;
        }
        step += 1;
    }
    log.finish()?;
    Ok(f64::from(step) * STEP_S)
}

#[allow(clippy::cast_possible_truncation, reason = "MAVLink's values are single-precision")]
fn single(value: f64) -> f32 {
    value as f32
}

fn messages_of_step(step: u32) -> Vec<dialect::MavMessage> {
    use dialect::MavMessage as M;
    let (time_boot_ms, time_usec) = (41_000 + step * 8, u64::from(41_000 + step * 8) * 1000);
    let t = f64::from(step) * STEP_S;
    let flies = t % CYCLE_S > GROUND_S;
    let size = if flies { 1.0 } else { 0.0 };
    // a hash in place of noise, the same in every run
    let noise = |salt: u32| {
        let mixed =
            (step ^ salt.rotate_left(16)).wrapping_mul(0x9E37_79B9).rotate_left(13).wrapping_mul(0x85EB_CA6B);
        f64::from(mixed >> 8) / f64::from(1_u32 << 24) - 0.5
    };
    let wave = |period_s: f64, phase: f64| (TAU * t / period_s + phase).sin();
    let roll = 0.15 * size * wave(2.0, 0.0);
    // rate and acceleration, forward-right-down, with the amplitudes of configs/x500.toml's torques
    let motion = [(0.15 * TAU / 2.0, 2.0, FRAC_PI_2), (0.3, 3.1, 0.4), (0.2, 5.0, 1.0)];
    let rate = motion.map(|(amplitude, period_s, phase)| size * amplitude * wave(period_s, phase));
    let effort = motion.map(|(amplitude, period_s, phase)| {
        amplitude * TAU / period_s * wave(period_s, phase + FRAC_PI_2) / THRUST_SLOPE_N
    });
    let [x, y, z] = [effort[0] * 0.0238 / 0.174, effort[1] * 0.0238 / 0.174, effort[2] * 0.0439 / 0.016];
    let command = |command: f64, salt| single(size * (command + 0.005 * noise(salt)));
    let mut messages = vec![
        M::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
            time_boot_ms,
            q1: single((roll / 2.0).cos()),
            q2: single((roll / 2.0).sin()),
            rollspeed: single(rate[0] + 0.01 * noise(1)),
            pitchspeed: single(rate[1] + 0.01 * noise(2)),
            yawspeed: single(rate[2] + 0.01 * noise(3)),
            ..Default::default()
        }),
        M::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
            time_usec,
            xacc: single(0.1 * noise(4)),
            yacc: single(0.1 * noise(5)),
            zacc: single(-9.81 + 0.1 * noise(6)),
            xgyro: single(rate[0] + 0.01 * noise(7)),
            ygyro: single(rate[1] + 0.01 * noise(8)),
            zgyro: single(rate[2] + 0.01 * noise(9)),
            fields_updated: dialect::HighresImuUpdatedFlags::all(),
            ..Default::default()
        }),
        M::ACTUATOR_OUTPUT_STATUS(dialect::ACTUATOR_OUTPUT_STATUS_DATA {
            time_usec,
            active: 4,
            actuator: std::array::from_fn(|channel| match channel {
                0 => command(0.77 - x + y + z, 10),
                1 => command(0.77 + x - y + z, 11),
                2 => command(0.77 + x + y - z, 12),
                3 => command(0.77 - x - y - z, 13),
                _ => 0.0,
            }),
        }),
    ];
    if step.is_multiple_of(2) {
        messages.push(M::LOCAL_POSITION_NED(dialect::LOCAL_POSITION_NED_DATA {
            time_boot_ms,
            x: single(size * wave(10.0, 0.0)),
            z: single(-size * 2.0),
            vx: single(size * TAU / 10.0 * wave(10.0, FRAC_PI_2)),
            ..Default::default()
        }));
    }
    if step.is_multiple_of(125) {
        messages.push(M::HEARTBEAT(dialect::HEARTBEAT_DATA {
            custom_mode: 6 << 16,
            mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
            autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_PX4,
            base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED,
            system_status: dialect::MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
        }));
        messages.push(M::EXTENDED_SYS_STATE(dialect::EXTENDED_SYS_STATE_DATA {
            landed_state: if flies {
                dialect::MavLandedState::MAV_LANDED_STATE_IN_AIR
            } else {
                dialect::MavLandedState::MAV_LANDED_STATE_ON_GROUND
            },
            ..Default::default()
        }));
    }
    messages
}
