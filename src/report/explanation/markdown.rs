//! A summary in Markdown, to paste into a forum or an issue: no paths, no positions.

use super::answer::answer;
use super::motor::motor;
use super::text::after;
use crate::diagnose::called;
use crate::note::{About, Note};
use crate::report::bare::{bare, file_name};
use crate::report::number::{percent, significant, spoken, with_error};
use crate::study::{ExplainStudy, Predicted, QUANTITIES, ValidationData};
use std::fmt::Write;

/// The summary.
#[must_use]
pub fn explanation_markdown(study: &ExplainStudy) -> String {
    let files = files(study);
    let mut page = format!("**{}**\n", escaped(&bare(&answer(study), &files)));
    named(&mut page, study);
    better(&mut page, study, &files);
    body(&mut page, study);
    for said in &study.notes {
        let _ = write!(page, "\n> {}\n", escaped(&sentence(said, &files)));
    }
    let flights: Vec<String> = study
        .given
        .inputs
        .iter()
        .map(|input| {
            let name = file_name(&input.path);
            let hash: String = input.sha256.chars().take(12).collect();
            format!("`{}` (SHA-256 {hash}...)", name.replace('`', "'"))
        })
        .collect();
    let _ = write!(
        page,
        "\nVehicle: {}. Flights: {}. Program: mavid {}, `mavid explain --format md`.\n",
        escaped(&study.given.vehicle.name),
        flights.join(", "),
        env!("CARGO_PKG_VERSION")
    );
    page
}

/// The files of an answer, by their names as given.
fn files(study: &ExplainStudy) -> Vec<&str> {
    let held_out = match &study.shown_on {
        ValidationData::Flights(inputs) => inputs.as_slice(),
        _ => &[],
    };
    let inputs = study.given.inputs.iter().chain(held_out);
    inputs
        .flat_map(|input| {
            std::iter::once(&input.path)
                .chain(input.other_logs.iter().map(|(path, _)| path))
                .map(String::as_str)
        })
        .collect()
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

/// Text that Markdown takes as text, on one line.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
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

fn table(page: &mut String, heads: &[&str], rows: &[Vec<String>]) {
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

fn named(page: &mut String, study: &ExplainStudy) {
    let mut rows = Vec::new();
    for effect in &study.effects {
        for p in &effect.parameters {
            let (value, unit) = match motor(study, effect, p.name) {
                Some(motor) => (motor, String::new()),
                None => (with_error(p.value, p.std), spoken(p.unit).to_string()),
            };
            rows.push(vec![called(effect.id).to_owned(), p.name.to_owned(), value, unit]);
        }
    }
    table(page, &["effect", "parameter", "value", "unit"], &rows);
}

fn better(page: &mut String, study: &ExplainStudy, files: &[&str]) {
    let (predicted, on) = match &study.holdout {
        Some(of) => (Some(of), study.shown_on.heading()),
        None => (study.identify.as_ref(), "flights explained".to_owned()),
    };
    let rows = predicted.map_or_else(Vec::new, rows_of);
    if !rows.is_empty() {
        let _ = write!(page, "\nError of a prediction over 0.5 s ({}):\n", escaped(&bare(&on, files)));
    }
    let columns = ["", "unchanged", "rigid body", "model found", "better by", "unit"];
    table(page, &columns, &rows);
    if !rows.is_empty() {
        page.push_str("\nunchanged: a state that does not change; better by: than the better one of it and the rigid body\n");
    }
}

fn rows_of(predicted: &Predicted) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let Some(of) = predicted.at_half_second() else { return rows };
    for (compared, (name, unit)) in of.quantities().iter().zip(QUANTITIES) {
        let Some(compared) = compared else { continue };
        rows.push(vec![
            name.to_owned(),
            compared.unchanged.map_or_else(|| "-".to_owned(), |of| significant(of.value, 3)),
            significant(compared.before.value, 3),
            significant(compared.after.value, 3),
            percent(&compared.improvement_percent),
            unit.to_owned(),
        ]);
    }
    rows
}

fn body(page: &mut String, study: &ExplainStudy) {
    let rows: Vec<Vec<String>> = study
        .body()
        .iter()
        .map(|of| vec![of.name.to_owned(), significant(of.nominal, 4), after(of), of.unit.to_owned()])
        .collect();
    table(page, &["parameter", "vehicle file", "identified", "unit"], &rows);
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
        let mut page = String::new();
        table(&mut page, &["h", "i"], &[vec!["1|2".to_owned(), "x".to_owned()]]);
        assert_eq!(page, "\n| h | i |\n| --- | --- |\n| 1\\|2 | x |\n");
        table(&mut page, &["h"], &[]);
        assert_eq!(page.lines().count(), 4);
    }
}
