//! Linear regression models of the rigid body: what multiplies the parameters.

mod filtered;
mod paper_models;
mod phi;
mod prediction;
mod standard;
mod weak_form;

pub use filtered::{RATE_PAIRS, gyroscopic_from_products, gyroscopic_regressor, momentum_regressor};
pub use paper_models::{SampledModel, ZeroPhase, paper_models};
pub use phi::Phi;
pub use prediction::output_prediction_rms;
pub use standard::{BodyKinematics, standard_regressor};
pub use weak_form::{CHANNELS, VerticalMotion, WeakMotion, WeakRows, weak_rows};
