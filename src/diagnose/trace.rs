//! One flight for the weak form: measured states, and the rotor thrusts in two versions, from commands and from the
//! motion.

use super::instruments::{Instruments, instruments};
use super::momentum::{Momentum, MomentumRows, WeakMotion};
use super::rotors::{OfRotors, RotorMotion, felt, filtered};
use super::timing::{command_period_s, inertial_late};
use super::trace_error::TraceError;
use crate::physics::{ActuationLatency, Airframe, State};
use crate::reconstruction::velocity_error_m_s;
use crate::signals::{
    Butterworth, Grid, OwnOfFlight, Series, Signals, ThrustSource, TorqueError, VelocityHeldBy, WeakKernel,
    central_difference, stride,
};
use crate::vehicle::{Propulsion, RigidBody, Vehicle};
use nalgebra::{DMatrix, UnitQuaternion, Vector3, Vector4};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Cut-off of the zero-phase low-pass of the regressors' signals, Hz. The kernel of 0.4 s passes little of faster
/// motion; a lower cut-off would take part of it.
const SMOOTH_HZ: f64 = 6.0;

/// A flight prepared for diagnosis. Series have one entry a grid instant.
#[derive(Debug, Clone)]
pub struct Trace {
    /// instants
    pub grid: Grid,
    /// airborne, no gap, not saturated
    pub usable: Vec<bool>,
    /// weak form's test function
    pub kernel: WeakKernel,
    /// grid indices of the rows
    pub centers: Vec<usize>,
    /// rows without a break between them
    pub runs: Vec<Range<usize>>,
    /// measured states; parts that were not recorded are zero (attitude: level)
    pub states: Series<State>,
    /// parts of the state that are measured
    pub known: Known,
    /// commands and body rates are fast enough to compare torques row by row; else they are averaged
    pub torques: bool,
    /// V
    pub voltage_v: Option<Series<f64>>,
    /// thrusts are computed from measured rotor speeds: effects between command and speed are not visible
    pub measured_speeds: bool,
    /// rad/s, white noise of the gyroscopes at their own samples, largest axis; 0 where it is not known
    pub gyro_noise_rad_s: f64,
    /// s between commands (or measured speeds) as logged
    pub command_period_s: f64,
    /// s, delay of the inertial unit relative to both attitude and velocity: that of its filters
    pub inertial_late_s: f64,
    /// s, uncertainty of this delay: the difference of attitude and velocity, or the advance of the attitude alone
    pub inertial_unsure_s: f64,
    /// m/s^2, body, accelerometer
    specific_force_m_s2: Option<Series<Vector3<f64>>>,
    /// N, as commanded (or measured), each rotor, on the scale of `full_thrust_n`
    commanded_n: OfRotors,
    /// N, N m: contribution of the commands' jitter if the rotors follow all of it, on the same scale
    jitter: Option<Series<Vector4<f64>>>,
    /// N, thrust of one rotor at u = 1
    full_thrust_n: f64,
    /// zero-phase low-pass of body rates, rad/s; the next two are their derivative, rad/s^2, and the specific force along z, m/s^2
    smooth_rate: Series<Vector3<f64>>,
    smooth_turning: Series<Vector3<f64>>,
    smooth_lift: Series<f64>,
    /// specific force, body, m/s^2: the accelerometer's, else the smoothed one of the kinematics
    pub(super) felt_m_s2: Series<Vector3<f64>>,
    /// m/s^2
    pub gravity_m_s2: f64,
    /// what holds the vertical velocity beside the accelerometer
    pub velocity_held_by: VelocityHeldBy,
    /// a satellite receiver gives the position
    pub position_by_receiver: bool,
    /// what all torques have in common as an error
    pub torque_error: TorqueError,
    /// a simulator flew it
    pub simulated: bool,
    /// what it has beside the vehicle's other flights
    pub own: OwnOfFlight,
    /// m/s rms, slow error of the horizontal velocity by a satellite receiver; `None` without one
    pub velocity_error_m_s: Option<f64>,
    /// if the commanded trajectory was recorded and torques are compared
    pub(super) instruments: Option<Arc<Instruments>>,
    /// what every model of this motion is compared with, once it was asked for
    weak_motion: Arc<OnceLock<WeakMotion>>,
}

/// Which parts of the state are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Known {
    /// attitude
    pub attitude: bool,
    /// velocity
    pub velocity: bool,
    /// position
    pub position: bool,
}

impl Trace {
    /// Prepares a flight from conditioned signals.
    ///
    /// # Errors
    /// [`TraceError`] where rates, forces or rotor thrusts are not known.
    pub fn new(signals: &Signals, vehicle: &Vehicle, half_width_s: f64) -> Result<Self, TraceError> {
        let grid = signals.grid;
        let rates = signals.rate.as_ref().ok_or(TraceError::NoRates)?;
        if signals.rotor_thrust_n.is_empty() {
            return Err(TraceError::NoRotors);
        }
        let known = Known {
            attitude: signals.attitude.is_some(),
            velocity: signals.velocity.is_some(),
            position: signals.position.is_some(),
        };
        let kinematic = known.attitude && known.velocity;
        // readings that their rounding hides are a constant, and no measurement
        let measured =
            signals.specific_force.as_ref().filter(|_| !kinematic || signals.resolves_specific_force());
        if measured.is_none() && !kinematic {
            return Err(TraceError::NoForce);
        }
        let kernel = WeakKernel::new(half_width_s, grid.step_s);
        let (centers, runs) = centers_and_runs(signals, &kernel);
        let (inertial_late_s, inertial_unsure_s) = inertial_late(signals);
        let mut trace = Self {
            grid,
            usable: signals.usable.clone(),
            kernel,
            centers,
            runs,
            states: states(signals, rates).into(),
            known,
            torques: signals.quality.torques,
            voltage_v: signals.battery_voltage_v.clone(),
            measured_speeds: signals.quality.thrust_source == ThrustSource::MeasuredSpeed,
            gyro_noise_rad_s: signals.quality.gyro_noise_rad_s.unwrap_or(0.0),
            command_period_s: command_period_s(signals),
            inertial_late_s,
            inertial_unsure_s,
            specific_force_m_s2: measured.cloned(),
            commanded_n: OfRotors::new(vehicle.rotors.len(), signals.rotor_thrust_n.clone()),
            jitter: signals.jitter_wrench.clone(),
            full_thrust_n: signals.full_thrust_n,
            smooth_rate: Series::default(),
            smooth_turning: Series::default(),
            smooth_lift: Series::default(),
            felt_m_s2: Series::default(),
            gravity_m_s2: vehicle.gravity_m_s2,
            velocity_held_by: signals.quality.velocity_held_by,
            position_by_receiver: signals.quality.position_by_receiver,
            torque_error: signals.quality.torque_error,
            simulated: signals.quality.simulated,
            own: signals.own.clone(),
            velocity_error_m_s: velocity_error_m_s(signals),
            instruments: None,
            weak_motion: Arc::default(),
        };
        trace.smooth()?;
        let weak = |order, series: &[f64]| trace.weak(order, series);
        let of = |reference| Arc::new(instruments(reference, (grid.step_s, trace.gravity_m_s2), weak));
        trace.instruments = signals.reference.as_ref().filter(|_| trace.torques).map(of);
        Ok(trace)
    }

    /// The same flight with another motion: states and specific force (m/s^2, body), one entry a grid instant.
    pub(super) fn with_motion(
        &self,
        states: Vec<State>,
        specific_force_m_s2: Option<Vec<Vector3<f64>>>,
    ) -> Result<Self, TraceError> {
        let mut trace = self.reading(states, specific_force_m_s2.map(Series::new));
        trace.smooth()?;
        Ok(trace)
    }

    /// The same if only the measurements of force and momentum are needed; smoothed series stay as they were.
    pub(super) fn reading(
        &self,
        states: Vec<State>,
        specific_force_m_s2: Option<Series<Vector3<f64>>>,
    ) -> Self {
        Self { states: states.into(), specific_force_m_s2, weak_motion: Arc::default(), ..self.clone() }
    }

    /// Measured specific force, m/s^2, body; `None` without an accelerometer.
    pub(super) fn specific_force_m_s2(&self) -> Option<&Series<Vector3<f64>>> {
        self.specific_force_m_s2.as_ref()
    }

    /// Number of weak-form rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.centers.len()
    }

    /// `K` of a series at every row.
    #[must_use]
    pub fn weak(&self, order: usize, series: &[f64]) -> Vec<f64> {
        self.kernel.apply(order, series, &self.centers)
    }

    /// `K` of a vector series, axis by axis.
    #[must_use]
    pub fn weak_vector(&self, order: usize, series: &[Vector3<f64>]) -> [Vec<f64>; 3] {
        self.kernel.apply_vector(order, series, &self.centers)
    }

    /// The same at some of the rows, of a series over the instants that these reach.
    pub(super) fn weak_vector_in(
        &self,
        order: usize,
        series: &[Vector3<f64>],
        rows: &Range<usize>,
    ) -> [Vec<f64>; 3] {
        let from = self.reach(rows).start;
        let centers: Vec<usize> = self.centers[rows.clone()].iter().map(|center| center - from).collect();
        self.kernel.apply_vector(order, series, &centers)
    }

    /// Instants that the test functions of these rows reach.
    pub(super) fn reach(&self, rows: &Range<usize>) -> Range<usize> {
        match self.centers[rows.clone()] {
            [first, .., last] => first - self.kernel.half_count..last + self.kernel.half_count + 1,
            [only] => only - self.kernel.half_count..only + self.kernel.half_count + 1,
            [] => 0..0,
        }
    }

    /// An accelerometer is recorded.
    #[must_use]
    pub fn has_accelerometer(&self) -> bool {
        self.specific_force_m_s2.is_some()
    }

    /// Whether the force is measured both by accelerometer and by kinematics.
    #[must_use]
    pub fn reads_force_twice(&self) -> bool {
        self.has_accelerometer() && self.known.attitude && self.known.velocity
    }

    /// `K` of the specific force, m/s^2, body, for each available measurement, the accelerometer's first.
    #[must_use]
    pub fn weak_specific_force(&self) -> &[[Vec<f64>; 3]] {
        &self.weak_motion().specific_force
    }

    /// For each entry of the inertia (xx xy xz yy yz zz): torque rows per kg m^2, of a body with this share of the gyroscopic torque.
    pub(super) fn momentum(&self, gyroscopic: f64) -> Cow<'_, MomentumRows> {
        self.weak_motion().momentum.with_share(gyroscopic)
    }

    /// The whole gyroscopic torque of a body, rows about body x, y, z, N m.
    pub(super) fn gyroscopic(&self, body: &RigidBody) -> [Vec<f64>; 3] {
        self.weak_motion().momentum.gyroscopic_nm(&body.inertia_kg_m2)
    }

    fn weak_motion(&self) -> &WeakMotion {
        self.weak_motion.get_or_init(|| {
            let measured = self.specific_force_m_s2.as_ref().map(|force| self.weak_vector(0, force));
            let specific_force = measured.into_iter().chain(self.weak_kinematic()).collect();
            let rates: Vec<Vector3<f64>> = self.states.iter().map(|state| state.rates_rad_s).collect();
            let momentum = Momentum::of(&rates, |order, series| self.weak(order, series));
            WeakMotion { specific_force, momentum: momentum.map(|axes| self.torque_rows(axes)) }
        })
    }

    fn smooth(&mut self) -> Result<(), TraceError> {
        let rate_hz = 1.0 / self.grid.step_s;
        let filter =
            Butterworth::new(SMOOTH_HZ.min(0.4 * rate_hz), rate_hz).ok_or(TraceError::TooSlow { rate_hz })?;
        let rates: [Vec<f64>; 3] = std::array::from_fn(|axis| {
            filter.filtfilt(&self.states.iter().map(|s| s.rates_rad_s[axis]).collect::<Vec<_>>())
        });
        let turning = rates.each_ref().map(|rate| central_difference(rate, self.grid.step_s));
        let vectors = |axes: &[Vec<f64>; 3]| -> Vec<Vector3<f64>> {
            (0..self.grid.count).map(|i| Vector3::new(axes[0][i], axes[1][i], axes[2][i])).collect()
        };
        self.smooth_rate = vectors(&rates).into();
        self.smooth_turning = vectors(&turning).into();
        let measured = self.specific_force_m_s2.clone();
        let force = measured.clone().unwrap_or_else(|| self.kinematic_force().into());
        let along = |axis: usize| filter.filtfilt(&force.iter().map(|force| force[axis]).collect::<Vec<_>>());
        let lift = along(2);
        self.felt_m_s2 = measured.unwrap_or_else(|| vectors(&[along(0), along(1), lift.clone()]).into());
        self.smooth_lift = lift.into();
        Ok(())
    }

    /// Specific force by differentiation, body, m/s^2; only for use behind the low-pass.
    fn kinematic_force(&self) -> Vec<Vector3<f64>> {
        let velocity: Vec<Vec<f64>> =
            (0..3).map(|axis| self.states.iter().map(|s| s.velocity_m_s[axis]).collect()).collect();
        let acceleration: Vec<Vec<f64>> =
            velocity.iter().map(|v| central_difference(v, self.grid.step_s)).collect();
        (0..self.grid.count)
            .map(|i| {
                let world = Vector3::new(acceleration[0][i], acceleration[1][i], acceleration[2][i]);
                let felt = world + Vector3::z() * self.gravity_m_s2;
                self.states[i].attitude.inverse_transform_vector(&felt)
            })
            .collect()
    }

    /// Rotor thrusts from the commands, N, behind the latency.
    #[must_use]
    pub fn felt_n(&self, airframe: &Airframe, latency: ActuationLatency) -> OfRotors {
        let factor = airframe.propulsion.full_thrust_n() / self.full_thrust_n;
        felt(&self.commanded_n, self.grid.step_s, latency).scaled(factor)
    }

    /// N, N m: contribution of the commands' jitter on the airframe's scale if the rotors follow all of it.
    #[must_use]
    pub fn jitter(&self, propulsion: &Propulsion) -> Option<Vec<Vector4<f64>>> {
        let factor = propulsion.full_thrust_n() / self.full_thrust_n;
        self.jitter.as_ref().map(|jitter| jitter.iter().map(|jitter| jitter * factor).collect())
    }

    /// Rotor thrusts from the commands, N, behind the latency: raw, and smoothed for regressors.
    #[must_use]
    pub fn by_commands(&self, airframe: &Airframe, latency: ActuationLatency) -> (OfRotors, RotorMotion) {
        let felt = self.felt_n(airframe, latency);
        let rate_hz = 1.0 / self.grid.step_s;
        let filter = Butterworth::new(SMOOTH_HZ.min(0.4 * rate_hz), rate_hz);
        let smooth = filtered(&felt, |column| {
            filter.as_ref().map_or_else(|| vec![0.0; column.len()], |filter| filter.filtfilt(column))
        });
        let turning = RotorMotion::new(smooth, airframe, self.grid.step_s);
        (felt, turning)
    }

    /// Rotor thrusts that, together with `effects` (N, N m in addition to the rotors' own wrench; `[Fz tau]`), give the
    /// measured motion. They contain the noise of the motion, not that of the commands.
    #[must_use]
    pub fn by_motion(
        &self,
        vehicle: &Vehicle,
        commanded: &RotorMotion,
        effects: Option<&[Vector4<f64>]>,
    ) -> OfRotors {
        let mixer = vehicle.mixer().matrix;
        let rotors = vehicle.rotors.len();
        let mixer = DMatrix::from_fn(4, rotors, |i, j| mixer[(i, j)]);
        let Ok(inverse) = mixer.clone().pseudo_inverse(1e-12) else { return commanded.thrust_n.clone() };
        let mut out: Vec<f64> = Vec::with_capacity(rotors * self.grid.count);
        for (i, thrusts) in commanded.thrust_n.each().enumerate() {
            let torque = vehicle.body.turning_torque_nm(&self.smooth_rate[i], &self.smooth_turning[i]);
            let lift_n = vehicle.body.mass_kg * self.smooth_lift[i];
            let mut short = Vector4::new(lift_n, torque.x, torque.y, torque.z);
            if let Some(effects) = effects {
                short -= effects[i];
            }
            for (rotor, thrust) in thrusts.iter().enumerate() {
                short -= Vector4::from_fn(|row, _| mixer[(row, rotor)] * thrust);
            }
            out.extend(thrusts.iter().enumerate().map(|(rotor, thrust)| {
                thrust + (0..4).map(|row| inverse[(rotor, row)] * short[row]).sum::<f64>()
            }));
        }
        OfRotors::new(rotors, out.into())
    }

    /// Torque that the measured rotation needs, `J w' + w x J w`, smoothed, body, N m.
    #[must_use]
    pub fn turning_torque(&self, body: &RigidBody) -> Vec<Vector3<f64>> {
        self.smooth_rate
            .iter()
            .zip(self.smooth_turning.iter())
            .map(|(rate, turning)| body.turning_torque_nm(rate, turning))
            .collect()
    }
}

/// The instants at which kernels are centred, and the rows of each run of usable instants.
fn centers_and_runs(signals: &Signals, kernel: &WeakKernel) -> (Vec<usize>, Vec<Range<usize>>) {
    let (half, stride) = (kernel.half_count, stride(signals.grid.step_s));
    let (mut centers, mut runs) = (Vec::new(), Vec::new());
    for run in Grid::runs(&signals.usable, 2 * half + 1) {
        let first = centers.len();
        centers.extend((run.start + half..run.end - half).step_by(stride));
        runs.push(first..centers.len());
    }
    (centers, runs)
}

/// States at each grid instant; what is not known is zero or level.
fn states(signals: &Signals, rates: &[Vector3<f64>]) -> Vec<State> {
    let of = |series: &Option<Series<Vector3<f64>>>, i: usize| {
        series.as_ref().map_or_else(Vector3::zeros, |series| series[i])
    };
    (0..signals.grid.count)
        .map(|i| State {
            position_m: of(&signals.position, i),
            velocity_m_s: of(&signals.velocity, i),
            attitude: signals.attitude.as_ref().map_or_else(UnitQuaternion::identity, |attitude| attitude[i]),
            rates_rad_s: rates[i],
        })
        .collect()
}
