//! Telemetry logs: stamps of eight bytes, each with a MAVLink frame.

use super::names::{Coordinate, is_secret_parameter};
use super::pass::{Kind, Pass};
use super::texts::Part;
use crate::wire::message_id as id;
use crate::wire::{Check, CrcSeeds, Frame, MARKER_V2, Payload, STAMP_BYTES, STATUSTEXT_BYTES, checksum};

/// Messages that hold neither a position on the Earth nor a name of the hardware.
const HARMLESS: &[u32] = &[
    id::HEARTBEAT,
    id::SYS_STATUS,
    id::SYSTEM_TIME,
    id::SCALED_IMU,
    id::RAW_IMU,
    id::RAW_PRESSURE,
    id::SCALED_PRESSURE,
    id::ATTITUDE,
    id::ATTITUDE_QUATERNION,
    id::LOCAL_POSITION_NED,
    id::RC_CHANNELS_RAW,
    id::SERVO_OUTPUT_RAW,
    id::MISSION_CURRENT,
    id::MISSION_ITEM_REACHED,
    id::ATTITUDE_QUATERNION_COV,
    id::NAV_CONTROLLER_OUTPUT,
    id::LOCAL_POSITION_NED_COV,
    id::RC_CHANNELS,
    id::REQUEST_DATA_STREAM,
    id::MANUAL_CONTROL,
    id::RC_CHANNELS_OVERRIDE,
    id::VFR_HUD,
    id::COMMAND_ACK,
    id::MANUAL_SETPOINT,
    id::SET_ATTITUDE_TARGET,
    id::ATTITUDE_TARGET,
    id::SET_POSITION_TARGET_LOCAL_NED,
    id::POSITION_TARGET_LOCAL_NED,
    id::LOCAL_POSITION_NED_SYSTEM_GLOBAL_OFFSET,
    id::VISION_POSITION_ESTIMATE,
    id::VISION_SPEED_ESTIMATE,
    id::VICON_POSITION_ESTIMATE,
    id::HIGHRES_IMU,
    id::OPTICAL_FLOW_RAD,
    id::HIL_SENSOR,
    id::TIMESYNC,
    id::SCALED_IMU2,
    id::POWER_STATUS,
    id::SCALED_IMU3,
    id::DISTANCE_SENSOR,
    id::TERRAIN_DATA,
    id::SCALED_PRESSURE2,
    id::ATT_POS_MOCAP,
    id::SET_ACTUATOR_CONTROL_TARGET,
    id::ACTUATOR_CONTROL_TARGET,
    id::SCALED_PRESSURE3,
    id::BATTERY_STATUS,
    id::MEMINFO,
    id::AHRS,
    id::HWSTATUS,
    id::WIND,
    id::RANGEFINDER,
    id::EKF_STATUS_REPORT,
    id::EFI_STATUS,
    id::RPM,
    id::ESTIMATOR_STATUS,
    id::WIND_COV,
    id::VIBRATION,
    id::MESSAGE_INTERVAL,
    id::EXTENDED_SYS_STATE,
    id::ESC_INFO,
    id::ESC_STATUS,
    id::ODOMETRY,
    id::ACTUATOR_OUTPUT_STATUS,
    id::CURRENT_MODE,
    id::ESC_TELEMETRY_1_TO_4,
    id::ESC_TELEMETRY_5_TO_8,
    id::ESC_TELEMETRY_9_TO_12,
];
/// Messages with a latitude and a longitude in 1e-7 degrees, and where these stand.
const POSITIONS: &[(u32, usize)] = &[
    (id::GPS_RAW_INT, 8),
    (id::GLOBAL_POSITION_INT, 4),
    (id::GPS_GLOBAL_ORIGIN, 0),
    (id::POSITION_TARGET_GLOBAL_INT, 4),
    (id::GPS2_RAW, 8),
    (id::SIMSTATE, 36),
    (id::AHRS2, 16),
    (id::HOME_POSITION, 0),
];
/// The flag that says that a signature is there.
const SIGNED: u8 = 1;

/// Whether a file begins as a telemetry log: a frame behind a stamp, before long.
pub(super) fn is_one(log: &[u8]) -> bool {
    let seeds = CrcSeeds::new();
    (0..log.len().min(4096)).any(|at| whole(log.get(at + STAMP_BYTES..), &seeds).is_some())
}

fn whole<'a>(bytes: Option<&'a [u8]>, seeds: &CrcSeeds) -> Option<Frame<'a>> {
    bytes.and_then(Frame::at_start).filter(|frame| frame.check(seeds) == Check::Right)
}

/// Walks the log; the redacted one comes out. Several frames may share one stamp.
pub(super) fn walk(log: &[u8], pass: &mut Pass) -> Vec<u8> {
    let seeds = CrcSeeds::new();
    let mut out = Vec::with_capacity(log.len());
    let (mut at, mut stamp) = (0, None);
    while at < log.len() {
        let (frame, stamped) = match whole(log.get(at + STAMP_BYTES..), &seeds) {
            Some(frame) => (frame, STAMP_BYTES),
            None => match whole(log.get(at..), &seeds) {
                Some(frame) => (frame, 0),
                None => {
                    at += 1;
                    pass.tally.unread_bytes += 1;
                    continue;
                }
            },
        };
        if stamped > 0 {
            stamp = log.get(at..at + stamped);
        }
        at += stamped + frame.bytes().len();
        match redacted(&frame, pass, &seeds) {
            Some(bytes) => {
                pass.tally.kept += 1;
                out.extend_from_slice(stamp.unwrap_or_default());
                out.extend_from_slice(&bytes);
            }
            None => pass.leave_out(format!("MAVLink message {}", frame.header().message_id)),
        }
    }
    out
}

/// A frame without what is not to be shared, unsigned; `None` where it is left out.
fn redacted(frame: &Frame<'_>, pass: &mut Pass, seeds: &CrcSeeds) -> Option<Vec<u8>> {
    let message = frame.header().message_id;
    let mut payload = frame.payload().0.to_vec();
    let sent = payload.len();
    match message {
        id::PARAM_VALUE => {
            let name = Payload(&payload).text(8, 16);
            if is_secret_parameter(&name) {
                pass.empty(|| name, payload.get_mut(0..4)?);
            }
        }
        // parameters five and six are a place in many commands
        id::COMMAND_LONG => {
            pass.empty(|| "place of COMMAND_LONG".to_owned(), grown(&mut payload, 24).get_mut(16..24)?);
        }
        id::AUTOPILOT_VERSION => {
            pass.empty(|| "AUTOPILOT_VERSION.uid".to_owned(), grown(&mut payload, 78).get_mut(8..16)?);
            pass.empty(|| "AUTOPILOT_VERSION.uid2".to_owned(), payload.get_mut(60..78)?);
        }
        id::STATUSTEXT => {
            let part = part_of(Payload(&payload));
            let end = payload.len().min(1 + STATUSTEXT_BYTES);
            pass.cover(|| "words of STATUSTEXT".to_owned(), payload.get_mut(1..end)?, part);
        }
        _ if HARMLESS.contains(&message) => {}
        _ => {
            let (_, from) = *POSITIONS.iter().find(|(of, _)| *of == message)?;
            grown(&mut payload, from + 8);
            pass.move_in((Coordinate::Latitude, Kind::E7), "lat", payload.get_mut(from..from + 4)?);
            pass.move_in((Coordinate::Longitude, Kind::E7), "lon", payload.get_mut(from + 4..from + 8)?);
        }
    }
    Some(rebuilt(frame.bytes(), payload, sent, seeds.get(message)?))
}

/// A text with a number is one of several that follow each other, and a word may lie in two of them.
fn part_of(payload: Payload<'_>) -> Part {
    let (id, chunk) = (payload.u16(51), payload.u8(53));
    // the text's last letter
    let is_full = payload.u8(STATUSTEXT_BYTES) != 0;
    Part { is_continued: chunk > 0, goes_on: id != 0 && is_full }
}

/// The payload with so many bytes at least: zeros at its end are not sent.
fn grown(payload: &mut Vec<u8>, bytes: usize) -> &mut Vec<u8> {
    if payload.len() < bytes {
        payload.resize(bytes, 0);
    }
    payload
}

fn rebuilt(frame: &[u8], mut payload: Vec<u8>, sent: usize, seed: u8) -> Vec<u8> {
    let is_second = frame.first() == Some(&MARKER_V2);
    let head = if is_second { 10 } else { 6 };
    if is_second {
        while payload.len() > sent.max(1) && payload.last() == Some(&0) {
            payload.pop();
        }
    } else {
        payload.truncate(sent);
    }
    let mut out = frame.get(..head).unwrap_or_default().to_vec();
    if let Some(length) = out.get_mut(1) {
        *length = u8::try_from(payload.len()).unwrap_or(u8::MAX);
    }
    if is_second && let Some(flags) = out.get_mut(2) {
        // the signature no longer holds
        *flags &= !SIGNED;
    }
    out.extend_from_slice(&payload);
    let sum = checksum(out.get(1..).unwrap_or_default(), seed);
    out.extend_from_slice(&sum.to_le_bytes());
    out
}
