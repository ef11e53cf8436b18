//! `report.html` of `explain`.

use super::prediction::{Predicted, QUANTITIES, ShownOn};
use super::story::{Story, body_values, rigid_body};
use crate::compare::SIGNALS;
use crate::diagnose::holdout::{Compared, HoldoutFit};
use crate::diagnose::{AXES, CHANNEL_NAMES, Named, Tested, Trace, Verdict};
use crate::diagnose::{called, clause};
use crate::report::chart::inline;
use crate::report::html::{Cell, Page, number, text};
use crate::report::number::{chance, percent, significant, spoken, with_error};

impl Story {
    /// The report: one file, nothing loaded from anywhere.
    #[must_use]
    pub fn report_html(&self, traces: &[Trace]) -> String {
        let mut page = Page::new(&format!("mavid explain: {}", self.given.vehicle.name), &self.answer());
        let flights = self.given.inputs.len();
        let mut tags = vec![
            self.verdict().name().replace('_', " "),
            format!("{flights} flight{} explained", if flights == 1 { "" } else { "s" }),
            self.shown_on.heading(),
        ];
        if self.explanation.too_little_excitation {
            tags.push("too little excitation".to_owned());
        }
        tags.extend(self.other_vehicle().map(|_| "hold-out of another vehicle".to_owned()));
        page.tags(&tags);
        self.given.warnings.iter().for_each(|warning| page.warning(warning));
        self.figures(&mut page, traces);
        self.found_section(&mut page);
        self.shown_section(&mut page);
        self.parameters_section(&mut page);
        self.evidence_section(&mut page);
        self.next_section(&mut page);
        self.limits_section(&mut page);
        self.quality_section(&mut page);
        self.provenance_section(&mut page);
        page.finish()
    }

    fn figures(&self, page: &mut Page, traces: &[Trace]) {
        page.heading("Simulation against recording");
        for panel in self.recorded_and_simulated(traces).iter().take(3) {
            page.figure(
                &inline(panel),
                "Behind the weak form's kernel of 0.4 s. Shaded: where the rigid body alone misses by more than noise.",
            );
        }
        if let Some(panel) = self.residual_along_time(traces) {
            page.figure(&inline(&panel), "The same as a difference.");
        }
        page.heading("Where they differ");
        if let Some(panel) = self.followed() {
            page.figure(
                &inline(&panel),
                "Mean residual in bins of the state, with bands that hold 95 of 100 resamplings of the flight's periods.",
            );
        }
        page.figure(&self.axes_chart(traces).inline(), "Root mean square of each axis.");
        if let Some(strip) = self.heat(traces) {
            page.figure(&strip.inline(), "Dark: five times what is left after, and more.");
        }
        if let Some(panel) = self.harmonics(traces) {
            page.figure(
                &inline(&panel),
                "A trajectory flown again and again puts what the model lacks at its harmonics; noise lies beside them as well. A ratio about 1 is noise.",
            );
        }
    }

    fn found_section(&self, page: &mut Page) {
        page.heading(match self.verdict() {
            Verdict::Unexplained => "What comes closest and does not serve",
            Verdict::NothingMissing => "What was left out: nothing that this flight could show",
            Verdict::Explained | Verdict::PartlyExplained => "What was left out",
        });
        for effect in self.effects.iter().chain(&self.closest) {
            page.paragraph(&format!("{}.", clause(effect, self.vehicle())));
            self.effect_table(page, effect);
        }
        if let Some(term) = &self.empirical {
            page.paragraph(&format!(
                "An empirical term, not a mechanism: a force along {}, straight lines between the knots, none outside what was flown. It predicts {} % of the force residual in stretches that it was not fitted to.",
                term.along.name(),
                significant(100.0 * term.gain, 2)
            ));
            let rows: Vec<Vec<Cell>> = term
                .knots
                .iter()
                .zip(&term.force_n)
                .map(|(at, force)| {
                    [*at, force.x, force.y, force.z].map(|value| number(significant(value, 3))).to_vec()
                })
                .collect();
            let at = format!("{} ({})|", term.along.name(), term.along.unit());
            page.table("Empirical force", &[&at, "x (N)|", "y (N)|", "z (N)|"], &rows);
        }
    }

    fn effect_table(&self, page: &mut Page, effect: &Named) {
        let rows: Vec<Vec<Cell>> = effect
            .parameters
            .iter()
            .map(|p| vec![text(p.name), number(with_error(p.value, p.std)), text(spoken(p.unit))])
            .collect();
        let strength = &effect.strength;
        let caption = format!(
            "{}: z {:.1}, chance {}, {} % of the residual energy, change of BIC {}",
            effect.id,
            strength.z,
            chance(self.p_value(effect)),
            significant(100.0 * strength.gain, 2),
            significant(self.delta_bic(effect), 3)
        );
        page.table(&caption, &["parameter", "value|", "unit"], &rows);
        for other in &effect.confusable_with {
            let apart = other.distinguishability.map_or_else(
                || "it explains nearly as much".to_owned(),
                |apart| format!("{apart:.1} standard deviations apart in this flight"),
            );
            page.note(&format!("May be taken for {} ({}): {apart}.", called(other.id), other.id));
        }
    }

    fn shown_section(&self, page: &mut Page) {
        page.heading("Fit before and after");
        page.note("Open-loop prediction from the measured state, fed the recorded actuators. Before: the rigid body identified on the same flights. Intervals hold 95 of 100 resamplings of blocks of the flight. Noise alone: what white noise of the sensors would leave with the model that is right.");
        if let Some(predicted) = &self.identify {
            prediction_table(page, "flights explained", predicted);
        }
        if let Some(predicted) = &self.holdout {
            prediction_table(page, &self.shown_on.heading(), predicted);
        }
        if let ShownOn::Nothing { reason } = &self.shown_on {
            page.warning(&format!("Not shown on anything that was not used: {reason}."));
        }
        if let Some(shown) = &self.shown {
            if let Some(why) = &shown.no_open_loop {
                page.note(&format!("Nothing could be predicted in open loop: {why}."));
            }
            weak_table(page, shown);
            closed_loop_table(page, shown);
            agreement_table(page, shown);
            shown.notes.iter().for_each(|note| page.note(note));
        }
    }

    fn parameters_section(&self, page: &mut Page) {
        page.heading("Rigid body");
        let search = &self.explanation.search;
        let nominal = body_values(&self.given.vehicle.body);
        let rows: Vec<Vec<Cell>> = rigid_body(&search.before)
            .iter()
            .zip(rigid_body(self.fitted()))
            .zip(nominal)
            .map(|((before, after), nominal)| {
                let moved = (after.value - before.value) / after.std.max(f64::MIN_POSITIVE);
                vec![
                    text(after.name),
                    number(significant(nominal, 4)),
                    number(with_error(before.value, before.std)),
                    number(with_error(after.value, after.std)),
                    number(format!("{moved:+.1}")),
                    text(after.unit),
                ]
            })
            .collect();
        page.table(
            "Before: alone. After: refitted together with the effects. Moved: in standard errors.",
            &["parameter", "nominal|", "before|", "after|", "moved|", "unit"],
            &rows,
        );
        let latency = &search.latency;
        page.note(&format!(
            "From command to rotor {} ms.",
            with_error(1e3 * latency.total_s, 1e3 * latency.std_s)
        ));
    }

    fn evidence_section(&self, page: &mut Page) {
        page.heading("Evidence");
        let mut rows = Vec::new();
        for (index, step) in self.explanation.search.steps.iter().enumerate() {
            rows.push(evidence_row(&format!("step {}: taken", index + 1), &step.taken));
            rows.extend(step.rivals.iter().take(4).map(|rival| evidence_row("rival", rival)));
        }
        let mut last: Vec<&Tested> = self.explanation.search.last.iter().collect();
        last.sort_by(|a, b| b.evidence.z.abs().total_cmp(&a.evidence.z.abs()));
        rows.extend(last.into_iter().take(12).map(|tested| evidence_row("in the end: not named", tested)));
        page.table(
            &format!(
                "A name needs z above {}, spread over the flight, {} % of the residual energy, and a size that physics allows",
                self.given.settings.gates.z,
                100.0 * self.given.settings.gates.gain
            ),
            &["", "effect", "z|", "gain %|", "chance over blocks|"],
            &rows,
        );
        if let Some(lack) = &self.explanation.lack_of_fit {
            page.note(&format!(
                "Lack of fit at the harmonics after all names: chance {} over {} periods of {:.1} s.",
                chance(lack.p_least()),
                lack.periods,
                lack.period_s
            ));
        }
    }

    fn next_section(&self, page: &mut Page) {
        let Some(next) = &self.next else { return };
        page.heading("The next flight");
        match next {
            Ok(next) => page.paragraph(&format!("{}.", next.sentence())),
            Err(why) => page.note(&format!("None was designed: {why}.")),
        }
    }

    fn limits_section(&self, page: &mut Page) {
        page.heading("What would have been named");
        let rows: Vec<Vec<Cell>> = self
            .explanation
            .limits
            .iter()
            .map(|limit| {
                vec![
                    text(called(limit.id)),
                    text(limit.id),
                    text(limit.parameter),
                    number(significant(limit.limit, 2)),
                    text(spoken(limit.unit)),
                ]
            })
            .collect();
        page.table(
            "The smallest size of each effect that this flight would have shown",
            &["effect", "identifier", "parameter", "from|", "unit"],
            &rows,
        );
    }

    fn quality_section(&self, page: &mut Page) {
        page.heading("Data quality");
        for (input, quality) in self.given.inputs.iter().zip(&self.given.quality) {
            crate::report::quality::section(page, &input.path, quality);
        }
    }

    fn provenance_section(&self, page: &mut Page) {
        let mut files: Vec<_> = self.given.inputs.iter().map(|input| ("explained", input)).collect();
        if let ShownOn::Flights(inputs) = &self.shown_on {
            files.extend(inputs.iter().map(|input| ("hold-out", input)));
        }
        let settings = &self.given.settings;
        page.provenance(
            &files,
            &[
                ("left out at the beginning, s".to_owned(), significant(self.given.transient_s, 3)),
                ("half width of the kernel, s".to_owned(), significant(settings.half_width_s, 3)),
                ("least z".to_owned(), significant(settings.gates.z, 3)),
                ("least share of the residual energy".to_owned(), significant(settings.gates.gain, 2)),
                ("chance of the cluster test".to_owned(), significant(settings.gates.p_cluster, 2)),
            ],
        );
    }
}

fn evidence_row(what: &str, tested: &Tested) -> Vec<Cell> {
    vec![
        text(what),
        text(tested.candidate.id),
        number(format!("{:.1}", tested.evidence.z)),
        number(significant(100.0 * tested.evidence.gain, 2)),
        number(chance(tested.evidence.p_cluster)),
    ]
}

fn compared_row(name: &str, unit: &str, of: &Compared) -> Vec<Cell> {
    vec![
        text(name),
        number(significant(of.before.value, 3)),
        number(significant(of.after.value, 3)),
        number(of.floor.map_or_else(|| "-".to_owned(), |floor| significant(floor, 3))),
        number(percent(&of.improvement_percent)),
        text(unit),
    ]
}

const COMPARED: [&str; 6] = ["", "before|", "after|", "noise alone|", "better by|", "unit"];

fn prediction_table(page: &mut Page, on: &str, predicted: &Predicted) {
    let mut rows = Vec::new();
    for of in &predicted.open_loop {
        for (compared, (name, unit)) in of.quantities().iter().zip(QUANTITIES) {
            if let Some(compared) = compared {
                rows.push(compared_row(&format!("{name}, {} s", of.window_s), unit, compared));
            }
        }
    }
    let mean = predicted
        .improvement_percent
        .map_or_else(String::new, |mean| format!("; mean at 0.5 s better by {}", percent(&mean)));
    page.table(&format!("Prediction error, rms, {on}{mean}"), &COMPARED, &rows);
}

fn weak_table(page: &mut Page, shown: &HoldoutFit) {
    let rows: Vec<Vec<Cell>> = shown
        .weak
        .iter()
        .zip(CHANNEL_NAMES)
        .take(AXES)
        .filter_map(|(of, name)| {
            let unit = if name.starts_with("force") { "N" } else { "N m" };
            Some(compared_row(&name.replace('_', " "), unit, of.as_ref()?))
        })
        .collect();
    page.table("Residual of the weak form on the same flights, rms", &COMPARED, &rows);
}

fn closed_loop_table(page: &mut Page, shown: &HoldoutFit) {
    match &shown.closed_loop {
        Ok(flown) => {
            let rows: Vec<Vec<Cell>> = flown
                .signals
                .iter()
                .zip(SIGNALS)
                .filter_map(|(of, (name, unit))| Some(compared_row(name, unit, of.as_ref()?)))
                .collect();
            page.table(
                "Flown again in closed loop from the recorded setpoints by the simulator's own controller, rms",
                &COMPARED,
                &rows,
            );
        }
        Err(why) => page.note(&format!("Not flown again in closed loop: {why}.")),
    }
}

fn agreement_table(page: &mut Page, shown: &HoldoutFit) {
    let rows: Vec<Vec<Cell>> = shown
        .agreement
        .iter()
        .map(|of| {
            vec![
                text(of.name.as_str()),
                number(with_error(of.identified, of.identified_std)),
                number(with_error(of.held_out, of.held_out_std)),
                number(format!("{:+.1}", of.sigmas())),
                text(spoken(of.unit)),
            ]
        })
        .collect();
    page.table(
        "The same parameters from these flights alone",
        &["parameter", "identified|", "from these alone|", "apart, sigma|", "unit"],
        &rows,
    );
}
