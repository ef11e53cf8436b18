//! MAVLink 2 message signing: <https://mavlink.io/en/guide/message_signing.html>.
//!
//! ```text
//! signature = first 48 bits of SHA-256(key + marker, header, payload, checksum + link id + time)
//! ```
//!
//! Time counts 10 microseconds since 2015-01-01 UTC and never repeats; it and the last time heard of each
//! stream are kept in a file beside the key's, so that neither a restart nor a clock set back lets an old
//! frame through, or locks us out.

mod clock;
mod distrust;
mod error;
mod key;
mod owner;
mod reported_signatures;
mod signature;
mod signer;
#[cfg(test)]
mod tests;
mod times;

pub(crate) use clock::time_of;
pub use distrust::Distrust;
pub use error::SigningError;
pub use key::SigningKey;
pub(super) use reported_signatures::ReportedSignatures;
pub(crate) use signature::TAIL_BYTES;
pub use signer::Signing;
