//! A log whose file transfer is slow: log messages are tried, and the faster way stays.

use std::collections::VecDeque;
use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::fetch::{Begun, Checked, Chosen, Download, Fetched, OtherWay, Part, Protocol, RemoteLog, Sum};
use mavid::sitl::Firmware;
use mavid::wire::Frame;
use mavid::wire::file_transfer::FileSum;
use mavlink::dialects::ardupilotmega::MavMessage;

use crate::ground::settings;
use crate::{DATA_SEED, Embedded, Other, Way, folder, frame, vehicle};

/// FILE_TRANSFER_PROTOCOL, LOG_ENTRY and LOG_DATA.
const FILE_TRANSFER: u32 = 110;
const LOG_ENTRY: u32 = 118;
const LOG_DATA: u32 = 120;
/// 239 bytes in it are 4.8 kB/s.
const SLOW: Duration = Duration::from_millis(50);
/// 90 bytes in it are 900 bytes/s.
const SLOWER: Duration = Duration::from_millis(100);

/// Messages of one kind that leave one by one.
struct Queue {
    id: u32,
    every: Duration,
    next: Duration,
    waiting: VecDeque<Vec<u8>>,
}

impl Queue {
    fn new(id: u32, every: Duration) -> Self {
        Self { id, every, next: Duration::ZERO, waiting: VecDeque::new() }
    }
}

/// The embedded vehicle, some of whose messages leave slowly or otherwise than it wrote them.
struct Slow<'a, F> {
    embedded: &'a mut Embedded,
    queues: Vec<Queue>,
    change: F,
}

impl<'a, F: FnMut(Vec<u8>) -> Option<Vec<u8>>> Slow<'a, F> {
    fn new(embedded: &'a mut Embedded, queues: Vec<Queue>, change: F) -> Self {
        Self { embedded, queues, change }
    }
}

impl<F: FnMut(Vec<u8>) -> Option<Vec<u8>>> Other for Slow<'_, F> {
    fn hear(&mut self, message: Option<&MavMessage>, now: Duration) -> Vec<Vec<u8>> {
        let ends = match message {
            Some(MavMessage::LOG_REQUEST_END(_)) => LOG_DATA,
            Some(MavMessage::FILE_TRANSFER_PROTOCOL(_)) => FILE_TRANSFER,
            _ => 0,
        };
        // a vehicle that sends slowly has not made what it is told not to send
        self.queues.iter_mut().filter(|queue| queue.id == ends).for_each(|queue| queue.waiting.clear());
        let mut out = Vec::new();
        for bytes in self.embedded.hear(message, now).into_iter().filter_map(&mut self.change) {
            let id = Frame::at_start(&bytes).unwrap().header().message_id;
            match self.queues.iter_mut().find(|queue| queue.id == id) {
                Some(queue) => queue.waiting.push_back(bytes),
                None => out.push(bytes),
            }
        }
        for queue in &mut self.queues {
            while queue.next <= now
                && let Some(bytes) = queue.waiting.pop_front()
            {
                queue.next = now + queue.every;
                out.push(bytes);
            }
        }
        out
    }
}

/// The log of a short flight by file transfer at full speed, with its bytes.
fn flown(kind: Firmware) -> (Embedded, Way, RemoteLog, Vec<u8>) {
    let mut embedded = Embedded::flown(settings(kind));
    let mut way = Way::new(1, 0.0, &embedded);
    let log = way.list(&mut embedded, kind.autopilot(), Protocol::Ftp).remove(0);
    let (whole, _) = way.bytes(&mut embedded, kind.autopilot(), &log).unwrap();
    (embedded, way, log, whole)
}

/// Fetches it by the faster way.
fn fetch(
    way: &mut Way,
    other: &mut impl Other,
    autopilot: Autopilot,
    log: &RemoteLog,
) -> (Vec<u8>, Fetched, Protocol, Option<Chosen>) {
    let mut download = Download::by_the_faster(vehicle(autopilot), log, 0).unwrap();
    let (mut bytes, mut chosen) = (Vec::new(), None);
    way.talk(&mut download, other, |download| {
        bytes.extend(download.ready());
        let told = download.chosen();
        assert!(told.is_none() || chosen.is_none(), "told once");
        chosen = chosen.take().or(told);
        false
    })
    .unwrap();
    (bytes, download.fetched().unwrap(), download.protocol(), chosen)
}

#[test]
fn a_slow_file_transfer_gives_way_to_faster_log_messages_and_the_checksum_is_still_asked_for() {
    for kind in [Firmware::PX4, Firmware::ARDUPILOT_4_7] {
        let (mut embedded, mut way, log, whole) = flown(kind);
        for loss in [0.0, 0.2] {
            let mut lossy = Way { loss, ..Way::new(11, loss, &embedded) };
            lossy.now = way.now;
            let mut slow = Slow::new(&mut embedded, vec![Queue::new(FILE_TRANSFER, SLOW)], Some);
            let began = lossy.now;
            let (bytes, fetched, protocol, chosen) = fetch(&mut lossy, &mut slow, kind.autopilot(), &log);
            let took = lossy.now - began;
            assert!(bytes == whole, "{kind:?} {loss}");
            assert_eq!((fetched.size, fetched.grown_to), (whole.len() as u64, None));
            assert_eq!((protocol, fetched.sum), (Protocol::Log, Sum::Is(FileSum::of(&whole))));
            let chosen = chosen.unwrap();
            let OtherWay::Brings(log_bytes_s) = chosen.log else { panic!("{chosen}") };
            assert!(chosen.ftp_bytes_s < 5e3 && log_bytes_s > 2.0 * chosen.ftp_bytes_s, "{chosen}");
            assert!(chosen.to_string().ends_with("kB/s: going on by log messages"), "{chosen}");
            // by file transfer alone
            let slow_s = whole.len() as f64 / 4.8e3;
            assert!(took.as_secs_f64() < 0.7 * slow_s, "{took:?} of {slow_s} s");
            way.now = lossy.now;
        }
    }
}

#[test]
fn a_file_transfer_that_is_fast_enough_or_faster_stays() {
    let kind = Firmware::ARDUPILOT_4_7;
    let (mut embedded, mut way, log, whole) = flown(kind);
    let (bytes, fetched, protocol, chosen) = fetch(&mut way, &mut embedded, kind.autopilot(), &log);
    assert_eq!((protocol, chosen), (Protocol::Ftp, None));
    assert!(bytes == whole && fetched.sum == Sum::Is(FileSum::of(&whole)));
    let queues = vec![Queue::new(FILE_TRANSFER, SLOW), Queue::new(LOG_DATA, SLOWER)];
    let mut slow = Slow::new(&mut embedded, queues, Some);
    let (bytes, fetched, protocol, chosen) = fetch(&mut way, &mut slow, kind.autopilot(), &log);
    let chosen = chosen.unwrap();
    assert_eq!((protocol, chosen.protocol), (Protocol::Ftp, Protocol::Ftp));
    assert!(matches!(chosen.log, OtherWay::Brings(bytes_s) if bytes_s < chosen.ftp_bytes_s), "{chosen}");
    assert!(chosen.to_string().ends_with("going on by file transfer"), "{chosen}");
    assert!(bytes == whole && fetched.sum == Sum::Is(FileSum::of(&whole)));
}

#[test]
fn log_messages_that_are_no_way_for_this_log_are_left() {
    let kind = Firmware::ARDUPILOT_4_7;
    let (mut embedded, mut way, log, whole) = flown(kind);
    type Change = fn(Vec<u8>) -> Option<Vec<u8>>;
    let silent: Change = |bytes| {
        let is_entry = Frame::at_start(&bytes).unwrap().header().message_id == LOG_ENTRY;
        (!is_entry).then_some(bytes)
    };
    // the same with other bytes
    let another: Change = |bytes| {
        let framed = Frame::at_start(&bytes).unwrap();
        if framed.header().message_id != LOG_DATA {
            return Some(bytes);
        }
        let mut payload = framed.payload().0.to_vec();
        payload.resize(97, 0);
        payload[20] ^= 0x55;
        Some(frame(120, DATA_SEED, &payload))
    };
    for (change, why) in
        [(silent, "no list of them within 5 s"), (another, "their bytes are not those of the file")]
    {
        let mut slow = Slow::new(&mut embedded, vec![Queue::new(FILE_TRANSFER, SLOW)], change);
        let (bytes, fetched, protocol, chosen) = fetch(&mut way, &mut slow, kind.autopilot(), &log);
        let chosen = chosen.unwrap();
        assert_eq!((protocol, &chosen.log), (Protocol::Ftp, &OtherWay::None(why.to_owned())), "{chosen}");
        assert!(bytes == whole && fetched.sum == Sum::Is(FileSum::of(&whole)), "{chosen}");
    }
}

#[test]
fn a_download_goes_on_where_it_stopped_by_whichever_way() {
    let kind = Firmware::ARDUPILOT_4_7;
    let (mut embedded, mut way, log, whole) = flown(kind);
    let out = folder("faster");
    let half = log.size / 2;
    // half of it takes long as well
    let mut slow = Slow::new(&mut embedded, vec![Queue::new(FILE_TRANSFER, 4 * SLOW)], Some);
    for (stop_after, begins) in [(half, None), (u64::MAX, Some(half))] {
        let mut part = Part::open(&out, "1234", &log, ".bin").unwrap();
        match (begins, part.begun()) {
            (None, begun) => assert_eq!(begun, Begun::Anew),
            (Some(half), Begun::After(bytes)) => assert!(bytes + 4096 >= half, "{bytes} {half}"),
            (Some(_), begun) => panic!("{begun:?}"),
        }
        let mut download = Download::by_the_faster(vehicle(kind.autopilot()), &log, part.length()).unwrap();
        way.talk(&mut download, &mut slow, |download| {
            part.append(&download.ready()).unwrap();
            part.length() >= stop_after
        })
        .unwrap();
        assert_eq!(download.protocol(), Protocol::Log);
        if begins.is_some() {
            let fetched = download.fetched().unwrap();
            assert_eq!(part.check(&fetched).unwrap(), Checked::Sum(FileSum::of(&whole)));
            assert!(std::fs::read(part.finish().unwrap()).unwrap() == whole);
        }
    }
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1);
}
