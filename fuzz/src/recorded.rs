//! The flights that are damaged, and how a log is read as the program reads it.

use std::path::PathBuf;
use std::sync::LazyLock;

use mavid::config::parse_vehicle;
use mavid::log::{self, OpenOptions, Opened, TlogReader};
use mavid::vehicle::Vehicle;

use super::damage::Record;

/// A recording of the project with its vehicle, and the least piece of it that can be used.
#[derive(Debug)]
pub struct Recorded {
    pub records: Vec<Record>,
    pub vehicle: Vehicle,
}

impl Recorded {
    fn of(log: &[u8], vehicle: &str, seconds: u64) -> Self {
        let mut reader = TlogReader::new(log);
        let mut records: Vec<Record> = Vec::new();
        while let Ok(Some(record)) = reader.next_record() {
            let start_us = records.first().map_or(record.stamp_us, |first| first.stamp_us);
            if record.stamp_us > start_us + seconds * 1_000_000 {
                break;
            }
            records.push(Record { stamp_us: record.stamp_us, bytes: record.frame.bytes().to_vec() });
        }
        Self {
            records,
            vehicle: parse_vehicle(vehicle, "fixture").expect("a vehicle of the project").vehicle,
        }
    }
}

macro_rules! recorded {
    ($log:literal, $vehicle:literal, $seconds:literal) => {
        LazyLock::new(|| {
            Recorded::of(
                include_bytes!(concat!("../../fixtures/", $log)),
                include_str!(concat!("../../fixtures/", $vehicle)),
                $seconds,
            )
        })
    };
}

/// An independent simulator's, ArduPilot's and PX4's; the first is long enough to be explained.
pub static FLIGHTS: [LazyLock<Recorded>; 3] = [
    recorded!("p04_identify_10_22s.tlog", "p04_vehicle.toml", 10),
    recorded!("ap_baseline_70_79s.tlog", "ardupilot-quad.toml", 8),
    recorded!("px4_baseline_40_46s.tlog", "px4-sih.toml", 6),
];

/// A log in a file, gone when this goes.
#[derive(Debug)]
pub struct File(PathBuf);

impl File {
    pub fn new(log: &[u8]) -> Self {
        let memory = PathBuf::from("/dev/shm");
        let base = if memory.is_dir() { memory } else { std::env::temp_dir() };
        let name = format!("mavid-fuzz-{}-{:?}.tlog", std::process::id(), std::thread::current().id());
        let path = base.join(name);
        std::fs::write(&path, log).expect("a file");
        Self(path)
    }

    /// As the verbs read it, without a system named; `None` where it is refused with words.
    pub fn load(&self) -> Option<Opened> {
        log::open(&self.0, &OpenOptions::default())
            .map_err(|error| assert!(!error.to_string().is_empty()))
            .ok()
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// No number of a page, a document or a file is one that is none, but where it says so in words.
pub fn is_readable(page: &str) {
    assert!(!page.trim().is_empty());
    let controls = page.chars().any(|c| c.is_control() && c != '\n');
    assert!(!controls, "a control character in {page:?}");
}
