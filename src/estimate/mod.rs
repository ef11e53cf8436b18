//! From regression models to parameters with standard errors.

mod physical;
mod problem;
mod recursive;
mod theta;
mod weak;

pub use physical::{is_physical, nearest_physical, second_moments};
pub use problem::{Channel, Problem, Solution};
pub use recursive::{GradientStep, History, PAPER_SIGMA, PaperEstimate, gradient_descent, least_squares};
pub use theta::{NAMES, THETA, Theta, ThetaCovariance, UNITS, inertia_of, scale_of, theta_of};
pub use weak::{Latency, LatencyKind, WeakEstimate, WeakMethod, latency, solve_weak};
