//! The form of each effect: all forms are fitted, and the most likely one is taken.

use super::requested::RequestedEffects;
use crate::diagnose::base::{Base, lift_load};
use crate::diagnose::fit::{Newton, fit};
use crate::diagnose::priors::Alike;
use crate::diagnose::recorded::Recorded;
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use rayon::prelude::*;

/// The chosen form of an effect.
#[derive(Debug, Clone)]
pub(super) struct Chosen {
    /// start values and what is estimated of them
    pub(super) form: EffectTerm,
    /// how many forms were tried
    pub(super) tried: usize,
    /// slot and standard error of a value that was found by trying (the time of a change)
    pub(super) tried_std: Option<(usize, f64)>,
}

/// Step between lengths of a cord around the most likely tried length, as a share of it. A number of steps: only the
/// time of a search and its last digits depend on it.
const LENGTH_EVERY: f64 = 0.0025;
const LENGTH_STEPS: i32 = 8;
/// The same step for a damped swing, whose lengths may lie farther apart. A number of steps: only the time of a
/// search and its last digits depend on it.
const DAMPED_EVERY: f64 = 0.01;
const DAMPINGS: [f64; 5] = [0.4, 0.65, 1.0, 1.5, 2.2];
/// Time around the moment of a change in which moments are tried, s. It is the step of the search before.
const ABOUT_S: f64 = 4.0;
/// Step between these moments, s. The resolution of the search, which is part of the stated error of a moment.
const EVERY_S: f64 = 0.25;

/// Chooses one form of every effect with columns of its own, in the requested order.
pub(super) fn choose(
    flights: &[Trace],
    base: &Base,
    wanted: &RequestedEffects,
    recorded: &Recorded,
) -> Result<Vec<Chosen>, PhysicsError> {
    let forms: Vec<Vec<EffectTerm>> =
        wanted.with_columns().map(|signature| wanted.forms(signature, recorded)).collect();
    let open = forms.iter().filter(|forms| forms.len() > 1).count();
    // what has one form is there from the beginning; of two that have several, the first is chosen once more
    let mut picked: Vec<Option<EffectTerm>> =
        forms.iter().map(|forms| if forms.len() == 1 { forms.first().cloned() } else { None }).collect();
    let sweeps = if open > 1 { 2 } else { 1 };
    let mut spread = vec![None; forms.len()];
    for _ in 0..sweeps {
        for (place, forms) in forms.iter().enumerate().filter(|(_, forms)| forms.len() > 1) {
            if forms.iter().all(|form| form.signature.role.hangs_below) {
                picked[place] = Some(length(flights, base, &picked, (place, forms))?);
                continue;
            }
            let mut best = likeliest(flights, base, &picked, (place, forms))?;
            if best.form.signature.role.moment.is_some() {
                let tried = moments_about(&best.form, flights);
                best = likeliest(flights, base, &picked, (place, &tried))?;
                spread[place] = Some((0, moment_std_s(&best, &tried)));
            }
            picked[place] = Some(best.form);
        }
    }
    let taken = picked.into_iter().zip(&forms).zip(spread);
    Ok(taken
        .filter_map(|((form, forms), tried_std)| Some(Chosen { form: form?, tried: forms.len(), tried_std }))
        .collect())
}

/// The most likely form, with the misfits of all.
struct Likeliest {
    form: EffectTerm,
    misfits: Vec<f64>,
    /// factor of correlated noise on standard deviations
    deviation: f64,
}

fn likeliest(
    flights: &[Trace],
    base: &Base,
    picked: &[Option<EffectTerm>],
    (place, forms): (usize, &[EffectTerm]),
) -> Result<Likeliest, PhysicsError> {
    // misfit, slow noise, what the nuisances ask of what is known of them beforehand, rows
    let fits: Vec<(f64, f64, f64, usize)> = forms
        .par_iter()
        .map(|form| {
            let mut base = with_others(base, picked, place);
            base.effects.push(form.clone());
            let fitted = fit(flights, base, Newton::Held)?;
            Ok((
                fitted.misfit(),
                fitted.weighted.long_run_deviation(),
                fitted.against_priors(Alike::ONE),
                fitted.rows.len(),
            ))
        })
        .collect::<Result<_, PhysicsError>>()?;
    let deviation = fits.iter().map(|(_, deviation, ..)| *deviation).fold(f64::INFINITY, f64::min);
    let price = |form: &EffectTerm, rows: usize| 0.5 * form.free.len() as f64 * (rows.max(2) as f64).ln();
    let misfits: Vec<f64> = fits
        .iter()
        .zip(forms)
        .map(|((misfit, _, against, rows), form)| misfit + (price(form, *rows) + against) * deviation.powi(2))
        .collect();
    let best = misfits.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index);
    Ok(Likeliest { form: forms[best].clone(), misfits, deviation })
}

/// The base with the chosen forms, except for one place.
fn with_others(base: &Base, picked: &[Option<EffectTerm>], place: usize) -> Base {
    let mut base = base.clone();
    let others = picked.iter().enumerate().filter(|(other, _)| *other != place);
    base.effects.extend(others.filter_map(|(_, present)| present.clone()));
    base
}

/// Length of the cord, damping of the swing and start value of the load, by the energy that a small load explains. The
/// pendulum keeps its phase over the whole flight only for nearly correct lengths.
fn length(
    flights: &[Trace],
    base: &Base,
    picked: &[Option<EffectTerm>],
    (place, forms): (usize, &[EffectTerm]),
) -> Result<EffectTerm, PhysicsError> {
    let fitted = fit(flights, with_others(base, picked, place), Newton::Held)?;
    let most = |forms: &[EffectTerm]| {
        let tested: Vec<(f64, EffectTerm)> = forms
            .par_iter()
            .filter_map(|form| {
                let columns = fitted.rows.columns_of(flights, &fitted.base, form).ok()?;
                let evidence = fitted.weighted.test(&columns)?;
                let load_kg = evidence.theta.first().copied().filter(|load_kg| *load_kg > 0.0)?;
                let mut form = form.clone();
                form.values[0] = form.possible(0, load_kg, &base.size);
                Some((evidence.energy, form))
            })
            .collect();
        tested.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, form)| form)
    };
    let Some(coarse) = most(forms) else { return Ok(forms[0].clone()) };
    let damped = coarse.values[2] > 0.0;
    let (every, dampings) = if damped { (DAMPED_EVERY, &DAMPINGS[..]) } else { (LENGTH_EVERY, &[1.0][..]) };
    let mut finely = Vec::new();
    for (times, step) in
        dampings.iter().flat_map(|times| (-LENGTH_STEPS..=LENGTH_STEPS).map(move |step| (times, step)))
    {
        let mut form = coarse.clone();
        let length_m = coarse.values[1] * (1.0 + every * f64::from(step));
        form.values = vec![0.0, form.possible(1, length_m, &base.size), coarse.values[2] * times];
        finely.push(form);
    }
    let mut found = most(&finely).unwrap_or(coarse);
    lift_load(&mut found, fitted.base.vehicle.body.mass_kg);
    found.free = (0..found.values.len()).collect();
    Ok(found)
}

/// The same change at times around the one that was found.
fn moments_about(form: &EffectTerm, flights: &[Trace]) -> Vec<EffectTerm> {
    let time_s = form.values[0];
    let flown = flights.first().and_then(|trace| {
        Some((trace.grid.time_s(*trace.centers.first()?), trace.grid.time_s(*trace.centers.last()?)))
    });
    let (first_s, last_s) = flown.unwrap_or((time_s, time_s));
    let mut out = Vec::new();
    let mut at_s = time_s - ABOUT_S;
    while at_s <= time_s + ABOUT_S {
        if at_s > first_s && at_s < last_s {
            let mut moved = form.clone();
            moved.values[0] = at_s;
            out.push(moved);
        }
        at_s += EVERY_S;
    }
    if out.is_empty() { vec![form.clone()] } else { out }
}

/// Standard error of the time, s, from the decrease of the likelihood around it and from the step of the tried times.
fn moment_std_s(best: &Likeliest, tried: &[EffectTerm]) -> f64 {
    let least = best.misfits.iter().copied().fold(f64::INFINITY, f64::min);
    let weights = best.misfits.iter().map(|misfit| (-(misfit - least) / best.deviation.powi(2)).exp());
    let (mut sum, mut square) = (0.0, 0.0);
    for (weight, form) in weights.zip(tried) {
        sum += weight;
        square += weight * (form.values[0] - best.form.values[0]).powi(2);
    }
    (square / sum.max(f64::MIN_POSITIVE) + EVERY_S.powi(2) / 12.0).sqrt()
}
