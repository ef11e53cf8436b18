//! How fast logs are read, beside pymavlink and pyulog on the same file.
//!
//! `cargo bench --bench reading [-- LOG]`: without a path a telemetry log is generated (seeded, the messages of
//! an identification flight). Of a log that the vehicle wrote itself (`.ulg`, `.bin`) megabytes a second are measured: all of
//! it into a recording, and all topics by pyulog, or all messages by pymavlink. `MAVID_PYTHON` names a Python that has pymavlink
//! and pyulog (default `python3`).

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use mavid::log::{self, LogError, OpenOptions, ReadReport, TlogReader};
use mavid::wire::{MessageWriter, SystemId};
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage as M};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const STEPS: u32 = 12_000;
const REPEATS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    let path = match std::env::args().skip(1).find(|argument| !argument.starts_with("--")) {
        Some(path) => PathBuf::from(path),
        None => generated_log()?,
    };
    writeln!(out, "{} ({} bytes)", path.display(), std::fs::metadata(&path)?.len())?;
    match log::format_of(&path)?.name {
        name if name.ends_with("(.ulg)") => {
            return onboard(&mut out, &path, "pyulog", "read_ulog_with_pyulog.py");
        }
        name if name.ends_with("(.bin)") => {
            return onboard(&mut out, &path, "pymavlink", "read_dataflash_with_pymavlink.py");
        }
        _ => {}
    }
    let options = OpenOptions { system: Some(SystemId(1)), ..OpenOptions::default() };
    let walk = fastest(|| {
        let mut reader = TlogReader::new(std::fs::File::open(&path)?);
        while reader.next_record()?.is_some() {}
        Ok(reader.report().frames)
    })?;
    let mut samples = 0_u64;
    let frames = |report: &ReadReport| report.telemetry().map_or(0, |telemetry| telemetry.frames);
    let stream = fastest(|| Ok(frames(&log::stream(&path, &options, &mut |_, _| samples += 1)?)))?;
    let recording = fastest(|| Ok(frames(&log::open(&path, &options)?.report)))?;
    writeln!(out, "{:<34} {walk:>12.0} frames/s", "frames and checksums")?;
    writeln!(out, "{:<34} {stream:>12.0} frames/s", "samples, streamed")?;
    writeln!(out, "{:<34} {recording:>12.0} frames/s", "whole recording in memory")?;
    match pymavlink(&path) {
        Ok(theirs) => {
            for (name, rate) in theirs {
                let (whole, streamed) = (recording / rate, stream / rate);
                writeln!(
                    out,
                    "{:<34} {rate:>12.0} frames/s: recording {whole:.0} times, streamed {streamed:.0} times",
                    format!("pymavlink {name}")
                )?;
            }
        }
        Err(error) => writeln!(out, "pymavlink not measured: {error}")?,
    }
    let (log, seconds) = identify_whole_process()?;
    writeln!(
        out,
        "mavid identify {log}, whole process on one core: {:.0} ms (median of {REPEATS})",
        1e3 * seconds
    )?;
    Ok(())
}

/// Megabytes a second of a log that the vehicle wrote, medians of a few runs, beside another reader in the same run.
fn onboard(out: &mut impl Write, path: &Path, other: &str, script: &str) -> Result<(), Box<dyn Error>> {
    let megabytes = std::fs::metadata(path)?.len() as f64 * 1e-6;
    let options = OpenOptions::default();
    let mut samples = 0_u64;
    let streamed =
        megabytes / median_s(|| log::stream(path, &options, &mut |_, _| samples += 1).map(|_| ()))?;
    let recorded = megabytes / median_s(|| log::open(path, &options).map(|_| ()))?;
    writeln!(out, "{:<34} {streamed:>12.0} MB/s", "samples, streamed")?;
    writeln!(out, "{:<34} {recorded:>12.0} MB/s", "whole recording in memory")?;
    let python = std::env::var("MAVID_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(script);
    let output = Command::new(python).arg(script).arg(path).output()?;
    match String::from_utf8(output.stdout)?.trim().parse::<f64>() {
        Ok(rate) => {
            let times = recorded / rate;
            writeln!(out, "{other:<34} {rate:>12.1} MB/s, fastest of 3: recording {times:.0} times")?;
        }
        Err(_) => writeln!(out, "{other} not measured: {}", String::from_utf8_lossy(&output.stderr).trim())?,
    }
    Ok(())
}

/// Seconds of the median of a few runs.
fn median_s(mut run: impl FnMut() -> Result<(), LogError>) -> Result<f64, LogError> {
    let mut times_s = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        run()?;
        times_s.push(start.elapsed().as_secs_f64());
    }
    times_s.sort_by(f64::total_cmp);
    Ok(times_s[REPEATS / 2])
}

/// Seconds of `mavid identify` from start to exit with one worker: on the 54 s flight of the practice cases
/// where they are, else on the 25 s of it that ship with the project.
fn identify_whole_process() -> Result<(String, f64), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shared = root.join("../shared/cases/p01-nothing-missing");
    let (log, vehicle) = if shared.is_dir() {
        (shared.join("identify.tlog"), shared.join("vehicle.toml"))
    } else {
        (root.join("fixtures/p01_identify_0_25s.tlog"), root.join("fixtures/p01_vehicle.toml"))
    };
    let mut times_s = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
            .args(["identify", "--json", "--vehicle"])
            .args([&vehicle, &log])
            .env("RAYON_NUM_THREADS", "1")
            .output()?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned().into());
        }
        times_s.push(start.elapsed().as_secs_f64());
    }
    times_s.sort_by(f64::total_cmp);
    Ok((log.file_name().unwrap_or_default().display().to_string(), times_s[REPEATS / 2]))
}

/// Frames a second of the fastest of a few runs.
fn fastest(mut run: impl FnMut() -> Result<u64, Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut best: f64 = 0.0;
    for _ in 0..REPEATS {
        let start = Instant::now();
        let frames = run()?;
        best = best.max(frames as f64 / start.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// Each way of pymavlink's with its frames a second.
fn pymavlink(log: &Path) -> Result<Vec<(String, f64)>, Box<dyn Error>> {
    let python = std::env::var("MAVID_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/read_with_pymavlink.py");
    let output = Command::new(python).arg(script).arg("--time").arg(log).output()?;
    let text = String::from_utf8(output.stdout)?;
    let rates: Vec<_> = text
        .lines()
        .filter_map(|line| line.split_once(' '))
        .filter_map(|(name, rate)| Some((name.to_owned(), rate.parse().ok()?)))
        .collect();
    if rates.is_empty() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned().into());
    }
    Ok(rates)
}

/// A log of the messages of an identification flight, 125 Hz steps.
fn generated_log() -> Result<PathBuf, Box<dyn Error>> {
    let path = std::env::temp_dir().join("mavid-reading.tlog");
    let mut log = MessageWriter::new(std::io::BufWriter::new(std::fs::File::create(&path)?));
    let mut random = Pcg64Mcg::seed_from_u64(7);
    for step in 0..STEPS {
        for message in messages_of_step(step, &mut random) {
            log.write(1_700_000_000_000_000 + u64::from(step) * 8000, &message)?;
        }
    }
    log.finish()?;
    Ok(path)
}

/// Between -0.5 and 0.5.
fn draw(random: &mut Pcg64Mcg) -> f32 {
    random.random::<f32>() - 0.5
}

/// ms and us of the vehicle's clock.
fn stamps(step: u32) -> (u32, u64) {
    (41_000 + step * 8, u64::from(41_000 + step * 8) * 1000)
}

fn messages_of_step(step: u32, random: &mut Pcg64Mcg) -> Vec<M> {
    let mut messages = Vec::from(motion(step, random));
    messages.extend(outputs(step, random));
    if step.is_multiple_of(2) {
        messages.extend(targets(step, random));
    }
    if step.is_multiple_of(125) {
        messages.extend(status());
    }
    messages
}

fn motion(step: u32, random: &mut Pcg64Mcg) -> [M; 4] {
    let mut value = || draw(random);
    let (time_boot_ms, time_usec) = stamps(step);
    [
        M::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
            time_boot_ms,
            q1: 1.0,
            q2: 0.05 * value(),
            q3: 0.05 * value(),
            q4: 0.05 * value(),
            rollspeed: value(),
            pitchspeed: value(),
            yawspeed: value(),
            ..Default::default()
        }),
        M::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
            time_usec,
            xacc: value(),
            yacc: value(),
            zacc: value() - 9.81,
            xgyro: value(),
            ygyro: value(),
            zgyro: value(),
            xmag: value(),
            ymag: value(),
            zmag: value(),
            abs_pressure: 1013.0 + value(),
            temperature: 20.0 + value(),
            fields_updated: dialect::HighresImuUpdatedFlags::all(),
            ..Default::default()
        }),
        M::ATTITUDE(dialect::ATTITUDE_DATA {
            time_boot_ms,
            roll: value(),
            pitch: value(),
            yaw: value(),
            rollspeed: value(),
            pitchspeed: value(),
            yawspeed: value(),
        }),
        M::LOCAL_POSITION_NED(dialect::LOCAL_POSITION_NED_DATA {
            time_boot_ms,
            x: value(),
            y: value(),
            z: value(),
            vx: value(),
            vy: value(),
            vz: value(),
        }),
    ]
}

fn outputs(step: u32, random: &mut Pcg64Mcg) -> [M; 2] {
    let (time_boot_ms, time_usec) = stamps(step);
    [
        M::SERVO_OUTPUT_RAW(dialect::SERVO_OUTPUT_RAW_DATA {
            time_usec: time_boot_ms * 1000,
            servo1_raw: 1500,
            servo2_raw: 1510,
            servo3_raw: 1490,
            servo4_raw: 1505,
            ..Default::default()
        }),
        M::ACTUATOR_OUTPUT_STATUS(dialect::ACTUATOR_OUTPUT_STATUS_DATA {
            time_usec,
            active: 4,
            actuator: std::array::from_fn(|channel| if channel < 4 { 0.5 + 0.1 * draw(random) } else { 0.0 }),
        }),
    ]
}

fn targets(step: u32, random: &mut Pcg64Mcg) -> [M; 3] {
    let mut value = || draw(random);
    let (time_boot_ms, time_usec) = stamps(step);
    [
        M::POSITION_TARGET_LOCAL_NED(dialect::POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms,
            x: value(),
            y: value(),
            z: value(),
            vx: value(),
            vy: value(),
            vz: value(),
            yaw: value(),
            type_mask: dialect::PositionTargetTypemask::empty(),
            coordinate_frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
            ..Default::default()
        }),
        M::ATTITUDE_TARGET(dialect::ATTITUDE_TARGET_DATA {
            time_boot_ms,
            q: [1.0, 0.05 * value(), 0.05 * value(), 0.05 * value()],
            thrust: 0.4,
            type_mask: dialect::AttitudeTargetTypemask::empty(),
            ..Default::default()
        }),
        M::ESC_STATUS(dialect::ESC_STATUS_DATA {
            time_usec,
            rpm: [7000, 7100, 6900, 7050],
            voltage: [16.4; 4],
            ..Default::default()
        }),
    ]
}

fn status() -> [M; 2] {
    let mut voltages = [u16::MAX; 10];
    voltages[..4].fill(4100);
    [
        M::HEARTBEAT(dialect::HEARTBEAT_DATA {
            custom_mode: 6 << 16,
            mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
            autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_PX4,
            base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED,
            system_status: dialect::MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
        }),
        M::BATTERY_STATUS(dialect::BATTERY_STATUS_DATA {
            voltages,
            current_battery: 1200,
            ..Default::default()
        }),
    ]
}
