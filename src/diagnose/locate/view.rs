//! A fit's residual row by row, with the states on which it may depend.

use super::super::channels::{AXES, CHANNELS, SECOND};
use super::super::fit::Fitted;
use super::super::followed::Followed;
use super::super::harmonics::flown_period_s;
use super::super::trace::Trace;
use crate::signals::{WeakKernel, central_difference};
use crate::stats::median_step;
use crate::vehicle::Guessed;
use nalgebra::Vector3;
use std::ops::Range;

/// Length of a replicate if the flight does not repeat, s. It is longer than the residual is correlated.
const BLOCK_S: f64 = 5.0;
/// Length of a replicate for slow states, s. Only what is shown depends on it.
const SHORT_BLOCK_S: f64 = 1.0;

/// Rows of all flights, one after the other.
#[derive(Debug)]
pub(super) struct View {
    /// s, vehicle clock of its flight
    pub(super) time_s: Vec<f64>,
    /// s between rows
    pub(super) step_s: f64,
    /// rows of each flight, and its period where it repeats (s)
    pub(super) flights: Vec<(Range<usize>, Option<f64>)>,
    /// rows without a break
    pub(super) runs: Vec<Range<usize>>,
    /// replicates: whole periods if the flight is periodic, otherwise blocks of some seconds
    pub(super) blocks: Vec<usize>,
    /// replicates for slow states
    pub(super) short_blocks: Vec<usize>,
    /// force and torque that the fit does not explain: N, N m; the force by its first measurement
    pub(super) residual: [Vec<f64>; AXES],
    /// the states that were measured and vary
    pub(super) states: Vec<(Followed, Vec<f64>)>,
    /// thrust of all rotors, N
    pub(super) thrust_n: Vec<f64>,
    /// force on world x, y, z, N; `None` without attitude
    pub(super) world_force_n: Option<[Vec<f64>; 3]>,
    /// first measurement of the force minus the second, on world x, y, z, N; `None` if there is only one
    pub(super) contradiction_n: Option<[Vec<f64>; 3]>,
    /// m/s rms, slow error of the horizontal velocity by satellite receivers: that of the flight with the greatest; 0 without one
    pub(super) velocity_error_m_s: f64,
    /// the commands are too far apart to tell torques, the shape of the thrust curve is a guess, or no velocity tells an error of the
    /// accelerometer from one of the thrust
    pub(super) thrust_is_unsure: bool,
    /// weak form's test function
    pub(super) kernel: WeakKernel,
    /// s, of the recordings' grid
    pub(super) grid_step_s: f64,
}

impl View {
    /// The view of a fit's residual; `None` without rows.
    pub(super) fn new(traces: &[Trace], fitted: &Fitted) -> Option<Self> {
        let first = traces.first()?;
        let rows = fitted.rows.len();
        let sigma = fitted.weighted.sigma;
        let left = &fitted.weighted.left;
        if rows < 2 || left.len() != CHANNELS * rows {
            return None;
        }
        let residual: [Vec<f64>; AXES] = std::array::from_fn(|channel| {
            left.rows(channel * rows, rows).iter().map(|value| value * sigma[channel]).collect()
        });
        let mut view = Self {
            time_s: fitted.rows.time_s.clone(),
            step_s: Some(median_step(&fitted.rows.time_s)).filter(|step_s| *step_s > 0.0)?,
            flights: Vec::new(),
            runs: fitted.rows.runs.clone(),
            blocks: Vec::with_capacity(rows),
            short_blocks: Vec::with_capacity(rows),
            residual,
            states: Vec::new(),
            thrust_n: Vec::with_capacity(rows),
            world_force_n: None,
            contradiction_n: None,
            velocity_error_m_s: traces.iter().filter_map(|of| of.velocity_error_m_s).fold(0.0, f64::max),
            thrust_is_unsure: traces.iter().any(|trace| !(trace.torques && trace.known.velocity))
                || fitted.base.vehicle.guessed(Guessed::Expo) > 0.0,
            kernel: first.kernel.clone(),
            grid_step_s: first.grid.step_s,
        };
        view.lay_out(traces);
        view.add_states(traces, fitted);
        view.world_force_n = in_world(traces, |axis, row| view.residual[axis][row]);
        if traces.iter().all(Trace::reads_force_twice) {
            let second = |axis: usize, row: usize| left[(SECOND + axis) * rows + row] * sigma[SECOND + axis];
            view.contradiction_n = in_world(traces, |axis, row| view.residual[axis][row] - second(axis, row));
        }
        Some(view)
    }

    /// Flights, periods and replicates.
    fn lay_out(&mut self, traces: &[Trace]) {
        let mut from = 0;
        for trace in traces {
            let rows = from..from + trace.rows();
            let time_s = &self.time_s[rows.clone()];
            let period_s = flown_period_s(trace, time_s);
            let last_s = time_s.last().copied().unwrap_or(0.0);
            // whole periods from the end: the beginning may hold the way to the start
            let lengths =
                [(&mut self.blocks, period_s.unwrap_or(BLOCK_S)), (&mut self.short_blocks, SHORT_BLOCK_S)];
            for (blocks, length_s) in lengths {
                let mut block = blocks.last().map_or(0, |last| last + 1);
                let mut end_s = last_s + 1e-6;
                while end_s - length_s > time_s.first().copied().unwrap_or(0.0) {
                    end_s -= length_s;
                }
                for time in time_s {
                    while *time > end_s {
                        end_s += length_s;
                        block += 1;
                    }
                    blocks.push(block);
                }
            }
            self.flights.push((rows.clone(), period_s));
            from = rows.end;
        }
    }

    fn add_states(&mut self, traces: &[Trace], fitted: &Fitted) {
        let known = |what: fn(&Trace) -> bool| traces.iter().all(what);
        let (position, attitude) = (known(|t| t.known.position), known(|t| t.known.attitude));
        let air = attitude && known(|t| t.known.velocity);
        let wind_m_s = fitted.base.wind_m_s();
        let mut add = |state: Followed, value: &dyn Fn(&Trace, usize) -> f64| {
            let values: Vec<f64> = traces
                .iter()
                .flat_map(|trace| trace.centers.iter().map(move |&center| value(trace, center)))
                .collect();
            self.states.push((state, values));
        };
        if position {
            add(Followed::Altitude, &|t, i| t.states[i].position_m.z);
            add(Followed::WorldX, &|t, i| t.states[i].position_m.x);
            add(Followed::WorldY, &|t, i| t.states[i].position_m.y);
        }
        if air {
            let airspeed = |t: &Trace, i: usize| {
                let state = &t.states[i];
                state.attitude.inverse_transform_vector(&(state.velocity_m_s - wind_m_s))
            };
            for axis in 0..3 {
                add(Followed::Airspeed(axis), &|t, i| airspeed(t, i)[axis]);
            }
            add(Followed::Speed, &|t, i| airspeed(t, i).norm());
        }
        for axis in 0..3 {
            add(Followed::Rate(axis), &|t, i| t.states[i].rates_rad_s[axis]);
        }
        if attitude {
            add(Followed::YawSin, &|t, i| t.states[i].attitude.euler_angles().2.sin());
            add(Followed::YawCos, &|t, i| t.states[i].attitude.euler_angles().2.cos());
        }
        if known(|t| t.voltage_v.is_some()) {
            add(Followed::Voltage, &|t, i| t.voltage_v.as_ref().map_or(0.0, |voltage| voltage[i]));
        }
        add(Followed::Time, &|t, i| t.grid.time_s(i));
        self.add_rotors(traces, fitted);
        self.states.retain(|(_, values)| moves(values));
    }

    fn add_rotors(&mut self, traces: &[Trace], fitted: &Fitted) {
        let count = fitted.base.vehicle.rotors.len();
        let mut rotors: Vec<Vec<f64>> = vec![Vec::new(); count];
        let mut rate_n_s = Vec::new();
        for (flight, trace) in traces.iter().enumerate() {
            let Some(commanded) = fitted.rows.commanded(flight) else { return };
            let total: Vec<f64> = commanded.thrust_n.each().map(|thrusts| thrusts.iter().sum()).collect();
            let rate = central_difference(&total, trace.grid.step_s);
            for &center in &trace.centers {
                self.thrust_n.push(total[center]);
                rate_n_s.push(rate[center]);
                for (rotor, values) in rotors.iter_mut().enumerate() {
                    values.push(commanded.thrust_n.at(center)[rotor]);
                }
            }
        }
        self.states.push((Followed::Thrust, self.thrust_n.clone()));
        self.states.push((Followed::ThrustRate, rate_n_s));
        for (rotor, values) in rotors.into_iter().enumerate() {
            self.states.push((Followed::Rotor(rotor), values));
        }
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.time_s.len()
    }

    /// The period of the flight that a row belongs to, s.
    pub(super) fn period_s_at(&self, row: usize) -> Option<f64> {
        self.flights.iter().find(|(rows, _)| rows.contains(&row)).and_then(|(_, period_s)| *period_s)
    }
}

/// Rotates a force from body axes, given by axis and row, into the world; `None` without attitude.
fn in_world(traces: &[Trace], body_n: impl Fn(usize, usize) -> f64) -> Option<[Vec<f64>; 3]> {
    if !traces.iter().all(|trace| trace.known.attitude) {
        return None;
    }
    let mut world: [Vec<f64>; 3] = Default::default();
    let centers = traces.iter().flat_map(|trace| trace.centers.iter().map(move |&center| (trace, center)));
    for (row, (trace, center)) in centers.enumerate() {
        let force = trace.states[center].attitude * Vector3::from_fn(|axis, _| body_n(axis, row));
        world.iter_mut().zip(force.iter()).for_each(|(axis, value)| axis.push(*value));
    }
    Some(world)
}

fn moves(values: &[f64]) -> bool {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    values.iter().all(|v| v.is_finite()) && high - low > 1e-9 * high.abs().max(1e-6)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// One flight of 50 s whose force along z is the weak form of `force` (s to N), the rest zero, with one
    /// state.
    pub(in super::super) fn synthetic(
        force: impl Fn(usize, f64) -> f64,
        period_s: Option<f64>,
        state: (Followed, &dyn Fn(f64) -> f64),
    ) -> View {
        let grid_step_s = 0.008;
        let kernel = WeakKernel::new(0.2, grid_step_s);
        let series: Vec<f64> = (0..6250).map(|i| force(i, i as f64 * grid_step_s)).collect();
        let mask = vec![true; series.len()];
        let centers = kernel.centers(&mask, 6);
        let time_s: Vec<f64> = centers.iter().map(|&center| center as f64 * grid_step_s).collect();
        let rows = time_s.len();
        let mut residual: [Vec<f64>; AXES] = std::array::from_fn(|_| vec![0.0; rows]);
        residual[2] = kernel.apply(0, &series, &centers);
        let length_s = period_s.unwrap_or(BLOCK_S);
        let block = |length_s: f64| -> Vec<usize> {
            time_s
                .iter()
                .map(|t| (0..100_i32).take_while(|k| (f64::from(*k) + 1.0) * length_s <= *t).count())
                .collect()
        };
        View {
            step_s: 6.0 * grid_step_s,
            flights: vec![(0..rows, period_s)],
            runs: std::iter::once(0..rows).collect(),
            blocks: block(length_s),
            short_blocks: block(SHORT_BLOCK_S),
            residual,
            states: vec![
                (state.0, time_s.iter().map(|t| state.1(*t)).collect()),
                (Followed::Speed, time_s.iter().map(|t| (1.7 * t).sin().abs()).collect()),
            ],
            thrust_n: vec![10.0; rows],
            world_force_n: None,
            contradiction_n: None,
            velocity_error_m_s: 0.0,
            thrust_is_unsure: false,
            kernel,
            grid_step_s,
            time_s,
        }
    }

    /// White noise of unit variance, the same for the same index.
    pub(in super::super) fn white(seed: u64) -> Vec<f64> {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        (0..6250).map(|_| StandardNormal.sample(&mut rng)).collect()
    }
}
