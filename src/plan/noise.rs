//! The noise of the balances (7) to (10) as a weak-form regression on commands sees it.
//!
//! The command loop runs faster than the log. A logged command is one tick of it, while the body feels the
//! mean of all ticks: of white jitter of `s` a tick, `s^2 (1/f_log - 1/f_control)` is left as density of
//! the difference. The jitter is the controller's answer to the noise on which it flies, an acceleration
//! times the mass or inertia that the controller believes in, and so does not follow from the rotors.
//! Accelerometer, velocity and the gyro's derivative come with the regressor. A tilt that is wanted by noise reaches the
//! balances about x and z together. What the accelerometer's noise adds to the mean is gone with its offset, and the
//! velocity's is there in its place.

use crate::estimate::{NoiseTerm, Theta, scale_of, theta_of};
use crate::regression::CHANNELS;
use crate::signals::WeakKernel;
use crate::simulate::FlightSettings;
use crate::vehicle::Vehicle;
use nalgebra::Vector4;

/// Sensors, command loop and log of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// accelerometer, one axis, m/s^2, one sample
    pub accelerometer_m_s2: f64,
    /// gyro, one axis, rad/s, one sample
    pub gyro_rad_s: f64,
    /// velocity, one axis, m/s, one sample
    pub velocity_m_s: f64,
    /// white jitter of one tick's thrust command, as thrust per mass, m/s^2
    pub thrust_jitter_m_s2: f64,
    /// the same of the torque commands that answers the noise of attitude and rates, as angular
    /// acceleration about body x, y, z, rad/s^2
    pub torque_jitter_rad_s2: [f64; 3],
    /// the same caused by a noisy desired tilt in hover, rad/s^2, about body x and y. Less thrust makes more tilt of a
    /// noisy desired force. If the thrust axis leans towards the heading, which is held about the world's vertical, a
    /// noisy tilt also rotates the desired attitude about body z
    pub tilt_jitter_rad_s2: f64,
    /// ticks of the command loop, 1/s
    pub control_rate_hz: f64,
    /// rate at which accelerometer, gyro and commands are logged, 1/s; samples count as independent
    pub log_rate_hz: f64,
    /// rate at which velocity is logged, 1/s
    pub velocity_rate_hz: f64,
    /// half the width of the weak form's kernel, s
    pub kernel_half_width_s: f64,
}

impl Default for NoiseModel {
    /// The noise of the simulated flights: sensors of the class of a Pixhawk, control at 250 Hz logged at 125 Hz.
    fn default() -> Self {
        Self::of_loop(&FlightSettings::default(), 9.81)
    }
}

/// Share of the accelerometer in the vertical motion if velocity is recorded as well. Only the expected error of a
/// plan depends on it.
const ACCELEROMETER_SHARE: f64 = 0.8;

impl NoiseModel {
    /// Command jitter of a cascaded controller from sensor noise, to first order at hover. Position and velocity cause
    /// thrust along z, and along x and y a tilt, from which the attitude gain makes a torque; attitude and rates cause
    /// torques.
    #[must_use]
    pub fn of_loop(settings: &FlightSettings, gravity_m_s2: f64) -> Self {
        let (gains, sensed) = (&settings.gains, settings.control_noise.scaled(settings.control_noise_scale));
        let logged = settings.telemetry.noise.scaled(settings.telemetry.noise_scale);
        let path = (gains.position * sensed.position_m).hypot(gains.velocity * sensed.velocity_m_s);
        let turning = (gains.attitude * sensed.attitude_rad).hypot(gains.rates * sensed.rates_rad_s);
        Self {
            accelerometer_m_s2: logged.specific_force_m_s2,
            gyro_rad_s: logged.rates_rad_s,
            velocity_m_s: logged.velocity_m_s,
            thrust_jitter_m_s2: path,
            torque_jitter_rad_s2: [turning; 3],
            tilt_jitter_rad_s2: gains.attitude * path / gravity_m_s2,
            control_rate_hz: 1.0 / settings.control_period_s,
            log_rate_hz: settings.telemetry.rates.actuator_hz,
            velocity_rate_hz: settings.telemetry.rates.position_hz,
            kernel_half_width_s: 0.2,
        }
    }

    /// s: the density that white noise of unit variance a tick leaves between the log and what acts. A
    /// loop no faster than its log has every tick in it.
    fn unseen_s(&self) -> f64 {
        (1.0 / self.log_rate_hz - 1.0 / self.control_rate_hz).max(0.0)
    }

    /// Densities of white noise in the four balances: those of commands and accelerometer (N^2 s, (N m)^2 s), and those
    /// on which the kernel's derivative acts ((N s)^2 s, (N m s)^2 s).
    fn densities(&self, vehicle: &Vehicle) -> [(f64, f64); CHANNELS] {
        let moments = vehicle.body.inertia_kg_m2.diagonal();
        std::array::from_fn(|channel| {
            if channel == 0 {
                let square = vehicle.body.mass_kg.powi(2);
                let kinematic = (1.0 - ACCELEROMETER_SHARE).powi(2) * self.velocity_density();
                (square * self.thrust_jitter_m_s2.powi(2) * self.unseen_s(), square * kinematic)
            } else {
                let square = moments[channel - 1].powi(2);
                let jitter = self.torque_jitter_rad_s2[channel - 1].powi(2) * self.unseen_s();
                (square * jitter, square * self.gyro_rad_s.powi(2) / self.log_rate_hz)
            }
        })
    }

    /// Density of the velocity's noise, (m/s)^2 s.
    fn velocity_density(&self) -> f64 {
        self.velocity_m_s.powi(2) / self.velocity_rate_hz
    }

    /// Density of the accelerometer's share in the vertical balance, N^2 s.
    fn accelerometer_density(&self, vehicle: &Vehicle) -> f64 {
        (vehicle.body.mass_kg * ACCELEROMETER_SHARE * self.accelerometer_m_s2).powi(2) / self.log_rate_hz
    }

    /// Noises of the weak form's rows.
    #[must_use]
    pub fn of_rows(
        &self,
        vehicle: &Vehicle,
        rows: &RowSpacing<'_>,
        RowMotion { tilting, turning_rad_s }: RowMotion,
    ) -> Vec<NoiseTerm> {
        let densities = self.densities(vehicle).into_iter().enumerate();
        let mut noise: Vec<NoiseTerm> = densities
            .flat_map(|(channel, (own, derived))| {
                let reaches = || vec![(channel, Vec::new())];
                [rows.coloured(own, 0, reaches()), rows.coloured(derived, 1, reaches())]
            })
            .collect();
        // the accelerometer's offset is that to the velocity's kinematics: its own mean is gone, and theirs is in its place
        let measured = rows.coloured(self.accelerometer_density(vehicle), 0, vec![(0, Vec::new())]);
        noise.push(NoiseTerm { of_mean: -1.0, ..measured });
        let rest = vehicle.body.mass_kg * (1.0 - ACCELEROMETER_SHARE);
        let across = turning_rad_s.into_iter().map(|rate| rest * rate).collect();
        let kinematic = rows.coloured(self.velocity_density(), 0, vec![(0, across)]);
        noise.push(NoiseTerm { of_mean: ACCELEROMETER_SHARE / (1.0 - ACCELEROMETER_SHARE), ..kinematic });
        let moments = vehicle.body.inertia_kg_m2.diagonal();
        let mut reaches = tilting.into_iter().enumerate().map(|(axis, tilting)| {
            (1 + axis, tilting.into_iter().map(|factor| moments[axis] * factor).collect::<Vec<f64>>())
        });
        let [about_x, about_y, about_z] = std::array::from_fn(|_| reaches.next());
        let tilt = self.tilt_density();
        noise.push(rows.coloured(tilt, 0, about_x.into_iter().chain(about_z).collect()));
        noise.push(rows.coloured(tilt, 0, about_y.into_iter().collect()));
        noise
    }

    /// Density of the angular acceleration that a noisy tilt in hover causes, (rad/s^2)^2 s.
    fn tilt_density(&self) -> f64 {
        self.tilt_jitter_rad_s2.powi(2) * self.unseen_s()
    }

    /// Inverse variance, per second of flight, of the balances Fz, `tau_x`, `tau_y`, `tau_z`
    /// (1/(N^2 s), 1/((N m)^2 s)): the kernel's colour as one number, for the criteria.
    ///
    /// The derivative of white noise has, under a kernel of half width H, `c / H^2` times its density:
    /// `c = 34/7` for `(1 - s^2)^4`, the ratio of the integrals of the squared derivative and of the
    /// squared kernel. A tilt counts as it does in hover.
    #[must_use]
    pub fn row_information(&self, vehicle: &Vehicle) -> Vector4<f64> {
        const KERNEL_RATIO: f64 = 34.0 / 7.0;
        let widened = KERNEL_RATIO / self.kernel_half_width_s.powi(2);
        let moments = vehicle.body.inertia_kg_m2.diagonal();
        let tilting = Vector4::new(0.0, moments.x.powi(2), moments.y.powi(2), 0.0) * self.tilt_density();
        let rest = Vector4::from(self.densities(vehicle).map(|(own, derived)| own + widened * derived));
        let measured = Vector4::new(self.accelerometer_density(vehicle), 0.0, 0.0, 0.0);
        (rest + tilting + measured).map(f64::recip)
    }
}

/// Factors of the motion at each row on noise.
#[derive(Debug, Clone, PartialEq)]
pub struct RowMotion {
    /// what a noisy tilt in hover becomes about body x, y, z, factors: about z it is the tilt about x that turns the vehicle
    pub tilting: [Vec<f64>; 3],
    /// rate across body z, rad/s, by which horizontal velocity comes into the vertical balance
    pub turning_rad_s: Vec<f64>,
}

/// Spacing of the rows in time.
#[derive(Debug, Clone, Copy)]
pub struct RowSpacing<'a> {
    /// the weak form's kernel
    pub kernel: &'a WeakKernel,
    /// s between samples
    pub step_s: f64,
    /// samples between rows
    pub stride: usize,
}

impl RowSpacing<'_> {
    /// White noise of this density under the kernel's derivative of this order.
    fn coloured(&self, density: f64, order: usize, reaches: Vec<(usize, Vec<f64>)>) -> NoiseTerm {
        let lags = (0..=2 * self.kernel.half_count).step_by(self.stride.max(1));
        let variance = density / self.step_s;
        let autocovariance = lags.map(|lag| variance * self.kernel.noise_covariance(order, lag)).collect();
        NoiseTerm { autocovariance, reaches, of_mean: 0.0 }
    }
}

/// The size to which each parameter's error is compared (kg, kg m^2): mass and moments of inertia themselves, and for
/// the product of two axes the geometric mean of their moments.
#[must_use]
pub fn parameter_scale(vehicle: &Vehicle) -> Theta {
    let theta = theta_of(&vehicle.body);
    Theta::from_fn(|index, _| scale_of(&theta, index))
}

/// Names of `Theta` in files and JSON.
pub use crate::estimate::NAMES as PARAMETERS;
