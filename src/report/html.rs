//! The parts of a report: one file of HTML, no scripts, nothing loaded from anywhere, light and dark, printable.
//!
//! Words become text of the page by their type: only markup of this module and of the charts is taken as it is.

use crate::study::InputFile;
use crate::text::clean_lines;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#1d1f23;--soft:#5b6068;--line:#d9dce1;--page:#fff;--card:#f6f7f9;--mark:#0072b2}\
@media(prefers-color-scheme:dark){:root{--ink:#e6e7ea;--soft:#a2a7b0;--line:#3a3e46;--page:#15171b;--card:#1d2025;--mark:#56b4e9}}\
*{box-sizing:border-box}\
body{margin:0 auto;padding:1.5rem 1.25rem 4rem;max-width:62rem;font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--page)}\
h1{font-size:1.05rem;color:var(--soft);font-weight:600;margin:0 0 .6rem}\
h2{font-size:1.1rem;margin:2.2rem 0 .6rem;border-top:1px solid var(--line);padding-top:.9rem}\
.answer{font-size:1.35rem;line-height:1.4;margin:0 0 1rem;border-left:4px solid var(--mark);padding-left:.9rem}\
.tags span{display:inline-block;background:var(--card);border:1px solid var(--line);border-radius:.3rem;padding:.05rem .5rem;margin:0 .4rem .3rem 0;font-size:.85rem}\
p.note,figcaption,td.why{color:var(--soft);font-size:.9rem}\
p.warn{border-left:4px solid #d55e00;padding-left:.7rem}\
figure{margin:1rem 0}\
svg{display:block;width:100%;height:auto;max-width:52rem;font:11px system-ui,sans-serif;color:var(--ink)}\
.wide{overflow-x:auto}\
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums;margin:.4rem 0 1rem}\
p.cap{color:var(--soft);font-size:.9rem;margin:1rem 0 0;break-after:avoid}\
th,td{padding:.2rem .8rem .2rem 0;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}\
td.n,th.n{text-align:right}\
td.n{white-space:nowrap}\
@media(max-width:40rem){body{padding:1rem .8rem 3rem}.answer{font-size:1.15rem}figure{overflow-x:auto}svg{min-width:34rem}}\
code{font-size:.85rem;overflow-wrap:anywhere}\
@media print{body{max-width:none;font-size:11pt;color:#000;background:#fff}:root{--ink:#000;--soft:#444;--line:#bbb;--page:#fff;--card:#fff}figure,table,tr{break-inside:avoid}h2{break-after:avoid}}";

/// A line's end, for those who read the file.
const BREAK: PreEscaped<&str> = PreEscaped("\n");

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    /// words, to the left
    Text(String),
    /// a number, to the right
    Number(String),
}

pub(super) fn text(text: impl Into<String>) -> Cell {
    Cell::Text(text.into())
}

pub(super) fn number(text: impl Into<String>) -> Cell {
    Cell::Number(text.into())
}

/// The whole file: title, answer, tags and sections.
pub(super) fn page(title: &str, answer: &str, tags: &[String], sections: &Markup) -> String {
    let page = html! {
        (DOCTYPE) (BREAK)
        html lang="en" { (BREAK)
            head { (BREAK)
                meta charset="utf-8"; (BREAK)
                meta name="viewport" content="width=device-width, initial-scale=1"; (BREAK)
                title { (title) } (BREAK)
                style { (PreEscaped(STYLE)) } (BREAK)
            }
            (BREAK)
            body { (BREAK)
                h1 { (title) } (BREAK)
                p.answer { (answer) } (BREAK)
                p.tags { @for tag in tags { span { (tag) } } } (BREAK)
                (sections)
            }
            (BREAK)
        }
        (BREAK)
    };
    clean_lines(&page.into_string()).into_owned()
}

/// A section with its heading.
pub(super) fn section(heading: &str, content: &Markup) -> Markup {
    html! { h2 { (heading) } (BREAK) (content) }
}

pub(super) fn paragraph(words: &str) -> Markup {
    html! { p { (words) } (BREAK) }
}

pub(super) fn note(words: &str) -> Markup {
    html! { p.note { (words) } (BREAK) }
}

pub(super) fn warning(words: &str) -> Markup {
    html! { p.warn { (words) } (BREAK) }
}

/// A chart, with a caption if it is not empty.
pub(super) fn figure(chart: &Markup, caption: &str) -> Markup {
    html! { figure { (chart) @if !caption.is_empty() { figcaption { (caption) } } } (BREAK) }
}

/// A table; nothing without rows. A heading that ends in `|` is above numbers.
pub(super) fn table(caption: &str, heads: &[&str], rows: &[Vec<Cell>]) -> Markup {
    html! {
        @if !rows.is_empty() {
            p.cap { (caption) }
            div.wide { table {
                thead { tr { @for head in heads {
                    @if let Some(head) = head.strip_suffix('|') { th.n { (head) } } @else { th { (head) } }
                } } }
                tbody { (BREAK) @for row in rows {
                    tr { @for cell in row { (cell_markup(cell)) } } (BREAK)
                } }
            } }
            (BREAK)
        }
    }
}

fn cell_markup(cell: &Cell) -> Markup {
    match cell {
        Cell::Text(words) => html! { td { (words) } },
        Cell::Number(words) => html! { td.n { (words) } },
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

    #[test]
    fn words_never_become_markup() {
        let words = "<b>\u{1b}[31m&\"'";
        let content = html! { (table(words, &[words], &[vec![text(words), number(words)]])) (note(words)) };
        let file = page(words, words, &[words.to_owned()], &section(words, &content));
        assert!(!file.contains("<b>") && !file.contains('\u{1b}'), "{file}");
        assert_eq!(file.matches("&lt;b&gt;\\u{1b}[31m&amp;").count(), 10, "{file}");
        assert!(file.starts_with("<!DOCTYPE html>\n<html lang=\"en\">") && file.ends_with("</html>\n"));
        assert_eq!(table("c", &["h"], &[]).into_string(), "");
    }
}
