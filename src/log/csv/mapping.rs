//! Which column means what.

use crate::recording::Quantity;
use crate::units;

/// What the columns of a file mean.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvMapping {
    /// between the cells; `None`: comma, semicolon or tab, whichever the header has most of
    pub delimiter: Option<u8>,
    /// the time column
    pub time: CsvTime,
    /// the others
    pub quantities: Vec<CsvQuantity>,
}

/// The time column.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvTime {
    /// its name
    pub column: String,
    /// of `value * scale`
    pub unit: CsvUnit,
    /// factor before the unit
    pub scale: f64,
}

/// One quantity and its columns.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvQuantity {
    /// what it is
    pub quantity: Quantity,
    /// sensor number where there are several
    pub instance: u8,
    /// column names in the order of the quantity's values. A single name with `{n}` stands for
    /// as many numbered columns, from 1, as the header has
    pub columns: Vec<String>,
    /// how an attitude is written; ignored for others
    pub form: AttitudeForm,
    /// the axes to which the values refer
    pub frame: AxisFrame,
    /// of `value * scale`
    pub unit: CsvUnit,
    /// factor before the unit
    pub scale: f64,
    /// raw cell values that mean "not known"
    pub missing: Vec<f64>,
    /// the file may do without
    pub optional: bool,
}

/// How an attitude is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AttitudeForm {
    /// w x y z
    #[default]
    Quaternion,
    /// roll, pitch, yaw (ZYX)
    Euler,
}

/// How many columns a quantity has; `None` where it has one a channel.
#[must_use]
pub fn column_count(quantity: Quantity, form: AttitudeForm) -> Option<usize> {
    match quantity {
        Quantity::Attitude | Quantity::AttitudeSetpoint => {
            Some(if form == AttitudeForm::Quaternion { 4 } else { 3 })
        }
        Quantity::RollYaw => Some(2),
        Quantity::AngularRate
        | Quantity::SpecificForce
        | Quantity::WorldAcceleration
        | Quantity::Position
        | Quantity::Velocity
        | Quantity::GpsVelocity
        | Quantity::TorqueSetpoint
        | Quantity::ThrustVectorSetpoint
        | Quantity::PositionSetpoint
        | Quantity::VelocitySetpoint
        | Quantity::AngularRateSetpoint
        | Quantity::AccelerationSetpoint => Some(3),
        Quantity::Wrench => Some(4),
        Quantity::ActuatorCommand | Quantity::ActuatorDemand | Quantity::RotorSpeed => None,
        Quantity::BatteryVoltage
        | Quantity::BatteryCurrent
        | Quantity::YawSetpoint
        | Quantity::YawRateSetpoint
        | Quantity::ThrustSetpoint
        | Quantity::BarometricHeight
        | Quantity::LandedState
        | Quantity::Armed
        | Quantity::BatteryCompensation
        | Quantity::Mode => Some(1),
    }
}

/// The axes of the values. For an attitude both its body and its world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxisFrame {
    /// forward-left-up and north-west-up, or a laboratory frame with z up
    #[default]
    FluNwu,
    /// forward-right-down and north-east-down
    FrdNed,
    /// forward-left-up and east-north-up
    FluEnu,
}

/// Unit of the cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name says the unit")]
pub enum CsvUnit {
    /// the quantity's SI unit, a ratio, or for pulse widths microseconds: taken as it is
    Si,
    Milliseconds,
    Microseconds,
    /// angles and rates
    Degrees,
    MilliradiansPerSecond,
    RevolutionsPerMinute,
    StandardGravity,
    MilliGravity,
    Millivolts,
    Centivolts,
    Centiamperes,
}

impl CsvUnit {
    /// A value in this unit, in SI.
    #[must_use]
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::Si => value,
            Self::Milliseconds => units::seconds_from_ms(value),
            Self::Microseconds => units::seconds_from_us(value),
            Self::Degrees => units::rad_from_deg(value),
            Self::MilliradiansPerSecond => units::rad_s_from_mrad_s(value),
            Self::RevolutionsPerMinute => units::rad_s_from_rpm(value),
            Self::StandardGravity => value * units::STANDARD_GRAVITY_M_S2,
            Self::MilliGravity => units::m_s2_from_milli_g(value),
            Self::Millivolts => units::volts_from_mv(value),
            Self::Centivolts => units::volts_from_cv(value),
            Self::Centiamperes => units::amperes_from_ca(value),
        }
    }
}
