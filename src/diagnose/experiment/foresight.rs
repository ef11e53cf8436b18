//! Prediction of the results of a flight.

use super::settings::NextSettings;
use crate::diagnose::base::Base;
use crate::diagnose::candidates::Candidate;
use crate::diagnose::channels::CHANNELS;
use crate::diagnose::confusable::Signal;
use crate::diagnose::evidence::Weighted;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::latency_distance::{latency_distance, of_latency, turned};
use crate::diagnose::rows::Rows;
use crate::diagnose::signatures::{latency_kind, signature_of};
use crate::diagnose::trace::Trace;
use crate::physics::ActuationLatency;
use crate::recording::Quantity;
use crate::signals::{AsRecorded, Grid, OwnOfFlight, Quality, Series, Signals, ThrustSource, Usable};
use crate::simulate::Allocation;
use crate::trajectory::{FourierTrajectory, Reference};
use nalgebra::{UnitQuaternion, Vector3, Vector4};

/// A question to the next flight.
#[derive(Debug, Clone)]
pub(super) struct Question {
    pub(super) named: &'static str,
    pub(super) kind: Kind,
    /// distance in the previous flights, standard deviations
    pub(super) now: f64,
}

/// The kind of question.
#[derive(Debug, Clone)]
pub(super) enum Kind {
    /// the effect at this place of the base against a candidate with which it can be confused
    Against(usize, Candidate),
    /// its distance from zero
    Size(usize),
    /// the latency against the same latency of the other kind
    Latency(&'static str, ActuationLatency),
}

impl Question {
    /// The effect from which the named one is separated; `None`: its distance from zero.
    pub(super) fn other(&self) -> Option<&'static str> {
        match &self.kind {
            Kind::Against(_, candidate) => Some(candidate.id),
            Kind::Size(_) => None,
            Kind::Latency(other, _) => Some(other),
        }
    }
}

/// The question of a named effect and an identifier in its set; of several candidates of one effect (times of a change,
/// lengths of a cord) the nearest. `None` if no candidate of this identifier was tested.
pub(super) fn question(
    explanation: &Explanation,
    traces: &[Trace],
    (named, other): (&'static str, &'static str),
) -> Option<Question> {
    let search = &explanation.search;
    let fitted = &search.after;
    if latency_kind(named).is_some() {
        let now = latency_distance(traces, fitted, named)?;
        return Some(Question { named, kind: Kind::Latency(other, turned(fitted.base.latency, named)), now });
    }
    let inflation = fitted.weighted.long_run_deviation();
    let rivals = search.steps.iter().flat_map(|step| &step.rivals);
    let mut best: Option<Question> = None;
    for place in places(explanation, named) {
        let Some(signal) = Signal::new(&fitted.rows, &fitted.base, place, None) else { continue };
        for tested in search.last.iter().chain(rivals.clone()).filter(|tested| tested.candidate.id == other) {
            let candidate = &tested.candidate;
            let left = signal.beyond(traces, &fitted.rows, &fitted.base, candidate);
            let now = left.unwrap_or_else(|| signal.norm()) / inflation;
            if best.as_ref().is_none_or(|best| now < best.now) {
                best = Some(Question { named, kind: Kind::Against(place, candidate.clone()), now });
            }
        }
    }
    best
}

/// The named effect with the smallest significance.
pub(super) fn least_known(explanation: &Explanation) -> Option<Question> {
    let of_motion =
        explanation.named.iter().filter(|named| signature_of(named.id).is_none_or(|of| of.role.by_motion));
    let each = of_motion.filter_map(|named| size(explanation, named.id));
    each.min_by(|a, b| a.now.total_cmp(&b.now))
}

/// The question about the size of a named effect; `None` for a latency.
pub(super) fn size(explanation: &Explanation, named: &'static str) -> Option<Question> {
    let fitted = &explanation.search.after;
    let inflation = fitted.weighted.long_run_deviation();
    let each = places(explanation, named).filter_map(|place| {
        let now = Signal::new(&fitted.rows, &fitted.base, place, None)?.norm() / inflation;
        Some(Question { named, kind: Kind::Size(place), now })
    });
    each.min_by(|a, b| a.now.total_cmp(&b.now))
}

/// Places of an effect in the base.
fn places(explanation: &Explanation, id: &str) -> impl Iterator<Item = usize> {
    let present = explanation.search.after.base.effects.iter().enumerate();
    present.filter(move |(_, present)| present.id() == id).map(|(place, _)| place)
}

/// Step of the grid of the simulated flight, s: many instants a kernel, few a second.
const STEP_S: f64 = 0.02;

/// Predicts flights with the model, the noise and the sensors of the previous flights.
pub(super) struct Foresight<'a> {
    base: &'a Base,
    questions: &'a [Question],
    sigma: [f64; CHANNELS],
    inflation: f64,
    settings: NextSettings,
    /// flight whose streams the simulated flight has
    like: &'a Trace,
}

impl<'a> Foresight<'a> {
    /// `traces` are not empty.
    pub(super) fn new(
        explanation: &'a Explanation,
        traces: &'a [Trace],
        questions: &'a [Question],
        settings: &NextSettings,
    ) -> Self {
        let fitted = &explanation.search.after;
        Self {
            base: &fitted.base,
            questions,
            sigma: fitted.weighted.sigma,
            inflation: fitted.weighted.long_run_deviation(),
            settings: *settings,
            like: &traces[0],
        }
    }

    /// The rigid body and effects of the simulated flight.
    pub(super) fn base(&self) -> &Base {
        self.base
    }

    /// Distance of every pair after all periods, standard deviations; `None` if the flight cannot be simulated (free
    /// fall, or none of the effect in it).
    pub(super) fn distances(&self, trajectory: &FourierTrajectory) -> Option<Vec<f64>> {
        let signals = self.imagined(trajectory)?;
        let traces = [Trace::new(&signals, &self.base.vehicle, self.settings.half_width_s).ok()?];
        let base = self.base;
        let rows = Rows::new(&traces, base).ok()?;
        // one period stands for all: its noise is that of their mean
        let share = f64::from(self.settings.repeats).sqrt().recip();
        let sigma = self.sigma.map(|sigma| sigma * share);
        let left = |question: &Question| match &question.kind {
            Kind::Against(place, candidate) => {
                let signal = Signal::new(&rows, base, *place, Some(&sigma))?;
                // what does nothing stands for nothing
                Some(signal.beyond(&traces, &rows, base, candidate).unwrap_or_else(|| signal.norm()))
            }
            Kind::Size(place) => Some(Signal::new(&rows, base, *place, Some(&sigma))?.norm()),
            Kind::Latency(_, latency) => {
                of_latency(&traces, (&rows, base), &Weighted::at(&rows, &sigma), *latency)
            }
        };
        self.questions.iter().map(|question| Some(left(question)? / self.inflation)).collect()
    }

    /// One period as it would be logged without noise: the reference is followed exactly, with the thrusts that the
    /// rigid body needs.
    fn imagined(&self, trajectory: &FourierTrajectory) -> Option<Signals> {
        let vehicle = &self.base.vehicle;
        let around_s = 2.0 * self.settings.half_width_s;
        let grid = Grid::covering(0.0, trajectory.period_s + around_s, STEP_S);
        let allocation = Allocation::new(vehicle, 0.0).ok()?;
        let rotors = vehicle.rotors.len();
        let mut flown = SimulatedSeries::default();
        for index in 0..grid.count {
            let now = Reference::new(trajectory.derivatives(grid.time_s(index)), vehicle.gravity_m_s2);
            let omega = Vector3::from(now.motion.omega);
            let turning = vehicle.body.turning_torque_nm(&omega, &Vector3::from(now.motion.omega_dot));
            let lift = vehicle.body.mass_kg * now.motion.specific_force;
            let thrusts = allocation.thrusts_n(&Vector4::new(lift, turning.x, turning.y, turning.z));
            let [roll, pitch, yaw] = [now.motion.roll[0], now.motion.pitch[0], now.path[3][0]];
            if !(lift + roll + pitch + turning.sum()).is_finite() {
                return None;
            }
            flown.attitude.push(UnitQuaternion::from_euler_angles(roll, pitch, yaw));
            flown.rate.push(omega);
            flown.position.push(Vector3::from_fn(|axis, _| now.path[axis][0]));
            flown.velocity.push(Vector3::from_fn(|axis, _| now.path[axis][1]));
            flown.felt.push(Vector3::z() * now.motion.specific_force);
            flown.thrusts.extend(thrusts.iter().take(rotors));
            flown.wrench.push(Vector4::new(lift, turning.x, turning.y, turning.z));
        }
        Some(flown.signals((grid, vehicle.propulsion.full_thrust_n()), self.like))
    }
}

/// Series of the simulated flight.
#[derive(Default)]
struct SimulatedSeries {
    attitude: Vec<UnitQuaternion<f64>>,
    rate: Vec<Vector3<f64>>,
    position: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    felt: Vec<Vector3<f64>>,
    thrusts: Vec<f64>,
    wrench: Vec<Vector4<f64>>,
}

impl SimulatedSeries {
    /// Signals with the streams of the previous flights, of which `like` is the first.
    fn signals(self, (grid, full_thrust_n): (Grid, f64), like: &Trace) -> Signals {
        let rate_hz = 1.0 / like.command_period_s.max(1e-3);
        let voltage = like.voltage_v.as_ref().map(|voltage| sampled(voltage, grid.count));
        Signals {
            grid,
            usable: vec![true; grid.count],
            attitude: like.known.attitude.then(|| self.attitude.into()),
            rate: Some(self.rate.into()),
            specific_force: like.has_accelerometer().then(|| self.felt.into()),
            world_acceleration: None,
            position: like.known.position.then(|| self.position.into()),
            velocity: like.known.velocity.then(|| self.velocity.into()),
            rotor_thrust_n: self.thrusts.into(),
            full_thrust_n,
            wrench: self.wrench.into(),
            jitter_wrench: None,
            battery_voltage_v: voltage.map(Series::new),
            as_recorded: AsRecorded::default(),
            reference: None,
            own: OwnOfFlight::default(),
            air_m_s: Vector3::zeros(),
            quality: Quality {
                sources: vec![(Quantity::ActuatorCommand, "imagined", rate_hz)],
                thrust_source: ThrustSource::Command,
                offsets: Vec::new(),
                airborne_s: Vec::new(),
                usable: Usable::default(),
                torques: true,
                gyro_noise_rad_s: Some(like.gyro_noise_rad_s),
                velocity_held_by: like.velocity_held_by,
                position_by_receiver: like.position_by_receiver,
                steady_voltage_v: None,
                torque_error: like.torque_error,
                simulated: like.simulated,
                notes: Vec::new(),
            },
        }
    }
}

/// A measured series over one period: the battery discharges in it as over the whole flight.
fn sampled(series: &[f64], count: usize) -> Vec<f64> {
    let last = series.len().saturating_sub(1);
    (0..count).map(|index| series[(last * index / count.max(1)).min(last)]).collect()
}
