//! Data quality of a flight, for every report.

use super::html::{Cell, note, number, paragraph, section, table, text};
use super::number::with_error;
use super::thrust_source::thrust_name;
use crate::signals::Quality;
use maud::{Markup, html};

/// Each flight's streams, offsets and what was left out, under the name of its file.
pub(super) fn data_quality<'a>(flights: impl Iterator<Item = (&'a str, &'a Quality)>) -> Markup {
    let content = html! { @for (name, quality) in flights { (one(name, quality)) } };
    section("Data quality", &content)
}

fn one(name: &str, quality: &Quality) -> Markup {
    let used = format!(
        "{name}: {:.1} s used; thrust from {}; {}.",
        quality.usable.usable_s,
        thrust_name(quality.thrust_source),
        quality.usable.summary()
    );
    let rows: Vec<Vec<Cell>> = quality
        .sources
        .iter()
        .map(|(quantity, message, rate_hz)| {
            let offset = quality.offsets.iter().find(|(of, _)| of == quantity).map(|(_, offset)| offset);
            let determined = offset.filter(|offset| offset.std_s.is_finite());
            let late = determined
                .map_or_else(|| "-".to_owned(), |offset| with_error(1e3 * offset.late_s, 1e3 * offset.std_s));
            let done = offset.map_or("", |offset| {
                if offset.repaired { "taken out" } else { "not corrected: not known well enough" }
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
    html! {
        (paragraph(&used))
        (table(
            "Streams; late: against the inertial unit",
            &["quantity", "message", "Hz|", "late (ms)|", ""],
            &rows,
        ))
        @for said in &quality.notes { (note(&said.to_string())) }
    }
}
