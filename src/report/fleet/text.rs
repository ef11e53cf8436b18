//! The page of a fleet for the terminal.

use super::words::{alarms, answer, change_sentence, differs, logs};
use crate::fleet::FleetReport;
use std::fmt::Write;

/// Outliers that are listed; the others are in the document.
const MOST: usize = 20;

/// The page for the terminal.
#[must_use]
pub fn fleet_text(report: &FleetReport) -> String {
    let mut page = format!("{}\n", answer(report));
    for vehicle in report.changed() {
        let _ = writeln!(page, "  {}", change_sentence(vehicle));
    }
    let _ = writeln!(page, "\n{}", alarms(report));
    if !report.outliers.is_empty() {
        page.push_str("\nDifferent from the others of their type\n");
    }
    for outlier in report.outliers.iter().take(MOST) {
        let _ = writeln!(page, "  {}", differs(outlier));
    }
    if report.outliers.len() > MOST {
        let _ = writeln!(page, "  and {} more", report.outliers.len() - MOST);
    }
    let _ = writeln!(page, "\n{}", logs(report));
    if !report.without_history.is_empty() {
        let _ =
            writeln!(page, "Without a flight that shows a balance: {}", report.without_history.join(", "));
    }
    page.trim_end().to_owned()
}
