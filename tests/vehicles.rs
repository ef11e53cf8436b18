//! Every vehicle file at hand loads: those shipped in `configs/` and those beside the repository.

mod support;

use mavid::config::{load_vehicle, parse_vehicle, read_vehicle, vehicle_to_toml};
use std::path::Path;

#[test]
fn shared_vehicles_load_and_survive_writing() {
    let Some(shared) = support::shared() else { return };
    let paths = support::files(&shared, "toml");
    assert!(paths.len() >= 14, "{paths:?}");
    for path in paths {
        let loaded = read_vehicle(&path).unwrap();
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", path.display());
        assert_eq!(loaded.vehicle.rotors.len(), 4);
        let again = parse_vehicle(&vehicle_to_toml(&loaded.vehicle).unwrap(), "again").unwrap();
        assert_eq!(again.vehicle.body, loaded.vehicle.body);
        assert_eq!(again.vehicle.rotors, loaded.vehicle.rotors);
    }
}

#[test]
fn shared_values_are_the_files() {
    let Some(shared) = support::shared() else { return };
    let x500 = load_vehicle(&shared.join("cases/p01-nothing-missing/vehicle.toml")).unwrap();
    // u = sqrt(2.0 * 9.81 / (4 * 8.55e-6)) / 1100
    let hover = x500.propulsion.command_from_thrust(2.0 * 9.81 / 4.0);
    assert!((hover - 0.688_56).abs() < 1e-5, "{hover}");
    let sih = load_vehicle(&shared.join("recordings/autopilots/px4-sih.toml")).unwrap();
    assert!((sih.propulsion.normalized(1500.0) - 0.5).abs() < 1e-12);
}

#[test]
fn a_missing_file_is_named() {
    let message = load_vehicle(Path::new("no/such/vehicle.toml")).unwrap_err().to_string();
    assert!(message.contains("no/such/vehicle.toml"), "{message}");
}
