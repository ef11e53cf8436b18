//! `compare`: one vehicle over its flights, and what changed of it.

mod motion;
mod request;
mod result;
mod run;
mod same_vehicle;

pub use request::CompareRequest;
pub use result::{Change, Changed, CompareStudy, Compared, ComparedFlight, LeastChange};
pub use run::compare;
