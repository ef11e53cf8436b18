//! The influence of a guessed thrust curve on an estimate.
//!
//! A flight compares torque and acceleration. If thrust comes from commands, torque is the slope of the thrust curve times the
//! difference of the commands. Another curve gives another inertia from the same flight, and no residual shows it.

use super::compensate::take_out;
use super::result::{CURVE_IS_A_GUESS, Estimated, percent};
use super::theta::{NAMES, Theta};
use super::weak::solve_weak;
use crate::note::{About, Note};
use crate::physics::ActuationLatency;
use crate::regression::{WeakMotion, WeakRows, weak_rows};
use crate::signals::{Signals, ThrustSource, WEAK_HALF_WIDTH_S, WeakKernel};
use crate::vehicle::{Guessed, Propulsion, ThrustLaw, Vehicle};
use std::sync::Arc;

/// A thrust curve whose exponent was guessed, at both ends of its standard error (no further than linear and quadratic).
#[derive(Debug, Clone, PartialEq)]
pub struct GuessedCurve {
    ends: [Propulsion; 2],
    /// standard error of the exponent over the distance of both ends
    share: f64,
}

impl GuessedCurve {
    /// Of a vehicle; `None` where its curve is not a guess.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Option<Self> {
        let ThrustLaw::Curve { thrust_max_n, expo } = vehicle.propulsion.law else { return None };
        let std = vehicle.guessed(Guessed::Expo);
        let (low, high) = ((expo - std).max(expo.min(0.0)), (expo + std).min(expo.max(1.0)));
        let of = |expo| Propulsion { law: ThrustLaw::Curve { thrust_max_n, expo }, ..vehicle.propulsion };
        (high > low).then(|| Self { ends: [of(low), of(high)], share: std / (high - low) })
    }

    /// A flight of this vehicle as its commands would be read with the curve at either end; the flight itself where its thrust
    /// does not come from commands.
    #[must_use]
    pub fn bent(&self, signals: &Signals, vehicle: &Vehicle) -> [Signals; 2] {
        [0, 1].map(|end| by_curve(signals, vehicle, &self.ends[end]))
    }

    /// How far estimates move with one standard error of the curve, by those at its ends.
    #[must_use]
    pub fn moved(&self, [low, high]: [&Theta; 2]) -> MovedByCurve {
        let by = (high - low).map(|moved| if moved.is_finite() { self.share * moved } else { 0.0 });
        MovedByCurve { by, about_kg: f64::midpoint(low[0], high[0]) }
    }
}

/// How far mass and inertia move with one standard error of a guessed thrust curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovedByCurve {
    by: Theta,
    /// mass on the same scale, kg; NaN where there is none
    about_kg: f64,
}

impl MovedByCurve {
    /// On the scale of an estimate of the same flights.
    #[must_use]
    pub fn on(&self, theta: &Theta) -> Theta {
        let factor = theta[0] / self.about_kg;
        if factor.is_finite() { self.by * factor } else { self.by }
    }
}

/// Share of a moment of inertia by which a guessed curve has to move it to be told. Only whether it is told depends
/// on it; the standard errors contain it in any case.
const TOLD: f64 = 0.05;

/// A note on moments of inertia that rest on a guessed thrust curve.
#[must_use]
pub fn rests_on_guessed_curve(estimated: &Estimated) -> Option<Note> {
    let share = |index: usize| estimated.moved_by_curve(index) / estimated.theta[index].abs();
    let moved = |index: &usize| share(*index) > TOLD;
    let those: Vec<String> = [1, 4, 6]
        .into_iter()
        .filter(moved)
        .map(|index| format!("{} by {}", NAMES[index], percent(share(index))))
        .collect();
    let text = format!(
        "{CURVE_IS_A_GUESS}, and one standard error of it moves {}: that is in the standard errors. `identify --with {}` has the \
         flight tell the curve; where it is known, state it in a vehicle file",
        those.join(", "),
        Guessed::Expo.name()
    );
    (!those.is_empty()).then(|| Note::remark(About::Estimate, text))
}

fn by_curve(signals: &Signals, vehicle: &Vehicle, other: &Propulsion) -> Signals {
    let mut bent = signals.clone();
    if signals.quality.thrust_source != ThrustSource::Command || signals.rotor_thrust_n.is_empty() {
        return bent;
    }
    let (mixer, rotors) = (vehicle.mixer(), vehicle.rotors.len());
    let factor = signals.thrust_factor(&vehicle.propulsion);
    let read = |thrust_n: &f64| {
        let command = vehicle.propulsion.command_from_thrust(factor * thrust_n);
        other.thrust_from_command_n(command) / factor
    };
    let thrusts: Vec<f64> = signals.rotor_thrust_n.iter().map(read).collect();
    let pairs = thrusts.chunks_exact(rotors).zip(signals.rotor_thrust_n.chunks_exact(rotors));
    for (wrench, (new, old)) in Arc::make_mut(&mut bent.wrench).iter_mut().zip(pairs) {
        *wrench += mixer.wrench(new) - mixer.wrench(old);
    }
    bent.rotor_thrust_n = Arc::new(thrusts);
    bent
}

/// How far mass and inertia move with one standard error of a guessed thrust curve, with this latency taken out; `None` where
/// the curve is no guess, or nothing can be estimated.
pub(super) fn moved_by_curve(
    flights: &[Signals],
    vehicle: &Vehicle,
    latency: ActuationLatency,
    nominal: &Theta,
) -> Option<MovedByCurve> {
    let curve = GuessedCurve::of(vehicle)?;
    if flights.iter().all(|signals| signals.quality.thrust_source != ThrustSource::Command) {
        return None;
    }
    let half_width_s = WEAK_HALF_WIDTH_S;
    let rows_of = |mut signals: Signals| {
        if latency.total_s() != 0.0 {
            take_out(&mut signals, vehicle, latency);
        }
        let kernel = WeakKernel::new(half_width_s, signals.grid.step_s);
        let motion = WeakMotion::measured(&signals, &kernel, vehicle.gravity_m_s2);
        weak_rows(&signals, &motion, &kernel)
    };
    let (mut low, mut high): (Vec<WeakRows>, Vec<WeakRows>) = (Vec::new(), Vec::new());
    for signals in flights {
        let [at_low, at_high] = curve.bent(signals, vehicle);
        low.push(rows_of(at_low));
        high.push(rows_of(at_high));
    }
    let theta = |rows: &[WeakRows]| Some(solve_weak(rows, nominal)?.theta);
    Some(curve.moved([&theta(&low)?, &theta(&high)?]))
}
