//! Answer of the vehicle to a request for a message.

/// Answer of the vehicle to a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// not requested (yet)
    NotAsked,
    /// accepted
    Accepted,
    /// refused, with its MAV_RESULT
    Refused(u8),
    /// no answer to any try
    Silent,
    /// its id or rate is in no message's range, or the vehicle's system id is: not asked
    OutOfRange,
}
