//! Dormand and Prince's Runge-Kutta pair of orders 5 and 4 with step control
//! (J. Comput. Appl. Math. 6, 1980, table 2).

/// Nodes.
const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

/// Weights of earlier slopes in each stage; the last row is the fifth-order result.
const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Fifth order less fourth.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Error of one step per unit of `1 + |y|`.
const TOLERANCE: f64 = 1e-6;

/// Steps between two instants before the rest is taken in one go: a right side that is no number must not hang.
const STEPS_MAX: usize = 400;

/// Takes `state` from `from` to `to`, s; `step` is the step to begin with and becomes the next one's.
pub fn advance<const N: usize>(
    slope: impl Fn(f64, &[f64; N]) -> [f64; N],
    state: &mut [f64; N],
    (from, to): (f64, f64),
    step: &mut f64,
) {
    let mut time = from;
    for count in 0.. {
        let left = to - time;
        if left <= 1e-12 {
            return;
        }
        let last = count >= STEPS_MAX;
        let h = if last { left } else { step.min(left) };
        let (next, error) = tried(&slope, state, time, h);
        let grow = (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
        if error <= 1.0 || last {
            *state = next;
            time += h;
            // a step cut short by the end says nothing against a longer one
            *step = if h < *step { step.min(h * grow).max(h) } else { h * grow };
        } else {
            *step = h * grow.min(0.9);
        }
    }
}

/// One step: the fifth-order result and its error in units of what is tolerated.
fn tried<const N: usize>(
    slope: &impl Fn(f64, &[f64; N]) -> [f64; N],
    state: &[f64; N],
    time: f64,
    h: f64,
) -> ([f64; N], f64) {
    let mut slopes = [[0.0; N]; 7];
    let mut at = *state;
    for stage in 0..7 {
        at = *state;
        for (weight, slope) in A[stage].iter().zip(&slopes[..stage]).filter(|(weight, _)| **weight != 0.0) {
            at.iter_mut().zip(slope).for_each(|(at, slope)| *at += h * weight * slope);
        }
        slopes[stage] = slope(time + C[stage] * h, &at);
    }
    let mut sum = 0.0;
    for place in 0..N {
        let error: f64 = E.iter().zip(&slopes).map(|(weight, slope)| weight * slope[place]).sum();
        let scale = TOLERANCE * (1.0 + state[place].abs().max(at[place].abs()));
        sum += (h * error / scale).powi(2);
    }
    (at, (sum / N as f64).sqrt())
}
