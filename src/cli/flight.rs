//! Arguments of the verb that flies a vehicle.

use super::address::ADDRESS;
use super::given::{ShapeArgs, kilograms};
use clap::{ArgGroup, Args, ValueEnum};
use mavid::fly::SETPOINT_HZ;
use std::path::PathBuf;

/// Arguments of `mavid fly`.
#[derive(Debug, Clone, Args)]
#[command(group = ArgGroup::new("flown").required(true).args(["vehicle", "mass"]))]
pub struct FlyArgs {
    #[arg(long, value_name = "ADDRESS", help = ADDRESS)]
    pub connect: String,
    /// trajectory.toml
    #[arg(long, value_name = "FILE")]
    pub trajectory: PathBuf,
    /// vehicle.toml, or a model; required without --mass
    #[arg(long, value_name = "FILE", conflicts_with_all = ["size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in place of --vehicle: mass with battery, kg. The rest comes from the vehicle's parameters and rules of thumb, and is
    /// written into the folder of the flight
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// new folder for recording, events, parameters and results
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// arm the vehicle; without it everything is checked and nothing is armed
    #[arg(long)]
    pub arm: bool,
    /// do not ask for the word `arm` at a terminal before arming
    #[arg(long)]
    pub yes: bool,
    /// the vehicle's MAVLink system id; without it the only vehicle on the link
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(1..=255))]
    pub system_id: Option<u32>,
    /// MAVLink system id of mavid itself
    #[arg(long, value_name = "ID", default_value_t = 255, value_parser = clap::value_parser!(u32).range(1..=255))]
    pub station_id: u32,
    /// periods to fly, instead of the trajectory's own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: Option<u32>,
    /// setpoints per second; not a divisor of the rates of the log
    #[arg(long, value_name = "HZ", default_value_t = SETPOINT_HZ, value_parser = clap::value_parser!(u32).range(20..=200))]
    pub setpoint_hz: u32,
    /// the trajectory's horizontal origin; heights are above the ground
    #[arg(long, value_enum, default_value = "local")]
    pub origin: OriginName,
    /// distance to the reference at which the flight is aborted, m
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub tracking_max: f64,
    /// tilt at which the flight is aborted, degrees [default: 20 more than planned]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub tilt_max: Option<f64>,
    /// time that the vehicle hovers on a full battery, s: the flight is refused if the charge does not suffice
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub hover_time: Option<f64>,
    /// distance to the start within which the vehicle must hover before the trajectory, m [default: 0.3, or what it can do]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub gate_distance: Option<f64>,
    /// greatest speed in this hover, m/s [default: 0.2, or what it can do]
    #[arg(long, value_name = "M/S", allow_negative_numbers = true)]
    pub gate_speed: Option<f64>,
    /// a check whose refusal becomes a warning; may be given several times
    #[arg(long, value_enum, value_name = "CHECK")]
    pub accept: Vec<CheckName>,
    /// key that signs what is sent
    #[arg(long, value_name = "FILE")]
    pub signing_key_file: Option<PathBuf>,
    /// before the flight, set what the autopilot logs so that an identification can use it; it is put back after the flight
    #[arg(long)]
    pub set_logging: bool,
    /// with --set-logging: leave it set after the flight, for a further flight; `mavid log prepare --restore` puts it back
    #[arg(long, requires = "set_logging")]
    pub keep_logging: bool,
    /// after landing, fetch the log that the vehicle wrote itself, however long that takes
    #[arg(long, conflicts_with = "no_fetch_log")]
    pub fetch_log: bool,
    /// do not fetch it [default: where it takes a minute at most]
    #[arg(long)]
    pub no_fetch_log: bool,
    /// fly and record, and make nothing of it: for `explain` of several flights together
    #[arg(long)]
    pub record_only: bool,
    /// print lines instead of the terminal view
    #[arg(long)]
    pub plain: bool,
}

/// Checks that may be overruled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CheckName {
    /// the vehicle file's thrust at the autopilot's hover command against its weight
    HoverThrust,
    /// number and arms of the vehicle file's rotors against those of the autopilot
    Rotors,
}

/// Where a trajectory's horizontal origin lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OriginName {
    /// at the origin of the vehicle's local position
    Local,
    /// such that the hover after takeoff is above the vehicle
    Here,
}
