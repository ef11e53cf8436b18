//! Whether what is certain also matters: small certain things are traces and get no name.
//!
//! A long quiet flight makes everything certain, also what slow errors of the sensors, of the estimator and of the log's stamps
//! imitate. What those imitate is small: an accelerometer's bias and a level that is off by a third of a degree are half a percent
//! of the weight.

use super::channels::{CHANNELS, SECOND};
use super::evidence::Evidence;
use super::fit::Fitted;
use super::signature::EffectTerm;
use nalgebra::DVector;
use std::ops::Range;

/// Force that matters, as a share of the weight. Names that were false on flights with an estimator in the loop had up to 0.0045,
/// true ones 0.0055 and more unless they passed one of the other two: 166 flights of `bench blind --realistic` and of two autopilots'
/// simulators.
const FORCE: f64 = 0.005;
/// Torque that matters, as a share of the rms of the torque that the motion needs. On the same flights false names had up to 0.06,
/// true ones of torques 0.116 and more.
const TORQUE: f64 = 0.1;
/// Times these sizes from which on it matters in however much noise.
const PLAIN: f64 = 2.0;
/// Force without a name that matters, as a share of the weight: what nothing explains must be plain.
pub(super) const UNNAMED_FORCE: f64 = PLAIN * FORCE;
/// Torque without a name that matters, as a share of the rms of the torque that the motion needs.
pub(super) const UNNAMED_TORQUE: f64 = PLAIN * TORQUE;
/// Share of the misfit without the effect that what is smaller than this must have: on 120 flights with nothing concealed, false names
/// of just those sizes had up to 0.03, on the flights above true ones 0.05.
const SHOWS: f64 = 0.04;
/// Share of the misfit without the effect from which on it matters, however small it is: the misfit itself is as small then. On the
/// same flights false names had up to 0.1.
const MISFIT: f64 = 0.2;

/// The part of an effect that no other column of the model can take over, root mean square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Materiality {
    /// greatest along an axis, as a share of the weight
    pub force: f64,
    /// greatest about an axis, as a share of the rms of the torque that the motion needs
    pub torque: f64,
    /// share of the misfit's energy without it, 0..1
    pub misfit: f64,
}

impl Materiality {
    /// Of the effect whose free values have these columns; `None` where it has no estimated amount, or no part of its own.
    pub(super) fn of(fitted: &Fitted, term: &EffectTerm, columns: Range<usize>) -> Option<Self> {
        let all = &fitted.weighted;
        let gram = all.normal.as_ref()?.l_dirty().lower_triangle();
        let gram = &gram * gram.transpose();
        let mut coefficients = DVector::zeros(gram.nrows());
        for (column, &slot) in columns.clone().zip(&term.free).filter(|(_, slot)| term.is_amount(**slot)) {
            coefficients[column] = term.from_nothing(slot);
        }
        let others: Vec<usize> = (0..gram.nrows()).filter(|index| !columns.contains(index)).collect();
        let normal = gram.select_rows(&others).select_columns(&others);
        let taken = normal.cholesky()?.solve(&(&gram * &coefficients).select_rows(&others));
        others.iter().zip(taken.iter()).for_each(|(&index, taken)| coefficients[index] = -taken);
        let own = all.nuisances.times(&coefficients);
        let energy = own.norm_squared();
        if energy.is_nan() || energy <= 0.0 {
            return None;
        }
        let weight_n = fitted.base.vehicle.body.mass_kg * fitted.base.vehicle.gravity_m_s2;
        let rms = |channel: usize| {
            let squares = own.rows(channel * all.rows, all.rows).norm_squared();
            (squares / all.count_of(channel).max(1) as f64).sqrt() * all.sigma[channel]
        };
        let greatest = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, f64::max);
        let of_torque = |axis: usize| rms(3 + axis) / fitted.rows.torque_rms[axis].max(f64::MIN_POSITIVE);
        Some(Self {
            force: greatest(&mut (0..3).chain(SECOND..CHANNELS).map(rms)) / weight_n,
            torque: greatest(&mut (0..3).map(of_torque)),
            misfit: energy / (energy + all.left.norm_squared()),
        })
    }

    /// Of a candidate beside a fit, by its test there.
    pub(super) fn of_candidate(evidence: &Evidence, fitted: &Fitted) -> Self {
        let weight_n = fitted.base.vehicle.body.mass_kg * fitted.base.vehicle.gravity_m_s2;
        let force = (0..3).chain(SECOND..CHANNELS).map(|channel| evidence.rms[channel]).fold(0.0, f64::max);
        let of_torque =
            |axis: usize| evidence.rms[3 + axis] / fitted.rows.torque_rms[axis].max(f64::MIN_POSITIVE);
        Self {
            force: force / weight_n,
            torque: (0..3).map(of_torque).fold(0.0, f64::max),
            misfit: evidence.energy / fitted.weighted.energy.max(f64::MIN_POSITIVE),
        }
    }

    /// How many times as large it would have to be to matter: at least by its force or its torque, or by its share of the misfit.
    pub(super) fn times_to_matter(&self) -> f64 {
        let by_size = 1.0 / self.size().max(f64::MIN_POSITIVE);
        // e s^2 / (rest + e s^2) = share, for the energy e of now
        let enough = |share: f64| {
            let (own, rest) = (self.misfit, (1.0 - self.misfit).max(0.0));
            (share / (1.0 - share) * rest / own.max(f64::MIN_POSITIVE)).sqrt()
        };
        (PLAIN * by_size).min(by_size.max(enough(SHOWS))).min(enough(MISFIT))
    }

    /// The greater of force and torque, over what matters.
    fn size(&self) -> f64 {
        (self.force / FORCE).max(self.torque / TORQUE)
    }

    /// Whether it is more than a trace.
    #[must_use]
    pub fn matters(&self) -> bool {
        let size = self.size();
        size >= PLAIN || size >= 1.0 && self.misfit >= SHOWS || self.misfit >= MISFIT
    }
}
