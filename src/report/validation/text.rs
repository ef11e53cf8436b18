//! The tables of `validate` for the terminal.

use super::heads::{column_heads, shortened_names};
use crate::study::{ErrorTable, ValidateStudy, lost};
use std::fmt::Write;

/// The page for the terminal: each flight's tables.
#[must_use]
pub fn validation_text(study: &ValidateStudy) -> String {
    let names: Vec<String> = study.models.iter().map(|model| model.name.clone()).collect();
    let heads: String =
        shortened_names(&names).into_iter().map(|(head, name)| format!("{head} is {name}\n")).collect();
    let space = if heads.is_empty() { "" } else { "\n" };
    let pages = study.flights.iter().map(|flight| {
        let tables: Vec<String> = flight.tables.iter().map(error_table_text).collect();
        format!("{}\n\n{}", flight.input.path, tables.join("\n"))
    });
    let mut page = format!("{heads}{space}{}", pages.collect::<Vec<_>>().join("\n"));
    lost(study.flights.iter().map(|flight| &flight.input)).iter().for_each(|note| {
        let _ = write!(page, "\n  {note}");
    });
    page.trim_end().to_owned()
}

/// A table in the form of Tables 4 to 12; the reason if there is nothing to show.
#[must_use]
pub fn error_table_text(table: &ErrorTable) -> String {
    let rows = table.shown();
    if rows.is_empty() {
        return format!("{}: none\n  {}\n", table.title, table.remarks().join("\n  "));
    }
    let mut page = format!("{}\n  {:<22}", table.title, "RMS error");
    for (index, model) in column_heads(&table.models).iter().enumerate() {
        let _ = write!(page, "{model:>15}");
        if index > 0 {
            let _ = write!(page, "{:>10}", "P_imp %");
        }
    }
    page.push('\n');
    let number = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
    };
    for row in rows {
        let _ = write!(page, "  {:<22}", format!("{} ({})", row.name, row.unit));
        for (index, (rms, gain)) in row.rms.iter().zip(&row.improvement_percent).enumerate() {
            let _ = write!(page, "{:>15}", number(*rms, 5));
            if index > 0 {
                let _ = write!(page, "{:>10}", number(*gain, 2));
            }
        }
        page.push('\n');
    }
    for line in table.remarks() {
        let _ = writeln!(page, "  {line}");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Fit, TenSignals};
    use crate::note::{About, Note};
    use crate::study::{closed_loop_table, playback_table};

    #[test]
    fn what_no_model_has_is_left_out_and_said_in_one_line() {
        let fit = Fit { attitude_rad: Some(0.1), rates_rad_s: Some(0.2), windows: 3, ..Fit::default() };
        let page = error_table_text(&playback_table(0.5, &[("a".to_owned(), Ok(fit))]));
        assert!(!page.contains("velocity (m/s)") && page.contains("attitude (rad)"), "{page}");
        assert!(
            page.contains("not recorded (position needs velocity as well): position, velocity\n"),
            "{page}"
        );
        let none = || Err("no setpoints".to_owned());
        let mut table = closed_loop_table(
            "Again",
            &TenSignals::default(),
            &[("a".to_owned(), none()), ("b".to_owned(), none())],
            (0.0, 1.0),
        );
        table.notes.push(Note::remark(About::Errors, "controller: a PID"));
        assert_eq!(error_table_text(&table), "Again: none\n  a, b: no setpoints\n");
    }
}
