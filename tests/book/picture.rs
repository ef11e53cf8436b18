//! The picture of an effect's signature, drawn by the program's own charts.

use super::measured::{Chart, Measured};
use mavid::report::{Band, Line, Panel, svg};

/// Colours of the residual of the rigid body and of the model found, as in the report.
const BEFORE: usize = 1;
const AFTER: usize = 2;

/// The SVG; `None` where no flight with the effect was measured.
pub fn svg_of(id: &str, measured: &Measured) -> Option<String> {
    let picture = measured.pictures.iter().find(|picture| picture.id == id)?;
    let panels: Vec<Panel> = picture.panels.iter().map(panel).collect();
    Some(svg(&panels))
}

fn panel(chart: &Chart) -> Panel {
    let line = |label: &str, y: &[f64], colour| Line {
        label: label.to_owned(),
        x: chart.x.clone(),
        y: y.to_vec(),
        colour: Some(colour),
        ..Line::default()
    };
    let band = Band { x: chart.x.clone(), low: chart.low.clone(), high: chart.high.clone(), colour: BEFORE };
    Panel {
        title: chart.title.clone(),
        x_label: chart.x_label.clone(),
        y_label: chart.y_label.clone(),
        lines: vec![line("rigid body", &chart.before, BEFORE), line("model found", &chart.after, AFTER)],
        bands: if chart.low.is_empty() { Vec::new() } else { vec![band] },
        ..Panel::default()
    }
}
