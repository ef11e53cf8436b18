//! Recursive identification of one flight from its stream of messages.

use super::choice::Sources;
use super::rows::{Causal, Instant};
use super::track::{At, Sample};
use crate::estimate::{Estimated, Finding, NAMES, Nominal, RecursiveEstimator, THETA, UNITS};
use crate::estimate::{finding, rescaled};
use crate::fly::parameters::Parameters;
use crate::physics::MAX_ROTORS;
use crate::recording::{Event, Quantity, Recording};
use crate::signals::{FLYING_SHARE, motor_channels, propulsion_from_log};
use crate::vehicle::{Anchor, Mixer, Propulsion, Vehicle};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

/// Step between instants, s. The usual rate of attitude and commands; only the live view depends on it.
const STEP_S: f64 = 0.01;
/// Time left out after every start and gap, s: the filters settle, and the vehicle leaves the ground. Of the live
/// view only; the analysis after the flight has its own rules.
const SETTLING_S: f64 = 2.0;
/// Largest number of instants that are caught up at once after a stall of the link.
const CATCH_UP: usize = 400;

/// Recursive identification of one flight.
#[derive(Debug)]
pub struct LiveIdentification {
    vehicle: Vehicle,
    nominal: Nominal,
    mixer: Mixer,
    propulsion: Propulsion,
    /// output channel of each motor
    channels: Vec<usize>,
    sources: Sources,
    causal: Option<Causal>,
    estimator: RecursiveEstimator,
    active: bool,
    next_s: Option<f64>,
    last_row_s: f64,
    /// start of the time in the air without a gap in any stream, s
    flying_since_s: Option<f64>,
    /// the stream of which the last instant was missing
    gap_in: Option<Quantity>,
}

impl LiveIdentification {
    /// The identification of a vehicle whose autopilot sent these parameters, which state how a command becomes thrust.
    /// There is no low-pass if its cut-off does not fit 100 Hz.
    #[must_use]
    pub fn new(vehicle: &Vehicle, parameters: &Parameters, settings: &LiveSettings) -> Self {
        let said = Recording {
            parameters: parameters.values.clone(),
            autopilot: parameters.autopilot,
            ..Recording::default()
        };
        let (propulsion, mut notes) = propulsion_from_log(&said, &vehicle.propulsion);
        let rotors = vehicle.rotors.len().min(MAX_ROTORS);
        let mut channels = motor_channels(&said, rotors, &mut notes);
        channels.truncate(MAX_ROTORS);
        Self {
            nominal: Nominal::of(vehicle),
            mixer: vehicle.mixer(),
            propulsion,
            sources: Sources::new(channels.iter().max().map_or(0, |last| last + 1), rotors),
            channels,
            causal: Causal::new(settings.cutoff_hz, STEP_S, vehicle.gravity_m_s2),
            estimator: RecursiveEstimator::new(STEP_S),
            vehicle: vehicle.clone(),
            active: true,
            next_s: None,
            last_row_s: f64::NAN,
            flying_since_s: None,
            gap_in: None,
        }
    }

    /// What the first estimate waits for.
    #[must_use]
    pub fn waits_for(&self) -> String {
        let missing = self.sources.missing();
        if !missing.is_empty() {
            let names: Vec<String> = missing.into_iter().map(spoken).collect();
            return format!("waits for {}", names.join(", "));
        }
        if !self.active {
            return "waits for the trajectory".to_owned();
        }
        let gap = self.gap_in.map_or_else(String::new, |gap| format!(" (the last was in {})", spoken(gap)));
        format!("waits for {SETTLING_S:.0} s in the air without a gap in the telemetry{gap}")
    }

    /// Sets whether rows count, which is while the trajectory is flown. Without this, rows of the whole flight count.
    pub fn set_active(&mut self, active: bool) {
        self.active = active;
    }

    /// Takes an event of the decoder.
    pub fn take(&mut self, event: &Event<'_>) {
        match event {
            Event::Sample { stream, time_s, values } => {
                self.sources.add(*stream, *time_s, values);
                self.advance();
            }
            Event::ClockReset { .. } => {
                self.sources.clear();
                self.restart();
                self.next_s = None;
            }
            Event::EstimatorReset { .. } => self.restart(),
            Event::Autopilot(_)
            | Event::Parameter { .. }
            | Event::ParameterDefault { .. }
            | Event::Text { .. } => {}
        }
    }

    /// The estimate so far; `None` before there is one.
    pub fn estimate(&mut self) -> Option<LiveEstimate> {
        let raw = self.estimator.estimate()?;
        let estimated = match self.vehicle.anchor {
            Anchor::Mass => rescaled(&raw, self.vehicle.body.mass_kg),
            Anchor::Thrust => raw,
        };
        let parameters = std::array::from_fn(|index| LiveParameter {
            name: NAMES[index],
            unit: UNITS[index],
            finding: match self.vehicle.anchor {
                Anchor::Mass if index == 0 => Finding::Given { value: self.vehicle.body.mass_kg },
                _ => finding(&estimated, &self.nominal, index),
            },
        });
        let used_s = self.estimator.rows() as f64 * STEP_S;
        Some(LiveEstimate { time_s: self.last_row_s, used_s, parameters, estimated })
    }

    /// Restarts the filters after a gap.
    fn restart(&mut self) {
        self.flying_since_s = None;
        if let Some(causal) = &mut self.causal {
            causal.restart();
        }
    }

    /// Makes the rows of all instants for which everything has arrived.
    fn advance(&mut self) {
        for _ in 0..CATCH_UP {
            let Some(newest_s) = self.sources.oldest_newest_s() else { return };
            let time_s = *self.next_s.get_or_insert(newest_s);
            if time_s > newest_s {
                return;
            }
            self.next_s = Some(time_s + STEP_S);
            match self.instant(time_s) {
                Some(instant) => self.row(time_s, &instant),
                None => {
                    self.gap_in = self.sources.gap_at(time_s);
                    self.restart();
                }
            }
        }
        // too far behind for one call: begin again at the present
        self.next_s = None;
        self.restart();
    }

    /// Everything at one instant; `None` in a gap.
    fn instant(&self, time_s: f64) -> Option<Instant> {
        let at = |quantity| match self.sources.track(quantity)?.at(time_s) {
            At::Value(value) => Some(value),
            At::Gap => None,
        };
        let vector = |sample: Sample| Vector3::new(sample[0], sample[1], sample[2]);
        let attitude = at(Quantity::Attitude)?;
        let [w, i, j, k] = [attitude[0], attitude[1], attitude[2], attitude[3]];
        let (wrench, collective_n) = self.wrench(time_s)?;
        Some(Instant {
            attitude: UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 0.5)?,
            rate_rad_s: vector(at(Quantity::AngularRate)?),
            velocity_m_s: vector(at(Quantity::Velocity)?),
            wrench,
            collective_n,
        })
    }

    /// Force and torque through the nominal mixer, and total thrust: N, N m, N.
    fn wrench(&self, time_s: f64) -> Option<(Vector4<f64>, f64)> {
        let rotors = self.channels.len();
        let mut thrusts = [0.0; MAX_ROTORS];
        let speeds = self.vehicle.propulsion.thrust_coefficient.and(self.sources.track(Quantity::RotorSpeed));
        // thrust of each sample, then its mean: the law is not linear
        let law = |sample: &Sample, rotor: usize| match speeds {
            Some(_) => self.propulsion.thrust_from_speed_n(sample[rotor]).unwrap_or(f64::NAN),
            None => {
                let u = self.propulsion.normalized(sample[self.channels[rotor]]);
                self.propulsion.thrust_from_command_n(u)
            }
        };
        let track = speeds.or_else(|| self.sources.track(Quantity::ActuatorCommand))?;
        let (before, after, share) = track.around(time_s)?;
        for (rotor, thrust) in thrusts.iter_mut().enumerate().take(rotors) {
            *thrust = law(before, rotor) + share * (law(after, rotor) - law(before, rotor));
        }
        let collective_n: f64 = thrusts[..rotors].iter().sum();
        collective_n.is_finite().then(|| (self.mixer.wrench(&thrusts[..rotors]), collective_n))
    }

    fn row(&mut self, time_s: f64, instant: &Instant) {
        let needed_n = FLYING_SHARE * self.vehicle.body.mass_kg * self.vehicle.gravity_m_s2;
        if instant.collective_n < needed_n || self.sources.is_landed() {
            self.restart();
            return;
        }
        let since_s = *self.flying_since_s.get_or_insert(time_s);
        let Some(causal) = &mut self.causal else { return };
        let (gamma, upsilon) = causal.row(instant);
        if self.active && time_s - since_s > SETTLING_S {
            self.estimator.add(&gamma, &upsilon);
            self.last_row_s = time_s;
        }
    }
}

fn spoken(quantity: Quantity) -> String {
    quantity.name().replace('_', " ")
}

/// Settings of the live estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiveSettings {
    /// cut-off of the causal low-pass, Hz: about ten times the trajectory's highest harmonic
    pub cutoff_hz: f64,
}

impl Default for LiveSettings {
    fn default() -> Self {
        Self { cutoff_hz: 5.0 }
    }
}

/// The present estimate of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveParameter {
    /// as in files
    pub name: &'static str,
    /// as in files
    pub unit: &'static str,
    /// value and standard error, or the reason why there is none yet
    pub finding: Finding,
}

/// The estimate so far.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveEstimate {
    /// s, vehicle clock, of the last row
    pub time_s: f64,
    /// used time of flight, s
    pub used_s: f64,
    /// `[m Ixx Ixy Ixz Iyy Iyz Izz]`
    pub parameters: [LiveParameter; THETA],
    /// the raw numbers, on the scale that the vehicle's anchor sets
    pub estimated: Estimated,
}
