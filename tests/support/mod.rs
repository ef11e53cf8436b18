//! What several tests need.

#![allow(dead_code, unused_imports, clippy::unwrap_used)] // no test uses all of it

pub mod dataflash;
pub mod require;
pub mod schema;

use std::path::{Path, PathBuf};

use mavid::log::TlogReader;
use mavid::wire::{Frame, MARKER_V2};
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use mavlink::{MAVLinkV1MessageRaw, MAVLinkV2MessageRaw, MavHeader, Message};
use proptest::test_runner::{Config as ProptestConfig, RngSeed};
pub use require::{Needed, skip};

/// A message id that no dialect has.
pub const UNKNOWN_ID: u32 = 60_001;
/// 2023-11-14 UTC, low two bits zero.
pub const START_US: u64 = 1_700_000_000_000_000;

/// The same cases in every run.
pub fn cases() -> ProptestConfig {
    ProptestConfig { rng_seed: RngSeed::Fixed(2020), failure_persistence: None, ..ProptestConfig::default() }
}

/// The folder of shared recordings; `None`, with a message, where it is not there.
pub fn shared() -> Option<PathBuf> {
    is_there(shared_path())
}

/// A practice case of the shared recordings; `None`, with a message, where it is not there.
pub fn shared_case(name: &str) -> Option<PathBuf> {
    is_there(shared_path().join("cases").join(name))
}

fn shared_path() -> PathBuf {
    std::env::var_os("MAVID_SHARED")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from)
}

fn is_there(folder: PathBuf) -> Option<PathBuf> {
    let found = folder.is_dir();
    if !found {
        skip(Needed::Shared, &format!("no shared recordings at {}", folder.display()));
    }
    found.then_some(folder)
}

pub fn header(system_id: u32, sequence: u8) -> MavHeader {
    MavHeader { system_id, component_id: 1, sequence }
}

/// A MAVLink 2 frame.
pub fn v2(header: MavHeader, message: &MavMessage) -> Vec<u8> {
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message(header, message);
    raw.raw_bytes().to_vec()
}

/// A MAVLink 1 frame.
pub fn v1(header: MavHeader, message: &MavMessage) -> Vec<u8> {
    let mut raw = MAVLinkV1MessageRaw::new();
    raw.serialize_message(header, message);
    raw.raw_bytes().to_vec()
}

/// A MAVLink 2 frame made by hand, with its checksum.
pub fn by_hand(id: u32, incompat_flags: u8, sequence: u8, payload: &[u8], extra_crc: u8) -> Vec<u8> {
    let [i0, i1, i2, _] = id.to_le_bytes();
    let length = u8::try_from(payload.len()).unwrap();
    let mut bytes = vec![MARKER_V2, length, incompat_flags, 0, sequence, 1, 1, i0, i1, i2];
    bytes.extend_from_slice(payload);
    let checksum = mavlink::calculate_crc(&bytes[1..], extra_crc);
    bytes.extend_from_slice(&checksum.to_le_bytes());
    bytes
}

/// A frame whose message nobody knows.
pub fn unknown(sequence: u8, payload: &[u8]) -> Vec<u8> {
    by_hand(UNKNOWN_ID, 0, sequence, payload, 77)
}

/// The same message, signed (with a signature that nobody could check).
pub fn signed(sequence: u8, message: &MavMessage) -> Vec<u8> {
    let plain = v2(header(1, sequence), message);
    let payload = &plain[10..plain.len() - 2];
    let mut bytes =
        by_hand(message.message_id(), 1, sequence, payload, MavMessage::extra_crc(message.message_id()));
    bytes.extend_from_slice(&[MARKER_V2; 13]);
    bytes
}

pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        custom_mode: 6 << 16,
        mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
        autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_PX4,
        base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED,
        system_status: dialect::MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

pub fn ground_heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        mavtype: dialect::MavType::MAV_TYPE_GCS,
        autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_INVALID,
        mavlink_version: 3,
        ..Default::default()
    })
}

/// Level and facing north at a time since boot, rates zero but yaw's, which tells frames apart.
pub fn attitude(time_boot_ms: u32) -> MavMessage {
    MavMessage::ATTITUDE(dialect::ATTITUDE_DATA { time_boot_ms, yawspeed: 1.0, ..Default::default() })
}

/// `count` attitude frames in sequence.
pub fn attitudes(count: u8) -> Vec<Vec<u8>> {
    (0..count).map(|index| v2(header(1, index), &attitude(1000 + u32::from(index) * 10))).collect()
}

/// One record of a telemetry log.
pub fn record(stamp_us: u64, frame: &[u8]) -> Vec<u8> {
    [&stamp_us.to_be_bytes(), frame].concat()
}

/// A telemetry log with a stamp each 10 ms.
pub fn tlog(frames: &[Vec<u8>]) -> Vec<u8> {
    (0_u64..).zip(frames).flat_map(|(index, frame)| record(START_US + index * 10_000, frame)).collect()
}

/// All records of a log, and its report.
pub fn read(bytes: &[u8]) -> (Vec<(u64, Vec<u8>)>, mavid::log::TlogReport) {
    let mut reader = TlogReader::new(bytes);
    let mut records = Vec::new();
    while let Some(record) = reader.next_record().unwrap() {
        records.push((record.stamp_us, record.frame.bytes().to_vec()));
    }
    (records, reader.into_report())
}

/// The frames alone.
pub fn frames(records: &[(u64, Vec<u8>)]) -> Vec<Vec<u8>> {
    records.iter().map(|(_, frame)| frame.clone()).collect()
}

pub fn frame(bytes: &[u8]) -> Frame<'_> {
    Frame::at_start(bytes).unwrap()
}

/// All files under a folder with this extension, sorted.
pub fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
