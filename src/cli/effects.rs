//! Arguments of `mavid effects`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `mavid effects`.
#[derive(Debug, Args)]
pub struct EffectsArgs {
    /// an effect by its name (`motor lag`) or its identifier (`motor_lag`); without it all are listed
    pub id: Option<String>,
    /// vehicle.toml or model.toml: bounds and sizes are for this vehicle [default: the Holybro X500 that `sitl` flies]
    #[arg(long, value_name = "FILE")]
    pub vehicle: Option<PathBuf>,
    /// print only [[effect]] tables of usual size, for --effects of demo, sitl, simulate and run
    #[arg(long, conflicts_with = "json")]
    pub table: bool,
}
