//! Which of two ways a log is fetched by, and why.

use std::fmt;

use super::remote::Protocol;

/// What the other way was found to be.
#[derive(Debug, Clone, PartialEq)]
pub enum OtherWay {
    /// it brings so many bytes a second
    Brings(f64),
    /// it is none for this log
    None(String),
}

/// Which way a log is fetched by, where the file transfer was slow.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// the way that was kept
    pub protocol: Protocol,
    /// bytes a second of the file transfer
    pub ftp_bytes_s: f64,
    /// log messages
    pub log: OtherWay,
}

impl fmt::Display for Chosen {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { protocol, ftp_bytes_s, log } = self;
        write!(out, "file transfer brings {:.0} kB/s, ", ftp_bytes_s / 1e3)?;
        match log {
            OtherWay::Brings(bytes_s) => write!(out, "log messages {:.0} kB/s", bytes_s / 1e3)?,
            OtherWay::None(why) => write!(out, "log messages do not bring this log ({why})")?,
        }
        write!(out, ": going on by {}", protocol.words())
    }
}
