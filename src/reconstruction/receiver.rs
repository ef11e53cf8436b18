//! The velocity that a satellite receiver measures: raw, beside the autopilot's estimate.

use nalgebra::{Vector2, Vector3};

use super::place::{Place, STEP_S, cell_of};
use crate::recording::Stream;
use crate::signals::{Grid, Signals};

/// Latenesses of a receiver that are tried, s: from the first to the last by the step. A receiver's delay lies well
/// within; a wider range costs time.
const TRIED_S: (f64, f64, f64) = (-0.1, 0.4, 0.01);
/// Fewer samples than this teach no lateness. They are 4 s at 5 Hz; a shorter piece resembles itself at any lateness.
const LEAST_SAMPLES: usize = 20;

/// Neighbouring samples of a receiver that are further apart than this say little of an error that changes within seconds.
const NEIGHBOURS_S: f64 = 1.0;

/// Root mean square of the slow error of the autopilot's horizontal velocity in flight, m/s, each axis: what it differs by from a
/// receiver's for longer than from one sample to the next. A receiver's own noise is another in each sample. `None` without a receiver,
/// or with too few of its samples in the air.
#[must_use]
pub fn velocity_error_m_s(signals: &Signals) -> Option<f64> {
    let (stream, velocity) = (signals.as_recorded.gps_velocity.as_deref()?, signals.velocity.as_ref()?);
    slow_error_m_s(stream, (&signals.grid, velocity), &signals.quality.airborne_s)
}

/// The same of a receiver's stream; `estimated` is the autopilot's velocity on its grid.
fn slow_error_m_s(
    stream: &Stream,
    estimated: (&Grid, &[Vector3<f64>]),
    airborne_s: &[(f64, f64)],
) -> Option<f64> {
    let (grid, velocity) = estimated;
    let horizontal = |index: &usize| stream.sample(*index)[..2].iter().all(|part| part.is_finite());
    // at every lateness that is tried there is a velocity to compare with
    let (first_s, last_s) = (grid.start_s + TRIED_S.1, grid.time_s(grid.count.saturating_sub(1)) + TRIED_S.0);
    let flown = |index: &usize| {
        let t = stream.time_s[*index];
        (first_s..last_s).contains(&t)
            && airborne_s.iter().any(|(from_s, to_s)| (*from_s..*to_s).contains(&t))
    };
    let samples: Vec<usize> = (0..stream.len()).filter(flown).filter(horizontal).collect();
    if samples.len() < LEAST_SAMPLES {
        return None;
    }
    let late_s = lateness_s(stream, &samples, estimated);
    let apart = |&index: &usize| {
        let here = Place::of(grid, stream.time_s[index] - late_s).between(velocity);
        let seen = stream.sample(index);
        Vector2::new(seen[0] - here.x, seen[1] - here.y)
    };
    let near = |pair: &&[usize]| stream.time_s[pair[1]] - stream.time_s[pair[0]] < NEIGHBOURS_S;
    let products: Vec<f64> =
        samples.windows(2).filter(near).map(|pair| apart(&pair[0]).dot(&apart(&pair[1])) / 2.0).collect();
    let mean = products.iter().sum::<f64>() / products.len() as f64;
    (products.len() >= LEAST_SAMPLES).then(|| mean.max(0.0).sqrt())
}

/// One sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReceiverSample {
    /// in which it was measured
    pub(super) cell: usize,
    /// place in the cell, 0 to 1
    pub(super) share: f64,
    /// world, m/s
    pub(super) velocity_m_s: Vector3<f64>,
    /// whether the message has a climb
    pub(super) climbs: bool,
}

/// The receiver's samples in cells, earlier than their stamps by the lateness that the autopilot's velocity tells.
#[derive(Debug, Default)]
pub struct Received {
    /// samples in the air
    pub(super) samples: Vec<ReceiverSample>,
}

impl Received {
    /// The samples of a flight; `estimated` is the autopilot's velocity on its grid, m/s.
    pub(super) fn of(stream: &Stream, estimated: (&Grid, &[Vector3<f64>]), time_s: &[f64]) -> Self {
        let (Some(first), Some(last)) = (time_s.first(), time_s.last()) else { return Self::default() };
        let horizontal = |index: &usize| stream.sample(*index)[..2].iter().all(|part| part.is_finite());
        let flown = |index: &usize| (*first..*last).contains(&stream.time_s[*index]);
        let samples: Vec<usize> = (0..stream.len()).filter(flown).filter(horizontal).collect();
        if samples.len() < LEAST_SAMPLES {
            return Self::default();
        }
        let late_s = lateness_s(stream, &samples, estimated);
        let one = |&index: &usize| {
            let t = stream.time_s[index] - late_s;
            let cell = cell_of(time_s, t)?;
            let mut velocity_m_s = Vector3::from_row_slice(stream.sample(index));
            let climbs = velocity_m_s.z.is_finite();
            if !climbs {
                velocity_m_s.z = 0.0;
            }
            Some(ReceiverSample { cell, share: (t - time_s[cell]) / STEP_S, velocity_m_s, climbs })
        };
        Self { samples: samples.iter().filter_map(one).collect() }
    }
}

/// The lateness at which the receiver's horizontal velocity is nearest to the autopilot's, s.
fn lateness_s(stream: &Stream, samples: &[usize], (grid, velocity): (&Grid, &[Vector3<f64>])) -> f64 {
    let (first, last, step) = TRIED_S;
    let apart = |late_s: f64| {
        let one = |&index: &usize| {
            let here = Place::of(grid, stream.time_s[index] - late_s).between(velocity);
            let seen = stream.sample(index);
            (seen[0] - here.x).powi(2) + (seen[1] - here.y).powi(2)
        };
        samples.iter().map(one).sum::<f64>()
    };
    let tried = (0..).map(|index| first + f64::from(index) * step).take_while(|late_s| *late_s <= last);
    tried
        .map(|late_s| (late_s, apart(late_s)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0.0, |found| found.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(t: f64) -> Vector3<f64> {
        Vector3::new((1.3 * t).sin(), (0.7 * t).cos(), 0.2 * t.sin())
    }

    #[test]
    fn a_receiver_that_is_late_is_put_where_it_measured() {
        let grid = Grid { start_s: 0.0, step_s: 0.01, count: 3000 };
        let estimated: Vec<Vector3<f64>> = (0..grid.count).map(|index| at(grid.time_s(index))).collect();
        let time_s: Vec<f64> = (0..200).map(|index| 1.0 + 0.1 * f64::from(index)).collect();
        // 0.13 s late, without a climb
        let seen = time_s.iter().map(|t| at(t - 0.13)).flat_map(|v| [v.x, v.y, f64::NAN]).collect();
        let stream = Stream { time_s, width: 3, values: seen };
        let cells: Vec<f64> = (0..600).map(|index| f64::from(index) * STEP_S).collect();
        let received = Received::of(&stream, (&grid, &estimated), &cells);
        assert!(received.samples.len() > 190, "{}", received.samples.len());
        for seen in &received.samples {
            let true_m_s = at(cells[seen.cell] + seen.share * STEP_S);
            assert!((seen.velocity_m_s - true_m_s).xy().norm() < 1e-3 && !seen.climbs, "{seen:?}");
        }
    }

    #[test]
    fn the_slow_error_of_a_velocity_shows_beside_a_receivers_noise() {
        let grid = Grid { start_s: 0.0, step_s: 0.01, count: 6000 };
        // each axis is wrong by 0.3 m/s rms, within ten seconds
        let wrong = |t: f64| Vector3::new((0.6 * t).sin(), (0.6 * t).cos(), 0.0) * (0.3 * 2.0_f64.sqrt());
        let estimated: Vec<Vector3<f64>> =
            (0..grid.count).map(|index| at(grid.time_s(index)) + wrong(grid.time_s(index))).collect();
        let time_s: Vec<f64> = (0..500).map(|index| 2.0 + 0.1 * f64::from(index)).collect();
        // noise of 0.2 m/s that is another in each sample
        let noise = |index: usize| 0.2 * 2.0_f64.sqrt() * (2.4 * index as f64).sin();
        let seen = time_s.iter().enumerate().flat_map(|(index, t)| {
            let seen = at(*t);
            [seen.x + noise(index), seen.y + noise(7 * index), f64::NAN]
        });
        let values = seen.collect();
        let stream = Stream { time_s, width: 3, values };
        let error = |airborne_s| slow_error_m_s(&stream, (&grid, &estimated), airborne_s);
        assert_eq!(error(&[(0.0, 2.5)]), None);
        let error_m_s = error(&[(0.0, 60.0)]).expect("enough samples");
        assert!((error_m_s - 0.3).abs() < 0.06, "{error_m_s}");
    }

    #[test]
    fn a_few_samples_teach_nothing() {
        let stream = Stream { time_s: vec![1.0, 1.2], width: 3, values: vec![0.0; 6] };
        let grid = Grid { start_s: 0.0, step_s: 0.01, count: 300 };
        let still = vec![Vector3::zeros(); 300];
        assert!(Received::of(&stream, (&grid, &still), &[0.0, 1.0, 2.0]).samples.is_empty());
    }
}
