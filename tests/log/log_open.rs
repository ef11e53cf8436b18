//! The door for logs: what a file is, its content tells, and what is not in the recording is counted.

use crate::support;

use std::collections::BTreeSet;
use std::path::Path;

use mavid::autopilot::Autopilot;
use mavid::log::{
    self, Details, FORMATS, Flights, Hold, Input, LogError, Loss, OpenOptions, Opened, Position, format_of,
    open_flights,
};
use mavid::recording::Event;
use mavid::wire::SystemId;
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use support::{header, heartbeat, tlog, v2};

const TABLE: &str = "time_s,battery_V\n0,12\n1,11\n";

fn open(bytes: &[u8]) -> Result<Opened, LogError> {
    log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default())
}

fn flight() -> Vec<u8> {
    let mut frames = vec![v2(header(1, 0), &heartbeat())];
    frames.extend(support::attitudes(60));
    tlog(&frames)
}

#[test]
fn content_tells_the_format_and_names_do_not() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (bytes, format) in [
        (flight(), "telemetry log (.tlog)"),
        (
            std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg")).unwrap(),
            "PX4 log (.ulg)",
        ),
        (TABLE.into(), "table of comma-separated values (.csv)"),
    ] {
        for name in ["as.tlog", "as.csv", "as.ulg", "as_nothing"] {
            let path = folder.join(format!("door-{name}"));
            std::fs::write(&path, &bytes).unwrap();
            let opened = log::open(&path, &OpenOptions::default()).unwrap();
            assert_eq!((opened.report.format, format_of(&path).unwrap().name), (format, format), "{name}");
            assert_eq!(opened, open(&bytes).unwrap(), "{name}");
        }
    }
    let names: BTreeSet<&str> = FORMATS.iter().map(|format| format.name).collect();
    assert_eq!(names.len(), FORMATS.len());
}

#[test]
fn damage_before_the_first_record_hides_no_telemetry_log() {
    let mut bytes = vec![0x55; 900_000];
    bytes.extend(flight());
    let opened = open(&bytes).unwrap();
    let [Loss::Skipped { bytes: 900_000, places: 1, first_byte: 0, .. }] = opened.report.losses.as_slice()
    else {
        panic!("{:?}", opened.report.losses)
    };
}

#[test]
fn a_file_of_no_known_format_is_named_with_what_to_do() {
    let mut noise = vec![1_u8];
    noise.extend((0..500_u32).map(|index| (index * 97 % 251).to_le_bytes()[0]));
    let raw: Vec<u8> = support::attitudes(20).concat();
    let tar = [&b"flight.ulg"[..], &[0; 247], b"ustar\0", &[0; 200]].concat();
    for (bytes, came, advice) in [
        (&b"\xa3\x95\x80\x80\x59FMT"[..], "the first bytes of an ArduPilot log (.bin)", "the whole log"),
        (b"\xa3\x95\x80", "or of a PX4 log of the format before ULog", "the whole log"),
        (
            b"\xa3\x95\x80\x02\x37ATT ",
            "a PX4 log of the format before ULog (sdlog2, .px4log)",
            "sdlog2_dump.py",
        ),
        (b"\x1f\x8b\x08\0\0\0", "a gzip archive", "unpack"),
        (b"PK\x03\x04\x14\0", "a zip archive", "unpack"),
        (b"ULog\x01", "the first bytes of a PX4 log (.ulg)", "the whole log"),
        (b"ULog\x02", "binary data that begins with 55 4c 6f 67 02", "the log itself"),
        (b"PK\x05\x06\0\0\0\0", "an empty zip archive", "pack the log again"),
        (b"7z\xbc\xaf\x27\x1c\0\x04", "a 7z archive", "unpack"),
        (&tar, "a tar archive", "unpack"),
        (b"#ROSBAG V2.0\n", "a ROS bag", "table"),
        (b"SQLite format 3\0", "a ROS 2 bag", "table"),
        (b"\x89MCAP0\r\n", "an MCAP file", "table"),
        (b"H Product:Blackbox flight data recorder", "a blackbox log", "blackbox_decode"),
        (b"\xef\xbb\xbf\n<!DOCTYPE html><html>", "a web page (HTML)", "download the log itself"),
        (b"version https://git-lfs.github.com/spec/v1\n", "the pointer to a file in Git LFS", "git lfs pull"),
        (b"# Onboard parameters for Vehicle 1\n", "a file of parameters", "the log of a flight"),
        (
            b"#NOTE: today\nACRO_YAW_P,4.5\nANGLE_MAX 3000\nFS_THR_VALUE,-1e3\nATC_RA",
            "a file of parameters",
            "the log of a flight",
        ),
        (b"%PDF-1.4\n1 0 obj", "a PDF document", "the log itself"),
        (b"{\"a\": 1, \"b\": 2}", "JSON", "table"),
        (
            b"# of a, b and c\nname = \"x\"\n\n[body] # weighed\nmass = 1.0\n[propulsion]\n",
            "a vehicle file or a model",
            "`mavid vehicle FILE`",
        ),
        (
            b"Dear reader\nno table here\n",
            "text that is no log and has no header of columns",
            "names its columns",
        ),
        (b"0.0,1,2,3\n0.1,1,2,3\n", "text that is no log and has no header of columns", "names its columns"),
        (
            b"\ntime_s,battery_V\n0,1\n",
            "text that is no log and has no header of columns",
            "names its columns",
        ),
        (b"", "an empty file", "nothing was recorded"),
        (&[0; 4096], "a file that begins with zeros only", "interrupted"),
        (&raw, "MAVLink frames without stamps", "mavid record"),
        (&noise, "binary data that begins with 01 00 61 c2", "the log itself"),
    ] {
        let refused = open(bytes).unwrap_err();
        assert!(matches!(refused, LogError::UnknownFormat { .. }), "{refused:?}");
        let told = refused.to_string();
        let expected = "expected a telemetry log (.tlog), ";
        assert!(told.starts_with(expected) && told.contains(came) && told.contains(advice), "{told}");
    }
    let told = |path: &str| log::open(path, &OpenOptions::default()).unwrap_err().to_string();
    for (path, came) in [
        (env!("CARGO_MANIFEST_DIR"), "got a folder: give one of the logs in it"),
        ("no/such/*.ulg", "got a pattern that no file matches: check the folder and the ending"),
        #[cfg(unix)]
        ("/dev/null", "got a pipe or a device, which can be read only once: save it as a file"),
    ] {
        let told = told(path);
        assert!(told.starts_with("expected a telemetry log (.tlog), ") && told.contains(came), "{told}");
    }
    assert!(told("no/such.ulg").starts_with("cannot open no/such.ulg"), "{}", told("no/such.ulg"));
}

#[test]
fn losses_are_typed_with_how_much_and_where_first() {
    let whole = flight();
    let third = 8 + support::attitudes(1)[0].len();
    let mut broken = whole[..whole.len() - 5].to_vec();
    // the payload of a record in the middle, and noise between two
    let at = broken.len() - 10 * third;
    broken[at - 12] ^= 0xff;
    let boundary = whole.len() - 5 * third;
    broken.splice(boundary..boundary, [0x55; 33]);
    let losses = open(&broken).unwrap().report.losses;
    let told: Vec<String> = losses.iter().map(ToString::to_string).collect();
    let [checksum, skipped, cut] = losses.as_slice() else { panic!("{told:?}") };
    assert!(matches!(checksum, Loss::WrongChecksum { count: 1, .. }), "{told:?}");
    assert!(matches!(skipped, Loss::Skipped { bytes: 33, places: 1, .. }), "{told:?}");
    assert_eq!(skipped.first(), Some(Position::Byte(boundary as u64)));
    assert_eq!(told[0], "1 frames with a wrong checksum dropped");
    assert_eq!(told[1], format!("33 bytes of no frame skipped in 1 places, the first at byte {boundary}"));
    assert_eq!(told[2], format!("{} bytes of a record cut off at the end", third - 5));
    assert_eq!(cut.first(), Some(Position::Byte((broken.len() - (third - 5)) as u64)));

    let table =
        "time_s,attitude_w,attitude_x,attitude_y,attitude_z\n0,1,0,0,0\n1,2,0,0,0\n1,1,0,0,0\nx,1,0,0,0\n";
    let report = open(table.as_bytes()).unwrap().report;
    let told: Vec<(String, Option<Position>)> =
        report.losses.iter().map(|loss| (loss.to_string(), loss.first())).collect();
    let line = |line| Some(Position::Line(line));
    let rejected =
        "1 of 4 rows rejected, the first in line 5: column \"time_s\": expected a number, came \"x\"";
    assert_eq!(
        told,
        [
            (rejected.to_owned(), line(5)),
            ("1 rows repeat a time and were left out".to_owned(), line(4)),
            ("1 attitudes are no rotations and were left out".to_owned(), line(3)),
        ]
    );
    assert!(matches!(report.details, Details::Table(_)) && report.vehicle.is_none());
}

#[test]
fn a_table_begins_at_its_earliest_row_and_streams_on_the_same_clock() {
    let mut table = "time_s,battery_V\n".to_owned();
    for time_s in [5.2, 5.1, 5.3, 5.3, 4.9, 5.6, 6.5, 6.4, 9.0, 1.0, 1.5] {
        table.push_str(&format!("{time_s},{time_s}\n"));
    }
    let opened = open(table.as_bytes()).unwrap();
    let stream = opened.recording.streams.values().next().unwrap();
    let first: Vec<f64> = stream.values.clone();
    assert_eq!(first, [4.9, 5.1, 5.2, 5.3, 5.6, 6.4, 6.5, 9.0, 1.0, 1.5]);
    let wanted = [0.0, 0.2, 0.3, 0.4, 0.7, 1.5, 1.6, 4.1, 5.1, 5.6];
    assert!(stream.time_s.iter().zip(wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-9), "{stream:?}");
    assert!((opened.recording.clock_resets_s[0] - 5.1).abs() < 1e-9);
    let counts = opened.report.table().unwrap();
    assert_eq!((counts.rows_repeating_a_time, counts.rows_out_of_order, counts.clock_resets), (1, 3, 1));
    assert!((counts.start_time_s - 4.9).abs() < 1e-9);

    let mut times_s = Vec::new();
    let bytes = Input::Bytes { name: "bytes", bytes: table.as_bytes() };
    log::stream(bytes, &OpenOptions::default(), &mut |place, event| {
        if let Event::Sample { time_s, .. } = event {
            assert!(place.offset > 0 && place.arrival_us.is_none());
            times_s.push(time_s);
        }
    })
    .unwrap();
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    assert_eq!(times_s, stream.time_s);
}

/// What is more than is to be held is read once more, whatever the format.
#[test]
fn flights_are_the_same_whether_all_of_the_log_was_held_or_not() {
    let mut table = "time_s,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s,motor_1_command,armed\n".to_owned();
    for step in 0..30_000_u32 {
        let time_s = f64::from(step) * 0.02;
        let armed = u8::from((300.0..360.0).contains(&time_s));
        table.push_str(&format!("{time_s},{},{},0.1,0.5,{armed}\n", time_s.sin(), time_s.cos()));
    }
    let bytes = Input::Bytes { name: "table", bytes: table.as_bytes() };
    let most = Hold { seconds: 1e6, numbers: 60_000, short_s: 0.0 };
    let held = open_flights(bytes, &OpenOptions::default(), &most).unwrap();
    let whole = log::open(bytes, &OpenOptions::default()).unwrap();
    assert_eq!(held.flights, Flights::of(whole.recording, &most));
    let (from_s, to_s) = held.flights.flights[0].part_s.unwrap();
    assert!((280.0..=300.0).contains(&from_s) && (360.0..=380.0).contains(&to_s), "{from_s} to {to_s}");

    let least = Hold { seconds: 1e6, numbers: 20_000, short_s: 0.0 };
    let left = open_flights(bytes, &OpenOptions::default(), &least).unwrap();
    let [loss @ Loss::NotHeld { seconds }] = left.report.losses.as_slice() else {
        panic!("{:?}", left.report.losses)
    };
    assert!(*seconds > 10.0 && *seconds == left.flights.left_out_s && loss.first().is_none());
    assert!(loss.to_string().contains("s of flight at the end are left out"), "{loss}");

    // a short flight is held whole
    let short = Hold { short_s: 120.0, ..least };
    let kept = open_flights(bytes, &OpenOptions::default(), &short).unwrap();
    assert_eq!((kept.flights, kept.report.losses.len()), (held.flights, 0));
}

#[test]
fn a_stream_of_another_vehicle_than_the_one_that_flew_says_which_one_did() {
    let beat = |system, armed| {
        let MavMessage::HEARTBEAT(mut data) = heartbeat() else { panic!() };
        data.base_mode.set(dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, armed);
        v2(header(system, 0), &MavMessage::HEARTBEAT(data))
    };
    let turning = |system, time_boot_ms| {
        let data = dialect::ATTITUDE_DATA { time_boot_ms, yawspeed: 1.0, ..Default::default() };
        v2(header(system, 0), &MavMessage::ATTITUDE(data))
    };
    let frames: Vec<Vec<u8>> = (0..100_u32)
        .flat_map(|step| {
            let time_ms = 1000 + 20 * step;
            [beat(1, false), turning(1, time_ms), beat(2, true), turning(2, time_ms)]
        })
        .collect();
    let bytes = tlog(&frames);
    let input = Input::Bytes { name: "two", bytes: &bytes };
    let refused = log::stream(input, &OpenOptions::default(), &mut |_, _| ()).unwrap_err();
    assert!(matches!(refused, LogError::OtherFlew { system: SystemId(2) }), "{refused}");
    let opened = log::open(input, &OpenOptions::default()).unwrap();
    assert_eq!(
        (opened.report.vehicle.unwrap().system, opened.report.others),
        (SystemId(2), vec![SystemId(1)])
    );
    assert_eq!(opened.recording.autopilot, Autopilot::Px4);
}

#[test]
fn a_log_that_was_cut_off_before_its_first_sample_says_so() {
    let whole = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg")).unwrap();
    let told = open(&whole[..12]).unwrap_err().to_string();
    assert!(told.contains("the first 12 bytes of one: give the whole log"), "{told}");
    let cut = open(&whole[..600]).unwrap();
    assert!(cut.report.ends_early() && cut.report.is_timed());
    let found = mavid::inspect::inspect_recording(&cut, None);
    assert!(found.verdict.contains("it ends before its first sample. It was cut off"), "{}", found.verdict);
    assert!(!open(&whole).unwrap().report.ends_early());
}

#[test]
fn a_table_without_the_columns_says_how_to_name_them() {
    let told = open(b"a,b,c\n1,2,3\n4,5,6\n").unwrap_err().to_string();
    assert!(told.contains("expected column(s) time_s") && told.contains("--csv-map"), "{told}");
}
