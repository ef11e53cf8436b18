//! What holds for the effects.

mod bounds;
mod catalogue;
mod fixtures;
mod laws;
mod limits;
mod regressors;
mod speed;
