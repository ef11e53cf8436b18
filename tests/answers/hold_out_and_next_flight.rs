//! An explained model on flights that it has not seen; and the flight to fly next.

use mavid::diagnose::experiment::{NextError, NextFlight, NextSettings, design, told_apart};
use mavid::diagnose::holdout::{
    Explained, HeldOut, HoldoutError, HoldoutFit, HoldoutSettings, differing, on_holdout, on_identification,
    split_last_periods,
};
use mavid::diagnose::{
    Along, Empirical, ExplainSettings, Explanation, FlightParameter, Trace, Verdict, apart,
    each_with_model_of_all, explain,
};
use mavid::physics::effects::by_id;
use mavid::physics::{ActiveEffect, Wrench};
use mavid::recording::{Quantity, Recording};
use mavid::signals::{ConditionSettings, Series, Signals, ThrustPreference, condition};
use mavid::simulate::{
    Disturbance, FlightSettings, RandomTrajectory, Reference, Truth, VehiclePair, random_vehicle,
    simulate_flight,
};
use mavid::trajectory::{FourierAxis, FourierTrajectory};
use mavid::vehicle::Vehicle;
use nalgebra::Vector3;
use std::sync::Arc;

const VEHICLE: u64 = 21;

fn effect(id: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect::new(by_id(id).unwrap(), values).unwrap()
}

fn trajectory(seed: u64) -> FourierTrajectory {
    RandomTrajectory { speed_max_m_s: 2.0, ..RandomTrajectory::default() }.draw(seed).unwrap()
}

/// A flight of a vehicle, and its signals as seen with the nominal one.
fn flown(
    (truth, nominal): (&Vehicle, &Vehicle),
    concealed: (Vec<ActiveEffect>, Option<Disturbance>),
    path: FourierTrajectory,
    (seed, duration_s): (u64, f64),
) -> (Recording, Signals) {
    let reference = Reference { trajectory: path, hover_s: 4.0, ramp_s: 2.0 };
    let settings = FlightSettings { seed, duration_s, ..FlightSettings::default() };
    let truth = Truth { vehicle: truth.clone(), effects: concealed.0, disturbance: concealed.1 };
    let recording = simulate_flight(truth, nominal, &reference, &settings).unwrap().recording;
    let settings = ConditionSettings {
        transient_s: Some(1.0),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&recording, nominal, &settings).unwrap();
    (recording, signals)
}

fn pair() -> VehiclePair {
    random_vehicle(VEHICLE)
}

/// Explained from one flight with these effects.
fn explained(vehicles: &VehiclePair, effects: Vec<ActiveEffect>) -> (Explanation, Signals) {
    let flight = flown((&vehicles.truth, &vehicles.nominal), (effects, None), trajectory(5), (1, 44.0));
    let found =
        explain(std::slice::from_ref(&flight.1), &vehicles.nominal, &ExplainSettings::default()).unwrap();
    (found, flight.1)
}

fn shown(explanation: &Explanation, nominal: &Vehicle, flight: &(Recording, Signals)) -> HoldoutFit {
    let held = HeldOut { name: "holdout", signals: &flight.1, recording: Some(&flight.0) };
    on_holdout(Explained::of(explanation), &[held], nominal, &HoldoutSettings::default()).unwrap()
}

#[test]
fn drag_pays_on_a_flight_that_was_not_used_and_the_vehicle_is_the_same() {
    let vehicles = pair();
    let drag = || vec![effect("linear_drag", &[0.25, 0.25, 0.0])];
    let (found, _) = explained(&vehicles, drag());
    assert_eq!(found.named.iter().map(|named| named.id).collect::<Vec<_>>(), ["linear_drag"]);
    let both = (&vehicles.truth, &vehicles.nominal);
    let holdout = flown(both, (drag(), None), trajectory(6), (2, 34.0));
    let shown = shown(&found, &vehicles.nominal, &holdout);
    let gain = shown.improvement_percent.unwrap();
    let (low, high) = gain.range.unwrap();
    assert!(low > 5.0 && low < gain.value && gain.value < high, "{gain:?}");
    let velocity = shown.half_second().unwrap().velocity_m_s.unwrap();
    let floor = velocity.floor.unwrap();
    // the floor is an estimate too
    assert!(
        floor < 1.1 * velocity.after.value && velocity.after.value < 0.7 * velocity.before.value,
        "{velocity:?}"
    );
    // windows grow, errors grow
    let errors: Vec<f64> = shown.open_loop.iter().map(|of| of.position_m.unwrap().after.value).collect();
    assert!(errors[0] < errors[1] && errors[1] < errors[2], "{errors:?}");
    // the force rows fall to what the flight's own fit leaves
    let force = shown.weak[0].unwrap();
    assert!(force.after.value < 0.6 * force.before.value, "{force:?}");
    // the tilt of the thrust axis is what the other flight told, to a milliradian
    assert!(force.after.value < 1.5 * force.floor.unwrap(), "{force:?}");
    let closed = shown.closed_loop.as_ref().unwrap();
    assert!(closed.signals[0].unwrap().after.value < closed.signals[0].unwrap().before.value);
    // no model takes the recording's own noise out
    assert!(
        closed.signals.iter().flatten().all(|of| of.floor.is_some_and(|floor| of.after.value > 0.9 * floor))
    );
    assert_eq!(shown.other_vehicle, None);
    let drag = shown.agreement.iter().find(|of| of.name == "linear_drag.dx").unwrap();
    assert!(drag.sigmas().abs() < 5.0 && (drag.held_out / 0.25 - 1.0).abs() < 0.1, "{drag:?}");

    // a controller that expects forty times the inertia oscillates: the figures say nothing about the model
    let mut believed = vehicles.nominal.clone();
    believed.body.inertia_kg_m2 *= 40.0;
    let swung = self::shown(&found, &believed, &holdout).closed_loop.unwrap_err();
    assert!(
        swung.contains("diverges from the flight: ") && swung.contains("say nothing about the model"),
        "{swung}"
    );

    // the same log of a vehicle with other mass and inertia is found out
    let mut heavier = vehicles.truth.clone();
    heavier.body.mass_kg *= 1.2;
    heavier.body.inertia_kg_m2 *= 1.5;
    let stranger = flown((&heavier, &vehicles.nominal), (Vec::new(), None), trajectory(6), (3, 34.0));
    let shown = self::shown(&found, &vehicles.nominal, &stranger);
    let reason = shown.other_vehicle.unwrap().reason;
    assert!(reason.contains("mass"), "{reason}");
}

/// A drag leaves nothing across a flight that only climbs and sinks, and all of itself in one along a trajectory.
#[test]
fn what_a_slow_flight_cannot_show_makes_no_other_vehicle_of_a_faster_hold_out() {
    let vehicles = pair();
    let both = (&vehicles.truth, &vehicles.nominal);
    let drag = || vec![effect("linear_drag", &[2.8, 2.8, 0.0])];
    let mut climbs = trajectory(5);
    for axis in [0, 1, 3] {
        climbs.axes[axis] = FourierAxis { a: Vec::new(), b: Vec::new(), c: 0.0 };
    }
    let slow = flown(both, (drag(), None), climbs, (4, 34.0)).1;
    let settings = ExplainSettings::default();
    let found = explain(std::slice::from_ref(&slow), &vehicles.nominal, &settings).unwrap();
    assert!(found.named.is_empty(), "{:?}", found.named);
    let holdout = flown(both, (drag(), None), trajectory(6), (2, 34.0));
    let shown = shown(&found, &vehicles.nominal, &holdout);
    assert!(shown.speed_share > 3.0, "{}", shown.speed_share);
    // by its own fit
    let left = shown.weak[0].unwrap().floor.unwrap() / found.search.after.weighted.sigma[0];
    assert!(left > 4.0 * shown.speed_share.powi(2), "{left}, {} times as fast", shown.speed_share);
    assert_eq!(shown.other_vehicle, None);

    // what has another mass is another vehicle, however fast
    let mut heavier = vehicles.truth.clone();
    heavier.body.mass_kg *= 1.2;
    let stranger = flown((&heavier, &vehicles.nominal), (drag(), None), trajectory(6), (3, 34.0));
    let reason = self::shown(&found, &vehicles.nominal, &stranger).other_vehicle.unwrap().reason;
    assert!(reason.contains("mass"), "{reason}");
}

#[test]
fn flights_of_two_vehicles_are_told_from_two_of_one() {
    let vehicles = pair();
    let mut heavier = vehicles.truth.clone();
    heavier.body.mass_kg *= 1.2;
    heavier.body.inertia_kg_m2 *= 1.5;
    let of = |truth: &Vehicle, seed| {
        flown((truth, &vehicles.nominal), (Vec::new(), None), trajectory(seed), (seed, 34.0))
    };
    let (first, second, other) = (of(&vehicles.truth, 5), of(&vehicles.truth, 6), of(&heavier, 7));
    let said = |flights: [&(Recording, Signals); 2]| {
        let signals: Vec<Signals> = flights.iter().map(|flight| flight.1.clone()).collect();
        let found = explain(&signals, &vehicles.nominal, &ExplainSettings::default()).unwrap();
        let named = ["one", "two"].into_iter().zip(flights);
        let held: Vec<HeldOut> =
            named.map(|(name, flight)| HeldOut { name, signals: &flight.1, recording: None }).collect();
        differing(&found, &held, &vehicles.nominal, &HoldoutSettings::default()).unwrap()
    };
    assert_eq!(said([&first, &second]), None);
    let why = said([&first, &other]).unwrap();
    assert!(why.starts_with("one and two differ by more") && why.contains("ixx"), "{why}");
}

/// What is said of a flight whose streams, or vehicle file, were changed.
fn doubts(recording: &Recording, vehicle: &Vehicle) -> Vec<String> {
    let settings = ConditionSettings { thrust: ThrustPreference::Commands, ..ConditionSettings::default() };
    let notes = condition(recording, vehicle, &settings).unwrap().quality.notes;
    notes.iter().map(ToString::to_string).filter(|note| note.starts_with("warning: the bod")).collect()
}

#[test]
fn degrees_for_radians_reversed_axes_and_rotors_in_another_order_are_told() {
    let vehicles = pair();
    let flight = flown((&vehicles.truth, &vehicles.nominal), (Vec::new(), None), trajectory(5), (1, 34.0));
    assert_eq!(doubts(&flight.0, &vehicles.nominal), [""; 0]);
    let rates = |by: [f64; 3]| {
        let mut recording = flight.0.clone();
        for (key, stream) in &mut recording.streams {
            if key.quantity == Quantity::AngularRate {
                let scaled =
                    stream.values.chunks_exact(3).flat_map(|v| [by[0] * v[0], by[1] * v[1], by[2] * v[2]]);
                stream.values = scaled.collect();
            }
        }
        doubts(&recording, &vehicles.nominal)
    };
    let degrees = rates([180.0 / std::f64::consts::PI; 3]);
    assert!(
        degrees.len() == 3 && degrees.iter().all(|doubt| doubt.contains("times the rate")),
        "{degrees:?}"
    );
    let reversed = rates([1.0, -1.0, 1.0]);
    assert!(
        reversed.len() == 1 && reversed[0].contains("rate about y has the sign opposite"),
        "{reversed:?}"
    );
    for turn in 1..vehicles.nominal.rotors.len() {
        let mut turned = vehicles.nominal.clone();
        turned.rotors.rotate_left(turn);
        let said = doubts(&flight.0, &turned);
        assert!(said.len() == 1 && said[0].contains("in the vehicle file's order"), "{turn} {said:?}");
    }
}

#[test]
fn nothing_missing_changes_nothing_and_no_flight_is_refused() {
    let vehicles = pair();
    let (found, flight) = explained(&vehicles, Vec::new());
    assert_eq!(found.verdict, Verdict::NothingMissing);
    let split = split_last_periods(&flight).unwrap();
    let last = |signals: &Signals| signals.usable.iter().rposition(|usable| *usable).unwrap();
    let first = split.holdout.usable.iter().position(|usable| *usable).unwrap();
    assert!(last(&split.identify) < first && last(&split.holdout) == last(&flight));
    // whole periods of 10 s
    let periods = (flight.grid.time_s(last(&flight)) - split.from_s) / 10.0;
    assert!((periods - periods.round()).abs() < 0.03, "{periods}");
    let held = HeldOut { name: "end", signals: &split.holdout, recording: None };
    let settings = HoldoutSettings { same_flight: true, ..HoldoutSettings::default() };
    let shown = on_holdout(Explained::of(&found), &[held], &vehicles.nominal, &settings).unwrap();
    assert_eq!(shown.improvement_percent.unwrap().value, 0.0);
    assert_eq!(shown.other_vehicle, None);
    let mut nothing = flight.clone();
    nothing.usable.fill(false);
    let held = HeldOut { name: "ground", signals: &nothing, recording: None };
    let refused = on_holdout(Explained::of(&found), &[held], &vehicles.nominal, &settings);
    assert!(matches!(refused, Err(HoldoutError::TooShort { .. })));
    let refused = on_holdout(Explained::of(&found), &[], &vehicles.nominal, &settings);
    assert!(matches!(refused, Err(HoldoutError::NoFlight)));
    let next = design(&found, &[flight], &vehicles.nominal, &NextSettings::default(), &|| {});
    assert!(matches!(next, Err(NextError::NothingToTell)));
}

#[test]
fn the_moment_of_a_mass_change_is_found_again() {
    let vehicles = pair();
    let change = |time_s: f64| vec![effect("mass_change", &[time_s, -0.12 * vehicles.truth.body.mass_kg])];
    let (found, flight) = explained(&vehicles, change(22.0));
    assert_eq!(found.named.first().map(|named| named.id), Some("mass_change"));
    let both = (&vehicles.truth, &vehicles.nominal);
    let holdout = flown(both, (change(15.0), None), trajectory(6), (4, 34.0));
    let shown = shown(&found, &vehicles.nominal, &holdout);
    assert!(shown.improvement_percent.unwrap().range.unwrap().0 > 5.0);
    let note = shown.notes.iter().find(|note| note.text.contains("mass change")).unwrap().to_string();
    assert!(note.contains("at 14.") || note.contains("at 15."), "{note}");
    // after it, in the last part of the same flight, its size and the mass cannot be distinguished
    let split = split_last_periods(&flight).unwrap();
    let held = HeldOut { name: "end", signals: &split.holdout, recording: None };
    let settings = HoldoutSettings { same_flight: true, ..HoldoutSettings::default() };
    let shown = on_holdout(Explained::of(&found), &[held], &vehicles.nominal, &settings).unwrap();
    assert!(shown.agreement.iter().all(|of| of.name != "mass_change.delta" && of.held_out_std.is_finite()));
    let force_z = shown.weak[2].unwrap();
    assert!(force_z.after.value < 0.5 * force_z.before.value, "{force_z:?}");
}

#[test]
fn flights_that_each_drop_a_load_have_each_its_own_and_the_mass_before_it() {
    let vehicles = pair();
    let both = (&vehicles.truth, &vehicles.nominal);
    let mass_kg = vehicles.truth.body.mass_kg;
    let drops = |time_s: f64, seed: u64| {
        let change = vec![effect("mass_change", &[time_s, -0.08 * mass_kg])];
        flown(both, (change, None), trajectory(seed), (seed, 40.0)).1
    };
    let mut flights = vec![drops(18.0, 5), drops(20.0, 6)];
    let settings = ExplainSettings::default();
    let apart = apart(&flights, &vehicles.nominal, &settings);
    assert_eq!(apart.own.len(), 2);
    for ((signals, own), moment_s) in flights.iter_mut().zip(apart.own).zip([18.0, 20.0]) {
        let [(id, values)] = &*own.has else { panic!("{own:?}") };
        assert!(*id == "mass_change" && (values[0] - moment_s).abs() < 0.5, "{values:?}");
        signals.own = own;
    }
    let together = explain(&flights, &vehicles.nominal, &settings).unwrap();
    let found_kg = together.search.after.base.vehicle.body.mass_kg;
    assert!(together.named.is_empty() && (found_kg / mass_kg - 1.0).abs() < 0.01, "{found_kg} {mass_kg}");
}

#[test]
fn a_force_fixed_in_the_room_is_predicted_without_a_name() {
    let vehicles = pair();
    let push = 0.08 * vehicles.truth.body.mass_kg * 9.81;
    let field = || {
        Some(Disturbance::new(move |_, state| {
            let near = ((state.position_m.x - 0.2) / 0.25).powi(2);
            let force = Vector3::new(0.0, 0.0, -push * (-0.5 * near).exp());
            Wrench { force_n: state.attitude.inverse_transform_vector(&force), ..Wrench::zero() }
        }))
    };
    let both = (&vehicles.truth, &vehicles.nominal);
    let (_, flight) = flown(both, (Vec::new(), field()), trajectory(5), (1, 44.0));
    let flights = [flight];
    let settings = ExplainSettings::default();
    let found = explain(&flights, &vehicles.nominal, &settings).unwrap();
    assert!(matches!(found.verdict, Verdict::Unexplained | Verdict::PartlyExplained), "{:?}", found.verdict);
    let term = Empirical::fit(&found, &flights, &vehicles.nominal, &settings).unwrap().unwrap();
    assert_eq!(term.along, Along::Position(0));
    let holdout = flown(both, (Vec::new(), field()), trajectory(6), (2, 34.0));
    let held = HeldOut { name: "holdout", signals: &holdout.1, recording: Some(&holdout.0) };
    let with_term = Explained { empirical: Some(&term), ..Explained::of(&found) };
    let shown = on_holdout(with_term, &[held], &vehicles.nominal, &HoldoutSettings::default()).unwrap();
    assert!(shown.improvement_percent.unwrap().range.unwrap().0 > 0.0, "{:?}", shown.improvement_percent);
    assert!(shown.closed_loop.is_err());
}

#[test]
fn torques_that_do_not_tell_the_rates_give_way_to_a_law_of_the_rates() {
    let vehicles = pair();
    let (found, flight) = explained(&vehicles, Vec::new());
    let both = (&vehicles.truth, &vehicles.nominal);
    let (_, other) = flown(both, (Vec::new(), None), trajectory(6), (2, 44.0));
    let settings = HoldoutSettings::default();
    let fitted = |signals: &Signals| {
        let used = HeldOut { name: "used", signals, recording: None };
        on_identification(Explained::of(&found), &[used], &vehicles.nominal, &settings).unwrap()
    };
    let sound = fitted(&flight);
    assert_eq!(sound.rate_law, None);
    let [.., attitude, rates] = sound.open_loop[1].quantities().map(Option::unwrap);
    assert!(!attitude.is_worse_than_unchanged() && !rates.is_worse_than_unchanged());
    // the commands of another flight
    let foreign = Signals { rotor_thrust_n: other.rotor_thrust_n.clone(), ..flight.clone() };
    let fit = fitted(&foreign);
    let law = fit.rate_law.unwrap();
    assert!(law.share.x < 0.1 && law.share.y < 0.1 && law.decay_1_s.min() >= 0.0, "{law:?}");
    let rates = fit.open_loop[1].rates_rad_s.unwrap();
    assert!(!rates.is_worse_than_unchanged(), "{rates:?}");
    // it is what predicts a hold-out too, and no simulation in closed loop
    let held = || [HeldOut { name: "holdout", signals: &foreign, recording: None }];
    let with_law = Explained { rate_law: fit.rate_law, ..Explained::of(&found) };
    let shown = on_holdout(with_law, &held(), &vehicles.nominal, &settings).unwrap();
    let without = on_holdout(Explained::of(&found), &held(), &vehicles.nominal, &settings).unwrap();
    let rates = |fit: &HoldoutFit| fit.half_second().unwrap().rates_rad_s.unwrap().after.value;
    assert!(rates(&shown) < 0.6 * rates(&without));
}

#[test]
fn flights_with_and_without_measured_rotor_speeds_are_explained_together() {
    let vehicles = pair();
    let drag = || vec![effect("linear_drag", &[0.25, 0.25, 0.0])];
    let both = (&vehicles.truth, &vehicles.nominal);
    let (_, by_commands) = flown(both, (drag(), None), trajectory(5), (1, 34.0));
    let (recording, _) = flown(both, (drag(), None), trajectory(6), (2, 34.0));
    let settings = ConditionSettings { transient_s: Some(1.0), ..ConditionSettings::default() };
    let by_speeds = condition(&recording, &vehicles.nominal, &settings).unwrap();
    assert!(by_commands.jitter_wrench.is_some() && by_speeds.jitter_wrench.is_none());
    let named = |flights: &[Signals]| {
        let found = explain(flights, &vehicles.nominal, &ExplainSettings::default()).unwrap();
        found.named.iter().map(|named| named.id).collect::<Vec<_>>()
    };
    assert_eq!(named(&[by_speeds.clone(), by_commands.clone()]), ["linear_drag"]);
    let (flights, settings) = ([by_commands, by_speeds], ExplainSettings::default());
    let found = explain(&flights, &vehicles.nominal, &settings).unwrap();
    let [drag] = found.named.as_slice() else { panic!("{:?}", found.named) };
    assert_eq!((drag.id, drag.parameters[0].name), ("linear_drag", "dx"));
    // each flight tells it too, less certainly than both of them
    for alone in each_with_model_of_all(&flights, (&[false; 2], &[]), &found, (&vehicles.nominal, &settings))
    {
        let dx = alone.iter().find(|of| of.name == "linear_drag.dx").unwrap();
        let (value, std) = dx.estimate;
        assert!((value - 0.25).abs() < 3.0 * std && std < 0.1, "{dx:?}");
        // an error so large that none would do as well proves nothing
        assert!((value - 0.25).abs() < 0.05 || std < 0.03, "{dx:?}");
        assert!(dx.common_std < std && drag.parameters[0].std < std, "{dx:?}, {drag:?}");
    }
}

/// The distance that the next flight was said to bring is the one that it brings.
fn promise_is_kept(
    concealed: &dyn Fn() -> Vec<ActiveEffect>,
    named: &str,
    within: std::ops::Range<f64>,
) -> NextFlight {
    let vehicles = pair();
    let (found, flight) = explained(&vehicles, concealed());
    let settings = NextSettings { starts: 2, moves: 40, ..NextSettings::default() };
    let next = design(&found, std::slice::from_ref(&flight), &vehicles.nominal, &settings, &|| {}).unwrap();
    assert!(next.limits_are_flown && next.sentence().contains("standard deviations"));
    let promised = *next.pairs.iter().find(|pair| pair.named == named).unwrap();
    // the list of names has the same distance
    let like_it = found.named.iter().filter(|of| of.id == named).flat_map(|of| &of.confusable_with);
    let listed =
        like_it.filter(|other| Some(other.id) == promised.other).find_map(|other| other.distinguishability);
    assert!(listed.is_none_or(|distance| (distance - promised.now).abs() < 1e-9), "{listed:?}, {promised:?}");
    let both = (&vehicles.truth, &vehicles.nominal);
    let (_, then) = flown(both, (concealed(), None), next.trajectory.clone(), (9, 6.0 + next.seconds));
    let after = explain(std::slice::from_ref(&then), &vehicles.nominal, &ExplainSettings::default()).unwrap();
    let reached =
        told_apart((&after, named), promised.other, (&[then], &vehicles.nominal), &settings).unwrap();
    let reached = reached.unwrap_or_else(|| panic!("{named} from {:?}: not tried", promised.other));
    let ratio = reached / promised.after;
    assert!(within.contains(&ratio), "promised {promised:?}, reached {reached}");
    next
}

#[test]
fn the_next_flight_keeps_its_promise_for_an_effect_that_is_known_badly() {
    let next = promise_is_kept(&|| vec![effect("linear_drag", &[0.03, 0.03, 0.0])], "linear_drag", 0.6..1.6);
    // a search of random moves finds more than its first draw, and no less than now
    assert!(next.pairs[0].after > next.pairs[0].now, "{}", next.sentence());
}

#[test]
fn the_next_flight_keeps_its_promise_for_lag_and_delay() {
    // jitter of the commands tells the two apart as well, and is not counted on
    let next = promise_is_kept(&|| vec![effect("motor_lag", &[0.02])], "motor_lag", 0.6..2.5);
    assert_eq!(next.pairs[0].other, Some("transport_delay"));
}

/// In hover nothing that shows only in motion can be named, whatever is there.
#[test]
fn a_hover_has_too_little_excitation_for_a_name() {
    let vehicles = pair();
    let mut hover = trajectory(5);
    for axis in &mut hover.axes {
        axis.a.iter_mut().chain(&mut axis.b).for_each(|coefficient| *coefficient = 0.0);
    }
    let both = (&vehicles.truth, &vehicles.nominal);
    for (seed, concealed) in [(1, Vec::new()), (2, vec![effect("linear_drag", &[0.25, 0.25, 0.0])])] {
        let (_, flight) = flown(both, (concealed, None), hover.clone(), (seed, 44.0));
        let found = explain(&[flight], &vehicles.nominal, &ExplainSettings::default()).unwrap();
        assert!(found.too_little_excitation, "{:?}", found.limits);
        assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.named);
    }
    let (lively, _) = explained(&vehicles, Vec::new());
    assert!(!lively.too_little_excitation);
}

/// An accelerometer whose steps hide all that it feels is no measurement: a hover then says nothing certain of a drag.
#[test]
fn a_hover_within_the_steps_of_its_accelerometer_does_not_tell_the_drag() {
    let vehicles = pair();
    let drag = || vec![effect("linear_drag", &[0.25, 0.25, 0.0])];
    let (found, moving) = explained(&vehicles, drag());
    let mut hover = trajectory(5);
    for axis in &mut hover.axes {
        axis.a.iter_mut().chain(&mut axis.b).for_each(|coefficient| *coefficient = 0.0);
    }
    let both = (&vehicles.truth, &vehicles.nominal);
    let (_, mut hover) = flown(both, (drag(), None), hover, (1, 44.0));
    let along = |signals: &Signals| -> Vec<_> {
        signals.specific_force.as_ref().unwrap().iter().map(|force| Vector3::z() * force.z).collect()
    };
    hover.specific_force = Some(Series::new(along(&hover)));
    let stream = Arc::make_mut(hover.as_recorded.specific_force.as_mut().unwrap());
    stream.values.iter_mut().enumerate().for_each(|(place, value)| {
        *value = if place % 3 == 2 { (*value / 0.0098).round() * 0.0098 } else { 0.0 };
    });
    assert!(moving.resolves_specific_force() && !hover.resolves_specific_force());
    let settings = ExplainSettings::default();
    let trace = Trace::new(&hover, &vehicles.nominal, settings.half_width_s).unwrap();
    assert!(!trace.has_accelerometer());
    let flights = [moving, hover];
    let each = each_with_model_of_all(&flights, (&[false; 2], &[]), &found, (&vehicles.nominal, &settings));
    let [moving, hover] = each.try_into().unwrap();
    let of = |flight: &[FlightParameter], name: &str| {
        flight.iter().find(|of| of.name == name).map(|of| of.estimate)
    };
    for name in ["linear_drag.dx", "linear_drag.dy"] {
        assert!((of(&moving, name).unwrap().0 - 0.25).abs() < 0.02, "{name}: {moving:?}");
        assert_eq!(of(&hover, name), None);
    }
    assert!(of(&hover, "mass").is_some());
}

/// Thrust that falls with climb is a drag along the rotor axis: no flight tells one from the other.
#[test]
fn what_no_flight_tells_apart_is_said() {
    let vehicles = pair();
    let (found, flight) = explained(&vehicles, vec![effect("inflow", &[0.2])]);
    assert_eq!(found.named[0].confusable_with[0].id, "linear_drag");
    let settings = NextSettings { starts: 1, moves: 1, ..NextSettings::default() };
    let Err(NextError::Inseparable(pairs)) = design(&found, &[flight], &vehicles.nominal, &settings, &|| {})
    else {
        panic!("a flight was designed");
    };
    assert!(
        pairs[0].to_string().starts_with("no trajectory separates thrust that falls with climb from drag: "),
        "{pairs:?}"
    );
}
