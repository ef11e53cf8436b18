//! The linear allocation from a controller's setpoints to the rotors' thrusts, fitted to the commands that a log holds.

use super::grid::cubic_at;
use crate::recording::Stream;
use nalgebra::{DMatrix, DVector};

/// Steps in which the shift between the stamps of commands and setpoints is searched, s.
const LATE_STEP_S: f64 = 0.001;
/// Steps to each side: four cycles of a controller at 400 Hz.
const LATE_STEPS: i32 = 10;
/// Least squared correlation of a torque that was asked for with that of the commands. With less, their spreads do not belong together.
const LEAST_ALIKE: f64 = 0.2;
/// The same from which on least squares err by less than the ratio of spreads does: at most 3 % on logs of ArduPilot's simulator whose
/// allocation is known.
const WELL_ALIKE: f64 = 0.95;
/// Relative standard error of least squares over the share of a torque that the commands do not follow: at most 3 % where that was 0.01 to
/// 0.02 on the same logs.
const STD_OF_UNFOLLOWED: f64 = 2.0;
/// Relative standard error of a ratio of spreads: 1 to 10 % off on the same logs.
pub(super) const STD_BY_SPREAD: f64 = 0.05;
/// Thrust setpoints further apart are no line between each other, s: PX4 logs them at 17 Hz by default.
const THRUST_GAP_S: f64 = 0.15;
/// Commands that are no linear function of the setpoints any more: at their ends.
const UNSATURATED: std::ops::Range<f64> = 0.02..0.98;
/// Fewer pairs than this fit five coefficients a rotor badly. They are twelve for each coefficient.
const LEAST_PAIRS: usize = 60;
/// Columns of the allocation: a constant, torque about x, y, z, thrust.
const COLUMNS: usize = 5;

/// A channel of a stream at a time, on the straight line between two samples; `None` outside of them and in gaps.
pub(super) fn between(stream: &Stream, channel: usize, time_s: f64) -> Option<f64> {
    let after = stream.time_s.partition_point(|stamp_s| *stamp_s < time_s);
    let (next, next_s) = (stream.sample(after.min(stream.len() - 1))[channel], *stream.time_s.get(after)?);
    if after == 0 {
        return (next_s == time_s).then_some(next);
    }
    let (last, last_s) = (stream.sample(after - 1)[channel], stream.time_s[after - 1]);
    let span_s = next_s - last_s;
    (span_s <= THRUST_GAP_S).then(|| last + (next - last) * (time_s - last_s) / span_s)
}

/// Setpoints and commands of the same instants.
struct Pairs {
    /// a constant and the setpoints, a row an instant
    asked: DMatrix<f64>,
    /// thrusts, one column a rotor
    wanted: DMatrix<f64>,
}

impl Pairs {
    /// Commands that are not at their ends, with the setpoints `late_s` after their stamps; `None` where they are too few.
    fn of(asked: &Stream, (thrusts, command): (&Stream, &Stream), late_s: f64) -> Option<Self> {
        let unsaturated = |index: &usize| command.sample(*index).iter().all(|u| UNSATURATED.contains(u));
        let late = |index: usize| thrusts.time_s[index] + late_s;
        let within = |index: &usize| between(asked, 0, late(*index)).is_some();
        let used: Vec<usize> = (0..thrusts.len()).filter(unsaturated).filter(within).collect();
        if used.len() < LEAST_PAIRS {
            return None;
        }
        // the controller's noise changes between two samples
        let times_s: Vec<f64> = used.iter().map(|index| late(*index)).collect();
        let at = cubic_at(asked, &times_s)?;
        Some(Self {
            asked: DMatrix::from_fn(used.len(), COLUMNS, |row, column| {
                if column == 0 { 1.0 } else { at[row * asked.width + column - 1] }
            }),
            wanted: DMatrix::from_fn(used.len(), thrusts.width, |row, rotor| {
                thrusts.sample(used[row])[rotor]
            }),
        })
    }

    /// Mean square of what coefficients leave of a thrust, N^2.
    fn left(&self, coefficients: &DMatrix<f64>) -> f64 {
        (&self.wanted - &self.asked * coefficients).norm_squared() / self.wanted.len() as f64
    }

    /// Least squares. A setpoint that never moves has no coefficient: the least solution leaves it at nought.
    fn by_least_squares(&self) -> Option<DMatrix<f64>> {
        self.asked.clone().svd(true, true).solve(&self.wanted, 1e-9).ok()
    }

    /// Coefficients of least squares, or, where the commands follow a setpoint only in part, those by which the setpoint varies as much as
    /// `spread` (its variance at all samples) says; and the relative standard error of those of the torques about x and y, the greater
    /// one. Where the controller's answer to the noise of its gyroscopes changes between two setpoints, least squares do not know what the
    /// command was made of; both are of one process, so the ratio of their spreads stays right. `None` where the commands do not follow
    /// a torque that was asked for.
    fn evened(&self, mut coefficients: DMatrix<f64>, spread: &[f64]) -> Option<(DMatrix<f64>, f64)> {
        let shares = coefficients.rows(1, COLUMNS - 1).into_owned();
        let constant =
            DMatrix::from_fn(self.wanted.nrows(), shares.ncols(), |_, rotor| coefficients[(0, rotor)]);
        // what was asked for, by the commands
        let by_commands = (&self.wanted - constant) * shares.pseudo_inverse(1e-12).ok()?;
        let mut most = 0.0_f64;
        for column in 1..COLUMNS {
            let (logged, commanded) = (self.asked.column(column), by_commands.column(column - 1));
            let (of_logged, of_commanded) = (logged.variance(), commanded.variance());
            let of_all = spread[column - 1];
            if of_logged <= 0.0 || of_commanded <= 0.0 || of_all <= 0.0 {
                continue;
            }
            let means = (logged.mean(), commanded.mean());
            let products = logged.iter().zip(commanded.iter()).map(|(a, b)| (a - means.0) * (b - means.1));
            let together = products.sum::<f64>() / logged.len() as f64;
            let alike = together * together / (of_logged * of_commanded);
            let follows = alike >= WELL_ALIKE;
            if column < 3 {
                if alike < LEAST_ALIKE {
                    return None;
                }
                most = most.max(if follows { STD_OF_UNFOLLOWED * (1.0 - alike) } else { STD_BY_SPREAD });
            }
            if !follows && alike >= LEAST_ALIKE {
                coefficients.row_mut(column).scale_mut((of_commanded / of_all).sqrt());
            }
        }
        // the mean command stays that of the mean setpoint
        let means = |of: &DMatrix<f64>| of.row_mean();
        let constant = means(&self.wanted)
            - means(&self.asked).columns(1, COLUMNS - 1) * coefficients.rows(1, COLUMNS - 1);
        coefficients.set_row(0, &constant);
        Some((coefficients, most))
    }
}

/// Variance of each channel of a stream over the span of these times.
fn variances(stream: &Stream, times_s: &[f64]) -> Vec<f64> {
    let (first_s, last_s) = (times_s.first().copied().unwrap_or(0.0), times_s.last().copied().unwrap_or(0.0));
    let inside = (0..stream.len()).filter(|&index| (first_s..=last_s).contains(&stream.time_s[index]));
    let inside: Vec<usize> = inside.collect();
    let of = |channel: usize| {
        let values = inside.iter().map(|&index| stream.sample(index)[channel]);
        DVector::from_iterator(inside.len(), values).variance()
    };
    (0..stream.width).map(of).collect()
}

/// From setpoints to one thrust a rotor.
pub(super) struct Allocation {
    /// one column a rotor
    coefficients: DMatrix<f64>,
    /// relative standard error of those of the torques about x and y
    pub(super) std: f64,
    /// share of the commands' variance
    pub(super) explained: f64,
    /// what is left of one rotor's thrust, N, root mean square
    pub(super) rms_n: f64,
}

impl Allocation {
    /// The allocation of all commands that are not at their ends, or why there is none.
    pub(super) fn fit(asked: &Stream, thrusts: &Stream, command: &Stream) -> Result<Self, String> {
        // setpoints and commands are stamped at different places of the controller's cycle
        let at = |late: i32| {
            let pairs = Pairs::of(asked, (thrusts, command), f64::from(late) * LATE_STEP_S)?;
            let coefficients = pairs.by_least_squares()?;
            let left = pairs.left(&coefficients);
            Some((left, coefficients, pairs))
        };
        let each = (-LATE_STEPS..=LATE_STEPS).filter_map(at);
        let (_, coefficients, pairs) = each
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .ok_or_else(|| format!("fewer than {LEAST_PAIRS} of them have setpoints around them"))?;
        let (coefficients, std) = pairs
            .evened(coefficients, &variances(asked, &thrusts.time_s))
            .ok_or("they do not follow the torques about x and y that were asked for")?;
        let mut variance = 0.0;
        for rotor in 0..pairs.wanted.ncols() {
            let mean = pairs.wanted.column(rotor).mean();
            variance += pairs.wanted.column(rotor).map(|thrust_n| (thrust_n - mean).powi(2)).sum();
        }
        let left = pairs.left(&coefficients);
        let squares = left * pairs.wanted.len() as f64;
        Ok(Self {
            coefficients,
            std,
            explained: 1.0 - squares / variance.max(f64::MIN_POSITIVE),
            rms_n: left.sqrt(),
        })
    }

    /// The thrusts that these setpoints ask for.
    pub(super) fn applied(&self, asked: &Stream) -> Stream {
        let width = self.coefficients.ncols();
        let mut values = Vec::with_capacity(asked.len() * width);
        for index in 0..asked.len() {
            let row = DVector::from_iterator(
                COLUMNS,
                std::iter::once(1.0).chain(asked.sample(index).iter().copied()),
            );
            // a rotor does not pull downwards
            values.extend(self.coefficients.tr_mul(&row).iter().map(|thrust_n| thrust_n.max(0.0)));
        }
        Stream { time_s: asked.time_s.clone(), width, values }
    }
}
