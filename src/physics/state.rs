//! Where the vehicle is, how that changes, and what pushes it.

use std::ops::{Add, AddAssign, Mul, Sub};

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3, Vector4};

/// Numbers in the rigid body's state vector: position, velocity, quaternion (w x y z), rates.
pub const RIGID_STATES: usize = 13;

/// State of the rigid body. Position and velocity are those of the centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// world, m
    pub position_m: Vector3<f64>,
    /// world, m/s
    pub velocity_m_s: Vector3<f64>,
    /// body to world
    pub attitude: UnitQuaternion<f64>,
    /// body, rad/s
    pub rates_rad_s: Vector3<f64>,
}

impl State {
    /// At rest and level at a place (world, m) with a heading (rad about up).
    #[must_use]
    pub fn at_rest(position_m: Vector3<f64>, yaw_rad: f64) -> Self {
        Self {
            position_m,
            velocity_m_s: Vector3::zeros(),
            attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, yaw_rad),
            rates_rad_s: Vector3::zeros(),
        }
    }

    /// Velocity of the paper's (1): in the body frame, m/s.
    #[must_use]
    pub fn body_velocity_m_s(&self) -> Vector3<f64> {
        self.attitude.inverse_transform_vector(&self.velocity_m_s)
    }

    /// Writes the state into the head of an integrator's vector of at least [`RIGID_STATES`] numbers;
    /// shorter vectors take what fits.
    #[inline]
    pub fn write<const N: usize>(&self, vector: &mut SVector<f64, N>) {
        let q = self.attitude.quaternion();
        let (p, v, w) = (&self.position_m, &self.velocity_m_s, &self.rates_rad_s);
        let numbers = [p.x, p.y, p.z, v.x, v.y, v.z, q.w, q.i, q.j, q.k, w.x, w.y, w.z];
        for (slot, number) in vector.iter_mut().zip(numbers) {
            *slot = number;
        }
    }

    /// Reads the head of an integrator's vector; the quaternion is brought to unit length.
    #[must_use]
    #[inline]
    pub fn read<const N: usize>(vector: &SVector<f64, N>) -> Self {
        const { assert!(N >= RIGID_STATES) };
        let v = vector.as_slice();
        Self {
            position_m: Vector3::new(v[0], v[1], v[2]),
            velocity_m_s: Vector3::new(v[3], v[4], v[5]),
            attitude: UnitQuaternion::from_quaternion(Quaternion::new(v[6], v[7], v[8], v[9])),
            rates_rad_s: Vector3::new(v[10], v[11], v[12]),
        }
    }
}

/// Time derivative of [`State`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateDerivative {
    /// world, m/s
    pub velocity_m_s: Vector3<f64>,
    /// world, m/s^2
    pub acceleration_m_s2: Vector3<f64>,
    /// 1/s
    pub quaternion_rate: Quaternion<f64>,
    /// body, rad/s^2
    pub angular_acceleration_rad_s2: Vector3<f64>,
}

impl StateDerivative {
    /// Writes the derivative in the order of [`State::write`].
    pub fn write<const N: usize>(&self, vector: &mut SVector<f64, N>) {
        let (v, a) = (&self.velocity_m_s, &self.acceleration_m_s2);
        let (q, w) = (&self.quaternion_rate, &self.angular_acceleration_rad_s2);
        let numbers = [v.x, v.y, v.z, a.x, a.y, a.z, q.w, q.i, q.j, q.k, w.x, w.y, w.z];
        for (slot, number) in vector.iter_mut().zip(numbers) {
            *slot = number;
        }
    }
}

/// Force and torque in the body frame, the torque about the centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// body, N
    pub force_n: Vector3<f64>,
    /// body, N m, about the centre of mass
    pub torque_nm: Vector3<f64>,
}

impl Wrench {
    /// Nothing pushes.
    #[must_use]
    #[inline]
    pub fn zero() -> Self {
        Self { force_n: Vector3::zeros(), torque_nm: Vector3::zeros() }
    }

    /// The paper's `F = [Fz tau_phi tau_theta tau_psi]` (N, N m).
    #[must_use]
    pub fn from_thrust_and_torque(f: &Vector4<f64>) -> Self {
        Self { force_n: Vector3::new(0.0, 0.0, f[0]), torque_nm: Vector3::new(f[1], f[2], f[3]) }
    }

    /// A force (body, N) that acts at `arm_m` (body, m, from the centre of mass).
    #[must_use]
    #[inline]
    pub fn at(arm_m: &Vector3<f64>, force_n: Vector3<f64>) -> Self {
        Self { force_n, torque_nm: arm_m.cross(&force_n) }
    }

    /// Adds a force (body, N) that acts at `arm_m` (body, m, from the centre of mass).
    #[inline]
    pub fn push_at(&mut self, arm_m: &Vector3<f64>, force_n: &Vector3<f64>) {
        self.force_n += force_n;
        self.torque_nm += arm_m.cross(force_n);
    }

    /// [`Self::push_at`] for a force along the rotor axis, body z.
    #[inline]
    pub fn lift_at(&mut self, arm_m: &Vector3<f64>, force_n: f64) {
        self.force_n.z += force_n;
        self.torque_nm.x += arm_m.y * force_n;
        self.torque_nm.y -= arm_m.x * force_n;
    }
}

impl Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force_n: self.force_n + other.force_n, torque_nm: self.torque_nm + other.torque_nm }
    }
}

impl AddAssign for Wrench {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.force_n += other.force_n;
        self.torque_nm += other.torque_nm;
    }
}

impl Sub for Wrench {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Wrench {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { force_n: self.force_n * factor, torque_nm: self.torque_nm * factor }
    }
}
