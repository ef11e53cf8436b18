//! Arguments of `mavid compare`.

use super::given::{frame, kilograms, metres};
use super::recording::ReadArgs;
use clap::Args;
use mavid::autopilot::Frame;
use mavid::draft::Given;
use mavid::study::{CompareRequest, VehicleGiven};
use std::path::PathBuf;

/// Arguments of `mavid compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// recordings of one vehicle, in their order: those before a change, or, without --with, all of them
    #[arg(required = true, value_name = "LOG")]
    pub before: Vec<PathBuf>,
    /// later recordings of the same vehicle: what changed since those before?
    #[arg(long = "with", value_name = "LOG", num_args = 1..)]
    pub after: Vec<PathBuf>,
    /// vehicle.toml or model.toml; without it and without --mass thrusts are compared as shares
    #[arg(long, value_name = "FILE", conflicts_with_all = ["mass", "size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in place of --vehicle: mass with battery, kg. The rest comes from the first log's parameters, its flight and rules of thumb
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// with --mass: distance from motor to motor across the centre, m
    #[arg(long, value_name = "M", requires = "mass", value_parser = metres, allow_negative_numbers = true)]
    pub size: Option<f64>,
    /// if the first log does not say where the motors are: quadrotor-x, quadrotor-plus, hexarotor-x, ...; also without --mass
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    pub frame: Option<&'static Frame>,
    /// compare the balance of the rotors alone, not what the motion shows
    #[arg(long)]
    pub balance_only: bool,
    /// write report.html, report.md, report.txt and comparison.json into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// time left out at the beginning of each flight, s
    #[arg(long, value_name = "S", default_value_t = CompareRequest::TRANSIENT_S, allow_negative_numbers = true)]
    pub transient: f64,
}

impl CompareArgs {
    /// As the study takes them.
    pub fn request(&self) -> CompareRequest {
        let given = |mass_kg| Given { mass_kg, size_m: self.size, frame: self.frame };
        let weighed = || self.mass.map(|mass_kg| VehicleGiven::Weighed(given(mass_kg)));
        CompareRequest {
            before: self.before.clone(),
            after: self.after.clone(),
            vehicle: self.vehicle.clone().map(VehicleGiven::File).or_else(weighed),
            frame: self.frame,
            read: self.read.settings(),
            transient_s: self.transient,
            balance_only: self.balance_only,
        }
    }
}
