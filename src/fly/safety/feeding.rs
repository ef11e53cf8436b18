//! Conversion of the reference to the sent setpoints, so that the vehicle follows the reference, and comes to rest
//! inside the room if one of them is the last that it receives.

use nalgebra::Vector3;

use super::SetpointBounds;
use crate::fly::law::{FollowLaw, Motion};
use crate::fly::setpoint::Setpoint;
use crate::simulate::GuidedTarget;

/// How much of the reference's velocity and acceleration a setpoint carries. What it does not carry, the autopilot is made
/// to ask for by itself: the setpoint's place lies ahead of the reference, by as much as the autopilot's own law makes of
/// that velocity and acceleration. A vehicle that hears no more then flies to that place and stays there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feeding {
    law: Option<FollowLaw>,
    share: f64,
    /// places ahead stay inside
    room: Option<SetpointBounds>,
}

impl Default for Feeding {
    fn default() -> Self {
        Self::whole()
    }
}

impl Feeding {
    /// Setpoints with position, velocity and acceleration of the reference.
    #[must_use]
    pub fn whole() -> Self {
        Self { law: None, share: 1.0, room: None }
    }

    /// Setpoints with this share (0 to 1) of velocity and acceleration, and positions ahead for the rest, in the room.
    #[must_use]
    pub fn ahead(law: FollowLaw, share: f64, room: SetpointBounds) -> Self {
        Self { law: Some(law), share, room: Some(room) }
    }

    /// Share of the reference's velocity and acceleration in the setpoints.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// The sent setpoint for one of the reference.
    #[must_use]
    pub fn apply(&self, reference: &Setpoint) -> Setpoint {
        let Some(law) = self.law.filter(|_| self.share < 1.0) else { return *reference };
        let rest = 1.0 - self.share;
        let motion = Motion {
            acceleration_m_s2: reference.acceleration_m_s2 * rest,
            ..Motion::at(reference.position_m, reference.velocity_m_s * rest)
        };
        let ahead = law.place_ahead(&motion);
        Setpoint {
            position_m: self.room.map_or(ahead, |room| within(&room, &reference.position_m, &ahead)),
            velocity_m_s: reference.velocity_m_s * self.share,
            acceleration_m_s2: reference.acceleration_m_s2 * self.share,
            ..*reference
        }
    }

    /// The sent setpoint as the autopilot uses it.
    #[must_use]
    pub fn target(&self, reference: &Setpoint) -> GuidedTarget {
        let Setpoint { position_m, velocity_m_s, acceleration_m_s2, .. } = self.apply(reference);
        GuidedTarget { position_m, velocity_m_s, acceleration_m_s2 }
    }
}

/// The place ahead, inside the room along each axis; where the reference itself is outside, no further out.
fn within(room: &SetpointBounds, from: &Vector3<f64>, ahead: &Vector3<f64>) -> Vector3<f64> {
    room.with(from).nearest(ahead)
}
