//! What ends a flight, each rule on its own: values in, a [`Cause`](super::Cause) out.

mod bounds;
mod envelope;
mod feeding;
mod knowledge;
mod masters;
mod stream;
mod tracking;

pub use bounds::SetpointBounds;
pub use envelope::Envelope;
pub use feeding::Feeding;
pub use knowledge::{Doubted, ModeKnowledge};
pub use masters::Masters;
pub use stream::{Guide, Lead, Streamed, Streamer};
pub use tracking::Tracking;

use std::time::Duration;

/// How long a condition has held without a break.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sustained {
    since: Option<Duration>,
}

impl Sustained {
    /// Takes the condition of now; gives for how long it holds.
    pub fn update(&mut self, now: Duration, holds: bool) -> Duration {
        if !holds {
            self.since = None;
            return Duration::ZERO;
        }
        now.saturating_sub(*self.since.get_or_insert(now))
    }
}
