//! The messages that are read, and where each keeps its time.

use crate::wire::clock::Stamp;
use crate::wire::frame::Payload;

/// How a message keeps its time.
#[derive(Clone, Copy)]
enum TimeField {
    Absent,
    BootMs,
    BootUs32,
    Us,
    /// SYSTEM_TIME: behind the Unix time
    BootMsAt8,
}

macro_rules! sources {
    ($($variant:ident = $id:literal, $name:literal, $time:ident;)*) => {
        /// A message that is read.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[allow(missing_docs)] // the variants are MAVLink's own names
        pub enum Source { $($variant,)* }

        impl Source {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The message of this id, if it is read.
            #[must_use]
            pub fn from_message_id(id: u32) -> Option<Self> {
                match id { $($id => Some(Self::$variant),)* _ => None }
            }

            /// Its MAVLink id.
            #[must_use]
            pub fn message_id(self) -> u32 {
                match self { $(Self::$variant => $id,)* }
            }

            /// Its MAVLink name.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            fn time_field(self) -> TimeField {
                match self { $(Self::$variant => TimeField::$time,)* }
            }
        }
    };
}

sources! {
    Heartbeat = 0, "HEARTBEAT", Absent;
    SysStatus = 1, "SYS_STATUS", Absent;
    SystemTime = 2, "SYSTEM_TIME", BootMsAt8;
    ParamValue = 22, "PARAM_VALUE", Absent;
    // its stamp counts from the boot or from 1970: it stands where it arrived
    GpsRawInt = 24, "GPS_RAW_INT", Absent;
    ScaledImu = 26, "SCALED_IMU", BootMs;
    RawImu = 27, "RAW_IMU", Us;
    Attitude = 30, "ATTITUDE", BootMs;
    AttitudeQuaternion = 31, "ATTITUDE_QUATERNION", BootMs;
    LocalPositionNed = 32, "LOCAL_POSITION_NED", BootMs;
    ServoOutputRaw = 36, "SERVO_OUTPUT_RAW", BootUs32;
    SetAttitudeTarget = 82, "SET_ATTITUDE_TARGET", Absent;
    AttitudeTarget = 83, "ATTITUDE_TARGET", BootMs;
    SetPositionTargetLocalNed = 84, "SET_POSITION_TARGET_LOCAL_NED", Absent;
    PositionTargetLocalNed = 85, "POSITION_TARGET_LOCAL_NED", BootMs;
    HighresImu = 105, "HIGHRES_IMU", Us;
    ScaledImu2 = 116, "SCALED_IMU2", BootMs;
    ScaledImu3 = 129, "SCALED_IMU3", BootMs;
    BatteryStatus = 147, "BATTERY_STATUS", Absent;
    ExtendedSysState = 245, "EXTENDED_SYS_STATE", Absent;
    Statustext = 253, "STATUSTEXT", Absent;
    EscStatus = 291, "ESC_STATUS", Us;
    Odometry = 331, "ODOMETRY", Us;
    ActuatorOutputStatus = 375, "ACTUATOR_OUTPUT_STATUS", Us;
    CurrentMode = 436, "CURRENT_MODE", Absent;
    EscTelemetry1To4 = 11030, "ESC_TELEMETRY_1_TO_4", Absent;
    EscTelemetry5To8 = 11031, "ESC_TELEMETRY_5_TO_8", Absent;
    EscTelemetry9To12 = 11032, "ESC_TELEMETRY_9_TO_12", Absent;
}

impl Source {
    /// Samples of this message stand where their own stamp says, not where the host's does.
    #[must_use]
    pub fn has_own_time(self) -> bool {
        !matches!(self.time_field(), TimeField::Absent)
    }

    /// The message's own time. Setpoints that a ground station sends carry its clock, not the vehicle's:
    /// none.
    #[must_use]
    pub fn stamp(self, payload: Payload<'_>) -> Stamp {
        match self.time_field() {
            TimeField::Absent => Stamp::Absent,
            TimeField::BootMs => Stamp::BootMs(payload.u32(0)),
            TimeField::BootUs32 => Stamp::BootUs32(payload.u32(0)),
            TimeField::Us => Stamp::Us(payload.u64(0)),
            TimeField::BootMsAt8 => Stamp::BootMs(payload.u32(8)),
        }
    }
}
