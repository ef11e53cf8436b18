//! State of the safety rules.

use std::time::Duration;

use crate::fly::safety::{Envelope, Masters, Sustained, Tracking};
use crate::fly::sortie::Sortie;
use crate::units::rad_from_deg;

/// Default limit of the tilt above the planned one, degrees. Gusts and corrections tilt a vehicle beyond its plan; a
/// larger limit takes over later, a smaller one without need.
const TILT_BEYOND_DEG: f64 = 20.0;
/// Least default limit of the tilt, degrees. A smaller one ends hovers in wind.
const TILT_LEAST_DEG: f64 = 25.0;
/// Greatest default limit of the tilt, degrees. Beyond it a vehicle with a thrust of twice its weight does not hold
/// its height.
const TILT_MOST_DEG: f64 = 60.0;

/// State of the safety rules.
#[derive(Debug)]
pub(super) struct Watch {
    pub(super) tracking: Tracking,
    pub(super) masters: Masters,
    pub(super) envelope: Envelope,
    pub(super) failsafe: Sustained,
    pub(super) terminated: Sustained,
    pub(super) unhealthy: Sustained,
    pub(super) paused_since: Option<Duration>,
    /// when this program last resumed after a stall of 0.3 s or more: messages from that time are not read immediately
    pub(super) awake: Duration,
    /// whether an unaccepted report of "disarmed" was reported
    pub(super) told_contradiction: bool,
}

impl Watch {
    pub(super) fn new(sortie: &Sortie) -> Self {
        let settings = &sortie.settings;
        let planned_rad = sortie.course.tilt_max_rad(sortie.gravity_m_s2);
        let tilt_max_rad = settings.tilt_max_rad.unwrap_or_else(|| {
            (planned_rad + rad_from_deg(TILT_BEYOND_DEG))
                .clamp(rad_from_deg(TILT_LEAST_DEG), rad_from_deg(TILT_MOST_DEG))
        });
        Self {
            tracking: Tracking::default(),
            masters: Masters::new(settings.station.0, settings.station.1),
            envelope: Envelope::new(sortie.limits, settings.room_margin_m, tilt_max_rad),
            failsafe: Sustained::default(),
            terminated: Sustained::default(),
            unhealthy: Sustained::default(),
            paused_since: None,
            awake: Duration::ZERO,
            told_contradiction: false,
        }
    }

    /// Whether the trajectory waits because nothing is received.
    pub(super) fn is_paused(&self) -> bool {
        self.paused_since.is_some()
    }
}
