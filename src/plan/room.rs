//! The room that every plan and every flight has: walls, a ceiling and a floor above the ground.

use super::bounds::{Bound, Quantity};
use super::wall::Wall;
use crate::note::{About, Note};
use crate::units::{deg_from_rad, rad_from_deg};
use crate::vehicle::{Limits, Vehicle};

/// Error of an estimated height above the place of takeoff, m, which barometers and estimators reach within minutes.
/// Barometers drift by 0.1 to 0.3 m within minutes; less would let rotors touch the ground, more costs room.
pub const HEIGHT_ERROR_M: f64 = 0.3;
/// Tilt at which the rotors must still be clear of the ground, degrees. It is the largest tilt that autopilots allow
/// by default (PX4: 45, ArduPilot: 30 degrees).
const TILT_DEG: f64 = 45.0;

/// Default room: half its length and width, m. A default for whoever states none; it is told, and meant for a large
/// room indoors.
const WALL_M: f64 = 2.0;
/// Default room: floor and ceiling, m. A default for whoever states none; it is told: clear of the ground's effect
/// and of a usual ceiling.
const HEIGHTS_M: (f64, f64) = (1.0, 3.0);
/// Default limit of the speed, m/s. A default for whoever states none; it is told.
const SPEED_M_S: f64 = 1.5;
/// Default limit of roll and of pitch, degrees. A default for whoever states none; it is told.
const TILT_MAX_DEG: f64 = 15.0;
/// Default limit of the yaw rate, degrees/s. A default for whoever states none; it is told.
const YAW_RATE_MAX_DEG_S: f64 = 60.0;

/// Limits with a room, and the parts of it that were not stated.
#[derive(Debug, Clone, PartialEq)]
pub struct Roomed {
    /// with all walls, ceiling and floor
    pub limits: Limits,
    /// additions and changes, a sentence each; empty if the room was stated completely
    pub notes: Vec<Note>,
}

/// Reach of the rotors from the position (the body's origin) of a vehicle, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// to each side, level
    pub side_m: f64,
    /// up, tilted by 45 degrees
    pub up_m: f64,
    /// down, tilted by 45 degrees
    pub down_m: f64,
}

impl Reach {
    /// The reach of a vehicle; zero without rotors.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Self {
        let radius_m = vehicle.propulsion.rotor_radius_m.unwrap_or(0.0);
        let (sin, cos) = rad_from_deg(TILT_DEG).sin_cos();
        let greatest = |reach: &dyn Fn(f64, f64) -> f64| {
            let reaches = vehicle.rotors.iter().map(|rotor| {
                let place_m = rotor.position_m;
                reach(place_m.xy().norm() + radius_m, place_m.z)
            });
            reaches.fold(0.0, f64::max)
        };
        Self {
            side_m: greatest(&|side_m, _| side_m),
            up_m: greatest(&|side_m, up_m| side_m * sin + (up_m * cos).max(0.0)),
            down_m: greatest(&|side_m, up_m| side_m * sin - (up_m * cos).min(0.0)),
        }
    }
}

/// A wall of a room in which the vehicle has no place: which, its coordinate, and the reach of the rotors, m.
#[must_use]
pub fn too_narrow(limits: &Limits, vehicle: &Vehicle) -> Option<(Wall, f64, f64)> {
    let side_m = Reach::of(vehicle).side_m;
    let walls = [Wall::NorthOrSouth, Wall::WestOrEast];
    walls
        .into_iter()
        .find_map(|wall| Some((wall, wall.of(limits).filter(|wall_m| *wall_m <= side_m)?, side_m)))
}

/// The least height above the ground (m) at which no rotor can touch it: the reach of the tilted rotors, and the error of
/// the height.
#[must_use]
pub fn floor_m(vehicle: &Vehicle) -> f64 {
    Reach::of(vehicle).down_m + HEIGHT_ERROR_M
}

/// Bounds with which a vehicle flies, and comes to rest without setpoints, at least this far (m) inside the room: its
/// rotors from walls and ceiling, its position from the floor; negative: outside. `None` if the room is too small.
#[must_use]
pub(super) fn rest_bounds(limits: &Limits, vehicle: &Vehicle, inside_m: f64) -> Option<Vec<Bound>> {
    let reach = Reach::of(vehicle);
    let side = |wall_m: Option<f64>| wall_m.map(|wall_m| wall_m - reach.side_m - inside_m);
    let (x_m, y_m) = (side(limits.x_max_m), side(limits.y_max_m));
    let low_m = limits.z_min_m.map(|z_min_m| z_min_m + inside_m);
    let high_m = limits.z_max_m.map(|z_max_m| z_max_m - reach.up_m - inside_m);
    let mut bounds = Vec::new();
    for (axis, min, max) in [(0, x_m.map(|x_m| -x_m), x_m), (1, y_m.map(|y_m| -y_m), y_m), (2, low_m, high_m)]
    {
        if min.zip(max).is_some_and(|(min, max)| min >= max) {
            return None;
        }
        for quantity in [Quantity::Path { axis, order: 0 }, Quantity::Rest(axis)] {
            bounds.push(Bound { quantity, min, max });
        }
    }
    bounds.retain(|bound| bound.min.is_some() || bound.max.is_some());
    Some(bounds)
}

/// The limits with a careful default for each part of the room that they do not state, and with a floor above the
/// ground.
#[must_use]
pub fn with_room(limits: &Limits, vehicle: &Vehicle) -> Roomed {
    let floor_m = floor_m(vehicle);
    let mut roomed = *limits;
    let mut missing = Vec::new();
    let mut fill = |value: &mut Option<f64>, name: &str, default: f64| {
        if value.is_none() {
            *value = Some(default);
            missing.push(format!("{name} = {default:.2}"));
        }
    };
    fill(&mut roomed.x_max_m, "x_max_m", WALL_M);
    fill(&mut roomed.y_max_m, "y_max_m", WALL_M);
    let low_m = HEIGHTS_M.0.max(floor_m);
    fill(&mut roomed.z_min_m, "z_min_m", low_m);
    let above_m = roomed.z_min_m.unwrap_or(low_m).max(floor_m) + HEIGHTS_M.1 - HEIGHTS_M.0;
    fill(&mut roomed.z_max_m, "z_max_m", above_m);
    if !bounds_motion(limits) {
        fill(&mut roomed.speed_max_m_s, "speed_max_m_s", SPEED_M_S);
        roomed.roll_max_rad = Some(rad_from_deg(TILT_MAX_DEG));
        roomed.pitch_max_rad = roomed.roll_max_rad;
        roomed.yaw_rate_max_rad_s.get_or_insert(rad_from_deg(YAW_RATE_MAX_DEG_S));
        missing.extend(tilt_notes(&roomed));
    }
    let mut notes = Vec::new();
    let mut warn = |text: String| notes.push(Note::warning(About::Vehicle, text));
    if !missing.is_empty() {
        warn(format!(
            "expected a room and speed limits in [limits], got none or a part of them: defaults are used for what is \
             missing, {}; state your own values there if they differ",
            missing.join(", ")
        ));
    }
    if let Some(stated_m) = roomed.z_min_m.filter(|z_min_m| *z_min_m < floor_m) {
        roomed.z_min_m = Some(floor_m);
        warn(format!(
            "expected z_min_m of at least {floor_m:.2} (rotors' reach and {HEIGHT_ERROR_M} m of error in height), got \
             {stated_m:.2}: {floor_m:.2} is the floor of the room"
        ));
    }
    Roomed { limits: roomed, notes }
}

/// Whether speed, acceleration or tilt is bounded, so that the limits of the motion were considered.
fn bounds_motion(limits: &Limits) -> bool {
    let of_motion =
        [limits.speed_max_m_s, limits.acceleration_max_m_s2, limits.roll_max_rad, limits.pitch_max_rad];
    of_motion.iter().any(Option::is_some)
}

fn tilt_notes(limits: &Limits) -> Vec<String> {
    [
        ("roll_max_deg", limits.roll_max_rad),
        ("pitch_max_deg", limits.pitch_max_rad),
        ("yaw_rate_max_deg_s", limits.yaw_rate_max_rad_s),
    ]
    .into_iter()
    .filter_map(|(name, value)| Some(format!("{name} = {:.0}", deg_from_rad(value?))))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random_vehicle;

    #[test]
    fn a_room_that_is_stated_stays_and_one_that_is_not_is_stated() {
        let vehicle = random_vehicle(1).truth;
        let whole = with_room(&Limits::default(), &vehicle);
        let limits = whole.limits;
        assert!(limits.z_min_m.unwrap() >= 1.0 && limits.z_max_m.unwrap() <= 10.0, "{limits:?}");
        assert!(whole.notes[0].text.contains("defaults are used"));
        assert!(whole.notes[0].text.contains("roll_max_deg = 15"));
        assert_eq!(with_room(&limits, &vehicle), Roomed { limits, notes: Vec::new() });
        let fast = Limits { x_max_m: Some(5.0), speed_max_m_s: Some(3.0), ..Limits::default() };
        let part = with_room(&fast, &vehicle);
        assert_eq!((part.limits.x_max_m, part.limits.roll_max_rad), (Some(5.0), None));
        // a room alone does not say how lively it may be flown
        let calm = with_room(&Limits { speed_max_m_s: None, ..fast }, &vehicle);
        assert_eq!(calm.limits.speed_max_m_s, Some(SPEED_M_S));
        assert!(calm.limits.roll_max_rad.is_some() && calm.notes[0].text.contains("speed_max_m_s = 1.50"));
        assert!(
            part.notes[0].text.contains("y_max_m") && !part.notes[0].text.contains("x_max_m"),
            "{:?}",
            part.notes
        );
    }

    #[test]
    fn no_room_reaches_to_the_ground() {
        let vehicle = random_vehicle(2).truth;
        let floor_m = floor_m(&vehicle);
        assert!(floor_m > HEIGHT_ERROR_M);
        let stated = Limits { z_min_m: Some(-5.0), z_max_m: Some(4.0), ..Limits::default() };
        let roomed = with_room(&stated, &vehicle);
        assert_eq!(roomed.limits.z_min_m, Some(floor_m));
        assert!(roomed.notes.iter().any(|note| note.text.contains("got -5.00")), "{:?}", roomed.notes);
    }
}
