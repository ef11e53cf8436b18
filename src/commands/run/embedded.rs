//! The embedded vehicle of a run: on a thread and a runtime of its own, reached by a socket and by nothing else.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use mavid::link::{Link, LinkOptions};
use mavid::sitl::{LinkRole, Pace, Settings, Vehicle, serve};
use mavid::wire::{ComponentId, Nonce, SystemId};
use tokio::sync::oneshot;
use tokio::time::Instant;

use super::step::Step;
use crate::cli::SitlArgs;
use crate::commands::{CommandError, network, sitl};

/// Any port.
const ANY: &str = "tcpin:127.0.0.1:0";
/// Between two looks whether it stands still.
const LOOK: Duration = Duration::from_millis(10);

/// The vehicle while it runs.
#[derive(Debug)]
pub struct Embedded {
    /// where it listens
    port: u16,
    /// what it is known by: another vehicle on that port is not armed
    pub nonce: Nonce,
    /// the longest time for which it stood still, us
    stood: Arc<AtomicU64>,
    stop: oneshot::Sender<()>,
    thread: JoinHandle<()>,
}

impl Embedded {
    /// Starts it by this step of `mavid sitl`, which names no address; and the step with the address at which it listens.
    pub fn start(step: &Step) -> Result<(Self, Step), CommandError> {
        let args = step.clone().option("--listen", ANY).sitl()?;
        let (stop, stopped) = oneshot::channel();
        let (listening, port) = channel();
        let nonce = Nonce::random();
        let stood = Arc::new(AtomicU64::new(0));
        let seen = stood.clone();
        let work = move || {
            if let Err(error) = run((&args, nonce), stopped, &listening, &seen) {
                // the starter waits for one of both
                let _ = listening.send(Err(error));
            }
        };
        let thread = thread::Builder::new().name("vehicle".into()).spawn(work).map_err(|e| failed(&e))?;
        let port = port.recv().map_err(|error| failed(&error))??;
        let said = step.clone().option("--listen", ANY.replace(":0", &format!(":{port}")));
        Ok((Self { port, nonce, stood, stop, thread }, said))
    }

    /// The address by which it is reached.
    pub fn address(&self) -> String {
        format!("tcpout:127.0.0.1:{}", self.port)
    }

    /// The longest time for which it stood still since it was asked last: this computer kept it waiting.
    pub fn stood(&self) -> Duration {
        Duration::from_micros(self.stood.swap(0, Ordering::Relaxed))
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
    (args, nonce): (&SitlArgs, Nonce),
    stopped: oneshot::Receiver<()>,
    listening: &Sender<Result<u16, CommandError>>,
    stood: &AtomicU64,
) -> Result<(), CommandError> {
    let settings = Settings { nonce: Some(nonce), ..sitl::settings(args)? };
    let address = network::address("--listen", args.listen.first().map_or(ANY, String::as_str))?;
    let system = SystemId(settings.system.into());
    let vehicle = Vehicle::new(settings).map_err(|error| CommandError::Input(error.to_string()))?;
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(|e| failed(&e))?;
    runtime.block_on(async {
        let options =
            LinkOptions { system, component: ComponentId(1), patient: true, ..LinkOptions::default() };
        let ends = Link::open(&address, options).await.map_err(|error| failed(&error))?;
        let port = ends.0.local_address().map(|local| local.port());
        let port = port.ok_or_else(|| failed(&"its socket has no port"))?;
        // the starter is there until it has heard of it
        let _ = listening.send(Ok(port));
        let stop = async {
            let _ = stopped.await;
        };
        let links = vec![(LinkRole::GroundStation, ends)];
        tokio::select! {
            _ = serve(vehicle, links, (Pace::Times(args.speed), None), stop) => {}
            () = watch_over(stood) => {}
        }
        Ok(())
    })
}

/// Notes without end how long the thread of the vehicle stood still: for how much longer than it was asked to it sleeps.
async fn watch_over(stood: &AtomicU64) {
    loop {
        let since = Instant::now();
        tokio::time::sleep(LOOK).await;
        let late = since.elapsed().saturating_sub(LOOK);
        stood.fetch_max(u64::try_from(late.as_micros()).unwrap_or(u64::MAX), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The clock stands still but for what is waited for.
    #[tokio::test(start_paused = true)]
    async fn a_vehicle_that_is_kept_waiting_says_for_how_long() {
        let stood = AtomicU64::new(0);
        let watched = async {
            tokio::time::sleep(Duration::from_secs(1)).await;
            assert!(stood.load(Ordering::Relaxed) <= 2000, "{stood:?}");
            // nobody looked meanwhile
            tokio::time::advance(Duration::from_millis(640)).await;
            tokio::time::sleep(Duration::from_secs(1)).await;
        };
        tokio::select! {
            () = watched => {}
            () = watch_over(&stood) => {}
        }
        let stood_ms = stood.load(Ordering::Relaxed) / 1000;
        assert!((625..=645).contains(&stood_ms), "{stood_ms}");
    }
}
