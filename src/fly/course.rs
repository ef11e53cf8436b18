//! The flown course: the path in the plan's frame, and the clock that moves the vehicle along it.

use std::sync::Arc;
use std::time::Duration;

use nalgebra::Vector3;

use super::setpoint::{Place, Setpoint, wrapped};
use crate::plan::{self, HOVER_S, TransitionError, bounds_of};
use crate::trajectory::{
    FlightPath, FourierTrajectory, Segment, Transition, at_rest, end_state, flat_motion,
};
use crate::units::whole;
use crate::vehicle::{Limits, Vehicle};

/// Speed of the climb after takeoff, m/s. Faster would overshoot the height, slower would stay in the ground's
/// effect.
pub(super) const CLIMB_M_S: f64 = 0.8;
/// Speed of the transfer to the start, m/s. A person at the switch has to be able to follow it; faster saves seconds.
pub(super) const TRANSFER_M_S: f64 = 1.0;
/// Yaw rate of the transfer, rad/s. Half a turn takes 6 s; a faster one saturates weak yaw control.
pub(super) const TURN_RAD_S: f64 = 0.5;
/// Ratio of greatest to mean speed of a transition of seventh degree from rest to rest.
const PEAK_TO_MEAN_SPEED: f64 = 2.1875;
/// Greatest acceleration of this transition times the square of its duration, divided by its length.
const PEAK_ACCELERATION: f64 = 7.513;
/// Largest acceleration of a transfer, m/s^2: a vehicle that receives no more setpoints continues with it. Less costs
/// time, more carries a vehicle without setpoints farther.
const TRANSFER_M_S2: f64 = 0.5;

/// Hovers and transitions around the series, by `trajectory.toml`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Around {
    /// x, y, z (m) and psi (rad) where the vehicle hovers after takeoff
    pub takeoff: [f64; 4],
    /// where it hovers before it lands
    pub landing: [f64; 4],
    /// s from takeoff to the series' start
    pub to_start_s: f64,
    /// s from the series' end to the landing place
    pub to_landing_s: f64,
}

/// Hover, transition, the series, transition, hover; plan's frame (NWU, zero on the ground).
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    path: Arc<FlightPath>,
    takeoff: [f64; 4],
    series_from_s: f64,
    period_s: f64,
    repeats: u32,
}

impl Course {
    /// A course with the planned transitions. Without them, with the shortest transitions that keep the limits, from
    /// and to a hover at the mean of the series.
    ///
    /// # Errors
    /// If there are no transitions inside the limits.
    pub fn new(
        series: &FourierTrajectory,
        repeats: u32,
        around: Option<&Around>,
        limits: &Limits,
        vehicle: &Vehicle,
    ) -> Result<Self, TransitionError> {
        let path = match around {
            Some(around) => planned(series, repeats, around),
            None => {
                let mean = series.axes.each_ref().map(|axis| axis.c);
                let flight = plan::FlightPlan { takeoff: mean, landing: mean, hover_s: HOVER_S, repeats };
                let dynamics = plan::Dynamics::new(vehicle);
                plan::flight_path(series, &flight, &bounds_of(limits, vehicle), &dynamics)?
            }
        };
        let takeoff = path.derivatives(0.0).map_or([0.0; 4], |axes| axes.map(|axis| axis[0]));
        let series_from_s = path.segments.iter().take(2).map(|(_, duration)| duration).sum();
        let (period_s, path) = (series.period_s, Arc::new(path));
        Ok(Self { path, takeoff, series_from_s, period_s, repeats })
    }

    /// x, y, z (m) and psi (rad) of the hover that it begins with.
    #[must_use]
    pub fn takeoff(&self) -> [f64; 4] {
        self.takeoff
    }

    /// The whole path.
    #[must_use]
    pub fn path(&self) -> &Arc<FlightPath> {
        &self.path
    }

    /// Periods that are flown.
    #[must_use]
    pub fn repeats(&self) -> u32 {
        self.repeats
    }

    /// Number of the period at `along_s` (s) from the path's start, from 1; 0 before the series and `repeats + 1` after
    /// it.
    #[must_use]
    pub fn period_at(&self, along_s: f64) -> u32 {
        if along_s >= self.series_from_s + f64::from(self.repeats) * self.period_s {
            return self.repeats + 1;
        }
        let flown = ((along_s - self.series_from_s) / self.period_s).floor() + 1.0;
        u32::try_from(whole(flown.max(0.0))).map_or(0, |count| count.min(self.repeats))
    }

    /// The same course whose series ends with the period at `along_s` from the start; `None` if that is the last one,
    /// or the series is over.
    #[must_use]
    pub fn ending_soon(&self, along_s: f64) -> Option<Self> {
        let repeats = self.period_at(along_s).max(1);
        if repeats >= self.repeats {
            return None;
        }
        let mut path = (*self.path).clone();
        for (segment, duration) in &mut path.segments {
            if matches!(segment, Segment::Fourier(_)) {
                *duration = f64::from(repeats) * self.period_s;
            }
        }
        Some(Self { path: Arc::new(path), repeats, ..self.clone() })
    }

    /// The greatest tilt of the path, rad, in steps of 10 ms.
    #[must_use]
    pub fn tilt_max_rad(&self, gravity_m_s2: f64) -> f64 {
        let mut greatest = 0.0_f64;
        let mut time_s = 0.0;
        while time_s < self.path.duration_s() {
            if let Some([x, y, z, yaw]) = self.path.derivatives(time_s) {
                let jet = |axis: [f64; 5]| [axis[2], axis[3], axis[4]];
                let yaw = [yaw[0], yaw[1], yaw[2]];
                let motion = flat_motion(&[jet(x), jet(y), jet(z)], &yaw, gravity_m_s2);
                greatest = greatest.max((motion.roll[0].cos() * motion.pitch[0].cos()).acos());
            }
            time_s += 0.01;
        }
        greatest
    }
}

fn planned(series: &FourierTrajectory, repeats: u32, around: &Around) -> FlightPath {
    let joint = end_state(&series.derivatives(0.0));
    let climb = Transition::new(&at_rest(around.takeoff), &joint, around.to_start_s);
    let descent = Transition::new(&joint, &at_rest(around.landing), around.to_landing_s);
    FlightPath {
        segments: vec![
            (Segment::Hold(around.takeoff), HOVER_S),
            (Segment::Transition(climb), around.to_start_s),
            (Segment::Fourier(series.clone()), f64::from(repeats) * series.period_s),
            (Segment::Transition(descent), around.to_landing_s),
            (Segment::Hold(around.landing), HOVER_S),
        ],
    }
}

/// Paths straight up from the place of a vehicle to the height of its start, and from there to the start.
#[must_use]
pub fn approach(stand: &Place, start: &Place) -> [FlightPath; 2] {
    let top = Vector3::new(stand.position_m.x, stand.position_m.y, start.position_m.z);
    let top = Place { position_m: top, ..*stand };
    [transfer(stand, &top, CLIMB_M_S, TURN_RAD_S), transfer(&top, start, TRANSFER_M_S, TURN_RAD_S)]
}

/// The reference of a path at one instant of it, while its clock runs, moved by an offset (m); `None` for a path without segments.
#[must_use]
pub fn reference_at(
    path: &FlightPath,
    along_s: f64,
    offset_m: &Vector3<f64>,
    time: Duration,
) -> Option<Setpoint> {
    let clock = PathTime { along_s, rate: 1.0, slope: 0.0 };
    on_path(path, &clock, offset_m, time)
}

/// Path from one hover to another, no faster than `speed_m_s` and `yaw_rate_rad_s`, slower on short distances, with the
/// shorter rotation.
#[must_use]
pub fn transfer(from: &Place, to: &Place, speed_m_s: f64, yaw_rate_rad_s: f64) -> FlightPath {
    let turn_rad = wrapped(to.yaw_rad - from.yaw_rad);
    let (start, end) = (from.position_m, to.position_m);
    let mean_s = ((end - start).norm() / speed_m_s).max(turn_rad.abs() / yaw_rate_rad_s);
    let gently_s = (PEAK_ACCELERATION * (end - start).norm() / TRANSFER_M_S2).sqrt();
    let duration_s = (PEAK_TO_MEAN_SPEED * mean_s).max(gently_s).max(1.0);
    let transition = Transition::new(
        &at_rest([start.x, start.y, start.z, from.yaw_rad]),
        &at_rest([end.x, end.y, end.z, from.yaw_rad + turn_rad]),
        duration_s,
    );
    FlightPath { segments: vec![(Segment::Transition(transition), duration_s)] }
}

/// Time in which the clock of a path stops and starts, s.
const RAMP_S: f64 = 1.0;

/// Time along a path. It can be paused and resumed: its rate then changes linearly between 0 and 1, so that the
/// setpoints slow down and speed up along the path without a jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathClock {
    /// when the rate was last changed
    from: Duration,
    /// time along the path then, s
    along_s: f64,
    /// rate then
    rate: f64,
    runs: bool,
}

/// A clock's time along the path, its rate, and the rate's slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathTime {
    /// s along the path
    pub along_s: f64,
    /// s along the path a second
    pub rate: f64,
    /// 1/s
    pub slope: f64,
}

impl PathClock {
    /// Runs from `now` on, at full rate.
    #[must_use]
    pub fn start(now: Duration) -> Self {
        Self { from: now, along_s: 0.0, rate: 1.0, runs: true }
    }

    /// Time along the path at an instant.
    #[must_use]
    pub fn at(&self, now: Duration) -> PathTime {
        let passed_s = now.saturating_sub(self.from).as_secs_f64();
        let (goal, slope) = if self.runs { (1.0, 1.0 / RAMP_S) } else { (0.0, -1.0 / RAMP_S) };
        let ramp_s = (goal - self.rate) / slope;
        if passed_s < ramp_s {
            let rate = self.rate + slope * passed_s;
            return PathTime { along_s: self.along_s + 0.5 * (self.rate + rate) * passed_s, rate, slope };
        }
        let along_s = self.along_s + 0.5 * (self.rate + goal) * ramp_s + goal * (passed_s - ramp_s);
        PathTime { along_s, rate: goal, slope: 0.0 }
    }

    /// Starts or stops it, from `now` on.
    pub fn set_running(&mut self, runs: bool, now: Duration) {
        if runs != self.runs {
            let PathTime { along_s, rate, .. } = self.at(now);
            *self = Self { from: now, along_s, rate, runs };
        }
    }
}

/// A path with its offset and its clock.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// what
    pub path: Arc<FlightPath>,
    /// added to the path's positions, m
    pub offset_m: Vector3<f64>,
    /// when
    pub clock: PathClock,
}

impl Track {
    /// The setpoint of one instant; beyond the end, the path's end. `None` for a path without segments.
    #[must_use]
    pub fn setpoint(&self, time: Duration) -> Option<Setpoint> {
        on_path(&self.path, &self.clock.at(time), &self.offset_m, time)
    }

    /// Whether the path is flown to its end.
    #[must_use]
    pub fn is_over(&self, now: Duration) -> bool {
        self.clock.at(now).along_s >= self.path.duration_s()
    }
}

fn on_path(path: &FlightPath, clock: &PathTime, offset_m: &Vector3<f64>, time: Duration) -> Option<Setpoint> {
    let PathTime { along_s, rate, .. } = *clock;
    let axes = path.derivatives(along_s)?;
    let beyond = along_s > path.duration_s();
    let moves = if beyond { 0.0 } else { 1.0 };
    let speed = |axis: &[f64; 5]| moves * axis[1] * rate;
    let [x, y, z, yaw] = &axes;
    // not the clock's own slope, velocity times up to 1/s: an autopilot that hears no more continues with it for seconds, which
    // takes it metres off the path. A clock of any rate alone leads no further than one that runs
    let push = |axis: &[f64; 5]| moves * axis[2] * rate * rate;
    Some(Setpoint {
        time,
        position_m: Vector3::new(x[0], y[0], z[0]) + offset_m,
        velocity_m_s: Vector3::new(speed(x), speed(y), speed(z)),
        acceleration_m_s2: Vector3::new(push(x), push(y), push(z)),
        yaw_rad: yaw[0],
        yaw_rate_rad_s: speed(yaw),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(value: f64) -> Duration {
        Duration::from_secs_f64(value)
    }

    fn place(x: f64, z: f64, yaw_rad: f64) -> Place {
        Place { position_m: Vector3::new(x, 0.0, z), yaw_rad }
    }

    #[test]
    fn a_transfer_keeps_its_speed_and_turns_the_short_way() {
        let path = transfer(&place(0.0, 1.0, 3.0), &place(4.0, 1.0, -3.0), 1.0, 0.5);
        let duration_s = path.duration_s();
        let mut fastest = 0.0_f64;
        for step in 0..=1000 {
            let axes = path.derivatives(duration_s * f64::from(step) / 1000.0).unwrap();
            fastest = fastest.max(axes[0][1].abs());
            assert!(axes[3][1].abs() <= 0.5 + 1e-9);
            assert!(axes[3][0] >= 3.0 - 1e-9, "turns over pi, not over zero");
        }
        assert!((fastest - 1.0).abs() < 1e-6, "{fastest}");
    }

    #[test]
    fn a_paused_clock_comes_to_rest_and_goes_on_without_a_jump() {
        let mut clock = PathClock::start(seconds(10.0));
        clock.set_running(false, seconds(12.0));
        clock.set_running(true, seconds(15.0));
        let mut last = clock.at(seconds(15.0));
        assert!((last.along_s - 2.5).abs() < 1e-9, "half a second of coming to rest: {last:?}");
        for step in 1..=300 {
            let now = clock.at(seconds(15.0 + 0.01 * f64::from(step)));
            assert!(now.rate - last.rate < 0.011 && now.along_s >= last.along_s);
            last = now;
        }
        assert!((last.along_s - 5.0).abs() < 1e-9 && last.rate == 1.0, "{last:?}");
    }

    #[test]
    fn feed_forward_is_the_slope_of_what_is_sent_without_that_of_the_clock() {
        let path = Arc::new(transfer(&place(0.0, 1.0, 0.0), &place(4.0, 2.0, 1.0), 1.0, 0.5));
        let mut clock = PathClock::start(seconds(0.0));
        clock.set_running(false, seconds(2.0));
        let track = Track { path, offset_m: Vector3::new(5.0, 0.0, 0.5), clock };
        let h = 1e-4;
        for t in [2.2, 2.5, 2.9] {
            let at = |t: f64| track.setpoint(seconds(t)).unwrap();
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            let velocity = (after.position_m - before.position_m) / (2.0 * h);
            assert!((velocity - now.velocity_m_s).norm() < 1e-5);
            let PathTime { rate, slope, .. } = clock.at(seconds(t));
            let whole = (after.velocity_m_s - before.velocity_m_s) / (2.0 * h);
            let of_clock = now.velocity_m_s * (slope / rate);
            assert!((whole - of_clock - now.acceleration_m_s2).norm() < 1e-5 && slope == -1.0);
        }
        let rest = track.setpoint(seconds(4.0)).unwrap();
        assert_eq!((rest.velocity_m_s.norm(), rest.acceleration_m_s2.norm()), (0.0, 0.0));
    }
}
