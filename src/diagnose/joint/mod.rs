//! Named effects identified together with the rigid body.
//!
//! The base is the rigid body with the named effects present; Gauss-Newton on the weak-form rows fits mass,
//! inertia, latency, nuisances and every free parameter of the effects at once, and the standard errors are those of
//! the evidence. What is not smooth (which rotor, when, how long a cord, which law) is profiled: each form is fitted
//! and the most likely is taken. A lag or delay is kept as the named kind and goes through the latency.

mod choose;
mod error;
mod finding;
mod held;
mod identify;
mod latency;
mod requested;
mod result;
mod scale;
mod swing;

pub use error::JointError;
pub use finding::{EffectFound, Found, ParameterFound};
pub use identify::identify_jointly;
pub use requested::RequestedEffects;
pub use result::{JointEstimate, Physical};
