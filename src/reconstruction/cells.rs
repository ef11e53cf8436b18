//! A flight in cells of time: what the sensors and the rotors did in each.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::physics::{ActuationLatency, Airframe, MAX_ROTORS, delayed_thrusts_n};
use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{best, thrusts_from_commands, white_level};
use crate::vehicle::Vehicle;

use super::error::ReconstructionError;

/// Length of a cell, s.
pub const STEP_S: f64 = 0.04;
/// Grid on which commands are held and lagged, s.
const FINE_S: f64 = 0.004;
/// Fine instants over which a cell is averaged.
const PER_CELL: usize = 10;
/// Lags of the rotors for which thrusts are held, s apart, and how many.
const LAG_STEP_S: f64 = 0.01;
/// See [`LAG_STEP_S`].
const LAGS: usize = 21;
/// Latenesses of the commands about which thrusts are held, s.
pub const LATENESS_S: f64 = 0.004;
/// Height over where it stood at which a vehicle is in the air, m.
const AIRBORNE_M: f64 = 1.0;
/// Left out after that, s: it still rises.
const RISING_S: f64 = 0.5;
/// Fewer cells than this teach nothing.
const LEAST_CELLS: usize = 100;

/// A flight in cells of [`STEP_S`], body FLU and world NWU.
#[derive(Debug)]
pub struct Cells {
    /// s, beginnings of the cells and the last end
    pub time_s: Vec<f64>,
    /// the autopilot's attitude in the middle of each cell
    pub attitude: Vec<UnitQuaternion<f64>>,
    /// body rates in the middle of each cell, rad/s
    pub rate_rad_s: Vec<Vector3<f64>>,
    /// position in the middle of each cell, m
    pub position_m: Vec<Vector3<f64>>,
    /// mean of the accelerometer's samples and how many they are, m/s^2; none where there are none
    pub specific_force_m_s2: Vec<Option<(Vector3<f64>, f64)>>,
    /// white noise of one sample of the accelerometer, m/s^2
    pub accelerometer_noise_m_s2: Vector3<f64>,
    /// the autopilot's velocity where it is sampled: cell, place in it 0..1, m/s
    pub velocity_m_s: Vec<(usize, f64, Vector3<f64>)>,
    /// velocity at the cells' borders, m/s, where a fit begins
    pub borders_m_s: Vec<Vector3<f64>>,
    rotors: usize,
    /// thrust of each rotor, N: by cell, rotor, lag, lateness
    thrust_n: Vec<f64>,
}

impl Cells {
    /// The airborne part of a recording.
    ///
    /// # Errors
    /// [`ReconstructionError`] where a stream is missing, or the flight is too short.
    pub fn of(recording: &Recording, vehicle: &Vehicle) -> Result<Self, ReconstructionError> {
        let stream = |quantity, width| {
            best(recording, quantity, |stream: &Stream| stream.width == width)
                .map(|(_, stream)| stream)
                .ok_or(ReconstructionError::Missing(quantity))
        };
        let (attitude, rate) = (stream(Quantity::Attitude, 4)?, stream(Quantity::AngularRate, 3)?);
        let (force, position) = (stream(Quantity::SpecificForce, 3)?, stream(Quantity::Position, 3)?);
        let velocity = stream(Quantity::Velocity, 3)?;
        let thrusts = thrusts_from_commands(recording, vehicle)?;
        let (from_s, to_s) = airborne(position).ok_or(ReconstructionError::TooShort)?;
        let from_s = centred(force, from_s, to_s);
        let count = (0..).take_while(|cell| from_s + f64::from(*cell) * STEP_S < to_s - STEP_S).count();
        if count < LEAST_CELLS {
            return Err(ReconstructionError::TooShort);
        }
        let time_s: Vec<f64> = (0..=count).map(|cell| from_s + cell as f64 * STEP_S).collect();
        let middles: Vec<f64> = (0..count).map(|cell| from_s + (cell as f64 + 0.5) * STEP_S).collect();
        let vectors = |stream: &Stream, at: &[f64]| at.iter().map(|t| vector(stream, *t)).collect::<Vec<_>>();
        let cell_of = |t: f64| {
            let cell = ((t - from_s) / STEP_S).floor();
            (0..count).nth(if cell >= 0.0 { cell as usize } else { count })
        };
        let mut sums = vec![(Vector3::zeros(), 0.0); count];
        for index in 0..force.len() {
            let sample = Vector3::from_row_slice(force.sample(index));
            if let Some(cell) = cell_of(force.time_s[index]).filter(|_| sample.iter().all(|v| v.is_finite())) {
                sums[cell].0 += sample;
                sums[cell].1 += 1.0;
            }
        }
        let specific_force_m_s2 =
            sums.into_iter().map(|(sum, n): (Vector3<f64>, f64)| (n > 0.0).then(|| (sum / n, n))).collect();
        let sampled = |index: usize| {
            let t = velocity.time_s[index];
            let inside = t > from_s + 0.3 && t < time_s[count] - 0.3;
            let cell = cell_of(t).filter(|_| inside)?;
            Some((cell, (t - time_s[cell]) / STEP_S, Vector3::from_row_slice(velocity.sample(index))))
        };
        let mut velocity_m_s: Vec<_> = (0..velocity.len()).filter_map(sampled).collect();
        // one a cell: what comes more often is the same integration
        velocity_m_s.dedup_by_key(|(cell, ..)| *cell);
        let white = white_level(force);
        let accelerometer_noise_m_s2 =
            Vector3::from_fn(|axis, _| white.get(axis).copied().unwrap_or(0.1).max(0.003));
        let rotors = thrusts.stream.width;
        Ok(Self {
            attitude: middles.iter().map(|t| rotation(attitude, *t)).collect(),
            rate_rad_s: vectors(rate, &middles),
            position_m: vectors(position, &middles),
            specific_force_m_s2,
            accelerometer_noise_m_s2,
            velocity_m_s,
            borders_m_s: vectors(velocity, &time_s),
            thrust_n: thrust_table(&thrusts.stream, from_s, count),
            rotors,
            time_s,
        })
    }

    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        self.attitude.len()
    }

    /// None.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.attitude.is_empty()
    }

    /// Thrust of each rotor in a cell, N, behind a lag and a lateness of the commands, s.
    #[must_use]
    pub fn thrust_n(&self, cell: usize, lag_s: f64, late_s: f64) -> [f64; MAX_ROTORS] {
        let place = (lag_s / LAG_STEP_S).clamp(0.0, LAGS as f64 - 1.001);
        let (low, share) = (place.floor(), place.fract());
        let low = (0..LAGS).find(|lag| *lag as f64 >= low).unwrap_or(0);
        let slope = (late_s - LATENESS_S) / (2.0 * LATENESS_S);
        let mut thrust_n = [0.0; MAX_ROTORS];
        for (rotor, thrust) in thrust_n.iter_mut().enumerate().take(self.rotors) {
            let at = ((cell * self.rotors + rotor) * LAGS + low) * 3;
            let values: [f64; 3] = std::array::from_fn(|late| {
                (1.0 - share) * self.thrust_n[at + late] + share * self.thrust_n[at + 3 + late]
            });
            *thrust = values[1] + slope * (values[2] - values[0]);
        }
        thrust_n
    }
}

/// First and last time in the air, s.
fn airborne(position: &Stream) -> Option<(f64, f64)> {
    let height = |index: usize| position.sample(index)[2];
    let stood = 20.min(position.len());
    let ground_m = (0..stood).map(height).sum::<f64>() / stood as f64;
    let up = |index: &usize| height(*index) - ground_m > AIRBORNE_M;
    let first = (0..position.len()).find(up)?;
    let last = (0..position.len()).rev().find(up)?;
    Some((position.time_s[first] + RISING_S, position.time_s[last]))
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

/// Index before a time and share of the way to the next sample.
fn bracket(time_s: &[f64], t: f64) -> (usize, usize, f64) {
    let next = time_s.partition_point(|stamp| *stamp <= t).min(time_s.len() - 1);
    let before = next.saturating_sub(1);
    let span = time_s[next] - time_s[before];
    let share = if span > 0.0 { ((t - time_s[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
    (before, next, share)
}

fn vector(stream: &Stream, t: f64) -> Vector3<f64> {
    let (before, next, share) = bracket(&stream.time_s, t);
    let at = |index| Vector3::from_row_slice(stream.sample(index));
    at(before) * (1.0 - share) + at(next) * share
}

fn rotation(stream: &Stream, t: f64) -> UnitQuaternion<f64> {
    let (before, next, share) = bracket(&stream.time_s, t);
    let at = |index: usize| {
        let q = stream.sample(index);
        UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]))
    };
    at(before).nlerp(&at(next), share)
}

/// Thrusts behind each lag and about each lateness, averaged over cells.
fn thrust_table(thrusts: &Stream, from_s: f64, count: usize) -> Vec<f64> {
    let rotors = thrusts.width;
    let lead_s = 1.0;
    let fine = (count * PER_CELL) + 2 * PER_CELL * 25;
    let start_s = from_s - lead_s;
    let mut held = Vec::with_capacity(fine * rotors);
    for index in 0..fine {
        let t = start_s + (index as f64 + 0.5) * FINE_S;
        let (before, next, share) = bracket(&thrusts.time_s, t);
        let (a, b) = (thrusts.sample(before), thrusts.sample(next));
        held.extend((0..rotors).map(|rotor| (1.0 - share) * a[rotor] + share * b[rotor]));
    }
    let mut table = vec![0.0; count * rotors * LAGS * 3];
    for lag in 0..LAGS {
        let latency = ActuationLatency { delay_s: 0.0, lag_s: lag as f64 * LAG_STEP_S, uneven: 0.0 };
        let lagged = delayed_thrusts_n(&held, rotors, FINE_S, latency);
        for cell in 0..count {
            let first = 250 + cell * PER_CELL;
            for rotor in 0..rotors {
                let at = ((cell * rotors + rotor) * LAGS + lag) * 3;
                // latenesses of 0, 4 and 8 ms are whole steps of the fine grid
                for late in 0..3 {
                    let range = first - late..first - late + PER_CELL;
                    let sum: f64 = range.map(|index| lagged[index * rotors + rotor]).sum();
                    table[at + late] = sum / PER_CELL as f64;
                }
            }
        }
    }
    table
}

/// Gravity and the airframe of a vehicle, for the equations.
pub fn airframe(vehicle: &Vehicle) -> Result<Airframe, ReconstructionError> {
    Airframe::new(vehicle).map_err(|error| ReconstructionError::Vehicle(error.to_string()))
}
