//! A guessed torque per thrust, held against the motion.
//!
//! The motion about z tells only the ratio of izz to the rotors' torque, so with a torque that is guessed too large izz is too large as well.
//! No body has more of it than ixx + iyy, which the thrusts tell.

use super::nominal::Nominal;
use super::result::Estimated;
use super::weak::solve_weak;
use super::weak_flights::WeakFlights;
use crate::note::{About, Note};
use crate::signals::{Signals, WEAK_HALF_WIDTH_S};
use crate::text::significant;
use crate::vehicle::{Guessed, Vehicle};

/// izz over ixx + iyy of multirotors: 1 of a flat one, 0.8 to 0.96 of those with a body, less of tall ones.
const USUAL_SHARE: f64 = 0.85;
/// Its scatter, relative standard error: it becomes that of the torque per thrust.
const RELATIVE: f64 = 0.2;
/// Standard errors from which on the motion excludes a guess. The usual three.
const CERTAIN: f64 = 3.0;
/// Standard error of a logarithm of the ratio of izz to ixx + iyy above which the motion tells too little to correct a guess by it.
const LARGEST_STD: f64 = 0.1;

/// The vehicle with another torque per thrust, and a note on it, where that is guessed and no body could have the izz which the flights
/// show with it. `None` where it is no guess, or the flights do not exclude it.
#[must_use]
pub fn torque_by_motion(flights: &[Signals], vehicle: &Vehicle) -> Option<(Vehicle, Note)> {
    vehicle.guesses.iter().find(|guess| guess.of == Guessed::TorqueRatio)?;
    let nominal = Nominal::of(vehicle);
    let mut weak = WeakFlights::from(flights, vehicle, WEAK_HALF_WIDTH_S);
    weak.compensate(&nominal.theta, vehicle);
    let Estimated { theta, covariance, .. } = Estimated::of(&solve_weak(&weak.rows, &nominal.theta)?);
    let (across, about) = (theta[1] + theta[4], theta[6]);
    if !(across > 0.0 && about > 0.0) {
        return None;
    }
    let variance_across = covariance[(1, 1)] + covariance[(4, 4)] + 2.0 * covariance[(1, 4)];
    let std = (variance_across / across.powi(2) + covariance[(6, 6)] / about.powi(2)).sqrt();
    let share = about / across;
    // not below by a number that is none
    if !(std < LARGEST_STD && share.ln() > CERTAIN * std) {
        return None;
    }
    let mut corrected = vehicle.clone();
    corrected.propulsion.torque_per_thrust_m *= USUAL_SHARE / share;
    let why = "from the motion and the usual flatness of a multirotor";
    for guess in corrected.guesses.iter_mut().filter(|guess| guess.of == Guessed::TorqueRatio) {
        (guess.relative, guess.why) = (RELATIVE, why.to_owned());
    }
    let text = format!(
        "with the guessed torque per thrust of {} m, the inertia about z would be {} times what a body with this ixx and iyy can have: {} m +- \
         {:.0} % is taken, {why}",
        significant(vehicle.propulsion.torque_per_thrust_m, 3),
        significant(share, 2),
        significant(corrected.propulsion.torque_per_thrust_m, 3),
        100.0 * RELATIVE
    );
    Some((corrected, Note::remark(About::Vehicle, text)))
}
