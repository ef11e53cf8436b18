//! Runs the scripts of `tests/peers`.

#![allow(dead_code, clippy::unwrap_used)] // no user uses all of it

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

/// Exit status of a script whose package is missing.
const MISSING: i32 = 77;

/// The interpreter: `MAVID_PYTHON`, that of `tests/peers/setup.sh`, or the system's.
pub fn interpreter() -> PathBuf {
    if let Some(python) = std::env::var_os("MAVID_PYTHON") {
        return python.into();
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let made = target.join("peers/bin/python");
    if made.is_file() { made } else { "python3".into() }
}

/// What a script of `tests/peers` answers; an error says why there is no answer because something is
/// missing.
///
/// # Panics
/// Where the script fails.
pub fn ask(script: &str, arguments: &[&str], given: &Value) -> Result<Value, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(script);
    let child = Command::new(interpreter())
        .arg(path)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = child.map_err(|error| format!("{} does not run: {error}", interpreter().display()))?;
    let mut stdin = child.stdin.take().unwrap();
    // a script that stops early closes its end: its status tells
    let _ = stdin.write_all(given.to_string().as_bytes());
    drop(stdin);
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    if output.status.code() == Some(MISSING) {
        return Err(format!("{said} (looked for by {})", interpreter().display()));
    }
    assert!(output.status.success(), "{script}: {said}");
    Ok(serde_json::from_slice(&output.stdout).unwrap())
}

/// A flat list of numbers.
pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}
