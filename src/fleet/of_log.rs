//! One log as rows: a pure function of its bytes and of the settings.

use super::of_flight::{FlightOf, flight_rows, leg_rows, parameter_rows};
use super::of_flight::{effect_rows, residual_rows};
use super::rows::{LogRow, LogRows, ProvenanceRow, SCHEMA, WarningRow};
use super::task::{LogTask, program};
use super::vehicles::{OfLog, own_name, own_type, system_of};
use crate::config::vehicle_to_toml;
use crate::inspect::{Inspection, Reading};
use crate::note::{Note, Severity};
use crate::study::{AloneRequest, AloneStudy, Depth, OwnWords, ReadSettings, alone};
use crate::text;
use crate::vehicle::Vehicle;

/// The rows of a log. A log that cannot be read has one row in `logs`, with the reason; nothing is an error of this function.
///
/// ```
/// use mavid::fleet::{LogSettings, LogTask, log_rows};
/// use std::path::Path;
///
/// let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p04_identify_10_22s.tlog");
/// let task = LogTask {
///     uri: "s3://flights/p04.tlog".to_owned(),
///     path,
///     sha256: "the hash of its bytes".to_owned(),
///     bytes: 0,
///     settings: LogSettings { depth: mavid::study::Depth::Balance, ..LogSettings::default() },
/// };
/// let rows = log_rows(&task);
/// assert_eq!((rows.logs.len(), rows.logs[0].uri.as_str()), (1, "s3://flights/p04.tlog"));
/// ```
#[must_use]
pub fn log_rows(task: &LogTask) -> LogRows {
    let request = AloneRequest {
        log: task.path.clone(),
        read: ReadSettings { csv_map: task.settings.csv_map.clone(), system: None },
        depth: task.settings.depth,
    };
    let vehicles = &task.settings.vehicles;
    let whose =
        |own: &OwnWords<'_>| vehicles.of(&OfLog { uri: &task.uri, own: *own }).map(|known| known.given());
    let mut rows = match alone(&request, &whose) {
        Ok(study) => studied(task, &study),
        Err(why) => error_rows(task, &why.to_string()),
    };
    call_by_uri(&mut rows, task);
    rows
}

/// Sentences name the log by its address, also where its bytes lie in a copy.
fn call_by_uri(rows: &mut LogRows, task: &LogTask) {
    let path = text::path(&task.path);
    if path == task.uri {
        return;
    }
    let call = |text: &mut String| *text = text.replace(&path, &task.uri);
    rows.logs.iter_mut().flat_map(|log| log.error.iter_mut().chain(&mut log.verdict)).for_each(call);
    for flight in &mut rows.flights {
        flight.balance_error.iter_mut().chain(&mut flight.motion_error).for_each(call);
    }
    rows.warnings.iter_mut().map(|warning| &mut warning.text).for_each(call);
}

/// The rows of a log that could not be read.
#[must_use]
pub fn error_rows(task: &LogTask, why: &str) -> LogRows {
    let row = LogRow {
        log: task.sha256.clone(),
        uri: task.uri.clone(),
        bytes: i64::try_from(task.bytes).unwrap_or(i64::MAX),
        status: "error".to_owned(),
        error: Some(why.to_owned()),
        vehicle: None,
        vehicle_type: None,
        format: None,
        autopilot: None,
        firmware: None,
        system: None,
        start_utc_us: None,
        span_s: None,
        airborne_s: None,
        flights: 0,
        verdict: None,
        losses: 0,
    };
    LogRows { logs: vec![row], provenance: vec![provenance(task, (None, false))], ..LogRows::default() }
}

fn provenance(task: &LogTask, (vehicle, given): (Option<&Vehicle>, bool)) -> ProvenanceRow {
    ProvenanceRow {
        log: task.sha256.clone(),
        schema: SCHEMA,
        program: program(),
        settings: task.settings.digest(),
        depth: format!("{:?}", task.settings.depth).to_lowercase(),
        vehicle_toml: vehicle.and_then(|vehicle| vehicle_to_toml(vehicle).ok()),
        vehicle_given: given,
    }
}

fn studied(task: &LogTask, study: &AloneStudy) -> LogRows {
    let found = &study.inspection;
    let own = OwnWords {
        system: found.vehicle.system,
        autopilot: found.vehicle.autopilot,
        parameters: &study.parameters,
    };
    let of_log = OfLog { uri: &task.uri, own };
    let listed = task.settings.vehicles.of(&of_log);
    let vehicle = listed.and_then(|vehicle| vehicle.name.clone()).unwrap_or_else(|| own_name(&of_log));
    let kind = listed.map_or_else(|| own_type(&of_log), |vehicle| vehicle.type_name(&of_log));
    let start_utc_us = found.clock.start_utc_us.and_then(|us| i64::try_from(us).ok());
    let mut rows = LogRows {
        provenance: vec![provenance(task, (study.vehicle.as_ref(), study.is_known))],
        ..LogRows::default()
    };
    for (place, flight) in (0..).zip(&study.flights) {
        let of = FlightOf {
            log: &task.sha256,
            place,
            vehicle: &vehicle,
            vehicle_type: &kind,
            start_utc_us,
            nominal: study.vehicle.as_ref(),
            is_known: study.is_known,
        };
        rows.flights.push(flight_rows(&of, flight));
        rows.legs.extend(leg_rows(&of, flight));
        rows.parameters.extend(parameter_rows(&of, flight));
        rows.effects.extend(effect_rows(&of, flight));
        rows.residuals.extend(residual_rows(&of, flight));
        let doubts = flight.input.notes.iter().filter(|note| note.severity != Severity::Loss);
        rows.warnings
            .extend(doubts.chain(&flight.doubts).map(|note| warning(task, (&vehicle, Some(place)), note)));
    }
    rows.warnings.extend(study.notes.iter().map(|note| warning(task, (&vehicle, None), note)));
    rows.warnings.extend(said(task, &vehicle, found));
    rows.logs.push(LogRow {
        status: status(task, study).to_owned(),
        error: study.refused.as_ref().map(|why| why.replace(OF_ONE_LOG, OF_FLEET)),
        vehicle: Some(vehicle),
        vehicle_type: Some(kind),
        format: Some(format_name(&found.reading).to_owned()),
        autopilot: Some(found.vehicle.autopilot.to_owned()),
        firmware: found.vehicle.firmware.clone(),
        system: system_of(&of_log).map(i64::from),
        start_utc_us,
        span_s: Some(found.clock.span_s.1 - found.clock.span_s.0).filter(|span| span.is_finite()),
        airborne_s: Some(found.flight.airborne_s).filter(|seconds| seconds.is_finite()),
        flights: i64::try_from(study.flights.len()).unwrap_or(i64::MAX),
        verdict: Some(found.verdict.clone()),
        losses: i64::try_from(found.losses.len()).unwrap_or(i64::MAX),
        ..error_rows(task, "").logs.swap_remove(0)
    });
    rows
}

fn status(task: &LogTask, study: &AloneStudy) -> &'static str {
    match (task.settings.depth, study.flights.is_empty()) {
        (_, false) => "flown",
        (Depth::Inspect, true) => "inspected",
        (_, true) => "no_flight",
    }
}

/// How a command on one log is told of the frame, and how a fleet is.
const OF_ONE_LOG: &str = "give the frame (--frame quadrotor-x)";
const OF_FLEET: &str = "list the vehicle in the file of --vehicles, with its file, or its mass and frame, or give --mass and --frame";

fn format_name(reading: &Reading) -> &'static str {
    match reading {
        Reading::Tlog(_) => "tlog",
        Reading::Csv(_) => "csv",
        Reading::Onboard(of) => of.name,
        Reading::Other { name } => name,
    }
}

fn warning(task: &LogTask, (vehicle, flight): (&str, Option<i64>), note: &Note) -> WarningRow {
    let severity = match note.severity {
        Severity::Remark => "remark",
        Severity::Warning => "warning",
        Severity::Loss => "loss",
    };
    WarningRow {
        log: task.sha256.clone(),
        flight,
        vehicle: Some(vehicle.to_owned()),
        severity: severity.to_owned(),
        text: note.text.clone(),
    }
}

/// Losses of the log, and the warnings that the vehicle sent.
fn said(task: &LogTask, vehicle: &str, found: &Inspection) -> Vec<WarningRow> {
    let row = |severity: &str, text: &str| WarningRow {
        log: task.sha256.clone(),
        flight: None,
        vehicle: Some(vehicle.to_owned()),
        severity: severity.to_owned(),
        text: text.to_owned(),
    };
    let losses = found.losses.iter().map(|loss| row("loss", loss));
    let off = found.outputs_off_mixer.iter().map(|off| row("warning", &off.to_string()));
    let texts = found.texts.warnings.iter().map(|text| row("text", &text.text));
    losses.chain(off).chain(texts).collect()
}
