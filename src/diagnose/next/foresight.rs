//! What a flight that was not flown would show.

use super::NextSettings;
use crate::diagnose::base::Base;
use crate::diagnose::candidates::Candidate;
use crate::diagnose::confusable::Signal;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::rows::{CHANNELS, Rows};
use crate::diagnose::trace::Trace;
use crate::log::Quantity;
use crate::signals::{Grid, Quality, Signals, ThrustSource, Usable};
use crate::simulate::Allocation;
use crate::trajectory::{FourierTrajectory, Reference};
use nalgebra::{UnitQuaternion, Vector3, Vector4};

/// An effect of the model and a candidate that could stand for it.
#[derive(Debug, Clone)]
pub(super) struct Question {
    pub(super) named: &'static str,
    /// among the base's effects
    pub(super) place: usize,
    pub(super) candidate: Candidate,
    /// standard deviations in the flights so far
    pub(super) now: f64,
}

/// Every named effect against every candidate that any flight can tell from it; of several candidates of
/// one effect (times of a change, lengths of a cord) the nearest.
pub(super) fn questions(explanation: &Explanation, traces: &[Trace]) -> Vec<Question> {
    let fitted = &explanation.search.after;
    let inflation = fitted.weighted.long_run_deviation();
    let mut out: Vec<Question> = Vec::new();
    for (place, present) in fitted.base.present.iter().enumerate() {
        let id = present.effect.id();
        if !explanation.named.iter().any(|named| named.id == id) {
            continue;
        }
        let Some(signal) = Signal::new(&fitted.rows, &fitted.base, place, None) else { continue };
        for tested in &explanation.search.last {
            let candidate = &tested.candidate;
            let Some(left) = signal.beyond(traces, &fitted.rows, &fitted.base, candidate) else { continue };
            let now = left / inflation;
            let known = out.iter_mut().find(|q| q.place == place && q.candidate.id == candidate.id);
            match known {
                Some(known) if known.now <= now => {}
                Some(known) => (known.now, known.candidate) = (now, candidate.clone()),
                None => out.push(Question { named: id, place, candidate: candidate.clone(), now }),
            }
        }
    }
    out
}

/// Instants of the imagined flight, s: many a kernel, few a second.
const STEP_S: f64 = 0.02;

/// Looks ahead with the model, the noise and the sensors of the flights so far.
pub(super) struct Foresight<'a> {
    base: &'a Base,
    questions: &'a [Question],
    sigma: [f64; CHANNELS],
    inflation: f64,
    settings: NextSettings,
    /// whose streams the imagined flight has
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

    /// The rigid body and effects that are flown.
    pub(super) fn base(&self) -> &Base {
        self.base
    }

    /// Distance of every pair after all periods, standard deviations; `None` where the flight cannot be
    /// imagined (free fall, or nothing of the effect in it).
    pub(super) fn distances(&self, trajectory: &FourierTrajectory) -> Option<Vec<f64>> {
        let signals = self.imagined(trajectory)?;
        let traces = [Trace::new(&signals, &self.base.vehicle, self.settings.half_width_s).ok()?];
        let base = self.base;
        let rows = Rows::new(&traces, base).ok()?;
        // one period stands for all: its noise is that of their mean
        let share = f64::from(self.settings.repeats).sqrt().recip();
        let sigma = self.sigma.map(|sigma| sigma * share);
        self.questions
            .iter()
            .map(|question| {
                let signal = Signal::new(&rows, base, question.place, Some(&sigma))?;
                Some(signal.beyond(&traces, &rows, base, &question.candidate)? / self.inflation)
            })
            .collect()
    }

    /// One period as its log would be without noise: the reference is followed exactly, and the rotors do
    /// what the rigid body needs for it.
    fn imagined(&self, trajectory: &FourierTrajectory) -> Option<Signals> {
        let vehicle = &self.base.vehicle;
        let around_s = 2.0 * self.settings.half_width_s;
        let grid = Grid::covering(0.0, trajectory.period_s + around_s, STEP_S);
        let allocation = Allocation::new(vehicle, 0.0).ok()?;
        let rotors = vehicle.rotors.len();
        let mut flown = Flown::default();
        for index in 0..grid.count {
            let now = Reference::new(trajectory.derivatives(grid.time_s(index)), vehicle.gravity_m_s2);
            let omega = Vector3::from(now.motion.omega);
            let turning = vehicle.body.inertia_kg_m2 * Vector3::from(now.motion.omega_dot)
                + omega.cross(&(vehicle.body.inertia_kg_m2 * omega));
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
        Some(flown.signals(grid, self.like))
    }
}

/// Series of the imagined flight.
#[derive(Default)]
struct Flown {
    attitude: Vec<UnitQuaternion<f64>>,
    rate: Vec<Vector3<f64>>,
    position: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    felt: Vec<Vector3<f64>>,
    thrusts: Vec<f64>,
    wrench: Vec<Vector4<f64>>,
}

impl Flown {
    /// With the streams that the flights so far had, of which `like` is the first.
    fn signals(self, grid: Grid, like: &Trace) -> Signals {
        let rate_hz = 1.0 / like.command_period_s.max(1e-3);
        let voltage = like.voltage_v.as_ref().map(|voltage| sampled(voltage, grid.count));
        Signals {
            grid,
            usable: vec![true; grid.count],
            attitude: like.known.attitude.then_some(self.attitude),
            rate: Some(self.rate),
            specific_force: like.has_accelerometer().then_some(self.felt),
            world_acceleration: None,
            position: like.known.position.then_some(self.position),
            velocity: like.known.velocity.then_some(self.velocity),
            rotor_thrust_n: self.thrusts,
            wrench: self.wrench,
            jitter_wrench: None,
            battery_voltage_v: voltage,
            reference: None,
            quality: Quality {
                sources: vec![(Quantity::ActuatorCommand, "imagined", rate_hz)],
                thrust_source: ThrustSource::Command,
                offsets: Vec::new(),
                airborne_s: Vec::new(),
                usable: Usable::default(),
                notes: Vec::new(),
            },
        }
    }
}

/// The battery runs down over one period as it did over the whole flight.
fn sampled(series: &[f64], count: usize) -> Vec<f64> {
    let last = series.len().saturating_sub(1);
    (0..count).map(|index| series[(last * index / count.max(1)).min(last)]).collect()
}
