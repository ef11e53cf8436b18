//! Limits for a vehicle file without limits: those of the previous flights, which were safe.

use crate::signals::{Signals, WEAK_HALF_WIDTH_S};
use crate::vehicle::Limits;
use nalgebra::Vector3;

/// Limits of speeds and accelerations over those that were flown. The room and the tilt stay as they were flown. A
/// person agrees to it before it is flown; more would be another flight.
const MORE: f64 = 1.5;

/// The room, speeds, accelerations and angles of the usable parts of flights.
#[must_use]
pub fn flown_limits(flights: &[Signals]) -> Limits {
    let mut most = [0.0_f64; 8];
    let mut height = (f64::INFINITY, f64::NEG_INFINITY);
    for signals in flights {
        // accelerations are averaged over the half width of the weak form's kernel
        let back =
            (1..10_000).find(|n| f64::from(*n) * signals.grid.step_s >= WEAK_HALF_WIDTH_S).unwrap_or(1);
        let back = usize::try_from(back).unwrap_or(1);
        for index in (0..signals.grid.count).filter(|&index| signals.usable[index]) {
            let mut widen = |slot: usize, value: f64| most[slot] = most[slot].max(value.abs());
            if let Some(position) = &signals.position {
                widen(0, position[index].x);
                widen(1, position[index].y);
                height = (height.0.min(position[index].z), height.1.max(position[index].z));
            }
            if let Some(velocity) = &signals.velocity {
                widen(2, velocity[index].amax());
                if let Some(before) = index.checked_sub(back) {
                    let by: Vector3<f64> = velocity[index] - velocity[before];
                    widen(3, by.amax() / WEAK_HALF_WIDTH_S);
                }
            }
            if let Some(attitude) = &signals.attitude {
                let (roll, pitch, yaw) = attitude[index].euler_angles();
                widen(4, roll);
                widen(5, pitch);
                widen(6, yaw);
            }
            if let Some(rate) = &signals.rate {
                widen(7, rate[index].z);
            }
        }
    }
    let positive = |value: f64| (value > 0.0).then_some(value);
    let [x, y, speed, acceleration, roll, pitch, yaw, yaw_rate] = most;
    Limits {
        roll_max_rad: positive(roll),
        pitch_max_rad: positive(pitch),
        yaw_max_rad: positive(yaw.max(0.3)),
        yaw_rate_max_rad_s: positive(MORE * yaw_rate),
        x_max_m: positive(x),
        y_max_m: positive(y),
        z_min_m: height.0.is_finite().then_some(height.0),
        z_max_m: height.1.is_finite().then_some(height.1),
        speed_max_m_s: positive(MORE * speed),
        acceleration_max_m_s2: positive(acceleration),
        ..Limits::default()
    }
}
