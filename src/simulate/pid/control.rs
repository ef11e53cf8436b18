//! The control law (28)-(32) with its saturations; knows no simulation.

use nalgebra::{Vector3, Vector4};

use crate::physics::euler_rates_inverse;

/// Diagonal gains of (31) and (32).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PidGains {
    /// `K_pp`, N/m
    pub position: Vector3<f64>,
    /// `K_ip`, N/(m s)
    pub position_integral: Vector3<f64>,
    /// `K_dp`, N/(m/s)
    pub position_derivative: Vector3<f64>,
    /// `K_po`, N m/rad
    pub attitude: Vector3<f64>,
    /// `K_io`, N m/(rad s)
    pub attitude_integral: Vector3<f64>,
    /// `K_do`, N m/(rad/s)
    pub attitude_derivative: Vector3<f64>,
}

impl Default for PidGains {
    /// As printed in section III-C.
    fn default() -> Self {
        Self {
            position: Vector3::new(11.5, 10.0, 10.5),
            position_integral: Vector3::new(0.04, 0.07, 1.3),
            position_derivative: Vector3::new(5.5, 5.0, 6.0),
            attitude: Vector3::new(2.0, 2.0, 2.6),
            attitude_integral: Vector3::new(0.03, 0.05, 0.01),
            attitude_derivative: Vector3::new(0.6, 0.6, 1.0),
        }
    }
}

/// What the controller knows and may do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PidSettings {
    /// gains
    pub gains: PidGains,
    /// m in (29), (30), (32): the nominal mass of Table 1, kg
    pub mass_kg: f64,
    /// g in (32), m/s^2
    pub gravity_m_s2: f64,
    /// bound on Fz, N
    pub thrust_max_n: f64,
    /// bound on each torque, N m
    pub torque_max_nm: f64,
    /// pole of `D(s) = p s / (s + p)`, which differentiates the desired roll and pitch, rad/s
    pub derivative_pole_rad_s: f64,
}

impl Default for PidSettings {
    /// As printed in sections III-A, III-C and IV-A.
    fn default() -> Self {
        Self {
            gains: PidGains::default(),
            mass_kg: 1.79,
            gravity_m_s2: crate::units::GRAVITY_M_S2,
            thrust_max_n: 34.4,
            torque_max_nm: 1.72,
            derivative_pole_rad_s: 20.0,
        }
    }
}

/// What the sensors hold: roll, pitch and their rates from the inertial unit, the rest from motion capture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feedback {
    /// world, m
    pub position_m: Vector3<f64>,
    /// world, m/s
    pub velocity_m_s: Vector3<f64>,
    /// roll, pitch, yaw, rad
    pub euler_rad: Vector3<f64>,
    /// their rates, rad/s
    pub euler_rates_rad_s: Vector3<f64>,
}

/// The controller and its memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pid {
    settings: PidSettings,
    position_integral: Vector3<f64>,
    attitude_integral: Vector3<f64>,
    /// low-passed desired roll and pitch, the state of D(s); `None` before the first call
    smoothed_tilt_rad: Option<[f64; 2]>,
}

impl Pid {
    /// A controller at rest.
    #[must_use]
    pub fn new(settings: PidSettings) -> Self {
        Self {
            settings,
            position_integral: Vector3::zeros(),
            attitude_integral: Vector3::zeros(),
            smoothed_tilt_rad: None,
        }
    }

    /// `F = [Fz tau]` (N, N m) within the saturations. `desired` holds value, first and second
    /// derivative of x, y, z (m) and psi (rad); called every `period_s` (s).
    pub fn wrench(&mut self, desired: &[[f64; 5]; 4], seen: &Feedback, period_s: f64) -> Vector4<f64> {
        let PidSettings { gains, mass_kg, gravity_m_s2, .. } = self.settings;
        let order = |n: usize| Vector3::new(desired[0][n], desired[1][n], desired[2][n]);
        // (32)
        let error = order(0) - seen.position_m;
        self.position_integral += error * period_s;
        let f = (order(2) + Vector3::z() * gravity_m_s2) * mass_kg
            + gains.position.component_mul(&error)
            + gains.position_integral.component_mul(&self.position_integral)
            + gains.position_derivative.component_mul(&(order(1) - seen.velocity_m_s));
        // (28)
        let thrust_n = f.z / (seen.euler_rad.x.cos() * seen.euler_rad.y.cos());
        let tilt = tilt_of_force(&f, desired[3][0]);
        let torque = self.torque(tilt, &desired[3], seen, period_s);
        let bound = self.settings.torque_max_nm;
        Vector4::new(
            thrust_n.clamp(0.0, self.settings.thrust_max_n),
            torque.x.clamp(-bound, bound),
            torque.y.clamp(-bound, bound),
            torque.z.clamp(-bound, bound),
        )
    }

    /// (31), before saturation.
    fn torque(&mut self, tilt: [f64; 2], yaw: &[f64; 5], seen: &Feedback, period_s: f64) -> Vector3<f64> {
        let gains = self.settings.gains;
        let tilt_rate = self.tilt_rate(tilt, period_s);
        let mut error = Vector3::new(tilt[0], tilt[1], yaw[0]) - seen.euler_rad;
        error.z -= std::f64::consts::TAU * (error.z / std::f64::consts::TAU).round();
        let rate_error = Vector3::new(tilt_rate[0], tilt_rate[1], yaw[1]) - seen.euler_rates_rad_s;
        self.attitude_integral += error * period_s;
        let action = gains.attitude.component_mul(&error)
            + gains.attitude_integral.component_mul(&self.attitude_integral)
            + gains.attitude_derivative.component_mul(&rate_error);
        euler_rates_inverse(seen.euler_rad.x, seen.euler_rad.y).transpose() * action
    }

    /// D(s), exact for an input that is held over the period.
    pub(super) fn tilt_rate(&mut self, tilt_rad: [f64; 2], period_s: f64) -> [f64; 2] {
        let pole = self.settings.derivative_pole_rad_s;
        let smoothed = self.smoothed_tilt_rad.get_or_insert(tilt_rad);
        let share = 1.0 - (-pole * period_s).exp();
        std::array::from_fn(|axis| {
            let rate = pole * (tilt_rad[axis] - smoothed[axis]);
            smoothed[axis] += share * (tilt_rad[axis] - smoothed[axis]);
            rate
        })
    }
}

/// (29), (30): roll and pitch (rad) that point the thrust along a force (world, N) at this heading.
///
/// Printed is `m f / f_z`, a mass too many: (32) gives a force already, and only without that mass do
/// (29), (30) become (26), (27) when the position error is zero, as the paper says they do.
#[must_use]
pub fn tilt_of_force(f: &Vector3<f64>, yaw_rad: f64) -> [f64; 2] {
    let (sin, cos) = yaw_rad.sin_cos();
    let pitch = ((f.x * cos + f.y * sin) / f.z).atan();
    let roll = (pitch.cos() * (f.x * sin - f.y * cos) / f.z).atan();
    [roll, pitch]
}
