//! `mavid explain` and `mavid export` at their process boundary.

use crate::support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use support::schema::differences;
use support::shared_case;

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn fixture(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name).display().to_string()
}

fn temporary(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("explain_command-{name}"))
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn a_complete_rigid_body_has_nothing_missing_and_says_what_it_would_have_seen() {
    let out = temporary("explain-p01");
    let (log, vehicle) = (fixture("p01_identify_0_25s.tlog"), fixture("p01_vehicle.toml"));
    // no flight is designed where nothing is to be told apart: one of an earlier run must not pass for it
    let next = temporary("explain-p01-next.toml");
    std::fs::write(&next, "of an earlier run").unwrap();
    let to = ["--out", out.to_str().unwrap(), "--next", next.to_str().unwrap(), "--json"];
    let output = mavid(&[&["explain", log.as_str(), "--vehicle", &vehicle][..], &to].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("--next: nothing written: ") && !next.exists(), "{}", stderr(&output));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let schema: Value = serde_json::from_slice(&mavid(&["schema", "explain"]).stdout).unwrap();
    assert_eq!(differences(&document, &schema), Vec::<String>::new());
    assert_eq!(document["schema"], 1);
    assert_eq!(document["verdict"], "nothing_missing");
    assert_eq!(document["effects"].as_array().unwrap().len(), 0);
    assert!(document["answer"].as_str().unwrap().starts_with("Nothing is missing"));
    let limits = document["detection_limits"].as_array().unwrap();
    let drag = limits.iter().find(|limit| limit["id"] == "linear_drag").unwrap();
    assert!((0.001..0.1).contains(&drag["limit"].as_f64().unwrap()), "{drag}");
    let mass = &document["parameters"]["mass"];
    assert!((mass["value"].as_f64().unwrap() / 2.06 - 1.0).abs() < 0.01 && mass["unit"] == "kg");
    for key in ["axes", "time_s", "state", "band_hz"] {
        assert!(document["localisation"].get(key).is_some(), "{key}");
    }
    assert!(document["fit"]["identify"]["before"]["velocity_m_s"].as_f64().unwrap() > 0.0);
    // all that the report's tables show
    for on in ["identify", "holdout"] {
        let windows = document["fit"][on]["open_loop"].as_array().unwrap();
        let lengths: Vec<f64> = windows.iter().map(|of| of["window_s"].as_f64().unwrap()).collect();
        assert_eq!(lengths, [0.1, 0.5, 1.0]);
        let error = &windows[1]["errors"]["velocity"];
        assert_eq!(error["before"], document["fit"][on]["before"]["velocity_m_s"]);
        assert!(error["floor"].as_f64().unwrap() > 0.0 && error["unit"] == "m/s", "{error}");
    }
    let holdout = &document["fit"]["holdout"];
    let force = &holdout["weak_residual"]["force_z"];
    assert!(force["after"].as_f64().unwrap() > 0.0 && force["unit"] == "N", "{force}");
    assert!(holdout["no_closed_loop"].as_str().unwrap().contains("is not simulated"));
    assert!(holdout["own_parameters"]["mass"]["own"].as_f64().unwrap() > 1.9);
    assert_eq!(document["too_little_excitation"], false);
    // the model goes where a vehicle goes
    let model = out.join("model.toml");
    let checked = mavid(&["vehicle", model.to_str().unwrap(), "--json"]);
    assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
    whole_report(&out.join("report.html"));
    // the summary beside it is what `--format md` prints
    let summary = std::fs::read_to_string(out.join("report.md")).unwrap();
    assert!(summary.starts_with("**") && summary.contains("`mavid explain --format md`"), "{summary}");
    // and what `mavid report` prints of the folder
    let place = out.to_str().unwrap();
    let report = |more: &[&str]| {
        let output = mavid(&[&["report", place][..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(report(&[]), summary);
    assert_eq!(report(&["--json"]), report(&["--format", "json"]));
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert_eq!(report(&["--format", "html"]).trim_end(), page.trim_end());
    let text = std::fs::read_to_string(out.join("report.txt")).unwrap();
    assert_eq!(report(&["--format", "text"]).trim_end(), text.trim_end());
}

/// One file, closed, with nothing loaded from anywhere.
fn whole_report(path: &Path) {
    let report = std::fs::read_to_string(path).unwrap();
    assert!(report.len() < 1_000_000, "{} bytes", report.len());
    // its scripts stand in it and load nothing
    let mut rest = String::new();
    for (index, part) in report.split("<script").enumerate() {
        let (script, after) = if index > 0 { part.split_once("</script>").unwrap() } else { ("", part) };
        for word in ["fetch(", "XMLHttpRequest", "import(", ".src", "WebSocket", "sendBeacon"] {
            assert!(!script.contains(word), "{word}");
        }
        rest.push_str(after);
    }
    let report = rest;
    for word in ["http:", "https:", "<script", "src=", "@import", "url(", "NaN"] {
        assert!(!report.contains(word), "{word}");
    }
    let mut open: Vec<&str> = Vec::new();
    for tag in report.split('<').skip(1).filter_map(|part| part.split('>').next()) {
        let name = tag.split([' ', '/']).find(|part| !part.is_empty()).unwrap_or_default();
        if tag.starts_with('!') || tag.ends_with('/') || name == "meta" {
            continue;
        }
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn bad_input_is_refused_with_what_was_expected_and_what_came() {
    let (log, vehicle) = (fixture("p01_identify_0_25s.tlog"), fixture("p01_vehicle.toml"));
    let idle = temporary("explain-idle.csv");
    std::fs::write(&idle, motion_without_actuators()).unwrap();
    let folder = temporary("explain-read");
    std::fs::create_dir_all(&folder).unwrap();
    let read = folder.join("model.toml");
    std::fs::write(&read, "read").unwrap();
    let part = temporary("explain-part.tlog");
    let whole = std::fs::read(&log).unwrap();
    std::fs::write(&part, &whole[..2 * whole.len() / 3]).unwrap();
    for (arguments, words) in [
        (vec![log.as_str(), "--holdout", &log], "same recording"),
        (
            vec![log.as_str(), "--holdout", part.to_str().unwrap()],
            "expected a flight that is not explained, but 100 % of",
        ),
        (vec![log.as_str(), "--transient", "-1"], "--transient: expected seconds from 0 on, got -1"),
        (vec![log.as_str(), "--csv-map", "map.toml"], "expected a .csv among the logs"),
        (
            vec![idle.to_str().unwrap(), "--system-id", "7"],
            "--system-id: expected a telemetry log (.tlog) among the logs, got none",
        ),
        (vec![log.as_str(), "--transient", "1e9"], "(--transient) leaves too little: expected at most"),
        (vec![log.as_str(), "--out", &log], "expected a folder"),
        (
            vec![log.as_str(), "--holdout", read.to_str().unwrap(), "--out", folder.to_str().unwrap()],
            "model.toml is an input",
        ),
        (vec!["no-such.tlog"], "no-such.tlog"),
        (vec![idle.to_str().unwrap()], "no actuator outputs for 4 rotors"),
    ] {
        let mut all = vec!["explain"];
        all.extend(&arguments);
        all.extend(["--vehicle", vehicle.as_str(), "--json"]);
        let output = mavid(&all);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let message = document["error"]["message"].as_str().unwrap();
        assert!(message.contains(words), "{arguments:?}: {message}");
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
}

/// Twenty seconds of rates and acceleration and nothing else.
fn motion_without_actuators() -> String {
    let mut text = "time_s,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s,specific_force_x_m_s2,specific_force_y_m_s2,specific_force_z_m_s2\n".to_owned();
    for index in 0..2000_u32 {
        let t = f64::from(index) * 0.01;
        text.push_str(&format!("{t},{},{},0.1,0.0,0.1,9.81\n", t.sin(), t.cos()));
    }
    text
}

/// The document of an explanation that is done.
fn explained(log: &Path, vehicle: &Path, holdout: &Path, further: &[&str]) -> Value {
    let [log, vehicle, holdout] = [log, vehicle, holdout].map(|path| path.to_str().unwrap());
    let common = ["explain", log, "--vehicle", vehicle, "--holdout", holdout, "--json"];
    let output = mavid(&[&common[..], further].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn drag_is_named_shown_on_the_hold_out_and_carried_into_every_command() {
    let Some(folder) = shared_case("p02-linear-drag") else { return };
    let out = temporary("explain-p02");
    let [log, holdout, vehicle] =
        ["identify.tlog", "holdout.tlog", "vehicle.toml"].map(|name| folder.join(name));
    let document = explained(&log, &vehicle, &holdout, &["--out", out.to_str().unwrap()]);
    assert_eq!(document["verdict"], "explained");
    assert_eq!(document["effects"][0]["id"], "linear_drag");
    let answer = document["answer"].as_str().unwrap();
    assert!(
        answer.starts_with("Drag was left out: 0.1") && answer.contains("on the hold-out falls by"),
        "{answer}"
    );
    assert!(document["fit"]["holdout"]["improvement_percent"].as_f64().unwrap() > 20.0);
    // drag acts along both
    let axis = document["localisation"]["axes"][0]["axis"].as_str().unwrap();
    assert!(["force_x", "force_y"].contains(&axis), "{axis}");
    whole_report(&out.join("report.html"));
    let model = out.join("model.toml");
    let model = model.to_str().unwrap();
    // its own model explains the flight: nothing more is missing
    let [holdout, vehicle] = [&holdout, &vehicle].map(|path| path.to_str().unwrap());
    let again = mavid(&["validate", holdout, "--model", vehicle, "--model", model, "--json"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    for to in ["px4-sih", "ardupilot-sitl", "sdf", "mjcf", "rotorpy"] {
        let exported = mavid(&["export", model, "--to", to, "--json"]);
        assert_eq!(exported.status.code(), Some(0), "{to}: {}", stderr(&exported));
        let document: Value = serde_json::from_slice(&exported.stdout).unwrap();
        assert!(document["text"].as_str().unwrap().len() > 200);
    }
}

#[test]
fn a_hold_out_of_another_vehicle_is_found_out_and_said() {
    let (Some(folder), Some(other)) = (shared_case("p02-linear-drag"), shared_case("p04-motor-lag")) else {
        return;
    };
    let out = temporary("explain-other");
    let (log, vehicle) = (folder.join("identify.tlog"), folder.join("vehicle.toml"));
    let out = ["--out", out.to_str().unwrap()];
    let document = explained(&log, &vehicle, &other.join("holdout.tlog"), &out);
    let warnings = document["warnings"].as_array().unwrap();
    let said = warnings.iter().any(|warning| {
        warning
            .as_str()
            .unwrap()
            .starts_with("the hold-out is not of the vehicle that was identified: mass 2.5")
    });
    assert!(said, "{warnings:?}");
    let answer = document["answer"].as_str().unwrap();
    assert!(
        answer.contains("the hold-out is of another vehicle, or something of this one changed (mass 2.5")
            && !answer.contains("falls"),
        "{answer}"
    );
    assert!(document["fit"]["holdout"]["improvement_percent"].is_null());
    assert!(document["fit"]["holdout"]["other_vehicle"].is_string());
}

/// It cannot be played back without an attitude, and is found out by its residuals all the same.
#[test]
fn a_hold_out_of_another_vehicle_without_attitude_is_found_out() {
    let Some(folder) = shared_case("p02-linear-drag") else { return };
    let other = folder.join("../../recordings/crazyflie_1khz/log15.csv");
    let (log, vehicle) = (folder.join("identify.tlog"), folder.join("vehicle.toml"));
    let document = explained(&log, &vehicle, &other, &[]);
    let answer = document["answer"].as_str().unwrap();
    assert!(answer.contains("the hold-out is of another vehicle"), "{answer}");
}

#[test]
fn identify_and_validate_write_reports_of_one_file() {
    let folder = temporary("reports");
    std::fs::create_dir_all(&folder).unwrap();
    let (log, vehicle) = (fixture("p01_identify_0_25s.tlog"), fixture("p01_vehicle.toml"));
    let model = folder.join("model.toml");
    let model = model.to_str().unwrap();
    let identified = mavid(&["identify", &log, "--vehicle", &vehicle, "--out", model]);
    assert_eq!(identified.status.code(), Some(0), "{}", stderr(&identified));
    let report = folder.join("model.html");
    whole_report(&report);
    let text = std::fs::read_to_string(&report).unwrap();
    assert!(
        text.contains("good for all of mass and inertia: mass <span class=\"one\">2.06"),
        "{}",
        &text[..2000]
    );
    for part in ["Data quality", "Provenance", "SHA-256", "<svg", "Correlation"] {
        assert!(text.contains(part), "{part}");
    }
    let elsewhere = folder.join("elsewhere.html");
    let place = elsewhere.to_str().unwrap();
    let with = ["--with", "linear_drag", "--report", place];
    let arguments = [&["identify", log.as_str(), "--vehicle", vehicle.as_str()][..], &with[..]].concat();
    let identified = mavid(&arguments);
    assert_eq!(identified.status.code(), Some(0), "{}", stderr(&identified));
    whole_report(&elsewhere);
    let out = folder.join("validated");
    let (nominal, place) = (vehicle.as_str(), out.to_str().unwrap());
    let validated = mavid(&["validate", &log, "--model", nominal, "--model", model, "--out", place]);
    assert_eq!(validated.status.code(), Some(0), "{}", stderr(&validated));
    whole_report(&out.join("report.html"));
    let text = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        text.contains("model predicts better than p01_vehicle: its 0.5\u{a0}s errors are"),
        "{}",
        &text[..2500]
    );
}

/// A hover is predicted by the flight that moves, and says nothing against it; it cannot predict that flight.
#[test]
fn a_hover_beside_a_flight_that_moves_raises_no_doubt() {
    let Some(shared) = support::shared() else { return };
    let sitl = shared.join("onboard/sitl");
    let path = |name: &str| sitl.join(name).display().to_string();
    for kind in ["tlog", "bin"] {
        let [moving, hover] = ["ap07", "ap08"].map(|flight| path(&format!("{flight}.{kind}")));
        let vehicle = path("ardupilot-quad-c.toml");
        let output = mavid(&["explain", &moving, &hover, "--vehicle", &vehicle, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let said = document.to_string();
        for doubt in ["not of the vehicle", "differ by more than flights of one vehicle", "two vehicles"] {
            assert!(!said.contains(doubt), "{kind}: {doubt}");
        }
        assert!(said.contains("so the others do not predict this flight"), "{kind}");
        let effects = document["effects"].as_array().unwrap();
        let drag = effects.iter().find(|effect| effect["id"] == "linear_drag").unwrap();
        let along = drag["parameters"].as_array().unwrap();
        let dx = along.iter().find(|of| of["name"] == "dx").unwrap();
        assert!((dx["value"].as_f64().unwrap() / 0.297 - 1.0).abs() < 0.05, "{kind}: {dx}");
    }
}

/// The thrust of this small vehicle drifts while it climbs, and no line leads down from it. A baseline predicts what was held back better
/// than the model with a line.
#[test]
fn a_thrust_that_drifts_with_the_height_is_no_line_to_the_ground() {
    let Some(shared) = support::shared() else { return };
    let log = shared.join("onboard/logs/copter_368_indoor_quad.bin").display().to_string();
    let output = mavid(&["explain", &log, "--mass", "1.0", "--size", "0.45", "--json"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let effects = document["effects"].as_array().unwrap();
    assert!(effects.is_empty(), "{effects:?}");
    let said = document["warnings"].to_string();
    assert!(said.contains("a name to a tether") && said.contains("so it gets none"), "{said}");
    assert!(document["answer"].as_str().unwrap().contains("do not confirm it"), "{}", document["answer"]);
}

/// The squares change the thrust of this drone four times as much as its random flight, and leave as much more of it. It is the same drone.
#[test]
fn a_livelier_flight_of_one_drone_is_not_of_another_one() {
    let Some(shared) = support::shared() else { return };
    let path = |name: &str| shared.join("recordings/nanodrone").join(name).display().to_string();
    let [log, vehicle, squares] = ["random1_run1.csv", "vehicle.toml", "square_run3.csv"].map(path);
    let output = mavid(&["explain", &log, "--vehicle", &vehicle, "--holdout", &squares, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let answer = document["answer"].as_str().unwrap();
    assert!(!answer.contains("another vehicle") && answer.contains("on the hold-out falls by"), "{answer}");
}

/// A hold-out of another vehicle tests nothing, so a short flight has the names that it has without one.
#[test]
fn a_short_flight_with_a_hold_out_of_another_vehicle_is_judged_as_a_short_flight() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    let path = |name: &str| folder.join(name).display().to_string();
    let part = temporary("short-foreign.tlog");
    std::fs::write(&part, beginning(&folder.join("ap02.tlog"), 62.0)).unwrap();
    let explained = |further: &[&str]| -> Value {
        let vehicle = path("ardupilot-quad-a.toml");
        let common = ["explain", part.to_str().unwrap(), "--vehicle", &vehicle, "--json"];
        let output = mavid(&[&common, further].concat());
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let names = |of: &Value| -> Vec<String> {
        let effects = of["effects"].as_array().unwrap().iter();
        effects.map(|effect| effect["id"].as_str().unwrap().to_owned()).collect()
    };
    let alone = explained(&[]);
    let foreign = explained(&["--holdout", &path("ap07.tlog")]);
    assert!(foreign["fit"]["holdout"]["other_vehicle"].is_string());
    assert_eq!(names(&foreign), names(&alone));
    for answer in [&foreign, &alone] {
        assert!(answer["answer"].to_string().contains("but not surely enough"), "{}", answer["answer"]);
    }
    assert!(foreign["doubts"].to_string().contains("the flight is short"), "{}", foreign["doubts"]);
}

/// The beginning of a log, up to so many seconds after its first frame.
fn beginning(log: &Path, seconds: f64) -> Vec<u8> {
    let bytes = std::fs::read(log).unwrap();
    let stamp = |at: usize| u64::from_be_bytes(bytes[at..at + 8].try_into().unwrap()) as f64 / 1e6;
    let (first, mut at) = (stamp(0), 0);
    while at + 10 < bytes.len() && stamp(at) - first <= seconds {
        let (length, signed) = (usize::from(bytes[at + 9]), bytes[at + 10] & 1 == 1);
        at += 8 + match bytes[at + 8] {
            0xFD => 12 + length + if signed { 13 } else { 0 },
            _ => 8 + length,
        };
    }
    bytes[..at.min(bytes.len())].to_vec()
}

#[test]
fn a_short_flight_is_said_to_be_short_first_and_the_whole_one_is_not() {
    let whole = PathBuf::from(fixture("p01_identify_0_25s.tlog"));
    let explained = |log: &Path| -> Value {
        let arguments =
            ["explain", log.to_str().unwrap(), "--vehicle", &fixture("p01_vehicle.toml"), "--json"];
        serde_json::from_slice(&mavid(&arguments).stdout).unwrap()
    };
    let all = explained(&whole);
    assert!(!all["answer"].as_str().unwrap().contains("short"), "{}", all["answer"]);
    let part = temporary("short.tlog");
    std::fs::write(&part, beginning(&whole, 15.0)).unwrap();
    let short = explained(&part);
    let answer = short["answer"].as_str().unwrap();
    assert!(answer.starts_with("Doubtful: the flight is short ("), "{answer}");
    assert_eq!(short["effects"].as_array().unwrap().len(), 0, "{answer}");
}
