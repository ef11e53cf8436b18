//! The examples run and give what their logs hold.

#![allow(
    clippy::unwrap_used,
    dead_code,
    reason = "a test ends where it fails; an example has a main function"
)]

#[path = "../../examples/explain.rs"]
mod explain;
#[path = "../../examples/identify.rs"]
mod identify;
#[path = "../../examples/new_effect/main.rs"]
mod new_effect;

#[test]
fn identify_prints_mass_and_inertia_with_their_errors() {
    let table = identify::table().unwrap();
    // the true mass is 2.06 kg: fixtures/README.md
    assert!(table.starts_with("mass = 2.06"), "{table}");
    assert_eq!(table.matches("+-").count(), 7, "{table}");
}

#[test]
fn explain_prints_the_lag_that_is_there() {
    let text = explain::effects().unwrap();
    // the true lag is 60 ms: fixtures/README.md
    assert!(text.contains("motor_lag: The motors' lag was left out"), "{text}");
}

#[test]
fn a_new_effect_is_simulated_and_found() {
    let text = new_effect::found().unwrap();
    assert!(text.starts_with("explained\nside_force: "), "{text}");
    // 0.25 N/(m/s) is concealed
    let size = text.split("found ").nth(1).and_then(|size| size.split(' ').next()).unwrap();
    assert!((size.parse::<f64>().unwrap() - 0.25).abs() < 0.02, "{text}");
}
