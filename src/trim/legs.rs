//! A flight cut into legs of seconds, with the mean balance of each.

use crate::signals::Signals;
use crate::stats::median;
use crate::vehicle::Vehicle;
use nalgebra::{Vector3, Vector4};

/// s of a leg: twenty samples of commands at 10 Hz, and longer than a controller takes to settle. Longer legs are
/// fewer, and shorter ones hold the controller's own motion.
pub const LEG_S: f64 = 2.0;
/// Legs of a flight, from which on its scatter means something. Of fewer the standard deviation itself is known to a
/// third only.
pub const LEAST_LEGS: usize = 6;
/// Components of the balance.
pub const AXES: usize = 3;
/// s after lift-off and before touch-down that are left out. Lift-off is 0.3 m above the ground; at 1 m/s the vehicle is then higher
/// than its own size, beyond the reach of the ground.
const NEAR_GROUND_S: f64 = 1.0;
/// Body rate beyond which a leg shows manoeuvres more than balance, rad/s rms. More would hold what inertia takes
/// instead of what balances.
const MOST_RATE_RAD_S: f64 = 2.0;
/// Thrust of a leg over the median of the flight, within which it counts. Outside of it the vehicle climbs or falls,
/// and the air pushes from below.
const THRUSTS: std::ops::RangeInclusive<f64> = 0.6..=1.6;

/// Means over one leg.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// s, its middle on the vehicle's clock
    pub time_s: f64,
    /// where the commanded thrust acts, along body x and y over the mean arm, and its torque about body z over that of all rotors turning
    /// one way: by the nominal vehicle, shares of the commanded thrust
    pub lean: [f64; AXES],
    /// what the air pushes along body x and y, over the weight: tilt less acceleration
    pub felt: [f64; 2],
    /// angular acceleration that goes with each component of [`Self::lean`], about body y, x and z, rad/s^2
    pub turning: [f64; AXES],
    /// mean body rate about the same axes, rad/s
    pub rate: [f64; AXES],
    /// each rotor's share of the commanded thrust
    pub shares: Vec<f64>,
    /// specific thrust over g that full commands would give
    pub lift: Option<f64>,
    /// V
    pub voltage_v: Option<f64>,
}

/// Why a flight shows no balance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrimError {
    /// commands or attitude are missing
    #[error("expected {0} in the log, got none: without it a flight shows no balance")]
    Lacks(&'static str),
    /// too little flight
    #[error(
        "expected at least {needed} legs of {LEG_S} s in the air between lift-off and touch-down, got {found}"
    )]
    TooShort {
        /// legs that can be used
        found: usize,
        /// legs needed
        needed: usize,
    },
}

/// The legs of a flight, in order. Thrusts are those of the vehicle's law.
///
/// # Errors
/// [`TrimError`] where the flight lacks thrusts or attitude, or is too short.
pub fn legs(signals: &Signals, vehicle: &Vehicle) -> Result<Vec<Leg>, TrimError> {
    let rotors = vehicle.rotors.len();
    if signals.rotor_thrust_n.is_empty() {
        return Err(TrimError::Lacks("a command of each motor"));
    }
    let attitude = signals.attitude.as_ref().ok_or(TrimError::Lacks("an attitude"))?;
    let long = (0..).take_while(|count| (f64::from(*count) + 0.5) * signals.grid.step_s <= LEG_S).count();
    let scale = Scale::of(vehicle);
    let mut found: Vec<(f64, Leg)> = Vec::new();
    let mut from = 0;
    while from + long < signals.grid.count {
        let (start_s, end_s) = (signals.grid.time_s(from), signals.grid.time_s(from + long));
        let flies = |&(lifts_s, lands_s): &(f64, f64)| {
            start_s >= lifts_s + NEAR_GROUND_S && end_s <= lands_s - NEAR_GROUND_S
        };
        if !signals.quality.airborne_s.iter().any(flies) {
            from += 1 + long / 8;
            continue;
        }
        let span = from..from + long;
        let rate = signals.rate.as_ref();
        let calm = rate.is_none_or(|rate| {
            let squares: f64 = rate[span.clone()].iter().map(Vector3::norm_squared).sum();
            squares / long as f64 <= MOST_RATE_RAD_S * MOST_RATE_RAD_S
        });
        if calm {
            found.extend(leg((signals, attitude), span, (rotors, &scale)));
        }
        from += long;
    }
    let usual = median(&mut found.iter().map(|(thrust_n, _)| *thrust_n).collect::<Vec<_>>());
    found.retain(|(thrust_n, _)| THRUSTS.contains(&(thrust_n / usual)));
    if found.len() < LEAST_LEGS {
        return Err(TrimError::TooShort { found: found.len(), needed: LEAST_LEGS });
    }
    Ok(found.into_iter().map(|(_, leg)| leg).collect())
}

/// Lengths of the nominal vehicle.
#[derive(Debug, Clone, Copy)]
struct Scale {
    arm_m: f64,
    torque_per_thrust_m: f64,
    gravity_m_s2: f64,
}

impl Scale {
    fn of(vehicle: &Vehicle) -> Self {
        Self {
            arm_m: mean_arm_m(vehicle),
            torque_per_thrust_m: vehicle.propulsion.torque_per_thrust_m,
            gravity_m_s2: vehicle.gravity_m_s2,
        }
    }
}

/// Mean distance of the rotors from the centre of mass, m.
#[must_use]
pub fn mean_arm_m(vehicle: &Vehicle) -> f64 {
    let arm = |rotor: &crate::vehicle::Rotor| (rotor.position_m - vehicle.body.center_of_mass_m).xy().norm();
    vehicle.rotors.iter().map(arm).sum::<f64>() / vehicle.rotors.len() as f64
}

/// One leg with its mean thrust, N.
fn leg(
    (signals, attitude): (&Signals, &[nalgebra::UnitQuaternion<f64>]),
    span: std::ops::Range<usize>,
    (rotors, scale): (usize, &Scale),
) -> Option<(f64, Leg)> {
    let count = span.len() as f64;
    let wrench = signals.wrench[span.clone()].iter().sum::<Vector4<f64>>() / count;
    let thrust_n = wrench[0];
    let up =
        attitude[span.clone()].iter().map(|to_world| to_world.inverse() * Vector3::z()).sum::<Vector3<f64>>();
    let change =
        |series: &[Vector3<f64>]| (series[span.end] - series[span.start]) / (count * signals.grid.step_s);
    // the vehicle may turn during a leg
    let in_body = |velocity: &[Vector3<f64>]| {
        let steps =
            span.clone().map(|index| attitude[index].inverse() * (velocity[index + 1] - velocity[index]));
        steps.sum::<Vector3<f64>>() / (count * signals.grid.step_s)
    };
    let accelerated = signals.velocity.as_ref().map_or_else(Vector3::zeros, |velocity| in_body(velocity));
    let specific = up / count + accelerated / scale.gravity_m_s2;
    let turning = signals.rate.as_ref().map_or_else(Vector3::zeros, |rate| change(rate));
    let rates = |rate: &[Vector3<f64>]| rate[span.clone()].iter().sum::<Vector3<f64>>() / count;
    let rate = signals.rate.as_ref().map_or_else(Vector3::zeros, |rate| rates(rate));
    let of_rotor = |rotor: usize| -> f64 {
        span.clone().map(|index| signals.rotor_thrust_n[index * rotors + rotor]).sum::<f64>() / count
    };
    let lean = [
        -wrench[2] / thrust_n / scale.arm_m,
        wrench[1] / thrust_n / scale.arm_m,
        wrench[3] / thrust_n / scale.torque_per_thrust_m,
    ];
    let voltage = signals.battery_voltage_v.as_ref();
    let voltage_v = voltage.map(|voltage| voltage[span.clone()].iter().sum::<f64>() / count);
    let of_full = thrust_n / (rotors as f64 * signals.full_thrust_n);
    let leg = Leg {
        time_s: signals.grid.time_s(usize::midpoint(span.start, span.end)),
        lean,
        felt: [specific.x, specific.y],
        turning: [turning.y, turning.x, turning.z],
        rate: [rate.y, rate.x, rate.z],
        shares: (0..rotors).map(|rotor| of_rotor(rotor) / thrust_n).collect(),
        lift: signals.velocity.as_ref().map(|_| specific.z / of_full).filter(|lift| lift.is_finite()),
        voltage_v: voltage_v.filter(|voltage| voltage.is_finite()),
    };
    let whole = thrust_n > 0.0
        && lean.iter().chain(&leg.felt).chain(&leg.turning).chain(&leg.rate).all(|value| value.is_finite());
    whole.then_some((thrust_n, leg))
}
