//! Every vehicle file at hand loads: those shipped in `configs/` and those beside the repository.

use crate::support;

use mavid::config::{load_vehicle, parse_vehicle, read_vehicle, vehicle_to_toml};
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn shared_vehicles_load_and_survive_writing() {
    let Some(shared) = support::shared() else { return };
    // trajectories stand there, too
    let is_vehicle = |path: &PathBuf| std::fs::read_to_string(path).unwrap().contains("[[rotor]]");
    let paths: Vec<PathBuf> = support::files(&shared, "toml").into_iter().filter(is_vehicle).collect();
    assert!(paths.len() >= 14, "{paths:?}");
    for path in paths {
        let loaded = read_vehicle(&path).unwrap();
        assert_eq!(loaded.warnings, [], "{}", path.display());
        assert!([4, 6].contains(&loaded.vehicle.rotors.len()), "{}", path.display());
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

fn shipped(name: &str) -> mavid::config::LoadedVehicle {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    read_vehicle(&folder.join(name)).unwrap()
}

#[test]
fn every_shipped_vehicle_loads_and_can_hover() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        count += 1;
        let loaded = read_vehicle(&path).unwrap();
        assert_eq!(loaded.warnings, [], "{}", path.display());
        let vehicle = loaded.vehicle;
        let share_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / vehicle.rotors.len() as f64;
        let hover = vehicle.propulsion.command_from_thrust(share_n);
        assert!((0.4..0.85).contains(&hover), "{}: hover at u = {hover}", path.display());
    }
    assert!(count >= 4, "{count}");
}

#[test]
fn qball2_is_the_papers() {
    let vehicle = shipped("qball2.toml").vehicle;
    assert_eq!(vehicle.body.mass_kg, 1.79);
    assert_eq!(vehicle.body.inertia_kg_m2.diagonal(), nalgebra::Vector3::new(0.03, 0.03, 0.04));
    let full_n = 4.0 * vehicle.propulsion.thrust_from_command_n(1.0);
    assert!((full_n - vehicle.limits.thrust_max_n.unwrap()).abs() < 1e-9);
    // one rotor at full thrust gives the paper's largest roll torque
    let roll_nm = vehicle.mixer().wrench(&[0.0, 0.0, 8.6, 0.0])[1];
    assert!((roll_nm - vehicle.limits.torque_max_nm.unwrap()).abs() < 1e-9);
    assert!((vehicle.limits.roll_max_rad.unwrap() - 0.1).abs() < 1e-4);
    assert!((vehicle.limits.yaw_rate_max_rad_s.unwrap() - 0.5).abs() < 1e-4);
}

#[test]
fn simulated_vehicles_are_their_models() {
    let x500 = shipped("x500.toml").vehicle;
    assert!((x500.propulsion.torque_per_thrust_m - 0.016).abs() < 1e-6);
    assert_eq!(x500.propulsion.thrust_coefficient, Some(8.548_58e-6));
    let iris = shipped("iris.toml").vehicle;
    assert!((iris.propulsion.torque_per_thrust_m - 0.06).abs() < 1e-9);
    let crazyflie = shipped("crazyflie.toml").vehicle;
    // 14.5 g of thrust at full speed
    assert!((crazyflie.propulsion.thrust_from_command_n(1.0) - 0.0145 * 9.81).abs() < 0.002);
}

#[test]
fn a_missing_file_is_named() {
    let message = load_vehicle(Path::new("no/such/vehicle.toml")).unwrap_err().to_string();
    assert!(message.contains("no/such/vehicle.toml"), "{message}");
}

/// Model files of the first version: no `format`, and no parameter that was added since.
#[test]
fn model_files_of_the_first_version_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/models");
    for (name, effects) in [("first_identify.toml", 0), ("first_explain.toml", 1)] {
        let path = folder.join(name);
        let loaded = read_vehicle(&path).unwrap();
        assert_eq!(loaded.warnings, [], "{name}");
        assert_eq!(loaded.model.effects.len(), effects, "{name}");
        assert!(loaded.model.identified.is_some() && loaded.model.provenance.is_some(), "{name}");
        // written anew they have the format
        let text = vehicle_to_toml(&loaded.vehicle).unwrap();
        assert!(text.starts_with("format = 1\n"), "{text}");
        assert_eq!(parse_vehicle(&text, "again").unwrap().vehicle.body, loaded.vehicle.body);
        let mut export = Command::new(env!("CARGO_BIN_EXE_mavid"));
        let output = export.arg("export").arg(&path).args(["--to", "rotorpy"]).output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_later_format_is_refused_with_what_to_do() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let text = std::fs::read_to_string(path).unwrap();
    assert!(parse_vehicle(&format!("format = 1\n{text}"), "v.toml").is_ok());
    for (came, shown, is_later) in [
        ("2", "got 2", true),
        ("0", "got 0", false),
        ("\"1\"", "got \"1\"", false),
        ("[1]", "got [1]", false),
    ] {
        // its unknown keys are not what is told
        let later = format!("format = {came}\nnew_key = 1\n{text}");
        let said = parse_vehicle(&later, "v.toml").unwrap_err().to_string();
        assert!(
            said.starts_with("v.toml: `format`: expected ") && said.contains(" or no such key"),
            "{said}"
        );
        assert!(said.contains(shown), "{said}");
        assert_eq!(said.contains("a later version of mavid"), is_later, "{said}");
        assert_eq!(said.contains("mavid vehicle init"), is_later, "{said}");
    }
}
