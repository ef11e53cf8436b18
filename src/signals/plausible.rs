//! Whether the streams of a flight belong together: units, signs and the order of the rotors.
//!
//! Over a tenth of a second the attitude turns by what the body rates say, and the body rates change with the torque of
//! the rotors. A log whose columns were taken for something else does neither, and what is identified from it is nonsense
//! with small standard errors.

use super::Signals;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Over which turns and torques are compared, s.
const WINDOW_S: f64 = 0.1;
/// Two series that belong together, or one with the wrong sign, are at least so much alike.
const ALIKE: f64 = 0.6;
/// More alike to another than to its own by this much.
const APART: f64 = 0.3;
/// A ratio of rates further from one than this, up or down, is none of noise.
const RATIO: f64 = 2.0;
/// Turning slower than this says nothing, rad/s rms.
const TURNING_RAD_S: f64 = 0.02;
/// Fewer windows say nothing.
const LEAST: usize = 40;

const AXES: [&str; 3] = ["x", "y", "z"];

/// What is to be said of streams that contradict each other.
pub(super) fn check(signals: &Signals, vehicle: &Vehicle) -> Vec<String> {
    let spans = windows(signals);
    if spans.len() < LEAST {
        return Vec::new();
    }
    let units = rates(signals, &spans);
    // torque beside rates that are none says nothing
    if units.is_empty() { torques(signals, vehicle, &spans).into_iter().collect() } else { units }
}

/// First and last instants of the windows that can be used, one after the other.
fn windows(signals: &Signals) -> Vec<(usize, usize)> {
    let mut length = 2;
    while (length as f64 + 0.5) * signals.grid.step_s < WINDOW_S {
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
    for (axis, name) in AXES.iter().enumerate() {
        let (turned, said) = (column(&turned, axis), column(&said, axis));
        let alike = likeness(&turned, &said);
        if rms(&turned) < TURNING_RAD_S || alike.abs() < ALIKE {
            continue;
        }
        let ratio = rms(&said) / rms(&turned);
        if !(1.0 / RATIO..=RATIO).contains(&ratio) {
            out.push(format!(
                "warning: the body rate about {name} is {ratio:.3} times the rate at which the attitude turns: expected both in \
                 rad/s (degrees for radians would be 57.3)"
            ));
        } else if alike < 0.0 {
            out.push(format!(
                "warning: the body rate about {name} has the sign opposite to the attitude's turning: expected both about \
                 forward, left, up"
            ));
        }
    }
    out
}

/// Torque of the rotors against the change of the body rates.
fn torques(signals: &Signals, vehicle: &Vehicle, spans: &[(usize, usize)]) -> Option<String> {
    let rate = signals.rate.as_ref()?;
    let inverse = vehicle.body.inertia_kg_m2.try_inverse()?;
    let changed: Vec<Vector3<f64>> = spans.iter().map(|&(first, last)| rate[last] - rate[first]).collect();
    let driven: Vec<Vector3<f64>> = spans
        .iter()
        .map(|&(first, last)| {
            let wrenches = signals.wrench[first..=last].iter();
            inverse * wrenches.map(|wrench| wrench.fixed_rows::<3>(1).into_owned()).sum::<Vector3<f64>>()
        })
        .collect();
    (0..AXES.len()).find_map(|axis| {
        let changed = column(&changed, axis);
        let alike: Vec<f64> =
            (0..AXES.len()).map(|other| likeness(&changed, &column(&driven, other))).collect();
        let best = (0..AXES.len()).max_by(|&a, &b| alike[a].abs().total_cmp(&alike[b].abs()))?;
        let wrong = alike[best].abs() > ALIKE && alike[best].abs() > alike[axis] + APART;
        wrong.then(|| {
            let sign = if alike[best] < 0.0 { "-" } else { "" };
            format!(
                "warning: the body turns about {} as the rotors' torque about {sign}{} would have it (correlation {:.2}; {:.2} \
                 with that about {}): expected the rotors in the vehicle file's order, at its places and turning its way",
                AXES[axis], AXES[best], alike[best].abs(), alike[axis], AXES[axis]
            )
        })
    })
}

fn column(values: &[Vector3<f64>], axis: usize) -> Vec<f64> {
    values.iter().map(|value| value[axis]).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Correlation; 0 where one of them does not move.
fn likeness(a: &[f64], b: &[f64]) -> f64 {
    let centred = |values: &[f64]| -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        values.iter().map(|value| value - mean).collect()
    };
    let (a, b) = (centred(a), centred(b));
    let product: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let scale = rms(&a) * rms(&b) * a.len() as f64;
    if scale > 0.0 { product / scale } else { 0.0 }
}
