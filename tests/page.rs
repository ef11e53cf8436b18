//! The report's page in headless Chromium: three widths, light and dark, and paper.
//!
//! `tests/browser/setup.sh` brings the browser. Pictures are left in `target/pages` to be looked at.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "support/require.rs"]
mod require;

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::report::explanation_html;
use mavid::study::{ExplainRequest, Silent, explain};
use require::{Needed, skip};
use serde_json::Value;

/// Exit status of the script where no browser can be started.
const MISSING: i32 = 77;
/// Largest page, bytes.
const LARGEST: u64 = 1_000_000;
/// Most sheets of paper.
const SHEETS: u64 = 4;

fn target() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}

/// What the browser says of a page; `Err`: why there is none.
fn look(page: &Path, out: &Path) -> Result<Value, String> {
    let packages = target().join("browser");
    if !packages.join("ready").is_file() {
        return Err(format!("no headless Chromium in {}: run tests/browser/setup.sh", packages.display()));
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/look.mjs");
    let looked =
        Command::new("node").arg(script).args([&packages, &page.to_owned(), &out.to_owned()]).output();
    let looked = looked.map_err(|error| format!("node does not run: {error}"))?;
    let said = String::from_utf8_lossy(&looked.stderr).trim().to_owned();
    if looked.status.code() == Some(MISSING) {
        return Err(format!("Chromium does not start: {said}"));
    }
    assert!(looked.status.success(), "look.mjs: {said}");
    Ok(serde_json::from_slice(&looked.stdout).unwrap())
}

fn written() -> (PathBuf, PathBuf) {
    let request = ExplainRequest {
        logs: vec![PathBuf::from("fixtures/p01_identify_0_25s.tlog")],
        vehicle: PathBuf::from("fixtures/p01_vehicle.toml").into(),
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    let out = target().join("pages");
    std::fs::create_dir_all(&out).unwrap();
    let page = out.join("report.html");
    std::fs::write(&page, explanation_html(&explain(&request, &Silent).unwrap())).unwrap();
    (page, out)
}

#[test]
fn a_report_is_legible_on_phone_desktop_and_paper() {
    let (page, out) = written();
    let text = std::fs::read_to_string(&page).unwrap();
    assert!(std::fs::metadata(&page).unwrap().len() < LARGEST, "{} bytes", text.len());
    // one file: nothing in it names another
    for outside in ["src=", "<link", "@import", "url("] {
        assert!(!text.contains(outside), "{outside}");
    }
    // without its script each plot is a drawing, with words for those who do not see it
    let plots = text.matches("<div class=\"plot\">").count();
    assert!(plots >= 2 && text.matches("<svg").count() > plots, "{plots}");
    assert_eq!(text.matches("<svg").count(), text.matches("role=\"img\"").count());
    let seen = match look(&page, &out) {
        Ok(seen) => seen,
        Err(why) => return skip(Needed::Browser, &why),
    };
    assert_eq!(seen["console"], Value::Array(Vec::new()), "the console is silent");
    assert_eq!(
        seen["requests"].as_array().unwrap().len(),
        1,
        "nothing but the page is loaded: {}",
        seen["requests"]
    );
    for (picture, wrong) in seen["seen"].as_object().unwrap() {
        assert_eq!(*wrong, Value::Array(Vec::new()), "{picture}: see {}", out.display());
    }
    assert!(seen["plots"].as_u64().unwrap() >= 2, "{seen}");
    assert_eq!(seen["turns"], 1, "{seen}");
    assert!(
        seen["cursor"].as_str().unwrap().starts_with("At "),
        "a click on the path shows the time: {seen}"
    );
    if let Some(sheets) = seen["pages"].as_u64() {
        assert!((1..=SHEETS).contains(&sheets), "{sheets} sheets of paper");
    }
}
