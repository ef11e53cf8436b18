//! `report.html` of `validate`.

use super::error_table::ErrorTable;
use crate::report::InputFile;
use crate::report::chart::{Bars, Panel, inline};
use crate::report::html::{Cell, Page, number, text};
use crate::report::number::significant;
use crate::signals::Quality;

/// One flight's results for the report.
#[derive(Debug, Clone, Copy)]
pub struct ValidatedFlight<'a> {
    /// its file
    pub input: &'a InputFile,
    /// all tables
    pub tables: &'a [ErrorTable],
    /// flown again, recorded and simulated
    pub charts: &'a [Panel],
    /// where its signals come from, by the first model's thrust law
    pub quality: &'a Quality,
}

/// Window of the errors that the sentence is about, s.
const WINDOW_S: f64 = 0.5;

/// The report: one file, nothing loaded from anywhere. `models` are names and files, the first is what the others
/// are compared with; `settings` are names and values.
#[must_use]
pub fn validation_report(
    models: &[(String, InputFile)],
    flights: &[ValidatedFlight<'_>],
    settings: &[(String, String)],
) -> String {
    let names: Vec<&str> = models.iter().map(|(name, _)| name.as_str()).collect();
    let mut page = Page::new(&format!("mavid validate: {}", names.join(", ")), &answer(&names, flights));
    let count = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    page.tags(&[count(models.len(), "model"), count(flights.len(), "flight")]);
    if let Some(bars) = bars(&names, flights) {
        page.heading("Prediction");
        page.figure(
            &bars.inline(),
            "Open-loop prediction from the measured state, fed the recorded actuators, over windows of 0.5 s; all flights.",
        );
    }
    for flight in flights {
        page.heading(&flight.input.path);
        let playback = flight.tables.iter().filter(|table| table.window_s.is_some());
        let others = flight.tables.iter().filter(|table| table.window_s.is_none());
        playback.chain(others).for_each(|table| error_table(&mut page, table));
        if !flight.charts.is_empty() {
            page.note("Recorded, and flown again in closed loop from the recorded setpoints:");
        }
        flight.charts.iter().for_each(|panel| page.figure(&inline(panel), ""));
    }
    page.heading("Data quality");
    for flight in flights {
        crate::report::quality::section(&mut page, &flight.input.path, flight.quality);
    }
    let mut files: Vec<(&str, &InputFile)> = models.iter().map(|(_, input)| ("model", input)).collect();
    files.extend(flights.iter().map(|flight| ("compared with", flight.input)));
    page.provenance(&files, settings);
    page.finish()
}

/// Errors of all flights over windows of 0.5 s: name and unit of each quantity, and one value a model.
fn half_second(flights: &[ValidatedFlight<'_>], models: usize) -> Vec<(String, String, Vec<Option<f64>>)> {
    let tables: Vec<&ErrorTable> = flights
        .iter()
        .flat_map(|flight| flight.tables)
        .filter(|table| table.window_s.is_some_and(|window_s| (window_s - WINDOW_S).abs() < 1e-9))
        .collect();
    let Some(first) = tables.first() else { return Vec::new() };
    let mean = |row: usize, model: usize| {
        let each: Option<Vec<f64>> =
            tables.iter().map(|table| table.rows.get(row)?.rms.get(model).copied().flatten()).collect();
        let each = each?;
        let squares: f64 = each.iter().map(|rms| rms * rms).sum();
        Some((squares / each.len() as f64).sqrt())
    };
    first
        .rows
        .iter()
        .enumerate()
        .map(|(row, of)| {
            (of.name.clone(), of.unit.clone(), (0..models).map(|model| mean(row, model)).collect())
        })
        .collect()
}

/// Which model predicts best, in one sentence.
fn answer(names: &[&str], flights: &[ValidatedFlight<'_>]) -> String {
    let rows = half_second(flights, names.len());
    let list = |parts: Vec<String>| match parts.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        all => all.concat(),
    };
    let known = |model: usize| rows.iter().any(|(.., rms)| rms[model].is_some());
    let Some(first) = names.first().filter(|_| known(0)) else {
        return "Nothing could be predicted over 0.5 s; the tables say why.".to_owned();
    };
    let gain = |model: usize| -> Vec<(&str, f64)> {
        let gains = rows.iter().filter_map(|(name, _, rms)| {
            Some((name.as_str(), crate::compare::improvement_percent(rms[0]?, rms[model]?)))
        });
        gains.collect()
    };
    let mean = |model: usize| {
        let gains = gain(model);
        gains.iter().map(|(_, percent)| percent).sum::<f64>() / gains.len().max(1) as f64
    };
    let best = (1..names.len()).filter(|model| known(*model)).max_by(|a, b| mean(*a).total_cmp(&mean(*b)));
    let Some(best) = best else {
        let errors = rows
            .iter()
            .filter_map(|(name, unit, rms)| Some(format!("{name} to {} {unit}", significant(rms[0]?, 2))));
        return format!("Over 0.5 s {first} predicts {}, rms.", list(errors.collect()));
    };
    let changes = gain(best).into_iter().map(|(name, percent)| {
        let how = if percent < 0.0 { "larger" } else { "smaller" };
        format!("{:.0} % {how} in {name}", percent.abs())
    });
    let verdict = if mean(best) < -0.5 {
        format!("No model predicts better than {first}; nearest comes {}, whose", names[best])
    } else if mean(best) < 0.5 {
        format!("{} predicts as well as {first}: its", names[best])
    } else if names.len() > 2 {
        format!("{} predicts best of {} models: against {first} its", names[best], names.len())
    } else {
        format!("{} predicts better than {first}: its", names[best])
    };
    format!("{verdict} 0.5 s errors are {}.", list(changes.collect()))
}

/// Errors of every model in units of the first one's.
fn bars(names: &[&str], flights: &[ValidatedFlight<'_>]) -> Option<Bars> {
    let rows = half_second(flights, names.len());
    let ratio = |row: &(String, String, Vec<Option<f64>>), model: usize| match (row.2[0], row.2[model]) {
        (Some(first), Some(rms)) if first > 0.0 => rms / first,
        _ => f64::NAN,
    };
    (!rows.is_empty()).then(|| Bars {
        title: format!("prediction error, in units of that of {}", names.first().unwrap_or(&"the first")),
        unit: String::new(),
        names: rows.iter().map(|(name, ..)| name.clone()).collect(),
        series: names
            .iter()
            .enumerate()
            .map(|(model, name)| {
                ((*name).to_owned(), model, rows.iter().map(|row| ratio(row, model)).collect())
            })
            .collect(),
    })
}

fn error_table(page: &mut Page, table: &ErrorTable) {
    let shown = table.shown();
    if shown.is_empty() {
        page.note(&format!("{}: none. {}", table.title, table.remarks().join("; ")));
        return;
    }
    let mut heads = vec!["rms error".to_owned()];
    for (index, model) in table.models.iter().enumerate() {
        heads.push(format!("{model}|"));
        if index > 0 {
            heads.push("better by %|".to_owned());
        }
    }
    heads.push("unit".to_owned());
    let value = |value: Option<f64>, digits: i32| {
        number(value.map_or_else(|| "-".to_owned(), |value| significant(value, digits)))
    };
    let rows: Vec<Vec<Cell>> = shown
        .iter()
        .map(|row| {
            let mut cells = vec![text(row.name.as_str())];
            for (index, (rms, gain)) in row.rms.iter().zip(&row.improvement_percent).enumerate() {
                cells.push(value(*rms, 3));
                if index > 0 {
                    cells.push(number(gain.map_or_else(|| "-".to_owned(), |gain| format!("{gain:.1}"))));
                }
            }
            cells.push(text(row.unit.as_str()));
            cells
        })
        .collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    page.table(&table.title, &heads, &rows);
    table.remarks().into_iter().for_each(|line| page.note(line));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Fit;
    use crate::report::playback_table;
    use crate::signals::{ThrustSource, Usable};

    fn tables(second: f64) -> Vec<ErrorTable> {
        let fit = |scale: f64| Fit {
            position_m: Some(0.1 * scale),
            velocity_m_s: Some(0.2 * scale),
            attitude_rad: None,
            rates_rad_s: Some(0.3 * scale),
            windows: 10,
        };
        let fits = [("a".to_owned(), Ok(fit(1.0))), ("b".to_owned(), Ok(fit(second)))];
        vec![playback_table(0.5, &fits)]
    }

    fn said(second: f64) -> String {
        let input = InputFile { path: "l".into(), sha256: "0".into(), losses: Vec::new(), notes: Vec::new() };
        let tables = tables(second);
        let quality = Quality {
            sources: Vec::new(),
            thrust_source: ThrustSource::Command,
            offsets: Vec::new(),
            airborne_s: Vec::new(),
            usable: Usable::default(),
            notes: Vec::new(),
        };
        let flight = ValidatedFlight { input: &input, tables: &tables, charts: &[], quality: &quality };
        answer(&["a", "b"], &[flight])
    }

    #[test]
    fn the_sentence_says_which_model_predicts_better_and_by_how_much() {
        assert_eq!(
            said(0.5),
            "b predicts better than a: its 0.5 s errors are 50 % smaller in position, 50 % smaller in velocity and 50 % smaller in body rates."
        );
        assert!(said(1.0).starts_with("b predicts as well as a"));
        assert!(said(2.0).starts_with("No model predicts better than a; nearest comes b"));
    }
}
