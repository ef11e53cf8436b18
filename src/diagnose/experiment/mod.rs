//! The next flight: the trajectory inside the vehicle's limits that distinguishes best what the flights so far
//! cannot.
//!
//! For every pair (an effect that was named, another that could stand for it) the expected distance is
//! `d^2 = theta' X' (I - P) X theta`, X the effect's weak-form columns less all that nuisances can do, P the
//! projection onto the other effect's columns: the noncentrality of the test between the two
//! (T-optimality). The smallest distance of all pairs is made as large as the limits allow.

mod design;
mod envelope;
mod error;
mod flight;
mod foresight;
mod search;
mod settings;

pub use design::{design, told_apart};
pub use envelope::flown_limits;
pub use error::NextError;
pub use flight::{Inseparable, NextFlight, Pair};
pub use settings::NextSettings;
