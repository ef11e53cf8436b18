//! The trajectory against the room and the vehicle's limits.

use super::stopping::place_and_velocity;
use super::{Situation, Stopping};
use crate::fly::finding::Finding;
use crate::plan::{
    Dynamics, HEIGHT_ERROR_M, Margin, Quantity, Reach, Wall, bounds_of, check, floor_m, path_samples,
    too_narrow,
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
                    "the nearest is {}: {} of {} at {:.1} s",
                    margin.quantity.words(),
                    margin.quantity.amount(margin.value),
                    margin.quantity.amount(margin.limit),
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
    let missing: Vec<Wall> = Wall::ALL.into_iter().filter(|wall| wall.of(limits).is_none()).collect();
    (!missing.is_empty()).then(|| {
        let each = |of: fn(Wall) -> &'static str| missing.iter().map(|wall| of(*wall)).collect::<Vec<_>>();
        let came = format!("nothing of {}", each(Wall::words).join(", "));
        let keys = each(Wall::key).join(", ");
        let remedy = format!("give {keys} in the vehicle file's or the trajectory's [limits]");
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
    let expected = |reach_m, wall: Wall, max| {
        format!("the rotors, which reach {reach_m:.2} m, inside {} at {max:.2} m", wall.words())
    };
    if let Some((wall, wall_m, reach_m)) = too_narrow(situation.limits, situation.vehicle) {
        let came = "a room that is narrower than the vehicle";
        return Some(Finding::refusal("room", expected(reach_m, wall, wall_m), came, "correct the room"));
    }
    let reach = Reach::of(situation.vehicle);
    let walls = [
        (0, Wall::NorthOrSouth, reach.side_m),
        (1, Wall::WestOrEast, reach.side_m),
        (2, Wall::Ceiling, reach.up_m),
    ];
    let beyond = |(axis, wall, reach_m): (usize, Wall, f64)| {
        let max = wall.of(situation.limits)?;
        let place_m = |value: f64| if axis < 2 { value.abs() } else { value };
        let farthest_m =
            path_samples(situation.path).map(|(_, axes)| place_m(axes[axis][0])).fold(0.0, f64::max);
        Some((farthest_m + reach_m - max, expected(reach_m, wall, max)))
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
    let walls = [("north", "south", inside.x, limits.x_max_m), ("west", "east", inside.y, limits.y_max_m)];
    let (ahead, behind, value, max) = walls.into_iter().find_map(|(ahead, behind, value, max)| {
        max.filter(|max| value.abs() > *max).map(|max| (ahead, behind, value, max))
    })?;
    let side = if value > 0.0 { ahead } else { behind };
    Some(Finding::refusal(
        "room",
        format!("the vehicle inside it, at most {max:.2} m {ahead} or {behind}"),
        format!("{:.2} m {side} of the trajectory's zero", value.abs()),
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
        format!("{} {side} {}", margin.quantity.words(), margin.quantity.amount(margin.limit)),
        format!("{} at {:.1} s", margin.quantity.amount(margin.value), margin.time_s),
        remedy,
    )
}

/// Checks that the vehicle, if it is ordered to stop anywhere on the path, comes to rest inside the room.
fn braking(situation: &Situation<'_>, stopping: &Stopping) -> Option<Finding> {
    let limits = situation.limits;
    let mut worst: Option<(f64, f64, Wall)> = None;
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
            format!("{beyond_m:.2} m beyond {} if stopped at {time_s:.1} s", wall.words()),
            "leave that much room behind the wall, or plan a slower trajectory",
        )),
        None => has_walls.then(|| Finding::ok("stopping distance", expected, "inside at every point")),
    }
}

/// Distance of a position beyond each wall of the room, m; negative inside.
fn beyond(place_m: &Vector3<f64>, limits: &Limits) -> Vec<(f64, Wall)> {
    let beyond_m = |wall: Wall| {
        let at_m = wall.of(limits)?;
        Some(match wall {
            Wall::NorthOrSouth => place_m.x.abs() - at_m,
            Wall::WestOrEast => place_m.y.abs() - at_m,
            Wall::Ceiling => place_m.z - at_m,
            Wall::Floor => at_m - place_m.z,
        })
    };
    Wall::ALL.into_iter().filter_map(|wall| Some((beyond_m(wall)?, wall))).collect()
}
