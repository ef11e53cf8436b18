//! The parts of a report's page.
//!
//! Words become text of the page by their type: only markup of this module and of the charts is taken as it is.

use crate::study::InputFile;
use maud::{Markup, PreEscaped, html};

/// A line's end, for those who read the file.
pub(super) const BREAK: PreEscaped<&str> = PreEscaped("\n");

/// Units, of which the number before them does not stand on another line.
const UNITS: [&str; 23] = [
    "%", "N", "m", "mm", "cm", "m/s", "m/s^2", "s", "ms", "1/s", "Hz", "kg", "g", "kg/m", "rad", "rad/s",
    "rad/s^2", "deg", "V", "A", "W", "sigma", "N/m",
];

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    /// words, to the left
    Text(String),
    /// one word that is never broken, to the left
    Name(String),
    /// a number, to the right
    Number(String),
}

pub(super) fn text(text: impl Into<String>) -> Cell {
    Cell::Text(text.into())
}

pub(super) fn name(text: impl Into<String>) -> Cell {
    Cell::Name(text.into())
}

pub(super) fn number(text: impl Into<String>) -> Cell {
    Cell::Number(text.into())
}

/// A section with its heading.
pub(super) fn section(heading: &str, content: &Markup) -> Markup {
    html! { section { h2 { (heading) } (BREAK) (content) } (BREAK) }
}

/// Sections that are folded until they are asked for, under one heading.
pub(super) fn folded(heading: &str, content: &Markup) -> Markup {
    html! { details.method { summary { h2 { (heading) } } (BREAK) (content) } (BREAK) }
}

/// Numbers that are folded until they are asked for, within a section. They are not printed.
pub(super) fn folded_numbers(words: &str, content: &Markup) -> Markup {
    html! { details.numbers { summary { (words) } (content) } (BREAK) }
}

/// Words in which a number, its error and its unit stand on one line.
pub(super) fn unbroken(words: &str) -> String {
    let mut out = String::with_capacity(words.len() + 16);
    let mut before = None;
    for word in words.split(' ') {
        if let Some(before) = before {
            out.push(if is_one(before, word) { '\u{a0}' } else { ' ' });
        }
        out.push_str(word);
        before = Some(word);
    }
    out
}

/// Whether two neighbours are parts of one quantity.
fn is_one(before: &str, word: &str) -> bool {
    let bare = word.trim_end_matches(['.', ',', ';', ':', ')']);
    match (before, bare) {
        ("+-", error) => is_number(error),
        ("N", "m") | ("kg", "m^2") => true,
        (value, "+-") => is_number(value),
        (value, unit) => is_number(value) && UNITS.contains(&unit),
    }
}

fn is_number(word: &str) -> bool {
    let digits = word.trim_start_matches(['(', '-', '+']);
    let is_digit = |letter: char| letter.is_ascii_digit();
    digits.starts_with(is_digit) && digits.ends_with(is_digit)
}

pub(super) fn paragraph(words: &str) -> Markup {
    html! { p { (unbroken(words)) } (BREAK) }
}

pub(super) fn note(words: &str) -> Markup {
    html! { p.note { (unbroken(words)) } (BREAK) }
}

pub(super) fn warning(words: &str) -> Markup {
    html! { p.warn { (unbroken(words)) } (BREAK) }
}

/// A chart, with a caption if it is not empty.
pub(super) fn figure(chart: &Markup, caption: &str) -> Markup {
    html! { figure { (chart) @if !caption.is_empty() { figcaption { (unbroken(caption)) } } } (BREAK) }
}

/// A table; nothing without rows. A heading that ends in `|` is above numbers. On a narrow screen each value stands after the
/// words of its column.
pub(super) fn table(caption: &str, heads: &[&str], rows: &[Vec<Cell>]) -> Markup {
    let head_of = |column: usize| {
        let head = heads.get(column).copied().unwrap_or_default();
        head.strip_suffix('|').unwrap_or(head)
    };
    html! {
        @if !rows.is_empty() {
            p.cap { (unbroken(caption)) }
            div.wide.stack tabindex="0" role="region" aria-label=(caption) { table {
                thead { tr { @for head in heads {
                    @if let Some(head) = head.strip_suffix('|') { th.n { (head) } } @else { th { (head) } }
                } } }
                tbody { (BREAK) @for row in rows {
                    tr { @for (column, cell) in row.iter().enumerate() { (cell_markup(cell, head_of(column))) } } (BREAK)
                } }
            } }
            (BREAK)
        }
    }
}

fn cell_markup(cell: &Cell, head: &str) -> Markup {
    match cell {
        Cell::Text(words) => html! { td data-head=(head) { (unbroken(words)) } },
        Cell::Name(words) => html! { td.name data-head=(head) { (words) } },
        Cell::Number(words) => html! { td.n data-head=(head) { (unbroken(words)) } },
    }
}

/// Inputs with hashes, settings, and the program.
pub(super) fn provenance(inputs: &[(&str, &InputFile)], settings: &[(&str, String)]) -> Markup {
    let files: Vec<Vec<Cell>> = inputs
        .iter()
        .flat_map(|(role, input)| {
            input.files().map(|(path, sha256)| vec![text(*role), text(path), text(sha256)])
        })
        .collect();
    let mut rows = vec![vec![text("program"), text(format!("mavid {}", env!("CARGO_PKG_VERSION")))]];
    rows.extend(settings.iter().map(|(name, value)| vec![text(*name), text(value.as_str())]));
    let content = html! {
        (table("Files that went in", &["role", "file", "SHA-256"], &files))
        (table("Settings", &["setting", "value"], &rows))
    };
    section("Provenance", &content)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::page::page;

    #[test]
    fn words_never_become_markup() {
        let words = "<b>\u{1b}[31m&\"'";
        let content = html! { (table(words, &[words], &[vec![text(words), number(words)]])) (note(words)) };
        let file = page(words, words, &[words.to_owned()], &section(words, &content));
        assert!(!file.contains("<b>") && !file.contains('\u{1b}'), "{file}");
        // the title twice, the answer, a tag, the heading, the caption twice, the head, its cell, both cells, the note
        assert_eq!(file.matches("&lt;b&gt;\\u{1b}[31m&amp;").count(), 12, "{file}");
        assert!(file.starts_with("<!DOCTYPE html>\n<html lang=\"en\">") && file.ends_with("</html>\n"));
        assert_eq!(table("c", &["h"], &[]).into_string(), "");
    }

    #[test]
    fn a_number_stands_beside_its_error_and_its_unit() {
        let shown = |words: &str| unbroken(words).replace('\u{a0}', "~");
        assert_eq!(shown("drag (1.17 +- 0.02 across), by 97 %."), "drag (1.17~+-~0.02 across), by 97~%.");
        assert_eq!(shown("0.040 +- 0.003 N m per rad/s"), "0.040~+-~0.003~N~m per rad/s");
        assert_eq!(
            shown("izz -0.0003 +- 0.0004 kg m^2; 14 % (51 to 56 %)"),
            "izz -0.0003~+-~0.0004~kg~m^2; 14~% (51 to 56~%)"
        );
        // other words are broken as before
        assert_eq!(
            shown("motor 2 (rear left), 2 flights +- few  a"),
            "motor 2 (rear left), 2 flights +- few  a"
        );
        assert!(note("0.5 s").into_string().contains("0.5\u{a0}s"));
        assert!(table("c", &["h"], &[vec![name("imu_offset")]]).into_string().contains("class=\"name\""));
    }
}
