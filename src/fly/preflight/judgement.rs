//! The result of all checks before a flight.

use super::failsafes::failsafes;
use super::page::Page;
use super::situation::Situation;
use super::stopping::Stopping;
use super::{abandoned, autopilot, energy, fence_clearance, hover, logging, readiness, room};
use crate::fly::finding::Finding;
use crate::fly::safety::Feeding;
use crate::plan::Extremes;

/// Checks everything. Each finding says what was expected, what was found, and what to do. The vehicle may be armed if
/// none of them is a [`Level::Refusal`](crate::fly::finding::Level::Refusal).
#[must_use]
pub fn preflight(situation: &Situation<'_>) -> Vec<Finding> {
    judge(situation).findings
}

/// As [`preflight`], with the chosen kind of setpoint.
#[must_use]
pub fn judge(situation: &Situation<'_>) -> Judged {
    let extremes = Extremes::of(situation.path, situation.vehicle);
    let stopping = Stopping::of(situation.parameters, situation.limits, situation.vehicle.gravity_m_s2);
    let mut findings = room::findings(situation, &stopping);
    findings.extend(fence_clearance::findings(situation, &stopping));
    let (feeding, abandoned) = abandoned::judge(situation);
    findings.extend(abandoned);
    findings.extend(autopilot::findings(situation.parameters, &extremes));
    findings.extend(hover::findings(situation));
    findings.extend(logging::finding(situation.parameters, situation.log_awaited));
    findings.push(energy::finding(situation.battery, situation.duration_s()));
    findings.extend(readiness::findings(situation.readiness, situation.parameters.autopilot));
    findings.extend(failsafes(situation));
    let page = Page::new(situation, &findings);
    Judged { findings, feeding, page }
}

/// Findings, and the kind of setpoint to be sent.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// one for each check
    pub findings: Vec<Finding>,
    /// the kind of setpoint, which is safe if any setpoint is the last
    pub feeding: Feeding,
    /// page for the operator
    pub page: Page,
}
