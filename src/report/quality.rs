//! What a flight's signals rest on, for every report.

use super::html::{Cell, Page, number, text};
use super::number::with_error;
use crate::signals::Quality;

/// One flight's streams, offsets and what was left out.
pub(super) fn section(page: &mut Page, name: &str, quality: &Quality) {
    page.paragraph(&format!(
        "{name}: {:.1} s used; thrust from {}; {}.",
        quality.usable.usable_s,
        super::identification::thrust_name(quality.thrust_source),
        quality.usable.summary()
    ));
    let rows: Vec<Vec<Cell>> = quality
        .sources
        .iter()
        .map(|(quantity, message, rate_hz)| {
            let offset = quality.offsets.iter().find(|(of, _)| of == quantity).map(|(_, offset)| offset);
            let late = offset
                .map_or_else(|| "-".to_owned(), |offset| with_error(1e3 * offset.late_s, 1e3 * offset.std_s));
            let done = offset.map_or("", |offset| {
                if offset.repaired { "taken out" } else { "left in: not known well enough" }
            });
            vec![
                text(quantity.name().replace('_', " ")),
                text(*message),
                number(format!("{rate_hz:.1}")),
                number(late),
                text(done),
            ]
        })
        .collect();
    page.table(
        "Streams; late: against the inertial unit",
        &["quantity", "message", "Hz|", "late (ms)|", ""],
        &rows,
    );
    quality.notes.iter().for_each(|note| page.note(note));
}
