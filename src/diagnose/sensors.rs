//! Effects on the sensors: the true motion is the measured one, corrected for them.
//!
//! An effect states what ideal sensors measure of a true motion ([`Effect::measure`]). This module solves for the true
//! motion, so that the equation is written once.

use super::base::Base;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::{Measurement, State};
use crate::signals::{Series, central_difference};
use nalgebra::Vector3;
use std::borrow::Cow;
use std::sync::Arc;

/// Largest number of fixed-point passes. Each pass reduces the error by the effect's size (below 0.2).
const PASSES: usize = 8;
/// Largest difference from the measurement at which the motion counts as found, SI. Far below any sensor's noise.
const FOUND: f64 = 1e-9;

/// The flights' true motion, given the base's effects on the sensors.
pub(super) fn true_motion<'a>(flights: &'a [Trace], base: &Base) -> Cow<'a, [Trace]> {
    let faults = faults(base);
    if faults.is_empty() {
        return Cow::Borrowed(flights);
    }
    let moved = |trace: &Trace| {
        let (states, force) = undone(trace, &faults);
        // the low-pass that was possible before is possible now
        trace.with_motion(states, force).unwrap_or_else(|_| trace.clone())
    };
    Cow::Owned(flights.iter().map(moved).collect())
}

/// The true motion of flights with effects on the sensors, kept: many columns need it, and it takes long to find.
#[derive(Debug, Clone)]
pub(super) struct KnownMotion {
    faults: Vec<EffectTerm>,
    /// states and felt specific force of each flight as recorded
    recorded: Vec<(Series<State>, Series<Vector3<f64>>)>,
    flights: Arc<[Trace]>,
}

impl KnownMotion {
    /// `None` where the base has no effect on the sensors.
    pub(super) fn of(recorded: &[Trace], base: &Base) -> Option<Self> {
        let faults: Vec<EffectTerm> = faults(base).into_iter().cloned().collect();
        (!faults.is_empty()).then(|| Self {
            faults,
            recorded: recorded.iter().map(|trace| (trace.states.clone(), trace.felt_m_s2.clone())).collect(),
            flights: true_motion(recorded, base).into(),
        })
    }

    fn is_of(&self, recorded: &[Trace], base: &Base) -> bool {
        let faults = faults(base);
        let same_flight = |(known, trace): (&(Series<State>, Series<Vector3<f64>>), &Trace)| {
            Arc::ptr_eq(&known.0, &trace.states) && Arc::ptr_eq(&known.1, &trace.felt_m_s2)
        };
        let same_fault = |(known, fault): (&EffectTerm, &&EffectTerm)| {
            known.is(fault.signature) && known.values == fault.values
        };
        self.faults.len() == faults.len()
            && self.recorded.len() == recorded.len()
            && self.recorded.iter().zip(recorded).all(same_flight)
            && self.faults.iter().zip(&faults).all(same_fault)
    }

    /// The true motion of flights given a base: the one that is known, or else found anew.
    pub(super) fn or_found<'a>(
        known: Option<&'a Self>,
        recorded: &'a [Trace],
        base: &Base,
    ) -> Cow<'a, [Trace]> {
        match known.filter(|known| known.is_of(recorded, base)) {
            Some(known) => Cow::Borrowed(&known.flights),
            None => true_motion(recorded, base),
        }
    }
}

/// The same if only the measurements of force and momentum are needed.
pub(super) fn true_readings<'a>(flights: &'a [Trace], base: &Base) -> Cow<'a, [Trace]> {
    let faults = faults(base);
    if faults.is_empty() {
        return Cow::Borrowed(flights);
    }
    let moved = |trace: &Trace| {
        let (states, force) = undone(trace, &faults);
        trace.reading(states, force.map(Series::new))
    };
    Cow::Owned(flights.iter().map(moved).collect())
}

fn faults(base: &Base) -> Vec<&EffectTerm> {
    base.effects.iter().filter(|present| present.is_of_sensors()).collect()
}

/// One flight's states and, where it was recorded, specific force (m/s^2, body).
fn undone(trace: &Trace, faults: &[&EffectTerm]) -> (Vec<State>, Option<Vec<Vector3<f64>>>) {
    let shown_force = trace.specific_force_m_s2();
    let mut states = trace.states.to_vec();
    let mut force: Vec<Vector3<f64>> =
        shown_force.map_or_else(|| vec![Vector3::zeros(); states.len()], |force| force.to_vec());
    for _ in 0..PASSES {
        let turning = angular_acceleration(&states, trace.grid.step_s);
        let mut missed = 0.0_f64;
        for (index, shown) in trace.states.iter().enumerate() {
            let now = states[index];
            let mut seen = Measurement { state: now, specific_force_m_s2: force[index] };
            for fault in faults {
                fault.effect().measure(&now, &turning[index], &fault.values, &mut seen);
            }
            let of_motion = [
                shown.position_m - seen.state.position_m,
                shown.velocity_m_s - seen.state.velocity_m_s,
                shown.rates_rad_s - seen.state.rates_rad_s,
            ];
            missed = of_motion.iter().map(Vector3::amax).fold(missed, f64::max);
            missed = missed.max(shown.attitude.angle_to(&seen.state.attitude));
            states[index] = State {
                position_m: now.position_m + of_motion[0],
                velocity_m_s: now.velocity_m_s + of_motion[1],
                attitude: shown.attitude * seen.state.attitude.inverse() * now.attitude,
                rates_rad_s: now.rates_rad_s + of_motion[2],
            };
            if let Some(shown) = shown_force {
                let short = shown[index] - seen.specific_force_m_s2;
                missed = missed.max(short.amax());
                force[index] += short;
            }
        }
        if missed < FOUND {
            break;
        }
    }
    (states, shown_force.map(|_| force))
}

/// Unfiltered angular acceleration, rad/s^2; the weak form smooths it.
fn angular_acceleration(states: &[State], step_s: f64) -> Vec<Vector3<f64>> {
    let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        central_difference(&states.iter().map(|state| state.rates_rad_s[axis]).collect::<Vec<_>>(), step_s)
    });
    (0..states.len()).map(|i| Vector3::new(axes[0][i], axes[1][i], axes[2][i])).collect()
}

#[cfg(test)]
mod tests {
    use super::super::rows::tests::{turning_on_the_spot, vehicle};
    use super::super::signatures::signature_of;
    use super::*;

    #[test]
    fn a_known_motion_is_taken_for_its_own_base_alone() {
        let vehicle = vehicle();
        let flights = [Trace::new(&turning_on_the_spot(), &vehicle, 0.2).unwrap()];
        let turned = |angle_rad: f64| {
            let mut base = Base::rigid(&vehicle);
            let signature = signature_of("imu_misalignment").unwrap();
            base.effects.push(signature.term(&[angle_rad, 0.0, 0.0], &[0]));
            base
        };
        let known = KnownMotion::of(&flights, &turned(0.02));
        let rate = |motion: Cow<[Trace]>| motion[0].states[100].rates_rad_s;
        for angle_rad in [0.02, 0.05] {
            let base = turned(angle_rad);
            let found = rate(KnownMotion::or_found(known.as_ref(), &flights, &base));
            assert_eq!(found, rate(true_motion(&flights, &base)));
        }
        assert!(matches!(KnownMotion::or_found(known.as_ref(), &flights, &turned(0.02)), Cow::Borrowed(_)));
        assert!(KnownMotion::of(&flights, &Base::rigid(&vehicle)).is_none());
    }
}
