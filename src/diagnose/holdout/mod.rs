//! The better model on flights that it has not seen.
//!
//! Everything is frozen as it was identified, but for what belongs to a moment (when a load was dropped).
//! `before` is the rigid body identified on the same flights without effects, so that no effect is paid
//! for by a wrong mass. Intervals come from resampled blocks of the flight, the same for both models.

mod bootstrap;
mod carried;
mod closed_loop;
mod error;
mod floor;
mod hold_out;
mod open_loop;
mod other_vehicle;
mod ready;
mod settings;
mod shown;
mod split;
mod weak;

pub use bootstrap::{Compared, Interval};
pub use closed_loop::ClosedLoop;
pub use error::HoldoutError;
pub use floor::{command_noise, state_noise};
pub use hold_out::{on_holdout, on_identification};
pub use open_loop::{OpenLoop, WINDOWS_S};
pub use other_vehicle::{Agreement, Difference, OtherVehicle, differing};
pub use settings::{HeldOut, HoldoutSettings};
pub use shown::HoldoutFit;
pub use split::{Split, split_last_periods};
