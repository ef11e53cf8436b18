//! Which vehicle a log is of, and what is known of it: by a file of vehicles, or by what the log says of itself.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::autopilot::Frame;
use crate::draft::{DraftError, Given};
use crate::study::{AIRFRAME, OwnWords, SERIAL, VehicleGiven};
use crate::text;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// One vehicle of the file, or all that are built alike. A log is its own if all that is stated here fits: the address, the system id,
/// and the parameters.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FleetVehicle {
    /// name; without one, vehicles that fit are told apart by what their logs say
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// vehicles of one type are compared; without it the name of its file, or what the logs say
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
    /// vehicle file, relative to the file of vehicles
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// without a file: mass with battery, kg
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// with a mass: from motor to motor across the centre, m
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<f64>,
    /// with a mass: where the motors are
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<String>,
    /// pattern of the addresses of its logs
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub logs: Option<String>,
    /// MAVLink system id
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub system: Option<u32>,
    /// parameters that its logs have, with their values
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, f64>,
}

/// The file of vehicles.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicles {
    /// the first that fits a log is its vehicle
    #[serde(default)]
    pub vehicle: Vec<FleetVehicle>,
}

/// Why a file of vehicles cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {why}")]
pub struct VehiclesError {
    file: String,
    why: String,
}

/// Where a log was found, and what it says of its vehicle.
#[derive(Debug, Clone, Copy)]
pub struct OfLog<'a> {
    /// where it was found
    pub uri: &'a str,
    /// what it says
    pub own: OwnWords<'a>,
}

impl Vehicles {
    /// Reads the file and checks what can be checked without a log.
    ///
    /// # Errors
    /// [`VehiclesError`] with what was expected and what came.
    pub fn read(path: &Path) -> Result<Self, VehiclesError> {
        let refused = |why: String| VehiclesError { file: text::path(&path), why };
        let written = std::fs::read_to_string(path).map_err(|error| refused(error.to_string()))?;
        let mut vehicles: Self = toml::from_str(&written).map_err(|error| refused(error.to_string()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        for vehicle in &mut vehicles.vehicle {
            let called = vehicle.name.as_deref().map_or_else(
                || "vehicle without a name".to_owned(),
                |name| format!("vehicle `{}`", text::clean(name)),
            );
            let of = |why: &str| refused(format!("{called}: {why}"));
            if vehicle.file.is_some() == vehicle.mass.is_some() {
                return Err(of("expected a `file` or a `mass`, one of them"));
            }
            if vehicle.logs.is_none() && vehicle.system.is_none() && vehicle.parameters.is_empty() {
                return Err(of("expected `logs`, `system` or `parameters`, by which its logs are known"));
            }
            if let Some(pattern) = &vehicle.logs {
                glob::Pattern::new(pattern).map_err(|error| of(&format!("logs: {error}")))?;
            }
            if let Some(frame) = vehicle.frame.as_deref().filter(|frame| Frame::of_id(frame).is_none()) {
                return Err(of(&format!(
                    "frame: expected a frame as `quadrotor-x`, got `{}`",
                    text::clean(frame)
                )));
            }
            if let VehicleGiven::Weighed(given) = vehicle.given() {
                given.checked().map_err(|error| of(&error.to_string()))?;
            }
            if let Some(file) = &mut vehicle.file {
                *file = folder.join(&*file);
                if !file.is_file() {
                    return Err(of(&format!("file: {} is not there", text::path(&file))));
                }
            }
        }
        Ok(vehicles)
    }

    /// Adds what holds for all vehicles that are not listed: they are built alike, and told apart by what their logs say.
    ///
    /// # Errors
    /// [`DraftError`] where no vehicle has such a mass or size.
    pub fn otherwise(&mut self, given: &Given) -> Result<(), DraftError> {
        given.checked()?;
        self.vehicle.push(FleetVehicle {
            mass: Some(given.mass_kg),
            size: given.size_m,
            frame: given.frame.map(Frame::id),
            logs: Some("*".to_owned()),
            ..FleetVehicle::default()
        });
        Ok(())
    }

    /// The vehicle of a log; `None`: of none that is listed.
    #[must_use]
    pub fn of(&self, log: &OfLog<'_>) -> Option<&FleetVehicle> {
        self.vehicle.iter().find(|vehicle| vehicle.fits(log))
    }
}

impl FleetVehicle {
    fn fits(&self, log: &OfLog<'_>) -> bool {
        let has = |(name, value): (&String, &f64)| {
            log.own.parameters.get(name).is_some_and(|own| (own - value).abs() <= 1e-6 * value.abs().max(1.0))
        };
        let matches =
            |pattern: &String| glob::Pattern::new(pattern).is_ok_and(|pattern| pattern.matches(log.uri));
        self.logs.as_ref().is_none_or(matches)
            && self.system.is_none_or(|system| log.own.system == Some(system))
            && self.parameters.iter().all(has)
    }

    /// As a study takes it.
    #[must_use]
    pub fn given(&self) -> VehicleGiven {
        match (&self.file, self.mass) {
            (Some(file), _) => VehicleGiven::File(file.clone()),
            (None, mass) => VehicleGiven::Weighed(Given {
                mass_kg: mass.unwrap_or(f64::NAN),
                size_m: self.size,
                frame: self.frame.as_deref().and_then(Frame::of_id),
            }),
        }
    }

    /// Its type.
    #[must_use]
    pub fn type_name(&self, log: &OfLog<'_>) -> String {
        let of_file = || self.file.as_deref().and_then(Path::file_stem).map(text::path);
        self.kind.clone().or_else(of_file).unwrap_or_else(|| own_type(log))
    }
}

/// Beside [`AIRFRAME`]: vehicles of one type are set alike.
const SET_ALIKE: &str = "MOT_SPIN_ARM";
/// Parameters with the system id of a log that has no frames.
const SYSTEM: [&str; 3] = ["MAV_SYS_ID", "SYSID_THISMAV", "MAV_SYSID"];

/// The type of a log's vehicle by its airframe parameters: `px4-5f3a90`.
#[must_use]
pub fn own_type(log: &OfLog<'_>) -> String {
    format!("{}-{}", log.own.autopilot, digest(log.own.parameters, AIRFRAME.into_iter().chain([SET_ALIKE])))
}

/// The name of a log's vehicle by its system id, airframe and serial numbers: `px4-5f3a90-1-0c22e1`.
#[must_use]
pub fn own_name(log: &OfLog<'_>) -> String {
    let system = system_of(log).map_or_else(|| "x".to_owned(), |system| system.to_string());
    format!("{}-{system}-{}", own_type(log), digest(log.own.parameters, SERIAL.into_iter()))
}

/// The MAVLink system id of a log, by its frames or by a parameter.
#[must_use]
pub fn system_of(log: &OfLog<'_>) -> Option<u32> {
    let stated = || SYSTEM.iter().find_map(|name| log.own.parameters.get(*name).copied());
    // ids are small and whole
    let whole = |value: f64| (1..=255_u32).find(|id| f64::from(*id) == value);
    log.own.system.or_else(|| stated().and_then(whole))
}

fn digest<'a>(parameters: &BTreeMap<String, f64>, names: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<String> =
        names.filter_map(|name| parameters.get(name).map(|value| format!("{name}={value}"))).collect();
    if known.is_empty() {
        return "unknown".to_owned();
    }
    let hash = Sha256::digest(known.join(";").as_bytes());
    hash.iter().take(3).map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log<'a>(uri: &'a str, parameters: &'a BTreeMap<String, f64>) -> OfLog<'a> {
        OfLog { uri, own: OwnWords { system: Some(3), autopilot: "px4", parameters } }
    }

    #[test]
    fn a_log_is_of_the_first_vehicle_that_fits() {
        let vehicles: Vehicles = toml::from_str(
            "[[vehicle]]\nname = 'a'\nmass = 1.0\nlogs = '*/a/*'\n[[vehicle]]\nname = 'b'\nmass = 2.0\nsystem = 3\n\
             parameters = { SYS_AUTOSTART = 4001 }\n",
        )
        .unwrap();
        let (none, some) = (BTreeMap::new(), BTreeMap::from([("SYS_AUTOSTART".to_owned(), 4001.0)]));
        let of =
            |uri, parameters| vehicles.of(&log(uri, parameters)).and_then(|vehicle| vehicle.name.clone());
        assert_eq!(of("x/a/1.ulg", &none).as_deref(), Some("a"));
        assert_eq!(of("x/c/1.ulg", &some).as_deref(), Some("b"));
        assert_eq!(of("x/c/1.ulg", &none), None);
        // what is said of all others changes none that is listed
        let mut more = vehicles.clone();
        let given = |mass_kg| Given { mass_kg, size_m: Some(0.5), frame: None };
        assert!(more.otherwise(&given(-1.0)).is_err() && more == vehicles);
        more.otherwise(&given(3.0)).unwrap();
        assert_eq!(more.of(&log("x/a/1.ulg", &none)).unwrap().name.as_deref(), Some("a"));
        let other = more.of(&log("x/c/1.ulg", &none)).unwrap();
        assert_eq!((&other.name, other.given()), (&None, VehicleGiven::Weighed(given(3.0))));
    }

    #[test]
    fn vehicles_are_told_apart_by_id_airframe_and_serial_number() {
        let with = |airframe: f64, serial: f64| {
            BTreeMap::from([("SYS_AUTOSTART".to_owned(), airframe), ("CAL_ACC0_ID".to_owned(), serial)])
        };
        let (one, twin, other) = (with(4001.0, 1.0), with(4001.0, 2.0), with(4500.0, 1.0));
        assert_eq!(own_type(&log("", &one)), own_type(&log("", &twin)));
        assert_ne!(own_name(&log("", &one)), own_name(&log("", &twin)));
        assert_ne!(own_type(&log("", &one)), own_type(&log("", &other)));
        let none = BTreeMap::new();
        assert_eq!(own_name(&log("", &none)), "px4-unknown-3-unknown");
        let stated = BTreeMap::from([("MAV_SYS_ID".to_owned(), 7.0)]);
        assert_eq!(
            system_of(&OfLog {
                uri: "",
                own: OwnWords { system: None, autopilot: "px4", parameters: &stated },
            }),
            Some(7)
        );
    }

    #[test]
    fn a_vehicle_without_what_it_needs_is_refused_with_its_name() {
        let folder = std::env::temp_dir().join(format!("mavid-vehicles-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("vehicles.toml");
        for (text, said) in [
            ("[[vehicle]]\nname = 'a'\nsystem = 1", "vehicle `a`: expected a `file` or a `mass`"),
            ("[[vehicle]]\nname = 'a'\nmass = 1", "expected `logs`, `system` or `parameters`"),
            ("[[vehicle]]\nname = 'a'\nfile = 'no.toml'\nsystem = 1", "is not there"),
            ("[[vehicle]]\nname = 'a'\nmass = 1\nframe = 'y'\nsystem = 1", "expected a frame"),
            ("[[vehicle]]\nname = 'a'\nmass = 1\nlogs = '['", "logs:"),
            ("[[vehicle]]\nname = 'a'\nmasss = 1", "unknown field"),
            ("[[vehicle]]\nmass = -1\nsystem = 1", "vehicle without a name: expected a mass from"),
        ] {
            std::fs::write(&path, text).unwrap();
            let error = Vehicles::read(&path).unwrap_err().to_string();
            assert!(error.contains(said) && error.contains("vehicles.toml"), "{error}");
        }
        std::fs::remove_dir_all(folder).unwrap();
    }
}
