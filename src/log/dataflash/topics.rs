//! Which messages become which streams: one row a stream.
//!
//! Where releases named a field otherwise, its names stand beside each other, the newest first.

use super::units::Unit;
use super::units::Unit::{
    Amperes, Degrees, DegreesPerSecond, Downwards, Metres, MetresPerSecond, MetresPerSecondSquared,
    Microseconds, Plain, RadiansPerSecond, RevolutionsPerMinute, Volts,
};
use super::values::{Convert, as_is, body, channels, course, euler, guided, quaternion, world};
use crate::recording::Quantity::{
    self, AccelerationSetpoint, ActuatorCommand, AngularRate, AngularRateSetpoint, Armed, Attitude,
    AttitudeSetpoint, BarometricHeight, BatteryCurrent, BatteryVoltage, GpsVelocity, LandedState, Position,
    PositionSetpoint, RotorSpeed, SpecificForce, ThrustSetpoint, TorqueSetpoint, Velocity, VelocitySetpoint,
};

/// A field by its names, and what it is in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    pub names: &'static [&'static str],
    pub unit: Unit,
}

/// One stream of one message.
#[derive(Debug, Clone, Copy)]
pub(super) struct Topic {
    pub message: &'static str,
    pub quantity: Quantity,
    pub columns: &'static [Column],
    pub convert: Convert,
    pub instance: Instance,
    /// name of the stream's source
    pub source: &'static str,
    /// the field with the time of the sample, where the message's own is that of its writing
    pub sampled: Option<&'static str>,
    /// the sample is of several messages, each of which holds a part of its values
    pub part: Option<Part>,
    pub demands: Demand,
}

/// Which sensor or output it is of.
#[derive(Debug, Clone, Copy)]
pub(super) enum Instance {
    /// the field that says it, where there is one; else 0
    Field,
    /// by the message's name
    Number(u8),
}

/// Which values of a sample a message holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// one, by its instance
    OfInstance,
    /// one, by the message's name
    Index(usize),
    /// all from here on; written at once with the others
    From(usize),
}

/// Under which circumstances a message can be used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Demand {
    /// whatever the release
    Nothing,
    /// all columns, or as many of the first as there are
    AsManyAsThere,
    /// release known: a number before Copter 3.4 was this many times one of now
    Rates(f64),
    /// the log says its units
    Units,
}

impl Topic {
    const fn new(
        message: &'static str,
        quantity: Quantity,
        columns: &'static [Column],
        convert: Convert,
    ) -> Self {
        Self {
            message,
            quantity,
            columns,
            convert,
            instance: Instance::Field,
            source: message,
            sampled: None,
            part: None,
            demands: Demand::Nothing,
        }
    }

    const fn number(self, number: u8) -> Self {
        Self { instance: Instance::Number(number), ..self }
    }

    const fn sampled(self, field: &'static str) -> Self {
        Self { sampled: Some(field), ..self }
    }

    const fn part(self, source: &'static str, part: Part) -> Self {
        Self { source, part: Some(part), ..self }
    }

    const fn demands(self, demands: Demand) -> Self {
        Self { demands, ..self }
    }
}

const fn c(names: &'static [&'static str], unit: Unit) -> Column {
    Column { names, unit }
}

const GYRO: &[Column] =
    &[c(&["GyrX"], RadiansPerSecond), c(&["GyrY"], RadiansPerSecond), c(&["GyrZ"], RadiansPerSecond)];
const ACCELEROMETER: &[Column] = &[
    c(&["AccX"], MetresPerSecondSquared),
    c(&["AccY"], MetresPerSecondSquared),
    c(&["AccZ"], MetresPerSecondSquared),
];
const EULER: &[Column] = &[c(&["Roll"], Degrees), c(&["Pitch"], Degrees), c(&["Yaw"], Degrees)];
const DESIRED: &[Column] = &[c(&["DesRoll"], Degrees), c(&["DesPitch"], Degrees), c(&["DesYaw"], Degrees)];
const QUATERNION: &[Column] = &[c(&["Q1"], Plain), c(&["Q2"], Plain), c(&["Q3"], Plain), c(&["Q4"], Plain)];
const PLACE: &[Column] = &[c(&["PN"], Metres), c(&["PE"], Metres), c(&["PD"], Metres)];
const SPEED: &[Column] =
    &[c(&["VN"], MetresPerSecond), c(&["VE"], MetresPerSecond), c(&["VD"], MetresPerSecond)];
const COURSE: &[Column] = &[
    c(&["Spd"], MetresPerSecond),
    c(&["GCrs"], Degrees),
    c(&["VZ"], MetresPerSecond),
    c(&["Status"], Plain),
];
const HEIGHT: &[Column] = &[c(&["Alt"], Metres)];
const CONTROLLED_HEIGHT: &[Column] = &[c(&["BAlt", "BarAlt"], Metres)];
const RATES: &[Column] =
    &[c(&["R"], DegreesPerSecond), c(&["P"], DegreesPerSecond), c(&["Y"], DegreesPerSecond)];
const DESIRED_RATES: &[Column] =
    &[c(&["RDes"], DegreesPerSecond), c(&["PDes"], DegreesPerSecond), c(&["YDes"], DegreesPerSecond)];
const TORQUE: &[Column] = &[c(&["ROut"], Plain), c(&["POut"], Plain), c(&["YOut"], Plain)];
const THRUST: &[Column] = &[c(&["AOut"], Plain)];
const VOLTAGE: &[Column] = &[c(&["Volt"], Volts)];
const CURRENT: &[Column] = &[c(&["Curr"], Amperes)];
const RPM: &[Column] = &[c(&["RPM"], RevolutionsPerMinute)];
const ARM_STATE: &[Column] = &[c(&["ArmState", "Armed"], Plain)];
const FLYING: &[Column] = &[c(&["isFlying"], Plain)];

const OUTPUTS: &[Column] = &[
    c(&["C1", "Ch1", "Chan1", "Mot1"], Microseconds),
    c(&["C2", "Ch2", "Chan2", "Mot2"], Microseconds),
    c(&["C3", "Ch3", "Chan3", "Mot3"], Microseconds),
    c(&["C4", "Ch4", "Chan4", "Mot4"], Microseconds),
    c(&["C5", "Ch5", "Chan5", "Mot5"], Microseconds),
    c(&["C6", "Ch6", "Chan6", "Mot6"], Microseconds),
    c(&["C7", "Ch7", "Chan7", "Mot7"], Microseconds),
    c(&["C8", "Ch8", "Chan8", "Mot8"], Microseconds),
    c(&["C9", "Ch9"], Microseconds),
    c(&["C10", "Ch10"], Microseconds),
    c(&["C11", "Ch11"], Microseconds),
    c(&["C12", "Ch12"], Microseconds),
    c(&["C13"], Microseconds),
    c(&["C14"], Microseconds),
];
const FURTHER_OUTPUTS: &[Column] = &[
    c(&["C15"], Microseconds),
    c(&["C16"], Microseconds),
    c(&["C17"], Microseconds),
    c(&["C18"], Microseconds),
];
const LAST_OUTPUTS: &[Column] = &[
    c(&["C19"], Microseconds),
    c(&["C20"], Microseconds),
    c(&["C21"], Microseconds),
    c(&["C22"], Microseconds),
    c(&["C23"], Microseconds),
    c(&["C24"], Microseconds),
    c(&["C25"], Microseconds),
    c(&["C26"], Microseconds),
    c(&["C27"], Microseconds),
    c(&["C28"], Microseconds),
    c(&["C29"], Microseconds),
    c(&["C30"], Microseconds),
    c(&["C31"], Microseconds),
    c(&["C32"], Microseconds),
];

/// What kind of target it is, and whether its height is above the ground.
const TARGET: [Column; 2] = [c(&["Type"], Plain), c(&["Terrain"], Plain)];
const TARGET_PLACE: &[Column] =
    &[TARGET[0], TARGET[1], c(&["pX"], Metres), c(&["pY"], Metres), c(&["pZ"], Downwards)];
const TARGET_SPEED: &[Column] =
    &[TARGET[0], TARGET[1], c(&["vX"], MetresPerSecond), c(&["vY"], MetresPerSecond), c(&["vZ"], Downwards)];
const TARGET_ACCELERATION: &[Column] = &[
    TARGET[0],
    TARGET[1],
    c(&["aX"], MetresPerSecondSquared),
    c(&["aY"], MetresPerSecondSquared),
    c(&["aZ"], Downwards),
];

const fn position(
    message: &'static str,
    quantity: Quantity,
    columns: &'static [Column],
    axis: usize,
) -> Topic {
    Topic::new(message, quantity, columns, world).part("PSC", Part::Index(axis))
}

/// Of the rate controller. `before` is how many times one of now a number before Copter 3.4 was: rates were in hundredths of
/// degrees, torques of 4500, thrusts of 1000.
const fn rate(quantity: Quantity, columns: &'static [Column], convert: Convert, before: f64) -> Topic {
    Topic::new("RATE", quantity, columns, convert).demands(Demand::Rates(before))
}

const fn outputs(message: &'static str, columns: &'static [Column], first: usize) -> Topic {
    let topic = Topic::new(message, ActuatorCommand, columns, channels).demands(Demand::AsManyAsThere);
    topic.part("RCOU", Part::From(first))
}

const fn rotor(message: &'static str, part: Part) -> Topic {
    Topic::new(message, RotorSpeed, RPM, as_is).part("ESC", part)
}

const fn target(quantity: Quantity, columns: &'static [Column]) -> Topic {
    Topic::new("GUIP", quantity, columns, guided).demands(Demand::Units)
}

const fn estimator(message: &'static str) -> [Topic; 3] {
    [
        Topic::new(message, Attitude, EULER, euler),
        Topic::new(message, Velocity, SPEED, world),
        Topic::new(message, Position, PLACE, world),
    ]
}

/// All streams that are read.
pub(super) const TOPICS: &[&[Topic]] = &[
    // raw sensors at their own rate
    &[
        Topic::new("GYR", AngularRate, GYRO, body).sampled("SampleUS"),
        Topic::new("GYR1", AngularRate, GYRO, body).number(0).sampled("SampleUS"),
        Topic::new("GYR2", AngularRate, GYRO, body).number(1).sampled("SampleUS"),
        Topic::new("GYR3", AngularRate, GYRO, body).number(2).sampled("SampleUS"),
        Topic::new("ACC", SpecificForce, ACCELEROMETER, body).sampled("SampleUS"),
        Topic::new("ACC1", SpecificForce, ACCELEROMETER, body).number(0).sampled("SampleUS"),
        Topic::new("ACC2", SpecificForce, ACCELEROMETER, body).number(1).sampled("SampleUS"),
        Topic::new("ACC3", SpecificForce, ACCELEROMETER, body).number(2).sampled("SampleUS"),
    ],
    // filtered ones at the rate of the log
    &[
        Topic::new("IMU", AngularRate, GYRO, body),
        Topic::new("IMU2", AngularRate, GYRO, body).number(1),
        Topic::new("IMU3", AngularRate, GYRO, body).number(2),
        Topic::new("IMU", SpecificForce, ACCELEROMETER, body),
        Topic::new("IMU2", SpecificForce, ACCELEROMETER, body).number(1),
        Topic::new("IMU3", SpecificForce, ACCELEROMETER, body).number(2),
    ],
    // attitude and what was asked for
    &[
        Topic::new("ANG", Attitude, EULER, euler),
        Topic::new("ANG", AttitudeSetpoint, DESIRED, euler),
        Topic::new("ATT", Attitude, EULER, euler),
        Topic::new("ATT", AttitudeSetpoint, DESIRED, euler),
        Topic::new("AHR2", Attitude, QUATERNION, quaternion),
    ],
    // estimators; further cores had messages of their own until 2020
    &estimator("XKF1"),
    &estimator("NKF1"),
    &estimator("EKF1"),
    // satellites and air pressure
    &[
        Topic::new("GPS", GpsVelocity, COURSE, course),
        Topic::new("GPS2", GpsVelocity, COURSE, course).number(1),
        Topic::new("BARO", BarometricHeight, HEIGHT, as_is),
        Topic::new("BAR2", BarometricHeight, HEIGHT, as_is).number(1),
        Topic::new("BAR3", BarometricHeight, HEIGHT, as_is).number(2),
        // where the others are not logged, as before 3.2
        Topic::new("CTUN", BarometricHeight, CONTROLLED_HEIGHT, as_is),
    ],
    // rate controller and outputs
    &[
        rate(AngularRate, RATES, body, 100.0),
        rate(AngularRateSetpoint, DESIRED_RATES, body, 100.0),
        rate(TorqueSetpoint, TORQUE, body, 4500.0),
        rate(ThrustSetpoint, THRUST, as_is, 1000.0),
        outputs("RCOU", OUTPUTS, 0),
        outputs("RCO2", FURTHER_OUTPUTS, 14),
        outputs("RCO3", LAST_OUTPUTS, 18),
        // before 3.2
        Topic::new("MOT", ActuatorCommand, OUTPUTS, channels).demands(Demand::AsManyAsThere),
        rotor("ESC", Part::OfInstance),
    ],
    // a message each before 4.1
    &[
        rotor("ESC1", Part::Index(0)),
        rotor("ESC2", Part::Index(1)),
        rotor("ESC3", Part::Index(2)),
        rotor("ESC4", Part::Index(3)),
        rotor("ESC5", Part::Index(4)),
        rotor("ESC6", Part::Index(5)),
        rotor("ESC7", Part::Index(6)),
        rotor("ESC8", Part::Index(7)),
    ],
    // what was asked for in GUIDED
    &[
        target(PositionSetpoint, TARGET_PLACE),
        target(VelocitySetpoint, TARGET_SPEED),
        target(AccelerationSetpoint, TARGET_ACCELERATION),
    ],
    // position controller, an axis a message
    &[
        position("PSCN", PositionSetpoint, &[c(&["DPN", "TPN"], Metres)], 0),
        position("PSCE", PositionSetpoint, &[c(&["DPE", "TPE"], Metres)], 1),
        position("PSCD", PositionSetpoint, &[c(&["DPD", "TPD"], Metres)], 2),
        position("PSCN", VelocitySetpoint, &[c(&["DVN"], MetresPerSecond)], 0),
        position("PSCE", VelocitySetpoint, &[c(&["DVE"], MetresPerSecond)], 1),
        position("PSCD", VelocitySetpoint, &[c(&["DVD"], MetresPerSecond)], 2),
        position("PSCN", AccelerationSetpoint, &[c(&["DAN"], MetresPerSecondSquared)], 0),
        position("PSCE", AccelerationSetpoint, &[c(&["DAE"], MetresPerSecondSquared)], 1),
        position("PSCD", AccelerationSetpoint, &[c(&["DAD"], MetresPerSecondSquared)], 2),
    ],
    // battery and arming
    &[
        Topic::new("BAT", BatteryVoltage, VOLTAGE, as_is),
        Topic::new("BAT", BatteryCurrent, CURRENT, as_is),
        Topic::new("BAT2", BatteryVoltage, VOLTAGE, as_is).number(1),
        Topic::new("BAT2", BatteryCurrent, CURRENT, as_is).number(1),
        Topic::new("CURR", BatteryVoltage, VOLTAGE, as_is),
        Topic::new("CURR", BatteryCurrent, CURRENT, as_is),
        Topic::new("CUR2", BatteryVoltage, VOLTAGE, as_is).number(1),
        Topic::new("CUR2", BatteryCurrent, CURRENT, as_is).number(1),
        Topic::new("ARM", Armed, ARM_STATE, as_is),
        // planes
        Topic::new("STAT", Armed, ARM_STATE, as_is),
        Topic::new("STAT", LandedState, FLYING, as_is),
    ],
];
