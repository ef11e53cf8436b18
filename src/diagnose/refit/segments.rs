//! Segments of the flights and their simulation by the model.

use super::settings::RefitSettings;
use crate::diagnose::base::Base;
use crate::diagnose::rotors::RotorMotion;
use crate::diagnose::trace::Trace;
use crate::physics::{Input, Model, State};
use crate::signals::Grid;
use crate::simulate::{Plant, SimulateError};
use nalgebra::{DVector, UnitQuaternion, Vector3};

use super::error::RefitError;

/// Numbers of a state: velocity, rotation of the attitude, body rates. They are free at a node and compared at an
/// instant.
pub(super) const STATE: usize = 9;

/// A stretch of a flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) flight: usize,
    /// grid index of the node
    pub(super) start: usize,
    /// instants from one comparison to the next
    pub(super) every: usize,
    pub(super) comparisons: usize,
}

/// Cuts segments evenly over all usable stretches.
pub(super) fn cut(traces: &[Trace], settings: &RefitSettings) -> Vec<Segment> {
    let mut all = Vec::new();
    for (flight, trace) in traces.iter().enumerate() {
        let count = |time_s: f64| {
            (1..trace.grid.count).take_while(|n| *n as f64 * trace.grid.step_s <= time_s + 1e-9).count()
        };
        let every = count(settings.every_s).max(1);
        let comparisons = (count(settings.segment_s) / every).max(1);
        let length = every * comparisons;
        for run in Grid::runs(&trace.usable, length + 1) {
            let starts = (run.start..run.end - length).step_by(length);
            all.extend(starts.map(|start| Segment { flight, start, every, comparisons }));
        }
    }
    let keep = settings.most_segments.max(1);
    if all.len() <= keep {
        return all;
    }
    (0..keep).map(|index| all[index * all.len() / keep]).collect()
}

/// A base ready to be simulated along the flights.
pub(super) struct Shooter {
    model: Model,
    turning: Vec<RotorMotion>,
}

impl Shooter {
    pub(super) fn new(base: &Base, traces: &[Trace]) -> Result<Self, RefitError> {
        let model = base.model(&[])?;
        let turning = traces
            .iter()
            .map(|trace| {
                let felt = trace.felt_n(&model.airframe, base.latency);
                RotorMotion::new(felt, &model.airframe, trace.grid.step_s)
            })
            .collect();
        Ok(Self { model, turning })
    }

    /// The simulated states minus the measured ones at the segment's instants, from a node that is moved by `node` from
    /// the measured state.
    pub(super) fn residual(
        &self,
        trace: &Trace,
        segment: &Segment,
        node: &[f64; STATE],
    ) -> Result<DVector<f64>, SimulateError> {
        let start = moved(&trace.states[segment.start], node);
        let turning = &self.turning[segment.flight];
        let mut plant = Plant::new(&self.model, None, &start, &self.input(trace, turning, segment.start))?;
        let mut out = DVector::zeros(STATE * segment.comparisons);
        let end = segment.start + segment.every * segment.comparisons;
        let mut compared = 0;
        for index in segment.start..end {
            plant.step(&self.input(trace, turning, index), trace.grid.step_s);
            if (index + 1 - segment.start).is_multiple_of(segment.every) {
                let error = difference(&plant.state(), &trace.states[index + 1]);
                out.rows_mut(STATE * compared, STATE).copy_from_slice(&error);
                compared += 1;
            }
        }
        Ok(out)
    }

    /// Input from one instant to the next: the mean of both.
    fn input(&self, trace: &Trace, turning: &RotorMotion, index: usize) -> Input {
        let airframe = &self.model.airframe;
        let next = (index + 1).min(turning.thrust_n.len() - 1);
        let time_s = trace.grid.time_s(index) + 0.5 * trace.grid.step_s;
        let mut input = Input::from_commands(airframe, time_s, &[]);
        for rotor in 0..airframe.rotor_count() {
            let middle = f64::midpoint(turning.thrust_n[index][rotor], turning.thrust_n[next][rotor]);
            input.speed_command[rotor] = airframe.relative_speed_of_thrust(middle);
            input.speed_rate_1_s[rotor] =
                f64::midpoint(turning.acceleration_1_s[index][rotor], turning.acceleration_1_s[next][rotor]);
        }
        input.battery_voltage_v = trace.voltage_v.as_ref().map(|voltage| voltage[index]);
        input
    }
}

/// A state moved by velocity (m/s), turn (rad, body) and rates (rad/s).
fn moved(state: &State, by: &[f64; STATE]) -> State {
    let part = |first: usize| Vector3::new(by[first], by[first + 1], by[first + 2]);
    State {
        position_m: state.position_m,
        velocity_m_s: state.velocity_m_s + part(0),
        attitude: state.attitude * UnitQuaternion::from_scaled_axis(part(3)),
        rates_rad_s: state.rates_rad_s + part(6),
    }
}

/// Velocity, rotation (body) and rates of `a` minus those of `b`.
fn difference(a: &State, b: &State) -> [f64; STATE] {
    let velocity = a.velocity_m_s - b.velocity_m_s;
    let turn = (b.attitude.inverse() * a.attitude).scaled_axis();
    let rates = a.rates_rad_s - b.rates_rad_s;
    std::array::from_fn(|index| match index {
        0..3 => velocity[index],
        3..6 => turn[index - 3],
        _ => rates[index - 6],
    })
}
