//! A chart as an SVG document, or as an element of a page.

use super::data::{numbers, table};
use super::draw::{HEIGHT, drawing};
use super::frame::{WIDTH, framed};
use super::panel::Panel;
use crate::text::clean_lines;
use maud::{Markup, html};

/// Panels one below the other as one SVG document, dark on white.
#[must_use]
pub fn svg(panels: &[Panel]) -> String {
    let total = HEIGHT * panels.len() as f64;
    let placed = panels.iter().enumerate().map(|(index, panel)| (HEIGHT * index as f64, panel));
    let document = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (WIDTH) " " (total) }
            font-family="sans-serif" font-size="11" color="#222" fill="currentColor" {
            rect width=(WIDTH) height=(total) fill="#fff" {}
            @for (y, panel) in placed {
                g transform={ "translate(0 " (y) ")" } { (drawing(panel)) }
            }
        }
        "\n"
    };
    clean_lines(&document.into_string()).into_owned()
}

/// One panel for a page: no background, the page's colour. It brings its numbers, for the page's script and as a table.
#[must_use]
pub fn inline(panel: &Panel) -> Markup {
    html! {
        div.plot { (framed(HEIGHT, &panel.title, &drawing(panel))) (numbers(panel)) }
        (table(panel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::panel::{Band, Line};

    #[test]
    fn a_chart_is_whole_and_escapes_its_words() {
        let line = Line {
            label: "a<b\u{1b}".into(),
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
        assert!(text.contains("a&lt;b") && !text.contains("NaN") && !text.contains('\u{1b}'));
        // the band's upper end is the highest that is drawn: it has a place inside
        let page = inline(&panel).into_string();
        assert!(page.contains("class=\"span\"") && page.contains("fill-opacity") && !page.contains("#fff"));
    }
}
