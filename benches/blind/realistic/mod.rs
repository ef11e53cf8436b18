//! Flights with an estimator in the loop: what is asked for, and how they are told, put down and scored.

mod answers;
mod judge;
mod report;
mod sanity;
#[path = "../../support/realistic.rs"]
mod stored;

use std::path::PathBuf;

use crate::maker::realistic::case::{EFFECTS, SEVERAL};
use crate::support::Arguments;
use judge::Request;

/// Runs what is asked for.
pub fn run(arguments: &Arguments) {
    let seed = arguments.number("--seed", 1_u64);
    if arguments.has("--sanity") {
        return sanity::tell(seed, arguments.number("--sanity", 34));
    }
    if let Some(folder) = arguments.text("--write").map(PathBuf::from) {
        return answers::write(&folder, seed, arguments.number("--flights", 29));
    }
    let only = arguments.text("--only");
    let all = only.is_none();
    let (cases, clean, several) = (
        arguments.number("--cases", 12_u64),
        arguments.number("--clean", if all { 60_u64 } else { 0 }),
        arguments.number("--several", if all { 24_u64 } else { 0 }),
    );
    let known = EFFECTS.iter().filter(|effect| only.as_ref().is_none_or(|only| only == *effect));
    let mut requests: Vec<Request> =
        (0..clean).map(|place| Request { seed: seed + place, entries: &[] }).collect();
    for effect in known {
        requests.extend(
            (0..cases).map(|place| Request { seed: seed + place, entries: std::slice::from_ref(effect) }),
        );
    }
    for (place, entries) in (0..several).zip(SEVERAL.iter().cycle()) {
        requests.push(Request { seed: seed + place, entries });
    }
    let judged = judge::all(&requests);
    let command = arguments.command("blind");
    let figures = report::figures((command, seed), &judged);
    report::tell(&figures);
    if let Some(file) = arguments.text("--out") {
        let text = serde_json::to_string_pretty(&figures).expect("figures as JSON");
        std::fs::write(file, text + "\n").expect("room for the figures");
    }
}
