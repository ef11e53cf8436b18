//! A trajectory that the autopilot follows: its limits in GUIDED or OFFBOARD bound what is planned.

use std::path::Path;

use mavid::autopilot::Bounded;
use mavid::config::{read_limits, read_trajectory};
use mavid::fly::parameters::Parameters;
use mavid::fly::preflight::{LIMIT_RESERVE, LimitShortfall, limit_shortfalls};
use mavid::fly::{Around, Course};
use mavid::plan::Extremes;
use mavid::text::compact;
use mavid::vehicle::{Limits, Vehicle};

use super::context::Context;
use crate::commands::{CommandError, output};

/// The accelerations along both horizontal axes are bounded one by one, and the autopilot bounds them together.
const HORIZONTAL_SHARE: f64 = 0.85;
/// Up or down there is one axis.
const VERTICAL_SHARE: f64 = 0.98;
/// The line above the bounds that are added to the limits.
const ADDED: &str = "# what the autopilot's own limits let it follow (remove these lines to state others)";

/// The course of a trajectory with its ways, inside the limits of the folder.
///
/// # Errors
/// It cannot be read, or it does not keep them.
pub fn course(
    context: &Context<'_>,
    vehicle: &Vehicle,
    trajectory: &Path,
) -> Result<(Course, Limits), CommandError> {
    let stored = read_trajectory(trajectory)?;
    let limits = read_limits(&context.folder.limits())?;
    let around = stored.transitions.map(|stored| Around {
        takeoff: stored.takeoff,
        landing: stored.landing,
        to_start_s: stored.to_start_s,
        to_landing_s: stored.to_landing_s,
    });
    let course = Course::new(&stored.series, stored.repeats, around.as_ref(), &limits, vehicle);
    Ok((course.map_err(|error| CommandError::Failure(error.to_string()))?, limits))
}

/// The limits that the autopilot does not follow the trajectory within, where its parameters are known; they are added to those
/// of the folder, for a calmer trajectory. Empty: it is followed, or a person states accelerations there.
///
/// # Errors
/// A file cannot be read or written.
pub fn calmed(
    context: &Context<'_>,
    vehicle: &Vehicle,
    trajectory: &Path,
) -> Result<Vec<LimitShortfall>, CommandError> {
    let Ok(text) = std::fs::read_to_string(context.folder.parameters()) else { return Ok(Vec::new()) };
    let Ok(parameters) = Parameters::from_toml(&text, "parameters.toml") else { return Ok(Vec::new()) };
    let (course, limits) = course(context, vehicle, trajectory)?;
    let extremes = Extremes::of(course.path(), vehicle);
    let shortfalls = limit_shortfalls(&parameters, &extremes);
    let path = context.folder.limits();
    let file = std::fs::read_to_string(&path).unwrap_or_default();
    let stated = file.split(ADDED).next().unwrap_or_default();
    if shortfalls.is_empty() || file == stated && states_acceleration(&limits) {
        return Ok(Vec::new());
    }
    let Some(added) = bounds(&extremes, &shortfalls) else { return Ok(Vec::new()) };
    output::file(&path, &format!("{}\n{ADDED}\n{added}", stated.trim_end()))?;
    if read_limits(&path).is_ok_and(|limits| states_acceleration(&limits)) {
        return Ok(shortfalls);
    }
    // a file of other tables than [limits]: a person's own
    output::file(&path, &file)?;
    Ok(Vec::new())
}

fn states_acceleration(limits: &Limits) -> bool {
    limits.acceleration_max_m_s2.is_some() || limits.vertical_acceleration_max_m_s2.is_some()
}

/// Accelerations with which the autopilot follows: all demands of a trajectory shrink with them. `None` where none would help.
fn bounds(extremes: &Extremes, shortfalls: &[LimitShortfall]) -> Option<String> {
    let share = |of: [Bounded; 2]| {
        let short = shortfalls.iter().filter(|shortfall| of.contains(&shortfall.bounded));
        short.map(|short| short.limit / (LIMIT_RESERVE * short.needed)).reduce(f64::min)
    };
    let horizontal = share([Bounded::HorizontalAcceleration, Bounded::HorizontalJerk]);
    let vertical = share([Bounded::VerticalAcceleration, Bounded::VerticalJerk]);
    if horizontal.is_none() && vertical.is_none() {
        return None;
    }
    let rounded = |value: f64| (1e3 * value).floor() / 1e3;
    let across =
        rounded(extremes.horizontal_acceleration_m_s2 * horizontal.unwrap_or(1.0) * HORIZONTAL_SHARE);
    let up = rounded(extremes.vertical_acceleration_m_s2 * vertical.unwrap_or(1.0) * VERTICAL_SHARE);
    let across = horizontal.map(|_| format!("acceleration_max_m_s2 = {across:?}   # along each axis\n"));
    let up = format!("vertical_acceleration_min_m_s2 = -{up:?}\nvertical_acceleration_max_m_s2 = {up:?}\n");
    Some(across.unwrap_or_default() + &up)
}

/// What is said before a trajectory is planned that is calmer than the room allows.
pub fn words(shortfalls: &[LimitShortfall]) -> String {
    let one = |short: &LimitShortfall| {
        format!("{} to {} or more (now {})", short.name, compact(short.advised), compact(short.value))
    };
    let list: Vec<String> = shortfalls.iter().map(one).collect();
    format!(
        "the autopilot's own limits are too low for this trajectory: a calmer one is planned, which tells less. For a livelier \
         flight set {} on the vehicle, remove limits.toml and plan.toml, and give the same command again",
        list.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_of_the_autopilot_bound_what_is_planned() {
        let extremes = Extremes {
            horizontal_acceleration_m_s2: 3.0,
            vertical_acceleration_m_s2: 1.5,
            ..Extremes::default()
        };
        let short = |bounded, limit, needed| LimitShortfall {
            bounded,
            limit,
            needed,
            name: "PSC_JERK_XY".to_owned(),
            value: limit,
            advised: LIMIT_RESERVE * needed,
        };
        let jerk = short(Bounded::HorizontalJerk, 5.0, 10.0);
        let lines = bounds(&extremes, std::slice::from_ref(&jerk)).unwrap();
        // 3 m/s^2 * 5 / (1.3 * 10) * 0.85
        assert!(lines.starts_with("acceleration_max_m_s2 = 0.98"), "{lines}");
        assert!(lines.contains("vertical_acceleration_max_m_s2 = 1.47\n"), "{lines}");
        let up = bounds(&extremes, &[short(Bounded::VerticalAcceleration, 1.0, 1.5)]).unwrap();
        assert!(
            !up.contains("\nacceleration_max") && up.contains("vertical_acceleration_min_m_s2 = -0.753"),
            "{up}"
        );
        assert_eq!(bounds(&extremes, &[short(Bounded::YawRate, 1.0, 2.0)]), None);
        assert!(words(&[jerk]).contains("set PSC_JERK_XY to 13 or more (now 5) on the vehicle"));
    }
}
