//! The streams of a recording that a flight is conditioned from.

use super::flight::AsRecorded;
use super::select::{best, best_of};
use crate::recording::{Quantity, Recording, Stream};
use std::sync::Arc;

/// The streams that were chosen.
pub(super) struct Chosen<'a> {
    pub(super) attitude: Option<(&'static str, &'a Stream)>,
    pub(super) rate: Option<(&'static str, &'a Stream)>,
    pub(super) specific_force: Option<(&'static str, &'a Stream)>,
    pub(super) world_acceleration: Option<(&'static str, &'a Stream)>,
    pub(super) position: Option<(&'static str, &'a Stream)>,
    pub(super) velocity: Option<(&'static str, &'a Stream)>,
    pub(super) gps_velocity: Option<(&'static str, &'a Stream)>,
    /// position of the message that brings the velocity
    pub(super) position_of_velocity: Option<&'a Stream>,
    /// body rates of the message that brings the specific force, where the chosen rates come by another
    pub(super) inertial_rate: Option<&'a Stream>,
}

impl<'a> Chosen<'a> {
    /// The best of each quantity.
    pub(super) fn from(recording: &'a Recording) -> Self {
        let pick = |quantity, width| {
            best(recording, quantity, |s: &Stream| s.width == width).map(|(key, stream)| (key.source, stream))
        };
        let (rate, specific_force) = (pick(Quantity::AngularRate, 3), pick(Quantity::SpecificForce, 3));
        let by_another = rate.zip(specific_force).filter(|((of_rate, _), (of_force, _))| of_rate != of_force);
        let inertial_rate = by_another.and_then(|(_, (of_force, _))| {
            best_of(recording, Quantity::AngularRate, |key, s| s.width == 3 && key.source == of_force)
        });
        let velocity = pick(Quantity::Velocity, 3);
        let position_of_velocity = velocity.and_then(|(of_velocity, _)| {
            best_of(recording, Quantity::Position, |key, s| s.width == 3 && key.source == of_velocity)
        });
        Self {
            attitude: pick(Quantity::Attitude, 4),
            rate,
            inertial_rate: inertial_rate.map(|(_, stream)| stream),
            specific_force,
            world_acceleration: pick(Quantity::WorldAcceleration, 3),
            position: pick(Quantity::Position, 3),
            velocity,
            position_of_velocity: position_of_velocity.map(|(_, stream)| stream),
            gps_velocity: pick(Quantity::GpsVelocity, 3),
        }
    }

    /// The streams whose raw samples are needed.
    pub(super) fn as_recorded(&self) -> AsRecorded {
        let kept = |stream: Option<(&'static str, &Stream)>| stream.map(|(_, s)| Arc::new(s.clone()));
        AsRecorded {
            specific_force: kept(self.specific_force),
            velocity: kept(self.velocity),
            gps_velocity: kept(self.gps_velocity),
        }
    }

    /// What the grid holds, with its message.
    pub(super) fn list(&self) -> [(Quantity, Option<(&'static str, &'a Stream)>); 6] {
        [
            (Quantity::Attitude, self.attitude),
            (Quantity::AngularRate, self.rate),
            (Quantity::SpecificForce, self.specific_force),
            (Quantity::WorldAcceleration, self.world_acceleration),
            (Quantity::Position, self.position),
            (Quantity::Velocity, self.velocity),
        ]
    }
}
