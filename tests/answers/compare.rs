//! `mavid compare`: a rotor that became weak between simulated flights, real propellers that were cut, and outputs that left the mixer.

use crate::support;
use crate::support::schema::differences;

use mavid::config::load_vehicle;
use mavid::diagnose::{ExplainSettings, each_with_model_of_all, explain};
use mavid::inspect::inspect;
use mavid::log::{self, OpenOptions};
use mavid::signals::{ConditionSettings, condition};
use mavid::study::{Changed, CompareRequest, CompareStudy, Silent, StudyError, VehicleGiven, compare};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

pub(super) fn config(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).display().to_string()
}

/// A fresh folder for one test.
pub(super) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("compare-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

const WEAK: &str = "[[effect]]\nid = \"weak_rotor\"\nrotor = 2\nfactor = 0.95\n";

#[test]
fn a_rotor_that_became_weak_is_found_and_an_unchanged_vehicle_is_not_called_changed() {
    let folder = folder("compare");
    let place = |name: &str| folder.join(name).display().to_string();
    std::fs::write(place("weak.toml"), WEAK).unwrap();
    let (vehicle, trajectory) = (config("x500.toml"), config("trajectories/table2.toml"));
    let flight = |name: &str, seed: &str, more: &[&str]| {
        let log = place(name);
        let common = ["simulate", &vehicle, "--trajectory", &trajectory, "--seed", seed, "--out", &log];
        let simulated = mavid(&[&common[..], more].concat());
        assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
        log
    };
    let first = flight("first.tlog", "1", &[]);
    let second = flight("second.tlog", "2", &[]);
    let weak = flight("weak.tlog", "3", &["--effects", &place("weak.toml")]);
    let out = place("out");

    let changed = mavid(&[
        "compare",
        &first,
        &second,
        "--with",
        &weak,
        "--balance-only",
        "--vehicle",
        &vehicle,
        "--out",
        &out,
        "--json",
    ]);
    assert_eq!(changed.status.code(), Some(4), "{}", String::from_utf8_lossy(&changed.stderr));
    let said: Value = serde_json::from_slice(&changed.stdout).unwrap();
    assert_eq!((&said["schema"], &said["verdict"]), (&1.into(), &"changed".into()));
    let change = &said["changes"][0];
    assert_eq!(
        (&change["what"], &change["rotor"], &change["carried_by"]),
        (&"rotor".into(), &2.into(), &serde_json::json!([2]))
    );
    let (after, std) = (change["after"]["value"].as_f64().unwrap(), change["by"]["std"].as_f64().unwrap());
    assert!((after - 0.95).abs() < 2.0 * std && std < 0.01, "{after} +- {std}");
    // one value has one error
    assert_eq!(
        (&change["after"]["std"], &change["before"]),
        (&std.into(), &serde_json::json!({ "value": 1.0, "std": 0.0 }))
    );
    let schema = mavid(&["schema", "compare"]);
    let schema: Value = serde_json::from_slice(&schema.stdout).unwrap();
    assert_eq!(differences(&said, &schema), Vec::<String>::new());
    // the same along the row
    assert_eq!(said["history"][0]["from"], 2);
    let report = std::fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert_eq!((&change["of"], &change["motor"]), (&"front_left".into(), &3.into()));
    assert!(report.contains("<svg") && report.contains("motor 3 (front left)"));
    let stored: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("out/comparison.json")).unwrap()).unwrap();
    assert_eq!(stored, said);
    let summary = mavid(&["report", &place("out")]);
    let summary = String::from_utf8_lossy(&summary.stdout).into_owned();
    assert!(
        summary.starts_with("**Motor 3 (front left)") && summary.contains("| what | before |"),
        "{summary}"
    );
    assert!(!summary.contains(&place("")), "no folder: {summary}");

    let same =
        mavid(&["compare", &first, "--with", &second, "--balance-only", "--vehicle", &vehicle, "--json"]);
    assert_eq!(same.status.code(), Some(0), "{}", String::from_utf8_lossy(&same.stderr));
    let said: Value = serde_json::from_slice(&same.stdout).unwrap();
    assert_eq!((&said["verdict"], &said["changes"]), (&"nothing_changed".into(), &serde_json::json!([])));
    assert_eq!(differences(&said, &schema), Vec::<String>::new());
    // and a document that is otherwise is seen
    let mut wrong = said.clone();
    wrong["verdict"] = "perhaps".into();
    wrong["flights"][0]["legs"] = (-1).into();
    wrong["more"] = 1.into();
    assert_eq!(differences(&wrong, &schema).len(), 3, "{:?}", differences(&wrong, &schema));
    // a battery that sits elsewhere is told, and is no change
    std::fs::write(place("load.toml"), "[[effect]]\nid = \"com_offset\"\nx = 0.005\ny = 0.0\nz = 0.0\n")
        .unwrap();
    let load = flight("load.tlog", "4", &["--effects", &place("load.toml")]);
    let told = mavid(&["compare", &first, &second, "--with", &load, "--balance-only", "--vehicle", &vehicle]);
    assert_eq!(told.status.code(), Some(0), "{}", String::from_utf8_lossy(&told.stderr));
    let told = String::from_utf8_lossy(&told.stdout).into_owned();
    assert!(told.starts_with("Nothing changed") && told.contains("Its balance differs by 0.0"), "{told}");
    // and what would have shown is told
    let least = said["smallest_changes"].as_array().unwrap();
    assert!(
        least.len() == 6 && least.iter().all(|least| least["size"].as_f64().unwrap() < 0.05),
        "{least:?}"
    );
}

/// A flight of the x500 along Table 2 with another mass or drag.
pub(super) fn simulated(folder: &Path, name: &str, (mass_kg, drag): (f64, f64), seed: u32) -> String {
    let place = |name: String| folder.join(name).display().to_string();
    let (vehicle, effects, log) = (
        place(format!("{name}.toml")),
        place(format!("{name}-effects.toml")),
        place(format!("{name}-{seed}.tlog")),
    );
    let nominal = std::fs::read_to_string(config("x500.toml")).unwrap();
    std::fs::write(&vehicle, nominal.replacen("mass = 2.0643", &format!("mass = {mass_kg}"), 1)).unwrap();
    let of_drag = format!("[[effect]]\nid = \"linear_drag\"\ndx = {drag}\ndy = {drag}\ndz = {drag}\n");
    std::fs::write(&effects, of_drag).unwrap();
    let (trajectory, seed) = (config("trajectories/table2.toml"), seed.to_string());
    let simulated = mavid(&[
        "simulate",
        &vehicle,
        "--trajectory",
        &trajectory,
        "--effects",
        &effects,
        "--seed",
        &seed,
        "--out",
        &log,
    ]);
    assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
    log
}

/// "Nothing changed" says nothing of two vehicles.
#[test]
fn flights_that_may_be_of_two_vehicles_have_an_exit_status_of_their_own() {
    let folder = folder("two-vehicles");
    let heavy = simulated(&folder, "heavy", (2.0643, 0.3), 1);
    let light = simulated(&folder, "light", (1.4, 0.3), 2);
    let told =
        mavid(&["compare", &heavy, "--with", &light, "--balance-only", "--vehicle", &config("x500.toml")]);
    let text = String::from_utf8_lossy(&told.stdout).into_owned();
    assert!(text.contains("It is doubtful that this is one vehicle"), "{text}");
    assert_eq!(told.status.code(), Some(3), "{text}");
    // also between others of a history, where it is named
    let again = simulated(&folder, "heavy", (2.0643, 0.3), 3);
    let row =
        mavid(&["compare", &heavy, &light, &again, "--balance-only", "--vehicle", &config("x500.toml")]);
    let text = String::from_utf8_lossy(&row.stdout).into_owned();
    assert!(text.contains(" in light-2.tlog and ") && text.contains(" in the other flights"), "{text}");
    assert_eq!(row.status.code(), Some(3), "{text}");
}

/// A change of drag needs several flights, because it differs between flights of one vehicle: what does not suffice is told.
#[test]
fn a_drag_that_moved_along_a_history_is_told_before_it_is_certain() {
    let folder = folder("drag-along");
    let mut flights: Vec<String> =
        (1..4).map(|seed| simulated(&folder, "slow", (2.0643, 0.3), seed)).collect();
    flights.extend((4..6).map(|seed| simulated(&folder, "fast", (2.0643, 0.41), seed)));
    let request = CompareRequest {
        before: flights.iter().map(PathBuf::from).collect(),
        vehicle: Some(VehicleGiven::File(config("x500.toml").into())),
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    let study = compare(&request, &Silent).unwrap();
    assert!(study.history.is_empty() && !study.has_changed());
    let along = study.undecided_along.as_ref().unwrap();
    assert!(along.from == 3 && along.moved[0].sigmas < along.least_sigmas, "{along:?}");
    let told = mavid::report::comparison_text(&study);
    assert!(
        told.contains("Not decided: from ") && told.contains("make a change at one of the places"),
        "{told}"
    );
}

#[test]
fn logs_of_different_autopilots_are_not_of_one_vehicle() {
    let refused =
        mavid(&["compare", "fixtures/px4_flight.ulg", "--with", "fixtures/ap_baseline_70_79s.tlog"]);
    assert_eq!(refused.status.code(), Some(2));
    let why = String::from_utf8_lossy(&refused.stderr);
    assert!(why.contains("ap_baseline_70_79s.tlog: expected flights of one vehicle, got a log of"), "{why}");
}

#[test]
fn a_vehicle_file_with_another_number_of_rotors_is_refused() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let folder = folder("six");
    let six = folder.join("six.toml");
    // the frame of the file, with two rotors more
    let four = std::fs::read_to_string(fixtures.join("px4-sih.toml")).unwrap();
    let more = "\n[[rotor]]\nname = \"left\"\nposition = [0.0, 0.3, 0.0]\nspin = \"cw\"\n";
    let other = more.replace("left", "right").replace("0.3", "-0.3").replace("\"cw", "\"ccw");
    std::fs::write(&six, format!("{four}{more}{other}")).unwrap();
    let six = six.display().to_string();
    let [log, other] =
        ["px4_flight.ulg", "px4_baseline_40_46s.tlog"].map(|name| fixtures.join(name).display().to_string());
    for arguments in [
        vec!["identify", &log],
        vec!["explain", &log],
        vec!["validate", &log],
        vec!["compare", &log, "--with", &other],
        vec!["inspect", &log],
    ] {
        let which = if arguments[0] == "validate" { "--model" } else { "--vehicle" };
        let refused = mavid(&[&arguments[..], &[which, &six]].concat());
        let why = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {why}");
        assert!(why.contains("expected the log of a vehicle with 6 rotors"), "{arguments:?}: {why}");
        assert!(why.contains("give the file of the vehicle that flew"), "{arguments:?}: {why}");
    }
}

#[test]
fn one_flight_is_nothing_to_compare() {
    let refused = mavid(&["compare", "alone.bin"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("expected at least two flights, got one log"));
}

#[test]
fn two_logs_of_one_flight_are_nothing_to_compare() {
    let Some(shared) = support::shared() else { return };
    let [by_vehicle, by_link] =
        ["px04.ulg", "px04.tlog"].map(|name| shared.join("onboard/sitl").join(name).display().to_string());
    let refused = mavid(&["compare", &by_vehicle, &by_link]);
    assert_eq!(refused.status.code(), Some(2));
    let why = String::from_utf8_lossy(&refused.stderr);
    assert!(why.contains("expected at least two flights, but") && why.contains("the same flight"), "{why}");
}

#[test]
fn a_named_latency_is_told_flight_by_flight() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml")).unwrap();
    let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default()).unwrap();
    let flight = condition(&log.recording, &vehicle, &ConditionSettings::default()).unwrap();
    let (flights, settings) = ([flight.clone(), flight], ExplainSettings::default());
    let found = explain(&flights, &vehicle, &settings).unwrap();
    let [lag] = found.named.as_slice() else { panic!("{:?}", found.named) };
    for alone in each_with_model_of_all(&flights, (&[false; 2], &[]), &found, (&vehicle, &settings)) {
        let latency = alone.iter().find(|of| of.effect == Some(lag.id)).unwrap();
        let (value, std) = latency.estimate;
        // without the delay that the log itself has, which is below the period of its commands
        let log_s = found.search.latency.total_s - value;
        assert!((0.0..0.02).contains(&log_s) && std < 0.01, "{log_s} s, {latency:?}");
        // beyond what every vehicle has
        assert!(latency.name == "latency" && value - latency.nothing > 3.0 * std, "{latency:?}");
    }
}

/// Flights of a folder compared, the first `before` of them with the last, without mass and lengths.
fn compared(folder: &Path, before: &[&str], after: &str) -> CompareStudy {
    let place = |name: &&str| folder.join(format!("flight_{name}.BIN"));
    let request = CompareRequest {
        before: before.iter().map(place).collect(),
        after: vec![place(&after)],
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    compare(&request, &Silent).unwrap()
}

#[test]
fn cut_propellers_are_found_from_20_mm_on_and_smaller_cuts_get_no_name() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/propeller_cut");
    let whole = ["09", "04", "02"];
    // the arming of 12 and 03 is lost in a gap of their logs
    for (flight, mm) in [("15", 20), ("12", 20), ("03", 20), ("06", 25), ("08", 25), ("10", 25)] {
        let study = compared(&folder, &whole, flight);
        let changes = &study.compared.as_ref().unwrap().changes;
        assert_eq!(changes.len(), 1, "{mm} mm: {changes:?}");
        assert_eq!(changes[0].what, Changed::Rotor(0), "{mm} mm");
        assert!(changes[0].rivals.is_empty() && changes[0].moved.unwrap().after.0 < 0.9);
    }
    for flight in ["13", "11"] {
        let study = compared(&folder, &whole, flight);
        let found = study.compared.as_ref().unwrap();
        assert!(found.changes.is_empty(), "{flight}: {:?}", found.changes);
        // what cuts of 5 and 10 mm do is below what these flights show
        assert!(found.balance.least.rotors.iter().all(|least| *least > 0.05));
    }
    let between_whole = compared(&folder, &whole[..2], whole[2]);
    assert!(!between_whole.has_changed());
}

#[test]
fn the_answer_is_the_same_whichever_flight_is_the_earlier_one() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/propeller_cut");
    let of = |before: &str, after: &str| compared(&folder, &[before], after).compared.unwrap().changes;
    // 25 against 5 mm at the least that is certain, 25 and 20 mm against whole, and 5 against 10 mm
    for (one, other) in [("10", "13"), ("09", "06"), ("04", "12"), ("13", "11")] {
        let (there, back) = (of(one, other), of(other, one));
        assert_eq!(there.len(), back.len(), "{one} {other}: {there:?} {back:?}");
        for (there, back) in there.iter().zip(&back) {
            assert_eq!(there.what, back.what, "{one} {other}");
            assert!((there.sigmas / back.sigmas - 1.0).abs() < 1e-5, "{one} {other}: {there:?} {back:?}");
            if let (Changed::Rotor(_), Some(gone), Some(returned)) = (there.what, there.moved, back.moved) {
                assert!((gone.after.0 * returned.after.0 - 1.0).abs() < 1e-5, "{there:?} {back:?}");
            }
        }
    }
}

#[test]
fn a_flight_that_is_too_short_is_left_out_of_several_and_said() {
    let Some(shared) = support::shared() else { return };
    let logs = |names: &[&str]| -> Vec<PathBuf> {
        names.iter().map(|name| shared.join("onboard/sitl").join(name)).collect()
    };
    let request = |before: &[&str], after: &[&str]| CompareRequest {
        before: logs(before),
        after: logs(after),
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    // the aborted flight first: the vehicle is drafted from the first flight that can be used
    let study = compare(&request(&["ap11.bin", "ap01.bin", "ap02.bin"], &[]), &Silent).unwrap();
    assert!(study.flights.len() == 2 && !study.is_whole());
    let [left] = study.left_out.as_slice() else { panic!("{:?}", study.left_out) };
    assert!(left.path.ends_with("ap11.bin") && left.why.contains("legs of 2 s"), "{left:?}");
    assert!(study.notes.iter().any(|note| note.is_warning() && note.text.starts_with("left out: ")));
    let study = compare(&request(&["ap01.bin", "ap11.bin"], &["ap02.bin"]), &Silent).unwrap();
    assert_eq!(study.groups.unwrap().before, [0]);
    // none is left on one side, or one alone
    for (before, after) in
        [(&["ap01.bin", "ap02.bin"][..], &["ap11.bin"][..]), (&["ap01.bin", "ap11.bin"], &[])]
    {
        let refused = compare(&request(before, after), &Silent).unwrap_err().to_string();
        assert!(refused.contains("ap11.bin: expected at least 6 legs of 2 s"), "{refused}");
    }
}

#[test]
fn a_balance_that_one_flight_certainly_lacks_begins_after_it() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    // a payload in the middle of the second one, a centre of mass that is off in the third one
    let logs = |names: &[&str]| names.iter().map(|name| folder.join(name)).collect();
    let compared = |before: &[&str], after: &[&str]| {
        let request = CompareRequest {
            before: logs(before),
            after: logs(after),
            vehicle: Some(VehicleGiven::File(folder.join("ardupilot-hexa-b.toml"))),
            balance_only: true,
            transient_s: CompareRequest::TRANSIENT_S,
            ..CompareRequest::default()
        };
        compare(&request, &Silent).unwrap()
    };
    assert!(!compared(&["ap05.bin", "ap06.bin", "ap10.bin"], &[]).has_changed());
    assert!(!compared(&["ap05.bin"], &["ap06.bin", "ap10.bin"]).has_changed());
}

#[test]
fn a_payload_that_is_dropped_in_a_flight_is_no_change_of_the_vehicle() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    let request = CompareRequest {
        before: vec![folder.join("px04.ulg")],
        after: vec![folder.join("px10.ulg")],
        vehicle: Some(VehicleGiven::File(folder.join("px4-v2.toml"))),
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    let study = compare(&request, &Silent).unwrap();
    assert!(!study.has_changed(), "{:?}", study.compared);
    // drag along body z has one name in both flights, and they agree in it
    let vertical = study.tracks.iter().find(|track| track.name == "linear_drag.dz").unwrap();
    let [Some(one), Some(other)] = vertical.values[..] else { panic!("{vertical:?}") };
    assert!((one.0 - other.0).abs() < 3.0 * one.1.hypot(other.1), "{vertical:?}");
    assert!(!study.tracks.iter().any(|track| track.name == "inflow.kz"));
    // and each rotor has a value of each flight
    assert!(study.rotors.len() == 4 && study.rotors.iter().all(|track| track.len() == 2));
}

#[test]
fn an_output_that_left_the_mixer_is_told_with_its_times_and_nothing_hidden_is_searched_for() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/motor_fault_sim");
    let answers: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("answers.json")).unwrap()).unwrap();
    for (name, answer) in answers.as_object().unwrap() {
        let inspection = inspect(&folder.join(name), &OpenOptions::default(), None, &mut |_| ()).unwrap();
        let faults = answer["faults"].as_array().unwrap();
        let found = &inspection.outputs_off_mixer;
        assert_eq!(found.len(), faults.len(), "{name}: {found:?}");
        for (off, fault) in found.iter().zip(faults) {
            let stuck_s = |key: &str| fault[key].as_f64().unwrap() * 1e-6;
            let lasted_s = stuck_s("motor_stopped_us") - stuck_s("control_taken_from_mixer_us");
            assert_eq!(off.output as u64, fault["motor"].as_u64().unwrap(), "{name}");
            assert!((off.stopped_s.unwrap() - off.left_s - lasted_s).abs() < 0.25, "{name}: {off}");
            assert_eq!(Some(off.held), fault["command_held_us"].as_f64(), "{name}");
        }
        assert!(inspection.advice[0].contains("does not follow the controllers"), "{:?}", inspection.advice);
        // nothing after it can be used
        let (flight, left_s) = (&inspection.flight, found[0].left_s);
        assert!(flight.usable_s < left_s - flight.segments[0].start_s, "{name}: {flight:?}");
        let ends_s = flight.segments.last().unwrap().end_s;
        // it flies until it is on the ground, by the clock of the log, which ends with its last message
        let from_end_s = |key: &str| Some(1e-6 * (answer["log_end_us"].as_f64()? - answer[key].as_f64()?));
        if let Some(before_end_s) = from_end_s("ground_us") {
            let down_s = inspection.clock.span_s.1 - before_end_s;
            assert!((ends_s - down_s).abs() < 0.5, "{name}: {ends_s} s, down at {down_s} s");
        }
        assert!((flight.off_mixer_s - (ends_s - left_s)).abs() < 0.5, "{name}: {flight:?}");
    }
    let faulty = ["flight_01.bin", "flight_02.bin"].map(|name| folder.join(name));
    let request = CompareRequest { before: faulty.to_vec(), ..CompareRequest::default() };
    let StudyError::NoBalance { why, .. } = compare(&request, &Silent).unwrap_err() else {
        panic!("no file")
    };
    assert!(why.contains("legs of 2 s") && why.contains("output 2 does not follow the controllers"), "{why}");
    let request = mavid::study::ExplainRequest {
        logs: vec![folder.join("flight_01.bin")],
        vehicle: VehicleGiven::Weighed(mavid::draft::Given { mass_kg: 1.5, size_m: Some(0.45), frame: None }),
        transient_s: 1.0,
        ..mavid::study::ExplainRequest::default()
    };
    let refused = mavid::study::explain(&request, &Silent).unwrap_err();
    let StudyError::File { why, .. } = refused else { panic!("{refused}") };
    assert!(
        why.contains("output 2 does not follow the controllers")
            && why.contains("mavid does not search for effects")
            && why.contains("before that it was in the air for 12 s, expected 40 s at least"),
        "{why}"
    );
}
