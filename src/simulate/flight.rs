//! A synthetic identification flight, from seed to recording.

use std::fmt;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::SimulateError;
use super::controller::{CascadeController, CascadeGains, Setpoint};
use super::divergence::LOST_M;
use super::logger::{Logger, Measured};
use super::plant::{Plant, Push};
use super::reference::Reference;
use super::sensors::{NoiseLevels, TelemetrySettings};
use super::setting::{not_negative, positive, whole_steps};
use crate::physics::{ActiveEffect, Evaluation, Input, MAX_ROTORS, Model, State, Wrench};
use crate::recording::Recording;
use crate::vehicle::{Actuator, Propulsion, Vehicle};

/// Everything about a flight but vehicle, effects and reference. The defaults are those of the
/// practice recordings: 250 Hz control, 4 ms motors, telemetry as PX4 sends it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightSettings {
    /// seed of the noise; the same seed gives the same flight
    pub seed: u64,
    /// s, hover included
    pub duration_s: f64,
    /// integration step, s; control periods are whole multiples of it
    pub step_s: f64,
    /// period of the controller, s; commands are held so long
    pub control_period_s: f64,
    /// gains
    pub gains: CascadeGains,
    /// noise of the estimates that the controller flies on
    pub control_noise: NoiseLevels,
    /// factor on [`Self::control_noise`] (-)
    pub control_noise_scale: f64,
    /// first-order lag of the rotors, s; 0 lets them follow at once. A motor lag among the true effects comes in
    /// its place
    pub motor_time_constant_s: f64,
    /// time from command to its arrival at the motors, s, in whole steps
    pub transport_delay_s: f64,
    /// least command u (-)
    pub command_min: f64,
    /// V, at the start
    pub battery_v: f64,
    /// V/s by which the battery falls
    pub battery_drop_v_s: f64,
    /// the log
    pub telemetry: TelemetrySettings,
}

impl Default for FlightSettings {
    fn default() -> Self {
        Self {
            seed: 0,
            duration_s: 54.0,
            step_s: 0.002,
            control_period_s: 0.004,
            gains: CascadeGains::default(),
            control_noise: NoiseLevels::default(),
            control_noise_scale: 1.0,
            motor_time_constant_s: 0.004,
            transport_delay_s: 0.0,
            command_min: 0.02,
            battery_v: 16.4,
            battery_drop_v_s: 0.01,
            telemetry: TelemetrySettings::default(),
        }
    }
}

/// Something that no effect accounts for, as force and torque (body) at a time and state.
pub struct Disturbance(DisturbanceFn);

type DisturbanceFn = Box<dyn Fn(f64, &State) -> Wrench + Send + Sync>;

impl Disturbance {
    /// From a function of time (s) and state.
    pub fn new(push: impl Fn(f64, &State) -> Wrench + Send + Sync + 'static) -> Self {
        Self(Box::new(push))
    }
}

impl fmt::Debug for Disturbance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Disturbance")
    }
}

/// What flies: the true vehicle, the one that its controller believes in, and what is concealed.
#[derive(Debug)]
pub struct Truth {
    /// the true vehicle
    pub vehicle: Vehicle,
    /// what is on top of rigid body and motors
    pub effects: Vec<ActiveEffect>,
    /// and what is outside all effects
    pub disturbance: Option<Disturbance>,
}

impl Truth {
    /// A rigid body with exact thrust and nothing else.
    #[must_use]
    pub fn clean(vehicle: Vehicle) -> Self {
        Self { vehicle, effects: Vec::new(), disturbance: None }
    }
}

/// A recording and what made it.
#[derive(Debug)]
pub struct SimulatedFlight {
    /// as the log holds it
    pub recording: Recording,
    /// what flew
    pub truth: Truth,
    /// greatest distance from the reference, m
    pub tracking_error_max_m: f64,
    /// share of the control periods in which some command was at a bound (-)
    pub saturated: f64,
}

/// Flies `truth` along `reference` with a controller that believes `nominal`, and logs it.
///
/// ```
/// use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let pair = random_vehicle(11);
/// let reference = Reference { trajectory: RandomTrajectory::default().draw(12)?, hover_s: 4.0, ramp_s: 2.0 };
/// let settings = FlightSettings { duration_s: 8.0, ..FlightSettings::default() };
/// let flight = simulate_flight(Truth::clean(pair.truth), &pair.nominal, &reference, &settings)?;
/// assert!(flight.tracking_error_max_m < 1.0);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// If a vehicle or setting is not physical, or the flight leaves all bounds.
pub fn simulate_flight(
    truth: Truth,
    nominal: &Vehicle,
    reference: &Reference,
    settings: &FlightSettings,
) -> Result<SimulatedFlight, SimulateError> {
    let _stage = tracing::debug_span!("simulate", duration_s = settings.duration_s).entered();
    let mut effects = Vec::with_capacity(truth.effects.len() + 1);
    let own_lag = truth.effects.iter().any(ActiveEffect::is_rotor_lag);
    if not_negative("motor_time_constant_s", settings.motor_time_constant_s)? > 0.0 && !own_lag {
        effects.push(ActiveEffect::rotor_lag(settings.motor_time_constant_s));
    }
    effects.extend(truth.effects.iter().cloned());
    let model = Model::new(&truth.vehicle, effects)?;
    let ticks = Ticks::new(settings, model.command_delay_s())?;
    let push = truth.disturbance.as_ref().map(|disturbance| &*disturbance.0 as Push);
    let rotor_count = truth.vehicle.rotors.len();
    let mut logger =
        Logger::new(&settings.telemetry, rotor_count, settings.duration_s, settings.seed ^ LOG_SEED)?;
    let controller = CascadeController::new(nominal, settings.gains, settings.command_min)?;
    let mut flight_loop = Loop::new(controller, (settings, ticks), &truth.vehicle, reference)?;
    let start = reference.at(0.0);
    let state = State::at_rest(start.position_m, start.yaw_rad);
    let mut plant = Plant::new(&model, push, &state, &flight_loop.input(&model, 0))?;
    for step in 0..ticks.steps {
        let time_s = step as f64 * settings.step_s;
        if step.is_multiple_of(ticks.steps_a_tick) {
            // what the sensors show of the state does not depend on the force
            let seen = model.measure(&plant.state(), &Wrench::zero()).state;
            flight_loop.control(time_s, &plant.state(), (&seen, step))?;
        }
        let input = flight_loop.input(&model, step);
        logger.log(&flight_loop.measured(&model, (&plant.state(), &plant.evaluate(&input)), &input));
        plant.step(&input, settings.step_s);
    }
    let saturated = flight_loop.saturated_ticks as f64 / (ticks.steps / ticks.steps_a_tick).max(1) as f64;
    let tracking_error_max_m = flight_loop.tracking_error_max_m;
    Ok(SimulatedFlight { recording: logger.finish(), truth, tracking_error_max_m, saturated })
}

/// Keeps the log's noise apart from the controller's.
const LOG_SEED: u64 = 0x006c_6f67_6e6f_6973;

/// Durations as counts of steps.
#[derive(Debug, Clone, Copy)]
struct Ticks {
    steps: usize,
    steps_a_tick: usize,
    delay_steps: usize,
}

impl Ticks {
    /// `delay_s` is the effects' own, beside that of the settings.
    fn new(settings: &FlightSettings, delay_s: f64) -> Result<Self, SimulateError> {
        let step_s = positive("step_s", settings.step_s)?;
        let steps_a_tick = whole_steps("control_period_s", settings.control_period_s, step_s)?.max(1);
        let delay_steps = whole_steps("transport_delay_s", settings.transport_delay_s + delay_s, step_s)?;
        Ok(Self { steps: whole_steps("duration_s", settings.duration_s, step_s)?, steps_a_tick, delay_steps })
    }
}

/// The controller with its own view of the flight, and the commands under way to the motors.
struct Loop<'a> {
    controller: CascadeController,
    settings: &'a FlightSettings,
    ticks: Ticks,
    propulsion: Propulsion,
    reference: &'a Reference,
    noise: NoiseLevels,
    rng: Pcg64Mcg,
    estimate: State,
    setpoint: Setpoint,
    /// the last commands, one slot a control period, newest at [`Self::newest`]
    sent: Vec<[f64; MAX_ROTORS]>,
    newest: usize,
    rotor_count: usize,
    tracking_error_max_m: f64,
    saturated_ticks: usize,
}

impl<'a> Loop<'a> {
    fn new(
        controller: CascadeController,
        (settings, ticks): (&'a FlightSettings, Ticks),
        vehicle: &Vehicle,
        reference: &'a Reference,
    ) -> Result<Self, SimulateError> {
        let setpoint = reference.at(0.0);
        let rotor_count = vehicle.rotors.len();
        let hover_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / rotor_count as f64;
        let hover = [vehicle.propulsion.command_from_thrust(hover_n); MAX_ROTORS];
        Ok(Self {
            controller,
            settings,
            ticks,
            propulsion: vehicle.propulsion,
            reference,
            noise: settings
                .control_noise
                .scaled(not_negative("control_noise_scale", settings.control_noise_scale)?),
            rng: Pcg64Mcg::seed_from_u64(settings.seed),
            estimate: State::at_rest(setpoint.position_m, setpoint.yaw_rad),
            setpoint,
            sent: vec![hover; ticks.delay_steps / ticks.steps_a_tick + 2],
            newest: 0,
            rotor_count,
            tracking_error_max_m: 0.0,
            saturated_ticks: 0,
        })
    }

    /// One control period begins: a new estimate, a new command.
    fn control(
        &mut self,
        time_s: f64,
        state: &State,
        (seen, step): (&State, usize),
    ) -> Result<(), SimulateError> {
        self.setpoint = self.reference.at(time_s);
        self.estimate = self.noise.measure(&mut self.rng, seen);
        let commands =
            self.controller.commands(&self.setpoint, &self.estimate, self.settings.control_period_s);
        self.newest = (step / self.ticks.steps_a_tick) % self.sent.len();
        self.sent[self.newest] = commands;
        let bounds = (self.settings.command_min, 1.0);
        let at_bound = commands[..self.rotor_count].iter().any(|u| *u <= bounds.0 || *u >= bounds.1);
        self.saturated_ticks += usize::from(at_bound);
        let error_m = (state.position_m - self.setpoint.position_m).norm();
        self.tracking_error_max_m = self.tracking_error_max_m.max(error_m);
        if error_m < LOST_M { Ok(()) } else { Err(SimulateError::Diverged { time_s, what: "position" }) }
    }

    /// What acts on the vehicle during a step: the command that was sent one transport delay ago.
    fn input(&self, model: &Model, step: usize) -> Input {
        let now = step / self.ticks.steps_a_tick;
        let acting = match step.checked_sub(self.ticks.delay_steps) {
            Some(then) => (then / self.ticks.steps_a_tick) % self.sent.len(),
            // nothing has arrived yet: this slot still holds the hover command
            None => (now + 1) % self.sent.len(),
        };
        let time_s = step as f64 * self.settings.step_s;
        let battery_voltage_v = self.settings.battery_v - self.settings.battery_drop_v_s * time_s;
        Input {
            battery_voltage_v: Some(battery_voltage_v),
            ..Input::from_commands(&model.airframe, time_s, &self.sent[acting][..self.rotor_count])
        }
    }

    fn measured(&self, model: &Model, (state, now): (&State, &Evaluation), input: &Input) -> Measured {
        let mut actuators = self.sent[self.newest];
        for value in &mut actuators {
            *value = actuator_value(&self.propulsion, *value);
        }
        let rotor_speed_rad_s =
            model.airframe.hover_speed_rad_s.map(|hover_rad_s| now.rotors.speed.map(|n| n * hover_rad_s));
        let seen = model.measure(state, &now.wrench);
        Measured {
            time_s: input.time_s,
            state: seen.state,
            estimate: self.estimate,
            specific_force_m_s2: seen.specific_force_m_s2,
            actuators,
            rotor_speed_rad_s,
            setpoint: self.setpoint,
            battery_voltage_v: input.battery_voltage_v.unwrap_or(f64::NAN),
        }
    }
}

/// The normalised command u as the log holds it; inverse of [`Propulsion::normalized`].
fn actuator_value(propulsion: &Propulsion, u: f64) -> f64 {
    match propulsion.actuator {
        Actuator::Pwm(Some(range)) => range.min_us + u * (range.max_us - range.min_us),
        Actuator::Speed | Actuator::Thrust | Actuator::Pwm(None) => u,
    }
}

#[cfg(test)]
#[path = "flight_tests.rs"]
mod tests;
