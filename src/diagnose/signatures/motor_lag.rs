//! Signature: a lag of the motors. It is found with the latency, not by a column.

use crate::diagnose::named::Named;
use crate::diagnose::signature::{LatencyKind, Refinement, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words;
use crate::physics::effects::MotorLag;

/// Rotors that follow their commands with a lag.
pub static SIGNATURE: Signature = Signature {
    refinement: Refinement { freed: |_| Vec::new(), ..Refinement::NONE },
    role: Role { latency: Some(LatencyKind::Lag), ..Role::NONE },
    sizes: &[("time_constant", UsualSize::Of(0.04))],
    ..Signature::of(
        &MotorLag,
        &[0],
        Words {
            clause: Clause::Own(|named, _| clause(named)),
            size: Size::Own(
                |named| {
                    let said = |name: &str| words::said(named, name, 1e3, "ms");
                    match (said("time_constant"), said("time_constant_down")) {
                        (Some(up), Some(down)) => Some(format!("{up} up, {down} down")),
                        (up, _) => up,
                    }
                },
                |named| named.get("time_constant").map(|lag| (lag.value, lag.std)),
            ),
            ..Words::of("motor lag")
        },
    )
};

fn clause(named: &Named) -> String {
    let follow = "The motors' lag was left out: the rotors follow their commands with a time constant of";
    let rising = named.said("time_constant", 1e3);
    match named.get("time_constant_down") {
        Some(_) => format!("{follow} {rising} ms up and {} ms down", named.said("time_constant_down", 1e3)),
        None => format!("{follow} {rising} ms"),
    }
}
