//! Why logs are not listed or fetched.

use super::remote::MOST_BYTES;

/// Why logs are not listed or fetched.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FetchError {
    /// nothing came any more
    #[error("expected {expected}, nothing came in {tries} tries over {seconds} s")]
    Silent {
        /// what was waited for
        expected: String,
        /// requests sent
        tries: u32,
        /// since the first of them, or since something came last
        seconds: u64,
    },
    /// the vehicle said no
    #[error("asked for {asked}, the vehicle refuses: {why}")]
    Refused {
        /// what was asked for
        asked: String,
        /// its reason
        why: String,
    },
    /// a parameter stays what it was
    #[error("expected {name} = {requested} after setting it, the vehicle says {came}")]
    NotSet {
        /// which
        name: String,
        /// what was asked for
        requested: f64,
        /// what it is
        came: String,
    },
    /// the file is not as long as the vehicle said
    #[error("expected a log of {stated} bytes, as the vehicle states it; it ends after {came}")]
    Short {
        /// bytes that were stated
        stated: u64,
        /// bytes that there are
        came: u64,
    },
    /// more than a log can be
    #[error("expected a log of at most {MOST_BYTES} bytes, the vehicle states {stated}")]
    TooLong {
        /// bytes that were stated
        stated: u64,
    },
    /// a vehicle that no message can name
    #[error("expected a vehicle with a system id of 1 to 255, got {0}")]
    NoTarget(u32),
}
