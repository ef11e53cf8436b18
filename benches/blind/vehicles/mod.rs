//! Several flights of one vehicle, with an estimator in the loop: pairs that are compared, eight that are put together, and
//! histories of forty.

mod histories;
mod made;
mod pairs;
mod together;

use std::path::PathBuf;

use crate::support::Arguments;

/// Runs what is asked for.
pub fn run(arguments: &Arguments) {
    let seed = arguments.number("--seed", 1_u64);
    if let Some(folder) = arguments.text("--write").map(PathBuf::from) {
        made::write(&folder, seed, arguments.number("--count", 40_u64), arguments.number("--flights", 2_u64));
        return;
    }
    let histories = arguments.number("--history", 0_u64);
    if histories > 0 {
        return histories::run(seed, histories, arguments.number("--shuffles", mavid::fleet::SHUFFLES));
    }
    let compared = arguments.number("--compared", 40_u64);
    if compared > 0 {
        pairs::run(seed, compared);
    }
    let vehicles = arguments.number("--together", 0_u64);
    if vehicles > 0 {
        together::run(seed, vehicles, arguments.number("--flights", 8_u64));
    }
}
