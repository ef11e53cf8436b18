//! `explain` on damaged recordings: from the file to the page.

use mavid::diagnose::{ExplainSettings, explain};
use mavid::estimate::{contradicting_flights, moved_by_guessed_curve};
use mavid::report::{
    ExplanationDocument, explained_model, explanation_answer, explanation_html, explanation_text,
};
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::study::{ExplainStudy, Given};

use super::bytes::Bytes;
use super::damage::damaged;
use super::recorded::{FLIGHTS, File, is_readable};

/// What can happen to one recording.
const MOST: usize = 8;
const TRANSIENT_S: f64 = 1.0;

/// What happens to the log of the flight that can be explained.
pub fn run(data: &[u8], seeded: bool) {
    let flight = &FLIGHTS[0];
    let log = damaged(&flight.records, &mut Bytes::new(data), MOST);
    let Some(loaded) = File::new(&log).load() else { return };
    let conditioned = ConditionSettings {
        transient_s: Some(TRANSIENT_S),
        thrust: ThrustPreference::BestSampled,
        ..ConditionSettings::default()
    };
    let Ok(signals) = condition(&loaded.recording, &flight.vehicle, &conditioned) else { return };
    let settings = ExplainSettings::default();
    let flights = [signals];
    let Ok(explanation) = explain(&flights, &flight.vehicle, &settings) else { return };
    assert!(
        !(seeded && loaded.report.telemetry().is_some_and(|told| told.backward_stamps > 0)),
        "the seeded bug: records that were turned round"
    );
    let given = Given {
        battery_voltage_v: None,
        hover_command: None,
        vehicle: flight.vehicle.clone(),
        inputs: Vec::new(),
        quality: flights.iter().map(|signals| signals.quality.clone()).collect(),
        by_guessed_curve: moved_by_guessed_curve(&flights, &flight.vehicle),
        contradicting: contradicting_flights(&flights, &flight.vehicle),
        settings,
        transient_s: TRANSIENT_S,
        limited: Vec::new(),
        has_velocity: true,
        own_load: false,
        own_wind: false,
    };
    let study = ExplainStudy::new(given, explanation);
    is_readable(&explanation_text(&study));
    is_readable(&explanation_answer(&study));
    is_readable(&explanation_html(&study));
    let _ = ExplanationDocument::new(&study);
    let _ = explained_model(&study);
}
