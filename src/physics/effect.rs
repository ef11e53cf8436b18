//! The one trait: a physical effect that the rigid body with exact thrust leaves out.

use std::fmt::Debug;

use nalgebra::Vector3;

use super::{Airframe, Input, MAX_ROTORS, Measurement, Parameter, State, Wrench};

/// What the vehicle does and what flows around it at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Condition<'a> {
    /// the rotors' geometry
    pub airframe: &'a Airframe,
    /// the rigid body
    pub state: &'a State,
    /// time, commands, battery
    pub input: &'a Input,
    /// velocity of the centre of mass through the air, body, m/s
    pub air_velocity_m_s: Vector3<f64>,
    /// where the centre of mass is against where the airframe has it, body, m
    center_of_mass_m: Vector3<f64>,
    /// each hub from the true centre of mass, body, m
    arm_m: [Vector3<f64>; MAX_ROTORS],
    /// velocity of each hub through the air, body, m/s; once for all effects
    hub_air_velocity_m_s: [Vector3<f64>; MAX_ROTORS],
}

impl<'a> Condition<'a> {
    /// The condition in a given wind (world, m/s).
    #[must_use]
    #[inline]
    pub fn new(airframe: &'a Airframe, state: &'a State, input: &'a Input, wind_m_s: Vector3<f64>) -> Self {
        Self::about((airframe, Vector3::zeros()), state, input, wind_m_s)
    }

    /// The condition of an airframe whose centre of mass is elsewhere than it has it, by so much (body, m).
    #[inline(always)]
    pub(super) fn about(
        (airframe, center_of_mass_m): (&'a Airframe, Vector3<f64>),
        state: &'a State,
        input: &'a Input,
        wind_m_s: Vector3<f64>,
    ) -> Self {
        let air_velocity_m_s = state.attitude.inverse_transform_vector(&(state.velocity_m_s - wind_m_s));
        let mut at = Self {
            airframe,
            state,
            input,
            air_velocity_m_s,
            center_of_mass_m,
            arm_m: [Vector3::zeros(); MAX_ROTORS],
            hub_air_velocity_m_s: [Vector3::zeros(); MAX_ROTORS],
        };
        // no more hubs than there are
        let hubs = at.arm_m.iter_mut().zip(&mut at.hub_air_velocity_m_s);
        for ((arm, air), nominal) in hubs.zip(airframe.arms_m()) {
            *arm = nominal - center_of_mass_m;
            *air = air_velocity_m_s + state.rates_rad_s.cross(arm);
        }
        at
    }

    /// The same with the centre of mass elsewhere in the airframe (body, m).
    #[must_use]
    pub fn with_center_of_mass(self, center_of_mass_m: Vector3<f64>) -> Self {
        let moved_m = center_of_mass_m - self.center_of_mass_m;
        let arm_m = self.arm_m.map(|arm| arm - moved_m);
        let turning_m_s = self.state.rates_rad_s.cross(&moved_m);
        let hub_air_velocity_m_s = self.hub_air_velocity_m_s.map(|air| air - turning_m_s);
        Self { center_of_mass_m, arm_m, hub_air_velocity_m_s, ..self }
    }

    /// Each hub's position from the true centre of mass (body, m) and velocity through the air (body, m/s).
    #[inline]
    pub fn hubs(&self) -> impl Iterator<Item = (&Vector3<f64>, &Vector3<f64>)> {
        self.arms_m().iter().zip(&self.hub_air_velocity_m_s)
    }

    /// Hub positions from the true centre of mass, body, m.
    #[inline]
    pub fn arms_m(&self) -> &[Vector3<f64>] {
        &self.arm_m[..self.airframe.rotor_count()]
    }

    /// Height of a point of the body (`arm_m` from the centre of mass) over the ground, world z = 0, m.
    #[must_use]
    pub fn height_of(&self, arm_m: &Vector3<f64>) -> f64 {
        self.state.position_m.z + (self.state.attitude * arm_m).z
    }

    /// Force and torque of rotor thrusts (N) about the true centre of mass.
    #[must_use]
    #[inline]
    pub fn thrust_wrench(&self, thrust_n: &[f64; MAX_ROTORS]) -> Wrench {
        let mut wrench = self.airframe.thrust_wrench(thrust_n);
        wrench.torque_nm -= self.center_of_mass_m.cross(&wrench.force_n);
        wrench
    }
}

/// Motion and thrust of each rotor; entries beyond the airframe's rotor count are not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotors {
    /// over the hover speed (-)
    pub speed: [f64; MAX_ROTORS],
    /// rate of the relative speed, 1/s
    pub acceleration_1_s: [f64; MAX_ROTORS],
    /// N
    pub thrust_n: [f64; MAX_ROTORS],
}

impl Rotors {
    /// Rotors that stand.
    #[must_use]
    pub fn still() -> Self {
        Self { speed: [0.0; MAX_ROTORS], acceleration_1_s: [0.0; MAX_ROTORS], thrust_n: [0.0; MAX_ROTORS] }
    }

    /// Rotors that turn as commanded, at constant speed.
    #[must_use]
    #[inline]
    pub fn as_commanded(airframe: &Airframe, relative_speed: &[f64; MAX_ROTORS]) -> Self {
        let mut rotors = Self { speed: *relative_speed, ..Self::still() };
        rotors.thrust_from_speed(airframe);
        rotors
    }

    /// Sets the thrusts that belong to the speeds.
    #[inline]
    pub fn thrust_from_speed(&mut self, airframe: &Airframe) {
        for (thrust, speed) in self.thrust_n.iter_mut().zip(&self.speed) {
            *thrust = airframe.thrust_n(*speed);
        }
    }
}

/// Through what an effect acts: which of its functions do something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hook {
    /// [`Effect::command_delay_s`]
    Commands,
    /// [`Effect::wind_m_s`]
    Air,
    /// [`Effect::center_of_mass_m`]
    CenterOfMass,
    /// [`Effect::rotor_speed`]
    RotorSpeed,
    /// [`Effect::rotor_thrust`]
    RotorThrust,
    /// [`Effect::wrench`]
    Wrench,
    /// [`Effect::reaction`]
    Reaction,
    /// [`Effect::measure`]
    Sensors,
}

/// An effect's parameter values and own states, and where it writes the rates of the latter.
#[derive(Debug)]
pub struct Own<'a> {
    /// in the order of [`Effect::parameters`], then of [`Effect::finer_parameters`] where they are given
    pub parameters: &'a [f64],
    /// as many as [`Effect::state_count`]
    pub states: &'a [f64],
    /// 1/s of each state; the effect writes them in whichever hook it likes, unset ones stay zero
    pub rates: &'a mut [f64],
}

impl Own<'_> {
    /// The first three parameters, of effects that have one for each axis.
    #[must_use]
    #[inline]
    pub fn axes(&self) -> Vector3<f64> {
        Vector3::new(self.parameters[0], self.parameters[1], self.parameters[2])
    }
}

/// One physical effect: equation, parameters, and the sentence by which the report names it.
///
/// The hooks run in this order over all effects of a model: [`Effect::command_delay_s`] when commands
/// are looked up, then [`Effect::wind_m_s`] and [`Effect::center_of_mass_m`], [`Effect::rotor_speed`],
/// [`Effect::rotor_thrust`], [`Effect::wrench`], [`Effect::reaction`]; [`Effect::measure`] when sensors
/// are read. An effect fills in those that it acts through; the others change nothing.
pub trait Effect: Debug + Sync {
    /// identifier as in reports and files
    fn id(&self) -> &'static str;

    /// what a person reads
    fn sentence(&self) -> &'static str;

    /// equation and source, in Markdown
    fn equation(&self) -> &'static str;

    /// name, unit, bounds
    fn parameters(&self) -> &'static [Parameter];

    /// name, unit, bounds of what a finer form of the effect has beyond [`Effect::parameters`]: given from the first on, as
    /// many as differ from the common form
    fn finer_parameters(&self) -> &'static [Parameter] {
        &[]
    }

    /// Slots of the parameters that have a side: their sign turns in the mirror image of the vehicle, left for right.
    fn sided(&self) -> &'static [usize] {
        &[]
    }

    /// which of the functions below do something: the others are not called in a simulation
    fn hooks(&self) -> &'static [Hook];

    /// Whether it acts between the command and the rotor's speed: where the speed is measured there is
    /// nothing left of it.
    fn is_before_speed(&self) -> bool {
        self.hooks().iter().any(|hook| matches!(hook, Hook::Commands | Hook::RotorSpeed))
    }

    /// what this airframe's description lacks for the effect to be computed
    fn missing(&self, _airframe: &Airframe) -> Option<&'static str> {
        None
    }

    /// number of own states on this airframe
    fn state_count(&self, _airframe: &Airframe) -> usize {
        0
    }

    /// own states at the start, for rotors that have long followed their command
    fn initial_states(&self, _at: &Condition, _rotors: &Rotors, _states: &mut [f64]) {}

    /// how long before now the commands were sent that act now, s
    fn command_delay_s(&self, _parameters: &[f64]) -> f64 {
        0.0
    }

    /// wind that it adds, world, m/s
    fn wind_m_s(&self, _input: &Input, _own: &Own) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// by how much it moves the centre of mass from where the vehicle's description has it, body, m
    fn center_of_mass_m(&self, _own: &Own) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// alters the rotors' speed and its rate
    fn rotor_speed(&self, _at: &Condition, _own: &mut Own, _rotors: &mut Rotors) {}

    /// alters the rotors' thrust at their speed, and their reaction torque with it
    fn rotor_thrust(&self, _at: &Condition, _own: &mut Own, _rotors: &mut Rotors) {}

    /// adds force and torque beyond the rotors' thrust to `sum`
    fn wrench(&self, _at: &Condition, _rotors: &Rotors, _own: &mut Own, _sum: &mut Wrench) {}

    /// adds what follows from the vehicle's acceleration, that is, from all force and torque on it that
    /// `sum` holds already (gravity apart)
    fn reaction(&self, _at: &Condition, _own: &mut Own, _sum: &mut Wrench) {}

    /// alters what the sensors show; `angular_acceleration_rad_s2` is the true one, body
    fn measure(
        &self,
        _state: &State,
        _angular_acceleration_rad_s2: &Vector3<f64>,
        _parameters: &[f64],
        _seen: &mut Measurement,
    ) {
    }

    /// Whether its wrench is linear in its parameters: [`Effect::regressor`] times them is the wrench.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether [`Effect::regressor`] gives the wrench's derivative by the parameters. Not so where an
    /// effect acts through its own states, wind, time or the sensors.
    fn has_regressor(&self) -> bool {
        self.is_linear()
    }

    /// The wrench's derivative by each parameter at `parameters`, one column a parameter; of a linear
    /// effect the same everywhere. Columns of an effect without regressor are left as they are.
    fn regressor(&self, _at: &Condition, _rotors: &Rotors, _parameters: &[f64], _columns: &mut [Wrench]) {}
}

/// The whole change of force and torque that one effect makes, through thrust and otherwise, to
/// rotors that turn at `rotors.speed`.
#[must_use]
pub fn effect_wrench(effect: &dyn Effect, at: &Condition, rotors: &Rotors, own: &mut Own) -> Wrench {
    in_order(&mut |visit| visit(effect, own), at, rotors) - at.thrust_wrench(&rotors.thrust_n)
}

/// Force and torque of rotors that turn at `rotors.speed`, with all that these effects change of it; none of them has states.
/// One effect's reaction is to the others' forces too.
#[must_use]
pub fn effects_wrench<'a>(
    effects: impl Iterator<Item = (&'a dyn Effect, &'a [f64])> + Clone,
    at: &Condition,
    rotors: &Rotors,
) -> Wrench {
    let mut each = |visit: &mut Visit| {
        for (effect, parameters) in effects.clone() {
            visit(effect, &mut Own { parameters, states: &[], rates: &mut [] });
        }
    };
    in_order(&mut each, at, rotors)
}

type Visit<'a> = dyn FnMut(&dyn Effect, &mut Own) + 'a;

/// The hooks of the effects that `each` visits, in the order of a simulation.
fn in_order(each: &mut dyn FnMut(&mut Visit), at: &Condition, rotors: &Rotors) -> Wrench {
    let mut moved_m = Vector3::zeros();
    each(&mut |effect, own| moved_m += effect.center_of_mass_m(own));
    let elsewhere;
    let at = if moved_m == Vector3::zeros() {
        at
    } else {
        elsewhere = at.with_center_of_mass(at.center_of_mass_m + moved_m);
        &elsewhere
    };
    let mut changed = *rotors;
    each(&mut |effect, own| effect.rotor_speed(at, own, &mut changed));
    if changed.speed != rotors.speed {
        changed.thrust_from_speed(at.airframe);
    }
    each(&mut |effect, own| effect.rotor_thrust(at, own, &mut changed));
    let mut sum = at.thrust_wrench(&changed.thrust_n);
    each(&mut |effect, own| effect.wrench(at, &changed, own, &mut sum));
    each(&mut |effect, own| effect.reaction(at, own, &mut sum));
    sum
}
