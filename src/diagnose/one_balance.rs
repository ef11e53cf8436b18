//! One effect that moves the balance in place of several.
//!
//! A rotor that is weak, the opposite one that is strong, and a centre of mass that is off turn the vehicle nearly alike. A search that takes
//! one after the other may end with all of them: each has then a part of the one that is there, and a part may be too small for its name.

use super::base::Base;
use super::fit::{Fitted, Newton, fit};
use super::price::Price;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// The model `fitted` with one effect that moves the balance in place of all such effects, where that one is about to leave it and costs less
/// alone than `left`, what is left of the model without all that leaves: of several the one that costs least, with its place in that model.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn better_alone(
    traces: &[Trace],
    (fitted, leaves): (&Fitted, &[bool]),
    left: &Fitted,
) -> Result<Option<(Fitted, usize)>, PhysicsError> {
    let effects = &fitted.base.effects;
    let is_balance = |place: usize| moves_balance(&effects[place]);
    if (0..effects.len()).filter(|&place| is_balance(place)).count() < 2 {
        return Ok(None);
    }
    let price = Price::of(fitted);
    let mut best: Option<(Fitted, usize)> = None;
    for place in (0..effects.len()).filter(|&place| leaves[place] && is_balance(place)) {
        let goes = |of: usize| of != place && (leaves[of] || is_balance(of));
        let alone = fit(traces, fitted.base.without(goes), Newton::Held)?;
        let least = price.cost(best.as_ref().map_or(left, |(least, _)| least));
        if price.cost(&alone) < least {
            best = place_in(&alone.base, &effects[place]).map(|at| (alone, at));
        }
    }
    if let Some((alone, at)) = &best {
        let effect = alone.base.effects[*at].id();
        tracing::info!(effect, "one effect moves the balance in place of several");
    }
    Ok(best)
}

/// Where an effect is in a model.
fn place_in(base: &Base, term: &EffectTerm) -> Option<usize> {
    let number = |of: &EffectTerm| of.signature.role.which.map(|slot| of.values[slot]);
    base.effects.iter().position(|of| of.id() == term.id() && number(of) == number(term))
}

/// Whether it is a rotor's, or a load's place.
fn moves_balance(term: &EffectTerm) -> bool {
    let role = &term.signature.role;
    role.which.is_some() || role.of_the_loading && role.moment.is_none()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::latency::fit_latency;
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::diagnose::signatures::signature_of;
    use crate::simulate::RandomTrajectory;

    /// What takes the place of a rotor and a centre of mass of which the one named `leaves` leaves, of a flight with these.
    fn alone(concealed: &[(&str, [f64; 2])], leaves: &str) -> Option<&'static str> {
        let (signals, vehicle) = flown(41, &RandomTrajectory::default(), |truth, _| {
            conceal(truth, concealed.iter().map(|(id, values)| (*id, values as &[f64])));
        });
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let (before, _) = fit_latency(&flights, Base::anchored(&vehicle)).unwrap();
        let mut base = before.base.clone();
        let [mut rotor, mut load] = ["weak_rotor", "com_offset"].map(|id| signature_of(id).unwrap().whole());
        rotor.values[0] = 1.0;
        rotor.free = rotor.signature.amounts.to_vec();
        load.free = vec![0, 1];
        base.effects = vec![rotor, load];
        let both = fit(&flights, base, Newton::Held).unwrap();
        let leave: Vec<bool> = both.base.effects.iter().map(|of| of.id() == leaves).collect();
        let left = fit(&flights, both.base.without(|place| leave[place]), Newton::Held).unwrap();
        let better = better_alone(&flights, (&both, &leave), &left).unwrap();
        better.map(|(model, at)| {
            assert_eq!(model.base.effects.len(), 1);
            model.base.effects[at].id()
        })
    }

    #[test]
    fn what_is_there_takes_the_place_of_what_is_not_and_nothing_else_does() {
        const ROTOR: (&str, [f64; 2]) = ("weak_rotor", [1.0, 0.9]);
        const LOAD: (&str, [f64; 2]) = ("com_offset", [0.02, 0.01]);
        assert_eq!(alone(&[ROTOR], "weak_rotor"), Some("weak_rotor"));
        assert_eq!(alone(&[ROTOR], "com_offset"), None);
        assert_eq!(alone(&[LOAD], "com_offset"), Some("com_offset"));
        assert_eq!(alone(&[LOAD], "weak_rotor"), None);
    }
}
