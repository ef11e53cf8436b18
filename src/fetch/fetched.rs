//! What is known of a log that was fetched.

/// The checksum of a log by its vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sum {
    /// the vehicle calculates none
    NotOffered,
    /// it does, but did not answer
    Unanswered,
    /// it says this
    Is(u32),
}

/// What is known of a log that was fetched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fetched {
    /// bytes: as many as the vehicle stated when the download began
    pub size: u64,
    /// the vehicle's checksum of all that it has of it
    pub sum: Sum,
    /// the vehicle wrote on meanwhile: bytes that it has now. The checksum is not of what was fetched then
    pub grown_to: Option<u64>,
}
