//! `report.html` of `identify`.

use super::input::InputFile;
use super::model::history_charts;
use super::page::verdict;
use super::with::WithEffects;
use crate::diagnose::called;
use crate::diagnose::joint::{EffectFound, Found};
use crate::estimate::{Finding, Identification, NAMES, Parameter, THETA, Theta, ThrustScale, theta_of};
use crate::report::chart::inline;
use crate::report::html::{Cell, Page, number, text};
use crate::report::model_parts::correlation;
use crate::report::number::{significant, spoken, with_error};
use crate::report::recorded::recorded_and_predicted;
use crate::signals::{FilterPair, Signals};
use crate::vehicle::{Anchor, Vehicle};

/// Everything that the report of `identify` says.
#[derive(Debug, Clone, Copy)]
pub struct IdentificationStory<'a> {
    /// what came out
    pub identification: &'a Identification,
    /// nominal
    pub vehicle: &'a Vehicle,
    /// as they were identified from
    pub flights: &'a [Signals],
    /// their files
    pub inputs: &'a [InputFile],
    /// where the mass was weighed
    pub scale: Option<&'a ThrustScale>,
    /// effects that were identified together with the rigid body
    pub with: Option<&'a WithEffects>,
}

impl IdentificationStory<'_> {
    /// The answer in one sentence.
    #[must_use]
    pub fn answer(&self) -> String {
        let parameters = self.parameters();
        let nominal = theta_of(&self.vehicle.body);
        let mut parts = Vec::new();
        if let Finding::Determined { value, std } = parameters[0].finding {
            let percent = 100.0 * (value / nominal[0] - 1.0);
            let than = if percent < 0.0 { "less" } else { "more" };
            let by = significant(percent.abs(), 2);
            parts.push(format!(
                "mass {} kg, {by} % {than} than the vehicle file says",
                with_error(value, std)
            ));
        }
        let inertia: Vec<String> = [1, 4, 6]
            .into_iter()
            .filter_map(|index| match parameters[index].finding {
                Finding::Determined { value, std } => {
                    Some(format!("{} {}", parameters[index].name, with_error(value, std)))
                }
                _ => None,
            })
            .collect();
        if !inertia.is_empty() {
            parts.push(format!("{} kg m^2", inertia.join(", ")));
        }
        if let Some(with) = self.with {
            let found = with.together.effects.iter().filter(|effect| effect.is_significant());
            parts.extend(found.map(effect_words));
        }
        let result = self.with.map_or(&self.identification.best.result, |with| &with.together.body);
        let good = verdict(result);
        let doubtful = if self.warned() { ", but see the warnings" } else { "" };
        let is = if good.starts_with("good") { " is" } else { "" };
        let parts = if parts.is_empty() { String::new() } else { format!(": {}", parts.join("; ")) };
        format!("The flight{is} {good}{doubtful}{parts}.")
    }

    /// The report: one file, nothing loaded from anywhere.
    #[must_use]
    pub fn report_html(&self) -> String {
        let mut page = Page::new(&format!("mavid identify: {}", self.vehicle.name), &self.answer());
        let method = self.identification.best.method.name();
        let flights = self.inputs.len();
        page.tags(&[
            format!("method {method}"),
            format!("{flights} flight{}", if flights == 1 { "" } else { "s" }),
            match self.vehicle.anchor {
                Anchor::Thrust => "thrust as stated".to_owned(),
                Anchor::Mass => "mass as weighed".to_owned(),
            },
        ]);
        let (warnings, notes): (Vec<&String>, Vec<&String>) =
            self.identification.notes.iter().partition(|note| note.starts_with("warning"));
        warnings.iter().for_each(|warning| page.warning(warning));
        self.figures(&mut page);
        self.effects_section(&mut page);
        self.parameters_section(&mut page);
        self.methods_section(&mut page);
        self.residual_section(&mut page);
        notes.iter().for_each(|note| page.note(note));
        page.heading("Data quality");
        for (input, signals) in self.inputs.iter().zip(self.flights) {
            crate::report::quality::section(&mut page, &input.path, &signals.quality);
        }
        self.provenance_section(&mut page);
        page.finish()
    }

    fn parameters(&self) -> &[Parameter; THETA] {
        self.with.map_or(&self.identification.best.result.parameters, |with| &with.together.body.parameters)
    }

    fn warned(&self) -> bool {
        self.identification.notes.iter().any(|note| note.starts_with("warning"))
    }

    fn figures(&self, page: &mut Page) {
        page.heading("Rotors against motion");
        let nominal = theta_of(&self.vehicle.body);
        let best = &self.identification.best.result.parameters;
        let theta = Theta::from_fn(|index, _| match best[index].finding {
            Finding::Determined { value, .. } | Finding::Given { value } => value,
            Finding::NotDetermined { .. } => nominal[index],
        });
        let factor = match self.scale.map(|scale| &scale.factor) {
            Some(Finding::Determined { value, .. }) => *value,
            _ => 1.0,
        };
        let settings = (self.identification.cutoff_hz, self.vehicle.gravity_m_s2, factor);
        let models = [("vehicle file", nominal), ("identified", theta)];
        let panels = self.flights.first().map(|flight| recorded_and_predicted(flight, settings, &models));
        page.note(if panels.as_ref().is_none_or(Vec::is_empty) {
            "Not drawn: body rates or vertical motion are not recorded."
        } else {
            "What the rotors gave, and what the measured motion takes with mass and inertia of the vehicle file and with those of the rigid body identified alone; the first flight, behind the low-pass."
        });
        panels.iter().flatten().for_each(|panel| page.figure(&inline(panel), ""));
        page.heading("Estimates along the flight");
        page.note("The paper's four estimators after each instant of the flight (its figures 4 and 5).");
        let drawn: Vec<_> =
            history_charts(self.identification).into_iter().filter(|panel| !panel.lines.is_empty()).collect();
        for index in [0, 1, 4, 6] {
            if let Some(panel) = drawn.get(index) {
                page.figure(&inline(panel), "");
            }
        }
    }

    fn effects_section(&self, page: &mut Page) {
        let Some(with) = self.with else { return };
        page.heading("Effects");
        for effect in &with.together.effects {
            page.paragraph(effect.effect.sentence());
            let there = if effect.is_significant() { "" } else { ", not to be told from nothing" };
            let rows: Vec<Vec<Cell>> = effect
                .parameters
                .iter()
                .map(|parameter| {
                    let (value, why) = found(&parameter.found);
                    vec![text(parameter.name), number(value), text(spoken(parameter.unit)), text(why)]
                })
                .collect();
            page.table(
                &format!("{}: {:.1} standard errors from nothing{there}", effect.effect.id(), effect.z),
                &["parameter", "value|", "unit", ""],
                &rows,
            );
        }
    }

    fn parameters_section(&self, page: &mut Page) {
        page.heading("Rigid body");
        page.note(&format!(
            "Method {}: {}.",
            self.identification.best.method.name(),
            self.identification.best.why
        ));
        let nominal = theta_of(&self.vehicle.body);
        let without = self.with.map(|with| &with.together.body_before.parameters);
        let rows: Vec<Vec<Cell>> = self
            .parameters()
            .iter()
            .enumerate()
            .map(|(index, parameter)| {
                let (value, why) = said(&parameter.finding);
                let mut cells = vec![text(parameter.name), number(value)];
                cells.extend(without.map(|without| number(said(&without[index].finding).0)));
                cells.extend([number(significant(nominal[index], 4)), text(parameter.unit), text(why)]);
                cells
            })
            .collect();
        let mut heads = vec!["parameter", "value|"];
        heads.extend(without.map(|_| "without effects|"));
        heads.extend(["vehicle file|", "unit", ""]);
        page.table("Mass and inertia with standard errors", &heads, &rows);
        match self.scale {
            Some(scale) => {
                let (value, why) = said(&scale.value);
                page.note(&format!("{} {value} {} {why}", scale.name, scale.unit));
            }
            None => page.note("The stated thrust is trusted: mass and inertia rest on it, Izz on the stated torque per thrust as well."),
        }
        let (names, rows) = match self.with {
            Some(with) => correlation(&with.together.after),
            None => (
                NAMES.map(str::to_owned).to_vec(),
                super::correlation::correlation(&self.identification.best.result),
            ),
        };
        correlation_table(page, &names, &rows);
    }

    fn methods_section(&self, page: &mut Page) {
        page.heading("Methods");
        let rows: Vec<Vec<Cell>> = self
            .identification
            .methods
            .iter()
            .map(|method| {
                let mut cells = vec![text(method.method.name())];
                cells.extend(method.parameters.iter().map(|parameter| {
                    number(match parameter.finding {
                        Finding::Determined { value, .. } | Finding::Given { value } => significant(value, 4),
                        Finding::NotDetermined { .. } => "-".to_owned(),
                    })
                }));
                cells
            })
            .collect();
        let heads: Vec<String> =
            std::iter::once("method".to_owned()).chain(NAMES.map(|name| format!("{name}|"))).collect();
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        page.table("The rigid body by each method; -: not determined", &heads, &rows);
    }

    fn residual_section(&self, page: &mut Page) {
        let of = self.identification;
        let rows: Vec<Vec<Cell>> = of
            .residual_channels
            .iter()
            .zip(of.residual.iter().zip(&of.explained))
            .map(|(channel, (residual, explained))| {
                let unit = if channel.starts_with("torque") { "N m" } else { "N" };
                vec![
                    text(channel.replace('_', " ")),
                    number(significant(*residual, 3)),
                    text(unit),
                    number(format!("{:.1}", 100.0 * explained)),
                ]
            })
            .collect();
        page.table(
            "What the rigid body leaves of each equation, rms, and what it explains of its variance",
            &["equation", "residual|", "unit", "explained %|"],
            &rows,
        );
        if let Some(latency) = of.latency.filter(|latency| latency.total_s.is_finite()) {
            page.note(&format!(
                "From command to rotor {} ms.",
                with_error(1e3 * latency.total_s, 1e3 * latency.std_s)
            ));
        }
    }

    fn provenance_section(&self, page: &mut Page) {
        let of = self.identification;
        let files: Vec<_> = self.inputs.iter().map(|input| ("identified from", input)).collect();
        let mut settings = vec![
            ("low-pass of LS, GD, FMLS, FMGD, Hz".to_owned(), significant(of.cutoff_hz, 3)),
            ("lambda of the filters (37), rad/s".to_owned(), significant(FilterPair::PAPER_LAMBDA_RAD_S, 3)),
            ("condition number, columns scaled".to_owned(), significant(of.scaled_condition_number, 3)),
        ];
        settings.extend(
            of.condition_number
                .map(|condition| ("condition number as flown".to_owned(), significant(condition, 3))),
        );
        page.provenance(&files, &settings);
    }
}

/// An effect's name with its values.
fn effect_words(effect: &EffectFound) -> String {
    let values: Vec<String> = effect
        .parameters
        .iter()
        .filter_map(|parameter| match &parameter.found {
            Found::Determined { value, std } => Some(
                format!("{} {} {}", parameter.name, with_error(*value, *std), spoken(parameter.unit))
                    .trim_end()
                    .to_owned(),
            ),
            _ => None,
        })
        .collect();
    format!("{} ({})", called(effect.effect.id()), values.join(", "))
}

fn correlation_table(page: &mut Page, names: &[String], rows: &[Vec<Option<f64>>]) {
    let rows: Vec<Vec<Cell>> = names
        .iter()
        .zip(rows)
        .map(|(name, row)| {
            let mut cells = vec![text(name.as_str())];
            cells.extend(row.iter().map(|r| number(r.map_or_else(|| "-".to_owned(), |r| format!("{r:.2}")))));
            cells
        })
        .collect();
    let heads: Vec<String> =
        std::iter::once(String::new()).chain(names.iter().map(|name| format!("{name}|"))).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    page.table("Correlation of the estimates", &heads, &rows);
}

/// A value with its standard error, and a reason.
fn said(finding: &Finding) -> (String, String) {
    match finding {
        Finding::Determined { value, std } => (with_error(*value, *std), String::new()),
        Finding::Given { value } => (significant(*value, 4), "weighed".to_owned()),
        Finding::NotDetermined { reason } => ("-".to_owned(), format!("not determined: {reason}")),
    }
}

fn found(found: &Found) -> (String, String) {
    match found {
        Found::Determined { value, std } => (with_error(*value, *std), String::new()),
        Found::AtBound { value, wanted, std } => (
            significant(*value, 4),
            format!("at the bound of what physics allows; the flight asks for {}", with_error(*wanted, *std)),
        ),
        Found::Given { value, why } => (significant(*value, 4), why.clone()),
        Found::NotDetermined { reason, .. } => ("-".to_owned(), format!("not determined: {reason}")),
    }
}
