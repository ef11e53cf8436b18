//! From regression models to parameters with standard errors.
mod problem;
pub use problem::{Channel, Problem, Solution};
