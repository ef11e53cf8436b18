//! A rigid body, its rotors and the effects that act on it, put together.

use std::ops::Range;

use nalgebra::Vector3;

use super::{
    ActiveEffect, Airframe, Condition, Effect, Hook, Input, Measurement, Own, PhysicsError, RigidBodyModel,
    Rotors, State, Wrench,
};
use crate::vehicle::Vehicle;

/// A vehicle with effects.
#[derive(Debug, Clone)]
pub struct Model {
    /// mass and inertia
    pub body: RigidBodyModel,
    /// rotors
    pub airframe: Airframe,
    effects: Vec<ActiveEffect>,
    /// each effect's part of the own states
    pub(super) slots: Vec<Range<usize>>,
    own_state_count: usize,
    by_hook: ByHook,
}

impl Model {
    /// # Errors
    /// If the vehicle is not physical (see [`RigidBodyModel::new`], [`Airframe::new`]), or its
    /// description lacks what an effect needs.
    pub fn new(vehicle: &Vehicle, effects: Vec<ActiveEffect>) -> Result<Self, PhysicsError> {
        let airframe = Airframe::new(vehicle)?;
        for active in &effects {
            if let Some(what) = active.effect.missing(&airframe) {
                return Err(PhysicsError::Missing { id: active.effect.id(), what });
            }
        }
        let body = RigidBodyModel::new(&vehicle.body, vehicle.gravity_m_s2)?;
        Ok(Self::assembled(body, airframe, effects))
    }

    /// The same vehicle for rotors whose speeds are measured: without what lies between command and speed.
    #[must_use]
    pub fn with_measured_speeds(&self) -> Self {
        let after = |active: &&ActiveEffect| !active.effect.is_before_speed();
        let effects = self.effects.iter().filter(after).cloned().collect();
        Self::assembled(self.body, self.airframe.clone(), effects)
    }

    /// The same vehicle with one more effect, called after the others at each [`Hook`].
    ///
    /// # Errors
    /// If the vehicle's description lacks what the effect needs.
    pub fn with(&self, effect: ActiveEffect) -> Result<Self, PhysicsError> {
        if let Some(what) = effect.effect.missing(&self.airframe) {
            return Err(PhysicsError::Missing { id: effect.effect.id(), what });
        }
        let mut effects = self.effects.clone();
        effects.push(effect);
        Ok(Self::assembled(self.body, self.airframe.clone(), effects))
    }

    fn assembled(body: RigidBodyModel, airframe: Airframe, effects: Vec<ActiveEffect>) -> Self {
        let (mut slots, mut own_state_count) = (Vec::with_capacity(effects.len()), 0);
        for active in &effects {
            let start = own_state_count;
            own_state_count += active.effect.state_count(&airframe);
            slots.push(start..own_state_count);
        }
        Self { body, airframe, by_hook: ByHook::of(&effects, &slots), effects, slots, own_state_count }
    }

    /// What was put on top of the rigid body.
    #[must_use]
    pub fn effects(&self) -> &[ActiveEffect] {
        &self.effects
    }

    /// Own states of all effects together.
    #[must_use]
    pub fn own_state_count(&self) -> usize {
        self.own_state_count
    }

    /// Own states of vehicles that have long followed their command. Fills the head of `states`.
    pub fn initial_states(&self, state: &State, input: &Input, states: &mut [f64]) {
        let at = Condition::new(&self.airframe, state, input, input.wind_m_s);
        let mut rotors = Rotors::as_commanded(&self.airframe, &input.speed_command);
        for (active, slot) in self.effects.iter().zip(&self.slots) {
            if let Some(states) = states.get_mut(slot.clone()) {
                active.effect.initial_states(&at, &rotors, states);
                // the next effect's command is what this one makes of it
                let (parameters, mut rates) = (&active.parameters, vec![0.0; states.len()]);
                let mut own = Own { parameters, states, rates: &mut rates };
                active.effect.rotor_speed(&at, &mut own, &mut rotors);
            }
        }
    }

    /// Force and torque of rotors and effects; writes the rates of the effects' own states. Both must be
    /// [`Self::own_state_count`] long; an effect whose part is missing sees none.
    pub fn evaluate(&self, state: &State, input: &Input, states: &[f64], rates: &mut [f64]) -> Evaluation {
        let mut rotors = Rotors::still();
        rates.fill(0.0);
        let wrench = self.wrench(state, input, OwnStates { states, rates }, &mut rotors);
        Evaluation { wrench, rotors }
    }

    /// [`Self::evaluate`] for the inner loop: `rotors` is overwritten, the rates must come as zero.
    #[inline(always)]
    pub(crate) fn wrench(
        &self,
        state: &State,
        input: &Input,
        mut states: OwnStates,
        rotors: &mut Rotors,
    ) -> Wrench {
        let at = self.condition(state, input, &mut states);
        self.turned(&at, &mut states, rotors);
        self.lifted(&at, &mut states, rotors);
        let sum = self.pushed(&at, rotors, &mut states, at.thrust_wrench(&rotors.thrust_n));
        self.answered(&at, &mut states, sum)
    }

    /// Rates of the own states alone, where [`Self::own_states_are_of_rotors`]; they must come as zero.
    #[inline(always)]
    pub(crate) fn rotor_rates(&self, state: &State, input: &Input, mut states: OwnStates) {
        let at = self.condition(state, input, &mut states);
        self.turned(&at, &mut states, &mut Rotors::still());
    }

    /// Whether all own states are of effects between command and rotor speed, which do not ask how the body moves.
    #[must_use]
    pub fn own_states_are_of_rotors(&self) -> bool {
        let mut each = self.effects.iter().zip(&self.slots);
        each.all(|(active, slot)| slot.is_empty() || active.effect.hooks() == [Hook::RotorSpeed])
    }

    /// What the effects of the air and of the centre of mass make of the instant.
    #[inline(always)]
    pub(super) fn condition<'a>(
        &'a self,
        state: &'a State,
        input: &'a Input,
        states: &mut OwnStates,
    ) -> Condition<'a> {
        let hooks = &self.by_hook;
        let (mut wind_m_s, mut center_m) = (input.wind_m_s, Vector3::zeros());
        each(&hooks.air, states, |effect, own| wind_m_s += effect.wind_m_s(input, own));
        each(&hooks.center_of_mass, states, |effect, own| center_m += effect.center_of_mass_m(own));
        Condition::about((&self.airframe, center_m), state, input, wind_m_s)
    }

    /// Speeds, and the thrusts that belong to them.
    #[inline(always)]
    pub(super) fn turned(&self, at: &Condition, states: &mut OwnStates, rotors: &mut Rotors) {
        rotors.speed = at.input.speed_command;
        rotors.acceleration_1_s = at.input.speed_rate_1_s;
        each(&self.by_hook.rotor_speed, states, |effect, own| effect.rotor_speed(at, own, rotors));
        rotors.thrust_from_speed(&self.airframe);
    }

    /// What the effects on thrusts make of them.
    #[inline(always)]
    pub(super) fn lifted(&self, at: &Condition, states: &mut OwnStates, rotors: &mut Rotors) {
        each(&self.by_hook.rotor_thrust, states, |effect, own| effect.rotor_thrust(at, own, rotors));
    }

    /// Force and torque of the thrusts and of all effects, but for what hangs on the vehicle.
    #[inline(always)]
    pub(super) fn pushed(
        &self,
        at: &Condition,
        rotors: &Rotors,
        states: &mut OwnStates,
        thrust: Wrench,
    ) -> Wrench {
        let mut sum = thrust;
        each(&self.by_hook.wrench, states, |effect, own| effect.wrench(at, rotors, own, &mut sum));
        sum
    }

    /// Beyond [`Self::pushed`] what the last effect pushes.
    #[inline(always)]
    pub(super) fn pushed_by_last(
        &self,
        at: &Condition,
        rotors: &Rotors,
        states: &mut OwnStates,
        sum: &mut Wrench,
    ) {
        let last = self.by_hook.wrench.len().saturating_sub(1);
        each(&self.by_hook.wrench[last..], states, |effect, own| effect.wrench(at, rotors, own, sum));
    }

    /// With what hangs on the vehicle.
    #[inline(always)]
    pub(super) fn answered(&self, at: &Condition, states: &mut OwnStates, mut sum: Wrench) -> Wrench {
        each(&self.by_hook.reaction, states, |effect, own| effect.reaction(at, own, &mut sum));
        sum
    }

    /// Rates of the own states of what hangs on the vehicle, where the force on the vehicle was measured: `felt_n`, with
    /// what the effects add (body, N, gravity apart). States and rates are as in [`Self::evaluate`]; the other
    /// rates are left as they are.
    pub fn reaction_rates(
        &self,
        (state, input): (&State, &Input),
        felt_n: &Vector3<f64>,
        states: &[f64],
        rates: &mut [f64],
    ) {
        if self.by_hook.reaction.is_empty() {
            return;
        }
        let at = Condition::new(&self.airframe, state, input, input.wind_m_s);
        each(&self.by_hook.reaction, &mut OwnStates { states, rates }, |effect, own| {
            let mut pull_n = |without_n: Vector3<f64>| {
                let mut sum = Wrench { force_n: without_n, torque_nm: Vector3::zeros() };
                effect.reaction(&at, own, &mut sum);
                sum.force_n - without_n
            };
            // the pull goes with the force on the vehicle without it: two places give the line
            let first_n = pull_n(*felt_n);
            let second_n = pull_n(felt_n - first_n);
            let square = first_n.norm_squared();
            let slope = if square > 0.0 { (second_n - first_n).dot(&first_n) / square } else { 0.0 };
            pull_n(felt_n - first_n / (1.0 - slope));
        });
    }

    /// How long before now the commands were sent that act now, s. Whoever holds the commands looks
    /// them up by it.
    #[must_use]
    pub fn command_delay_s(&self) -> f64 {
        self.effects.iter().map(|active| active.effect.command_delay_s(&active.parameters)).sum()
    }

    /// What sensors without noise show while the vehicle is pushed by `wrench`, which includes every
    /// effect's (see [`Self::evaluate`]).
    #[must_use]
    pub fn measure(&self, state: &State, wrench: &Wrench) -> Measurement {
        let mut seen = Measurement { state: *state, specific_force_m_s2: wrench.force_n / self.body.mass_kg };
        let turning = self.body.derivative(state, wrench).angular_acceleration_rad_s2;
        for active in &self.effects {
            active.effect.measure(state, &turning, &active.parameters, &mut seen);
        }
        seen
    }
}

/// Force and torque at one instant, and what the rotors do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// all but gravity, body, about the centre of mass
    pub wrench: Wrench,
    /// after all effects
    pub rotors: Rotors,
}

/// An effect where it acts, with its part of the own states.
#[derive(Debug, Clone)]
struct Acting {
    active: ActiveEffect,
    slot: Range<usize>,
}

/// The effects that act through each hook, side by side for the inner loop.
#[derive(Debug, Clone, Default)]
struct ByHook {
    air: Vec<Acting>,
    center_of_mass: Vec<Acting>,
    rotor_speed: Vec<Acting>,
    rotor_thrust: Vec<Acting>,
    wrench: Vec<Acting>,
    reaction: Vec<Acting>,
}

impl ByHook {
    fn of(effects: &[ActiveEffect], slots: &[Range<usize>]) -> Self {
        let through = |hook: Hook| {
            let acts = |(active, _): &(&ActiveEffect, _)| active.effect.hooks().contains(&hook);
            let all = effects.iter().zip(slots).filter(acts);
            all.map(|(active, slot)| Acting { active: active.clone(), slot: slot.clone() }).collect()
        };
        Self {
            air: through(Hook::Air),
            center_of_mass: through(Hook::CenterOfMass),
            rotor_speed: through(Hook::RotorSpeed),
            rotor_thrust: through(Hook::RotorThrust),
            wrench: through(Hook::Wrench),
            reaction: through(Hook::Reaction),
        }
    }
}

/// Calls `visit` with each effect and its own parameters and states.
#[inline]
fn each(acting: &[Acting], all: &mut OwnStates, mut visit: impl FnMut(&'static dyn Effect, &mut Own)) {
    for Acting { active, slot } in acting {
        let mut own = Own { parameters: &active.parameters, states: &[], rates: &mut [] };
        if !slot.is_empty() {
            own.states = all.states.get(slot.clone()).unwrap_or_default();
            own.rates = all.rates.get_mut(slot.clone()).unwrap_or_default();
        }
        visit(active.effect, &mut own);
    }
}

/// Own states of all effects and where their rates go, [`Model::own_state_count`] of each.
pub(crate) struct OwnStates<'a> {
    pub(crate) states: &'a [f64],
    pub(crate) rates: &'a mut [f64],
}
