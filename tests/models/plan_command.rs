//! `mavid plan` at its process boundary.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::config::load_vehicle;
use mavid::fly::{Around, Course};

fn plan(vehicle: &str, arguments: &[&str]) -> Output {
    let vehicle = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(vehicle);
    Command::new(env!("CARGO_BIN_EXE_mavid")).arg("plan").arg(vehicle).args(arguments).output().unwrap()
}

fn temporary(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("plan_command-{name}"))
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn json_has_the_settled_keys() {
    let out = temporary("plan.toml");
    let output = plan("qball2.toml", &["--starts", "2", "--json", "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document = json(&output);
    assert_eq!(document["schema"], 1);
    assert_eq!(document["criterion"], "cond");
    assert!(document["condition_number"].as_f64().unwrap() < 17.0);
    for name in ["mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"] {
        let error = document["standard_errors"][name].as_f64().unwrap();
        assert!(error > 0.0 && error < 1.0, "{name} {error}");
    }
    assert!(document["margins"].as_object().unwrap().values().all(|spare| spare.as_f64().unwrap() >= 0.0));
    let again = plan("qball2.toml", &["--check", out.to_str().unwrap(), "--json"]);
    assert_eq!(again.status.code(), Some(0));
    let (first, second) = (document["condition_number"].as_f64(), json(&again)["condition_number"].as_f64());
    assert!((first.unwrap() - second.unwrap()).abs() < 1e-9);
}

/// With the first margin alone 3 to 6 % of the X500's commands are at a bound.
#[test]
fn the_rotors_of_a_plan_stay_off_their_bounds_as_it_is_flown() {
    for vehicle in ["x500.toml", "iris.toml"] {
        let output = plan(vehicle, &["--starts", "4", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let share = json(&output)["share_at_rotor_bound"].as_f64().unwrap();
        assert!(share <= 0.002, "{vehicle}: {share}");
    }
}

#[test]
fn a_circle_is_written_with_the_way_to_it() {
    let out = temporary("circle.toml");
    let arguments = ["--circle", "0.5,5", "--takeoff", "0,0,1.8", "--json", "--out", out.to_str().unwrap()];
    let output = plan("x500.toml", &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stdout));
    let stored = mavid::config::read_trajectory(&out).unwrap();
    let start = stored.series.derivatives(0.0);
    assert!((start[0][0] - 0.5).abs() < 1e-12 && (stored.series.period_s - 5.0).abs() < 1e-12);
    let transitions = stored.transitions.unwrap();
    assert!((transitions.takeoff[2] - 1.8).abs() < 1e-12 && transitions.to_start_s >= 1.0);
    // faster than the limits allow
    let fast = plan("x500.toml", &["--circle", "1.5,2", "--json"]);
    assert_eq!(fast.status.code(), Some(3));
    assert!(json(&fast)["first_violation"].as_str().unwrap().contains("limit"));
}

#[test]
fn a_plan_says_how_long_it_is_flown_from_hover_to_hover() {
    let out = temporary("long.toml");
    let output = plan("x500.toml", &["--circle", "0.5,5", "--repeats", "4", "--out", out.to_str().unwrap()]);
    let page = String::from_utf8(output.stdout).unwrap();
    let vehicle = load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
    let stored = mavid::config::read_trajectory(&out).unwrap();
    let ways = stored.transitions.unwrap();
    let around = Around {
        takeoff: ways.takeoff,
        landing: ways.landing,
        to_start_s: ways.to_start_s,
        to_landing_s: ways.to_landing_s,
    };
    // as `fly` flies it
    let course =
        Course::new(&stored.series, stored.repeats, Some(&around), &stored.limits, &vehicle).unwrap();
    let said =
        format!("the flight takes {:.0} s from hover to hover, 20 s of them", course.path().duration_s());
    assert!(page.contains(&said), "{said}\n{page}");
    assert!(page.contains("standard errors expected before the flight"), "{page}");
    // in words; identifiers are for JSON
    assert!(page.contains("  place along north, at most ") && !page.contains("_m_"), "{page}");
}

#[test]
fn wrong_input_is_named() {
    for (arguments, word) in [
        (["--period", "-1"], "period: expected 0.1 to 1000 s, got -1"),
        (["--harmonics", "0"], "harmonics: expected 4 to 20, got 0"),
        (["--repeats", "0"], "repeats"),
        (["--start", "9,0"], "start at x = 9"),
        (["--start", "1"], "expected X,Y[,Z[,YAW]]"),
        (["--circle", "-1,5"], "radius above 0 m"),
        (["--circle", "1,-5"], "period of 0.1 to 1000 s"),
        (["--takeoff", "1"], "expected X,Y,Z[,YAW]"),
        (["--limits", "no-such-file.toml"], "no-such-file.toml"),
    ] {
        let output = plan("qball2.toml", &[&arguments[..], &["--starts", "1", "--json"]].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let told = document["error"]["message"].as_str().unwrap();
        assert!(told.contains(word) && message.contains(word), "{arguments:?}: {message}");
    }
    let vehicle = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let output = plan("qball2.toml", &["--limits", vehicle.to_str().unwrap(), "--starts", "1"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    let expected =
        "x500.toml: expected a file in TOML with a [limits] table and nothing else, got a vehicle file (";
    assert!(message.contains(expected), "{message}");
    let limits = temporary("conflict.toml");
    std::fs::write(&limits, "[limits]\nthrust_max_n = 10.0\n").unwrap();
    let output = plan("qball2.toml", &["--limits", limits.to_str().unwrap(), "--starts", "1"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("thrust_max_n = 10"), "{message}");
}

/// Without a room, and with one that reaches below the ground.
#[test]
fn a_plan_has_a_room_above_the_ground_and_says_where_it_is_not_the_stated_one() {
    let described =
        std::fs::read_to_string(format!("{}/configs/x500.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let body = described.split("[limits]").next().unwrap();
    let rooms = [
        ("none", "", "defaults are used"),
        (
            "low",
            "[limits]\nx_max_m = 2.0\ny_max_m = 2.0\nz_min_m = -5.0\nz_max_m = 4.0\nspeed_max_m_s = 1.5\n",
            "got -5.00",
        ),
    ];
    for (name, limits, said) in rooms {
        let (vehicle, out) =
            (temporary(&format!("{name}_room.toml")), temporary(&format!("{name}_plan.toml")));
        std::fs::write(&vehicle, format!("{body}{limits}")).unwrap();
        for way in [&["--starts", "1"][..], &["--circle", "1,6"][..]] {
            let further = [way, &["--out", out.to_str().unwrap()][..]].concat();
            let output = plan(vehicle.to_str().unwrap(), &further);
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success() && stderr.contains(said), "{name}: {stderr}");
            let planned = mavid::config::read_trajectory(&out).unwrap();
            for step in 0..500 {
                let [_, _, z, _] =
                    planned.series.derivatives(planned.series.period_s * f64::from(step) / 500.0);
                assert!((0.6..10.0).contains(&z[0]), "{name}: {} m", z[0]);
            }
        }
        let low = plan(vehicle.to_str().unwrap(), &["--starts", "1", "--landing", "0,0,0.2"]);
        assert_eq!(low.status.code(), Some(3), "{name}");
        assert!(String::from_utf8_lossy(&low.stdout).contains("hover of landing is at 0.20 m"), "{name}");
    }
}
