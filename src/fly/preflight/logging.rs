//! What the autopilot will log of the flight itself, and whether an identification can use it.

use crate::fly::finding::Finding;
use crate::fly::parameters::Parameters;

const SUBJECT: &str = "vehicle's own log";

/// One finding; none for an autopilot whose logging is not known.
pub(super) fn finding(parameters: &Parameters) -> Option<Finding> {
    let stack = parameters.autopilot.stack()?;
    let plan = stack.log_plan(|name| parameters.get(name));
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
    if plan.changes.is_empty() {
        return Some(Finding::ok(SUBJECT, expected, plan.logs.join("; ")));
    }
    let found = plan.changes.iter().map(|change| {
        let restart = if change.restarts { ", after a restart" } else { "" };
        format!("{} = {} and not {}{restart}", change.parameter, change.found, change.wanted)
    });
    let found: Vec<String> = found.chain(plan.logs).collect();
    Some(Finding::warning(SUBJECT, expected, found.join("; "), remedy))
}
