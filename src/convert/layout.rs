//! Layouts in which other people's programs open what was converted.

use super::series::TimeSeries;
use crate::text;
use serde_json::{Value, json};

/// Quantities that a layout shows, from above.
const SHOWN: [&str; 6] =
    ["position", "velocity", "angular_rate", "specific_force", "actuator_command", "residual"];

/// The series that a layout shows, group by group.
fn groups(all: &[TimeSeries]) -> Vec<Vec<&TimeSeries>> {
    let of = |quantity: &str| -> Vec<&TimeSeries> {
        let own = |series: &&TimeSeries| {
            series.name.split('/').next().is_some_and(|name| name.starts_with(quantity))
        };
        all.iter().filter(own).collect()
    };
    SHOWN.iter().map(|quantity| of(quantity)).filter(|group| !group.is_empty()).collect()
}

/// A layout for Foxglove: a plot for each group, and the vehicle in space.
#[must_use]
pub fn foxglove_layout(all: &[TimeSeries]) -> String {
    let mut panels = serde_json::Map::new();
    let mut names: Vec<String> = vec!["3D!vehicle".to_owned()];
    panels.insert(
        "3D!vehicle".to_owned(),
        json!({ "followTf": "world", "topics": { "/pose": { "visible": true } } }),
    );
    for (place, group) in groups(all).iter().enumerate() {
        let paths: Vec<Value> = group
            .iter()
            .flat_map(|series| {
                let topic = format!("/{}", series.name.replace(' ', "_"));
                series.columns.iter().map(move |column| {
                    json!({ "value": format!("{topic}.{column}"), "enabled": true, "timestampMethod": "receiveTime" })
                })
            })
            .collect();
        let name = format!("Plot!group{place}");
        panels.insert(name.clone(), json!({ "paths": paths, "showLegend": true, "isSynced": true }));
        names.push(name);
    }
    let layout = names
        .into_iter()
        .map(Value::from)
        .reduce(|first, second| json!({ "direction": "column", "first": first, "second": second }));
    let document = json!({
        "configById": panels, "globalVariables": {}, "userNodes": {}, "layout": layout,
        "playbackConfig": { "speed": 1 },
    });
    text::json_pretty(&document).unwrap_or_default()
}

/// A layout for PlotJuggler: a plot for each group.
#[must_use]
pub fn plotjuggler_layout(all: &[TimeSeries]) -> String {
    let groups = groups(all);
    let share = 1.0 / groups.len().max(1) as f64;
    let sizes = groups.iter().map(|_| share.to_string()).collect::<Vec<_>>().join(";");
    let mut out = format!(
        "<?xml version='1.0' encoding='UTF-8'?>\n<root>\n <tabbed_widget parent=\"main_window\" name=\"Main Window\">\n  <Tab \
         tab_name=\"flight\" containers=\"1\">\n   <Container>\n    <DockSplitter orientation=\"-\" sizes=\"{sizes}\" count=\"{}\">\n",
        groups.len()
    );
    for group in groups {
        out.push_str("     <DockArea name=\"...\">\n      <plot style=\"Lines\" mode=\"TimeSeries\">\n");
        for series in group {
            let topic = format!("/{}", series.name.replace(' ', "_"));
            for column in &series.columns {
                let curve = text::markup(&format!("{topic}/{column}"));
                out.push_str(&format!("       <curve name=\"{curve}\"/>\n"));
            }
        }
        out.push_str("      </plot>\n     </DockArea>\n");
    }
    out.push_str("    </DockSplitter>\n   </Container>\n  </Tab>\n  <currentTabIndex index=\"0\"/>\n </tabbed_widget>\n</root>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_name_the_series_that_are_there() {
        let series = |name: &str| TimeSeries {
            name: name.to_owned(),
            columns: vec!["x".to_owned()],
            unit: "",
            time_s: vec![0.0],
            values: vec![1.0],
        };
        let all = [series("position/LOCAL"), series("residual/force x"), series("mode/HEARTBEAT")];
        let foxglove = foxglove_layout(&all);
        let document: Value = serde_json::from_str(&foxglove).unwrap();
        assert_eq!(document["configById"]["Plot!group1"]["paths"][0]["value"], "/residual/force_x.x");
        let juggler = plotjuggler_layout(&all);
        assert!(juggler.contains("<curve name=\"/position/LOCAL/x\"/>") && !juggler.contains("HEARTBEAT"));
    }
}
