//! `mavid fly` at a terminal: what is typed before the page of the flight was shown, and a terminal that takes nothing.

use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::processes::{LONG, Running, config, folder, planned, until, vehicle};
use crate::pty::Person;
use serde_json::Value;

fn fly(out: &Path, listens: &str, trajectory: &Path, further: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command.args(["fly", "--arm", "--connect", &listens.replace("in:", "out:")]);
    command.args(["--vehicle", &config("x500.toml"), "--trajectory"]).arg(trajectory);
    command.arg("--out").arg(out).args(further).env("TERM", "xterm-256color");
    command
}

/// Kinds of the events so far.
fn events(out: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(out.join("events.jsonl")).unwrap_or_default();
    text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

fn is_in_phase(out: &Path, phase: &str) -> bool {
    events(out).iter().any(|event| event["kind"] == "phase" && event["text"] == phase)
}

/// A flight that ends before it begins.
pub fn a_word_for_arming_that_was_typed_before_the_page_arms_nothing() {
    let (trajectory, out) = (planned("early_plan", 1), folder("early").join("flight"));
    let (_vehicle, listens) = vehicle("px4", "udpin:127.0.0.1:0");
    let (mut person, child) = Person::starts(&mut fly(&out, &listens, &trajectory, &["--plain"]));
    let mut running = Running(child);
    person.types("arm\narm\nar");
    until("nothing is said of it", || {
        person.saw().contains("typed before the page was shown: ignored; type arm again")
    });
    until("no page", || person.saw().contains("type arm and return to arm and fly"));
    let page = person.saw().len();
    // it is waited for, second after second
    until("no state", || person.saw()[page..].matches(" s] check").count() >= 3);
    // what is left of the line begun before is no word
    person.types("m\n");
    until("half a word is none", || person.saw()[page..].contains("got `m`"));
    assert!(!is_in_phase(&out, "arm") && !is_in_phase(&out, "prime"), "{:?}", events(&out));
    assert_eq!(person.saw().matches("typed before the page").count(), 1, "{}", person.saw());
    person.types("arm\n");
    until("it does not arm", || is_in_phase(&out, "take off"));
    let _ = running.0.kill();
    assert!(running.0.wait().unwrap().code().is_none());
}

/// One flight in real time.
pub fn a_terminal_that_takes_nothing_costs_no_result() {
    let (trajectory, out) = (planned("blocked_plan", 1), folder("blocked").join("flight"));
    let (_vehicle, listens) = vehicle("px4", "udpin:127.0.0.1:0");
    let (person, child) = Person::starts(&mut fly(&out, &listens, &trajectory, &["--yes"]));
    let mut running = Running(child);
    until("no trajectory", || is_in_phase(&out, "trajectory"));
    person.looks_away();
    until("it does not end", || running.0.try_wait().unwrap().is_some());
    let told = events(&out);
    assert!(told.iter().any(|event| event["kind"] == "view"), "{told:?}");
    assert!(is_in_phase(&out, "over"), "{told:?}");
    for name in ["model.toml", "report.html", "report.md", "rigid_body/identification.json"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    // all is done, and not all of it was told
    assert_eq!(running.0.wait().unwrap().code(), Some(3), "{told:?}");
}

/// A vehicle that was started so as to outlive its terminal flies on when the terminal is gone; its standard output on a
/// pipe that is closed, and nobody at its address, end it as little.
pub fn a_vehicle_outlives_its_terminal_where_it_was_started_so() {
    let ground = UdpSocket::bind("127.0.0.1:0").unwrap();
    ground.set_read_timeout(Some(LONG)).unwrap();
    let nobody = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let listen = format!("udpout:{}", ground.local_addr().unwrap());
    let script = format!(
        "trap '' HUP; exec {} sitl --listen udpout:{nobody} --listen {listen}",
        env!("CARGO_BIN_EXE_mavid")
    );
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = Command::new("sh");
    command.args(["-c", &script]).stdin(Stdio::null()).stdout(writer).stderr(Stdio::null());
    let mut running = Running(command.spawn().unwrap());
    let heard = |frames: u32| {
        let mut bytes = [0; 2048];
        for _ in 0..frames {
            ground.recv(&mut bytes).unwrap();
        }
    };
    heard(20);
    let signal = |name: &str| {
        let id = running.0.id().to_string();
        assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
    };
    signal("-HUP");
    heard(500);
    signal("-TERM");
    assert_eq!(running.0.wait().unwrap().code(), Some(0));
}
