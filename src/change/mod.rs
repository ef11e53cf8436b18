//! What changed of a vehicle between flights: which rotor, the centre of mass, or a parameter, by how much, with its error; and what
//! could not have been seen.

mod balance_change;
mod beside_rotor;
mod both_scales;
mod explanation;
mod groups;
mod history;
mod parameter;
mod pooled;

pub use balance_change::{BalanceChange, BalanceFound, LOADED, Least, NAMED, NAMED_SIGMAS, judge_balance};
pub use beside_rotor::left_beside_rotor;
pub use both_scales::judge_at_both_scales;
pub use explanation::What;
pub use groups::{Groups, Moved, interval_95};
pub use history::{Step, find_returns, steps};
pub use parameter::{ParameterChange, Spread, UNDECIDED, Undecided, judge_parameter};
pub use pooled::{pooled_mean, with_scatter};
