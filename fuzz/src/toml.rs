//! Every file that the user or another program writes in TOML.

use mavid::config::{
    ConfigError, LoadedVehicle, parse_csv_mapping, parse_effect_tables, parse_limits, parse_trajectory,
    parse_vehicle, trajectory_to_toml, vehicle_to_toml,
};
use mavid::fly::parameters::Parameters;
use mavid::fly::{Course, Lift};
use mavid::physics::{ActiveEffect, Airframe, REFERENCE_SIZE};
use mavid::vehicle::VehicleSize;

use super::bytes::Bytes;
use super::csv;

/// The vehicle for which trajectories and effects are read.
const X500: &str = include_str!("../../configs/x500.toml");
/// Beyond this a course is not laid: it is a matter of minutes, not of reading.
const LONGEST_S: f64 = 600.0;

/// One kind of file a first byte; the rest is its text.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    let kind = script.u8();
    let Ok(text) = std::str::from_utf8(script.rest()) else { return };
    match kind % 7 {
        0 => vehicle(text, seeded),
        1 => trajectory(text),
        2 => effects(text),
        3 => mapping(text),
        4 => limits(text),
        5 => parameters(text),
        _ => model(text),
    }
}

/// What was read, or nothing where it was refused with words.
fn told<T>(read: Result<T, ConfigError>) -> Option<T> {
    read.map_err(|error| assert!(error.to_string().contains("file"), "the origin is named: {error}")).ok()
}

fn loaded(text: &str) -> Option<LoadedVehicle> {
    told(parse_vehicle(text, "file"))
}

/// A vehicle can be used, and is the same when it was written and read again.
fn vehicle(text: &str, seeded: bool) {
    let Some(loaded) = loaded(text) else { return };
    let vehicle = &loaded.vehicle;
    assert!(!seeded || loaded.warnings.is_empty(), "the seeded bug: a vehicle with a warning");
    let _ = Lift::new(vehicle, &Parameters::default());
    let _ = Airframe::new(vehicle);
    let written = vehicle_to_toml(vehicle).expect("what was read can be written");
    let again = parse_vehicle(&written, "written").unwrap_or_else(|error| panic!("{error} in\n{written}"));
    assert!(near(vehicle.body.mass_kg, again.vehicle.body.mass_kg), "{written}");
    assert_eq!(vehicle.name, again.vehicle.name);
    assert_eq!(vehicle.rotors.len(), again.vehicle.rotors.len());
    assert!(near(vehicle.gravity_m_s2, again.vehicle.gravity_m_s2), "{written}");
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}

/// A model is a vehicle with effects.
fn model(text: &str) {
    let Some(loaded) = loaded(text) else { return };
    for table in &loaded.model.effects {
        effect(table, &loaded.vehicle.size());
    }
}

fn effects(text: &str) {
    for table in told(parse_effect_tables(text, "file")).unwrap_or_default() {
        effect(&table, &REFERENCE_SIZE);
    }
}

/// As the commands do: an id and numbers by name.
fn effect(table: &toml::Table, size: &VehicleSize) {
    let Some(id) = table.get("id").and_then(toml::Value::as_str) else { return };
    let numbers = table.iter().filter_map(|(name, value)| {
        let number = value.as_float().or_else(|| {
            let whole = value.as_integer()?;
            i32::try_from(whole).ok().map(f64::from)
        });
        number.map(|number| (name.as_str(), number))
    });
    match ActiveEffect::named(id, &numbers.collect::<Vec<_>>(), size) {
        Ok(active) => assert_eq!(active.effect().id(), id),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// A series has finite derivatives everywhere, and is the same when it was written and read again.
fn trajectory(text: &str) {
    let Some(stored) = told(parse_trajectory(text, "file")) else { return };
    let written = trajectory_to_toml(&stored).expect("what was read can be written");
    let again = parse_trajectory(&written, "written").unwrap_or_else(|error| panic!("{error} in\n{written}"));
    assert_eq!(stored.series, again.series, "{written}");
    assert_eq!(stored.repeats, again.repeats, "{written}");
    assert_eq!(stored.transitions, again.transitions, "{written}");
    let vehicle = parse_vehicle(X500, "x500").expect("a vehicle of the project").vehicle;
    if stored.series.period_s * f64::from(stored.repeats) < LONGEST_S {
        // refused or laid, and laid it has an end
        if let Ok(course) = Course::new(&stored.series, stored.repeats, None, &stored.limits, &vehicle) {
            assert!(course.path().duration_s().is_finite());
        }
    }
}

fn limits(text: &str) {
    let _ = told(parse_limits(text, "file"));
}

/// What a mapping says is applied to a small table.
fn mapping(text: &str) {
    let Some(mapping) = told(parse_csv_mapping(text, "file")) else { return };
    let names: Vec<&str> =
        mapping.quantities.iter().flat_map(|quantity| &quantity.columns).map(String::as_str).collect();
    let header = format!("{},{}\n", mapping.time.column, names.join(","));
    let row = |time: &str| format!("{time}{}\n", ",1".repeat(names.len()));
    let table = [header, row("0"), row("1e300"), row("-1")].concat();
    let _ = csv::read(table.as_bytes(), &mapping);
}

/// Parameters are the same when they were written and read again.
fn parameters(text: &str) {
    let Ok(parameters) = Parameters::from_toml(text, "file") else { return };
    let written = parameters.to_toml().expect("what was read can be written");
    let again =
        Parameters::from_toml(&written, "written").unwrap_or_else(|error| panic!("{error} in\n{written}"));
    assert_eq!(format!("{parameters:?}"), format!("{again:?}"), "{written}");
    let vehicle = parse_vehicle(X500, "x500").expect("a vehicle of the project").vehicle;
    let _ = Lift::new(&vehicle, &parameters);
}
