//! The autopilot of synthetic flights: position and attitude control on noisy estimates.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3, Vector4};

use super::SimulateError;
use super::allocation::Allocation;
use crate::physics::{MAX_ROTORS, RigidBodyModel, State};
use crate::vehicle::Vehicle;

/// What the vehicle shall do, world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint {
    /// m
    pub position_m: Vector3<f64>,
    /// m/s
    pub velocity_m_s: Vector3<f64>,
    /// m/s^2
    pub acceleration_m_s2: Vector3<f64>,
    /// about up
    pub yaw_rad: f64,
    /// about up
    pub yaw_rate_rad_s: f64,
}

/// Gains as accelerations per error, so that one set flies every size of vehicle.
///
/// The defaults put the closed loop's poles near 3 rad/s (position) and 13 rad/s (attitude), and pass
/// the default sensor noise on as 0.09 m/s^2, 1.5 rad/s^2 about x and y and 0.3 rad/s^2 about z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CascadeGains {
    /// 1/s^2
    pub position: f64,
    /// 1/s
    pub velocity: f64,
    /// 1/s^3
    pub position_integral: f64,
    /// 1/s^2
    pub attitude: f64,
    /// 1/s
    pub rates: f64,
    /// greatest tilt asked for, rad
    pub tilt_max_rad: f64,
}

impl Default for CascadeGains {
    fn default() -> Self {
        Self {
            position: 8.0,
            velocity: 5.5,
            position_integral: 2.0,
            attitude: 160.0,
            rates: 28.0,
            tilt_max_rad: 0.7,
        }
    }
}

/// Geometric tracking control (Lee, Leok and McClamroch 2010) with an integral on position, and the
/// allocation of thrust and torque to rotors by the mixer's pseudo-inverse.
#[derive(Debug, Clone)]
pub struct CascadeController {
    gains: CascadeGains,
    body: RigidBodyModel,
    allocation: Allocation,
    integral_m_s: Vector3<f64>,
}

impl CascadeController {
    /// A controller that believes `vehicle`; commands stay within `command_min` to 1.
    ///
    /// # Errors
    /// If the vehicle is not physical or its rotors do not span thrust and three torques.
    pub fn new(vehicle: &Vehicle, gains: CascadeGains, command_min: f64) -> Result<Self, SimulateError> {
        let body = RigidBodyModel::new(&vehicle.body, vehicle.gravity_m_s2)?;
        let allocation = Allocation::new(vehicle, command_min)?;
        Ok(Self { gains, body, allocation, integral_m_s: Vector3::zeros() })
    }

    /// Normalised commands u for an estimate of the state; called every `period_s` (s).
    pub fn commands(&mut self, setpoint: &Setpoint, estimate: &State, period_s: f64) -> [f64; MAX_ROTORS] {
        let (force_n, attitude) = self.thrust_vector(setpoint, estimate, period_s);
        let thrust_n = force_n.dot(&(estimate.attitude * Vector3::z()));
        let torque_nm = self.torque(setpoint, estimate, &attitude);
        self.allocation.commands(&Vector4::new(thrust_n, torque_nm.x, torque_nm.y, torque_nm.z))
    }

    /// Force wanted (world, N) and the attitude that points the thrust along it.
    fn thrust_vector(
        &mut self,
        setpoint: &Setpoint,
        estimate: &State,
        period_s: f64,
    ) -> (Vector3<f64>, UnitQuaternion<f64>) {
        let gains = &self.gains;
        let error_m = setpoint.position_m - estimate.position_m;
        let error_m_s = setpoint.velocity_m_s - estimate.velocity_m_s;
        self.integral_m_s += error_m * period_s;
        let wanted = setpoint.acceleration_m_s2
            + error_m * gains.position
            + error_m_s * gains.velocity
            + self.integral_m_s * gains.position_integral
            + Vector3::z() * self.body.gravity_m_s2;
        let wanted = limited_tilt(wanted, self.body.gravity_m_s2, gains.tilt_max_rad);
        let attitude = attitude_of_thrust(&wanted, setpoint.yaw_rad);
        (wanted * self.body.mass_kg, attitude)
    }

    /// Torque (body, N m) that turns the estimate towards the wanted attitude.
    fn torque(&self, setpoint: &Setpoint, estimate: &State, wanted: &UnitQuaternion<f64>) -> Vector3<f64> {
        // twice the vector part: sin of the half angle, close to the angle where the loop works
        let turn = (wanted.inverse() * estimate.attitude).into_inner();
        let error = turn.imag() * (2.0 * turn.w.signum());
        let w = estimate.rates_rad_s;
        let rates_wanted =
            estimate.attitude.inverse_transform_vector(&(Vector3::z() * setpoint.yaw_rate_rad_s));
        let acceleration = -error * self.gains.attitude - (w - rates_wanted) * self.gains.rates;
        self.body.turning_torque_nm(&w, &acceleration)
    }
}

/// The attitude whose z axis lies along `wanted` (world) and whose nose points to `yaw_rad`.
pub(super) fn attitude_of_thrust(wanted: &Vector3<f64>, yaw_rad: f64) -> UnitQuaternion<f64> {
    let up = wanted.normalize();
    let heading = Vector3::new(yaw_rad.cos(), yaw_rad.sin(), 0.0);
    let left = up.cross(&heading).normalize();
    let matrix = Matrix3::from_columns(&[left.cross(&up), left, up]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
}

/// Keeps a wanted acceleration (world, gravity included) from hanging below a third of hover and from
/// tilting beyond a bound (rad).
pub(super) fn limited_tilt(mut wanted: Vector3<f64>, gravity_m_s2: f64, tilt_max_rad: f64) -> Vector3<f64> {
    wanted.z = wanted.z.max(gravity_m_s2 / 3.0);
    let (side, most) = (wanted.xy().norm(), wanted.z * tilt_max_rad.tan());
    if side > most {
        wanted.x *= most / side;
        wanted.y *= most / side;
    }
    wanted
}
