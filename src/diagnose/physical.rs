//! An inertia that a body can have, for every model that is written or simulated.

use super::base::{Base, turns_about_z};
use super::channels::Nuisance;
use super::fit::Fitted;
use super::trace::Trace;
use crate::estimate::{
    Finding, MOMENTS, Nominal, THETA, Theta, ThetaCovariance, finding, inertia_of, is_physical,
    nearest_physical, size_of, theta_of,
};
use crate::physics::PhysicsError;
use crate::vehicle::{Guessed, Vehicle};
use nalgebra::{SMatrix, SVector};
use std::ops::AddAssign;

/// Standard errors by which an inertia may be moved to the nearest one that a body can have. The usual three: beyond,
/// the nearest possible inertia contradicts the flight.
pub(super) const WITHIN_ERROR: f64 = 3.0;

/// Moments and products of inertia that the flights do not determine, as places in mass and inertia: by their errors, by a window of twice
/// the width (`by_wider_window`: Ixx, Iyy, Izz as shares), or because the rigid body explains too little of the torque. What the
/// description only guesses is no matter here: the motion tells ratios to it.
fn undetermined(fitted: &Fitted, stated: &Vehicle, by_wider_window: [f64; 3]) -> Vec<usize> {
    let (estimated, nominal) =
        (fitted.rigid_body().with_wider_window(by_wider_window), Nominal::without_guesses(stated));
    let is_open =
        |entry: &usize| matches!(finding(&estimated, &nominal, *entry), Finding::NotDetermined { .. });
    (1..THETA).filter(is_open).collect()
}

/// Moves an inertia that no body can have to the nearest possible one in the metric of its covariance, if that lies within its
/// error. Otherwise the flight does not determine it: the stated one stays, with an error as large as itself. A guessed torque per thrust
/// moves with izz.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub(super) fn make_physical(
    flights: &[Trace],
    (stated, by_wider_window): (&Vehicle, [f64; 3]),
    fitted: &mut Fitted,
) -> Result<(), PhysicsError> {
    let open = undetermined(fitted, stated, by_wider_window);
    let as_flown = theta_of(&fitted.base.vehicle.body);
    stay_at_prior(flights, (stated, &open), fitted)?;
    let theta = theta_of(&fitted.base.vehicle.body);
    if is_physical(&theta) {
        fitted.undetermined = open;
        return Ok(());
    }
    let nominal = theta_of(&stated.body);
    let moved = near(fitted, &theta, &Nominal::of(stated));
    let mut base = fitted.base.clone();
    base.vehicle.body.inertia_kg_m2 = inertia_of(&moved.unwrap_or(nominal));
    if moved.is_none() {
        let back = stated.propulsion.torque_per_thrust_m / base.vehicle.propulsion.torque_per_thrust_m;
        turn_with(&mut base, back);
    }
    if let Some(moved) = moved.filter(|_| guesses_torque(stated)) {
        // the motion tells the ratio of izz and of this torque
        turn_with(&mut base, moved[ABOUT_Z] / theta[ABOUT_Z]);
    }
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
    let beyond_bodies = moved.is_none().then(|| largest_over_others(&as_flown));
    *fitted = Fitted { undetermined: open, beyond_bodies, ..after };
    Ok(())
}

/// The place of the largest moment of inertia, and its ratio to the sum of the other two.
fn largest_over_others(theta: &Theta) -> (usize, f64) {
    let sum: f64 = MOMENTS.into_iter().map(|place| theta[place]).sum();
    let larger = |a: usize, b: usize| if theta[b] > theta[a] { b } else { a };
    let place = MOMENTS.into_iter().fold(MOMENTS[0], larger);
    (place, theta[place] / (sum - theta[place]))
}

/// Place of izz in mass and inertia.
const ABOUT_Z: usize = 6;

/// Another torque per thrust by a factor, with the sizes that the motion tells as ratios to it.
pub(super) fn turn_with(base: &mut Base, factor: f64) {
    base.vehicle.propulsion.torque_per_thrust_m *= factor;
    for term in &mut base.effects {
        for slot in 0..term.values.len() {
            if term.parameter(slot).is_some_and(|of| turns_about_z(of.name, of.unit)) {
                term.values[slot] *= factor;
            }
        }
    }
}

fn guesses_torque(vehicle: &Vehicle) -> bool {
    vehicle.guessed(Guessed::TorqueRatio) > 0.0
}

/// Where a part of the inertia is not determined (`open`, as places in mass and inertia), or no body can have the inertia, it stays at what
/// the vehicle file states as far as the flight tells nothing else: the mean of both, weighted by their information. Of what is open
/// the flight's error is as large as the moment itself, at least.
fn stay_at_prior(
    flights: &[Trace],
    (stated, open): (&Vehicle, &[usize]),
    fitted: &mut Fitted,
) -> Result<(), PhysicsError> {
    let Some(places) = inertia_places(fitted) else { return Ok(()) };
    let mut covariance: SMatrix<f64, ENTRIES, ENTRIES> =
        SMatrix::from_fn(|i, j| fitted.covariance[(places[i], places[j])]);
    let theta = theta_of(&fitted.base.vehicle.body);
    let nominal = Nominal::of(stated);
    let is_possible = is_physical(&theta);
    if is_possible && open.is_empty() {
        return Ok(());
    }
    for entry in 1..THETA {
        // what the description guesses is no knowledge of the flight's
        covariance[(entry - 1, entry - 1)] += (nominal.guessed(entry) * theta[entry]).powi(2);
    }
    for &entry in open {
        let size = size_of(&theta, &nominal, entry);
        covariance[(entry - 1, entry - 1)] += size.powi(2);
    }
    let largest = MOMENTS.into_iter().map(|entry| nominal.theta[entry]).fold(0.0, f64::max);
    // what the flight determines stays where it is, unless no body can have the whole
    let by_prior = SMatrix::from_diagonal(&SVector::<f64, ENTRIES>::from_fn(|entry, _| {
        let is_moment = MOMENTS.contains(&(1 + entry));
        let std = if is_moment { MOMENT_STD * nominal.theta[1 + entry] } else { PRODUCT_STD * largest };
        if is_possible && !open.contains(&(1 + entry)) { 0.0 } else { std.powi(-2) }
    }));
    let by_flight = covariance.cholesky().map(|root| root.inverse());
    let Some(posterior) = by_flight.and_then(|of| (of + by_prior).cholesky()).map(|root| root.inverse())
    else {
        return Ok(());
    };
    let from_prior = posterior * by_prior * (nominal.theta - theta).fixed_rows::<ENTRIES>(1);
    let moved_by = |share: f64| {
        let mut moved = theta;
        moved.fixed_rows_mut::<ENTRIES>(1).add_assign(share * from_prior);
        moved
    };
    // the mean of entries whose errors go together need not be an inertia that a body can have
    let shares = [1.0, 0.5, 0.25].into_iter();
    let kept = shares
        .map(moved_by)
        .find(is_physical)
        .unwrap_or_else(|| if is_physical(&theta) { theta } else { moved_by(1.0) });
    let mut base = fitted.base.clone();
    base.vehicle.body.inertia_kg_m2 = inertia_of(&kept);
    if guesses_torque(stated) && theta[ABOUT_Z] > 0.0 && kept[ABOUT_Z] > 0.0 {
        // the motion tells the ratio of izz and of this torque
        turn_with(&mut base, kept[ABOUT_Z] / theta[ABOUT_Z]);
    }
    // its standard error is still the flight's own: what it does not determine is said
    *fitted = fitted.moved_to(flights, base)?;
    Ok(())
}

/// Entries of an inertia: xx xy xz yy yz zz.
const ENTRIES: usize = THETA - 1;
/// Standard deviation (-) of a stated moment as a share of it. Moments by drawings and rules of thumb are wrong by 10 to 30 %.
pub const MOMENT_STD: f64 = 0.3;
/// Standard deviation of a stated product as a share of the largest moment: arms and batteries are placed about planes of symmetry.
const PRODUCT_STD: f64 = 0.05;

/// Columns of the inertia's entries; `None` where not all of them are estimated.
fn inertia_places(fitted: &Fitted) -> Option<[usize; ENTRIES]> {
    let mut places = [usize::MAX; ENTRIES];
    for (place, column) in fitted.rows.nuisances.iter().enumerate() {
        if let Nuisance::Inertia(entry) = column.nuisance {
            places[entry] = place;
        }
    }
    let known =
        |place: &usize| fitted.covariance.get((*place, *place)).is_some_and(|variance| *variance > 0.0);
    places.iter().all(known).then_some(places)
}

/// The covariance of an inertia with the errors of what the description guesses: a guessed torque per thrust holds izz no more firmly than
/// the guess is.
pub(super) fn with_guesses(
    covariance: &ThetaCovariance,
    theta: &Theta,
    nominal: &Nominal,
) -> ThetaCovariance {
    let mut whole = *covariance;
    for index in 1..THETA {
        whole[(index, index)] += (nominal.guessed(index) * theta[index]).powi(2);
    }
    whole
}

/// The nearest possible one, if it lies within the error, that of what the description guesses included.
fn near(fitted: &Fitted, theta: &Theta, nominal: &Nominal) -> Option<Theta> {
    let covariance = with_guesses(&fitted.rigid_body().covariance, theta, nominal);
    let nearest = nearest_physical(theta, &covariance, &nominal.theta)?;
    let by = nearest - theta;
    let wald = by.dot(&covariance.cholesky()?.solve(&by));
    // it is moved along what forbids it: one direction
    (wald <= WITHIN_ERROR.powi(2)).then_some(nearest)
}
