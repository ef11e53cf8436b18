//! A report as one file of HTML: no scripts, nothing loaded from anywhere, light and dark, printable.

use super::InputFile;
use crate::text::markup;
use std::fmt::Write;

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

/// The whole file: what it is about, the answer, and everything below it.
pub(super) struct Page {
    title: String,
    body: String,
}

impl Page {
    pub(super) fn new(title: &str, answer: &str) -> Self {
        let body = format!("<h1>{}</h1>\n<p class=\"answer\">{}</p>\n", markup(title), markup(answer));
        Self { title: title.to_owned(), body }
    }

    pub(super) fn tags(&mut self, tags: &[String]) {
        let tags: Vec<String> = tags.iter().map(|tag| format!("<span>{}</span>", markup(tag))).collect();
        let _ = writeln!(self.body, "<p class=\"tags\">{}</p>", tags.concat());
    }

    pub(super) fn heading(&mut self, words: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", markup(words));
    }

    pub(super) fn note(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", markup(words));
    }

    pub(super) fn paragraph(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", markup(words));
    }

    pub(super) fn warning(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p class=\"warn\">{}</p>", markup(words));
    }

    /// `svg` is an element as the charts make it; without words below it where the caption is empty.
    pub(super) fn figure(&mut self, svg: &str, caption: &str) {
        let caption = match caption {
            "" => String::new(),
            words => format!("<figcaption>{}</figcaption>", markup(words)),
        };
        let _ = writeln!(self.body, "<figure>{svg}{caption}</figure>");
    }

    /// A heading that ends in `|` stands over numbers.
    pub(super) fn table(&mut self, caption: &str, heads: &[&str], rows: &[Vec<Cell>]) {
        if rows.is_empty() {
            return;
        }
        let heads: String = heads
            .iter()
            .map(|head| match head.strip_suffix('|') {
                Some(head) => format!("<th class=\"n\">{}</th>", markup(head)),
                None => format!("<th>{}</th>", markup(head)),
            })
            .collect();
        let rows: String = rows
            .iter()
            .map(|row| {
                let cells: String = row
                    .iter()
                    .map(|cell| match cell {
                        Cell::Text(text) => format!("<td>{}</td>", markup(text)),
                        Cell::Number(text) => format!("<td class=\"n\">{}</td>", markup(text)),
                    })
                    .collect();
                format!("<tr>{cells}</tr>\n")
            })
            .collect();
        let _ = writeln!(
            self.body,
            "<p class=\"cap\">{}</p><div class=\"wide\"><table><thead><tr>{heads}</tr></thead><tbody>\n{rows}</tbody></table></div>",
            markup(caption)
        );
    }

    /// What went in, by hash, and what made it.
    pub(super) fn provenance(&mut self, inputs: &[(&str, &InputFile)], settings: &[(String, String)]) {
        self.heading("Provenance");
        let rows: Vec<Vec<Cell>> = inputs
            .iter()
            .map(|(role, input)| vec![text(*role), text(input.path.as_str()), text(input.sha256.as_str())])
            .collect();
        self.table("Files that went in", &["role", "file", "SHA-256"], &rows);
        let mut rows = vec![vec![text("program"), text(format!("mavid {}", env!("CARGO_PKG_VERSION")))]];
        rows.extend(settings.iter().map(|(name, value)| vec![text(name.as_str()), text(value.as_str())]));
        self.table("Settings", &["setting", "value"], &rows);
    }

    pub(super) fn finish(self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
            markup(&self.title),
            self.body
        )
    }
}
