//! What ends a flight, each rule on its own: values in, a [`Cause`](super::Cause) out.

mod bounds;
mod envelope;
mod feeding;
mod knowledge;
mod masters;
mod stream;
mod sustained;
mod tracking;

pub use bounds::SetpointBounds;
pub use envelope::Envelope;
pub use feeding::Feeding;
pub(in crate::fly) use knowledge::SHORT;
pub use knowledge::{Doubted, FirstQuestion, ModeKnowledge};
pub use masters::Masters;
pub(in crate::fly) use stream::SILENT_AFTER;
pub use stream::{Guide, Lead, Streamed, Streamer};
pub use sustained::Sustained;
pub use tracking::Tracking;
