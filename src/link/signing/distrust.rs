//! Why a frame is not believed.

use std::fmt;

/// Why a frame is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distrust {
    /// it carries no signature
    Unsigned,
    /// it is MAVLink 1, which has no signatures
    Downgraded,
    /// its signature was not made with our key
    Wrong,
    /// its time was heard already
    Replayed,
    /// the first of its stream in this run, and signed too far in the past
    Old {
        /// s behind our signing time
        behind_s: u64,
    },
}

impl fmt::Display for Distrust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsigned => f.write_str(
                "it does not sign; set the key up on the vehicle (over USB), or leave out --signing-key-file",
            ),
            Self::Downgraded => f.write_str(
                "it speaks MAVLink 1, which cannot be signed; set its port to MAVLink 2 (PX4: MAV_PROTO_VER, ArduPilot: \
                 SERIALn_PROTOCOL)",
            ),
            Self::Wrong => f.write_str(
                "it signs with another key; expected the vehicle's key in the file of --signing-key-file, or set this \
                 one up on the vehicle",
            ),
            Self::Replayed => f.write_str(
                "it sends what was received before: somebody replays messages, or the vehicle's signing time does not \
                 advance",
            ),
            Self::Old { behind_s } => write!(
                f,
                "it signs {behind_s} s in the past, expected at most 60 s; set the clock of the vehicle (by GPS or \
                 SYSTEM_TIME) or of this computer",
            ),
        }
    }
}
