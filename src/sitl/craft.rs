//! The vehicle itself: what the outputs of the autopilot do to it, and what sensors without noise show.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use super::{Settings, SitlError};
use crate::physics::{ActiveEffect, Input, MAX_ROTORS, Model, State, Wrench};
use crate::simulate::{GroundContact, GroundSettings, Plant, PlantMemory};

/// What sensors without noise show at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct IdealSensors {
    /// motion
    pub(super) state: State,
    /// accelerometer, m/s^2
    pub(super) specific_force_m_s2: Vector3<f64>,
    /// of each rotor, rad/s; `None` where the vehicle's file knows no coefficient
    pub(super) rotor_speed_rad_s: Option<[f64; MAX_ROTORS]>,
}

/// Something that pushes the vehicle for a while.
#[derive(Debug, Clone, Copy)]
struct Shove {
    /// world, N
    force_n: Vector3<f64>,
    /// body, N m
    torque_nm: Vector3<f64>,
    until_s: f64,
}

/// The vehicle, its effects, and the ground under it.
#[derive(Debug)]
pub(super) struct Craft {
    model: Model,
    ground: GroundContact,
    memory: PlantMemory,
    /// outputs under way to the rotors, newest last
    sent: VecDeque<[f64; MAX_ROTORS]>,
    stopped: [bool; MAX_ROTORS],
    shove: Option<Shove>,
    step_s: f64,
    steps: u64,
    battery_v: f64,
}

impl Craft {
    /// Standing on the ground, rotors still. The ground lies so that the centre of mass stands at world z = 0.
    pub(super) fn new(settings: &Settings, step: Duration) -> Result<Self, SitlError> {
        let mut effects = Vec::with_capacity(settings.effects.len() + 1);
        // a lag among the effects is the rotors' own
        let own_lag = settings.effects.iter().any(ActiveEffect::is_rotor_lag);
        if settings.motor_time_constant_s > 0.0 && !own_lag {
            let propulsion = &settings.vehicle.propulsion;
            let is_stated = propulsion.time_constant_s == Some(settings.motor_time_constant_s);
            let stated = ActiveEffect::stated_rotor_lag(propulsion).filter(|_| is_stated);
            effects.push(stated.unwrap_or_else(|| ActiveEffect::rotor_lag(settings.motor_time_constant_s)));
        }
        effects.extend(settings.effects.iter().cloned());
        let model = Model::new(&settings.vehicle, effects)?;
        let base = GroundSettings::default();
        let standing_m = GroundContact::new(&model.airframe, base).standing_height_m();
        let ground = GroundContact::new(
            &model.airframe,
            GroundSettings { height_m: base.height_m - standing_m, ..base },
        );
        let [north_m, west_m] = settings.start_m;
        let state = State::at_rest(Vector3::new(north_m, west_m, 0.0), settings.start_yaw_rad);
        let still = Input::from_commands(&model.airframe, 0.0, &[0.0; MAX_ROTORS]);
        let memory = Plant::new(&model, None, &state, &still)?.memory();
        let step_s = step.as_secs_f64();
        let mut sent = VecDeque::new();
        let mut delay_s = model.command_delay_s();
        while delay_s > 0.5 * step_s {
            sent.push_back([0.0; MAX_ROTORS]);
            delay_s -= step_s;
        }
        Ok(Self {
            model,
            ground,
            memory,
            sent,
            stopped: [false; MAX_ROTORS],
            shove: None,
            step_s,
            steps: 0,
            battery_v: settings.battery_v,
        })
    }

    /// Under a battery of this voltage from now on.
    pub(super) fn set_battery_v(&mut self, battery_v: f64) {
        self.battery_v = battery_v;
    }

    /// A rotor gets no power any more.
    pub(super) fn stop_rotor(&mut self, rotor: usize) {
        if let Some(stopped) = self.stopped.get_mut(rotor) {
            *stopped = true;
        }
    }

    /// Pushes by a force (world, N) and a torque (body, N m) for `time_s` (s).
    pub(super) fn shove(&mut self, force_n: Vector3<f64>, torque_nm: Vector3<f64>, time_s: f64) {
        self.shove = Some(Shove { force_n, torque_nm, until_s: self.time_s() + time_s });
    }

    fn time_s(&self) -> f64 {
        self.steps as f64 * self.step_s
    }

    /// The motion as sensors without noise show it.
    pub(super) fn motion(&self) -> State {
        // what they show of it does not depend on the force
        let state = Plant::resume(&self.model, None, self.memory).state();
        self.model.measure(&state, &Wrench::zero()).state
    }

    /// One step under normalised outputs u; returns what sensors show before it.
    pub(super) fn step(&mut self, commands: &[f64; MAX_ROTORS]) -> IdealSensors {
        let mut acting = *commands;
        if !self.sent.is_empty() {
            self.sent.push_back(*commands);
            acting = self.sent.pop_front().unwrap_or(*commands);
        }
        for (command, stopped) in acting.iter_mut().zip(&self.stopped) {
            if *stopped {
                *command = 0.0;
            }
        }
        let time_s = self.time_s();
        let input = Input {
            battery_voltage_v: Some(self.battery_v),
            ..Input::from_commands(&self.model.airframe, time_s, &acting)
        };
        let (ground, shove) = (&self.ground, self.shove.filter(|shove| time_s < shove.until_s));
        let push = |_: f64, state: &State| {
            let mut wrench = ground.wrench(state);
            if let Some(shove) = &shove {
                wrench += Wrench {
                    force_n: state.attitude.inverse_transform_vector(&shove.force_n),
                    torque_nm: shove.torque_nm,
                };
            }
            wrench
        };
        let mut plant = Plant::resume(&self.model, Some(&push), self.memory);
        let now = plant.evaluate(&input);
        let seen = self.model.measure(&plant.state(), &now.wrench);
        plant.step(&input, self.step_s);
        let hover_rad_s = self.model.airframe.hover_speed_rad_s;
        self.memory = plant.memory();
        self.steps += 1;
        IdealSensors {
            state: seen.state,
            specific_force_m_s2: seen.specific_force_m_s2,
            rotor_speed_rad_s: hover_rad_s.map(|hover_rad_s| now.rotors.speed.map(|n| n * hover_rad_s)),
        }
    }
}
