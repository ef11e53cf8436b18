//! Reads PX4's own logs and holds them to what another reader finds in them.

use crate::support;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mavid::autopilot::VehicleKind;
use mavid::log::ulog::{Message, UlogReader, UlogReport};
use mavid::log::{self, Input, LogError, Loss, OpenOptions, Opened, ReadReport};
use mavid::recording::{Quantity, Recording, RecordingBuilder, Stream, StreamKey};
use serde_json::Value;

/// What the values of one field are.
#[derive(Debug, Default)]
struct Tally {
    count: u64,
    sum: f64,
    min: f64,
    max: f64,
    not_finite: u64,
}

impl Tally {
    fn add(&mut self, value: f64) {
        if !value.is_finite() {
            self.not_finite += 1;
            return;
        }
        (self.min, self.max) =
            if self.count == 0 { (value, value) } else { (self.min.min(value), self.max.max(value)) };
        self.count += 1;
        self.sum += value;
    }
}

/// What a file holds, by the reader beneath all.
#[derive(Debug, Default)]
struct Raw {
    report: UlogReport,
    /// by `topic[instance]`: field and its values
    fields: BTreeMap<String, Vec<(String, Tally)>>,
    parameters: usize,
    texts: usize,
    start_us: u64,
}

fn raw(bytes: &[u8]) -> Raw {
    let mut raw = Raw::default();
    let mut reader = UlogReader::new(bytes);
    while let Some(entry) = reader.next_message().unwrap() {
        match entry.message {
            Message::Begin { start_us } => raw.start_us = start_us,
            Message::Parameter { .. } => raw.parameters += 1,
            Message::Text { .. } => raw.texts += 1,
            Message::Data { subscription, bytes } => {
                let key = format!("{}[{}]", subscription.topic, subscription.instance);
                let fields = raw.fields.entry(key).or_insert_with(|| {
                    let paths = subscription.layout.paths().filter(|path| path != "timestamp");
                    paths.map(|path| (path, Tally::default())).collect()
                });
                for (path, tally) in fields {
                    tally.add(subscription.layout.cell(path).unwrap().read(bytes));
                }
            }
            _ => {}
        }
    }
    raw.report = reader.into_report();
    raw
}

fn logs() -> Option<PathBuf> {
    support::shared().map(|shared| shared.join("onboard/logs"))
}

/// Each log and what is expected of it.
fn expected(folder: &Path) -> Vec<(String, Value)> {
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let all: BTreeMap<String, Value> = serde_json::from_str(&text).unwrap();
    all.into_iter().filter(|(name, _)| name.ends_with(".ulg")).collect()
}

fn close(found: f64, expected: f64, scale: f64) -> bool {
    (found - expected).abs() <= 1e-6 * scale.max(expected.abs()).max(1e-9)
}

#[test]
fn topics_counts_stamps_and_values_are_those_of_another_reader() {
    let Some(folder) = logs() else { return };
    let all = expected(&folder);
    assert!(all.len() >= 12);
    for (name, expected) in all.iter().filter(|(name, _)| name != "derived_corrupt.ulg") {
        let raw = raw(&std::fs::read(folder.join(name)).unwrap());
        assert_eq!(raw.start_us, expected["start_us"].as_u64().unwrap(), "{name}");
        let topics = expected["topics"].as_object().unwrap();
        let found: BTreeMap<String, (u64, Option<(u64, u64)>)> = raw
            .report
            .topics
            .iter()
            .filter(|topic| topic.count > 0)
            .map(|topic| (format!("{}[{}]", topic.topic, topic.instance), (topic.count, topic.stamps_us)))
            .collect();
        assert_eq!(found.keys().collect::<Vec<_>>(), topics.keys().collect::<Vec<_>>(), "{name}");
        for (key, topic) in topics {
            let (count, stamps_us) = found[key];
            let stamps = (topic["first_us"].as_u64().unwrap(), topic["last_us"].as_u64().unwrap());
            assert_eq!((count, stamps_us), (topic["count"].as_u64().unwrap(), Some(stamps)), "{name} {key}");
            for (field, values) in topic["fields"].as_object().unwrap() {
                let Some((_, tally)) = raw.fields[key].iter().find(|(path, _)| path == field) else {
                    assert!(field.contains("_padding"), "{name} {key}.{field}");
                    continue;
                };
                let number = |name: &str| values[name].as_f64();
                assert_eq!(
                    tally.not_finite,
                    values["not_finite"].as_u64().unwrap_or(0),
                    "{name} {key}.{field}"
                );
                let (Some(min), Some(max), Some(mean)) = (number("min"), number("max"), number("mean"))
                else {
                    assert_eq!(tally.count, 0, "{name} {key}.{field}");
                    continue;
                };
                let scale = max.abs().max(min.abs());
                let found = [(tally.min, min), (tally.max, max), (tally.sum / tally.count as f64, mean)];
                assert!(
                    found.iter().all(|(found, expected)| close(*found, *expected, scale)),
                    "{name} {key}.{field}: {tally:?}, expected {values}"
                );
            }
        }
    }
}

#[test]
fn parameters_texts_and_dropouts_are_those_of_another_reader() {
    let Some(folder) = logs() else { return };
    for (name, expected) in expected(&folder) {
        let raw = raw(&std::fs::read(folder.join(&name)).unwrap());
        let number = |key: &str| expected[key].as_u64().unwrap();
        let length = |key: &str| expected[key].as_array().unwrap().len() as u64;
        let parameters = number("initial_parameters") + number("changed_parameters");
        assert_eq!(raw.parameters as u64, parameters, "{name}");
        assert_eq!(raw.texts as u64, number("logged_messages") + number("tagged_messages"), "{name}");
        assert_eq!(raw.report.dropouts, length("dropouts"), "{name}");
    }
}

fn open(path: &Path) -> Opened {
    log::open(path, &OpenOptions::default()).unwrap()
}

fn key(quantity: Quantity, source: &'static str, instance: u8) -> StreamKey {
    StreamKey { quantity, source, instance }
}

fn channel(stream: &Stream, channel: usize) -> Vec<f64> {
    (0..stream.len()).map(|index| stream.sample(index)[channel]).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn what_kind_of_vehicle_wrote_a_log_is_said() {
    let Some(folder) = logs() else { return };
    let kinds = [
        ("px4_2017_x21_quad.ulg", Some(VehicleKind::Multirotor), Some("PX4 (fd483321) on AUAV_X21")),
        ("px4_1112_vtol.ulg", Some(VehicleKind::Vtol), Some("PX4 1.11.2 (8583f1da) on CUBEPILOT_CUBEORANGE")),
        ("not_px4_trig.ulg", None, Some("ULogExampleWriter")),
        ("not_px4_custom_quad.ulg", None, None),
    ];
    for (name, kind, firmware) in kinds {
        let opened = open(&folder.join(name));
        let onboard = opened.report.onboard().unwrap();
        assert_eq!((onboard.kind, onboard.firmware.as_deref()), (kind, firmware), "{name}");
        assert!(opened.report.losses.is_empty(), "{name}");
    }
    // no vehicle at all: what it holds is listed, nothing of it is a stream
    let opened = open(&folder.join("not_px4_trig.ulg"));
    let topics = &opened.report.onboard().unwrap().topics;
    assert!(opened.recording.streams.is_empty() && topics.len() == 2);
    assert!(topics.iter().all(|topic| topic.count == 100 && !topic.is_used && topic.rate_hz().is_some()));
}

/// Quantity, topic and instance of a stream, its samples, and the values of each.
type Found = (Quantity, &'static str, u8, usize, usize);

/// Of each release another set of names.
#[test]
fn streams_are_found_under_the_names_of_each_year() {
    let Some(folder) = logs() else { return };
    use Quantity as Q;
    let expected: [(&str, &[Found]); 5] = [
        (
            "px4_2017_x21_quad.ulg",
            &[
                (Q::Attitude, "vehicle_attitude", 0, 6461, 4),
                (Q::AngularRate, "vehicle_attitude", 0, 6461, 3),
                (Q::AngularRate, "sensor_combined", 0, 17070, 3),
                (Q::SpecificForce, "sensor_combined", 0, 17070, 3),
                (Q::TorqueSetpoint, "actuator_controls_0", 0, 3269, 3),
                (Q::AngularRateSetpoint, "vehicle_rates_setpoint", 0, 6448, 3),
            ],
        ),
        (
            "px4_190_quad_esc_status.ulg",
            &[
                (Q::RotorSpeed, "esc_status", 0, 127, 4),
                (Q::GpsVelocity, "vehicle_gps_position", 0, 179, 3),
                (Q::BarometricHeight, "vehicle_air_data", 0, 110, 1),
                (Q::PositionSetpoint, "vehicle_local_position_setpoint", 0, 318, 3),
            ],
        ),
        (
            "px4_1112_vtol.ulg",
            &[
                (Q::AngularRate, "vehicle_angular_velocity", 0, 1812, 3),
                (Q::SpecificForce, "vehicle_imu", 2, 12, 3),
                (Q::ActuatorCommand, "actuator_outputs", 1, 65, 4),
                (Q::BatteryVoltage, "battery_status", 1, 21, 1),
            ],
        ),
        (
            "px4_113_sitl_tagged.ulg",
            &[
                (Q::SpecificForce, "vehicle_acceleration", 0, 217, 3),
                (Q::ThrustVectorSetpoint, "actuator_controls_0", 0, 217, 3),
            ],
        ),
        (
            "px4_115_sitl_events.ulg",
            &[
                (Q::ActuatorCommand, "actuator_motors", 0, 313, 4),
                (Q::ActuatorCommand, "actuator_outputs", 0, 313, 16),
                (Q::RotorSpeed, "esc_status", 0, 126, 4),
                (Q::TorqueSetpoint, "vehicle_torque_setpoint", 0, 1558, 3),
                (Q::ThrustVectorSetpoint, "vehicle_thrust_setpoint", 0, 1558, 3),
            ],
        ),
    ];
    for (name, streams) in expected {
        let opened = open(&folder.join(name));
        for (quantity, source, instance, count, width) in streams {
            let stream = opened.recording.streams.get(&key(*quantity, source, *instance));
            let found = stream.map(|stream| (stream.len(), stream.width));
            assert_eq!(found, Some((*count, *width)), "{name} {quantity:?} {source}[{instance}]");
        }
    }
}

#[test]
fn frames_and_units_are_those_of_this_crate() {
    let Some(folder) = logs() else { return };
    let flight = open(&folder.join("px4_115_cubeorange_quad.ulg")).recording;
    let of = |quantity, source| &flight.streams[&key(quantity, source, 0)];
    // z is up
    for source in ["sensor_combined", "vehicle_acceleration", "vehicle_imu"] {
        let z = mean(&channel(of(Quantity::SpecificForce, source), 2));
        assert!((9.0..11.0).contains(&z), "{source}: {z}");
    }
    let height = channel(of(Quantity::Position, "vehicle_local_position"), 2);
    assert!(height.iter().copied().fold(0.0, f64::max) > 3.0);
    let force = mean(&channel(of(Quantity::ThrustVectorSetpoint, "vehicle_thrust_setpoint"), 2));
    assert!(force > 0.1, "{force}");
    // motors within 0..1, outputs in microseconds
    let motors = of(Quantity::ActuatorCommand, "actuator_motors");
    assert!(motors.values.iter().filter(|u| u.is_finite()).all(|u| (0.0..=1.0).contains(u)));
    let outputs = &flight.streams[&key(Quantity::ActuatorCommand, "actuator_outputs", 1)];
    assert!(outputs.values.iter().all(|us| (900.0..=2000.0).contains(us)));
    for (quantity, from, to) in [(Quantity::Armed, 0.0, 1.0), (Quantity::LandedState, 1.0, 2.0)] {
        let states = flight.streams.iter().filter(|(key, _)| key.quantity == quantity);
        assert!(states.flat_map(|(_, stream)| &stream.values).all(|state| *state == from || *state == to));
    }
}

/// The quantity of a stream as roll, pitch and yaw or as it is, at other times.
struct Track<'a>(&'a Stream);

impl Track<'_> {
    /// By straight lines; `None` outside.
    fn at(&self, time_s: f64) -> Option<Vec<f64>> {
        let after = self.0.time_s.partition_point(|known| *known <= time_s);
        let before = after.checked_sub(1)?;
        let span = self.0.time_s.get(after)? - self.0.time_s[before];
        let share = (time_s - self.0.time_s[before]) / span;
        let (a, b) = (self.0.sample(before), self.0.sample(after));
        (span < 0.5).then(|| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect())
    }
}

/// How far two logs of one thing are apart, rms over channels and time, where the second begins `later_s` before.
fn apart(a: &Stream, b: &Stream, later_s: f64) -> f64 {
    let other = Track(b);
    let (mut sum, mut count) = (0.0, 0);
    for (index, time_s) in a.time_s.iter().enumerate() {
        let Some(values) = other.at(time_s + later_s) else { continue };
        let width = a.width.min(values.len());
        let squares = a.sample(index)[..width].iter().zip(&values).map(|(a, b)| (a - b).powi(2));
        let square: f64 = squares.sum();
        if square.is_finite() {
            sum += square;
            count += width;
        }
    }
    if count < 200 { f64::INFINITY } else { (sum / count as f64).sqrt() }
}

/// How much later the second log's clock runs, by where both fit best.
fn later_s(a: &Stream, b: &Stream) -> f64 {
    let best = |from: i32, to: i32, step_s: f64, about_s: f64| {
        let shifts = (from..=to).map(|step| about_s + step_s * f64::from(step));
        shifts.min_by(|x, y| apart(a, b, *x).total_cmp(&apart(a, b, *y))).unwrap()
    };
    let coarse = best(-60, 300, 0.25, 0.0);
    best(-50, 50, 0.01, coarse)
}

/// Both logs of one flight say the same, in the same frames and units.
#[test]
fn the_on_board_log_agrees_with_the_telemetry_of_the_same_flight() {
    let Some(shared) = support::shared() else { return };
    for flight in ["px01", "px02", "px07", "px09", "px11"] {
        let folder = shared.join("onboard/sitl");
        let on_board = open(&folder.join(format!("{flight}.ulg"))).recording;
        let telemetry = open(&folder.join(format!("{flight}.tlog"))).recording;
        let ours = |quantity, source| &on_board.streams[&key(quantity, source, 0)];
        let theirs = |quantity, source| &telemetry.streams[&key(quantity, source, 0)];
        let position = ours(Quantity::Position, "vehicle_local_position");
        let later = later_s(position, theirs(Quantity::Position, "LOCAL_POSITION_NED"));
        let pairs = [
            (Quantity::Position, "vehicle_local_position", "LOCAL_POSITION_NED", 0.05),
            (Quantity::Velocity, "vehicle_local_position", "LOCAL_POSITION_NED", 0.05),
            (Quantity::Attitude, "vehicle_attitude", "ATTITUDE_QUATERNION", 0.01),
            (Quantity::AngularRate, "vehicle_angular_velocity", "ATTITUDE_QUATERNION", 0.15),
            (Quantity::SpecificForce, "sensor_combined", "HIGHRES_IMU", 2.5),
            (Quantity::ActuatorCommand, "actuator_outputs", "SERVO_OUTPUT_RAW", 60.0),
        ];
        for (quantity, source, message, most) in pairs {
            let rms = apart(ours(quantity, source), theirs(quantity, message), later);
            println!("{flight} {quantity:?}: {rms:.4} ({later:.2} s)");
            assert!(rms < most, "{flight} {quantity:?}: {rms}");
        }
        assert_eq!(on_board.parameters.get("THR_MDL_FAC"), telemetry.parameters.get("THR_MDL_FAC"));
        assert!(on_board.parameters.keys().all(|name| !name.starts_with("SIH_")));
    }
}

/// Every topic's message of a log, by topic and bytes.
fn messages(bytes: &[u8]) -> BTreeMap<(Arc<str>, u8, Vec<u8>), u64> {
    let mut found = BTreeMap::new();
    let mut reader = UlogReader::new(bytes);
    while let Some(entry) = reader.next_message().unwrap() {
        if let Message::Data { subscription, bytes } = entry.message {
            let key = (Arc::clone(&subscription.topic), subscription.instance, bytes.to_vec());
            *found.entry(key).or_default() += 1;
        }
    }
    found
}

/// Where the messages of a log begin.
fn places(bytes: &[u8]) -> Vec<usize> {
    let (mut places, mut reader) = (Vec::new(), UlogReader::new(bytes));
    while let Some(entry) = reader.next_message().unwrap() {
        places.push(usize::try_from(entry.offset).unwrap());
    }
    places
}

/// A fixed stream of numbers that look like chance.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound
    }
}

/// What a fault does to a file, whose definitions end before the first of these places between two messages.
type Fault = fn(&mut Numbers, &mut Vec<u8>, between: &[usize]);

const FAULTS: [(&str, Fault); 5] = [
    ("zeros", |numbers, bytes, between| {
        let at = between[0] + numbers.below(bytes.len() - between[0] - 5000);
        let length = 40 + numbers.below(4000);
        bytes[at..at + length].fill(0);
    }),
    ("junk put in", |numbers, bytes, between| {
        let at = between[0] + numbers.below(bytes.len() - between[0]);
        let junk: Vec<u8> =
            (0..1 + numbers.below(300)).map(|_| numbers.below(256).to_le_bytes()[0]).collect();
        bytes.splice(at..at, junk);
    }),
    ("a piece taken out", |numbers, bytes, between| {
        let at = between[0] + numbers.below(bytes.len() - between[0] - 5000);
        bytes.drain(at..at + 1 + numbers.below(3000));
    }),
    // whole messages: without a checksum, two halves of messages of one topic are a message
    ("two pieces in the other order", |numbers, bytes, between| {
        let middle = between[numbers.below(between.len())];
        bytes[between[0]..].rotate_left(middle - between[0]);
    }),
    ("a cut", |numbers, bytes, between| {
        bytes.truncate(between[0] + numbers.below(bytes.len() - between[0]));
    }),
];

/// Bytes that a report says are lost.
fn lost_bytes(losses: &[Loss]) -> u64 {
    losses
        .iter()
        .map(|loss| match loss {
            Loss::Skipped { bytes, .. } | Loss::CutOff { bytes, .. } => *bytes,
            _ => 0,
        })
        .sum()
}

#[test]
fn damage_is_counted_and_nothing_is_read_that_was_not_written() {
    let flight = flight();
    let whole = messages(&flight);
    let total: u64 = whole.values().sum();
    let between: Vec<usize> = places(&flight).into_iter().filter(|place| *place > flight.len() / 3).collect();
    let (mut numbers, mut spliced) = (Numbers(1), 0);
    for round in 0..200 {
        let (name, fault) = FAULTS[round % FAULTS.len()];
        let mut damaged = flight.clone();
        fault(&mut numbers, &mut damaged, &between);
        let found = messages(&damaged);
        let strange = found.iter().find(|(key, count)| whole.get(*key).is_none_or(|known| *count > known));
        // without a checksum, two halves of messages of one topic that happen to fit are a message
        if name == "a piece taken out" && strange.is_some() {
            spliced += 1;
            continue;
        }
        assert!(strange.is_none(), "round {round}, {name}: {strange:?}");
        let opened = log::open(Input::Bytes { name, bytes: &damaged }, &OpenOptions::default()).unwrap();
        let read: u64 = found.values().sum();
        let losses = &opened.report.losses;
        // a cut between two messages loses nothing that the file says
        assert!(read == total || !losses.is_empty() || name == "a cut", "round {round}, {name}: {read}");
        assert!(
            read as f64 > 0.9 * total as f64 || name == "a cut",
            "round {round}, {name}: {read} of {total}"
        );
        assert!(lost_bytes(losses) < 20_000, "round {round}, {name}: {losses:?}");
    }
    assert!(spliced <= 1, "{spliced}");
}

/// A piece of a simulated flight of PX4's.
fn flight() -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg")).unwrap()
}

#[test]
fn a_log_cut_anywhere_is_read_up_to_there() {
    let flight = flight();
    let all: u64 = messages(&flight).values().sum();
    let mut before = 0;
    for length in (0..flight.len()).step_by(997).chain([flight.len()]) {
        let input = Input::Bytes { name: "cut", bytes: &flight[..length] };
        match log::open(input, &OpenOptions::default()) {
            Ok(opened) => {
                let report = opened.report.onboard().unwrap();
                let count = report.topics.iter().map(|topic| topic.count).sum();
                assert!(before <= count && count <= all, "{length}");
                before = count;
            }
            Err(error) => {
                assert!(length < 16, "{length}: {error}");
                assert!(matches!(error, LogError::UnknownFormat { .. } | LogError::WrongContent { .. }));
            }
        }
    }
    assert_eq!(before, all);
}

#[test]
fn logs_behind_each_other_are_one_recording_with_a_restart() {
    let flight = flight();
    let single = log::open(Input::Bytes { name: "one", bytes: &flight }, &OpenOptions::default()).unwrap();
    let twice = [flight.clone(), flight].concat();
    let double = log::open(Input::Bytes { name: "two", bytes: &twice }, &OpenOptions::default()).unwrap();
    assert!(double.report.losses.is_empty());
    assert_eq!(double.recording.clock_resets_s.len(), 1);
    let attitude = key(Quantity::Attitude, "vehicle_attitude", 0);
    let (one, two) = (&single.recording.streams[&attitude], &double.recording.streams[&attitude]);
    assert_eq!(two.len(), 2 * one.len());
    assert!(two.time_s.windows(2).all(|pair| pair[1] > pair[0]));
}

#[test]
fn the_damaged_logs_that_others_keep_are_read_and_their_loss_said() {
    let Some(folder) = logs() else { return };
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    for (damaged, whole) in [
        ("derived_corrupt.ulg", "px4_160_quad_appended.ulg"),
        ("derived_truncated.ulg", "px4_190_quad_esc_status.ulg"),
    ] {
        let known = messages(&read(whole));
        let found = messages(&read(damaged));
        assert!(found.keys().all(|key| known.contains_key(key)), "{damaged}");
        assert!(!open(&folder.join(damaged)).report.losses.is_empty(), "{damaged}");
    }
    // more than another reader finds: only what the damage covers is gone
    let found: u64 = messages(&read("derived_corrupt.ulg")).values().sum();
    assert!(found > 6700, "{found}");
}

/// A recording to the last bit, and what was met.
fn bits(recording: &Recording, report: &ReadReport) -> (Vec<(StreamKey, Vec<u64>)>, String) {
    let of = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let stream =
        |(key, stream): (&StreamKey, &Stream)| (*key, [of(&stream.time_s), of(&stream.values)].concat());
    let Recording { parameters, parameter_changes, clock_resets_s, estimator_resets_s, texts, .. } =
        recording;
    let rest = format!(
        "{parameters:?} {parameter_changes:?} {clock_resets_s:?} {estimator_resets_s:?} {texts:?} {report:?}"
    );
    (recording.streams.iter().map(stream).collect(), rest)
}

/// That the log as a whole is what its messages say one by one.
fn is_read_whole(name: &str, bytes: &[u8]) {
    let input = Input::Bytes { name, bytes };
    let opened = log::open(input, &OpenOptions::default()).unwrap();
    let mut builder = RecordingBuilder::new();
    let mut report = log::stream(input, &OpenOptions::default(), &mut |_, event| builder.add(event)).unwrap();
    let (recording, repairs) = builder.finish();
    let count = repairs.values().map(|repair| repair.impossible).sum();
    report.losses.extend((count > 0).then_some(Loss::Impossible { count }));
    report.streams = repairs;
    assert_eq!(bits(&opened.recording, &opened.report), bits(&recording, &report), "{name}");
}

#[test]
fn a_log_that_is_read_whole_is_what_its_messages_say_one_by_one() {
    let flight = flight();
    is_read_whole("flight", &flight);
    is_read_whole("two", &[flight.clone(), flight.clone()].concat());
    let places = places(&flight);
    let between: Vec<usize> = places.iter().copied().filter(|place| *place > flight.len() / 3).collect();
    let mut numbers = Numbers(5);
    for round in 0..60 {
        let (name, fault) = FAULTS[round % FAULTS.len()];
        let mut damaged = flight.clone();
        fault(&mut numbers, &mut damaged, &between);
        is_read_whole(name, &damaged);
    }
    // half of a topic's messages under another number, and a parameter that changes among them
    let name = b"vehicle_attitude";
    let is_named = |at: &&usize| flight[**at + 2] == b'A' && flight[**at + 6..].starts_with(name);
    let subscribed = *places.iter().find(is_named).unwrap();
    let (id, length) = ([flight[subscribed + 4], flight[subscribed + 5]], 3 + 3 + name.len());
    let first = *places.iter().find(|at| flight[**at + 2] == b'D').unwrap();
    let mut both = flight[..first].to_vec();
    let mut again = flight[subscribed..subscribed + length].to_vec();
    again[4..6].copy_from_slice(&500_u16.to_le_bytes());
    both.extend(again);
    for (index, pair) in places.windows(2).filter(|pair| pair[0] >= first).enumerate() {
        let mut message = flight[pair[0]..pair[1]].to_vec();
        if message[2] == b'D' && message[3..5] == id && index % 2 == 0 {
            message[3..5].copy_from_slice(&500_u16.to_le_bytes());
        }
        both.extend(message);
        if index % 1000 == 999 {
            let changed = [b"\x11\x00P\x0cfloat A_GAIN".as_slice(), &(index as f32).to_le_bytes()].concat();
            both.extend(changed);
        }
    }
    is_read_whole("two numbers", &both);
    let input = Input::Bytes { name: "two numbers", bytes: &both };
    let opened = log::open(input, &OpenOptions::default()).unwrap();
    assert!(!opened.recording.parameter_changes.is_empty());
}
