//! Signature: gusts. They are found in the residual, not by a column.

use crate::diagnose::signature::{Joint, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Size, Words};
use crate::physics::effects::Gust;

/// Wind that changes.
pub static SIGNATURE: Signature = Signature {
    joint: Joint {
        irregular: Some(
            "a gust is one random course of the wind that does not repeat, and force and torque are not a function of its \
             strength and correlation time; `mavid explain` gives both from the remaining residual",
        ),
        ..Joint::PLAIN
    },
    sizes: &[
        ("sigma", UsualSize::Of(0.4)),
        ("correlation_time", UsualSize::Of(1.0)),
        ("seed", UsualSize::Of(7.0)),
    ],
    ..Signature::of(
        &Gust,
        &[0, 1],
        Words { size: Size::Of { parameter: "sigma", factor: 1.0, unit: "m/s rms" }, ..Words::of("gusts") },
    )
};
