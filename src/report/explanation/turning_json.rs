//! What the JSON document of `explain` has of how the vehicle turns, beside its effects.

use crate::diagnose::holdout::RateLaw;
use crate::diagnose::{GyroscopicShare, TorqueLaw};
use crate::study::ExplainStudy;
use schemars::JsonSchema;
use serde::Serialize;

/// Laws of the rotation that are only there where a flight told them.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub(super) struct TurningValue {
    #[serde(skip_serializing_if = "Option::is_none")]
    rate_law: Option<RateLawValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    torque_law: Option<TorqueLawValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gyroscopic: Option<GyroscopicValue>,
}

/// How the rates move in open loop, body x y z.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct RateLawValue {
    /// of the model's torque that acts, 0..1
    share: [f64; 3],
    decay_1_s: [f64; 3],
    offset_rad_s2: [f64; 3],
}

/// The power of the thrust with which the rotors' torque about their axes goes.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct TorqueLawValue {
    exponent: f64,
    std: f64,
}

/// Share of the gyroscopic torque that acts in a simulator that leaves it out.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct GyroscopicValue {
    share: f64,
    std: f64,
}

impl TurningValue {
    pub(super) fn of(study: &ExplainStudy) -> Self {
        let law = |TorqueLaw { exponent, std }| TorqueLawValue { exponent, std };
        let share = |GyroscopicShare { value, std }| GyroscopicValue { share: value, std };
        Self {
            rate_law: study.rate_law.map(RateLawValue::from),
            torque_law: study.explanation.torque_law.map(law),
            gyroscopic: study.gyroscopic().map(share),
        }
    }
}

impl From<RateLaw> for RateLawValue {
    fn from(law: RateLaw) -> Self {
        Self {
            share: law.share.into(),
            decay_1_s: law.decay_1_s.into(),
            offset_rad_s2: law.offset_rad_s2.into(),
        }
    }
}
