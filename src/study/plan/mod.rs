//! An excitation trajectory for a vehicle: planned, checked or a circle, with all that is flown around it.

mod request;
mod result;
mod run;

pub use request::{Circle, PlannedSeries, PlanningRequest};
pub use result::{FlightExtremes, PlanStudy};
pub use run::plan_flight;
