//! State of the vehicle, from its messages.

use crate::recording::landed::ON_GROUND;
use crate::wire::heartbeat::{ARMED, BASE_MODE_AT};
use crate::wire::message_id as id;
use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::arming::Arming;
use super::ground::Ground;
use super::health::{BatteryLevel, EstimatorReport, SystemReport, battery_status, level_of_percent};
use super::lift::Outputs;
use super::news::Novelty;
use super::order::SendingOrder;
use super::reset::GAP_MAX_S;
use super::reset::{Pose, Step};
pub use super::state::{FlightState, Motion, Timestamped};
use crate::autopilot::Stack;
use crate::frames::Attitude;
use crate::recording::{self, Quantity};
use crate::wire::{self, Decoder, Frame, Payload, Record};

/// Longest time since boot, beyond the silence before, of an autopilot that has just restarted, s. A larger one would
/// take a working autopilot for a restarted one, a smaller one would miss a slow boot.
const STARTED_S: f64 = 20.0;
/// Number of kept texts, which give reasons of a refusal.
const TEXTS: usize = 64;
/// A step of the position beyond what velocity explains from which the estimate was reset, m. Twice the step with
/// which a flight goes on; smaller ones are told by the reset counters.
const JUMP_M: f64 = 0.7;
/// Positions further apart in time are not one stream.
const POSITION_GAP: Duration = Duration::from_secs(1);
/// Time for which a report of the estimator or the battery is valid. Innovation tests fail for an instant, so a fault
/// counts only if it lasts.
const STATUS_VALID: Duration = Duration::from_secs(3);

/// State of the vehicle.
#[derive(Debug)]
pub struct Telemetry {
    decoder: Decoder,
    stack: &'static Stack,
    /// last frame of its autopilot
    pub heard: Duration,
    /// when it was heard again after a silence, or first
    pub resumed: Duration,
    /// last HEARTBEAT
    pub heartbeat: Duration,
    /// mode, arming
    pub state: Option<Timestamped<FlightState>>,
    /// place and velocity
    pub motion: Option<Timestamped<Motion>>,
    /// orientation
    pub attitude: Option<Timestamped<Attitude>>,
    /// on the ground, as EXTENDED_SYS_STATE says
    pub(super) ground: Ground,
    /// report of the estimator
    pub estimator: Option<Timestamped<EstimatorReport>>,
    /// since when the estimator has been good without a pause
    pub estimator_good_since: Option<Duration>,
    /// since when it has been bad without a pause
    pub estimator_bad_since: Option<Duration>,
    /// since when positions arrive without a gap of a second
    pub position_since: Option<Duration>,
    /// sensors, pre-arm checks
    pub system: Option<Timestamped<SystemReport>>,
    /// level of the battery, and percent
    pub battery: Option<Timestamped<(BatteryLevel, Option<i8>)>>,
    /// V
    pub battery_v: Option<f64>,
    /// of the last frame
    outputs: Vec<Outputs>,
    texts: VecDeque<(Duration, u8, String)>,
    order: SendingOrder,
    /// of the last frame
    place: i64,
    /// last ODOMETRY
    pose: Option<Pose>,
    /// place of the frame from which `state` is
    state_place: i64,
    /// reports of the mode so far, without those that others had overtaken
    mode_reports: u64,
    arming: Arming,
    velocity_m_s: Option<Vector3<f64>>,
}

impl Telemetry {
    /// The state of a vehicle whose HEARTBEAT was heard at `now`.
    #[must_use]
    pub fn new(vehicle: wire::Vehicle, stack: &'static Stack, now: Duration) -> Self {
        Self {
            decoder: Decoder::new(vehicle, None, micros(now)),
            stack,
            heard: now,
            resumed: now,
            heartbeat: now,
            state: None,
            motion: None,
            attitude: None,
            ground: Ground::default(),
            estimator: None,
            estimator_good_since: None,
            estimator_bad_since: None,
            position_since: None,
            system: None,
            battery: None,
            battery_v: None,
            outputs: Vec::new(),
            texts: VecDeque::new(),
            order: SendingOrder::default(),
            place: 0,
            pose: None,
            state_place: i64::MIN,
            mode_reports: 0,
            arming: Arming::default(),
            velocity_m_s: None,
        }
    }

    /// Takes a frame of the vehicle's autopilot with a right checksum.
    pub fn take(&mut self, now: Duration, frame: Frame<'_>) -> Vec<Novelty> {
        let header = frame.header();
        let silence = now.saturating_sub(self.heard);
        if silence > POSITION_GAP {
            self.resumed = now;
        }
        self.heard = now;
        let place = self.order.place(header.sequence, silence);
        self.place = place;
        let mut news = Vec::new();
        self.status(now, header.message_id, frame.payload(), place, &mut news);
        self.samples((now, silence), frame, &mut news);
        news
    }

    /// Reads status messages by byte, because an unknown enumeration value elsewhere in a message must not hide the
    /// mode.
    fn status(&mut self, now: Duration, id: u32, payload: Payload<'_>, place: i64, news: &mut Vec<Novelty>) {
        match id {
            id::HEARTBEAT => {
                self.heartbeat = now;
                let (custom_mode, armed) = (payload.u32(0), payload.u8(BASE_MODE_AT) & ARMED != 0);
                let state = FlightState { custom_mode, armed, system_status: payload.u8(7) };
                if self.note_state(now, state, place, news) {
                    let on_ground = self.ground.is_landed_at(now);
                    self.arming.report(now, armed, on_ground);
                }
            }
            id::CURRENT_MODE => {
                if let Some(Timestamped { value, at }) = self.state {
                    let state = FlightState { custom_mode: payload.u32(0), ..value };
                    self.note_state(at, state, place, news);
                }
            }
            id::SYS_STATUS => {
                let report = SystemReport::from_sys_status(payload);
                if self.battery.is_none_or(|battery| now.saturating_sub(battery.at) > STATUS_VALID)
                    && let Some(percent) = report.battery_percent
                {
                    let value = (level_of_percent(percent), Some(percent));
                    self.battery = Some(Timestamped { at: now, value });
                }
                self.system = Some(Timestamped { at: now, value: report });
            }
            id::BATTERY_STATUS if payload.u8(32) == 0 => {
                self.battery = Some(Timestamped { at: now, value: battery_status(payload) });
            }
            id::EKF_STATUS_REPORT => {
                self.note_estimator(now, EstimatorReport::from_ekf_status_report(payload))
            }
            id::ESTIMATOR_STATUS => self.note_estimator(now, EstimatorReport::from_estimator_status(payload)),
            _ => {}
        }
    }

    /// Takes a state of the vehicle. One that was sent before the known one is ignored.
    fn note_state(&mut self, at: Duration, state: FlightState, place: i64, news: &mut Vec<Novelty>) -> bool {
        if place < self.state_place {
            if self.state.is_some_and(|seen| seen.value.custom_mode != state.custom_mode) {
                news.push(Novelty::LateMode(state.custom_mode));
            }
            return false;
        }
        self.state_place = place;
        self.mode_reports += 1;
        let from = self.state.map(|seen| seen.value);
        self.state = Some(Timestamped { at, value: state });
        if from != Some(state) {
            news.push(Novelty::State { from, to: state });
        }
        true
    }

    fn note_estimator(&mut self, now: Duration, report: EstimatorReport) {
        if report.is_good() {
            self.estimator_good_since.get_or_insert(now);
            self.estimator_bad_since = None;
        } else {
            self.estimator_bad_since.get_or_insert(now);
            self.estimator_good_since = None;
        }
        self.estimator = Some(Timestamped { at: now, value: report });
    }

    fn samples(&mut self, (now, silence): (Duration, Duration), frame: Frame<'_>, news: &mut Vec<Novelty>) {
        let record = Record { stamp_us: micros(now), offset: 0, known: true, frame };
        let (mut position, mut velocity, mut rates, mut reset) = (None, None, None, false);
        let mut target_m = None;
        let (attitude, ground, volts) = (&mut self.attitude, &mut self.ground, &mut self.battery_v);
        let outputs = &mut self.outputs;
        outputs.clear();
        self.decoder.decode(&record, &mut |event| match event {
            recording::Event::Sample { stream, time_s, values } => match (stream.quantity, values) {
                (Quantity::Position, &[x, y, z]) => position = Some((time_s, Vector3::new(x, y, z))),
                (Quantity::Velocity, &[x, y, z]) => velocity = Some(Vector3::new(x, y, z)),
                (Quantity::Attitude, &[w, x, y, z]) => {
                    let value = Attitude(UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)));
                    *attitude = Some(Timestamped { at: now, value });
                }
                (Quantity::AngularRate, &[x, y, z]) => rates = Some(Vector3::new(x, y, z)),
                (Quantity::LandedState, &[state]) => {
                    ground.report(now, (state - ON_GROUND).abs() < 0.5);
                }
                (quantity @ (Quantity::ActuatorCommand | Quantity::RotorSpeed), values) => {
                    outputs.push(Outputs { quantity, source: stream.source, values: values.to_vec() });
                }
                (Quantity::BatteryVoltage, &[value]) => *volts = Some(value),
                (Quantity::PositionSetpoint, &[x, y, z]) if (x + y + z).is_finite() => {
                    target_m = Some(Vector3::new(x, y, z));
                }
                _ => {}
            },
            recording::Event::Text { severity, text, .. } => {
                news.push(Novelty::Text(severity, text.to_owned()))
            }
            // a network that holds frames back for seconds shows old stamps, which are not those of a start
            recording::Event::ClockReset { stamp_s, .. } => {
                ground.clock_jumped(now);
                if stamp_s < silence.as_secs_f64() + STARTED_S {
                    news.push(Novelty::Reboot);
                }
            }
            recording::Event::EstimatorReset { .. } => reset = true,
            recording::Event::Autopilot(_)
            | recording::Event::Parameter { .. }
            | recording::Event::ParameterDefault { .. } => {}
        });
        if frame.header().message_id == id::POSITION_TARGET_LOCAL_NED {
            news.push(Novelty::Target(target_m));
        }
        let oriented = self.attitude.filter(|seen| seen.at == now).map(|seen| seen.value);
        let pose = position.zip(velocity).zip(oriented.zip(rates));
        let pose = pose.map(|(((time_s, position_m), velocity_m_s), (attitude, rates_rad_s))| Pose {
            time_s,
            position_m,
            velocity_m_s,
            attitude,
            rates_rad_s,
        });
        if frame.header().message_id == id::ODOMETRY {
            self.note_pose(pose, reset, news);
        }
        self.texts.extend(news.iter().filter_map(|novelty| match novelty {
            Novelty::Text(severity, text) => Some((now, *severity, text.clone())),
            _ => None,
        }));
        self.texts.drain(..self.texts.len().saturating_sub(TEXTS));
        if let (Some((time_s, position_m)), Some(velocity_m_s)) = (position, velocity)
            && position_m.iter().chain(&velocity_m_s).all(|value| value.is_finite())
        {
            self.note_motion(now, Motion { time_s, position_m, velocity_m_s }, news);
        }
    }

    /// Takes ODOMETRY; its counter shows whether something was `reset`.
    fn note_pose(&mut self, pose: Option<Pose>, reset: bool, news: &mut Vec<Novelty>) {
        let before = std::mem::replace(&mut self.pose, pose);
        if reset {
            let step = pose.map_or(Step::Unknown, |after| Step::between(before.as_ref(), &after));
            let text = format!("ODOMETRY.reset_counter changed, {step}");
            news.push(if step.is_small() {
                Novelty::EstimatorStep(text)
            } else {
                Novelty::EstimatorReset(text)
            });
        }
    }

    fn note_motion(&mut self, now: Duration, motion: Motion, news: &mut Vec<Novelty>) {
        if let Some(Timestamped { value: last, .. }) = self.motion {
            let passed_s = motion.time_s - last.time_s;
            // a message that others overtook
            if passed_s < 0.0 && passed_s > -1.0 {
                return;
            }
            let mean = 0.5 * (motion.velocity_m_s + last.velocity_m_s);
            let jump_m = (motion.position_m - last.position_m - mean * passed_s).norm();
            if (0.0..GAP_MAX_S).contains(&passed_s) && jump_m > JUMP_M {
                news.push(Novelty::EstimatorReset(format!(
                    "position stepped by {jump_m:.2} m beyond what velocity explains"
                )));
            }
            let weight = (passed_s / 0.3).clamp(0.0, 1.0);
            if let Some(smooth) = &mut self.velocity_m_s {
                *smooth += weight * (motion.velocity_m_s - *smooth);
            }
        }
        self.velocity_m_s.get_or_insert(motion.velocity_m_s);
        let gap = self.motion.is_none_or(|last| now.saturating_sub(last.at) > POSITION_GAP);
        self.position_since = self.position_since.filter(|_| !gap).or(Some(now));
        self.motion = Some(Timestamped { at: now, value: motion });
    }

    /// Outputs of the motors in the last frame.
    #[must_use]
    pub fn outputs(&self) -> &[Outputs] {
        &self.outputs
    }

    /// Place of the last frame among all that the vehicle sent: greater means sent later.
    #[must_use]
    pub fn place(&self) -> i64 {
        self.place
    }

    /// Identity of the vehicle.
    #[must_use]
    pub fn vehicle(&self) -> wire::Vehicle {
        *self.decoder.vehicle()
    }

    /// Rules of its autopilot.
    #[must_use]
    pub fn stack(&self) -> &'static Stack {
        self.stack
    }

    /// Velocity over the last third of a second, m/s.
    #[must_use]
    pub fn smooth_velocity_m_s(&self) -> Option<Vector3<f64>> {
        self.velocity_m_s
    }

    /// Whether the motors may turn; `false` if nothing is known. A single HEARTBEAT that says "disarmed" in the air is
    /// not accepted.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.arming.is_armed()
    }

    /// Whether a HEARTBEAT says "disarmed" and is not accepted yet.
    #[must_use]
    pub fn is_arming_contradicted(&self) -> bool {
        self.arming.is_contradicted()
    }

    /// Reports of the mode that were taken: HEARTBEAT and CURRENT_MODE, without those that later ones had overtaken.
    #[must_use]
    pub fn mode_reports(&self) -> u64 {
        self.mode_reports
    }

    /// Warnings and errors of the vehicle since `since`, each only once.
    #[must_use]
    pub fn complaints_since(&self, since: Duration) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for (at, severity, text) in &self.texts {
            if *at >= since && *severity <= 4 && !found.contains(text) {
                found.push(text.clone());
            }
        }
        found
    }

    /// Level of the battery; good without a report.
    #[must_use]
    pub fn battery_level(&self) -> BatteryLevel {
        self.battery.map_or(BatteryLevel::Good, |battery| battery.value.0)
    }

    /// Present faults of its position; empty if it is good.
    #[must_use]
    pub fn estimator_faults(&self, now: Duration) -> Vec<String> {
        let mut faults = match &self.estimator {
            Some(seen) if now.saturating_sub(seen.at) < STATUS_VALID => seen.value.faults.clone(),
            _ => Vec::new(),
        };
        if let Some(seen) = &self.system {
            faults.extend(seen.value.unhealthy.iter().map(|name| format!("{name} is not healthy")));
        }
        faults
    }
}

/// The flight's clock as host stamps of the decoder.
fn micros(now: Duration) -> u64 {
    u64::try_from(now.as_micros()).unwrap_or(u64::MAX)
}
