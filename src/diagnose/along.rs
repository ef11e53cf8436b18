//! Force and torque of a model along a recorded flight, from the measured states and given rotor thrusts.

use super::base::Base;
use super::rotors::RotorMotion;
use super::spin_up::SpinUp;
use super::trace::Trace;
use crate::physics::{Input, Model, Wrench};
use nalgebra::{Vector3, Vector4};

/// Adams-Bashforth weights of the last slopes, newest first, by the number of slopes that are known. The fourth order
/// keeps the amplitude of a pendulum that is excited at its own frequency; the second order increases it.
const ADAMS_BASHFORTH: [[f64; ORDER]; ORDER] = [
    [1.0, 0.0, 0.0, 0.0],
    [1.5, -0.5, 0.0, 0.0],
    [23.0 / 12.0, -16.0 / 12.0, 5.0 / 12.0, 0.0],
    [55.0 / 24.0, -59.0 / 24.0, 37.0 / 24.0, -9.0 / 24.0],
];
const ORDER: usize = 4;

/// Force and torque of the model at each grid instant (body, N, N m), with the effects' own states integrated along the
/// flight.
///
/// A load below the vehicle is excited by the measured motion, not by the model's motion, which would lose its phase.
/// Instants that no row uses are zero, unless states are integrated through them.
#[must_use]
pub fn wrench_along(model: &Model, trace: &Trace, turning: &RotorMotion) -> Vec<Wrench> {
    let count = model.own_state_count();
    let (mut states, mut rates) = (vec![0.0; count], vec![0.0; count]);
    // newest first
    let mut past: [Vec<f64>; ORDER] = std::array::from_fn(|_| vec![0.0; count]);
    let mut out = vec![Wrench::zero(); trace.grid.count];
    for index in 0..trace.grid.count {
        if count == 0 && !trace.usable[index] {
            continue;
        }
        let input = Input {
            time_s: trace.grid.time_s(index),
            speed_command: turning.speed.at(index),
            speed_rate_1_s: turning.acceleration_1_s.at(index),
            wind_m_s: Vector3::zeros(),
            battery_voltage_v: trace.voltage_v.as_ref().map(|v| v[index]),
        };
        let state = &trace.states[index];
        if index == 0 {
            model.initial_states(state, &input, &mut states);
        }
        out[index] = model.evaluate(state, &input, &states, &mut rates).wrench;
        if count == 0 {
            continue;
        }
        let felt_n = trace.felt_m_s2[index] * model.body.mass_kg;
        model.reaction_rates((state, &input), &felt_n, &states, &mut rates);
        past.rotate_right(1);
        past[0].copy_from_slice(&rates);
        for (rates, weight) in past.iter().zip(ADAMS_BASHFORTH[index.min(ORDER - 1)]) {
            states
                .iter_mut()
                .zip(rates)
                .for_each(|(state, rate)| *state += trace.grid.step_s * weight * rate);
        }
    }
    out
}

/// Fixed-point passes over the rotor thrusts that belong to the motion, because these thrusts depend on the effects and
/// the effects on them. Chosen; not measured.
const MOTION_PASSES: usize = 2;

/// Rotor motion from the measured motion, and the force and torque of the model with it.
pub(super) fn moved_by(
    trace: &Trace,
    (base, model): (&Base, &Model),
    commanded: &RotorMotion,
) -> (RotorMotion, Vec<Wrench>) {
    let airframe = &model.airframe;
    let spin_up = SpinUp::of(base, airframe);
    let (mass_kg, inertia) = (base.vehicle.body.mass_kg, base.vehicle.body.inertia_kg_m2);
    let (mut motion, mut by_motion, mut beyond) = (commanded.clone(), Vec::new(), None);
    for _ in 0..MOTION_PASSES {
        let thrusts = trace.by_motion(&base.vehicle, (mass_kg, &inertia), commanded, beyond.as_deref());
        motion = RotorMotion::new(thrusts, airframe, trace.grid.step_s);
        by_motion = wrench_along(model, trace, &motion);
        if base.present.is_empty() {
            break;
        }
        let of_effects = by_motion.iter().enumerate().map(|(index, all)| {
            let rest = *all - airframe.thrust_wrench(&motion.thrust_n.at(index));
            Vector4::new(rest.force_n.z, rest.torque_nm.x, rest.torque_nm.y, rest.torque_nm.z)
        });
        let mut of_effects: Vec<Vector4<f64>> = of_effects.collect();
        if let Some(spin_up) = &spin_up {
            spin_up.share(trace, (airframe, &motion), &inertia, &mut of_effects);
        }
        beyond = Some(of_effects);
    }
    (motion, by_motion)
}
