//! What is fuzzed: one function for each target, from an input's bytes to a panic where a law is broken.
//!
//! The targets of libFuzzer (`targets/`) call these functions, and so do their twins in `tests/link/fuzz_twins.rs`,
//! which replay the corpus and add seeded mutations. A seeded bug is a fault of the harness, not of the program:
//! it breaks a law in one rare place and shows that the fuzzer gets there.

mod bytes;
mod csv;
mod damage;
mod dataflash;
mod explain;
mod flight;
mod frames;
mod identify;
mod recorded;
mod signing;
mod splitter;
mod tlog;
mod toml;
mod ulog;

/// What a target does with an input; the second argument puts the target's seeded bug in.
pub type Run = fn(&[u8], bool);

/// One thing that is fuzzed.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// as in `targets/` and `corpus/`
    pub name: &'static str,
    /// panics where a law is broken
    pub run: Run,
}

/// All targets.
pub const TARGETS: [Target; 10] = [
    Target { name: "splitter", run: splitter::run },
    Target { name: "tlog", run: tlog::run },
    Target { name: "ulog", run: ulog::run },
    Target { name: "dataflash", run: dataflash::run },
    Target { name: "csv", run: csv::run },
    Target { name: "toml", run: toml::run },
    Target { name: "signing", run: signing::run },
    Target { name: "flight", run: flight::run },
    Target { name: "identify", run: identify::run },
    Target { name: "explain", run: explain::run },
];

/// The environment variable that puts the seeded bug in.
pub const SEEDED_BUG: &str = "MAVID_FUZZ_SEEDED_BUG";

/// Runs one target as libFuzzer wants it.
pub fn fuzz(name: &str, data: &[u8]) {
    let target = TARGETS.iter().find(|target| target.name == name);
    let seeded = std::env::var_os(SEEDED_BUG).is_some();
    (target.expect("a target of this name").run)(data, seeded);
}
