//! The trajectory against the room and the vehicle's limits.

use super::stopping::place_and_velocity;
use super::{Situation, Stopping};
use crate::fly::finding::Finding;
use crate::plan::{
    Dynamics, HEIGHT_ERROR_M, Margin, Quantity, Reach, bounds_of, check, floor_m, path_samples, too_narrow,
};
use crate::vehicle::Limits;
use nalgebra::Vector3;

/// Rounding of a planned trajectory that just touches a bound, as a share of the bound.
const TOUCH: f64 = 1e-6;

pub(super) fn findings(situation: &Situation<'_>, stopping: &Stopping) -> Vec<Finding> {
    let bounds = bounds_of(situation.limits, situation.vehicle);
    let dynamics = Dynamics::new(situation.vehicle);
    let path = |time_s| situation.path.derivatives(time_s).unwrap_or([[f64::NAN; 5]; 4]);
    let margins = check(path, situation.path.duration_s(), &bounds, &dynamics).margins;
    let mut findings: Vec<Finding> = margins.iter().filter(|margin| is_broken(margin)).map(refusal).collect();
    findings.extend(walls(situation.limits));
    findings.extend(floor(situation));
    findings.extend(stand(situation));
    let rotors = rotors(situation);
    if findings.is_empty() {
        let spare = margins.iter().min_by(|a, b| relative(a).total_cmp(&relative(b)));
        findings.push(match spare {
            Some(margin) => Finding::ok(
                "limits",
                format!("{} bounds of room and vehicle kept", margins.len()),
                format!(
                    "the nearest is {}: {:.3} of {:.3} at {:.1} s",
                    margin.quantity.name(),
                    margin.value,
                    margin.limit,
                    margin.time_s
                ),
            ),
            None => Finding::warning(
                "limits",
                "bounds of the room",
                "none",
                "give the room in the vehicle file's [limits], or fly where there is nothing to hit",
            ),
        });
    }
    findings.extend(rotors);
    findings.extend(braking(situation, stopping));
    findings
}

/// Walls, floor and ceiling that are not stated.
fn walls(limits: &Limits) -> Option<Finding> {
    let stated = [
        ("x_max_m", limits.x_max_m),
        ("y_max_m", limits.y_max_m),
        ("z_min_m", limits.z_min_m),
        ("z_max_m", limits.z_max_m),
    ];
    let missing: Vec<&str> =
        stated.iter().filter(|(_, value)| value.is_none()).map(|(name, _)| *name).collect();
    (!missing.is_empty()).then(|| {
        let came = format!("none for {}", missing.join(", "));
        let remedy = "give the room in the vehicle file's or the trajectory's [limits]";
        Finding::refusal("room", "walls, floor and ceiling", came, remedy)
    })
}

/// Checks that no rotor comes near the ground along the path, whatever the limits say.
fn floor(situation: &Situation<'_>) -> Option<Finding> {
    let floor_m = floor_m(situation.vehicle);
    let heights = path_samples(situation.path).map(|(time_s, [_, _, z, _])| (z[0], time_s));
    let (lowest_m, time_s) = heights.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let expected = format!(
        "at least {floor_m:.2} m above the ground, the rotors' reach and {HEIGHT_ERROR_M} m of error in height"
    );
    (lowest_m.is_nan() || lowest_m < floor_m - TOUCH).then(|| {
        let came = format!("{lowest_m:.2} m at {time_s:.1} s");
        Finding::refusal("floor", expected, came, "plan higher")
    })
}

/// Checks the rotors along the path, which the bounds of the position do not include.
fn rotors(situation: &Situation<'_>) -> Option<Finding> {
    let expected =
        |reach_m, name, max| format!("the rotors, which reach {reach_m:.2} m, inside {name} = {max:.2} m");
    if let Some((name, wall_m, reach_m)) = too_narrow(situation.limits, situation.vehicle) {
        let came = "a room that is narrower than the vehicle";
        return Some(Finding::refusal("room", expected(reach_m, name, wall_m), came, "correct the room"));
    }
    let reach = Reach::of(situation.vehicle);
    let walls = [
        (0, "x_max_m", situation.limits.x_max_m, reach.side_m),
        (1, "y_max_m", situation.limits.y_max_m, reach.side_m),
        (2, "z_max_m", situation.limits.z_max_m, reach.up_m),
    ];
    let beyond = |(axis, name, max, reach_m): (usize, &'static str, Option<f64>, f64)| {
        let max = max?;
        let place_m = |value: f64| if axis < 2 { value.abs() } else { value };
        let farthest_m =
            path_samples(situation.path).map(|(_, axes)| place_m(axes[axis][0])).fold(0.0, f64::max);
        Some((farthest_m + reach_m - max, expected(reach_m, name, max)))
    };
    let (beyond_m, expected) = walls.into_iter().filter_map(beyond).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (beyond_m > TOUCH).then(|| {
        let came = format!("{beyond_m:.2} m beyond it where the path comes nearest");
        let remedy = "leave that much room behind the wall, or plan further inside";
        Finding::warning("room", expected, came, remedy)
    })
}

/// Checks that the vehicle stands inside the room.
fn stand(situation: &Situation<'_>) -> Option<Finding> {
    let inside = situation.stand_m? - situation.origin_m;
    let limits = situation.limits;
    let walls = [("x", inside.x, limits.x_max_m), ("y", inside.y, limits.y_max_m)];
    let (name, value, max) = walls
        .into_iter()
        .find_map(|(name, value, max)| max.filter(|max| value.abs() > *max).map(|max| (name, value, max)))?;
    Some(Finding::refusal(
        "room",
        format!("the vehicle inside it, |{name}| at most {max:.2} m"),
        format!("{name} = {value:.2} m from the trajectory's zero"),
        "put it there, or fly from where it stands (--origin here)",
    ))
}

fn is_broken(margin: &Margin) -> bool {
    let spare = margin.spare();
    spare.is_nan() || spare < -TOUCH * margin.limit.abs().max(1.0)
}

fn relative(margin: &Margin) -> f64 {
    margin.spare() / margin.limit.abs().max(1e-9)
}

fn refusal(margin: &Margin) -> Finding {
    let side = if margin.upper { "at most" } else { "at least" };
    let remedy = match margin.quantity {
        Quantity::RotorThrust(_) | Quantity::Thrust | Quantity::Torque(_) => {
            "the vehicle cannot do it: plan a gentler trajectory"
        }
        Quantity::Path { .. } | Quantity::Rest(_) | Quantity::Roll | Quantity::Pitch => {
            "plan the trajectory for these limits, or correct them"
        }
    };
    Finding::refusal(
        "limits",
        format!("{} {side} {:.3}", margin.quantity.name(), margin.limit),
        format!("{:.3} at {:.1} s", margin.value, margin.time_s),
        remedy,
    )
}

/// Checks that the vehicle, if it is ordered to stop anywhere on the path, comes to rest inside the room.
fn braking(situation: &Situation<'_>, stopping: &Stopping) -> Option<Finding> {
    let limits = situation.limits;
    let mut worst: Option<(f64, f64, &'static str)> = None;
    for (time_s, entry) in path_samples(situation.path) {
        let (place, velocity) = place_and_velocity(&entry);
        for (beyond_m, wall) in beyond(&stopping.rest(&place, &velocity), limits) {
            if beyond_m > 0.0 && worst.is_none_or(|(most, ..)| beyond_m > most) {
                worst = Some((beyond_m, time_s, wall));
            }
        }
    }
    let has_walls = !beyond(&Vector3::zeros(), limits).is_empty();
    let expected = format!("rest inside the room from every point, {}", stopping.basis);
    match worst {
        Some((beyond_m, time_s, wall)) => Some(Finding::warning(
            "stopping distance",
            expected,
            format!("{beyond_m:.2} m beyond {wall} if stopped at {time_s:.1} s"),
            "leave that much room behind the wall, or plan a slower trajectory",
        )),
        None => has_walls.then(|| Finding::ok("stopping distance", expected, "inside at every point")),
    }
}

/// Distance of a position beyond each wall of the room, m; negative inside.
fn beyond(place_m: &Vector3<f64>, limits: &Limits) -> Vec<(f64, &'static str)> {
    [
        (limits.x_max_m.map(|max| place_m.x.abs() - max), "x_max_m"),
        (limits.y_max_m.map(|max| place_m.y.abs() - max), "y_max_m"),
        (limits.z_max_m.map(|max| place_m.z - max), "z_max_m"),
        (limits.z_min_m.map(|min| min - place_m.z), "z_min_m"),
    ]
    .into_iter()
    .filter_map(|(beyond_m, wall)| beyond_m.map(|beyond_m| (beyond_m, wall)))
    .collect()
}
