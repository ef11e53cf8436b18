//! The cascade that PX4 and ArduPilot fly: position, velocity, attitude, body rates.

use nalgebra::{UnitQuaternion, Vector3, Vector4};

use super::SimulateError;
use super::allocation::Allocation;
use super::controller::{Setpoint, attitude_of_thrust, limited_tilt};
use crate::physics::{MAX_ROTORS, RigidBodyModel, State};
use crate::vehicle::Vehicle;

/// Gains of one axis group of a PID loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopGains {
    /// 1/s
    pub proportional: Vector3<f64>,
    /// 1/s^2
    pub integral: Vector3<f64>,
    /// -
    pub derivative: Vector3<f64>,
}

/// Gains from one loop's error to the next loop's setpoint; world axes for position and velocity, body
/// axes for attitude and rates.
///
/// The outer three are PX4's defaults (`MPC_XY_P`, `MPC_XY_VEL_P_ACC`, `MC_ROLL_P` and so on), ArduPilot's
/// being close. The rate loop's are per unit of inertia, so that one set flies every size of vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AutopilotGains {
    /// position error to velocity, 1/s
    pub position: Vector3<f64>,
    /// velocity error to acceleration
    pub velocity: LoopGains,
    /// attitude error to body rates, 1/s
    pub attitude: Vector3<f64>,
    /// rate error to angular acceleration
    pub rates: LoopGains,
    /// greatest speed asked for by the position loop, m/s
    pub speed_max_m_s: f64,
    /// greatest tilt asked for, rad
    pub tilt_max_rad: f64,
    /// greatest body rates asked for, rad/s
    pub rates_max_rad_s: Vector3<f64>,
    /// cut-off of the low-pass on the derivatives, rad/s
    pub derivative_pole_rad_s: f64,
}

impl Default for AutopilotGains {
    fn default() -> Self {
        Self {
            position: Vector3::new(0.95, 0.95, 1.0),
            velocity: LoopGains {
                proportional: Vector3::new(1.8, 1.8, 4.0),
                integral: Vector3::new(0.4, 0.4, 2.0),
                derivative: Vector3::new(0.2, 0.2, 0.0),
            },
            attitude: Vector3::new(6.5, 6.5, 2.8),
            rates: LoopGains {
                proportional: Vector3::new(25.0, 25.0, 10.0),
                integral: Vector3::new(25.0, 25.0, 5.0),
                derivative: Vector3::new(0.2, 0.2, 0.0),
            },
            speed_max_m_s: 12.0,
            tilt_max_rad: 0.785,
            rates_max_rad_s: Vector3::new(3.84, 3.84, 3.49),
            derivative_pole_rad_s: 60.0,
        }
    }
}

/// One PID loop over three axes: the derivative is that of the measurement, low-passed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pid {
    gains: LoopGains,
    integral: Vector3<f64>,
    smoothed: Option<Vector3<f64>>,
    pole_rad_s: f64,
}

impl Pid {
    fn new(gains: LoopGains, pole_rad_s: f64) -> Self {
        Self { gains, integral: Vector3::zeros(), smoothed: None, pole_rad_s }
    }

    fn update(&mut self, wanted: &Vector3<f64>, measured: &Vector3<f64>, period_s: f64) -> Vector3<f64> {
        let error = wanted - measured;
        let smoothed = self.smoothed.get_or_insert(*measured);
        let rate = (measured - *smoothed) * self.pole_rad_s;
        *smoothed += (measured - *smoothed) * (1.0 - (-self.pole_rad_s * period_s).exp());
        let action = self.gains.proportional.component_mul(&error) + self.integral
            - self.gains.derivative.component_mul(&rate);
        self.integral += self.gains.integral.component_mul(&error) * period_s;
        action
    }

    fn reset(&mut self) {
        self.integral = Vector3::zeros();
        self.smoothed = None;
    }
}

/// What a cascade last asked of its inner loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerLoopSetpoint {
    /// body to world
    pub attitude: UnitQuaternion<f64>,
    /// body, rad/s
    pub rates_rad_s: Vector3<f64>,
    /// along body z, N
    pub thrust_n: f64,
}

/// Position P, velocity PID, attitude P, rate PID, mixer.
#[derive(Debug, Clone)]
pub struct AutopilotCascade {
    gains: AutopilotGains,
    body: RigidBodyModel,
    allocation: Allocation,
    velocity: Pid,
    rates: Pid,
    inner: InnerLoopSetpoint,
    hover_scale: f64,
}

/// Cosine of the lean beyond which no more thrust makes up for it (-).
const LEANING_MIN: f64 = 0.5;

impl AutopilotCascade {
    /// A cascade that believes `vehicle`; commands stay within `command_min` to 1.
    ///
    /// # Errors
    /// If the vehicle is not physical or its rotors do not span thrust and three torques.
    pub fn new(vehicle: &Vehicle, gains: AutopilotGains, command_min: f64) -> Result<Self, SimulateError> {
        Ok(Self {
            gains,
            body: RigidBodyModel::new(&vehicle.body, vehicle.gravity_m_s2)?,
            allocation: Allocation::new(vehicle, command_min)?,
            velocity: Pid::new(gains.velocity, gains.derivative_pole_rad_s),
            rates: Pid::new(gains.rates, gains.derivative_pole_rad_s),
            inner: InnerLoopSetpoint {
                attitude: UnitQuaternion::identity(),
                rates_rad_s: Vector3::zeros(),
                thrust_n: 0.0,
            },
            hover_scale: 1.0,
        })
    }

    /// Takes a hover's thrust for so many times the weight of the vehicle that it believes: an autopilot has it as a parameter, and turns
    /// accelerations into thrust by it. 1 at first.
    pub fn set_hover_scale(&mut self, scale: f64) {
        self.hover_scale = scale;
    }

    /// What the last call of [`Self::commands`] or [`Self::turn`] asked of the inner loops.
    #[must_use]
    pub fn inner_loop_setpoint(&self) -> &InnerLoopSetpoint {
        &self.inner
    }

    /// Forgets integrals and derivatives, as at arming.
    pub fn reset(&mut self) {
        self.velocity.reset();
        self.rates.reset();
    }

    /// Normalised commands u for an estimate of the state; called every `period_s` (s).
    pub fn commands(&mut self, setpoint: &Setpoint, estimate: &State, period_s: f64) -> [f64; MAX_ROTORS] {
        let acceleration = self.acceleration(setpoint, estimate, period_s);
        let attitude = attitude_of_thrust(&acceleration, setpoint.yaw_rad);
        let up = estimate.attitude * Vector3::z();
        let rates = self.rates_wanted(&attitude, estimate, setpoint.yaw_rate_rad_s);
        let thrust_n = self.hover_scale * self.body.mass_kg * acceleration.dot(&up);
        self.inner = InnerLoopSetpoint { attitude, rates_rad_s: rates, thrust_n };
        self.rate_commands(estimate, period_s)
    }

    /// The same from the attitude loop inwards: towards an attitude (body to world), with the rate about z fed
    /// forward about the world's vertical, or at `rates_rad_s` (body) where there is none; thrust along body z in N.
    pub fn turn(
        &mut self,
        attitude: Option<UnitQuaternion<f64>>,
        rates_rad_s: &Vector3<f64>,
        thrust_n: f64,
        (estimate, period_s): (&State, f64),
    ) -> [f64; MAX_ROTORS] {
        self.velocity.reset();
        self.turned(attitude, rates_rad_s, thrust_n, (estimate, period_s))
    }

    /// The same with the thrust that keeps to the setpoint's height and climb, however the vehicle leans (up to 60
    /// degrees); what the setpoint asks for horizontally does not count.
    pub fn turn_at_height(
        &mut self,
        attitude: Option<UnitQuaternion<f64>>,
        rates_rad_s: &Vector3<f64>,
        setpoint: &Setpoint,
        (estimate, period_s): (&State, f64),
    ) -> [f64; MAX_ROTORS] {
        // above where it is, and as it drifts: no horizontal error takes its share of the greatest speed
        let level = |across: &Vector3<f64>, up: &Vector3<f64>| Vector3::new(across.x, across.y, up.z);
        let setpoint = Setpoint {
            position_m: level(&estimate.position_m, &setpoint.position_m),
            velocity_m_s: level(&Vector3::zeros(), &setpoint.velocity_m_s),
            acceleration_m_s2: level(&Vector3::zeros(), &setpoint.acceleration_m_s2),
            ..*setpoint
        };
        let up_m_s2 = self.acceleration(&setpoint, estimate, period_s).z;
        self.velocity.integral = level(&Vector3::zeros(), &self.velocity.integral);
        let leaning = (estimate.attitude * Vector3::z()).z.max(LEANING_MIN);
        let thrust_n = self.hover_scale * self.body.mass_kg * up_m_s2 / leaning;
        self.turned(attitude, rates_rad_s, thrust_n, (estimate, period_s))
    }

    fn turned(
        &mut self,
        attitude: Option<UnitQuaternion<f64>>,
        rates_rad_s: &Vector3<f64>,
        thrust_n: f64,
        (estimate, period_s): (&State, f64),
    ) -> [f64; MAX_ROTORS] {
        let most = self.gains.rates_max_rad_s;
        let rates_rad_s = match &attitude {
            Some(attitude) => self.rates_wanted(attitude, estimate, rates_rad_s.z),
            None => rates_rad_s.zip_map(&most, |rate, most| rate.clamp(-most, most)),
        };
        self.inner =
            InnerLoopSetpoint { attitude: attitude.unwrap_or(estimate.attitude), rates_rad_s, thrust_n };
        self.rate_commands(estimate, period_s)
    }

    fn rate_commands(&mut self, estimate: &State, period_s: f64) -> [f64; MAX_ROTORS] {
        let InnerLoopSetpoint { rates_rad_s: rates, thrust_n, .. } = self.inner;
        let turning = self.rates.update(&rates, &estimate.rates_rad_s, period_s);
        let w = &estimate.rates_rad_s;
        let torque = self.body.turning_torque_nm(w, &turning);
        self.allocation.commands(&Vector4::new(thrust_n, torque.x, torque.y, torque.z))
    }

    /// What the thrust has to give per mass, world, m/s^2, gravity included.
    fn acceleration(&mut self, setpoint: &Setpoint, estimate: &State, period_s: f64) -> Vector3<f64> {
        let error_m = setpoint.position_m - estimate.position_m;
        let velocity = (setpoint.velocity_m_s + self.gains.position.component_mul(&error_m))
            .cap_magnitude(self.gains.speed_max_m_s);
        let wanted = self.velocity.update(&velocity, &estimate.velocity_m_s, period_s)
            + setpoint.acceleration_m_s2
            + Vector3::z() * self.body.gravity_m_s2;
        limited_tilt(wanted, self.body.gravity_m_s2, self.gains.tilt_max_rad)
    }

    /// Body rates that take the estimate to the wanted attitude; twice the error quaternion's vector
    /// part, and the yaw rate asked for about the world's vertical.
    fn rates_wanted(
        &self,
        wanted: &UnitQuaternion<f64>,
        estimate: &State,
        yaw_rate_rad_s: f64,
    ) -> Vector3<f64> {
        let turn = (estimate.attitude.inverse() * wanted).into_inner();
        let error = turn.imag() * (2.0 * turn.w.signum());
        let ahead = estimate.attitude.inverse_transform_vector(&(Vector3::z() * yaw_rate_rad_s));
        let (rates, most) = (self.gains.attitude.component_mul(&error) + ahead, &self.gains.rates_max_rad_s);
        rates.zip_map(most, |rate, most| rate.clamp(-most, most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random_vehicle;

    #[test]
    fn a_drift_takes_nothing_of_the_climb() {
        let vehicle = random_vehicle(1).truth;
        let gains = AutopilotGains::default();
        let thrust_n = |drift_m_s: f64, away_m: f64| {
            let mut cascade = AutopilotCascade::new(&vehicle, gains, 0.0).expect("flies");
            let across = Vector3::x();
            let estimate =
                State { velocity_m_s: across * drift_m_s, ..State::at_rest(Vector3::zeros(), 0.0) };
            let setpoint = Setpoint {
                position_m: across * away_m + Vector3::z(),
                velocity_m_s: Vector3::z() * 2.0,
                acceleration_m_s2: Vector3::zeros(),
                yaw_rad: 0.0,
                yaw_rate_rad_s: 0.0,
            };
            for _ in 0..100 {
                cascade.turn_at_height(None, &Vector3::zeros(), &setpoint, (&estimate, 0.004));
            }
            cascade.inner_loop_setpoint().thrust_n
        };
        let still_n = thrust_n(0.0, 0.0);
        assert!(still_n > 1.5 * vehicle.body.mass_kg * vehicle.gravity_m_s2, "{still_n}");
        for (drift_m_s, away_m) in [(15.0, 0.0), (0.0, 200.0), (-15.0, 200.0)] {
            let drifting_n = thrust_n(drift_m_s, away_m);
            assert!(
                (drifting_n - still_n).abs() < 1e-9,
                "{drift_m_s} {away_m}: {drifting_n}, still {still_n}"
            );
        }
    }
}
