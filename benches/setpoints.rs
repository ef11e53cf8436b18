//! How punctual setpoints are: `mavid fly` at 100 Hz against `mavid sitl`, two processes, while every core is
//! kept busy. A tap between both stamps each setpoint as it comes out of its socket.
//!
//! `cargo bench --bench setpoints`. It fails unless 99 % come within 3 ms of their time and none is missing.
//! A setpoint's time is the instant of the 10 ms grid for which it was made; times are counted from the
//! most punctual one. The tap has to be woken too, under the same load: what it sees is an upper bound. Without the
//! permission to raise threads (CAP_SYS_NICE, or RLIMIT_RTPRIO of at least 1) several wait for each instant:
//! for root, `setpriv --bounding-set=-sys_nice` before the benchmark shows what a user without it gets.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a benchmark prints and ends where it fails")]

#[path = "../tests/support/processes.rs"]
mod processes;

use std::net::{SocketAddr, UdpSocket};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use mavid::wire::Frame;
use processes::{fly, folder, planned, vehicle};
use serde_json::Value;

const SET_POSITION_TARGET_LOCAL_NED: u32 = 84;
const RATE_HZ: u32 = 100;
const PERIOD_MS: u32 = 1000 / RATE_HZ;
/// What must hold.
const WITHIN_MS: f64 = 3.0;
const SHARE: f64 = 0.99;
/// Periods of 6 s.
const PERIODS: u64 = 6;

/// A setpoint: the milliseconds of the sender's clock at which it was made, and when it came by.
type Arrival = (u32, Duration);

/// Passes datagrams on between whoever sends to it and the vehicle, and stamps the setpoints.
fn tap(to: SocketAddr) -> (u16, Arc<Mutex<Vec<Arrival>>>) {
    let ground_side = UdpSocket::bind("127.0.0.1:0").unwrap();
    let vehicle_side = UdpSocket::bind("127.0.0.1:0").unwrap();
    vehicle_side.connect(to).unwrap();
    let port = ground_side.local_addr().unwrap().port();
    let seen = Arc::new(Mutex::new(Vec::new()));
    let ground = Arc::new(Mutex::new(None));
    let start = Instant::now();
    thread::spawn({
        let (seen, ground) = (seen.clone(), ground.clone());
        let (from, to) = (ground_side.try_clone().unwrap(), vehicle_side.try_clone().unwrap());
        move || {
            mavid::fly::raise_priority();
            let mut buffer = [0; 2048];
            loop {
                let Ok((bytes, sender)) = from.recv_from(&mut buffer) else { continue };
                let came = start.elapsed();
                // the vehicle's socket may not be there any more
                let _ = to.send(&buffer[..bytes]);
                *ground.lock().unwrap() = Some(sender);
                if let Some(frame) = Frame::at_start(&buffer[..bytes])
                    && frame.header().message_id == SET_POSITION_TARGET_LOCAL_NED
                {
                    seen.lock().unwrap().push((frame.payload().u32(0), came));
                }
            }
        }
    });
    thread::spawn(move || {
        let mut buffer = [0; 2048];
        loop {
            let Ok(bytes) = vehicle_side.recv(&mut buffer) else { continue };
            let to = *ground.lock().unwrap();
            if let Some(to) = to {
                let _ = ground_side.send_to(&buffer[..bytes], to);
            }
        }
    });
    (port, seen)
}

/// Keeps this many threads busy while `work` runs.
fn under_load<T>(threads: usize, work: impl FnOnce() -> T) -> T {
    let over = AtomicBool::new(false);
    thread::scope(|scope| {
        for seed in 0..threads {
            let over = &over;
            scope.spawn(move || {
                let mut number = seed as f64;
                while !over.load(Ordering::Relaxed) {
                    for _ in 0..10_000 {
                        number = std::hint::black_box(number.mul_add(0.5, 1.0).sqrt());
                    }
                }
            });
        }
        let done = work();
        over.store(true, Ordering::Relaxed);
        done
    })
}

/// Lateness in ms, sorted, and how many instants of the grid have no setpoint.
fn lateness(seen: &[Arrival]) -> (Vec<f64>, usize) {
    let late = |(made_ms, came): &Arrival| {
        let due_ms = made_ms / PERIOD_MS * PERIOD_MS;
        1000.0 * came.as_secs_f64() - f64::from(due_ms)
    };
    let earliest = seen.iter().map(late).fold(f64::INFINITY, f64::min);
    let mut all: Vec<f64> = seen.iter().map(|seen| late(seen) - earliest).collect();
    all.sort_unstable_by(f64::total_cmp);
    let slots: Vec<u32> = seen.iter().map(|(made_ms, _)| made_ms / PERIOD_MS).collect();
    let span = slots.iter().max().unwrap() - slots.iter().min().unwrap() + 1;
    (all, usize::try_from(span).unwrap() - slots.len())
}

fn main() -> ExitCode {
    let cores = thread::available_parallelism().unwrap().get();
    let trajectory = planned("setpoints_plan", PERIODS);
    let out = folder("setpoints").join("flight");
    let (_vehicle, listens) = vehicle("px4", "udpin:127.0.0.1:0");
    let (port, seen) = tap(listens.trim_start_matches("udpin:").parse().unwrap());
    let connect = format!("udpout:127.0.0.1:{port}");
    let rate = RATE_HZ.to_string();
    let output = under_load(cores, || fly(&out, &connect, &trajectory, &["--setpoint-hz", &rate]));
    let Ok(document) = serde_json::from_slice::<Value>(&output.stdout) else {
        println!("{}", String::from_utf8_lossy(&output.stderr));
        return ExitCode::FAILURE;
    };
    let seen = seen.lock().unwrap().clone();
    let (late, lost) = lateness(&seen);
    // a whole share of at most all of them
    let at = |share: f64| late[mavid::units::whole(share * (late.len() - 1) as f64).unsigned_abs() as usize];
    let span_s = (seen[seen.len() - 1].1 - seen[0].1).as_secs_f64();
    println!(
        "{} setpoints at {RATE_HZ} Hz in {span_s:.1} s, {cores} cores kept busy by {cores} threads",
        late.len()
    );
    println!("late by (ms)   50 %     90 %     99 %   99.9 %      all");
    println!(
        "          {:9.3}{:9.3}{:9.3}{:9.3}{:9.3}",
        at(0.5),
        at(0.9),
        at(SHARE),
        at(0.999),
        late[late.len() - 1]
    );
    println!("missing: {lost}; flight: {}, {}", document["flight"]["ending"], document["setpoints"]);
    if at(SHARE) <= WITHIN_MS && lost == 0 {
        ExitCode::SUCCESS
    } else {
        println!("expected 99 % within {WITHIN_MS} ms and none missing");
        ExitCode::FAILURE
    }
}
