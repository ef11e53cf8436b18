//! The ways in which a program is told to end.

use super::error::RunError;

/// The ways in which a program is told to end.
pub(super) struct Ends {
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
    #[cfg(unix)]
    hang_up: HangUp,
}

impl Ends {
    pub(super) fn new() -> Result<Self, RunError> {
        #[cfg(unix)]
        {
            use tokio::signal::unix::{SignalKind, signal};
            let make = |source| RunError::Make { what: "a signal handler".to_owned(), source };
            Ok(Self {
                terminate: signal(SignalKind::terminate()).map_err(make)?,
                hang_up: HangUp::new().map_err(make)?,
            })
        }
        #[cfg(not(unix))]
        Ok(Self {})
    }

    pub(super) async fn next_signal(&mut self) -> &'static str {
        #[cfg(unix)]
        tokio::select! {
            _ = tokio::signal::ctrl_c() => "Ctrl-C",
            _ = self.terminate.recv() => "SIGTERM",
            () = self.hang_up.came() => "SIGHUP",
        }
        #[cfg(not(unix))]
        {
            let _ = tokio::signal::ctrl_c().await;
            "Ctrl-C"
        }
    }
}

/// The end of the terminal from which a program was started. Started so as to outlive it (`nohup`), the program continues.
#[cfg(unix)]
#[derive(Debug)]
pub struct HangUp(Option<tokio::signal::unix::Signal>);

#[cfg(unix)]
impl HangUp {
    /// Listens from now on.
    ///
    /// # Errors
    /// The system permits no handler, or there is no runtime.
    pub fn new() -> std::io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};
        // a handler would put an end to its being ignored
        if is_ignored(SignalKind::hangup().as_raw_value()) {
            return Ok(Self(None));
        }
        signal(SignalKind::hangup()).map(|hang_up| Self(Some(hang_up)))
    }

    /// Until it comes.
    pub async fn came(&mut self) {
        match &mut self.0 {
            Some(hang_up) => {
                hang_up.recv().await;
            }
            None => std::future::pending().await,
        }
    }
}

/// Whether whoever started the program had this signal ignored. Where the system does not tell, it is taken for one that
/// is not.
#[cfg(unix)]
fn is_ignored(signal: std::ffi::c_int) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    u32::try_from(signal - 1).is_ok_and(|bit| mask.checked_shr(bit).is_some_and(|mask| mask & 1 == 1))
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_ignored_is_told_by_the_system() {
        // every program of this language begins with SIGPIPE ignored, and none with SIGSEGV
        assert_eq!((is_ignored(13), is_ignored(11), is_ignored(0)), (true, false, false));
    }
}
