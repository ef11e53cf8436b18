//! Checks that the streams of a flight belong together: units, signs and the order of the rotors.
//!
//! Over a tenth of a second, the rotation of the attitude follows from the body rates, and the change of the body rates
//! follows from the torque of the rotors. In a log with wrongly mapped columns neither is true, and an identification
//! from it is meaningless but has small standard errors.

use super::Signals;
use crate::note::{About, Note};
use crate::vehicle::{AXIS_NAMES, Vehicle};
use nalgebra::{DMatrix, DVector, Vector3, Vector4};

/// Time over which rotations and torques are compared, s. Shorter windows hold the noise of differences, longer ones
/// average the motion away.
const WINDOW_S: f64 = 0.1;
/// Time over which changes of position are compared with the velocity, s. Over shorter ones a position shows its resolution.
const TRAVEL_S: f64 = 1.0;
/// Least number of such windows. They overlap by half, so five are apart.
const LEAST_TRAVELS: usize = 10;
/// Least rms of such a change that is compared, m. A receiver's position wanders by less in a second.
const TRAVELLED_M: f64 = 0.05;
/// Least rms of the change of a velocity over that time that is compared with the measured acceleration, m/s. A receiver's velocity is
/// noisier than this only where it says nothing.
const SPED_UP_M_S: f64 = 0.1;
/// Largest ratio of such changes, or its inverse, that noise and the low-pass of an estimator can explain: 2.2 in one simulated flight. Feet
/// are a factor of 3.3, kilometres an hour one of 3.6.
const OTHER_UNIT: f64 = 3.0;
/// Least absolute correlation of two series that belong together, or of one with the wrong sign. Only a flight with
/// little noise tells signs and order; with a smaller one a sound log could be contradicted.
const ALIKE: f64 = 0.6;
/// Difference of correlations from which a series belongs to another one. With a smaller difference two columns of
/// one frame could be exchanged by noise.
const APART: f64 = 0.3;
/// Largest ratio of two rates, or its inverse, that noise can explain. A wrong unit is a factor of 9.8 or 57.
const RATIO: f64 = 2.0;
/// Largest ratio of mean thrust to weight, or its inverse. A wrong thrust curve is within it, a wrong unit is not.
const CARRIED: f64 = 1.5;
/// Least part of the torque about roll that turns the vehicle about pitch, or of that about pitch about roll, where rotors are told to be turned
/// about the vertical: 12 degrees. A rotor that gives half of its thrust mixes 0.13 of them, also where no noise hides it.
const TURNED: f64 = 0.2;
/// Least share of a torque's energy that other columns do not explain. With less, the column is told by what
/// resembles it.
const SEEN: f64 = 0.05;
/// Least share of the change's amplitude that must remain. With less, the change is within what sampling does to it.
const LEFT: f64 = 0.3;
/// Least rotation for a comparison, rad/s rms. Gyroscopes at rest have as much noise.
const TURNING_RAD_S: f64 = 0.02;
/// Least number of windows. They are 4 s; a correlation of fewer is chance.
const LEAST: usize = 40;

/// Notes on streams that contradict each other.
pub(super) fn check(signals: &Signals, vehicle: &Vehicle) -> Vec<Note> {
    let spans = windows(signals, WINDOW_S);
    if spans.len() < LEAST {
        return Vec::new();
    }
    let mut units = rates(signals, &spans);
    units.extend(forces(signals, vehicle.gravity_m_s2, &spans));
    // torque beside rates that are none says nothing
    if units.is_empty() {
        units.extend(torques(signals, vehicle, &spans));
    }
    units.extend(velocities(signals));
    units.extend(positions(signals));
    units.into_iter().map(|text| Note::warning(About::Contradiction, text)).collect()
}

/// First and last instants of the usable windows, in order.
fn windows(signals: &Signals, window_s: f64) -> Vec<(usize, usize)> {
    let mut length = 2;
    while (length as f64 + 0.5) * signals.grid.step_s < window_s {
        length += 1;
    }
    (0..signals.usable.len().saturating_sub(length))
        .step_by((length / 2).max(1))
        .map(|first| (first, first + length))
        .filter(|&(first, last)| signals.usable[first..=last].iter().all(|usable| *usable))
        .collect()
}

fn mean(values: &[Vector3<f64>]) -> Vector3<f64> {
    values.iter().sum::<Vector3<f64>>() / values.len().max(1) as f64
}

/// Body rates against the attitude's turning.
fn rates(signals: &Signals, spans: &[(usize, usize)]) -> Vec<String> {
    let (Some(attitude), Some(rate)) = (&signals.attitude, &signals.rate) else { return Vec::new() };
    let span_s = |(first, last): (usize, usize)| (last - first) as f64 * signals.grid.step_s;
    let turned: Vec<Vector3<f64>> = spans
        .iter()
        .map(|&(first, last)| {
            (attitude[first].inverse() * attitude[last]).scaled_axis() / span_s((first, last))
        })
        .collect();
    let said: Vec<Vector3<f64>> = spans.iter().map(|&(first, last)| mean(&rate[first..=last])).collect();
    let mut out = Vec::new();
    for (axis, name) in AXIS_NAMES.iter().enumerate() {
        let (turned, said) = (column(&turned, axis), column(&said, axis));
        let alike = likeness(&turned, &said);
        if rms(&turned) < TURNING_RAD_S || alike.abs() < ALIKE {
            continue;
        }
        // a gyroscope's bias is no scale
        let ratio = rms(&centred(&said)) / rms(&centred(&turned));
        if !(1.0 / RATIO..=RATIO).contains(&ratio) {
            out.push(format!(
                "the body rate about {name} is {ratio:.3} times the rate at which the attitude turns: expected both in \
                 rad/s (degrees for radians would be 57.3)"
            ));
        } else if alike < 0.0 {
            out.push(format!(
                "the body rate about {name} has the sign opposite to the attitude's turning: expected both about \
                 forward, left, up"
            ));
        }
    }
    out
}

/// The accelerometer against gravity, and the change of velocity against the accelerometer.
fn forces(signals: &Signals, gravity_m_s2: f64, spans: &[(usize, usize)]) -> Vec<String> {
    let (Some(attitude), Some(specific_force)) = (&signals.attitude, &signals.specific_force) else {
        return Vec::new();
    };
    let force = |index: usize| attitude[index] * specific_force[index];
    let felt: Vec<Vector3<f64>> = spans
        .iter()
        .map(|&(first, last)| (first..=last).map(force).sum::<Vector3<f64>>() / (1 + last - first) as f64)
        .collect();
    let up = mean(&felt).z / gravity_m_s2;
    // sums of what flies are near the weight
    if !(1.0 / CARRIED..=CARRIED).contains(&up) {
        return vec![format!(
            "the accelerometer shows {up:.2} times gravity upwards in the mean of the flight: expected about one, in m/s^2, \
             about forward, left, up, with an attitude that turns these into north, west, up"
        )];
    }
    let Some(velocity) = &signals.velocity else { return Vec::new() };
    let changed: Vec<Vector3<f64>> =
        spans.iter().map(|&(first, last)| velocity[last] - velocity[first]).collect();
    ["north", "west", "up"]
        .iter()
        .enumerate()
        .filter(|(axis, _)| likeness(&column(&changed, *axis), &column(&felt, *axis)) < -ALIKE)
        .map(|(_, name)| {
            format!(
                "the velocity {name} changes in the opposite direction of the measured acceleration: expected both in \
                 north, west, up once \
                 the attitude has turned the accelerometer's"
            )
        })
        .collect()
}

/// Changes of the velocity against the measured acceleration. Velocity and position that are both in another unit agree with each other.
fn velocities(signals: &Signals) -> Vec<String> {
    let (Some(attitude), Some(specific_force), Some(velocity)) =
        (&signals.attitude, &signals.specific_force, &signals.velocity)
    else {
        return Vec::new();
    };
    let spans = windows(signals, TRAVEL_S);
    let changed: Vec<Vector3<f64>> =
        spans.iter().map(|&(first, last)| velocity[last] - velocity[first]).collect();
    let felt: Vec<Vector3<f64>> = spans
        .iter()
        .map(|&(first, last)| {
            let sum: Vector3<f64> = (first..last).map(|index| attitude[index] * specific_force[index]).sum();
            sum * signals.grid.step_s
        })
        .collect();
    let one = |(axis, name): (usize, &&str)| {
        let ratio = other_scale(&column(&changed, axis), &column(&felt, axis))?;
        Some(format!(
            "the velocity {name} changes by {ratio:.3} times what the accelerometer says: expected velocities in m/s and accelerations in \
             m/s^2"
        ))
    };
    ["north", "west", "up"].iter().enumerate().filter_map(one).collect()
}

/// Ratio of changes of a velocity to those that the acceleration gives, m/s, where both are alike and on scales that differ by more than
/// noise explains. Gravity and a bias are in the mean.
fn other_scale(changed: &[f64], felt: &[f64]) -> Option<f64> {
    let (changed, felt) = (centred(changed), centred(felt));
    let ratio = rms(&changed) / rms(&felt);
    let tells = changed.len() >= LEAST_TRAVELS
        && rms(&changed).max(rms(&felt)) > SPED_UP_M_S
        && likeness(&changed, &felt) > ALIKE;
    (tells && !(1.0 / OTHER_UNIT..=OTHER_UNIT).contains(&ratio)).then_some(ratio)
}

/// Whether position and velocity are in units and axes that agree, as far as the flight tells.
pub(super) fn position_agrees(signals: &Signals) -> bool {
    positions(signals).is_empty()
}

/// Changes of the position against the velocity.
fn positions(signals: &Signals) -> Vec<String> {
    let (Some(position), Some(velocity)) = (&signals.position, &signals.velocity) else { return Vec::new() };
    let spans = windows(signals, TRAVEL_S);
    let changed: Vec<Vector3<f64>> =
        spans.iter().map(|&(first, last)| position[last] - position[first]).collect();
    let travelled: Vec<Vector3<f64>> = spans
        .iter()
        .map(|&(first, last)| mean(&velocity[first..=last]) * ((last - first) as f64 * signals.grid.step_s))
        .collect();
    let mut out = Vec::new();
    for (axis, name) in ["north", "west", "up"].iter().enumerate() {
        // a climb rate has a bias
        let (changed, travelled) = (centred(&column(&changed, axis)), centred(&column(&travelled, axis)));
        let alike = likeness(&changed, &travelled);
        // what is alike to this degree and on one scale has no other ratio
        let ratio = rms(&changed) / rms(&travelled);
        if spans.len() < LEAST_TRAVELS
            || rms(&changed).max(rms(&travelled)) < TRAVELLED_M
            || alike.abs() < ALIKE
        {
            continue;
        }
        if !(1.0 / RATIO..=RATIO).contains(&ratio) {
            out.push(format!(
                "the position {name} changes by {ratio:.3} times what the velocity says: expected positions in m and velocities in m/s"
            ));
        } else if alike < 0.0 {
            out.push(format!(
                "the position {name} changes in the opposite direction of the velocity: expected both in north, west, up"
            ));
        }
    }
    out
}

/// Torque of the rotors about each axis against the change of the body rates, with columns for the aerodynamic torques
/// of velocity, rates and a steady wind, and for the thrust. Without the first, on a circle a hub moment would look like the torque of
/// another axis; without the others, drag at the hubs in wind and a centre of mass that is off would.
fn torques(signals: &Signals, vehicle: &Vehicle, spans: &[(usize, usize)]) -> Option<String> {
    let (rate, velocity, attitude) =
        (signals.rate.as_ref()?, signals.velocity.as_ref()?, signals.attitude.as_ref()?);
    let inverse = vehicle.body.inertia_kg_m2.try_inverse()?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); 12];
    let mut changed: Vec<Vector3<f64>> = Vec::with_capacity(spans.len());
    for &(first, last) in spans {
        let wrench = signals.wrench[first..=last].iter().sum::<Vector4<f64>>();
        let torque = wrench.fixed_rows::<3>(1).into_owned();
        let middle = (first + last) / 2;
        let through_air = attitude[middle].inverse_transform_vector(&velocity[middle]);
        let parts = [inverse * torque * signals.grid.step_s, through_air, mean(&rate[first..=last])];
        // what a steady wind pushes goes with the heading
        let north = attitude[middle].inverse_transform_vector(&Vector3::x());
        let values = parts.iter().flat_map(Vector3::iter).copied().chain([wrench[0], north.x, north.y]);
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        changed.push(rate[last] - rate[first]);
    }
    let columns: Vec<DVector<f64>> =
        columns.iter().map(|column| DVector::from_vec(centred(column))).collect();
    (0..AXIS_NAMES.len()).find_map(|axis| {
        let changed = DVector::from_vec(centred(&column(&changed, axis)));
        let parts = alone(&columns, &changed)?;
        let (other, beside) = other_torque(&parts, axis)?;
        let (too, expected) = if beside {
            (" as well", "at the vehicle file's places, not turned about the vertical")
        } else {
            ("", "in the vehicle file's order, at its places and turning its way")
        };
        let sign = if parts[other].alike < 0.0 { "-" } else { "" };
        Some(format!(
            "the body turns about {} as if by the rotors' torque about {sign}{}{too} (partial correlation {:.2}; {:.2} with that about {}): \
             expected the rotors {expected}",
            AXIS_NAMES[axis], AXIS_NAMES[other], parts[other].alike.abs(), parts[axis].alike, AXIS_NAMES[axis]
        ))
    })
}

/// The axis about which the rotors' torque turns the body about `axis` in place of their torque about that, or (true) beside it: rotors that
/// are turned about the vertical exchange a part of roll and pitch. A weak rotor mixes all three torques as well, by less of those two.
fn other_torque(parts: &[Part; 3], axis: usize) -> Option<(usize, bool)> {
    let best = (0..parts.len()).max_by(|&a, &b| parts[a].alike.abs().total_cmp(&parts[b].alike.abs()))?;
    if parts[best].alike.abs() > ALIKE && parts[best].alike.abs() > parts[axis].alike + APART {
        return Some((best, false));
    }
    let beside = [1, 0].get(axis).copied()?;
    let is_turned =
        parts[beside].alike.abs() > ALIKE && parts[beside].size.abs() > TURNED * parts[axis].size.abs();
    is_turned.then_some((beside, true))
}

/// The part of a column in values, without that of all other columns; none of a column that the others explain almost completely.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    /// partial correlation
    alike: f64,
    /// how often the column is in the values
    size: f64,
}

/// The part of each of the first three columns in `values`. `None` if the system cannot be solved.
fn alone(columns: &[DVector<f64>], values: &DVector<f64>) -> Option<[Part; 3]> {
    let mut out = [Part::default(); 3];
    for (index, part) in out.iter_mut().enumerate() {
        let others: Vec<DVector<f64>> = columns
            .iter()
            .enumerate()
            .filter(|(other, column)| *other != index && column.norm() > 0.0)
            .map(|(_, column)| column.normalize())
            .collect();
        let others = DMatrix::from_columns(&others).svd(true, false).u?;
        let out_of = |of: &DVector<f64>| of - &others * others.tr_mul(of);
        let (own, left) = (out_of(&columns[index]), out_of(values));
        let seen = own.norm_squared() > SEEN * columns[index].norm_squared();
        // what the others leave of the change itself is little where they account for it
        let scale = own.norm() * left.norm().max(LEFT * values.norm());
        if seen && scale > 0.0 {
            *part = Part { alike: own.dot(&left) / scale, size: own.dot(&left) / own.norm_squared() };
        }
    }
    Some(out)
}

fn column(values: &[Vector3<f64>], axis: usize) -> Vec<f64> {
    values.iter().map(|value| value[axis]).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Correlation; 0 if one of them is constant.
fn likeness(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (centred(a), centred(b));
    let product: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let scale = rms(&a) * rms(&b) * a.len() as f64;
    if scale > 0.0 { product / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotors_turned_about_the_vertical_are_told_and_what_a_weak_rotor_mixes_is_not() {
        let parts = |of: [(f64, f64); 3]| of.map(|(alike, size)| Part { alike, size });
        // motor 1 at 0.93: a part of yaw torque and of pitch in roll, which no noise hides
        let weak = parts([(0.98, 0.97), (0.70, 0.017), (-0.90, -0.3)]);
        assert_eq!(other_torque(&weak, 0), None);
        // by 30 degrees
        let turned = parts([(0.95, 0.87), (-0.85, -0.5), (0.1, 0.02)]);
        assert_eq!(other_torque(&turned, 0), Some((1, true)));
        assert_eq!(other_torque(&parts([(0.8, 0.5), (0.9, 0.87), (0.0, 0.0)]), 1), Some((0, true)));
        // about the vertical there is nothing to exchange
        assert_eq!(other_torque(&parts([(0.7, 0.1), (0.0, 0.0), (0.9, 1.0)]), 2), None);
        // in place of its own
        let exchanged = parts([(0.1, 0.1), (0.9, 1.0), (0.0, 0.0)]);
        assert_eq!(other_torque(&exchanged, 0), Some((1, false)));
        assert_eq!(other_torque(&parts([(-0.9, -1.0), (0.0, 0.0), (0.0, 0.0)]), 0), Some((0, false)));
    }

    #[test]
    fn the_part_of_a_column_is_told_beside_its_correlation() {
        let wave = |rate: f64| DVector::from_iterator(60, (0..60).map(|i| (rate * f64::from(i)).sin()));
        let columns = [wave(0.31), wave(0.47), wave(0.83)];
        let [own, beside, none] = alone(&columns, &(&columns[0] + 0.05 * &columns[1])).unwrap();
        // without noise a small part is as alike as it can be, but for what sampling does
        assert!((own.size - 1.0).abs() < 1e-9 && (beside.size - 0.05).abs() < 1e-9, "{own:?} {beside:?}");
        assert!(
            own.alike > 0.9 && beside.alike > 0.05 && none.size.abs() < 1e-9,
            "{own:?} {beside:?} {none:?}"
        );
    }

    #[test]
    fn a_velocity_in_another_unit_is_told_by_the_acceleration() {
        // with gravity in the mean of what is felt
        let felt: Vec<f64> = (0..20).map(|i| f64::from(i).sin() + 9.8).collect();
        let times = |factor: f64| -> Vec<f64> { felt.iter().map(|of| factor * (of - 9.8)).collect() };
        assert_eq!(other_scale(&times(1.0), &felt), None);
        assert_eq!(other_scale(&times(2.5), &felt), None);
        let ratio = other_scale(&times(100.0), &felt).unwrap();
        assert!((ratio - 100.0).abs() < 1e-9, "{ratio}");
        // nothing alike, too few, or hardly any motion
        assert_eq!(
            other_scale(&(0..20).map(|i| 100.0 * (2.7 * f64::from(i)).cos()).collect::<Vec<_>>(), &felt),
            None
        );
        assert_eq!(other_scale(&times(100.0)[..5], &felt[..5]), None);
        assert_eq!(other_scale(&times(0.02), &times(0.001)), None);
    }
}
