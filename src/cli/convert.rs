//! Arguments of `mavid convert`.

use super::given::{ShapeArgs, kilograms};
use super::recording::ReadArgs;
use clap::{Args, ValueEnum};
use mavid::study::VehicleGiven;
use std::path::PathBuf;

/// Arguments of `mavid convert`.
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// recording: .tlog, .ulg, .bin, or .csv with known columns
    pub log: PathBuf,
    /// form of the files; mcap and parquet need a program that was built with the feature `fleet`
    #[arg(long, value_enum)]
    pub to: ConvertForm,
    /// write the files into this folder
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// vehicle.toml or model.toml: adds what is left of the equations of motion, before and after the effects that are found
    #[arg(long, value_name = "FILE", conflicts_with_all = ["mass", "size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in place of --vehicle: mass with battery, kg
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// how the recording is read
    #[command(flatten)]
    pub read: ReadArgs,
}

impl ConvertArgs {
    /// How the study is told of the vehicle; `None`: the streams alone are wanted.
    pub fn given(&self) -> Option<VehicleGiven> {
        let weighed = || self.mass.map(|mass_kg| VehicleGiven::Weighed(self.shape.given(mass_kg)));
        self.vehicle.clone().map(VehicleGiven::File).or_else(weighed)
    }
}

/// Form of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ConvertForm {
    /// a table of text for each stream
    Csv,
    /// one file for Foxglove and PlotJuggler, with a layout for each
    Mcap,
    /// a file for each stream
    Parquet,
}
