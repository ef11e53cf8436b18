//! Bounds of the process that studies one log: the system holds them, whatever the log makes of the program.

use std::time::Duration;

use crate::cli::FleetStudyArgs;

/// What one log may take.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// processor time, s
    pub time_s: u64,
    /// memory, MB
    pub memory_mb: u64,
}

/// What each of many logs may be and take.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// of the process that studies it
    pub limits: Limits,
    /// bytes of the largest log that is read
    pub most_bytes: u64,
}

impl Bounds {
    /// As they were given.
    pub fn of(args: &FleetStudyArgs) -> Self {
        Self {
            limits: Limits { time_s: args.log_time, memory_mb: args.log_memory },
            most_bytes: args.log_size.saturating_mul(1 << 20),
        }
    }

    /// Why a log of so many bytes is not read.
    pub fn refused(&self, bytes: u64) -> Option<String> {
        let most = self.most_bytes;
        (bytes > most).then(|| format!("expected a log of at most {} MB, got {} MB", most >> 20, bytes >> 20))
    }
}

/// Time on the wall over processor time after which a process is ended all the same: it waits for a file that does not come.
const PATIENCE: u32 = 10;

impl Limits {
    /// Until it is ended from outside.
    pub fn patience(&self) -> Duration {
        Duration::from_secs(self.time_s).saturating_mul(PATIENCE)
    }

    /// Bounds this process; where the system has no such bounds, the time alone is held, from outside.
    #[cfg(unix)]
    pub fn take_hold(self) -> Result<(), String> {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
        let bound = |resource, most: u64| {
            // no more than what holds already
            let most = getrlimit(resource).maximum.map_or(most, |held| held.min(most));
            setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) })
                .map_err(|error| error.to_string())
        };
        bound(Resource::Cpu, self.time_s)?;
        bound(Resource::As, self.memory_mb.saturating_mul(1 << 20))?;
        bound(Resource::Core, 0)
    }

    /// See the other.
    #[cfg(not(unix))]
    pub fn take_hold(self) -> Result<(), String> {
        Ok(())
    }
}
