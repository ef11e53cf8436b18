//! Closed loop: the flight flown again by a simulated vehicle, and the ten signals of Table 4.

use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

use super::CompareError;
use super::mean_square::MeanSquare;
use crate::physics::{Input, MAX_ROTORS, Model, State};
use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{Grid, Signals, best, linear_onto};
use crate::simulate::pid::{PidFlightSettings, simulate_pid_model_flight};
use crate::simulate::{AutopilotCascade, AutopilotGains, Plant, Setpoint, SimulateError};
use crate::vehicle::Vehicle;
use std::collections::VecDeque;

/// The signals of Table 4 and their units.
pub const SIGNALS: [(&str, &str); 10] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("phi", "deg"),
    ("theta", "deg"),
    ("psi", "deg"),
    ("F_z", "N"),
    ("tau_phi", "N m"),
    ("tau_theta", "N m"),
    ("tau_psi", "N m"),
];

/// Position (m), roll, pitch, yaw (deg, as the paper's tables have it), force and torque (N, N m) along
/// time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TenSignals {
    /// s
    pub time_s: Vec<f64>,
    /// in the order of [`SIGNALS`]
    pub values: Vec<[f64; 10]>,
}

impl TenSignals {
    /// Of a conditioned flight.
    ///
    /// # Errors
    /// If position or attitude are missing.
    pub fn of_signals(signals: &Signals) -> Result<Self, CompareError> {
        let missing = |what| CompareError::Missing { what, purpose: "the closed-loop comparison" };
        let position = signals.position.as_ref().ok_or_else(|| missing("position"))?;
        let attitude = signals.attitude.as_ref().ok_or_else(|| missing("attitude"))?;
        let mut all = Self::default();
        for (index, wrench) in signals.wrench.iter().enumerate() {
            all.push(signals.grid.time_s(index), (&position[index], &attitude[index]), wrench);
        }
        Ok(all)
    }

    /// Of a recording that holds force and torque, sample by sample.
    ///
    /// # Errors
    /// If position, attitude, or force and torque are missing.
    pub fn of_recording(recording: &Recording) -> Result<Self, CompareError> {
        let stream = |quantity, width, what| {
            best(recording, quantity, |stream| stream.width == width)
                .map(|(_, stream)| stream)
                .ok_or(CompareError::Missing { what, purpose: "the closed-loop comparison" })
        };
        let position = stream(Quantity::Position, 3, "position")?;
        let attitude = stream(Quantity::Attitude, 4, "attitude")?;
        let wrench = stream(Quantity::Wrench, 4, "force and torque")?;
        let mut all = Self::default();
        for index in 0..position.len().min(attitude.len()).min(wrench.len()) {
            let q = attitude.sample(index);
            let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
            let place = Vector3::from_column_slice(position.sample(index));
            let applied = Vector4::from_column_slice(wrench.sample(index));
            all.push(position.time_s[index], (&place, &turn), &applied);
        }
        Ok(all)
    }

    fn push(
        &mut self,
        time_s: f64,
        (position, attitude): (&Vector3<f64>, &UnitQuaternion<f64>),
        wrench: &Vector4<f64>,
    ) {
        let (roll, pitch, yaw) = attitude.euler_angles();
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_degrees);
        let (p, w) = (position, wrench);
        self.time_s.push(time_s);
        self.values.push([p.x, p.y, p.z, roll, pitch, yaw, w[0], w[1], w[2], w[3]]);
    }

    /// RMS of the difference of each signal from `from_s` to `to_s`, `other` interpolated to this one's
    /// instants. Angles go the short way round. `None` where both share no instant.
    #[must_use]
    pub fn rms_errors(&self, other: &Self, span_s: (f64, f64)) -> Option<[f64; 10]> {
        let mut sums = [MeanSquare::default(); 10];
        for (_, squares) in self.square_errors(other, span_s) {
            sums.iter_mut().zip(squares).for_each(|(sum, square)| sum.add(square));
        }
        let roots: Vec<f64> = sums.iter().filter_map(MeanSquare::root).collect();
        roots.try_into().ok()
    }

    /// Squared differences behind [`Self::rms_errors`], instant by instant (s of the vehicle's clock).
    #[must_use]
    pub fn square_errors(&self, other: &Self, (from_s, to_s): (f64, f64)) -> Vec<(f64, [f64; 10])> {
        let mut out = Vec::with_capacity(self.time_s.len());
        let mut right = 1;
        for (time_s, mine) in self.time_s.iter().zip(&self.values) {
            while right + 1 < other.time_s.len() && other.time_s[right] < *time_s {
                right += 1;
            }
            let inside = *time_s >= from_s && *time_s <= to_s;
            let bracket = other.time_s.get(right - 1).zip(other.time_s.get(right));
            let Some((a, b)) = bracket.filter(|(a, b)| inside && *a <= time_s && time_s <= b) else {
                continue;
            };
            let share = (time_s - a) / (b - a).max(f64::MIN_POSITIVE);
            let square = |signal: usize| {
                let angle = SIGNALS[signal].1 == "deg";
                let (low, high) = (other.values[right - 1][signal], other.values[right][signal]);
                let there = low + share * shortest(high - low, angle);
                shortest(mine[signal] - there, angle).powi(2)
            };
            out.push((*time_s, std::array::from_fn(square)));
        }
        out
    }
}

/// A difference of angles (deg) brought to -180..180.
fn shortest(difference: f64, angle: bool) -> f64 {
    if angle { difference - 360.0 * (difference / 360.0).round() } else { difference }
}

/// What was asked for, sampled evenly.
struct Asked {
    grid: Grid,
    time_s: Vec<f64>,
    /// position 3, velocity 3, acceleration 3, yaw, one instant after the other
    values: Vec<[f64; 10]>,
}

/// Spacing of the setpoints as the controllers read them, s.
const SETPOINT_STEP_S: f64 = 0.01;

impl Asked {
    fn of(recording: &Recording) -> Result<Self, CompareError> {
        let purpose = "flying it again";
        let stream = |quantity, width| {
            best(recording, quantity, |stream: &Stream| stream.width == width && stream.len() > 1)
                .map(|(_, stream)| stream)
        };
        let position = stream(Quantity::PositionSetpoint, 3)
            .ok_or(CompareError::Missing { what: "position setpoints", purpose })?;
        let yaw = stream(Quantity::YawSetpoint, 1)
            .ok_or(CompareError::Missing { what: "yaw setpoints", purpose })?;
        let (from_s, to_s) = (position.time_s[0], position.time_s[position.len() - 1]);
        let grid = Grid::covering(from_s, to_s, SETPOINT_STEP_S);
        let on_grid = |stream: Option<&Stream>, width: usize| {
            stream.and_then(|s| linear_onto(s, 0.0, &grid)).unwrap_or_else(|| vec![0.0; grid.count * width])
        };
        let place = on_grid(Some(position), 3);
        let velocity = on_grid(stream(Quantity::VelocitySetpoint, 3), 3);
        let acceleration = on_grid(stream(Quantity::AccelerationSetpoint, 3), 3);
        let heading = on_grid(Some(yaw), 1);
        let row = |i: usize| {
            std::array::from_fn(|k| match k {
                0..3 => place[3 * i + k],
                3..6 => velocity[3 * i + k - 3],
                6..9 => acceleration[3 * i + k - 6],
                _ => heading[i],
            })
        };
        let time_s = (0..grid.count).map(|i| grid.time_s(i)).collect();
        Ok(Self { grid, time_s, values: (0..grid.count).map(row).collect() })
    }

    fn end_s(&self) -> f64 {
        self.grid.time_s(self.grid.count.saturating_sub(1))
    }

    /// Straight lines between instants; yaw and its rate last.
    fn at(&self, time_s: f64) -> [f64; 11] {
        let last = self.grid.count.saturating_sub(1);
        let after = self.time_s.partition_point(|instant_s| *instant_s <= time_s);
        let left = after.saturating_sub(1).min(last.saturating_sub(1));
        let share = ((time_s - self.grid.time_s(left)) / self.grid.step_s).clamp(0.0, 1.0);
        let (a, b) = (&self.values[left], &self.values[(left + 1).min(last)]);
        std::array::from_fn(|k| match k {
            0..9 => a[k] + share * (b[k] - a[k]),
            9 => a[9] + share * shortest((b[9] - a[9]).to_degrees(), true).to_radians(),
            _ => shortest((b[9] - a[9]).to_degrees(), true).to_radians() / self.grid.step_s,
        })
    }
}

/// The recorded setpoints flown by the paper's PID (28) to (32) with this model.
///
/// # Errors
/// If the recording holds no setpoints, or the loop diverges.
pub fn resimulated(
    recording: &Recording,
    flown: (&Model, &Vehicle),
    settings: &PidFlightSettings,
) -> Result<TenSignals, CompareError> {
    let asked = Asked::of(recording)?;
    let start_s = asked.grid.start_s;
    let settings = PidFlightSettings { duration_s: asked.end_s() - start_s, ..*settings };
    let path = |time_s: f64| {
        let now = asked.at(start_s + time_s);
        let axis = |k: usize| [now[k], now[k + 3], now[k + 6], 0.0, 0.0];
        [axis(0), axis(1), axis(2), [now[9], now[10], 0.0, 0.0, 0.0]]
    };
    let flight = simulate_pid_model_flight(flown, &path, &settings)?;
    let mut signals = TenSignals::of_recording(&flight.recording)?;
    signals.time_s.iter_mut().for_each(|time_s| *time_s += start_s);
    Ok(signals)
}

/// By how much the recorded flight itself was off its setpoints in x, y, z, RMS, m, from `from_s` to `to_s`. So
/// much of the closed-loop errors is the recorded controller's own, and no model of the vehicle mends it.
///
/// # Errors
/// If the recording holds no setpoints.
pub fn recorded_tracking_m(
    recording: &Recording,
    recorded: &TenSignals,
    (from_s, to_s): (f64, f64),
) -> Result<Option<[f64; 3]>, CompareError> {
    let asked = Asked::of(recording)?;
    let span_s = from_s.max(asked.grid.start_s)..=to_s.min(asked.end_s());
    let mut sums = [MeanSquare::default(); 3];
    for (time_s, flown) in recorded.time_s.iter().zip(&recorded.values) {
        if span_s.contains(time_s) {
            let wanted = asked.at(*time_s);
            for (sum, (flown, wanted)) in sums.iter_mut().zip(flown.iter().zip(wanted)) {
                sum.add((flown - wanted).powi(2));
            }
        }
    }
    let roots: Vec<f64> = sums.iter().filter_map(MeanSquare::root).collect();
    Ok(roots.try_into().ok())
}

/// The recorded setpoints flown with this model by a cascade as PX4 and ArduPilot have, with its default gains:
/// for logs of autopilots, whose own gains and estimates are not known. It flies on exact states and
/// believes `nominal`, so that every model is flown alike.
///
/// # Errors
/// If the recording holds no setpoints, the loop diverges, or rotors cannot set all torques.
pub fn autopilot_flight(
    recording: &Recording,
    model: &Model,
    nominal: &Vehicle,
) -> Result<TenSignals, CompareError> {
    const PERIOD_S: f64 = 0.004;
    const STEPS: u32 = 2;
    let asked = Asked::of(recording)?;
    let mut controller = AutopilotCascade::new(nominal, AutopilotGains::default(), 0.0)?;
    let first = asked.at(asked.grid.start_s);
    let state = State::at_rest(Vector3::new(first[0], first[1], first[2]), first[9]);
    let mut hover = Input::from_commands(&model.airframe, 0.0, &[]);
    hover.speed_command[..model.airframe.rotor_count()].fill(1.0);
    let mut plant = Plant::new(model, None, &state, &hover)?;
    let (mixer, mut all) = (nominal.mixer(), TenSignals::default());
    let mut under_way: VecDeque<[f64; MAX_ROTORS]> = VecDeque::new();
    let mut time_s = asked.grid.start_s;
    while time_s < asked.end_s() {
        let now = asked.at(time_s);
        let vector = |k: usize| Vector3::new(now[k], now[k + 1], now[k + 2]);
        let setpoint = Setpoint {
            position_m: vector(0),
            velocity_m_s: vector(3),
            acceleration_m_s2: vector(6),
            yaw_rad: now[9],
            yaw_rate_rad_s: now[10],
        };
        let state = plant.state();
        if !(state.position_m - setpoint.position_m).norm().is_finite() {
            return Err(SimulateError::Diverged { time_s, what: "position" }.into());
        }
        let commands = controller.commands(&setpoint, &state, PERIOD_S);
        let thrusts_n = commands.map(|u| nominal.propulsion.thrust_from_command_n(u));
        all.push(time_s, (&state.position_m, &state.attitude), &mixer.wrench(&thrusts_n));
        under_way.push_back(commands);
        // as many periods late as the delay has
        while under_way.len() > 1
            && (under_way.len() - 1) as f64 * PERIOD_S > model.command_delay_s() + 0.5 * PERIOD_S
        {
            under_way.pop_front();
        }
        let acting = under_way.front().unwrap_or(&commands);
        for step in 0..STEPS {
            let step_s = PERIOD_S / f64::from(STEPS);
            let input = Input::from_commands(&model.airframe, time_s + f64::from(step) * step_s, acting);
            plant.step(&input, step_s);
        }
        time_s += PERIOD_S;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::{ConditionSettings, condition};
    use crate::simulate::{
        FlightSettings, RandomTrajectory, Reference, TelemetrySettings, Truth, random_vehicle,
        simulate_flight,
    };

    #[test]
    fn an_autopilots_flight_flown_again_tells_a_wrong_mass_by_its_thrust() {
        let vehicle = random_vehicle(11).truth;
        let trajectory = RandomTrajectory::default().draw(11).unwrap();
        let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
        let telemetry = TelemetrySettings { noise_scale: 0.0, ..TelemetrySettings::default() };
        let settings = FlightSettings {
            duration_s: 30.0,
            control_noise_scale: 0.0,
            motor_time_constant_s: 0.0,
            telemetry,
            ..FlightSettings::default()
        };
        let flight = simulate_flight(Truth::clean(vehicle.clone()), &vehicle, &reference, &settings).unwrap();
        let signals = condition(&flight.recording, &vehicle, &ConditionSettings::default()).unwrap();
        let recorded = TenSignals::of_signals(&signals).unwrap();
        let span_s = (10.0, 29.0);
        let off_m = recorded_tracking_m(&flight.recording, &recorded, span_s).unwrap().unwrap();
        assert!(off_m.iter().all(|off_m| *off_m < 0.1 && *off_m <= flight.tracking_error_max_m), "{off_m:?}");
        assert_eq!(recorded_tracking_m(&flight.recording, &recorded, (900.0, 901.0)).unwrap(), None);
        let errors = |mass: f64| {
            let mut flown = vehicle.clone();
            flown.body.mass_kg *= mass;
            let model = Model::new(&flown, vec![]).unwrap();
            let again = autopilot_flight(&flight.recording, &model, &vehicle).unwrap();
            recorded.rms_errors(&again, span_s).unwrap()
        };
        let (right, heavy) = (errors(1.0), errors(1.1));
        let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
        assert!(right[6] < 0.03 * weight_n && heavy[6] > 0.08 * weight_n, "{right:?} {heavy:?}");
        // the loops hold position and heading whatever the mass
        assert!(right[..3].iter().chain(&heavy[..3]).all(|error_m| *error_m < 0.3), "{right:?} {heavy:?}");
    }
}
