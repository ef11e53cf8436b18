//! The log that the vehicle writes of its own flight, and how it is served. No I/O: what comes over the link is read.

use mavid::log::{self, Input, OpenOptions, Opened};
use mavid::recording::{Quantity, Stream};
use mavid::sitl::{Firmware, Mode, Settings};
use mavid::wire::Frame;
use mavid::wire::file_transfer::{FileSum, Transfer, operation, refusal};

use crate::ground::{Ground, Target, settings};
use crate::{COPTER, PX4};

const FILE_TRANSFER: u8 = 110;
const FILE_TRANSFER_SEED: u8 = 84;
const LOG_REQUEST_LIST: (u8, u8) = (117, 128);
const LOG_REQUEST_DATA: (u8, u8) = (119, 116);

/// An answer with its data.
#[derive(Debug, Clone)]
struct Answer {
    sequence: u16,
    operation: u8,
    offset: u32,
    data: Vec<u8>,
    burst_complete: bool,
}

/// A vehicle on whose files somebody looks.
struct Files {
    ground: Ground,
    sequence: u16,
}

impl Files {
    /// After a flight to a few places and back.
    fn after_a_flight(settings: Settings) -> Self {
        let mut ground = Ground::new(settings);
        ground.set_interval(32, 20.0);
        ground.take_off(3.0);
        let goal = Target::at([2.0, -1.5, -2.5]).message();
        ground.stream(2.0, &goal);
        assert_eq!(ground.set_mode(Mode::Guided), 0, "{:?}", ground.texts());
        ground.stream(8.0, &goal);
        assert_eq!(ground.command(21, [0.0; 7]), 0);
        ground.wait(20.0);
        assert!(!ground.is_armed(), "{:?}", ground.texts());
        Self { ground, sequence: 100 }
    }

    fn ask(&mut self, operation: u8, offset: u32, size: u8, data: &[u8]) -> Vec<Answer> {
        self.sequence += 1;
        self.ask_as(self.sequence, operation, offset, size, data)
    }

    fn ask_as(&mut self, sequence: u16, operation: u8, offset: u32, size: u8, data: &[u8]) -> Vec<Answer> {
        let size = if data.is_empty() { size } else { u8::try_from(data.len()).unwrap() };
        let request = Transfer { offset, size, data, ..Transfer::request(sequence, operation) };
        let mut payload = vec![0, 1, 1];
        payload.extend(request.bytes());
        self.ground.forget();
        self.ground.send_raw(FILE_TRANSFER, FILE_TRANSFER_SEED, &payload);
        self.ground.wait(1.0);
        let own = self.ground.received.iter().filter(|(_, id, _)| *id == u32::from(FILE_TRANSFER));
        own.map(|(_, _, bytes)| {
            let read = Transfer::read(Frame::at_start(bytes).unwrap().payload());
            assert!(read.answers == operation, "{read:?}");
            Answer {
                sequence: read.sequence,
                operation: read.operation,
                offset: read.offset,
                data: read.whole_data(),
                burst_complete: read.burst_complete,
            }
        })
        .collect()
    }

    fn one(&mut self, operation: u8, offset: u32, data: &[u8]) -> Answer {
        let mut answers = self.ask(operation, offset, 239, data);
        assert_eq!(answers.len(), 1, "{answers:?}");
        assert_eq!(answers[0].sequence, self.sequence + 1);
        answers.remove(0)
    }

    fn entries(&mut self, path: &str) -> Vec<String> {
        let answer = self.one(operation::LIST, 0, path.as_bytes());
        assert_eq!(answer.operation, operation::ACK, "{path}: {answer:?}");
        let text = String::from_utf8(answer.data).unwrap();
        text.split_terminator('\0').map(str::to_owned).collect()
    }

    /// The only log: its path and size, by the folders from the root on.
    fn log(&mut self) -> (String, u32) {
        let mut path = String::new();
        loop {
            let entries = self.entries(if path.is_empty() { "/" } else { &path });
            assert_eq!(entries.len(), 1, "{entries:?}");
            let (kind, rest) = entries[0].split_at(1);
            let (name, size) = rest.split_once('\t').unwrap_or((rest, "0"));
            path = format!("{path}/{name}");
            if kind == "F" {
                return (path, size.parse().unwrap());
            }
        }
    }

    /// All of it, burst by burst.
    fn download(&mut self, path: &str, size: u32) -> Vec<u8> {
        let opened = self.one(operation::OPEN, 0, path.as_bytes());
        assert_eq!(opened.data, size.to_le_bytes(), "{opened:?}");
        let mut bytes = Vec::new();
        while bytes.len() < size as usize {
            let answers = self.ask(operation::BURST, u32::try_from(bytes.len()).unwrap(), 239, &[]);
            assert!(answers.last().unwrap().burst_complete);
            for (index, answer) in (1_u16..).zip(answers) {
                assert_eq!(answer.sequence, self.sequence + index);
                if answer.operation == operation::NAK {
                    assert_eq!((answer.data[0], bytes.len()), (refusal::END, size as usize));
                    break;
                }
                assert_eq!(answer.offset as usize, bytes.len());
                bytes.extend(answer.data);
            }
        }
        bytes
    }
}

fn read(bytes: &[u8]) -> Opened {
    log::open(Input::Bytes { name: "of the vehicle", bytes }, &OpenOptions::default()).unwrap()
}

fn stream(opened: &Opened, quantity: Quantity) -> &Stream {
    let found = opened.recording.streams.iter().filter(|(key, _)| key.quantity == quantity);
    found.map(|(_, stream)| stream).max_by_key(|stream| stream.len()).unwrap()
}

fn identification(kind: Firmware) -> Settings {
    let parameters = match kind {
        PX4 => vec![("SDLOG_PROFILE".to_owned(), 9.0)],
        _ => vec![("LOG_BITMASK".to_owned(), 176_126.0 + 1.0 + 262_144.0)],
    };
    Settings { parameters, esc_telemetry: true, ..settings(kind) }
}

#[test]
fn the_log_of_a_flight_comes_by_file_transfer_and_tells_the_same_flight() {
    for kind in [PX4, COPTER] {
        let mut files = Files::after_a_flight(identification(kind));
        let flown: Vec<[f64; 3]> = {
            let own = files.ground.received.iter().filter(|(_, id, _)| *id == 32);
            own.map(|(_, _, bytes)| Frame::at_start(bytes).unwrap().payload().f32s(4)).collect()
        };
        let (path, size) = files.log();
        let bytes = files.download(&path, size);
        assert_eq!(bytes.len(), size as usize);
        let sum = files.one(operation::CRC, 0, path.as_bytes());
        assert_eq!(sum.data, FileSum::of(&bytes).to_le_bytes());
        let opened = read(&bytes);
        assert!(opened.report.losses.is_empty(), "{:?}", opened.report.losses);
        // world: north, west, up
        let position = stream(&opened, Quantity::Position);
        let farthest = |axis: usize| {
            position.values.iter().skip(axis).step_by(position.width).copied().fold(f64::MIN, f64::max)
        };
        let told = |axis: usize, sign: f64| flown.iter().map(|at| sign * at[axis]).fold(f64::MIN, f64::max);
        for (axis, sign) in [(0, 1.0), (1, -1.0), (2, -1.0)] {
            let (own, radio) = (farthest(axis), told(axis, sign));
            assert!((own - radio).abs() < 0.05 && own > 1.4, "{kind:?} axis {axis}: {own} {radio}");
        }
        let rate_hz = |quantity| {
            let stream = stream(&opened, quantity);
            (stream.len() - 1) as f64 / (stream.time_s[stream.len() - 1] - stream.time_s[0])
        };
        let loop_hz = if kind == PX4 { 250.0 } else { 400.0 };
        for quantity in
            [Quantity::AngularRate, Quantity::SpecificForce, Quantity::Attitude, Quantity::TorqueSetpoint]
        {
            assert!((rate_hz(quantity) / loop_hz - 1.0).abs() < 0.02, "{quantity:?} {}", rate_hz(quantity));
        }
        // it carries its weight
        let force = stream(&opened, Quantity::SpecificForce);
        let up_m_s2 = force.values.iter().skip(2).step_by(3).sum::<f64>() / force.len() as f64;
        assert!((9.5..10.1).contains(&up_m_s2), "{up_m_s2}");
        let hovering = stream(&opened, Quantity::RotorSpeed);
        assert!(hovering.sample(hovering.len() / 2).iter().all(|speed| (300.0..1200.0).contains(speed)));
        let armed = stream(&opened, Quantity::Armed);
        assert!(armed.values.contains(&1.0), "{:?}", armed.values);
    }
}

#[test]
fn the_older_messages_give_the_same_bytes() {
    for kind in [PX4, COPTER] {
        let mut files = Files::after_a_flight(settings(kind));
        let (path, size) = files.log();
        let bytes = files.download(&path, size);
        files.ground.forget();
        files.ground.send_raw(LOG_REQUEST_LIST.0, LOG_REQUEST_LIST.1, &[0, 0, 0xFF, 0xFF, 1, 1]);
        files.ground.wait(0.5);
        let entry = files.ground.last(118).unwrap();
        let id = u16::from(kind != PX4);
        assert_eq!((entry.u32(4), entry.u16(8), entry.u16(10), entry.u16(12)), (size, id, 1, id));
        let mut request = [0; 12];
        request[4..8].copy_from_slice(&u32::MAX.to_le_bytes());
        request[8..].copy_from_slice(&[id.to_le_bytes()[0], 0, 1, 1]);
        files.ground.forget();
        files.ground.send_raw(LOG_REQUEST_DATA.0, LOG_REQUEST_DATA.1, &request);
        files.ground.wait(60.0);
        let mut got = Vec::new();
        for (_, _, frame) in files.ground.received.iter().filter(|(_, id, _)| *id == 120) {
            let payload = Frame::at_start(frame).unwrap().payload();
            assert_eq!(payload.u32(0) as usize, got.len());
            got.extend((0..usize::from(payload.u8(6))).map(|at| payload.u8(7 + at)));
        }
        assert!(got == bytes, "{} of {}", got.len(), bytes.len());
    }
}

#[test]
fn a_request_that_comes_twice_is_answered_twice_alike_and_what_is_not_there_is_refused() {
    let mut files = Files::after_a_flight(settings(COPTER));
    let (path, size) = files.log();
    let opened = files.one(operation::OPEN, 0, path.as_bytes());
    let again = files.ask_as(files.sequence, operation::OPEN, 0, 0, path.as_bytes());
    assert_eq!((again[0].sequence, &again[0].data), (opened.sequence, &opened.data));
    let refused = |answer: Answer| (answer.operation, answer.data[0]);
    assert_eq!(refused(files.one(operation::READ, size, &[])), (operation::NAK, refusal::END));
    for outside in ["/etc/passwd", "/APM/LOGS/../../x", "/APM/LOGS/00000009.BIN", ""] {
        let answer = files.one(operation::OPEN, 0, outside.as_bytes());
        assert_eq!(answer.operation, operation::NAK, "{outside}");
    }
    // removing and writing are not known to it
    for forbidden in [6, 7, 8, 11, 12, 13] {
        let answer = files.one(forbidden, 0, path.as_bytes());
        assert_eq!(refused(answer), (operation::NAK, refusal::UNKNOWN));
    }
    files.one(operation::TERMINATE, 0, &[]);
    assert_eq!(refused(files.one(operation::READ, 0, &[])), (operation::NAK, refusal::INVALID_SESSION));
}
