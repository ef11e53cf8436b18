//! The page of `explain` for the terminal.

use super::along::along_lines;
use super::answer::answer;
use super::limits::{named_from, not_possible};
use super::motor::{motor, sizes};
use super::no_model::{by_model_file, no_model_line};
use super::rivals::rival;
use super::shown_by::shown_by;
use super::whereabouts::{channel_in_words, spoken_state};
use crate::diagnose::holdout::OpenLoop;
use crate::diagnose::{NO_LATENCY, Named, Verdict, called, clause, known_to};
use crate::estimate::{Finding, ThrustScale};
use crate::note::Note;
use crate::report::number::{chance, percent, significant, with_error};
use crate::report::thrust_source::thrust_name;
use crate::study::{AxisFit, BodyParameter, ExplainStudy, Predicted, QUANTITIES};
use std::fmt::Write;

/// Relative standard error from which on that is said.
const HARDLY_KNOWN: f64 = 0.3;
/// Normal deviate beside which the page says of what the error of the size is.
const CERTAIN_Z: f64 = 8.0;

/// The page for the terminal: the answer first, the notes last.
#[must_use]
pub fn explanation_text(study: &ExplainStudy) -> String {
    let mut page = explanation_page(study);
    for note in &study.notes {
        let _ = write!(page, "\n  {note}");
    }
    page
}

/// The same without the study's own notes, for a terminal on which they are said beside it.
#[must_use]
pub fn explanation_page(study: &ExplainStudy) -> String {
    let mut page = format!("{}\n\n", answer(study));
    let _ = writeln!(page, "  verdict: {}", verdict(study));
    for effect in study.effects.iter().chain(&study.closest) {
        effect_lines(&mut page, study, effect);
    }
    trace_lines(&mut page, study);
    located_lines(&mut page, study);
    fit_lines(&mut page, study);
    body_lines(&mut page, study);
    along_lines(&mut page, study);
    limit_lines(&mut page, study);
    match &study.next_flight {
        Some(Ok(next)) => drop(writeln!(page, "\n  next flight: {}", next.sentence())),
        Some(Err(why)) => drop(writeln!(page, "\n  no next flight: {why}")),
        None => {}
    }
    quality_lines(&mut page, study);
    let of_holdout = study.shown.iter().flat_map(|shown| &shown.notes);
    for note in of_holdout.filter(|note| note.is_warning()) {
        let _ = writeln!(page, "  {note}");
    }
    page.truncate(page.trim_end().len());
    page
}

fn trace_lines(page: &mut String, study: &ExplainStudy) {
    let slight = &study.explanation.slight;
    if slight.is_empty() {
        return;
    }
    page.push_str("\n  significant, but too small to get a name: another cause is possible\n");
    for effect in slight.iter().map(|of| &of.effect) {
        let _ = writeln!(page, "    {}: {}", called(effect.id), sizes(study, effect));
    }
}

fn effect_lines(page: &mut String, study: &ExplainStudy, effect: &Named) {
    let mark = if study.verdict() == Verdict::Unexplained { " (closest, not named)" } else { "" };
    let _ = writeln!(page, "\n  {}{mark}: {}", called(effect.id), clause(effect, study.vehicle()));
    for p in &effect.parameters {
        let (value, unit) = match motor(study, effect, p.name) {
            Some(motor) => (motor, ""),
            None => (with_error(p.value, p.std), p.unit),
        };
        let _ = writeln!(page, "    {:<16}{value:>22}  {unit}", p.name);
    }
    let _ = writeln!(
        page,
        "    evidence: z {:.1}, p {}, {}",
        effect.strength.z,
        chance(study.p_value(effect)),
        shown_by(effect)
    );
    if known_to(effect).is_some_and(|share| share > HARDLY_KNOWN) && effect.strength.z > CERTAIN_Z {
        page.push_str(
            "    z is of the test in which the effect was found; the error of its size is with all effects in the model, and with what its law may \
             be wrong by\n",
        );
    }
    for other in &effect.confusable_with {
        let _ = writeln!(page, "    {}", rival(study, other));
    }
}

fn located_lines(page: &mut String, study: &ExplainStudy) {
    let located = &study.located;
    if located.axes.is_empty() {
        return;
    }
    let axes: Vec<String> = located
        .axes
        .iter()
        .take(4)
        .map(|axis| format!("{} {:.0} %", channel_in_words(axis.axis), axis.share_percent))
        .collect();
    let _ = writeln!(page, "\n  where: {}", axes.join(", "));
    if !located.state.is_empty() {
        let state: Vec<String> = located
            .state
            .iter()
            .take(4)
            .map(|state| {
                let (axis, state_words) = (channel_in_words(state.axis), spoken_state(&state.variable));
                format!("{axis} with {state_words} {:.0} %", state.share_percent)
            })
            .collect();
        let _ = writeln!(page, "  following: {}", state.join(", "));
    }
    if let Some([low, high]) = located.band_hz {
        let _ = writeln!(page, "  between {} and {} Hz", significant(low, 2), significant(high, 2));
    }
}

fn fit_lines(page: &mut String, study: &ExplainStudy) {
    let _ = writeln!(
        page,
        "\n  open-loop prediction over 0.5 s, rms {:>10}{:>12}{:>12}{:>13}  better by",
        "unchanged", "rigid body", "with it", "noise alone"
    );
    let shown = study.shown_on.heading();
    for (name, of) in [("flights explained", &study.identify), (shown.as_str(), &study.holdout)] {
        let _ = writeln!(page, "    {name}");
        predicted_lines(page, of.as_ref());
    }
    page.push_str("    unchanged: a state that does not change; better by: than the better one of it and the rigid body\n");
    at_end_lines(page, (study.holdout.as_ref().or(study.identify.as_ref()), by_model_file(study)));
    for (name, of) in [("flights explained", &study.identify), (shown.as_str(), &study.holdout)] {
        if let Some(line) = of.as_ref().and_then(no_model_line) {
            let _ = writeln!(page, "    {name}: {line}");
        }
    }
    if let Some(Err(why)) = study.shown.as_ref().map(|shown| &shown.closed_loop) {
        let _ = writeln!(page, "\n  not simulated in closed loop: {why}");
    }
}

fn predicted_lines(page: &mut String, predicted: Option<&Predicted>) {
    let Some(predicted) = predicted else { return };
    for (of, (name, unit)) in predicted.half_second().iter().zip(QUANTITIES) {
        let Some(of) = of else { continue };
        let figure = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| significant(value, 3));
        let _ = writeln!(
            page,
            "      {:<30}{:>11}{:>12}{:>12}{:>13}  {}",
            format!("{name} ({unit})"),
            figure(of.unchanged.map(|of| of.value)),
            figure(Some(of.before.value)),
            figure(Some(of.after.value)),
            figure(of.floor),
            percent(&of.improvement_percent)
        );
    }
    if let Some(mean) = predicted.improvement_percent {
        let _ = writeln!(page, "      {:<78}  {}", "mean", percent(&mean));
    }
}

/// Errors at the end of the windows, as benchmarks of multi-step prediction give them.
/// `written`: the same with the model file as it is, where `predicted` is with more than that.
fn at_end_lines(page: &mut String, (predicted, written): (Option<&Predicted>, Option<&Predicted>)) {
    let Some(predicted) = predicted else { return };
    let as_written = if written.is_some() { "  model.toml" } else { "" };
    let _ = writeln!(
        page,
        "\n  error at the horizon, mean{:>21}{:>12}{:>12}{as_written}",
        "unchanged", "rigid body", "with it"
    );
    let mut by_file = written.into_iter().flat_map(|written| &written.open_loop);
    for of in &predicted.open_loop {
        let by_file = by_file.next().map_or([None; 4], OpenLoop::quantities);
        for ((compared, by_file), (name, unit)) in of.quantities().iter().zip(by_file).zip(QUANTITIES) {
            let by_file = by_file.and_then(|of| of.at_end).map(|at_end| significant(at_end.after, 3));
            let Some(at_end) = compared.and_then(|of| of.at_end) else { continue };
            let _ = writeln!(
                page,
                "    {:<32}{:>11}{:>12}{:>12}{}",
                format!("{name} after {} s ({unit})", of.window_s),
                significant(at_end.unchanged, 3),
                significant(at_end.before, 3),
                significant(at_end.after, 3),
                by_file.map_or_else(String::new, |error| format!("{error:>12}"))
            );
        }
    }
}

/// Which of the standard errors of one number these are: a plan and the view of a flight have others.
pub(super) const ERRORS: &str = "standard error after the flight, with the effects in the model. A plan and the live view have those \
                                 of the rigid body alone";

fn body_lines(page: &mut String, study: &ExplainStudy) {
    let _ = writeln!(page, "\n  rigid body{:>13}{:>24}{:>28}", "nominal", "alone", "with the effects");
    for of in study.body() {
        let _ = writeln!(
            page,
            "    {:<6}{:>13}{:>24}{:>28}  {}",
            of.name,
            significant(of.nominal, 4),
            before(&of),
            after(&of),
            of.unit
        );
    }
    let _ = writeln!(page, "    +-: {ERRORS}");
    if let Some(sentence) = scale(study) {
        let _ = writeln!(page, "    {sentence}");
    }
    for (reason, names) in study.body_not_determined() {
        let _ = writeln!(page, "    {}: not determined: {reason}", names.join(", "));
    }
    let latency = study.latency();
    let _ = if latency.is_determined() {
        let known_ms = with_error(1e3 * latency.total_s, 1e3 * latency.std_s);
        writeln!(page, "    from command to rotor {known_ms} ms")
    } else {
        writeln!(page, "    from command to rotor: not determined: {NO_LATENCY}")
    };
    let _ = writeln!(page, "\n  {:<22}{:>13}{:>12}", "residual, rms", "alone", "after");
    for AxisFit { name, unit, before, after } in study.residual() {
        let _ = writeln!(
            page,
            "    {:<20}{:>13}{:>12}  {unit}",
            channel_in_words(name),
            significant(before, 3),
            significant(after, 3)
        );
    }
}

/// A value of the rigid body alone, as people read it.
pub(super) fn before(of: &BodyParameter) -> String {
    match of.before_not_determined {
        Some(_) => NOT_DETERMINED.to_owned(),
        None if of.weighed => format!("{} (weighed)", significant(of.before.value, 4)),
        None => with_error(of.before.value, of.before.std),
    }
}

const NOT_DETERMINED: &str = "not determined";

/// A value with the effects, as people read it.
pub(super) fn after(of: &BodyParameter) -> String {
    match of.not_determined {
        Some(_) => NOT_DETERMINED.to_owned(),
        None if of.weighed => format!("{} (weighed)", significant(of.after.value, 4)),
        None => with_error(of.after.value, of.after.std),
    }
}

/// The verdict, and what takes from it.
pub(super) fn verdict(study: &ExplainStudy) -> String {
    let name = study.verdict().name().replace('_', " ");
    if study.is_doubtful() {
        format!("{name}, doubtful")
    } else if !study.limited().is_empty() && !study.effects.is_empty() {
        format!("{name}, no name is certain")
    } else {
        name
    }
}

/// What the scale of masses and forces rests on; `None` where a note says it.
pub(super) fn scale(study: &ExplainStudy) -> Option<String> {
    if let Some(of) = study.scale() {
        return of_weighed(&of);
    }
    study.std_of_stated_thrust().map(|std| {
        let error = match 100.0 * std {
            none if none <= 0.0 => "its error is not in theirs".to_owned(),
            percent => format!("an error of {} % of it is in theirs", significant(percent, 2)),
        };
        format!(
            "scale: the stated thrust is trusted (anchor = \"thrust\"): mass, moments of inertia, forces and torques are in proportion to it, and \
             {error}; a weighed mass sets the scale with anchor = \"mass\""
        )
    })
}

/// What a weighed mass makes of the stated thrust.
fn of_weighed(of: &ThrustScale) -> Option<String> {
    let (Finding::Determined { value, std }, Finding::Determined { value: factor, .. }) =
        (&of.value, &of.factor)
    else {
        return None;
    };
    let times = significant(*factor, 3);
    Some(format!(
        "{} {} {}, {times} times the stated one: identified, since the mass was weighed",
        of.name,
        with_error(*value, *std),
        of.unit
    ))
}

fn limit_lines(page: &mut String, study: &ExplainStudy) {
    if study.explanation.limits.is_empty() {
        return;
    }
    let _ = writeln!(page, "\n  what would have been named in {}", study.these_flights());
    let named = named_from(&study.explanation.limits);
    let width = named.iter().map(|(id, _)| called(id).chars().count()).max().unwrap_or(0);
    for (id, from) in named {
        let _ = writeln!(page, "    {:<width$}  from {from}", called(id));
    }
    if let Some(unseen) = not_possible(&study.explanation.limits) {
        let _ = writeln!(page, "    {unseen}");
    }
}

fn quality_lines(page: &mut String, study: &ExplainStudy) {
    page.push('\n');
    for (input, quality) in study.given.inputs.iter().zip(&study.given.quality) {
        let _ = writeln!(
            page,
            "  {}: {:.1} s used; thrust from {}; {}",
            input.path,
            quality.usable.usable_s,
            thrust_name(quality.thrust_source),
            quality.usable.summary()
        );
        // what the study says of it stands among its notes
        let is_said = |note: &&Note| study.notes.iter().any(|of| of.text == note.text);
        for note in quality.notes.iter().filter(|note| !is_said(note)) {
            let _ = writeln!(page, "    {note}");
        }
    }
}
