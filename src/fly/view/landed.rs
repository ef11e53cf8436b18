//! The view after the landing: how the flight went, what is worked out, and the answer.

use super::instruments::bar;
use crate::text::wrapped;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Block, Paragraph};

/// Columns of the bar of counted steps.
const BAR_COLUMNS: usize = 20;

/// A stage of the analysis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StageView {
    /// in words
    pub name: String,
    /// s since it began, or that it took
    pub elapsed_s: f64,
    /// steps that are done, and all of them, where they are counted
    pub steps: Option<(u64, u64)>,
    /// what the steps are, in the plural
    pub counted: &'static str,
    /// how many steps there are is an estimate
    pub is_estimate: bool,
}

impl StageView {
    /// s that are left, by the steps that are done; `None` where they are not counted, or none is done.
    #[must_use]
    pub fn left_s(&self) -> Option<f64> {
        let (done, all) = self.steps.filter(|(done, _)| *done > 0)?;
        Some(self.elapsed_s * all.saturating_sub(done) as f64 / done as f64)
    }

    fn line(&self) -> String {
        let Self { name, elapsed_s, counted, .. } = self;
        match (self.steps, self.left_s()) {
            (Some((done, all)), Some(left_s)) if done < all => {
                let bar = bar(done as f64 / all.max(1) as f64, BAR_COLUMNS);
                match self.is_estimate {
                    true => format!("{name}  {bar} about {left_s:.0} s left"),
                    false => format!("{name}  {bar} {done} of {all} {counted}, {left_s:.0} s left"),
                }
            }
            _ => format!("{name}, {elapsed_s:.0} s"),
        }
    }
}

/// Content of the view after the landing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LandedView {
    /// vehicle
    pub title: String,
    /// how the flight went, line by line
    pub flown: Vec<String>,
    /// the stages of the analysis so far, the last of which goes on while there is no answer
    pub stages: Vec<StageView>,
    /// what is to be known of the data
    pub notes: Vec<String>,
    /// the answer, or why there is none
    pub answer: Option<String>,
    /// the view stays until a key is pressed
    pub stays: bool,
}

/// Draws the view after the landing.
pub fn render_landed(frame: &mut Frame<'_>, view: &LandedView) {
    let columns = usize::from(frame.area().width.saturating_sub(2)).max(1);
    let lines = |texts: &[String]| -> Vec<Line<'static>> {
        texts.iter().flat_map(|text| wrapped(text, columns)).map(Line::raw).collect()
    };
    let flown = lines(&view.flown);
    let mut analysis = lines(&view.stages.iter().map(StageView::line).collect::<Vec<_>>());
    analysis.extend(lines(&view.notes).into_iter().map(|line| line.style(Color::Yellow)));
    let answer: Vec<Line<'_>> = match &view.answer {
        Some(answer) => {
            let bold = Style::new().add_modifier(Modifier::BOLD);
            answer
                .lines()
                .flat_map(|line| wrapped(line, columns))
                .map(|line| Line::styled(line, bold))
                .collect()
        }
        None => vec![Line::raw("not yet: the flight is analysed")],
    };
    let rows = |lines: &[Line<'_>]| u16::try_from(lines.len() + 2).unwrap_or(u16::MAX);
    // the answer is seen whole whatever else has to go
    let [head, of_answer, of_flight, of_analysis, foot] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(rows(&answer)),
        Constraint::Max(rows(&flown)),
        Constraint::Min(0),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    let title = Line::styled(format!("{}  after the landing", view.title), Modifier::BOLD);
    frame.render_widget(Paragraph::new(title), head);
    boxed(frame, "Answer", answer, of_answer);
    boxed(frame, "Flight", flown, of_flight);
    // what is worked on now is at the end
    let shown = usize::from(of_analysis.height.saturating_sub(2));
    let first = analysis.len().saturating_sub(shown);
    boxed(frame, "Analysis", analysis.split_off(first), of_analysis);
    let help = match (&view.answer, view.stays) {
        (Some(_), true) => "Enter goes on",
        (Some(_), false) => "",
        (None, _) => "Ctrl-C ends the analysis; the recording is in its file",
    };
    frame.render_widget(Paragraph::new(Line::raw(help)), foot);
}

fn boxed(frame: &mut Frame<'_>, title: &str, lines: Vec<Line<'_>>, area: Rect) {
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(title.to_owned())), area);
}
