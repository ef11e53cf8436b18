//! A model for other simulators: values by hand, and every file read back.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use mavid::export::{Format, PLACES, export, places};
use mavid::physics::ActiveEffect;
use mavid::physics::effects::{ALL, by_id};
use mavid::units::AIR_DENSITY_KG_M3;
use mavid::vehicle::{ThrustLaw, Vehicle};

fn vehicle() -> Vehicle {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let mut vehicle = mavid::config::load_vehicle(&path).unwrap();
    vehicle.body.inertia_kg_m2[(0, 1)] = 0.001;
    vehicle.body.inertia_kg_m2[(1, 0)] = 0.001;
    vehicle.body.inertia_kg_m2[(1, 2)] = 0.002;
    vehicle.body.inertia_kg_m2[(2, 1)] = 0.002;
    vehicle
}

fn effect(id: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect::new(by_id(id).unwrap(), values).unwrap()
}

fn parameter(text: &str, name: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with(&format!("param set {name} "))).unwrap();
    line.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
fn px4_has_its_frame_and_hovers_at_the_same_command() {
    let vehicle = vehicle();
    let effects = [effect("linear_drag", &[0.3, 0.3, 0.3]), effect("thrust_tilt", &[0.02, 0.0])];
    let exported = export(&vehicle, &effects, Format::Px4Sih).unwrap();
    let value = |name| parameter(&exported.text, name);
    assert!((value("SIH_MASS") - vehicle.body.mass_kg).abs() < 1e-6);
    // y and z turn about: xy changes sign, yz does not
    assert!((value("SIH_IXY") + 0.001).abs() < 1e-9 && (value("SIH_IYZ") - 0.002).abs() < 1e-9);
    assert!((value("SIH_KDV") - 0.3).abs() < 1e-9);
    let hover = vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0;
    let command = vehicle.propulsion.command_from_thrust(hover);
    assert!((value("SIH_T_MAX") * command / hover - 1.0).abs() < 1e-5);
    assert!(exported.left_out.iter().any(|note| note.contains("thrust_tilt")), "{:?}", exported.left_out);
    assert!(exported.text.contains("# thrust_tilt"));
}

#[test]
fn ardupilot_drag_comes_back_by_its_own_law() {
    let vehicle = vehicle();
    let exported =
        export(&vehicle, &[effect("linear_drag", &[0.3, 0.3, 0.3])], Format::ArdupilotSitl).unwrap();
    let clean: String = exported.text.lines().filter(|line| !line.starts_with('#')).collect();
    let file: serde_json::Value = serde_json::from_str(&clean).unwrap();
    let number = |key: &str| file[key].as_f64().unwrap();
    let weight = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let drag = number("mdrag_coef") * (AIR_DENSITY_KG_M3 * number("disc_area") * weight).sqrt();
    assert!((drag - 0.3).abs() < 1e-9, "{drag}");
    for (index, rotor) in vehicle.rotors.iter().enumerate() {
        let position = &file[format!("motor{}_position", index + 1)];
        assert_eq!(position[0].as_f64().unwrap(), rotor.position_m.x);
        // to the right, not to the left
        assert_eq!(position[1].as_f64().unwrap(), -rotor.position_m.y);
        let yaw = file[format!("motor{}_yaw", index + 1)].as_f64().unwrap();
        assert!(yaw * rotor.spin.yaw_sign() < 0.0);
    }
    assert!(exported.left_out.iter().any(|note| note.contains("products of inertia")));
}

/// Tags of a text in order, each checked to be closed.
fn well_formed(text: &str) {
    let mut open: Vec<String> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        let end = if rest[start..].starts_with("<!--") {
            start + rest[start..].find("-->").unwrap() + 2
        } else {
            start + rest[start..].find('>').unwrap()
        };
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if tag.starts_with(['?', '!']) || tag.ends_with('/') {
            continue;
        }
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop().as_deref(), Some(name)),
            None => open.push(tag.split(' ').next().unwrap().to_owned()),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

fn between<'a>(text: &'a str, open: &str, close: &str) -> &'a str {
    let start = text.find(open).unwrap() + open.len();
    &text[start..start + text[start..].find(close).unwrap()]
}

#[test]
fn gazebo_and_mujoco_are_well_formed_and_hold_the_values() {
    let mut vehicle = vehicle();
    vehicle.name = "a<b & c -- d".into();
    let effects = [
        effect("linear_drag", &[0.3, 0.3, 0.0]),
        effect("motor_lag", &[0.03]),
        effect("com_offset", &[0.01, -0.02, 0.0]),
        effect("angular_damping", &[0.01, 0.01, 0.01]),
    ];
    let sdf = export(&vehicle, &effects, Format::Sdf).unwrap();
    well_formed(&sdf.text);
    let coefficient = vehicle.propulsion.thrust_coefficient.unwrap();
    let hover = (vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0 / coefficient).sqrt();
    let drag: f64 = between(&sdf.text, "<rotorDragCoefficient>", "<").parse().unwrap();
    assert!((drag * 4.0 * hover - 0.3).abs() < 1e-9);
    assert_eq!(between(&sdf.text, "<timeConstantUp>", "<"), "0.03");
    assert!(sdf.left_out.iter().any(|note| note.starts_with("angular_damping")));
    let mjcf = export(&vehicle, &effects, Format::Mjcf).unwrap();
    well_formed(&mjcf.text);
    assert!(mjcf.text.contains("dyntype=\"filter\" dynprm=\"0.03\""));
    let inertia: Vec<f64> =
        between(&mjcf.text, "fullinertia=\"", "\"").split(' ').map(|v| v.parse().unwrap()).collect();
    assert_eq!(inertia[3], 0.001);
    assert_eq!(inertia[5], 0.002);
}

#[test]
fn rotorpy_gets_back_what_it_is_made_of() {
    let vehicle = vehicle();
    let effects = [effect("linear_drag", &[0.3, 0.3, 0.2]), effect("inflow", &[0.1])];
    let exported = export(&vehicle, &effects, Format::Rotorpy).unwrap();
    let value = |key: &str| -> f64 { between(&exported.text, &format!("'{key}': "), ",").parse().unwrap() };
    let hover = (vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0 / value("k_eta")).sqrt();
    assert!((value("k_d") * 4.0 * hover - 0.3).abs() < 1e-9);
    assert!((value("k_z") * 4.0 * hover - 0.3).abs() < 1e-9);
    assert!((value("k_m") / value("k_eta") - vehicle.propulsion.torque_per_thrust_m).abs() < 1e-12);
    assert!(exported.left_out.is_empty(), "{:?}", exported.left_out);
}

#[test]
fn what_a_simulator_cannot_be_is_said() {
    let mut vehicle = vehicle();
    vehicle.rotors.pop();
    let error = export(&vehicle, &[], Format::Px4Sih).unwrap_err();
    assert!(error.to_string().contains("3 rotors"), "{error}");
    vehicle.propulsion.thrust_coefficient = None;
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 10.0, expo: 0.5 };
    let error = export(&vehicle, &[], Format::Rotorpy).unwrap_err();
    assert!(error.to_string().contains("thrust_coefficient"), "{error}");
}

/// What the table says of each effect and simulator is what the exporters do.
#[test]
fn every_effect_stands_in_the_table_of_what_simulators_can_hold() {
    let mut wrong = Vec::new();
    for effect in ALL {
        let id = effect.id();
        let Some(places) = places(id) else { panic!("{id}: expected an entry in export/places.rs") };
        let near = |bounds: (f64, f64)| 0.01_f64.clamp(bounds.0, bounds.1);
        let size = vehicle().size();
        let values: Vec<f64> = effect.parameters().iter().map(|p| near(p.bounds.at(&size))).collect();
        let active = [ActiveEffect::new(*effect, &values).unwrap()];
        for format in [Format::Px4Sih, Format::ArdupilotSitl, Format::Sdf, Format::Mjcf, Format::Rotorpy] {
            let exported = export(&vehicle(), &active, format).unwrap();
            let has_place = !exported
                .left_out
                .iter()
                .any(|note| note.starts_with(&format!("{id} cannot be represented")));
            if has_place != places.contains(&format) {
                wrong.push(format!("{id} in {format:?}: has a place: {has_place}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(PLACES.len(), ALL.len());
}
