//! What `explain` says of flights that another maker made: other formulae, another integrator, another controller,
//! a log as a ground station writes it. Nothing here knows the library's physics.
//!
//! `cargo bench --bench blind -- [--cases N per effect] [--clean N] [--pairs N] [--outside N] [--seed S] [--only EFFECT]
//! [--write DIR]`: `--write` puts the flights down as cases with their answers, which `mavid prove` scores. Every wrong
//! answer is told with its seed and what was true; with `BLIND_TELL` in the environment the right ones are as well.
//!
//! With `--realistic` the controller flies on what an estimator believes, and the telemetry carries that belief. The
//! flights are scored as practice flights are; `--cases` is the number of flights an effect, `--several` of those with
//! two and four effects, `--out FILE` stores the figures, `--sanity N` tells how N estimators err, `--write DIR` puts N
//! flights (`--flights N`) down as cases. `BLIND_KEEP=DIR` in the environment keeps the flights that are not answered
//! right.
//!
//! Vehicle, conditions and noise are the seed's, whatever is concealed: what one seed's noise makes look like an
//! effect may be named beside several entries, and is one event.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod maker;
mod realistic;
mod score;
#[path = "../support/mod.rs"]
mod support;
mod vehicles;
mod write;

use std::path::PathBuf;

use maker::catalogue::{CONTROLS, Case, EFFECTS, OUTSIDE, PAIRS};
use score::{clean, effects, outside, pairs};
use support::Arguments;

/// What is asked for.
struct Request {
    cases: u64,
    clean: u64,
    pairs: u64,
    outside: u64,
    seed: u64,
    only: Option<String>,
    write: Option<PathBuf>,
}

fn main() {
    if Arguments::of_process().has("--vehicles") {
        return vehicles::run(&Arguments::of_process());
    }
    if Arguments::of_process().has("--realistic") {
        return realistic::run(&Arguments::of_process());
    }
    let request = request();
    let wanted = |entry: &&&'static str| {
        request
            .only
            .as_ref()
            .is_none_or(|only| **entry == only || maker::catalogue::identifier(entry) == only)
    };
    let seeds = |count: u64| (request.seed..request.seed + count).collect::<Vec<_>>();
    let known: Vec<&'static str> = EFFECTS.iter().filter(wanted).copied().collect();
    let unknown: Vec<&'static str> = OUTSIDE.iter().filter(wanted).copied().collect();
    if let Some(folder) = &request.write {
        let mut cases: Vec<Case> = Vec::new();
        cases.extend(seeds(request.clean).into_iter().map(|seed| Case::new(seed, &[])));
        let each = |entries: &[&'static str], count| {
            seeds(count).into_iter().map(|seed| Case::new(seed, entries)).collect::<Vec<_>>()
        };
        cases.extend(known.iter().flat_map(|entry| each(&[entry], request.cases)));
        cases.extend(unknown.iter().flat_map(|entry| each(&[entry], request.outside)));
        cases.extend(PAIRS.iter().flat_map(|pair| each(pair, request.pairs.div_ceil(10))));
        write::write(folder, &cases);
        return;
    }
    if request.cases > 0 {
        effects(&known, &seeds(request.cases));
    }
    if request.clean > 0 {
        clean(&[], &seeds(request.clean));
        for control in CONTROLS {
            clean(&[*control], &seeds(request.clean.div_ceil(4)));
        }
    }
    if request.pairs > 0 {
        pairs(request.seed, request.pairs);
    }
    if request.outside > 0 && !unknown.is_empty() {
        outside(&unknown, &seeds(request.outside));
    }
}

/// Reads the arguments.
fn request() -> Request {
    let arguments = Arguments::of_process();
    let only = arguments.text("--only");
    let all = only.is_none();
    Request {
        cases: arguments.number("--cases", 6),
        clean: arguments.number("--clean", if all { 20 } else { 0 }),
        pairs: arguments.number("--pairs", if all { 10 } else { 0 }),
        outside: arguments.number("--outside", 6),
        seed: arguments.number("--seed", 1),
        only,
        write: arguments.text("--write").map(PathBuf::from),
    }
}
