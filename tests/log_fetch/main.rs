//! Logs of the embedded vehicle, listed and fetched over a link that loses a fifth both ways; and what comes of vehicles
//! that lie. No sockets and no real time.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/ground.rs"]
mod ground;
#[path = "../support/mod.rs"]
mod support;

mod faster;

use std::path::{Path, PathBuf};
use std::time::Duration;

use ground::{Ground, settings};
use mavid::autopilot::Autopilot;
use mavid::fetch::{
    Begun, Checked, Dialogue, Download, FetchError, Fetched, List, LogSelection, Part, PartError, Place,
    Protocol, ReadParameters, RemoteLog, SetParameters, Sum, Survey, Uptime,
};
use mavid::log::{self, Input, OpenOptions};
use mavid::sitl::{Firmware, Settings};
use mavid::study::FlightLogs;
use mavid::wire::file_transfer::{FileSum, Transfer, operation, refusal};
use mavid::wire::{ComponentId, Frame, SystemId, Vehicle, checksum};
use mavlink::dialects::ardupilotmega::MavMessage;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const STEP: Duration = Duration::from_millis(5);
/// Longer than any of these conversations.
const END: Duration = Duration::from_secs(1200);
const FTP_SEED: u8 = 84;
const ENTRY_SEED: u8 = 56;
const DATA_SEED: u8 = 134;

fn vehicle(autopilot: Autopilot) -> Vehicle {
    Vehicle { system: SystemId(1), component: ComponentId(1), autopilot, kind: None }
}

/// An empty folder of this test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("log_fetch").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Whoever answers.
trait Other {
    /// A message came; what there is to say by this time.
    fn hear(&mut self, message: Option<&MavMessage>, now: Duration) -> Vec<Vec<u8>>;
}

/// The embedded vehicle.
struct Embedded(Ground);

impl Embedded {
    /// After a short flight.
    fn flown(settings: Settings) -> Self {
        let mut ground = Ground::new(settings);
        ground.set_interval(32, 20.0);
        ground.take_off(2.0);
        assert_eq!(ground.command(21, [0.0; 7]), 0);
        ground.wait(15.0);
        assert!(!ground.is_armed(), "{:?}", ground.texts());
        Self(ground)
    }
}

impl Other for Embedded {
    fn hear(&mut self, message: Option<&MavMessage>, now: Duration) -> Vec<Vec<u8>> {
        let ground = &mut self.0;
        if let Some(message) = message {
            ground.send(message);
        }
        ground.now = ground.now.max(now);
        let out = ground.vehicle.advance(ground.now);
        let link = ground.link;
        out.into_iter().filter(|outgoing| outgoing.link == link).map(|outgoing| outgoing.bytes).collect()
    }
}

/// What lies between: loss both ways, by a seed.
struct Way {
    random: Pcg64,
    loss: f64,
    now: Duration,
    /// data messages that arrived
    arrived: usize,
}

impl Way {
    fn new(seed: u64, loss: f64, other: &Embedded) -> Self {
        Self { random: Pcg64::seed_from_u64(seed), loss, now: other.0.now, arrived: 0 }
    }

    fn of_liar() -> Self {
        Self { random: Pcg64::seed_from_u64(0), loss: 0.0, now: Duration::ZERO, arrived: 0 }
    }

    fn is_lost(&mut self) -> bool {
        self.random.random::<f64>() < self.loss
    }

    /// Until it is done or `enough`; what came is given to `each`.
    fn talk<D: Dialogue>(
        &mut self,
        dialogue: &mut D,
        other: &mut impl Other,
        mut each: impl FnMut(&mut D) -> bool,
    ) -> Result<(), FetchError> {
        let end = self.now + END;
        while !dialogue.is_done() {
            assert!(self.now < end, "no end");
            let mut came = Vec::new();
            while let Some(message) = dialogue.poll(self.now)? {
                if !self.is_lost() {
                    came.extend(other.hear(Some(&message), self.now));
                }
            }
            self.now += STEP;
            came.extend(other.hear(None, self.now));
            for bytes in came {
                if self.is_lost() {
                    continue;
                }
                let frame = Frame::at_start(&bytes).unwrap();
                self.arrived += usize::from(matches!(frame.header().message_id, 110 | 120));
                dialogue.take(self.now, &frame);
            }
            if each(dialogue) {
                return Ok(());
            }
        }
        Ok(())
    }

    fn list(&mut self, other: &mut impl Other, autopilot: Autopilot, protocol: Protocol) -> Vec<RemoteLog> {
        let mut list = List::new(vehicle(autopilot), protocol, LogSelection::All).unwrap();
        self.talk(&mut list, other, |_| false).unwrap();
        list.logs()
    }

    /// All bytes of a log.
    fn bytes(
        &mut self,
        other: &mut impl Other,
        autopilot: Autopilot,
        log: &RemoteLog,
    ) -> Result<(Vec<u8>, Fetched), FetchError> {
        let mut download = Download::new(vehicle(autopilot), log, 0)?;
        let mut bytes = Vec::new();
        self.talk(&mut download, other, |download| {
            bytes.extend(download.ready());
            false
        })?;
        Ok((bytes, download.fetched().unwrap()))
    }
}

/// Seeds of lots of losses.
const LOTS: std::ops::Range<u64> = 7..13;

#[test]
fn both_protocols_bring_the_same_bytes_over_a_link_that_loses_a_fifth_both_ways() {
    for kind in [Firmware::PX4, Firmware::ARDUPILOT_4_7] {
        let autopilot = kind.autopilot();
        let mut embedded = Embedded::flown(settings(kind));
        let mut clean = Way::new(1, 0.0, &embedded);
        let logs = clean.list(&mut embedded, autopilot, Protocol::Ftp);
        let (whole, fetched) = clean.bytes(&mut embedded, autopilot, &logs[0]).unwrap();
        assert_eq!(logs.len(), 1);
        assert_eq!((whole.len() as u64, fetched.grown_to), (logs[0].size, None));
        assert_eq!(fetched.sum, Sum::Is(FileSum::of(&whole)));
        let opened =
            log::open(Input::Bytes { name: "fetched", bytes: &whole }, &OpenOptions::default()).unwrap();
        assert!(opened.report.losses.is_empty() && whole.len() > 50_000, "{}", whole.len());
        for (protocol, piece) in [(Protocol::Ftp, 239), (Protocol::Log, 90)] {
            // one lot of losses may hit the last pieces over and over
            let mut took_s = 0.0;
            for seed in LOTS {
                let mut lossy = Way::new(seed, 0.2, &embedded);
                lossy.now = clean.now;
                let listed = lossy.list(&mut embedded, autopilot, protocol);
                assert_eq!((listed.len(), listed[0].size), (1, whole.len() as u64));
                lossy.arrived = 0;
                let began = lossy.now;
                let (bytes, _) = lossy.bytes(&mut embedded, autopilot, &listed[0]).unwrap();
                took_s += (lossy.now - began).as_secs_f64();
                assert!(bytes == whole, "{kind:?} {protocol:?}");
                // what came once is hardly asked for again
                let needed = whole.len() / piece;
                assert!(lossy.arrived < needed + needed / 3, "{protocol:?}: {} of {needed}", lossy.arrived);
                clean.now = lossy.now;
            }
            let bytes_s = whole.len() as f64 * LOTS.count() as f64 / took_s;
            assert!(bytes_s > 12e3, "{kind:?} {protocol:?}: {bytes_s:.0} bytes/s");
        }
    }
}

#[test]
fn a_vehicle_says_what_it_offers() {
    let mut embedded = Embedded(Ground::of(Firmware::PX4));
    let mut way = Way::new(3, 0.2, &embedded);
    let mut survey = Survey::new(vehicle(Autopilot::Px4));
    way.talk(&mut survey, &mut embedded, |_| false).unwrap();
    let offer = survey.offer();
    assert_eq!((offer.ftp, offer.protocol()), (Some(true), Protocol::Ftp));
    assert_eq!(offer.uid.unwrap().len(), 36);
    // one that does not answer is tried all the same
    let mut survey = Survey::new(vehicle(Autopilot::Px4));
    Way::of_liar().talk(&mut survey, &mut Silent, |_| false).unwrap();
    assert_eq!(survey.offer().ftp, None);
}

/// Fetches into a folder; stops after so many bytes.
fn fetch_into(
    out: &Path,
    (way, other): (&mut Way, &mut impl Other),
    log: &RemoteLog,
    stop_after: u64,
) -> Result<(Begun, Option<(PathBuf, Checked)>), PartError> {
    let mut part = Part::open(out, "1234", log, ".ulg")?;
    let begun = part.begun();
    let mut download = Download::new(vehicle(Autopilot::Px4), log, part.length()).unwrap();
    let mut failure = None;
    way.talk(&mut download, other, |download| {
        failure = part.append(&download.ready()).err();
        failure.is_some() || part.length() >= stop_after
    })
    .unwrap();
    if let Some(failure) = failure {
        return Err(failure);
    }
    let Some(fetched) = download.fetched() else { return Ok((begun, None)) };
    let checked = part.check(&fetched)?;
    Ok((begun, Some((part.finish()?, checked))))
}

#[test]
fn a_download_goes_on_where_it_stopped_and_nothing_is_overwritten() {
    let out = folder("resume");
    let mut embedded = Embedded::flown(settings(Firmware::PX4));
    let mut way = Way::new(5, 0.2, &embedded);
    for protocol in [Protocol::Ftp, Protocol::Log] {
        let log = way.list(&mut embedded, Autopilot::Px4, protocol).remove(0);
        let half = log.size / 2;
        let (begun, done) = fetch_into(&out, (&mut way, &mut embedded), &log, half).unwrap();
        assert_eq!((begun, done), (Begun::Anew, None));
        way.arrived = 0;
        let (begun, done) = fetch_into(&out, (&mut way, &mut embedded), &log, u64::MAX).unwrap();
        let Begun::After(after) = begun else { panic!("{begun:?}") };
        assert!(after + 4096 >= half && after < log.size, "{after} {half}");
        let (path, checked) = done.unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(bytes.len() as u64, log.size);
        match protocol {
            Protocol::Ftp => assert_eq!(checked, Checked::Sum(FileSum::of(&bytes))),
            Protocol::Log => assert_eq!(checked, Checked::Length),
        }
        // the second half alone
        assert!(
            way.arrived < bytes.len() / if protocol == Protocol::Ftp { 300 } else { 110 },
            "{}",
            way.arrived
        );
        // once more: beside the first
        let (_, again) = fetch_into(&out, (&mut way, &mut embedded), &log, u64::MAX).unwrap();
        let second = again.unwrap().0;
        assert!(second != path && second.to_string_lossy().ends_with("-2.ulg"), "{}", second.display());
    }
    let left: Vec<_> = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.len() == 4 && left.iter().all(|name| name.to_string_lossy().ends_with(".ulg")), "{left:?}");
}

#[test]
fn bytes_that_are_not_the_vehicles_are_found_by_the_checksum_and_at_the_seam() {
    let out = folder("damage");
    let mut embedded = Embedded::flown(settings(Firmware::PX4));
    let mut way = Way::new(6, 0.0, &embedded);
    let log = way.list(&mut embedded, Autopilot::Px4, Protocol::Ftp).remove(0);
    let part_of = |out: &Path| {
        let names = std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap().path());
        names.into_iter().find(|path| path.extension().is_some_and(|end| end == "part")).unwrap()
    };
    fetch_into(&out, (&mut way, &mut embedded), &log, 100_000).unwrap();
    let mut bytes = std::fs::read(part_of(&out)).unwrap();
    bytes[500] ^= 1;
    std::fs::write(part_of(&out), &bytes).unwrap();
    let error = fetch_into(&out, (&mut way, &mut embedded), &log, u64::MAX).unwrap_err();
    assert!(matches!(error, PartError::Sum { .. }), "{error}");
    assert!(error.to_string().contains("expected bytes whose checksum is 0x"), "{error}");
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 0);
    // and at the end of what is there
    fetch_into(&out, (&mut way, &mut embedded), &log, 100_000).unwrap();
    let mut bytes = std::fs::read(part_of(&out)).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    std::fs::write(part_of(&out), &bytes).unwrap();
    let error = fetch_into(&out, (&mut way, &mut embedded), &log, u64::MAX).unwrap_err();
    assert!(matches!(error, PartError::Another { .. }), "{error}");
    assert!(part_of(&out).is_file());
    // of another vehicle: begun anew
    let other = Part::open(&out, "another", &log, ".ulg").unwrap();
    assert_eq!((other.begun(), other.length()), (Begun::Anew, 0));
}

#[test]
fn a_log_that_grows_is_fetched_as_long_as_it_was() {
    let parameters = vec![("SDLOG_MODE".to_owned(), 2.0), ("SDLOG_PROFILE".to_owned(), 9.0)];
    let mut embedded = Embedded(Ground::new(Settings { parameters, ..settings(Firmware::PX4) }));
    embedded.0.wait(5.0);
    let mut way = Way::new(2, 0.1, &embedded);
    let log = way.list(&mut embedded, Autopilot::Px4, Protocol::Ftp).remove(0);
    let (bytes, fetched) = way.bytes(&mut embedded, Autopilot::Px4, &log).unwrap();
    assert!(fetched.grown_to.unwrap() > fetched.size && fetched.size == bytes.len() as u64);
    assert!(bytes.len() as u64 >= log.size);
    let opened = log::open(Input::Bytes { name: "growing", bytes: &bytes }, &OpenOptions::default()).unwrap();
    assert!(opened.recording.streams.len() > 5);
}

/// Says nothing.
struct Silent;

impl Other for Silent {
    fn hear(&mut self, _: Option<&MavMessage>, _: Duration) -> Vec<Vec<u8>> {
        Vec::new()
    }
}

#[test]
fn silence_ends_with_what_was_expected() {
    for (protocol, words) in [(Protocol::Ftp, "the list of /APM/LOGS"), (Protocol::Log, "the list of logs")] {
        let mut list = List::new(vehicle(Autopilot::ArduPilot), protocol, LogSelection::All).unwrap();
        let error = Way::of_liar().talk(&mut list, &mut Silent, |_| false).unwrap_err();
        let text = error.to_string();
        assert!(text.contains(words) && text.contains("nothing came in 12 tries"), "{text}");
    }
    for place in [Place::Path("/APM/LOGS/1.BIN".to_owned()), Place::Number(1)] {
        let log = RemoteLog { id: None, place, size: 10, time_s: None };
        let error = Way::of_liar().bytes(&mut Silent, Autopilot::ArduPilot, &log).unwrap_err();
        assert!(matches!(error, FetchError::Silent { .. }), "{error}");
    }
}

/// A frame of system 1 by its payload.
fn frame(id: u8, seed: u8, payload: &[u8]) -> Vec<u8> {
    let length = u8::try_from(payload.len()).unwrap();
    let mut frame = vec![0xFD, length, 0, 0, 0, 1, 1, id, 0, 0];
    frame.extend(payload);
    let sum = checksum(&frame[1..], seed);
    frame.extend(sum.to_le_bytes());
    frame
}

/// Answers the file transfer by a function: what is asked, with its path; the answer's operation, offset and data.
struct Liar<F>(F);

impl<F: FnMut(&Transfer<'_>, &str) -> (u8, u32, Vec<u8>)> Other for Liar<F> {
    fn hear(&mut self, message: Option<&MavMessage>, _: Duration) -> Vec<Vec<u8>> {
        let Some(MavMessage::FILE_TRANSFER_PROTOCOL(data)) = message else { return Vec::new() };
        let mut payload = vec![0, 1, 1];
        payload.extend(data.payload);
        let asked = Transfer::read(mavid::wire::Payload(&payload));
        let path = String::from_utf8(asked.whole_data()).unwrap_or_default();
        let (operation, offset, data) = (self.0)(&asked, &path);
        let answer = Transfer {
            size: u8::try_from(data.len()).unwrap(),
            answers: asked.operation,
            offset,
            data: &data,
            ..Transfer::request(asked.sequence.wrapping_add(1), operation)
        };
        let mut payload = vec![0, 255, 190];
        payload.extend(answer.bytes());
        vec![frame(110, FTP_SEED, &payload)]
    }
}

#[test]
fn names_that_are_no_names_are_left_out() {
    let listed = b"F../../etc/passwd\t9\0F..\0D.\0D..\0F00000001.BIN\t77\0Fa/b.BIN\t1\0F\x1b[2Jx.bin\t1\0Fnotes.txt\t5\0\
        F00000002.bin\tmany\0X\0D\0"
        .to_vec();
    let mut liar = Liar(move |asked: &Transfer<'_>, _: &str| match asked.offset {
        0 => (operation::ACK, 0, listed.clone()),
        _ => (operation::NAK, 0, vec![refusal::END]),
    });
    let mut list = List::new(vehicle(Autopilot::ArduPilot), Protocol::Ftp, LogSelection::All).unwrap();
    Way::of_liar().talk(&mut list, &mut liar, |_| false).unwrap();
    let paths: Vec<_> = list.logs().into_iter().map(|log| (log.id, log.place, log.size)).collect();
    let place = |path: &str| Place::Path(path.to_owned());
    assert_eq!(
        paths,
        [(Some(1), place("/APM/LOGS/00000001.BIN"), 77), (Some(2), place("/APM/LOGS/00000002.bin"), 0)]
    );
    assert_eq!(list.left_out(), 4);
}

/// Lists its logs by messages, from this number on; tells this one as the last.
struct Entries {
    first: u16,
    last_told: u16,
}

impl Other for Entries {
    fn hear(&mut self, message: Option<&MavMessage>, _: Duration) -> Vec<Vec<u8>> {
        const COUNT: u16 = 3;
        let Some(MavMessage::LOG_REQUEST_LIST(asked)) = message else { return Vec::new() };
        let all = (self.first..self.first + COUNT).filter(|id| (asked.start..=asked.end).contains(id));
        let entry = |id: u16| {
            let mut payload =
                [1_700_000_000_u32.to_le_bytes(), (1000 + u32::from(id)).to_le_bytes()].concat();
            payload.extend([id, COUNT, self.last_told].into_iter().flat_map(u16::to_le_bytes));
            frame(118, ENTRY_SEED, &payload)
        };
        all.map(entry).collect()
    }
}

/// ArduPilot counts logs from 1; PX4 from 0, and 1.16 tells their number as the last one.
#[test]
fn logs_are_counted_from_where_the_vehicle_counts() {
    for (first, last_told) in [(1, 3), (5, 7), (0, 2), (0, 3)] {
        let mut list = List::new(vehicle(Autopilot::Px4), Protocol::Log, LogSelection::All).unwrap();
        Way::of_liar().talk(&mut list, &mut Entries { first, last_told }, |_| false).unwrap();
        let sizes: Vec<u64> = list.logs().iter().map(|log| log.size).collect();
        let from = 1000 + u64::from(first);
        assert_eq!(sizes, [from, from + 1, from + 2], "{first} {last_told}");
    }
}

#[test]
fn a_list_without_an_end_ends() {
    let mut count = 0;
    let mut liar = Liar(|_: &Transfer<'_>, _: &str| {
        count += 1;
        (operation::ACK, 0, format!("Fx{count}.bin\t1\0Dd{count}\0").into_bytes())
    });
    let mut list = List::new(vehicle(Autopilot::ArduPilot), Protocol::Ftp, LogSelection::Last).unwrap();
    Way::of_liar().talk(&mut list, &mut liar, |_| false).unwrap();
    assert!(list.logs().len() <= 4096);
}

#[test]
fn lies_about_sizes_are_found_out() {
    let log = |place| RemoteLog { id: None, place, size: 1000, time_s: None };
    let path = || Place::Path("/APM/LOGS/1.BIN".to_owned());
    let fetch = |size: u32, there: u32| {
        let mut liar = Liar(move |asked: &Transfer<'_>, _: &str| match asked.operation {
            operation::OPEN => (operation::ACK, 0, size.to_le_bytes().to_vec()),
            operation::BURST | operation::READ if asked.offset < there => {
                let piece = (there - asked.offset).min(asked.size.into());
                (operation::ACK, asked.offset, vec![7; usize::try_from(piece).unwrap()])
            }
            operation::BURST | operation::READ => (operation::NAK, asked.offset, vec![refusal::END]),
            operation::CRC => (operation::NAK, 0, vec![refusal::UNKNOWN]),
            _ => (operation::ACK, 0, Vec::new()),
        });
        Way::of_liar().bytes(&mut liar, Autopilot::ArduPilot, &log(path()))
    };
    assert_eq!(fetch(u32::MAX, 0).unwrap_err(), FetchError::TooLong { stated: u32::MAX.into() });
    assert_eq!(fetch(5000, 1234).unwrap_err(), FetchError::Short { stated: 5000, came: 1234 });
    // more than was stated is not taken
    let (bytes, fetched) = fetch(500, 10_000).unwrap();
    assert_eq!((bytes.len(), fetched.sum), (500, Sum::NotOffered));
    assert_eq!(fetch(0, 0).unwrap().0.len(), 0);
    let stated = RemoteLog { size: 1 << 40, ..log(Place::Number(1)) };
    let error = Way::of_liar().bytes(&mut Silent, Autopilot::ArduPilot, &stated).unwrap_err();
    assert_eq!(error, FetchError::TooLong { stated: 1 << 40 });
}

/// Has one log of 200 bytes which it says has more.
struct Numbers;

impl Other for Numbers {
    fn hear(&mut self, message: Option<&MavMessage>, _: Duration) -> Vec<Vec<u8>> {
        match message {
            Some(MavMessage::LOG_REQUEST_LIST(_)) => {
                // entries that contradict the first, and one that is not among those stated
                let entry = |id: u16, count: u16, last: u16, size: u32| {
                    let mut payload = 5_u32.to_le_bytes().to_vec();
                    payload.extend(size.to_le_bytes());
                    [id, count, last].iter().for_each(|number| payload.extend(number.to_le_bytes()));
                    frame(118, ENTRY_SEED, &payload)
                };
                vec![entry(3, 1, 3, 500), entry(9, 1, 3, 1), entry(3, 60_000, 60_000, 1)]
            }
            Some(MavMessage::LOG_REQUEST_DATA(data)) => {
                let left = 200_u32.saturating_sub(data.ofs).min(90);
                let mut payload = data.ofs.to_le_bytes().to_vec();
                payload.extend(data.id.to_le_bytes());
                // it says that it has more than a message holds
                payload.push(if left == 90 { 255 } else { u8::try_from(left).unwrap() });
                payload.extend([1; 90]);
                vec![frame(120, DATA_SEED, &payload)]
            }
            _ => Vec::new(),
        }
    }
}

#[test]
fn log_messages_that_contradict_themselves_are_held_to_the_first() {
    let mut way = Way::of_liar();
    let logs = way.list(&mut Numbers, Autopilot::ArduPilot, Protocol::Log);
    let expected = RemoteLog { id: Some(3), place: Place::Number(3), size: 500, time_s: Some(5) };
    assert_eq!(logs, [expected]);
    let error = way.bytes(&mut Numbers, Autopilot::ArduPilot, &logs[0]).unwrap_err();
    assert_eq!(error, FetchError::Short { stated: 500, came: 200 });
}

#[test]
fn parameters_of_logging_are_read_and_set_as_each_autopilot_encodes_them() {
    for (kind, name, wanted) in
        [(Firmware::PX4, "SDLOG_PROFILE", 9.0), (Firmware::ARDUPILOT_4_7, "LOG_BITMASK", 438_271.0)]
    {
        let autopilot = kind.autopilot();
        let mut embedded = Embedded(Ground::of(kind));
        embedded.0.wait(1.0);
        let mut way = Way::new(4, 0.2, &embedded);
        let read = |way: &mut Way, embedded: &mut Embedded| {
            let mut reading = ReadParameters::new(vehicle(autopilot), &[name, "NOT_THERE"]).unwrap();
            way.talk(&mut reading, embedded, |_| false).unwrap();
            reading.known()
        };
        let known = read(&mut way, &mut embedded);
        let plan = kind.stack().log_plan(|name| known.value(name));
        assert_eq!((plan.changes[0].parameter, plan.changes[0].needed), (name, wanted));
        assert_eq!(known.value("NOT_THERE"), None);
        let mut setting = SetParameters::new(vehicle(autopilot), &known, &[(name, wanted)]).unwrap();
        way.talk(&mut setting, &mut embedded, |_| false).unwrap();
        assert_eq!(read(&mut way, &mut embedded).value(name), Some(wanted));
        let mut uptime = Uptime::new(vehicle(autopilot));
        way.talk(&mut uptime, &mut embedded, |_| false).unwrap();
        let up_s = uptime.up_s().unwrap();
        assert!((up_s - embedded.0.now.as_secs_f64()).abs() < 3.0, "{up_s}");
        // one that stays what it was
        let mut setting = SetParameters::new(vehicle(autopilot), &known, &[(name, wanted + 1.0)]).unwrap();
        Way::of_liar().talk(&mut setting, &mut Silent, |_| false).unwrap();
        let failures: Vec<String> = setting.failures().map(|(of, why)| format!("{of}: {why}")).collect();
        assert!(
            failures[0].starts_with(&format!("{name}: expected {name} = {}", wanted + 1.0)),
            "{failures:?}"
        );
    }
}

#[test]
fn the_vehicles_own_log_is_analysed_with_the_recording_if_both_are_of_one_flight() {
    let out = folder("flight_logs");
    let recording = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p01_identify_0_25s.tlog");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg");
    let alone = FlightLogs::of(&recording, None, Some(&other));
    assert_eq!(alone.logs, std::slice::from_ref(&recording));
    assert!(alone.why.unwrap().contains("is not of this flight"));
    let damaged = out.join("none.ulg");
    std::fs::write(&damaged, b"nothing").unwrap();
    let alone = FlightLogs::of(&recording, None, Some(&damaged));
    assert_eq!((alone.logs, alone.why.unwrap().contains("cannot be read")), (vec![recording.clone()], true));
    let kept = FlightLogs::of(&damaged, None, Some(&other));
    assert_eq!((kept.logs, kept.why.unwrap().contains("analysed alone")), (vec![other], true));
    assert_eq!(FlightLogs::of(&recording, None, None), FlightLogs { logs: vec![recording], why: None });
    let Some(shared) = support::shared() else { return };
    let [link, own] = ["ap03.tlog", "ap03.bin"].map(|name| shared.join("onboard/sitl").join(name));
    let both = FlightLogs::of(&link, None, Some(&own));
    assert_eq!(both.logs, [link, own]);
    assert!(both.why.unwrap().contains("are analysed together"));
}
