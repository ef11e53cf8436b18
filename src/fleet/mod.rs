//! Many logs of many vehicles: one log as rows of tables, and the tables as each vehicle's history.

mod alarms;
mod history;
mod of_flight;
mod of_log;
mod outliers;
mod parts;
mod place;
mod report;
mod rows;
mod schema;
mod sources;
mod task;
mod transfer;
mod vehicles;

pub use alarms::{FALSE_ALARMS, FalseAlarms, SHUFFLES, calibrated, judge};
pub use history::{MOST_FLIGHTS, VehicleHistory, histories};
pub use of_log::{error_rows, log_rows};
pub use outliers::{Outlier, outliers};
pub use parts::{Listed, PartForm, PartList, PartsError, PartsFolder};
pub use report::{FleetReport, ReportSettings, ReportedVehicle};
pub use rows::{
    EffectRow, FlightRow, LegRow, LogRow, LogRows, ParameterRow, ProvenanceRow, ResidualRow, SCHEMA,
    WarningRow,
};
pub use schema::{Schema, TableSchema};
pub use sources::{At, Shard, Source, SourceError, sources, unread_name};
pub use task::{LogSettings, LogTask, hexadecimal, program};
pub use transfer::{rows_of_text, rows_text};
pub use vehicles::{FleetVehicle, OfLog, Vehicles, VehiclesError};
