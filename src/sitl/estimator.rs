//! What the autopilot believes of its motion.

use std::time::Duration;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::Settings;
use crate::physics::State;
use crate::simulate::NoiseLevels;

/// Where PX4 aligns its heading in the air, m above the ground.
const ALIGNED_ABOVE_M: f64 = 1.5;

/// An estimator that is as good as its noise, needs time after boot, and can be made to jump or fail.
#[derive(Debug)]
pub(super) struct Estimator {
    noise: NoiseLevels,
    rng: Pcg64Mcg,
    warm_up: Duration,
    healthy: bool,
    shift_m: Vector3<f64>,
    /// counts jumps, as ODOMETRY does
    pub(super) reset_counter: u8,
    /// its heading is aligned since it took off
    aligned: bool,
    /// the last estimate
    pub(super) state: State,
}

impl Estimator {
    pub(super) fn new(settings: &Settings) -> Self {
        let [north_m, west_m] = settings.start_m;
        Self {
            noise: settings.sensors.control_noise.scaled(settings.sensors.noise_scale),
            rng: Pcg64Mcg::seed_from_u64(settings.seed),
            warm_up: settings.warm_up(),
            healthy: true,
            shift_m: Vector3::zeros(),
            reset_counter: 0,
            aligned: false,
            state: State::at_rest(Vector3::new(north_m, west_m, 0.0), settings.start_yaw_rad),
        }
    }

    /// Takes what sensors without noise show.
    pub(super) fn update(&mut self, shown: &State) {
        let mut state = self.noise.measure(&mut self.rng, shown);
        state.position_m += self.shift_m;
        self.state = state;
    }

    /// Position and velocity can be flown on.
    pub(super) fn is_good(&self, now: Duration) -> bool {
        self.healthy && self.is_warm(now)
    }

    /// Long enough after boot to have an origin.
    pub(super) fn is_warm(&self, now: Duration) -> bool {
        now >= self.warm_up
    }

    /// The position jumps by this much, world.
    pub(super) fn jump(&mut self, by_m: Vector3<f64>) {
        self.shift_m += by_m;
        self.state.position_m += by_m;
        self.reset_counter = self.reset_counter.wrapping_add(1);
    }

    /// PX4 resets its heading once in each flight, when it is this high, and counts that however small the
    /// step is; here there is none.
    pub(super) fn align_at(&mut self, height_m: f64) {
        if height_m > ALIGNED_ABOVE_M && !self.aligned {
            self.aligned = true;
            self.reset_counter = self.reset_counter.wrapping_add(1);
        }
    }

    /// It stands on the ground: the next flight aligns again.
    pub(super) fn stand(&mut self) {
        self.aligned = false;
    }

    /// Where the position estimate is against the simulation's, world, m.
    pub(super) fn shift_m(&self) -> Vector3<f64> {
        self.shift_m
    }

    pub(super) fn set_health(&mut self, healthy: bool) {
        self.healthy = healthy;
    }

    /// The largest test ratio of the innovations, above 1 where they are refused.
    pub(super) fn test_ratio(&self, now: Duration) -> f64 {
        if self.is_good(now) { 0.08 } else { 1.7 }
    }
}
