//! Flights for the tests of the diagnosis: a vehicle of a seed, with what the test conceals in it.
#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use crate::physics::ActiveEffect;
use crate::physics::effects::by_id;
use crate::signals::{ConditionSettings, Signals, condition};
use crate::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use crate::vehicle::Vehicle;

/// The conditioned flight along a trajectory of `random`, and the nominal vehicle. `conceal` is given the truth and its weight, N.
pub(in crate::diagnose) fn flown(
    seed: u64,
    random: &RandomTrajectory,
    conceal: impl Fn(&mut Truth, f64),
) -> (Signals, Vehicle) {
    let pair = random_vehicle(seed.wrapping_mul(7919));
    let trajectory = random.draw(seed.wrapping_mul(104_729)).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let weight_n = pair.truth.body.mass_kg * pair.truth.gravity_m_s2;
    let mut truth = Truth::clean(pair.truth);
    conceal(&mut truth, weight_n);
    let settings = FlightSettings { seed, ..FlightSettings::default() };
    let flight = simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap();
    let conditioning = ConditionSettings { transient_s: Some(1.0), ..ConditionSettings::default() };
    let signals = condition(&flight.recording, &pair.nominal, &conditioning).unwrap();
    (signals, pair.nominal)
}

/// Adds effects to what is concealed, by their names and first values; the others are zero.
pub(in crate::diagnose) fn conceal<'a>(
    truth: &mut Truth,
    effects: impl IntoIterator<Item = (&'a str, &'a [f64])>,
) {
    truth.effects.extend(effects.into_iter().map(|(id, values)| {
        let effect = by_id(id).unwrap();
        let mut whole = values.to_vec();
        whole.resize(effect.parameters().len(), 0.0);
        ActiveEffect::new(effect, &whole).unwrap()
    }));
}
