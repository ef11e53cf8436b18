//! The command at which the vehicle hovers, from what was flown.

use super::flight::Signals;
use super::rotor_thrusts::ThrustSource;
use crate::vehicle::{Guessed, Vehicle};

/// Length of the parts that are left out in turn for the standard error, s. Thrust and force of one manoeuvre are within one.
const PART_S: f64 = 2.0;
/// Least number of such parts.
const LEAST_PARTS: usize = 5;
/// Relative standard error between flights that hover alike: propellers, air and what a battery gives at one voltage differ by as much. Set by
/// judgement.
const BETWEEN_FLIGHTS: f64 = 0.01;

/// Command of the motors at which their thrust is the weight, mean over the rotors (0 to 1), and its standard error. The thrust for the
/// commands flown is brought from the mean force along body z to the weight. `None` where no flight has commands and an accelerometer for
/// ten seconds.
#[must_use]
pub fn hover_command(flights: &[Signals], vehicle: &Vehicle) -> Option<(f64, f64)> {
    let full_n = vehicle.propulsion.full_thrust_n();
    let rotors = vehicle.rotors.len().max(1) as f64;
    let parts: Vec<(f64, f64)> = flights.iter().flat_map(|signals| parts(signals, rotors)).collect();
    let (ratio, ratio_std) = ratio(&parts)?;
    let share = ratio * vehicle.gravity_m_s2;
    let command = vehicle.propulsion.command_from_thrust(share * full_n);
    // another curve through the mean of what was flown meets the weight elsewhere
    let beyond =
        parts.iter().map(|(_, force)| force).sum::<f64>() / parts.len() as f64 / vehicle.gravity_m_s2 - 1.0;
    let by_curve = vehicle.guessed(Guessed::Expo) * (1.0 - command) * beyond.abs();
    let relative = (ratio_std / ratio).hypot(by_curve).hypot(BETWEEN_FLIGHTS);
    (command.is_finite() && command > 0.0).then_some((command, command * relative))
}

/// Of each part of a flight the mean share of full thrust and specific force along body z, m/s^2.
fn parts(signals: &Signals, rotors: f64) -> Vec<(f64, f64)> {
    let Some(force) = &signals.specific_force else { return Vec::new() };
    if signals.quality.thrust_source != ThrustSource::Command {
        return Vec::new();
    }
    let part = |index: usize| (index as f64 * signals.grid.step_s / PART_S).floor();
    let used: Vec<(f64, f64, f64)> = (0..signals.usable.len())
        .filter(|&index| signals.usable[index])
        .map(|index| {
            (part(index), signals.wrench[index][0] / (rotors * signals.full_thrust_n), force[index].z)
        })
        .collect();
    let mean = |part: &[(f64, f64, f64)]| {
        let count = part.len() as f64;
        (part.iter().map(|of| of.1).sum::<f64>() / count, part.iter().map(|of| of.2).sum::<f64>() / count)
    };
    used.chunk_by(|one, next| (next.0 - one.0).abs() < 0.5).map(mean).collect()
}

/// Sum of the first over sum of the second of each pair, and its standard error by leaving each pair out in turn (jackknife, Quenouille 1956).
fn ratio(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = pairs.len() as f64;
    let (first, second) = pairs.iter().fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1));
    if pairs.len() < LEAST_PARTS || first <= 0.0 || second <= 0.0 {
        return None;
    }
    let without: Vec<f64> = pairs.iter().map(|of| (first - of.0) / (second - of.1)).collect();
    let mean = without.iter().sum::<f64>() / count;
    let squares: f64 = without.iter().map(|of| (of - mean).powi(2)).sum();
    Some((first / second, ((count - 1.0) / count * squares).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_is_that_of_the_sums_and_its_error_that_of_the_scatter() {
        // thrust in proportion to the force: nothing scatters
        let exact: Vec<(f64, f64)> = [9.0, 10.0, 11.0, 9.5, 10.5].map(|force| (0.05 * force, force)).to_vec();
        let (value, std) = ratio(&exact).unwrap();
        assert!((value - 0.05).abs() < 1e-12 && std < 1e-12);
        // forces all alike: the mean of five shares, and its standard error 0.05 / sqrt(5) of a scatter of 0.05
        let shares = [0.45, 0.5, 0.55, 0.45, 0.55];
        let (value, std) = ratio(&shares.map(|share| (share, 10.0))).unwrap();
        assert!((value - 0.05).abs() < 1e-12 && (std - 0.005 / 5.0_f64.sqrt()).abs() < 1e-12, "{std}");
        assert_eq!(ratio(&exact[..4]), None);
    }
}
