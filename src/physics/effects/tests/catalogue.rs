//! The catalogue of effects: names, bounds, hooks and what is refused.

use nalgebra::Vector3;
use proptest::prelude::*;

use super::fixtures::*;
use crate::physics::effects::{ALL, GroundEffect, LinearDrag, MotorLag, by_id};
use crate::physics::{ActiveEffect, Condition, Hook, Input, Model, Own, Rotors, Wrench};

proptest! {
    /// A simulation calls only the hooks that an effect names; none that does something is left out.
    #[test]
    fn hooks_are_named(
        state in any_state(),
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.05..0.95, 3),
    ) {
        let vehicle = vehicle();
        for effect in ALL {
            let theta = within_bounds(*effect, &shares);
            let model = Model::new(&vehicle, vec![ActiveEffect::new(*effect, &theta).unwrap()]).unwrap();
            let bare = Model::new(&vehicle, vec![]).unwrap();
            let from = Input::from_commands(&model.airframe, 1e5, &commands);
            let input = Input { battery_voltage_v: Some(14.1), ..from };
            let at = Condition::new(&model.airframe, &state, &input, Vector3::zeros());
            let rotors = Rotors::as_commanded(&model.airframe, &input.speed_command);
            let mut own = vec![0.0; model.own_state_count()];
            model.initial_states(&state, &input, &mut own);
            let change = model.evaluate(&state, &input, &own, &mut own.clone()).wrench
                - bare.evaluate(&state, &input, &[], &mut []).wrench;
            let alone = wrench_of(*effect, &at, &rotors, &theta);
            prop_assert!(size(&(change - alone)) < 1e-9 * (1.0 + size(&alone)), "{}", effect.id());
            let moves = |hook| effect.hooks().contains(&hook);
            let own = Own { parameters: &theta, states: &[], rates: &mut [] };
            prop_assert!(moves(Hook::Air) || effect.wind_m_s(&input, &own) == Vector3::zeros());
            prop_assert!(moves(Hook::Commands) || effect.command_delay_s(&theta) == 0.0);
            let seen = model.measure(&state, &Wrench::zero());
            prop_assert!(moves(Hook::Sensors) || seen.state == state);
        }
    }
}

#[test]
fn identifiers_are_unique_and_bounds_in_order() {
    for (index, effect) in ALL.iter().enumerate() {
        assert_eq!(by_id(effect.id()).unwrap().sentence(), effect.sentence());
        assert!(ALL.iter().skip(index + 1).all(|other| other.id() != effect.id()));
        let all = effect.parameters().iter().chain(effect.finer_parameters());
        for parameter in all {
            let (least, greatest) = parameter.bounds.at(&vehicle().size());
            assert!(least < greatest && !parameter.unit.is_empty(), "{} {}", effect.id(), parameter.name);
        }
    }
    assert!(by_id("no_such_effect").is_none());
}

#[test]
fn wrong_parameter_counts_are_refused() {
    assert!(ActiveEffect::new(&LinearDrag, &[0.1]).is_err());
    assert!(ActiveEffect::new(&MotorLag, &[0.1]).is_ok());
}

#[test]
fn effects_are_made_by_name_within_their_bounds() {
    let size = vehicle().size();
    let drag = ActiveEffect::named("linear_drag", &[("dy", 0.2), ("dx", 0.1), ("dz", 0.0)], &size).unwrap();
    assert_eq!(drag.parameters(), [0.1, 0.2, 0.0]);
    for (id, values) in [
        ("no_such", vec![]),
        ("inflow", vec![]),
        ("inflow", vec![("kz", -1.0)]),
        ("inflow", vec![("kz", f64::NAN)]),
        ("inflow", vec![("kz", 0.1), ("k", 0.1)]),
    ] {
        assert!(ActiveEffect::named(id, &values, &size).is_err(), "{id} {values:?}");
    }
}

#[test]
fn an_effect_that_the_description_does_not_carry_is_refused() {
    let mut bare = vehicle();
    bare.propulsion.rotor_radius_m = None;
    let ground = ActiveEffect::new(&GroundEffect, &[1.0, 0.0, 1.0]).unwrap();
    let refused = Model::new(&bare, vec![ground]).unwrap_err();
    assert!(refused.to_string().contains("rotor_radius"), "{refused}");
}
