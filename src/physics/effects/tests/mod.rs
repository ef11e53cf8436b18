//! What holds for the effects.

mod catalogue;
mod fixtures;
mod laws;
mod limits;
mod regressors;
mod speed;
