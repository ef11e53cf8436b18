//! `mavid run` at its process boundary, as far as it goes without a flight; and how long a vehicle is waited for.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

use std::cell::RefCell;
#[cfg(unix)]
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use mavid::link::LinkOptions;
use mavid::log::TlogReader;
use mavid::note::Note;
use mavid::onboard::{OnboardError, Session, SessionRequest};
use mavid::wire::STAMP_BYTES;

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("run").join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// Runs it without a terminal.
fn run(out: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid"))
        .arg("run")
        .arg("--out")
        .arg(out)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn what_cannot_be_is_told_before_anybody_is_spoken_to() {
    let out = folder("wrong");
    let nobody = ["--connect", "udpin:127.0.0.1:0"];
    let vehicle = format!("{}/configs/x500.toml", env!("CARGO_MANIFEST_DIR"));
    for (arguments, expected) in [
        // nobody can be asked
        (
            vec![nobody[0], nobody[1], "--mass", "2"],
            "expected a terminal at which questions can be answered, or --yes",
        ),
        (vec!["--mass", "2", "--yes"], "--connect <ADDRESS>"),
        (vec![nobody[0], nobody[1], "--sitl", "--yes"], "cannot be used with"),
        (vec![nobody[0], nobody[1], "--arm"], "--yes"),
        (vec![nobody[0], nobody[1], "--autopilot", "px4", "--yes"], "cannot be used with"),
        (
            vec![nobody[0], nobody[1], "--yes"],
            "--mass: expected the mass with battery and payload in kg, got none",
        ),
        (vec![nobody[0], nobody[1], "--yes", "--room", "4,4"], "--room: expected length, width and height"),
        (vec!["--connect", "nowhere", "--mass", "2", "--yes"], "udpin:HOST:PORT"),
        // what is wrong is told, and not that nobody is there
        (vec!["--connect", "nowhere", "--mass", "2"], "udpin:HOST:PORT"),
        (
            vec![nobody[0], nobody[1], "--mass", "2", "--room", "4,4"],
            "--room: expected length, width and height",
        ),
        (
            vec![nobody[0], nobody[1], "--mass", "2", "--tracking-max", "nan", "--yes"],
            "--tracking-max: expected a number above 0 and at most 10, got NaN",
        ),
        (vec!["--sitl", "--yes", "--effects", "nowhere.toml"], "nowhere.toml"),
        (
            vec![nobody[0], nobody[1], "--mass", "0", "--yes"],
            "--mass: expected a mass from 0.005 to 500 kg, got 0",
        ),
        (vec!["--sitl", "--mass", "-1", "--yes"], "--mass: expected a mass from 0.005 to 500 kg, got -1"),
        (
            vec![nobody[0], nobody[1], "--mass", "2", "--size", "90", "--yes"],
            "--size: expected a size from 0.03 to 10 m, got 90",
        ),
        (vec![nobody[0], nobody[1], "--vehicle", "nowhere.toml", "--yes"], "nowhere.toml"),
        (
            vec![nobody[0], nobody[1], "--vehicle", &vehicle, "--room", "1,1,1", "--yes"],
            "for this vehicle (its rotors reach",
        ),
        (vec![nobody[0], nobody[1], "--mass", "2", "--vehicle", &vehicle, "--yes"], "cannot be used with"),
    ] {
        let output = run(&out, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_doubt_ends_a_run_without_a_person_and_says_what_to_do() {
    let out = folder("doubt");
    // an empty folder blocks nothing
    std::fs::create_dir_all(&out).unwrap();
    let small = run(&out, &["--sitl", "--yes", "--room", "0.8,4,3"]);
    assert_eq!(small.status.code(), Some(2), "{}", stderr(&small));
    assert!(stderr(&small).contains("--room: expected a room of at least"), "{}", stderr(&small));
    assert!(!out.join("limits.toml").exists());
    // the vehicle's file is there from now on
    let other = run(&out, &["--sitl", "--yes", "--mass", "3", "--room", "4,4,3"]);
    assert_eq!(other.status.code(), Some(2), "{}", stderr(&other));
    assert!(stderr(&other).contains("--mass: expected the 2.0643 kg of"), "{}", stderr(&other));
    // and so is a room
    std::fs::write(out.join("limits.toml"), "[limits]\nx_max_m = 2.0\ny_max_m = 2.0\nz_max_m = 3.0\n")
        .unwrap();
    let narrow = run(&out, &["--sitl", "--yes", "--room", "2,2,2"]);
    assert_eq!(narrow.status.code(), Some(2), "{}", stderr(&narrow));
    assert!(stderr(&narrow).contains("--room: expected the 4,4,3 m of"), "{}", stderr(&narrow));
    assert!(!out.join("plan.toml").exists());
    // by the vehicle's own parameters it is a vehicle of this size: no such mass flies with it
    let out = folder("contradiction");
    let light = run(&out, &["--sitl", "--yes", "--mass", "0.006", "--room", "4,4,3"]);
    assert_eq!(light.status.code(), Some(2), "{}", stderr(&light));
    let said = stderr(&light);
    assert!(said.contains("the vehicle is doubtful") && said.contains("State mass and size anew"), "{said}");
    assert!(said.contains("$ mavid vehicle init --from tcpout:127.0.0.1:"), "{said}");
    assert!(!out.join("vehicle.toml").exists() && out.join("vehicle.toml.doubtful").exists());
}

/// While it plans, or in the flight after that: wherever the signal comes, it is told, and the exit status says that not all is done.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_run_with_the_exit_status_of_what_is_not_done() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["run", "--sitl", "--yes", "--room", "4,4,3", "--out"])
        .arg(folder("interrupted"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = String::new();
    for line in BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok) {
        // it begins to plan
        if line.contains("Room and trajectory") {
            let id = child.id().to_string();
            assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        }
        said.push_str(&line);
        said.push('\n');
    }
    assert_eq!(child.wait().unwrap().code(), Some(3), "{said}");
    assert!(said.contains("ended by Ctrl-C"), "{said}");
}

/// A pipe is read once, and what came is there from then on.
#[cfg(unix)]
#[test]
fn a_vehicle_may_come_through_a_pipe() {
    let out = folder("pipe");
    std::fs::create_dir_all(&out).unwrap();
    // where the run ends
    std::fs::write(out.join("plan.toml"), "no plan\n").unwrap();
    let pipe = out.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let vehicle = std::fs::read(format!("{}/configs/x500.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let writer = {
        let (pipe, vehicle) = (pipe.clone(), vehicle.clone());
        std::thread::spawn(move || std::fs::write(pipe, vehicle).unwrap())
    };
    let output = run(&out, &["--sitl", "--yes", "--room", "4,4,3", "--vehicle", &pipe.display().to_string()]);
    writer.join().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("plan.toml: expected a trajectory file"), "{}", stderr(&output));
    for name in ["given_vehicle.toml", "vehicle.toml"] {
        assert_eq!(std::fs::read(out.join(name)).unwrap(), vehicle, "{name}");
    }
}

#[test]
fn a_real_room_is_never_assumed() {
    let out = folder("no_room");
    std::fs::create_dir_all(&out).unwrap();
    std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml"), out.join("vehicle.toml"))
        .unwrap();
    let output = run(&out, &["--connect", "udpin:127.0.0.1:0", "--yes"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--room: expected the free room"), "{}", stderr(&output));
    assert!(!out.join("plan.toml").exists());
}

/// A flight in the folder of a run that is over.
fn flown(folder: &Path, log: &[u8]) {
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join("flight.tlog"), log).unwrap();
    let phases = ["take off", "trajectory", "land", "over"].map(|phase| {
        format!("{{\"time_s\":1.0,\"level\":\"information\",\"kind\":\"phase\",\"text\":\"{phase}\"}}\n")
    });
    std::fs::write(folder.join("events.jsonl"), phases.concat()).unwrap();
}

/// Of a run that is taken up after its flights: whatever is made of the answer, it comes first.
#[test]
fn the_answer_comes_before_what_is_made_of_it() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let log = std::fs::read(fixtures.join("p01_identify_0_25s.tlog")).unwrap();
    // in the middle, between two frames
    let mut reader = TlogReader::new(log.as_slice());
    let mut middle = 0;
    while middle < log.len() / 2 {
        middle = usize::try_from(reader.next_record().unwrap().unwrap().offset).unwrap();
    }
    let middle = middle - STAMP_BYTES;
    for (name, flights) in [("answer", vec![&log[..]]), ("answers", vec![&log[..middle], &log[middle..]])] {
        let out = folder(name);
        for (at, log) in flights.iter().enumerate() {
            flown(&out.join(format!("flight{}", at + 1)), log);
        }
        std::fs::copy(fixtures.join("p01_vehicle.toml"), out.join("vehicle.toml")).unwrap();
        let limits = "[limits]\nx_max_m = 3.0\ny_max_m = 3.0\nz_min_m = 0.5\nz_max_m = 4.0\n";
        std::fs::write(out.join("limits.toml"), limits).unwrap();
        // standard output and standard error in the order in which they are said
        let said = out.join("said.txt");
        let file = std::fs::File::create(&said).unwrap();
        let status = Command::new(env!("CARGO_BIN_EXE_mavid"))
            .args([
                "run",
                "--connect",
                "udpout:127.0.0.1:9",
                "--yes",
                "--flights",
                &flights.len().to_string(),
            ])
            .arg("--out")
            .arg(&out)
            .stdin(Stdio::null())
            .stdout(file.try_clone().unwrap())
            .stderr(file)
            .status()
            .unwrap();
        let said = std::fs::read_to_string(said).unwrap();
        assert!(matches!(status.code(), Some(0 | 3)), "{said}");
        let answer = std::fs::read_to_string(out.join("report.txt")).unwrap();
        let sentence: String = answer.lines().next().unwrap().chars().take(40).collect();
        let at = |text: &str| said.find(text).unwrap_or_else(|| panic!("no {text:?} in {said}"));
        let after =
            ["Model and report", "for the appendix", "$ mavid identify", "$ mavid export", "report      "];
        assert!(after.iter().all(|text| at(&sentence) < at(text)), "{said}");
        assert_eq!(said.matches(&sentence).count(), 1, "{said}");
    }
}

thread_local! {
    static TOLD: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

fn tell(note: &Note) {
    TOLD.with_borrow_mut(|told| told.push(note.sentence()));
}

/// The clock stands still but for what is waited for.
#[tokio::test(start_paused = true)]
async fn who_waits_for_a_vehicle_says_how_long() {
    let request = SessionRequest {
        address: "udpin:127.0.0.1:0".parse().unwrap(),
        options: LinkOptions::default(),
        system: None,
        patience: Duration::from_secs(30),
        interrupt: Box::pin(std::future::pending()),
        tell,
    };
    let Err(error) = Session::open(request).await else { panic!("nobody is there") };
    assert!(matches!(error, OnboardError::Absent { within_s: 30, .. }), "{error}");
    let told = TOLD.with_borrow(Clone::clone);
    let waited: Vec<&String> = told.iter().filter(|line| line.contains("waiting")).collect();
    assert_eq!(waited.len(), 4, "{told:?}");
    assert!(waited[1].ends_with("no vehicle yet: waiting 12 of 30 s"), "{told:?}");
}
