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
pub use knowledge::{Doubted, FirstQuestion, ModeKnowledge};
pub use masters::Masters;
pub use stream::{Guide, Lead, Streamed, Streamer};
pub use sustained::Sustained;
pub use tracking::Tracking;
