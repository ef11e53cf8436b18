//! Everything that is checked before a vehicle is armed: the whole trajectory against fence, room, vehicle
//! and autopilot, and whether the vehicle is ready.

mod abandoned;
mod autopilot;
mod energy;
mod extremes;
mod fence;
mod fence_download;
mod hover;
mod page;
mod readiness;
mod room;

pub use energy::{BatteryState, SPARE_FACTOR};
pub use extremes::{Extremes, Stopping};
pub use fence::Fence;
pub use fence_download::{FenceDownload, FenceOutcome};
pub(crate) use hover::{HOVER, ROTORS};
pub use page::Page;
pub use readiness::{ESTIMATE_GOOD_FOR, Readiness};

use super::finding::{Finding, Level};
use super::parameters::{Parameters, failsafe_declaration, takeover_declaration};
use super::safety::Feeding;
use crate::trajectory::FlightPath;
use crate::vehicle::{Limits, Vehicle};
use nalgebra::Vector3;

/// What is known before the flight.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// the whole flight from hover after takeoff to hover before landing, m and rad, NWU
    pub path: &'a FlightPath,
    /// where the path's origin lies in the autopilot's local frame, m, NWU
    pub origin_m: Vector3<f64>,
    /// where the vehicle stands in the autopilot's local frame, m, NWU
    pub stand_m: Option<Vector3<f64>>,
    /// home in the autopilot's local frame, m, NWU
    pub home_m: Option<Vector3<f64>>,
    /// what flies
    pub vehicle: &'a Vehicle,
    /// room and limits to keep, in the path's frame
    pub limits: &'a Limits,
    /// distance to the reference that is allowed, m
    pub tracking_max_m: f64,
    /// what the vehicle said of its parameters
    pub parameters: &'a Parameters,
    /// major and minor number of the autopilot's release, where it said so
    pub release: Option<(u8, u8)>,
    /// the vehicle's fence
    pub fence: &'a Fence,
    /// charge
    pub battery: &'a BatteryState,
    /// health, estimate, home
    pub readiness: &'a Readiness,
    /// the ground station's MAVLink system id
    pub own_system: u8,
}

/// Checks everything; each finding says what was expected, what came, and what to do. The vehicle may
/// be armed where none of them is a [`Level::Refusal`].
#[must_use]
pub fn preflight(situation: &Situation<'_>) -> Vec<Finding> {
    judge(situation).findings
}

/// What the checks found, and how setpoints are to be sent.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// one a check
    pub findings: Vec<Finding>,
    /// safe, as far as anything is, if any setpoint is the last
    pub feeding: Feeding,
    /// for people
    pub page: Page,
}

/// As [`preflight`], with the way of sending setpoints that it chose.
#[must_use]
pub fn judge(situation: &Situation<'_>) -> Judged {
    let extremes = Extremes::of(situation.path, situation.vehicle);
    let stopping = Stopping::of(situation.parameters, situation.limits, situation.vehicle.gravity_m_s2);
    let mut findings = room::findings(situation, &stopping);
    findings.extend(fence::findings(situation, &stopping));
    let (feeding, abandoned) = abandoned::judge(situation);
    findings.extend(abandoned);
    findings.extend(autopilot::findings(situation.parameters, &extremes));
    findings.extend(hover::findings(situation));
    findings.push(energy::finding(situation.battery, situation.path.duration_s()));
    findings.extend(readiness::findings(situation.readiness, situation.parameters.autopilot));
    findings.extend(failsafes(situation));
    let page = Page::new(situation, &findings);
    Judged { findings, feeding, page }
}

/// Subject of what is said of the pilot's way to take over.
pub(super) const TAKEOVER: &str = "pilot's takeover";

fn failsafes(situation: &Situation<'_>) -> Vec<Finding> {
    let said = failsafe_declaration(situation.parameters, situation.own_system);
    let warning = |text: String| {
        let remedy = "set the parameter on the vehicle, or accept it knowingly";
        Finding::warning("failsafe", "a declared and safe end", text, remedy)
    };
    let failsafes = said.into_iter().map(|sentence| match sentence.level {
        Level::Ok => Finding::ok("failsafe", "a declared and safe end", sentence.text),
        Level::Awaited | Level::Warning | Level::Refusal => warning(sentence.text),
    });
    let takeover = takeover_declaration(situation.parameters).into_iter().map(|sentence| {
        let expected = "a pilot who can take over";
        match sentence.level {
            Level::Ok => Finding::ok(TAKEOVER, expected, sentence.text),
            _ => Finding::warning(
                TAKEOVER,
                expected,
                sentence.text,
                "set one up, or fly where nobody needs it",
            ),
        }
    });
    failsafes.chain(takeover).collect()
}
