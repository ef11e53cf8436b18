//! What the vehicle does after setpoints and heartbeats have ended and it has come to rest.

use super::Situation;
use crate::autopilot::{ARDUPILOT, Autopilot, PX4, Reaction};
use crate::fly::finding::Finding;
use crate::fly::law::stated;
use crate::fly::parameters::hears_station;

/// Subject of the findings on the end of this program.
pub(super) const SUBJECT: &str = "if setpoints end";

const EXPECTED: &str = "a mode that stops it and keeps it in the room";
const MOTORS_ON: &str = "motors that run until it has landed";
/// Least height of ArduPilot's return, m (RTL_ALT_MIN in its source).
const RTL_LEAST_M: f64 = 0.3;
/// Least RTL_CONE_SLOPE that ArduPilot uses; it treats a smaller one as no cone.
const LEAST_SLOPE: f64 = 0.5;

/// Largest distances of a vehicle that receives nothing more, m from home.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Abandoned {
    /// along the ground
    pub farthest_m: f64,
    /// above it
    pub highest_m: f64,
}

/// Findings about failsafes that lead out of the room or drop the vehicle.
pub(super) fn findings(situation: &Situation<'_>, at: Abandoned) -> Vec<Finding> {
    match situation.parameters.autopilot {
        Autopilot::Px4 => px4(situation),
        Autopilot::ArduPilot => ardupilot(situation, at).into_iter().collect(),
        Autopilot::Other | Autopilot::Unknown => Vec::new(),
    }
}

/// A parameter's value as one of a list.
fn choice(situation: &Situation<'_>, name: &str) -> Option<f64> {
    situation.parameters.get(name).map(f64::round)
}

/// PX4's reaction by a failsafe's parameter.
fn px4_reaction(name: &str, value: Option<f64>) -> Option<Reaction> {
    Some(PX4.failsafe(name)?.choice(value?)?.reaction)
}

fn is_one_of(value: Option<f64>, of: &[f64]) -> bool {
    value.is_some_and(|value| of.iter().any(|one| (value - one).abs() < 0.5))
}

/// COM_OBL_RC_ACT when the setpoints end, then NAV_DLL_ACT when no ground station is heard.
fn px4(situation: &Situation<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let (setpoints, station) = (choice(situation, "COM_OBL_RC_ACT"), choice(situation, "NAV_DLL_ACT"));
    let stopped = px4_reaction("COM_OBL_RC_ACT", setpoints);
    let unheard_of = px4_reaction("NAV_DLL_ACT", station);
    let mut warn = |expected, came: String, remedy: &str| {
        findings.push(Finding::warning(SUBJECT, expected, came, remedy));
    };
    let land = "set COM_OBL_RC_ACT to 4 (land) or 5 (hold)";
    let value = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let climbs = || {
        let most_m = situation.highest_m()?;
        let height_m = situation.parameters.get("RTL_RETURN_ALT").filter(|height_m| *height_m > most_m)?;
        Some(format!(
            "a return that climbs to {height_m:.0} m above home (RTL_RETURN_ALT), the ceiling allows {most_m:.1} m"
        ))
    };
    if stopped == Some(Reaction::StopMotors) {
        let came = format!("motors that stop in the air (COM_OBL_RC_ACT = {})", value(setpoints));
        warn(MOTORS_ON, came, land);
    } else if matches!(stopped, Some(Reaction::Altitude | Reaction::Stabilized)) {
        let came = format!("a mode that does not stop it (COM_OBL_RC_ACT = {})", value(setpoints));
        warn(EXPECTED, came, land);
    } else if stopped == Some(Reaction::Return)
        && let Some(came) = climbs()
    {
        warn(EXPECTED, came, land);
    }
    let after = situation.parameters.get("COM_DL_LOSS_T");
    let after =
        after.map_or_else(|| "COM_DL_LOSS_T".to_owned(), |seconds| format!("{seconds:.0} s (COM_DL_LOSS_T)"));
    let unheard = format!("once no ground station is heard for {after} (NAV_DLL_ACT = {})", value(station));
    let remedy = "set NAV_DLL_ACT to 3 (land), or to 1 (hold)";
    if unheard_of == Some(Reaction::StopMotors) {
        warn(MOTORS_ON, format!("motors that stop in the air {unheard}"), remedy);
    } else if unheard_of == Some(Reaction::Return)
        // its landing goes before a return, and is over when the motors stop
        && !matches!(stopped, Some(Reaction::Return | Reaction::Land | Reaction::StopMotors))
        && let Some(came) = climbs()
    {
        warn(EXPECTED, format!("{came}, {unheard}"), remedy);
    }
    findings
}

/// FS_GCS_ENABLE: most of its choices return, which begins with a climb.
fn ardupilot(situation: &Situation<'_>, at: Abandoned) -> Option<Finding> {
    let parameters = situation.parameters;
    let enable = choice(situation, "FS_GCS_ENABLE").filter(|enable| *enable > 0.0)?;
    // 4, 5 and 7 land or brake
    if is_one_of(Some(enable), &[4.0, 5.0, 7.0]) {
        return None;
    }
    // it notices the loss of the station that it was told
    let listens_to = parameters.get("SYSID_MYGCS");
    if listens_to.is_some_and(|system| !hears_station(parameters, system, situation.own_system)) {
        return None;
    }
    let allowed_m = situation.highest_m()?;
    let height_m = highest_return(situation, at);
    if height_m <= allowed_m {
        return None;
    }
    let way = if is_one_of(Some(enable), &[3.0]) {
        "a return that, if it cannot take the way it came, climbs"
    } else {
        "a return that climbs"
    };
    let name = parameters.name_of("RTL_ALT");
    let assumed = if parameters.get("RTL_ALT").is_some() { "" } else { ", assumed: it did not answer" };
    let came = format!(
        "{way} to {height_m:.1} m above home ({name}{assumed}), once no heartbeat of ours came for {} (FS_GCS_ENABLE = \
         {enable}), the ceiling allows {allowed_m:.1} m",
        parameters
            .get("FS_GCS_TIMEOUT")
            .map_or_else(|| "FS_GCS_TIMEOUT".to_owned(), |seconds| format!("{seconds:.0} s")),
    );
    let land = "set FS_GCS_ENABLE to 5 (land)";
    let adds = stated(parameters, &ARDUPILOT, "RTL_CLIMB_MIN") > 0.0;
    let remedy = if adds {
        land.to_owned()
    } else {
        // rounded down in the vehicle's own unit
        let most = (10.0 * parameters.in_own_unit("RTL_ALT", 100.0 * allowed_m)).floor() / 10.0;
        format!("{land}, or {name} to {most} or less")
    };
    Some(Finding::warning(SUBJECT, EXPECTED, came, remedy))
}

/// The greatest height (m above home) to which a return climbs from where it is when nothing more is heard
/// (`ModeRTL::compute_return_target`).
fn highest_return(situation: &Situation<'_>, at: Abandoned) -> f64 {
    let stated = |name: &str| stated(situation.parameters, &ARDUPILOT, name);
    let height_m = stated("RTL_ALT");
    let climb_m = stated("RTL_CLIMB_MIN").max(0.0);
    let slope = stated("RTL_CONE_SLOPE");
    let least_m = (at.highest_m + climb_m).max(RTL_LEAST_M);
    let target_m = height_m.max(least_m);
    if slope < LEAST_SLOPE {
        return target_m;
    }
    target_m.min((slope * at.farthest_m).max(least_m))
}
