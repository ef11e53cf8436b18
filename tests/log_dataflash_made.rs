//! ArduPilot's logs made by hand: what each message becomes, and what is said of damage.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use mavid::autopilot::{Autopilot, VehicleKind};
use mavid::log::{self, Input, LogError, OpenOptions, Opened};
use mavid::recording::{Quantity, Recording, Stream, StreamKey};
use support::dataflash::{DataflashLog, Value};

fn open(bytes: &[u8]) -> Result<Opened, LogError> {
    log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default())
}

fn stream<'a>(
    recording: &'a Recording,
    quantity: Quantity,
    source: &'static str,
    instance: u8,
) -> &'a Stream {
    &recording.streams[&StreamKey { quantity, source, instance }]
}

fn near(ours: &[f64], theirs: &[f64]) {
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6 || a.is_nan() && b.is_nan();
    assert!(ours.len() == theirs.len() && ours.iter().zip(theirs).all(is_near), "{ours:?} {theirs:?}");
}

/// Definitions, software and parameters of a vehicle, stamps in microseconds.
fn begun() -> DataflashLog {
    let mut log = DataflashLog::new();
    for (number, name, format, columns) in [
        (129, "PARM", "QNff", "TimeUS,Name,Value,Default"),
        (130, "MSG", "QZ", "TimeUS,Message"),
        (131, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
        (132, "ATT", "Qcccccc", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw"),
        (133, "RATE", "Qfffffff", "TimeUS,RDes,R,ROut,P,POut,Y,YOut"),
        (134, "RCOU", "QHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6"),
        (135, "ESC", "QBf", "TimeUS,Instance,RPM"),
        (136, "EV", "QB", "TimeUS,Id"),
        (137, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn"),
        (138, "ERR", "QBB", "TimeUS,Subsys,ECode"),
        (139, "GPS", "QBBfff", "TimeUS,I,Status,Spd,GCrs,VZ"),
        (140, "XKF1", "QBcccffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,PN,PE,PD"),
        (141, "NEWS", "QBf", "TimeUS,I,Value"),
    ] {
        log.define(number, name, format, columns);
    }
    log.add("MSG", &[40e6.into(), "ArduCopter V4.5.7 (2a3dc4b7)".into()]);
    log.add("PARM", &[40e6.into(), "ATC_RAT_RLL_P".into(), 0.135.into(), 0.135.into()]);
    log.add("PARM", &[40e6.into(), "FRAME_CLASS".into(), 1.0.into(), 0.0.into()]);
    log.add("PARM", &[40e6.into(), "SIM_WIND_SPD".into(), 7.0.into(), 0.0.into()]);
    log
}

/// The same flight in microseconds from 41 s on.
fn flown() -> DataflashLog {
    let mut log = begun();
    log.add("EV", &[41e6.into(), 10.0.into()]);
    log.add("MODE", &[41e6.into(), 4.0.into(), 4.0.into(), 2.0.into()]);
    for step in 0..300_u32 {
        let (us, t) = (41e6 + 10_000.0 * f64::from(step), f64::from(step));
        log.add("IMU", &[us, 0.0, 0.5, 0.25, -0.125, 1.0, 2.0, -9.75].map(Value::from));
        log.add("IMU", &[us, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -9.5].map(Value::from));
        log.add("ATT", &[us, 1.0, 0.0, 0.0, 11.46, 0.0, 90.0].map(Value::from));
        log.add("RATE", &[us, 0.0, 180.0, 0.5, 90.0, 0.25, -90.0, -0.5].map(Value::from));
        log.add("RCOU", &[us, 1500.0 + t, 1400.0, 1300.0, 1200.0, 0.0, 0.0].map(Value::from));
        for esc in 0..4_u8 {
            let rpm = 6000.0 + 60.0 * f64::from(esc);
            log.add("ESC", &[us + 20.0 * f64::from(esc), esc.into(), rpm].map(Value::from));
        }
        log.add("GPS", &[us, 0.0, 3.0, 2.0, 90.0, 0.5].map(Value::from));
        log.add("XKF1", &[us, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(Value::from));
        log.add("NEWS", &[us, 1.0, 3.0].map(Value::from));
    }
    log.add("ERR", &[43.9e6.into(), 16.0.into(), 2.0.into()]);
    log.add("EV", &[43.95e6.into(), 18.0.into()]);
    log.add("EV", &[43.95e6.into(), 11.0.into()]);
    log
}

#[test]
fn every_message_becomes_its_stream_in_si_and_in_flu_and_nwu() {
    let log = flown();
    for (bytes, format) in
        [(log.binary.as_slice(), "ArduPilot log (.bin)"), (log.text.as_bytes(), "ArduPilot text log (.log)")]
    {
        let Opened { recording, report } = open(bytes).unwrap();
        assert_eq!((report.format, recording.autopilot), (format, Autopilot::ArduPilot));
        assert!(report.losses.is_empty() && report.oddities.is_empty(), "{report:?}");
        let of = |quantity, source, instance| stream(&recording, quantity, source, instance);
        near(of(Quantity::AngularRate, "IMU", 0).sample(0), &[0.5, -0.25, 0.125]);
        near(of(Quantity::SpecificForce, "IMU", 0).sample(0), &[1.0, -2.0, 9.75]);
        near(of(Quantity::SpecificForce, "IMU", 1).sample(0), &[0.0, 0.0, 9.5]);
        let attitude = of(Quantity::Attitude, "ATT", 0);
        assert_eq!((attitude.len(), attitude.width), (300, 4));
        assert!((attitude.time_s[1] - 1.01).abs() < 1e-9, "the log's first stamp is zero");
        // to the east: forward points to minus west
        let half = std::f64::consts::FRAC_PI_4;
        assert!((attitude.sample(0)[3] + half.sin() * 0.995).abs() < 1e-3, "{:?}", attitude.sample(0));
        let pi = std::f64::consts::PI;
        near(of(Quantity::AngularRate, "RATE", 0).sample(0), &[pi, -pi / 2.0, pi / 2.0]);
        near(of(Quantity::TorqueSetpoint, "RATE", 0).sample(0), &[0.5, -0.25, 0.5]);
        near(of(Quantity::ActuatorCommand, "RCOU", 0).sample(1), &[1501.0, 1400.0, 1300.0, 1200.0]);
        let speeds = of(Quantity::RotorSpeed, "ESC", 0);
        assert_eq!((speeds.len(), speeds.width), (300, 4));
        near(speeds.sample(7), &[100.0, 101.0, 102.0, 103.0].map(|hz| hz * 2.0 * pi));
        near(of(Quantity::GpsVelocity, "GPS", 0).sample(0), &[0.0, -2.0, -0.5]);
        near(of(Quantity::Velocity, "XKF1", 0).sample(0), &[1.0, -2.0, -3.0]);
        near(of(Quantity::Position, "XKF1", 0).sample(0), &[4.0, -5.0, -6.0]);
        // states stand until the next word
        let armed = of(Quantity::Armed, "EV", 0);
        assert!(armed.len() >= 4 && armed.values[..armed.len() - 1].iter().all(|state| *state == 1.0));
        assert_eq!((armed.time_s[0], armed.values[armed.len() - 1]), (1.0, 0.0));
        assert_eq!(of(Quantity::Mode, "EV", 0).values[0], 4.0);
        assert_eq!(recording.parameters["FRAME_CLASS"], 1.0);
        assert!(!recording.parameters.contains_key("SIM_WIND_SPD"), "the simulator's truth is not read");
        assert_eq!(recording.texts[1].1, "error of subsystem 16, code 2");
        let onboard = report.onboard().unwrap();
        assert_eq!(onboard.kind, Some(VehicleKind::Multirotor));
        assert_eq!(onboard.firmware.as_deref(), Some("ArduCopter V4.5.7 (2a3dc4b7)"));
        let news = onboard.topics.iter().find(|topic| topic.name == "NEWS").unwrap();
        assert_eq!((news.count, news.instance, news.is_used), (300, 1, false));
        assert!((news.rate_hz().unwrap() - 100.0).abs() < 1e-6);
    }
}

#[test]
fn a_field_that_is_new_or_gone_costs_nothing_else() {
    let mut log = begun();
    log.define(131, "IMU", "QBffffffff", "TimeUS,I,AccX,AccY,AccZ,New,GyrX,GyrY,GyrZ,T");
    log.define(132, "ATT", "Qcc", "TimeUS,Roll,Pitch");
    for step in 0..20_u32 {
        let us = 41e6 + 10_000.0 * f64::from(step);
        log.add("IMU", &[us, 0.0, 1.0, 2.0, -9.75, 7.0, 0.5, 0.25, -0.125, 30.0].map(Value::from));
        log.add("ATT", &[us, 1.0, 2.0].map(Value::from));
    }
    let Opened { recording, report } = open(&log.binary).unwrap();
    near(stream(&recording, Quantity::AngularRate, "IMU", 0).sample(0), &[0.5, -0.25, 0.125]);
    assert!(!recording.streams.keys().any(|key| key.source == "ATT"));
    assert!(report.losses.is_empty());
}

#[test]
fn a_batch_gives_each_of_its_samples_its_own_time() {
    let mut log = begun();
    log.define(150, "ISBH", "QHBBHHQf", "TimeUS,N,type,instance,mul,smp_cnt,SampleUS,smp_rate");
    log.define(151, "ISBD", "QHHaaa", "TimeUS,N,seqno,x,y,z");
    let head = |number: f64| [41.2e6, number, 1.0, 0.0, 1000.0, 64.0, 41.1e6, 2000.0].map(Value::from);
    log.add("ISBH", &head(5.0));
    for (number, place) in [(5.0, 0.0), (5.0, 1.0), (6.0, 0.0)] {
        let x: [i16; 32] = std::array::from_fn(|index| i16::try_from(index).unwrap() * 10);
        let arrays = [Value::Array(x), Value::Array([500; 32]), Value::Array([-250; 32])];
        let front = [41.21e6, number, place].map(Value::from);
        log.add("ISBD", &[&front[..], &arrays[..]].concat());
    }
    let Opened { recording, .. } = open(&log.binary).unwrap();
    let rates = stream(&recording, Quantity::AngularRate, "ISBD", 0);
    assert_eq!(rates.len(), 64, "a piece whose head was lost has no time");
    near(rates.sample(3), &[0.03, -0.5, 0.25]);
    assert!((rates.time_s[33] - (1.1 + 33.0 / 2000.0)).abs() < 1e-6);
}

#[test]
fn a_second_log_behind_the_first_is_a_clock_that_began_anew() {
    let flight = flown();
    let twice = [flight.binary.as_slice(), flight.binary.as_slice()].concat();
    let Opened { recording, report } = open(&twice).unwrap();
    assert_eq!(recording.clock_resets_s.len(), 1);
    assert!((recording.clock_resets_s[0] - 4.99).abs() < 0.1, "{:?}", recording.clock_resets_s);
    assert_eq!(stream(&recording, Quantity::AngularRate, "IMU", 0).len(), 600);
    assert!(report.losses.is_empty());
}

#[test]
fn what_was_disarmed_was_armed_since_its_first_sample() {
    let mut log = begun();
    for step in 0..50_u32 {
        let us = 41e6 + 100_000.0 * f64::from(step);
        log.add("RCOU", &[us, 1500.0, 1400.0, 1300.0, 1200.0, 0.0, 0.0].map(Value::from));
    }
    log.add("EV", &[46e6.into(), 11.0.into()]);
    let twice = log.binary.repeat(2);
    let Opened { recording, .. } = open(&twice).unwrap();
    let armed = stream(&recording, Quantity::Armed, "EV", 0);
    let said: Vec<(f64, f64)> = armed.time_s.iter().copied().zip(armed.values.iter().copied()).collect();
    assert_eq!(said, [(1.0, 1.0), (6.0, 0.0), (8.0, 1.0), (13.0, 0.0)]);
}

#[test]
fn what_is_lost_is_counted_to_the_byte() {
    let mut log = begun();
    let first = log.binary.len();
    for step in 0..20_u32 {
        log.add("EV", &[41e6 + 1e4 * f64::from(step), 10.0].map(Value::from));
    }
    let lost = |bytes: &[u8]| {
        let report = open(bytes).unwrap().report;
        (
            report.losses.iter().map(ToString::to_string).collect::<Vec<_>>(),
            report.onboard().unwrap().messages,
        )
    };
    let (whole, count) = lost(&log.binary);
    assert!(whole.is_empty());
    // each is 12 bytes long: junk behind the second one casts doubt on it
    let mut junk = log.binary.clone();
    junk.splice(first + 24..first + 24, [0x55; 7]);
    let told = format!("19 bytes of no message skipped in 1 places, the first at byte {}", first + 12);
    assert_eq!(lost(&junk), (vec![told], count - 1));
    let cut = &log.binary[..log.binary.len() - 5];
    assert_eq!(lost(cut), (vec!["7 bytes of a record cut off at the end".to_owned()], count - 1));
    let mut padded = log.binary.clone();
    padded.extend([0xff; 100]);
    assert_eq!(lost(&padded), (vec!["112 bytes of a record cut off at the end".to_owned()], count - 1));
    // a stamp of the year 6000, and one that is gone
    let mut stray = log.binary.clone();
    stray[first + 12 + 3 + 6] = 0x40;
    assert_eq!(lost(&stray).0, ["1 messages with a time that fits no clock were left out"]);
    let mut text = log.text.clone();
    text.truncate(text.len() - 3);
    let cut = lost(text.as_bytes()).0;
    assert!(cut[0].starts_with("1 of ") && cut[0].contains("rows rejected"), "{cut:?}");
}

#[test]
fn a_log_whose_first_bytes_are_damaged_is_still_one() {
    let mut log = flown().binary;
    log[..50].fill(0);
    assert_eq!(open(&log).unwrap().report.format, "ArduPilot log (.bin)");
    // without any definition it says nothing
    let refused = open(&log[7000..]).unwrap_err().to_string();
    assert!(refused.contains("got "), "{refused}");
}
