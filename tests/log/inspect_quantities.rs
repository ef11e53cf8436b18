//! What `inspect` expects of a log is what `explain` and `identify` then find.

use crate::support;

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::config::read_vehicle;
use mavid::diagnose::{Expected, ExplainSettings, expected_errors, explain};
use mavid::inspect::{Inspection, QuantitySummary, inspect};
use mavid::log::{self, OpenOptions};
use mavid::report::inspection_text;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

fn inspected(log: &Path, vehicle: Option<&Vehicle>) -> Inspection {
    inspect(log, &OpenOptions::default(), vehicle, &mut |_| ()).unwrap()
}

fn quantity<'a>(found: &'a Inspection, name: &str) -> &'a QuantitySummary {
    found.quantities.iter().find(|quantity| quantity.name == name).unwrap()
}

/// The standard error that is expected of an effect against the one that comes with its name.
fn holds(log: &Path, vehicle: &Path, name: &str, effect: &str) {
    let vehicle = read_vehicle(vehicle).unwrap().vehicle;
    let inspection = inspected(log, Some(&vehicle));
    let expected = &quantity(&inspection, name).expected[0];
    let recording = log::open(log, &OpenOptions::default()).unwrap().recording;
    let signals = condition(&recording, &vehicle, &ConditionSettings::default()).unwrap();
    let explanation = explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap();
    let named = explanation.named.iter().find(|named| named.id == effect).unwrap();
    let of = named.parameters.iter().find(|found| found.name == expected.parameter);
    let found = of.unwrap_or_else(|| panic!("{expected:?} {named:?}")).std;
    let ratio = expected.std.unwrap() / found;
    // before an effect is found it is part of the noise: the expectation is careful
    assert!((0.3..10.0).contains(&ratio), "{effect}: expected {expected:?}, found {found:e}");
}

#[test]
fn a_lag_is_found_as_well_as_expected() {
    let log = fixture("p04_identify_10_22s.tlog");
    holds(&log, &fixture("p04_vehicle.toml"), "motor_lag", "motor_lag");
}

#[test]
fn the_effects_of_the_practice_cases_are_found_as_well_as_expected() {
    let cases = [
        ("p02-linear-drag", "drag", "linear_drag"),
        ("p05-com-offset", "centre_of_mass", "com_offset"),
        ("p06-wind-and-drag", "wind", "steady_wind"),
    ];
    for (case, name, effect) in cases {
        let Some(case) = support::shared_case(case) else { return };
        holds(&case.join("identify.tlog"), &case.join("vehicle.toml"), name, effect);
    }
}

#[test]
fn without_a_vehicle_errors_are_relative_and_much_the_same() {
    let log = fixture("px4_flight.ulg");
    let vehicle = read_vehicle(&fixture("px4-sih.toml")).unwrap().vehicle;
    let (with, without) = (inspected(&log, Some(&vehicle)), inspected(&log, None));
    assert!(without.quantities_relative && !with.quantities_relative);
    for name in ["mass", "inertia", "motor_lag", "rotor_efficiency"] {
        let relative =
            |found: &Inspection| quantity(found, name).expected.first().map(|one| one.std_relative);
        let (known, assumed) = (relative(&with), relative(&without));
        assert_eq!(known.is_some(), assumed.is_some(), "{name}");
        let ratio = known.zip(assumed).map_or(1.0, |(known, assumed)| known / assumed);
        // the thrust curve of a vehicle that is not known is a guess, and the mass has its error
        let least = if name == "mass" { 0.0 } else { 0.4 };
        assert!((least..2.5).contains(&ratio), "{name}: {known:?} {assumed:?}");
    }
    // in kilograms and metres nothing is known of a vehicle that was neither weighed nor measured
    for name in ["mass", "inertia", "centre_of_mass"] {
        assert!(quantity(&without, name).expected.iter().all(|one| one.std.is_none()), "{name}");
    }
    assert!(quantity(&without, "drag").expected.iter().all(|one| one.unit == "1/s"));
}

/// Rotor speeds are behind the motors: what they lag is not in them. Commands beside them tell it.
#[test]
fn a_lag_is_not_promised_of_measured_rotor_speeds() {
    let pair = random_vehicle(5);
    let trajectory = RandomTrajectory::default().draw(5).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let settings = FlightSettings { seed: 5, duration_s: 30.0, ..FlightSettings::default() };
    let flight = simulate_flight(Truth::clean(pair.truth), &pair.nominal, &reference, &settings).unwrap();
    let expected = |thrust| {
        let settings = ConditionSettings { thrust, ..ConditionSettings::default() };
        let signals = condition(&flight.recording, &pair.nominal, &settings).unwrap();
        let errors = expected_errors(&[signals], &pair.nominal).unwrap();
        errors.into_iter().find(|error| error.quantity == "motor_lag").unwrap().of
    };
    assert_eq!(expected(ThrustPreference::Measured), Expected::Measured);
    assert!(matches!(expected(ThrustPreference::Commands), Expected::Known { .. }));
}

#[test]
fn the_first_screen_has_a_line_for_each_quantity() {
    let log = fixture("px4_flight.ulg");
    let output = Command::new(env!("CARGO_BIN_EXE_mavid")).arg("inspect").arg(&log).output().unwrap();
    let page = String::from_utf8(output.stdout).unwrap();
    let screen: Vec<&str> = page.lines().take(24).collect();
    for name in [
        "mass",
        "inertia",
        "thrust curve",
        "motor lag",
        "drag",
        "wind",
        "centre of mass",
        "rotor efficiency",
        "voltage sag",
    ] {
        let line = screen.iter().find(|line| line.trim_start().starts_with(name)).unwrap();
        let said = line.trim_start().trim_start_matches(name).trim_start();
        assert!(["yes", "partly", "no"].iter().any(|word| said.starts_with(word)), "{line}");
    }
}

#[test]
fn without_a_vehicle_yaw_and_poor_errors_are_told_as_with_one() {
    let Some(shared) = support::shared() else { return };
    let log = shared.join("onboard/sitl/px06.ulg");
    let found = inspect(&log, &OpenOptions::default(), None, &mut |_| ()).unwrap();
    let text = inspection_text("px06.ulg", &found);
    assert!(found.verdict.contains("Izz also needs the rotors' torque per thrust"), "{}", found.verdict);
    assert!(text.contains("; Izz only where the rotors' torque per thrust is known"), "{text}");
    assert!(text.contains("yes, but poorly, to"), "{text}");
}
