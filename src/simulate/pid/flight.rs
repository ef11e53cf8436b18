//! A flight of the paper's closed loop.

use nalgebra::{SVector, Vector3, Vector4};

use super::control::{Feedback, Pid, PidSettings};
use super::log::Log;
use crate::physics::{Input, Model, RIGID_STATES, RigidBodyModel, State, Wrench, euler_rates};
use crate::recording::Recording;
use crate::simulate::SimulateError;
use crate::simulate::allocation::Allocation;
use crate::simulate::divergence::LOST_M;
use crate::simulate::integrator::rk4_step;
use crate::simulate::plant::{Plant, Push};
use crate::simulate::sensors::NoiseLevels;
use crate::simulate::setting::{positive, whole_steps};
use crate::trajectory::FourierTrajectory;
use crate::vehicle::Vehicle;

/// The simulation of section IV-A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PidFlightSettings {
    /// controller
    pub controller: PidSettings,
    /// s
    pub duration_s: f64,
    /// integration step, s
    pub step_s: f64,
    /// zero-order hold of p, psi and their rates, Hz
    pub motion_capture_hz: f64,
    /// zero-order hold of roll, pitch and their rates, Hz; the controller computes, and the log is
    /// written, each time they are new, so that the log holds the very force and torque that act
    pub inertial_hz: f64,
    /// noise of the log (not of the feedback) and its seed; `None` logs the truth
    pub log_noise: Option<(NoiseLevels, u64)>,
}

impl Default for PidFlightSettings {
    /// As printed in section IV-A; 50 s as in section III-D.
    fn default() -> Self {
        Self {
            controller: PidSettings::default(),
            duration_s: 50.0,
            step_s: 0.001,
            motion_capture_hz: 30.0,
            inertial_hz: 500.0,
            log_noise: None,
        }
    }
}

/// A flight of the closed loop.
#[derive(Debug, Clone, PartialEq)]
pub struct PidFlight {
    /// position, velocity, attitude, body rates and F as applied, at the inertial rate
    pub recording: Recording,
    /// greatest distance from the reference, m
    pub tracking_error_max_m: f64,
    /// share of the steps in which a component of F was at its bound (-)
    pub saturated: f64,
}

/// What is to be flown: value and four derivatives of x, y, z (m) and psi (rad) at a time (s).
pub type Path<'a> = &'a dyn Fn(f64) -> [[f64; 5]; 4];

/// Flies `body` along `reference` from rest at its first point; `push` is what the rigid body leaves out.
///
/// # Errors
/// If a setting is not positive, or the loop diverges.
pub fn simulate_pid_flight(
    body: &RigidBodyModel,
    reference: &FourierTrajectory,
    settings: &PidFlightSettings,
    push: Option<Push>,
) -> Result<PidFlight, SimulateError> {
    let path = |time_s: f64| reference.derivatives(time_s);
    let mut state = at_rest_on(&path);
    fly(&path, settings, &mut |f, instant| {
        state = advance((body, push), &state, f, instant);
        state
    })
}

/// Flies a vehicle with rotors and effects: F is shared out to the rotors of `vehicle`, whose commands
/// then go through the effects of `model`. A thrust below zero becomes zero.
///
/// # Errors
/// As [`simulate_pid_flight`]; also if the rotors do not span thrust and three torques.
pub fn simulate_pid_model_flight(
    (model, vehicle): (&Model, &Vehicle),
    path: Path,
    settings: &PidFlightSettings,
) -> Result<PidFlight, SimulateError> {
    let allocation = Allocation::new(vehicle, 0.0)?;
    let input_of = |f: &Vector4<f64>, time_s: f64| {
        let mut input = Input::from_commands(&model.airframe, time_s, &[]);
        for (speed, thrust_n) in input.speed_command.iter_mut().zip(allocation.thrusts_n(f).iter()) {
            *speed = model.airframe.relative_speed_of_thrust(*thrust_n);
        }
        input
    };
    let hover = Vector4::new(model.body.weight_n(), 0.0, 0.0, 0.0);
    let mut plant = Plant::new(model, None, &at_rest_on(path), &input_of(&hover, 0.0))?;
    fly(path, settings, &mut |f, (time_s, step_s)| {
        plant.step(&input_of(f, time_s), step_s);
        plant.state()
    })
}

fn at_rest_on(path: Path) -> State {
    let start = path(0.0).map(|axis| axis[0]);
    State::at_rest(Vector3::new(start[0], start[1], start[2]), start[3])
}

/// Moves the vehicle on by a step (time and length, s) under constant F.
type Advance<'a> = &'a mut dyn FnMut(&Vector4<f64>, (f64, f64)) -> State;

fn fly(path: Path, settings: &PidFlightSettings, advance: Advance) -> Result<PidFlight, SimulateError> {
    let step_s = positive("step_s", settings.step_s)?;
    let steps = whole_steps("duration_s", settings.duration_s, step_s)?;
    let mut motion_capture = Clock::new("motion_capture_hz", settings.motion_capture_hz)?;
    let mut inertial = Clock::new("inertial_hz", settings.inertial_hz)?;
    let mut pid = Pid::new(settings.controller);
    let mut log = Log::new(settings.log_noise);
    let mut state = at_rest_on(path);
    let mut seen = feedback(&state);
    let mut applied = Vector4::zeros();
    let (mut tracking_error_max_m, mut saturated_steps) = (0.0_f64, 0_usize);
    for step in 0..steps {
        let time_s = step as f64 * step_s;
        let now = feedback(&state);
        if motion_capture.due(time_s) {
            seen.position_m = now.position_m;
            seen.velocity_m_s = now.velocity_m_s;
            seen.euler_rad.z = now.euler_rad.z;
            seen.euler_rates_rad_s.z = now.euler_rates_rad_s.z;
        }
        let inertial_due = inertial.due(time_s);
        if inertial_due {
            seen.euler_rad.fixed_rows_mut::<2>(0).copy_from(&now.euler_rad.fixed_rows::<2>(0));
            let rates = now.euler_rates_rad_s.fixed_rows::<2>(0);
            seen.euler_rates_rad_s.fixed_rows_mut::<2>(0).copy_from(&rates);
        }
        let desired = path(time_s);
        if inertial_due {
            applied = pid.wrench(&desired, &seen, 1.0 / settings.inertial_hz);
            log.sample(time_s, &state, (&applied, &desired));
        }
        let error = Vector3::new(desired[0][0], desired[1][0], desired[2][0]) - state.position_m;
        tracking_error_max_m = tracking_error_max_m.max(error.norm());
        saturated_steps += usize::from(at_bound(&applied, &settings.controller));
        state = advance(&applied, (time_s, step_s));
        let away_m = state.position_m.norm();
        if away_m.is_nan() || away_m > LOST_M {
            return Err(SimulateError::Diverged { time_s, what: "position" });
        }
    }
    let saturated = saturated_steps as f64 / steps.max(1) as f64;
    Ok(PidFlight { recording: log.finish(), tracking_error_max_m, saturated })
}

/// What ideal sensors give.
pub(super) fn feedback(state: &State) -> Feedback {
    let (roll, pitch, yaw) = state.attitude.euler_angles();
    Feedback {
        position_m: state.position_m,
        velocity_m_s: state.velocity_m_s,
        euler_rad: Vector3::new(roll, pitch, yaw),
        euler_rates_rad_s: euler_rates(roll, pitch) * state.rates_rad_s,
    }
}

fn at_bound(f: &Vector4<f64>, settings: &PidSettings) -> bool {
    let torque = f.rows(1, 3).iter().any(|torque_nm| torque_nm.abs() >= settings.torque_max_nm);
    torque || f[0] <= 0.0 || f[0] >= settings.thrust_max_n
}

/// One step under constant F.
fn advance(
    (body, push): (&RigidBodyModel, Option<Push>),
    state: &State,
    f: &Vector4<f64>,
    (time_s, step_s): (f64, f64),
) -> State {
    let applied = Wrench::from_thrust_and_torque(f);
    let mut derivative = |time_s: f64, vector: &SVector<f64, RIGID_STATES>| {
        let state = State::read(vector);
        let wrench = push.map_or(applied, |push| applied + push(time_s, &state));
        let mut out = SVector::<f64, RIGID_STATES>::zeros();
        body.derivative(&state, &wrench).write(&mut out);
        out
    };
    let mut vector = SVector::<f64, RIGID_STATES>::zeros();
    state.write(&mut vector);
    State::read(&rk4_step(&mut derivative, time_s, &vector, step_s))
}

/// Tells when the next sample is due.
struct Clock {
    period_s: f64,
    taken: u32,
}

impl Clock {
    fn new(name: &'static str, rate_hz: f64) -> Result<Self, SimulateError> {
        Ok(Self { period_s: 1.0 / positive(name, rate_hz)?, taken: 0 })
    }

    /// True at the first call at or after each due time.
    fn due(&mut self, time_s: f64) -> bool {
        let due = time_s >= f64::from(self.taken) * self.period_s - 1e-9;
        self.taken += u32::from(due);
        due
    }
}
