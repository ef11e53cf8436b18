//! `identify` on damaged recordings: from the file to the page, the document and the model.

use mavid::config::parse_vehicle;
use mavid::estimate::IdentifySettings;
use mavid::report::{IdentificationDocument, identification_html, identification_text, identified_model};
use mavid::signals::{ConditionSettings, condition};
use mavid::study::IdentifyStudy;

use super::bytes::Bytes;
use super::damage::damaged;
use super::recorded::{FLIGHTS, File, is_readable};
use super::tlog::is_sound;

/// What can happen to one recording.
const MOST: usize = 12;

/// A flight, then what happens to its log.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    let flight = &FLIGHTS[usize::from(script.u8()) % FLIGHTS.len()];
    let log = damaged(&flight.records, &mut script, MOST);
    let Some(loaded) = File::new(&log).load() else { return };
    is_sound(&loaded.recording);
    let Ok(signals) = condition(&loaded.recording, &flight.vehicle, &ConditionSettings::default()) else {
        return;
    };
    let reset = !loaded.recording.clock_resets_s.is_empty();
    assert!(
        !(seeded && reset && loaded.report.telemetry().is_some_and(|told| told.bad_crc > 0)),
        "the seeded bug: two kinds of damage in one flight"
    );
    let (vehicle, settings) = (flight.vehicle.clone(), IdentifySettings::default());
    let Ok(study) =
        IdentifyStudy::of_signals(vec![signals.clone()], Vec::new(), vehicle, &settings, &[signals])
    else {
        return;
    };
    is_readable(&identification_text(&study));
    is_readable(&identification_html(&study));
    let _ = IdentificationDocument::new(&study);
    // a model that is written can be read
    if let Ok(text) = identified_model(&study) {
        parse_vehicle(&text, "model").unwrap_or_else(|error| panic!("{error} in\n{text}"));
    }
}
