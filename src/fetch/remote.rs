//! A log on a vehicle.

/// Bytes of a log, at most: half of what a number of the messages can say, and as much as a file of a FAT32 card that
/// ArduPilot writes.
pub const MOST_BYTES: u64 = 1 << 31;

/// How logs are fetched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// MAVLink's file transfer: files by their paths, in bursts, with a checksum
    Ftp,
    /// LOG_REQUEST_LIST and LOG_REQUEST_DATA: logs by their numbers
    Log,
}

impl Protocol {
    /// Its name on the command line and in documents.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Ftp => "ftp",
            Self::Log => "log",
        }
    }

    /// In a sentence.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Ftp => "file transfer",
            Self::Log => "log messages",
        }
    }
}

/// Where a log is on the vehicle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// its path, as the file transfer names it
    Path(String),
    /// its number among the log messages
    Number(u16),
}

/// A log on a vehicle, as the vehicle states it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemoteLog {
    /// by which it is asked for: ArduPilot's own number, PX4's counted from 0, the oldest first. `None` where not all logs
    /// are known
    pub id: Option<u32>,
    /// where it is
    pub place: Place,
    /// bytes
    pub size: u64,
    /// seconds since 1970 at which it began or ended, where the vehicle says so
    pub time_s: Option<u32>,
}

/// Which logs are to be listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LogSelection {
    /// all of them
    All,
    /// the last one, and others only where they come with it
    Last,
}
