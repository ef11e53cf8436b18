//! The parts of a report's page.
//!
//! Words become text of the page by their type: only markup of this module and of the charts is taken as it is.

use crate::study::InputFile;
use crate::text::unbroken;
use maud::{Markup, PreEscaped, html};

/// A line's end, for those who read the file.
pub(super) const BREAK: PreEscaped<&str> = PreEscaped("\n");

/// What tells a part of [`unbroken`] words that states an error.
const WITH_ERROR: &str = "+-\u{a0}";

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
    html! { section { h2 { (whole(heading)) } (BREAK) (content) } (BREAK) }
}

/// Sections that are folded until they are asked for, under one heading.
pub(super) fn folded(heading: &str, content: &Markup) -> Markup {
    html! { details.method { summary { h2 { (heading) } } (BREAK) (content) } (BREAK) }
}

/// Numbers that are folded until they are asked for, within a section. They are not printed.
pub(super) fn folded_numbers(words: &str, content: &Markup) -> Markup {
    html! { details.numbers { summary { (whole(words)) } (content) } (BREAK) }
}

pub(super) fn paragraph(words: &str) -> Markup {
    html! { p { (whole(words)) } (BREAK) }
}

pub(super) fn note(words: &str) -> Markup {
    html! { p.note { (whole(words)) } (BREAK) }
}

pub(super) fn warning(words: &str) -> Markup {
    html! { p.warn { (whole(words)) } (BREAK) }
}

/// A chart, with a caption if it is not empty.
pub(super) fn figure(chart: &Markup, caption: &str) -> Markup {
    html! { figure { (chart) @if !caption.is_empty() { figcaption { (whole(caption)) } } } (BREAK) }
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
            p.cap { (whole(caption)) }
            div.wide.stack tabindex="0" role="region" aria-label=(caption) { table {
                thead { tr { @for head in heads {
                    @if let Some(head) = head.strip_suffix('|') { th.n { (unbroken(head)) } } @else { th { (unbroken(head)) } }
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
        Cell::Text(words) => html! { td data-head=(head) { (whole(words)) } },
        Cell::Name(words) => html! { td.name data-head=(head) { (words) } },
        Cell::Number(words) => html! { td.n data-head=(head) { (unbroken(words)) } },
    }
}

/// Words in which a number with its error is whole also where any other word may be broken.
pub(super) fn whole(words: &str) -> Markup {
    html! {
        @for (place, part) in unbroken(words).split(' ').enumerate() {
            @if place > 0 { " " }
            @if part.contains(WITH_ERROR) { span.one { (part) } } @else { (part) }
        }
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
    fn no_number_parts_from_its_error_and_its_unit() {
        assert!(note("0.5 s").into_string().contains("0.5\u{a0}s"));
        assert!(table("c", &["h"], &[vec![name("imu_offset")]]).into_string().contains("class=\"name\""));
        assert!(section("by 3 mm", &Markup::default()).into_string().contains("by 3\u{a0}mm"));
        // where words may be broken anywhere, the number with its error may not
        let cell = table("c", &["h"], &[vec![text("about 1.0 +- 0.2 N (0.6 to 1.4), <b>")]]).into_string();
        let expected = "about <span class=\"one\">1.0\u{a0}+-\u{a0}0.2\u{a0}N</span> (0.6 to 1.4), &lt;b&gt;";
        assert!(cell.contains(expected), "{cell}");
        assert!(!table("c", &["h"], &[vec![text("0.2 N")]]).into_string().contains("<span"));
    }
}
