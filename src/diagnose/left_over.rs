//! What the torque that a fit leaves over may do to its moments of inertia.
//!
//! Statistics of one flight take what is left over for noise that has nothing to do with the motion. A controller answers the motion,
//! and what the model lacks goes with it, so a part of what is left over goes with the angular acceleration and is taken for
//! inertia. With a correlation r of both, a moment is wrong by `r sqrt((1 - R2) / R2)` of itself, where R2 is the share of the
//! torque's variance that the inertia explains.

use super::channels::Nuisance;
use super::fit::Fitted;

/// Standard deviation of this correlation. Of 48 flights with an estimator in the loop (`cargo bench --bench blind -- --realistic
/// --write DIR --flights 48 --seed 91125001`) moments were wrong by .7 % rms at 1 - R2 = .002, 1.6 % at .007, 2.4 % at .027, 3.0 %
/// at .045 and 4.0 % at .11.
const CORRELATION: f64 = 0.12;

/// Places of Ixx, Iyy and Izz among the entries of the inertia.
const MOMENTS: [usize; 3] = [0, 3, 5];

/// Variance that this adds to the moments of inertia about body x, y, z, kg^2 m^4.
pub(super) fn of_left_over(fitted: &Fitted) -> [f64; 3] {
    let explained = fitted.explained_torques();
    std::array::from_fn(|axis| {
        let share = explained[axis].clamp(LEAST_EXPLAINED, 1.0);
        let moment = fitted.base.vehicle.body.inertia_kg_m2[(axis, axis)];
        (CORRELATION * moment).powi(2) * (1.0 - share) / share
    })
}

/// Least share that is reckoned with: below it, no inertia is stated anyway.
const LEAST_EXPLAINED: f64 = 0.1;

/// Adds it to the covariance of a fit by least squares.
pub(super) fn add_left_over(fitted: &mut Fitted) {
    let added = of_left_over(fitted);
    for (index, column) in fitted.rows.nuisances.iter().enumerate() {
        let Nuisance::Inertia(entry) = column.nuisance else { continue };
        let Some(axis) = MOMENTS.iter().position(|moment| *moment == entry) else { continue };
        // what no row bears on stays undetermined
        if fitted.covariance[(index, index)] > 0.0 {
            fitted.covariance[(index, index)] += added[axis];
        }
    }
}
