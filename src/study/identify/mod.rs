//! Mass, inertia and, where asked for, effects from recorded flights.

mod joint_estimate;
mod recorded;
mod request;
mod result;
mod run;

pub use recorded::{COMPONENTS, RotorsAndMotion};
pub use request::IdentifyRequest;
pub use result::{IdentifyStudy, Misfit, WithEffects};
pub use run::identify;
