//! The page before the flight: warnings, the trajectory and its place, and the failsafes.

use super::Situation;
use super::failsafes::TAKEOVER;
use crate::fly::finding::{Finding, Level};
use crate::plan::{Extremes, path_samples};
use crate::text::wrapped;
use crate::units::deg_from_rad;

/// Columns of a drawing, and the rows of the one from above: letters are twice as high as wide.
const COLUMNS: usize = 41;
const ROWS: usize = 15;
/// Subjects of findings that are shown even if they are ok.
const ALWAYS: [&str; 5] = ["if setpoints end", "battery", "fence", "room", TAKEOVER];

/// The page that is shown before the vehicle is armed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// that it is another vehicle than may be thought
    of: Option<String>,
    /// warnings, the worst first
    warnings: Vec<Finding>,
    /// facts about the trajectory and the failsafes
    facts: Vec<String>,
    /// the room, with the trajectory in it
    drawing: Vec<String>,
}

impl Page {
    /// The page of a situation and its findings.
    #[must_use]
    pub fn new(situation: &Situation<'_>, findings: &[Finding]) -> Self {
        let mut facts = trajectory_facts(situation);
        let good = findings.iter().filter(|finding| finding.level == Level::Ok);
        facts.extend(
            good.filter(|finding| ALWAYS.contains(&finding.subject))
                .map(|finding| format!("{}: {}", finding.subject, finding.came)),
        );
        let mut page = Self { of: None, warnings: Vec::new(), facts, drawing: drawing(situation) };
        page.warn_of(findings);
        page
    }

    /// Says first whose page it is.
    #[must_use]
    pub fn said_of(self, of: Option<String>) -> Self {
        Self { of, ..self }
    }

    /// Replaces the warnings by those of these findings, the worst first.
    pub fn warn_of(&mut self, findings: &[Finding]) {
        let mut warned: Vec<&Finding> =
            findings.iter().filter(|finding| finding.level >= Level::Warning).collect();
        warned.sort_by_key(|finding| std::cmp::Reverse(finding.level));
        self.warnings = warned.into_iter().cloned().collect();
    }

    /// The page's lines, none longer than `columns`; the drawing stays as it is.
    #[must_use]
    pub fn lines(&self, columns: usize) -> Vec<String> {
        let mut lines = Vec::new();
        let warnings = self.warnings.iter().map(Finding::to_string);
        for text in self.of.iter().cloned().chain(warnings).chain(self.facts.iter().cloned()) {
            lines.extend(wrapped(&text, columns));
        }
        lines.extend(self.drawing.iter().cloned());
        lines
    }
}

/// The box round the trajectory, its greatest speed and tilt, its duration, in sentences.
fn trajectory_facts(situation: &Situation<'_>) -> Vec<String> {
    let extremes = Extremes::of(situation.path, situation.vehicle);
    let (low, high) = (extremes.low_m, extremes.high_m);
    let limits = situation.limits;
    let wall = |max: Option<f64>| max.map_or("no wall".to_owned(), |max| format!("wall at {max:.2}"));
    let height = |bound: Option<f64>| bound.map_or_else(|| "none".to_owned(), |bound| format!("{bound:.2}"));
    let up_m_s = extremes.up_speed_m_s.max(extremes.down_speed_m_s);
    vec![
        format!(
            "trajectory with the ways to it and from it: {:.0} s (about {:.0} s from the ground to the ground); north {:.2} to {:.2} m ({}), west {:.2} to {:.2} m ({}), up {:.2} to {:.2} m (room {} to {})",
            situation.path.duration_s(),
            situation.duration_s(),
            low[0],
            high[0],
            wall(limits.x_max_m),
            low[1],
            high[1],
            wall(limits.y_max_m),
            low[2],
            high[2],
            height(limits.z_min_m),
            height(limits.z_max_m),
        ),
        format!(
            "at most {:.2} m/s along the ground, {up_m_s:.2} m/s up or down, {:.1} degrees of tilt",
            extremes.horizontal_speed_m_s,
            deg_from_rad(extremes.tilt_rad)
        ),
    ]
}

/// The trajectory in its room, from above (north up, west left) and from the side (up, north to the right).
fn drawing(situation: &Situation<'_>) -> Vec<String> {
    let limits = situation.limits;
    let (Some(x), Some(y), Some(z_max)) = (limits.x_max_m, limits.y_max_m, limits.z_max_m) else {
        return Vec::new();
    };
    let mut above = Canvas::new((-y, y), (-x, x), ROWS);
    let mut side = Canvas::new((-x, x), (0.0, z_max), ROWS / 2);
    for (_, [x, y, z, _]) in path_samples(situation.path) {
        above.mark((-y[0], x[0]), '.');
        side.mark((x[0], z[0]), '.');
    }
    if let Some(stand_m) = situation.stand_m {
        let stand = stand_m - situation.origin_m;
        above.mark((-stand.y, stand.x), 'o');
        side.mark((stand.x, stand.z), 'o');
    }
    let mut lines = vec![format!("from above, {:.1} by {:.1} m, north up, o: the vehicle", 2.0 * y, 2.0 * x)];
    lines.extend(above.lines());
    lines.push(format!("from the side, {z_max:.1} m high, north to the right, the ground below"));
    lines.extend(side.lines());
    lines
}

/// A rectangle of letters over a rectangle of metres.
struct Canvas {
    across_m: (f64, f64),
    up_m: (f64, f64),
    rows: Vec<[char; COLUMNS]>,
}

impl Canvas {
    fn new(across_m: (f64, f64), up_m: (f64, f64), rows: usize) -> Self {
        Self { across_m, up_m, rows: vec![[' '; COLUMNS]; rows.max(1)] }
    }

    /// Puts a letter at a place, where it is inside.
    fn mark(&mut self, (across, up): (f64, f64), letter: char) {
        let Some(column) = cell(across, self.across_m, COLUMNS) else { return };
        let Some(row) = cell(up, self.up_m, self.rows.len()) else { return };
        let last = self.rows.len() - 1;
        self.rows[last - row][column] = letter;
    }

    fn lines(&self) -> Vec<String> {
        let edge = format!("+{}+", "-".repeat(COLUMNS));
        let inside = self.rows.iter().map(|row| format!("|{}|", row.iter().collect::<String>()));
        std::iter::once(edge.clone()).chain(inside).chain(std::iter::once(edge)).collect()
    }
}

/// Which of `count` cells of a span a value is in.
fn cell(value: f64, (low, high): (f64, f64), count: usize) -> Option<usize> {
    let share = (value - low) / (high - low);
    let cells = count as f64;
    (0..count).find(|index| {
        let from = *index as f64 / cells;
        let is_last = index + 1 == count;
        share >= from && (share < from + 1.0 / cells || is_last && share <= 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_canvas_shows_what_is_inside_and_keeps_its_size() {
        let mut canvas = Canvas::new((-2.0, 2.0), (0.0, 4.0), 4);
        canvas.mark((-2.0, 0.0), 'a');
        canvas.mark((2.0, 4.0), 'b');
        canvas.mark((2.5, 1.0), 'c');
        canvas.mark((f64::NAN, 1.0), 'd');
        let lines = canvas.lines();
        assert_eq!(lines.len(), 6);
        assert!(lines.iter().all(|line| line.chars().count() == COLUMNS + 2));
        assert!(lines[4].starts_with("|a") && lines[1].ends_with("b|"), "{lines:#?}");
        assert!(!lines.concat().contains('c') && !lines.concat().contains('d'));
    }
}
