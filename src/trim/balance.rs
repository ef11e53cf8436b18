//! The balance of each flight in still air, estimated over all flights at once.
//!
//! `lean = b + (h + e) felt + j turning + d rate`: `b` and `e` are a flight's own, the air's lever `h`, the inertia `j` and the damping `d`
//! the vehicle's. The air pushes at another height than the rotors do. So a vehicle that stands in the wind leans its thrust by as much
//! as a rotor that is a tenth weak does. The force of the air that it feels tells these apart.

use super::legs::{AXES, Leg};
use nalgebra::{DMatrix, DVector};

/// Share of the scatter of legs that goes from flight to flight as well: wind that turns, a battery that sits
/// elsewhere. Three flights of one vehicle outdoors scatter by 0.3 to 0.6 of it, simulated flights by 0.1 to 0.4;
/// more hides changes, less names them where there are none (`cargo bench --bench blind -- --vehicles --compared 40
/// --seed 9101`).
pub const WANDER: f64 = 0.6;
/// Standard deviation of the air's lever from flight to flight, arms. 15 flights of one vehicle outdoors show 0.2.
pub const AIR_LEVER_SPREAD: f64 = 0.2;
/// Standard deviation of the air's lever of a vehicle, arms, about zero. Wide on purpose: a body hangs below its
/// rotors by less than an arm, and the flights tell the rest.
const AIR_LEVER: f64 = 1.5;
/// Least scatter of a leg, shares: what a log's commands resolve. A pulse width of 1 us is 1e-3 of the range, and a
/// leg averages twenty of them.
const LEAST_SCATTER: f64 = 3e-4;
/// Residual beyond which a leg counts less, in standard deviations (Huber). Huber's usual value is 1.3; with a larger
/// one a gust pulls the mean, with a smaller one good legs count less.
const OUTLYING: f64 = 2.0;
/// Most correlation of a leg with the next that is believed. A larger one would let a few legs give any error.
const MOST_CORRELATED: f64 = 0.8;
/// Passes in which scatter and weights settle.
const PASSES: usize = 6;

/// The balance of several flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    /// one a flight
    pub flights: Vec<FlightBalance>,
    /// covariance of the flights' values, flight by flight, of each component; without [`FlightBalance::wander`]
    pub covariance: [DMatrix<f64>; AXES],
    /// arms, with standard error: height of the air's force above the rotors' plane, along body x and y
    pub air_lever: [(f64, f64); 2],
}

/// The balance of one flight in still air.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightBalance {
    /// as [`Leg::lean`]
    pub lean: [f64; AXES],
    /// standard deviation by which it wanders from flight to flight beside its error, of each component
    pub wander: [f64; AXES],
    /// scatter of a leg, of each component
    pub scatter: [f64; AXES],
    /// legs that it rests on
    pub legs: usize,
    /// mean of [`Leg::felt`]
    pub felt: [f64; 2],
    /// mean share of each rotor in the commanded thrust
    pub shares: Vec<f64>,
    /// specific thrust over g that full commands would give, with the standard error of its mean, of the legs on which the air hardly pushes
    pub lift: Option<(f64, f64)>,
    /// V, mean
    pub voltage_v: Option<f64>,
}

impl Balance {
    /// Standard error of a component of a flight, without what wanders.
    #[must_use]
    pub fn std(&self, flight: usize, axis: usize) -> f64 {
        self.covariance[axis][(flight, flight)].max(0.0).sqrt()
    }

    /// A component of a flight, with the standard error that a flight of the same vehicle differs by: that of the estimate, and what
    /// wanders from flight to flight.
    #[must_use]
    pub fn lean(&self, flight: usize, axis: usize) -> (f64, f64) {
        let of = &self.flights[flight];
        (of.lean[axis], self.std(flight, axis).hypot(of.wander[axis]))
    }

    /// Covariance of the flights' components with what wanders from flight to flight, at `scale` times the scatter that is expected. The
    /// errors of the legs are larger than stated where the flights scatter more, and not smaller where they scatter less.
    #[must_use]
    pub fn covariance_of(&self, axis: usize, scale: f64) -> DMatrix<f64> {
        let mut out = &self.covariance[axis] * scale.max(1.0).powi(2);
        for (place, flight) in self.flights.iter().enumerate() {
            out[(place, place)] += (scale * flight.wander[axis]).powi(2);
        }
        out
    }
}

/// The balance of flights, each given by its legs; there is at least one of each.
#[must_use]
pub fn balance(flights: &[Vec<Leg>]) -> Balance {
    let fits: [Fit; AXES] = std::array::from_fn(|axis| Fit::of(flights, axis));
    let each = flights.iter().enumerate().map(|(place, legs)| {
        let mean = |of: &dyn Fn(&Leg) -> f64| legs.iter().map(of).sum::<f64>() / legs.len() as f64;
        let rotors = legs.first().map_or(0, |leg| leg.shares.len());
        FlightBalance {
            lean: std::array::from_fn(|axis| fits[axis].own[place]),
            wander: std::array::from_fn(|axis| WANDER * fits[axis].scatter[place]),
            scatter: std::array::from_fn(|axis| fits[axis].scatter[place]),
            legs: legs.len(),
            felt: [0, 1].map(|axis| mean(&|leg| leg.felt[axis])),
            shares: (0..rotors).map(|rotor| mean(&|leg| leg.shares[rotor])).collect(),
            lift: mean_of(legs.iter().filter(|leg| is_calm(leg)).map(|leg| leg.lift)),
            voltage_v: mean_of(legs.iter().map(|leg| leg.voltage_v)).map(|(mean, _)| mean),
        }
    });
    Balance {
        flights: each.collect(),
        air_lever: [0, 1].map(|axis: usize| fits[axis].lever),
        covariance: fits.map(|fit| fit.covariance),
    }
}

/// Push of the air across the rotor axis over the weight, up to which thrust tells the weight. What the air pushes along the axis is not known
/// and may be as large as the push times the tilt, here 2 % of the weight.
const CALM: f64 = 0.15;

/// Whether the air hardly pushes a vehicle.
fn is_calm(leg: &Leg) -> bool {
    leg.felt[0].hypot(leg.felt[1]) < CALM
}

/// Mean and standard error, where there are values and every leg has one.
fn mean_of(values: impl Iterator<Item = Option<f64>>) -> Option<(f64, f64)> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    if values.is_empty() {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    Some((mean, (square / count).sqrt()))
}

/// The fit of one component.
struct Fit {
    /// of each flight
    own: Vec<f64>,
    covariance: DMatrix<f64>,
    /// of a leg of each flight
    scatter: Vec<f64>,
    lever: (f64, f64),
}

/// A leg as an equation.
struct Equation {
    flight: usize,
    /// of the air, none about the vertical
    felt: f64,
    turning: f64,
    rate: f64,
    lean: f64,
}

impl Fit {
    fn of(flights: &[Vec<Leg>], axis: usize) -> Self {
        let count = flights.len();
        let mut rows = Vec::new();
        for (flight, legs) in flights.iter().enumerate() {
            rows.extend(legs.iter().map(|leg| Equation {
                flight,
                felt: leg.felt.get(axis).copied().unwrap_or(0.0),
                turning: leg.turning[axis],
                rate: leg.rate[axis],
                lean: leg.lean[axis],
            }));
        }
        let mut scatter = vec![0.01; count];
        let mut inflation = vec![1.0; count];
        let mut huber = vec![1.0; rows.len()];
        let (mut solution, mut inverse) = solved(&rows, count, (&scatter, &inflation, &huber));
        for _ in 0..PASSES {
            let left: Vec<f64> = rows.iter().map(|row| row.lean - row.predicted(&solution)).collect();
            let determined = determined(&rows, count, (&scatter, &inflation, &huber), &inverse);
            for flight in 0..count {
                let own: Vec<f64> = rows
                    .iter()
                    .zip(&left)
                    .filter(|(row, _)| row.flight == flight)
                    .map(|(_, left)| *left)
                    .collect();
                (scatter[flight], inflation[flight]) = scatter_of(&own, determined[flight]);
            }
            for ((weight, row), left) in huber.iter_mut().zip(&rows).zip(&left) {
                *weight = (OUTLYING * scatter[row.flight] / left.abs().max(1e-12)).min(1.0);
            }
            (solution, inverse) = solved(&rows, count, (&scatter, &inflation, &huber));
        }
        let place = |flight: usize| OWN + 2 * flight;
        Self {
            own: (0..count).map(|flight| solution[place(flight)]).collect(),
            covariance: DMatrix::from_fn(count, count, |i, j| inverse[(place(i), place(j))]),
            scatter,
            lever: (solution[0], inverse[(0, 0)].max(0.0).sqrt()),
        }
    }
}

/// Places: lever, inertia, damping, then of each flight its balance and its lever beside the vehicle's.
const OWN: usize = 3;

impl Equation {
    fn coefficients(&self) -> [(usize, f64); 5] {
        let own = OWN + 2 * self.flight;
        [(0, self.felt), (1, self.turning), (2, self.rate), (own, 1.0), (own + 1, self.felt)]
    }

    fn predicted(&self, solution: &DVector<f64>) -> f64 {
        self.coefficients().iter().map(|(place, factor)| factor * solution[*place]).sum()
    }
}

/// Solution and its covariance, given the scatter of each flight's legs, how much its mean is less certain than of independent legs, and
/// the weight of each leg.
fn solved(
    rows: &[Equation],
    count: usize,
    (scatter, inflation, huber): (&[f64], &[f64], &[f64]),
) -> (DVector<f64>, DMatrix<f64>) {
    let size = OWN + 2 * count;
    let (mut normal, mut right) = (DMatrix::<f64>::zeros(size, size), DVector::<f64>::zeros(size));
    normal[(0, 0)] = AIR_LEVER.powi(-2);
    // nothing is known beforehand
    normal[(1, 1)] = 1e-6;
    normal[(2, 2)] = 1e-6;
    for flight in 0..count {
        normal[(OWN + 2 * flight, OWN + 2 * flight)] = 1e-6;
        normal[(OWN + 2 * flight + 1, OWN + 2 * flight + 1)] = AIR_LEVER_SPREAD.powi(-2);
    }
    for (row, huber) in rows.iter().zip(huber) {
        let weight = huber / (scatter[row.flight].powi(2) * inflation[row.flight]);
        let coefficients = row.coefficients();
        for (i, by) in coefficients {
            right[i] += weight * by * row.lean;
            for (j, with) in coefficients {
                normal[(i, j)] += weight * by * with;
            }
        }
    }
    let inverse =
        normal.cholesky().map_or_else(|| DMatrix::identity(size, size), |decomposed| decomposed.inverse());
    (&inverse * right, inverse)
}

/// How many parameters the legs of each flight determine: the trace of their part of the hat matrix.
fn determined(
    rows: &[Equation],
    count: usize,
    (scatter, inflation, huber): (&[f64], &[f64], &[f64]),
    inverse: &DMatrix<f64>,
) -> Vec<f64> {
    let mut out = vec![0.0; count];
    for (row, huber) in rows.iter().zip(huber) {
        let weight = huber / (scatter[row.flight].powi(2) * inflation[row.flight]);
        let coefficients = row.coefficients();
        let each = coefficients
            .iter()
            .flat_map(|&(i, by)| coefficients.iter().map(move |&(j, with)| by * with * inverse[(i, j)]));
        out[row.flight] += weight * each.sum::<f64>();
    }
    out
}

/// Scatter of what is left of legs in order, which determined so many parameters, and how much less certain their mean is than of
/// independent ones.
fn scatter_of(left: &[f64], determined: f64) -> (f64, f64) {
    let count = left.len() as f64;
    let mut sizes: Vec<f64> = left.iter().map(|value| value.abs()).collect();
    let robust = crate::stats::normal_sigma(&mut sizes);
    let rms = (left.iter().map(|value| value * value).sum::<f64>() / (count - determined).max(1.0)).sqrt();
    // a leg or two of a gust are no scatter
    let scatter = rms.min(2.0 * robust.max(LEAST_SCATTER)).max(LEAST_SCATTER);
    let products: f64 = left.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let squares: f64 = left.iter().map(|value| value * value).sum::<f64>().max(f64::MIN_POSITIVE);
    let correlated = (products / squares).clamp(0.0, MOST_CORRELATED);
    (scatter, (1.0 + correlated) / (1.0 - correlated))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trim::LEAST_LEGS;

    /// Legs of a flight in an air that pushes by `felt` on the mean, whose balance in still air is `own`.
    fn flight(own: [f64; AXES], felt: f64) -> Vec<Leg> {
        let leg = |place: u32| {
            let time_s = 2.0 * f64::from(place);
            let push = felt + 0.02 * (1.3 * time_s).sin();
            let (turning, rate) = (0.3 * (0.7 * time_s).sin(), 0.2 * (0.4 * time_s).cos());
            // at the legs' 2 s no other term goes like it
            let noise = 0.002 * (5.3 * time_s).sin();
            let of = |axis: usize| {
                let air = if axis < 2 { 0.9 * push } else { 0.0 };
                own[axis] + air + 0.1 * turning + 0.05 * rate + noise
            };
            Leg {
                time_s,
                lean: [of(0), of(1), of(2)],
                felt: [push; 2],
                turning: [turning; AXES],
                rate: [rate; AXES],
                shares: vec![0.25; 4],
                lift: Some(2.0),
                voltage_v: None,
            }
        };
        (0..30).map(leg).collect()
    }

    #[test]
    fn the_scatter_of_few_legs_is_neither_too_small_nor_too_large() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let mut noise = || 0.01 * rng.sample::<f64, _>(rand_distr::StandardNormal);
        let mut squares = 0.0;
        for _ in 0..200 {
            let mut short = || {
                let mut legs = flight([0.01, -0.02, 0.03], 0.0)[..LEAST_LEGS].to_vec();
                legs.iter_mut().for_each(|leg| leg.lean[0] += noise());
                legs
            };
            squares += Fit::of(&[short(), short()], 0).scatter.iter().map(|std| std * std).sum::<f64>();
        }
        let ratio = (squares / 400.0).sqrt() / 0.01;
        // by the number of legs less 1.5 it was 0.77
        assert!((0.88..1.12).contains(&ratio), "{ratio}");
    }

    #[test]
    fn legs_in_strong_wind_do_not_tell_the_lift() {
        let mut legs = flight([0.0; AXES], 0.05);
        for leg in legs.iter_mut().skip(10) {
            (leg.felt, leg.lift) = ([0.3, 0.15], Some(1.46));
        }
        assert_eq!(balance(&[legs.clone()]).flights[0].lift, Some((2.0, 0.0)));
        assert_eq!(balance(&[legs.split_off(10)]).flights[0].lift, None);
    }

    #[test]
    fn wind_and_turning_are_told_apart_from_the_balance() {
        let own = [[0.01, -0.02, 0.03], [0.04, -0.05, -0.01]];
        let found = balance(&[flight(own[0], 0.0), flight(own[1], 0.06)]);
        for (flight, own) in own.iter().enumerate() {
            for (axis, own) in own.iter().enumerate() {
                let (value, std) = (found.flights[flight].lean[axis], found.std(flight, axis));
                assert!((value - own).abs() < 3.0 * std && std < 0.006, "{flight} {axis}: {value} +- {std}");
            }
        }
        assert!(found.air_lever.iter().all(|(lever, std)| (lever - 0.9).abs() < 3.0 * std));
        let wide = found.covariance_of(0, 2.0);
        assert!(wide[(0, 0)] > found.covariance[0][(0, 0)]);
    }
}
