//! The parts of the book that are made from the code and from outputs of benchmarks, `docs/measured*.json`.
//!
//! `MAVID_WRITE_BOOK=1 cargo test --release --test book` writes them; without the variable the test compares.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

mod blocks;
mod comparison;
#[path = "../../benches/support/comparison.rs"]
mod comparison_figures;
mod effect_page;
mod figures;
mod fleet;
#[path = "../../benches/support/fleet.rs"]
mod fleet_figures;
mod identification;
#[path = "../../benches/support/identification.rs"]
mod identification_figures;
#[path = "../../benches/support/measured.rs"]
mod measured;
#[path = "../support/ordinary.rs"]
mod ordinary;
mod overview;
mod picture;
mod realistic;
#[path = "../../benches/support/realistic.rs"]
mod realistic_figures;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use mavid::physics::effects::ALL;
use measured::Measured;
use serde::de::DeserializeOwned;

/// What makes the generated parts anew.
const WRITE: &str = "MAVID_WRITE_BOOK=1 cargo test --release --test book";
/// What makes the measurements anew; the command itself stands in each file.
const MEASURED: &str = "docs/measured.json";
/// Those of flights with an estimator in the loop.
const REALISTIC: &str = "docs/measured-realistic.json";
/// Those of the other pages; a benchmark writes a section.
const IDENTIFICATION: &str = "docs/measured-identification.json";
const COMPARISON: &str = "docs/measured-comparison.json";
const FLEET: &str = "docs/measured-fleet.json";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The figures of a file.
fn stored<T: DeserializeOwned>(file: &str) -> T {
    serde_json::from_str(&read(&root().join(file))).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn measured() -> Measured {
    stored(MEASURED)
}

/// Every generated file with its text.
fn generated(measured: &Measured) -> BTreeMap<PathBuf, String> {
    let source = root().join("docs/src");
    let mut files = BTreeMap::new();
    for effect in ALL {
        let page = source.join("effects").join(effect.id());
        files.insert(page.with_extension("md"), effect_page::page(*effect, measured));
        files.extend(picture::svg_of(effect.id(), measured).map(|svg| (page.with_extension("svg"), svg)));
    }
    for (name, blocks) in [
        ("effects.md", vec![("effects", overview::table_of_effects())]),
        ("SUMMARY.md", vec![("effects", overview::contents())]),
        ("figures-diagnosis.md", [figures::blocks(measured), realistic::blocks(&stored(REALISTIC))].concat()),
        ("figures-identification.md", identification::blocks(&stored(IDENTIFICATION))),
        ("figures-comparison.md", comparison::blocks(&stored(COMPARISON))),
        ("figures-fleet.md", fleet::blocks(&stored(FLEET))),
    ] {
        let path = source.join(name);
        let text = blocks::replaced(&read(&path), &blocks).unwrap_or_else(|error| panic!("{name}: {error}"));
        files.insert(path, text);
    }
    files
}

#[test]
fn the_generated_parts_are_what_code_and_measurements_give() {
    let files = generated(&measured());
    if std::env::var_os("MAVID_WRITE_BOOK").is_some() {
        std::fs::create_dir_all(root().join("docs/src/effects")).unwrap();
        files.iter().for_each(|(path, text)| std::fs::write(path, text).unwrap());
    }
    let stale: Vec<String> = files
        .iter()
        .filter(|(path, text)| std::fs::read_to_string(path).ok().as_ref() != Some(*text))
        .map(|(path, _)| path.strip_prefix(root()).unwrap().display().to_string())
        .collect();
    assert!(stale.is_empty(), "not what the code and {MEASURED} give; run `{WRITE}`:\n{}", stale.join("\n"));
    let folder = std::fs::read_dir(root().join("docs/src/effects")).unwrap();
    let there: BTreeSet<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
    let unknown: Vec<_> = there.iter().filter(|path| !files.contains_key(*path)).collect();
    assert!(unknown.is_empty(), "files of no effect, to be deleted: {unknown:?}");
}

/// What is measured is an effect; the page of a new one says that it is not measured yet.
#[test]
fn what_is_measured_is_an_effect() {
    let measured = measured();
    let of_runs: BTreeSet<&str> = measured.effects.iter().map(|run| run.id.as_str()).collect();
    let known: BTreeSet<&str> = ALL.iter().map(|effect| effect.id()).collect();
    let gone: Vec<_> = of_runs.difference(&known).collect();
    assert!(
        gone.is_empty(),
        "{gone:?} of {MEASURED}: no effects; run `{}`, then `{WRITE}`",
        measured.command
    );
    let new: Vec<_> = known.difference(&of_runs).copied().collect();
    println!("not measured yet: {new:?}; `{}` does, then `{WRITE}`", measured.command);
    for effect in ALL.iter().filter(|effect| new.contains(&effect.id())) {
        assert!(effect_page::page(*effect, &measured).contains("Not measured."), "{}", effect.id());
    }
}

/// The README's claim is the measured one.
#[test]
fn the_readme_says_what_was_measured() {
    let clean = measured().clean;
    let readme = read(&root().join("README.md")).replace('\n', " ");
    let count = if clean.named == 0 { "none".to_owned() } else { clean.named.to_string() };
    let claim = format!("{count} of {} simulated flights without a concealed effect", clean.flights);
    assert!(readme.contains(&claim), "README.md: expected `{claim}`");
}
