//! From regression models to parameters with standard errors.

mod anchor;
mod compensate;
mod error;
mod expected;
mod identify;
mod information;
mod live;
mod method;
mod nominal;
mod physical;
mod plausible;
mod problem;
mod recommend;
mod recursive;
mod result;
mod rotor_check;
mod theta;
mod weak;
mod window;

pub use anchor::{ThrustScale, apply_anchor, identified_vehicle, rescaled, thrust_scale};
pub use error::EstimateError;
pub use expected::NoiseTerm;
pub use identify::{Identification, IdentifySettings, identify, inertia_by_wider_window};
pub use information::WeakInformation;
pub use live::RecursiveEstimator;
pub use method::Method;
pub use nominal::Nominal;
pub use physical::{is_physical, nearest_physical, second_moments};
pub use plausible::{Contradiction, contradictions};
pub use problem::{Channel, Problem, Solution};
pub use recommend::Recommendation;
pub use recursive::{GradientStep, History, PAPER_SIGMA, PaperEstimate, gradient_descent, least_squares};
pub use result::{Estimated, Finding, MethodResult, Parameter, finding};
pub use rotor_check::WeakRotor;
pub use theta::{NAMES, THETA, Theta, ThetaCovariance, UNITS, inertia_of, scale_of, theta_of};
pub use weak::{Latency, LatencyKind, WeakEstimate, WeakMethod, expected_covariance, latency, solve_weak};
