//! A part of the program stands still or dies while the vehicle climbs: setpoints end within 0.1 s, no mode is ordered,
//! and the vehicle's own failsafe acts.
//!
//! What counts is the program's own time: the setpoint's, against that at which the part last ran. A busy machine
//! changes neither; what it adds until the setpoint is sent is measured beside them.

#![allow(clippy::print_stdout, reason = "the figures of the documents are printed")]

use crate::flying;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

use mavid::fly::view::{KeyCommand, ViewModel};
use mavid::fly::{self, Cause, Console, Ending, Parking, Part, Record, Ride, RunError, TLOG};
use mavid::link::{Link, LinkOptions, Recorder, Stop};
use mavid::log::TlogReader;
use mavid::sitl::{Firmware, LinkRole, Pace, Vehicle, serve};
use mavid::wire::{ComponentId, SystemId};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::task::JoinHandle;

const SETPOINT: u32 = 84;
const COMMAND_LONG: u32 = 76;
const SET_MODE: u16 = 176;
const ARM_DISARM: u16 = 400;

const PARTS: [Part; 3] = [Part::Supervisor, Part::Telemetry, Part::Link];
const STOPS: [Stop; 3] = [Stop::Stands, Stop::Panics, Stop::Ends];
/// A setpoint is made at most so long after a part last ran, ms.
const SILENT_AFTER_MS: f64 = 100.0;
/// A setpoint says its time in whole milliseconds.
const ROUNDING_MS: f64 = 2.0;
/// Between the making of a setpoint and its sending the system may let others run for so long, ms. If it takes longer, this
/// host stood still meanwhile, and the trial says nothing.
const SCHEDULER_MS: f64 = 50.0;

/// A message of the station as somebody recorded it.
struct Said {
    /// of the recording's clock, us
    stamp_us: u64,
    id: u32,
    /// of a command
    command: u16,
    /// of a setpoint: its own time, ms of the flight's clock
    time_ms: u32,
}

fn said(log: &Path) -> Vec<Said> {
    let mut reader = TlogReader::new(std::fs::File::open(log).unwrap());
    let mut said = Vec::new();
    while let Some(record) = reader.next_record().unwrap() {
        let (header, payload) = (record.frame.header(), record.frame.payload());
        if header.system == SystemId(255) {
            let id = header.message_id;
            let command = if id == COMMAND_LONG { payload.u16(28) } else { 0 };
            let time_ms = if id == SETPOINT { payload.u32(0) } else { 0 };
            said.push(Said { stamp_us: record.stamp_us, id, command, time_ms });
        }
    }
    said
}

/// A flight of an embedded vehicle over a real link, two seconds into its climb.
struct Climbing {
    parking: Parking,
    flight: JoinHandle<Result<Record, RunError>>,
    vehicle: JoinHandle<()>,
    recorder: Recorder,
    log: PathBuf,
    /// lest its keys end
    _press: UnboundedSender<KeyCommand>,
}

async fn climbing(name: &str) -> Climbing {
    let settings = flying::vehicle_settings(Firmware::PX4);
    flying::write_events();
    let mut sortie = flying::sortie(&settings);
    sortie.may_arm = true;
    let file = settings.vehicle.clone();
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fly_dead_man").join(name);
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    let log = dir.join("vehicle.tlog");
    let recorder = Recorder::create(&log, false).unwrap();
    let options = LinkOptions {
        system: SystemId(1),
        component: ComponentId(1),
        patient: true,
        recorder: Some(recorder.clone()),
        ..LinkOptions::default()
    };
    let ends = Link::open(&"udpin:127.0.0.1:0".parse().unwrap(), options).await.unwrap();
    let address = ends.0.local_address().unwrap();
    let vehicle = Vehicle::new(settings).unwrap();
    let links = vec![(LinkRole::Onboard, ends)];
    let vehicle = tokio::spawn(async move {
        let _ = serve(vehicle, links, (Pace::Times(1.0), None), std::future::pending()).await;
    });
    let parking = Parking::default();
    let address = format!("udpout:{address}").parse().unwrap();
    let ride = Ride { sortie, vehicle: file, address, signing: None, dir, parking: parking.clone() };
    let (show, pictures) = mpsc::sync_channel::<ViewModel>(4);
    let (press, keys) = unbounded_channel();
    let (climbs, climbing) = tokio::sync::oneshot::channel();
    std::thread::spawn(move || {
        let mut climbs = Some(climbs);
        for picture in pictures {
            if picture.state == "take off"
                && let Some(climbs) = climbs.take()
            {
                let _ = climbs.send(());
            }
        }
    });
    let flight = tokio::spawn(fly::run(ride, Console { view: show, keys }));
    tokio::time::timeout(Duration::from_secs(60), climbing).await.unwrap().unwrap();
    tokio::time::sleep(Duration::from_secs(2)).await;
    Climbing { parking, flight, vehicle, recorder, log, _press: press }
}

/// What followed after a part had stopped.
#[derive(Debug)]
struct Trial {
    /// ms from when the part last ran until the last setpoint's own time, and until it was sent
    made_ms: f64,
    sent_ms: f64,
    setpoints: usize,
    /// that change a mode, arm or disarm, and came to the vehicle
    orders: usize,
}

/// Stops a part two seconds into the climb.
async fn stopped(part: Part, how: Stop, name: &str) -> Trial {
    let Climbing { parking, flight, vehicle, recorder, log, _press } = climbing(name).await;
    parking.stop(part, how);
    // long enough for many setpoints more
    tokio::time::sleep(Duration::from_millis(1500)).await;
    let last_ran_us = parking.last_ran_us(part);
    flight.abort();
    // a task that stands still cannot be ended
    parking.release();
    vehicle.abort();
    recorder.end().await.unwrap();
    let sent = said(&log.with_file_name(TLOG));
    let setpoints: Vec<&Said> = sent.iter().filter(|said| said.id == SETPOINT).collect();
    let ahead_us = |said: &Said| said.stamp_us as f64 - 1e3 * f64::from(said.time_ms);
    let start_us = setpoints.iter().map(|said| ahead_us(said)).fold(f64::MAX, f64::min);
    let last = setpoints.last().unwrap();
    let later = |said: &&Said| said.stamp_us > last_ran_us && [SET_MODE, ARM_DISARM].contains(&said.command);
    Trial {
        made_ms: 1e-3 * (start_us + 1e3 * f64::from(last.time_ms) - last_ran_us as f64),
        sent_ms: 1e-3 * (last.stamp_us as f64 - last_ran_us as f64),
        setpoints: setpoints.len(),
        orders: said(&log).iter().filter(later).count(),
    }
}

/// Every part stops so, each in a flight of its own.
async fn all_stopped(how: Stop, name: &str) -> Vec<(Part, Trial)> {
    let name = |part: &str| format!("{name}_{part}");
    let [supervisor, telemetry, link] = ["supervisor", "telemetry", "link"].map(name);
    let trials = tokio::join!(
        stopped(Part::Supervisor, how, &supervisor),
        stopped(Part::Telemetry, how, &telemetry),
        stopped(Part::Link, how, &link),
    );
    PARTS.into_iter().zip([trials.0, trials.1, trials.2]).collect()
}

/// Whether the laws held; that of the sending only if this host did not stand still.
fn check(part: Part, how: Stop, trial: &Trial) {
    let what = format!("{part:?} {how:?}: {trial:?}");
    assert!(trial.setpoints > 50, "{what}");
    assert!(trial.made_ms <= SILENT_AFTER_MS + ROUNDING_MS, "{what}");
    let stood_still = trial.sent_ms - trial.made_ms > SCHEDULER_MS;
    assert!(stood_still || trial.sent_ms <= SILENT_AFTER_MS + SCHEDULER_MS, "{what}");
    assert_eq!(trial.orders, 0, "{what}");
}

/// Nothing but the flight's clock tells of it: every part goes on as if nothing had been.
pub async fn a_computer_that_slept_has_stood_still() {
    let Climbing { parking, flight, vehicle, _press, .. } = climbing("sleep").await;
    parking.sleep(Duration::from_secs(600));
    let record = tokio::time::timeout(Duration::from_secs(120), flight).await.unwrap().unwrap().unwrap();
    vehicle.abort();
    let Some(Cause::Stalled(what)) = record.outcome.cause else { panic!("{:?}", record.outcome) };
    assert!(what.contains("stalled for 600"), "{what}");
    assert_eq!(record.outcome.ending, Ending::Landed);
}

pub async fn whatever_stands_still_setpoints_end_and_no_mode_is_ordered() {
    for (part, trial) in all_stopped(Stop::Stands, "stands").await {
        check(part, Stop::Stands, &trial);
    }
}

pub async fn whatever_dies_setpoints_end_and_no_mode_is_ordered() {
    for (how, name) in [(Stop::Panics, "panics"), (Stop::Ends, "ends")] {
        for (part, trial) in all_stopped(how, name).await {
            check(part, how, &trial);
        }
    }
}

/// The figures of the documents: 180 flights, seven minutes.
pub async fn twenty_trials_of_each() {
    for how in STOPS {
        let mut trials = Vec::new();
        for _ in 0..10 {
            let (one, other) = tokio::join!(all_stopped(how, "one"), all_stopped(how, "other"));
            trials.extend(one.into_iter().chain(other));
        }
        for part in PARTS {
            let mut of_part: Vec<&Trial> = Vec::new();
            for (of, trial) in &trials {
                check(*of, how, trial);
                if *of == part {
                    of_part.push(trial);
                }
            }
            let most = |of: fn(&Trial) -> f64| of_part.iter().map(|trial| of(trial)).fold(f64::MIN, f64::max);
            let still = of_part.iter().filter(|trial| trial.sent_ms - trial.made_ms > SCHEDULER_MS).count();
            println!(
                "{part:?} {how:?}: {} trials, made at most {:.1} ms and sent at most {:.1} ms after it last ran, {still} with a host \
                 that stood still, {} orders",
                of_part.len(),
                most(|trial| trial.made_ms),
                most(|trial| trial.sent_ms),
                of_part.iter().map(|trial| trial.orders).sum::<usize>()
            );
        }
    }
}
