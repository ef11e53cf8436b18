//! Which messages each autopilot sends, unasked and asked, and what becomes of an interval that is asked for.

use std::collections::BTreeMap;
use std::time::Duration;

use super::{Firmware, LinkRole};
use crate::wire::message_id::{
    ACTUATOR_OUTPUT_STATUS, ALTITUDE, ATTITUDE, ATTITUDE_QUATERNION, ATTITUDE_TARGET, AUTOPILOT_VERSION,
    BATTERY_STATUS, CURRENT_EVENT_SEQUENCE, CURRENT_MODE, EKF_STATUS_REPORT, ESC_INFO, ESC_STATUS,
    ESC_TELEMETRY_1_TO_4, ESTIMATOR_STATUS, EXTENDED_SYS_STATE, GLOBAL_POSITION_INT, GPS_GLOBAL_ORIGIN,
    GPS_RAW_INT, HIGHRES_IMU, HOME_POSITION, LINK_NODE_STATUS, LOCAL_POSITION_NED, ODOMETRY, PING,
    POSITION_TARGET_LOCAL_NED, RAW_IMU, RC_CHANNELS, RPM, SCALED_IMU2, SERVO_OUTPUT_RAW, SYS_STATUS,
    SYSTEM_TIME, TIMESYNC, VFR_HUD,
};

/// Messages of PX4 with rates on its ground-station link and on its onboard link, Hz.
const PX4: &[(u32, f64, f64)] = &[
    (SYS_STATUS, 1.0, 5.0),
    (SYSTEM_TIME, 1.0, 1.0),
    (PING, 0.1, 0.1),
    (LINK_NODE_STATUS, 1.0, 1.0),
    (GPS_RAW_INT, 1.0, 5.0),
    (ATTITUDE, 50.0, 100.0),
    (ATTITUDE_QUATERNION, 10.0, 50.0),
    (LOCAL_POSITION_NED, 30.0, 30.0),
    (GLOBAL_POSITION_INT, 10.0, 50.0),
    (SERVO_OUTPUT_RAW, 50.0, 10.0),
    (GPS_GLOBAL_ORIGIN, 1.0, 1.0),
    (RC_CHANNELS, 5.0, 20.0),
    (VFR_HUD, 4.0, 10.0),
    (ATTITUDE_TARGET, 2.0, 10.0),
    (POSITION_TARGET_LOCAL_NED, 1.5, 10.0),
    (HIGHRES_IMU, 0.0, 50.0),
    (TIMESYNC, 1.0, 10.0),
    (ALTITUDE, 1.0, 10.0),
    (BATTERY_STATUS, 0.5, 0.5),
    (AUTOPILOT_VERSION, 0.0, 0.0),
    (ESTIMATOR_STATUS, 0.5, 1.0),
    (HOME_POSITION, 0.5, 1.0),
    (EXTENDED_SYS_STATE, 1.0, 5.0),
    (ESC_INFO, 1.0, 1.0),
    (ESC_STATUS, 1.0, 10.0),
    (ODOMETRY, 0.0, 30.0),
    (ACTUATOR_OUTPUT_STATUS, 0.0, 0.0),
    (CURRENT_EVENT_SEQUENCE, 0.5, 0.5),
    (CURRENT_MODE, 0.5, 0.5),
];

/// Messages of ArduPilot; only TIMESYNC comes unasked.
const ARDUPILOT: &[u32] = &[
    SYS_STATUS,
    SYSTEM_TIME,
    GPS_RAW_INT,
    RAW_IMU,
    ATTITUDE,
    ATTITUDE_QUATERNION,
    LOCAL_POSITION_NED,
    GLOBAL_POSITION_INT,
    SERVO_OUTPUT_RAW,
    GPS_GLOBAL_ORIGIN,
    RC_CHANNELS,
    VFR_HUD,
    ATTITUDE_TARGET,
    POSITION_TARGET_LOCAL_NED,
    TIMESYNC,
    SCALED_IMU2,
    BATTERY_STATUS,
    AUTOPILOT_VERSION,
    EKF_STATUS_REPORT,
    RPM,
    HOME_POSITION,
    EXTENDED_SYS_STATE,
    ESC_TELEMETRY_1_TO_4,
];

/// Groups of REQUEST_DATA_STREAM.
const GROUPS: &[(u8, &[u32])] = &[
    (1, &[RAW_IMU, SCALED_IMU2]),
    (2, &[SYS_STATUS, GPS_RAW_INT]),
    (3, &[SERVO_OUTPUT_RAW, RC_CHANNELS]),
    (6, &[LOCAL_POSITION_NED, GLOBAL_POSITION_INT]),
    (10, &[ATTITUDE, ESC_TELEMETRY_1_TO_4]),
    (11, &[VFR_HUD]),
    (12, &[BATTERY_STATUS, EKF_STATUS_REPORT, SYSTEM_TIME, RPM]),
];

/// ArduPilot refuses whatever is faster than this share of its loop rate (-).
const ARDUPILOT_LOAD: f64 = 0.8;
/// How much longer ArduPilot's intervals are while parameters are downloaded.
const DOWNLOAD_SLOWDOWN: u32 = 4;
/// PX4 sends this much before the end of an interval: 0.3 of its loop's least delay of 1.5 ms.
const PX4_EARLY: Duration = Duration::from_micros(450);
/// PX4's position estimate is new at this period.
const PX4_ESTIMATE_PERIOD: Duration = Duration::from_micros(8000);

/// Why an interval is not set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IntervalRefusal {
    /// this autopilot never sends the message
    UnknownMessage,
    /// faster than it can
    TooFast,
}

/// PX4 tells its mode so often where it does not change.
const PX4_MODE_PERIOD: Duration = Duration::from_millis(500);

#[derive(Debug, Clone, Copy)]
struct Stream {
    id: u32,
    /// none: switched off
    interval: Option<Duration>,
    default: Option<Duration>,
    last: Option<Duration>,
}

/// The messages that one link carries by themselves.
#[derive(Debug)]
pub(super) struct Streams {
    kind: Firmware,
    all: BTreeMap<u32, Stream>,
    mode_changed: bool,
}

fn period(rate_hz: f64) -> Option<Duration> {
    (rate_hz > 0.0).then(|| Duration::from_secs_f64(1.0 / rate_hz))
}

impl Streams {
    pub(super) fn new(kind: Firmware, role: LinkRole) -> Self {
        let stream = |id: u32, rate_hz: f64| {
            let default = period(rate_hz);
            (id, Stream { id, interval: default, default, last: None })
        };
        let all = if kind.is_px4() {
            let rate_hz =
                |ground_hz, onboard_hz| if role == LinkRole::Onboard { onboard_hz } else { ground_hz };
            PX4.iter()
                .map(|(id, ground_hz, onboard_hz)| stream(*id, rate_hz(*ground_hz, *onboard_hz)))
                .collect()
        } else {
            ARDUPILOT.iter().map(|id| stream(*id, if *id == TIMESYNC { 0.1 } else { 0.0 })).collect()
        };
        Self { kind, all, mode_changed: false }
    }

    /// This autopilot can send the message.
    pub(super) fn has(&self, id: u32) -> bool {
        self.all.contains_key(&id)
    }

    /// MAV_CMD_SET_MESSAGE_INTERVAL: microseconds, 0 the default, negative off.
    pub(super) fn set_interval(&mut self, id: u32, interval_us: f64) -> Result<(), IntervalRefusal> {
        let kind = self.kind;
        let stream = self.all.get_mut(&id).ok_or(IntervalRefusal::UnknownMessage)?;
        if interval_us < 0.0 || !interval_us.is_finite() {
            stream.interval = None;
            return Ok(());
        }
        if interval_us < 1.0 {
            stream.interval = stream.default;
            return Ok(());
        }
        let asked = Duration::from_secs_f64(interval_us * 1e-6);
        stream.interval = Some(if kind.is_px4() { asked } else { ardupilot_interval(asked, kind)? });
        Ok(())
    }

    /// REQUEST_DATA_STREAM: a group of messages at one rate, Hz.
    pub(super) fn set_group(&mut self, group: u8, rate_hz: f64) {
        for (number, ids) in GROUPS {
            if group != 0 && group != *number {
                continue;
            }
            for id in *ids {
                let interval_us = if rate_hz > 0.0 { 1e6 / rate_hz } else { -1.0 };
                // what is too fast keeps its rate
                let _ = self.set_interval(*id, interval_us);
            }
        }
    }

    /// Microseconds between messages, -1 where it is off; `None` where there is no such message.
    pub(super) fn interval_us(&self, id: u32) -> Option<i32> {
        let stream = self.all.get(&id)?;
        Some(stream.interval.map_or(-1, |interval| i32::try_from(interval.as_micros()).unwrap_or(i32::MAX)))
    }

    /// The mode is another one.
    pub(super) fn mode_changed(&mut self) {
        self.mode_changed = true;
    }

    /// Messages that are due in this loop period; they count as sent.
    pub(super) fn due(&mut self, now: Duration, downloading: bool) -> Vec<u32> {
        let news = std::mem::take(&mut self.mode_changed);
        let kind = self.kind;
        let mut due = Vec::new();
        for stream in self.all.values_mut() {
            let is_due = match kind.is_px4() {
                true if stream.id == CURRENT_MODE => px4_mode_is_due(stream, now, news),
                true => px4_is_due(stream, now),
                false => ardupilot_is_due(stream, now, downloading),
            };
            if is_due {
                due.push(stream.id);
            }
        }
        due
    }
}

/// Whole milliseconds from 1 to 60000.
fn ardupilot_interval(asked: Duration, kind: Firmware) -> Result<Duration, IntervalRefusal> {
    let cut = Duration::from_millis(u64::try_from(asked.as_millis()).unwrap_or(u64::MAX).clamp(1, 60_000));
    if cut.mul_f64(ARDUPILOT_LOAD) < kind.loop_period() {
        return Err(IntervalRefusal::TooFast);
    }
    Ok(cut)
}

/// ArduPilot: the first loop period in which the interval has passed since the last message.
fn ardupilot_is_due(stream: &mut Stream, now: Duration, downloading: bool) -> bool {
    let Some(mut interval) = stream.interval else { return false };
    if downloading {
        interval *= DOWNLOAD_SLOWDOWN;
    }
    let due = stream.last.is_none_or(|last| now.saturating_sub(last) >= interval);
    if due {
        stream.last = Some(now);
    }
    due
}

/// PX4 (`MavlinkStream::update`): on its loop's grid, keeping the phase of the interval while it is less than
/// half an interval late.
fn px4_is_due(stream: &mut Stream, now: Duration) -> bool {
    let Some(interval) = stream.interval else { return false };
    let is_estimate = matches!(stream.id, LOCAL_POSITION_NED | GLOBAL_POSITION_INT | ODOMETRY);
    if is_estimate && !now.as_micros().is_multiple_of(PX4_ESTIMATE_PERIOD.as_micros()) {
        return false;
    }
    let Some(last) = stream.last else {
        stream.last = Some(now);
        return true;
    };
    let Some(passed) = now.checked_sub(last) else { return false };
    if passed + PX4_EARLY <= interval {
        return false;
    }
    stream.last = Some(if passed < interval.mul_f64(1.5) { last + interval } else { now });
    true
}

/// PX4 has a mode to tell when it changes and twice a second, however often it is asked for.
fn px4_mode_is_due(stream: &mut Stream, now: Duration, changed: bool) -> bool {
    let Some(interval) = stream.interval else { return false };
    let passed = stream.last.map(|last| now.saturating_sub(last));
    let due = changed || passed.is_none_or(|passed| passed + PX4_EARLY > interval.max(PX4_MODE_PERIOD));
    if due {
        stream.last = Some(now);
    }
    due
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured_hz(kind: Firmware, id: u32, asked_hz: f64) -> Result<f64, IntervalRefusal> {
        let mut streams = Streams::new(kind, LinkRole::GroundStation);
        streams.set_interval(id, 1e6 / asked_hz)?;
        let (mut now, mut count) = (Duration::ZERO, 0);
        while now < Duration::from_secs(20) {
            now += kind.loop_period();
            count += u32::from(streams.due(now, false).contains(&id));
        }
        Ok(f64::from(count) / 20.0)
    }

    #[test]
    fn rates_are_those_that_were_measured_of_both_autopilots() {
        let px4 = |id, asked_hz| measured_hz(Firmware::PX4, id, asked_hz);
        let near = |got: Result<f64, IntervalRefusal>, want: f64| {
            assert!((got.unwrap() - want).abs() < 0.011 * want, "{got:?} {want}");
        };
        near(px4(ATTITUDE, 100.0), 100.0);
        near(px4(ATTITUDE, 200.0), 125.0);
        near(px4(HIGHRES_IMU, 250.0), 250.0);
        near(px4(LOCAL_POSITION_NED, 250.0), 125.0);
        near(px4(CURRENT_MODE, 10.0), 2.0);
        let ardupilot = |asked_hz| measured_hz(Firmware::ARDUPILOT_4_7, ATTITUDE, asked_hz);
        near(ardupilot(100.0), 100.0);
        near(ardupilot(200.0), 200.0);
        near(ardupilot(250.0), 200.0);
        assert_eq!(ardupilot(400.0), Err(IntervalRefusal::TooFast));
    }

    #[test]
    fn each_autopilot_refuses_what_it_does_not_send() {
        let refused = Err(IntervalRefusal::UnknownMessage);
        let ardupilot = Firmware::ARDUPILOT_4_6;
        for id in [ESC_STATUS, ESC_INFO, ACTUATOR_OUTPUT_STATUS, ESTIMATOR_STATUS, ODOMETRY, ALTITUDE] {
            assert_eq!(measured_hz(ardupilot, id, 10.0), refused, "{id}");
        }
        for id in [RAW_IMU, ESC_TELEMETRY_1_TO_4, EKF_STATUS_REPORT] {
            assert_eq!(measured_hz(Firmware::PX4, id, 10.0), refused, "{id}");
        }
    }
}
