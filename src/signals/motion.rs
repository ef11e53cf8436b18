//! The body's motion on the grid: its streams aligned.

use super::align::{
    AlignFrame, InertialOnGrid, StreamOffset, attitude_offset, attitudes_onto, position_offset, rate_offset,
    vectors_onto, velocity_offset,
};
use super::chosen::Chosen;
use crate::recording::{Quantity, Stream};
use nalgebra::{UnitQuaternion, Vector3};

/// The body's motion on the grid, with corrected offsets.
pub(super) struct Motion {
    pub(super) attitude: Option<Vec<UnitQuaternion<f64>>>,
    pub(super) rate: Option<Vec<Vector3<f64>>>,
    pub(super) specific_force: Option<Vec<Vector3<f64>>>,
    pub(super) world_acceleration: Option<Vec<Vector3<f64>>>,
    pub(super) position: Option<Vec<Vector3<f64>>>,
    pub(super) velocity: Option<Vec<Vector3<f64>>>,
    pub(super) offsets: Vec<(Quantity, StreamOffset)>,
}

impl Motion {
    /// The chosen streams; `rate` is on the grid already, rad/s.
    pub(super) fn aligned(
        chosen: &Chosen<'_>,
        rate: Option<Vec<Vector3<f64>>>,
        frame: &AlignFrame<'_>,
        gravity_m_s2: f64,
    ) -> Self {
        let grid = frame.grid;
        let plain = |s: Option<(&'static str, &Stream)>| s.and_then(|(_, s)| vectors_onto(s, 0.0, grid));
        let mut offsets = Vec::new();
        let mut rate = rate;
        if let Some(((_, stream), inertial)) = chosen.rate.zip(chosen.inertial_rate)
            && let Some(offset) = rate_offset(stream, inertial, frame)
        {
            offsets.push((Quantity::AngularRate, offset));
            if offset.repaired {
                rate = vectors_onto(stream, offset.late_s, grid);
            }
        }
        let mut note = |quantity, offset: Option<StreamOffset>| {
            offset.map_or(0.0, |offset| {
                offsets.push((quantity, offset));
                if offset.repaired { offset.late_s } else { 0.0 }
            })
        };
        let specific_force = plain(chosen.specific_force);
        let attitude = chosen.attitude.and_then(|(_, stream)| {
            let offset = rate.as_ref().and_then(|rate| attitude_offset(stream, rate, frame));
            attitudes_onto(stream, note(Quantity::Attitude, offset), grid)
        });
        let velocity = chosen.velocity.and_then(|(_, stream)| {
            let offset = match (&attitude, &rate, &specific_force) {
                (Some(attitude), Some(rate), Some(specific_force)) => {
                    let inertial = InertialOnGrid { attitude, rate, specific_force, gravity_m_s2 };
                    velocity_offset(stream, &inertial, frame)
                }
                _ => None,
            };
            vectors_onto(stream, note(Quantity::Velocity, offset), grid)
        });
        let position = chosen.position.and_then(|(_, stream)| {
            let offset = velocity.as_ref().and_then(|velocity| position_offset(stream, velocity, frame));
            vectors_onto(stream, note(Quantity::Position, offset), grid)
        });
        let world_acceleration = plain(chosen.world_acceleration);
        Self { attitude, rate, specific_force, world_acceleration, position, velocity, offsets }
    }
}
