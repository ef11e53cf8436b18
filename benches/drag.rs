//! The drag of flights of PX4's simulator by three estimators, side by side: the weak form by least squares, the weak form by
//! instruments, and the joint estimate of flight path and parameters with which `explain` answers.
//!
//! `cargo bench --bench drag`. The logs are those of `MAVID_SHARED` (`../shared`); `answers.json` beside them has no part in any
//! estimate, the drag that was flown is stated here.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use std::path::{Path, PathBuf};

use mavid::config::load_vehicle;
use mavid::log::{self, OpenOptions};
use mavid::recording::Quantity;
use mavid::signals::{
    ConditionSettings, STEP_FOR_EFFECTS_S, Signals, WEAK_HALF_WIDTH_S, WeakKernel, best, condition,
    linear_onto,
};
use mavid::study::{ExplainRequest, Silent, VehicleGiven, explain};
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;
use support::{Arguments, end};

/// Flights with the drag that their simulator has along each axis, N per m/s.
const FLIGHTS: [(&str, f64); 9] = [
    ("d1", 0.5),
    ("d2", 1.0),
    ("d3", 2.0),
    ("d4", 0.5),
    ("d5", 1.0),
    ("d6", 2.0),
    ("d7", 0.5),
    ("d8", 1.0),
    ("d9", 2.0),
];
/// Rows between which errors may be correlated: 2 s.
const CORRELATED_ROWS: usize = 40;
/// Centres of the weak form, s apart.
const APART_S: f64 = 0.05;
/// How late the commanded trajectory is used as an instrument, s: the vehicle is behind it.
const BEHIND_S: [f64; 3] = [0.0, 0.3, 0.6];

/// A coefficient with its standard error, N per m/s.
type Told = (f64, f64);

/// One flight: by each estimator, along x and y.
struct Row {
    truth: f64,
    least_squares: [Told; 2],
    instruments: [Told; 2],
    joint: Vec<Told>,
}

fn main() {
    let _ = Arguments::of_process();
    let root = PathBuf::from(std::env::var_os("MAVID_SHARED").unwrap_or_else(|| "../shared".into()));
    let vehicle = root.join("recordings/autopilots/px4-sih.toml");
    let rows: Vec<Row> = FLIGHTS
        .par_iter()
        .map(|&(name, truth)| {
            row(&root.join("onboard/px4_drag").join(name).with_extension("tlog"), &vehicle, truth)
        })
        .collect();
    for ((name, truth), row) in FLIGHTS.iter().zip(&rows) {
        println!("{name} {truth}: {:.3?} {:.3?} {:.3?}", row.least_squares, row.instruments, row.joint);
    }
    println!(
        "\n| estimator | sizes | mean error | rms error | within two standard errors | median standard error |"
    );
    println!("|---|---|---|---|---|---|");
    summary("weak form, least squares", &rows, |row| row.least_squares.to_vec());
    summary("weak form, instruments", &rows, |row| row.instruments.to_vec());
    summary("`explain`: flight path and parameters together", &rows, |row| row.joint.clone());
}

/// One line of the table.
fn summary(name: &str, rows: &[Row], of: impl Fn(&Row) -> Vec<Told>) {
    let told: Vec<(f64, f64, f64)> = rows
        .iter()
        .flat_map(|row| {
            of(row)
                .into_iter()
                .map(|(value, std)| (value / row.truth - 1.0, std / row.truth, (value - row.truth) / std))
        })
        .collect();
    let count = told.len() as f64;
    let mean = told.iter().map(|(error, ..)| error).sum::<f64>() / count;
    let rms = (told.iter().map(|(error, ..)| error * error).sum::<f64>() / count).sqrt();
    let within = told.iter().filter(|(.., z)| z.abs() <= 2.0).count();
    let mut stds: Vec<f64> = told.iter().map(|(_, std, _)| *std).collect();
    stds.sort_by(f64::total_cmp);
    let median = stds.get(stds.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "| {name} | {} of 18 | {:+.1} % | {:.1} % | {within} | {:.1} % |",
        told.len(),
        100.0 * mean,
        100.0 * rms,
        100.0 * median
    );
}

fn row(log: &Path, vehicle: &Path, truth: f64) -> Row {
    let stop = |error: &dyn std::fmt::Display| -> ! { end(&format!("{}: {error}", log.display())) };
    let opened = log::open(log, &OpenOptions::default()).unwrap_or_else(|error| stop(&error));
    let nominal = load_vehicle(vehicle).unwrap_or_else(|error| stop(&error));
    let settings = ConditionSettings { step_s: Some(STEP_FOR_EFFECTS_S), ..ConditionSettings::default() };
    let signals = condition(&opened.recording, &nominal, &settings).unwrap_or_else(|error| stop(&error));
    let (_, commanded) = best(&opened.recording, Quantity::VelocitySetpoint, |stream| stream.width == 3)
        .unwrap_or_else(|| stop(&"expected a commanded velocity, got none"));
    let commanded = linear_onto(commanded, 0.0, &signals.grid)
        .unwrap_or_else(|| stop(&"expected a commanded velocity during the flight, got none"));
    let commanded: Vec<Vector3<f64>> = commanded.chunks_exact(3).map(Vector3::from_column_slice).collect();
    let weak = WeakRows::of(&signals, &commanded)
        .unwrap_or_else(|| stop(&"expected attitude, velocity, accelerometer and commanded trajectory"));
    let request = ExplainRequest {
        logs: vec![log.to_path_buf()],
        vehicle: VehicleGiven::File(vehicle.to_path_buf()),
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    let study = explain(&request, &Silent).unwrap_or_else(|error| stop(&error));
    let drag = study.effects.iter().filter(|effect| effect.id == "linear_drag");
    let joint =
        drag.flat_map(|effect| &effect.parameters).filter(|parameter| ["dx", "dy"].contains(&parameter.name));
    Row {
        truth,
        least_squares: [0, 1].map(|axis| weak.least_squares(axis, nominal.body.mass_kg)),
        instruments: [0, 1].map(|axis| weak.instruments(axis, nominal.body.mass_kg)),
        joint: joint.map(|parameter| (parameter.value, parameter.std)).collect(),
    }
}

/// Weak means of what the two equations across the rotor axis compare, one row a centre.
struct WeakRows {
    /// m/s^2, body
    specific_force: [Vec<f64>; 3],
    /// m/s, body, by the autopilot's estimate
    velocity: [Vec<f64>; 3],
    /// commanded velocity and acceleration in the commanded heading, each as late as [`BEHIND_S`] says
    commanded: Vec<[Vec<f64>; 3]>,
}

impl WeakRows {
    fn of(signals: &Signals, commanded_velocity: &[Vector3<f64>]) -> Option<Self> {
        let (attitude, velocity) = (signals.attitude.as_ref()?, signals.velocity.as_ref()?);
        let (force, reference) = (signals.specific_force.as_ref()?, signals.reference.as_ref()?);
        let step_s = signals.grid.step_s;
        let kernel = WeakKernel::new(WEAK_HALF_WIDTH_S, step_s);
        let rows = |seconds: f64| {
            (0..signals.grid.count).take_while(|count| (*count as f64 + 0.5) * step_s < seconds).count()
        };
        let longest = rows(BEHIND_S[BEHIND_S.len() - 1]);
        let within = |center: &usize| {
            signals.usable[center - kernel.half_count..=center + kernel.half_count]
                .iter()
                .all(|usable| *usable)
        };
        let last = signals.grid.count.checked_sub(kernel.half_count + 1)?;
        let centers: Vec<usize> =
            (kernel.half_count + longest..=last).step_by(rows(APART_S).max(1)).filter(within).collect();
        let body: Vec<_> = attitude
            .iter()
            .zip(velocity.iter())
            .map(|(attitude, v)| attitude.inverse_transform_vector(v))
            .collect();
        let turned = |series: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
            let turn = |(v, yaw): (&Vector3<f64>, &f64)| {
                let (sin, cos) = yaw.sin_cos();
                Vector3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z)
            };
            series.iter().zip(reference.yaw.iter()).map(turn).collect()
        };
        let commanded = [turned(commanded_velocity), turned(&reference.acceleration)];
        let behind = |series: &Vec<Vector3<f64>>, seconds: f64| {
            let earlier: Vec<usize> = centers.iter().map(|center| center - rows(seconds)).collect();
            kernel.apply_vector(0, series, &earlier)
        };
        Some(Self {
            specific_force: kernel.apply_vector(0, force, &centers),
            velocity: kernel.apply_vector(0, &body, &centers),
            commanded: commanded
                .iter()
                .flat_map(|series| BEHIND_S.map(|seconds| behind(series, seconds)))
                .collect(),
        })
    }

    /// Velocity and one, and the force without its sign: `m a = -d v + constant`.
    fn equation(&self, axis: usize, mass_kg: f64) -> (DMatrix<f64>, DVector<f64>) {
        let count = self.velocity[axis].len();
        let velocity = DVector::from_column_slice(&self.velocity[axis]);
        let columns = DMatrix::from_columns(&[velocity, DVector::repeat(count, 1.0)]);
        (columns, DVector::from_column_slice(&self.specific_force[axis]) * -mass_kg)
    }

    fn least_squares(&self, axis: usize, mass_kg: f64) -> Told {
        let (columns, force) = self.equation(axis, mass_kg);
        solved(&columns, &columns, &force)
    }

    /// Two-stage least squares: of the velocity only what goes with the commanded trajectory.
    fn instruments(&self, axis: usize, mass_kg: f64) -> Told {
        let (columns, force) = self.equation(axis, mass_kg);
        let count = force.len();
        let commanded = self.commanded.iter().map(|series| DVector::from_column_slice(&series[axis]));
        let instruments: Vec<_> = commanded.chain([DVector::repeat(count, 1.0)]).collect();
        let instruments = DMatrix::from_columns(&instruments);
        let stage =
            (instruments.transpose() * &instruments).pseudo_inverse(1e-9).expect("a tolerance above zero");
        let fitted = &instruments * (stage * (instruments.transpose() * &columns));
        solved(&columns, &fitted, &force)
    }
}

/// The first coefficient of `fitted' columns theta = fitted' force`, with an error that allows for rows that are correlated
/// (Newey and West 1987).
fn solved(columns: &DMatrix<f64>, fitted: &DMatrix<f64>, force: &DVector<f64>) -> Told {
    let inverse = (fitted.transpose() * columns).try_inverse().expect("a flight that moves");
    let theta = &inverse * (fitted.transpose() * force);
    let residual = force - columns * &theta;
    let mut scores = fitted.clone();
    scores.row_iter_mut().zip(residual.iter()).for_each(|(mut row, residual)| row *= *residual);
    let count = scores.nrows();
    let mut sum = scores.transpose() * &scores;
    for lag in 1..=CORRELATED_ROWS.min(count - 1) {
        let shared = scores.rows(lag, count - lag).transpose() * scores.rows(0, count - lag);
        sum += (&shared + shared.transpose()) * (1.0 - lag as f64 / (CORRELATED_ROWS as f64 + 1.0));
    }
    let covariance = &inverse * sum * inverse.transpose();
    (theta[0], covariance[(0, 0)].sqrt())
}
