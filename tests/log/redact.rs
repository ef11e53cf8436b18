//! `mavid redact`: a log to share has the flight and its parameters, and neither places nor names of the hardware.

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::log::{Input, OpenOptions, open};
use mavid::recording::Recording;
use mavid::redact::{RedactError, redact};
use mavid::wire::{MARKER_V2, checksum};

/// Latitude and longitude of the test, 1e-7 degrees: 59.9 N 10.75 E.
const LATITUDE: i32 = 599_000_000;
const LONGITUDE: i32 = 107_500_000;
/// Declination of the magnetic field there, which tells the region.
const DECLINATION_DEG: f32 = 4.6875;

fn read(bytes: &[u8]) -> Recording {
    open(Input::Bytes { name: "redacted", bytes }, &OpenOptions::default()).unwrap().recording
}

fn holds(log: &[u8], needle: &[u8]) -> bool {
    log.windows(needle.len()).any(|window| window == needle)
}

/// A frame of MAVLink 2 behind its stamp.
fn frame(at_us: u64, id: u32, seed: u8, payload: &[u8], is_signed: bool) -> Vec<u8> {
    let [a, b, c, _] = id.to_le_bytes();
    let mut bytes =
        vec![MARKER_V2, u8::try_from(payload.len()).unwrap(), u8::from(is_signed), 0, 7, 1, 1, a, b, c];
    bytes.extend_from_slice(payload);
    let sum = checksum(&bytes[1..], seed);
    bytes.extend_from_slice(&sum.to_le_bytes());
    if is_signed {
        bytes.extend_from_slice(b"\x05SIGNATURE123");
    }
    [at_us.to_be_bytes().to_vec(), bytes].concat()
}

/// Places, a serial number, a key and a device's identifier among harmless messages.
fn telltale() -> Vec<u8> {
    let at = |index: u64| 1_700_000_000_000_000 + 1000 * index;
    let mut heartbeat = vec![0; 9];
    heartbeat[4..].copy_from_slice(&[2, 12, 81, 3, 3]);
    let mut place = vec![0; 28];
    place[4..8].copy_from_slice(&LATITUDE.to_le_bytes());
    place[8..12].copy_from_slice(&LONGITUDE.to_le_bytes());
    let mut north = place.clone();
    // 100 m further north, 100 m further east
    north[4..8].copy_from_slice(&(LATITUDE + 8993).to_le_bytes());
    north[8..12].copy_from_slice(&(LONGITUDE + 17_932).to_le_bytes());
    let mut version = vec![0; 78];
    version[8..16].copy_from_slice(b"SERIAL_1");
    version[60..78].copy_from_slice(b"SERIAL_OF_HARDWARE");
    let mut parameter = vec![0; 25];
    parameter[..4].copy_from_slice(&1_234_567.0_f32.to_le_bytes());
    parameter[8..19].copy_from_slice(b"CAL_ACC0_ID");
    let mut gain = parameter.clone();
    gain[8..24].copy_from_slice(b"MPC_THR_HOVER\0\0\0");
    let mut declination = parameter.clone();
    declination[..4].copy_from_slice(&DECLINATION_DEG.to_le_bytes());
    declination[8..21].copy_from_slice(b"EKF2_MAG_DECL");
    let mut key = vec![0; 42];
    key[8..40].copy_from_slice(b"0123456789abcdefSECRETKEYSECRETK");
    let mut text = vec![0; 51];
    text[1..43].copy_from_slice(b"Cube 00340025 3433510A 3030, pass: hunter2");
    [
        frame(at(0), 0, 50, &heartbeat, true),
        frame(at(1), 33, 104, &place, false),
        frame(at(2), 33, 104, &north, false),
        frame(at(3), 148, 178, &version, false),
        frame(at(4), 22, 220, &parameter, false),
        frame(at(5), 22, 220, &gain, false),
        frame(at(6), 22, 220, &declination, false),
        frame(at(7), 256, 71, &key, false),
        frame(at(8), 253, 83, &text, false),
    ]
    .concat()
}

#[test]
fn places_serial_numbers_and_keys_are_out_of_a_telemetry_log() {
    let log = telltale();
    let redacted = redact(&log).unwrap();
    let tally = redacted.tally;
    assert_eq!((tally.kept, tally.moved, tally.emptied, tally.left_out), (8, 4, 5, 1), "{tally:?}");
    // each by its name: together they are what was counted
    let names: Vec<(&str, u64)> =
        redacted.emptied.iter().map(|(name, count)| (name.as_str(), *count)).collect();
    assert_eq!(
        names,
        [
            ("AUTOPILOT_VERSION.uid", 1),
            ("AUTOPILOT_VERSION.uid2", 1),
            ("CAL_ACC0_ID", 1),
            ("EKF2_MAG_DECL", 1),
            ("words of STATUSTEXT", 1)
        ]
    );
    let left_out: Vec<&str> = redacted.left_out.keys().map(String::as_str).collect();
    assert_eq!(left_out, ["MAVLink message 256"]);
    for told in [
        &b"SERIAL"[..],
        b"SECRET",
        b"SIGNATURE",
        b"3433510A",
        b"hunter2",
        &LATITUDE.to_le_bytes(),
        &LONGITUDE.to_le_bytes(),
        &DECLINATION_DEG.to_le_bytes(),
    ] {
        assert!(holds(&log, told) && !holds(&redacted.bytes, told), "{told:?}");
    }
    assert!(
        holds(&redacted.bytes, b"MPC_THR_HOVER") && holds(&redacted.bytes, &1_234_567.0_f32.to_le_bytes())
    );
    // in metres the flight is the same: 1e-7 degrees are 11.1 mm
    let places: Vec<(i32, i32)> = redacted
        .bytes
        .windows(12)
        .filter(|window| window[0] == MARKER_V2 && window[7] == 33)
        .map(|window| window.as_ptr() as usize - redacted.bytes.as_ptr() as usize)
        .map(|at| {
            let value = |from: usize| {
                i32::from_le_bytes(redacted.bytes[at + from..at + from + 4].try_into().unwrap())
            };
            (value(14), value(18))
        })
        .collect();
    let [(first_north, first_east), (north, east)] = places[..] else { panic!("{places:?}") };
    assert!((north - first_north - 8993).abs() <= 1, "{places:?}");
    assert!((east - first_east - 8993).abs() <= 2, "{places:?}");
    // once more changes nothing but the place, which stays beside the point without one
    assert_eq!(redact(&redacted.bytes).unwrap().tally.emptied, 0);
}

#[test]
fn the_flight_stays_as_it_was() {
    for name in ["px4_flight.ulg", "px4_baseline_40_46s.tlog", "ap_baseline_70_79s.tlog"] {
        let log = std::fs::read(Path::new("fixtures").join(name)).unwrap();
        let redacted = redact(&log).unwrap();
        let (before, after) = (read(&log), read(&redacted.bytes));
        assert!(before.streams.len() > 5, "{name}");
        assert_eq!(
            before.streams.keys().collect::<Vec<_>>(),
            after.streams.keys().collect::<Vec<_>>(),
            "{name}"
        );
        for (key, stream) in &before.streams {
            let other = &after.streams[key];
            assert_eq!(stream.time_s, other.time_s, "{name}: {key:?}");
            let apart = stream.values.iter().zip(&other.values).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 0.02, "{name}: {key:?}");
        }
    }
}

#[test]
fn what_is_no_log_and_what_is_cut_off_is_told_and_never_fails() {
    assert!(matches!(redact(b"nothing of a flight"), Err(RedactError::Unknown(_))));
    assert!(matches!(redact(b""), Err(RedactError::Empty)));
    let log = std::fs::read("fixtures/px4_flight.ulg").unwrap();
    for end in (0..log.len()).step_by(9973) {
        let _ = redact(&log[..end]);
    }
    let log = telltale();
    for end in 0..log.len() {
        let _ = redact(&log[..end]);
    }
}

#[test]
fn the_command_writes_the_log_and_says_what_it_did() {
    let folder = tempfile::tempdir().unwrap();
    let (log, out): (PathBuf, PathBuf) = (folder.path().join("a.tlog"), folder.path().join("b.tlog"));
    std::fs::write(&log, telltale()).unwrap();
    let run = |out: &Path| {
        Command::new(env!("CARGO_BIN_EXE_mavid"))
            .arg("redact")
            .arg(&log)
            .arg("--out")
            .arg(out)
            .output()
            .unwrap()
    };
    let done = run(&out);
    let said = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success() && said.contains("8 messages") && said.contains("read back"), "{said}");
    assert_eq!(std::fs::read(&out).unwrap(), redact(&telltale()).unwrap().bytes);
    // what is there stays, unless it may be replaced
    std::fs::write(&out, "mine").unwrap();
    let refused = run(&out);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(2) && said.contains("which exists; --force replaces it"), "{said}");
    assert_eq!(std::fs::read(&out).unwrap(), b"mine");
    let of_folder = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .arg("redact")
        .arg(folder.path())
        .arg("--out")
        .arg(folder.path().join("c.tlog"))
        .output()
        .unwrap();
    let said = String::from_utf8(of_folder.stderr).unwrap();
    assert!(of_folder.status.code() == Some(2) && said.contains("recording, got a folder"), "{said}");
    // the log itself stays
    assert_eq!(run(&log).status.code(), Some(2));
    assert_eq!(std::fs::read(&log).unwrap(), telltale());
}
