//! Thrust for each mass, from a log: what the accelerometer feels for what the rotors are told.

use crate::recording::{Quantity, Recording};
use crate::signals::{best, thrusts_from_commands};
use crate::units::GRAVITY_M_S2;
use crate::vehicle::Vehicle;

/// Rotors carry the vehicle where their thrust is at least this share of its 90th percentile. Below it the vehicle
/// stands, takes off or falls.
const CARRYING: f64 = 0.5;
/// Samples of rotors that carry the vehicle, from which on a median means something. They are a second at 50 Hz.
const LEAST: usize = 50;
/// Relative standard error: scale and lean of an accelerometer, drag along the rotors' axis, a curve that is not the
/// rotors'.
const RELATIVE: f64 = 0.03;
/// The same without an accelerometer, where the mean acceleration is taken for nought.
const RELATIVE_BLIND: f64 = 0.06;

/// Full thrust of one rotor that a flight shows for a mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FullThrust {
    /// N, one rotor at u = 1
    pub thrust_max_n: f64,
    /// standard error over the value
    pub relative: f64,
    /// an accelerometer felt the thrust
    pub felt: bool,
}

/// Full thrust of one rotor, from the flight itself. `unit` is the vehicle with a full thrust of 1 N. `None` where the log
/// holds no commands in its unit, or no flight.
pub(super) fn full_thrust(recording: &Recording, unit: &Vehicle) -> Option<FullThrust> {
    let thrusts = thrusts_from_commands(recording, unit).ok()?.stream;
    let sums: Vec<f64> = (0..thrusts.len()).map(|index| thrusts.sample(index).iter().sum()).collect();
    let most = percentile(sums.clone(), 0.9)?;
    let carries = |sum: f64| sum > CARRYING * most && sum > 0.0;
    let carrying: Vec<(f64, f64)> =
        thrusts.time_s.iter().copied().zip(sums).filter(|(_, sum)| carries(*sum)).collect();
    if carrying.len() < LEAST {
        return None;
    }
    let (first, last) = (carrying.first()?.0, carrying.last()?.0);
    let sum = percentile(carrying.into_iter().map(|(_, sum)| sum).collect(), 0.5)?;
    let felt =
        best(recording, Quantity::SpecificForce, |stream| stream.width == 3).and_then(|(_, stream)| {
            let inside = (0..stream.len()).filter(|index| (first..=last).contains(&stream.time_s[*index]));
            let along: Vec<f64> =
                inside.map(|index| stream.sample(index)[2]).filter(|z| z.is_finite()).collect();
            if along.len() < LEAST { None } else { percentile(along, 0.5) }
        });
    // an accelerometer of another unit or frame is not believed
    let felt = felt.filter(|along| (0.5 * GRAVITY_M_S2..2.0 * GRAVITY_M_S2).contains(along));
    let per_mass = felt.unwrap_or(unit.gravity_m_s2);
    let relative = if felt.is_some() { RELATIVE } else { RELATIVE_BLIND };
    Some(FullThrust { thrust_max_n: unit.body.mass_kg * per_mass / sum, relative, felt: felt.is_some() })
}

fn percentile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let index = (share * values.len().checked_sub(1)? as f64).round();
    values.iter().enumerate().find(|(place, _)| *place as f64 >= index).map(|(_, value)| *value)
}
