//! Everything that is checked before a vehicle is armed: the whole trajectory against fence, room, vehicle
//! and autopilot, and whether the vehicle is ready.

mod abandoned;
mod aftermath;
mod autopilot;
mod energy;
mod failsafes;
mod fence;
mod fence_clearance;
mod fence_download;
mod hover;
mod judgement;
mod logging;
mod page;
mod readiness;
mod room;
mod situation;
mod stopping;

pub use autopilot::{LIMIT_RESERVE, LimitShortfall, limit_shortfalls};
pub use energy::{BatteryState, SPARE_FACTOR};
pub use fence::Fence;
pub use fence_download::{FenceDownload, FenceOutcome};
pub(crate) use hover::{HOVER, ROTORS};
pub use judgement::{Judged, judge, preflight};
pub use page::Page;
pub use readiness::{ESTIMATE_GOOD_FOR, Readiness};
pub use situation::Situation;
pub use stopping::Stopping;
