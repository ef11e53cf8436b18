//! The better model on hold-out flights.
//!
//! All parameters are frozen as identified, except those that belong to a time (when a load was dropped). `before` is
//! the rigid body identified on the same flights without effects, so that no effect compensates for a wrong mass.
//! Intervals come from a bootstrap over blocks of the flight, with the same blocks for both models.

mod agreement;
mod bootstrap;
mod carried;
mod closed_loop;
mod difference;
mod error;
mod floor;
mod hold_out;
mod holdout_fit;
mod loading;
mod open_loop;
mod other_vehicle;
mod rate_law;
mod ready;
mod settings;
mod split;
mod weak;
mod what_is_left;
mod without;

pub use agreement::Agreement;
pub use bootstrap::{AtEnd, Compared, Interval};
pub use closed_loop::ClosedLoop;
pub use difference::{Difference, OtherVehicle};
pub use error::HoldoutError;
pub use floor::{command_noise, state_noise};
pub use hold_out::{IdentificationFit, on_holdout, on_identification, on_left_out};
pub use holdout_fit::HoldoutFit;
pub use open_loop::{HALF_S, OpenLoop, WINDOWS_S};
pub use other_vehicle::differing;
pub use rate_law::RateLaw;
pub use settings::{Explained, HeldOut, HoldoutSettings};
pub use split::{Split, flown_period_s, split_last_periods};
pub use without::{HALF_SECOND, SquaredErrors, WindowError, Without, without_each};
