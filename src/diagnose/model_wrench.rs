//! Force and torque of a model along a recorded flight, from the measured states and given rotor thrusts.

use super::base::Base;
use super::rotors::RotorMotion;
use super::spin_up::SpinUp;
use super::trace::Trace;
use crate::physics::{ActiveEffect, Beyond, Hook, Input, Model, State, Wrench};
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
    let mut out = vec![Wrench::zero(); trace.grid.count];
    walk(model, (trace, turning), false, |index, (state, input), own| {
        out[index] = model.evaluate(state, input, &own.states, &mut own.rates).wrench;
    });
    out
}

/// A model's own states along a flight.
struct OwnAlong<'a> {
    model: &'a Model,
    states: Vec<f64>,
    rates: Vec<f64>,
    /// newest first
    past: [Vec<f64>; ORDER],
}

impl<'a> OwnAlong<'a> {
    fn of(model: &'a Model) -> Self {
        let none = || vec![0.0; model.own_state_count()];
        Self { model, states: none(), rates: none(), past: std::array::from_fn(|_| none()) }
    }

    /// To the next instant.
    fn onward(&mut self, trace: &Trace, index: usize, (state, input): (&State, &Input)) {
        let Self { model, states, rates, past } = self;
        let felt_n = trace.felt_m_s2[index] * model.body.mass_kg;
        model.reaction_rates((state, input), &felt_n, states, rates);
        past.rotate_right(1);
        past[0].copy_from_slice(rates);
        for (rates, weight) in past.iter().zip(ADAMS_BASHFORTH[index.min(ORDER - 1)]) {
            states
                .iter_mut()
                .zip(rates)
                .for_each(|(state, rate)| *state += trace.grid.step_s * weight * rate);
        }
    }
}

/// Calls `visit` with each grid instant that a row uses, or with all: its index, state and input, and the effects' own states.
fn walk(
    model: &Model,
    (trace, turning): (&Trace, &RotorMotion),
    all: bool,
    mut visit: impl FnMut(usize, (&State, &Input), &mut OwnAlong),
) {
    let mut own = OwnAlong::of(model);
    let has_states = !own.states.is_empty();
    for index in 0..trace.grid.count {
        if !(all || has_states || trace.usable[index]) {
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
            model.initial_states(state, &input, &mut own.states);
        }
        visit(index, (state, &input), &mut own);
        if has_states {
            own.onward(trace, index, (state, &input));
        }
    }
}

/// Force or torque of a model along a flight.
pub(super) struct PartAlong {
    /// N or N m, body, one an instant
    pub(super) series: Vec<Vector3<f64>>,
    /// at some instant its torque is not that of the base
    pub(super) turns: bool,
}

/// Force or torque of several models along a flight, as of [`wrench_along`]; each differs from `base` in one effect, and what
/// they have in common is computed once.
pub(super) fn each_along(
    base: &Model,
    models: &[&Model],
    (trace, turning): (&Trace, &RotorMotion),
    part: fn(&Wrench) -> Vector3<f64>,
) -> Vec<PartAlong> {
    // own states that follow the motion are the same in all of them
    let hangs = |active: &ActiveEffect| {
        active.effect().state_count(&base.airframe) == 0 || active.effect().hooks() == [Hook::Reaction]
    };
    let alike = models.len() > 1 && base.effects().iter().all(hangs);
    let beyond = |model: &&Model| model.differs_from(base).filter(|_| alike);
    let beyond: Vec<Option<Beyond>> = models.iter().map(beyond).collect();
    let mut out: Vec<PartAlong> = models
        .iter()
        .zip(&beyond)
        .map(|(model, beyond)| match beyond {
            Some(_) => PartAlong { series: vec![Vector3::zeros(); trace.grid.count], turns: false },
            None => {
                let series = wrench_along(model, trace, turning).iter().map(part).collect();
                PartAlong { series, turns: true }
            }
        })
        .collect();
    let mut shared: Vec<Shared> = Vec::new();
    for ((model, beyond), out) in models.iter().zip(beyond).zip(&mut out) {
        let Some(beyond) = beyond else { continue };
        let own = (beyond == Beyond::Hung).then(|| OwnAlong::of(model));
        shared.push(Shared { model, beyond, own, out });
    }
    if !shared.is_empty() {
        walk_together(base, &mut shared, (trace, turning), part);
    }
    out
}

/// A model that has something in common with another one.
struct Shared<'a> {
    model: &'a Model,
    beyond: Beyond,
    /// where it has own states that the other one lacks or has otherwise
    own: Option<OwnAlong<'a>>,
    out: &'a mut PartAlong,
}

fn walk_together(
    base: &Model,
    shared: &mut [Shared],
    (trace, turning): (&Trace, &RotorMotion),
    part: fn(&Wrench) -> Vector3<f64>,
) {
    let all = shared.iter().any(|of| of.own.is_some());
    let mut beside = vec![0.0; base.own_state_count()];
    walk(base, (trace, turning), all, |index, (state, input), base_own| {
        let instant = base.instant(state, input, &base_own.states, &mut base_own.rates);
        let plain = base.wrench_beyond(Beyond::Forces, &instant, &base_own.states, &mut beside);
        for Shared { model, beyond, own, out } in &mut *shared {
            let wrench = match own {
                Some(own) => {
                    if index == 0 {
                        model.initial_states(state, input, &mut own.states);
                    }
                    let wrench = model.wrench_beyond(*beyond, &instant, &own.states, &mut own.rates);
                    own.onward(trace, index, (state, input));
                    wrench
                }
                None => model.wrench_beyond(*beyond, &instant, &base_own.states, &mut beside),
            };
            out.turns |= wrench.torque_nm != plain.torque_nm;
            out.series[index] = part(&wrench);
        }
    });
}

/// Fixed-point passes over the rotor thrusts that belong to the motion, because these thrusts depend on the effects
/// and the effects on them. The effects are small against the thrust, so that each pass lowers the error by their
/// ratio.
const MOTION_PASSES: usize = 2;

/// Rotor motion from the measured motion, and the force and torque of the model with it.
pub(super) fn moved_by(
    trace: &Trace,
    (base, model): (&Base, &Model),
    commanded: &RotorMotion,
) -> (RotorMotion, Vec<Wrench>) {
    let airframe = &model.airframe;
    let spin_up = SpinUp::of(base, airframe);
    let (mut motion, mut by_motion, mut beyond) = (commanded.clone(), Vec::new(), None);
    for _ in 0..MOTION_PASSES {
        let thrusts = trace.by_motion(&base.vehicle, commanded, beyond.as_deref());
        motion = RotorMotion::new(thrusts, airframe, trace.grid.step_s);
        by_motion = wrench_along(model, trace, &motion);
        if base.effects.is_empty() {
            break;
        }
        let of_effects = by_motion.iter().enumerate().map(|(index, all)| {
            let rest = *all - airframe.thrust_wrench(&motion.thrust_n.at(index));
            Vector4::new(rest.force_n.z, rest.torque_nm.x, rest.torque_nm.y, rest.torque_nm.z)
        });
        let mut of_effects: Vec<Vector4<f64>> = of_effects.collect();
        if let Some(spin_up) = &spin_up {
            spin_up.share(trace, (airframe, &motion), &base.vehicle.body, &mut of_effects);
        }
        beyond = Some(of_effects);
    }
    (motion, by_motion)
}
