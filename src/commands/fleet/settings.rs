//! How the logs are studied, from the command line.

use std::path::PathBuf;

use super::identity::hash;
use crate::cli::FleetStudyArgs;
use crate::commands::CommandError;
use mavid::config::load_csv_mapping;
use mavid::fleet::{LogSettings, Vehicles};

/// All that the rows depend on beside the logs.
pub fn settings(args: &FleetStudyArgs) -> Result<LogSettings, CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let vehicles = args.vehicles.as_deref().map(Vehicles::read).transpose().map_err(|error| input(&error))?;
    let mut vehicles = vehicles.unwrap_or_default();
    if let Some(mass_kg) = args.mass {
        vehicles.otherwise(&args.shape.given(mass_kg)).map_err(|error| input(&error))?;
    }
    args.csv_map.as_deref().map(load_csv_mapping).transpose()?;
    let named: Vec<&PathBuf> =
        vehicles.vehicle.iter().filter_map(|vehicle| vehicle.file.as_ref()).chain(&args.csv_map).collect();
    for vehicle in vehicles.vehicle.iter().filter_map(|vehicle| vehicle.file.as_deref()) {
        // one that cannot be read is told before the work
        mavid::config::read_vehicle(vehicle)?;
    }
    let files =
        named.iter().map(|path| hash(path)).collect::<Result<_, _>>().map_err(|error| input(&error))?;
    Ok(LogSettings { depth: args.depth.into(), vehicles, csv_map: args.csv_map.clone(), files })
}
