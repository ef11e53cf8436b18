//! The methods for a rigid body alone, on one or several flights of a vehicle.

use super::error::EstimateError;
use super::guessed_curve::{GuessedCurve, MovedByCurve, moved_by_curve};
use super::method::Method;
use super::nominal::Nominal;
use super::paper_runs::PaperRuns;
use super::plausible::FlightApart;
use super::recommend::Recommendation;
use super::recursive::History;
use super::result::{Estimated, MethodResult};

use super::weak::{Latency, WeakEstimate, solve_weak};
use super::weak_flights::WeakFlights;
use crate::note::{About, Note};
use crate::physics::ActuationLatency;
use crate::regression::ZeroPhase;
use crate::signals::{
    Butterworth, Signals, ThrustSource, TorqueError, WEAK_HALF_WIDTH_S, WindowedFir, highest_harmonic_hz,
};
use crate::vehicle::Vehicle;

/// Settings of the identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdentifySettings {
    /// s, half width of the weak form's kernel
    pub weak_half_width_s: f64,
    /// cut-off of the zero-phase low-pass, Hz; `None`: from the trajectory's highest harmonic
    pub cutoff_hz: Option<f64>,
    /// the paper's windowed FIR in place of the Butterworth
    pub fir: bool,
    /// adaptation gain of gradient descent
    pub sigma: f64,
}

impl Default for IdentifySettings {
    fn default() -> Self {
        Self { weak_half_width_s: WEAK_HALF_WIDTH_S, cutoff_hz: None, fir: false, sigma: super::PAPER_SIGMA }
    }
}

/// Result of the identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// one result for each method that could be applied
    pub methods: Vec<MethodResult>,
    /// the recommended method: of those for a rigid body alone, the weak form
    pub best: Recommendation,
    /// estimates over time of the paper's four methods
    pub histories: Vec<(Method, History)>,
    /// latency from command to body
    pub latency: Option<Latency>,
    /// s, latency that was corrected in the commands before the methods were applied
    pub compensated: ActuationLatency,
    /// cut-off of the zero-phase low-pass, Hz
    pub cutoff_hz: f64,
    /// the trajectory's highest harmonic, Hz, where it could be found
    pub highest_harmonic_hz: Option<f64>,
    /// cond(W) of the standard regressor as flown
    pub condition_number: Option<f64>,
    /// the same with columns scaled to unit length
    pub scaled_condition_number: f64,
    /// N m, constant torque about body x, y, z that remains with the rotors' nominal geometry
    pub trim_torque_nm: [f64; 3],
    /// residual standard deviation of the weak form: N, N m
    pub residual: Vec<f64>,
    /// equation of each entry of [`Self::residual`]
    pub residual_channels: Vec<&'static str>,
    /// share of each of these equations' variance that the rigid body explains (-)
    pub explained: Vec<f64>,
    /// m/s^2, vertical specific force of the accelerometer minus that of the kinematics, for each flight
    pub accelerometer_bias: Vec<Option<f64>>,
    /// flights whose rigid body alone contradicts that of the first one
    pub apart: Vec<FlightApart>,
    /// reasons for missing methods, and other remarks
    pub notes: Vec<Note>,
}

/// Identifies the rigid body from conditioned flights of one vehicle.
///
/// ```
/// # use mavid::config::load_vehicle;
/// # use mavid::log::{self, OpenOptions};
/// # use mavid::signals::{ConditionSettings, condition};
/// use mavid::estimate::{IdentifySettings, identify};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
/// # let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default())?;
/// # let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml"))?;
/// let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;
/// let identification = identify(&[signals], &vehicle, &IdentifySettings::default())?;
/// for parameter in &identification.best.result.parameters {
///     println!("{}: {:?} {}", parameter.name, parameter.finding, parameter.unit);
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`EstimateError`] where no method can run.
pub fn identify(
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &IdentifySettings,
) -> Result<Identification, EstimateError> {
    let _stage = tracing::info_span!("identify", flights = flights.len()).entered();
    let nominal = Nominal::of(vehicle);
    let mut notes = Vec::new();
    let mut weak = WeakFlights::from(flights, vehicle, settings.weak_half_width_s);
    let (found, compensated) = weak.compensate(&nominal.theta, vehicle);
    let plain = solve_weak(&weak.rows, &nominal.theta).ok_or(EstimateError::NoRows)?;

    let harmonic_hz = highest_of_all_hz(&weak.signals);
    let (paper, cutoff_hz) = paper_runs(&weak.signals, vehicle, settings, harmonic_hz)?;
    notes.extend(paper.is_empty().then(|| Note::remark(About::Estimate, NO_PAPER)));

    let wider = weak.by_wider_window(&plain, &nominal.theta, settings.weak_half_width_s);
    let by_curve = moved_by_curve(flights, vehicle, compensated, &nominal.theta);
    let torque_error = TorqueError::of_all(flights.iter().map(|flight| flight.quality.torque_error));
    let whole = |weak: &WeakEstimate| {
        let moved = by_curve.map(|by| by.on(&weak.theta));
        Estimated::of(weak).with_torque_error(torque_error).with_wider_window(wider).with_guessed_curve(moved)
    };
    let mut methods = paper.results(&whole(&plain));
    let best = Recommendation::weak(whole(&plain), &nominal);
    methods.push(MethodResult::new(Method::Weak, &whole(&plain), &nominal));
    let apart = weak.flights_apart(&nominal.theta, settings.weak_half_width_s);
    let by_commands = |signals: &Signals| signals.quality.thrust_source == ThrustSource::Command;
    notes.extend(flights.iter().any(by_commands).then(|| Note::remark(About::Actuators, BY_COMMANDS)));
    Ok(Identification {
        best,
        methods,
        condition_number: paper.condition_number(),
        histories: paper.histories(),
        latency: found,
        compensated,
        cutoff_hz,
        highest_harmonic_hz: harmonic_hz,
        scaled_condition_number: plain.solution.scaled_condition,
        trim_torque_nm: plain.trim_torque_nm,
        residual: plain.solution.sigma.clone(),
        residual_channels: plain.channels.clone(),
        explained: plain.explained.clone(),
        accelerometer_bias: weak.accelerometer_bias,
        apart,
        notes,
    })
}

/// The highest harmonic of the flights' commanded trajectories, Hz; `None` if none is known.
fn highest_of_all_hz(flights: &[Signals]) -> Option<f64> {
    flights.iter().filter_map(highest_harmonic_hz).reduce(f64::max)
}

/// The paper's own methods behind a low-pass, and its cut-off, Hz.
fn paper_runs(
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &IdentifySettings,
    harmonic_hz: Option<f64>,
) -> Result<(PaperRuns, f64), EstimateError> {
    let rate_hz = flights.first().map_or(f64::NAN, |s| 1.0 / s.grid.step_s);
    let cutoff_hz = settings.cutoff_hz.unwrap_or_else(|| default_cutoff_hz(harmonic_hz, rate_hz));
    let filter = zero_phase(settings, cutoff_hz, rate_hz)?;
    Ok((PaperRuns::from(flights, vehicle, &filter, settings.sigma), cutoff_hz))
}

/// Ixx, Iyy, Izz of the rigid body by a window of twice the width, as shares of those by the usual one; NaN where either has
/// none. Far from 1 where control answers the motion that something else causes.
#[must_use]
pub fn inertia_by_wider_window(flights: &[Signals], vehicle: &Vehicle) -> [f64; 3] {
    let nominal = Nominal::of(vehicle);
    let mut weak = WeakFlights::from(flights, vehicle, WEAK_HALF_WIDTH_S);
    weak.compensate(&nominal.theta, vehicle);
    let narrow = solve_weak(&weak.rows, &nominal.theta);
    narrow.map_or([f64::NAN; 3], |narrow| weak.by_wider_window(&narrow, &nominal.theta, WEAK_HALF_WIDTH_S))
}

/// Flights whose masses or moments of inertia contradict those of the first one, each by the rigid body of its flight alone.
#[must_use]
pub fn contradicting_flights(flights: &[Signals], vehicle: &Vehicle) -> Vec<FlightApart> {
    if flights.len() < 2 {
        return Vec::new();
    }
    let nominal = Nominal::of(vehicle);
    let mut weak = WeakFlights::from(flights, vehicle, WEAK_HALF_WIDTH_S);
    weak.compensate(&nominal.theta, vehicle);
    weak.flights_apart(&nominal.theta, WEAK_HALF_WIDTH_S)
}

/// How far mass and inertia move with one standard error of a guessed thrust curve; `None` where it is no guess, or nothing can
/// be estimated.
#[must_use]
pub fn moved_by_guessed_curve(flights: &[Signals], vehicle: &Vehicle) -> Option<MovedByCurve> {
    GuessedCurve::of(vehicle)?;
    let nominal = Nominal::of(vehicle);
    let mut weak = WeakFlights::from(flights, vehicle, WEAK_HALF_WIDTH_S);
    let (_, latency) = weak.compensate(&nominal.theta, vehicle);
    moved_by_curve(flights, vehicle, latency, &nominal.theta)
}

/// Where the paper's methods have nothing to run on.
const NO_PAPER: &str =
    "LS, GD, FMLS and FMGD need body rates and the vertical motion; this recording lacks one";

/// Error that the standard errors do not include if thrust is computed from commands.
const BY_COMMANDS: &str = "thrust from commands: the standard errors do not include the commands between two samples, \
                           so mass and moments are uncertain by some tenths of a percent more; measured rotor speeds \
                           (ESC_STATUS) do not have this";

/// Default cut-off, Hz: ten times the highest harmonic, as in the paper (30 rad/s for 180 deg/s); 5 Hz if the
/// trajectory is not known; at most a fifth of the sample rate.
fn default_cutoff_hz(harmonic_hz: Option<f64>, rate_hz: f64) -> f64 {
    harmonic_hz.map_or(5.0, |f| (10.0 * f).clamp(2.0, 10.0)).min(0.2 * rate_hz)
}

fn zero_phase(settings: &IdentifySettings, cutoff_hz: f64, rate_hz: f64) -> Result<ZeroPhase, EstimateError> {
    let filter = if settings.fir {
        WindowedFir::new(WindowedFir::PAPER_LENGTH, cutoff_hz, rate_hz).map(ZeroPhase::Fir)
    } else {
        Butterworth::new(cutoff_hz, rate_hz).map(ZeroPhase::Butterworth)
    };
    filter.ok_or(EstimateError::Cutoff { cutoff_hz, rate_hz })
}
