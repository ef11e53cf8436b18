//! Columns by differences: how force and torque along a flight change with each parameter.

use super::base::Base;
use super::channels::{Channels, channels, nothing};
use super::flight_rows::Along;
use super::model_wrench::{PartAlong, each_along};
use super::rotors::RotorMotion;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::{Model, PhysicsError, Wrench};
use nalgebra::Vector3;
use std::sync::Arc;

/// Force or torque along a flight of a model, and of the one below it.
type Pair = (PartAlong, Option<PartAlong>);

/// `K` of the change of force and torque per step of each, along one flight, relative to the rows' own base where there is no model below.
pub(super) fn differences_along(
    (trace, along): (&Trace, &Along),
    base: &Model,
    moved: &[MovedOn],
) -> Vec<Channels> {
    let weak = |(of, (up, down)): (&MovedOn, Pair), base: &[Vector3<f64>]| {
        let below = down.as_ref().map_or(base, |down| &down.series);
        let change = per_step_of(up.series, below, of.step);
        change.map_or_else(|| nothing(trace), |series| trace.weak_vector(0, &series))
    };
    let forces = pairs_along(base, moved, (trace, &along.commanded), |wrench| wrench.force_n);
    // what has no torque by the commands has none by the motion
    let turns: Vec<bool> =
        forces.iter().map(|(up, down)| up.turns || down.as_ref().is_some_and(|down| down.turns)).collect();
    // the series of a long flight take much memory: those of the forces are gone before those of the torques come
    let forces: Vec<[Vec<f64>; 3]> =
        moved.iter().zip(forces).map(|pair| weak(pair, &along.force_n)).collect();
    let turning = moved.iter().zip(&turns).filter(|(_, turns)| **turns).map(|(moved, _)| moved);
    let torques = pairs_along(base, turning.clone(), (trace, &along.motion), |wrench| wrench.torque_nm);
    let mut torques = turning.zip(torques).map(|pair| weak(pair, &along.torque_nm));
    let one = |(turns, force): (&bool, [Vec<f64>; 3])| {
        let torque = torques.by_ref().take(usize::from(*turns)).next();
        channels(trace, force, torque.unwrap_or_else(|| nothing(trace)))
    };
    turns.iter().zip(forces).map(one).collect()
}

/// Force or torque along a flight of each model, and of the one below it where it has one.
fn pairs_along<'a>(
    base: &Model,
    moved: impl IntoIterator<Item = &'a MovedOn<'a>> + Clone,
    along: (&Trace, &RotorMotion),
    part: fn(&Wrench) -> Vector3<f64>,
) -> Vec<Pair> {
    let models = moved.clone().into_iter().flat_map(|of| [Some(of.up), of.down]).flatten();
    let mut each = each_along(base, &models.collect::<Vec<_>>(), along, part).into_iter();
    let pair = |of: &MovedOn| Some((each.next()?, of.down.and_then(|_| each.next())));
    moved.into_iter().map_while(pair).collect()
}

/// Change of a series per step; `None` where there is none.
fn per_step_of(mut up: Vec<Vector3<f64>>, from: &[Vector3<f64>], step: f64) -> Option<Vec<Vector3<f64>>> {
    if up == from {
        return None;
    }
    up.iter_mut().zip(from).for_each(|(a, b)| *a = (*a - b) / step);
    Some(up)
}

/// Instants times columns that are computed together: what they take in memory is bounded, and they share what they have in common.
pub(super) const AT_ONCE: usize = 1 << 19;

/// Models, one a flight, whose effects are a step of one parameter further, and those below where they are not of the rows' own base.
pub(super) struct Moved {
    pub(super) up: Vec<Arc<Model>>,
    pub(super) down: Option<Vec<Arc<Model>>>,
    pub(super) step: f64,
}

impl Moved {
    /// Those of one flight.
    pub(super) fn on(&self, flight: usize) -> MovedOn<'_> {
        MovedOn { up: &self.up[flight], down: self.down.as_ref().map(|down| &*down[flight]), step: self.step }
    }
}

/// The same of one flight.
pub(super) struct MovedOn<'a> {
    up: &'a Model,
    down: Option<&'a Model>,
    step: f64,
}

/// The base with an effect that it does not have, a step of each free parameter away.
pub(super) fn moved_models(
    flights: &[Trace],
    base: &Base,
    candidate: &EffectTerm,
) -> Result<Vec<Moved>, PhysicsError> {
    let one = |&index: &usize| {
        let mut with = base.clone();
        let mut moved = candidate.clone();
        let step = candidate.step_of(index, &base.size);
        moved.values[index] += step;
        with.effects.push(moved);
        Ok(Moved { up: with.models(flights)?, down: None, step })
    };
    candidate.free.iter().map(one).collect()
}
