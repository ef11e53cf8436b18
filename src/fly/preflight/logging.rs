//! What the autopilot will log of the flight itself, and whether an identification can use it.

use crate::autopilot::{LogAwaited, LogPlan, Stack};
use crate::fly::finding::Finding;
use crate::fly::parameters::Parameters;

const SUBJECT: &str = "vehicle's own log";

/// One finding; none for an autopilot whose logging is not known. `awaited` are parameters that were set since its start
/// and count only from its next one on.
pub(super) fn finding(parameters: &Parameters, awaited: &[LogAwaited]) -> Option<Finding> {
    let stack = parameters.autopilot.stack()?;
    let plan = stack.log_plan_until_start(|name| parameters.get(name), awaited);
    let expected = "a log that an identification can use";
    let remedy = "--set-logging sets it, and puts it back after the flight";
    if let (true, [_, ..]) = (plan.changes.is_empty(), plan.unknown.as_slice()) {
        let came = format!("no answer for {}", plan.unknown.join(", "));
        return Some(Finding::warning(
            SUBJECT,
            expected,
            came,
            "the recording of the link is there in any case",
        ));
    }
    if plan.changes.is_empty() && !awaited.is_empty() {
        let list = awaited.iter().map(|LogAwaited { parameter, set, runs_by }| {
            format!("{parameter} = {set} was set since the autopilot's last start, it runs by {runs_by}")
        });
        let came: Vec<String> = list.chain(plan.logs).collect();
        let remedy = "restart the autopilot (mavid log prepare --set-logging --restart does it)";
        return Some(Finding::warning(SUBJECT, expected, came.join("; "), remedy));
    }
    if plan.changes.is_empty() {
        return Some(Finding::ok(SUBJECT, expected, enough(stack, &plan)));
    }
    let found = plan.changes.iter().map(|change| {
        let restart = if change.restarts { ", after a restart" } else { "" };
        format!("{} = {} and not {}{restart}", change.parameter, change.found, change.needed)
    });
    let found: Vec<String> = found.chain(plan.logs).collect();
    Some(Finding::warning(SUBJECT, expected, found.join("; "), remedy))
}

/// What it logs; a value that somebody set since its start is not told from one that it started with.
fn enough(stack: &Stack, plan: &LogPlan) -> String {
    let logs = plan.logs.join("; ");
    match stack.log_rates_from_start() {
        Some(name) => format!("{logs}, if {name} was not changed since the autopilot's last start"),
        None => logs,
    }
}
