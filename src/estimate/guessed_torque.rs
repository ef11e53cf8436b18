//! The torque per thrust, guessed or stated, held against the motion.
//!
//! The motion about z tells only the ratio of izz to the rotors' torque, so with a torque that is too large izz is too large as well.
//! No body has more of it than ixx + iyy, which the thrusts tell.

use super::nominal::Nominal;
use super::result::{Estimated, Finding, finding};
use super::weak::{WeakEstimate, solve_weak};
use super::weak_flights::WeakFlights;
use crate::note::{About, Note};
use crate::regression::WeakRows;
use crate::signals::{Signals, WEAK_HALF_WIDTH_S};
use crate::vehicle::{Guess, Guessed, Vehicle};

/// izz over ixx + iyy of multirotors: 1 of a flat one, 0.8 to 0.96 of those with a body, less of tall ones.
const USUAL_SHARE: f64 = 0.85;
/// Its scatter, relative standard error: it becomes that of the torque per thrust.
const RELATIVE: f64 = 0.2;
/// Relative standard error that the sampling of commands adds to a ratio of moments: it moves each of them by some percent.
const OF_SAMPLING: f64 = 0.04;
/// Largest relative standard error of izz with which the motion tells anything of the torque.
const LARGEST_STD: f64 = 0.15;
/// Standard errors from which on the motion excludes a torque per thrust. The usual three.
const CERTAIN: f64 = 3.0;
/// Least share, beside these, at which it excludes one that is stated: stated arms are wrong by some percent. Set by judgement.
const STATED_SHARE: f64 = 1.1;

/// izz over ixx + iyy as the rigid body alone shows it with the stated torque per thrust (-), and the standard error of its logarithm. `None`
/// where the flights do not determine ixx, iyy, or leave izz open.
fn share_about_z(flights: &[Signals], vehicle: &Vehicle) -> Option<(f64, f64)> {
    let nominal = Nominal::without_guesses(vehicle);
    let mut weak = WeakFlights::from(flights, vehicle, WEAK_HALF_WIDTH_S);
    weak.compensate(&nominal.theta, vehicle);
    let found = solve_weak(&weak.rows, &nominal.theta)?;
    let by_wider_window = weak.by_wider_window(&found, &nominal.theta, WEAK_HALF_WIDTH_S);
    let estimated = Estimated::of(&found).with_wider_window(by_wider_window);
    let is_determined =
        |index: usize| matches!(finding(&estimated, &nominal, index), Finding::Determined { .. });
    let across_is_determined = is_determined(1) && is_determined(4);
    if !weak.frees_gyroscopic {
        weak.rows.iter_mut().for_each(WeakRows::free_gyroscopic_torque);
    }
    let WeakEstimate { theta, covariance, .. } = solve_weak(&weak.rows, &nominal.theta)?;
    let (across, about) = (theta[1] + theta[4], theta[6]);
    let relative_about = covariance[(6, 6)].max(0.0).sqrt() / about;
    tracing::debug!(
        share = about / across,
        relative_about,
        across_is_determined,
        "guessed torque against the motion"
    );
    // a torque that does not quite go with the thrust leaves much of itself unexplained, and its size is told all the same
    if !(across_is_determined && relative_about > 0.0 && relative_about < LARGEST_STD) {
        return None;
    }
    let variance = (covariance[(1, 1)] + covariance[(4, 4)] + 2.0 * covariance[(1, 4)]) / across.powi(2)
        + covariance[(6, 6)] / about.powi(2)
        - 2.0 * (covariance[(1, 6)] + covariance[(4, 6)]) / (across * about);
    Some((about / across, variance.max(0.0).sqrt()))
}

/// The vehicle with another torque per thrust, and a note on it, where no body could have the izz which the flights show with that of the
/// file. The note is a warning where that was stated, not guessed. `None` where the flights do not determine the moments, and where they do
/// not exclude it.
#[must_use]
pub fn torque_by_motion(flights: &[Signals], vehicle: &Vehicle) -> Option<(Vehicle, Note)> {
    let guess = vehicle.guessed(Guessed::TorqueRatio);
    let is_stated = guess <= 0.0;
    let (share, std) = share_about_z(flights, vehicle)?;
    let std = std.hypot(vehicle.guessed(Guessed::Arms)).hypot(OF_SAMPLING);
    let least = if is_stated { STATED_SHARE.ln() } else { 0.0 };
    let is_excluded = share.ln() > least.max(CERTAIN * std);
    if !is_excluded {
        return None;
    }
    // two opinions of the logarithm of its factor: the guess, and the motion with the usual flatness; what is stated and excluded is none
    let by_motion = (USUAL_SHARE / share).ln();
    let weight_of_guess = if is_stated { 0.0 } else { guess.powi(-2) };
    let weight = RELATIVE.hypot(std).powi(-2);
    let factor = (by_motion * weight / (weight + weight_of_guess)).exp();
    let left = (weight + weight_of_guess).sqrt().recip();
    let mut corrected = vehicle.clone();
    corrected.propulsion.torque_per_thrust_m *= factor;
    let (whose, why) = if is_stated {
        ("stated", "from the motion and the usual flatness of a multirotor")
    } else {
        ("guessed", "from the rotors' radius, the motion and the usual flatness of a multirotor")
    };
    corrected.guesses.retain(|guess| guess.of != Guessed::TorqueRatio);
    corrected.guesses.push(Guess { of: Guessed::TorqueRatio, relative: left, why: why.to_owned() });
    let text = format!(
        "with the {whose} torque per thrust of {:.4} m, the inertia about z would be {share:.1} times what a body with this ixx and iyy can \
         have: {:.4} m +- {:.0} % is taken, {why}",
        vehicle.propulsion.torque_per_thrust_m,
        corrected.propulsion.torque_per_thrust_m,
        100.0 * left
    );
    let note = if is_stated {
        let ask = "; is torque_ratio wrong in the vehicle file, or are the rotors' places?";
        Note::warning(About::Contradiction, text + ask)
    } else {
        Note::remark(About::Vehicle, text)
    };
    Some((corrected, note))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::physics::{ActiveEffect, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};
    use crate::signals::{ConditionSettings, condition};
    use crate::simulate::{
        FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
    };
    use nalgebra::Vector3;

    /// Takes the gyroscopic torque out.
    #[derive(Debug)]
    struct NoGyroscopicTorque;

    const fn moment(name: &'static str) -> Parameter {
        Parameter { name, unit: "kg m^2", bounds: Bounds::of(0.0, 1.0) }
    }

    const MOMENTS: &[Parameter] = &[moment("ixx"), moment("iyy"), moment("izz")];

    impl Effect for NoGyroscopicTorque {
        fn id(&self) -> &'static str {
            "no_gyroscopic_torque"
        }

        fn sentence(&self) -> &'static str {
            "The simulator has no gyroscopic torque."
        }

        fn equation(&self) -> &'static str {
            "`tau = w x J w`"
        }

        fn parameters(&self) -> &'static [Parameter] {
            MOMENTS
        }

        fn hooks(&self) -> &'static [Hook] {
            &[Hook::Wrench]
        }

        fn wrench(&self, at: &Condition, _: &Rotors, own: &mut Own, sum: &mut Wrench) {
            let rates_rad_s = at.state.rates_rad_s;
            let momentum = rates_rad_s.component_mul(&Vector3::from_column_slice(own.parameters));
            sum.torque_nm += rates_rad_s.cross(&momentum);
        }
    }

    /// What is made of a torque per thrust of `factor` times the true one, and the true one, m.
    fn corrected(truth: fn(&mut Truth), factor: f64, is_guess: bool) -> (Option<(Vehicle, Note)>, f64) {
        let pair = random_vehicle(31);
        let trajectory = RandomTrajectory::default().draw(3101).unwrap();
        let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
        let settings = FlightSettings { seed: 31, ..FlightSettings::default() };
        let mut flown = Truth::clean(pair.truth.clone());
        truth(&mut flown);
        let flight = simulate_flight(flown, &pair.nominal, &reference, &settings).unwrap();
        let mut vehicle = pair.nominal.clone();
        vehicle.propulsion.torque_per_thrust_m *= factor;
        let guess = Guess { of: Guessed::TorqueRatio, relative: 0.45, why: String::new() };
        vehicle.guesses = if is_guess { vec![guess] } else { Vec::new() };
        let signals = condition(&flight.recording, &vehicle, &ConditionSettings::default()).unwrap();
        (torque_by_motion(&[signals], &vehicle), pair.truth.propulsion.torque_per_thrust_m)
    }

    #[test]
    fn a_guess_that_no_body_allows_is_corrected_and_another_one_stays() {
        let (found, truth_m) = corrected(|_| (), 3.0, true);
        let (corrected_to, note) = found.unwrap();
        let ratio = corrected_to.propulsion.torque_per_thrust_m / truth_m;
        // the guess itself is another opinion
        assert!((0.7..1.8).contains(&ratio), "{ratio}");
        assert!((0.1..RELATIVE).contains(&corrected_to.guesses[0].relative), "{:?}", corrected_to.guesses);
        assert!(note.text.contains("the inertia about z would be"), "{}", note.text);
        assert_eq!(corrected(|_| (), 1.0, true).0, None);
        assert!(!note.is_warning());
    }

    #[test]
    fn a_stated_torque_that_no_body_allows_is_corrected_with_a_warning_and_a_possible_one_stays() {
        let (found, truth_m) = corrected(|_| (), 3.0, false);
        let (corrected_to, note) = found.unwrap();
        let ratio = corrected_to.propulsion.torque_per_thrust_m / truth_m;
        assert!((0.7..1.3).contains(&ratio), "{ratio}");
        assert!(corrected_to.guessed(Guessed::TorqueRatio) > 0.15);
        assert!(note.is_warning() && note.text.contains("is torque_ratio wrong"), "{}", note.text);
        for factor in [0.3, 1.0, 1.1] {
            assert_eq!(corrected(|_| (), factor, false).0, None, "{factor}");
        }
    }

    #[test]
    fn a_simulator_without_gyroscopic_torque_does_not_hide_a_guess_that_no_body_allows() {
        let without = |truth: &mut Truth| {
            let moments = truth.vehicle.body.inertia_kg_m2.diagonal();
            truth.effects.push(ActiveEffect::new(&NoGyroscopicTorque, moments.as_slice()).unwrap());
        };
        let (found, truth_m) = corrected(without, 3.0, true);
        let ratio = found.unwrap().0.propulsion.torque_per_thrust_m / truth_m;
        assert!((0.7..1.8).contains(&ratio), "{ratio}");
        assert_eq!(corrected(without, 1.0, true).0, None);
    }
}
