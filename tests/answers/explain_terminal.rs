//! `mavid explain` at a terminal, where both of its outputs are one screen.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::pty::Person;

/// What a drafted vehicle is said to rest on: a note.
const NOTE: &str = "the drafted vehicle: rests on guesses";

fn explain(out: &Path) -> Command {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg");
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command.arg("explain").arg(log).args(["--mass", "2.0"]).arg("--out").arg(out);
    command
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("explain_terminal-{name}"));
    let _ = std::fs::remove_dir_all(&path);
    path
}

#[test]
fn at_a_terminal_notes_are_said_once_and_the_answer_stands_at_the_end_again() {
    let out = folder("person");
    let (person, mut child) = Person::starts(&mut explain(&out));
    assert!(child.wait().unwrap().success());
    let report = format!("report: {}", out.join("report.html").display());
    let begun = Instant::now();
    while !person.saw().contains(&report) && begun.elapsed() < Duration::from_secs(5) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let saw = person.saw();
    let lines: Vec<&str> = saw.lines().map(str::trim_end).filter(|line| !line.is_empty()).collect();
    let [.., answer, summary, last] = lines.as_slice() else { panic!("{saw}") };
    assert!(answer.starts_with("answer: ") && answer.chars().count() <= 120, "{saw}");
    assert_eq!(*summary, format!("summary to paste: {}", out.join("report.md").display()));
    assert_eq!(*last, report);
    assert_eq!(saw.matches(NOTE).count(), 1, "{saw}");
}

#[test]
fn in_a_pipe_the_page_holds_its_notes_and_no_second_answer() {
    let output = explain(&folder("pipe")).output().unwrap();
    let [page, said] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert_eq!((page.matches(NOTE).count(), said.matches(NOTE).count()), (1, 1));
    assert!(
        !page.contains("answer: ") && !page.contains("report: ") && !said.contains("answer: "),
        "{page}{said}"
    );
}
