//! An inertia that a body can have, for every model that is written or simulated.

use super::channels::Nuisance;
use super::fit::Fitted;
use super::trace::Trace;
use crate::estimate::{Nominal, THETA, Theta, inertia_of, is_physical, nearest_physical, theta_of};
use crate::physics::PhysicsError;
use crate::vehicle::Vehicle;

/// Standard errors by which an inertia may be moved to the nearest one that a body can have. The usual three: beyond,
/// the nearest possible inertia contradicts the flight.
pub(super) const WITHIN_ERROR: f64 = 3.0;

/// Moves an inertia that no body can have to the nearest possible one in the metric of its covariance, if that lies within its
/// error. Otherwise the flight does not determine it: the stated one stays, with an error as large as itself.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub(super) fn make_physical(
    flights: &[Trace],
    stated: &Vehicle,
    fitted: &mut Fitted,
) -> Result<(), PhysicsError> {
    let theta = theta_of(&fitted.base.vehicle.body);
    if is_physical(&theta) {
        return Ok(());
    }
    let nominal = theta_of(&stated.body);
    let moved = near(fitted, &theta, &Nominal::of(stated));
    let mut base = fitted.base.clone();
    base.vehicle.body.inertia_kg_m2 = inertia_of(&moved.unwrap_or(nominal));
    let mut after = fitted.moved_to(flights, base)?;
    if moved.is_none() {
        for (place, column) in after.rows.nuisances.iter().enumerate() {
            let Nuisance::Inertia(entry) = column.nuisance else { continue };
            after.covariance.row_mut(place).fill(0.0);
            after.covariance.column_mut(place).fill(0.0);
            let moments = [nominal[1], nominal[4], nominal[6]];
            let largest = moments.into_iter().fold(0.0, f64::max);
            let is_moment = matches!(entry, 0 | 3 | 5);
            let size = if is_moment { nominal[1 + entry].abs().max(0.1 * largest) } else { largest };
            after.covariance[(place, place)] = size.powi(2);
        }
    }
    *fitted = after;
    Ok(())
}

/// The nearest possible one, if it lies within the error, that of what the description guesses included.
fn near(fitted: &Fitted, theta: &Theta, nominal: &Nominal) -> Option<Theta> {
    let mut covariance = fitted.rigid_body().covariance;
    for index in 1..THETA {
        covariance[(index, index)] += (nominal.guessed(index) * theta[index]).powi(2);
    }
    let nearest = nearest_physical(theta, &covariance, &nominal.theta)?;
    let by = nearest - theta;
    let wald = by.dot(&covariance.cholesky()?.solve(&by));
    // it is moved along what forbids it: one direction
    (wald <= WITHIN_ERROR.powi(2)).then_some(nearest)
}
