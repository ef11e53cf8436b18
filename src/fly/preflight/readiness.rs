//! Whether the vehicle itself is ready.

use crate::autopilot::{Autopilot, Mode};
use crate::fly::finding::Finding;
use std::time::Duration;

/// Time for which the estimate must have been good. An estimator that has just converged can lose its position again;
/// longer only delays the flight.
pub const ESTIMATE_GOOD_FOR: Duration = Duration::from_secs(5);

/// Readiness of the vehicle by its own reports.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Readiness {
    /// its own pre-arm checks; `None` without a report
    pub may_arm: Option<bool>,
    /// reported reasons why not (STATUSTEXT)
    pub reasons: Vec<String>,
    /// parts that are on and not healthy
    pub unhealthy: Vec<String>,
    /// for how long the position estimate has been good; `None` where nothing is known of it
    pub estimate_good_for: Option<Duration>,
    /// what is wrong with the estimate
    pub estimate_faults: Vec<String>,
    /// home is set
    pub home_set: bool,
    /// position and velocity in the local frame arrive
    pub position_arrives: bool,
    /// motors may turn already
    pub armed: bool,
}

pub(super) fn findings(readiness: &Readiness, autopilot: Autopilot) -> Vec<Finding> {
    let mut findings = vec![estimate(readiness), pre_arm(readiness, autopilot)];
    findings.push(if readiness.unhealthy.is_empty() {
        Finding::ok("health", "every part healthy", "no fault reported")
    } else {
        let remedy = "read the reason in the messages of the vehicle";
        Finding::refusal("health", "every part healthy", readiness.unhealthy.join(", "), remedy)
    });
    findings.push(if readiness.home_set {
        Finding::ok("home", "set", "set")
    } else {
        let remedy = "wait for a position estimate, or set home: a return would lead nowhere";
        Finding::refusal("home", "set", "not set", remedy)
    });
    if readiness.armed {
        let remedy = "land and disarm first: a flight begins on the ground";
        findings.push(Finding::refusal("arming", "disarmed, on the ground", "armed", remedy));
    }
    findings
}

fn estimate(readiness: &Readiness) -> Finding {
    let expected = format!("good for {} s", ESTIMATE_GOOD_FOR.as_secs());
    let remedy = "wait; if it stays so, look for GPS reception, compass and the position source";
    if !readiness.position_arrives {
        return Finding::refusal("estimate", expected, "no local position arrives", remedy);
    }
    match readiness.estimate_good_for {
        _ if !readiness.estimate_faults.is_empty() => {
            Finding::refusal("estimate", expected, readiness.estimate_faults.join(", "), remedy)
        }
        None => Finding::warning("estimate", expected, "no report of its health", remedy),
        Some(good_for) if good_for < ESTIMATE_GOOD_FOR => {
            let came = format!("good for {:.1} s", good_for.as_secs_f64());
            Finding::refusal("estimate", expected, came, "wait")
        }
        Some(good_for) => {
            Finding::ok("estimate", expected, format!("good for {:.0} s", good_for.as_secs_f64()))
        }
    }
}

fn pre_arm(readiness: &Readiness, autopilot: Autopilot) -> Finding {
    let expected = "the autopilot's own checks passed";
    let said = if readiness.reasons.is_empty() {
        "no reason given".to_owned()
    } else {
        readiness.reasons.join("; ")
    };
    let depends = autopilot.stack().filter(|stack| stack.setpoints.position_checked_in_mode);
    let remedy = depends.map_or_else(
        || "correct what it names".to_owned(),
        |stack| {
            let mode = stack.name_of(Mode::External);
            format!("its checks depend on the mode: set {mode}, then wait for the position estimate")
        },
    );
    match readiness.may_arm {
        Some(true) => Finding::ok("pre-arm", expected, "passed"),
        Some(false) => Finding::refusal("pre-arm", expected, format!("failed: {said}"), remedy),
        None => Finding::warning("pre-arm", expected, "not said", "it will refuse to arm if they fail"),
    }
}
