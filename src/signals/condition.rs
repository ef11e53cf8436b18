//! Conditioning of one flight: streams are chosen, aligned, interpolated to one grid, and masked.

use super::actuation::{Actuation, ThrustPreference};
use super::align::{AlignFrame, vectors_onto};
use super::changed::{changes_in_the_air, resting_on_defaults};
use super::chosen::Chosen;
use super::flight::{Quality, Series, Signals};
use super::height::{VelocityHeldBy, is_height_by_pose, is_position_by_receiver};
use super::lifts::too_little;
use super::motion::Motion;
use super::noise::gyro_noise_rad_s;
use super::own::OwnOfFlight;
use super::reference::reference;
use super::rotor_thrusts::ThrustSource;
use super::select::{mean_rate_hz, median_period_s, too_short};
use super::slow_velocity::Estimated;
use super::sufficient::{LEAST_ACTUATOR_HZ, LEAST_BODY_RATE_HZ, Needed};
use super::torque_error::{TorqueError, alternating};
use super::usable::{Evidence, Usable, airborne_spans, usable};
use super::voltage::{battery_voltage_v, steady_voltage_v};
use super::{Grid, SignalsError, WeakKernel, plausible, sufficient};
use crate::autopilot::is_simulated;
use crate::note::Note;
use crate::recording::{Quantity, Recording, Stream};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::sync::Arc;

/// Half width of the weak form's test function, s: over less a mean force is noise, over more it loses motion of over 2 Hz.
pub const WEAK_HALF_WIDTH_S: f64 = 0.2;

/// Least and largest step of the grid, s.
const STEP_S: (f64, f64) = (0.002, 0.02);
/// Least step of the grid for effects, s: it samples motion of 5 Hz, which the weak form still passes, twenty times a period.
pub const STEP_FOR_EFFECTS_S: f64 = 0.01;

/// Settings of the conditioning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConditionSettings {
    /// s between grid instants; `None`: the period of the fastest inertial stream, 2 to 20 ms
    pub step_s: Option<f64>,
    /// least step where none is given, s: streams that are faster are averaged over a step
    pub least_step_s: f64,
    /// time left out at the beginning of the flight, s; `None`: 10 s as in the paper, at most a fifth of the flight
    pub transient_s: Option<f64>,
    /// s, half width of the weak form's kernel
    pub weak_half_width_s: f64,
    /// source of the thrusts if the log has both
    pub thrust: ThrustPreference,
    /// the inertial unit may be misaligned in the body: offsets between streams are estimated together with its angles
    pub askew: bool,
}

impl Default for ConditionSettings {
    fn default() -> Self {
        Self {
            step_s: None,
            least_step_s: STEP_S.0,
            transient_s: None,
            weak_half_width_s: WEAK_HALF_WIDTH_S,
            thrust: ThrustPreference::Measured,
            askew: false,
        }
    }
}

/// Conditions one flight: chooses streams, aligns them in time, puts them on one grid, and takes the slow error that its
/// position tells out of the velocity. Nothing else is smoothed.
///
/// ```
/// use mavid::config::load_vehicle;
/// use mavid::log::{self, OpenOptions};
/// use mavid::signals::{ConditionSettings, condition};
/// use std::path::Path;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
/// let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default())?;
/// let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml"))?;
/// let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;
/// // each stream with its offset in time
/// for (quantity, offset) in &signals.quality.offsets {
///     println!("{}: {offset:?}", quantity.name());
/// }
/// assert!(signals.grid.step_s > 0.0);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`SignalsError`] where the log has no actuators in the vehicle's unit, no streams of motion, hardly a sample of
/// them, or no stretch of flight long enough for the weak form.
pub fn condition(
    recording: &Recording,
    vehicle: &Vehicle,
    settings: &ConditionSettings,
) -> Result<Signals, SignalsError> {
    let _stage = tracing::info_span!("condition").entered();
    let chosen = Chosen::from(recording);
    let actuation = Actuation::from(recording, vehicle, settings.thrust)?;
    let step_s = step(recording, &chosen, actuation.stream(), settings)?;
    let grid = common_grid(&chosen, actuation.stream(), step_s)?;
    let kernel = WeakKernel::new(settings.weak_half_width_s, step_s);
    let airborne_s = airborne_spans(recording, &actuation, vehicle);
    too_little(recording, &actuation, vehicle).filter(|_| airborne_s.is_empty()).map_or(Ok(()), Err)?;
    let sufficiency =
        sufficient::check(&needed(&chosen, &actuation), &airborne_s, sufficient::logging_of(recording))?;
    if grid.count >= Grid::LONGEST {
        return Err(SignalsError::TooLong { span_s: step_s * grid.count as f64 });
    }
    let rate = chosen.rate.and_then(|(_, s)| vectors_onto(s, 0.0, &grid));
    let (mask, used) =
        mask(recording, (&chosen, &actuation), (&grid, rate.as_deref()), &airborne_s, settings.transient_s);
    let centers = enough_centers(&kernel, (&mask, &used), step_s, settings)?;
    let frame = AlignFrame { askew: settings.askew, grid: &grid, kernel: &kernel, centers: &centers };
    let motion = Motion::aligned(&chosen, rate, &frame, vehicle.gravity_m_s2);
    let felt = actuation.onto(&grid, vehicle);
    let notes = notes((recording, vehicle), (&actuation, sufficiency.note), &airborne_s);
    let mut signals = Signals {
        grid,
        usable: mask,
        attitude: motion.attitude.map(Series::new),
        rate: motion.rate.map(Series::new),
        specific_force: motion.specific_force.map(Series::new),
        world_acceleration: motion.world_acceleration.map(Series::new),
        position: motion.position.map(Series::new),
        velocity: motion.velocity.map(Series::new),
        rotor_thrust_n: felt.rotor_thrust_n.into(),
        full_thrust_n: vehicle.propulsion.full_thrust_n(),
        wrench: felt.wrench.into(),
        jitter_wrench: felt.jitter_wrench.map(Series::new),
        battery_voltage_v: battery_voltage_v(recording, &grid).map(Series::new),
        as_recorded: chosen.as_recorded(),
        reference: reference(recording, &grid),
        own: OwnOfFlight::default(),
        air_m_s: Vector3::zeros(),
        quality: Quality {
            sources: sources(&chosen, &actuation),
            thrust_source: actuation.source(),
            offsets: motion.offsets,
            gyro_noise_rad_s: chosen.rate.and_then(|(_, stream)| gyro_noise_rad_s(stream, &airborne_s)),
            airborne_s,
            usable: used,
            torques: sufficiency.torques,
            torque_error: TorqueError::default(),
            velocity_held_by: VelocityHeldBy { pose: is_height_by_pose(recording), position: false },
            position_by_receiver: is_position_by_receiver(recording),
            steady_voltage_v: steady_voltage_v(recording),
            simulated: is_simulated(|name| recording.parameters.get(name).copied()),
            notes,
        },
    };
    signals.quality.torque_error = torque_error(&actuation, vehicle, &signals);
    let doubts = plausible::check(&signals, vehicle);
    if plausible::position_agrees(&signals) {
        take_slow_error_out(&mut signals, &chosen, &resets_s(recording));
    }
    signals.quality.notes.extend(doubts);
    signals.emit();
    Ok(signals)
}

/// Centres of the weak form's rows, if there are enough for any estimate.
fn enough_centers(
    kernel: &WeakKernel,
    (mask, used): (&[bool], &Usable),
    step_s: f64,
    settings: &ConditionSettings,
) -> Result<Vec<usize>, SignalsError> {
    let centers = kernel.centers(mask, stride(step_s));
    if centers.len() < 40 {
        return Err(used.refusal(2.0 + 2.0 * settings.weak_half_width_s, settings.transient_s));
    }
    Ok(centers)
}

/// The instants that may be used, and the time that each rule left out. `rate`: body rates on the grid, rad/s.
fn mask(
    recording: &Recording,
    (chosen, actuation): (&Chosen<'_>, &Actuation),
    (grid, rate): (&Grid, Option<&[Vector3<f64>]>),
    airborne_s: &[(f64, f64)],
    transient_s: Option<f64>,
) -> (Vec<bool>, Usable) {
    let streams: Vec<&Stream> =
        chosen.list().iter().filter_map(|(_, s)| s.map(|(_, s)| s)).chain([actuation.stream()]).collect();
    let resets_s = resets_s(recording);
    let command = actuation.command();
    let is_damaged = recording.is_damaged;
    let evidence = Evidence { streams: &streams, airborne_s, resets_s: &resets_s, command, rate, is_damaged };
    usable(grid, &evidence, transient_s)
}

/// Instants at which the vehicle's clock restarted or its estimator jumped, in order, s.
fn resets_s(recording: &Recording) -> Vec<f64> {
    let mut all = [recording.clock_resets_s.as_slice(), &recording.estimator_resets_s].concat();
    all.sort_by(f64::total_cmp);
    all
}

/// Takes the slow error that the position tells out of the velocity, on the grid and at its own instants.
fn take_slow_error_out(signals: &mut Signals, chosen: &Chosen<'_>, resets_s: &[f64]) {
    let Some(((_, velocity), position)) = chosen.velocity.zip(chosen.position_of_velocity) else { return };
    let estimated = Estimated { position, velocity, resets_s, airborne_s: &signals.quality.airborne_s };
    let receiver = chosen.gps_velocity.map(|(_, stream)| stream);
    let Some((velocity, is_up)) = estimated.without_slow_error(receiver) else { return };
    let offset = signals.quality.offsets.iter().find(|(quantity, _)| *quantity == Quantity::Velocity);
    let late_s = offset.filter(|(_, offset)| offset.repaired).map_or(0.0, |(_, offset)| offset.late_s);
    let Some(on_grid) = vectors_onto(&velocity, late_s, &signals.grid) else { return };
    signals.velocity = Some(Series::new(on_grid));
    signals.as_recorded.velocity = Some(Arc::new(velocity));
    signals.quality.velocity_held_by.position = is_up;
}

/// Quantity, message and samples a second of what is used.
fn sources(chosen: &Chosen<'_>, actuation: &Actuation) -> Vec<(Quantity, &'static str, f64)> {
    let motion = chosen.list().into_iter().filter_map(|(quantity, s)| s.map(|(name, s)| (quantity, name, s)));
    motion
        .chain([(actuation.quantity(), actuation.message(), actuation.stream())])
        .map(|(quantity, name, stream)| (quantity, name, mean_rate_hz(stream)))
        .collect()
}

/// What is to be said of the streams' rates, of the actuators, and of parameters that changed in the air.
fn notes(
    (recording, vehicle): (&Recording, &Vehicle),
    (actuation, of_rates): (&Actuation, Option<Note>),
    airborne_s: &[(f64, f64)],
) -> Vec<Note> {
    let (autopilot, parameters) = (recording.autopilot, &recording.parameters);
    let changed = changes_in_the_air(autopilot, &recording.parameter_changes, airborne_s, parameters);
    let defaults = resting_on_defaults(autopilot, &recording.defaulted, parameters);
    let said = of_rates.into_iter().chain(actuation.notes(recording, vehicle));
    said.chain(changed).chain(defaults).collect()
}

/// What the torques of the signals have in common as an error.
fn torque_error(actuation: &Actuation, vehicle: &Vehicle, signals: &Signals) -> TorqueError {
    let thrusts = (actuation.stream(), actuation.source());
    let rate = signals.rate.as_ref().map(|rate| &rate[..]);
    let alternating = alternating(thrusts, vehicle, (&signals.grid, &signals.usable), rate);
    tracing::debug!(?alternating, "torques from one command to the next");
    TorqueError { rebuilt: actuation.torque_std(), alternating }
}

/// Samples between the weak form's centres: 0.05 s.
#[must_use]
pub fn stride(step_s: f64) -> usize {
    let mut stride = 1;
    while (stride as f64 + 0.5) * step_s < 0.05 {
        stride += 1;
    }
    stride
}

fn step(
    recording: &Recording,
    chosen: &Chosen<'_>,
    actuation: &Stream,
    settings: &ConditionSettings,
) -> Result<f64, SignalsError> {
    if let Some(step_s) = settings.step_s {
        return Ok(step_s);
    }
    let inertial = chosen.rate.or(chosen.attitude).or(chosen.world_acceleration);
    let (_, stream) = inertial.ok_or_else(|| no_motion(recording))?;
    let period = median_period_s(stream).min(median_period_s(actuation));
    if !period.is_finite() {
        return Err(SignalsError::NoMotion);
    }
    Ok(period.clamp(settings.least_step_s.min(STEP_S.1), STEP_S.1))
}

/// The error if no stream of motion can be used.
fn no_motion(recording: &Recording) -> SignalsError {
    [(Quantity::AngularRate, 3), (Quantity::Attitude, 4), (Quantity::WorldAcceleration, 3)]
        .into_iter()
        .find_map(|(quantity, width)| too_short(recording, quantity, |_, stream| stream.width == width))
        .unwrap_or(SignalsError::NoMotion)
}

/// The streams that are needed for the rotation of the body: its motion and its actuation.
fn needed<'a>(chosen: &Chosen<'a>, actuation: &'a Actuation) -> Vec<Needed<'a>> {
    let body = [("body rates", chosen.rate), ("attitude", chosen.attitude)];
    let body = body.into_iter().find_map(|(what, stream)| Some((what, stream?)));
    let body = body.map(|(what, (message, stream))| (what, message, stream, LEAST_BODY_RATE_HZ));
    let what = match actuation.source() {
        ThrustSource::MeasuredSpeed => "rotor speeds",
        ThrustSource::Command => "actuator outputs",
        ThrustSource::Wrench => "force and torque",
    };
    let driven = (what, actuation.message(), actuation.stream(), LEAST_ACTUATOR_HZ);
    body.into_iter().chain([driven]).collect()
}

/// The grid over the common span of all chosen streams.
fn common_grid(chosen: &Chosen<'_>, actuation: &Stream, step_s: f64) -> Result<Grid, SignalsError> {
    let (mut start, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
    let streams = chosen.list();
    let motion = streams.iter().filter_map(|(_, s)| s.map(|(_, s)| s));
    for stream in motion.chain([actuation]) {
        if let (Some(first), Some(last)) = (stream.time_s.first(), stream.time_s.last()) {
            start = start.max(*first);
            end = end.min(*last);
        }
    }
    if end - start < 1.0 {
        return Err(SignalsError::NoOverlap { overlap_s: (end - start).max(0.0) });
    }
    Ok(Grid::covering(start, end, step_s))
}
