//! What `explain` names on simulated flights: false names where nothing is concealed, right names where
//! something is, and the smallest sizes that it would have named.
//!
//! `cargo bench --bench explain -- [--clean N] [--each N] [--limits N] [--pairs N] [--seed S] [--only EFFECT] [--fed-back]
//! [--askew] [--out FILE]`, with `SHOW=SEED` for the steps of one search and `RUST_LOG=mavid=info` for its events: `--fed-back` has the controller fly on the noise that is logged, `--askew` leans every thrust
//! axis by 0.2 degrees, which is no finding. `--out` writes the results, with a picture of each effect, as JSON: the book's
//! figures are made from `docs/measured.json`.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a benchmark prints"
)]

mod clean;
mod effects;
mod flights;
mod limits;
#[path = "../support/measured.rs"]
mod measured;
#[path = "../../tests/support/ordinary.rs"]
mod ordinary;
mod pairs;
mod pictures;
mod search_steps;
#[path = "../support/mod.rs"]
mod support;

use flights::Conditions;
use measured::Measured;
use ordinary::ORDINARY;
use support::Arguments;
use tracing_subscriber::EnvFilter;

fn main() {
    tracing_subscriber::fmt().with_env_filter(EnvFilter::from_default_env()).init();
    let arguments = Arguments::of_process();
    let (first, each) = (arguments.number("--seed", 1), arguments.number("--each", 6));
    let conditions = Conditions {
        fed_back: arguments.has("--fed-back"),
        askew: arguments.has("--askew"),
        ..Conditions::default()
    };
    let clean = clean::run(first, arguments.number("--clean", 60), conditions);
    let limits = limits::run(first, arguments.number("--limits", 24));
    let pairs = pairs::run(first, arguments.number("--pairs", 0));
    let only = arguments.text("--only");
    println!(
        "\neffect               flights  named  set  trace  others  verdicts; median relative size error %"
    );
    let chosen = || ORDINARY.iter().filter(|entry| only.as_ref().is_none_or(|only| only == entry.id));
    let effects = chosen().map(|entry| effects::run(entry, first, each)).collect();
    let Some(out) = arguments.text("--out") else { return };
    let pictures = chosen().filter_map(|entry| pictures::picture(entry, first)).collect();
    let command = arguments.command("explain");
    let measured = Measured { command, seed: first, clean, effects, pairs, limits, pictures };
    let text = serde_json::to_string(&measured).expect("numbers and words");
    // one entry a line: changes can be read
    let text = text.replace("},{", "},\n{").replace(":[{", ":[\n{");
    std::fs::write(&out, text + "\n").unwrap_or_else(|error| panic!("{out}: {error}"));
}
