//! What the verbs that talk to vehicles share.

use std::future::Future;

use mavid::link::{Address, AddressError, Ends, Link, LinkError, LinkOptions};

use super::CommandError;

/// Runs a verb on the runtime.
pub fn block_on<T>(verb: impl Future<Output = Result<T, CommandError>>) -> Result<T, CommandError> {
    let runtime = tokio::runtime::Runtime::new()
        .map_err(|error| CommandError::Failure(format!("cannot start the runtime: {error}")))?;
    let outcome = runtime.block_on(verb);
    // a thread that a serial driver holds is not waited for
    runtime.shutdown_background();
    outcome
}

/// The address that the user gave.
pub fn address(text: &str) -> Result<Address, CommandError> {
    text.parse().map_err(|error: AddressError| CommandError::Input(error.to_string()))
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
    let failed =
        |error: std::io::Error| CommandError::Failure(format!("cannot wait for an interrupt: {error}"));
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminate = signal(SignalKind::terminate()).map_err(failed)?;
        let mut hang_up = signal(SignalKind::hangup()).map_err(failed)?;
        tokio::select! {
            pressed = tokio::signal::ctrl_c() => pressed.map_err(failed),
            _ = terminate.recv() => Ok(()),
            _ = hang_up.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    tokio::signal::ctrl_c().await.map_err(failed)
}
