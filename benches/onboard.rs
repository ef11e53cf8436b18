//! How fast logs that a vehicle wrote itself are read, beside pymavlink on the same messages.
//!
//! `cargo bench --bench onboard [-- LOG.bin]`: whole messages of the log are repeated, their times shifted, until the file
//! has 500 MB; it is written to `target/`. Without a path, ArduPilot's simulated flight of `../shared` is taken where it
//! is there. `MAVID_PYTHON` names a Python that has pymavlink (default `python3`); it reads the log itself, which is short.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use mavid::log::{self, DataflashReader, OpenOptions};

const FILE_BYTES: usize = 500_000_000;
const REPEATS: usize = 5;
/// Between two repetitions, microseconds.
const PAUSE_US: u64 = 10_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let log = match std::env::args().skip(1).find(|argument| !argument.starts_with("--")) {
        Some(path) => PathBuf::from(path),
        None => root.join("../shared/onboard/sitl/ap01.bin"),
    };
    if !log.is_file() {
        writeln!(out, "expected a log, {} is none: nothing measured", log.display())?;
        return Ok(());
    }
    let long = root.join("target/bench-onboard.bin");
    let bytes = repeated(&std::fs::read(&log)?);
    std::fs::write(&long, &bytes)?;
    let megabytes = bytes.len() as f64 * 1e-6;
    drop(bytes);
    writeln!(out, "{} ({megabytes:.0} MB of {})", long.display(), log.display())?;
    let raw = median(|| {
        let mut reader = DataflashReader::new(std::fs::File::open(&long)?);
        while reader.next_message()?.is_some() {}
        Ok(())
    })?;
    let streamed = median(|| Ok(log::stream(&long, &OpenOptions::default(), &mut |_, _| ())?))?;
    let held = median(|| Ok(log::open(&long, &OpenOptions::default())?))?;
    for (what, seconds) in [("messages", raw), ("samples, streamed", streamed), ("whole recording", held)] {
        writeln!(out, "{what:<20} {:>8.0} MB/s", megabytes / seconds)?;
    }
    std::fs::remove_file(&long)?;
    match pymavlink(&log) {
        Ok(theirs) => {
            let times = megabytes / held / theirs;
            writeln!(
                out,
                "{:<20} {theirs:>8.2} MB/s: the whole recording is read {times:.0} times as fast",
                "pymavlink"
            )?;
        }
        Err(error) => writeln!(out, "pymavlink not measured: {error}")?,
    }
    Ok(())
}

/// Median seconds of a few runs, the first of which warms the cache and does not count.
fn median<T>(mut run: impl FnMut() -> Result<T, Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    run()?;
    let mut times_s = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        run()?;
        times_s.push(start.elapsed().as_secs_f64());
    }
    times_s.sort_by(f64::total_cmp);
    Ok(times_s[REPEATS / 2])
}

/// The log's messages again and again, each round after the one before it.
fn repeated(log: &[u8]) -> Vec<u8> {
    let mut reader = DataflashReader::new(log);
    // bytes of each message, and where its stamps are
    let mut messages: Vec<(Vec<u8>, Vec<usize>)> = Vec::new();
    let mut last_us = 0;
    let mut first_us = u64::MAX;
    while let Ok(Some(message)) = reader.next_message() {
        let Ok(at) = usize::try_from(message.offset) else { break };
        let fields = message.definition.fields.iter();
        let stamps: Vec<usize> = fields
            .filter(|field| ["TimeUS", "SampleUS"].contains(&field.name.as_str()))
            .map(|field| field.offset)
            .collect();
        let bytes = log[at..at + message.definition.bytes].to_vec();
        for stamp in &stamps {
            let us = stamp_of(&bytes, *stamp);
            (first_us, last_us) = (first_us.min(us), last_us.max(us));
        }
        messages.push((bytes, stamps));
    }
    let span_us = last_us.saturating_sub(first_us) + PAUSE_US;
    let mut long = Vec::with_capacity(FILE_BYTES);
    let mut round = 0;
    while long.len() < FILE_BYTES && !messages.is_empty() {
        for (bytes, stamps) in &messages {
            let start = long.len();
            long.extend_from_slice(bytes);
            for stamp in stamps {
                let us = stamp_of(bytes, *stamp) + round * span_us;
                long[start + stamp..start + stamp + 8].copy_from_slice(&us.to_le_bytes());
            }
        }
        // definitions and parameters stand once
        messages.retain(|(bytes, stamps)| !stamps.is_empty() && bytes[2] != 128);
        round += 1;
    }
    long
}

fn stamp_of(bytes: &[u8], at: usize) -> u64 {
    bytes[at..].first_chunk().map_or(0, |stamp| u64::from_le_bytes(*stamp))
}

/// Megabytes a second of the fastest of a few runs.
fn pymavlink(log: &Path) -> Result<f64, Box<dyn Error>> {
    let python = std::env::var("MAVID_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/read_dataflash_with_pymavlink.py");
    let output = Command::new(python).arg(script).arg(log).output()?;
    let rate = String::from_utf8(output.stdout)?.trim().parse();
    rate.map_err(|_| String::from_utf8_lossy(&output.stderr).trim().to_owned().into())
}
