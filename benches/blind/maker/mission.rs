//! An ordinary mission: from waypoint to waypoint, with stops.

use nalgebra::Vector3;
use rand::{Rng, RngExt};

use super::path::{RequestedEffects, Room};

/// s in which the nose turns half around; less takes less.
const TURN: f64 = 5.0;

/// From one place of rest to the next.
#[derive(Debug, Clone, Copy)]
pub struct Leg {
    /// s, when it begins and how long it takes
    begins: f64,
    lasts: f64,
    /// s in which it turns
    turns: f64,
    /// m and rad
    from: (Vector3<f64>, f64),
    to: (Vector3<f64>, f64),
}

/// Legs from `begins` s on until `ends`, in a room of `reach` m to each side.
pub fn legs((room, reach): (Room, f64), (begins, ends): (f64, f64), dice: &mut impl Rng) -> Vec<Leg> {
    let middle = 0.5 * (room.heights.0 + room.heights.1);
    let mut from = (Vector3::new(0.0, 0.0, middle), 0.0);
    let mut legs = vec![Leg { begins: 0.0, lasts: begins, turns: begins, from, to: from }];
    let mut time = begins;
    while time < ends {
        let height = dice.random_range(room.heights.0..room.heights.1);
        let level = Vector3::new(dice.random_range(-reach..reach), dice.random_range(-reach..reach), 0.0);
        // every third leg is a climb alone
        let place = if dice.random_bool(0.3) { Vector3::new(from.0.x, from.0.y, 0.0) } else { level };
        let at = Vector3::new(place.x, place.y, height);
        let way = (at - from.0).norm();
        // the nose turns to where it goes
        let ahead = (at - from.0).xy();
        let turn = if ahead.norm() > 0.3 { turned(ahead.y.atan2(ahead.x) - from.1) } else { 0.0 };
        let to = (at, from.1 + turn);
        // the quintic from rest to rest goes 15/8 of the mean speed and 5.77 of way over time squared
        let speed = room.speed * dice.random_range(0.5..1.0);
        let hard = 0.35 * room.acceleration;
        let turns = (TURN * (turn.abs() / std::f64::consts::PI).sqrt()).max(0.5);
        let lasts = (1.875 * way / speed).max((5.77 * way / hard).sqrt()).max(turns);
        legs.push(Leg { begins: time, lasts, turns, from, to });
        time += lasts + dice.random_range(0.5..2.5);
        from = to;
    }
    legs
}

/// The short way around, rad.
fn turned(angle: f64) -> f64 {
    (angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI
}

/// From 0 to 1 within `lasts` s at rest at both ends, with two derivatives.
fn quintic(since: f64, lasts: f64) -> [f64; 3] {
    let s = (since / lasts).clamp(0.0, 1.0);
    [
        s * s * s * (10.0 + s * (6.0 * s - 15.0)),
        30.0 * s * s * (1.0 - s) * (1.0 - s) / lasts,
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (lasts * lasts),
    ]
}

/// What is asked for at a time.
pub fn at(legs: &[Leg], time: f64) -> RequestedEffects {
    let leg = legs.iter().rev().find(|leg| leg.begins <= time).or(legs.first()).copied();
    let Some(Leg { begins, lasts, turns, from, to }) = leg else { return RequestedEffects::default() };
    let [share, rise, bend] = quintic(time - begins, lasts);
    let [turned, turning, _] = quintic(time - begins, turns);
    let (way, turn) = (to.0 - from.0, to.1 - from.1);
    RequestedEffects {
        position: from.0 + share * way,
        velocity: rise * way,
        acceleration: bend * way,
        yaw: from.1 + turned * turn,
        yaw_rate: turning * turn,
    }
}
