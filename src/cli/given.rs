//! How a vehicle is given: by a file, or by its mass and shape.

use clap::{ArgGroup, Args};
use mavid::autopilot::{FRAMES, Frame};
use mavid::draft::Given;
use mavid::study::VehicleGiven;
use std::path::PathBuf;

/// The vehicle of a log: a file, or its mass and size.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("known").required(true).args(["vehicle", "mass"]))]
pub struct GivenArgs {
    /// vehicle.toml or model.toml; required without --mass
    #[arg(long, value_name = "FILE", conflicts_with_all = ["size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in place of --vehicle: mass with battery, kg. The rest comes from the log's parameters, the flight and rules of thumb
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
}

/// The vehicle of a command that has neither a log nor a link: in place of its file, mass and shape.
#[derive(Debug, Clone, Default, Args)]
pub struct DraftArgs {
    /// in place of a file: mass with battery, kg. With --frame, and best with --size; the rest comes from rules of thumb
    #[arg(long, value_name = "KG", requires = "frame", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
}

impl DraftArgs {
    /// How the study is told of the vehicle.
    pub fn given(&self, file: Option<&PathBuf>) -> VehicleGiven {
        match (file, self.mass) {
            (None, Some(mass_kg)) => VehicleGiven::Weighed(self.shape.given(mass_kg)),
            (file, _) => VehicleGiven::File(file.cloned().unwrap_or_default()),
        }
    }
}

/// With --mass: the shape of the vehicle.
#[derive(Debug, Clone, Default, Args)]
pub struct ShapeArgs {
    /// with --mass: distance from motor to motor across the centre, m; without it, what depends on the arms is not determined
    #[arg(long, value_name = "M", requires = "mass", value_parser = metres, allow_negative_numbers = true)]
    pub size: Option<f64>,
    /// with --mass, if log or parameters do not say where the motors are: quadrotor-x, quadrotor-plus, hexarotor-x, ...
    #[arg(long, value_name = "FRAME", requires = "mass", value_parser = frame)]
    pub frame: Option<&'static Frame>,
}

impl ShapeArgs {
    /// With a mass, what is known of the vehicle.
    pub fn given(&self, mass_kg: f64) -> Given {
        Given { mass_kg, size_m: self.size, frame: self.frame }
    }
}

/// A mass in kg as people write it: `1.5`, `1,5`, `1.5 kg`.
pub(super) fn kilograms(text: &str) -> Result<f64, String> {
    measure(text, "kg")
}

/// A length in m as people write it: `0.45`, `0,45`, `0.45 m`.
pub(super) fn metres(text: &str) -> Result<f64, String> {
    measure(text, "m")
}

fn measure(text: &str, unit: &str) -> Result<f64, String> {
    let text = text.trim();
    let number = text.strip_suffix(unit).unwrap_or(text).trim_end().replace(',', ".");
    number.parse().map_err(|_| format!("expected a number of {unit}, for example 0.45"))
}

/// A frame by its name.
pub(super) fn frame(id: &str) -> Result<&'static Frame, String> {
    let ids = || FRAMES.iter().map(Frame::id).collect::<Vec<_>>().join(", ");
    Frame::of_id(id).ok_or_else(|| format!("expected one of {}", ids()))
}

impl GivenArgs {
    /// How the study is told of the vehicle.
    pub fn given(&self) -> VehicleGiven {
        match (&self.vehicle, self.mass) {
            (None, Some(mass_kg)) => VehicleGiven::Weighed(self.shape.given(mass_kg)),
            (file, _) => VehicleGiven::File(file.clone().unwrap_or_default()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_is_taken_as_people_write_it() {
        for text in ["1.5", "1,5", "1.5kg", "1.5 kg", " 1.5 "] {
            assert_eq!(kilograms(text), Ok(1.5), "{text}");
        }
        assert_eq!((metres("0,45 m"), kilograms("-1")), (Ok(0.45), Ok(-1.0)));
        for text in ["", "heavy", "1.5 g", "1.2,3", "45 cm"] {
            let why = kilograms(text).unwrap_err();
            assert!(why.starts_with("expected a number of kg"), "{text}: {why}");
        }
        assert!(metres("450mm").is_err());
        assert!(metres("45 cm").unwrap_err().starts_with("expected a number of m"));
    }
}
