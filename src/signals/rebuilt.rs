//! Motor commands that are logged at a low rate, rebuilt from the controller's torque and thrust setpoints.
//!
//! By default, both autopilots log their motors at 10 Hz, and the torque and thrust setpoints of their controllers at 50 Hz or
//! more. The allocation from setpoints to thrusts is linear. It is fitted to the logged samples, and its error is reported.

use nalgebra::{DMatrix, DVector};

use super::grid::cubic_at;
use super::rotor_thrusts::{RotorThrusts, ThrustSource};
use super::select::best;
use super::sufficient::{LEAST_ACTUATOR_HZ, flowing_rate_hz};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording, Stream};
use crate::vehicle::Propulsion;

/// Setpoints must come this many times as often as the commands.
const FASTER: f64 = 1.5;
/// A command and the setpoint that it was made from are logged in cycles of the controller that are up to so many of these apart, s.
const LATE_STEP_S: f64 = 0.001;
const LATE_STEPS: i32 = 10;
/// Least squared correlation of a torque that was asked for with that of the commands. With less, their spreads do not belong together.
const LEAST_ALIKE: f64 = 0.2;
/// The same from which on least squares err by less than the ratio of spreads does: at most 3 % on logs of ArduPilot's simulator whose
/// allocation is known.
const WELL_ALIKE: f64 = 0.95;
/// Relative standard error of a ratio of spreads: 1 to 10 % off on the same logs.
const STD_BY_SPREAD: f64 = 0.05;
/// Thrust setpoints further apart are no line between each other, s: PX4 logs them at 17 Hz by default.
const THRUST_GAP_S: f64 = 0.15;
/// Commands that are no linear function of the setpoints any more: at their ends.
const UNSATURATED: std::ops::Range<f64> = 0.02..0.98;
/// Fewer pairs than this fit five coefficients a rotor badly. They are twelve for each coefficient.
const LEAST_PAIRS: usize = 60;
/// Share of the commands' variance that the setpoints must explain. PX4's logs have 0.999, with its parameters unchanged.
const LEAST_EXPLAINED: f64 = 0.95;
/// Columns of the allocation: a constant, torque about x, y, z, thrust.
const COLUMNS: usize = 5;

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

/// A channel of a stream at a time, on the straight line between two samples; `None` outside of them and in gaps.
fn between(stream: &Stream, channel: usize, time_s: f64) -> Option<f64> {
    let after = stream.time_s.partition_point(|stamp_s| *stamp_s < time_s);
    let (next, next_s) = (stream.sample(after.min(stream.len() - 1))[channel], *stream.time_s.get(after)?);
    if after == 0 {
        return (next_s == time_s).then_some(next);
    }
    let (last, last_s) = (stream.sample(after - 1)[channel], stream.time_s[after - 1]);
    let span_s = next_s - last_s;
    (span_s <= THRUST_GAP_S).then(|| last + (next - last) * (time_s - last_s) / span_s)
}

/// Setpoints and commands of the same instants.
struct Pairs {
    /// a constant and the setpoints, a row an instant
    asked: DMatrix<f64>,
    /// thrusts, one column a rotor
    wanted: DMatrix<f64>,
}

impl Pairs {
    /// Commands that are not at their ends, with the setpoints `late_s` after their stamps; `None` where they are too few.
    fn of(asked: &Stream, (thrusts, command): (&Stream, &Stream), late_s: f64) -> Option<Self> {
        let unsaturated = |index: &usize| command.sample(*index).iter().all(|u| UNSATURATED.contains(u));
        let late = |index: usize| thrusts.time_s[index] + late_s;
        let within = |index: &usize| between(asked, 0, late(*index)).is_some();
        let used: Vec<usize> = (0..thrusts.len()).filter(unsaturated).filter(within).collect();
        if used.len() < LEAST_PAIRS {
            return None;
        }
        // the controller's noise changes between two samples
        let times_s: Vec<f64> = used.iter().map(|index| late(*index)).collect();
        let at = cubic_at(asked, &times_s)?;
        Some(Self {
            asked: DMatrix::from_fn(used.len(), COLUMNS, |row, column| {
                if column == 0 { 1.0 } else { at[row * asked.width + column - 1] }
            }),
            wanted: DMatrix::from_fn(used.len(), thrusts.width, |row, rotor| {
                thrusts.sample(used[row])[rotor]
            }),
        })
    }

    /// Mean square of what coefficients leave of a thrust, N^2.
    fn left(&self, coefficients: &DMatrix<f64>) -> f64 {
        (&self.wanted - &self.asked * coefficients).norm_squared() / self.wanted.len() as f64
    }

    /// Least squares. A setpoint that never moves has no coefficient: the least solution leaves it at nought.
    fn by_least_squares(&self) -> Option<DMatrix<f64>> {
        self.asked.clone().svd(true, true).solve(&self.wanted, 1e-9).ok()
    }

    /// Coefficients of least squares, or, where the commands follow a setpoint only in part, those by which the setpoint varies as much as
    /// `spread` (its variance at all samples) says; and the relative standard error of those of the torques about x and y, the greater
    /// one. Where the controller's answer to the noise of its gyroscopes changes between two setpoints, least squares do not know what the
    /// command was made of; both are of one process, so the ratio of their spreads stays right. `None` where the commands do not follow
    /// a torque that was asked for.
    fn evened(&self, mut coefficients: DMatrix<f64>, spread: &[f64]) -> Option<(DMatrix<f64>, f64)> {
        let shares = coefficients.rows(1, COLUMNS - 1).into_owned();
        let constant =
            DMatrix::from_fn(self.wanted.nrows(), shares.ncols(), |_, rotor| coefficients[(0, rotor)]);
        // what was asked for, by the commands
        let by_commands = (&self.wanted - constant) * shares.pseudo_inverse(1e-12).ok()?;
        let mut most = 0.0_f64;
        for column in 1..COLUMNS {
            let (logged, commanded) = (self.asked.column(column), by_commands.column(column - 1));
            let (of_logged, of_commanded) = (logged.variance(), commanded.variance());
            let of_all = spread[column - 1];
            if of_logged <= 0.0 || of_commanded <= 0.0 || of_all <= 0.0 {
                continue;
            }
            let means = (logged.mean(), commanded.mean());
            let products = logged.iter().zip(commanded.iter()).map(|(a, b)| (a - means.0) * (b - means.1));
            let together = products.sum::<f64>() / logged.len() as f64;
            let alike = together * together / (of_logged * of_commanded);
            let follows = alike >= WELL_ALIKE;
            if column < 3 {
                if alike < LEAST_ALIKE {
                    return None;
                }
                most = most.max(if follows { 2.0 * (1.0 - alike) } else { STD_BY_SPREAD });
            }
            if !follows && alike >= LEAST_ALIKE {
                coefficients.row_mut(column).scale_mut((of_commanded / of_all).sqrt());
            }
        }
        Some((coefficients, most))
    }
}

/// Variance of each channel of a stream over the span of these times.
fn variances(stream: &Stream, times_s: &[f64]) -> Vec<f64> {
    let (first_s, last_s) = (times_s.first().copied().unwrap_or(0.0), times_s.last().copied().unwrap_or(0.0));
    let inside = (0..stream.len()).filter(|&index| (first_s..=last_s).contains(&stream.time_s[index]));
    let inside: Vec<usize> = inside.collect();
    let of = |channel: usize| {
        let values = inside.iter().map(|&index| stream.sample(index)[channel]);
        DVector::from_iterator(inside.len(), values).variance()
    };
    (0..stream.width).map(of).collect()
}

/// From setpoints to one thrust a rotor.
struct Allocation {
    /// one column a rotor
    coefficients: DMatrix<f64>,
    /// relative standard error of those of the torques about x and y
    std: f64,
    /// share of the commands' variance
    explained: f64,
    /// what is left of one rotor's thrust, N, root mean square
    rms_n: f64,
}

impl Allocation {
    fn fit(asked: &Stream, thrusts: &Stream, command: &Stream) -> Result<Self, String> {
        // setpoints and commands are stamped at different places of the controller's cycle
        let at = |late: i32| {
            let pairs = Pairs::of(asked, (thrusts, command), f64::from(late) * LATE_STEP_S)?;
            let coefficients = pairs.by_least_squares()?;
            let left = pairs.left(&coefficients);
            Some((left, coefficients, pairs))
        };
        let each = (-LATE_STEPS..=LATE_STEPS).filter_map(at);
        let (_, coefficients, pairs) = each
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .ok_or_else(|| format!("fewer than {LEAST_PAIRS} of them have setpoints around them"))?;
        let (coefficients, std) = pairs
            .evened(coefficients, &variances(asked, &thrusts.time_s))
            .ok_or("they do not follow the torques about x and y that were asked for")?;
        let mut variance = 0.0;
        for rotor in 0..pairs.wanted.ncols() {
            let mean = pairs.wanted.column(rotor).mean();
            variance += pairs.wanted.column(rotor).map(|thrust_n| (thrust_n - mean).powi(2)).sum();
        }
        let left = pairs.left(&coefficients);
        let squares = left * pairs.wanted.len() as f64;
        Ok(Self {
            coefficients,
            std,
            explained: 1.0 - squares / variance.max(f64::MIN_POSITIVE),
            rms_n: left.sqrt(),
        })
    }

    fn applied(&self, asked: &Stream) -> Stream {
        let width = self.coefficients.ncols();
        let mut values = Vec::with_capacity(asked.len() * width);
        for index in 0..asked.len() {
            let row = DVector::from_iterator(
                COLUMNS,
                std::iter::once(1.0).chain(asked.sample(index).iter().copied()),
            );
            // a rotor does not pull downwards
            values.extend(self.coefficients.tr_mul(&row).iter().map(|thrust_n| thrust_n.max(0.0)));
        }
        Stream { time_s: asked.time_s.clone(), width, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;
    use crate::vehicle::{Actuator, ThrustLaw};

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
