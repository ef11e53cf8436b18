//! Which of several streams of one quantity is used.

use super::SignalsError;
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use crate::stats::median_step;

/// Commands of the motors themselves, as shares of full thrust, in the autopilot's order of motors: before its thrust curve
/// and its outputs.
pub(super) const MOTORS: &str = "actuator_motors";

/// Message names of the attitude, best first. Where both are there, what the vehicle logged comes before what it sent: its
/// stamps are exact to the microsecond and no sample is lost.
const ATTITUDE: &[&str] = &[
    "vehicle_attitude",
    "vehicle_odometry",
    "ANG",
    "ATT",
    "XKF1",
    "NKF1",
    "EKF1",
    "AHR2",
    "ATTITUDE_QUATERNION",
    "ATTITUDE",
    "ODOMETRY",
];

/// Message names of the body rates, best first.
const ANGULAR_RATE: &[&str] = &[
    // as the sensor read it; what is filtered comes late
    "sensor_combined",
    "vehicle_imu",
    "vehicle_angular_velocity",
    "vehicle_attitude",
    "GYR",
    "IMU",
    "RATE",
    "GYR1",
    "IMU2",
    "IMU3",
    "HIGHRES_IMU",
    "SCALED_IMU",
    "RAW_IMU",
    "SCALED_IMU2",
    "SCALED_IMU3",
    "ATTITUDE_QUATERNION",
    "ATTITUDE",
    "ODOMETRY",
];

/// Message names of the specific force, best first.
const SPECIFIC_FORCE: &[&str] = &[
    "sensor_combined",
    "vehicle_imu",
    "vehicle_acceleration",
    "ACC",
    "IMU",
    "ACC1",
    "IMU2",
    "IMU3",
    "HIGHRES_IMU",
    "SCALED_IMU",
    "RAW_IMU",
    "SCALED_IMU2",
    "SCALED_IMU3",
];

/// Message names of one quantity, best first. A source that is not listed comes last.
fn preference(quantity: Quantity) -> &'static [&'static str] {
    match quantity {
        Quantity::Attitude => ATTITUDE,
        Quantity::AngularRate => ANGULAR_RATE,
        Quantity::SpecificForce => SPECIFIC_FORCE,
        Quantity::Position | Quantity::Velocity => &[
            "vehicle_local_position",
            "vehicle_odometry",
            "XKF1",
            "NKF1",
            "EKF1",
            "LOCAL_POSITION_NED",
            "ODOMETRY",
        ],
        // what was asked for comes before the autopilot's own setpoint, into which it feeds back noise
        Quantity::PositionSetpoint
        | Quantity::VelocitySetpoint
        | Quantity::AccelerationSetpoint
        | Quantity::YawSetpoint => &[
            "SET_POSITION_TARGET_LOCAL_NED",
            "GUIP",
            "POSITION_TARGET_LOCAL_NED",
            "trajectory_setpoint",
            "vehicle_local_position_setpoint",
        ],
        Quantity::ActuatorCommand => {
            &["SERVO_OUTPUT_RAW", "ACTUATOR_OUTPUT_STATUS", MOTORS, "actuator_outputs"]
        }
        Quantity::RotorSpeed => &["esc_status", "ESC", "ESC_STATUS", "ESC_TELEMETRY_1_TO_4"],
        _ => &[],
    }
}

/// Mean rate over the stream's span, Hz; 0 for fewer than two samples.
#[must_use]
pub fn mean_rate_hz(stream: &Stream) -> f64 {
    match (stream.time_s.first(), stream.time_s.last()) {
        (Some(first), Some(last)) if last > first => (stream.len() as f64 - 1.0) / (last - first),
        _ => 0.0,
    }
}

/// Median period between samples, s; NaN for fewer than two samples.
#[must_use]
pub fn median_period_s(stream: &Stream) -> f64 {
    median_step(&stream.time_s)
}

/// Something in the stream moves: a frozen stream says nothing.
#[must_use]
pub fn is_live(stream: &Stream) -> bool {
    (0..stream.width).any(|channel| {
        let mut seen: Option<f64> = None;
        (0..stream.len()).map(|i| stream.sample(i)[channel]).filter(|v| v.is_finite()).any(|value| {
            // zero has two signs
            let moved = seen.is_some_and(|first| f64::abs(first - value) > 0.0);
            seen.get_or_insert(value);
            moved
        })
    })
}

/// A stream of fewer samples is not used. Of fewer neither rate nor noise can be told. It is a number of its own: that of
/// `recording` decides only whether a rate is shown.
pub(super) const LEAST_SAMPLES: usize = 10;

/// The refusal of a recording whose longest stream of a quantity that satisfies `fits` is too short to be used;
/// `None` where one is long enough, or none fits.
pub(super) fn too_short(
    recording: &Recording,
    quantity: Quantity,
    fits: impl Fn(&StreamKey, &Stream) -> bool,
) -> Option<SignalsError> {
    let fitting =
        recording.streams.iter().filter(|(key, stream)| key.quantity == quantity && fits(key, stream));
    let (key, longest) = fitting.max_by_key(|(_, stream)| stream.len())?;
    (longest.len() < LEAST_SAMPLES).then(|| SignalsError::TooFewSamples {
        quantity,
        message: key.source,
        count: longest.len(),
        needed: LEAST_SAMPLES,
    })
}

/// Batches of raw samples with pauses between them are for spectra: they say nothing of the motion between.
const IN_BATCHES: &str = "ISBD";

/// The best live stream of a quantity that satisfies `fits`: among those within a factor of 1.6 of
/// the fastest, the first of its quantity's order of preference.
#[must_use]
pub fn best(
    recording: &Recording,
    quantity: Quantity,
    fits: impl Fn(&Stream) -> bool,
) -> Option<(&StreamKey, &Stream)> {
    best_of(recording, quantity, |_, stream| fits(stream))
}

/// As [`best`], where it matters whose the stream is.
pub(super) fn best_of(
    recording: &Recording,
    quantity: Quantity,
    fits: impl Fn(&StreamKey, &Stream) -> bool,
) -> Option<(&StreamKey, &Stream)> {
    let candidates: Vec<(&StreamKey, &Stream)> = recording
        .streams
        .iter()
        .filter(|(key, stream)| {
            key.quantity == quantity
                && key.source != IN_BATCHES
                && stream.len() >= LEAST_SAMPLES
                && is_live(stream)
                && fits(key, stream)
        })
        .collect();
    let rated: Vec<(&str, f64)> =
        candidates.iter().map(|(key, stream)| (key.source, mean_rate_hz(stream))).collect();
    best_rank(quantity, &rated).map(|index| candidates[index])
}

/// A faster inertial sensor says no more, Hz: of several that are fast, the one that filters least is best. Above it
/// the motion that is used, up to 5 Hz, is sampled ten times a period.
const ENOUGH_HZ: f64 = 100.0;

/// A place on the earth, to a centimetre: only where nothing else tells the position.
const PLACES: &str = "POS";

/// What a source's rate is worth, Hz.
fn worth_hz(quantity: Quantity, source: &str, rate_hz: f64) -> f64 {
    match quantity {
        Quantity::AngularRate | Quantity::SpecificForce => rate_hz.min(ENOUGH_HZ),
        Quantity::Position if source == PLACES => 0.0,
        _ => rate_hz,
    }
}

/// Which of several sources of a quantity (message and samples a second, in the order of their keys) is used:
/// among those within a factor of 1.6 of the fastest, the first of the quantity's order of preference.
#[must_use]
pub fn best_rank(quantity: Quantity, sources: &[(&str, f64)]) -> Option<usize> {
    let worth = |(source, rate_hz): &(&str, f64)| worth_hz(quantity, source, *rate_hz);
    let fastest = sources.iter().map(worth).fold(0.0, f64::max);
    let order = preference(quantity);
    let rank = |source: &str| order.iter().position(|name| *name == source).unwrap_or(order.len());
    let fast = sources.iter().enumerate().filter(|(_, source)| worth(source) * 1.6 >= fastest);
    fast.min_by_key(|(index, (source, _))| (rank(source), *index)).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(period_s: f64, live: bool) -> Stream {
        let time_s: Vec<f64> = (0..100).map(|i| f64::from(i) * period_s).collect();
        let values = time_s.iter().map(|t| if live { *t } else { 1.0 }).collect();
        Stream { time_s, width: 1, values }
    }

    fn recording(entries: [(&'static str, Stream); 2]) -> Recording {
        let mut recording = Recording::default();
        for (source, stream) in entries {
            let key = StreamKey { quantity: Quantity::AngularRate, source, instance: 0 };
            recording.streams.insert(key, stream);
        }
        recording
    }

    #[test]
    fn rate_comes_before_preference_and_frozen_streams_never() {
        let pick = |r: &Recording| best(r, Quantity::AngularRate, |_| true).map(|(key, _)| key.source);
        let same = recording([("ATTITUDE", stream(0.01, true)), ("HIGHRES_IMU", stream(0.01, true))]);
        assert_eq!(pick(&same), Some("HIGHRES_IMU"));
        let slow = recording([("ATTITUDE", stream(0.01, true)), ("HIGHRES_IMU", stream(0.04, true))]);
        assert_eq!(pick(&slow), Some("ATTITUDE"));
        let frozen = recording([("ATTITUDE", stream(0.02, true)), ("HIGHRES_IMU", stream(0.01, false))]);
        assert_eq!(pick(&frozen), Some("ATTITUDE"));
        let filtered = recording([
            ("vehicle_angular_velocity", stream(0.004, true)),
            ("sensor_combined", stream(0.008, true)),
        ]);
        assert_eq!(pick(&filtered), Some("sensor_combined"));
    }

    #[test]
    fn a_place_on_the_earth_is_the_last_resort() {
        let rank = |sources: &[(&str, f64)]| best_rank(Quantity::Position, sources);
        assert_eq!(rank(&[("POS", 25.0)]), Some(0));
        assert_eq!(rank(&[("POS", 25.0), ("XKF1", 10.0)]), Some(1));
    }
}
