//! Tests of the columns of the velocity's slow error.

use super::super::rows::Rows;
use super::super::rows::tests::{turning_on_the_spot, vehicle};
use super::super::signatures::signature_of;
use super::*;
use crate::signals::{Signals, VelocityHeldBy};
use std::sync::Arc;

/// Errors of the vertical velocity at the knots, m/s.
const ERRORS_M_S: [f64; 3] = [0.2, -0.15, 0.1];

/// Rows of a body that turns on the spot, about a base with linear drag, where the measured vertical velocity lacks this.
fn rows(mut signals: Signals, lacks_m_s: impl Fn(f64) -> f64) -> Rows {
    let vehicle = vehicle();
    let mut base = Base::rigid(&vehicle);
    base.effects.push(signature_of("linear_drag").unwrap().term(&[0.4, 0.5, 0.6, 1.0], &[0, 1, 2]));
    let grid = signals.grid;
    let velocities = signals.velocity.iter_mut().flat_map(|series| Arc::make_mut(series).iter_mut());
    for (index, velocity) in velocities.enumerate() {
        velocity.z -= lacks_m_s(grid.time_s(index));
    }
    Rows::new(&[Trace::new(&signals, &vehicle, 0.2).unwrap()], &base).unwrap()
}

/// Drag is linear in the velocity, and so is the kinematic reading: a straight line between knots changes the residual by
/// exactly its columns.
#[test]
fn the_columns_are_what_an_error_brings_into_the_residual() {
    let twice = turning_on_the_spot();
    let by_kinematics = Signals { specific_force: None, ..turning_on_the_spot() };
    let by_accelerometer = Signals { attitude: None, ..turning_on_the_spot() };
    for (signals, first) in [(twice, Some(SECOND)), (by_kinematics, Some(0)), (by_accelerometer, None)] {
        let right = rows(signals.clone(), |_| 0.0);
        let columns: Vec<&NuisanceColumn> =
            right.nuisances.iter().filter(|column| column.nuisance == Nuisance::VelocityError).collect();
        assert_eq!(columns.len(), ERRORS_M_S.len());
        let knots = Knots::of((right.time_s[0], right.time_s[right.len() - 1]), signals.grid.step_s, 1);
        let lacks_m_s =
            |time_s: f64| (0..3).map(|knot| ERRORS_M_S[knot] * knots.hat(knot, time_s)).sum::<f64>();
        let wrong = rows(signals, lacks_m_s);
        let mut by_derivative = 0.0_f64;
        for channel in (0..3).chain(SECOND..SECOND + 3) {
            for row in 0..right.len() {
                let expected: f64 = columns
                    .iter()
                    .zip(ERRORS_M_S)
                    .map(|(column, error_m_s)| error_m_s * column.at(channel, row))
                    .sum();
                let found = wrong.residual[channel][row] - right.residual[channel][row];
                assert!((found - expected).abs() < 1e-9, "channel {channel}: {found}, not {expected}");
                if first == Some(SECOND) && channel >= SECOND {
                    by_derivative =
                        by_derivative.max((expected - sum_at(&columns, channel - SECOND, row)).abs());
                }
            }
        }
        // 1.6 kg times the steepest line, 0.35 m/s in half of the rows' time
        if first == Some(SECOND) {
            let steepest_n = 1.6 * 0.35 / knots.apart_s;
            assert!((by_derivative / steepest_n - 1.0).abs() < 0.05, "{by_derivative}, not {steepest_n}");
        }
    }
}

fn sum_at(columns: &[&NuisanceColumn], channel: usize, row: usize) -> f64 {
    columns.iter().zip(ERRORS_M_S).map(|(column, error)| error * column.at(channel, row)).sum()
}

/// A straight line between two independent knots varies less between them than at them.
#[test]
fn the_error_has_the_stated_root_mean_square() {
    let mean =
        |of: &dyn Fn(f64) -> f64| (0..1000).map(|i| of((f64::from(i) + 0.5) * 1e-3)).sum::<f64>() * 1e-3;
    let between = mean(&|s| (1.0 - s).powi(2) + s * s);
    assert!((between - BETWEEN_KNOTS).abs() < 1e-6);
    for (pose, position, rms_m_s) in [
        (Some(false), false, RMS_M_S),
        (None, true, RMS_BY_POSITION_M_S),
        (Some(true), false, RMS_BY_POSE_M_S),
        (Some(true), true, RMS_BY_POSE_M_S),
    ] {
        let mut signals = turning_on_the_spot();
        signals.quality.velocity_held_by = VelocityHeldBy { pose, position };
        let rows = rows(signals, |_| 0.0);
        let of_knot = rows.nuisances.iter().find(|column| column.nuisance == Nuisance::VelocityError);
        let std_m_s = of_knot.and_then(|column| column.prior_std).unwrap();
        assert!((between.sqrt() * std_m_s / rms_m_s - 1.0).abs() < 1e-6, "{std_m_s}");
    }
}
