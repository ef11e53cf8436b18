//! Influence of the noise of the measured motion, which excites a slung load, on the estimates.
//!
//! A swing with little damping accumulates noise over the whole flight, and all rows then have a common error that
//! their residual does not show. Therefore the same amount of noise is added to the motion several times, and the
//! scatter of the estimates is added to their covariance.

use super::held::{FittedForm, Held, estimates};
use crate::diagnose::channels::{Channels, Nuisance};
use crate::diagnose::evidence::weighted;
use crate::diagnose::fit::{Fitted, Newton, fit};
use crate::diagnose::flight_rows::residuals;
use crate::diagnose::gates::Gates;
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use crate::stats::white_level_of;
use nalgebra::{DMatrix, Vector3};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use std::sync::Arc;

/// Number of noisier motions. They give a standard error to a fifth of itself.
const REPLICATES: u64 = 12;
/// A swing that loses its phase appears as a load that changes along the flight. This is the least change, as a share
/// of the load. Set by judgement.
const CHANGED_SHARE: f64 = 0.25;
/// The least change in standard errors. The usual three.
const CHANGED: f64 = 3.0;

/// Adds this scatter if a load is estimated. A swing that the noise hides does not determine its load.
pub(super) fn allow_for_noise(
    flights: &[Trace],
    fitted: &mut Fitted,
    settled: &mut [FittedForm],
) -> Result<(), PhysicsError> {
    scatter(flights, fitted)?;
    let before = fitted.base.effects.len() - settled.len();
    let mut hidden = Vec::new();
    for (index, of) in
        settled.iter_mut().enumerate().filter(|(_, of)| of.chosen.form.signature.role.hangs_below)
    {
        let all = estimates(fitted, before + index);
        // the number of cords that were tried allowed for
        let tried = 2.0 * (of.chosen.tried.max(1) as f64).ln();
        let needed = (Gates::default().deviate(of.chosen.form.signature).powi(2) + tried).sqrt();
        let seen = all.iter().any(|(slot, value, std, _)| *slot == 0 && *value > needed * std);
        let changes = seen && runs_out_of_step(fitted, before + index);
        if !seen || changes {
            hidden.push(before + index);
            let why = if changes {
                "the most likely swing loses its phase to the motion along the flight: the cord has another length, \
                 or the cause is something else"
            } else {
                "either there is no load, or its swing has little damping and the noise of the measured motion hides \
                 its phase"
            };
            let slots = 0..of.chosen.form.values.len();
            of.held = slots.map(|slot| (slot, Held::NotDetermined(why.to_owned()))).collect();
        }
    }
    if hidden.is_empty() {
        return Ok(());
    }
    // what is not determined is not in the model: its mass is the vehicle's again
    let mut base = fitted.base.clone();
    for load in hidden {
        base.vehicle.body.mass_kg += base.effects[load].values[0];
        base.effects[load].values[0] = 0.0;
        base.effects[load].free.clear();
    }
    *fitted = fit(flights, base, Newton::Held)?;
    Ok(())
}

/// Whether the load at `place` of the base seems to change along the flight, apart from its weight.
fn runs_out_of_step(fitted: &Fitted, place: usize) -> bool {
    let before: usize = fitted.base.effects[..place].iter().map(|present| present.free.len()).sum();
    let load = fitted.rows.effects.get(before);
    let mass = fitted.rows.nuisances.iter().find(|column| column.nuisance == Nuisance::Mass);
    let (Some(load), Some(mass)) = (load, mass) else { return false };
    let last = fitted.rows.len().saturating_sub(1).max(1) as f64;
    let along = |column: &Channels, law: fn(f64) -> f64| -> Channels {
        let by = |(row, value): (usize, &f64)| value * law(2.0 * row as f64 / last - 1.0);
        column.each_ref().map(|series| series.iter().enumerate().map(by).collect())
    };
    let square = |tau: f64| tau.powi(2) - 1.0 / 3.0;
    let columns = [
        along(&mass.values, |tau| tau),
        along(&mass.values, square),
        along(load, |tau| tau),
        along(load, square),
    ];
    let Some(evidence) = fitted.weighted.test(&columns) else { return false };
    let load_kg = fitted.base.effects[place].values[0];
    (2..columns.len()).any(|index| {
        let change_kg = evidence.theta[index].abs();
        change_kg > CHANGED_SHARE * load_kg && change_kg > CHANGED * evidence.std(index)
    })
}

fn scatter(flights: &[Trace], fitted: &mut Fitted) -> Result<(), PhysicsError> {
    if !fitted.base.estimates(|term| term.signature.role.hangs_below) {
        return Ok(());
    }
    let (rows, weights) = (&fitted.rows, &fitted.weighted);
    let Some(normal) = &weights.normal else { return Ok(()) };
    let moved = |seed: u64| {
        let mut rng = Pcg64Mcg::new(u128::from(seed) + 1);
        let noisy: Vec<Trace> = flights.iter().map(|trace| noisier(trace, &mut rng)).collect();
        let mut change = residuals(&noisy, &fitted.base)?;
        for (change, before) in change.iter_mut().zip(&rows.residual) {
            change.iter_mut().zip(before).for_each(|(change, before)| *change -= before);
        }
        let change = weighted(&change, &weights.sigma);
        Ok(normal.solve(&weights.nuisances.transposed_times(change.as_slice())))
    };
    let moves: Vec<_> =
        (0..REPLICATES).into_par_iter().map(moved).collect::<Result<Vec<_>, PhysicsError>>()?;
    let mut scatter = DMatrix::zeros(fitted.covariance.nrows(), fitted.covariance.ncols());
    for by in &moves {
        scatter += by * by.transpose() / REPLICATES as f64;
    }
    fitted.covariance += scatter;
    Ok(())
}

/// The same flight with a motion to which the same amount of white noise was added.
fn noisier(trace: &Trace, rng: &mut Pcg64Mcg) -> Trace {
    let mut trace = trace.clone();
    let level = Vector3::from_fn(|axis, _| {
        let series: Vec<f64> = trace.felt_m_s2.iter().map(|felt| felt[axis]).collect();
        Some(white_level_of(&series)).filter(|level| level.is_finite()).unwrap_or(0.0)
    });
    for felt in Arc::make_mut(&mut trace.felt_m_s2) {
        let noise = Vector3::from_fn(|_, _| StandardNormal.sample(rng));
        *felt += level.component_mul(&noise);
    }
    trace
}
