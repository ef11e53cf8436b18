//! The optimized excitation trajectory.
pub mod bounds;
pub mod criterion;
pub mod descent;
pub mod information;
pub mod quadratic;
pub mod sensitivity;
pub mod space;
pub mod noise;
pub mod optimise;
