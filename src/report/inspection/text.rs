//! The inspection for people: a verdict, then compact tables.

use std::fmt::{Display, Write};

use super::quantities;
use crate::inspect::{
    Inspection, OnboardReading, Outlook, Reading, StreamSummary, TlogReading, TopicSummary,
};
use crate::text;

/// Largest number of spans, texts and segments that are listed; the JSON document has all.
const TOLD: usize = 12;

/// The whole page; `file` is the log's name.
#[must_use]
pub fn inspection_text(file: &str, inspection: &Inspection) -> String {
    let mut page = String::new();
    line(&mut page, file);
    line(&mut page, &inspection.verdict);
    line(&mut page, whose(inspection));
    heading(&mut page, "what it will tell");
    for (name, said) in quantities::lines(inspection) {
        row(&mut page, &name, said);
    }
    if !inspection.advice.is_empty() || !inspection.losses.is_empty() {
        line(&mut page, "");
    }
    for advice in &inspection.advice {
        line(&mut page, format!("  - {advice}"));
    }
    for loss in &inspection.losses {
        line(&mut page, format!("  ! lost: {loss}"));
    }
    parameters_table(&mut page, inspection);
    flight(&mut page, inspection);
    clock(&mut page, inspection);
    streams(&mut page, &inspection.streams);
    reading(&mut page, inspection);
    vehicle_parameters(&mut page, inspection);
    texts(&mut page, inspection);
    page.truncate(page.trim_end().len());
    page
}

/// Of what the log is, as far as it says: kind of vehicle, length, seconds armed and in the air.
fn whose(inspection: &Inspection) -> String {
    let (first_s, last_s) = inspection.clock.span_s;
    let armed_s: f64 = inspection.timeline.armed_s.iter().map(|(from_s, to_s)| to_s - from_s).sum();
    let parts = [
        inspection.vehicle.kind.map(str::to_owned),
        (first_s.is_finite() && last_s.is_finite()).then(|| format!("{:.0} s of log", last_s - first_s)),
        (armed_s > 0.0).then(|| format!("armed for {armed_s:.0} s")),
        Some(format!("in the air for {:.0} s", inspection.flight.airborne_s)),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Writing to a String cannot fail.
fn line(page: &mut String, text: impl Display) {
    let _ = writeln!(page, "{text}");
}

fn row(page: &mut String, name: &str, text: impl Display) {
    let _ = writeln!(page, "  {name:<22}{text}");
}

fn heading(page: &mut String, text: &str) {
    let _ = writeln!(page, "\n{text}");
}

fn parameters_table(page: &mut String, inspection: &Inspection) {
    heading(page, "mass and inertia");
    let of_all = inspection.identifiability.first();
    if let Some(reason) = of_all.and_then(|one| one.reason.as_ref()).filter(|reason| {
        inspection.identifiability.iter().all(|one| one.std.is_none() && one.reason.as_ref() == Some(*reason))
    }) {
        return row(page, "none of them", reason);
    }
    for outlook in &inspection.identifiability {
        row(page, outlook.name, expectation(outlook));
    }
}

fn expectation(outlook: &Outlook) -> String {
    match (outlook.std, outlook.std_relative, &outlook.reason) {
        (Some(std), Some(relative), _) => {
            let unit = if outlook.unit == "1" { String::new() } else { format!(" {}", outlook.unit) };
            format!("to {:.2} % (standard error {std:.2e}{unit})", 100.0 * relative)
        }
        (_, _, Some(reason)) => format!("no: {reason}"),
        _ => "yes; --vehicle shows how well".to_owned(),
    }
}

fn flight(page: &mut String, inspection: &Inspection) {
    let flight = &inspection.flight;
    let by = flight.airborne_from;
    heading(page, &if by.is_empty() { "flight".to_owned() } else { format!("flight (in the air by {by})") });
    row(
        page,
        "in the air",
        format!("{:.1} s, of which {:.1} s can be used", flight.airborne_s, flight.usable_s),
    );
    let off_mixer = if flight.off_mixer_s > 0.0 {
        format!("{:.1} s after an output left the mixer; before that ", flight.off_mixer_s)
    } else {
        String::new()
    };
    row(
        page,
        "left out",
        format!(
            "{off_mixer}transient {:.1} s, without excitation {:.1} s, saturated {:.1} s, in gaps {:.1} s (may overlap)",
            flight.transient_s, flight.idle_s, flight.saturated_s, flight.gap_s
        ),
    );
    let segments = flight
        .segments
        .iter()
        .map(|s| format!("{:.1} to {:.1} s (usable {:.1} s)", s.start_s, s.end_s, s.usable_s));
    row(page, "segments", listed(segments));
    let span = |(start, end): &(f64, f64)| format!("{start:.1} to {end:.1} s");
    let timeline = &inspection.timeline;
    if !timeline.armed_s.is_empty() {
        row(page, "armed", listed(timeline.armed_s.iter().map(span)));
    }
    if !timeline.in_air_s.is_empty() {
        row(page, "autopilot: in the air", listed(timeline.in_air_s.iter().map(span)));
    }
    if !timeline.modes.is_empty() {
        let modes = timeline.modes.iter().map(|mode| {
            let name = mode.name.map_or_else(|| format!("{:.0}", mode.number), ToOwned::to_owned);
            format!("{name} {:.1} s", mode.time_s)
        });
        row(page, "modes", listed(modes));
    }
    excitation(page, inspection);
}

fn excitation(page: &mut String, inspection: &Inspection) {
    let Some(excitation) = &inspection.excitation else { return };
    let three = |v: [f64; 3]| format!("{:.2}, {:.2}, {:.2}", v[0], v[1], v[2]);
    if let Some(rms) = excitation.angular_acceleration_rms_rad_s2 {
        let band = excitation
            .angular_acceleration_band_hz
            .map_or_else(String::new, |(low, high)| format!(", mostly {low:.2} to {high:.2} Hz"));
        row(page, "angular acceleration", format!("{} rad/s^2 rms about x, y, z{band}", three(rms)));
    }
    if let Some(rms) = excitation.rate_rms_rad_s {
        row(page, "body rates", format!("{} rad/s rms", three(rms)));
    }
    if let (Some(mean), Some(variation)) = (excitation.thrust_mean_m_s2, excitation.thrust_variation_m_s2) {
        row(page, "thrust per mass", format!("{mean:.2} m/s^2, varied by {variation:.2} (one sigma)"));
    }
    if let (Some(rms), Some(most)) = (excitation.speed_rms_m_s, excitation.speed_max_m_s) {
        row(page, "speed", format!("{rms:.2} m/s rms, at most {most:.2}"));
    }
    if let Some((low, high)) = excitation.altitude_m {
        row(page, "altitude", format!("{low:.2} to {high:.2} m"));
    }
    let period =
        excitation.period_s.map_or_else(|| "not periodic".to_owned(), |s| format!("period {s:.1} s"));
    row(page, "trajectory", period);
}

fn clock(page: &mut String, inspection: &Inspection) {
    let clock = &inspection.clock;
    heading(page, "clock");
    let span = match clock.span_s {
        (first_s, last_s) if first_s.is_finite() && last_s.is_finite() => {
            format!("{first_s:.1} to {last_s:.1} s")
        }
        _ => "no sample has a time of it".to_owned(),
    };
    row(page, "vehicle's clock", span);
    if let Some(start_us) = clock.start_utc_us {
        row(page, inspection.start_words(), text::utc(start_us));
    }
    if let (Some(drift), Some(std)) = (clock.drift_ppm, clock.drift_std_ppm) {
        row(page, "host against vehicle", format!("{drift:+.0} +- {std:.0} ppm"));
    }
    if let (Some(jitter), Some(latest)) = (clock.arrival_jitter_s, clock.arrival_latest_s) {
        let text = format!("{:.2} ms rms, latest {:.0} ms", 1e3 * jitter, 1e3 * latest);
        row(page, "arrival jitter", text);
    }
    let at = |times: &[f64]| listed(times.iter().map(|time_s| format!("{time_s:.1} s")));
    if !clock.resets_s.is_empty() {
        row(page, "restarted", at(&clock.resets_s));
    }
    if !clock.estimator_resets_s.is_empty() {
        row(page, "estimator jumped", at(&clock.estimator_resets_s));
    }
    for offset in &inspection.stream_offsets {
        let text = if offset.std_s.is_finite() {
            format!("{:+.2} +- {:.2} ms late", 1e3 * offset.late_s, 1e3 * offset.std_s)
        } else {
            "lateness not determined".to_owned()
        };
        row(page, &format!("{} stamps", offset.quantity), text);
    }
}

fn streams(page: &mut String, streams: &[StreamSummary]) {
    heading(page, "streams");
    let _ = writeln!(
        page,
        "  {:<22}{:<30}{:>9}{:>9}{:>11}{:>6}{:>12}",
        "quantity", "from", "samples", "Hz", "jitter ms", "gaps", "largest s"
    );
    for stream in streams {
        let instance = if stream.instance > 0 { format!(" {}", stream.instance) } else { String::new() };
        let state = if stream.state == "live" { String::new() } else { format!("  {}", stream.state) };
        let _ = writeln!(
            page,
            "  {:<22}{:<30}{:>9}{:>9}{:>11}{:>6}{:>12}{state}",
            stream.quantity,
            format!("{}{instance}", stream.source),
            stream.count,
            finite(stream.rate_hz, 1),
            finite(1e3 * stream.jitter_s, 2),
            stream.gaps,
            finite(stream.largest_gap_s, 2),
        );
    }
}

fn finite(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { "-".to_owned() }
}

fn reading(page: &mut String, inspection: &Inspection) {
    heading(page, "file");
    match &inspection.reading {
        Reading::Tlog(reading) => tlog(page, inspection, reading),
        Reading::Csv(reading) => {
            row(page, "rows", format!("{}, {} rejected", reading.rows, reading.rows_rejected));
            let counts = [
                ("out of order", reading.rows_out_of_order),
                ("repeating a time", reading.rows_repeating_a_time),
                ("invalid attitudes", reading.invalid_attitudes),
            ];
            for (name, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
                row(page, name, count);
            }
            if !reading.unused_columns.is_empty() {
                row(page, "unused columns", listed(reading.unused_columns.iter()));
            }
        }
        Reading::Onboard(reading) => onboard(page, inspection, reading),
        Reading::Other { name } => row(page, "format", name),
    }
}

fn onboard(page: &mut String, inspection: &Inspection, reading: &OnboardReading) {
    let vehicle = &inspection.vehicle;
    row(page, "format", reading.name);
    let kind = vehicle.kind.unwrap_or("of a kind that the log does not say");
    row(page, "vehicle", format!("{kind}, autopilot {}", vehicle.autopilot));
    if let Some(firmware) = &vehicle.firmware {
        row(page, "software", firmware);
    }
    row(page, "messages", format!("{} in {} bytes", reading.messages, reading.bytes));
    for oddity in &reading.oddities {
        row(page, "odd", oddity.as_str());
    }
    let told = |topic: &TopicSummary| {
        let instance = if topic.instance == 0 { String::new() } else { format!("[{}]", topic.instance) };
        let rate = topic.rate_hz.map_or_else(String::new, |hz| format!(" at {hz:.1} Hz"));
        format!("{}{instance} {}{rate}", topic.name, topic.count)
    };
    for (name, use_of) in
        [("used", (true, true)), ("known, not used", (false, true)), ("not used", (false, false))]
    {
        let of_use = |topic: &&TopicSummary| (topic.is_used, topic.is_known) == use_of;
        let topics: Vec<_> = reading.topics.iter().filter(of_use).collect();
        if !topics.is_empty() {
            row(page, name, listed(topics.into_iter().map(told)));
        }
    }
}

fn tlog(page: &mut String, inspection: &Inspection, reading: &TlogReading) {
    let vehicle = &inspection.vehicle;
    if let (Some(system), Some(component)) = (vehicle.system, vehicle.component) {
        row(
            page,
            "vehicle",
            format!("system {system}, component {component}, autopilot {}", vehicle.autopilot),
        );
    }
    let frames = format!(
        "{} in {} bytes (MAVLink 2: {}, MAVLink 1: {})",
        reading.frames, reading.bytes, reading.frames_v2, reading.frames_v1
    );
    row(page, "frames", frames);
    for sender in &reading.senders {
        let share = 100.0 * sender.lost as f64 / (sender.frames + sender.lost).max(1) as f64;
        let text = format!("{} frames, {} lost by sequence ({share:.2} %)", sender.frames, sender.lost);
        row(page, &format!("from {}/{}", sender.system, sender.component), text);
    }
    let counts = [
        ("signed", reading.signed),
        ("duplicates", reading.duplicates),
        ("sharing a stamp", reading.shared_stamps),
        ("stamps backward", reading.backward_stamps),
        ("stamps doubled", reading.doubled_stamps),
        ("stamps leaping", reading.leaping_stamps),
        ("stamps of no clock", reading.odd_stamps),
        ("wrong checksum", reading.bad_crc),
        ("resyncs", reading.resync_count),
        ("bytes skipped", reading.skipped_bytes),
        ("bytes cut off", reading.truncated_tail_bytes),
        ("stamp fits no clock", reading.stale_stamps),
        ("simulator's truth", reading.withheld_truth),
    ];
    for (name, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
        let note = if name == "simulator's truth" { " messages and parameters, not read" } else { "" };
        row(page, name, format!("{count}{note}"));
    }
    for oddity in &reading.oddities {
        row(page, "odd", oddity.as_str());
    }
    if reading.little_endian_stamps {
        row(page, "stamps", "little-endian");
    }
    for (name, list) in [("unusable", &reading.unusable), ("without a value", &reading.empty)] {
        if !list.is_empty() {
            row(page, name, listed(list.iter().map(|(message, count)| format!("{message} {count}"))));
        }
    }
    if !reading.unknown_ids.is_empty() {
        let ids = reading.unknown_ids.iter().map(|(id, count)| format!("{id} ({count})"));
        row(page, "unknown message ids", listed(ids));
    }
}

fn vehicle_parameters(page: &mut String, inspection: &Inspection) {
    let parameters = &inspection.parameters;
    if parameters.count == 0 {
        return;
    }
    let heading_text = format!("vehicle's parameters ({}; those that matter)", parameters.count);
    heading(page, &heading_text);
    let entries: Vec<String> =
        parameters.relevant.iter().map(|(name, value)| format!("{name} {}", short(*value))).collect();
    for chunk in entries.chunks(4) {
        let cells: String = chunk.iter().map(|entry| format!("{entry:<28}")).collect();
        line(page, format!("  {}", cells.trim_end()));
    }
}

/// Parameters are single-precision: six decimals are all there is.
fn short(value: f64) -> String {
    format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn texts(page: &mut String, inspection: &Inspection) {
    let texts = &inspection.texts;
    if texts.count == 0 {
        return;
    }
    heading(page, &format!("texts ({}; warnings and worse: {})", texts.count, texts.warning_count));
    for text in texts.warnings.iter().take(TOLD) {
        row(page, &format!("{:.1} s", text.time_s), &text.text);
    }
    if texts.warnings.len() > TOLD {
        row(page, "", format!("and {} more", texts.warning_count.saturating_sub(TOLD as u64)));
    }
}

/// The first entries, and how many more there are.
fn listed<T: Display>(entries: impl Iterator<Item = T>) -> String {
    let all: Vec<String> = entries.map(|entry| entry.to_string()).collect();
    if all.is_empty() {
        return "none".to_owned();
    }
    let shown = all[..all.len().min(TOLD)].join(", ");
    if all.len() > TOLD { format!("{shown} and {} more", all.len() - TOLD) } else { shown }
}
