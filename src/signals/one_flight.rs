//! Whether two logs hold the same flight, and how their clocks differ.
//!
//! A ground station and the vehicle both log the attitude that the autopilot estimates. Of one flight both series are equal but
//! for the clock; of two flights, even along the same trajectory, they differ by wind, noise and control.

use super::Grid;
use super::align::attitudes_onto;
use super::select::{best, mean_rate_hz};
use crate::recording::{Quantity, Recording, Stream};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::ops::Range;

/// The clock of a second log of a flight, against that of the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockOffset {
    /// s by which the second log's stamps are late, at [`Self::at_s`]
    pub late_s: f64,
    /// its standard error, s
    pub std_s: f64,
    /// s on the second log's clock
    pub at_s: f64,
    /// s by which they become later each second; 0 where that is not significant
    pub drift: f64,
}

impl ClockOffset {
    /// An instant of the second log (s) on the first one's clock (s).
    #[must_use]
    pub fn on_first(&self, time_s: f64) -> f64 {
        time_s - self.late_s - self.drift * (time_s - self.at_s)
    }
}

/// Step of the coarse search, s. Half of what the fine search covers.
const COARSE_S: f64 = 0.2;
/// Step of the grid that interpolates the faster attitude, s.
const FINE_S: f64 = 0.005;
/// Least number of coarse steps that both logs must cover (10 s), beside half of the shorter one.
const LEAST_STEPS: usize = 50;
/// Largest share of the attitude's variance by which two logs of one flight differ. Measured with both logs of flights of both
/// autopilots' simulators: at most 6e-6 for the same flight, at least 1.5e-2 for the same trajectory flown twice.
/// Logs of the embedded vehicle have noise of their own each: at most 1e-3.
const MOST_DIFFERENT: f64 = 3e-3;
/// The same of the tilt alone: turns about the vertical that two plans have in common make up most of the attitude's variance and hide that
/// the tilts are others. Of two plans it is one to two; logs of one flight that have noise of their own each differ by a few hundredths
/// in a hover. Set by judgement.
const MOST_OTHER_TILT: f64 = 0.1;
/// Parts of the flight in which the offset is found again, for its standard error and its drift.
const PARTS: usize = 8;

/// How the clock of `second` differs from that of `first`, if both hold the same flight; `None` if they do not, or if one has
/// no attitude.
#[must_use]
pub fn clock_offset(first: &Recording, second: &Recording) -> Option<ClockOffset> {
    let attitude = |recording| best(recording, Quantity::Attitude, |stream| stream.width == 4);
    let (first, second) = (attitude(first)?.1, attitude(second)?.1);
    // the faster one is interpolated
    if mean_rate_hz(second) >= mean_rate_hz(first) {
        let Line { late_s, std_s, at_s, drift } = lateness(first, second)?;
        return Some(ClockOffset { late_s, std_s, at_s: at_s + late_s, drift });
    }
    let Line { late_s, std_s, at_s, drift } = lateness(second, first)?;
    Some(ClockOffset { late_s: -late_s, std_s, at_s, drift: -drift })
}

/// By how much the stamps of `fast` are late against those of `slow`.
fn lateness(slow: &Stream, fast: &Stream) -> Option<Line> {
    let mut late_s = coarse(slow, fast)?;
    let (from_s, to_s) = (*fast.time_s.first()? - late_s, *fast.time_s.last()? - late_s);
    let inside = slow.time_s.partition_point(|time_s| *time_s < from_s)
        ..slow.time_s.partition_point(|time_s| *time_s <= to_s);
    let wanted = Samples {
        axes: inside.clone().map(|index| axes_of(slow.sample(index))).collect::<Option<_>>()?,
        time_s: slow.time_s.get(inside)?,
    };
    let fine = Fine::of(fast)?;
    // two coarse steps to each side, in tenths of a step
    let near = (-20..=20).map(|tenth| late_s + f64::from(tenth) * 0.1 * COARSE_S);
    let rated = near.map(|late_s| (wanted.difference(&fine, late_s), late_s));
    late_s = rated.min_by(|a, b| a.0.total_cmp(&b.0))?.1;
    for _ in 0..20 {
        let step_s = wanted.further_lateness(&fine, late_s, 0..wanted.time_s.len())?.0;
        late_s += step_s.clamp(-0.1 * COARSE_S, 0.1 * COARSE_S);
        if step_s.abs() < 1e-6 {
            break;
        }
    }
    let difference = wanted.difference(&fine, late_s);
    let is_same = difference <= MOST_DIFFERENT && wanted.tilt_difference(&fine, late_s) <= MOST_OTHER_TILT;
    if !is_same {
        return None;
    }
    let count = wanted.time_s.len();
    let parts: Vec<Part> = (0..PARTS)
        .filter_map(|part| {
            let range = part * count / PARTS..(part + 1) * count / PARTS;
            let at_s = *wanted.time_s.get(range.start.midpoint(range.end))?;
            let (step_s, weight) = wanted.further_lateness(&fine, late_s, range)?;
            Some(Part { at_s, step_s, weight })
        })
        .collect();
    line(&parts, late_s)
}

/// A part of the flight.
struct Part {
    /// its middle, s on the slow stream's clock
    at_s: f64,
    /// by how much later than in the whole the fast stream must be read, s
    step_s: f64,
    /// by least squares
    weight: f64,
}

/// Lateness along the flight.
struct Line {
    /// s, at `at_s`
    late_s: f64,
    std_s: f64,
    /// s on the slow stream's clock
    at_s: f64,
    /// s each second
    drift: f64,
}

/// Weighted regression over the parts; without parts `None`. Of fewer than three, or of parts at one instant, no drift is
/// known, and the offset is not known better than to a step of the grid.
fn line(parts: &[Part], late_s: f64) -> Option<Line> {
    let total: f64 = parts.iter().map(|part| part.weight).sum();
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    let mean =
        |of: &dyn Fn(&Part) -> f64| parts.iter().map(|part| part.weight * of(part)).sum::<f64>() / total;
    let (at_s, more_s) = (mean(&|part| part.at_s), mean(&|part| part.step_s));
    let spread = mean(&|part| (part.at_s - at_s).powi(2));
    if parts.len() < 3 || spread.is_nan() || spread <= 0.0 {
        let scatter = mean(&|part| (part.step_s - more_s).powi(2)).sqrt();
        return Some(Line { late_s: late_s + more_s, std_s: scatter.max(FINE_S), at_s, drift: 0.0 });
    }
    let slope = mean(&|part| (part.at_s - at_s) * (part.step_s - more_s)) / spread;
    let left = mean(&|part| (part.step_s - more_s - slope * (part.at_s - at_s)).powi(2));
    let free = parts.len() as f64 - 2.0;
    let (std_s, slope_std) = ((left / free).sqrt(), (left / free / spread).sqrt());
    let drift = if slope.abs() > 4.0 * slope_std { slope } else { 0.0 };
    Some(Line { late_s: late_s + more_s, std_s, at_s, drift })
}

/// North and up in the body's axes: what an attitude does to two directions.
type Axes = [Vector3<f64>; 2];

fn in_body(attitude: &UnitQuaternion<f64>) -> Axes {
    [Vector3::x(), Vector3::z()].map(|axis| attitude.inverse_transform_vector(&axis))
}

fn axes(attitude: &Stream, grid: &Grid) -> Option<Vec<Axes>> {
    Some(attitudes_onto(attitude, 0.0, grid)?.iter().map(in_body).collect())
}

/// Of one sample, a quaternion w x y z; `None` if it is damaged.
fn axes_of(sample: &[f64]) -> Option<Axes> {
    let &[w, x, y, z] = sample else { return None };
    let attitude = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-3)?;
    Some(in_body(&attitude)).filter(|axes| axes[0].x.is_finite())
}

fn squared(a: &Axes, b: &Axes) -> f64 {
    (a[0] - b[0]).norm_squared() + (a[1] - b[1]).norm_squared()
}

fn mean(axes: &[Axes]) -> Axes {
    let count = axes.len().max(1) as f64;
    [0, 1].map(|axis| axes.iter().map(|axes| axes[axis]).sum::<Vector3<f64>>() / count)
}

/// Lateness of `second`, s, that leaves least of the attitude's variance, in steps of [`COARSE_S`].
fn coarse(first: &Stream, second: &Stream) -> Option<f64> {
    let grid_of = |stream: &Stream| {
        let (from_s, to_s) = (*stream.time_s.first()?, *stream.time_s.last()?);
        (to_s > from_s).then(|| Grid::covering(from_s, to_s, COARSE_S))
    };
    let (of_first, of_second) = (grid_of(first)?, grid_of(second)?);
    let (a, b) = (axes(first, &of_first)?, axes(second, &of_second)?);
    let shorter = a.len().min(b.len());
    let least = LEAST_STEPS.max(shorter / 2);
    if shorter < least {
        return None;
    }
    // the first steps of each that the other does not have
    let b_first = (1..b.len().saturating_sub(least) + 1).map(|j| (0, j));
    let a_first = (0..a.len().saturating_sub(least) + 1).map(|i| (i, 0));
    let (_, (i, j)) = a_first
        .chain(b_first)
        .filter_map(|(i, j)| {
            let count = (a.len() - i).min(b.len() - j);
            let (a, b) = (&a[i..i + count], &b[j..j + count]);
            let center = mean(a);
            let moved: f64 = a.iter().map(|a| squared(a, &center)).sum();
            let differs: f64 = a.iter().zip(b).map(|(a, b)| squared(a, b)).sum();
            (moved > 0.0).then(|| (differs / moved, (i, j)))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(of_second.time_s(j) - of_first.time_s(i))
}

/// An attitude between its samples.
struct Fine {
    /// s, [`FINE_S`] apart
    time_s: Vec<f64>,
    axes: Vec<Axes>,
}

impl Fine {
    fn of(stream: &Stream) -> Option<Self> {
        let grid = Grid::covering(*stream.time_s.first()?, *stream.time_s.last()?, FINE_S);
        Some(Self {
            axes: axes(stream, &grid)?,
            time_s: (0..grid.count).map(|index| grid.time_s(index)).collect(),
        })
    }

    /// Value and slope (1/s) at an instant, s; `None` outside.
    fn at(&self, time_s: f64) -> Option<(Axes, Axes)> {
        let left = self.time_s.partition_point(|at_s| *at_s <= time_s).checked_sub(1)?;
        let (from, to) = (self.axes.get(left)?, self.axes.get(left + 1)?);
        let share = (time_s - self.time_s[left]) / FINE_S;
        let value = [0, 1].map(|axis| from[axis].lerp(&to[axis], share));
        Some((value, [0, 1].map(|axis| (to[axis] - from[axis]) / FINE_S)))
    }
}

/// An attitude at its own samples.
struct Samples<'a> {
    /// s
    time_s: &'a [f64],
    axes: Vec<Axes>,
}

impl Samples<'_> {
    /// Each sample of a range that `fine`, read later by `late_s`, has as well: its value, and value and slope there.
    fn both<'a>(
        &'a self,
        fine: &'a Fine,
        late_s: f64,
        range: Range<usize>,
    ) -> impl Iterator<Item = (&'a Axes, Axes, Axes)> {
        range.filter_map(move |index| {
            let (value, slope) = fine.at(self.time_s[index] + late_s)?;
            Some((&self.axes[index], value, slope))
        })
    }

    /// Share of the variance by which they differ.
    fn difference(&self, fine: &Fine, late_s: f64) -> f64 {
        let center = mean(&self.axes);
        let both = || self.both(fine, late_s, 0..self.axes.len());
        let moved: f64 = both().map(|(wanted, ..)| squared(wanted, &center)).sum();
        both().map(|(wanted, found, _)| squared(wanted, &found)).sum::<f64>() / moved
    }

    /// Share of the tilt's variance by which they differ.
    fn tilt_difference(&self, fine: &Fine, late_s: f64) -> f64 {
        let tilt = |axes: &Axes| axes[1];
        let center = mean(&self.axes)[1];
        let both = || self.both(fine, late_s, 0..self.axes.len());
        let moved: f64 = both().map(|(wanted, ..)| (tilt(wanted) - center).norm_squared()).sum();
        both().map(|(wanted, found, _)| (tilt(wanted) - tilt(&found)).norm_squared()).sum::<f64>() / moved
    }

    /// By how much later still, s, the other must be read (Gauss-Newton), and the weight of that.
    fn further_lateness(&self, fine: &Fine, late_s: f64, range: Range<usize>) -> Option<(f64, f64)> {
        let (mut along, mut weight) = (0.0, 0.0);
        for (wanted, found, slope) in self.both(fine, late_s, range) {
            for axis in 0..2 {
                along += slope[axis].dot(&(wanted[axis] - found[axis]));
                weight += slope[axis].norm_squared();
            }
        }
        (weight > 0.0).then(|| (along / weight, weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(at_s: f64, step_s: f64) -> Part {
        Part { at_s, step_s, weight: 2.0 }
    }

    #[test]
    fn a_line_through_too_few_parts_has_no_drift() {
        for parts in [&[part(3.0, 0.001)][..], &[part(3.0, 0.001), part(5.0, 0.001)]] {
            let line = line(parts, 0.5).unwrap();
            assert!((line.late_s - 0.501).abs() < 1e-12);
            assert_eq!((line.std_s, line.drift), (FINE_S, 0.0));
        }
        let at_one = [0.0, 0.0, 0.0].map(|more_s| part(3.0, more_s));
        assert_eq!(line(&at_one, 0.5).map(|line| (line.drift, line.std_s)), Some((0.0, FINE_S)));
        assert!(line(&[], 0.5).is_none());
    }

    /// Attitudes at 50 Hz that turn by 180 degrees and tilt by 3 degrees about x at `tilt_hz`.
    fn turning(tilt_hz: f64) -> Stream {
        let time_s: Vec<f64> = (0..1000).map(|index| 0.02 * f64::from(index)).collect();
        let of = |time_s: &f64| {
            let tilt = 0.03 * (std::f64::consts::TAU * tilt_hz * time_s).sin();
            let attitude = UnitQuaternion::from_euler_angles(tilt, 0.0, 0.157 * time_s);
            [attitude.w, attitude.i, attitude.j, attitude.k]
        };
        let values = time_s.iter().flat_map(of).collect();
        Stream { time_s, width: 4, values }
    }

    #[test]
    fn the_same_turn_with_other_tilts_is_another_flight() {
        assert!(lateness(&turning(0.3), &turning(0.3)).is_some());
        let (slow, other) = (turning(0.3), turning(0.47));
        let samples = Samples {
            time_s: &slow.time_s,
            axes: (0..slow.len()).map(|index| axes_of(slow.sample(index)).unwrap()).collect(),
        };
        // the turn alone would have called them one flight
        assert!(samples.difference(&Fine::of(&other).unwrap(), 0.0) < MOST_DIFFERENT);
        assert!(lateness(&slow, &other).is_none());
    }

    /// Least squares through (0, 0), (1, 0), (2, 3) by hand: mean 1, slope 1.5, what is left 0.5, -1, 0.5.
    #[test]
    fn a_line_through_three_parts_is_that_of_least_squares() {
        let line = line(&[part(0.0, 0.0), part(1.0, 0.0), part(2.0, 3.0)], 0.5).unwrap();
        assert_eq!((line.late_s, line.at_s), (1.5, 1.0));
        assert!((line.std_s - 0.5_f64.sqrt()).abs() < 1e-12);
        // 1.5 is less than four times sqrt(0.5 / (2 / 3))
        assert_eq!(line.drift, 0.0);
    }
}
