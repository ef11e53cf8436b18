//! A model as one vector differential equation, rigid body first, then the effects' own states.

use nalgebra::SVector;

use super::integrator::rk4_step;
use super::{PLANT_STATES, SimulateError};
use crate::physics::{Evaluation, Input, Model, OwnStates, RIGID_STATES, Rotors, State, Wrench};

/// A vehicle in flight.
pub struct Plant<'a> {
    model: &'a Model,
    push: Option<Push<'a>>,
    vector: SVector<f64, PLANT_STATES>,
}

impl<'a> Plant<'a> {
    /// A vehicle in `state` whose rotors have long followed the commands of `input`.
    ///
    /// # Errors
    /// If the effects have more own states than fit.
    pub fn new(
        model: &'a Model,
        push: Option<Push<'a>>,
        state: &State,
        input: &Input,
    ) -> Result<Self, SimulateError> {
        let count = model.own_state_count();
        if RIGID_STATES + count > PLANT_STATES {
            return Err(SimulateError::TooManyStates { count });
        }
        let mut vector = SVector::<f64, PLANT_STATES>::zeros();
        state.write(&mut vector);
        model.initial_states(state, input, &mut vector.as_mut_slice()[RIGID_STATES..RIGID_STATES + count]);
        Ok(Self { model, push, vector })
    }

    /// The vehicle that [`Self::memory`] was taken of; `model` must be the one it was taken with.
    #[must_use]
    pub fn resume(model: &'a Model, push: Option<Push<'a>>, memory: PlantMemory) -> Self {
        Self { model, push, vector: memory.0 }
    }

    /// All of its state, for [`Self::resume`].
    #[must_use]
    pub fn memory(&self) -> PlantMemory {
        PlantMemory(self.vector)
    }

    /// Where it is.
    #[must_use]
    pub fn state(&self) -> State {
        State::read(&self.vector)
    }

    /// Puts the body somewhere else; the effects' own states stay.
    pub fn set_state(&mut self, state: &State) {
        state.write(&mut self.vector);
    }

    /// Force, torque and rotors under this input, now.
    #[must_use]
    pub fn evaluate(&self, input: &Input) -> Evaluation {
        let (mut rates, count) = ([0.0; PLANT_STATES], self.model.own_state_count());
        let (state, own) = (self.state(), &self.vector.as_slice()[RIGID_STATES..RIGID_STATES + count]);
        let mut evaluation = self.model.evaluate(&state, input, own, &mut rates[..count]);
        if let Some(push) = self.push {
            evaluation.wrench += push(input.time_s, &state);
        }
        evaluation
    }

    /// Moves on by `step_s` (s) under a constant input, with one Runge-Kutta step.
    pub fn step(&mut self, input: &Input, step_s: f64) {
        let at = |after_s: f64| Input { time_s: input.time_s + after_s, ..*input };
        self.step_along([&at(0.0), &at(0.5 * step_s), &at(step_s)], step_s);
    }

    /// [`Self::step`] under an input that changes: at the beginning, in the middle and at the end.
    pub fn step_along(&mut self, inputs: [&Input; 3], step_s: f64) {
        // no more numbers than the effects need take part
        match self.model.own_state_count() {
            0 => self.step_of::<RIGID_STATES>(inputs, step_s),
            1..=4 => self.step_of::<{ RIGID_STATES + 4 }>(inputs, step_s),
            5..=10 => self.step_of::<{ RIGID_STATES + 10 }>(inputs, step_s),
            _ => self.step_of::<PLANT_STATES>(inputs, step_s),
        }
    }

    /// [`Self::step_along`] of the effects' own states alone, as far as no one asks where the body is meanwhile
    /// ([`Model::own_states_are_of_rotors`]).
    pub fn step_own(&mut self, inputs: [&Input; 3], step_s: f64) {
        match self.model.own_state_count() {
            0 => {}
            1..=4 => self.step_own_of::<4>(inputs, step_s),
            5..=10 => self.step_own_of::<10>(inputs, step_s),
            _ => self.step_own_of::<{ PLANT_STATES - RIGID_STATES }>(inputs, step_s),
        }
    }

    fn step_own_of<const N: usize>(&mut self, inputs: [&Input; 3], step_s: f64) {
        let (model, state, mut stages) = (self.model, self.state(), stages(inputs));
        let count = model.own_state_count();
        let mut derivative = |_: f64, vector: &SVector<f64, N>| {
            let mut out = SVector::<f64, N>::zeros();
            let (states, rates) = (&vector.as_slice()[..count], &mut out.as_mut_slice()[..count]);
            model.rotor_rates(&state, stages(), OwnStates { states, rates });
            out
        };
        let own = &mut self.vector.as_mut_slice()[RIGID_STATES..RIGID_STATES + N];
        let vector = SVector::<f64, N>::from_column_slice(own);
        own.copy_from_slice(rk4_step(&mut derivative, inputs[0].time_s, &vector, step_s).as_slice());
    }

    fn step_of<const N: usize>(&mut self, inputs: [&Input; 3], step_s: f64) {
        let (model, push) = (self.model, self.push);
        let count = model.own_state_count();
        let (mut stages, mut rotors) = (stages(inputs), Rotors::still());
        let mut derivative = |time_s: f64, vector: &SVector<f64, N>| {
            let mut out = SVector::<f64, N>::zeros();
            let state = State::read(vector);
            let states = &vector.as_slice()[RIGID_STATES..RIGID_STATES + count];
            let rates = &mut out.as_mut_slice()[RIGID_STATES..RIGID_STATES + count];
            let mut wrench = model.wrench(&state, stages(), OwnStates { states, rates }, &mut rotors);
            if let Some(push) = push {
                wrench += push(time_s, &state);
            }
            model.body.derivative(&state, &wrench).write(&mut out);
            out
        };
        let mut vector = SVector::<f64, N>::from_column_slice(&self.vector.as_slice()[..N]);
        vector = rk4_step(&mut derivative, inputs[0].time_s, &vector, step_s);
        // back to a unit quaternion: the step leaves it by its own error
        State::read(&vector).write(&mut vector);
        self.vector.as_mut_slice()[..N].copy_from_slice(vector.as_slice());
    }
}

/// The input of each of a Runge-Kutta step's four stages, one after the other.
fn stages<'a>([begin, middle, end]: [&'a Input; 3]) -> impl FnMut() -> &'a Input {
    let mut order = [begin, middle, middle].into_iter();
    move || order.next().unwrap_or(end)
}

/// Where a [`Plant`] is, own states of the effects included, while nobody steps it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantMemory(SVector<f64, PLANT_STATES>);

/// Something beyond every effect that pushes the vehicle, as force and torque in the body frame.
pub type Push<'a> = &'a dyn Fn(f64, &State) -> Wrench;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::ActiveEffect;
    use crate::physics::effects::{LinearDrag, MotorLag, SlungLoad};
    use crate::simulate::{
        AutopilotCascade, AutopilotGains, GroundContact, GroundSettings, Setpoint, random_vehicle,
    };
    use crate::vehicle::Vehicle;
    use nalgebra::{UnitQuaternion, Vector3};

    const STEP_S: f64 = 0.001;

    fn plain(vehicle: &Vehicle, effects: Vec<ActiveEffect>) -> Model {
        Model::new(vehicle, effects).unwrap()
    }

    fn input(model: &Model, relative_speed: f64) -> Input {
        let mut input = Input::from_commands(&model.airframe, 0.0, &[]);
        input.speed_command[..4].fill(relative_speed);
        input
    }

    fn drifting(velocity_m_s: Vector3<f64>) -> State {
        State { velocity_m_s, ..State::at_rest(Vector3::new(0.0, 0.0, 50.0), 0.4) }
    }

    #[test]
    fn drag_slows_a_glide_exponentially() {
        let mut vehicle = random_vehicle(3).truth;
        vehicle.rotors.iter_mut().for_each(|rotor| rotor.position_m.z = 0.0);
        let m = vehicle.body.mass_kg;
        let drag = ActiveEffect::new(&LinearDrag, &[0.3, 0.3, 0.0]).unwrap();
        let model = plain(&vehicle, vec![drag]);
        let hover = input(&model, 1.0);
        let mut plant = Plant::new(&model, None, &drifting(Vector3::new(4.0, 0.0, 0.0)), &hover).unwrap();
        for _ in 0..2000 {
            plant.step(&hover, STEP_S);
        }
        // level, since the hubs lie in the centre's plane: m v' = -d v
        assert!((plant.state().velocity_m_s.x - 4.0 * (-0.3 / m * 2.0).exp()).abs() < 1e-9);
    }

    #[test]
    fn a_lagging_rotor_answers_a_step_as_the_exponential_does() {
        let vehicle = random_vehicle(4).truth;
        let model = plain(&vehicle, vec![ActiveEffect::new(&MotorLag, &[0.05]).unwrap()]);
        let mut plant = Plant::new(&model, None, &drifting(Vector3::zeros()), &input(&model, 1.0)).unwrap();
        let faster = input(&model, 1.2);
        for _ in 0..50 {
            plant.step(&faster, STEP_S);
        }
        let expected = 1.2 - 0.2 * (-1.0_f64).exp();
        assert!((plant.evaluate(&faster).rotors.speed[0] - expected).abs() < 1e-9);
    }

    #[test]
    fn a_rotor_that_slows_down_has_its_own_exponential() {
        let vehicle = random_vehicle(4).truth;
        let model = plain(&vehicle, vec![ActiveEffect::new(&MotorLag, &[0.05, 0.1]).unwrap()]);
        let mut plant = Plant::new(&model, None, &drifting(Vector3::zeros()), &input(&model, 1.0)).unwrap();
        for (target, from, time_constant_s) in
            [(1.2, 1.0, 0.05_f64), (0.9, 1.2 - 0.2 * (-1.0_f64).exp(), 0.1)]
        {
            for _ in 0..50 {
                plant.step(&input(&model, target), STEP_S);
            }
            let expected = target + (from - target) * (-0.05 / time_constant_s).exp();
            assert!((plant.evaluate(&input(&model, target)).rotors.speed[0] - expected).abs() < 1e-9);
        }
    }

    /// Kinetic and potential energy of vehicle and load, J, and their momentum, N s.
    fn totals(plant: &Plant, vehicle: &Vehicle, (load_kg, length_m): (f64, f64)) -> (f64, Vector3<f64>) {
        let (state, own) = (plant.state(), plant.vector.as_slice());
        let cord = Vector3::from_column_slice(&own[13..16]);
        let swing = Vector3::from_column_slice(&own[16..19]);
        let load_velocity = state.velocity_m_s + swing * length_m;
        let m = vehicle.body.mass_kg;
        let kinetic =
            0.5 * m * state.velocity_m_s.norm_squared() + 0.5 * load_kg * load_velocity.norm_squared();
        let height = m * state.position_m.z + load_kg * (state.position_m + cord * length_m).z;
        (kinetic + vehicle.gravity_m_s2 * height, state.velocity_m_s * m + load_velocity * load_kg)
    }

    #[test]
    fn a_slung_load_in_free_fall_keeps_energy_and_momentum() {
        let vehicle = random_vehicle(5).truth;
        let load = (0.3, 0.8);
        let model = plain(&vehicle, vec![ActiveEffect::new(&SlungLoad, &[load.0, load.1]).unwrap()]);
        let off = input(&model, 0.0);
        let mut plant = Plant::new(&model, None, &drifting(Vector3::new(1.0, 0.5, 0.0)), &off).unwrap();
        // the load swings
        plant.vector[16] = 2.0;
        plant.vector[17] = -1.0;
        let (energy, momentum) = totals(&plant, &vehicle, load);
        for _ in 0..2000 {
            plant.step(&off, STEP_S);
        }
        let (later, moved) = totals(&plant, &vehicle, load);
        assert!((later / energy - 1.0).abs() < 1e-9, "{energy} J, {later} J");
        // only gravity acts on both together
        let fall = Vector3::z() * (-9.81 * 2.0 * (vehicle.body.mass_kg + load.0));
        assert!((moved - momentum - fall).norm() < 1e-8);
        let cord = Vector3::from_column_slice(&plant.vector.as_slice()[13..16]);
        assert!((cord.norm() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_load_swings_alike_by_the_force_without_it_and_by_the_force_that_was_felt() {
        let vehicle = random_vehicle(5).truth;
        for damping in [0.0, 0.3] {
            let load = ActiveEffect::new(&SlungLoad, &[0.3, 0.8, damping]).unwrap();
            let model = plain(&vehicle, vec![load]);
            let mut state = drifting(Vector3::new(1.0, 0.5, 0.0));
            state.attitude = UnitQuaternion::from_euler_angles(0.2, -0.3, 0.5);
            let input = input(&model, 1.1);
            let states = [0.3, -0.2, -(1.0_f64 - 0.13).sqrt(), 0.4, 1.0, 0.08];
            let (mut by_model, mut by_motion) = ([0.0; 6], [0.0; 6]);
            let felt_n = model.evaluate(&state, &input, &states, &mut by_model).wrench.force_n;
            model.reaction_rates((&state, &input), &felt_n, &states, &mut by_motion);
            for (a, b) in by_model.iter().zip(by_motion) {
                assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{by_model:?} {by_motion:?}");
            }
        }
    }

    #[test]
    fn a_slung_load_swings_at_the_frequency_of_the_double_body() {
        let vehicle = random_vehicle(6).truth;
        let (m, load_kg, length_m) = (vehicle.body.mass_kg, 0.2, 1.0);
        let model = plain(&vehicle, vec![ActiveEffect::new(&SlungLoad, &[load_kg, length_m]).unwrap()]);
        // thrust carries both
        let hold = input(&model, ((m + load_kg) / m).sqrt());
        let mut plant = Plant::new(&model, None, &drifting(Vector3::zeros()), &hold).unwrap();
        plant.vector[13] = 0.01;
        let mut crossings = Vec::new();
        let mut before = 0.01;
        for step in 0..6000_u32 {
            plant.step(&Input { time_s: f64::from(step) * STEP_S, ..hold }, STEP_S);
            let now = plant.vector[13];
            if before > 0.0 && now <= 0.0 {
                crossings.push((f64::from(step) + before / (before - now)) * STEP_S);
            }
            before = now;
        }
        let found = std::f64::consts::TAU / (crossings[1] - crossings[0]);
        let expected = (9.81 / length_m * (1.0 + load_kg / m)).sqrt();
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} rad/s, expected {expected}");
    }

    #[test]
    fn a_vehicle_rests_on_the_ground_takes_off_and_lands() {
        let vehicle = random_vehicle(7).truth;
        let model = plain(&vehicle, vec![]);
        let ground = GroundContact::new(&model.airframe, GroundSettings::default());
        let push = |_: f64, state: &State| ground.wrench(state);
        let stand = Vector3::new(0.0, 0.0, ground.standing_height_m() + 0.02);
        let off = input(&model, 0.0);
        // dropped from 2 cm, a little askew and moving
        let mut state = State::at_rest(stand, 0.3);
        state.velocity_m_s.x = 0.2;
        state.attitude *= UnitQuaternion::from_euler_angles(0.05, 0.02, 0.0);
        let mut plant = Plant::new(&model, Some(&push), &state, &off).unwrap();
        for _ in 0..2000 {
            plant.step(&off, STEP_S);
        }
        let resting = plant.state();
        assert!(resting.velocity_m_s.norm() < 1e-3 && resting.rates_rad_s.norm() < 1e-3);
        assert!((resting.position_m.z - ground.standing_height_m()).abs() < 1e-4);
        assert!((resting.attitude * Vector3::z()).z > 0.999_999);
        // then the cascade takes it to 2 m and back
        let mut cascade = AutopilotCascade::new(&vehicle, AutopilotGains::default(), 0.0).unwrap();
        let mut fly = |plant: &mut Plant, target_m: f64, seconds: u32| {
            for step in 0..seconds * 1000 {
                let height_m = target_m;
                let setpoint = Setpoint {
                    position_m: Vector3::new(0.0, 0.0, height_m),
                    velocity_m_s: Vector3::zeros(),
                    acceleration_m_s2: Vector3::zeros(),
                    yaw_rad: 0.3,
                    yaw_rate_rad_s: 0.0,
                };
                let commands = cascade.commands(&setpoint, &plant.state(), STEP_S);
                let time_s = f64::from(step) * STEP_S;
                plant.step(&Input::from_commands(&model.airframe, time_s, &commands), STEP_S);
            }
        };
        fly(&mut plant, 2.0, 12);
        let up = plant.state();
        assert!((up.position_m - Vector3::new(0.0, 0.0, 2.0)).norm() < 0.05, "{}", up.position_m);
        assert!((up.attitude.euler_angles().2 - 0.3).abs() < 0.01);
        fly(&mut plant, -1.0, 8);
        for _ in 0..2000 {
            plant.step(&off, STEP_S);
        }
        assert!((plant.state().position_m.z - ground.standing_height_m()).abs() < 1e-3);
    }

    #[test]
    fn the_autopilots_cascade_flies_a_circle_in_wind() {
        let vehicle = random_vehicle(8).truth;
        let drag = ActiveEffect::new(&LinearDrag, &[0.15, 0.15, 0.05]).unwrap();
        let model = plain(&vehicle, vec![drag]);
        let mut cascade = AutopilotCascade::new(&vehicle, AutopilotGains::default(), 0.02).unwrap();
        let hover = input(&model, 1.0);
        let mut plant =
            Plant::new(&model, None, &State::at_rest(Vector3::new(1.0, 0.0, 2.0), 0.0), &hover).unwrap();
        let mut worst_m = 0.0_f64;
        for step in 0..30_000_u32 {
            let t = f64::from(step) * STEP_S;
            let (sin, cos) = (0.8 * t).sin_cos();
            let setpoint = Setpoint {
                position_m: Vector3::new(cos, sin, 2.0),
                velocity_m_s: Vector3::new(-sin, cos, 0.0) * 0.8,
                acceleration_m_s2: Vector3::new(-cos, -sin, 0.0) * 0.64,
                yaw_rad: 0.5 * t,
                yaw_rate_rad_s: 0.5,
            };
            let commands = cascade.commands(&setpoint, &plant.state(), STEP_S);
            let mut now = Input::from_commands(&model.airframe, t, &commands);
            now.wind_m_s = Vector3::new(2.0, 0.0, 0.0);
            plant.step(&now, STEP_S);
            if t > 15.0 {
                worst_m = worst_m.max((plant.state().position_m - setpoint.position_m).norm());
            }
        }
        assert!(worst_m < 0.15, "{worst_m} m");
    }
}
