//! Torques by instruments (two-stage least squares).
//!
//! The controller answers the noise of the measured motion, so commands and motion share it, and least squares takes the
//! answer for the vehicle. Only what of each column goes with the commanded trajectory is compared.

use super::channels::{AXES, CHANNELS, Channels, Nuisance};
use super::columns::Columns;
use super::evidence::weighted;
use super::fit::{CONVERGED, Coefficients, Fitted, Newton, PASSES, linearised, step};
use super::hausman::holds;
use super::instruments::inverse;
use super::latency_error::{by_latency, late_effects};
use super::left_over::of_left_over;
use super::priors::Priors;
use super::trace::Trace;
use crate::estimate::{Estimated, MOMENTS};
use crate::physics::PhysicsError;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Inertia and damping of a model as instruments tell them, where least squares contradicts them or is the less certain. The
/// latency of the model and its standard error, s, are known. Returns the places of the coefficients that
/// the instruments have told.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub(super) fn torques_by_instruments(
    flights: &[Trace],
    latency_std_s: f64,
    fitted: &mut Fitted,
) -> Result<Vec<usize>, PhysicsError> {
    let Some(mut by) = fit_by_instruments(flights, fitted, Newton::Held)? else { return Ok(Vec::new()) };
    if let Some(brings) = brought_by_latency(flights, &by).filter(|_| latency_std_s.is_finite()) {
        by.covariance += &brings * brings.transpose() * latency_std_s.powi(2);
    }
    let of_latency = by_latency(flights, fitted, (latency_std_s, &[]))?;
    // what alternates is in both, which read the same commands
    let (plain, told) = (fitted.rigid_body_by_rows(), by.rigid_body_by_rows());
    let contradicts = |at: usize| {
        let variance = |body: &Estimated| body.covariance[(at, at)];
        let moment = Nuisance::Inertia(at - 1);
        let place = fitted.rows.nuisances.iter().position(|column| column.nuisance == moment);
        let of_model =
            place.map_or(0.0, |place| of_left_over(&fitted.weighted, place) + of_latency[(place, place)]);
        holds(told.theta[at] - plain.theta[at], variance(&plain), of_model, variance(&told))
    };
    if !MOMENTS.into_iter().any(contradicts) {
        return Ok(Vec::new());
    }
    let places: Vec<usize> =
        (0..by.covariance.nrows()).filter(|&place| by.covariance[(place, place)] > 0.0).collect();
    // what the torques do not tell stays as it is known
    let mut after = fitted.moved_to(flights, by.base)?;
    let others = 0..after.covariance.nrows();
    for &place in &places {
        for other in others.clone() {
            let shared = by.covariance[(place, other)];
            (after.covariance[(place, other)], after.covariance[(other, place)]) = (shared, shared);
        }
    }
    *fitted = after;
    Ok(places)
}

/// The fit with inertia, latency and what damps the rotation by instruments, iterated; `None` where they cannot be had so.
///
/// Coefficients and covariance of the result are those of these parameters, and zero for all others.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub(super) fn fit_by_instruments(
    flights: &[Trace],
    fitted: &Fitted,
    newton: Newton,
) -> Result<Option<Fitted>, PhysicsError> {
    let mut base = fitted.base.clone();
    let Some(told) = by_instruments(flights, fitted, newton) else { return Ok(None) };
    let mut moved = step(&mut base, &fitted.rows, &told.0, newton).largest(&told.1);
    let mut effects = (moved >= CONVERGED).then(|| fitted.rows.effects.clone());
    for _ in 0..PASSES {
        // what damps is linear: its columns stay on the way, and the result has its own
        let near = effects.take().filter(|_| moved >= CONVERGED);
        let is_own = near.is_none();
        // the one before is gone: two of a long flight at a time take much memory
        let Ok(mut by) = linearised(flights, base.clone(), near) else { return Ok(None) };
        let Some(told) = by_instruments(flights, &by, newton) else { return Ok(None) };
        let mut next = base.clone();
        moved = step(&mut next, &by.rows, &told.0, newton).largest(&told.1);
        if is_own && moved < CONVERGED {
            (by.coefficients, by.covariance) = told;
            return Ok(Some(by));
        }
        base = next;
        effects = Some(by.rows.effects);
    }
    Ok(None)
}

/// The torque rows: columns as they are, what of them goes with the instruments, and the inverse of their normal matrix.
struct Projected {
    /// among the coefficients of the fit
    places: Vec<usize>,
    given: DMatrix<f64>,
    asked: DMatrix<f64>,
    bread: DMatrix<f64>,
    /// what is known of each before: its pull, and its part in the variance of the scores
    known: (DVector<f64>, DVector<f64>),
}

impl Projected {
    /// `None` where no flight has instruments, or they do not tell the columns apart.
    fn of(flights: &[Trace], fitted: &Fitted, newton: Newton) -> Option<Self> {
        let served = served(flights, fitted);
        let (places, columns) = estimated(fitted, &served, newton)?;
        let count = columns.len();
        let all = CHANNELS * fitted.rows.len();
        let (mut asked, mut given) = (DMatrix::zeros(all, count), DMatrix::zeros(all, count));
        for (rows, basis) in served {
            let mut own =
                DMatrix::from_fn(rows.len(), count, |row, column| columns[column][rows.start + row]);
            for mut column in own.column_iter_mut() {
                let mean = column.mean();
                column.add_scalar_mut(-mean);
            }
            let along = basis * basis.tr_mul(&own);
            asked.view_mut((rows.start, 0), (rows.len(), count)).copy_from(&along);
            given.view_mut((rows.start, 0), (rows.len(), count)).copy_from(&own);
        }
        let alike = fitted.weighted.alike();
        let priors = Priors::of(&fitted.rows.nuisances, fitted.coefficients.len(), alike);
        let normal = asked.tr_mul(&asked) + DMatrix::from_diagonal(&priors.precision.select_rows(&places));
        let bread = inverse(&normal)?;
        let known = (priors.pull.select_rows(&places), priors.meat.select_rows(&places));
        Some(Self { places, given, asked, bread, known })
    }

    /// Coefficients for a column of the torque rows.
    fn part_in(&self, column: &DVector<f64>) -> DVector<f64> {
        &self.bread * self.asked.tr_mul(column)
    }
}

/// Rows among those of all channels, with the directions of their instruments.
type Served<'a> = (Range<usize>, &'a DMatrix<f64>);

/// Share of a column's squares that must lie where there are instruments. With less most of the column would have no
/// instrument.
const LEAST_TOLD: f64 = 0.5;

/// The rows and instruments of each torque that has any: those of a vehicle that is not asked to turn about an axis say nothing
/// of it.
fn served<'a>(flights: &'a [Trace], fitted: &Fitted) -> Vec<Served<'a>> {
    let mut out = Vec::new();
    let mut first = 0;
    for trace in flights {
        for (axis, basis) in trace.instruments.iter().flat_map(|all| all.torques.iter()).enumerate() {
            let from = (3 + axis) * fitted.rows.len() + first;
            out.extend(basis.iter().map(|basis| (from..from + trace.rows(), basis)));
        }
        first += trace.rows();
    }
    out
}

/// The torques' part of a column, about its mean in each stretch with instruments.
fn of_torques(column: &Channels, flights: &[Trace], fitted: &Fitted) -> DVector<f64> {
    let all = weighted(column, &fitted.weighted.sigma);
    let mut out = DVector::zeros(all.len());
    for (rows, _) in served(flights, fitted) {
        let part = all.rows_range(rows.clone());
        let mean = part.mean();
        out.rows_range_mut(rows).copy_from(&part.add_scalar(-mean));
    }
    out
}

/// What a second of error of the latency brings into each coefficient.
fn brought_by_latency(flights: &[Trace], fitted: &Fitted) -> Option<DVector<f64>> {
    let projected = Projected::of(flights, fitted, Newton::Held)?;
    let turning = fitted.rows.nuisances.iter().find(|column| column.nuisance == Nuisance::Latency)?;
    let others = late_effects(flights, fitted).ok()?;
    let late = of_torques(&turning.values, flights, fitted) + of_torques(&others, flights, fitted);
    let part = projected.part_in(&late);
    let mut out = DVector::zeros(fitted.covariance.nrows());
    for (&place, by) in projected.places.iter().zip(part.iter()) {
        out[place] = *by;
    }
    Some(out)
}

/// Inertia, latency and what damps the rotation by instruments; `None` where they do not tell them apart.
fn by_instruments(flights: &[Trace], fitted: &Fitted, newton: Newton) -> Option<Coefficients> {
    let projected = Projected::of(flights, fitted, newton)?;
    let Projected { places, given, asked, bread, known: (pull, meat) } = &projected;
    let y = of_torques(&fitted.rows.residual, flights, fitted);
    let told = projected.part_in(&y) + bread * pull;
    let left = y - given * &told;
    let tested = Columns::of(asked, fitted.rows.len());
    let told_covariance = fitted.weighted.sandwich(bread, &tested, &left, &DMatrix::from_diagonal(meat));
    if told_covariance.diagonal().iter().any(|variance| variance.is_nan() || *variance <= 0.0) {
        return None;
    }
    let all = fitted.coefficients.len();
    let (mut coefficients, mut covariance) = (DVector::zeros(all), DMatrix::zeros(all, all));
    for (i, &place) in places.iter().enumerate() {
        coefficients[place] = told[i];
        for (j, &other) in places.iter().enumerate() {
            covariance[(place, other)] = told_covariance[(i, j)];
        }
    }
    Some((coefficients, covariance))
}

/// Places among the coefficients and, weighted, the columns of what is estimated. A latency that is held is known: it and a
/// damping explain much of each other. So is what acts about axes without instruments.
fn estimated(
    fitted: &Fitted,
    served: &[Served<'_>],
    newton: Newton,
) -> Option<(Vec<usize>, Vec<DVector<f64>>)> {
    let rows = &fitted.rows;
    let torques = 3 * rows.len()..AXES * rows.len();
    let mut out = (Vec::new(), Vec::new());
    let mut take = |place: usize, values: &Channels| {
        let column = weighted(values, &fitted.weighted.sigma);
        let of = |rows: Range<usize>| column.rows_range(rows).norm_squared();
        let told: f64 = served.iter().map(|(rows, _)| of(rows.clone())).sum();
        if told > LEAST_TOLD * of(torques.clone()) {
            out.0.push(place);
            out.1.push(column);
        }
    };
    for (place, column) in rows.nuisances.iter().enumerate() {
        let wanted = match column.nuisance {
            Nuisance::Inertia(_) | Nuisance::GuessedMomentAboutZ => true,
            Nuisance::Latency => newton != Newton::Held,
            _ => false,
        };
        if wanted {
            take(place, &column.values);
        }
    }
    let terms = fitted.base.effects.iter().flat_map(|present| present.free.iter().map(move |_| present));
    for (place, (present, column)) in terms.zip(&rows.effects).enumerate() {
        // the forces tell a drag; the torques tell what else damps the rotation
        if present.signature.role.like_latency.is_some() && !present.signature.role.of_air {
            take(rows.nuisances.len() + place, column);
        }
    }
    (!out.0.is_empty()).then_some(out)
}
