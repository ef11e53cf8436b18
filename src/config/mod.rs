//! Configuration files: what the user wrote (TOML, unknown keys refused), then what it means (checked, SI).

mod check;
mod csv_mapping;
mod csv_proposal;
mod effect_tables;
mod effects;
mod error;
mod faults;
mod form;
mod kind;
mod propulsion;
mod read;
mod rigid_body;
mod trajectory;
mod vehicle;
mod vehicle_file;
mod vehicle_writer;

pub use csv_mapping::{load_csv_mapping, parse_csv_mapping};
pub use csv_proposal::{CsvProposal, propose_csv_mapping};
pub use effect_tables::{parse_effect_tables, read_effect_tables};
pub use effects::{each_once, effects_of};
pub use error::ConfigError;
pub use trajectory::{
    StoredTrajectory, StoredTransitions, parse_limits, parse_trajectory, read_limits, read_trajectory,
    trajectory_to_toml,
};
pub use vehicle::{LoadedVehicle, ModelTables, load_vehicle, parse_vehicle, read_vehicle};
pub use vehicle_writer::vehicle_to_toml;
