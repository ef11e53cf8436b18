//! From the values of fields to a sample: frames, units, and what a field says that it is not.

use crate::autopilot::{PX4, px4_mode_of_state};
use crate::frames::{attitude_from_frd_ned, body_from_frd, yaw_from_ned};
use crate::units::{rad_s_from_rpm, seconds_from_us, whole, whole_unsigned};

/// Numbers that one sample is made of, at most: two of each of 16 channels, and what all have in common.
pub(super) const MOST_CELLS: usize = 36;

/// How values become a sample.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    /// a vector by half a turn about its first axis: body axes forward, right, down to forward, left, up; and those of the world
    /// north, east, down to north, west, up
    HalfTurn,
    /// turns the first so many values, in place, into a sample; how many values it has, 0 for none. There is room for four at least
    By(fn(&mut [f64], usize) -> usize),
}

impl Turn {
    #[inline]
    pub(super) fn turn(self, values: &mut [f64], count: usize) -> usize {
        match self {
            Self::HalfTurn => put(values, half_turn(triple(values))),
            Self::By(turn) => turn(values, count),
        }
    }
}

/// See [`Turn::HalfTurn`].
#[inline]
pub(super) fn half_turn(vector: [f64; 3]) -> [f64; 3] {
    body_from_frd(vector).0.into()
}

/// `vehicle_status.arming_state` of an armed vehicle.
const ARMED: f64 = 2.0;
/// MAV_LANDED_STATE: on the ground, in the air.
const LANDED_STATES: [f64; 2] = [1.0, 2.0];

fn put<const N: usize>(values: &mut [f64], sample: [f64; N]) -> usize {
    values[..N].copy_from_slice(&sample);
    N
}

fn triple(values: &[f64]) -> [f64; 3] {
    [values[0], values[1], values[2]]
}

/// As it is.
pub(super) fn same(_: &mut [f64], count: usize) -> usize {
    count
}

/// A body vector summed over a time, the fourth value, microseconds: its mean.
pub(super) fn body_over_time(values: &mut [f64], _: usize) -> usize {
    let over_s = seconds_from_us(values[3]);
    if over_s <= 0.0 {
        return 0;
    }
    put(values, body_from_frd(triple(values).map(|sum| sum / over_s)).0.into())
}

/// Quaternion, FRD to NED.
pub(super) fn attitude(values: &mut [f64], _: usize) -> usize {
    let wxyz = [values[0], values[1], values[2], values[3]];
    attitude_from_frd_ned(wxyz).map_or(0, |attitude| {
        let q = attitude.0.quaternion();
        put(values, [q.w, q.i, q.j, q.k])
    })
}

/// An angle or a rate about down to one about up.
pub(super) fn yaw(values: &mut [f64], _: usize) -> usize {
    put(values, [yaw_from_ned(values[0])])
}

/// A force along down to one along up.
pub(super) fn upward(values: &mut [f64], _: usize) -> usize {
    put(values, [-values[0]])
}

/// A collective thrust to a force along up.
pub(super) fn thrust(values: &mut [f64], _: usize) -> usize {
    put(values, [0.0, 0.0, values[0]])
}

/// Channels up to the last one that has a value.
pub(super) fn channels(values: &mut [f64], count: usize) -> usize {
    values[..count].iter().rposition(|value| value.is_finite()).map_or(0, |last| last + 1)
}

/// The number of outputs, and the outputs; up to the last one that puts something out.
pub(super) fn outputs(values: &mut [f64], count: usize) -> usize {
    let used = limited(values[0], count - 1);
    values.rotate_left(1);
    values[..used].iter().rposition(|value| *value != 0.0).map_or(used.min(1), |last| last + 1)
}

/// The number of speed controllers, and their speeds, rpm.
pub(super) fn speeds(values: &mut [f64], count: usize) -> usize {
    let used = limited(values[0], count - 1);
    values.rotate_left(1);
    values[..used].iter_mut().for_each(|rpm| *rpm = rad_s_from_rpm(*rpm));
    used
}

/// The number of speed controllers, which of them answer (one bit each), their speeds, rpm, and which output each drives: a
/// motor's speed where the motor is, NaN where none answers.
pub(super) fn speeds_by_motor(values: &mut [f64], count: usize) -> usize {
    let (used, online) = (limited(values[0], (count - 2) / 2), whole_unsigned(values[1]));
    let (speeds, functions) = values[2..count].split_at((count - 2) / 2);
    let mut by_motor = [f64::NAN; MOST_CELLS];
    let mut motors = 0;
    let is_told = functions[..used].iter().any(|function| PX4.outputs.is_motor(*function));
    for index in 0..used {
        let motor = match is_told {
            true if PX4.outputs.is_motor(functions[index]) => {
                whole_index(functions[index] - PX4.outputs.motor(0))
            }
            true => continue,
            false => index,
        };
        if motor < MOST_CELLS && online >> index & 1 == 1 {
            by_motor[motor] = rad_s_from_rpm(speeds[index]);
            motors = motors.max(motor + 1);
        }
    }
    let motors = motors.min(values.len());
    values[..motors].copy_from_slice(&by_motor[..motors]);
    motors
}

/// A battery that is not there measures nothing.
pub(super) fn positive(values: &mut [f64], _: usize) -> usize {
    usize::from(values[0] > 0.0)
}

/// A current that is not known is below zero.
pub(super) fn not_negative(values: &mut [f64], _: usize) -> usize {
    usize::from(values[0] >= 0.0)
}

/// `arming_state` to armed or not.
pub(super) fn armed(values: &mut [f64], _: usize) -> usize {
    put(values, [if values[0] == ARMED { 1.0 } else { 0.0 }])
}

/// `landed` to MAV_LANDED_STATE.
pub(super) fn landed(values: &mut [f64], _: usize) -> usize {
    let [on_ground, in_air] = LANDED_STATES;
    put(values, [if values[0] == 0.0 { in_air } else { on_ground }])
}

/// `nav_state` to the number of the mode.
pub(super) fn mode(values: &mut [f64], _: usize) -> usize {
    px4_mode_of_state(whole(values[0])).map_or(0, |number| put(values, [number.into()]))
}

fn limited(number: f64, most: usize) -> usize {
    whole_index(number).min(most)
}

fn whole_index(number: f64) -> usize {
    usize::try_from(whole_unsigned(number)).unwrap_or(usize::MAX)
}
