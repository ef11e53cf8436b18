//! Parameters of the aircraft's own autopilot: what a model knows too little of, and at what they hold.

use mavid::autopilot::Autopilot;
use mavid::diagnose::called;
use mavid::export::{AircraftParameters, Format, aircraft_parameters, export};
use mavid::physics::ActiveEffect;
use mavid::physics::effects::by_id;
use mavid::vehicle::{Guess, Guessed, Vehicle};

fn vehicle() -> Vehicle {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    mavid::config::load_vehicle(&path).unwrap()
}

fn effect(id: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect::new(by_id(id).unwrap(), values).unwrap()
}

/// The parameters of a model with a linear drag, N/(m/s).
fn with_drag(identified: &str, drag: [f64; 3], autopilot: Autopilot) -> AircraftParameters {
    let identified = toml::from_str(identified).unwrap();
    let effects = [effect("linear_drag", &drag)];
    aircraft_parameters(&vehicle(), &effects, Some(&identified), (autopilot, None)).unwrap()
}

fn has(written: &AircraftParameters, name: &str) -> bool {
    written.parameters.iter().any(|parameter| parameter.name == name)
}

fn told(written: &AircraftParameters, words: &str) -> bool {
    written.left_out.iter().any(|note| note.contains(words))
}

/// Half of the drag and more is no help to the estimator; what is said is how well the drag is known.
#[test]
fn a_drag_that_is_hardly_known_is_not_written_and_not_called_none() {
    let mass = "mass = { value = 2.0, std = 0.02 }\n";
    let drag = "[effects.linear_drag]\ndx = { value = 0.4, std = 0.22 }\ndy = { value = 0.4, std = 0.22 }\n";
    for (autopilot, name) in [(Autopilot::Px4, "EKF2_MCOEF"), (Autopilot::ArduPilot, "EK3_DRAG_MCOEF")] {
        let written = with_drag(&format!("{mass}{drag}"), [0.4, 0.4, 0.4], autopilot);
        assert!(!has(&written, name) && !has(&written, "EKF2_DRAG_CTRL"));
        let known = "not written: the drag is known to 0.40 +- 0.22 N/(m/s) only; fly again";
        assert!(told(&written, known) && written.text.contains(known), "{:?}", written.left_out);
        for never in ["no significant drag", "contains no drag", "drag cannot be represented"] {
            assert!(!told(&written, never), "{:?}", written.left_out);
        }
        // errors that are independent of each other: 0.22 / sqrt(2) of 0.4 is 39 %
        let apart = "correlation_of = [\"linear_drag.dx\", \"linear_drag.dy\"]\n\
                     correlation = [[1.0, 0.0], [0.0, 1.0]]\n";
        let written = with_drag(&format!("{mass}{apart}{drag}"), [0.4, 0.4, 0.4], autopilot);
        let momentum = written.parameters.iter().find(|parameter| parameter.name == name).unwrap();
        let relative = (momentum.std.unwrap() / momentum.value).powi(2);
        assert!((relative - (0.22_f64 / 0.4).powi(2) / 2.0).abs() < 1e-9, "{relative}");
    }
    let identified = toml::from_str(mass).unwrap();
    let none = aircraft_parameters(&vehicle(), &[], Some(&identified), (Autopilot::Px4, None)).unwrap();
    assert!(told(&none, "not written: the model contains no drag"), "{:?}", none.left_out);
}

/// A drag that may as well be the largest that the autopilot documents is that one, and says so.
#[test]
fn a_drag_whose_error_reaches_the_documented_limit_is_the_limit() {
    let drag = 1.05 * vehicle().body.mass_kg;
    let of = |std: f64| {
        let axis = format!("{{ value = {drag}, std = {std} }}");
        let mass = "mass = { value = 2.0, std = 0.02 }";
        let identified = format!("{mass}\n[effects.linear_drag]\ndx = {axis}\ndy = {axis}\n");
        with_drag(&identified, [drag, drag, 0.4], Autopilot::Px4)
    };
    let near = of(0.1);
    let momentum = near.parameters.iter().find(|parameter| parameter.name == "EKF2_MCOEF").unwrap();
    assert!(
        (momentum.value - 1.0).abs() < 1e-12 && momentum.why.starts_with("the limit of 1 "),
        "{momentum:?}"
    );
    assert!(momentum.why.contains("in place of 1.05 +- 0.05,"), "{}", momentum.why);
    assert!(has(&near, "EKF2_DRAG_CTRL") && near.text.contains("in place of 1.05"), "{}", near.text);
    let far = of(0.02);
    assert!(!has(&far, "EKF2_MCOEF") && !has(&far, "EKF2_DRAG_CTRL"), "{:?}", far.parameters);
    assert!(told(&far, "EKF2_MCOEF would be 1.050 1/s, more than the 1"), "{:?}", far.left_out);
}

/// A bent thrust curve moves thrust, mass and drag by one factor, and the drag over the mass not at all: the limit does not stand in
/// the place of a value that is certainly beyond it.
#[test]
fn the_scale_of_the_thrust_is_no_error_of_the_drag_over_the_mass() {
    let of = |per_kg: f64| {
        let (mass_kg, scale) = (vehicle().body.mass_kg, 0.27_f64);
        let drag = per_kg * mass_kg;
        let axis = format!("{{ value = {drag}, std = {} }}", scale.hypot(0.03) * drag);
        let identified = format!(
            "mass = {{ value = {mass_kg}, std = {} }}\n[effects.linear_drag]\ndx = {axis}\ndy = {axis}\n\
             [effects.thrust_curve]\ncurvature = {{ value = -0.2, std = 0.01 }}\n",
            scale * mass_kg
        );
        let effects = [effect("linear_drag", &[drag, drag, 0.4]), effect("thrust_curve", &[-0.2])];
        let identified = toml::from_str(&identified).unwrap();
        aircraft_parameters(&vehicle(), &effects, Some(&identified), (Autopilot::Px4, None)).unwrap()
    };
    let slight = of(0.4);
    let momentum = slight.parameters.iter().find(|parameter| parameter.name == "EKF2_MCOEF").unwrap();
    assert!((momentum.value - 0.4).abs() < 1e-12, "{momentum:?}");
    assert!((momentum.std.unwrap() - 0.03 * 0.4).abs() < 1e-9, "{momentum:?}");
    let strong = of(1.4);
    assert!(!has(&strong, "EKF2_MCOEF"), "{:?}", strong.parameters);
    assert!(told(&strong, "EKF2_MCOEF would be 1.400 1/s, more than the 1"), "{:?}", strong.left_out);
}

#[test]
fn a_rough_hover_throttle_is_not_written_and_says_what_it_rests_on() {
    let drag = "[effects.linear_drag]\ndx = { value = 0.4, std = 0.02 }\ndy = { value = 0.4, std = 0.02 }\n";
    let of = |mass: &str| with_drag(&format!("{mass}{drag}"), [0.4, 0.4, 0.4], Autopilot::Px4);
    let fine = of("mass = { value = 2.0, std = 0.098 }\n");
    assert!(has(&fine, "MPC_THR_HOVER"), "{:?}", fine.left_out);
    let rough = of("mass = { value = 2.0, std = 0.12 }\n");
    assert!(!has(&rough, "MPC_THR_HOVER") && has(&rough, "EKF2_MCOEF"));
    assert!(told(&rough, "MPC_THR_HOVER is not written: it would be "), "{:?}", rough.left_out);
    assert!(told(&rough, "an error of 6 %") && told(&rough, "Weigh the vehicle"), "{:?}", rough.left_out);
    // a guessed curve is the largest part of it
    let mut guessed = vehicle();
    guessed.guesses.push(Guess { of: Guessed::Expo, relative: 0.5, why: "THR_MDL_FAC = 0".to_owned() });
    let identified = toml::from_str(&format!("thrust_max = {{ value = 8.0, std = 1.2 }}\n{drag}")).unwrap();
    let effects = [effect("linear_drag", &[0.4, 0.4, 0.4])];
    let to =
        |autopilot| aircraft_parameters(&guessed, &effects, Some(&identified), (autopilot, None)).unwrap();
    let own = to(Autopilot::Px4);
    assert!(told(&own, "a guess of +- 50 %: measure it on a thrust stand"), "{:?}", own.left_out);
    // and it names the autopilot that the model is of
    assert!(!told(&own, "another autopilot"), "{:?}", own.left_out);
    let other = to(Autopilot::ArduPilot);
    assert!(told(&other, "a vehicle with PX4 (its guesses name THR_MDL_FAC)"), "{:?}", other.left_out);
}

#[test]
fn a_hover_throttle_says_at_which_voltage_mass_and_curve_it_holds() {
    let drag = "[effects.linear_drag]\ndx = { value = 0.4, std = 0.02 }\ndy = { value = 0.4, std = 0.02 }\n";
    let identified = format!("mass = {{ value = 2.0, std = 0.02 }}\nbattery_voltage = 16.21\n{drag}");
    let written = with_drag(&identified, [0.4, 0.4, 0.4], Autopilot::ArduPilot);
    let hover = written.parameters.iter().find(|parameter| parameter.name == "MOT_THST_HOVER").unwrap();
    let mass = mavid::report::significant(vehicle().body.mass_kg, 4);
    assert!(hover.why.contains(&format!("at 16.2 V and {mass} kg")), "{}", hover.why);
    let curve = "for a vehicle that has MOT_THST_EXPO = 1.000, which this file does not set";
    assert!(hover.why.contains(curve), "{}", hover.why);
}

#[test]
fn a_latency_that_nobody_found_is_not_lost() {
    let identified: toml::Table =
        toml::from_str("[effects.motor_lag]\ntime_constant = { value = 0.04, std = 0.01 }\n").unwrap();
    let lost = |id: &str, delay_s: f64, identified: Option<&toml::Table>| {
        let exported = export(&vehicle(), &[effect(id, &[delay_s])], identified, Format::Sdf).unwrap();
        exported
            .left_out
            .iter()
            .any(|note| note.starts_with(&format!("{} cannot be represented", called(id))))
    };
    // of 20 ms and of 1 ms in a file that names nothing, and of 20 ms in one that names another one
    assert!(lost("transport_delay", 0.02, None) && !lost("transport_delay", 0.001, None));
    assert!(!lost("transport_delay", 0.02, Some(&identified)));
}

/// A rotor that is weak in one of several flights is not the model's: no file holds it, and each says so, with the flight.
#[test]
fn what_one_flight_has_alone_is_told_by_every_exporter() {
    let model = |flight: &str| -> toml::Table {
        let text = format!(
            "mass = {{ value = 2.0, std = 0.02 }}\n[effects.weak_rotor]\nrotor = {{ value = 2.0, std = 0.0, unit = \"-\" }}\n\
             factor = {{ value = 0.93, std = 0.002, unit = \"-\" }}\n{flight}"
        );
        toml::from_str(&text).unwrap()
    };
    let vehicle = vehicle();
    let told = |identified: &toml::Table| -> Vec<(Vec<String>, String)> {
        let of_simulator = |format: Format| {
            let exported = export(&vehicle, &[], Some(identified), format).unwrap();
            (exported.left_out, exported.text)
        };
        let of_aircraft = |autopilot: Autopilot| {
            let written = aircraft_parameters(&vehicle, &[], Some(identified), (autopilot, None)).unwrap();
            (written.left_out, written.text)
        };
        let formats = [Format::Px4Sih, Format::ArdupilotSitl, Format::Sdf, Format::Mjcf, Format::Rotorpy];
        let aircraft = [Autopilot::Px4, Autopilot::ArduPilot].map(of_aircraft);
        formats.map(of_simulator).into_iter().chain(aircraft).collect()
    };
    let words = format!(
        "weak_rotor was found in second.ulg alone: {}, factor = 0.93; the model does not have it",
        vehicle.motor_words(2)
    );
    for (notes, text) in told(&model("flight = \"second.ulg\"\n")) {
        assert!(notes[0].starts_with(&words), "{notes:?}");
        assert_eq!(
            notes.iter().filter(|note| note.contains("weak rotor") || note.contains("weak_rotor")).count(),
            1
        );
        assert!(text.contains("second.ulg"), "{text}");
    }
    // the file of an older version does not say which
    for (notes, _) in told(&model("")) {
        assert!(notes[0].starts_with("weak_rotor was found in one of the flights alone: "), "{notes:?}");
    }
}
