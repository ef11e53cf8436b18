//! A flight in cells of time: what the sensors and the rotors did in each.

use nalgebra::{UnitQuaternion, Vector3};

use super::error::ReconstructionError;
use super::place::{Place, STEP_S, cell_of};
use super::receiver::Received;
use super::thrusts::CellThrusts;
use crate::recording::{Quantity, Stream};
use crate::signals::{Grid, Signals, white_level};
use crate::vehicle::Vehicle;

/// Forgetting of the error of the autopilot's velocity, 1/s. It is the time of 2 s in which an estimator follows its receiver; of 1 s where the
/// position has told what is slower. The learned noise level takes up an error of this.
const FORGET_1_S: (f64, f64) = (0.5, 1.0);
/// Height over the place of take-off at which a vehicle is in the air, m: on the ground it is carried, and the fit would explain
/// that by drag.
const AIRBORNE_M: f64 = 1.0;
/// The same for flights that stay lower: share of the greatest height. Below it the ground is near, whose effect on
/// rotors is no part of this model.
const AIRBORNE_SHARE: f64 = 0.5;
/// Left out at both ends of the part in the air, s: it still rises, or is about to land. Longer would waste flight,
/// shorter would take the jerk of lift-off for a force.
const RISING_S: f64 = 0.5;
/// Time before a span in which the vehicle stood where it took off, s: a climb to the height of a flight takes 5 to 15. Longer would reach an
/// earlier landing.
const CLIMB_S: f64 = 20.0;
/// Fewer cells than this teach nothing. They are 8 s; the noise levels of nine sensors would rest on too little.
const LEAST_CELLS: usize = 200;
/// Accelerometers read no less than this, m/s^2: the resolution of the messages. MAVLink's RAW_IMU counts in milli-g,
/// 0.0098 m/s^2, whose rounding has a standard deviation of 0.0028.
const LEAST_NOISE_M_S2: f64 = 0.003;

/// An accelerometer with less noise than this, m/s^2 a sample, is that of a simulator, or very well mounted: the estimate that
/// rests on it is as good.
pub(super) const QUIET_M_S2: f64 = 0.1;

/// A flight in cells of [`STEP_S`], body FLU and world NWU.
#[derive(Debug)]
pub struct Cells {
    /// s, beginnings of the cells and the last end
    pub time_s: Vec<f64>,
    /// the autopilot's attitude in the middle of each cell
    pub attitude: Vec<UnitQuaternion<f64>>,
    /// body rates in the middle of each cell, rad/s
    pub rate_rad_s: Vec<Vector3<f64>>,
    /// position in the middle of each cell, m; zero where it was not recorded
    pub position_m: Vec<Vector3<f64>>,
    /// V, where it was recorded
    pub battery_voltage_v: Option<Vec<f64>>,
    /// cells in which the commands are known and the rotors can follow them
    pub driven: Vec<bool>,
    /// mean of the accelerometer's samples and how many they are, m/s^2; none where there are none
    pub specific_force_m_s2: Vec<Option<(Vector3<f64>, f64)>>,
    /// white noise of one sample of the accelerometer, m/s^2
    pub accelerometer_noise_m_s2: Vector3<f64>,
    /// the autopilot's velocity where it is sampled: cell, place in it 0..1, m/s
    pub velocity_m_s: Vec<(usize, f64, Vector3<f64>)>,
    /// velocity at the cells' borders, m/s, where a fit begins
    pub borders_m_s: Vec<Vector3<f64>>,
    /// forgetting of the error of the autopilot's velocity, 1/s
    pub forgetting_1_s: f64,
    /// what a satellite receiver said of the velocity
    pub receiver: Received,
    /// of the rotors
    pub thrusts: CellThrusts,
}

impl Cells {
    /// The airborne part of a flight, of a vehicle whose rotors slow down as `uneven` says
    /// ([`crate::physics::ActuationLatency::uneven`]).
    ///
    /// # Errors
    /// [`ReconstructionError`] where a stream is missing, or the flight is too short.
    pub fn of(signals: &Signals, vehicle: &Vehicle, uneven: f64) -> Result<Self, ReconstructionError> {
        let missing = ReconstructionError::Missing;
        let attitude = signals.attitude.as_ref().ok_or(missing(Quantity::Attitude))?;
        let rate = signals.rate.as_ref().ok_or(missing(Quantity::AngularRate))?;
        let on_grid = signals.velocity.as_ref().ok_or(missing(Quantity::Velocity))?;
        let raw = &signals.as_recorded;
        let force = raw.specific_force.as_deref().ok_or(missing(Quantity::SpecificForce))?;
        let velocity = raw.velocity.as_deref().ok_or(missing(Quantity::Velocity))?;
        if signals.rotor_thrust_n.is_empty() {
            return Err(missing(Quantity::ActuatorCommand));
        }
        let (from_s, to_s) = airborne(signals).ok_or(ReconstructionError::TooShort)?;
        let from_s = centred(force, from_s, to_s);
        let count = (0..).take_while(|cell| from_s + f64::from(*cell + 1) * STEP_S < to_s).count();
        if count < LEAST_CELLS {
            return Err(ReconstructionError::TooShort);
        }
        let time_s: Vec<f64> = (0..=count).map(|cell| from_s + cell as f64 * STEP_S).collect();
        let middles: Vec<f64> = time_s.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        let places: Vec<Place> = middles.iter().map(|t| Place::of(&signals.grid, *t)).collect();
        let vectors = |of: &[Vector3<f64>]| places.iter().map(|place| place.between(of)).collect::<Vec<_>>();
        let white = white_level(force);
        let noise = |axis: usize, _| white.get(axis).copied().unwrap_or(0.1).max(LEAST_NOISE_M_S2);
        let accelerometer_noise_m_s2 = Vector3::from_fn(noise);
        let is_held = signals.quality.velocity_held_by.position;
        let voltage = |of: &Vec<f64>| places.iter().map(|place| place.between(of)).collect();
        Ok(Self {
            attitude: places.iter().map(|place| place.turned(attitude)).collect(),
            rate_rad_s: vectors(rate),
            position_m: signals
                .position
                .as_ref()
                .map_or_else(|| vec![Vector3::zeros(); count], |p| vectors(p)),
            battery_voltage_v: signals.battery_voltage_v.as_ref().map(|series| voltage(series)),
            driven: driven(signals, &time_s),
            specific_force_m_s2: force_by_cell(force, &time_s),
            accelerometer_noise_m_s2,
            velocity_m_s: velocity_by_cell(velocity, &time_s),
            forgetting_1_s: if is_held { FORGET_1_S.1 } else { FORGET_1_S.0 },
            receiver: raw.gps_velocity.as_deref().map_or_else(Received::default, |stream| {
                Received::of(stream, (&signals.grid, on_grid), &time_s)
            }),
            borders_m_s: time_s.iter().map(|t| Place::of(&signals.grid, *t).between(on_grid)).collect(),
            thrusts: CellThrusts::of((signals, vehicle, uneven), from_s, count),
            time_s,
        })
    }

    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        self.attitude.len()
    }
}

/// Mean of the finite samples in each cell, m/s^2, and their number.
fn force_by_cell(force: &Stream, time_s: &[f64]) -> Vec<Option<(Vector3<f64>, f64)>> {
    let mut sums = vec![(Vector3::zeros(), 0.0); time_s.len() - 1];
    for index in 0..force.len() {
        let sample = Vector3::from_row_slice(force.sample(index));
        let cell = cell_of(time_s, force.time_s[index]);
        if let Some(cell) = cell.filter(|_| sample.iter().all(|v| v.is_finite())) {
            sums[cell].0 += sample;
            sums[cell].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, n)| (n > 0.0).then(|| (sum / n, n))).collect()
}

/// The first finite velocity in each cell (m/s) with its cell and its place there, 0 to 1: what comes more often is the same
/// integration.
fn velocity_by_cell(velocity: &Stream, time_s: &[f64]) -> Vec<(usize, f64, Vector3<f64>)> {
    let sampled = |index: usize| {
        let t = velocity.time_s[index];
        let cell = cell_of(time_s, t)?;
        let sample = Vector3::from_row_slice(velocity.sample(index));
        sample.iter().all(|v| v.is_finite()).then(|| (cell, (t - time_s[cell]) / STEP_S, sample))
    };
    let mut out: Vec<_> = (0..velocity.len()).filter_map(sampled).collect();
    out.dedup_by_key(|(cell, ..)| *cell);
    out
}

/// First and last time in the air, s.
fn airborne(signals: &Signals) -> Option<(f64, f64)> {
    let grid = &signals.grid;
    let end_s = grid.time_s(grid.count.checked_sub(1)?);
    let mut in_air = vec![false; grid.count];
    for &(from_s, to_s) in &signals.quality.airborne_s {
        // a log that begins or ends in the air has no ground there to keep away from
        let (begins, ends) = (from_s <= grid.start_s + 0.1, to_s >= end_s - 0.1);
        let flown =
            if begins { from_s } else { from_s + RISING_S }..=if ends { to_s } else { to_s - RISING_S };
        let least_m = if begins { None } else { lifted_m(signals, (from_s, to_s)) };
        for (index, in_air) in in_air.iter_mut().enumerate() {
            let height = signals.position.as_ref().map(|all| all[index].z);
            let lifted = height.zip(least_m).is_none_or(|(height, least)| height > least);
            *in_air |= flown.contains(&grid.time_s(index)) && lifted;
        }
    }
    // the longest stretch: on the ground between two nothing is known
    let longest = Grid::runs(&in_air, 1).into_iter().max_by_key(ExactSizeIterator::len)?;
    Some((grid.time_s(longest.start), grid.time_s(longest.end.checked_sub(1)?)))
}

/// Height from which on a vehicle that took off before or at the beginning of a span is off the ground, m.
fn lifted_m(signals: &Signals, (from_s, to_s): (f64, f64)) -> Option<f64> {
    let position = signals.position.as_ref()?;
    let (first, last) = (Place::of(&signals.grid, from_s).before(), Place::of(&signals.grid, to_s).after());
    // where the autopilot's words begin the span, the vehicle may be at its height already
    let climb = Place::of(&signals.grid, from_s - CLIMB_S).before();
    let before_m = position[climb.min(first)..first].iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let ground_m = position[first].z.min(before_m);
    let most_m = position[first..=last].iter().map(|p| p.z - ground_m).fold(0.0, f64::max);
    Some(ground_m + AIRBORNE_M.min(AIRBORNE_SHARE * most_m))
}

/// Between the first and the last usable instant the mask leaves out what is saturated, or not recorded; before and after it
/// leaves out what is not exciting, which teaches biases.
fn driven(signals: &Signals, time_s: &[f64]) -> Vec<bool> {
    let grid = &signals.grid;
    let first = signals.usable.iter().position(|used| *used).unwrap_or(0);
    let last = signals.usable.iter().rposition(|used| *used).unwrap_or(0);
    let is_known = |ends: &[f64]| {
        let (from, to) = (Place::of(grid, ends[0]).before(), Place::of(grid, ends[1]).after());
        (from..=to).all(|index| signals.usable[index] || index < first || index > last)
    };
    time_s.windows(2).map(is_known).collect()
}

/// A beginning at which cells are centred on the samples of a stream that is slower than they are short: otherwise its
/// means would be early or late.
fn centred(stream: &Stream, from_s: f64, to_s: f64) -> f64 {
    let inside: Vec<f64> = stream.time_s.iter().copied().filter(|t| (from_s..to_s).contains(t)).collect();
    if inside.is_empty() {
        return from_s;
    }
    let phases = inside.iter().map(|t| (t - from_s).rem_euclid(STEP_S));
    let period_s = (to_s - from_s) / inside.len() as f64;
    if period_s < 0.6 * STEP_S {
        return from_s + phases.sum::<f64>() / inside.len() as f64 - STEP_S / 2.0;
    }
    let (sine, cosine) = phases.fold((0.0, 0.0), |(sine, cosine), phase| {
        let angle = std::f64::consts::TAU * phase / STEP_S;
        (sine + angle.sin(), cosine + angle.cos())
    });
    from_s + sine.atan2(cosine) / std::f64::consts::TAU * STEP_S + STEP_S / 2.0
}
