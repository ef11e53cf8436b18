//! `compare`: one vehicle over its flights, and what changed of it.

mod along;
mod back;
mod by_motion;
mod judge;
mod lifts;
mod motion;
mod order;
mod request;
mod result;
mod run;
mod scale;
mod usable;

pub use by_motion::WeakAlone;
pub use judge::Judge;
pub(super) use lifts::are_apart;
pub(super) use motion::is_compared;
pub use request::CompareRequest;
pub use result::{
    Change, Changed, CompareStudy, Compared, ComparedFlight, LeastChange, LeftOut, LiftsApart, LiftsOf,
    UndecidedAlong,
};
pub use run::compare;
pub(super) use run::{UNKNOWN, power_w};
pub use scale::ScaleMoved;
