//! From a mode to the setpoint of the cascade.

use std::time::Duration;

use nalgebra::Vector3;

use super::demand::{AttitudeDemand, Demand, Lift};
use super::tuning::Tuning;
use crate::physics::State;
use crate::simulate::{AutopilotGains, GuidedTarget, Setpoint, Shaper, ShaperLimits, Wish};

/// What the vehicle is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Task {
    /// stops, stays
    Hold,
    /// straight up to this height, local frame, m
    Takeoff(f64),
    /// down until it stands
    Land,
    /// home, then down
    Return(Leg),
    /// PX4: the setpoint goes straight to the controller
    Direct(Demand),
    /// an attitude or rates, with what carries the vehicle; when it came
    Turn(AttitudeDemand, Duration),
    /// ArduPilot: the setpoint is shaped first; when it came
    Shaped(Demand, Duration),
}

/// Parts of a return.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Leg {
    /// to this height, m
    Climb(f64),
    /// over home at this height, m
    Across(f64),
}

/// Speed above which the nose turns to where the vehicle flies, m/s.
const TURNING_SPEED_M_S: f64 = 1.0;
/// Rate at which the heading follows, rad/s.
const TURNING_RATE_RAD_S: f64 = 1.05;
/// As near counts as arrived, m.
const ARRIVED_M: f64 = 0.25;
/// Above this height over home the landing descends faster, m.
const SLOW_BELOW_M: f64 = 10.0;

/// Keeps the reference of the task at hand.
#[derive(Debug)]
pub(super) struct Guidance {
    pub(super) task: Task,
    shaper: Shaper,
    yaw_rad: f64,
    gains: AutopilotGains,
}

impl Guidance {
    pub(super) fn new(state: &State, gains: AutopilotGains) -> Self {
        Self {
            task: Task::Hold,
            shaper: Shaper::at(state.position_m, state.velocity_m_s),
            yaw_rad: state.attitude.euler_angles().2,
            gains,
        }
    }

    /// Begins a task from where the vehicle is and as it moves.
    pub(super) fn begin(&mut self, task: Task, state: &State) {
        let shaped = |task: &Task| !matches!(task, Task::Direct(_) | Task::Turn(..));
        let turns = |task: &Task| matches!(task, Task::Turn(..));
        let goes_on = shaped(&self.task) && shaped(&task) || turns(&self.task) && turns(&task);
        if !goes_on {
            self.restart(state);
        }
        self.task = task;
    }

    /// The reference is where the vehicle is.
    pub(super) fn restart(&mut self, state: &State) {
        self.shaper = Shaper::at(state.position_m, state.velocity_m_s);
        self.yaw_rad = state.attitude.euler_angles().2;
    }

    /// The position estimate jumped, and what is stored with it.
    pub(super) fn shift(&mut self, by_m: Vector3<f64>) {
        self.shaper.position_m += by_m;
        if let Task::Direct(demand) | Task::Shaped(demand, _) = &mut self.task {
            demand.motion.position_m += by_m;
        }
    }

    /// The task wants to leave the ground; `hover` is the share of full thrust that carries the weight.
    pub(super) fn wants_up(&self, state: &State, hover: f64) -> bool {
        match &self.task {
            Task::Takeoff(height_m) => *height_m > state.position_m.z,
            Task::Turn(AttitudeDemand { lift: Lift::Thrust(thrust), .. }, _) => *thrust > hover,
            Task::Turn(AttitudeDemand { lift: Lift::Climb(climb_m_s), .. }, _) => *climb_m_s > 0.0,
            Task::Direct(demand) => {
                demand.motion.position_m.z - state.position_m.z > 0.2
                    || demand.motion.velocity_m_s.z > 0.1
                    || (demand.motion.position_m.z.is_nan()
                        && demand.motion.velocity_m_s.z.is_nan()
                        && demand.motion.acceleration_m_s2.z > 0.5)
            }
            _ => false,
        }
    }

    /// The task wants to go down, at the latest here.
    pub(super) fn wants_down(&self, setpoint: &Setpoint, state: &State) -> bool {
        let lets_down = match &self.task {
            Task::Land => true,
            Task::Turn(demand, _) => matches!(demand.lift, Lift::Thrust(_)),
            _ => false,
        };
        lets_down || setpoint.velocity_m_s.z < -0.1 || setpoint.position_m.z - state.position_m.z < -0.3
    }

    /// A takeoff has reached its height.
    pub(super) fn has_taken_off(&self, state: &State) -> bool {
        matches!(self.task, Task::Takeoff(height_m) if state.position_m.z > height_m - ARRIVED_M)
    }

    /// The setpoint for the period that begins now.
    pub(super) fn setpoint(
        &mut self,
        state: &State,
        home_m: &Vector3<f64>,
        (tuning, now): (&Tuning, Duration),
        period_s: f64,
    ) -> Setpoint {
        if let Task::Direct(demand) = self.task {
            return self.direct(&demand, state, &tuning.limits, period_s);
        }
        if let Some(demand) = self.turn_wanted(tuning, now) {
            return self.drifting(&demand, state, (&tuning.limits, period_s));
        }
        self.next_leg(state, home_m);
        self.time_out(tuning, now);
        let (wish, limits) = self.wish(state, home_m, tuning);
        self.shaper.step(&wish, &limits, period_s);
        if let Task::Shaped(demand, _) = &mut self.task {
            demand.motion.step(period_s);
        }
        let yaw_rate_rad_s = self.turn(tuning, now, period_s);
        Setpoint {
            position_m: self.shaper.position_m,
            velocity_m_s: self.shaper.velocity_m_s,
            acceleration_m_s2: self.shaper.acceleration_m_s2,
            yaw_rad: self.yaw_rad,
            yaw_rate_rad_s,
        }
    }

    /// The attitude or rates that are asked for. ArduPilot gets level when no more come (PX4 leaves OFFBOARD then).
    pub(super) fn turn_wanted(&self, tuning: &Tuning, now: Duration) -> Option<AttitudeDemand> {
        let Task::Turn(demand, came) = self.task else { return None };
        let stale = now.saturating_sub(came) > tuning.setpoint_timeout;
        Some(if stale { AttitudeDemand::level(self.yaw_rad) } else { demand })
    }

    /// No place is asked for: the vehicle is where it should be, at its height where a climb is asked for.
    fn drifting(
        &mut self,
        demand: &AttitudeDemand,
        state: &State,
        (limits, period_s): (&ShaperLimits, f64),
    ) -> Setpoint {
        let before = self.shaper;
        self.restart(state);
        self.yaw_rad = demand.attitude.unwrap_or(state.attitude).euler_angles().2;
        if let Lift::Climb(climb_m_s) = demand.lift {
            self.shaper.position_m.z = before.position_m.z;
            self.shaper.velocity_m_s.z = before.velocity_m_s.z;
            self.shaper.acceleration_m_s2.z = before.acceleration_m_s2.z;
            let wish = Wish {
                position_m: Vector3::repeat(f64::NAN),
                velocity_m_s: Vector3::new(state.velocity_m_s.x, state.velocity_m_s.y, climb_m_s),
                acceleration_m_s2: Vector3::zeros(),
            };
            self.shaper.step(&wish, limits, period_s);
        }
        let upright = |level: &Vector3<f64>, height: f64| Vector3::new(level.x, level.y, height);
        Setpoint {
            position_m: upright(&state.position_m, self.shaper.position_m.z),
            velocity_m_s: upright(&state.velocity_m_s, self.shaper.velocity_m_s.z),
            acceleration_m_s2: Vector3::zeros(),
            yaw_rad: self.yaw_rad,
            yaw_rate_rad_s: 0.0,
        }
    }

    fn next_leg(&mut self, state: &State, home_m: &Vector3<f64>) {
        match self.task {
            Task::Return(Leg::Climb(height_m)) if state.position_m.z > height_m - ARRIVED_M => {
                self.task = Task::Return(Leg::Across(height_m));
            }
            Task::Return(Leg::Across(_)) if (state.position_m - home_m).xy().norm() < ARRIVED_M => {
                self.task = Task::Land;
            }
            _ => {}
        }
    }

    /// ArduPilot: GUID_TIMEOUT after the last setpoint its velocity and acceleration are zero.
    fn time_out(&mut self, tuning: &Tuning, now: Duration) {
        if let Task::Shaped(demand, came) = &mut self.task
            && now.saturating_sub(*came) > tuning.setpoint_timeout
        {
            demand.motion.time_out();
        }
    }

    fn wish(&self, state: &State, home_m: &Vector3<f64>, tuning: &Tuning) -> (Wish, ShaperLimits) {
        let mut limits = tuning.limits;
        let zero = Vector3::zeros();
        let mut wish =
            Wish { position_m: Vector3::repeat(f64::NAN), velocity_m_s: zero, acceleration_m_s2: zero };
        match self.task {
            Task::Hold | Task::Direct(_) | Task::Turn(..) => {}
            Task::Takeoff(height_m) => {
                limits.climb_m_s = tuning.takeoff_speed_m_s;
                wish.position_m.z = height_m;
            }
            Task::Land => {
                let high = state.position_m.z - home_m.z > SLOW_BELOW_M;
                let speed = if high { tuning.limits.descent_m_s } else { tuning.land_speed_m_s };
                wish.velocity_m_s.z = -speed.max(tuning.land_speed_m_s);
            }
            Task::Return(Leg::Climb(height_m)) => wish.position_m.z = height_m,
            Task::Return(Leg::Across(height_m)) => {
                wish.position_m = Vector3::new(home_m.x, home_m.y, height_m);
            }
            Task::Shaped(demand, _) => wish = shaped_wish(&demand.motion, &self.shaper),
        }
        (wish, limits)
    }

    /// The heading continues; returns the rate that is fed forward, rad/s.
    fn turn(&mut self, tuning: &Tuning, now: Duration, period_s: f64) -> f64 {
        let speed = self.shaper.velocity_m_s.xy();
        match self.task {
            Task::Shaped(Demand { yaw_rad: Some(yaw_rad), yaw_rate_rad_s, .. }, _) => {
                self.yaw_rad = yaw_rad;
                yaw_rate_rad_s.unwrap_or(0.0)
            }
            Task::Shaped(Demand { yaw_rate_rad_s: Some(rate), .. }, came)
                if now.saturating_sub(came) <= tuning.setpoint_timeout =>
            {
                self.yaw_rad += rate * period_s;
                rate
            }
            Task::Shaped(Demand { yaw_rate_rad_s: None, .. }, _) | Task::Return(_)
                if tuning.yaw_follows_path && speed.norm() > TURNING_SPEED_M_S =>
            {
                let off = speed.y.atan2(speed.x) - self.yaw_rad;
                let off = off.sin().atan2(off.cos());
                let most = TURNING_RATE_RAD_S * period_s;
                self.yaw_rad += off.clamp(-most, most);
                0.0
            }
            _ => 0.0,
        }
    }

    /// PX4: `v = v_ff + P (p - p_now)` within the speed limits; an axis without position follows its velocity,
    /// one with neither its acceleration alone.
    fn direct(&mut self, demand: &Demand, state: &State, limits: &ShaperLimits, period_s: f64) -> Setpoint {
        let mut velocity = Vector3::zeros();
        for axis in 0..3 {
            let ahead = demand.motion.velocity_m_s[axis];
            let back = (demand.motion.position_m[axis] - state.position_m[axis]) * self.gains.position[axis];
            velocity[axis] = match (back.is_nan(), ahead.is_nan()) {
                (false, false) => back + ahead,
                (false, true) => back,
                (true, false) => ahead,
                (true, true) => state.velocity_m_s[axis],
            };
        }
        let level = velocity.xy().cap_magnitude(self.gains.speed_max_m_s);
        let climb = velocity.z.clamp(-limits.descent_m_s, limits.climb_m_s);
        match (demand.yaw_rad, demand.yaw_rate_rad_s) {
            (Some(yaw_rad), _) => self.yaw_rad = yaw_rad,
            (None, Some(rate)) => self.yaw_rad += rate * period_s,
            (None, None) => {}
        }
        Setpoint {
            // the position error is in the velocity already
            position_m: state.position_m,
            velocity_m_s: Vector3::new(level.x, level.y, climb),
            acceleration_m_s2: demand.motion.acceleration_m_s2.map(|a| if a.is_nan() { 0.0 } else { a }),
            yaw_rad: self.yaw_rad,
            yaw_rate_rad_s: demand.yaw_rate_rad_s.unwrap_or(0.0),
        }
    }
}

/// ArduPilot: with position the velocity and acceleration are fed forward.
fn shaped_wish(target: &GuidedTarget, shaper: &Shaper) -> Wish {
    let given = |vector: &Vector3<f64>| vector.x.is_finite();
    let velocity_m_s = if given(&target.velocity_m_s) {
        target.velocity_m_s
    } else if given(&target.acceleration_m_s2) && !given(&target.position_m) {
        shaper.velocity_m_s
    } else {
        Vector3::zeros()
    };
    let acceleration_m_s2 =
        if given(&target.acceleration_m_s2) { target.acceleration_m_s2 } else { Vector3::zeros() };
    Wish { position_m: target.position_m, velocity_m_s, acceleration_m_s2 }
}
