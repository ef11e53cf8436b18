//! Motor commands that are logged at a low rate, rebuilt from the controller's torque and thrust setpoints.
//!
//! By default, both autopilots log their motors at 10 Hz, and the torque and thrust setpoints of their controllers at 50 Hz or
//! more. The allocation from setpoints to thrusts is linear. It is fitted to the logged samples, and its error is reported.

use super::allocation::{Allocation, between};
use super::rotor_thrusts::{RotorThrusts, ThrustSource};
use super::select::best;
use super::sufficient::{LEAST_ACTUATOR_HZ, flowing_rate_hz};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording, Stream};
use crate::vehicle::Propulsion;

/// Setpoints must come this many times as often as the commands.
const FASTER: f64 = 1.5;
/// Share of the commands' variance that the setpoints must explain. PX4's logs have 0.999, with its parameters unchanged.
const LEAST_EXPLAINED: f64 = 0.95;

/// Thrusts at the setpoints' rate, in place of those at the slower commands' rate; a note where that does not succeed.
/// `None` where the commands are fast enough, or nothing faster is logged.
pub(super) fn rebuilt(
    recording: &Recording,
    slow: &RotorThrusts,
    propulsion: &Propulsion,
) -> Option<Result<RotorThrusts, Note>> {
    let command = slow.command.as_ref()?;
    let slow_hz = flowing_rate_hz(&slow.stream);
    if slow_hz >= LEAST_ACTUATOR_HZ {
        return None;
    }
    let asked = Asked::of(recording)?;
    let asked_hz = flowing_rate_hz(&asked.stream);
    if asked_hz < FASTER * slow_hz {
        return None;
    }
    let note = |text: String| Note::remark(About::Actuators, text);
    let source = asked.source;
    let begin = format!("motor commands ({}) are logged at {slow_hz:.0} Hz", slow.message);
    let allocation = match Allocation::fit(&asked.stream, &slow.stream, command) {
        Ok(allocation) => allocation,
        Err(why) => return Some(Err(note(format!("{begin}, and are not rebuilt from {source}: {why}")))),
    };
    let told = format!(
        "{source} at {asked_hz:.0} Hz explains {:.2} % of their variance and leaves {:.3} N a rotor, rms; its torques about x and y are \
         known to {:.1} %",
        100.0 * allocation.explained,
        allocation.rms_n,
        100.0 * allocation.std
    );
    if allocation.explained < LEAST_EXPLAINED {
        return Some(Err(note(format!("{begin}, and are not rebuilt: {told}"))));
    }
    let stream = allocation.applied(&asked.stream);
    let values = stream.values.iter().map(|thrust_n| propulsion.command_from_thrust(*thrust_n)).collect();
    let command = Some(Stream { values, ..stream.clone() });
    let mut notes = slow.notes.clone();
    notes.push(note(format!("{begin}, and are rebuilt: {told}")));
    let source = ThrustSource::Command;
    let torque_std = allocation.std;
    Some(Ok(RotorThrusts { stream, command, jitter: None, source, message: asked.source, torque_std, notes }))
}

/// What the controller asked for: torque about x, y, z and thrust, as shares.
struct Asked {
    stream: Stream,
    source: &'static str,
}

impl Asked {
    fn of(recording: &Recording) -> Option<Self> {
        let (key, torque) = best(recording, Quantity::TorqueSetpoint, |stream| stream.width == 3)?;
        // along the body's z, or alone
        let (thrust, along) = best(recording, Quantity::ThrustVectorSetpoint, |stream| stream.width == 3)
            .map(|(_, stream)| (stream, 2))
            .or_else(|| {
                best(recording, Quantity::ThrustSetpoint, |stream| stream.width == 1)
                    .map(|(_, stream)| (stream, 0))
            })?;
        let mut stream = Stream { time_s: Vec::with_capacity(torque.len()), width: 4, values: Vec::new() };
        for index in 0..torque.len() {
            let time_s = torque.time_s[index];
            // the thrust moves more slowly than the torque, and is logged more seldom
            let Some(thrust) = between(thrust, along, time_s) else { continue };
            let torque = torque.sample(index);
            if thrust.is_finite() && torque.iter().all(|value| value.is_finite()) {
                stream.time_s.push(time_s);
                stream.values.extend(torque.iter().chain([&thrust]));
            }
        }
        (!stream.is_empty()).then_some(Self { stream, source: key.source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;
    use crate::signals::allocation::STD_BY_SPREAD;
    use crate::vehicle::{Actuator, ThrustLaw};
    use rand::{RngExt, SeedableRng};

    const CURVE: Propulsion = Propulsion {
        actuator: Actuator::Thrust,
        law: ThrustLaw::Curve { thrust_max_n: 6.0, expo: 0.5 },
        thrust_coefficient: None,
        torque_per_thrust_m: 0.02,
        rotor_radius_m: None,
        time_constant_s: None,
        time_constant_down_s: None,
    };

    /// Shares of thrust of a quadrotor X that is asked for these at a time; the last is the thrust.
    fn asked(time_s: f64) -> [f64; 4] {
        [
            0.05 * (3.0 * time_s).sin(),
            0.04 * (4.1 * time_s).cos(),
            0.02 * (1.7 * time_s).sin(),
            0.5 + 0.1 * time_s.sin(),
        ]
    }

    fn share(rotor: usize, [x, y, z, thrust]: [f64; 4]) -> f64 {
        let signs = [[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]][rotor];
        thrust + signs[0] * x + signs[1] * y + signs[2] * z
    }

    /// Setpoints at 50 Hz and motors' thrusts at 10 Hz, with a disturbance of the commands that no setpoint shows.
    fn log(disturbance_n: f64) -> (Recording, RotorThrusts) {
        let key = |quantity| StreamKey { quantity, source: "vehicle_torque_setpoint", instance: 0 };
        let fast_s: Vec<f64> = (0..1500).map(|index| 0.02 * f64::from(index)).collect();
        let torque = fast_s.iter().flat_map(|t| asked(*t)[..3].to_vec()).collect();
        // the thrust at a third of the torque's rate, as PX4 logs it
        let seldom_s: Vec<f64> = fast_s.iter().copied().step_by(3).chain([29.98]).collect();
        let thrust = seldom_s.iter().flat_map(|t| [0.0, 0.0, asked(*t)[3]]).collect();
        let streams = [
            (key(Quantity::TorqueSetpoint), Stream { time_s: fast_s.clone(), width: 3, values: torque }),
            (key(Quantity::ThrustVectorSetpoint), Stream { time_s: seldom_s, width: 3, values: thrust }),
        ]
        .into();
        let recording = Recording { streams, ..Recording::default() };
        let time_s: Vec<f64> = (0..300).map(|index| 0.1 * f64::from(index)).collect();
        let thrust_n = |t: f64, rotor: usize| {
            6.0 * share(rotor, asked(t)) + disturbance_n * (37.0 * t + 2.0 * rotor as f64).sin()
        };
        let values: Vec<f64> =
            time_s.iter().flat_map(|t| (0..4).map(|rotor| thrust_n(*t, rotor)).collect::<Vec<_>>()).collect();
        let command = values.iter().map(|thrust_n| CURVE.command_from_thrust(*thrust_n)).collect();
        let stream = Stream { time_s, width: 4, values };
        let command = Some(Stream { values: command, ..stream.clone() });
        let source = ThrustSource::Command;
        (
            recording,
            RotorThrusts {
                stream,
                command,
                jitter: None,
                source,
                message: "actuator_motors",
                torque_std: 0.0,
                notes: Vec::new(),
            },
        )
    }

    #[test]
    fn commands_are_rebuilt_at_the_rate_of_the_setpoints() {
        let (recording, slow) = log(0.0);
        let fast = rebuilt(&recording, &slow, &CURVE).unwrap().unwrap();
        assert_eq!(fast.stream.len(), 1500);
        for index in [0, 333, 1499] {
            let expected = asked(fast.stream.time_s[index]);
            for rotor in 0..4 {
                assert!((fast.stream.sample(index)[rotor] - 6.0 * share(rotor, expected)).abs() < 2e-3);
            }
        }
        assert!(
            fast.notes[0].text.contains("logged at 10 Hz, and are rebuilt: vehicle_torque_setpoint at 50 Hz")
        );
        let command = fast.command.unwrap();
        assert!((CURVE.thrust_from_command_n(command.values[7]) - fast.stream.values[7]).abs() < 1e-9);
    }

    /// Setpoints whose torque about x has noise that another cycle does not have, beside a mean, and the thrusts of such cycles.
    fn noisy_log(slow_part: f64) -> (Recording, RotorThrusts) {
        let (mut recording, mut slow) = log(0.0);
        let mut dice = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let mut noise = || 0.02 * dice.random_range(-1.0..1.0);
        let at = |time_s: f64, noise: f64| {
            let [x, y, z, thrust] = asked(time_s);
            [slow_part * x + 0.03 + noise, y, z, thrust]
        };
        for (key, stream) in &mut recording.streams {
            if key.quantity == Quantity::TorqueSetpoint {
                for (index, time_s) in stream.time_s.iter().enumerate() {
                    stream.values[3 * index] = at(*time_s, noise())[0];
                }
            }
        }
        for (index, time_s) in slow.stream.time_s.clone().into_iter().enumerate() {
            let of_cycle = at(time_s, noise());
            for rotor in 0..4 {
                slow.stream.values[4 * index + rotor] = 6.0 * share(rotor, of_cycle);
            }
        }
        let command =
            slow.stream.values.iter().map(|thrust_n| CURVE.command_from_thrust(*thrust_n)).collect();
        slow.command = Some(Stream { values: command, ..slow.stream.clone() });
        (recording, slow)
    }

    #[test]
    fn noise_of_another_cycle_lowers_no_torque_and_moves_no_mean() {
        let (recording, slow) = noisy_log(0.6);
        let fast = rebuilt(&recording, &slow, &CURVE).unwrap().unwrap();
        assert_eq!(fast.torque_std, STD_BY_SPREAD);
        let setpoints = recording.streams.iter().find(|(key, _)| key.quantity == Quantity::TorqueSetpoint);
        let torque = setpoints.unwrap().1;
        let about_x = |index: usize| {
            let thrusts_n = fast.stream.sample(index);
            0.25 * (thrusts_n[1] + thrusts_n[2] - thrusts_n[0] - thrusts_n[3])
        };
        let pairs = || (100..1400).map(|index| (torque.values[3 * index], about_x(index)));
        let means = pairs().fold((0.0, 0.0), |sum, (x, n)| (sum.0 + x / 1300.0, sum.1 + n / 1300.0));
        let (slope, square) = pairs().fold((0.0, 0.0), |(slope, square), (x, n)| {
            (slope + (x - means.0) * (n - means.1), square + (x - means.0).powi(2))
        });
        // least squares alone give about three quarters of it
        assert!((slope / square / 6.0 - 1.0).abs() < 0.08, "{}", slope / square);
        assert!((means.1 / (6.0 * means.0) - 1.0).abs() < 0.1, "{means:?}");
    }

    #[test]
    fn commands_that_do_not_follow_a_torque_are_not_rebuilt() {
        let (recording, slow) = noisy_log(0.0);
        let note = rebuilt(&recording, &slow, &CURVE).unwrap().unwrap_err();
        assert!(note.text.contains("do not follow the torques about x and y"), "{}", note.text);
    }

    #[test]
    fn what_the_setpoints_do_not_explain_is_not_rebuilt() {
        let (recording, slow) = log(1.0);
        let note = rebuilt(&recording, &slow, &CURVE).unwrap().unwrap_err();
        assert!(note.text.contains("are not rebuilt"), "{}", note.text);
    }

    #[test]
    fn fast_commands_and_logs_without_setpoints_stay_as_they_are() {
        let (recording, mut slow) = log(0.0);
        assert!(rebuilt(&Recording::default(), &slow, &CURVE).is_none());
        slow.stream.time_s.iter_mut().for_each(|time_s| *time_s *= 0.1);
        assert!(rebuilt(&recording, &slow, &CURVE).is_none());
    }
}
