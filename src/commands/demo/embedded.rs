//! The demo's vehicle: on a thread and a runtime of its own, reached by a UDP socket and by nothing else.

use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use mavid::config::parse_vehicle;
use mavid::link::{Address, Link, LinkOptions};
use mavid::sitl::{Firmware, LinkRole, Pace, Settings, Vehicle, serve};
use mavid::wire::{ComponentId, Nonce, SystemId};
use tokio::sync::oneshot;

use super::concealed::concealed;
use crate::commands::CommandError;
use crate::commands::sitl::DEFAULT_VEHICLE;

/// From boot until the position estimate is good.
const WARM_UP: Duration = Duration::from_secs(2);
/// Any port.
const LISTEN: &str = "udpin:127.0.0.1:0";

/// The vehicle while it runs.
#[derive(Debug)]
pub struct Embedded {
    /// where it listens
    pub port: u16,
    /// what it is known by: another vehicle on that port is not armed
    pub nonce: Nonce,
    stop: oneshot::Sender<()>,
    thread: JoinHandle<()>,
}

impl Embedded {
    /// Starts it with what it conceals: that of the file, or the demo's own.
    pub fn start(effects: Option<PathBuf>) -> Result<Self, CommandError> {
        let (stop, stopped) = oneshot::channel();
        let (listening, port) = channel();
        let nonce = Nonce::random();
        let work = move || {
            if let Err(error) = run((effects, nonce), stopped, &listening) {
                // the starter waits for one of both
                let _ = listening.send(Err(error));
            }
        };
        let thread = thread::Builder::new().name("vehicle".into()).spawn(work).map_err(|e| failed(&e))?;
        let port = port.recv().map_err(|error| failed(&error))??;
        Ok(Self { port, nonce, stop, thread })
    }

    /// Ends it.
    pub fn stop(self) {
        // one that has ended by itself hears nothing
        let _ = self.stop.send(());
        let _ = self.thread.join();
    }
}

fn failed(error: &dyn std::fmt::Display) -> CommandError {
    CommandError::Failure(format!("the embedded vehicle cannot be started: {error}"))
}

fn run(
    (effects, nonce): (Option<PathBuf>, Nonce),
    stopped: oneshot::Receiver<()>,
    listening: &Sender<Result<u16, CommandError>>,
) -> Result<(), CommandError> {
    let described = parse_vehicle(DEFAULT_VEHICLE, "the vehicle within the program")?.vehicle;
    let settings = Settings {
        effects: concealed(effects.as_deref(), &described)?,
        warm_up: Some(WARM_UP),
        esc_telemetry: true,
        nonce: Some(nonce),
        ..Settings::new(described, Firmware::PX4)
    };
    let system = SystemId(settings.system.into());
    let vehicle = Vehicle::new(settings).map_err(|error| CommandError::Input(error.to_string()))?;
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(|e| failed(&e))?;
    runtime.block_on(async {
        let address: Address = LISTEN.parse().map_err(|error| failed(&error))?;
        let options = LinkOptions { system, component: ComponentId(1), ..LinkOptions::default() };
        let ends = Link::open(&address, options).await.map_err(|error| failed(&error))?;
        let port = ends.0.local_address().map(|local| local.port());
        let port = port.ok_or_else(|| failed(&"its socket has no port"))?;
        // the starter is there until it has heard of it
        let _ = listening.send(Ok(port));
        let stop = async {
            let _ = stopped.await;
        };
        serve(vehicle, vec![(LinkRole::GroundStation, ends)], (Pace::Times(1.0), None), stop).await;
        Ok(())
    })
}
