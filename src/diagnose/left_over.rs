//! Error that the residual torque causes in parameters that only torques determine.
//!
//! Statistics of one flight take what is left over for noise that has nothing to do with the motion. A controller answers the motion,
//! and what the model lacks goes with it, so a part of what is left over goes with the angular acceleration and is taken for
//! inertia. With a correlation r of what is left over and a parameter's column, the parameter is wrong by r times the ratio of
//! their norms. Of a moment of inertia that is about `r sqrt((1 - R2) / R2)` of itself, where R2 is the share of the torque's variance
//! that the inertia explains.

use super::channels::{AXES, Nuisance};
use super::evidence::{Evidence, Weighted};
use super::fit::Fitted;
use super::recorded::Need;

/// Standard deviation of this correlation. Of 48 flights with an estimator in the loop (`cargo bench --bench blind -- --realistic
/// --write DIR --flights 48 --seed 91125001`) moments were wrong by 0.7 % rms at 1 - R2 = 0.002, 1.6 % at 0.007, 2.4 % at 0.027,
/// 3.0 % at 0.045 and 4.0 % at 0.11.
const CORRELATION: f64 = 0.12;

/// Variance that this adds to a coefficient of a fit, in its unit squared.
pub(super) fn of_left_over(weighted: &Weighted, place: usize) -> f64 {
    // weighted, what is left over has the norm of the number of rows
    let rows = weighted.count_of(AXES - 1) as f64;
    weighted.own(place).map_or(0.0, |own| CORRELATION.powi(2) * rows / own)
}

/// Standard deviation that it adds to one of the coefficients of tested columns, in its unit.
pub(super) fn of_tested(weighted: &Weighted, evidence: &Evidence, index: usize) -> f64 {
    let squares = |channel: usize| {
        let rms = evidence.unit_rms[index][channel] / weighted.sigma[channel];
        weighted.count_of(channel) as f64 * rms.powi(2)
    };
    let own: f64 = (0..AXES).filter(|&channel| weighted.sigma[channel] > 0.0).map(squares).sum();
    if own > 0.0 { CORRELATION * (weighted.count_of(AXES - 1) as f64 / own).sqrt() } else { 0.0 }
}

/// Places among the coefficients of a fit of what only torques tell: the inertia, and the amounts of effects that need torques.
pub(super) fn of_torques(fitted: &Fitted) -> Vec<usize> {
    let of_nuisances = fitted.rows.nuisances.iter();
    let mut places: Vec<usize> = of_nuisances
        .enumerate()
        .filter(|(_, column)| matches!(column.nuisance, Nuisance::Inertia(_)))
        .map(|(place, _)| place)
        .collect();
    let mut place = fitted.rows.nuisances.len();
    for term in &fitted.base.effects {
        for slot in &term.free {
            places.extend(
                (term.signature.needs.contains(&Need::Torques) && term.is_amount(*slot)).then_some(place),
            );
            place += 1;
        }
    }
    // what no row bears on stays undetermined
    places.retain(|&place| fitted.covariance[(place, place)] > 0.0);
    places
}

/// Adds it to the covariance of a fit: to what only torques tell, except where `by_instruments` has told it.
pub(super) fn add_left_over(fitted: &mut Fitted, by_instruments: &[usize]) {
    for place in of_torques(fitted).into_iter().filter(|place| !by_instruments.contains(place)) {
        fitted.covariance[(place, place)] += of_left_over(&fitted.weighted, place);
    }
}
