//! A regressor by what its entries are made of: of 28 entries, ten numbers.

use super::filtered::RATE_PAIRS;
#[cfg(test)]
use super::filtered::{gyroscopic_regressor, momentum_regressor};
use crate::signals::{FilterPair, PairMemory};
use nalgebra::{SMatrix, Vector3};

/// `Phi` of (12), or what a filter made of it: rows Fz, torques (N, N m); columns m (kg), Ixx, Ixy, Ixz, Iyy, Iyz, Izz
/// (kg m^2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phi {
    /// what the mass is multiplied by, m/s^2
    vertical: f64,
    /// p', q', r', rad/s^2
    turning: [f64; 3],
    /// pq, pr, qr, rad^2/s^2
    mixed: [f64; 3],
    /// qq - rr, rr - pp, pp - qq, rad^2/s^2
    squares: [f64; 3],
}

impl Phi {
    /// Of a specific force along body z (`w' + p v - q u + g_bz`, m/s^2), body rates (rad/s) and their derivative (rad/s^2).
    #[must_use]
    pub fn of(vertical: f64, omega: &Vector3<f64>, omega_dot: &Vector3<f64>) -> Self {
        let (mixed, squares) = products(omega);
        Self { vertical, turning: (*omega_dot).into(), mixed, squares }
    }

    /// All entries.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<f64, 4, 7> {
        let ([dp, dq, dr], [pq, pr, qr]) = (self.turning, self.mixed);
        let [about_x, about_y, about_z] = self.squares;
        #[rustfmt::skip]
        let phi = SMatrix::<f64, 4, 7>::from_row_slice(&[
            self.vertical, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
            0.0, dp, dq - pr, dr + pq, -qr, about_x, qr,
            0.0, pr, dp + qr, about_y, dq, dr - pq, -pr,
            0.0, -pq, about_z, dp - qr, pq, dq + pr, dr,
        ]);
        phi
    }
}

/// Products of two rates, and differences of their squares, in the order of [`Phi`].
fn products(omega: &Vector3<f64>) -> ([f64; 3], [f64; 3]) {
    let [pp, qq, rr, pq, pr, qr] = RATE_PAIRS.map(|(i, j)| omega[i] * omega[j]);
    ([pq, pr, qr], [qq - rr, rr - pp, pp - qq])
}

/// `g_D Phi_a + f_D Phi_b` instant by instant: the filtered regressor (37).
pub(super) struct FilteredPhi {
    pair: FilterPair,
    momentum: [PairMemory; 4],
    rest: [PairMemory; 7],
}

impl FilteredPhi {
    pub(super) fn new(pair: FilterPair) -> Self {
        Self { pair, momentum: [PairMemory::default(); 4], rest: [PairMemory::default(); 7] }
    }

    /// Of the next instant: w (m/s), `p v - q u + g_bz` (m/s^2), body rates (rad/s).
    pub(super) fn next(&mut self, w: f64, rest: f64, omega: &Vector3<f64>) -> Phi {
        let pair = self.pair;
        let [of_w, turning @ ..] = &mut self.momentum;
        let [of_rest, of_products @ ..] = &mut self.rest;
        let (mixed, squares) = products(omega);
        let mut low = |from: usize, values: [f64; 3]| {
            std::array::from_fn(|i| pair.step_low_pass(&mut of_products[from + i], values[i]))
        };
        Phi {
            vertical: pair.step_rate(of_w, w) + pair.step_low_pass(of_rest, rest),
            mixed: low(0, mixed),
            squares: low(3, squares),
            turning: std::array::from_fn(|i| pair.step_rate(&mut turning[i], omega[i])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filtered_it_is_each_entry_filtered() {
        let pair = FilterPair::new(FilterPair::PAPER_LAMBDA_RAD_S, 0.01);
        let mut filtered = FilteredPhi::new(pair);
        let mut memories = [[PairMemory::default(); 2]; 28];
        for s in (0..20).map(f64::from) {
            let omega = Vector3::new((0.7 * s).sin(), 0.3 - 0.1 * s, (1.3 * s).cos());
            let (w, rest) = (0.3 * s, 9.7 - 0.02 * s);
            let (momentum, gyroscopic) = (momentum_regressor(w, &omega), gyroscopic_regressor(rest, &omega));
            let each = memories.iter_mut().enumerate().map(|(entry, [of_momentum, of_rest])| {
                pair.step_rate(of_momentum, momentum[entry]) + pair.step_low_pass(of_rest, gyroscopic[entry])
            });
            let expected = SMatrix::<f64, 4, 7>::from_iterator(each);
            assert_eq!(filtered.next(w, rest, &omega).matrix(), expected);
        }
    }
}
