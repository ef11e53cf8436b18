//! The optimized excitation trajectory: the finite Fourier series (18) that minimises a criterion of the
//! regressor `W` (20) inside the bounds (22)-(25) and those of roll, pitch, thrust and torque.
//!
//! ```text
//! space        (18) with the start conditions eliminated
//! sensitivity  (26), (27), (12) and their exact slopes
//! information  W^T D W and its slope
//! criterion    cond, scaled cond, D, A as functions of that matrix
//! bounds       what must hold; check: does it, on 2 ms samples
//! quadratic, descent, optimise   one step, one start, many starts
//! noise, expected   what the flight will determine, and how well
//! excitation   from limits to a plan
//! room         walls, ceiling and floor where none are stated; wall: their words and keys
//! ```

mod bounds;
mod check;
mod criterion;
mod descent;
mod excitation;
mod expected;
mod extremes;
mod feasible;
mod information;
mod noise;
mod optimise;
mod quadratic;
mod request;
mod room;
mod sensitivity;
mod space;
mod transition;
mod wall;

pub use bounds::{
    AHEAD_S, Bound, Dynamics, Instant, Quantity, ROTOR_MARGINS, RotorMargin, bounds_of, bounds_to_plan_in,
    parameters_of,
};
pub use check::{CheckReport, Margin, SAMPLE_S, Violation, check};
pub use criterion::{Criterion, condition_number, scaled_condition_number};
pub use excitation::{assess, plan, search_of, work_of};
pub use expected::{FlightSpan, expected_standard_errors, share_at_bound};
pub use extremes::{Extremes, path_samples};
pub use feasible::{Conflict, StartPlace, feasible};
pub use information::{GramSampler, Matrix7};
pub use noise::{NoiseModel, PARAMETERS, RowMotion, RowSpacing, parameter_scale};
pub use optimise::{Round, Search};
pub use request::{Assessment, Plan, PlanError, PlanRequest, RestInside};
pub use room::{HEIGHT_ERROR_M, Reach, Roomed, floor_m, too_narrow, with_room};
pub use space::{AxisStart, SeriesSpace};
pub use transition::{FlightPlan, HOVER_S, TransitionError, flight_path};
pub use wall::Wall;
