//! Flights as rows of the weak form, with their commands' latency taken out.

use super::compensate::{as_stated, compensation, take_out};
use super::plausible::{FlightApart, flights_apart};
use super::result::Estimated;
use super::theta::Theta;
use super::weak::{Latency, WeakEstimate, latency, solve_weak};
use super::window::{Wider, by_wider_window};
use crate::physics::ActuationLatency;
use crate::regression::{WeakMotion, WeakRows, weak_rows};
use crate::signals::{Signals, WeakKernel};
use crate::vehicle::{Guessed, Vehicle};
use rayon::prelude::*;

/// The flights as rows of the weak form.
pub(super) struct WeakFlights {
    pub(super) signals: Vec<Signals>,
    kernels: Vec<WeakKernel>,
    motions: Vec<WeakMotion>,
    pub(super) rows: Vec<WeakRows>,
    pub(super) accelerometer_bias: Vec<Option<f64>>,
    gravity_m_s2: f64,
    /// the moments that the gyroscopic torques show are not on the scale of a guess
    pub(super) frees_gyroscopic: bool,
}

impl WeakFlights {
    pub(super) fn from(flights: &[Signals], vehicle: &Vehicle, half_width_s: f64) -> Self {
        let signals = flights.to_vec();
        let gravity_m_s2 = vehicle.gravity_m_s2;
        let kernels: Vec<WeakKernel> =
            signals.iter().map(|s| WeakKernel::new(half_width_s, s.grid.step_s)).collect();
        let each = signals.par_iter().zip(&kernels);
        let motions: Vec<WeakMotion> = each.map(|(s, k)| WeakMotion::measured(s, k, gravity_m_s2)).collect();
        let accelerometer_bias =
            motions.iter().map(|m| m.vertical.as_ref().and_then(|v| v.accelerometer_bias)).collect();
        let guesses = vehicle.guessed(Guessed::TorqueRatio) > 0.0 || vehicle.guessed(Guessed::Arms) > 0.0;
        let mut all = Self {
            signals,
            kernels,
            motions,
            rows: Vec::new(),
            accelerometer_bias,
            gravity_m_s2,
            frees_gyroscopic: guesses,
        };
        all.refresh();
        all
    }

    fn refresh(&mut self) {
        self.rows = self
            .signals
            .par_iter()
            .zip(&self.motions)
            .zip(&self.kernels)
            .map(|((signals, motion), kernel)| weak_rows(signals, motion, kernel))
            .collect();
        if self.frees_gyroscopic {
            self.rows.iter_mut().for_each(WeakRows::free_gyroscopic_torque);
        }
    }

    /// Estimates the latency with the original commands and corrects the commands for it, so that every method uses the
    /// wrench on the body.
    pub(super) fn compensate(
        &mut self,
        nominal: &Theta,
        vehicle: &Vehicle,
    ) -> (Option<Latency>, ActuationLatency) {
        let Some(found) = latency(&self.rows, nominal) else { return (None, ActuationLatency::default()) };
        let told = found.total_s.abs() > 4.0 * found.std_s && found.total_s.abs() < 0.3;
        let compensation =
            if told { compensation(&found, vehicle) } else { as_stated(&found, vehicle, &self.signals) };
        if compensation.total_s() == 0.0 {
            return (Some(found), compensation);
        }
        self.signals.par_iter_mut().for_each(|signals| take_out(signals, vehicle, compensation));
        self.refresh();
        (Some(found), compensation)
    }

    /// The flights whose masses or moments of inertia contradict those of the first one, each by its rows alone.
    pub(super) fn flights_apart(&self, nominal: &Theta, half_width_s: f64) -> Vec<FlightApart> {
        if self.rows.len() < 2 {
            return Vec::new();
        }
        let alone = |rows: &WeakRows| solve_weak(std::slice::from_ref(rows), nominal);
        let found: Vec<Option<WeakEstimate>> = self.rows.par_iter().map(alone).collect();
        let each: Vec<Option<Estimated>> =
            found.iter().map(|found| found.as_ref().map(Estimated::of)).collect();
        if flights_apart(&each).is_empty() {
            return Vec::new();
        }
        // the wider window costs as much again
        let assessed = |(signals, found): (&Signals, &Option<WeakEstimate>)| {
            let found = found.as_ref()?;
            let wider =
                by_wider_window(std::slice::from_ref(signals), (found, nominal), self.wider(half_width_s));
            Some(Estimated::of(found).with_wider_window(wider))
        };
        flights_apart(&self.signals.par_iter().zip(&found).map(assessed).collect::<Vec<_>>())
    }

    /// Moments of inertia by a window of twice the width, as shares of those of `narrow`.
    pub(super) fn by_wider_window(
        &self,
        narrow: &WeakEstimate,
        nominal: &Theta,
        half_width_s: f64,
    ) -> [f64; 3] {
        by_wider_window(&self.signals, (narrow, nominal), self.wider(half_width_s))
    }

    fn wider(&self, half_width_s: f64) -> Wider {
        let Self { gravity_m_s2, frees_gyroscopic, .. } = *self;
        Wider { half_width_s, gravity_m_s2, frees_gyroscopic }
    }
}
