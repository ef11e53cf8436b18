//! The parts of a summary in Markdown.

use super::bare::{bare, file_name};
use crate::note::{About, Note};
use crate::text::unbroken;
use std::fmt::Write;

/// A note as a quotation, with files by their names alone.
pub(super) fn remark(page: &mut String, note: &Note, known: &[&str]) {
    quoted(page, &sentence(note, known));
}

/// Words as a quotation.
pub(super) fn quoted(page: &mut String, words: &str) {
    // writing to a String cannot fail
    let _ = write!(page, "\n> {}\n", escaped(words));
}

/// What a note says, with files by their names alone.
fn sentence(note: &Note, known: &[&str]) -> String {
    match &note.about {
        About::File(names) => {
            let names = bare(names, known);
            let names: Vec<&str> = names.split(' ').map(file_name).collect();
            format!("{}: {}", names.join(" "), bare(&note.text, known))
        }
        _ => bare(&note.sentence(), known),
    }
}

/// Text that Markdown takes as text, on one line, and in which no number parts from its error and unit.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in unbroken(text).chars() {
        match letter {
            '<' => out.push_str("&lt;"),
            '&' => out.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '~' | '#' => out.extend(['\\', letter]),
            _ if letter.is_control() => out.push(' '),
            _ => out.push(letter),
        }
    }
    out
}

/// A table; nothing without rows.
pub(super) fn table(page: &mut String, heads: &[&str], rows: &[Vec<String>]) {
    if rows.is_empty() {
        return;
    }
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let heads: Vec<String> = heads.iter().map(|head| (*head).to_owned()).collect();
    let rules: Vec<String> = heads.iter().map(|_| "---".to_owned()).collect();
    page.push('\n');
    page.push_str(&line(&heads));
    page.push_str(&line(&rules));
    for row in rows {
        page.push_str(&line(&row.iter().map(|cell| escaped(cell)).collect::<Vec<_>>()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_stand_without_their_folders() {
        let known = ["/work/my logs/ap 12.bin", "m/radio.tlog, flight 2", "a.ulg", "C:\\logs\\b.bin"];
        let of = |text: &str| bare(text, &known);
        assert_eq!(of("read /work/my logs/ap 12.bin (slowly)"), "read ap 12.bin (slowly)");
        assert_eq!(of("m/radio.tlog: 2 m/s, 0.3 N/(m/s)"), "radio.tlog: 2 m/s, 0.3 N/(m/s)");
        assert_eq!(of("a.ulg and (/home/me/c.bin) and ../d.bin"), "a.ulg and (c.bin) and d.bin");
        assert_eq!(of("C:\\logs\\b.bin, D:\\e.bin"), "b.bin, e.bin");
        let note = Note::warning(About::File("logs/x.bin, m/radio.tlog".to_owned()), "slow: 3 m/s");
        assert_eq!(sentence(&note, &known), "x.bin, radio.tlog: slow: 3 m/s");
        assert_eq!(sentence(&Note::remark(About::Vehicle, "at /"), &known), "at /");
    }

    #[test]
    fn words_of_others_stay_words() {
        assert_eq!(escaped("a|b `c` <i>\n[x](y) _z_"), "a\\|b \\`c\\` &lt;i> \\[x\\](y) \\_z\\_");
        assert_eq!(escaped("0.3 +- 0.1 N"), "0.3\u{a0}+-\u{a0}0.1\u{a0}N");
        let mut page = String::new();
        table(&mut page, &["h", "i"], &[vec!["1|2".to_owned(), "x".to_owned()]]);
        assert_eq!(page, "\n| h | i |\n| --- | --- |\n| 1\\|2 | x |\n");
        table(&mut page, &["h"], &[]);
        assert_eq!(page.lines().count(), 4);
    }
}
