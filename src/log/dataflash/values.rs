//! The values of one sample on their way from a message to a stream.

use crate::frames::{attitude_from_euler_frd_ned, attitude_from_frd_ned, body_from_frd, world_from_ned};

/// Most values of a sample.
pub(super) const MOST: usize = 32;
/// An output that puts out nothing.
const NO_OUTPUT: f64 = 65_535.0;
/// A target of position, velocity and acceleration together, as a trajectory is.
const TRAJECTORY: f64 = 3.0;
/// A receiver with fewer than three dimensions has no velocity.
const FIX_3D: f64 = 3.0;

/// The values of one sample; none where it is of no use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Values {
    list: [f64; MOST],
    count: usize,
}

/// From a message's fields in SI to this crate's frames.
pub(super) type Convert = fn(&mut Values);

impl Values {
    pub(super) const NONE: Self = Self { list: [0.0; MOST], count: 0 };

    /// None any more.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    pub(super) fn push(&mut self, value: f64) {
        if let Some(slot) = self.list.get_mut(self.count) {
            *slot = value;
            self.count += 1;
        }
    }

    pub(super) fn get(&self) -> &[f64] {
        &self.list[..self.count]
    }

    fn set(&mut self, values: &[f64]) {
        self.count = 0;
        values.iter().for_each(|value| self.push(*value));
    }

    fn first<const N: usize>(&self) -> Option<[f64; N]> {
        self.get().first_chunk().copied()
    }
}

/// Scalars, and what is in this crate's frames already.
pub(super) fn as_is(_: &mut Values) {}

/// A vector in the body.
pub(super) fn body(values: &mut Values) {
    let Some(frd) = values.first() else { return values.set(&[]) };
    let flu: [f64; 3] = body_from_frd(frd).0.into();
    values.set(&flu);
}

/// A vector in the world.
pub(super) fn world(values: &mut Values) {
    let Some(ned) = values.first() else { return values.set(&[]) };
    let nwu: [f64; 3] = world_from_ned(ned).0.into();
    values.set(&nwu);
}

/// Roll, pitch, yaw.
pub(super) fn euler(values: &mut Values) {
    let finite = |angles: &[f64; 3]| angles.iter().all(|angle| angle.is_finite());
    let Some([roll, pitch, yaw]) = values.first().filter(finite) else { return values.set(&[]) };
    let q = *attitude_from_euler_frd_ned(roll, pitch, yaw).0.quaternion();
    values.set(&[q.w, q.i, q.j, q.k]);
}

/// w x y z.
pub(super) fn quaternion(values: &mut Values) {
    let attitude = values.first().and_then(attitude_from_frd_ned);
    let Some(attitude) = attitude else { return values.set(&[]) };
    let q = *attitude.0.quaternion();
    values.set(&[q.w, q.i, q.j, q.k]);
}

/// Kind of a target, whether its height is above the ground, and a vector in the world.
pub(super) fn guided(values: &mut Values) {
    let Some([kind, above_ground, x, y, z]) = values.first() else { return values.set(&[]) };
    if kind != TRAJECTORY || above_ground != 0.0 {
        return values.set(&[]);
    }
    values.set(&[x, y, z]);
    world(values);
}

/// Outputs up to the last one that puts out something.
pub(super) fn channels(values: &mut Values) {
    let puts_out = |output: &f64| *output != 0.0 && !output.is_nan();
    let used = values.get().iter().rposition(puts_out).map_or(0, |last| last + 1);
    values.count = used;
    for value in &mut values.list[..used] {
        if *value == NO_OUTPUT {
            *value = f64::NAN;
        }
    }
}

/// Speed over ground, course, speed down, and the receiver's status.
pub(super) fn course(values: &mut Values) {
    let Some([speed, course, down, status]) = values.first() else { return values.set(&[]) };
    if status < FIX_3D {
        return values.set(&[]);
    }
    values.set(&[speed * course.cos(), speed * course.sin(), down]);
    world(values);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn converted(convert: Convert, input: &[f64]) -> Vec<f64> {
        let mut values = Values::NONE;
        values.set(input);
        convert(&mut values);
        values.get().to_vec()
    }

    #[test]
    fn every_conversion_ends_in_this_crates_frames() {
        assert_eq!(converted(body, &[1.0, 2.0, -9.8]), [1.0, -2.0, 9.8]);
        assert_eq!(converted(world, &[1.0, 2.0, 3.0]), [1.0, -2.0, -3.0]);
        // nose up: about left, by the negative half angle
        let up = converted(euler, &[0.0, 0.2, 0.0]);
        assert!((up[2] + 0.1_f64.sin()).abs() < 1e-12 && up[1] == 0.0);
        assert_eq!(converted(quaternion, &[0.0; 4]), [0.0; 0]);
        assert_eq!(converted(channels, &[1500.0, 65_535.0, 1400.0, 0.0, f64::NAN])[2..], [1400.0]);
        assert_eq!(converted(guided, &[3.0, 0.0, 1.0, 2.0, 3.0]), [1.0, -2.0, -3.0]);
        assert_eq!(converted(guided, &[4.0, 0.0, 1.0, 2.0, 3.0]), [0.0; 0]);
        // to the east
        let east = converted(course, &[2.0, std::f64::consts::FRAC_PI_2, 0.5, 3.0]);
        assert!((east[1] + 2.0).abs() < 1e-12 && east[2] == -0.5);
        assert_eq!(converted(course, &[2.0, 0.0, 0.5, 1.0]), [0.0; 0]);
    }
}
