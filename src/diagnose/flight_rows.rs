//! One flight's part of the rows: what acts along it by commands and by motion, and the residual of the base.

use super::base::Base;
use super::channels::{Channels, NuisanceColumn, SECOND, append, channels};
use super::model_wrench::{moved_by, wrench_along};
use super::nuisances::nuisances;
use super::rotors::{OfRotors, RotorMotion};
use super::sensors::true_motion;
use super::trace::Trace;
use super::velocity_error::velocity_error;
use crate::physics::{Airframe, Model, PhysicsError, Wrench};
use nalgebra::{Vector3, Vector4};
use rayon::prelude::*;

/// One flight's rotors and loads under the base.
#[derive(Debug)]
pub(super) struct Along {
    pub(super) felt: OfRotors,
    pub(super) commanded: RotorMotion,
    pub(super) motion: RotorMotion,
    /// N, of the model with the rotors by the commands
    pub(super) force_n: Vec<Vector3<f64>>,
    /// N m, of the model with the rotors by the motion
    pub(super) torque_nm: Vec<Vector3<f64>>,
}

impl Along {
    /// Torque of the effects at each instant, with the rotors by the motion, body, N m.
    pub(super) fn torque_of_effects_nm(&self, airframe: &Airframe) -> Vec<Vector3<f64>> {
        let of = |(index, all): (usize, &Vector3<f64>)| {
            all - airframe.thrust_wrench(&self.motion.thrust_n.at(index)).torque_nm
        };
        self.torque_nm.iter().enumerate().map(of).collect()
    }
}

/// The residual for the true motion of the flights.
pub(super) fn residuals(recorded: &[Trace], base: &Base) -> Result<Channels, PhysicsError> {
    let models = base.models(recorded)?;
    let parts: Vec<Channels> = true_motion(recorded, base)
        .par_iter()
        .zip(&models)
        .map(|(trace, model)| one_flight((trace, recorded.len()), base, model).residual)
        .collect();
    let mut out = Channels::default();
    parts.iter().for_each(|part| append(&mut out, part));
    Ok(out)
}

fn forces_n(wrenches: &[Wrench]) -> Vec<Vector3<f64>> {
    wrenches.iter().map(|wrench| wrench.force_n).collect()
}

fn torques_nm(wrenches: &[Wrench]) -> Vec<Vector3<f64>> {
    wrenches.iter().map(|wrench| wrench.torque_nm).collect()
}

fn weak_wrench(trace: &Trace, forces: &[Vector3<f64>], torques: &[Vector3<f64>]) -> Channels {
    channels(trace, trace.weak_vector(0, forces), trace.weak_vector(0, torques))
}

/// One flight's share of the rows.
pub(super) struct Part {
    pub(super) along: Along,
    pub(super) residual: Channels,
    /// the same ones in every flight
    pub(super) nuisances: Vec<NuisanceColumn>,
    /// of this flight alone
    pub(super) own: Vec<NuisanceColumn>,
}

/// `model` is that of the base on this flight.
pub(super) fn one_flight((trace, flights): (&Trace, usize), base: &Base, model: &Model) -> Part {
    let base = &*base.on(&trace.own);
    let (felt, commanded) = trace.by_commands(&model.airframe, base.latency);
    let (by_commands, (motion, by_motion)) =
        rayon::join(|| wrench_along(model, trace, &commanded), || moved_by(trace, (base, model), &commanded));
    let (force_n, torque_nm) = (forces_n(&by_commands), torques_nm(&by_motion));
    drop((by_commands, by_motion));
    let along = Along { felt, commanded, motion, force_n, torque_nm };
    let (residual, (nuisances, own)) = rayon::join(
        || residual(trace, base, model, &along),
        || {
            let own = velocity_error((trace, flights), (base, model), &along.commanded, &along.force_n);
            (nuisances(trace, base, &along.commanded, &along.force_n), own)
        },
    );
    Part { along, residual, nuisances, own }
}

/// Base and model are those on this flight: `m K(a) - K(F)` and `D(J w) + K(w x J w) - K(M)`, with the effects' part from the smooth thrusts.
pub(super) fn residual(trace: &Trace, base: &Base, model: &Model, along: &Along) -> Channels {
    let airframe = &model.airframe;
    let jitter = trace.jitter(&airframe.propulsion);
    let (commanded_n, moved_n) = (&along.commanded.thrust_n, &along.motion.thrust_n);
    let (mut forces, mut torques) = (Vec::new(), Vec::new());
    for index in 0..trace.grid.count {
        let rotors = airframe.thrust_wrench(&along.felt.at(index));
        let jitter = jitter.as_ref().map_or_else(Vector4::zeros, |jitter| jitter[index] * 0.5);
        let effects_force = along.force_n[index] - airframe.thrust_wrench(&commanded_n.at(index)).force_n;
        let effects_torque = along.torque_nm[index] - airframe.thrust_wrench(&moved_n.at(index)).torque_nm;
        let used = if trace.usable[index] { 1.0 } else { 0.0 };
        forces.push(rotors.force_n - Vector3::z() * jitter[0] + effects_force * used);
        torques
            .push(rotors.torque_nm - Vector3::new(jitter[1], jitter[2], jitter[3]) + effects_torque * used);
    }
    let acting = weak_wrench(trace, &forces, &torques);
    let readings = trace.weak_specific_force();
    let momentum = trace.momentum(base.vehicle.body.gyroscopic);
    let j = &base.vehicle.body.inertia_kg_m2;
    let six = [j[(0, 0)], j[(0, 1)], j[(0, 2)], j[(1, 1)], j[(1, 2)], j[(2, 2)]];
    let mut out = acting;
    for axis in 0..3 {
        for (reading, first) in readings.iter().zip([0, SECOND]) {
            for (row, value) in out[first + axis].iter_mut().enumerate() {
                *value = base.vehicle.body.mass_kg * reading[axis][row] - *value;
            }
        }
        for (row, value) in out[3 + axis].iter_mut().enumerate() {
            let turning: f64 = (0..6).map(|k| momentum[k][axis][row] * six[k]).sum();
            *value = turning - *value;
        }
    }
    out
}
