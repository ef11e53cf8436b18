//! `report.html` of `validate`: each section is one function, and one call in [`validation_html`].

use super::charts::closed_loop_charts;
use crate::report::chart::{Bars, inline};
use crate::report::html::{self, Cell, figure, note, number, section, table, text, warning};
use crate::report::number::significant;
use crate::report::page::page;
use crate::report::quality::data_quality;
use crate::study::{ErrorTable, Rank, ValidateStudy, ValidatedFlight, lost};
use crate::text::list;
use maud::{Markup, html};

/// The report: one file, nothing loaded from anywhere.
#[must_use]
pub fn validation_html(study: &ValidateStudy) -> String {
    let _stage = tracing::info_span!("report").entered();
    let names: Vec<&str> = study.models.iter().map(|model| model.name.as_str()).collect();
    let count = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let tags = [count(study.models.len(), "model"), count(study.flights.len(), "flight")];
    let sections = html! {
        @for said in lost(study.flights.iter().map(|of| &of.input)) { (warning(&said.sentence())) }
        (prediction(study))
        @for of in &study.flights { (flight(of)) }
        (data_quality(study.flights.iter().map(|of| (of.input.path.as_str(), &of.quality))))
        (provenance(study))
    };
    page(&format!("mavid validate: {}", names.join(", ")), &answer(study), &tags, &sections)
}

fn prediction(study: &ValidateStudy) -> Markup {
    let rows = study.half_second();
    if rows.is_empty() {
        return Markup::default();
    }
    let first = study.models.first().map_or("the first", |model| model.name.as_str());
    let models = study.models.iter().enumerate();
    let bars = Bars {
        title: format!("prediction error relative to {first}"),
        unit: String::new(),
        names: rows.iter().map(|row| row.name.clone()).collect(),
        series: models
            .map(|(model, of)| {
                (of.name.clone(), model, rows.iter().map(|row| row.over_first(model)).collect())
            })
            .collect(),
    };
    let caption = "Open-loop prediction from the measured state with the recorded actuators, over windows of 0.5 s; \
                   all flights.";
    section("Prediction", &figure(&bars.inline(), caption))
}

fn flight(of: &ValidatedFlight) -> Markup {
    let playback = of.tables.iter().filter(|table| table.window_s.is_some());
    let others = of.tables.iter().filter(|table| table.window_s.is_none());
    let charts = closed_loop_charts(&of.flown_again);
    let content = html! {
        @for table in playback.chain(others) { (error_table(table)) }
        @if !charts.is_empty() {
            (note("Recorded, and simulated in closed loop from the recorded setpoints:"))
        }
        @for panel in &charts { (figure(&inline(panel), "")) }
    };
    section(&of.input.path, &content)
}

fn provenance(study: &ValidateStudy) -> Markup {
    let mut files: Vec<_> = study.models.iter().map(|model| ("model", &model.input)).collect();
    files.extend(study.flights.iter().map(|flight| ("compared with", &flight.input)));
    let settings = [
        ("left out at the beginning, s", significant(study.transient_s, 3)),
        ("low-pass under the regression models, Hz", significant(study.cutoff_hz, 3)),
    ];
    html::provenance(&files, &settings)
}

/// Which model predicts best, in one sentence.
fn answer(study: &ValidateStudy) -> String {
    let names: Vec<&str> = study.models.iter().map(|model| model.name.as_str()).collect();
    let Some(first) = names.first().filter(|_| study.is_predicted(0)) else {
        return "Nothing could be predicted over 0.5 s; the tables say why.".to_owned();
    };
    let Some(best) = study.best() else {
        let errors = study
            .half_second()
            .into_iter()
            .filter_map(|row| Some(format!("{} to {} {}", row.name, significant(row.rms[0]?, 2), row.unit)));
        return format!("Over 0.5 s {first} predicts {}, rms.", list(&errors.collect::<Vec<_>>()));
    };
    let changes = study.gains(best).into_iter().map(|(name, percent)| {
        let how = if percent < 0.0 { "larger" } else { "smaller" };
        format!("{:.0} % {how} in {name}", percent.abs())
    });
    let name = names[best];
    let verdict = match (study.rank(best), names.len()) {
        (Rank::Worse, _) => format!("No model predicts better than {first}; the next best is {name}, whose"),
        (Rank::Alike, _) => format!("{name} predicts as well as {first}: its"),
        (Rank::Better, 0..=2) => format!("{name} predicts better than {first}: its"),
        (Rank::Better, count) => format!("{name} predicts best of {count} models: against {first} its"),
    };
    format!("{verdict} 0.5 s errors are {}.", list(&changes.collect::<Vec<_>>()))
}

fn error_table(of: &ErrorTable) -> Markup {
    let shown = of.shown();
    if shown.is_empty() {
        return note(&format!("{}: none. {}", of.title, of.remarks().join("; ")));
    }
    let mut heads = vec!["rms error".to_owned()];
    for (index, model) in of.models.iter().enumerate() {
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
    html! { (table(&of.title, &heads, &rows)) @for line in of.remarks() { (note(line)) } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Fit;
    use crate::signals::{Quality, ThrustSource, TorqueError, Usable, VelocityHeldBy};
    use crate::study::{InputFile, ValidatedModel, playback_table};

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
        let input =
            || InputFile { path: "l".into(), sha256: "0".into(), other_logs: Vec::new(), notes: Vec::new() };
        let quality = Quality {
            sources: Vec::new(),
            thrust_source: ThrustSource::Command,
            offsets: Vec::new(),
            airborne_s: Vec::new(),
            usable: Usable::default(),
            torques: true,
            torque_error: TorqueError::default(),
            gyro_noise_rad_s: None,
            velocity_held_by: VelocityHeldBy::default(),
            position_by_receiver: false,
            steady_voltage_v: None,
            simulated: false,
            notes: Vec::new(),
        };
        let flight = ValidatedFlight {
            input: input(),
            span_s: (0.0, 1.0),
            tables: tables(second),
            flown_again: Vec::new(),
            quality,
        };
        let model = |name: &str| ValidatedModel { name: name.to_owned(), input: input() };
        answer(&ValidateStudy {
            models: vec![model("a"), model("b")],
            flights: vec![flight],
            transient_s: 10.0,
            cutoff_hz: 5.0,
            notes: Vec::new(),
        })
    }

    #[test]
    fn the_sentence_says_which_model_predicts_better_and_by_how_much() {
        assert_eq!(
            said(0.5),
            "b predicts better than a: its 0.5 s errors are 50 % smaller in position, 50 % smaller in velocity and 50 % smaller in body rates."
        );
        assert!(said(1.0).starts_with("b predicts as well as a"));
        assert!(said(2.0).starts_with("No model predicts better than a; the next best is b"));
    }
}
