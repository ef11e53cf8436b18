//! Checks of implausible results: another vehicle, a wrong unit, two vehicles at once.

use super::result::{Estimated, Finding, MethodResult};
use super::theta::{NAMES, UNITS, theta_of};
use super::thrust_scale::ThrustScale;
use crate::note::{About, Note};
use crate::vehicle::{Guessed, Vehicle};

/// Largest ratio of an identified mass or thrust to that of the vehicle file, or its inverse, without a warning.
/// Nominal files are often 20 to 30 % off, and a battery adds to it; only a warning depends on it.
const SCALE_FACTOR: f64 = 1.5;
/// The same for a moment of inertia. A stated inertia is often a guess by mass and size; only a warning depends on
/// it.
const INERTIA_FACTOR: f64 = 1.75;
/// Standard errors, of the estimate and of a guess in the file, that do not count. The usual 95 %.
const WITHIN: f64 = 2.0;
/// Standard errors of the difference within which two flights of one vehicle agree: 4.0 at most in 17 pairs of simulated
/// flights with what was concealed in both.
const FLIGHTS_SIGMA: f64 = 6.0;
/// Relative difference within which their masses agree. Sampling and filters differ between logs; only a warning
/// depends on it.
const FLIGHTS_SHARE: f64 = 0.02;
/// The same of their moments of inertia. Sampling and filters differ between logs; only a warning depends on it.
const FLIGHTS_INERTIA_SHARE: f64 = 0.03;

/// A quantity that is far from what the vehicle file states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contradiction {
    /// as in files
    pub name: &'static str,
    /// estimate over stated value
    pub factor: f64,
    /// the stated value is that of a rule of thumb
    pub guessed: bool,
}

impl Contradiction {
    /// An estimate with its standard error against a stated value, which may be a guess with a relative standard error;
    /// `None` where they agree within a factor.
    #[must_use]
    pub fn of(name: &'static str, (value, std): (f64, f64), (stated, guess): (f64, f64)) -> Option<Self> {
        let factor = value / stated;
        let most = if name.starts_with('i') { INERTIA_FACTOR } else { SCALE_FACTOR };
        let apart = factor.ln().abs() - WITHIN * std / value.abs();
        (apart > most.ln().max(WITHIN * guess)).then_some(Self { name, factor, guessed: guess > 0.0 })
    }

    /// A note on it.
    #[must_use]
    pub fn note(&self) -> Note {
        let Self { name, factor, guessed } = self;
        let of_torque = format!(
            "is the rotors' torque per thrust (torque_ratio) {:.2} times what is stated, or not proportional to their thrust? The \
             motion about z tells only the ratio of torque and izz",
            factor.recip()
        );
        let along = if *name == NAMES[1] { "y" } else { "x" };
        let of_arms = format!(
            "is a coefficient of the rotors wrong, or are their arms along {along} {:.2} times what is stated? The motion tells only the \
             ratio of torque and {name}",
            factor.recip()
        );
        let ask = if *name == NAMES[0] {
            "are thrust and torque coefficients wrong by this factor? A weighed mass with anchor = \"mass\" sets the scale"
        } else if self.is_about_z() {
            &of_torque
        } else {
            &of_arms
        };
        let stated =
            if *guessed { "the rule of thumb says of this mass and size" } else { "the vehicle file states" };
        let text = format!(
            "{name} is {factor:.2} times what {stated}: is it another vehicle's log, is a unit wrong, or {ask}"
        );
        Note::warning(About::Estimate, text)
    }
}

impl Contradiction {
    /// Whether it is of the moment of inertia about z, which is only known with the rotors' torque.
    fn is_about_z(&self) -> bool {
        self.name == ABOUT_Z
    }
}

/// The moment that goes with the rotors' torque.
const ABOUT_Z: &str = NAMES[6];

/// Several of them in one clause.
#[must_use]
pub fn contradicts_file(all: &[Contradiction]) -> Option<String> {
    let one = |of: &Contradiction| {
        let Contradiction { name, factor, .. } = of;
        let places = if *factor < 0.1 { 3 } else { 2 };
        let or = if of.is_about_z() {
            format!(" (or the rotors' torque per thrust by {:.2})", factor.recip())
        } else {
            String::new()
        };
        format!("{name} by a factor of {factor:.places$}{or}")
    };
    let clause = |guessed: bool, begins: &str| {
        let those: Vec<String> = all.iter().filter(|of| of.guessed == guessed).map(one).collect();
        (!those.is_empty()).then(|| format!("{begins}, {}", those.join(", ")))
    };
    let of_file = clause(false, "it contradicts the vehicle file");
    let of_thumb = clause(true, "it is far from the rule of thumb for this mass and size");
    let clauses: Vec<String> = of_file.into_iter().chain(of_thumb).collect();
    (!clauses.is_empty()).then(|| clauses.join(", and "))
}

/// The stated mass (index 0) or moment of inertia (1, 4, 6) with the relative error of a guess.
#[must_use]
pub fn stated(vehicle: &Vehicle, index: usize) -> (f64, f64) {
    let of = if index == 0 { Guessed::ThrustMax } else { Guessed::Inertia };
    (theta_of(&vehicle.body)[index], vehicle.guessed(of))
}

/// Estimates that are far from what the vehicle file states: mass, thrust and moments of inertia.
#[must_use]
pub fn contradictions(
    result: &MethodResult,
    vehicle: &Vehicle,
    scale: Option<&ThrustScale>,
) -> Vec<Contradiction> {
    let of_thrust = scale.and_then(|scale| match scale.factor {
        Finding::Determined { value, std } => {
            Contradiction::of(scale.name, (value, std), (1.0, vehicle.guessed(Guessed::ThrustMax)))
        }
        _ => None,
    });
    let of_body = [0, 1, 4, 6].into_iter().filter_map(|index| {
        let Finding::Determined { value, std } = result.parameters[index].finding else { return None };
        Contradiction::of(NAMES[index], (value, std), stated(vehicle, index))
    });
    of_thrust.into_iter().chain(of_body).collect()
}

/// A flight whose mass or moments of inertia are further from those of the first flight than flights of one vehicle are, by its
/// estimate alone.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightApart {
    /// its place among the flights
    pub flight: usize,
    /// the parameter that is furthest apart, in words
    found: String,
    /// mass over that of the first flight
    mass_factor: f64,
    /// a moment of inertia is apart, and not by the factor of the mass as where the thrust differs
    by_moments: bool,
    /// izz alone is apart
    about_z_alone: bool,
}

impl FlightApart {
    /// In words, as by the rigid body alone.
    #[must_use]
    pub fn told(&self) -> String {
        format!("{}: two vehicles or two loads? The common estimate describes neither", self.found)
    }

    /// Whether izz alone is apart: it goes with the law of the rotors' torque, and a flight that hardly turns tells little of it.
    #[must_use]
    pub fn is_about_z_alone(&self) -> bool {
        self.about_z_alone
    }

    /// Whether moments of inertia alone are apart, and the masses are not by more than a payload and a battery explain.
    #[must_use]
    pub fn is_by_moments(&self) -> bool {
        self.by_moments && self.mass_factor.ln().abs() <= SCALE_FACTOR.ln()
    }

    /// Whether the flight is of another vehicle: its mass is apart by more than a payload and a battery explain, or its moments of
    /// inertia are, and no effect that was found alters the thrust (`thrust_differs`).
    #[must_use]
    pub fn is_other_vehicle(&self, thrust_differs: bool) -> bool {
        self.mass_factor.ln().abs() > SCALE_FACTOR.ln() || (self.by_moments && !thrust_differs)
    }

    /// A note on it, for estimates that contain effects.
    #[must_use]
    pub fn note(&self, thrust_differs: bool) -> Note {
        let text = if self.is_other_vehicle(thrust_differs) {
            self.told()
        } else {
            format!(
                "{}: a load, the battery, wind or a rotor may have differed between the flights",
                self.found
            )
        };
        Note::warning(About::Estimate, text)
    }
}

/// The flights whose estimates alone are further from the first one's than those of one vehicle are. A moment of inertia counts only where
/// the rigid body explains the torque in both flights at all frequencies.
#[must_use]
pub fn flights_apart(flights: &[Option<Estimated>]) -> Vec<FlightApart> {
    let Some(of_first) = flights.first().and_then(Option::as_ref) else { return Vec::new() };
    let first = &of_first.theta;
    let far = |flight: &Estimated, index: usize| {
        let tells = |of: &Estimated| of.explains(index) && of.is_of_all_bands(index);
        if !(tells(of_first) && tells(flight)) {
            return None;
        }
        let theta = &flight.theta;
        let variance = of_first.covariance[(index, index)] + flight.covariance[(index, index)];
        let sigma = (theta[index] - first[index]).abs() / variance.sqrt();
        let is_far = sigma > FLIGHTS_SIGMA && (theta[index] / first[index] - 1.0).abs() > share(index);
        (is_far && sigma.is_finite() && first[index] > 0.0).then_some((index, sigma))
    };
    let told = |(number, flight): (usize, &Option<Estimated>)| {
        let flight = flight.as_ref()?;
        let theta = &flight.theta;
        let all: Vec<(usize, f64)> =
            [0, 1, 4, 6].into_iter().filter_map(|index| far(flight, index)).collect();
        let (index, sigma) = *all.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let name = if index == 0 { "a mass".to_owned() } else { format!("an {}", NAMES[index]) };
        let unit = UNITS[index];
        let mass_factor = theta[0] / first[0];
        let unlike_mass =
            |index: usize| (theta[index] / first[index] / mass_factor - 1.0).abs() > share(index);
        Some(FlightApart {
            flight: number,
            found: format!(
                "flight {} alone gives {name} of {:.4} {unit}, flight 1 {:.4} {unit}, {sigma:.0} standard errors apart",
                number + 1,
                theta[index],
                first[index]
            ),
            mass_factor,
            by_moments: all.iter().any(|(index, _)| *index > 0 && unlike_mass(*index)),
            about_z_alone: all.iter().all(|(index, _)| NAMES[*index] == ABOUT_Z),
        })
    };
    flights.iter().enumerate().skip(1).filter_map(told).collect()
}

/// Relative difference within which a parameter of two flights agrees.
fn share(index: usize) -> f64 {
    if index == 0 { FLIGHTS_SHARE } else { FLIGHTS_INERTIA_SHARE }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn a_moment_about_z_is_told_with_the_torque_that_it_rests_on() {
        let of = |name| Contradiction::of(name, (0.010, 0.0001), (0.020, 0.0)).unwrap();
        let said = contradicts_file(&[of("izz")]).unwrap();
        assert_eq!(
            said,
            "it contradicts the vehicle file, izz by a factor of 0.50 (or the rotors' torque per thrust by 2.00)"
        );
        let note = of("izz").note().text;
        assert!(note.contains("torque_ratio) 2.00 times what is stated"), "{note}");
        assert_eq!(
            contradicts_file(&[of("ixx")]).unwrap(),
            "it contradicts the vehicle file, ixx by a factor of 0.50"
        );
        let note = of("ixx").note().text;
        assert!(
            note.contains("a coefficient of the rotors") && note.contains("arms along y 2.00 times"),
            "{note}"
        );
    }
}
