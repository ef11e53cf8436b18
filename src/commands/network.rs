//! What the verbs that talk to vehicles share.

use std::future::Future;
use std::time::Duration;

#[cfg(unix)]
use mavid::fly::HangUp;
use mavid::link::{Address, AddressError, Ends, Link, LinkError, LinkOptions};

use super::CommandError;

/// How long the end of a verb waits for what it has left running.
const LET_GO: Duration = Duration::from_millis(500);

/// Runs a verb on the runtime.
pub fn block_on<T>(verb: impl Future<Output = Result<T, CommandError>>) -> Result<T, CommandError> {
    let runtime = tokio::runtime::Runtime::new()
        .map_err(|error| CommandError::Failure(format!("cannot start the runtime: {error}")))?;
    let outcome = runtime.block_on(verb);
    // until the tasks of links have let go of their sockets: the next step may want the same port. A thread that a serial
    // driver holds is not waited for longer
    runtime.shutdown_timeout(LET_GO);
    outcome
}

/// The address that the user gave with an option.
pub fn address(option: &str, text: &str) -> Result<Address, CommandError> {
    text.parse().map_err(|error: AddressError| CommandError::Input(format!("{option}: {error}")))
}

/// Opens the link that the user named.
pub async fn open(address: &Address, options: LinkOptions) -> Result<Ends, CommandError> {
    Link::open(address, options).await.map_err(|error| match error {
        LinkError::Unavailable { .. } => CommandError::Input(error.to_string()),
        _ => CommandError::Failure(error.to_string()),
    })
}

/// Until the user or the system asks the program to end.
pub async fn interrupted() -> Result<(), CommandError> {
    Signals::new()?.next().await.map(|_| ())
}

/// The ways in which the program is asked to end. From the first of these on the system does not end it by itself.
#[derive(Debug)]
pub struct Signals {
    #[cfg(unix)]
    interrupt: tokio::signal::unix::Signal,
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
    #[cfg(unix)]
    hang_up: HangUp,
}

impl Signals {
    /// Listens from now on.
    pub fn new() -> Result<Self, CommandError> {
        #[cfg(unix)]
        {
            use tokio::signal::unix::{SignalKind, signal};
            Ok(Self {
                interrupt: signal(SignalKind::interrupt()).map_err(|error| no_signals(&error))?,
                terminate: signal(SignalKind::terminate()).map_err(|error| no_signals(&error))?,
                hang_up: HangUp::new().map_err(|error| no_signals(&error))?,
            })
        }
        #[cfg(not(unix))]
        Ok(Self {})
    }

    /// The name of the next.
    pub async fn next(&mut self) -> Result<&'static str, CommandError> {
        #[cfg(unix)]
        tokio::select! {
            _ = self.interrupt.recv() => Ok("Ctrl-C"),
            _ = self.terminate.recv() => Ok("SIGTERM"),
            () = self.hang_up.came() => Ok("SIGHUP"),
        }
        #[cfg(not(unix))]
        tokio::signal::ctrl_c().await.map(|()| "Ctrl-C").map_err(|error| no_signals(&error))
    }
}

fn no_signals(error: &std::io::Error) -> CommandError {
    CommandError::Failure(format!("cannot wait for an interrupt: {error}"))
}
