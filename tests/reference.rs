//! What `explain` says of the shared flights is what is written down in `fixtures/reference`: verdict, names, sizes with
//! their standard errors, mass and inertia. A change that should change nothing changes none of it.
//!
//! `MAVID_WRITE_REFERENCE=1 cargo test --release --test reference` writes it anew. Without `MAVID_REFERENCE=all` the
//! practice cases alone are compared, which takes some seconds.

#![allow(clippy::panic, clippy::unwrap_used, reason = "a test ends where it fails")]

mod support;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Numbers agree to this share of their value, or ...
const SAME: f64 = 1e-6;
/// ... to this share of their standard error: another processor rounds sums differently.
const SAME_OF_STD: f64 = 1e-3;

#[test]
fn the_practice_cases_are_explained_as_before() {
    compare("cases");
}

#[test]
fn flights_with_an_estimator_are_explained_as_before() {
    if std::env::var("MAVID_REFERENCE").is_ok_and(|which| which == "all") || is_written_anew() {
        compare("noisy");
    }
}

fn is_written_anew() -> bool {
    std::env::var_os("MAVID_WRITE_REFERENCE").is_some()
}

fn compare(set: &str) {
    let Some(shared) = support::shared() else { return };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("fixtures/reference/{set}.txt"));
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(shared.join(set)).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.retain(|folder| folder.join("identify.tlog").is_file());
    folders.sort();
    let said: String = folders.iter().map(|folder| explained(folder)).collect();
    if is_written_anew() {
        std::fs::write(&path, said).unwrap();
        return;
    }
    let before = std::fs::read_to_string(&path).unwrap();
    let mut differing = Vec::new();
    for (now, then) in said.lines().zip(before.lines()) {
        if !is_same(now, then) {
            differing.push(format!("was: {then}\nis:  {now}"));
        }
    }
    assert_eq!(said.lines().count(), before.lines().count(), "{set}: lines");
    assert!(differing.is_empty(), "{set}:\n{}", differing.join("\n"));
}

/// One line a flight and verdict, then one a value: `flight name value std`.
fn explained(folder: &Path) -> String {
    let name = folder.file_name().unwrap().to_str().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .arg("explain")
        .arg(folder.join("identify.tlog"))
        .arg("--vehicle")
        .arg(folder.join("vehicle.toml"))
        .arg("--holdout")
        .arg(folder.join("holdout.tlog"))
        .arg("--json")
        .output()
        .unwrap();
    let document: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{name}: {error}: {}", String::from_utf8_lossy(&output.stderr)));
    let mut text = format!("{name} {}\n", document["verdict"].as_str().unwrap());
    for effect in document["effects"].as_array().unwrap() {
        let id = effect["id"].as_str().unwrap();
        for parameter in effect["parameters"].as_array().unwrap() {
            let of = format!("{id}.{}", parameter["name"].as_str().unwrap());
            line(&mut text, name, &of, parameter);
        }
        let others: Vec<&str> =
            effect["confusable_with"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
        if !others.is_empty() {
            writeln!(text, "{name} {id} may-be {}", others.join(",")).unwrap();
        }
    }
    for (of, parameter) in document["parameters"].as_object().unwrap() {
        line(&mut text, name, of, parameter);
    }
    text
}

fn line(text: &mut String, flight: &str, of: &str, parameter: &Value) {
    let number = |key: &str| parameter[key].as_f64().map_or("-".to_owned(), |value| format!("{value:.9e}"));
    writeln!(text, "{flight} {of} {} {}", number("value"), number("std")).unwrap();
}

/// Words are the same, and numbers agree.
fn is_same(now: &str, then: &str) -> bool {
    let (now, then): (Vec<&str>, Vec<&str>) = (now.split(' ').collect(), then.split(' ').collect());
    let numbers =
        |words: &[&str]| -> Vec<Option<f64>> { words.iter().map(|word| word.parse().ok()).collect() };
    let std = numbers(&then).last().copied().flatten().unwrap_or(0.0);
    now.len() == then.len()
        && numbers(&now).iter().zip(numbers(&then)).zip(now.iter().zip(&then)).all(
            |((a, b), (word, other))| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() <= (SAME * b.abs()).max(SAME_OF_STD * std),
                _ => word == other,
            },
        )
}
