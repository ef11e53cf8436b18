//! Check that the accelerometer measures a force that was found.
//!
//! A force on the vehicle appears in the accelerometer and in the derivative of the autopilot's velocity. A slow error of that
//! velocity appears in the derivative only.

use super::channels::{Channels, SECOND};
use super::evidence::{Evidence, Weighted};
use super::fit::Fitted;
use super::hausman::{DEVIATE, differ};
use super::signature::EffectTerm;
use crate::stats::normal_deviate;
use nalgebra::{DMatrix, DVector};

/// Standard errors below which the accelerometer alone shows no effect. The usual 95 %.
const NOTHING: f64 = 2.0;

/// Standard errors from which on the forces alone show an effect. The usual three.
const SHOWN: f64 = 3.0;

/// Largest factor by which the other columns may raise the variance of an amount: a force that is fixed in the body
/// is the same as the accelerometer's bias, and the accelerometer alone says nothing of it.
const INFLATION: f64 = 30.0;

/// What the accelerometer and the torques alone say of a model's columns.
pub(super) struct Felt {
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
    /// factor by which the other columns raise each variance
    inflation: DVector<f64>,
}

impl Felt {
    /// `None` where force is read once.
    pub(super) fn of(fitted: &Fitted) -> Option<Self> {
        if !is_read_twice(fitted) {
            return None;
        }
        let felt = Weighted::by_first_reading(&fitted.rows, &fitted.weighted);
        let normal = felt.normal.as_ref()?;
        let information = normal.l_dirty().lower_triangle();
        let information = (&information * information.transpose()).diagonal();
        let inflation = normal.inverse().diagonal().component_mul(&information);
        let (coefficients, covariance) = felt.coefficients(&fitted.rows);
        Some(Self { coefficients, covariance, inflation })
    }

    /// Whether the accelerometer shows none of an effect's amounts, and contradicts one of them. The effect's first column in the
    /// model has this index.
    pub(super) fn refutes(&self, fitted: &Fitted, term: &EffectTerm, first: usize) -> bool {
        let each = term.free.iter().enumerate().filter(|(_, slot)| term.is_amount(**slot));
        let of = |(index, &slot): (usize, &usize)| {
            let at = (first + index, first + index);
            let size = term.from_nothing(slot);
            Amount {
                size,
                variance: fitted.covariance[at],
                felt: size + self.coefficients[first + index],
                felt_variance: self.covariance[at],
            }
        };
        let told = |(index, _): &(usize, &usize)| self.inflation[first + index] < INFLATION;
        let amounts: Vec<Amount> =
            each.filter(told).map(of).filter(|amount| amount.felt_variance > 0.0).collect();
        amounts.iter().all(Amount::is_nothing) && amounts.iter().any(Amount::is_contradicted)
    }
}

/// Whether the accelerometer may feel a force that is on no model: it shows some of it, or does not contradict it. Columns and evidence
/// are those of the force, by both readings.
pub(super) fn may_feel(fitted: &Fitted, columns: &[Channels], evidence: &Evidence) -> bool {
    if !is_read_twice(fitted) {
        return true;
    }
    let Some(felt) = Weighted::by_first_reading(&fitted.rows, &fitted.weighted).test(columns) else {
        return true;
    };
    let count = felt.theta.len();
    let Some(factor) = felt.covariance.clone().cholesky() else { return true };
    let deviate = |of: DVector<f64>| normal_deviate(of.dot(&factor.solve(&of)), count);
    let own = DVector::from_column_slice(&felt.theta);
    let apart = DVector::from_column_slice(&evidence.theta) - &own;
    deviate(own) >= NOTHING || deviate(apart) < DEVIATE
}

/// Whether the forces alone show an effect, by all of its amounts together. Its first column in the model has the index `first`.
pub(super) fn shows_in_forces(fitted: &Fitted, term: &EffectTerm, first: usize) -> bool {
    let (coefficients, covariance) =
        Weighted::by_forces(&fitted.rows, &fitted.weighted).coefficients(&fitted.rows);
    let each = term.free.iter().enumerate().filter(|(_, slot)| term.is_amount(**slot));
    let amounts: Vec<(usize, f64)> = each
        .map(|(index, &slot)| (first + index, term.from_nothing(slot) + coefficients[first + index]))
        .filter(|&(at, _)| covariance[(at, at)] > 0.0)
        .collect();
    let count = amounts.len();
    let amount = DVector::from_iterator(count, amounts.iter().map(|(_, amount)| *amount));
    let own = DMatrix::from_fn(count, count, |i, j| covariance[(amounts[i].0, amounts[j].0)]);
    own.cholesky()
        .is_some_and(|factor| count > 0 && normal_deviate(amount.dot(&factor.solve(&amount)), count) > SHOWN)
}

/// Whether force is read by the accelerometer and by the autopilot's velocity.
fn is_read_twice(fitted: &Fitted) -> bool {
    let sigma = &fitted.weighted.sigma;
    let any = |of: &[f64]| of.iter().any(|sigma| *sigma > 0.0);
    any(&sigma[SECOND..]) && any(&sigma[..3])
}

/// A size by everything, and by the accelerometer and the torques alone, with their variances.
struct Amount {
    size: f64,
    variance: f64,
    felt: f64,
    felt_variance: f64,
}

impl Amount {
    fn is_nothing(&self) -> bool {
        self.felt.powi(2) < NOTHING.powi(2) * self.felt_variance
    }

    fn is_contradicted(&self) -> bool {
        self.felt_variance > self.variance && differ(self.size - self.felt, self.variance, self.felt_variance)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::base::Base;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::diagnose::signatures::signature_of;
    use crate::diagnose::trace::Trace;
    use crate::simulate::RandomTrajectory;

    /// Whether the forces of a flight with these effects concealed, of a drag of 0.04 1/s, show the wind of a model with drag, hub moment and
    /// wind.
    fn shows_wind(concealed: &[(&str, &[f64])]) -> bool {
        let (signals, vehicle) = flown(23, &RandomTrajectory::default(), |truth, weight_n| {
            let drag = 0.04 * weight_n;
            let all = [("linear_drag", &[drag, drag] as &[f64]), ("blade_flapping", &[0.02])];
            conceal(truth, all.iter().chain(concealed).copied());
        });
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let mut base = Base::anchored(&vehicle);
        base.effects = ["linear_drag", "blade_flapping", "steady_wind"]
            .map(|id| EffectTerm {
                free: (0..if id == "blade_flapping" { 1 } else { 2 }).collect(),
                ..signature_of(id).unwrap().whole_finer()
            })
            .to_vec();
        base.effects[0].values[..2].fill(0.3);
        let fitted = fit(&flights, base, Newton::Held).unwrap();
        let wind = &fitted.base.effects[2];
        shows_in_forces(&fitted, wind, fitted.rows.nuisances.len() + 3)
    }

    #[test]
    fn forces_show_a_wind_and_not_a_centre_of_mass_that_is_off() {
        assert!(shows_wind(&[("steady_wind", &[3.0, 2.0])]));
        assert!(!shows_wind(&[("com_offset", &[0.01, -0.01])]));
    }

    #[test]
    fn a_force_that_the_accelerometer_does_not_feel_is_contradicted() {
        let amount = |size, felt| Amount { size, variance: 0.01, felt, felt_variance: 0.04 };
        // 0.1 and 0.2 standard errors: the difference has 0.17
        assert!(amount(1.0, 0.1).is_nothing() && amount(1.0, 0.1).is_contradicted());
        assert!(!amount(1.0, 0.7).is_nothing() && !amount(1.0, 0.7).is_contradicted());
        assert!(amount(0.4, 0.1).is_nothing() && !amount(0.4, 0.1).is_contradicted());
    }
}
