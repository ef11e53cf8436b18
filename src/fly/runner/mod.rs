//! A flight over a real link: sockets, threads and the clock around [`Flight`].
//!
//! ```text
//! link -> frames -> Flight -> commands -> link -> recording
//!                    | guide
//!                    v
//!            thread of setpoints ------> link
//! ```
//!
//! The live identification hears what the flight hears, on a thread of its own.

mod clearance;
mod drive;
mod estimating;
mod journal;
mod parking;
mod priority;
mod stream;
mod supervisor;

pub use parking::{Parking, Part};
pub use priority::raise_priority;
pub use stream::{Due, StreamFigures, send_due};
pub use supervisor::Supervisor;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};
use tokio::time::MissedTickBehavior;

use super::flight::{Event, Flight};
use super::outcome::Outcome;
use super::requests::LinkKind;
use super::sortie::Sortie;
use super::view::{KeyCommand, ViewModel};
use crate::link::{
    Address, Link, LinkError, LinkOptions, LinkReader, LinkStats, Received, RecordError, Recorder,
    RecorderStatus, Signing,
};
use crate::log::SystemId;
use crate::vehicle::Vehicle;
use drive::Drive;
use estimating::Estimating;
use journal::Journal;
use stream::{SharedGuide, Stream};

/// Between two looks at the clock.
const TICK: Duration = Duration::from_millis(10);
/// How long the last words of a flight may take to leave.
const FLUSH: Duration = Duration::from_secs(1);

/// What is said where setpoints get no thread of their own rank.
const NO_PRIORITY: &str = "the system permits no real-time threads (on Linux: CAP_SYS_NICE, or RLIMIT_RTPRIO of at \
     least 1): while every core is busy, a setpoint may go out late, over serial and TCP more than over UDP";

/// Names of the files of a flight in its folder.
pub const TLOG: &str = "flight.tlog";
/// Log of events, JSON lines.
pub const EVENTS: &str = "events.jsonl";
/// The vehicle's parameters.
pub const PARAMETERS: &str = "parameters.toml";

/// What is flown, how the vehicle is reached, and where the records go.
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
    /// for tests: what stands still
    pub parking: Parking,
}

/// Who watches the flight.
#[derive(Debug)]
pub struct Console {
    /// gets the state a few times a second; a picture that finds no room is left out
    pub show: SyncSender<ViewModel>,
    /// what the operator asks for
    pub keys: UnboundedReceiver<KeyCommand>,
}

/// What a flight left behind.
#[derive(Debug)]
pub struct Record {
    /// how it ended
    pub outcome: Outcome,
    /// how the setpoints went out
    pub stream: StreamFigures,
    /// whose flight it is; `None` where no vehicle was found
    pub system: Option<SystemId>,
    /// the recording
    pub recorder: RecorderStatus,
    /// the link
    pub link: LinkStats,
    /// the log of events could not be written in whole
    pub events_failure: Option<String>,
}

/// Why there was no flight, or no end of it.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// the link cannot be used
    #[error(transparent)]
    Link(#[from] LinkError),
    /// the recording cannot be made
    #[error(transparent)]
    Record(#[from] RecordError),
    /// a file or thread cannot be made
    #[error("cannot make {what}: {source}")]
    Make {
        /// which
        what: String,
        /// what the system said
        source: io::Error,
    },
    /// the program itself failed; nothing is sent any more
    #[error(
        "the flight broke off by a fault of this program; no setpoint is sent any more, and the vehicle's own failsafe acts: {0}"
    )]
    Broken(String),
}

/// Flies. Returns when the vehicle is on the ground or was left to others.
///
/// # Errors
/// If the link, the recording or a thread cannot be made, or the program itself fails.
pub async fn run(ride: Ride, console: Console) -> Result<Record, RunError> {
    let recorder = Recorder::create(&ride.dir.join(TLOG), false)?;
    let make = |what: &str| {
        let what = what.to_owned();
        move |source| RunError::Make { what, source }
    };
    let journal = Journal::create(&ride.dir.join(EVENTS)).map_err(make(EVENTS))?;
    let (system, component) = ride.sortie.settings.station;
    let options = LinkOptions {
        system,
        component,
        patient: true,
        signing: ride.signing,
        recorder: Some(recorder.clone()),
        parked: Some(ride.parking.flag(Part::Link).clone()),
        ..LinkOptions::default()
    };
    let (reader, writer) = Link::open(&ride.address, options).await?;
    let clock = Instant::now();
    let guide = SharedGuide::new();
    let (stalled, stalls) = unbounded_channel();
    let period = ride.sortie.settings.setpoint_period;
    let stream =
        Stream::start(period, clock, guide.clone(), writer.clone(), stalled).map_err(make("a thread"))?;
    let flight = Flight::new(ride.sortie);
    let (link, address) = (kind_of(&ride.address), ride.address.to_string());
    let place = drive::Place { dir: ride.dir, vehicle: ride.vehicle, link, address };
    // here, and not in a task: those of the link have a rank that it is not to have
    let estimating = Estimating::start().map_err(make("a thread"))?;
    let mut drive = Drive::new(flight, guide.clone(), writer.clone(), clock, (place, estimating));
    if !stream.is_real_time {
        drive.warn("setpoints", NO_PRIORITY);
    }
    // a task of its own: were it to panic, the guide is not renewed and no setpoint goes out. No mode is ordered by
    // whoever does not know it: the vehicle's own failsafe acts
    let task = tokio::spawn(conduct(drive, (reader, ride.parking), console, journal, stalls));
    let (outcome, events_failure) = match task.await {
        Ok(done) => done?,
        Err(broken) => return Err(RunError::Broken(broken.to_string())),
    };
    let stream = stream.finish();
    // the link may be gone by now
    let _ = tokio::time::timeout(FLUSH, writer.flush()).await;
    let link = writer.stats();
    let recorder = recorder.end().await?;
    let stream = stream.on_link(&link);
    let system = guide.get().target.map(|(target, _)| target.system);
    Ok(Record { outcome, stream, system, recorder, link, events_failure })
}

fn kind_of(address: &Address) -> LinkKind {
    match address {
        // what a USB port is told of its speed means nothing, but a radio's does
        Address::Serial { path, baud, .. } if !is_usb(path) => LinkKind::Serial { baud: f64::from(*baud) },
        _ => LinkKind::Wide,
    }
}

fn is_usb(path: &Path) -> bool {
    path.to_string_lossy().contains("ttyACM")
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
        if parking.is_parked(Part::Supervisor) {
            std::future::pending::<()>().await;
        }
        tokio::select! {
            received = reader.receive(), if hears && !parking.is_parked(Part::Telemetry) => match received {
                Ok(Received::Frame(frame)) => drive.frame(frame),
                Ok(Received::Event(event)) => drive.link_event(&event),
                Err(_) => {
                    hears = false;
                    drive.handle(Event::LinkEnded);
                }
            },
            _ = ticks.tick() => drive.tick(reader.waiting()),
            key = console.keys.recv(), if keyed => match key {
                Some(key) => drive.key(key),
                None => keyed = false,
            },
            Some(gap) = stalls.recv() => drive.handle(Event::Stalled(gap)),
            name = ends.next() => drive.handle(Event::Stop(name.to_owned())),
        }
        drive.report(&journal, &console.show);
        if let Some(outcome) = drive.outcome() {
            return Ok((outcome, journal.finish().await));
        }
    }
}

/// The ways in which a program is told to end.
struct Ends {
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
    #[cfg(unix)]
    hang_up: tokio::signal::unix::Signal,
}

impl Ends {
    fn new() -> Result<Self, RunError> {
        #[cfg(unix)]
        {
            use tokio::signal::unix::{SignalKind, signal};
            let make = |source| RunError::Make { what: "a signal handler".to_owned(), source };
            Ok(Self {
                terminate: signal(SignalKind::terminate()).map_err(make)?,
                hang_up: signal(SignalKind::hangup()).map_err(make)?,
            })
        }
        #[cfg(not(unix))]
        Ok(Self {})
    }

    async fn next(&mut self) -> &'static str {
        #[cfg(unix)]
        tokio::select! {
            _ = tokio::signal::ctrl_c() => "Ctrl-C",
            _ = self.terminate.recv() => "SIGTERM",
            _ = self.hang_up.recv() => "SIGHUP",
        }
        #[cfg(not(unix))]
        {
            let _ = tokio::signal::ctrl_c().await;
            "Ctrl-C"
        }
    }
}
