//! The message set that identification needs: asked for, measured, and judged.
//!
//! ```text
//! what to ask (streams) -> asked, one after the other -> what really arrives over some seconds -> does it suffice
//! ```

mod answer;
mod asking;
mod capacity;
mod report;
mod streams;

pub use answer::Answer;
pub use asking::{RequestSettings, Requests};
pub use capacity::{Capacity, LinkKind, granted_hz};
pub use report::{NeedReport, RatesReport, StreamReport};
pub use streams::{Need, StreamRequest, request_set, slow_request_set};
