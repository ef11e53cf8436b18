//! `mavid fleet`: logs of many vehicles as tables, whatever the logs are; killed and run again; and the report of histories.

use crate::support;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::fleet::{FleetReport, LogRows, PartsFolder, ReportSettings, Schema};
use serde_json::Value;

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A fresh folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fleet-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Fixtures and what damage makes of them, in a folder with what is no log.
fn logs(at: &Path) {
    fs::create_dir_all(at.join("deep")).unwrap();
    let vehicle = root().join("fixtures/p01_vehicle.toml");
    let list = format!("[[vehicle]]\nname = \"p01\"\nfile = {vehicle:?}\nlogs = \"*/a.tlog\"\n");
    fs::write(at.join("vehicles.toml"), list).unwrap();
    let copy = |from: &str, to: &str| fs::copy(root().join("fixtures").join(from), at.join(to)).unwrap();
    copy("p01_identify_0_25s.tlog", "a.tlog");
    copy("p04_identify_10_22s.tlog", "deep/b.tlog");
    copy("px4_flight.ulg", "deep/c.ulg");
    // the same bytes under another name
    copy("px4_flight.ulg", "deep/d.ulg");
    let whole = fs::read(at.join("deep/c.ulg")).unwrap();
    fs::write(at.join("cut.ulg"), &whole[..whole.len() / 3]).unwrap();
    let mut damaged = whole.clone();
    damaged.iter_mut().skip(4000).step_by(97).for_each(|byte| *byte ^= 0x5a);
    fs::write(at.join("damaged.ulg"), damaged).unwrap();
    fs::write(at.join("words.bin"), "this is no log at all\n".repeat(50)).unwrap();
    fs::write(at.join("empty.tlog"), "").unwrap();
    fs::write(at.join("notes.txt"), "not a log").unwrap();
}

/// Every line of a table's parts, in order.
fn lines(out: &Path, table: &str) -> Vec<String> {
    let mut all = Vec::new();
    for entry in fs::read_dir(out.join(table)).unwrap() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap();
        all.extend(text.lines().map(str::to_owned));
    }
    all.sort();
    all
}

fn all_lines(out: &Path) -> BTreeMap<&'static str, Vec<String>> {
    Schema::current().tables.iter().map(|table| (table.name, lines(out, table.name))).collect()
}

/// All parts with their bytes.
fn parts(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for table in Schema::current().tables {
        for entry in fs::read_dir(out.join(table.name)).into_iter().flatten() {
            let path = entry.unwrap().path();
            all.insert(path.clone(), fs::read(path).unwrap());
        }
    }
    all
}

fn run(sources: &Path, out: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let (sources, out) = (sources.display().to_string(), out.display().to_string());
    let list = format!("{sources}/vehicles.toml");
    let mut arguments =
        vec!["fleet", &sources, "--out", &out, "--format", "jsonl", "--depth", "balance", "--json"];
    if Path::new(&list).is_file() {
        arguments.extend(["--vehicles", &list]);
    }
    let output = mavid(&[&arguments[..], more].concat());
    let tally = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", said(&output)));
    (output.status.code(), tally)
}

#[test]
fn every_log_is_a_row_and_bad_ones_stop_nothing() {
    let at = folder("fleet_rows");
    let (sources, out) = (at.join("logs"), at.join("out"));
    logs(&sources);
    let (status, tally) = run(&sources, &out, &[]);
    assert_eq!(status, Some(3), "{tally}");
    assert_eq!(
        (&tally["logs"], &tally["twins"], &tally["errors"]),
        (&8.into(), &1.into(), &2.into()),
        "{tally}"
    );
    let rows = PartsFolder::open(&out).unwrap().read_all().unwrap();
    assert_eq!(rows.logs.len(), 7);
    let of = |name: &str| rows.logs.iter().find(|log| log.uri.ends_with(name)).unwrap();
    let flown = of("a.tlog");
    assert_eq!((flown.status.as_str(), flown.format.as_deref(), flown.flights), ("flown", Some("tlog"), 1));
    assert!(flown.airborne_s.unwrap() > 10.0 && flown.vehicle.is_some());
    for (name, expected) in [("words.bin", "expected"), ("empty.tlog", "expected")] {
        let log = of(name);
        assert!(log.status == "error" && log.error.as_ref().unwrap().contains(expected), "{log:?}");
    }
    // what is damaged is told, as `inspect` tells it
    assert!(of("damaged.ulg").losses > 0);
    let legs = rows.legs.iter().filter(|leg| leg.log == flown.log).count();
    assert!(legs >= 6, "{legs} legs");
    let flight = rows.flights.iter().find(|flight| flight.log == flown.log).unwrap();
    assert_eq!(flight.motion_error.as_deref(), Some("not asked for"));
    assert!(rows.parameters.iter().any(|row| row.name == "vibration" && row.std.unwrap() > 0.0));
    assert!(rows.provenance.iter().all(|row| row.schema == 1 && row.program.starts_with("mavid ")));

    // the same again does nothing and changes nothing
    let before = parts(&out);
    let (_, again) = run(&sources, &out, &[]);
    assert_eq!(
        (&again["done_before"], &again["parts"], &again["rows"]),
        (&8.into(), &0.into(), &0.into()),
        "{again}"
    );
    assert_eq!(parts(&out), before);
    // other settings do not lie beside these
    let other =
        mavid(&["fleet", sources.to_str().unwrap(), "--out", out.to_str().unwrap(), "--depth", "inspect"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(said(&other).contains("expected rows by the same settings and program"), "{}", said(&other));
}

#[test]
fn killed_and_run_again_ends_in_the_same_rows_and_shards_share_them() {
    let at = folder("fleet_resumed");
    let sources = at.join("logs");
    logs(&sources);
    let whole = at.join("whole");
    run(&sources, &whole, &[]);
    let expected = all_lines(&whole);
    let list = sources.join("vehicles.toml").display().to_string();

    // killed after the first parts: what is written stays, and half a part goes
    let resumed = at.join("resumed");
    let arguments = ["--format", "jsonl", "--depth", "balance", "--part-logs", "1", "--jobs", "1"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["fleet", sources.to_str().unwrap(), "--out", resumed.to_str().unwrap(), "--vehicles", &list])
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let lists = resumed.join("_parts");
    let finished = || fs::read_dir(&lists).map_or(0, Iterator::count);
    while finished() < 2 && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept: Vec<String> =
        PartsFolder::open(&resumed).unwrap().lists().unwrap().into_iter().map(|list| list.part).collect();
    assert!(!kept.is_empty());
    let is_kept = |path: &Path| kept.iter().any(|part| path.to_str().unwrap().contains(part.as_str()));
    let before: BTreeMap<_, _> = parts(&resumed).into_iter().filter(|(path, _)| is_kept(path)).collect();
    fs::write(resumed.join("logs/part-0123456789abcdef.jsonl"), "{\"log\":\"half\"").unwrap();
    run(&sources, &resumed, &["--part-logs", "3"]);
    let after = parts(&resumed);
    assert!(before.iter().all(|(path, bytes)| after[path] == *bytes));
    assert_eq!(all_lines(&resumed), expected);
    assert_eq!(fs::read_dir(resumed.join("_work")).map_or(0, Iterator::count), 0);

    // three runs of a scheduler share the logs
    let shared = at.join("shared");
    for index in 0..3 {
        let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
            .args(["fleet", sources.to_str().unwrap(), "--out", shared.to_str().unwrap(), "--shards", "3"])
            .args(["--vehicles", &list])
            .args(arguments)
            .env("JOB_COMPLETION_INDEX", index.to_string())
            .output()
            .unwrap();
        assert!(matches!(output.status.code(), Some(0 | 3)), "{}", said(&output));
    }
    let of = |rows: &LogRows| {
        let mut logs: Vec<String> = rows.logs.iter().map(|log| log.log.clone()).collect();
        logs.sort();
        (logs, rows.legs.len(), rows.flights.len())
    };
    let [one, many] = [&whole, &shared].map(|out| PartsFolder::open(out).unwrap().read_all().unwrap());
    assert_eq!(of(&one), of(&many));
    let lost =
        mavid(&["fleet", sources.to_str().unwrap(), "--out", shared.to_str().unwrap(), "--shards", "3"]);
    assert!(said(&lost).contains("JOB_COMPLETION_INDEX or SLURM_ARRAY_TASK_ID"), "{}", said(&lost));
}

/// A log that takes more than it may is a row, and the others are not touched.
#[cfg(target_os = "linux")]
#[test]
fn a_log_beyond_its_bounds_is_an_error_and_a_row() {
    let at = folder("fleet_bounds");
    let sources = at.join("logs");
    fs::create_dir_all(&sources).unwrap();
    fs::copy(root().join("fixtures/px4_flight.ulg"), sources.join("small.ulg")).unwrap();
    // a table of 40 million numbers
    let row = "1.0,".repeat(999) + "1.0\n";
    fs::write(sources.join("large.csv"), "t,".to_owned() + &row.repeat(1200)).unwrap();
    let (status, tally) = run(&sources, &at.join("out"), &["--log-size", "2"]);
    assert_eq!((status, &tally["errors"], &tally["flown"]), (Some(3), &1.into(), &1.into()), "{tally}");
    let rows = PartsFolder::open(&at.join("out")).unwrap().read_all().unwrap();
    let large = rows.logs.iter().find(|log| log.uri.ends_with("large.csv")).unwrap();
    assert_eq!(large.error.as_deref(), Some("expected a log of at most 2 MB, got 4 MB"));

    let fixture = root().join("fixtures/px4_flight.ulg");
    let (out, again) = (at.join("memory"), at.join("time"));
    let bounded = mavid(&[
        "fleet",
        fixture.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--log-memory",
        "128",
        "--json",
    ]);
    // 128 MB are enough for a small log: the bound is on the process and the program starts in it
    assert!(matches!(bounded.status.code(), Some(0 | 3)), "{}", said(&bounded));
    assert_eq!(PartsFolder::open(&out).unwrap().read_all().unwrap().logs.len(), 1);
    let task = serde_json::json!({ "uri": "x", "path": "/dev/zero", "sha256": "x", "bytes": 0, "settings": {
        "depth": "inspect", "vehicles": {}, "csv_map": null, "files": []
    }});
    let mut child = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["fleet-log", "--time", "1", "--memory", "256"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), task.to_string().as_bytes()).unwrap();
    // a file without an end is told or ended, and never read on and on
    let ended = child.wait_with_output().unwrap();
    assert!(
        !ended.status.success() || String::from_utf8_lossy(&ended.stdout).contains("error"),
        "{}",
        said(&ended)
    );
    drop(again);
}

/// Flights of simulated vehicles: the legs of real simulations, with one rotor weak from a flight on in one of them.
fn simulated(at: &Path) {
    let weak = at.join("weak.toml");
    fs::write(&weak, "[[effect]]\nid = \"weak_rotor\"\nrotor = 2\nfactor = 0.95\n").unwrap();
    let (vehicle, trajectory) =
        (root().join("configs/x500.toml"), root().join("configs/trajectories/table2.toml"));
    let mut list = String::new();
    let seeds = [(0, [1, 2, 3, 4, 5, 6]), (1, [11, 12, 13, 14, 15, 16])];
    for (craft, seeds) in seeds {
        let folder = at.join(format!("logs/craft{craft}"));
        fs::create_dir_all(&folder).unwrap();
        for (flight, seed) in seeds.into_iter().enumerate() {
            let log = folder.join(format!("{flight}.tlog")).display().to_string();
            let seed = seed.to_string();
            let mut arguments =
                vec!["simulate", vehicle.to_str().unwrap(), "--trajectory", trajectory.to_str().unwrap()];
            arguments.extend(["--seed", &seed, "--out", &log]);
            if craft == 1 && flight >= 3 {
                arguments.extend(["--effects", weak.to_str().unwrap()]);
            }
            let output = mavid(&arguments);
            assert!(output.status.success(), "{}", said(&output));
        }
        list.push_str(&format!(
            "[[vehicle]]\nname = \"craft{craft}\"\ntype = \"x500\"\nfile = {vehicle:?}\nlogs = \"*/craft{craft}/*\"\n"
        ));
    }
    fs::write(at.join("vehicles.toml"), list).unwrap();
}

#[test]
fn vehicles_that_are_not_listed_may_share_a_mass() {
    let at = folder("fleet_mass");
    let (sources, out) = (at.join("logs"), at.join("out"));
    fs::create_dir_all(&sources).unwrap();
    fs::copy(root().join("fixtures/px4_flight.ulg"), sources.join("a.ulg")).unwrap();
    let (status, tally) = run(&sources, &out, &["--mass", "1.0", "--size", "0.5"]);
    assert_eq!((status, &tally["flown"]), (Some(0), &1.into()), "{tally}");
    let rows = PartsFolder::open(&out).unwrap().read_all().unwrap();
    let flight = &rows.flights[0];
    // its log names it
    assert!(flight.vehicle_is_known && flight.vehicle.starts_with("px4-"), "{flight:?}");
    assert!(rows.provenance[0].vehicle_given && rows.provenance[0].vehicle_toml.is_some());
    for (words, expected) in
        [(&["--mass", "-1"][..], "expected a mass from"), (&["--size", "0.5"], "--mass <KG>")]
    {
        let refused = mavid(&[&["fleet", sources.to_str().unwrap(), "--out", "none"], words].concat());
        assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
        assert!(said(&refused).contains(expected), "{}", said(&refused));
    }
}

#[test]
fn the_vehicle_that_changed_is_found_with_its_rotor_and_flight() {
    let at = folder("fleet_report");
    simulated(&at);
    let out = at.join("out");
    let vehicles = at.join("vehicles.toml").display().to_string();
    let (status, tally) = run(&at.join("logs"), &out, &["--vehicles", &vehicles]);
    assert_eq!((status, &tally["flown"]), (Some(0), &12.into()), "{tally}");
    let report = mavid(&["fleet", "report", out.to_str().unwrap(), "--shuffles", "100", "--json"]);
    assert_eq!(report.status.code(), Some(4), "{}", said(&report));
    let document: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!(document["answer"], "1 of 2 vehicles changed.");
    let vehicle = |name: &str| {
        let all = document["vehicles"].as_array().unwrap();
        all.iter().find(|vehicle| vehicle["name"] == name).unwrap().clone()
    };
    assert_eq!(vehicle("craft0")["changed"], false);
    let changed = vehicle("craft1");
    let step = &changed["comparison"]["history"][0];
    assert_eq!((&step["from"], &step["changes"][0]["rotor"]), (&3.into(), &2.into()), "{step}");
    assert_eq!(changed["rotors"][2]["thrust_per_command"].as_array().unwrap().len(), 6);
    let alarms = &document["false_alarms"];
    // orders that divide the flights as a change does are left out
    assert!((80..=100).contains(&alarms["shuffled"].as_u64().unwrap()), "{alarms}");
    assert!(alarms["least_sigmas"].as_f64().unwrap() >= 4.5 && alarms["rate"].as_f64().unwrap() <= 0.01);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains("1 of 2 vehicles changed.")
            && page.contains("<svg")
            && page.contains("craft1 changed from flight 4")
    );
    assert_eq!(
        fs::read_to_string(out.join("fleet.json")).unwrap().trim(),
        String::from_utf8_lossy(&report.stdout).trim()
    );
    let text = said(&mavid(&["fleet", "report", out.to_str().unwrap(), "--shuffles", "100"]));
    assert!(text.starts_with("1 of 2 vehicles changed."), "{text}");

    // the unchanged one alone is status 0
    let mut rows = PartsFolder::open(&out).unwrap().read_all().unwrap();
    rows.flights.retain(|flight| flight.vehicle == "craft0");
    let alone = FleetReport::of(&rows, &ReportSettings { false_alarms: 0.005, shuffles: 50 });
    assert!(alone.changed().next().is_none() && alone.vehicles.len() == 1);
}

#[test]
fn cut_propellers_stand_out_in_the_history_of_one_vehicle() {
    let Some(shared) = support::shared() else { return };
    let at = folder("fleet_propellers");
    let list = at.join("vehicles.toml");
    fs::write(&list, "[[vehicle]]\nname = \"one\"\nlogs = \"*\"\nmass = 1.5\n").unwrap();
    let more = ["--vehicles", list.to_str().unwrap()];
    let (_, tally) = run(&shared.join("onboard/propeller_cut"), &at.join("out"), &more);
    assert_eq!(tally["flown"], 15, "{tally}");
    let report = mavid(&["fleet", "report", at.join("out").to_str().unwrap(), "--shuffles", "50", "--json"]);
    assert_eq!(report.status.code(), Some(4), "{}", said(&report));
    let document: Value = serde_json::from_slice(&report.stdout).unwrap();
    // by their dates: three flights each with whole propellers, and with one cut by 20, 5, 10 and 25 mm
    let history = document["vehicles"][0]["comparison"]["history"].as_array().unwrap();
    let steps: Vec<_> = history.iter().map(|step| (&step["from"], &step["changes"][0]["rotor"])).collect();
    let rotor = &Value::from(0);
    assert_eq!(steps, [(&3.into(), rotor), (&6.into(), rotor), (&12.into(), rotor)], "{history:?}");
    // of four days there are too few orders to shuffle
    assert_eq!(document["false_alarms"]["shuffled"], 0, "{}", document["false_alarms"]);
}

#[test]
fn the_book_has_every_table_and_column() {
    let chapter = fs::read_to_string(root().join("docs/src/fleet.md")).unwrap();
    let written = Schema::current().markdown();
    assert!(
        chapter.contains(written.trim_end()),
        "write what `mavid fleet schema` prints into docs/src/fleet.md:\n{written}"
    );
    let printed = mavid(&["fleet", "schema"]);
    assert_eq!(String::from_utf8_lossy(&printed.stdout).trim_end(), written.trim_end());
    let document: Value = serde_json::from_slice(&mavid(&["fleet", "schema", "--json"]).stdout).unwrap();
    assert_eq!(document["tables"][0]["columns"][2]["unit"], "B");
}

#[test]
fn what_cannot_be_used_is_told_before_the_work() {
    let at = folder("fleet_refused");
    let out = at.join("out").display().to_string();
    let log = root().join("fixtures/px4_flight.ulg").display().to_string();
    let file = at.join("file");
    fs::write(&file, "x").unwrap();
    for (arguments, expected) in [
        (vec!["fleet", "no/such/log.ulg", "--out", &out], "got nothing of that name"),
        (vec!["fleet", &log], "--out"),
        (vec!["fleet", &log, "--out", file.to_str().unwrap()], "expected a folder"),
        (vec!["fleet", &log, "--out", &out, "--shard", "3/2"], "expected a shard from 0 to 1"),
        (vec!["fleet", &log, "--out", &out, "--vehicles", file.to_str().unwrap()], "file"),
        (vec!["fleet", "report", at.to_str().unwrap()], "expected a folder that `mavid fleet"),
        (vec!["fleet", "report", &out, "--false-alarms", "2"], "expected a share between 0 and 1"),
    ] {
        let output = mavid(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(expected), "{arguments:?}: {}", said(&output));
    }
}
