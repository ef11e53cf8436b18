//! What flights cannot tell by the way they were flown. It is said before anything else.

use crate::diagnose::holdout::flown_period_s;
use crate::note::{About, Note};
use crate::signals::{Quality, Signals, Usable};
use crate::stats::quantile;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Part of a flight that is slower, and turned less, than a hover is at most. Set by judgement.
const MOST: (usize, usize) = (9, 10);
/// Speed of a hover over the root of the arm, m/s per root of a metre: 0.3 m/s with an arm of 0.25 m. Lengths and speeds of
/// vehicles of different sizes go so together (Froude). Set by judgement: hovers of simulated and recorded flights stay below 0.15 m/s,
/// and flights along a trajectory exceed 0.4 m/s.
const HOVER_SPEED: f64 = 0.6;
/// Angle (rad) between the mean direction of a body axis and that at an instant, in a hover: what a trajectory needs is 5 to 30 degrees.
/// Set by judgement.
const HOVER_ANGLE: f64 = 0.08;
/// Share of the speed that nineteen twentieths of a flight are below from which on it moves: a climb, a hover before and after do not.
const MOVES: f64 = 0.1;
/// Body rate (rad/s) that half of a flight exceeds which turns all the time. Set by judgement: a usual trajectory stays below.
const TURNS_RAD_S: f64 = 1.0;
/// The middle of a flight's values.
const TYPICAL: (usize, usize) = (1, 2);
/// Shortest period of a trajectory for identification, s.
const PERIOD_S: f64 = 8.0;
/// Shortest period of a trajectory for identification that repeats, s: the demo's. A shorter one found is that of a harmonic.
const SHORTEST_S: f64 = 6.0;
/// Fewest periods: what is seen once is not told from what happened once.
const PERIODS: f64 = 2.0;
/// Share of the flight that may be saturated.
const SATURATED: f64 = 0.3;

/// Why a flight tells little, by the way it was flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightLimit {
    /// it hovers
    Hover,
    /// no effect that shows only in motion could have been seen
    LittleMotion,
    /// no velocity, or no attitude, is recorded, and so no such effect could have been seen
    NoVelocity,
    /// it moves for less than two periods
    FewPeriods {
        /// s in motion
        moving_s: f64,
        /// s, of its trajectory, where that is known
        period_s: Option<f64>,
    },
    /// rotors are at a bound of their commands for much of it
    Saturated {
        /// s at a bound
        saturated_s: f64,
        /// s of flight
        all_s: f64,
    },
}

impl FlightLimit {
    /// A warning.
    #[must_use]
    pub fn note(&self) -> Note {
        Note::warning(About::Estimate, format!("limited: {}", self.words()))
    }

    /// A clause.
    #[must_use]
    pub fn words(&self) -> String {
        match self {
            Self::Hover => {
                "the vehicle only hovers, so effects that show in motion cannot be told from each other".to_owned()
            }
            Self::LittleMotion => {
                "the vehicle hardly moves, so drag, damping, ground effect and similar effects could not be detected".to_owned()
            }
            Self::NoVelocity => {
                "velocity and attitude are not both recorded, so drag, damping, ground effect and similar effects could not be detected".to_owned()
            }
            Self::FewPeriods { moving_s, period_s } => {
                let of = period_s.map_or_else(
                    || format!("a trajectory for identification ({PERIOD_S:.0} s or more)"),
                    |period_s| format!("its trajectory ({period_s:.1} s)"),
                );
                format!("the vehicle moves for {moving_s:.0} s only, less than two periods of {of}")
            }
            Self::Saturated { saturated_s, all_s } => format!(
                "rotors are at a bound of their commands for {saturated_s:.0} s of {all_s:.0} s, so missing physics may have a wrong name"
            ),
        }
    }
}

/// Why flights tell little: each of them has such a reason, and those of the longest one are told. None where one flight has none.
pub(in crate::study) fn limits_of_flights(flights: &[Signals], vehicle: &Vehicle) -> Vec<FlightLimit> {
    let each: Vec<Vec<FlightLimit>> = flights.iter().map(|signals| limits_of(signals, vehicle)).collect();
    if each.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    let usable_s = |place: &usize| flights[*place].quality.usable.usable_s;
    let longest = (0..flights.len()).max_by(|a, b| usable_s(a).total_cmp(&usable_s(b)));
    longest.map_or_else(Vec::new, |place| each[place].clone())
}

fn limits_of(signals: &Signals, vehicle: &Vehicle) -> Vec<FlightLimit> {
    let used: Vec<usize> = (0..signals.grid.count).filter(|&index| signals.usable[index]).collect();
    let hover_m_s = HOVER_SPEED * vehicle.size().arm_m.sqrt();
    let by_motion = if hovers(signals, &used, hover_m_s) {
        Some(FlightLimit::Hover)
    } else {
        few_periods(signals, &used, hover_m_s)
    };
    by_motion.into_iter().chain(saturated(&signals.quality)).collect()
}

/// Nine tenths of the flight are slow across, half of it up and down (a take-off and a landing are no motion), and nine tenths about one
/// attitude. Without velocity or attitude nothing is said.
fn hovers(signals: &Signals, used: &[usize], hover_m_s: f64) -> bool {
    let (Some(velocity), Some(attitude)) = (&signals.velocity, &signals.attitude) else { return false };
    let speeds = used.iter().map(|&index| velocity[index].xy().norm()).collect();
    let climbs = used.iter().map(|&index| velocity[index].z.abs()).collect();
    let climbs = at(climbs, TYPICAL).is_none_or(|climb_m_s| climb_m_s > hover_m_s);
    let below = |values: Vec<f64>, most: f64| at(values, MOST).is_some_and(|value| value < most);
    let steady = [Vector3::x(), Vector3::z()].into_iter().all(|axis| {
        let directions: Vec<Vector3<f64>> = used.iter().map(|&index| attitude[index] * axis).collect();
        let mean = directions.iter().sum::<Vector3<f64>>();
        below(directions.iter().map(|direction| direction.angle(&mean)).collect(), HOVER_ANGLE)
    });
    !climbs && below(speeds, hover_m_s) && steady
}

/// The flight moves for less than two periods: of its own trajectory, where that is known, otherwise of the shortest. Nothing is said of one
/// that turns all the time.
fn few_periods(signals: &Signals, used: &[usize], hover_m_s: f64) -> Option<FlightLimit> {
    let (velocity, rate) = (signals.velocity.as_ref()?, signals.rate.as_ref());
    let turning = rate.and_then(|rate| at(used.iter().map(|&index| rate[index].norm()).collect(), TYPICAL));
    if turning.is_some_and(|rate_rad_s| rate_rad_s > TURNS_RAD_S) {
        return None;
    }
    let speeds: Vec<f64> = used.iter().map(|&index| velocity[index].norm()).collect();
    let least = hover_m_s.max(MOVES * at(speeds.clone(), (19, 20))?);
    let moving_s = speeds.iter().filter(|speed| **speed > least).count() as f64 * signals.grid.step_s;
    // a shorter one is that of a harmonic, or of a turn
    let period_s = flown_period_s(signals, used).filter(|period_s| *period_s >= SHORTEST_S);
    let is_few = moving_s < PERIODS * period_s.unwrap_or(PERIOD_S);
    is_few.then_some(FlightLimit::FewPeriods { moving_s, period_s })
}

/// Rotors were at a bound of their commands for so much of a flight that missing physics may have a wrong name.
pub(super) fn saturated(quality: &Quality) -> Option<FlightLimit> {
    let Usable { saturated_s, usable_s, saturation_kept, .. } = quality.usable;
    let all_s = usable_s + saturated_s;
    let is_much = !saturation_kept && saturated_s > SATURATED * all_s;
    is_much.then_some(FlightLimit::Saturated { saturated_s, all_s })
}

fn at(mut values: Vec<f64>, part: (usize, usize)) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    quantile(&values, part)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::signals::{ConditionSettings, condition};
    use crate::simulate::{
        FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
    };

    /// A flight that hovers so long before its trajectory, and ends after so many seconds.
    fn limits(hover_s: f64, duration_s: f64) -> Vec<FlightLimit> {
        let pair = random_vehicle(5);
        let trajectory = RandomTrajectory::default().draw(5).unwrap();
        let reference = Reference { trajectory, hover_s, ramp_s: 2.0 };
        let truth = Truth { vehicle: pair.truth, effects: Vec::new(), disturbance: None };
        let settings = FlightSettings { seed: 5, duration_s, ..FlightSettings::default() };
        let flown = simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap();
        let settings = ConditionSettings { transient_s: Some(1.0), ..ConditionSettings::default() };
        let signals = condition(&flown.recording, &pair.nominal, &settings).unwrap();
        limits_of_flights(&[signals], &pair.nominal)
    }

    #[test]
    fn a_hover_and_a_flight_that_ends_early_are_limited_and_a_whole_one_is_not() {
        assert_eq!(limits(40.0, 30.0), [FlightLimit::Hover]);
        let short = limits(4.0, 14.0);
        let Some(FlightLimit::FewPeriods { moving_s, .. }) = short.first() else { panic!("{short:?}") };
        assert!((3.0..14.0).contains(moving_s), "{moving_s}");
        assert_eq!(limits(4.0, 54.0), []);
    }

    #[test]
    fn a_limit_is_a_clause_with_its_numbers() {
        let few = FlightLimit::FewPeriods { moving_s: 12.4, period_s: None };
        assert_eq!(
            few.words(),
            "the vehicle moves for 12 s only, less than two periods of a trajectory for identification (8 s or more)"
        );
        let own = FlightLimit::FewPeriods { moving_s: 12.4, period_s: Some(9.0) };
        assert!(own.words().ends_with("less than two periods of its trajectory (9.0 s)"), "{}", own.words());
        let bound = FlightLimit::Saturated { saturated_s: 12.0, all_s: 30.0 };
        assert!(bound.words().contains("for 12 s of 30 s"), "{}", bound.words());
    }
}
