//! Simulated flights by their seed, explained.

use super::ordinary::Ordinary;
use mavid::diagnose::{ExplainSettings, Explanation, explain};
use mavid::physics::ActiveEffect;
use mavid::physics::effects::ThrustTilt;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;

/// Beside what the seed draws.
#[derive(Clone, Copy, Default)]
pub struct Conditions {
    /// the controller flies on the noise that is logged
    pub fed_back: bool,
    /// every thrust axis leans by 0.2 degrees
    pub askew: bool,
    /// 125 Hz, noise factor 1, no skew
    pub usual: bool,
    /// flights to 0.8, 1.6 and 3 m/s
    pub marks: bool,
}

/// The vehicle of a seed's flight.
pub fn vehicle(seed: u64) -> Vehicle {
    random_vehicle(seed.wrapping_mul(7919)).truth
}

/// Rate, noise and skew of a seed's flight in words.
pub fn drawn(seed: u64) -> String {
    let settings = settings(seed);
    format!(
        "rate {} Hz, noise {:.2}, position late {:.1} ms",
        settings.telemetry.rates.actuator_hz,
        settings.telemetry.noise_scale,
        1e3 * settings.telemetry.skew.position_s
    )
}

/// Rates 50 to 250 Hz, noise 0.5 to 3 times, streams up to 10 ms late: by the seed.
fn settings(seed: u64) -> FlightSettings {
    let share = |by: u64| (seed.wrapping_mul(by) % 1009) as f64 / 1008.0;
    let mut settings = FlightSettings { seed, ..FlightSettings::default() };
    let rate_hz = [50.0, 100.0, 125.0, 250.0][(seed % 4) as usize];
    let rates = &mut settings.telemetry.rates;
    (rates.attitude_hz, rates.imu_hz, rates.actuator_hz) = (rate_hz, rate_hz, rate_hz);
    settings.telemetry.noise_scale = 0.5 * 6.0_f64.powf(share(617));
    settings.telemetry.skew.position_s = 0.010 * share(331);
    settings
}

/// The flight of a seed with these effects concealed. It is flown as it shows the first of them; the first that acts
/// through a drag has one beside it.
pub fn fly(seed: u64, concealed: &[&'static Ordinary], with: Conditions) -> Option<Explanation> {
    let mut pair = random_vehicle(seed.wrapping_mul(7919));
    let mut random = RandomTrajectory::default();
    if with.marks {
        // slow and fast flights, as the marks' own
        random.speed_max_m_s = [0.8, 1.6, 3.0][(seed % 3) as usize];
        (random.acceleration_max_m_s2, random.height_m) = (4.5, (0.5, 4.0));
    }
    let usual = FlightSettings { seed, ..FlightSettings::default() };
    let mut settings = if with.usual { usual } else { settings(seed) };
    if let Some(first) = concealed.first() {
        let stated = first.shown_by.prepare(&pair.truth, &mut random, &mut settings);
        pair.nominal.propulsion.time_constant_s = stated.or(pair.nominal.propulsion.time_constant_s);
    }
    settings.telemetry.share_controller_noise = with.fed_back;
    let trajectory = random.draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let mut effects: Vec<ActiveEffect> = concealed.iter().map(|entry| entry.effect(&pair.truth)).collect();
    effects.extend(concealed.first().and_then(|first| first.companion(&pair.truth)));
    if with.askew {
        effects.push(ActiveEffect::new(&ThrustTilt, &[0.0025, -0.0025]).expect("two parameters"));
    }
    let truth = Truth { vehicle: pair.truth, effects, disturbance: None };
    let flight = simulate_flight(truth, &pair.nominal, &reference, &settings).ok()?;
    let how = ConditionSettings {
        transient_s: Some(1.0),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&flight.recording, &pair.nominal, &how).ok()?;
    explain(&[signals], &pair.nominal, &ExplainSettings::default()).ok()
}
