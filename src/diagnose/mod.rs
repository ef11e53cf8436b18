//! Where simulation and recording differ, which physics was left out, and the better model.

mod along;
mod base;
mod candidates;
mod confusable;
mod deviate;
mod empirical;
mod evidence;
mod explain;
mod explanation;
mod harmonics;
mod latency;
pub mod locate;
pub mod next;
mod nuisances;
pub mod refit;
mod rows;
mod search;
mod sensors;
mod settle;
pub mod show;
mod spin_up;
pub mod together;
mod trace;

pub use along::{Thrusts, Turning, wrench_along};
pub use base::{Base, Present};
pub use candidates::{Candidate, candidates};
pub use deviate::normal_deviate;
pub use empirical::{Along, Empirical};
pub use evidence::{Evidence, Weighted};
pub use explain::{ExplainError, ExplainSettings, explain};
pub use explanation::{Confusable, DetectionLimit, Explanation, Named, NamedParameter, Strength, Verdict};
pub use harmonics::{LackOfFit, Line, flown_period_s, lack_of_fit, period_s};
pub use latency::{LatencyFinding, fit_latency};
pub use rows::{AXES, CHANNEL_NAMES, CHANNELS, Channels, Nuisance, NuisanceColumn, Rows, SECOND};
pub use search::{Fitted, Gates, Search, Step, Tested, fit, search};
pub use trace::{Known, Trace, TraceError};
