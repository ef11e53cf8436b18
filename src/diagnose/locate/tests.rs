use super::*;
use crate::diagnose::made_flights;
use crate::diagnose::{ExplainSettings, Explanation, Trace, Verdict, by_part, explain};
use crate::physics::effects::by_id;
use crate::physics::{ActiveEffect, Wrench};
use crate::signals::Signals;
use crate::simulate::{Disturbance, RandomTrajectory, Truth};
use crate::vehicle::{Guess, Guessed, Vehicle};
use nalgebra::Vector3;
use std::f64::consts::TAU;

fn explained(seed: u64, conceal: impl Fn(&mut Truth, f64)) -> Explanation {
    let (signals, vehicle) = flown(seed, conceal);
    explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap()
}

fn flown(seed: u64, conceal: impl Fn(&mut Truth, f64)) -> (Signals, Vehicle) {
    made_flights::flown(seed, &RandomTrajectory::default(), conceal)
}

/// A force of `share` of the weight along a world axis that wanders within some seconds and never repeats.
fn wandering(axis: usize, share: f64) -> impl Fn(&mut Truth, f64) {
    move |truth, weight_n| {
        truth.disturbance = Some(Disturbance::new(move |time_s, state| {
            // no harmonic of the flown period, and none of each other
            let turns = [0.0531, 0.0832, 0.1297, 0.2089].map(|hz| (TAU * hz * time_s + 9.0 * hz).sin());
            let force = Vector3::ith(axis, share * weight_n / 2.0_f64.sqrt() * turns.iter().sum::<f64>());
            Wrench { force_n: state.attitude.inverse_transform_vector(&force), torque_nm: Vector3::zeros() }
        }));
    }
}

fn effect(id: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect::new(by_id(id).unwrap(), values).unwrap()
}

#[test]
fn a_region_of_the_room_is_found_where_it_is_and_no_vehicle_effect_named() {
    let found = explained(6001, |truth, weight_n| {
        truth.disturbance = Some(Disturbance::new(move |_, state| {
            let bump = (-0.5 * ((state.position_m.x - 0.2) / 0.2).powi(2)).exp();
            let force = Vector3::z() * (-0.06 * weight_n * bump);
            Wrench { force_n: state.attitude.inverse_transform_vector(&force), torque_nm: Vector3::zeros() }
        }));
    });
    assert_eq!(found.verdict, Verdict::Unexplained);
    assert!(found.named.is_empty());
    let field = found.field.unwrap();
    assert!(field.certain && field.beats_named, "{field:?}");
    assert_eq!((field.component, field.along), (2, 0));
    assert!((field.where_m - 0.2).abs() < 0.1, "{field:?}");
    let located = found.located_before.unwrap();
    let lives = located.lives_on().unwrap();
    assert_eq!((lives.channel, lives.state), (2, Followed::WorldX));
    assert!((lives.peak_at - 0.2).abs() < 0.2, "{}", lives.peak_at);
    assert!(located.axes[2].share > 0.5, "{:?}", located.axes);
}

#[test]
fn gusts_are_named_through_the_drag() {
    let found = explained(6002, |truth, _| {
        truth.effects.push(effect("gust", &[0.3, 1.0, 11.0]));
        truth.effects.push(effect("linear_drag", &[0.3, 0.3, 0.0]));
    });
    let gust = found.aperiodic.gust.unwrap();
    assert!((gust.sigma_m_s - 0.3).abs() < 0.1, "{gust:?}");
    assert!((0.4..2.5).contains(&gust.correlation_s), "{gust:?}");
    assert!(gust.sigma_std_m_s > 0.0 && gust.sigma_std_m_s < 0.1, "{gust:?}");
    let names: Vec<&str> = found.named.iter().map(|named| named.id).collect();
    assert_eq!(names, ["linear_drag", "gust"]);
    assert_eq!(found.verdict, Verdict::Explained);
}

#[test]
fn a_drag_is_neither_a_field_nor_noise_and_acts_alike_everywhere() {
    let found = explained(6003, |truth, weight_n| {
        let drag = 0.02 * weight_n;
        truth.effects.push(effect("linear_drag", &[drag, drag, 0.0]));
    });
    assert_eq!(found.verdict, Verdict::Explained);
    let field = found.field.unwrap();
    assert!(!field.certain && field.uneven.is_empty(), "{field:?}");
    assert!(!found.aperiodic.is_lacking() && found.aperiodic.gust.is_none(), "{:?}", found.aperiodic);
    let before = found.located_before.unwrap();
    assert!(matches!(before.lives_on().unwrap().state, Followed::Airspeed(0 | 1)));
    let band = before.bands[0].unwrap();
    assert!(band.high_hz < 1.0 && band.harmonic.unwrap() > 0.9, "{band:?}");
    let with = before.coherences.first().unwrap();
    assert!(matches!(with.with, Followed::Airspeed(_)) && with.mean > 0.8, "{with:?}");
}

#[test]
fn where_nothing_is_missing_nothing_is_located() {
    let found = explained(6004, |_, _| {});
    assert_eq!(found.verdict, Verdict::NothingMissing);
    let located = found.located_after.unwrap();
    assert!(located.lives_on().is_none(), "{:?}", located.lives_on());
    assert!(located.axes.iter().all(|axis| axis.excess == 0.0), "{:?}", located.axes);
    assert!(!found.field.unwrap().certain && !found.aperiodic.is_lacking());
    assert!(found.aperiodic.redness.len() == 6);
}

#[test]
fn a_force_that_wanders_as_wind_does_is_told_and_nothing_is_missing_for_it() {
    let found = explained(6005, wandering(0, 0.03));
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.named);
    let told: Vec<_> = found.aperiodic.wandering().collect();
    assert!(told.iter().any(|red| red.of == Quantity::World(0)), "{:?}", found.aperiodic.redness);
    assert!((0.015..0.05).contains(&told[0].relative), "{told:?}");
    let words = told[0].words();
    assert!(words.contains("of the weight) along world x over"), "{words}");
    // three times as much is more than wind makes
    assert_eq!(explained(6005, wandering(0, 0.09)).verdict, Verdict::Unexplained);
}

#[test]
fn a_lift_that_wanders_is_no_change_of_the_mass_and_a_load_that_drops_is() {
    let wanders = explained(6006, wandering(2, 0.02));
    assert!(wanders.named.iter().all(|named| named.id != "mass_change"), "{:?}", wanders.named);
    let drops = explained(6006, |truth, weight_n| {
        truth.effects.push(effect("mass_change", &[22.0, -0.06 * weight_n / 9.81]));
    });
    assert_eq!(drops.named.iter().map(|named| named.id).collect::<Vec<_>>(), ["mass_change"]);
}

#[test]
fn where_torques_are_averaged_a_guessed_balance_leaves_a_weak_rotor_uncertain() {
    let (mut signals, mut vehicle) =
        flown(6007, |truth, _| truth.effects.push(effect("weak_rotor", &[1.0, 0.9])));
    signals.quality.torques = false;
    let std = |vehicle: &Vehicle| {
        let found = explain(std::slice::from_ref(&signals), vehicle, &ExplainSettings::default()).unwrap();
        let weak = found.named.iter().find(|named| named.id == "weak_rotor").unwrap();
        let factor = weak.get("factor").unwrap();
        assert!((factor.value - 0.9).abs() < 3.0 * factor.std, "{factor:?}");
        factor.std
    };
    let measured = std(&vehicle);
    vehicle.guesses.push(Guess { of: Guessed::CenterOfMass, relative: 0.018, why: String::new() });
    // the mean balance tells nothing any more, the balance over the thrust still does
    let guessed = std(&vehicle);
    assert!(guessed > 1.4 * measured, "{guessed} {measured}");
}

#[test]
fn a_drag_is_in_each_half_of_the_flight() {
    let (signals, vehicle) = flown(6008, |truth, weight_n| {
        let drag = 0.02 * weight_n;
        truth.effects.push(effect("linear_drag", &[drag, drag, 0.0]));
    });
    let settings = ExplainSettings::default();
    let found = explain(std::slice::from_ref(&signals), &vehicle, &settings).unwrap();
    let traces = [Trace::new(&signals, &vehicle, settings.half_width_s).unwrap()];
    let parts = by_part(&traces, &found).unwrap();
    let drag = parts.iter().find(|of| of.id == "linear_drag").unwrap();
    assert!(drag.parts.len() == 2 && drag.is_certain(), "{drag:?}");
    let whole = found.named.iter().find(|named| named.id == "linear_drag").unwrap().value(drag.parameter);
    assert!(
        drag.parts.iter().all(|(value, std)| (value - whole).abs() < 5.0 * std.max(0.02 * whole)),
        "{drag:?} {whole}"
    );
}
