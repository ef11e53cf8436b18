//! Charts as SVG, self-contained, no scripts. Text and axes take the colour of the page around them.

mod axis;
mod bars;
mod draw;
mod strip;

pub use bars::Bars;
pub use strip::Strip;

use crate::text::markup;
use std::fmt::Write;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// through all points
    #[default]
    Solid,
    /// likewise, broken
    Dashed,
    /// from the axis up to each point
    Stems,
}

/// One line of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// for the legend; none where it is empty
    pub label: String,
    /// abscissa
    pub x: Vec<f64>,
    /// ordinate; what is not finite is left out
    pub y: Vec<f64>,
    /// how
    pub stroke: Stroke,
    /// which of the colours; `None`: its place among the lines
    pub colour: Option<usize>,
}

/// An interval at each abscissa.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Band {
    /// abscissa
    pub x: Vec<f64>,
    /// lower end
    pub low: Vec<f64>,
    /// upper end
    pub high: Vec<f64>,
    /// which of the colours
    pub colour: usize,
}

/// One set of axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// over the axes
    pub title: String,
    /// with its unit
    pub x_label: String,
    /// with its unit
    pub y_label: String,
    /// drawn in order
    pub lines: Vec<Line>,
    /// drawn below the lines
    pub bands: Vec<Band>,
    /// shaded from one abscissa to another
    pub spans: Vec<[f64; 2]>,
    /// words for the shading, for the legend
    pub spans_label: String,
    /// logarithmic abscissa, ordinate
    pub log: (bool, bool),
}

/// Colours that stay apart for most eyes (Okabe and Ito 2008), and the page's own.
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "currentColor"];
/// Dots.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 230.0;

fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// Panels one under the other as one SVG document, dark on white.
#[must_use]
pub fn svg(panels: &[Panel]) -> String {
    let total = HEIGHT * panels.len() as f64;
    let mut out = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {total}" font-family="sans-serif" font-size="11" color="#222" fill="currentColor"><rect width="{WIDTH}" height="{total}" fill="#fff"/>"##
    );
    for (index, panel) in panels.iter().enumerate() {
        let _ = write!(out, r#"<g transform="translate(0 {})">"#, HEIGHT * index as f64);
        draw::panel(&mut out, panel);
        out.push_str("</g>");
    }
    out.push_str("</svg>\n");
    out
}

/// One panel for a page: no background, the page's colour.
#[must_use]
pub fn inline(panel: &Panel) -> String {
    framed(HEIGHT, &panel.title, &mut |out| draw::panel(out, panel))
}

/// An element for a page with a title for those who cannot see it.
fn framed(height: f64, title: &str, draw: &mut dyn FnMut(&mut String)) -> String {
    let mut out = format!(
        r#"<svg viewBox="0 0 {WIDTH} {height:.0}" role="img" fill="currentColor"><title>{}</title>"#,
        markup(title)
    );
    draw(&mut out);
    out.push_str("</svg>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_is_whole_and_escapes_its_words() {
        let line = Line {
            label: "a<b".into(),
            x: vec![0.0, 1.0, 2.0],
            y: vec![1.0, f64::NAN, 3.0],
            ..Line::default()
        };
        let band = Band { x: vec![0.0, 2.0], low: vec![0.5, 2.0], high: vec![1.5, 4.0], colour: 0 };
        let panel = Panel {
            title: "t".into(),
            lines: vec![line],
            bands: vec![band],
            spans: vec![[0.5, 1.0]],
            ..Panel::default()
        };
        let text = svg(std::slice::from_ref(&panel));
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
        assert!(text.contains("a&lt;b") && !text.contains("NaN"));
        // the band's upper end is the highest that is drawn: it has a place inside
        let page = inline(&panel);
        assert!(page.contains("class=\"span\"") && page.contains("fill-opacity") && !page.contains("#fff"));
    }
}
