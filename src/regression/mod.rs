//! Linear regression models of the rigid body: what multiplies the parameters.

mod standard;

pub use standard::{BodyKinematics, standard_regressor};
