//! Logs that are damaged, in another order than they were written in, or of two vehicles: what is said of them.

use crate::support;

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::config::effects_of;
use mavid::config::{load_vehicle, parse_effect_tables, read_trajectory};
use mavid::inspect::{Inspection, inspect, inspect_recording};
use mavid::log::{self, Input, Loss, OpenOptions};
use mavid::recording::{Quantity, Stream};
use mavid::simulate::{FlightSettings, Reference, Truth, simulate_flight};
use mavid::vehicle::Vehicle;
use mavid::wire::write_recording;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use support::dataflash::DataflashLog;

const DATA: u8 = b'D';
const HEADER: usize = 16;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("doubtful_logs");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn inspected(bytes: &[u8]) -> Inspection {
    let input = Input::Bytes { name: "bytes", bytes };
    inspect(input, &OpenOptions::default(), None, &mut |_| ()).unwrap()
}

/// What `mavid` says and its status.
fn mavid(arguments: &[&str]) -> (String, Option<i32>) {
    let output = Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    (String::from_utf8_lossy(&said).into_owned(), output.status.code())
}

fn shuffled<T>(pieces: &mut [T], random: &mut Pcg64) {
    for last in (1..pieces.len()).rev() {
        pieces.swap(last, random.random_range(0..=last));
    }
}

/// The records of a telemetry log with MAVLink 2.
fn records(log: &[u8]) -> Vec<&[u8]> {
    let (mut records, mut at) = (Vec::new(), 0);
    while at + 10 < log.len() {
        assert_eq!(log[at + 8], 0xfd);
        let bytes = 8 + 12 + usize::from(log[at + 9]) + if log[at + 10] & 1 == 1 { 13 } else { 0 };
        records.push(&log[at..at + bytes]);
        at += bytes;
    }
    records
}

/// The messages of a PX4 log behind its header.
fn messages(log: &[u8]) -> Vec<&[u8]> {
    let (mut messages, mut at) = (Vec::new(), HEADER);
    while at + 3 <= log.len() {
        let bytes = 3 + usize::from(u16::from_le_bytes([log[at], log[at + 1]]));
        messages.push(&log[at..(at + bytes).min(log.len())]);
        at += bytes;
    }
    messages
}

/// A log of ArduPilot of a minute: an inertial unit, and a state now and then.
fn minute() -> (Vec<u8>, Vec<Vec<u8>>) {
    let mut log = DataflashLog::new();
    log.define(131, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
    let head = log.binary.clone();
    let messages = (0..6000).map(|index| {
        log.binary.clear();
        let time_us = 5e6 + 1e4 * f64::from(index);
        let gyro = 0.1 * (0.01 * f64::from(index)).sin();
        log.add("IMU", &[time_us, 0.0, gyro, gyro, gyro, 0.1, 0.2, -9.8].map(Into::into));
        log.binary.clone()
    });
    let messages = messages.collect();
    (head, messages)
}

fn is_refused(bytes: &[u8], name: &str) {
    let found = inspected(bytes);
    assert!(
        found.verdict.contains("its messages are out of order, their stamps run back"),
        "{}",
        found.verdict
    );
    assert!(found.flight.segments.is_empty() && found.flight.airborne_s == 0.0, "{:?}", found.flight);
    let path = written(name, bytes);
    let (said, status) =
        mavid(&["identify", path.to_str().unwrap(), "--mass", "2", "--frame", "quadrotor-x"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("expected a log in the order in which it was written, got one whose stamps"),
        "{said}"
    );
}

#[test]
fn messages_in_another_order_are_told_and_not_timed() {
    let mut random = Pcg64::seed_from_u64(7);
    let whole = std::fs::read(fixture("p01_identify_0_25s.tlog")).unwrap();
    let mut shuffle = records(&whole);
    shuffled(&mut shuffle, &mut random);
    is_refused(&shuffle.concat(), "shuffled.tlog");
    // the frames alone, behind stamps in order
    let stamps: Vec<&[u8]> = records(&whole).into_iter().map(|record| &record[..8]).collect();
    let restamped = stamps.iter().zip(&shuffle).flat_map(|(stamp, record)| [*stamp, &record[8..]].concat());
    is_refused(&restamped.collect::<Vec<u8>>(), "restamped.tlog");
    let (head, mut messages_of_minute) = minute();
    shuffled(&mut messages_of_minute, &mut random);
    is_refused(&[head, messages_of_minute.concat()].concat(), "shuffled.bin");
    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    let (mut data, other): (Vec<&[u8]>, Vec<&[u8]>) =
        messages(&whole).into_iter().partition(|message| message.get(2) == Some(&DATA));
    shuffled(&mut data, &mut random);
    is_refused(&[&whole[..HEADER], &other.concat(), &data.concat()].concat(), "shuffled.ulg");
}

#[test]
fn what_transport_reorders_is_sorted_into_place() {
    let whole = std::fs::read(fixture("p01_identify_0_25s.tlog")).unwrap();
    let mut random = Pcg64::seed_from_u64(9);
    let mut swapped = records(&whole);
    for _ in 0..500 {
        let at = random.random_range(0..swapped.len() - 8);
        swapped.swap(at, at + random.random_range(1..8));
    }
    let (found, sound) = (inspected(&swapped.concat()), inspected(&whole));
    assert!((found.flight.airborne_s - sound.flight.airborne_s).abs() < 0.1, "{}", found.verdict);
}

/// A bit of the stamps' bytes that says more than an hour.
fn with_stray_stamps<'a>(messages: impl Iterator<Item = &'a mut Vec<u8>>, stamp_at: usize) -> u64 {
    let mut random = Pcg64::seed_from_u64(3);
    let mut strays = 0;
    for (index, message) in messages.enumerate() {
        if index % 397 == 200 {
            let bit = random.random_range(32..40_usize);
            message[stamp_at + bit / 8] ^= 1 << (bit % 8);
            strays += 1;
        }
    }
    strays
}

#[test]
fn stray_stamps_lengthen_nothing_and_are_counted() {
    let (head, mut of_minute) = minute();
    let strays = with_stray_stamps(of_minute.iter_mut(), 3);
    let found = inspected(&[head, of_minute.concat()].concat());
    assert!(found.clock.span_s.0.abs() < 1e-9 && (found.clock.span_s.1 - 59.99).abs() < 1e-9);
    let told = |count: u64| format!("{count} messages with a time that fits no clock were left out");
    assert_eq!(found.losses, [told(strays)]);

    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    let sound = inspected(&whole);
    let mut damaged: Vec<Vec<u8>> = messages(&whole).into_iter().map(<[u8]>::to_vec).collect();
    let read = damaged.iter_mut().filter(|message| message.get(2) == Some(&DATA) && message.len() > 40);
    let strays = with_stray_stamps(read, 5);
    let found = inspected(&[&whole[..HEADER], &damaged.concat()].concat());
    let apart = |one: (f64, f64), other: (f64, f64)| (one.0 - other.0).abs().max((one.1 - other.1).abs());
    assert!(apart(found.clock.span_s, sound.clock.span_s) < 5.0, "{:?}", found.clock);
    assert!((found.flight.airborne_s - sound.flight.airborne_s).abs() < 0.2, "{}", found.verdict);
    assert!(found.clock.resets_s.is_empty());
    // of topics that are read
    let left_out: u64 = found.losses[0].split(' ').next().unwrap().parse().unwrap();
    assert!((1..=strays).contains(&left_out), "{:?}", found.losses);
}

/// Adds a quarter of an hour to the stamps of some messages.
fn later(messages: &mut [Vec<u8>], which: &[usize], stamp_at: usize) {
    for index in which {
        let stamp = &mut messages[*index][stamp_at..stamp_at + 8];
        let us = u64::from_le_bytes(stamp.try_into().unwrap()) + 1_000_000_000;
        stamp.copy_from_slice(&us.to_le_bytes());
    }
}

#[test]
fn stamps_that_are_minutes_ahead_lengthen_nothing_and_a_pause_costs_nothing() {
    let open =
        |bytes: &[u8]| log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default()).unwrap();
    let strays = |count| vec![Loss::StrayStamps { count }];
    let (head, sound) = minute();
    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    let all: Vec<Vec<u8>> = messages(&whole).into_iter().map(<[u8]>::to_vec).collect();
    let is_sensor = |message: &&Vec<u8>| message[2] == b'A' && message[6..] == *b"sensor_combined";
    let id = all.iter().find(is_sensor).unwrap()[4..6].to_vec();
    let of_sensor: Vec<usize> =
        (0..all.len()).filter(|index| all[*index][2] == DATA && all[*index][3..5] == id).collect();
    let span_s = inspected(&whole).clock.span_s;
    // here and there, one behind the other, and at the end
    for which in [[500, 2000, 4000], [3000, 3001, 3002], [100, 4500, 5999]] {
        let mut damaged = sound.clone();
        later(&mut damaged, &which, 3);
        let bytes = [head.clone(), damaged.concat()].concat();
        assert_eq!(open(&bytes).report.losses, strays(3));
        let found = inspected(&bytes).clock.span_s;
        assert!(found.0.abs() < 1e-9 && (found.1 - 59.99).abs() < 0.02, "{found:?}");
    }
    for which in [[50, 200, 400], [300, 301, 302]] {
        let mut damaged = all.clone();
        later(&mut damaged, &which.map(|index| of_sensor[index]), 5);
        let bytes = [&whole[..HEADER], &damaged.concat()].concat();
        assert_eq!(open(&bytes).report.losses, strays(3));
        assert_eq!(inspected(&bytes).clock.span_s, span_s);
    }
    // everything from here on
    let mut paused = sound.clone();
    later(&mut paused, &(3000..6000).collect::<Vec<_>>(), 3);
    let opened = open(&[head, paused.concat()].concat());
    let streams: Vec<usize> = opened.recording.streams.values().map(Stream::len).collect();
    assert_eq!((opened.report.losses, streams), (vec![], vec![6000, 6000]));
    let mut paused = all.clone();
    let later_ones: Vec<usize> =
        (all.len() / 2..all.len() - 1).filter(|index| all[*index][2] == DATA).collect();
    later(&mut paused, &later_ones, 5);
    let opened = open(&[&whole[..HEADER], &paused.concat()].concat());
    assert_eq!(opened.report.losses, []);
}

#[test]
fn a_missing_beginning_is_told_as_that() {
    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    for cut in [1, 100, 5000, whole.len() / 2] {
        let path = written("cut.ulg", &whole[cut..]);
        let (said, status) = mavid(&["inspect", path.to_str().unwrap()]);
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains("a piece of a PX4 log (.ulg): its beginning is missing"), "{cut}: {said}");
    }
    let mut log = DataflashLog::new();
    log.define(130, "MSG", "QZ", "TimeUS,Message");
    log.define(131, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
    for index in 0..3000 {
        let time_us = 5e6 + 1e4 * f64::from(index);
        log.add("IMU", &[time_us, 0.0, 0.1, 0.1, 0.1, 0.1, 0.2, -9.8].map(Into::into));
        if index % 100 == 0 {
            log.add("MSG", &[time_us.into(), "flying".into()]);
        }
    }
    // the definition of the inertial unit is damaged, and with it most of the log
    let mut bytes = log.binary.clone();
    bytes[2 * 89..3 * 89].fill(0x5a);
    let found = inspected(&bytes);
    assert!(found.verdict.contains("its beginning is missing. Give the whole log"), "{}", found.verdict);
    let set = found.quantities.iter().filter_map(|of| of.set.clone());
    let all = found.advice.iter().cloned().chain(set).collect::<String>();
    assert!(!all.contains("LOG_BITMASK"), "{all}");
    // nothing but the messages
    let found = inspected(&bytes[89..]);
    assert!(found.verdict.contains("its beginning is missing. Give the whole log"), "{}", found.verdict);
}

#[test]
fn missing_rates_are_one_story_with_and_without_a_vehicle() {
    let vehicle = load_vehicle(&fixture("p01_vehicle.toml")).unwrap();
    let opened = log::open(fixture("p01_identify_0_25s.tlog").as_path(), &OpenOptions::default()).unwrap();
    let (mut without, mut zero) = (opened.clone(), opened);
    without.recording.streams.retain(|key, _| key.quantity != Quantity::AngularRate);
    let rates = zero.recording.streams.iter_mut().filter(|(key, _)| key.quantity == Quantity::AngularRate);
    rates.for_each(|(_, stream)| stream.values.fill(0.0));
    for (opened, expected) in
        [(without, "no body rates"), (zero, "no body rates: they hold nothing but zeros")]
    {
        let reasons = |vehicle: Option<&Vehicle>| -> Vec<String> {
            let found = inspect_recording(&opened, vehicle);
            let inertia = found.identifiability.iter().skip(1).filter_map(|of| of.reason.clone());
            let of_quantity = found.quantities[1].reason.clone();
            inertia
                .chain(of_quantity)
                .chain(found.advice.into_iter().filter(|one| one.contains("ody rates")))
                .collect()
        };
        assert_eq!(reasons(None), reasons(Some(&vehicle)));
        assert_eq!(reasons(None)[..7], vec![expected.to_owned(); 7]);
    }
}

#[test]
fn two_vehicles_in_one_log_are_told() {
    let config = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name);
    let heavier = std::fs::read_to_string(config("x500.toml")).unwrap();
    let inertia = heavier.lines().find(|line| line.starts_with("inertia")).unwrap();
    let of_other = "inertia = { xx = 0.0286, yy = 0.0286, zz = 0.0527 }";
    let other = written("other.toml", heavier.replace(inertia, of_other).as_bytes());
    let trajectory = fixture("at_bounds_trajectory.toml").display().to_string();
    let flown = |vehicle: &Path, seed: &str| {
        let log = written(&format!("flown_{seed}.tlog"), &[]).display().to_string();
        let vehicle = vehicle.display().to_string();
        let (said, status) =
            mavid(&["simulate", &vehicle, "--trajectory", &trajectory, "--out", &log, "--seed", seed]);
        assert_eq!(status, Some(0), "{said}");
        log
    };
    let (one, again, another) =
        (flown(&config("x500.toml"), "1"), flown(&config("x500.toml"), "2"), flown(&other, "3"));
    let stated = config("x500.toml").display().to_string();
    let (same, _) = mavid(&["identify", &one, &again, "--vehicle", &stated]);
    assert!(!same.contains("two vehicles"), "{same}");
    let (differ, _) = mavid(&["identify", &one, &another, "--vehicle", &stated]);
    assert!(differ.contains("doubtful: ") && differ.contains("two vehicles or two loads"), "{differ}");
    let (explained, _) = mavid(&["explain", &one, &another, "--vehicle", &stated]);
    assert!(explained.starts_with("Doubtful: "), "{explained}");
    assert!(explained.contains("two vehicles or two loads"), "{explained}");
    let both = |other: &str| {
        let bytes = [std::fs::read(&one).unwrap(), std::fs::read(other).unwrap()].concat();
        mavid(&["inspect", written("both.tlog", &bytes).to_str().unwrap(), "--vehicle", &stated]).0
    };
    let (same, differ) = (both(&again), both(&another));
    assert!(same.contains("This log is good for "), "{same}");
    assert!(differ.contains("Doubtful: flight 2 alone gives an i"), "{differ}");
}

/// The log of a flight of the X500 whose thrust sags with the battery, from this voltage on.
fn flown_at(battery_v: f64, seed: u64) -> String {
    let vehicle = load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
    let sag = "[[effect]]\nid = \"battery_sag\"\nexponent = 1.5\nfull_voltage = 16.8\n";
    let effects = effects_of(&parse_effect_tables(sag, "sag").unwrap(), "sag", &vehicle).unwrap();
    let trajectory = read_trajectory(&fixture("at_bounds_trajectory.toml")).unwrap();
    let duration_s = 4.0 + f64::from(trajectory.repeats) * trajectory.series.period_s;
    let reference = Reference { trajectory: trajectory.series, hover_s: 4.0, ramp_s: 2.0 };
    let settings = FlightSettings { seed, duration_s, battery_v, ..FlightSettings::default() };
    let truth = Truth { vehicle: vehicle.clone(), effects, disturbance: None };
    let flight = simulate_flight(truth, &vehicle, &reference, &settings).unwrap();
    let log = written(&format!("flown_at_{battery_v}.tlog"), &[]);
    write_recording(&flight.recording, std::fs::File::create(&log).unwrap(), support::START_US).unwrap();
    log.display().to_string()
}

#[test]
fn another_voltage_is_no_other_vehicle() {
    let stated = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml").display().to_string();
    let (explained, _) = mavid(&["explain", &flown_at(16.6, 1), &flown_at(15.4, 2), "--vehicle", &stated]);
    assert!(explained.contains("flight 2 alone gives a"), "{explained}");
    assert!(!explained.starts_with("Doubtful: "), "{explained}");
    assert!(!explained.contains("two vehicles"), "{explained}");
    let Some(shared) = support::shared() else { return };
    let file = |name: &str| shared.join("onboard/sitl").join(name).display().to_string();
    let logs = ["ap07.bin", "ap01.bin"].map(file);
    let (explained, _) = mavid(&["explain", &logs[0], &logs[1], "--vehicle", &file("ardupilot-quad-c.toml")]);
    assert!(explained.starts_with("Doubtful: "), "{explained}");
    assert!(
        explained.contains("the flights given together differ by more than flights of one vehicle do"),
        "{explained}"
    );
    // two vehicles with moments of inertia within 7 % of each other as the stated thrust has them: their masses differ
    let logs = ["px01.ulg", "px04.ulg"].map(file);
    let (explained, _) = mavid(&["explain", &logs[0], &logs[1], "--vehicle", &file("px4-v1.toml")]);
    assert!(explained.contains("its mass by the thrust differs from that of the flights"), "{explained}");
}

#[test]
fn losses_of_order_are_no_losses_of_bytes() {
    let (head, messages) = minute();
    let opened = log::open(
        Input::Bytes { name: "bytes", bytes: &[head, messages.concat()].concat() },
        &OpenOptions::default(),
    )
    .unwrap();
    assert!(!opened.report.losses.iter().any(|loss| matches!(loss, Loss::StrayStamps { .. })));
    assert_eq!((opened.report.out_of_order(), opened.report.damage()), (None, None));
}

/// Values within messages that were damaged, as nothing but their size tells: no checksum is of them.
#[test]
fn values_that_no_vehicle_has_take_nothing_from_a_log() {
    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    let vehicle = load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
    let found = |bytes: &[u8]| {
        let input = Input::Bytes { name: "bytes", bytes };
        inspect(input, &OpenOptions::default(), Some(&vehicle), &mut |_| ()).unwrap()
    };
    let mut damaged = whole.clone();
    // 16 bytes in the midst of each twentieth message of data that is long enough, of numbers of about 1e38
    let (mut at, mut count) = (HEADER, 0_usize);
    while at + 3 < whole.len() {
        let length = usize::from(u16::from_le_bytes([whole[at], whole[at + 1]]));
        let end = at + 3 + length;
        if whole[at + 2] == DATA && length > 40 && end <= whole.len() {
            count += 1;
            if count.is_multiple_of(20) {
                damaged[at + 3 + 18..at + 3 + 34].fill(0x7e);
            }
        }
        at = end;
    }
    let (sound, told) = (found(&whole), found(&damaged));
    assert!(
        told.losses.iter().any(|loss| loss.contains("with a value that no vehicle has")),
        "{:?}",
        told.losses
    );
    let mass = |of: &Inspection| of.identifiability[0].std_relative;
    let [sound, told] = [mass(&sound), mass(&told)].map(|std| std.unwrap_or(f64::INFINITY));
    assert!(told < 3.0 * sound, "{told} instead of {sound}");
}

#[test]
fn a_log_that_was_cut_off_in_its_head_is_told_so() {
    let whole = std::fs::read(fixture("px4_flight.ulg")).unwrap();
    for bytes in [16, 1000, 3000] {
        let verdict = inspected(&whole[..bytes]).verdict;
        assert!(verdict.contains("it ends before its first sample. It was cut off"), "{bytes}: {verdict}");
    }
}
