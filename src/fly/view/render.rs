//! Draws the model.

use super::instruments::{bar, horizon, path_map};
use super::keys::{ARM_WORD, KILL_WORD};
use super::model::{ParameterRow, Phase, TWIN, ViewModel};
use super::plain::with_error;
use super::spark::spark;
use crate::fly::finding::Level;
use crate::fly::preflight::Page;
use crate::text::to_width;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

/// Silence after which a link is late, s.
const LATE_S: f64 = 0.5;
/// Silence after which a link is lost, s.
const LOST_S: f64 = 2.0;
/// Columns of a parameter's name, and of its value with error and unit.
const NAME_COLUMNS: usize = 6;
const VALUE_COLUMNS: usize = 32;

/// Rows beside the parameters' and the instruments': head, gauges, motion, frames, events and foot.
const OTHER_ROWS: u16 = 16;
/// Rows of the instruments below each other with the parameters: a lower terminal has them beside these.
const INSTRUMENT_ROWS: u16 = 7;
/// Columns of the parameters with instruments beside them, and the fewest of these.
const BESIDE_COLUMNS: u16 = 42;
const INSTRUMENT_COLUMNS: u16 = 30;
/// Columns of the bar of the tracking error.
const BAR_COLUMNS: usize = 8;

/// Draws the whole view.
pub fn render(frame: &mut Frame<'_>, model: &ViewModel) {
    if let (true, Some(page)) = (model.awaits_word, &model.page) {
        return before_flight(frame, model, page);
    }
    let rows = u16::try_from(model.parameters.len()).unwrap_or(u16::MAX).max(1);
    let spare = frame.area().height.saturating_sub(rows.saturating_add(OTHER_ROWS));
    let drawn = if spare < INSTRUMENT_ROWS { 0 } else { spare.min(2 * INSTRUMENT_ROWS) };
    let [head, gauges, motion, instruments, below, events, foot] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(3),
        Constraint::Length(4),
        Constraint::Length(drawn),
        Constraint::Length(rows.saturating_add(2)),
        Constraint::Min(3),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    frame.render_widget(Paragraph::new(header(model)), head);
    gauge_row(frame, model, gauges);
    boxed(frame, "Motion (north, west, up)", motion_lines(model), motion);
    let is_wide = below.width >= BESIDE_COLUMNS + INSTRUMENT_COLUMNS;
    let parameters = if drawn > 0 {
        instrument_row(frame, model, instruments);
        below
    } else if is_wide {
        let [left, right] =
            Layout::horizontal([Constraint::Length(BESIDE_COLUMNS), Constraint::Min(0)]).areas(below);
        instrument_row(frame, model, right);
        left
    } else {
        below
    };
    boxed(
        frame,
        &parameters_title(model.parameters_used_s, usize::from(parameters.width)),
        parameter_lines(model, parameters.width),
        parameters,
    );
    event_list(frame, model, events);
    frame.render_widget(Paragraph::new(help(model)), foot);
}

/// What the parameters and their errors are, in so many columns with the frame: a plan and a model have other errors of them.
fn parameters_title(used_s: f64, columns: usize) -> String {
    let short = format!("Rigid body alone, from {used_s:.0} s so far");
    let long = format!("{short}; +-: standard error in this flight so far");
    if long.len() + 2 <= columns { long } else { short }
}

/// The page before the flight, as much of it as fits, and the field for the word.
fn before_flight(frame: &mut Frame<'_>, model: &ViewModel, page: &Page) {
    let [above, foot] = Layout::vertical([Constraint::Min(1), Constraint::Length(1)]).areas(frame.area());
    let lines = page.lines(usize::from(above.width));
    let end = model.page_from + usize::from(above.height);
    let (more, all) = (end < lines.len(), lines.len());
    let shown = lines.into_iter().skip(model.page_from).map(Line::raw);
    frame.render_widget(Paragraph::new(shown.collect::<Vec<_>>()), above);
    let typed = model.typed.as_deref().unwrap_or_default();
    let asked = if more {
        format!("line {end} of {all}: Space for more, Ctrl-C leaves")
    } else if let Some(refused) = &model.refused {
        format!("{ARM_WORD}> _   expected {ARM_WORD} and Enter, got {refused:?}: not armed; Ctrl-C leaves")
    } else if model.is_twin {
        format!("{ARM_WORD}> {typed}_  type {ARM_WORD} to fly {TWIN}; Ctrl-C leaves")
    } else {
        format!("{ARM_WORD}> {typed}_   type {ARM_WORD} and Enter to arm and fly; Ctrl-C leaves, Up for more")
    };
    frame.render_widget(Paragraph::new(Line::styled(asked, Modifier::BOLD)), foot);
}

/// How many lines of the page before the flight a terminal of so many rows shows at once.
#[must_use]
pub fn page_rows(rows: u16) -> usize {
    usize::from(rows.saturating_sub(1).max(1))
}

fn boxed(frame: &mut Frame<'_>, title: &str, lines: Vec<Line<'_>>, area: Rect) {
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(title.to_owned())), area);
}

/// Words before all else, while it matters.
fn stall_words(stall_s: f64) -> String {
    format!("THIS COMPUTER STALLED {stall_s:.1} s  ")
}

fn header(model: &ViewModel) -> Line<'_> {
    let color = match model.phase {
        Phase::Preparing => Color::Cyan,
        Phase::Flying => Color::Green,
        Phase::Aborted => Color::Red,
        Phase::Done => Color::Blue,
    };
    let progress = model
        .progress_s
        .map_or_else(String::new, |(done_s, all_s)| format!("  {done_s:.0} of {all_s:.0} s flown"));
    let stall = model.stall_s.map_or_else(String::new, stall_words);
    Line::from(vec![
        Span::styled(stall, Style::new().fg(Color::Red).add_modifier(Modifier::BOLD)),
        Span::styled(model.title.as_str(), Style::new().add_modifier(Modifier::BOLD)),
        Span::raw("  "),
        Span::styled(model.state.as_str(), Style::new().fg(color).add_modifier(Modifier::BOLD)),
        Span::raw(format!(
            "  {}  {}  {:.0} s{progress}",
            if model.mode.is_empty() { "mode unknown" } else { &model.mode },
            if model.armed { "ARMED" } else { "disarmed" },
            model.elapsed_s
        )),
    ])
}

fn gauge_row(frame: &mut Frame<'_>, model: &ViewModel, area: Rect) {
    let [link, battery, tracking] =
        Layout::horizontal([Constraint::Fill(4), Constraint::Fill(2), Constraint::Fill(3)]).areas(area);
    boxed(frame, "Link", vec![link_line(model)], link);
    boxed(frame, "Battery", vec![battery_line(model)], battery);
    boxed(frame, "Tracking error", vec![tracking_line(model, tracking.width)], tracking);
}

/// Artificial horizon, and the path from above.
fn instrument_row(frame: &mut Frame<'_>, model: &ViewModel, area: Rect) {
    let [left, right] = Layout::horizontal([Constraint::Fill(2), Constraint::Fill(3)]).areas(area);
    let inner =
        |area: Rect| (usize::from(area.width.saturating_sub(2)), usize::from(area.height.saturating_sub(2)));
    let lines = |lines: Vec<String>| lines.into_iter().map(Line::raw).collect::<Vec<_>>();
    let level = match &model.attitude {
        // body forward, left, up: a positive pitch is nose down
        Some(attitude) => horizon(inner(left), attitude.roll_deg, -attitude.pitch_deg),
        None => Vec::new(),
    };
    boxed(frame, "Horizon", lines(level), left);
    let path: Vec<[f64; 2]> = model.path_m.iter().copied().collect();
    let (map, width_m) = path_map(inner(right), &path);
    let title = format!("Path, north up, {width_m:.1} m wide");
    let fits = title.len() + 2 <= usize::from(right.width);
    boxed(frame, &if fits { title } else { format!("Path, {width_m:.1} m") }, lines(map), right);
}

fn link_line(model: &ViewModel) -> Line<'_> {
    let link = &model.link;
    let Some(age_s) = link.age_s else { return Line::styled("nothing heard", Color::Red) };
    let color = match age_s {
        age_s if age_s >= LOST_S => Color::Red,
        age_s if age_s >= LATE_S => Color::Yellow,
        _ => Color::Green,
    };
    let loss = link.loss.map_or_else(String::new, |loss| format!(" {:.1} % lost", 100.0 * loss));
    let text = format!("{age_s:.1} s {:.0}/s {:.1} kB/s{loss}", link.frames_hz, 1e-3 * link.bytes_s);
    Line::styled(text, color)
}

fn battery_line(model: &ViewModel) -> Line<'_> {
    let battery = &model.battery;
    let percent = battery.percent.map(|percent| format!("{percent:.0} %"));
    let voltage = battery.voltage_v.map(|voltage_v| format!("{voltage_v:.2} V"));
    let parts: Vec<String> = percent.into_iter().chain(voltage).collect();
    let text = if parts.is_empty() { "not said".to_owned() } else { parts.join("  ") };
    Line::styled(text, if battery.is_low { Color::Red } else { Color::Reset })
}

fn tracking_line(model: &ViewModel, columns: u16) -> Line<'_> {
    let tracking = &model.tracking;
    let Some(error_m) = tracking.error_m else { return Line::raw("nothing followed") };
    let limit = tracking.limit_m.map_or_else(String::new, |limit_m| format!(" of {limit_m:.1}"));
    let text = format!("{error_m:.2}{limit} m ");
    let color = match tracking.limit_m {
        Some(limit_m) if error_m >= limit_m => Color::Red,
        Some(limit_m) if error_m >= 0.5 * limit_m => Color::Yellow,
        _ => Color::Green,
    };
    let share = tracking.limit_m.filter(|limit_m| *limit_m > 0.0).map(|limit_m| error_m / limit_m);
    let bar = share.map_or_else(String::new, |share| bar(share, BAR_COLUMNS) + " ");
    let room = usize::from(columns).saturating_sub(text.len() + bar.chars().count() + 2);
    let spark = spark(tracking.history_m.values(), room);
    Line::from(vec![Span::styled(text, color), Span::styled(bar, color), Span::raw(spark)])
}

fn motion_lines(model: &ViewModel) -> Vec<Line<'_>> {
    let Some(attitude) = &model.attitude else { return vec![Line::raw("no attitude yet")] };
    let [x, y, z] = attitude.position_m;
    let [vx, vy, vz] = attitude.velocity_m_s;
    vec![
        // as pilots and autopilots read them: nose up is positive, the heading is clockwise from north
        Line::raw(format!(
            "roll {:+6.1}  pitch {:+6.1} (nose up)  heading {:5.1} deg",
            attitude.roll_deg,
            -attitude.pitch_deg,
            (-attitude.yaw_deg).rem_euclid(360.0)
        )),
        Line::raw(format!(
            "position {x:+7.2} {y:+7.2} {z:+7.2} m   velocity {vx:+6.2} {vy:+6.2} {vz:+6.2} m/s"
        )),
    ]
}

fn parameter_lines(model: &ViewModel, columns: u16) -> Vec<Line<'_>> {
    if model.parameters.is_empty() {
        let waits = model.parameters_await.as_deref().unwrap_or("it takes some seconds of the trajectory");
        let inside = usize::from(columns.saturating_sub(2));
        return vec![Line::raw(whole_words(&format!("nothing yet: {waits}"), inside))];
    }
    let room = usize::from(columns).saturating_sub(NAME_COLUMNS + VALUE_COLUMNS + 4);
    let reason = usize::from(columns).saturating_sub(NAME_COLUMNS + 2);
    model.parameters.iter().map(|row| parameter_line(row, (room, reason))).collect()
}

/// As much of a text as fits, to the end of a word.
fn whole_words(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    // a column for the dots
    let fits: String = text.chars().take(columns).collect();
    let end = fits.rfind(' ').unwrap_or(0);
    format!("{}…", fits[..end].trim_end_matches([' ', ',', ':', ';', '(']))
}

/// Why a parameter has no value yet, in so many columns.
fn not_yet(why: Option<&str>, columns: usize) -> String {
    let why = why.map_or_else(String::new, |why| format!(": {why}"));
    let long = format!("not determined yet{why}");
    if long.chars().count() <= columns { long } else { whole_words(&format!("not yet{why}"), columns) }
}

fn parameter_line(row: &ParameterRow, (room, reason): (usize, usize)) -> Line<'_> {
    let name =
        Span::styled(format!("{:<NAME_COLUMNS$}", row.name), Style::new().add_modifier(Modifier::BOLD));
    let Some((value, std)) = row.value.zip(row.std) else {
        return Line::from(vec![name, Span::raw(not_yet(row.why.as_deref(), reason))]);
    };
    let value = format!("{} {}", with_error(value, std), row.unit);
    Line::from(vec![
        name,
        Span::raw(format!("{value:<VALUE_COLUMNS$} ")),
        Span::styled(spark(row.history.values(), room), Color::Cyan),
    ])
}

fn event_list(frame: &mut Frame<'_>, model: &ViewModel, area: Rect) {
    let room = usize::from(area.height.saturating_sub(2));
    let first = model.events.len().saturating_sub(room);
    let columns = usize::from(area.width.saturating_sub(2));
    let mut lines: Vec<Line<'_>> = model
        .events
        .iter()
        .skip(first)
        .flat_map(|event| {
            let color = match event.level {
                Level::Ok | Level::Awaited => Color::Reset,
                Level::Warning => Color::Yellow,
                Level::Refusal => Color::Red,
            };
            let text = format!("{:7.1} {}", event.time_s, event.text);
            to_width(&text, columns).into_iter().map(move |line| Line::styled(line, color))
        })
        .collect();
    // the newest is at the end
    let title = if model.is_twin { format!("Events of {TWIN}") } else { "Events".to_owned() };
    boxed(frame, &title, lines.split_off(lines.len().saturating_sub(room)), area);
}

fn help(model: &ViewModel) -> Line<'_> {
    match &model.typed {
        Some(typed) => Line::styled(
            format!("type {KILL_WORD} and Enter to stop the motors NOW, Esc to leave: {typed}_"),
            Style::new().fg(Color::Red).add_modifier(Modifier::BOLD),
        ),
        None if model.keys_wait => {
            Line::raw("Ctrl-C end   other keys count from the page before the flight on")
        }
        None => Line::raw(format!(
            "h hold   l land   r return   :{KILL_WORD} Enter stops the motors   Ctrl-C end"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_title_of_the_parameters_says_which_errors_they_are_and_fits() {
        assert_eq!(parameters_title(12.0, 42), "Rigid body alone, from 12 s so far");
        let long = parameters_title(12.0, 80);
        assert!(long.ends_with("standard error in this flight so far") && long.len() <= 78, "{long}");
        assert!(parameters_title(1234.0, 42).len() <= 40);
    }

    #[test]
    fn no_word_of_a_reason_is_cut() {
        let why = "the length of the arms is a guess (usual for the mass)";
        assert_eq!(not_yet(Some(why), 34), "not yet: the length of the arms…");
        assert_eq!(not_yet(Some("fly more"), 34), "not determined yet: fly more");
        assert_eq!(
            (not_yet(None, 34).as_str(), not_yet(Some(why), 5).as_str()),
            ("not determined yet", "not…")
        );
        for columns in 10..60 {
            let said = not_yet(Some(why), columns);
            assert!(said.chars().count() <= columns, "{columns}: {said}");
        }
        assert_eq!(not_yet(Some(why), 100), format!("not determined yet: {why}"));
    }
}
