//! The recording against the model, channel by channel of the weak form, and how each parameter moves them.
//!
//! Each equation has its noisiest signal alone on the left: specific force in the force rows, the
//! commanded torque in the three torque rows. Force is read twice where it can be, by the accelerometer and
//! by the kinematics: what acts on the vehicle shows in both, a fault of a sensor in one of them. A parameter's column is built from the signals that are not
//! on the left of its row: rotor thrusts by the commands for forces, by the measured motion for torques.

use super::base::Base;
use super::channels::{CHANNELS, Channels, Nuisance, NuisanceColumn, append, joined, measures, per_step};
use super::differences::{AT_ONCE, Moved, MovedOn, differences_along, moved_models};
use super::flight_rows::{Along, Part, one_flight, residual};
use super::rotors::RotorMotion;
use super::sensors::{KnownMotion, true_readings};
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::{Model, PhysicsError};
use crate::signals::TorqueError;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// All flights in weak form, linearised about a base.
#[derive(Debug, Clone)]
pub struct Rows {
    /// s, vehicle clock of its flight
    pub time_s: Vec<f64>,
    /// rows without a break between them
    pub runs: Vec<Range<usize>>,
    /// the same for each channel: only those of flights that measure it; in the others it is zero
    pub measured: [Vec<Range<usize>>; CHANNELS],
    /// force and torque that the base does not explain: N, N m
    pub residual: Channels,
    /// nuisance columns, in every fit
    pub nuisances: Vec<NuisanceColumn>,
    /// one for each free parameter of the base's effects, in order
    pub effects: Vec<Channels>,
    /// in one of the flights, torques are compared row by row, not only on average
    pub compares_torques: bool,
    /// what all torques have in common as an error
    pub torque_error: TorqueError,
    /// N m, root mean square of the torque that the motion needs, about body x, y, z
    pub torque_rms: [f64; 3],
    /// data for further columns about the same base
    pub(super) flights: Vec<Arc<Along>>,
    /// of the base, where it has effects on the sensors
    known_motion: Option<KnownMotion>,
}

impl Rows {
    /// Linearises `flights` about `base`.
    ///
    /// # Errors
    /// [`PhysicsError`] where the base is not physical.
    pub fn new(recorded: &[Trace], base: &Base) -> Result<Self, PhysicsError> {
        Self::with_columns(recorded, base, None)
    }

    /// The same with the effects' columns of another base that is near, where they are given.
    ///
    /// # Errors
    /// [`PhysicsError`] where the base is not physical.
    pub(super) fn with_columns(
        recorded: &[Trace],
        base: &Base,
        near: Option<Vec<Channels>>,
    ) -> Result<Self, PhysicsError> {
        let known_motion = KnownMotion::of(recorded, base);
        let motion = KnownMotion::or_found(known_motion.as_ref(), recorded, base);
        let flights = &motion[..];
        let models = base.models(flights)?;
        let parts: Vec<Part> = flights
            .par_iter()
            .zip(&models)
            .map(|(trace, model)| one_flight((trace, flights.len()), base, model))
            .collect();
        let mut rows = Self {
            time_s: Vec::new(),
            runs: Vec::new(),
            measured: Default::default(),
            residual: Default::default(),
            nuisances: Vec::new(),
            effects: Vec::new(),
            compares_torques: flights.iter().any(|trace| trace.torques),
            torque_error: TorqueError::of_all(flights.iter().map(|trace| trace.torque_error)),
            torque_rms: [0.0; 3],
            flights: Vec::new(),
            known_motion: known_motion.clone(),
        };
        let mut squares = Vector3::zeros();
        for trace in flights {
            let torque = trace.turning_torque(&base.vehicle.body);
            squares +=
                trace.centers.iter().map(|&c| torque[c].component_mul(&torque[c])).sum::<Vector3<f64>>();
        }
        let mut of_one_flight = Vec::new();
        for (trace, Part { along, residual, nuisances, own }) in flights.iter().zip(parts) {
            let before = rows.time_s.len();
            of_one_flight.extend(own.into_iter().map(|column| column.among(before)));
            rows.time_s.extend(trace.centers.iter().map(|&center| trace.grid.time_s(center)));
            let runs = || trace.runs.iter().map(|run| run.start + before..run.end + before);
            rows.runs.extend(runs());
            let measured =
                rows.measured.iter_mut().enumerate().filter(|(channel, _)| measures(trace, *channel));
            measured.for_each(|(_, measured)| measured.extend(runs()));
            append(&mut rows.residual, &residual);
            rows.nuisances = joined(rows.nuisances, before, nuisances, trace.rows());
            rows.flights.push(Arc::new(along));
        }
        rows.nuisances.append(&mut of_one_flight);
        rows.torque_rms = std::array::from_fn(|axis| (squares[axis] / rows.len().max(1) as f64).sqrt());
        rows.effects = match near {
            Some(near) => near,
            None => rows.present_columns((recorded, flights), base)?,
        };
        Ok(rows)
    }

    /// Rotor motion of a flight from the commands, behind the latency and smoothed.
    #[must_use]
    pub fn commanded(&self, flight: usize) -> Option<&RotorMotion> {
        self.flights.get(flight).map(|along| &along.commanded)
    }

    /// The same from the motion.
    pub(super) fn moved(&self, flight: usize) -> Option<&RotorMotion> {
        self.flights.get(flight).map(|along| &along.motion)
    }

    /// The same without the nuisances for which something else stands. No further columns come from it: it has nothing of the
    /// rotors.
    pub(super) fn without(&self, stands_for: impl Fn(Nuisance) -> bool) -> Self {
        let kept = self.nuisances.iter().filter(|column| !stands_for(column.nuisance));
        Self {
            time_s: self.time_s.clone(),
            runs: self.runs.clone(),
            measured: self.measured.clone(),
            residual: self.residual.clone(),
            nuisances: kept.cloned().collect(),
            effects: self.effects.clone(),
            compares_torques: self.compares_torques,
            torque_error: self.torque_error,
            torque_rms: self.torque_rms,
            flights: Vec::new(),
            known_motion: None,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Number of rows at which a channel is measured.
    #[must_use]
    pub fn count_of(&self, channel: usize) -> usize {
        self.measured[channel].iter().map(ExactSizeIterator::len).sum()
    }

    /// No rows at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Columns of the free parameters of an effect that the base does not have. Its values must be those at which it
    /// has no influence.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle lacks what the effect needs.
    pub fn columns_of(
        &self,
        flights: &[Trace],
        base: &Base,
        candidate: &EffectTerm,
    ) -> Result<Vec<Channels>, PhysicsError> {
        self.columns_of_each(flights, base, &[candidate]).into_iter().next().unwrap_or_else(|| Ok(Vec::new()))
    }

    /// The same of several effects, each by itself.
    pub(super) fn columns_of_each(
        &self,
        flights: &[Trace],
        base: &Base,
        candidates: &[&EffectTerm],
    ) -> Vec<Result<Vec<Channels>, PhysicsError>> {
        let motion = KnownMotion::or_found(self.known_motion.as_ref(), flights, base);
        let mut models: Vec<Moved> = Vec::new();
        let mut places: Vec<Result<Range<usize>, PhysicsError>> = Vec::new();
        for candidate in candidates.iter().filter(|candidate| !candidate.is_of_sensors()) {
            let first = models.len();
            let found = moved_models(&motion, base, candidate).map(|moved| models.extend(moved));
            places.push(found.map(|()| first..models.len()));
        }
        let without = base.models(&motion);
        let columns = without.map(|without| self.differences(&motion, &without, &models));
        let mut places = places.into_iter();
        let of = |candidate: &&EffectTerm| {
            if candidate.is_of_sensors() {
                return self.sensor_columns(flights, base, candidate);
            }
            let place = places.next().unwrap_or(Ok(0..0))?;
            Ok(columns.as_ref().map_err(Clone::clone)?[place].to_vec())
        };
        candidates.iter().map(of).collect()
    }

    /// The same of an effect that changes what sensors show.
    fn sensor_columns(
        &self,
        flights: &[Trace],
        base: &Base,
        candidate: &EffectTerm,
    ) -> Result<Vec<Channels>, PhysicsError> {
        let one = |&index: &usize| {
            let mut moved = candidate.clone();
            let step = candidate.step_of(index, &base.size);
            moved.values[index] += step;
            let mut with = base.clone();
            with.effects.push(moved);
            Ok(per_step(self.sensor_residual(flights, &with)?, &self.residual, step))
        };
        candidate.free.iter().map(one).collect()
    }

    /// The same for an effect that acts through others that only `base` has, not the rows' own base.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle lacks what the effect needs.
    pub fn columns_through(
        &self,
        flights: &[Trace],
        base: &Base,
        candidate: &EffectTerm,
    ) -> Result<Vec<Channels>, PhysicsError> {
        let motion = KnownMotion::or_found(self.known_motion.as_ref(), flights, base);
        let without = base.models(&motion)?;
        let through = |moved: Moved| Moved { down: Some(without.clone()), ..moved };
        let models: Vec<Moved> = moved_models(&motion, base, candidate)?.into_iter().map(through).collect();
        Ok(self.differences(&motion, &without, &models))
    }

    /// Columns of the free parameters of the base's effects. `flights` have the true motion of the recorded ones.
    fn present_columns(
        &self,
        (recorded, flights): (&[Trace], &[Trace]),
        base: &Base,
    ) -> Result<Vec<Channels>, PhysicsError> {
        let places: Vec<(usize, usize)> = base
            .effects
            .iter()
            .enumerate()
            .flat_map(|(effect, present)| present.free.iter().map(move |&index| (effect, index)))
            .collect();
        let mut models: Vec<Moved> = Vec::new();
        let mut of_sensors: Vec<(usize, Channels)> = Vec::new();
        for (column, &(effect, index)) in places.iter().enumerate() {
            let present = &base.effects[effect];
            let step = present.step_of(index, &base.size);
            let moved = |by: f64| {
                let mut moved = base.clone();
                moved.effects[effect].values[index] += by;
                moved
            };
            if present.is_proportional_to(index) && !present.is_of_sensors() {
                models.push(Moved { up: moved(step).models(flights)?, down: None, step });
                continue;
            }
            // not beyond what is possible: a load has no negative mass
            let value = present.values[index];
            let below = present.possible(index, value - 0.5 * step, &base.size) - value;
            let (up, down) = (moved(below + step), moved(below));
            if present.is_of_sensors() {
                let shown = per_step(
                    self.sensor_residual(recorded, &up)?,
                    &self.sensor_residual(recorded, &down)?,
                    step,
                );
                of_sensors.push((column, shown));
            } else {
                models.push(Moved { up: up.models(flights)?, down: Some(down.models(flights)?), step });
            }
        }
        let mut columns = self.differences(flights, &base.models(flights)?, &models);
        of_sensors.into_iter().for_each(|(column, shown)| columns.insert(column, shown));
        Ok(columns)
    }

    /// The residual with other effects on the sensors. Effects on the vehicle keep their values, an approximation that
    /// is better the smaller the sensors' effects are.
    fn sensor_residual(&self, recorded: &[Trace], base: &Base) -> Result<Channels, PhysicsError> {
        let models = base.models(recorded)?;
        let mut out = Channels::default();
        let readings = true_readings(recorded, base);
        for ((trace, model), along) in readings.iter().zip(&models).zip(&self.flights) {
            append(&mut out, &residual(trace, &base.on(&trace.own), model, along));
        }
        Ok(out)
    }

    /// `K` of the change of force and torque per step of each, relative to the rows' own base where there is no model below.
    fn differences(&self, flights: &[Trace], base: &[Arc<Model>], moved: &[Moved]) -> Vec<Channels> {
        let instants = flights.iter().map(|trace| trace.grid.count).max().unwrap_or_default();
        let some = (AT_ONCE / instants.max(1)).clamp(2, 32);
        let parts: Vec<Vec<Channels>> =
            moved.par_chunks(some).map(|moved| self.differences_of(flights, base, moved)).collect();
        parts.into_iter().flatten().collect()
    }

    fn differences_of(&self, flights: &[Trace], base: &[Arc<Model>], moved: &[Moved]) -> Vec<Channels> {
        let each: Vec<Vec<Channels>> = flights
            .par_iter()
            .zip(&self.flights)
            .zip(base)
            .enumerate()
            .map(|(flight, ((trace, along), base))| {
                let moved: Vec<MovedOn> = moved.iter().map(|of| of.on(flight)).collect();
                differences_along((trace, along), base, &moved)
            })
            .collect();
        let mut out = vec![Channels::default(); moved.len()];
        for of_flight in each {
            out.iter_mut().zip(&of_flight).for_each(|(out, part)| append(out, part));
        }
        out
    }
}

#[cfg(test)]
#[path = "rows_tests.rs"]
pub(super) mod tests;
