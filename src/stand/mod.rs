//! What a thrust stand measured of one rotor: a table by its header, and what follows for the vehicle.
//!
//! Stands write a row for each instant or step, with names and units of the columns in the first line, such as
//! `ESC signal (us)`, `Throttle (%)`, `Thrust (kgf)`, `Torque (N m)`, `Motor Optical Speed (RPM)`, `Voltage (V)`.

mod column;
mod error;
mod fit;
mod propulsion;
mod steps;
mod table;

pub use column::StandQuantity;
pub use error::StandError;
pub use fit::Measured;
pub use propulsion::{StandResult, measured_propulsion};
pub use table::{StandTable, parse_table, read_table};
