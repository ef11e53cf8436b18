//! Whether streams are sampled fast enough to identify from.
//!
//! Simulated flights of lively trajectories (harmonics to 4 Hz), thinned stream by stream: thinned rotor speeds or
//! commands bring errors of 0.2 to 0.3 % in inertia at 40 Hz (two to three stated standard errors), of 1 % at 25 Hz (up
//! to five), 1.5 % at 15, 3 to 4 % at 10 and 10 % at 5 Hz (six to thirteen), because what lies between two samples of a
//! command is not on a straight line between them. Thinned body rates, which the weak form only integrates, hardly tell
//! in mass and inertia before 15 Hz, but in what is found missing: of an autopilot's flight whose motors lag, both
//! thinned to 40 Hz still show a lag, at 33 and 25 Hz a delay in its place, and damping of the rotation is lost. Attitude
//! beside body rates tells from 5 Hz on; accelerometer and velocity do not tell down to that.

use super::SignalsError;
use crate::note::{About, Note};
use crate::recording::{Recording, Stream};
use crate::stats::median;

/// Least rate of rotor speeds, commands, or force and torque without a warning, Hz: 40 Hz with some lost frames.
/// Measured, see above; at 33 Hz `explain` named a delay in a PX4 flight whose motors have a lag.
pub const LEAST_ACTUATOR_HZ: f64 = 38.0;
/// The same for body rates, or for the attitude in their place, Hz.
pub const LEAST_BODY_RATE_HZ: f64 = 38.0;

/// Rate below which torques are not compared with the motion, Hz: errors of inertia are many standard errors there, see
/// above.
pub const LEAST_TORQUE_HZ: f64 = 20.0;
/// Rate below which forces are not compared either, Hz: 10 Hz with some lost frames, which puts three samples or more
/// into the weak form's kernel. With fewer samples the kernel's mean is an interpolation.
pub const LEAST_FORCE_HZ: f64 = 8.0;

/// Intervals longer than this many median intervals are gaps, or belong to a time before the rate was requested. A
/// lossy link loses a few in a row.
const FLOWS: f64 = 5.0;

/// Mean rate of a stream, Hz, without its gaps and without an earlier time at a slower rate; 0 for fewer than two
/// samples.
#[must_use]
pub(super) fn flowing_rate_hz(stream: &Stream) -> f64 {
    flowing_hz(intervals(&stream.time_s).collect())
}

/// The same inside `spans_s` only (s); `None` if they contain less than two samples.
#[must_use]
pub fn flowing_rate_within_hz(stream: &Stream, spans_s: &[(f64, f64)]) -> Option<f64> {
    let inside = |(start, end): &(f64, f64)| {
        let from = stream.time_s.partition_point(|time_s| time_s < start);
        let to = stream.time_s.partition_point(|time_s| time_s <= end);
        &stream.time_s[from..to.max(from)]
    };
    let gaps: Vec<f64> = spans_s.iter().flat_map(|span| intervals(inside(span))).collect();
    (!gaps.is_empty()).then(|| flowing_hz(gaps))
}

fn intervals(time_s: &[f64]) -> impl Iterator<Item = f64> + '_ {
    time_s.windows(2).map(|pair| pair[1] - pair[0])
}

fn flowing_hz(mut gaps_s: Vec<f64>) -> f64 {
    let longest_s = FLOWS * median(&mut gaps_s);
    let flowing = gaps_s.iter().filter(|gap_s| **gap_s <= longest_s);
    let (count, total_s) = flowing.fold((0.0, 0.0), |(count, sum_s), gap_s| (count + 1.0, sum_s + gap_s));
    if total_s > 0.0 { count / total_s } else { 0.0 }
}

/// A stream that the identification needs: its content, its message, the stream, and the least rate, Hz.
pub(super) type Needed<'a> = (&'static str, &'static str, &'a Stream, f64);

/// What the rates of a flight's streams are good for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sufficiency {
    /// fast enough to compare torques with the motion; otherwise forces, and torques on average
    pub(super) torques: bool,
    /// on streams that are slow
    pub(super) note: Option<Note>,
}

/// What to set for more in the log that the vehicle writes itself, by the parameters that a recording has; `None` of a table, which
/// says nothing of its autopilot.
pub(super) fn logging_of(recording: &Recording) -> Option<Box<str>> {
    let parameter = |name: &str| recording.parameters.get(name).copied();
    recording.autopilot.stack().map(|stack| stack.logging_by(parameter).into_boxed_str())
}

/// Judges the rates in the air; `logging` is what to set for more in the vehicle's own log. Refuses a flight with a stream that is too slow for any identification.
///
/// # Errors
/// [`SignalsError::TooSlow`], which names each of those streams with its rate.
pub(super) fn check(
    needed: &[Needed<'_>],
    airborne_s: &[(f64, f64)],
    logging: Option<Box<str>>,
) -> Result<Sufficiency, SignalsError> {
    let in_air: Vec<(&str, &str, f64, f64)> = needed
        .iter()
        .filter_map(|(what, message, stream, good_hz)| {
            Some((*what, *message, flowing_rate_within_hz(stream, airborne_s)?, *good_hz))
        })
        .collect();
    let slowest_hz = in_air.iter().fold(f64::INFINITY, |slowest, (_, _, rate_hz, _)| slowest.min(*rate_hz));
    let below = |least_hz: f64| -> String {
        let slow = in_air.iter().filter(|(_, _, rate_hz, _)| *rate_hz < least_hz);
        let told = slow.map(|(what, message, rate_hz, _)| format!("{what} ({message}) at {rate_hz:.1} Hz"));
        format!("{}; {least_hz:.0} Hz are the least", told.collect::<Vec<_>>().join(", "))
    };
    if slowest_hz < LEAST_FORCE_HZ {
        return Err(SignalsError::TooSlow { slow: below(LEAST_FORCE_HZ), logging });
    }
    if slowest_hz < LEAST_TORQUE_HZ {
        let note = Some(forces_note(&below(LEAST_TORQUE_HZ), logging.as_deref()));
        return Ok(Sufficiency { torques: false, note });
    }
    let slow = in_air.iter().filter(|(_, _, rate_hz, good_hz)| rate_hz < good_hz);
    let told = slow.map(|(what, message, rate_hz, good_hz)| {
        format!("{what} ({message}) at {rate_hz:.1} Hz, expected {good_hz:.0} Hz at least")
    });
    let slow = told.collect::<Vec<_>>().join("; ");
    Ok(Sufficiency { torques: true, note: (!slow.is_empty()).then(|| slow_note(&slow)) })
}

fn slow_note(slow: &str) -> Note {
    let text = format!(
        "sampled slowly: {slow}. Inertia may be off by several of its standard errors, and a lag cannot be \
         distinguished from a delay; 100 Hz of each is good"
    );
    Note::remark(About::Sensors, text)
}

fn forces_note(slow: &str, logging: Option<&str>) -> Note {
    let set = logging.map_or_else(String::new, |set| format!(": for the log that the vehicle writes, {set}"));
    let text = format!(
        "sampled too slowly to compare torques with the motion: {slow}. Forces are used, and torques averaged over seconds: they \
         tell a weak rotor and a centre of mass that is off, but inertia, damping and lag cannot be determined. 100 Hz of each \
         is good{set}"
    );
    Note::warning(About::Sensors, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(rate_hz: f64, seconds: f64) -> Stream {
        let mut time_s = vec![0.0];
        while time_s[time_s.len() - 1] < seconds {
            time_s.push(time_s.len() as f64 / rate_hz);
        }
        Stream { values: time_s.clone(), width: 1, time_s }
    }

    #[test]
    fn a_stream_that_began_slowly_is_as_fast_as_it_became() {
        let mut late = stream(100.0, 1.0);
        late.time_s.splice(0..0, [-4.0, -3.0, -2.0, -1.0]);
        assert!((flowing_rate_hz(&late) - 100.0).abs() < 1e-9);
        assert_eq!(flowing_rate_hz(&Stream { time_s: vec![1.0], width: 1, values: vec![0.0] }), 0.0);
    }

    #[test]
    fn what_is_slow_in_the_air_is_named_and_what_is_slow_on_the_ground_is_not() {
        let (slow, good) = (stream(9.5, 60.0), stream(100.0, 60.0));
        let needed = |rates: &'static str, stream| (rates, "ATTITUDE", stream, LEAST_BODY_RATE_HZ);
        let outputs = ("actuator outputs", "SERVO_OUTPUT_RAW", &slow, LEAST_ACTUATOR_HZ);
        let flight = [(10.0, 50.0)];
        let px4 = Recording { autopilot: crate::autopilot::Autopilot::Px4, ..Recording::default() };
        let logging = logging_of(&px4).unwrap();
        let found = check(&[needed("body rates", &good), outputs], &flight, Some(logging.clone())).unwrap();
        let said = found.note.unwrap().text;
        assert!(!found.torques && said.contains("torques averaged over seconds"), "{said}");
        assert!(
            said.contains("actuator outputs (SERVO_OUTPUT_RAW) at 9.5 Hz; 20 Hz are the least"),
            "{said}"
        );
        assert!(!said.contains("body rates (ATTITUDE)"), "{said}");
        assert!(said.contains("set SDLOG_PROFILE = 9"), "{said}");
        let slower = stream(7.0, 60.0);
        let outputs_slower = ("actuator outputs", "SERVO_OUTPUT_RAW", &slower, LEAST_ACTUATOR_HZ);
        let error = check(&[outputs_slower], &flight, Some(logging.clone())).unwrap_err().to_string();
        assert!(
            error.contains("actuator outputs (SERVO_OUTPUT_RAW) at 7.0 Hz; 8 Hz are the least"),
            "{error}"
        );
        assert!(error.contains("set SDLOG_PROFILE = 9"), "{error}");
        // seldom for a minute on the ground, then as asked for
        let mut late = stream(1.0, 60.0);
        late.time_s.extend(stream(100.0, 20.0).time_s.iter().map(|time_s| 60.5 + time_s));
        let fast_enough = Sufficiency { torques: true, note: None };
        assert_eq!(check(&[needed("body rates", &late)], &[(60.5, 80.0)], None).unwrap(), fast_enough);
        assert!(check(&[needed("body rates", &late)], &[(5.0, 50.0)], None).is_err());
        assert_eq!(check(&[outputs], &[], None).unwrap(), fast_enough);
        // slow, but not hopeless: said
        let thin = stream(25.0, 60.0);
        let found = check(&[needed("body rates", &thin)], &flight, None).unwrap();
        assert!(found.torques);
        let said = found.note.unwrap().text;
        assert!(said.contains("body rates (ATTITUDE) at 25.0 Hz, expected 38 Hz at least"), "{said}");
    }
}
