//! Models that differ in one effect: what they have in common is computed once an instant.

use super::model::{Model, OwnStates};
use super::{ActiveEffect, Condition, Hook, Input, Rotors, State, Wrench};

/// A model at one instant, at each place from which another one may do something else.
pub(crate) struct Instant<'a> {
    at: Condition<'a>,
    /// before the effects on thrusts
    turned: Rotors,
    /// after them
    lifted: Rotors,
    /// of the thrusts alone
    thrust: Wrench,
    /// before what hangs on the vehicle
    pushed: Wrench,
}

/// What two models have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Beyond {
    /// the commands
    Commands,
    /// the rotors' speeds
    Speeds,
    /// the rotors' thrusts
    Thrusts,
    /// all forces but one more
    OtherForces,
    /// all forces, but for what hangs on the vehicle
    Forces,
    /// the same, and what hangs there has own states
    Hung,
}

impl Model {
    /// One instant, kept for models that differ in one effect ([`Self::differs_from`], [`Self::wrench_beyond`]).
    pub(crate) fn instant<'a>(
        &'a self,
        state: &'a State,
        input: &'a Input,
        states: &[f64],
        rates: &mut [f64],
    ) -> Instant<'a> {
        rates.fill(0.0);
        let mut states = OwnStates { states, rates };
        let at = self.condition(state, input, &mut states);
        let mut turned = Rotors::still();
        self.turned(&at, &mut states, &mut turned);
        let mut lifted = turned;
        self.lifted(&at, &mut states, &mut lifted);
        let thrust = at.thrust_wrench(&lifted.thrust_n);
        let pushed = self.pushed(&at, &lifted, &mut states, thrust);
        Instant { at, turned, lifted, thrust, pushed }
    }

    /// From where on this model does something else than `other`, of the same vehicle, does; `None` where that is not known.
    pub(crate) fn differs_from(&self, other: &Self) -> Option<Beyond> {
        let (own, others) = (self.effects(), other.effects());
        let same = |a: &ActiveEffect, b: &ActiveEffect| {
            a.effect.id() == b.effect.id() && a.parameters == b.parameters
        };
        let place = own.iter().zip(others).take_while(|(a, b)| same(a, b)).count();
        let Some(changed) = own.get(place) else {
            return (own.len() == others.len()).then_some(Beyond::Forces);
        };
        let appended = place == others.len() && own.len() == place + 1;
        let rest = || own[place + 1..].iter().zip(&others[place + 1..]).all(|(a, b)| same(a, b));
        let replaced =
            own.len() == others.len() && changed.effect.id() == others[place].effect.id() && rest();
        if !(appended || replaced) {
            return None;
        }
        match changed.effect.hooks() {
            [Hook::Reaction] if !self.slots[place].is_empty() => Some(Beyond::Hung),
            _ if !self.slots[place].is_empty() => None,
            [Hook::RotorSpeed] => Some(Beyond::Commands),
            [Hook::RotorThrust] => Some(Beyond::Speeds),
            [Hook::Wrench] if appended => Some(Beyond::OtherForces),
            [Hook::Wrench] => Some(Beyond::Thrusts),
            [Hook::Reaction] => Some(Beyond::Forces),
            _ => None,
        }
    }

    /// [`Self::evaluate`]'s wrench at an instant of another model that does the same up to there, and has the same own
    /// states.
    pub(crate) fn wrench_beyond(
        &self,
        from: Beyond,
        of: &Instant,
        states: &[f64],
        rates: &mut [f64],
    ) -> Wrench {
        let (at, mut states) = (&of.at, OwnStates { states, rates });
        let sum = match from {
            Beyond::Commands | Beyond::Speeds => {
                let mut rotors = of.turned;
                if from == Beyond::Commands {
                    self.turned(at, &mut states, &mut rotors);
                }
                self.lifted(at, &mut states, &mut rotors);
                self.pushed(at, &rotors, &mut states, at.thrust_wrench(&rotors.thrust_n))
            }
            Beyond::Thrusts => self.pushed(at, &of.lifted, &mut states, of.thrust),
            Beyond::OtherForces => {
                let mut sum = of.pushed;
                self.pushed_by_last(at, &of.lifted, &mut states, &mut sum);
                sum
            }
            Beyond::Forces | Beyond::Hung => of.pushed,
        };
        self.answered(at, &mut states, sum)
    }
}
