//! ArduPilot's logs made by hand: what each message becomes, and what is said of damage.

use crate::support;

use mavid::autopilot::{Autopilot, VehicleKind};
use mavid::log::{self, Input, LogError, OpenOptions, Opened};
use mavid::recording::{Event, Quantity, Recording, Stream, StreamKey};
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
fn why_a_vehicle_will_not_arm_says_that_it_is_not_armed() {
    let mut log = begun();
    let outputs = |log: &mut DataflashLog, us: f64| {
        log.add("RCOU", &[us, 1000.0, 1000.0, 1000.0, 1000.0, 0.0, 0.0].map(Value::from));
    };
    outputs(&mut log, 41e6);
    log.add("MSG", &[41.5e6.into(), "PreArm: Compass not healthy".into()]);
    outputs(&mut log, 43e6);
    let said = |log: &DataflashLog| {
        let Opened { recording, .. } = open(&log.binary).unwrap();
        stream(&recording, Quantity::Armed, "EV", 0).values.clone()
    };
    let never = said(&log);
    assert!(!never.is_empty() && never.iter().all(|armed| *armed == 0.0), "{never:?}");
    // and then it arms, or its throttle is raised in a log that lost the event of arming
    for event in [10.0, 15.0] {
        let mut log = log.clone();
        log.add("EV", &[44e6.into(), event.into()]);
        outputs(&mut log, 45e6);
        assert_eq!(said(&log).last(), Some(&1.0), "event {event}");
    }
}

#[test]
fn a_vehicle_that_took_off_was_armed_where_the_arming_is_lost_in_a_gap() {
    // airborne, and a throttle that was raised
    for event in [28.0, 15.0] {
        let mut log = begun();
        let outputs = |log: &mut DataflashLog, us: f64| {
            log.add("RCOU", &[us, 1500.0, 1500.0, 1500.0, 1500.0, 0.0, 0.0].map(Value::from));
        };
        outputs(&mut log, 41e6);
        log.add("MSG", &[41.5e6.into(), "PreArm: Compass not healthy".into()]);
        outputs(&mut log, 42e6);
        outputs(&mut log, 52e6);
        log.add("EV", &[53e6.into(), event.into()]);
        outputs(&mut log, 60e6);
        log.add("EV", &[61e6.into(), 11.0.into()]);
        let Opened { recording, .. } = open(&log.binary).unwrap();
        let armed = stream(&recording, Quantity::Armed, "EV", 0);
        let said = |time_s: f64| armed.values[armed.time_s.partition_point(|at| *at <= time_s) - 1];
        assert_eq!([12.5, 13.5, 20.0, 22.0].map(said), [0.0, 1.0, 1.0, 0.0], "event {event}: {armed:?}");
    }
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

#[test]
fn rates_before_copter_3_4_are_in_hundredths_of_degrees_and_torques_of_4500() {
    let told = |parameter: Option<&str>| {
        let mut log = DataflashLog::new();
        log.define(129, "PARM", "QNf", "TimeUS,Name,Value");
        log.define(133, "RATE", "Qffffffffffff", "TimeUS,RDes,R,ROut,PDes,P,POut,YDes,Y,YOut,ADes,A,AOut");
        parameter.into_iter().for_each(|name| log.add("PARM", &[1e6.into(), name.into(), 0.15.into()]));
        for step in 0..20_u32 {
            let us = 2e6 + 1e4 * f64::from(step);
            let rates = [100.0, 18_000.0, 450.0, 0.0, 9000.0, -900.0, 0.0, 0.0, 0.0, 0.0, 0.0, 500.0];
            log.add("RATE", &[&[us][..], &rates].concat().into_iter().map(Value::from).collect::<Vec<_>>());
        }
        open(&log.binary).unwrap()
    };
    let (old, new) = (told(Some("RATE_RLL_P")).recording, told(Some("ATC_RAT_RLL_P")).recording);
    let pi = std::f64::consts::PI;
    near(stream(&old, Quantity::AngularRate, "RATE", 0).sample(3), &[pi, -pi / 2.0, 0.0]);
    near(stream(&old, Quantity::TorqueSetpoint, "RATE", 0).sample(3), &[0.1, 0.2, 0.0]);
    near(stream(&old, Quantity::ThrustSetpoint, "RATE", 0).sample(3), &[0.5]);
    near(stream(&new, Quantity::AngularRate, "RATE", 0).sample(3), &[100.0 * pi, -50.0 * pi, 0.0]);
    let unknown = told(None);
    assert!(unknown.recording.streams.is_empty());
    assert!(unknown.report.oddities[0].to_string().contains("80 samples are in a unit that differs"));
}

#[test]
fn outputs_beyond_the_fourteenth_stand_in_one_row_with_the_others() {
    let mut log = begun();
    log.define(150, "RCO2", "QHHHH", "TimeUS,C15,C16,C17,C18");
    log.define(
        151,
        "RCO3",
        "QHHHHHHHHHHHHHH",
        "TimeUS,C19,C20,C21,C22,C23,C24,C25,C26,C27,C28,C29,C30,C31,C32",
    );
    for step in 0..20_u32 {
        let us = 41e6 + 1e5 * f64::from(step);
        log.add("RCOU", &[us, 1500.0, 1400.0, 1300.0, 1200.0, 0.0, 0.0].map(Value::from));
        // one is lost
        if step != 7 {
            log.add("RCO2", &[us + 8.0, 0.0, 1600.0, 1610.0, 0.0].map(Value::from));
        }
        log.add(
            "RCO3",
            &[&[us + 16.0, 1700.0][..], &[0.0; 13]].concat().into_iter().map(Value::from).collect::<Vec<_>>(),
        );
        log.add("IMU", &[us + 5e4, 0.0, 0.5, 0.25, -0.125, 1.0, 2.0, -9.75].map(Value::from));
    }
    let Opened { recording, report } = open(&log.binary).unwrap();
    let outputs = stream(&recording, Quantity::ActuatorCommand, "RCOU", 0);
    assert_eq!((outputs.len(), outputs.width), (20, 19));
    assert!((outputs.time_s[1] - outputs.time_s[0] - 0.1).abs() < 1e-9, "the time is that of RCOU");
    // none waits for the next one, which may come much later
    let mut times_s = Vec::new();
    let input = Input::Bytes { name: "bytes", bytes: &log.binary };
    let mut take = |_, event: Event<'_>| {
        if let Event::Sample { time_s, .. } = event {
            times_s.push(time_s);
        }
    };
    log::stream(input, &OpenOptions::default(), &mut take).unwrap();
    assert!(times_s.len() == 60 && times_s.is_sorted(), "{times_s:?}");
    near(&outputs.sample(19)[..4], &[1500.0, 1400.0, 1300.0, 1200.0]);
    near(&outputs.sample(19)[14..], &[0.0, 1600.0, 1610.0, 0.0, 1700.0]);
    assert!(outputs.sample(7)[15].is_nan() && outputs.sample(7)[18] == 1700.0);
    let topics = &report.onboard().unwrap().topics;
    assert!(topics.iter().filter(|topic| topic.name.starts_with("RCO")).all(|topic| topic.is_used));
}

#[test]
fn rotor_speeds_of_a_message_each_stand_in_one_row() {
    // in thousands of revolutions until 2017, then in revolutions
    for (letter, rpm) in [("c", 6.0), ("e", 6000.0)] {
        let mut log = begun();
        for esc in 0..4_u8 {
            let format = format!("Q{letter}ccc");
            log.define(150 + esc, &format!("ESC{}", esc + 1), &format, "TimeUS,RPM,Volt,Curr,Temp");
        }
        for step in 0..20_u32 {
            for esc in 0..4_u8 {
                let us = 41e6 + 1e5 * f64::from(step) + 30.0 * f64::from(esc);
                let speed = rpm * (1.0 + 0.1 * f64::from(esc));
                log.add(&format!("ESC{}", esc + 1), &[us, speed, 12.0, 3.0, 40.0].map(Value::from));
            }
        }
        let recording = open(&log.binary).unwrap().recording;
        let speeds = stream(&recording, Quantity::RotorSpeed, "ESC", 0);
        assert_eq!((speeds.len(), speeds.width), (20, 4));
        near(speeds.sample(5), &[100.0, 110.0, 120.0, 130.0].map(|hz| hz * std::f64::consts::TAU));
    }
}

#[test]
fn a_place_on_the_earth_is_a_position_from_the_first_one() {
    let mut log = begun();
    log.define(150, "POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt");
    for step in 0..20_u32 {
        let (us, t) = (41e6 + 1e5 * f64::from(step), f64::from(step));
        let [lat, lng] = if step == 0 { [0.0; 2] } else { [47.0 + 1e-5 * t, 8.0 + 1e-5 * t] };
        log.add("POS", &[us, lat, lng, 440.0 + t, 1.0 + t, 2.0 + t].map(Value::from));
    }
    let recording = open(&log.binary).unwrap().recording;
    let places = stream(&recording, Quantity::Position, "POS", 0);
    assert_eq!(places.len(), 19, "before the first fix it is nowhere");
    near(places.sample(0), &[0.0, 0.0, 3.0]);
    let [north_m, west_m, up_m] = *places.sample(10) else { panic!() };
    // metres of a degree at 47 degrees north, by the tables of WGS 84
    assert!((north_m - 1e-4 * 111_169.0).abs() < 0.01 && (west_m + 1e-4 * 76_056.0).abs() < 0.02);
    assert_eq!(up_m, 13.0);
}

#[test]
fn a_trajectory_in_guided_is_what_was_asked_for() {
    let columns = "TimeUS,Type,pX,pY,pZ,Terrain,vX,vY,vZ,aX,aY,aZ";
    // in hundredths of a metre and upwards; since 4.7 in metres and downwards
    for (multipliers, per_metre, down) in [("F-BBB-BBBBBB", 100.0, -1.0), ("F-000-000000", 1.0, 1.0)] {
        let mut log = begun();
        log.define(151, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
        log.define(152, "UNIT", "QbZ", "TimeUS,Id,Label");
        log.define(153, "MULT", "Qbd", "TimeUS,Id,Mult");
        log.define(150, "GUIP", "QBfffbffffff", columns);
        for (id, label) in [('m', "m"), ('n', "m/s"), ('o', "m/s/s")] {
            log.add("UNIT", &[1.0.into(), f64::from(u32::from(id)).into(), label.into()]);
        }
        for (id, value) in [('0', 1.0), ('B', 0.01)] {
            log.add("MULT", &[1.0, f64::from(u32::from(id)), value].map(Value::from));
        }
        log.add("FMTU", &[1.0.into(), 150.0.into(), "s-mmm-nnnooo".into(), multipliers.into()]);
        let told = |kind: f64, us: f64| {
            let [x, y, z] = [2.0 * per_metre, 3.0 * per_metre, -5.0 * down * per_metre];
            [us, kind, x, y, z, 0.0, x, y, z, x, y, z].map(Value::from)
        };
        for step in 0..20_u32 {
            log.add("GUIP", &told(3.0, 41e6 + 2e4 * f64::from(step)));
        }
        // a speed alone is no trajectory
        log.add("GUIP", &told(4.0, 42e6));
        let recording = open(&log.binary).unwrap().recording;
        for quantity in
            [Quantity::PositionSetpoint, Quantity::VelocitySetpoint, Quantity::AccelerationSetpoint]
        {
            let asked = stream(&recording, quantity, "GUIP", 0);
            assert_eq!(asked.len(), 20);
            near(asked.sample(4), &[2.0, -3.0, 5.0]);
        }
    }
}

#[test]
fn what_is_known_and_adds_nothing_is_told_apart() {
    let mut log = flown();
    log.define(150, "SIDD", "Qfffffffff", "TimeUS,Time,Targ,F,Gx,Gy,Gz,Ax,Ay,Az");
    log.define(151, "NTUN", "Qffffffffff", "TimeUS,DPosX,DPosY,PosX,PosY,DVelX,DVelY,VelX,VelY,DAccX,DAccY");
    log.add("SIDD", &[43e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(Value::from));
    log.add("NTUN", &[43e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(Value::from));
    let report = open(&log.binary).unwrap().report;
    let topics = &report.onboard().unwrap().topics;
    for (name, is_used, is_known) in
        [("SIDD", false, true), ("NTUN", false, true), ("NEWS", false, false), ("IMU", true, true)]
    {
        let topic = topics.iter().find(|topic| topic.name == name).unwrap();
        assert_eq!((topic.is_used, topic.is_known), (is_used, is_known), "{name}");
    }
}

#[test]
fn a_parameter_without_a_value_is_its_default() {
    let mut log = flown();
    log.add("PARM", &[44e6.into(), "MOT_SPIN_MIN".into(), f64::NAN.into(), 0.15.into()]);
    log.add("PARM", &[44e6.into(), "MOT_SPIN_MAX".into(), f64::NAN.into(), f64::NAN.into()]);
    for bytes in [log.binary.as_slice(), log.text.as_bytes()] {
        let recording = open(bytes).unwrap().recording;
        assert!((recording.parameters["MOT_SPIN_MIN"] - 0.15).abs() < 1e-6);
        assert!(recording.defaulted.iter().eq(["MOT_SPIN_MIN"]), "{:?}", recording.defaulted);
        assert!(!recording.parameters.contains_key("MOT_SPIN_MAX"));
        assert_eq!(recording.parameters["FRAME_CLASS"], 1.0, "what is set is no default");
    }
}
