//! From regression models to parameters with standard errors.

mod anchor;
mod compensate;
mod contradicted;
mod error;
mod expected;
mod guessed_curve;
mod guessed_torque;
mod identify;
mod information;
mod live;
mod method;
mod nominal;
mod paper_runs;
mod physical;
mod plausible;
mod problem;
mod recommend;
mod recursive;
mod result;
mod theta;
mod thrust_scale;
mod weak;
mod weak_flights;
mod window;

pub use anchor::{apply_anchor, identified_vehicle, rescaled, scaling_mass, thrust_scale};
pub use contradicted::contradicted;
pub use error::EstimateError;
pub use expected::NoiseTerm;
pub use guessed_curve::{GuessedCurve, MovedByCurve, rests_on_guessed_curve};
pub use guessed_torque::torque_by_motion;
pub use identify::{
    Identification, IdentifySettings, contradicting_flights, identify, inertia_by_wider_window,
    moved_by_guessed_curve,
};
pub use information::WeakInformation;
pub use live::RecursiveEstimator;
pub use method::Method;
pub use nominal::Nominal;
pub use physical::{is_physical, nearest_physical, second_moments};
pub use plausible::{Contradiction, FlightApart, contradictions, contradicts_file, flights_apart, stated};
pub use problem::{Channel, Problem, SCORE_LAGS, Solution};
pub use recommend::Recommendation;
pub use recursive::{History, PAPER_SIGMA, PaperEstimate, gradient_descent, least_squares};
pub use result::{
    Estimated, Finding, LARGEST_RELATIVE_STD, MethodResult, POOR, Parameter, RIGID_BODY_ALONE,
    depends_on_band, finding, size_of,
};
pub use theta::{
    INERTIA_ENTRIES, MOMENTS, NAMES, THETA, Theta, ThetaCovariance, UNITS, inertia_of, scale_of, theta_of,
};
pub use thrust_scale::ThrustScale;
pub use weak::{JITTER_STD, Latency, LatencyKind, WeakEstimate, expected_covariance, latency, solve_weak};
