//! The flight as lines, for a log or a terminal that cannot draw.

use super::keys::ARM_WORD;
use super::model::{EventLine, ParameterRow, Phase, TWIN, ViewModel};
use crate::fly::finding::Level;

/// Between two lines of state, s.
const STATE_S: f64 = 1.0;
/// Between two lines of parameters, s.
const PARAMETERS_S: f64 = 5.0;
/// Columns of a page where the terminal's are not known.
const COLUMNS: usize = 120;

/// Says each event once and the state now and then.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlainLog {
    events: u64,
    state_s: Option<f64>,
    parameters_s: Option<f64>,
    /// of the terminal; 0: not known
    columns: usize,
    page_follows: bool,
    page_said: bool,
    word_said: bool,
    /// warnings of the checks, until the page says them
    held: Vec<String>,
}

impl PlainLog {
    /// For a terminal of this width.
    #[must_use]
    pub fn of_width(columns: usize) -> Self {
        Self { columns, ..Self::default() }
    }

    /// With a page before the flight, which repeats the warnings of the checks: they are not said twice.
    #[must_use]
    pub fn before_a_page(self, page_follows: bool) -> Self {
        Self { page_follows, ..self }
    }

    /// The lines that are due, by the model's own time.
    pub fn lines(&mut self, model: &ViewModel) -> Vec<String> {
        let all = model.event_count.saturating_sub(self.events);
        let new = usize::try_from(all).unwrap_or(usize::MAX).min(model.events.len());
        self.events = model.event_count;
        let first = model.events.len() - new;
        let forgotten = all.saturating_sub(u64::try_from(new).unwrap_or(u64::MAX));
        let mut lines: Vec<String> = Vec::new();
        if forgotten > 0 {
            lines.push(format!("[{:7.1} s] {forgotten} events came too fast to be shown", model.elapsed_s));
        }
        for event in model.events.iter().skip(first) {
            let is_held = self.page_follows && !self.page_said && is_check_warning(event);
            if is_held { &mut self.held } else { &mut lines }.push(event_line(event));
        }
        if matches!(model.phase, Phase::Aborted | Phase::Done) {
            // no page came
            lines.append(&mut self.held);
        }
        if let Some(page) = model.page.as_ref().filter(|_| !std::mem::replace(&mut self.page_said, true)) {
            self.held.clear();
            lines.extend(page.lines(if self.columns > 0 { self.columns } else { COLUMNS }));
        }
        if model.awaits_word && !std::mem::replace(&mut self.word_said, true) {
            let what = if model.is_twin { format!(" {TWIN}") } else { String::new() };
            lines.push(format!("type {ARM_WORD} and return to arm and fly{what}; Ctrl-C ends it"));
        }
        if is_due(&mut self.state_s, model.elapsed_s, STATE_S) {
            lines.push(state_line(model));
        }
        if !model.parameters.is_empty() && is_due(&mut self.parameters_s, model.elapsed_s, PARAMETERS_S) {
            lines.push(parameters_line(model));
        }
        lines
    }
}

fn is_due(last_s: &mut Option<f64>, now_s: f64, period_s: f64) -> bool {
    let due = last_s.is_none_or(|last_s| now_s - last_s >= period_s);
    if due {
        *last_s = Some(now_s);
    }
    due
}

fn is_check_warning(event: &EventLine) -> bool {
    event.level == Level::Warning && event.text.starts_with("check: ")
}

fn event_line(event: &EventLine) -> String {
    let level = match event.level {
        Level::Ok => String::new(),
        level => format!("{}: ", level.name()),
    };
    format!("[{:7.1} s] {level}{}", event.time_s, event.text)
}

fn state_line(model: &ViewModel) -> String {
    let mut parts = vec![model.state.clone()];
    parts.extend(model.is_twin.then(|| TWIN.to_owned()));
    parts.extend(model.stall_s.map(|stall_s| format!("this computer stalled {stall_s:.1} s")));
    parts.extend((!model.mode.is_empty()).then(|| model.mode.clone()));
    parts.extend(model.progress_s.map(|(done_s, all_s)| format!("{done_s:.0} of {all_s:.0} s")));
    parts.extend(model.tracking.error_m.map(|error_m| format!("error {error_m:.2} m")));
    parts.extend(model.battery.percent.map(|percent| format!("battery {percent:.0} %")));
    parts.extend(
        model.link.age_s.map(|age_s| format!("link {age_s:.1} s, {:.0} frames/s", model.link.frames_hz)),
    );
    format!("[{:7.1} s] {}", model.elapsed_s, parts.join(", "))
}

fn parameters_line(model: &ViewModel) -> String {
    let shown: Vec<String> = model.parameters.iter().filter_map(parameter).collect();
    let said = if shown.is_empty() { "nothing determined yet".to_owned() } else { shown.join(", ") };
    let used_s = model.parameters_used_s;
    format!("[{:7.1} s] rigid body alone, from {used_s:.0} s so far: {said}", model.elapsed_s)
}

fn parameter(row: &ParameterRow) -> Option<String> {
    let (value, std) = row.value.zip(row.std)?;
    Some(format!("{} {} {}", row.name, with_error(value, std), row.unit))
}

/// A value with its standard error, both to the error's second digit.
pub(super) fn with_error(value: f64, std: f64) -> String {
    let mut digits = 0;
    let mut size = std;
    while size < 10.0 && digits < 6 && std > 0.0 {
        size *= 10.0;
        digits += 1;
    }
    if std > 0.0 { format!("{value:.digits$} +- {std:.digits$}") } else { format!("{value:.4}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_two_digits() {
        assert_eq!(with_error(2.0614, 0.0123), "2.061 +- 0.012");
        assert_eq!(with_error(0.021_431, 0.000_39), "0.02143 +- 0.00039");
        assert_eq!(with_error(2.5, 0.0), "2.5000");
        assert_eq!(with_error(120.4, 15.2), "120 +- 15");
    }

    #[test]
    fn warnings_of_the_checks_are_on_the_page_or_said_where_none_comes() {
        let mut model = ViewModel { state: "check".into(), ..ViewModel::default() };
        model.event(Level::Warning, "check: fence: none");
        let said = |log: &mut PlainLog, model: &ViewModel| {
            log.lines(model).iter().filter(|line| line.contains("fence")).count()
        };
        assert_eq!(said(&mut PlainLog::default(), &model), 1);
        let mut log = PlainLog::default().before_a_page(true);
        assert_eq!(said(&mut log, &model), 0);
        model.phase = Phase::Aborted;
        assert_eq!((said(&mut log, &model), said(&mut log, &model)), (1, 0));
        let mut log = PlainLog::default().before_a_page(true);
        model.page = Some(std::sync::Arc::default());
        model.phase = Phase::Preparing;
        assert_eq!(said(&mut log, &model), 0);
    }

    #[test]
    fn events_are_said_once_and_the_state_now_and_then() {
        let mut model = ViewModel { state: "connecting".into(), ..ViewModel::default() };
        let mut log = PlainLog::default();
        model.event(Level::Warning, "no fence");
        let lines = log.lines(&model);
        assert_eq!(lines, ["[    0.0 s] warning: no fence", "[    0.0 s] connecting"]);
        model.elapsed_s = 0.5;
        assert!(log.lines(&model).is_empty());
        for number in 0..500 {
            model.event(Level::Ok, format!("event {number}"));
        }
        // those that the list has forgotten cannot be said any more, and none is said twice
        let lines = log.lines(&model);
        assert_eq!(
            (lines.len(), lines[0].as_str()),
            (201, "[    0.5 s] 300 events came too fast to be shown")
        );
        model.elapsed_s = 1.5;
        assert_eq!(log.lines(&model), ["[    1.5 s] connecting"]);
    }
}
