//! The model file of `explain`: the vehicle with its effects, and what they rest on.

use super::prediction::ShownOn;
use super::story::Story;
use crate::config::{ConfigError, vehicle_to_toml};
use crate::report::model_parts::{correlations, effect_tables};
use crate::text::toml_string;
use std::fmt::Write;

impl Story {
    /// The model file: every command that takes a vehicle takes it.
    ///
    /// # Errors
    /// [`ConfigError`] where a value has no form in TOML.
    pub fn model_toml(&self) -> Result<String, ConfigError> {
        let mut text = vehicle_to_toml(self.vehicle())?;
        text.push_str(&effect_tables(&self.effects_of_model()));
        self.identified(&mut text);
        self.provenance(&mut text);
        Ok(text)
    }

    fn identified(&self, text: &mut String) {
        let _ =
            writeln!(text, "\n[identified]\nmethod = \"explain\"\nverdict = \"{}\"", self.verdict().name());
        let _ = writeln!(text, "answer = {}", toml_string(&self.answer()));
        let entry = |name: &str, value: f64, std: f64, unit: &str| {
            let std = if std.is_finite() { std } else { 0.0 };
            format!("{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}")
        };
        for p in self.rigid_body() {
            let _ = writeln!(text, "{}", entry(p.name, p.value, p.std, p.unit));
        }
        let latency = &self.explanation.search.latency;
        let _ = writeln!(text, "{}", entry("latency", latency.total_s, latency.std_s, "s"));
        let (names, rows) = correlations(self.fitted());
        let _ = writeln!(text, "correlation_of = {names:?}\ncorrelation = [\n{}\n]", rows.join(",\n"));
        for effect in &self.effects {
            let _ = writeln!(text, "\n[identified.effects.{}]", effect.id);
            for p in &effect.parameters {
                let _ = writeln!(text, "{}", entry(p.name, p.value, p.std, p.unit));
            }
            let others: Vec<&str> = effect.confusable_with.iter().map(|other| other.id).collect();
            let _ = writeln!(text, "confusable_with = {others:?}");
        }
    }

    fn provenance(&self, text: &mut String) {
        let _ = writeln!(text, "\n[provenance]\nprogram = \"mavid {}\"", env!("CARGO_PKG_VERSION"));
        let files = |inputs: &[crate::report::InputFile]| {
            let lines: Vec<String> = inputs
                .iter()
                .map(|input| {
                    format!("  {{ path = {}, sha256 = \"{}\" }}", toml_string(&input.path), input.sha256)
                })
                .collect();
            format!("[\n{}\n]", lines.join(",\n"))
        };
        let _ = writeln!(text, "inputs = {}", files(&self.given.inputs));
        match &self.shown_on {
            ShownOn::Flights(inputs) => {
                let _ = writeln!(text, "holdout = {}", files(inputs));
            }
            ShownOn::HeldBack { from_s, .. } => {
                let _ = writeln!(text, "held_back_from_s = {from_s:?}");
            }
            ShownOn::Nothing { .. } => {}
        }
        let gates = &self.given.settings.gates;
        let _ = writeln!(
            text,
            "transient_s = {:?}\nhalf_width_s = {:?}\ngate_z = {:?}\ngate_gain = {:?}",
            self.given.transient_s, self.given.settings.half_width_s, gates.z, gates.gain
        );
    }
}
