//! What the user writes in `vehicle.toml`, and what `identify` adds to make it `model.toml`.
//!
//! The keys carry no units; they are SI, and degrees where the key says so.

use serde::{Deserialize, Serialize};

/// Version of the form of these files, their key `format`. It goes up when a key is renamed, removed or gets another
/// meaning, not when one is added. Files without the key have version 1.
pub(super) const FORMAT: u32 = 1;

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VehicleFile {
    #[serde(default = "first_format")]
    pub format: u32,
    pub name: String,
    pub body: BodyTable,
    pub propulsion: PropulsionTable,
    #[serde(default, rename = "rotor")]
    pub rotors: Vec<RotorTable>,
    #[serde(default, skip_serializing_if = "LimitsTable::is_empty")]
    pub limits: LimitsTable,
    #[serde(default)]
    pub identify: IdentifyTable,
    #[serde(default, skip_serializing_if = "Vec::is_empty", rename = "guess")]
    pub guesses: Vec<GuessTable>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identified: Option<toml::Table>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<toml::Table>,
    #[serde(default, skip_serializing_if = "Vec::is_empty", rename = "effect")]
    pub effects: Vec<toml::Table>,
}

/// The format of files that do not state it.
fn first_format() -> u32 {
    1
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    /// kg
    pub mass: f64,
    /// m, FLU, from the origin of the rotor positions
    #[serde(default)]
    pub center_of_mass: [f64; 3],
    /// m/s^2
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<f64>,
    /// share of the gyroscopic torque that acts, of simulators that leave it out
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gyroscopic: Option<f64>,
    pub inertia: InertiaTable,
}

/// kg m^2, entries of the symmetric tensor about the centre of mass, FLU.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InertiaTable {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    #[serde(default)]
    pub xy: f64,
    #[serde(default)]
    pub xz: f64,
    #[serde(default)]
    pub yz: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ActuatorKind {
    Speed,
    Thrust,
    Pwm,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PropulsionTable {
    pub actuator: ActuatorKind,
    /// microseconds
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pwm_min: Option<f64>,
    /// microseconds
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pwm_max: Option<f64>,
    /// rad/s
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_max: Option<f64>,
    /// N/(rad/s)^2
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_coefficient: Option<f64>,
    /// N m/(rad/s)^2
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_coefficient: Option<f64>,
    /// N, one rotor
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_max: Option<f64>,
    /// 0 linear, 1 quadratic
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_expo: Option<f64>,
    /// N m per N
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_ratio: Option<f64>,
    /// m
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_radius: Option<f64>,
    /// s
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_constant: Option<f64>,
    /// s
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_constant_down: Option<f64>,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum SpinKey {
    Cw,
    Ccw,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotorTable {
    pub name: String,
    /// m, FLU
    pub position: [f64; 3],
    pub spin: SpinKey,
}

#[derive(Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct LimitsTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_max_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_max_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_max_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_rate_max_deg_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_acceleration_max_deg_s2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_max_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_max_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_min_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_max_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_max_m_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_max_m_s2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical_acceleration_min_m_s2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical_acceleration_max_m_s2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_max_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque_max_nm: Option<f64>,
}

impl LimitsTable {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct IdentifyTable {
    pub anchor: AnchorKey,
}

#[derive(Debug, Default, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum AnchorKey {
    #[default]
    Thrust,
    Mass,
}

/// A value that nobody measured.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GuessTable {
    /// which value
    pub of: String,
    /// standard error over the value
    pub relative_std: f64,
    /// what it rests on
    #[serde(default)]
    pub why: String,
}
