//! The equations of motion, and the physical effects that a rigid body with exact thrust leaves out.
//!
//! Everything here is SI, body FLU, world NWU. Vectors are bare nalgebra vectors because this is the
//! inner loop of simulation and regression; each says its frame.

mod active_effect;
mod actuator;
mod airframe;
mod beyond;
mod capacity;
mod effect;
pub mod effects;
mod equation;
mod error;
mod euler;
mod input;
mod measurement;
mod model;
mod parameter;
mod rigid_body;
mod state;

pub use active_effect::ActiveEffect;
pub use actuator::{ActuationLatency, RotorLag, RotorStep, delayed_thrusts_n, delayed_wrench};
pub use airframe::Airframe;
pub(crate) use beyond::Beyond;
pub use capacity::MAX_ROTORS;
pub use effect::{Condition, Effect, Hook, Own, Rotors, effect_wrench, effects_wrench};
pub use error::PhysicsError;
pub use euler::{euler_rates, euler_rates_inverse};
pub use input::Input;
pub use measurement::Measurement;
pub(crate) use model::OwnStates;
pub use model::{Evaluation, Model};
pub use parameter::{Bounds, Parameter, REFERENCE_SIZE, WHICH_ROTOR};
pub use rigid_body::{RigidBodyModel, pseudo_inertia_is_positive};
pub use state::{RIGID_STATES, State, StateDerivative, Wrench};
