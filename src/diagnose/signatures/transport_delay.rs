//! Signature: a delay of the commands. It is found with the latency, not by a column.

use crate::diagnose::signature::{LatencyKind, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::physics::effects::TransportDelay;

/// Commands that act later than they were sent.
pub static SIGNATURE: Signature = Signature {
    role: Role { latency: Some(LatencyKind::Delay), ..Role::NONE },
    sizes: &[("delay", UsualSize::Of(0.03))],
    ..Signature::of(
        &TransportDelay,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "delay",
                factor: 1e3,
                before: "A delay was left out: commands act",
                after: "ms after they were sent",
            },
            size: Size::Of { parameter: "delay", factor: 1e3, unit: "ms" },
            ..Words::of("a delay of the commands")
        },
    )
};
