//! Single outliers in a damaged log. On-board logs have no checksums, so damage within the possible values shows only against the
//! neighbouring samples.
//!
//! Only for logs that are known to be damaged: no sample of an undamaged log is left out.

use std::collections::BTreeMap;

use super::quantity::Quantity;
use super::stream::{Stream, StreamKey};

/// Samples on each side with which one is compared. Fewer do not tell a leap from a turn, more reach into the next
/// motion.
const AROUND: usize = 5;
/// A sample leaps that is so many times as far from those around it as they are from those around them. A smaller one
/// would cut the tail of a sound sensor's noise, a larger one keep small damage.
const TIMES: f64 = 8.0;
/// What leaps by less than this share of what a value mostly spans does no harm. A smaller value would cost samples
/// for nothing.
const HARMLESS: f64 = 0.05;
/// Shares between which a value mostly is. The outer tenths may be damage themselves.
const MOSTLY: (f64, f64) = (0.1, 0.9);

/// A state of a flight holds for longer, s. Nothing takes off and lands in less.
const SHORT_S: f64 = 2.0;
/// An instance with less than this share of another one's samples is none. Two instances of one sensor send alike;
/// less is a message of damage.
const STRAY: f64 = 0.02;

/// How two samples differ.
#[derive(Debug, Clone, Copy)]
enum Apart {
    /// by the angle between two attitudes
    Angle,
    /// by the difference of one channel
    Channel(usize),
}

impl Apart {
    fn of(self, stream: &Stream, one: usize, other: usize) -> f64 {
        let (one, other) = (stream.sample(one), stream.sample(other));
        match self {
            Self::Angle => {
                let dot: f64 = one.iter().zip(other).map(|(a, b)| a * b).sum();
                2.0 * dot.abs().min(1.0).acos()
            }
            Self::Channel(channel) => (one[channel] - other[channel]).abs(),
        }
    }

    /// What leaps by no more than this does no harm; `None` where nothing moves and the stream has no size.
    fn harmless(self, stream: &Stream, size: f64) -> Option<f64> {
        let mut values: Vec<f64> = match self {
            Self::Angle => (0..stream.len()).map(|index| self.of(stream, 0, index)).collect(),
            Self::Channel(channel) => (0..stream.len()).map(|index| stream.sample(index)[channel]).collect(),
        };
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values.get(place(share, values.len())).copied();
        let spans = at(MOSTLY.1)? - at(MOSTLY.0)?;
        // a channel that rests is compared with the size of them all
        let spans = if spans > 0.0 { spans } else { size };
        (spans > 0.0).then_some(HARMLESS * spans)
    }
}

/// The largest of what the channels mostly are, without their signs.
fn size(stream: &Stream) -> f64 {
    let mostly = |channel: usize| {
        let channel = (0..stream.len()).map(|index| stream.sample(index)[channel].abs());
        lower_median(&mut channel.filter(|value| value.is_finite()).collect::<Vec<_>>())
    };
    (0..stream.width).map(mostly).fold(0.0, f64::max)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
fn place(share: f64, length: usize) -> usize {
    (share * length.saturating_sub(1) as f64).round() as usize
}

/// The lower one of two in the middle: a step that stays is near to one side of it.
fn lower_median(values: &mut [f64]) -> f64 {
    let middle = values.len().saturating_sub(1) / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

fn around(index: usize, length: usize) -> impl Iterator<Item = usize> {
    let range = index.saturating_sub(AROUND)..(index + AROUND + 1).min(length);
    range.filter(move |other| *other != index)
}

/// Marks the samples that leap in one respect.
fn mark(stream: &Stream, (apart, size): (Apart, f64), leaps: &mut [bool]) {
    let Some(harmless) = apart.harmless(stream, size) else { return };
    let length = stream.len();
    let mut near = Vec::with_capacity(2 * AROUND);
    let far: Vec<f64> = (0..length)
        .map(|index| {
            near.clear();
            near.extend(around(index, length).map(|other| apart.of(stream, index, other)));
            lower_median(&mut near)
        })
        .collect();
    for index in 0..length {
        near.clear();
        near.extend(around(index, length).map(|other| far[other]));
        leaps[index] |= far[index] > harmless + TIMES * lower_median(&mut near);
    }
}

/// States that hold for a single sample and a short time, between two that agree.
fn mark_states(stream: &Stream, leaps: &mut [bool]) {
    for index in 1..stream.len().saturating_sub(1) {
        let [before, now, after] = [index - 1, index, index + 1].map(|index| stream.sample(index));
        let is_short = stream.time_s[index + 1] - stream.time_s[index - 1] < SHORT_S;
        leaps[index] = is_short && !leaps[index - 1] && before == after && now != before;
    }
}

/// Streams of a sensor or output that is none: its number is damaged in messages of another one of the same source. How many
/// samples these were.
pub(super) fn leave_out_strays(streams: &mut BTreeMap<StreamKey, Stream>) -> u64 {
    let mut most: BTreeMap<(Quantity, &str), usize> = BTreeMap::new();
    for (key, stream) in &*streams {
        let most = most.entry((key.quantity, key.source)).or_default();
        *most = stream.len().max(*most);
    }
    let mut count = 0;
    streams.retain(|key, stream| {
        let most = most.get(&(key.quantity, key.source)).copied().unwrap_or_default();
        let is_stray = (stream.len() as f64) < STRAY * most as f64;
        count += if is_stray { stream.len() as u64 } else { 0 };
        !is_stray
    });
    count
}

/// Leaves out the samples that leap; how many these are.
pub(super) fn leave_out(quantity: Quantity, stream: &mut Stream) -> u64 {
    let mut leaps = vec![false; stream.len()];
    match quantity {
        Quantity::Armed | Quantity::LandedState => mark_states(stream, &mut leaps),
        Quantity::Mode => {}
        Quantity::Attitude | Quantity::AttitudeSetpoint => mark(stream, (Apart::Angle, 0.0), &mut leaps),
        _ => {
            let size = size(stream);
            (0..stream.width).for_each(|channel| mark(stream, (Apart::Channel(channel), size), &mut leaps));
        }
    }
    let count = leaps.iter().filter(|leaps| **leaps).count();
    if count > 0 {
        let kept = || (0..leaps.len()).filter(|index| !leaps[*index]);
        let time_s = kept().map(|index| stream.time_s[index]).collect();
        let values = kept().flat_map(|index| stream.sample(index).iter().copied()).collect();
        *stream = Stream { time_s, width: stream.width, values };
    }
    count as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(width: usize, values: Vec<f64>) -> Stream {
        let time_s = (0..values.len() / width).map(|index| index as f64 * 0.1).collect();
        Stream { time_s, width, values }
    }

    /// A turn back and forth at 10 Hz, its fastest 0.3 of its size a sample.
    fn swing(index: usize) -> f64 {
        (index as f64 * 0.3).sin()
    }

    #[test]
    fn what_leaps_away_and_back_is_left_out_and_what_moves_stays() {
        let sound: Vec<f64> = (0..200).flat_map(|index| [swing(index), 5.0]).collect();
        let mut kept = stream(2, sound.clone());
        assert_eq!(leave_out(Quantity::Velocity, &mut kept), 0);
        // a fifth of the samples, some behind one another
        let mut damaged = stream(2, sound);
        for index in (7..200).step_by(10).chain((8..200).step_by(10)) {
            damaged.values[2 * index] += 40.0 + index as f64;
        }
        assert_eq!(leave_out(Quantity::Velocity, &mut damaged), 40);
        assert_eq!(damaged.len(), 160);
        assert!(damaged.values.chunks(2).all(|sample| sample[0].abs() <= 1.0));
    }

    #[test]
    fn a_step_that_stays_is_no_leap() {
        let pulses = (0..100).map(|index| if (30..70).contains(&index) { 1500.0 } else { 1000.0 });
        let mut steps = stream(1, pulses.collect());
        assert_eq!(leave_out(Quantity::ActuatorCommand, &mut steps), 0);
        steps.values[50] = 60_000.0;
        assert_eq!(leave_out(Quantity::ActuatorCommand, &mut steps), 1);
        // an output that is not used, beside one that is
        let mut beside = stream(2, (0..100).flat_map(|index| [1500.0 + 100.0 * swing(index), 0.0]).collect());
        assert_eq!(leave_out(Quantity::ActuatorCommand, &mut beside), 0);
        (beside.values[81], beside.values[121]) = (60.0, 60_000.0);
        assert_eq!(leave_out(Quantity::ActuatorCommand, &mut beside), 1);
    }

    #[test]
    fn attitudes_are_compared_by_their_angle() {
        let turned = |index: usize| {
            let half = 0.5 * swing(index);
            // the same attitude by either sign
            let sign = if index.is_multiple_of(3) { -1.0 } else { 1.0 };
            [sign * half.cos(), 0.0, 0.0, sign * half.sin()]
        };
        let mut attitudes = stream(4, (0..100).flat_map(turned).collect());
        assert_eq!(leave_out(Quantity::Attitude, &mut attitudes), 0);
        attitudes.values[200..204].copy_from_slice(&[0.0, 1.0, 0.0, 0.0]);
        assert_eq!(leave_out(Quantity::Attitude, &mut attitudes), 1);
    }

    #[test]
    fn a_state_of_one_sample_between_two_that_agree_is_none() {
        let mut landed = stream(1, vec![1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 2.0, 1.0, 2.0, 1.0, 1.0]);
        assert_eq!(leave_out(Quantity::LandedState, &mut landed), 2);
        assert_eq!(landed.values, [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, 1.0]);
        assert_eq!(leave_out(Quantity::LandedState, &mut stream(1, Vec::new())), 0);
        // a log that tells changes alone
        let mut flight = Stream { time_s: vec![0.0, 3.0, 65.0], width: 1, values: vec![1.0, 2.0, 1.0] };
        assert_eq!(leave_out(Quantity::LandedState, &mut flight), 0);
    }

    #[test]
    fn an_instance_of_a_few_samples_is_damage_and_another_source_is_not() {
        let key = |source, instance| StreamKey { quantity: Quantity::AngularRate, source, instance };
        let of = |count: usize| stream(1, vec![0.0; count]);
        let mut streams: BTreeMap<StreamKey, Stream> = [
            (key("IMU", 0), of(500)),
            (key("IMU", 1), of(480)),
            (key("IMU", 77), of(3)),
            (key("RATE", 0), of(4)),
        ]
        .into();
        assert_eq!(leave_out_strays(&mut streams), 3);
        assert_eq!(streams.len(), 3);
    }
}
