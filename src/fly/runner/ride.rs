//! A flight over a real link, from its first file to its record.

use std::path::PathBuf;
use std::sync::mpsc::SyncSender;
use std::time::Duration;

use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};
use tokio::time::MissedTickBehavior;
use tracing::Instrument;
use tracing::instrument::WithSubscriber;

use super::clock::Clock;
use super::drive::{self, Drive};
use super::error::RunError;
use super::estimating::Estimating;
use super::event_layer::{Subscription, flight_span};
use super::files::{EVENTS, TLOG};
use super::journal::Journal;
use super::judging::Judging;
use super::link_kind::kind_of;
use super::parking::{Parking, Part};
use super::stream::{SharedGuide, Stream, StreamFigures};
use super::termination::Ends;
use crate::fly::flight::{Event, Flight};
use crate::fly::outcome::Outcome;
use crate::fly::sortie::Sortie;
use crate::fly::view::{KeyCommand, ViewModel};
use crate::link::{
    Address, Link, LinkOptions, LinkReader, LinkStats, Received, Recorder, RecorderStatus, Signing, Stop,
    panic_for_test,
};
use crate::vehicle::Vehicle;
use crate::wire::SystemId;

/// Between two looks at the clock.
const TICK: Duration = Duration::from_millis(10);
/// Longest time for the last messages of a flight to be sent.
const FLUSH: Duration = Duration::from_secs(1);
/// Warning if setpoints get no real-time thread.
const NO_PRIORITY: &str = "the system permits no real-time threads (on Linux: CAP_SYS_NICE, or RLIMIT_RTPRIO of at \
     least 1): while every core is busy, a setpoint may go out late, over serial and TCP more than over UDP";

/// The flight, the link to the vehicle, and the place of the records.
#[derive(Debug)]
pub struct Ride {
    /// the flight
    pub sortie: Sortie,
    /// what is known of the vehicle
    pub vehicle: Vehicle,
    /// how it is reached
    pub address: Address,
    /// signs what is sent
    pub signing: Option<Signing>,
    /// an existing folder
    pub dir: PathBuf,
    /// for tests: what stalls or sleeps
    pub parking: Parking,
}

/// Who watches the flight.
#[derive(Debug)]
pub struct Console {
    /// gets the state a few times a second; a picture that finds no room is left out
    pub view: SyncSender<ViewModel>,
    /// what the operator asks for
    pub keys: UnboundedReceiver<KeyCommand>,
}

/// Results of a flight.
#[derive(Debug)]
pub struct Record {
    /// how it ended
    pub outcome: Outcome,
    /// figures of the setpoints
    pub stream: StreamFigures,
    /// system id of the vehicle; `None` if no vehicle was found
    pub system: Option<SystemId>,
    /// the recording
    pub recorder: RecorderStatus,
    /// the link
    pub link: LinkStats,
    /// reason why the log of events is incomplete
    pub events_failure: Option<String>,
}

/// Flies. Returns when the vehicle is on the ground or was left to others. What happens is said as tracing events within
/// a span `flight`; the log of events is written by [`event_layer`](super::event_layer()).
///
/// # Errors
/// If the current subscriber is without that layer, if the link, the recording or a thread cannot be made, or the program
/// itself fails.
pub async fn run(ride: Ride, console: Console) -> Result<Record, RunError> {
    let span = flight_span(&ride.address, &ride.vehicle.name);
    let subscription = Subscription::to(&span).ok_or(RunError::Unheard)?;
    fly(ride, console, subscription).instrument(span).await
}

async fn fly(ride: Ride, console: Console, subscription: Subscription) -> Result<Record, RunError> {
    let recorder = Recorder::create(&ride.dir.join(TLOG), false)?;
    let make = |what: &str| {
        let what = what.to_owned();
        move |source| RunError::Make { what, source }
    };
    let journal = Journal::create(&ride.dir.join(EVENTS), subscription).map_err(make(EVENTS))?;
    let (system, component) = ride.sortie.settings.station;
    let options = LinkOptions {
        system,
        component,
        patient: true,
        signing: ride.signing,
        recorder: Some(recorder.clone()),
        halt: ride.parking.halt(Part::Link).clone(),
        ..LinkOptions::default()
    };
    let (reader, writer) = Link::open(&ride.address, options).await?;
    let clock = Clock::start(ride.parking.clone());
    let guide = SharedGuide::new();
    let (stalled, stalls) = unbounded_channel();
    let period = ride.sortie.settings.setpoint_period;
    let stream = Stream::start(period, clock.clone(), guide.clone(), writer.clone(), stalled)
        .map_err(make("a thread"))?;
    let flight = Flight::new(ride.sortie);
    let (link, address) = (kind_of(&ride.address), ride.address.to_string());
    let place = drive::Place { dir: ride.dir, vehicle: ride.vehicle, link, address };
    // here, and not in a task: those of the link have a rank that it is not to have
    let estimating = Estimating::start().map_err(make("a thread"))?;
    let judging = Judging::start().map_err(make("a thread"))?;
    let mut drive = Drive::new(flight, guide.clone(), writer.clone(), clock, (place, estimating, judging));
    if !stream.is_real_time {
        drive.warn("setpoints", NO_PRIORITY);
    }
    // a task of its own: were it to panic, the guide is not renewed and no setpoint goes out. No mode is ordered by
    // whoever does not know it: the vehicle's own failsafe acts
    let conducted = conduct(drive, (reader, ride.parking), console, journal, stalls);
    let task = tokio::spawn(conducted.in_current_span().with_current_subscriber());
    let (outcome, events_failure) = match task.await {
        Ok(done) => done?,
        Err(broken) => return Err(RunError::Broken(broken.to_string())),
    };
    let stream = stream.finish();
    // the link may be gone by now
    let _ = tokio::time::timeout(FLUSH, writer.flush()).await;
    let so_far = writer.stats();
    // what the recording, ended after it, has
    let link = tokio::time::timeout(FLUSH, writer.close()).await.unwrap_or(so_far);
    let recorder = recorder.end().await?;
    let stream = stream.on_link(&link);
    let StreamFigures { sent, late, overtaken, refused } = stream;
    tracing::info!(sent, late, overtaken, refused, "setpoints sent");
    let system = guide.get().target.map(|(target, _)| target.system);
    Ok(Record { outcome, stream, system, recorder, link, events_failure })
}

/// What a flight ends in, and why its events are not whole.
type Done = (Outcome, Option<String>);

async fn conduct(
    mut drive: Drive,
    (mut reader, parking): (LinkReader, Parking),
    mut console: Console,
    journal: Journal,
    mut stalls: UnboundedReceiver<Duration>,
) -> Result<Done, RunError> {
    let mut ticks = tokio::time::interval(TICK);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Skip);
    let mut ends = Ends::new()?;
    let (mut hears, mut keyed) = (true, true);
    loop {
        match parking.halt(Part::Supervisor).stopped() {
            Some(Stop::Stands) => std::future::pending().await,
            Some(Stop::Panics) => panic_for_test("a test stops the supervisor"),
            Some(Stop::Ends) => return Err(RunError::Broken("a test ends the supervisor".to_owned())),
            None => {}
        }
        let telemetry = parking.halt(Part::Telemetry);
        hears &= telemetry.stopped() != Some(Stop::Ends);
        tokio::select! {
            received = reader.receive(), if hears && telemetry.stopped() != Some(Stop::Stands) => match received {
                Ok(_) if telemetry.stopped() == Some(Stop::Panics) => {
                    panic_for_test("a test stops the telemetry")
                }
                Ok(Received::Frame(frame)) => {
                    drive.frame(frame);
                    telemetry.runs();
                }
                Ok(Received::Event(event)) => drive.link_event(&event),
                Err(_) => {
                    hears = false;
                    drive.handle(Event::LinkEnded);
                }
            },
            _ = ticks.tick() => {
                let waiting = reader.waiting();
                drive.tick(waiting);
                if waiting == 0 {
                    telemetry.runs();
                }
            }
            key = console.keys.recv(), if keyed => match key {
                Some(key) => drive.key(key),
                None => keyed = false,
            },
            Some(gap) = stalls.recv() => drive.handle(Event::Stalled(gap)),
            name = ends.next_signal() => drive.handle(Event::Stop(name.to_owned())),
        }
        parking.halt(Part::Supervisor).runs();
        drive.report(&journal, &console.view);
        if let Some(outcome) = drive.outcome() {
            return Ok((outcome, journal.finish().await));
        }
    }
}
