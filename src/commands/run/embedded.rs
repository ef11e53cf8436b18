//! The embedded vehicle of a run: on a thread and a runtime of its own, reached by a socket and by nothing else.

use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use mavid::link::{Link, LinkOptions};
use mavid::sitl::{LinkRole, Pace, Settings, Vehicle, serve};
use mavid::wire::{ComponentId, Nonce, SystemId};
use tokio::sync::oneshot;

use super::step::Step;
use crate::cli::SitlArgs;
use crate::commands::{CommandError, network, sitl};

/// Any port.
const ANY: &str = "tcpin:127.0.0.1:0";

/// The vehicle while it runs.
#[derive(Debug)]
pub struct Embedded {
    /// where it listens
    port: u16,
    /// what it is known by: another vehicle on that port is not armed
    pub nonce: Nonce,
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
        let work = move || {
            if let Err(error) = run(&args, nonce, stopped, &listening) {
                // the starter waits for one of both
                let _ = listening.send(Err(error));
            }
        };
        let thread = thread::Builder::new().name("vehicle".into()).spawn(work).map_err(|e| failed(&e))?;
        let port = port.recv().map_err(|error| failed(&error))??;
        let said = step.clone().option("--listen", ANY.replace(":0", &format!(":{port}")));
        Ok((Self { port, nonce, stop, thread }, said))
    }

    /// The address by which it is reached.
    pub fn address(&self) -> String {
        format!("tcpout:127.0.0.1:{}", self.port)
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
    args: &SitlArgs,
    nonce: Nonce,
    stopped: oneshot::Receiver<()>,
    listening: &Sender<Result<u16, CommandError>>,
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
        serve(vehicle, vec![(LinkRole::GroundStation, ends)], (Pace::Times(args.speed), None), stop).await;
        Ok(())
    })
}
