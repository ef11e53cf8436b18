//! Sizes of the forces, from the flight path and the parameters estimated at once.
//!
//! The weak form takes the autopilot's velocity and attitude for the motion, and the error of both pulls a drag towards nought.
//! Once the effects are named, each flight is reconstructed with them, and their sizes come from there.

use super::base::{Base, follows_force};
use super::channels::Nuisance;
use super::fit::{Fitted, Newton, evaluate, fit as fit_rows};
use super::force_forms::{choose_forms, open_form};
use super::force_terms::{begin_at, terms};
use super::hausman::differ;
use super::pooled_estimate::PooledEstimate;
use super::tested::Search;
use super::trace::Trace;
use crate::physics::PhysicsError;
use crate::reconstruction::{
    Fit, FitError, KnownLag, Path, Problem, ReconstructionError, Term, fit, fit_mode, force_problem,
};
use crate::signals::{Signals, ThrustSource};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Standard deviation of a lag that the torques have told, s, beside its own. It is the period of a usual log, by
/// which force and torque may differ.
const LAG_STD_S: f64 = 0.01;
/// Standard deviation of a lag where none was found, s.
const NO_LAG_STD_S: f64 = 0.005;
/// The scale of thrust over mass stays within this factor of what the weak form found, or the fit is not believed. A
/// larger change is a failed fit.
const MOST_SCALE: f64 = 1.5;

/// Standard errors by which an estimate may be beyond what is possible. The usual two.
const BEYOND_BOUND: f64 = 2.0;
/// The same of a law of the drag beside another one, which takes over what it gives up: the sum of both is what the flight tells.
const BEYOND_BOUND_BESIDE_A_LAW: f64 = 10.0;

/// Whether the forms of effects are open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Forms {
    /// the forces tell of the body or of the rotors
    Chosen,
    /// they are known from other flights
    Known,
}

/// Replaces sizes of forces, and the mass, by those of the reconstruction where all flights allow one; returns whether they do. It
/// begins at the values of `start`, a model with the same effects; `None`: at those of the fit.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub(super) fn reconstruct(
    signals: &[Signals],
    traces: &[Trace],
    (forms, found): (Forms, &mut Search),
    start: Option<&Base>,
) -> Result<bool, PhysicsError> {
    let flights = Flights { signals, latency_std_s: found.latency.std_s, forms };
    match flights.sizes(traces, &found.after, start.unwrap_or(&found.after.base), &found.paths)? {
        Ok(told) => {
            (found.after, found.paths) = told;
            Ok(true)
        }
        Err(why) => {
            tracing::debug!(%why, "sizes of forces left as they were");
            Ok(matches!(why, Kept::Alike))
        }
    }
}

/// A model as the flight path of all flights tells it.
pub(super) struct Reconstructed {
    /// in the forms that the forces show, at the values that were given
    pub(super) base: Base,
    terms: Vec<Term>,
    pooled: PooledEstimate,
    /// of each flight
    paths: Vec<Path>,
}

impl Reconstructed {
    /// These values of all free parameters, each with the same standard error.
    #[cfg(test)]
    pub(super) fn by_hand(base: Base, values: &[f64], std: f64) -> Self {
        let term = |term: &super::signature::EffectTerm| {
            Term::new(term.effect(), term.values.clone(), term.free.clone(), vec![1e-3; term.free.len()])
        };
        let terms = base.effects.iter().map(term).collect();
        let values =
            DVector::from_iterator(values.len() + 1, std::iter::once(1.0).chain(values.iter().copied()));
        let covariance = DMatrix::identity(values.len(), values.len()) * (std * std);
        Self { base, terms, pooled: PooledEstimate { values, covariance }, paths: Vec::new() }
    }

    /// Estimates, SI, and covariance of those values, each by the place of its effect and its slot, that the forces tell.
    pub(super) fn of(&self, asked: &[(usize, usize)]) -> (DVector<f64>, DMatrix<f64>) {
        let place_of = |&(place, slot): &(usize, usize)| {
            let own = self.terms[place].free.iter().position(|free| *free == slot)?;
            Some(self.first(place) + own)
        };
        let at: Vec<usize> = asked.iter().filter_map(place_of).collect();
        let PooledEstimate { values, covariance } = &self.pooled;
        (values.select_rows(&at), covariance.select_rows(&at).select_columns(&at))
    }

    /// Another model with these estimates where it has the effect: of those that forces tell each is there once.
    pub(super) fn put_into(&self, mut base: Base) -> Base {
        for (place, (told, term)) in self.base.effects.iter().zip(&self.terms).enumerate() {
            let Some(same) = base.effects.iter_mut().find(|term| term.is(told.signature)) else { continue };
            for (index, &slot) in term.free.iter().enumerate().filter(|(_, slot)| same.free.contains(slot)) {
                same.values[slot] =
                    same.possible(slot, self.pooled.values[self.first(place) + index], &base.size);
            }
        }
        base
    }

    /// Place of an effect's first value among the estimates.
    fn first(&self, place: usize) -> usize {
        1 + self.terms[..place].iter().map(|term| term.free.len()).sum::<usize>()
    }
}

/// The estimates of another model of the same flights; `None` where they allow none.
pub(super) fn reconstructed_with(
    signals: &[Signals],
    found: &mut Search,
    base: Base,
) -> Option<Reconstructed> {
    let flights = Flights { signals, latency_std_s: found.latency.std_s, forms: Forms::Chosen };
    let told = flights.estimated(&found.after, base, &found.paths).ok()?;
    plausible_scale(told.pooled.values[0]).ok()?;
    found.paths.clone_from(&told.paths);
    Some(told)
}

/// Why the sizes stay as they were.
#[derive(Debug, thiserror::Error)]
enum Kept {
    #[error("an effect has states of its own, or changes what sensors show")]
    OtherKind,
    #[error("no force is among the effects")]
    NoForce,
    #[error("{0}")]
    Flight(#[from] ReconstructionError),
    #[error("their information is singular")]
    Singular,
    #[error("the weak form finds the same, with smaller errors")]
    Alike,
    #[error("{what} at {value} is not plausible")]
    Implausible { what: &'static str, value: f64 },
}

/// What is reconstructed.
struct Flights<'a> {
    signals: &'a [Signals],
    latency_std_s: f64,
    forms: Forms,
}

impl Flights<'_> {
    fn sizes(
        &self,
        traces: &[Trace],
        fitted: &Fitted,
        start: &Base,
        begun: &[Path],
    ) -> Result<Result<(Fitted, Vec<Path>), Kept>, PhysicsError> {
        match self.estimated(fitted, start.clone(), begun) {
            Ok(Reconstructed { base, terms, pooled, paths }) => {
                Ok(replaced(traces, (fitted, base), &terms, &pooled)?.map(|after| (after, paths)))
            }
            Err(why) => Ok(Err(why)),
        }
    }

    /// The base in the forms that the forces show, and its values; the latency is that of the fit. It begins at the paths of the flights
    /// (`begun`), where an estimate with other effects left some.
    fn estimated(&self, fitted: &Fitted, mut base: Base, begun: &[Path]) -> Result<Reconstructed, Kept> {
        let mut open = base.clone();
        for present in &mut open.effects {
            open_form(present);
        }
        let of_open = terms(&open).ok_or(Kept::OtherKind)?;
        if of_open.iter().all(|term| term.free.is_empty()) {
            return Err(Kept::NoForce);
        }
        let mut opened: Option<(PooledEstimate, Vec<Path>)> = None;
        let has_forms = open.effects.iter().any(|present| present.signature.role.with_speed.is_some());
        if has_forms && self.forms == Forms::Chosen {
            let (pooled, paths) = self.pooled_over_flights((fitted, &open), &of_open, fit_mode, begun)?;
            choose_forms(&mut base, &of_open, &pooled);
            opened = Some((pooled, paths));
        }
        let mut terms = terms(&base).ok_or(Kept::OtherKind)?;
        let begun = match &opened {
            Some((pooled, paths)) => {
                begin_at(&mut terms, &of_open, pooled);
                paths
            }
            None => begun,
        };
        let (pooled, paths) = self.pooled_over_flights((fitted, &base), &terms, fit, begun)?;
        Ok(Reconstructed { base, terms, pooled, paths })
    }

    fn pooled_over_flights(
        &self,
        (fitted, base): (&Fitted, &Base),
        terms: &[Term],
        estimate: Estimate,
        begun: &[Path],
    ) -> Result<(PooledEstimate, Vec<Path>), Kept> {
        let one = |(index, signals): (usize, &Signals)| {
            let lag = known_lag(fitted, signals, self.latency_std_s);
            fitted_flight((signals, base, lag), terms, estimate, begun.get(index))
        };
        let fits: Vec<Fit> = self.signals.par_iter().enumerate().map(one).collect::<Result<_, _>>()?;
        let pooled = PooledEstimate::of(&fits, terms).ok_or(Kept::Singular)?;
        Ok((pooled, fits.into_iter().map(|fit| fit.path).collect()))
    }
}

/// A fit of states and parameters.
type Estimate = fn(Problem, &[usize]) -> Result<Fit, FitError>;

fn known_lag(fitted: &Fitted, signals: &Signals, std_s: f64) -> KnownLag {
    if signals.quality.thrust_source == ThrustSource::MeasuredSpeed {
        return KnownLag { delay_s: 0.0, lag_s: 0.0, lag_std_s: NO_LAG_STD_S, uneven: 0.0 };
    }
    let latency = &fitted.base.latency;
    let lag_std_s = if latency.lag_s > 0.0 { LAG_STD_S.hypot(std_s.min(LAG_STD_S)) } else { NO_LAG_STD_S };
    KnownLag { delay_s: latency.delay_s.max(0.0), lag_s: latency.lag_s, lag_std_s, uneven: latency.uneven }
}

fn fitted_flight(
    (signals, base, lag): (&Signals, &Base, KnownLag),
    terms: &[Term],
    estimate: Estimate,
    path: Option<&Path>,
) -> Result<Fit, ReconstructionError> {
    let base = base.on(&signals.own);
    let mut terms = terms.to_vec();
    for (term, own) in terms.iter_mut().zip(&base.effects).filter(|(term, _)| term.free.is_empty()) {
        term.values.clone_from(&own.values);
    }
    let problem = || force_problem(signals, &base.vehicle, lag, terms.clone());
    let begun = problem()?.from_path(path);
    let free: Vec<usize> = (0..begun.unknowns.len()).collect();
    match estimate(begun, &free) {
        Err(_) if path.is_some() => Ok(estimate(problem()?, &free)?),
        found => Ok(found?),
    }
}

/// A value of the reconstruction: its place among the effects and its slot, where it stands in [`PooledEstimate`], the value.
struct Size {
    place: usize,
    slot: usize,
    at: usize,
    value: f64,
}

/// Index of an effect's free value among the coefficients of a fit.
pub(super) fn column(fitted: &Fitted, place: usize, slot: usize) -> Option<usize> {
    let present = &fitted.base.effects;
    let before: usize = present[..place].iter().map(|term| term.free.len()).sum();
    let own = present[place].free.iter().position(|free| *free == slot)?;
    Some(fitted.rows.nuisances.len() + before + own)
}

/// The weak form is the more precise while the autopilot's velocity has no error that matters; where
/// the reconstruction finds something else beyond what its greater variance allows, or where it is the more precise one, the
/// reconstruction holds.
fn differs(fitted: &Fitted, sizes: &[Size], covariance: &DMatrix<f64>) -> bool {
    sizes.iter().any(|&Size { place, slot, at, value }| {
        let Some(index) = column(fitted, place, slot) else { return false };
        let (more, less) = (covariance[(at, at)], fitted.covariance[(index, index)]);
        let apart = value - fitted.base.effects[place].values[slot];
        differ(apart, less, more)
    })
}

/// The base at the estimates, and these with what is beyond its bound at the bound.
fn within_bounds(
    base: &Base,
    terms: &[Term],
    pooled: &PooledEstimate,
) -> Result<(Base, PooledEstimate), Kept> {
    plausible_scale(pooled.values[0])?;
    let slots = || {
        terms.iter().enumerate().flat_map(|(place, term)| term.free.iter().map(move |&slot| (place, slot)))
    };
    let mut held: Vec<(usize, f64)> = Vec::new();
    for (index, (place, slot)) in slots().enumerate() {
        let (at, present) = (1 + index, &base.effects[place]);
        let (estimate, bound) = (pooled.values[at], present.possible(slot, pooled.values[at], &base.size));
        // what the search took for a drag, or for another law of it, comes out at nothing, and then leaves the model
        let is_drag = present.signature.is_drag();
        let beside_a_drag =
            base.effects.iter().any(|other| other.signature.is_drag() && other.id() != present.id());
        let ends_at_nothing = present.is_amount(slot) && bound == present.nothing_at(slot);
        let deviates = match (is_drag, beside_a_drag) {
            (true, true) => BEYOND_BOUND_BESIDE_A_LAW,
            (true, false) => BEYOND_BOUND,
            (false, true) if ends_at_nothing => BEYOND_BOUND,
            _ => 0.0,
        };
        if (bound - estimate).abs() > deviates * pooled.std(at) {
            tracing::debug!(what = present.id(), estimate, std = pooled.std(at), "beyond what is possible");
            return Err(Kept::Implausible { what: present.id(), value: estimate });
        }
        held.extend((bound != estimate).then_some((at, bound)));
    }
    let pooled = pooled.held_at(&held).ok_or(Kept::Singular)?;
    plausible_scale(pooled.values[0])?;
    let mut within = base.clone();
    for (index, (place, slot)) in slots().enumerate() {
        let present = &mut within.effects[place];
        present.values[slot] = present.possible(slot, pooled.values[1 + index], &base.size);
    }
    Ok((within, pooled))
}

fn plausible_scale(scale: f64) -> Result<(), Kept> {
    let plausible = (MOST_SCALE.recip()..=MOST_SCALE).contains(&scale);
    plausible.then_some(()).ok_or(Kept::Implausible { what: "thrust over mass", value: scale })
}

/// The fit with the new values, and their covariance in place of its own.
fn replaced(
    traces: &[Trace],
    (fitted, mut base): (&Fitted, Base),
    terms: &[Term],
    pooled: &PooledEstimate,
) -> Result<Result<Fitted, Kept>, PhysicsError> {
    let (within, PooledEstimate { values, covariance }) = match within_bounds(&base, terms, pooled) {
        Ok(within) => within,
        Err(why) => return Ok(Err(why)),
    };
    base = within;
    let mut sizes: Vec<Size> = Vec::new();
    for (place, term) in terms.iter().enumerate() {
        for &slot in &term.free {
            sizes.push(Size { place, slot, at: 1 + sizes.len(), value: base.effects[place].values[slot] });
        }
    }
    if !differs(fitted, &sizes, &covariance) {
        return Ok(Err(Kept::Alike));
    }
    // amounts that are not the forces' follow, on the scale of the thrust until now; the forms stay
    let mut held = Base { weighed_kg: None, ..base.clone() };
    for (present, term) in held.effects.iter_mut().zip(terms) {
        let amounts = present.signature.amounts;
        present.free.retain(|slot| !term.free.contains(slot) && amounts.contains(slot));
    }
    let settled = fit_rows(traces, held, Newton::Held)?.base;
    for (present, settled) in base.effects.iter_mut().zip(&settled.effects) {
        present.values.clone_from(&settled.values);
    }
    base.vehicle = settled.vehicle;
    let scale = values[0];
    base.vehicle.body.mass_kg = fitted.base.vehicle.body.mass_kg / scale;
    let by_force = base.bring_to_scale(fitted.rows.compares_torques);
    let mut after = evaluate(traces, base)?;
    put_covariance(&mut after, &sizes, (scale, by_force), &covariance);
    Ok(Ok(after))
}

/// Puts the covariance of the scale and of the sizes in place of the fit's own. `by_force` is the
/// factor by which what follows the force was brought to the scale of a weighed mass.
fn put_covariance(
    after: &mut Fitted,
    sizes: &[Size],
    (scale, by_force): (f64, f64),
    covariance: &DMatrix<f64>,
) {
    let mass_kg = after.base.vehicle.body.mass_kg;
    let mass = after.rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Mass);
    // of the mass: -m / scale per unit of scale
    let mut all: Vec<(usize, usize, f64)> =
        mass.map(|mass| (mass, 0, -mass_kg / scale)).into_iter().collect();
    for &Size { place, slot, at, .. } in sizes {
        let parameter = after.base.effects[place].parameter(slot);
        let by = if parameter.is_some_and(|of| follows_force(of.unit)) { by_force } else { 1.0 };
        all.extend(column(after, place, slot).map(|index| (index, at, by)));
    }
    for &(index, ..) in &all {
        after.covariance.row_mut(index).fill(0.0);
        after.covariance.column_mut(index).fill(0.0);
    }
    for &(row, i, by) in &all {
        for &(column, j, and) in &all {
            after.covariance[(row, column)] += by * and * covariance[(i, j)];
        }
    }
}
