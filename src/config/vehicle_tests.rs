//! Tests of reading vehicle files.

use super::*;
use crate::config::vehicle_to_toml;
use crate::vehicle::{Actuator, Propulsion, PwmRange, ThrustLaw};

const BODY: &str = "name = \"quad\"\n[body]\nmass = 1.5\ninertia = { xx = 0.02, yy = 0.02, zz = 0.035 }\n";
const CURVE: &str = "[propulsion]\nactuator = \"pwm\"\npwm_min = 1000\npwm_max = 2000\nthrust_max = 8.0\n\
                     thrust_expo = 0.5\ntorque_ratio = 0.02\n";
const SPEED: &str = "[propulsion]\nactuator = \"speed\"\nspeed_max = 1000\nthrust_coefficient = 1e-5\n\
                     torque_coefficient = 2e-7\n";
const ROTORS: &str = r#"
[[rotor]]
name = "front_left"
position = [0.2, 0.2, 0.0]
spin = "cw"
[[rotor]]
name = "front_right"
position = [0.2, -0.2, 0.0]
spin = "ccw"
[[rotor]]
name = "rear_right"
position = [-0.2, -0.2, 0.0]
spin = "cw"
[[rotor]]
name = "rear_left"
position = [-0.2, 0.2, 0.0]
spin = "ccw"
"#;

fn parse(parts: &[&str]) -> Result<LoadedVehicle, ConfigError> {
    parse_vehicle(&parts.concat(), "quad.toml")
}

fn refusal(parts: &[&str]) -> String {
    parse(parts).unwrap_err().to_string()
}

#[test]
fn units_become_si() {
    let limits = "[limits]\nroll_max_deg = 5.73\nyaw_rate_max_deg_s = 180\nz_min_m = 0.7\nz_max_m = 1.5\n";
    let loaded = parse(&[BODY, SPEED, ROTORS, limits, "[identify]\nanchor = \"mass\"\n"]).unwrap();
    let vehicle = loaded.vehicle;
    assert_eq!(loaded.warnings, []);
    assert!((vehicle.propulsion.torque_per_thrust_m - 0.02).abs() < 1e-15);
    assert!((vehicle.limits.roll_max_rad.unwrap() - 0.100_007_366).abs() < 1e-8);
    assert!((vehicle.limits.yaw_rate_max_rad_s.unwrap() - std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(vehicle.anchor, Anchor::Mass);
    assert_eq!(vehicle.gravity_m_s2, units::GRAVITY_M_S2);
}

#[test]
fn the_gyroscopic_torque_acts_by_a_share_of_none_to_all() {
    let with = |share: &str| parse(&[BODY, "gyroscopic = ", share, "\n", SPEED, ROTORS]);
    for share in [0.0, 0.25, 1.0] {
        assert_eq!(with(&format!("{share:?}")).unwrap().vehicle.body.gyroscopic, share);
    }
    for share in ["-0.1", "1.01", "nan", "inf"] {
        let told = with(share).unwrap_err().to_string();
        assert!(told.contains("quad.toml") && told.contains("body.gyroscopic"), "{told}");
        assert!(told.contains("a share of 0 to 1"), "{told}");
    }
    assert!(with("-0.1").unwrap_err().to_string().contains("-0.1"));
}

#[test]
fn pulse_widths_with_a_range_and_fractions_without() {
    let vehicle = parse(&[BODY, CURVE, ROTORS]).unwrap().vehicle;
    let range = PwmRange { min_us: 1000.0, max_us: 2000.0 };
    assert_eq!(vehicle.propulsion.actuator, Actuator::Pwm(Some(range)));
    let fractions = SPEED.replace("\"speed\"", "\"pwm\"");
    let vehicle = parse(&[BODY, &fractions, ROTORS]).unwrap().vehicle;
    assert_eq!(vehicle.propulsion.actuator, Actuator::Pwm(None));
    assert_eq!(vehicle.propulsion.law, ThrustLaw::Speed { speed_max_rad_s: 1000.0 });
}

#[test]
fn written_and_read_again_it_is_the_same() {
    let lagging = format!("{SPEED}time_constant = 0.0125\ntime_constant_down = 0.025\n");
    for propulsion in [CURVE, SPEED, &lagging] {
        let limits = "[limits]\nyaw_max_deg = 180.0\nthrust_max_n = 34.4\n";
        let vehicle = parse(&[BODY, propulsion, ROTORS, limits]).unwrap().vehicle;
        let mut text = vehicle_to_toml(&vehicle).unwrap();
        text.push_str("[identified]\nmass = 1.5\n[provenance]\nversion = \"0\"\n[[effect]]\nid = \"inflow\"\nkz = 0.1\n");
        let again = parse_vehicle(&text, "model.toml").unwrap();
        let ratio = again.vehicle.propulsion.torque_per_thrust_m;
        assert!((ratio / vehicle.propulsion.torque_per_thrust_m - 1.0).abs() < 1e-12);
        let same = Vehicle {
            propulsion: Propulsion {
                torque_per_thrust_m: vehicle.propulsion.torque_per_thrust_m,
                ..again.vehicle.propulsion
            },
            ..again.vehicle
        };
        assert_eq!(same, vehicle);
        assert_eq!(again.model.effects.len(), 1);
        assert!(again.model.identified.is_some() && again.model.provenance.is_some());
    }
}

#[test]
fn refusals_name_file_key_and_value() {
    for (parts, needles) in [
        (vec![BODY, "mas = 2\n", SPEED, ROTORS], vec!["quad.toml", "unknown field `mas`"]),
        (vec![&BODY.replace("1.5", "-1.5"), SPEED, ROTORS], vec!["`body.mass`", "got -1.5"]),
        (vec![&BODY.replace("0.02,", "nan,"), SPEED, ROTORS], vec!["`body.inertia.xx`", "got NaN"]),
        (vec![&BODY.replace("0.035 }", "0.035, xy = 0.03 }"), SPEED, ROTORS], vec!["positive definite"]),
        (
            vec![BODY, SPEED, "time_constant_down = 0.02\n", ROTORS],
            vec!["`propulsion.time_constant`: expected a number, since time_constant_down", "got nothing"],
        ),
        (
            vec![BODY, SPEED, "time_constant = 0.02\ntime_constant_down = 0\n", ROTORS],
            vec!["`propulsion.time_constant_down`: expected a number above zero", "got 0"],
        ),
        (vec![BODY, SPEED, "thrust_max = 5\n", ROTORS], vec!["speed_max = 1000 and thrust_max = 5"]),
        (
            vec![BODY, SPEED, "torque_ratio = 0.02\n", ROTORS],
            vec!["`propulsion.torque_ratio`: expected no such key, since", "u * speed_max"],
        ),
        (vec![BODY, SPEED, "pwm_min = 1000\n", ROTORS], vec!["`propulsion.pwm_min`", "not \"pwm\""]),
        (
            vec![BODY, &CURVE.replace("2000", "900"), ROTORS],
            vec!["`propulsion.pwm_min`", "below `propulsion.pwm_max` = 900", "got 1000"],
        ),
        (vec![BODY, &CURVE.replace("pwm_max = 2000\n", ""), ROTORS], vec!["`propulsion.pwm_max`", "nothing"]),
        (vec![BODY, &CURVE.replace("0.5", "1.5"), ROTORS], vec!["`propulsion.thrust_expo`", "got 1.5"]),
        (vec![BODY, SPEED], vec!["`rotor`", "at least one"]),
        // no body has more about one axis than about both others together; a little more is an error of measurement
        (
            vec![&BODY.replace("0.035", "0.07"), SPEED, ROTORS],
            vec!["`body.inertia`", "at most the sum of the other two", "got 7.000e-2"],
        ),
        // products of such numbers overflow, and factorisations of infinities do not end
        (
            vec![BODY, SPEED, &ROTORS.replacen("0.2", "1e200", 1)],
            vec!["`rotor[0].position`", "of size 1e-18 to 1e12", "got 1e200"],
        ),
        (vec![&BODY.replace("1.5", "1e-320"), SPEED, ROTORS], vec!["`body.mass`", "of size 1e-18 to 1e12"]),
        (vec![BODY, SPEED, &ROTORS.replace("rear_left", "front_left")], vec!["\"front_left\" twice"]),
        (
            vec![BODY, SPEED, ROTORS, "[limits]\nz_min_m = 2\nz_max_m = 1\n"],
            vec!["`limits.z_min_m`", "below `limits.z_max_m` = 1", "got 2"],
        ),
        (vec![BODY, SPEED, ROTORS, "[limits]\nroll_max_deg = 95\n"], vec!["`limits.roll_max_deg`", "95"]),
    ] {
        let message = refusal(&parts);
        for needle in needles {
            assert!(message.contains(needle), "{needle:?} is not in {message:?}");
        }
    }
}

#[test]
fn names_command_nothing_and_have_an_end() {
    let evil = BODY.replace("\"quad\"", "\"x\\u001b[31m\\nall is well\"");
    let rotors = ROTORS.replacen("front_left", "front\\u009bleft", 1);
    let loaded = parse(&[&evil, SPEED, &rotors]).unwrap();
    assert_eq!(loaded.vehicle.name, "x\\u{1b}[31m\\nall is well");
    assert_eq!(loaded.vehicle.rotors[0].name, "front\\u{9b}left");
    assert!(loaded.warnings.len() == 2 && loaded.warnings[0].text.starts_with("rotor[0].name: expected"));
    let long = BODY.replace("quad", &"q".repeat(1000));
    assert!(refusal(&[&long, SPEED, ROTORS]).contains("`name`: expected at most 200 characters, got 1000"));
    let many: String = (0..40)
        .map(|n| format!("[[rotor]]\nname = \"{n}\"\nposition = [0.2, 0.2, 0.0]\nspin = \"cw\"\n"))
        .collect();
    assert!(refusal(&[BODY, SPEED, &many]).contains("`rotor`: expected at most 32 [[rotor]] tables, got 40"));
}

#[test]
fn what_is_hardly_meant_is_warned_of() {
    let slender = BODY.replace("0.035", "0.05");
    let two = ROTORS.split("[[rotor]]\nname = \"rear_right\"").next().unwrap();
    let loaded = parse(&[&slender, SPEED, two]).unwrap();
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    let weak = SPEED.replace("1e-5", "1e-6");
    let loaded = parse(&[BODY, &weak, ROTORS]).unwrap();
    assert!(loaded.warnings[0].text.contains("4.000 N, does not lift the weight, 14.715 N"));
}

/// Each of the lines that a refusal of several errors has, without the file's name.
fn refusals(parts: &[&str]) -> Vec<String> {
    let lines = parse(parts).unwrap_err().lines();
    lines.iter().map(|line| line.trim_start_matches("quad.toml: ").to_owned()).collect()
}

#[test]
fn all_that_is_wrong_is_told_at_once() {
    let body =
        BODY.replace("1.5", "-1.5").replace("xx = 0.02", "xx = \"thin\"").replace("zz = 0.035", "zz = nan");
    let speed = SPEED.replace("speed_max = 1000\n", "speed_max = 0\nspeed_min = 1\n").replace("2e-7", "-1");
    let rotors = ROTORS.replacen("\"cw\"", "\"left\"", 1).replacen("spin = \"ccw\"\n", "", 1);
    let limits = "[limits]\nz_min_m = 2\nz_max_m = 1\nroll_max_deg = 95\nx_max_m = -3\n";
    let lines = refusals(&[&body, &speed, &rotors, limits]);
    let expected = [
        "11 errors",
        "line 4, column 18 (`inertia = { xx = \"thin\", yy = 0.02, zz = nan }`): invalid type: string \"thin\", expected f64",
        "unknown field `speed_min`, expected one of `actuator`",
        "unknown variant `left`, expected `cw` or `ccw`",
        "missing field `spin` in `rotor[1]`",
        "`body.mass`: expected a number above zero, got -1.5",
        "`body.inertia.zz`: expected a number above zero, got NaN",
        "`propulsion.speed_max`: expected a number above zero, got 0",
        "`propulsion.torque_coefficient`: expected a number not below zero, got -1",
        "`limits.x_max_m`",
        "`limits.z_min_m`: expected a number below `limits.z_max_m` = 1, got 2",
        "`limits.roll_max_deg`: expected an angle below 90 degrees",
    ];
    for needle in &expected[1..] {
        assert!(lines.iter().any(|line| line.contains(needle)), "{needle:?} is not in {lines:#?}");
    }
    assert_eq!(lines.len(), expected.len(), "{lines:#?}");
}

#[test]
fn what_is_missing_as_a_whole_is_told_once() {
    let lines = refusals(&["name = \"x\"\n[body]\nmass = 1\n"]);
    assert_eq!(lines.len(), 4, "{lines:#?}");
    assert!(lines[1].contains("missing field `inertia` in `body`"), "{lines:#?}");
    assert!(lines[2].contains("missing field `propulsion`"), "{lines:#?}");
    assert!(lines[3].contains("`rotor`: expected at least one"), "{lines:#?}");
}

#[test]
fn a_position_of_two_numbers_or_of_text_is_told_where_it_stands() {
    let rotors = ROTORS.replacen("[0.2, 0.2, 0.0]", "[0.2, 0.2]", 1).replacen(
        "[0.2, -0.2, 0.0]",
        "[0.2, \"x\", 0]",
        1,
    );
    let lines = refusals(&[BODY, SPEED, &rotors]);
    assert_eq!(lines.len(), 3, "{lines:#?}");
    assert!(lines[1].contains("invalid length 2, expected an array of length 3"), "{lines:#?}");
    assert!(lines[2].contains("invalid type: string \"x\", expected f64"), "{lines:#?}");
}

#[test]
fn what_is_no_toml_is_told_by_its_lines_and_a_foreign_file_has_an_end() {
    let lines = refusals(&["name = \n[body\nmass = 1\n"]);
    assert!(lines.len() > 1 && lines.iter().any(|line| line.contains("line 1")), "{lines:#?}");
    let many: String = (0..1000).map(|number| format!("key_{number} = 1\n")).collect();
    let lines = refusals(&[&many]);
    assert_eq!((lines.len(), lines[0].as_str()), (21, "20 or more errors"), "{lines:#?}");
}

#[test]
fn what_follows_from_a_fault_is_not_told() {
    let lines = refusals(&[BODY, &CURVE.replace("\"pwm\"", "\"pmw\""), ROTORS]);
    assert!(lines.len() == 1 && lines[0].contains("unknown variant `pmw`"), "{lines:#?}");
    let lines = refusals(&[&BODY.replace("mass = 1.5\n", ""), SPEED, ROTORS]);
    assert!(lines.len() == 1 && lines[0].contains("missing field `mass` in `body`"), "{lines:#?}");
}
