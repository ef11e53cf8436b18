//! Whether anybody else commands the vehicle.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use super::Sustained;
use crate::fly::outcome::Cause;
use crate::fly::target::Target;
use crate::log::{ComponentId, Frame, SystemId};

/// A reported target this far from all of ours is not ours.
const FOREIGN_M: f64 = 1.0;
/// Reports come later than what they report.
const DELAY: Duration = Duration::from_secs(1);
const PATIENCE: Duration = Duration::from_millis(500);

const HEARTBEAT: u32 = 0;
/// SET_ATTITUDE_TARGET, SET_POSITION_TARGET_LOCAL_NED, SET_POSITION_TARGET_GLOBAL_INT with the offset of
/// their target.
const SETPOINTS: [(u32, usize); 3] = [(82, 36), (84, 50), (86, 50)];

/// Watches for a second master.
#[derive(Debug)]
pub struct Masters {
    own: (SystemId, ComponentId),
    told: VecDeque<(Duration, Vector3<f64>)>,
    foreign: Sustained,
}

impl Masters {
    /// For a ground station of these ids.
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Self {
        Self { own: (system, component), told: VecDeque::new(), foreign: Sustained::default() }
    }

    /// Takes a frame that is not the vehicle's own: a heartbeat with our ids, or setpoints for our vehicle.
    #[must_use]
    pub fn hear(&self, frame: Frame<'_>, target: Target) -> Option<Cause> {
        let header = frame.header();
        let sender = (header.system, header.component);
        if header.message_id == HEARTBEAT && sender == self.own {
            let (system, component) = sender;
            return Some(Cause::SecondMaster(format!(
                "a heartbeat with our own ids, system {system} component {component}"
            )));
        }
        let (_, offset) = SETPOINTS.iter().find(|(id, _)| *id == header.message_id)?;
        let addressee = frame.payload().u8(*offset);
        (addressee == 0 || addressee == target.system_byte()).then(|| {
            let (system, component) = sender;
            Cause::SecondMaster(format!("setpoints from system {system} component {component}"))
        })
    }

    /// What the vehicle is told at `now`, m, world.
    pub fn told(&mut self, now: Duration, position_m: Vector3<f64>) {
        self.told.push_back((now, position_m));
        while self.told.front().is_some_and(|(at, _)| now.saturating_sub(*at) > DELAY) {
            self.told.pop_front();
        }
    }

    /// Takes the target that the vehicle says it flies to, m, world.
    pub fn check(&mut self, now: Duration, target_m: &Vector3<f64>) -> Option<Cause> {
        let nearest_m =
            self.told.iter().map(|(_, told)| (told - target_m).norm()).min_by(f64::total_cmp)?;
        (self.foreign.update(now, nearest_m > FOREIGN_M) > PATIENCE).then(|| {
            Cause::SecondMaster(format!("the vehicle flies to a target {nearest_m:.2} m from ours"))
        })
    }
}
