//! Arguments of the verb that plans a flight.

use super::given::DraftArgs;
use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `mavid plan`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("planned").required(true).args(["vehicle", "mass"]))]
pub struct PlanArgs {
    /// vehicle.toml or model.toml; required without --mass
    pub vehicle: Option<PathBuf>,
    /// in its place
    #[command(flatten)]
    pub draft: DraftArgs,
    /// where to write the trajectory
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// file with a [limits] table, instead of the vehicle's
    #[arg(long)]
    pub limits: Option<PathBuf>,
    /// what is minimised
    #[arg(long, value_enum, default_value = "cond")]
    pub criterion: CriterionName,
    /// seed of the random starts
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// number of random starts
    #[arg(long, default_value_t = 16)]
    pub starts: u64,
    /// periods to fly; comparing periods with each other needs four
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: u32,
    /// period, s
    #[arg(long, default_value_t = 10.0, allow_negative_numbers = true)]
    pub period: f64,
    /// harmonics of the series
    #[arg(long, default_value_t = 5)]
    pub harmonics: u32,
    /// where the series starts and ends: metres and degrees; without Z the height is chosen
    #[arg(long, value_name = "X,Y[,Z[,YAW]]", value_delimiter = ',', allow_hyphen_values = true)]
    pub start: Option<Vec<f64>>,
    /// check and assess this trajectory instead of planning one; --out writes it with the ways from takeoff and to landing
    #[arg(long, value_name = "TRAJECTORY", conflicts_with = "start")]
    pub check: Option<PathBuf>,
    /// the circular validation path (44) instead of a plan: metres, seconds a turn, metres of height;
    /// without HEIGHT the middle of the room
    #[arg(long, value_name = "RADIUS,PERIOD[,HEIGHT]", value_delimiter = ',', allow_hyphen_values = true,
        conflicts_with_all = ["check", "start"])]
    pub circle: Option<Vec<f64>>,
    /// hover after takeoff, metres and degrees; without it at the mean of the series
    #[arg(long, value_name = "X,Y,Z[,YAW]", value_delimiter = ',', allow_hyphen_values = true)]
    pub takeoff: Option<Vec<f64>>,
    /// hover before landing; without it at the place of takeoff
    #[arg(long, value_name = "X,Y,Z[,YAW]", value_delimiter = ',', allow_hyphen_values = true)]
    pub landing: Option<Vec<f64>>,
}

/// Names of the criteria.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CriterionName {
    /// condition number of W, the paper's
    Cond,
    /// condition number of W with columns of unit norm
    ScaledCond,
    /// volume of the error ellipsoid
    DOpt,
    /// sum of squared relative standard errors
    AOpt,
}
