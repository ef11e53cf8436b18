//! Whether the inertia depends on the window of the weak form.
//!
//! The torque that causes a motion is in proportion to the angular acceleration at every frequency. Where control answers the
//! motion that something else causes, torque and motion are in another proportion at each frequency, often with the wrong sign.
//! A window of twice the width weighs lower frequencies, so a comparison of both tells the two apart.

use super::theta::{MOMENTS, Theta};
use super::weak::{WeakEstimate, solve_weak};
use crate::regression::{WeakMotion, WeakRows, weak_rows};
use crate::signals::{Signals, WeakKernel};
use rayon::prelude::*;

/// How rows of a wider window are made.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wider {
    /// s, of the usual window
    pub(super) half_width_s: f64,
    pub(super) gravity_m_s2: f64,
    /// the gyroscopic torques have coefficients of their own
    pub(super) frees_gyroscopic: bool,
}

/// Ixx, Iyy, Izz by a window of twice the half width, as shares of those of `narrow`, from the same signals; NaN where either
/// has none, also if no stretch of flight is long enough for that window.
pub(super) fn by_wider_window(
    flights: &[Signals],
    (narrow, nominal): (&WeakEstimate, &Theta),
    of: Wider,
) -> [f64; 3] {
    let rows: Vec<WeakRows> = flights
        .par_iter()
        .map(|signals| {
            let kernel = WeakKernel::new(2.0 * of.half_width_s, signals.grid.step_s);
            let motion = WeakMotion::measured(signals, &kernel, of.gravity_m_s2);
            let mut rows = weak_rows(signals, &motion, &kernel);
            if of.frees_gyroscopic {
                rows.free_gyroscopic_torque();
            }
            rows
        })
        .collect();
    let wide = solve_weak(&rows, nominal);
    MOMENTS.map(|index| wide.as_ref().map_or(f64::NAN, |wide| wide.theta[index] / narrow.theta[index]))
}
