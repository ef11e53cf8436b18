//! A bent thrust curve, as the forces tell it that go with the commanded trajectory (two-stage least squares).
//!
//! Commands that react to noise hardly move the vehicle. By least squares the thrust then seems to follow its commands less than it does,
//! and a curve that is bent upwards seems straight. What of the commands goes with the commanded trajectory has no such noise in it.

use super::channels::CHANNELS;
use super::columns::Columns;
use super::evidence::weighted;
use super::fit::Fitted;
use super::instruments::inverse;
use super::signature::EffectTerm;
use super::trace::Trace;
use nalgebra::{DMatrix, DVector};

/// Least share of the bend's energy that goes with the commanded trajectory. With less, two-stage least squares falls back on least squares.
/// Calculated for a thrust curve that is not bent, 60 s of flight and answers to noise of 0.1 m/s^2: with a share of 0.23 the median of the
/// curvature is -0.19, with 0.81 it is none.
const LEAST_SHARE: f64 = 0.3;
/// Channel of the force along body z that is measured first.
const ALONG_Z: usize = 2;

/// A curvature with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bend {
    /// -, as `ThrustCurve` has it
    pub(super) curvature: f64,
    /// the same, standard error by noise and by that of the mass
    pub(super) std: f64,
}

impl Bend {
    /// The curvature of this effect, in a fit with or without it, by the forces along body z and instruments. What the model has of drag and
    /// inflow along z is estimated with it; all else is held. The mass follows from the mean thrust, which is left out. `None` where next to
    /// nothing is asked of the thrust.
    pub(super) fn by_instruments(flights: &[Trace], fitted: &Fitted, bend: &EffectTerm) -> Option<Self> {
        let columns = columns(flights, fitted, bend)?;
        let (count, all) = (columns.len(), CHANNELS * fitted.rows.len());
        let (mut asked, mut given) = (DMatrix::zeros(all, count), DMatrix::zeros(all, count));
        let residual = weighted(&fitted.rows.residual, &fitted.weighted.sigma);
        let mut y = DVector::zeros(all);
        let mut from = ALONG_Z * fitted.rows.len();
        let (mut told, mut all_told) = (0.0, 0.0);
        for trace in flights {
            let rows = trace.rows();
            let mut own = DMatrix::from_fn(rows, count, |row, column| columns[column][from + row]);
            for mut column in own.column_iter_mut() {
                let mean = column.mean();
                column.add_scalar_mut(-mean);
            }
            if let Some(basis) = trace.instruments.as_ref().and_then(|all| all.thrust.as_ref()) {
                let along = basis * basis.tr_mul(&own);
                asked.view_mut((from, 0), (rows, count)).copy_from(&along);
                told += along.column(0).norm_squared();
                all_told += own.column(0).norm_squared();
            }
            given.view_mut((from, 0), (rows, count)).copy_from(&own);
            let part = residual.rows(from, rows);
            y.rows_mut(from, rows).copy_from(&part.add_scalar(-part.mean()));
            from += rows;
        }
        if told.is_nan() || told <= LEAST_SHARE * all_told {
            return None;
        }
        let bread = inverse(&asked.tr_mul(&asked))?;
        let moved = &bread * asked.tr_mul(&y);
        let left = &y - &given * &moved;
        let tested = Columns::of(&asked, fitted.rows.len());
        let covariance = fitted.weighted.sandwich(&bread, &tested, &left, &DMatrix::zeros(count, count));
        // a mass that is wrong by a share changes the slope by as much
        let of_mass =
            fitted.rigid_body().covariance[(0, 0)].max(0.0).sqrt() / fitted.base.vehicle.body.mass_kg;
        let slot = bend.signature.role.bends_thrust?;
        let (curvature, std) = (bend.values[slot] + moved[0], covariance[(0, 0)].sqrt().hypot(of_mass));
        tracing::debug!(curvature, std, by_fit = bend.values[slot], "bend by instruments");
        (std > 0.0).then_some(Self { curvature, std })
    }

    /// Whether it is this many standard errors from none, on the side of a curvature of the model.
    pub(super) fn shows(&self, curvature: f64, least: f64) -> bool {
        self.curvature * curvature.signum() > least * self.std
    }

    /// Whether a curvature of the model is within this many standard errors.
    pub(super) fn agrees(&self, curvature: f64, most: f64) -> bool {
        (curvature - self.curvature).abs() < most * self.std
    }
}

/// The weighted columns of the bend and of what acts along body z in the model; `None` where the model does not allow the bend's.
fn columns(flights: &[Trace], fitted: &Fitted, bend: &EffectTerm) -> Option<Vec<DVector<f64>>> {
    let rows = &fitted.rows;
    let present = |first: usize| &rows.effects[first - rows.nuisances.len()];
    let own = fitted.with_first_columns().find(|(term, _)| term.is(bend.signature));
    let of_bend = match own {
        Some((_, first)) => present(first).clone(),
        None => rows.columns_of(flights, &fitted.base, bend).ok()?.into_iter().next()?,
    };
    let along_z = fitted.with_first_columns().flat_map(|(term, first)| {
        let role = &term.signature.role;
        let acts = move |slot: &usize| role.axial == Some(*slot) || role.vertical == Some(*slot);
        let slots = term.free.iter().enumerate().filter(move |(_, slot)| acts(slot));
        slots.map(move |(index, _)| present(first + index))
    });
    let all = std::iter::once(&of_bend).chain(along_z);
    Some(all.map(|column| weighted(column, &fitted.weighted.sigma)).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::base::Base;
    use crate::diagnose::candidates::candidates;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::diagnose::signatures::ALL;
    use crate::signals::Signals;
    use crate::simulate::RandomTrajectory;
    use crate::vehicle::Vehicle;

    /// Names the thrust curve.
    const CURVE: &str = "thrust_curve";

    /// A flight with this curvature concealed. Its gyroscopes count as noisy, so that the bend is judged by instruments.
    fn bent(curvature: f64) -> (Trace, Vehicle) {
        let (mut signals, vehicle): (Signals, _) = flown(23, &RandomTrajectory::default(), |truth, _| {
            conceal(truth, (curvature != 0.0).then_some((CURVE, &[curvature] as &[f64])));
        });
        signals.quality.gyro_noise_rad_s = Some(1.0);
        (Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap(), vehicle)
    }

    /// The bend of a model with this curvature, or without one.
    fn told(trace: &Trace, vehicle: &Vehicle, in_model: Option<f64>) -> Bend {
        let mut base = Base::anchored(vehicle);
        let all = candidates(vehicle, std::slice::from_ref(trace), ALL);
        let mut term = all.iter().find(|of| of.id == CURVE).unwrap().parts[0].clone();
        if let Some(curvature) = in_model {
            base.effects.push(EffectTerm { values: vec![curvature], ..term.clone() });
            term = base.effects[0].clone();
        }
        let fitted = fit(std::slice::from_ref(trace), base, Newton::Held).unwrap();
        let term = fitted.base.effects.first().unwrap_or(&term);
        Bend::by_instruments(std::slice::from_ref(trace), &fitted, term).unwrap()
    }

    #[test]
    fn instruments_tell_a_bend_whether_the_model_has_one_or_not() {
        let (trace, vehicle) = bent(0.2);
        for bend in [told(&trace, &vehicle, None), told(&trace, &vehicle, Some(0.1))] {
            // the model has no latency yet
            assert!(bend.shows(0.1, 6.0) && !bend.shows(-0.1, 0.0), "{bend:?}");
            assert!((bend.curvature - 0.2).abs() < 0.02, "{bend:?}");
        }
        let (trace, vehicle) = bent(0.0);
        let bend = told(&trace, &vehicle, None);
        assert!(!bend.shows(1.0, 3.0) && !bend.shows(-1.0, 3.0), "{bend:?}");
        assert!(bend.curvature.abs() < 0.02, "{bend:?}");
    }
}
