//! The largest values along a path.

use crate::trajectory::{FlightPath, Reference};
use crate::vehicle::Vehicle;

/// Between samples of a path, s: a tenth of the fastest motion that a multirotor follows.
const SAMPLE_S: f64 = 0.01;

/// Largest values along a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(missing_docs, reason = "each name says quantity and unit")]
pub struct Extremes {
    pub horizontal_speed_m_s: f64,
    pub up_speed_m_s: f64,
    pub down_speed_m_s: f64,
    pub horizontal_acceleration_m_s2: f64,
    pub vertical_acceleration_m_s2: f64,
    pub horizontal_jerk_m_s3: f64,
    pub vertical_jerk_m_s3: f64,
    pub tilt_rad: f64,
    pub yaw_rate_rad_s: f64,
    /// least and greatest x, y, z
    pub low_m: [f64; 3],
    pub high_m: [f64; 3],
}

impl Extremes {
    /// The extremes of a whole path.
    #[must_use]
    pub fn of(path: &FlightPath, vehicle: &Vehicle) -> Self {
        let mut out = Self { low_m: [f64::INFINITY; 3], high_m: [f64::NEG_INFINITY; 3], ..Self::default() };
        for (_, entry) in path_samples(path) {
            let [x, y, z, yaw] = entry;
            for (axis, place) in [x, y, z].into_iter().enumerate() {
                out.low_m[axis] = out.low_m[axis].min(place[0]);
                out.high_m[axis] = out.high_m[axis].max(place[0]);
            }
            let horizontal = |order: usize| x[order].hypot(y[order]);
            let motion = Reference::new(entry, vehicle.gravity_m_s2).motion;
            out.horizontal_speed_m_s = out.horizontal_speed_m_s.max(horizontal(1));
            out.up_speed_m_s = out.up_speed_m_s.max(z[1]);
            out.down_speed_m_s = out.down_speed_m_s.max(-z[1]);
            out.horizontal_acceleration_m_s2 = out.horizontal_acceleration_m_s2.max(horizontal(2));
            out.vertical_acceleration_m_s2 = out.vertical_acceleration_m_s2.max(z[2].abs());
            out.horizontal_jerk_m_s3 = out.horizontal_jerk_m_s3.max(horizontal(3));
            out.vertical_jerk_m_s3 = out.vertical_jerk_m_s3.max(z[3].abs());
            let tilt = (motion.roll[0].cos() * motion.pitch[0].cos()).acos();
            out.tilt_rad = out.tilt_rad.max(tilt);
            out.yaw_rate_rad_s = out.yaw_rate_rad_s.max(yaw[1].abs());
        }
        out
    }
}

/// Time (s) and entry (x, y, z in m, yaw in rad, each with four derivatives) at equal steps, first and last instant among
/// them.
pub fn path_samples(path: &FlightPath) -> impl Iterator<Item = (f64, [[f64; 5]; 4])> + '_ {
    let duration_s = path.duration_s();
    let mut step = 0.0;
    let mut done = false;
    std::iter::from_fn(move || {
        if done {
            return None;
        }
        let time_s: f64 = (step * SAMPLE_S).min(duration_s);
        step += 1.0;
        // a path without an end, or of no length, is its first instant
        done = time_s.is_nan() || time_s >= duration_s;
        path.derivatives(time_s).map(|entry| (time_s, entry))
    })
}
