//! Several flights of one vehicle, with an estimator in the loop: pairs that are compared (`--compared N`), eight that are
//! explained together (`--together N`), and histories of forty (`--history N`, with `--keep DIR` resumable). `--out FILE` stores the figures in sections of a
//! file, of which the book is made.

mod histories;
mod made;
mod pairs;
mod pooled;

use std::path::PathBuf;

use crate::support::Arguments;
use crate::support::comparison::{Pairs, Pooled};
use crate::support::fleet::Histories;
use crate::support::sections::store;

/// Runs what is asked for.
pub fn run(arguments: &Arguments) {
    let seed = arguments.number("--seed", 1_u64);
    if let Some(folder) = arguments.text("--write").map(PathBuf::from) {
        made::write(&folder, seed, arguments.number("--count", 40_u64), arguments.number("--flights", 2_u64));
        return;
    }
    let out = arguments.text("--out");
    let command = arguments.command("blind");
    let histories = arguments.number("--history", 0_u64);
    if histories > 0 {
        let shuffles = arguments.number("--shuffles", mavid::fleet::SHUFFLES);
        let keep = arguments.text("--keep").map(PathBuf::from);
        let figures = Histories { command, ..histories::run(seed, histories, (shuffles, keep.as_deref())) };
        return out.iter().for_each(|file| store(file, "histories", &figures));
    }
    let compared = arguments.number("--compared", 40_u64);
    if compared > 0 {
        let figures = Pairs { command: command.clone(), ..pairs::run(seed, compared) };
        out.iter().for_each(|file| store(file, "pairs", &figures));
    }
    let vehicles = arguments.number("--together", 0_u64);
    if vehicles > 0 {
        let figures = Pooled { command, ..pooled::run(seed, vehicles, arguments.number("--flights", 8_u64)) };
        out.iter().for_each(|file| store(file, "pooled", &figures));
    }
}
