//! A part of the program stands still while the vehicle climbs: setpoints end at once, no mode is ordered, and the
//! vehicle's own failsafe acts.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "support/flying.rs"]
mod flying;

use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

use mavid::fly::view::{KeyCommand, ViewModel};
use mavid::fly::{self, Cause, Console, Ending, Parking, Part, Record, Ride, RunError};
use mavid::link::{Link, LinkOptions, Recorder};
use mavid::log::TlogReader;
use mavid::sitl::{Firmware, LinkRole, Pace, Vehicle, serve};
use mavid::wire::{ComponentId, SystemId};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::task::JoinHandle;

const SETPOINT: u32 = 84;
const COMMAND_LONG: u32 = 76;
const SET_MODE: u16 = 176;
const ARM_DISARM: u16 = 400;

/// What the vehicle heard: when (its log's clock, us), and which message or command.
fn heard(log: &Path) -> Vec<(u64, u32, u16)> {
    let mut reader = TlogReader::new(std::fs::File::open(log).unwrap());
    let mut heard = Vec::new();
    while let Some(record) = reader.next_record().unwrap() {
        let header = record.frame.header();
        if header.system == SystemId(255) {
            let command = if header.message_id == COMMAND_LONG { record.frame.payload().u16(28) } else { 0 };
            heard.push((record.stamp_us, header.message_id, command));
        }
    }
    heard
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
    let flight = tokio::spawn(fly::run(ride, Console { show, keys }));
    tokio::time::timeout(Duration::from_secs(60), climbing).await.unwrap().unwrap();
    tokio::time::sleep(Duration::from_secs(2)).await;
    Climbing { parking, flight, vehicle, recorder, log, _press: press }
}

/// Parks a part two seconds into the climb; gives the vehicle's recording and when it was parked.
async fn parked(part: Part, name: &str) -> (PathBuf, u64) {
    let Climbing { parking, flight, vehicle, recorder, log, _press } = climbing(name).await;
    let at = u64::try_from(std::time::UNIX_EPOCH.elapsed().unwrap().as_micros()).unwrap();
    parking.park(part);
    tokio::time::sleep(Duration::from_secs(4)).await;
    flight.abort();
    // a task that stands still cannot be ended
    parking.release();
    vehicle.abort();
    recorder.end().await.unwrap();
    (log, at)
}

/// Nothing but the flight's clock tells of it: every part goes on as if nothing had been.
#[tokio::test(flavor = "multi_thread", worker_threads = 8)]
async fn a_computer_that_slept_has_stood_still() {
    let Climbing { parking, flight, vehicle, _press, .. } = climbing("sleep").await;
    parking.sleep(Duration::from_secs(600));
    let record = tokio::time::timeout(Duration::from_secs(120), flight).await.unwrap().unwrap().unwrap();
    vehicle.abort();
    let Some(Cause::Stalled(what)) = record.outcome.cause else { panic!("{:?}", record.outcome) };
    assert!(what.contains("stood still for 600"), "{what}");
    assert_eq!(record.outcome.ending, Ending::Landed);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 8)]
async fn whatever_stands_still_setpoints_end_and_no_mode_is_ordered() {
    let (supervisor, telemetry, link) = tokio::join!(
        parked(Part::Supervisor, "supervisor"),
        parked(Part::Telemetry, "telemetry"),
        parked(Part::Link, "link"),
    );
    for (name, (log, at)) in [("supervisor", supervisor), ("telemetry", telemetry), ("link", link)] {
        let heard = heard(&log);
        let before = heard.iter().filter(|(t, id, _)| *t < at && *id == SETPOINT).count();
        assert!(before > 50, "{name}: {before} setpoints before");
        // a tenth of a second by the program's clock; the machine may be busy
        let late = heard.iter().filter(|(t, id, _)| *t > at + 1_000_000 && *id == SETPOINT).count();
        assert_eq!(late, 0, "{name}");
        let orders =
            heard.iter().filter(|(t, _, command)| *t > at && [SET_MODE, ARM_DISARM].contains(command));
        assert_eq!(orders.count(), 0, "{name}");
    }
}
