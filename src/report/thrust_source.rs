//! The source of the thrust, in words.

use crate::signals::ThrustSource;

pub(super) fn thrust_name(source: ThrustSource) -> &'static str {
    match source {
        ThrustSource::MeasuredSpeed => "measured rotor speed",
        ThrustSource::Command => "commands",
        ThrustSource::Wrench => "recorded force and torque",
    }
}
