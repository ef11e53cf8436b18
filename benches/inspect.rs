//! Memory and time of `mavid inspect` on a large log.
//!
//! `cargo bench --bench inspect [-- MEGABYTES]`: generates a telemetry log under `target/` (1000 MB without an
//! argument), inspects it with and without a vehicle, and says how long that took and how much memory the
//! whole process used at most (VmHWM of /proc, Linux only).

#[path = "../tests/support/flight_log.rs"]
mod flight_log;

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    let argument = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let megabytes: u64 = argument.map_or(Ok(1000), |text| text.parse())?;
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inspect-bench.tlog");
    let length_s = flight_log::write_flight_log(&path, megabytes * 1_000_000)?;
    let size = std::fs::metadata(&path)?.len();
    writeln!(out, "{size} bytes, {:.1} hours of flights", length_s / 3600.0)?;
    let vehicle = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let log = path.display().to_string();
    for (name, arguments) in [
        ("without a vehicle", vec!["inspect", &log]),
        ("with a vehicle", vec!["inspect", &log, "--vehicle", &vehicle.display().to_string()]),
    ] {
        let (seconds, peak_kib) = measured(&arguments)?;
        let speed = size as f64 / 1e6 / seconds;
        writeln!(
            out,
            "{name:<20} {seconds:>7.2} s {speed:>7.0} MB/s {:>7.1} MB at most",
            peak_kib * 1.024e-3
        )?;
    }
    std::fs::remove_file(&path)?;
    Ok(())
}

/// Seconds and largest resident memory, KiB.
fn measured(arguments: &[&str]) -> Result<(f64, f64), Box<dyn Error>> {
    let start = Instant::now();
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).stdout(Stdio::null()).spawn()?;
    let status = format!("/proc/{}/status", child.id());
    let mut peak_kib: f64 = 0.0;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let high = text.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        peak_kib = high.and_then(|high| high.trim().parse().ok()).unwrap_or(peak_kib);
        if let Some(exit) = child.try_wait()? {
            let seconds = start.elapsed().as_secs_f64();
            return if exit.success() { Ok((seconds, peak_kib)) } else { Err(format!("{exit}").into()) };
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}
