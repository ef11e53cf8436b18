//! `mavid identify --with`: effects that a simulated flight conceals, identified together with the rigid body.

use crate::support;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn path(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name).display().to_string()
}

/// A fresh folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("identify-with-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// An X500 whose rotors follow at once: the shipped file's slow down more slowly than they speed up.
fn x500(folder: &Path) -> String {
    let text = std::fs::read_to_string(path("configs/x500.toml")).unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("time_constant")).collect();
    let file = folder.join("x500.toml");
    std::fs::write(&file, lines.join("\n")).unwrap();
    file.display().to_string()
}

/// The log of an X500 that flies table 2 with these effects.
fn flown(folder: &Path, vehicle: &str, effects: &str) -> String {
    let (file, log) = (folder.join("concealed.toml"), folder.join("flight.tlog").display().to_string());
    std::fs::write(&file, effects).unwrap();
    let (file, trajectory) = (file.display().to_string(), path("configs/trajectories/table2.toml"));
    let simulated =
        mavid(&["simulate", vehicle, "--trajectory", &trajectory, "--effects", &file, "--out", &log]);
    assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
    log
}

fn document(arguments: &[&str]) -> Value {
    let output = mavid(&[&["identify", "--json"], arguments].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn refusal(arguments: &[&str]) -> String {
    let output = mavid(&[&["identify"], arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr).unwrap()
}

fn effect<'a>(document: &'a Value, id: &str) -> &'a Value {
    document["with"]["effects"].as_array().unwrap().iter().find(|effect| effect["id"] == id).unwrap()
}

fn parameter<'a>(effect: &'a Value, name: &str) -> &'a Value {
    effect["parameters"].as_array().unwrap().iter().find(|parameter| parameter["name"] == name).unwrap()
}

/// Within a share of the truth and within three standard errors.
fn assert_found(effect: &Value, name: &str, truth: f64, share: f64) {
    let parameter = parameter(effect, name);
    let (value, std) = (parameter["value"].as_f64().unwrap(), parameter["std"].as_f64().unwrap());
    assert_eq!(parameter["status"], "determined", "{parameter}");
    let off = (value - truth).abs();
    assert!(off < share * truth.abs() && off < 3.0 * std, "{name}: {value} +- {std}, concealed {truth}");
}

const DRAG: &str = "[[effect]]\nid = \"linear_drag\"\ndx = 0.6\ndy = 0.5\ndz = 0.0\n";
const WIND: &str = "[[effect]]\nid = \"steady_wind\"\nnorth = 2.0\nwest = -1.5\nup = 0.0\n";

#[test]
fn wind_and_drag_come_with_mass_and_inertia_and_go_into_the_model() {
    let folder = folder("wind");
    let vehicle = x500(&folder);
    let log = flown(&folder, &vehicle, &format!("{DRAG}{WIND}"));
    let model = folder.join("model.toml").display().to_string();
    let with = ["--vehicle", &vehicle, "--with", "steady_wind,linear_drag", "--out", &model];
    let said = document(&[&[log.as_str()], &with[..]].concat());
    let (drag, wind) = (effect(&said, "linear_drag"), effect(&said, "steady_wind"));
    assert_found(drag, "dx", 0.6, 0.1);
    assert_found(drag, "dy", 0.5, 0.1);
    assert_found(wind, "north", 2.0, 0.1);
    assert_found(wind, "west", -1.5, 0.1);
    assert_eq!(parameter(wind, "up")["status"], "not_determined");
    assert!(drag["significant"] == true && wind["z"].as_f64().unwrap() > 10.0);
    let mass = said["with"]["parameters"]["mass"]["value"].as_f64().unwrap();
    assert!((mass / 2.064 - 1.0).abs() < 0.01, "{mass}");
    for channel in ["force_x", "force_y"] {
        let misfit = &said["with"]["misfit"][channel];
        assert!(misfit["with"].as_f64().unwrap() < 0.2 * misfit["without"].as_f64().unwrap(), "{misfit}");
    }
    // the order of a set changes nothing
    let turned = document(&[&log, "--vehicle", &vehicle, "--with", "linear_drag", "--with", "steady_wind"]);
    for name in ["dx", "dy"] {
        let (a, b) = (parameter(effect(&turned, "linear_drag"), name), parameter(drag, name));
        let off = (a["value"].as_f64().unwrap() - b["value"].as_f64().unwrap()).abs();
        assert!(off < 0.1 * a["std"].as_f64().unwrap(), "{a} {b}");
    }

    // the model flies, and predicts what the bare vehicle does not
    let (again, trajectory) = (folder.join("again.tlog"), path("configs/trajectories/table2.toml"));
    let again = again.display().to_string();
    let simulated = mavid(&["simulate", &model, "--trajectory", &trajectory, "--out", &again, "--json"]);
    assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
    let flew: Value = serde_json::from_slice(&simulated.stdout).unwrap();
    assert_eq!(flew["effects"], serde_json::json!(["steady_wind", "linear_drag"]));
    let validated = mavid(&["validate", &log, "--model", &vehicle, "--model", &model, "--json"]);
    assert!(validated.status.success(), "{}", String::from_utf8_lossy(&validated.stderr));
    let tables: Value = serde_json::from_slice(&validated.stdout).unwrap();
    let velocity = &tables["flights"][0]["tables"][4]["rows"][1];
    assert!(velocity["improvement_percent"][1].as_f64().unwrap() > 30.0, "{velocity}");
    // and starts the next identification: what it has is estimated anew, not added
    let anew = document(&[&log, "--vehicle", &model, "--with", "linear_drag"]);
    assert_found(effect(&anew, "linear_drag"), "dx", 0.6, 0.1);
    let page = mavid(&["identify", &log, "--vehicle", &vehicle, "--with", "linear_drag,steady_wind"]);
    let page = String::from_utf8(page.stdout).unwrap();
    for needle in ["linear_drag.dx", "steady_wind.north", "N/(m/s)", "without them", "kinematic_force_x"] {
        assert!(page.contains(needle), "{needle}:\n{page}");
    }
}

#[test]
fn what_explain_names_and_what_with_identifies_agree() {
    let folder = folder("agree");
    let vehicle = x500(&folder);
    let com = "[[effect]]\nid = \"com_offset\"\nx = 0.006\ny = -0.004\nz = 0.0\n";
    let log = flown(&folder, &vehicle, com);
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "com_offset"]);
    let found = effect(&said, "com_offset");
    assert_found(found, "x", 0.006, 0.1);
    assert_found(found, "y", -0.004, 0.1);
    assert!(parameter(found, "z")["reason"].as_str().unwrap().contains("nothing in this flight excites it"));
    let explained = mavid(&["explain", &log, "--vehicle", &vehicle, "--json"]);
    let explained: Value = serde_json::from_slice(&explained.stdout).unwrap();
    let named = explained["effects"].as_array().unwrap().iter().find(|e| e["id"] == "com_offset").unwrap();
    for name in ["x", "y"] {
        let (a, b) = (parameter(found, name), parameter(named, name));
        let off = (a["value"].as_f64().unwrap() - b["value"].as_f64().unwrap()).abs();
        let std = a["std"].as_f64().unwrap().hypot(b["std"].as_f64().unwrap());
        // explain holds a part of the flight back
        assert!(off < 3.0 * std, "{name}: {a} {b}");
    }
}

#[test]
fn what_is_found_by_trying_is_found() {
    let folder = folder("tried");
    let vehicle = x500(&folder);
    let both = "[[effect]]\nid = \"mass_change\"\ntime = 26.3\ndelta = -0.2\n\
                [[effect]]\nid = \"weak_rotor\"\nrotor = 2\nfactor = 0.94\n";
    let log = flown(&folder, &vehicle, both);
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "mass_change,weak_rotor"]);
    let (change, rotor) = (effect(&said, "mass_change"), effect(&said, "weak_rotor"));
    assert_found(change, "delta", -0.2, 0.2);
    assert!((parameter(change, "time")["value"].as_f64().unwrap() - 26.3).abs() < 0.3);
    assert_eq!(parameter(rotor, "rotor")["value"], 2.0);
    let factor = parameter(rotor, "factor")["value"].as_f64().unwrap();
    assert!((factor - 0.94).abs() < 0.012, "{factor}");
    assert!(rotor["tried"] == 4 && change["tried"].as_u64().unwrap() > 5);
}

#[test]
fn lag_and_delay_are_held_as_they_are_named() {
    let folder = folder("lag");
    let vehicle = x500(&folder);
    let log = flown(&folder, &vehicle, "[[effect]]\nid = \"motor_lag\"\ntime_constant = 0.05\n");
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "motor_lag"]);
    assert_found(effect(&said, "motor_lag"), "time_constant", 0.05, 0.1);
    assert_eq!(said["with"]["latency"]["named"], true);
    let late = "[[effect]]\nid = \"motor_lag\"\ntime_constant = 0.03\n[[effect]]\nid = \"transport_delay\"\ndelay = 0.016\n";
    let log = flown(&folder, &vehicle, late);
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "motor_lag,transport_delay"]);
    assert_found(effect(&said, "motor_lag"), "time_constant", 0.03, 0.2);
    assert_found(effect(&said, "transport_delay"), "delay", 0.016, 0.2);
}

#[test]
fn what_only_sensors_see_is_found() {
    let folder = folder("sensors");
    let vehicle = x500(&folder);
    for (id, x, y, z) in [("imu_offset", 0.04, -0.03, 0.02), ("imu_misalignment", 0.04, -0.03, 0.0)] {
        let concealed = format!("[[effect]]\nid = \"{id}\"\nx = {x:?}\ny = {y:?}\nz = {z:?}\n");
        let log = flown(&folder, &vehicle, &concealed);
        let said = document(&[&log, "--vehicle", &vehicle, "--with", id]);
        assert_found(effect(&said, id), "x", x, 0.2);
        assert_found(effect(&said, id), "y", y, 0.2);
    }
    let log =
        flown(&folder, &vehicle, "[[effect]]\nid = \"frame_misalignment\"\nx = 0.03\ny = -0.02\nz = 0.0\n");
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "frame_misalignment"]);
    let frame = effect(&said, "frame_misalignment");
    assert_found(frame, "x", 0.03, 0.2);
    assert_found(frame, "y", -0.02, 0.2);
    assert!(parameter(frame, "z")["reason"].as_str().unwrap().contains("heading"));
}

#[test]
fn a_flight_without_it_says_so() {
    let (log, vehicle) = (path("fixtures/p01_identify_0_25s.tlog"), path("fixtures/p01_vehicle.toml"));
    let plain = document(&[&log, "--vehicle", &vehicle]);
    assert!(plain.get("with").is_none());
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "com_offset,linear_drag,ground_effect"]);
    for id in ["com_offset", "linear_drag", "ground_effect"] {
        let found = effect(&said, id);
        assert!(found["z"].as_f64().unwrap() < 3.0 && found["significant"] == false, "{found}");
    }
    // the rest of the document is what it is without
    assert_eq!((&said["methods"], &said["best"]), (&plain["methods"], &plain["best"]));
    // what physics does not allow is held, and what the flight asks for is told
    let drag = effect(&said, "linear_drag")["parameters"].as_array().unwrap();
    for parameter in drag.iter().filter(|parameter| parameter["status"] == "at_bound") {
        assert!(parameter["wanted"].as_f64().unwrap() < 0.0 || parameter["name"] == "at_hubs", "{parameter}");
    }
    // a line never taut, a descent never steep
    let said = document(&[&log, "--vehicle", &vehicle, "--with", "vortex_ring,tether"]);
    assert_eq!(parameter(effect(&said, "vortex_ring"), "loss")["status"], "not_determined");
    assert_eq!(parameter(effect(&said, "tether"), "stiffness")["status"], "not_determined");
}

#[test]
fn a_weighed_mass_puts_forces_on_its_scale() {
    let folder = folder("weighed");
    let vehicle = x500(&folder);
    let log = flown(&folder, &vehicle, DRAG);
    // rotors a tenth stronger than they are, and a mass that was weighed
    let text = std::fs::read_to_string(&vehicle).unwrap();
    let stated: toml::Table = toml::from_str(&text).unwrap();
    let stated = stated["propulsion"]["thrust_coefficient"].as_float().unwrap();
    let line = text.lines().find(|line| line.starts_with("thrust_coefficient")).unwrap();
    let wrong = text
        .replace(line, &format!("thrust_coefficient = {:e}", 1.1 * stated))
        .replace("anchor = \"thrust\"", "anchor = \"mass\"");
    let wrong = if wrong.contains("anchor = \"mass\"") {
        wrong
    } else {
        format!("{wrong}\n[identify]\nanchor = \"mass\"\n")
    };
    let weighed = folder.join("weighed.toml");
    std::fs::write(&weighed, &wrong).unwrap();
    let said = document(&[&log, "--vehicle", &weighed.display().to_string(), "--with", "linear_drag"]);
    assert_found(effect(&said, "linear_drag"), "dx", 0.6, 0.1);
    let found = said["with"]["thrust"]["value"].as_f64().unwrap();
    assert!((found / stated - 1.0).abs() < 0.01, "{found}");
    assert_eq!(said["with"]["parameters"]["mass"]["status"], "given");

    // what the file knows of the drag is on the scale of the weighed mass, too
    let known = folder.join("known.toml");
    std::fs::write(&known, format!("{wrong}\n{DRAG}")).unwrap();
    let known = document(&[&log, "--vehicle", &known.display().to_string(), "--with", "com_offset"]);
    for channel in ["force_x", "force_y"] {
        let left = |document: &Value| document["with"]["misfit"][channel]["with"].as_f64().unwrap();
        assert!(left(&known) < 1.02 * left(&said), "{channel}: {} {} N", left(&known), left(&said));
    }
}

#[test]
fn wrong_sets_are_refused_with_what_was_expected() {
    let (log, vehicle) = (path("fixtures/p01_identify_0_25s.tlog"), path("fixtures/p01_vehicle.toml"));
    let with = |names: &str| refusal(&[&log, "--vehicle", &vehicle, "--with", names]);
    let unknown = with("linear_drag,gravity_waves");
    assert!(unknown.contains("no effect `gravity_waves`") && unknown.contains("mass_change"), "{unknown}");
    assert!(with("com_offset,com_offset").contains("com_offset is named twice"));
    assert!(with("linear_drag,").contains("no effect ``"));
    assert!(with("gust").contains("gust cannot be identified as parameters: a gust is one random course"));
    assert!(with("inertia_products").contains("in any case"));
    let wind = with("steady_wind");
    assert!(wind.contains("forces of the air") && wind.contains("linear_drag"), "{wind}");
    assert!(with("com_offset,steady_wind").contains("got none of them"));
    for filter in [&["--cutoff", "5"][..], &["--fir"], &["--sigma", "3"]] {
        let both = [&[log.as_str(), "--vehicle", &vehicle, "--with", "linear_drag"], filter].concat();
        assert!(refusal(&both).contains("expected them without --with"), "{filter:?}");
    }
    let p04 = path("fixtures/p04_identify_10_22s.tlog");
    let two = refusal(&[&log, &p04, "--vehicle", &vehicle, "--with", "mass_change"]);
    assert!(two.contains("expected one recording, got 2"), "{two}");
}

/// A recording of the first fixture without some of its quantities.
fn without(folder: &Path, gone: &[mavid::recording::Quantity]) -> String {
    let loaded = mavid::log::open(
        Path::new(&path("fixtures/p01_identify_0_25s.tlog")),
        &mavid::log::OpenOptions::default(),
    )
    .unwrap();
    let mut recording = loaded.recording;
    let written = [
        "ATTITUDE_QUATERNION",
        "HIGHRES_IMU",
        "ACTUATOR_OUTPUT_STATUS",
        "LOCAL_POSITION_NED",
        "BATTERY_STATUS",
    ];
    recording.streams.retain(|key, _| written.contains(&key.source) && !gone.contains(&key.quantity));
    let log = folder.join("less.tlog");
    let file = std::fs::File::create(&log).unwrap();
    mavid::wire::write_recording(&recording, file, support::START_US).unwrap();
    log.display().to_string()
}

#[test]
fn streams_that_an_effect_needs_are_named_where_they_are_missing() {
    use mavid::recording::Quantity as Q;
    let (folder, vehicle) = (folder("less"), path("fixtures/p01_vehicle.toml"));
    let said = |gone: &[Q], names: &str| {
        let log = without(&folder, gone);
        refusal(&[&log, "--vehicle", &vehicle, "--with", names])
    };
    let sag = said(&[Q::BatteryVoltage], "battery_sag");
    assert!(sag.contains("battery_sag needs battery voltage") && sag.contains("BATTERY_STATUS"), "{sag}");
    let none = said(&[Q::ActuatorCommand, Q::RotorSpeed], "linear_drag");
    assert!(none.contains("no actuator outputs for 4 rotors"), "{none}");
    let lag = said(&[Q::ActuatorCommand], "motor_lag");
    assert!(lag.contains("no actuator outputs") || lag.contains("needs actuator commands"), "{lag}");
    let imu = said(&[Q::SpecificForce], "imu_offset");
    assert!(imu.contains("imu_offset needs accelerometer"), "{imu}");
    let ground = said(&[Q::Position], "ground_effect");
    assert!(ground.contains("ground_effect needs position and attitude"), "{ground}");
    let drag = said(&[Q::Velocity], "linear_drag");
    assert!(drag.contains("linear_drag needs velocity and attitude"), "{drag}");
    let rates = said(&[Q::AngularRate], "com_offset");
    assert!(rates.contains("body rates are not recorded"), "{rates}");
}
