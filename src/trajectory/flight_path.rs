//! A whole flight's reference: pieces flown one after the other.

use super::{CirclePath, FourierTrajectory};

/// A polynomial of seventh degree an axis: position, velocity, acceleration and jerk are prescribed at
/// both ends, so that rates and thrust go over without a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    /// coefficients of `(t / duration)^k`, k = 0..7, for x, y, z (m) and psi (rad)
    coefficients: [[f64; 8]; 4],
    duration_s: f64,
}

/// Value and first three derivatives of x, y, z (m) and psi (rad), world NWU.
pub type EndState = [[f64; 4]; 4];

/// At rest at a place.
#[must_use]
pub fn at_rest(place: [f64; 4]) -> EndState {
    place.map(|value| [value, 0.0, 0.0, 0.0])
}

/// The state of a path at one instant, as far as a transition needs it.
#[must_use]
pub fn end_state(path: &[[f64; 5]; 4]) -> EndState {
    path.map(|axis| [axis[0], axis[1], axis[2], axis[3]])
}

impl Transition {
    /// From one state to another in `duration_s`.
    #[must_use]
    pub fn new(from: &EndState, to: &EndState, duration_s: f64) -> Self {
        let coefficients = std::array::from_fn(|axis| septic(&from[axis], &to[axis], duration_s));
        Self { coefficients, duration_s }
    }

    fn derivatives(&self, t_s: f64) -> [[f64; 5]; 4] {
        let s = t_s / self.duration_s;
        self.coefficients.map(|coefficients| {
            let mut out = [0.0; 5];
            let mut scale = 1.0;
            for (order, value) in out.iter_mut().enumerate() {
                *value = derivative(&coefficients, order, s) / scale;
                scale *= self.duration_s;
            }
            out
        })
    }
}

/// Derivative number `order` of `sum c_k s^k`.
fn derivative(coefficients: &[f64; 8], order: usize, s: f64) -> f64 {
    let mut sum = 0.0;
    for k in (order..8).rev() {
        let falling: f64 = (0..order).map(|j| (k - j) as f64).product();
        sum = sum * s + falling * coefficients[k];
    }
    sum
}

/// The septic with these values and three derivatives at s = 0 and s = 1, `s = t / duration`.
fn septic(from: &[f64; 4], to: &[f64; 4], duration: f64) -> [f64; 8] {
    let scaled = |state: &[f64; 4]| {
        [state[0], state[1] * duration, state[2] * duration.powi(2), state[3] * duration.powi(3)]
    };
    let ([p0, v0, a0, j0], [p1, v1, a1, j1]) = (scaled(from), scaled(to));
    let (c0, c1, c2, c3) = (p0, v0, 0.5 * a0, j0 / 6.0);
    // what the upper four coefficients still have to bring at s = 1
    let p = p1 - (c0 + c1 + c2 + c3);
    let v = v1 - (c1 + 2.0 * c2 + 3.0 * c3);
    let a = a1 - (2.0 * c2 + 6.0 * c3);
    let j = j1 - 6.0 * c3;
    [
        c0,
        c1,
        c2,
        c3,
        35.0 * p - 15.0 * v + 2.5 * a - j / 6.0,
        -84.0 * p + 39.0 * v - 7.0 * a + 0.5 * j,
        70.0 * p - 34.0 * v + 6.5 * a - 0.5 * j,
        -20.0 * p + 10.0 * v - 2.0 * a + j / 6.0,
    ]
}

/// What is flown in one piece of a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Segment {
    /// stay at x, y, z (m), psi (rad)
    Hold([f64; 4]),
    /// go over between two states
    Transition(Transition),
    /// the series (18), repeated
    Fourier(FourierTrajectory),
    /// a circle (44)
    Circle(CirclePath),
}

impl Segment {
    /// For x, y, z, psi, `t_s` after the segment's start: value and first four derivatives.
    #[must_use]
    pub fn derivatives(&self, t_s: f64) -> [[f64; 5]; 4] {
        match self {
            Self::Hold(place) => place.map(|value| [value, 0.0, 0.0, 0.0, 0.0]),
            Self::Transition(transition) => transition.derivatives(t_s),
            Self::Fourier(series) => series.derivatives(t_s),
            Self::Circle(circle) => circle.derivatives(t_s),
        }
    }
}

/// Segments with their durations (s), flown in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightPath {
    /// what, and for how many seconds
    pub segments: Vec<(Segment, f64)>,
}

impl FlightPath {
    /// From the first segment's start to the last one's end, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.segments.iter().map(|(_, duration)| duration).sum()
    }

    /// For x, y, z, psi at `t_s` from the start: value and first four derivatives. Beyond the end the
    /// last segment's end; `None` for a path without segments.
    #[must_use]
    pub fn derivatives(&self, t_s: f64) -> Option<[[f64; 5]; 4]> {
        let mut begin = 0.0;
        for (segment, duration) in &self.segments {
            if t_s < begin + duration {
                return Some(segment.derivatives((t_s - begin).max(0.0)));
            }
            begin += duration;
        }
        self.segments.last().map(|(segment, duration)| segment.derivatives(*duration))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transition_meets_both_states() {
        let from = [[0.3, -0.1, 0.2, 0.5], [0.0; 4], [1.0, 0.4, 0.0, -2.0], [0.1, 0.0, 0.0, 0.0]];
        let to = [[1.3, 0.7, -0.2, 0.9], [2.0, 0.0, 0.0, 0.0], [0.2, 0.0, 1.0, 0.0], [0.0, 0.3, 0.0, 0.4]];
        let transition = Transition::new(&from, &to, 2.5);
        let ends = [(0.0, from), (2.5, to)];
        for (t, state) in ends {
            let path = transition.derivatives(t);
            for axis in 0..4 {
                for order in 0..4 {
                    assert!((path[axis][order] - state[axis][order]).abs() < 1e-11);
                }
            }
        }
        let h = 1e-4;
        let (before, now, after) =
            (transition.derivatives(1.2 - h), transition.derivatives(1.2), transition.derivatives(1.2 + h));
        for order in 0..4 {
            let numeric = (after[0][order] - before[0][order]) / (2.0 * h);
            assert!((numeric - now[0][order + 1]).abs() < 1e-5);
        }
    }

    #[test]
    fn segments_follow_each_other() {
        let path = FlightPath {
            segments: vec![
                (Segment::Hold([1.0, 0.0, 0.0, 0.0]), 2.0),
                (Segment::Hold([2.0, 0.0, 0.0, 0.0]), 3.0),
            ],
        };
        assert_eq!(path.duration_s(), 5.0);
        let x = |t: f64| path.derivatives(t).unwrap()[0][0];
        assert_eq!((x(1.9), x(2.0), x(9.0)), (1.0, 2.0, 2.0));
        assert!(FlightPath::default().derivatives(0.0).is_none());
    }
}
