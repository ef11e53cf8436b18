//! Instruments: the torques and the thrust that the commanded trajectory needs. It causes the motion, and it does not contain the noise that the
//! measured motion and the commands share.

use crate::signals::{Reference, central_difference};
use nalgebra::{DMatrix, Rotation3, Vector3};

/// Delays at which the trajectory serves, s: controllers follow it within these.
const LATE_S: [f64; 3] = [0.0, 0.15, 0.3];
/// Derivatives of the commanded acceleration: the torque follows its second, the thrust itself.
const ORDERS: usize = 3;
/// Directions of the instruments with less than this share of the first one's length are left out. Above rounding,
/// and far below any motion.
const LEAST_DIRECTION: f64 = 1e-6;

/// Least rms of an instrument about its mean, m/s^2 and rad/s or their derivatives. An instrument that hardly moves
/// tells nothing and costs a column.
const LEAST_RMS: f64 = 0.01;

/// The orthonormal directions of instruments about their means, one row a row of the weak form; `None` where nothing is asked.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Instruments {
    /// of the torque about each body axis
    pub(super) torques: [Option<DMatrix<f64>>; 3],
    /// of the thrust
    pub(super) thrust: Option<DMatrix<f64>>,
}

/// Instruments of a flight on a grid of this step, s, in this gravity, m/s^2, by the weak form's derivatives of a series at its rows: sideways
/// acceleration for roll, forward for pitch, turning for yaw, and what gravity and the acceleration need together for the thrust.
pub(super) fn instruments(
    reference: &Reference,
    (step_s, gravity_m_s2): (f64, f64),
    weak: impl Fn(usize, &[f64]) -> Vec<f64>,
) -> Instruments {
    let turned = |axis: usize| -> Vec<f64> {
        let each = reference.acceleration.iter().zip(reference.yaw.iter());
        each.map(|(world, yaw)| {
            Rotation3::from_euler_angles(0.0, 0.0, *yaw).inverse_transform_vector(world)[axis]
        })
        .collect()
    };
    let turning = central_difference(&reference.yaw, step_s);
    let lift = |world: &Vector3<f64>| (world + Vector3::z() * gravity_m_s2).norm();
    let lift: Vec<f64> = reference.acceleration.iter().map(lift).collect();
    let of = |series: &[f64]| directions(&late(series, step_s, &weak));
    Instruments { torques: [turned(1), turned(0), turning].map(|series| of(&series)), thrust: of(&lift) }
}

/// A series at each of the delays, with its derivatives.
fn late(series: &[f64], step_s: f64, weak: impl Fn(usize, &[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    let at = |late_s: &f64| {
        let late = instants(*late_s, step_s);
        let behind: Vec<f64> = (0..series.len()).map(|index| series[index.saturating_sub(late)]).collect();
        (0..ORDERS).map(|order| weak(order, &behind)).collect::<Vec<_>>()
    };
    LATE_S.iter().flat_map(at).collect()
}

/// Number of grid steps nearest to a delay.
fn instants(late_s: f64, step_s: f64) -> usize {
    (0..).take_while(|count| (f64::from(*count) + 0.5) * step_s < late_s).count()
}

/// Orthonormal directions of the instruments about their means.
fn directions(instruments: &[Vec<f64>]) -> Option<DMatrix<f64>> {
    let rows = instruments.first()?.len();
    let mut all = DMatrix::from_fn(rows, instruments.len(), |row, column| instruments[column][row]);
    for mut column in all.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
        let length = column.norm();
        // what is asked for all along is no excitation, nor is its rounding
        if length > LEAST_RMS * (rows as f64).sqrt() {
            column /= length;
        } else {
            column.fill(0.0);
        }
    }
    let square = all.tr_mul(&all).symmetric_eigen();
    let most = square.eigenvalues.max();
    let kept: Vec<usize> =
        (0..instruments.len()).filter(|&i| square.eigenvalues[i] > LEAST_DIRECTION * most).collect();
    if kept.is_empty() || most <= 0.0 {
        return None;
    }
    let mut out = &all * square.eigenvectors.select_columns(&kept);
    for (mut column, &index) in out.column_iter_mut().zip(&kept) {
        column /= square.eigenvalues[index].sqrt();
    }
    Some(out)
}

/// Inverse of a normal matrix of the second stage, its columns brought to one length before; `None` where they are not told apart.
pub(super) fn inverse(normal: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let count = normal.nrows();
    let scale = normal.diagonal().map(f64::sqrt);
    if scale.iter().any(|scale| *scale <= 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(count, count, |i, j| normal[(i, j)] / (scale[i] * scale[j]));
    let inverse = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] / (scale[i] * scale[j])))
}
