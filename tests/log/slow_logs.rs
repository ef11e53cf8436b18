//! Flights whose log is too slow to compare torques with the motion, as both autopilots write by default: forces are used, and
//! torques averaged over seconds, which tell what acts always.

use mavid::diagnose::joint::{Found, RequestedEffects, identify_jointly};
use mavid::diagnose::{ExplainSettings, Explanation, Verdict, explain};
use mavid::estimate::{Finding, IdentifySettings, identify};
use mavid::physics::ActiveEffect;
use mavid::recording::{Quantity, Recording, Stream};
use mavid::signals::{ConditionSettings, Signals, SignalsError, ThrustPreference, condition};
use mavid::simulate::{
    FlightSettings, RandomTrajectory, Reference, Truth, VehiclePair, random_vehicle, simulate_flight,
};

const SEED: u64 = 11;

fn pair() -> VehiclePair {
    random_vehicle(SEED)
}

fn flown(effects: Vec<ActiveEffect>) -> Recording {
    let pair = pair();
    let trajectory = RandomTrajectory::default().draw(SEED).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let truth = Truth { vehicle: pair.truth, effects, disturbance: None };
    let settings = FlightSettings { seed: SEED, duration_s: 40.0, ..FlightSettings::default() };
    simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap().recording
}

/// One sample of the stream in each period.
fn thinned(stream: &Stream, rate_hz: f64) -> Stream {
    let mut out = Stream { time_s: Vec::new(), width: stream.width, values: Vec::new() };
    for (index, time_s) in stream.time_s.iter().enumerate() {
        if out.time_s.last().is_none_or(|last| time_s - last > (1.0 - 1e-6) / rate_hz) {
            out.time_s.push(*time_s);
            out.values.extend_from_slice(stream.sample(index));
        }
    }
    out
}

/// Commands at this rate, inertial sensors at 25 Hz, estimates at 10 Hz.
fn slow(mut recording: Recording, commands_hz: f64) -> Recording {
    for (key, stream) in &mut recording.streams {
        let rate_hz = match key.quantity {
            Quantity::ActuatorCommand => commands_hz,
            Quantity::AngularRate | Quantity::SpecificForce => 25.0,
            Quantity::Attitude | Quantity::Position | Quantity::Velocity => 10.0,
            _ => continue,
        };
        *stream = thinned(stream, rate_hz);
    }
    recording
}

fn conditioned(recording: &Recording) -> Result<Signals, SignalsError> {
    let settings = ConditionSettings { thrust: ThrustPreference::Commands, ..ConditionSettings::default() };
    condition(recording, &pair().nominal, &settings)
}

fn explained(effects: Vec<ActiveEffect>) -> Explanation {
    let signals = conditioned(&slow(flown(effects), 10.0)).unwrap();
    explain(&[signals], &pair().nominal, &ExplainSettings::default()).unwrap()
}

#[test]
fn mass_is_determined_and_inertia_is_not() {
    let signals = conditioned(&slow(flown(Vec::new()), 10.0)).unwrap();
    assert!(!signals.quality.torques);
    let note = &signals.quality.notes[0];
    assert!(note.is_warning() && note.text.contains("torques averaged over seconds"), "{note}");
    let found = identify(&[signals], &pair().nominal, &IdentifySettings::default()).unwrap();
    let [mass, inertia @ ..] = &found.best.result.parameters;
    let Finding::Determined { value, std } = mass.finding else { panic!("{mass:?}") };
    let true_kg = pair().truth.body.mass_kg;
    assert!((value - true_kg).abs() < 0.01 * true_kg && std < 0.01 * true_kg, "{value} +- {std}, {true_kg}");
    for parameter in inertia {
        let Finding::NotDetermined { reason } = &parameter.finding else { panic!("{parameter:?}") };
        assert!(reason.contains("at too low a rate"), "{reason}");
    }
}

#[test]
fn nothing_is_named_where_nothing_is_concealed() {
    let found = explained(Vec::new());
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.named);
    assert!(found.search.after.rigid_body().theta.iter().skip(1).all(|inertia| inertia.is_nan()));
}

#[test]
fn drag_is_named_with_its_size() {
    let size = pair().truth.size();
    let drag = 0.3 * size.mass_kg;
    let concealed = [("dx", drag), ("dy", drag), ("dz", drag)];
    let found = explained(vec![ActiveEffect::named("linear_drag", &concealed, &size).unwrap()]);
    let [named] = &found.named[..] else { panic!("{:?}", found.named) };
    assert_eq!(named.id, "linear_drag");
    // where it acts shows in torques alone
    assert!(named.parameters.iter().all(|parameter| parameter.name != "at_hubs"), "{:?}", named.parameters);
    for parameter in named.parameters.iter().take(3) {
        let error = (parameter.value - drag).abs();
        assert!(error < 0.1 * drag && error < 3.0 * parameter.std, "{parameter:?}, concealed {drag}");
    }
}

fn parameter(found: &Explanation, effect: &str, parameter: &str) -> (f64, f64) {
    let [named] = &found.named[..] else { panic!("{:?}, {:?}", found.named, found.slight) };
    assert_eq!((named.id, found.verdict), (effect, Verdict::Explained));
    let of = named.get(parameter).unwrap();
    (of.value, of.std)
}

#[test]
fn a_weak_rotor_is_named_by_averaged_torques() {
    let size = pair().truth.size();
    let concealed = [("rotor", 2.0), ("factor", 0.92)];
    let found = explained(vec![ActiveEffect::named("weak_rotor", &concealed, &size).unwrap()]);
    assert_eq!(found.named[0].value("rotor"), 2.0);
    let (factor, std) = parameter(&found, "weak_rotor", "factor");
    assert!((factor - 0.92).abs() < 3.0 * std && std < 0.01, "{factor} +- {std}");
}

#[test]
fn a_centre_of_mass_is_named_by_averaged_torques() {
    let size = pair().truth.size();
    let concealed = [("x", 0.006), ("y", -0.004), ("z", 0.0)];
    let found = explained(vec![ActiveEffect::named("com_offset", &concealed, &size).unwrap()]);
    for (axis, truth_m) in [("x", 0.006), ("y", -0.004)] {
        let (value, std) = parameter(&found, "com_offset", axis);
        assert!((value - truth_m).abs() < 3.0 * std && std < 0.001, "{axis}: {value} +- {std}");
    }
}

/// Forces and averaged torques do not tell the latency from command to rotor.
#[test]
fn what_needs_torques_is_not_determined_together_with_the_rigid_body() {
    let signals = conditioned(&slow(flown(Vec::new()), 10.0)).unwrap();
    let identified = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let wanted = RequestedEffects::of(&names).unwrap();
        identify_jointly(std::slice::from_ref(&signals), (&pair().nominal, &[]), &wanted, 0.2)
    };
    let found = identified(&["motor_lag", "linear_drag"]).unwrap();
    assert!(!found.latency.is_determined(), "{:?}", found.latency);
    let reason = |effect: &str, parameter: &str| {
        let of = found.effects.iter().find(|of| of.effect.id() == effect).unwrap();
        let of = of.parameters.iter().find(|of| of.name == parameter).unwrap();
        let Found::NotDetermined { reason, .. } = &of.found else { panic!("{of:?}") };
        reason.clone()
    };
    assert!(reason("motor_lag", "time_constant").contains("forces alone do not determine it"));
    assert!(!reason("linear_drag", "at_hubs").is_empty());
    assert!(found.acting.iter().all(|effect| effect.effect().id() != "motor_lag"));
    let refused = identified(&["angular_damping"]).map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("fast actuator commands and body rates"), "{refused}");
}

#[test]
fn commands_slower_still_are_refused() {
    let refused = conditioned(&slow(flown(Vec::new()), 4.0)).unwrap_err().to_string();
    assert!(
        refused.starts_with("sampled too slowly to identify from")
            && refused.contains("Hz; 8 Hz are the least"),
        "{refused}"
    );
}
