//! How fast logs that a vehicle wrote itself are read, beside pymavlink and pyulog on the same messages.
//!
//! `cargo bench --bench onboard [-- LOG]`: whole messages of the log (`.bin` or `.ulg`) are repeated, their times shifted,
//! until the file has 500 MB; it is written to `target/`. Without a path, a simulated flight of each autopilot of
//! `../shared` is taken where it is there. `MAVID_PYTHON` names a Python that has both packages (default `python3`). pyulog
//! reads the same long file, three times, of which the fastest counts; pymavlink reads the log itself, which is short: it would
//! hold the long one's messages in more memory than most computers have.

mod dataflash;
mod ulog;

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use mavid::log::{self, OpenOptions};

const FILE_BYTES: usize = 500_000_000;
const REPEATS: usize = 5;
/// Between two repetitions, microseconds.
const PAUSE_US: u64 = 10_000;

/// One kind of log.
struct Kind {
    /// of its files' names
    ending: &'static str,
    /// a flight of `../shared`
    flight: &'static str,
    walk: fn(&Path) -> Result<(), Box<dyn Error>>,
    /// the log's messages again and again, each round after the one before it
    repeated: fn(&[u8]) -> Vec<u8>,
    /// another reader of the same logs, and the script in `tests/peers` that times it
    peer: (&'static str, &'static str),
    /// it reads the long file, and not the log itself
    peer_reads_long: bool,
}

const KINDS: [Kind; 2] = [
    Kind {
        ending: "bin",
        flight: "ap01.bin",
        walk: dataflash::walk,
        repeated: dataflash::repeated,
        peer: ("pymavlink", "read_dataflash_with_pymavlink.py"),
        peer_reads_long: false,
    },
    Kind {
        ending: "ulg",
        flight: "px01.ulg",
        walk: ulog::walk,
        repeated: ulog::repeated,
        peer: ("pyulog", "read_ulog_with_pyulog.py"),
        peer_reads_long: true,
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::args().skip(1).find(|argument| !argument.starts_with("--")).map(PathBuf::from);
    for kind in &KINDS {
        let of_kind = |log: &PathBuf| log.extension().is_some_and(|ending| ending == kind.ending);
        match &given {
            Some(log) if of_kind(log) => measure(kind, log)?,
            Some(_) => {}
            None => measure(kind, &root.join("../shared/onboard/sitl").join(kind.flight))?,
        }
    }
    Ok(())
}

fn measure(kind: &Kind, log: &Path) -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    if !log.is_file() {
        writeln!(out, "expected a log, {} is none: nothing measured", log.display())?;
        return Ok(());
    }
    let long = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/bench-onboard").with_extension(kind.ending);
    let bytes = (kind.repeated)(&std::fs::read(log)?);
    long.parent().map_or(Ok(()), std::fs::create_dir_all)?;
    std::fs::write(&long, &bytes)?;
    let megabytes = bytes.len() as f64 * 1e-6;
    drop(bytes);
    writeln!(out, "{} ({megabytes:.0} MB of {})", long.display(), log.display())?;
    let raw = median(|| (kind.walk)(&long))?;
    let streamed = median(|| Ok(log::stream(&long, &OpenOptions::default(), &mut |_, _| ())?))?;
    let held = median(|| Ok(log::open(&long, &OpenOptions::default())?))?;
    for (what, seconds) in [("messages", raw), ("samples, streamed", streamed), ("whole recording", held)] {
        writeln!(out, "{what:<20} {:>8.0} MB/s", megabytes / seconds)?;
    }
    let (name, script) = kind.peer;
    let theirs = peer(script, if kind.peer_reads_long { &long } else { log });
    std::fs::remove_file(&long)?;
    match theirs {
        Ok(theirs) => {
            let times = megabytes / held / theirs;
            writeln!(
                out,
                "{name:<20} {theirs:>8.2} MB/s: the whole recording is read {times:.0} times as fast"
            )?;
        }
        Err(error) => writeln!(out, "{name} not measured: {error}")?,
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

/// The 64-bit stamp at a place.
fn stamp_of(bytes: &[u8], at: usize) -> u64 {
    bytes[at..].first_chunk().map_or(0, |stamp| u64::from_le_bytes(*stamp))
}

/// Megabytes a second of the fastest of a few runs.
fn peer(script: &str, log: &Path) -> Result<f64, Box<dyn Error>> {
    let python = std::env::var("MAVID_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(script);
    let output = Command::new(python).arg(script).arg(log).output()?;
    let rate = String::from_utf8(output.stdout)?.trim().parse();
    rate.map_err(|_| String::from_utf8_lossy(&output.stderr).trim().to_owned().into())
}
