//! The messages, their rates and purposes.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega as dialect;

use crate::autopilot::Autopilot;

/// A need of flight or identification.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// angular rates of the body
    BodyRates,
    /// orientation of the body
    Attitude,
    /// position and velocity: also to fly
    Position,
    /// commands or speeds of the motors
    Actuators,
    /// acceleration, in addition to velocity
    Acceleration,
    /// setpoints as the autopilot uses them
    Setpoints,
    /// voltage and charge: to fly
    Battery,
    /// mode, landed or in the air: to fly
    State,
    /// health of the position estimate: to fly
    Estimator,
}

impl Need {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::BodyRates,
        Self::Attitude,
        Self::Position,
        Self::Actuators,
        Self::Acceleration,
        Self::Setpoints,
        Self::Battery,
        Self::State,
        Self::Estimator,
    ];

    /// For reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::BodyRates => "body rates",
            Self::Attitude => "attitude",
            Self::Position => "position and velocity",
            Self::Actuators => "actuator outputs",
            Self::Acceleration => "acceleration",
            Self::Setpoints => "the autopilot's setpoints",
            Self::Battery => "battery",
            Self::State => "mode and landed state",
            Self::Estimator => "health of the estimate",
        }
    }
}

/// One message to request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamRequest {
    /// MAVLink's id
    pub message_id: u32,
    /// MAVLink's name
    pub name: &'static str,
    /// messages a second to ask for
    pub rate_hz: f64,
    /// bytes of a frame on the wire
    pub frame_bytes: f64,
    /// what for
    pub needs: &'static [Need],
    /// requested only if the message of this id is refused or does not arrive
    pub instead_of: Option<u32>,
    /// the rate is the largest: the autopilot sends it at changes, and rarely otherwise
    pub on_change: bool,
}

const fn stream<M: MessageData>(rate_hz: f64, frame_bytes: f64, needs: &'static [Need]) -> StreamRequest {
    let (message_id, name) = (M::ID, M::NAME);
    StreamRequest { message_id, name, rate_hz, frame_bytes, needs, instead_of: None, on_change: false }
}

impl StreamRequest {
    const fn instead_of(self, message_id: u32) -> Self {
        Self { instead_of: Some(message_id), ..self }
    }

    const fn on_change(self) -> Self {
        Self { on_change: true, ..self }
    }

    const fn at(self, rate_hz: f64) -> Self {
        Self { rate_hz, ..self }
    }
}

const ATTITUDE_QUATERNION: StreamRequest =
    stream::<dialect::ATTITUDE_QUATERNION_DATA>(100.0, 48.0, &[Need::BodyRates, Need::Attitude]);
const HIGHRES_IMU: StreamRequest =
    stream::<dialect::HIGHRES_IMU_DATA>(100.0, 75.0, &[Need::BodyRates, Need::Acceleration]);
const RAW_IMU: StreamRequest =
    stream::<dialect::RAW_IMU_DATA>(100.0, 41.0, &[Need::BodyRates, Need::Acceleration])
        .instead_of(HIGHRES_IMU.message_id);
const SCALED_IMU: StreamRequest =
    stream::<dialect::SCALED_IMU_DATA>(100.0, 36.0, &[Need::BodyRates, Need::Acceleration])
        .instead_of(RAW_IMU.message_id);
const LOCAL_POSITION_NED: StreamRequest =
    stream::<dialect::LOCAL_POSITION_NED_DATA>(50.0, 40.0, &[Need::Position]);
const ODOMETRY: StreamRequest = stream::<dialect::ODOMETRY_DATA>(20.0, 245.0, &[Need::Position]);
const SERVO_OUTPUT_RAW: StreamRequest =
    stream::<dialect::SERVO_OUTPUT_RAW_DATA>(100.0, 49.0, &[Need::Actuators]);
const ACTUATOR_OUTPUT_STATUS: StreamRequest =
    stream::<dialect::ACTUATOR_OUTPUT_STATUS_DATA>(100.0, 40.0, &[Need::Actuators]);
const ESC_STATUS: StreamRequest = stream::<dialect::ESC_STATUS_DATA>(100.0, 69.0, &[Need::Actuators]);
const ESC_TELEMETRY: StreamRequest =
    stream::<dialect::ESC_TELEMETRY_1_TO_4_DATA>(100.0, 56.0, &[Need::Actuators]);
const ATTITUDE_TARGET: StreamRequest =
    stream::<dialect::ATTITUDE_TARGET_DATA>(50.0, 49.0, &[Need::Setpoints]);
/// Each 37 ms: at a period that goes into another station's 20, 50 or 100 ms, every report may fall on our setpoint, and
/// none on another's between ours. (Of 30 setpoints of another to an ArduPilot, 50 ms apart, 30 reports 50 ms
/// apart showed none.)
const POSITION_TARGET: StreamRequest =
    stream::<dialect::POSITION_TARGET_LOCAL_NED_DATA>(27.0, 63.0, &[Need::Setpoints]);
const BATTERY_STATUS: StreamRequest = stream::<dialect::BATTERY_STATUS_DATA>(2.0, 53.0, &[Need::Battery]);
const SYS_STATUS: StreamRequest =
    stream::<dialect::SYS_STATUS_DATA>(2.0, 43.0, &[Need::Battery, Need::State]);
const EXTENDED_SYS_STATE: StreamRequest =
    stream::<dialect::EXTENDED_SYS_STATE_DATA>(5.0, 14.0, &[Need::State]);
const CURRENT_MODE: StreamRequest =
    stream::<dialect::CURRENT_MODE_DATA>(10.0, 21.0, &[Need::State]).on_change();
const ESTIMATOR_STATUS: StreamRequest =
    stream::<dialect::ESTIMATOR_STATUS_DATA>(5.0, 54.0, &[Need::Estimator]);
const EKF_STATUS_REPORT: StreamRequest =
    stream::<dialect::EKF_STATUS_REPORT_DATA>(5.0, 38.0, &[Need::Estimator]);
const HOME_POSITION: StreamRequest = stream::<dialect::HOME_POSITION_DATA>(0.5, 72.0, &[]);
/// ArduPilot sends it to those who ask. A recording that lacks it does not tell a receiver from motion capture.
const GPS_RAW_INT: StreamRequest = stream::<dialect::GPS_RAW_INT_DATA>(5.0, 64.0, &[]);
const GPS_GLOBAL_ORIGIN: StreamRequest = stream::<dialect::GPS_GLOBAL_ORIGIN_DATA>(0.5, 32.0, &[]);

const PX4: &[StreamRequest] = &[
    ATTITUDE_QUATERNION,
    HIGHRES_IMU,
    LOCAL_POSITION_NED,
    ODOMETRY,
    SERVO_OUTPUT_RAW,
    ACTUATOR_OUTPUT_STATUS,
    ESC_STATUS,
    ATTITUDE_TARGET,
    POSITION_TARGET,
    BATTERY_STATUS,
    SYS_STATUS,
    EXTENDED_SYS_STATE,
    CURRENT_MODE,
    ESTIMATOR_STATUS,
    HOME_POSITION,
    GPS_GLOBAL_ORIGIN,
];

const ARDUPILOT: &[StreamRequest] = &[
    ATTITUDE_QUATERNION,
    HIGHRES_IMU,
    RAW_IMU,
    SCALED_IMU,
    LOCAL_POSITION_NED,
    SERVO_OUTPUT_RAW,
    ESC_TELEMETRY,
    ATTITUDE_TARGET,
    POSITION_TARGET,
    BATTERY_STATUS,
    SYS_STATUS,
    EXTENDED_SYS_STATE,
    EKF_STATUS_REPORT,
    HOME_POSITION,
    GPS_RAW_INT,
    GPS_GLOBAL_ORIGIN,
];

/// The set that identification needs, without messages that an autopilot is known to refuse, so that refusals are
/// meaningful.
#[must_use]
pub fn request_set(autopilot: Autopilot) -> Vec<StreamRequest> {
    match autopilot {
        Autopilot::Px4 => PX4.to_vec(),
        Autopilot::ArduPilot => ARDUPILOT.to_vec(),
        Autopilot::Other | Autopilot::Unknown => {
            let mut all = PX4.to_vec();
            all.extend(ARDUPILOT.iter().filter(|stream| PX4.iter().all(|of| of.name != stream.name)));
            all
        }
    }
}

/// The set that the flight needs, for a link on which the whole set does not fit: identification then uses the on-board
/// log.
#[must_use]
pub fn slow_request_set(autopilot: Autopilot) -> Vec<StreamRequest> {
    let estimator = match autopilot {
        Autopilot::Px4 => ESTIMATOR_STATUS,
        _ => EKF_STATUS_REPORT,
    };
    let mode = (autopilot == Autopilot::Px4).then_some(CURRENT_MODE.at(5.0));
    [
        ATTITUDE_QUATERNION.at(10.0),
        LOCAL_POSITION_NED.at(10.0),
        BATTERY_STATUS.at(0.5),
        SYS_STATUS.at(0.5),
        EXTENDED_SYS_STATE.at(2.0),
        estimator.at(1.0),
        HOME_POSITION.at(0.2),
        GPS_GLOBAL_ORIGIN.at(0.2),
    ]
    .into_iter()
    .chain(mode)
    .collect()
}
