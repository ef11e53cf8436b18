//! The command at which the vehicle hovers, from what was flown.

use super::flight::Signals;
use super::rotor_thrusts::ThrustSource;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Length of the parts that are left out in turn for the standard error, s. Thrust and force of one manoeuvre are within one.
const PART_S: f64 = 2.0;
/// Least number of such parts.
const LEAST_PARTS: usize = 5;
/// Largest speed of a hover, m/s. Climbing or flying faster takes thrust for the air's forces.
const HOVER_M_S: f64 = 1.5;
/// Relative standard error between flights that hover alike: propellers, air and what a battery gives at one voltage differ by as much. Set by
/// judgement.
const BETWEEN_FLIGHTS: f64 = 0.01;

/// Command of the motors at which their thrust carries the weight, mean over the rotors (0 to 1), and its standard error, from what was flown at
/// less than 1.5 m/s. There the mean of the upward part of the thrust is the weight and what the upward acceleration takes, in wind as well. The
/// acceleration is taken out: a vehicle is slow also where it turns from climb to descent. `None` where no flight has commands, attitude and
/// velocity for ten seconds of this.
#[must_use]
pub fn hover_command(flights: &[Signals], vehicle: &Vehicle) -> Option<(f64, f64)> {
    let rotors = vehicle.rotors.len().max(1) as f64;
    let of = |signals: &Signals| parts(signals, (rotors, vehicle.gravity_m_s2));
    let parts: Vec<f64> = flights.iter().flat_map(of).collect();
    let (share, share_std) = mean(&parts)?;
    let propulsion = &vehicle.propulsion;
    let command = propulsion.command_from_thrust(share * propulsion.full_thrust_n());
    let relative = (share_std / share).hypot(BETWEEN_FLIGHTS);
    (command.is_finite() && command > 0.0).then_some((command, command * relative))
}

/// Of each part of a flight's hover the mean share of full thrust that acts upwards, over what it would be without acceleration.
fn parts(signals: &Signals, (rotors, gravity_m_s2): (f64, f64)) -> Vec<f64> {
    let (Some(attitude), Some(velocity)) = (&signals.attitude, &signals.velocity) else { return Vec::new() };
    if signals.quality.thrust_source != ThrustSource::Command {
        return Vec::new();
    }
    let is_hover = |index: usize| {
        let time_s = signals.grid.time_s(index);
        let flies =
            signals.quality.airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&time_s));
        flies && velocity[index].norm() < HOVER_M_S
    };
    let last = signals.grid.count.saturating_sub(1);
    let upward_m_s2 = |index: usize| {
        let (before, after) = (index.saturating_sub(1), (index + 1).min(last));
        (velocity[after].z - velocity[before].z) / (signals.grid.step_s * (after - before).max(1) as f64)
    };
    let used: Vec<(f64, f64, f64)> = (0..signals.grid.count)
        .filter(|&index| is_hover(index))
        .map(|index| {
            let part = (index as f64 * signals.grid.step_s / PART_S).floor();
            let upwards = (attitude[index] * Vector3::z()).z;
            let share = upwards * signals.wrench[index][0] / (rotors * signals.full_thrust_n);
            (part, share, 1.0 + upward_m_s2(index) / gravity_m_s2)
        })
        .collect();
    let least = (0.5 * PART_S / signals.grid.step_s).max(1.0);
    used.chunk_by(|one, next| (next.0 - one.0).abs() < 0.5)
        .filter(|part| part.len() as f64 >= least)
        .map(|part| part.iter().map(|of| of.1).sum::<f64>() / part.iter().map(|of| of.2).sum::<f64>())
        .collect()
}

/// Mean and its standard error by the scatter.
fn mean(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    if values.len() < LEAST_PARTS || mean.is_nan() || mean <= 0.0 {
        return None;
    }
    let squares: f64 = values.iter().map(|of| (of - mean).powi(2)).sum();
    Some((mean, (squares / (count - 1.0) / count).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_that_of_the_scatter() {
        // 0.05 of scatter over five parts
        let (value, std) = mean(&[0.45, 0.5, 0.55, 0.45, 0.55]).unwrap();
        assert!((value - 0.5).abs() < 1e-12 && (std - 0.05 / 5.0_f64.sqrt()).abs() < 1e-12, "{std}");
        assert_eq!(mean(&[0.5; 4]), None);
        assert_eq!(mean(&[f64::NAN; 5]), None);
    }
}
