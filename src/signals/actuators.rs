//! Conversion of actuator outputs to the thrust of each rotor and to `F = [Fz tau]` before the mixer.
//!
//! Measured rotor speeds have priority over commands. For commands, the autopilot's own parameters, if the log contains
//! them, state which channel drives which motor and how a pulse width becomes thrust. The vehicle file states the
//! strength of a rotor.

use super::SignalsError;
use super::grid::LARGEST_VALUE;
use super::rebuilt::rebuilt;
use super::rotor_count::refuse_still_rotors;
use super::rotor_thrusts::{RotorThrusts, ThrustSource, jitter_thrust};
use super::select::{LEAST_SAMPLES, MOTORS, best, best_of, is_live, too_short};
use crate::autopilot::{MOST_OUTPUTS, Outputs};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use crate::vehicle::{Actuator, Propulsion, PwmRange, ThrustLaw, Vehicle};

/// Rotor thrusts from the commands.
///
/// # Errors
/// [`SignalsError::NoActuators`] where no stream has a channel for every rotor in the vehicle's unit and moves,
/// [`SignalsError::OtherRotors`] where those of a rotor never move, [`SignalsError::TooFewSamples`] where hardly a sample has a value
/// for every rotor.
pub fn thrusts_from_commands(recording: &Recording, vehicle: &Vehicle) -> Result<RotorThrusts, SignalsError> {
    let (propulsion, mut notes) = propulsion_from_log(recording, &vehicle.propulsion);
    let outputs = motor_channels(recording, vehicle.rotors.len(), &mut notes);
    let motors: Vec<usize> = (0..vehicle.rotors.len()).collect();
    let read_as = |key: &StreamKey| match key.source {
        MOTORS => (&motors, Actuator::Thrust),
        _ => (&outputs, propulsion.actuator),
    };
    let fits = |key: &StreamKey, stream: &Stream| {
        let (channels, actuator) = read_as(key);
        channels.iter().all(|channel| *channel < stream.width) && in_unit(stream, channels, actuator)
    };
    let (key, raw) = best_of(recording, Quantity::ActuatorCommand, fits).ok_or_else(|| {
        too_short(recording, Quantity::ActuatorCommand, fits)
            .unwrap_or_else(|| no_actuators(recording, vehicle))
    })?;
    let (channels, _) = read_as(key);
    refuse_still_rotors(recording, (key.source, raw), channels)?;
    let expo = thrust_model(recording);
    let normalized = |value: f64| match key.source {
        MOTORS => output_of_thrust(value, expo),
        _ => propulsion.normalized(value),
    };
    let mut command = Stream { time_s: raw.time_s.clone(), width: channels.len(), values: Vec::new() };
    command.values.reserve(raw.len() * channels.len());
    command.time_s.clear();
    for index in 0..raw.len() {
        let sample = raw.sample(index);
        if channels.iter().all(|&channel| sample[channel].abs() < LARGEST_VALUE) {
            command.time_s.push(raw.time_s[index]);
            command.values.extend(channels.iter().map(|&channel| normalized(sample[channel])));
        }
    }
    if command.len() < LEAST_SAMPLES {
        let (quantity, message) = (key.quantity, key.source);
        let (count, needed) = (command.len(), LEAST_SAMPLES);
        return Err(SignalsError::TooFewSamples { quantity, message, count, needed });
    }
    let values = command.values.iter().map(|&u| propulsion.thrust_from_command_n(u)).collect();
    let stream = Stream { time_s: command.time_s.clone(), width: channels.len(), values };
    let jitter = Some(jitter_thrust(&command, propulsion.thrust_curvature_n()));
    let (command, source) = (Some(command), ThrustSource::Command);
    let mut thrusts =
        RotorThrusts { stream, command, jitter, source, message: key.source, torque_std: 0.0, notes };
    match rebuilt(recording, &thrusts, &propulsion) {
        Some(Ok(faster)) => return Ok(faster),
        Some(Err(note)) => thrusts.notes.push(note),
        None => {}
    }
    Ok(thrusts)
}

/// The exponent of the curve by which the autopilot makes outputs of thrusts; 0 where it has none.
fn thrust_model(recording: &Recording) -> f64 {
    let expo = recording.autopilot.stack().map(|stack| stack.outputs.expo);
    expo.and_then(|expo| recording.parameters.get(expo).copied()).unwrap_or(0.0)
}

/// The output `u`, 0..1, at which a curve `(1 - expo) u + expo u^2` gives a share of thrust.
fn output_of_thrust(share: f64, expo: f64) -> f64 {
    if expo.abs() < 1e-9 {
        return share;
    }
    let linear = 1.0 - expo;
    ((linear * linear + 4.0 * expo * share.max(0.0)).sqrt() - linear) / (2.0 * expo)
}

/// Rotor thrusts from measured speeds. `None` if no speeds, hardly a sample with all rotors, or a rotor that never moves are recorded,
/// or if no thrust coefficient is known.
#[must_use]
pub fn thrusts_from_speeds(recording: &Recording, vehicle: &Vehicle) -> Option<RotorThrusts> {
    let coefficient = vehicle.propulsion.thrust_coefficient?;
    let rotors = vehicle.rotors.len();
    let all: Vec<usize> = (0..rotors).collect();
    let (key, raw) = best(recording, Quantity::RotorSpeed, |stream| stream.width >= rotors)?;
    refuse_still_rotors(recording, (key.source, raw), &all).ok()?;
    let mut stream = Stream { time_s: Vec::with_capacity(raw.len()), width: rotors, values: Vec::new() };
    stream.values.reserve(raw.len() * rotors);
    for index in 0..raw.len() {
        let speeds = &raw.sample(index)[..rotors];
        // a sensor drop-out is a missing sample, not a stopped rotor
        if speeds.iter().all(|speed| speed.abs() < LARGEST_VALUE) {
            stream.time_s.push(raw.time_s[index]);
            stream.values.extend(speeds.iter().map(|speed| coefficient * speed * speed));
        }
    }
    if stream.len() < LEAST_SAMPLES {
        return None;
    }
    let (source, message) = (ThrustSource::MeasuredSpeed, key.source);
    let notes = Vec::new();
    Some(RotorThrusts { stream, command: None, jitter: None, source, message, torque_std: 0.0, notes })
}

fn no_actuators(recording: &Recording, vehicle: &Vehicle) -> SignalsError {
    let unit = match vehicle.propulsion.actuator {
        Actuator::Pwm(Some(_)) => "pulse widths in microseconds",
        Actuator::Pwm(None) | Actuator::Speed | Actuator::Thrust => "values in 0..1",
    };
    let commands = || recording.streams.iter().filter(|(key, _)| key.quantity == Quantity::ActuatorCommand);
    let found: Vec<String> = commands()
        .map(|(key, stream)| {
            let largest = stream.values.iter().copied().filter(|v| v.is_finite()).fold(f64::NAN, f64::max);
            let still = if is_live(stream) { "" } else { ", which does not move" };
            format!("{} ({} channels, largest value {largest:.3}{still})", key.source, stream.width)
        })
        .collect();
    let rotors = vehicle.rotors.len();
    let channels = commands().map(|(_, stream)| stream.width).max().unwrap_or(0);
    let found = if found.is_empty() { "none".to_owned() } else { found.join(", ") };
    let found = format!("{found}. {}", actuators_wanted(rotors, channels));
    SignalsError::NoActuators { rotors, unit, found }
}

/// What to do for actuator outputs that fit the vehicle.
fn actuators_wanted(rotors: usize, channels: usize) -> String {
    if (1..rotors).contains(&channels) {
        return format!("Is it another vehicle's log, or is the frame wrong? Expected {rotors} channels");
    }
    "They must be in that unit and move. Record actuator outputs (over MAVLink SERVO_OUTPUT_RAW or \
     ACTUATOR_OUTPUT_STATUS), or correct `actuator`"
        .to_owned()
}

/// Whether values can have the vehicle's unit: most are within its range, and not in that of another unit.
fn in_unit(stream: &Stream, channels: &[usize], actuator: Actuator) -> bool {
    let range = match actuator {
        Actuator::Pwm(Some(range)) => {
            let span = range.max_us - range.min_us;
            range.min_us - 0.5 * span..=range.max_us + 0.25 * span
        }
        Actuator::Speed | Actuator::Thrust | Actuator::Pwm(None) => -1.05..=1.05,
    };
    let total = stream.len() * channels.len();
    let inside = (0..stream.len())
        .flat_map(|i| channels.iter().map(move |&channel| stream.sample(i)[channel]))
        .filter(|value| range.contains(value))
        .count();
    2 * inside > total
}

/// The propulsion of the vehicle file, corrected by the autopilot's parameters, with notes.
#[must_use]
pub fn propulsion_from_log(recording: &Recording, stated: &Propulsion) -> (Propulsion, Vec<Note>) {
    let mut propulsion = *stated;
    let mut notes = Vec::new();
    let mut note = |text: String| notes.push(Note::remark(About::Actuators, text));
    let stated_range = match stated.actuator {
        Actuator::Pwm(Some(range)) => Some(range),
        // an autopilot sends pulse widths whatever the file calls its commands
        Actuator::Speed | Actuator::Thrust if !holds_fractions(recording) => None,
        Actuator::Speed | Actuator::Thrust | Actuator::Pwm(None) => return (propulsion, Vec::new()),
    };
    let parameter = |name: &str| recording.parameters.get(name).copied();
    let outputs = recording.autopilot.stack().map(|stack| &stack.outputs);
    let range = outputs.and_then(|outputs| outputs.pulses.ends_us(parameter));
    let range = range.map(|(min_us, max_us)| PwmRange { min_us, max_us });
    let bus = bus_range(recording);
    if let Some(bus) = bus {
        if !stated_range.is_some_and(|stated| is_same(stated, bus)) {
            let (from, to) = (bus.min_us, bus.max_us);
            note(format!("the log's outputs are those of a bus, {from:.0} to {to:.0}, and no pulse widths"));
        }
        propulsion.actuator = Actuator::Pwm(Some(bus));
    }
    let range = range.filter(|_| bus.is_none());
    let expo = outputs.and_then(|outputs| parameter(outputs.expo));
    if let Some(range) = range.filter(|range| range.max_us > range.min_us) {
        let (from, to) = (range.min_us, range.max_us);
        let taken = format!("pulse range {from:.0} to {to:.0} us from the log's parameters");
        match stated_range {
            Some(stated) if is_same(stated, range) => {}
            Some(PwmRange { min_us, max_us }) => {
                note(format!("{taken}, the vehicle file says {min_us:.0} to {max_us:.0} us"));
            }
            None => note(format!("{taken}, the vehicle file states 0..1")),
        }
        propulsion.actuator = Actuator::Pwm(Some(range));
    }
    if let (Some(expo), ThrustLaw::Curve { thrust_max_n, expo: stated_expo }) = (expo, stated.law) {
        if (expo - stated_expo).abs() > 1e-6 {
            note(format!(
                "thrust curve exponent {expo:.3} from the log's parameters, the vehicle file says {stated_expo:.3}"
            ));
        }
        propulsion.law = ThrustLaw::Curve { thrust_max_n, expo };
    }
    (propulsion, notes)
}

/// Parameters are in single precision, and files are written by people.
fn is_same(a: PwmRange, b: PwmRange) -> bool {
    (a.min_us - b.min_us).abs() < 0.05 && (a.max_us - b.max_us).abs() < 0.05
}

/// Whether there is a stream of commands in 0..1. One that does not move is of outputs that are not used: zeros are no
/// fractions.
#[must_use]
pub fn holds_fractions(recording: &Recording) -> bool {
    moving_commands(recording).any(|stream| {
        let zeros = |channel: usize| (0..stream.len()).filter(|i| stream.sample(*i)[channel] == 0.0).count();
        let used = (0..stream.width).filter(|channel| 2 * zeros(*channel) < stream.len()).collect::<Vec<_>>();
        in_unit(stream, &used, Actuator::Speed)
    })
}

/// The range of outputs on a bus, where the log holds moving outputs that are no pulses by their size.
#[must_use]
pub fn bus_range(recording: &Recording) -> Option<PwmRange> {
    let max_us = f64::from(recording.autopilot.stack()?.outputs.bus?);
    let is_beyond = |stream: &Stream| {
        // the first motor
        let values = || stream.values.iter().step_by(stream.width.max(1)).filter(|value| value.is_finite());
        let beyond = values().filter(|value| **value > LONGEST_PULSE_US && **value <= max_us).count();
        5 * beyond > values().count()
    };
    moving_commands(recording).any(is_beyond).then_some(PwmRange { min_us: 0.0, max_us })
}

/// No output has a longer pulse, microseconds.
pub(super) const LONGEST_PULSE_US: f64 = 2500.0;

fn moving_commands(recording: &Recording) -> impl Iterator<Item = &Stream> {
    let commands = recording.streams.iter().filter(|(key, _)| key.quantity == Quantity::ActuatorCommand);
    commands.map(|(_, stream)| stream).filter(|stream| is_live(stream))
}

/// Output channel (from 0) of each motor, by the functions of the outputs; in order if the log does not contain them.
#[must_use]
pub fn motor_channels(recording: &Recording, rotors: usize, notes: &mut Vec<Note>) -> Vec<usize> {
    let Some(stack) = recording.autopilot.stack() else { return (0..rotors).collect() };
    let Outputs { function, .. } = &stack.outputs;
    let find = |motor: usize| {
        (1..=MOST_OUTPUTS).find(|&channel| {
            let drives = recording.parameters.get(&function.name(channel));
            drives.is_some_and(|drives| (drives - stack.outputs.motor(motor)).abs() < 0.5)
        })
    };
    let mapped: Option<Vec<usize>> = (0..rotors).map(|motor| find(motor).map(|c| c - 1)).collect();
    match mapped {
        Some(channels) => {
            if channels.iter().enumerate().any(|(motor, channel)| motor != *channel) {
                let text = format!(
                    "motors 1..{rotors} on output channels {channels:?} (from 0), from the log's parameters"
                );
                notes.push(Note::remark(About::Actuators, text));
            }
            channels
        }
        None => (0..rotors).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;
    use crate::vehicle::{Anchor, Limits, RigidBody, Rotor, Spin};
    use nalgebra::{Matrix3, Vector3};

    fn vehicle() -> Vehicle {
        let rotor = |x: f64, y: f64, spin| Rotor {
            name: format!("{x} {y}"),
            position_m: Vector3::new(x, y, 0.0),
            spin,
        };
        Vehicle {
            name: "a cross".to_owned(),
            body: RigidBody {
                mass_kg: 2.0,
                inertia_kg_m2: Matrix3::identity(),
                center_of_mass_m: Vector3::zeros(),
                gyroscopic: 1.0,
            },
            propulsion: Propulsion {
                actuator: Actuator::Speed,
                law: ThrustLaw::Speed { speed_max_rad_s: 1000.0 },
                thrust_coefficient: Some(1e-5),
                torque_per_thrust_m: 0.016,
                rotor_radius_m: None,
                time_constant_s: None,
                time_constant_down_s: None,
            },
            rotors: vec![
                rotor(0.2, 0.2, Spin::Cw),
                rotor(0.2, -0.2, Spin::Ccw),
                rotor(-0.2, -0.2, Spin::Cw),
                rotor(-0.2, 0.2, Spin::Ccw),
            ],
            limits: Limits::default(),
            anchor: Anchor::Thrust,
            guesses: Vec::new(),
            gravity_m_s2: 9.81,
        }
    }

    /// A recording of PX4 with a second of commands that go up and down by `step`, and its pulse range.
    fn recording(low: f64, step: f64) -> Recording {
        let key = StreamKey { quantity: Quantity::ActuatorCommand, source: "SERVO_OUTPUT_RAW", instance: 0 };
        let time_s: Vec<f64> = (0..100).map(|index| 0.01 * f64::from(index)).collect();
        let stream = Stream { time_s, width: 4, values: [[low; 4], [low + step; 4]].concat().repeat(50) };
        Recording {
            streams: [(key, stream)].into(),
            parameters: [("PWM_MAIN_MIN1".to_owned(), 1000.0), ("PWM_MAIN_MAX1".to_owned(), 2000.0)].into(),
            autopilot: Autopilot::Px4,
            ..Recording::default()
        }
    }

    #[test]
    fn pulses_of_a_vehicle_stated_in_fractions_are_read_by_the_autopilots_range() {
        let vehicle = vehicle();
        let (pulses, fractions) = (recording(1500.0, 100.0), recording(0.5, 0.1));
        let thrust_n = |recording: &Recording| {
            let thrusts = thrusts_from_commands(recording, &vehicle).unwrap();
            (thrusts.stream.values[0], thrusts.notes.len())
        };
        let (from_pulses_n, notes) = thrust_n(&pulses);
        // 1e-5 (0.5 * 1000)^2
        assert!((from_pulses_n - 2.5).abs() < 1e-12 && notes == 1);
        assert_eq!(thrust_n(&fractions), (from_pulses_n, 0));
        let unknown = Recording { parameters: [].into(), ..pulses };
        assert!(thrusts_from_commands(&unknown, &vehicle).is_err());
    }

    #[test]
    fn outputs_that_rest_at_nought_are_no_fractions_and_those_of_a_bus_no_pulses() {
        let mut recording = recording(2000.0, 4000.0);
        let key = |instance| StreamKey {
            quantity: Quantity::ActuatorCommand,
            source: "actuator_outputs",
            instance,
        };
        let still = Stream { time_s: vec![0.0, 1.0, 2.0], width: 1, values: vec![0.0; 3] };
        recording.streams.insert(key(0), still);
        assert!(!holds_fractions(&recording));
        let bus = PwmRange { min_us: 0.0, max_us: 8191.0 };
        assert_eq!(bus_range(&recording), Some(bus));
        let stated = Propulsion {
            actuator: Actuator::Pwm(Some(PwmRange { min_us: 1000.0, max_us: 2000.0 })),
            ..vehicle().propulsion
        };
        let (found, notes) = propulsion_from_log(&recording, &stated);
        assert_eq!((found.actuator, notes.len()), (Actuator::Pwm(Some(bus)), 1));
        assert!(notes[0].text.contains("those of a bus, 0 to 8191"), "{}", notes[0].text);
        assert_eq!(bus_range(&self::recording(1500.0, 100.0)), None);
    }

    #[test]
    fn shares_of_thrust_are_thrust_whatever_the_autopilots_curve_and_outputs() {
        let mut vehicle = vehicle();
        vehicle.propulsion.actuator = Actuator::Pwm(Some(PwmRange { min_us: 1000.0, max_us: 2000.0 }));
        vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 8.0, expo: 0.0 };
        let mut recording = recording(0.25, 0.5);
        let (_, stream) = recording.streams.pop_first().unwrap();
        let key = StreamKey { quantity: Quantity::ActuatorCommand, source: MOTORS, instance: 0 };
        recording.streams.insert(key, stream);
        // the functions of the outputs say nothing of the motors' own order
        recording.parameters.extend((1..=4).map(|n| (format!("PWM_MAIN_FUNC{n}"), f64::from(105 - n))));
        for expo in [0.0, 0.3, 1.0] {
            recording.parameters.insert("THR_MDL_FAC".to_owned(), expo);
            let thrusts = thrusts_from_commands(&recording, &vehicle).unwrap();
            assert_eq!(thrusts.message, MOTORS);
            assert!((thrusts.stream.values[0] - 2.0).abs() < 1e-9, "{expo}");
            assert!((thrusts.stream.values[4] - 6.0).abs() < 1e-9, "{expo}");
        }
    }
}
