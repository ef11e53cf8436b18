//! Recorded flights of PX4's simulator: a hold-out with whole propellers after a flight with a weak rotor, the place where a drag acts, and how
//! much of a flight is held back.

use crate::support;
use serde_json::Value;
use std::process::Command;

/// The JSON of an explanation of logs in a folder of the recordings.
fn explained(folder: &str, [log, vehicle]: [&str; 2], hold_out: Option<&str>) -> Option<Value> {
    let folder = support::shared()?.join(folder);
    let path = |name: &str| folder.join(name).display().to_string();
    let [log, vehicle, held] = [log, vehicle, hold_out.unwrap_or_default()].map(path);
    let mut arguments = vec!["explain", &log, "--vehicle", &vehicle, "--json"];
    if hold_out.is_some() {
        arguments.extend(["--holdout", &held]);
    }
    let output = Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// A parameter of an effect, and its standard error.
fn told(document: &Value, id: &str, name: &str) -> Option<(f64, f64)> {
    let effect = document["effects"].as_array()?.iter().find(|effect| effect["id"] == id)?;
    let parameter = effect["parameters"].as_array()?.iter().find(|of| of["name"] == name)?;
    Some((parameter["value"].as_f64()?, parameter["std"].as_f64()?))
}

/// The propeller was changed between both flights: the name stays, and nothing is shown on the hold-out. Without the name its torque would be in
/// the moments of inertia.
#[test]
fn a_hold_out_with_whole_propellers_is_one_of_a_changed_vehicle() {
    for (folder, log, vehicle, held, factor, ixx) in [
        ("recordings/autopilots", "px4_motor1_85.tlog", "px4-sih.toml", "px4_baseline.tlog", 0.85, 0.025),
        ("onboard/sitl", "px05.tlog", "px4-v2.toml", "px04.tlog", 0.93, 0.034),
    ] {
        let Some(document) = explained(folder, [log, vehicle], Some(held)) else { return };
        let (value, std) = told(&document, "weak_rotor", "factor").expect(log);
        assert!((value - factor).abs() < 2.0 * std + 0.002, "{log}: {value} +- {std}");
        let other = document["fit"]["holdout"]["other_vehicle"].as_str().expect(log);
        assert!(other.contains("flew without a weak motor"), "{other}");
        assert!(document["answer"].as_str().unwrap().contains("here, not there"), "{}", document["answer"]);
        assert!(document["fit"]["holdout"]["improvement_percent"].is_null());
        assert!(document["warnings"].to_string().contains("the hold-out flew without"), "{log}");
        let found = document["parameters"]["ixx"]["value"].as_f64().unwrap();
        assert!((found / ixx - 1.0).abs() < 0.1, "{log}: Ixx {found} kg m^2");
    }
}

/// Its drag acts at the centre of mass, and its rotation is damped. Where the model has a share at the hubs instead, that is said to be
/// uncertain.
#[test]
fn a_share_of_the_drag_at_the_hubs_may_be_a_damping() {
    for log in ["px06.ulg", "px07.ulg"] {
        let Some(document) = explained("onboard/sitl", [log, "px4-v2.toml"], None) else { return };
        let Some((share, std)) = told(&document, "linear_drag", "at_hubs") else { continue };
        assert!(share < 3.0 * std, "{log}: {share} +- {std} at the hubs");
    }
}

/// Its last whole periods would leave too little of the flight on one side, and its last third does not.
#[test]
fn a_flight_of_half_a_minute_holds_its_end_back() {
    let Some(document) = explained("recordings/nanobench", ["circle_medium_rep2.csv", "vehicle.toml"], None)
    else {
        return;
    };
    assert_eq!(document["fit"]["shown_on"], "held_back");
    assert!(!document["doubts"].to_string().contains("short"), "{}", document["doubts"]);
    assert!(told(&document, "linear_drag", "dx").is_some(), "{}", document["answer"]);
}
