//! Arguments of the verb that does the whole: from a vehicle to the sentence.

use super::address::ADDRESS;
use super::given::{ShapeArgs, kilograms};
use super::live::autopilots;
use clap::{ArgGroup, Args};
use mavid::autopilot::Autopilot;
use std::path::PathBuf;

/// Arguments of `mavid run`.
#[derive(Debug, Clone, Args)]
#[command(group = ArgGroup::new("reached").required(true).args(["connect", "sitl"]))]
pub struct RunArgs {
    #[arg(long, value_name = "ADDRESS", help = ADDRESS)]
    pub connect: Option<String>,
    /// in place of --connect: start the embedded simulated vehicle and fly that one
    #[arg(long)]
    pub sitl: bool,
    /// with --sitl: the autopilot that is simulated [default: px4]
    #[arg(long, value_parser = autopilots(), conflicts_with = "connect")]
    pub autopilot: Option<Autopilot>,
    /// with --sitl: effects to conceal: [[effect]] tables with `id` and the parameters by name
    #[arg(long, value_name = "FILE", conflicts_with = "connect")]
    pub effects: Option<PathBuf>,
    /// mass with battery, kg: weigh it. The rest of the vehicle comes from its parameters and rules of thumb
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// in place of --mass: a vehicle.toml or a model that you have
    #[arg(long, value_name = "FILE", conflicts_with_all = ["mass", "size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// the free room round the place of takeoff, m: length from south to north, width from west to east, height
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', value_parser = side, allow_hyphen_values = true)]
    pub room: Option<Vec<f64>>,
    /// folder for everything; one that was begun is taken up where it was left [default: mavid-run]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// flights at most, those in the folder included [default: 1 with --yes; without it you are asked after each]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=20))]
    pub flights: Option<u32>,
    /// ask nothing and take the defaults; what has no safe default ends the run with a message
    #[arg(long)]
    pub yes: bool,
    /// with --yes: arm the vehicle; without it everything is checked and nothing is armed
    #[arg(long, requires = "yes")]
    pub arm: bool,
    /// first fly the whole of it on the embedded twin of this vehicle, with its file and its parameters
    #[arg(long)]
    pub rehearse: bool,
    /// before each flight, set what the autopilot logs so that an identification can use it; it is put back after the flight
    #[arg(long)]
    pub set_logging: bool,
    /// with --set-logging: restart the autopilot where the setting counts only then (PX4), before the first flight
    #[arg(long, requires = "set_logging")]
    pub restart: bool,
    /// distance to the reference at which a flight is aborted, m [default: 1]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub tracking_max: Option<f64>,
    /// the vehicle's MAVLink system id; without it the only vehicle on the link
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(1..=255))]
    pub system_id: Option<u32>,
    /// print lines instead of the terminal view
    #[arg(long)]
    pub plain: bool,
}

/// A side of a room, m.
fn side(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| {
        "expected length, width and height in m with commas between them, such as 4,4,3".to_owned()
    })
}
