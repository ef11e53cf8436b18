//! An ordinary mission: from waypoint to waypoint, with stops.

use nalgebra::Vector3;
use rand::{Rng, RngExt};

use super::path::{RequestedEffects, Room};

/// From one place of rest to the next.
#[derive(Debug, Clone, Copy)]
pub struct Leg {
    /// s, when it begins and how long it takes
    begins: f64,
    lasts: f64,
    /// m and rad
    from: (Vector3<f64>, f64),
    to: (Vector3<f64>, f64),
}

/// Legs from `begins` s on until `ends`, in a room of `reach` m to each side.
pub fn legs((room, reach): (Room, f64), (begins, ends): (f64, f64), dice: &mut impl Rng) -> Vec<Leg> {
    let middle = 0.5 * (room.heights.0 + room.heights.1);
    let mut from = (Vector3::new(0.0, 0.0, middle), 0.0);
    let mut legs = vec![Leg { begins: 0.0, lasts: begins, from, to: from }];
    let mut time = begins;
    while time < ends {
        let height = dice.random_range(room.heights.0..room.heights.1);
        let level = Vector3::new(dice.random_range(-reach..reach), dice.random_range(-reach..reach), 0.0);
        // every third leg is a climb alone
        let place = if dice.random_bool(0.3) { Vector3::new(from.0.x, from.0.y, 0.0) } else { level };
        let turn: f64 = if dice.random_bool(0.6) { dice.random_range(-1.5..1.5) } else { 0.0 };
        let to = (Vector3::new(place.x, place.y, height), from.1 + turn);
        let way = (to.0 - from.0).norm();
        // the quintic from rest to rest goes 15/8 of the mean speed and 5.77 of way over time squared
        let speed = room.speed * dice.random_range(0.5..1.0);
        let hard = 0.35 * room.acceleration;
        let lasts =
            (1.875 * way / speed).max((5.77 * way / hard).sqrt()).max(1.875 * turn.abs() / 0.9).max(1.0);
        legs.push(Leg { begins: time, lasts, from, to });
        time += lasts + dice.random_range(0.5..2.5);
        from = to;
    }
    legs
}

/// What is asked for at a time.
pub fn at(legs: &[Leg], time: f64) -> RequestedEffects {
    let leg = legs.iter().rev().find(|leg| leg.begins <= time).or(legs.first()).copied();
    let Some(Leg { begins, lasts, from, to }) = leg else { return RequestedEffects::default() };
    let s = ((time - begins) / lasts).clamp(0.0, 1.0);
    let share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let rise = 30.0 * s * s * (1.0 - s) * (1.0 - s) / lasts;
    let bend = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (lasts * lasts);
    let (way, turn) = (to.0 - from.0, to.1 - from.1);
    RequestedEffects {
        position: from.0 + share * way,
        velocity: rise * way,
        acceleration: bend * way,
        yaw: from.1 + share * turn,
        yaw_rate: rise * turn,
    }
}
