//! Materiality: significant effects that are too small to matter are traces and get no name.
//!
//! In a long quiet flight everything becomes significant, also the slow errors of sensors, estimator and time stamps. Their size
//! is small: an accelerometer bias, or a level that is wrong by a third of a degree, is half a percent of the weight.

use super::channels::{CHANNELS, SECOND};
use super::fit::Fitted;
use super::signature::EffectTerm;
use nalgebra::DVector;
use std::ops::Range;

/// What matters where it also shows in the misfit: force as a share of the weight, torque as a share of the rms of the torque that the
/// motion needs.
const SHOWN: Size = Size { force: 0.005, torque: 0.04 };
/// What matters in however much noise.
const PLAIN: Size = Size { force: 0.01, torque: 0.2 };
/// Share of the misfit without the effect from which on it shows. With it true names of less than PLAIN stayed: see
/// below.
const SHOWS: f64 = 0.04;
/// Share of the misfit without the effect from which on it matters, however small it is: the misfit itself is as small then.
const MISFIT: f64 = 0.2;
// Chosen on 286 flights with an estimator in the loop (`bench blind --realistic`, 120 of them with nothing concealed) and in two autopilots'
// simulators. There false names of forces had up to 0.0056 of the weight and 0.09 of the misfit, those above 0.005 up to 0.03 of the
// misfit; false names of torques up to 0.17 of the torque with 0.02 of the misfit. True ones of less than PLAIN had 0.05 of the misfit and more.

/// Force without a name that matters, as a share of the weight: what nothing explains must be plain.
pub(super) const UNNAMED_FORCE: f64 = PLAIN.force;
/// The same of a force across the vertical: an attitude that is wrong by 0.6 degrees, as estimators' are, makes 0.01 of it. On 600 clean
/// flights with an estimator in the loop (`cargo bench --bench blind -- --realistic --clean 600 --seed 20310000`) trends of up to
/// 0.022 and forces of places of up to 0.02 were left. It holds of every force at a place or along a state: real thrust differs from its
/// command by 0.01 to 0.04 for some seconds.
pub(super) const UNNAMED_SIDEWAYS: f64 = 0.025;
/// Force that wanders by itself and follows neither place nor motion that matters, as a share of the weight. Real thrust wanders
/// about its command and real wind about its mean, together by up to 0.041: see `docs/src/figures-diagnosis.md`.
pub(super) const UNNAMED_WANDERING: f64 = 0.05;
/// The same of a force along body z that follows the commands, where these are too far apart to tell the torques or the thrust curve is a
/// guess: what the commands do between two samples is noise of the thrust, and follows it. Of 19 logs of real quadrotors at 10 to 25 Hz it
/// made up to 0.05, and 0.25 in one.
pub(super) const UNNAMED_OF_UNSURE_THRUST: f64 = 0.1;
/// Outdoors, the same of a horizontal force that belongs to a place: of 15 flights of one quadrotor the wind over 3 to 7 m of height made up
/// to 0.06, and that over 10 m along the ground as much. A wind that is 3 m/s stronger is 0.09 at a usual drag of 0.3 1/s.
pub(super) const UNNAMED_WIND: f64 = 0.1;
/// Outdoors, the same of a horizontal force that changes over the flight: a wind that rises by 5 m/s.
pub(super) const UNNAMED_CHANGE_OF_WIND: f64 = 0.15;
/// The same of a thrust that becomes less over the flight: a battery that empties, and motors that become warm, made 0.06 to 0.09 in
/// three of 20 logs of real quadrotors.
pub(super) const UNNAMED_LOSS_OF_THRUST: f64 = 0.1;
/// The same of a torque, as a share of the weight on a mean arm: real ones wander by up to 0.032.
pub(super) const WANDERING_ON_ARM: f64 = 0.04;
/// The same of a torque, also as a share of the rms of the torque that the motion needs: between two samples of telemetry the commands
/// move, and on flights of an autopilot's simulator 0.2 to 0.4 of it was left.
pub(super) const WANDERING_TORQUE: f64 = 0.5;
/// Torque without a name that matters, as a share of the rms of the torque that the motion needs.
pub(super) const UNNAMED_TORQUE: f64 = PLAIN.torque;

/// A force (share of the weight) and a torque (share of the rms of the torque that the motion needs).
struct Size {
    force: f64,
    torque: f64,
}

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
    /// Of effects together, each with the columns of its free values; `None` where they have no estimated amount, or no part of their
    /// own.
    pub(super) fn of(fitted: &Fitted, effects: &[(&EffectTerm, Range<usize>)]) -> Option<Self> {
        let all = &fitted.weighted;
        let gram = all.normal.as_ref()?.l_dirty().lower_triangle();
        let gram = &gram * gram.transpose();
        let mut coefficients = DVector::zeros(gram.nrows());
        for (term, columns) in effects {
            for (column, &slot) in columns.clone().zip(&term.free).filter(|(_, slot)| term.is_amount(**slot))
            {
                coefficients[column] = term.from_nothing(slot);
            }
        }
        let is_own = |index: &usize| effects.iter().any(|(_, columns)| columns.contains(index));
        let others: Vec<usize> = (0..gram.nrows()).filter(|index| !is_own(index)).collect();
        let normal = gram.select_rows(&others).select_columns(&others);
        let taken = normal.cholesky()?.solve(&(&gram * &coefficients).select_rows(&others));
        others.iter().zip(taken.iter()).for_each(|(&index, taken)| coefficients[index] = -taken);
        let own = all.nuisances.times(&coefficients);
        let own = Self::of_rms(&all.rms(own.as_slice()), fitted);
        (own.misfit > 0.0).then_some(own)
    }

    /// Of what has these root mean squares (N, N m) after the projection of all else: an effect, or one unit of a candidate.
    pub(super) fn of_rms(rms: &[f64; CHANNELS], fitted: &Fitted) -> Self {
        let all = &fitted.weighted;
        let force_n = (0..3).chain(SECOND..CHANNELS).map(|channel| rms[channel]).fold(0.0, f64::max);
        let of_torque = |axis: usize| rms[3 + axis] / fitted.rows.torque_rms[axis].max(f64::MIN_POSITIVE);
        let measured = (0..CHANNELS).filter(|&channel| all.sigma[channel] > 0.0);
        let energy: f64 = measured
            .map(|channel| all.count_of(channel) as f64 * (rms[channel] / all.sigma[channel]).powi(2))
            .sum();
        Self {
            force: force_n / fitted.weight_n(),
            torque: (0..3).map(of_torque).fold(0.0, f64::max),
            misfit: energy / (energy + all.left.norm_squared()),
        }
    }

    /// How many times as large it would have to be to matter.
    pub(super) fn times_to_matter(&self) -> f64 {
        // e t^2 / (rest + e t^2) = share, for the energy e of now
        let enough = |share: f64| {
            let (own, rest) = (self.misfit, (1.0 - self.misfit).max(0.0));
            (share / (1.0 - share) * rest / own.max(f64::MIN_POSITIVE)).sqrt()
        };
        let shown = (1.0 / self.over(&SHOWN)).max(enough(SHOWS));
        (1.0 / self.over(&PLAIN)).min(shown).min(enough(MISFIT))
    }

    /// Whether it is more than a trace.
    #[must_use]
    pub fn matters(&self) -> bool {
        self.is_more_than_noise() && self.shows() || self.over(&PLAIN) >= 1.0 || self.misfit >= MISFIT
    }

    /// Whether its force or torque is large enough to matter, whatever it is of the misfit.
    pub(super) fn is_more_than_noise(&self) -> bool {
        self.over(&SHOWN) >= 1.0
    }

    /// Whether it shows in the misfit.
    pub(super) fn shows(&self) -> bool {
        self.misfit >= SHOWS
    }

    /// The greater of force and torque, over a size.
    fn over(&self, size: &Size) -> f64 {
        (self.force / size.force).max(self.torque / size.torque).max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_smaller_shows_less_and_matters_less() {
        let of = |force: f64, torque: f64, misfit: f64| Materiality { force, torque, misfit }.matters();
        assert!(of(0.011, 0.0, 0.001) && of(0.0, 0.21, 0.001) && of(0.0001, 0.0, 0.25));
        assert!(of(0.006, 0.0, 0.05) && !of(0.006, 0.0, 0.03) && !of(0.004, 0.0, 0.1));
        let more = |force: f64| Materiality { force, torque: 0.0, misfit: 0.0 }.is_more_than_noise();
        assert!(more(0.006) && !more(0.004));
        assert!(of(0.0, 0.05, 0.05) && !of(0.0, 0.15, 0.03) && !of(0.0, 0.03, 0.1));
    }

    #[test]
    fn a_limit_is_the_size_from_which_on_it_matters() {
        let times = |of: &Materiality, by: f64| {
            let own = of.misfit / (1.0 - of.misfit) * by * by;
            Materiality { force: by * of.force, torque: by * of.torque, misfit: own / (1.0 + own) }
        };
        for (force, torque, misfit) in
            [(0.001, 0.0, 1e-4), (0.001, 0.0, 0.01), (0.001, 0.0, 0.15), (1e-5, 0.3, 1e-5), (0.2, 0.0, 0.001)]
        {
            let of = Materiality { force, torque, misfit };
            let limit = of.times_to_matter();
            assert!(times(&of, 1.001 * limit).matters() && !times(&of, 0.999 * limit).matters(), "{of:?}");
        }
    }
}
