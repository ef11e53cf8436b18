//! Estimator, sensors and battery as the vehicle reports them, read by byte offset.

use crate::wire::Payload;

/// Flags that ESTIMATOR_STATUS and EKF_STATUS_REPORT share.
const ATTITUDE: u16 = 1;
const VELOCITY_HORIZONTAL: u16 = 1 << 1;
const VELOCITY_VERTICAL: u16 = 1 << 2;
const POSITION_RELATIVE: u16 = 1 << 3;
const POSITION_ABSOLUTE: u16 = 1 << 4;
const HEIGHT_ABSOLUTE: u16 = 1 << 5;
const HEIGHT_ABOVE_GROUND: u16 = 1 << 6;
const CONSTANT_POSITION: u16 = 1 << 7;
/// Its predicted position is good with the present aiding.
const PREDICTED: u16 = 1 << 8 | 1 << 9;
/// Innovation test ratio above which the autopilot rejects the measurement.
const RATIO_MAX: f64 = 1.0;

/// Status of the estimator.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EstimatorReport {
    /// faults of its position; empty if it is good
    pub faults: Vec<String>,
}

impl EstimatorReport {
    /// Status from ESTIMATOR_STATUS (PX4). "Constant position" is also reported by a vehicle on the ground, whose
    /// position is good; the position is invented only if nothing aids the estimator.
    #[must_use]
    pub fn from_estimator_status(payload: Payload<'_>) -> Self {
        let ratios = [("velocity", 8), ("horizontal position", 12), ("vertical position", 16)];
        let flags = payload.u16(40);
        let stands = flags & PREDICTED != 0;
        let flags = if stands { flags & !CONSTANT_POSITION } else { flags };
        Self::new(flags, ratios.map(|(name, offset)| (name, payload.f32(offset))))
    }

    /// Status from EKF_STATUS_REPORT (ArduPilot).
    #[must_use]
    pub fn from_ekf_status_report(payload: Payload<'_>) -> Self {
        let ratios = [("velocity", 0), ("horizontal position", 4), ("vertical position", 8)];
        Self::new(payload.u16(20), ratios.map(|(name, offset)| (name, payload.f32(offset))))
    }

    fn new(flags: u16, ratios: [(&str, f64); 3]) -> Self {
        let mut faults = Vec::new();
        for (any_of, name) in [
            (ATTITUDE, "no attitude"),
            (VELOCITY_HORIZONTAL, "no horizontal velocity"),
            (VELOCITY_VERTICAL, "no vertical velocity"),
            (POSITION_RELATIVE | POSITION_ABSOLUTE, "no horizontal position"),
            (HEIGHT_ABSOLUTE | HEIGHT_ABOVE_GROUND, "no height"),
        ] {
            if flags & any_of == 0 {
                faults.push(name.to_owned());
            }
        }
        if flags & CONSTANT_POSITION != 0 {
            faults.push("position is held constant".to_owned());
        }
        for (name, ratio) in ratios {
            if ratio > RATIO_MAX {
                faults.push(format!("{name} test ratio {ratio:.2}, at most {RATIO_MAX} is good"));
            }
        }
        Self { faults }
    }

    /// Whether its position is good.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.faults.is_empty()
    }
}

/// MAV_SYS_STATUS_SENSOR bits of the parts that a flight needs.
const WATCHED: [(u32, &str); 4] = [
    (1 << 11, "attitude stabilization"),
    (1 << 13, "height control"),
    (1 << 14, "position control"),
    (1 << 21, "attitude estimate"),
];
const PRE_ARM: u32 = 1 << 28;

/// SYS_STATUS.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SystemReport {
    /// parts that are enabled and not healthy
    pub unhealthy: Vec<&'static str>,
    /// the autopilot's own pre-arm checks; `None` without a report
    pub may_arm: Option<bool>,
    /// percent; `None` where not measured
    pub battery_percent: Option<i8>,
}

impl SystemReport {
    /// From the payload.
    #[must_use]
    pub fn from_sys_status(payload: Payload<'_>) -> Self {
        let (present, enabled, health) = (payload.u32(0), payload.u32(4), payload.u32(8));
        let bad = |bit: u32| enabled & bit != 0 && health & bit == 0;
        // PX4 shows the pre-arm bit in `health` alone
        let says = (present | enabled | health) & PRE_ARM != 0;
        let [percent, _] = payload.i16(30).to_le_bytes();
        let percent = i8::from_le_bytes([percent]);
        Self {
            unhealthy: WATCHED.iter().filter(|(bit, _)| bad(*bit)).map(|(_, name)| *name).collect(),
            may_arm: says.then_some(health & PRE_ARM != 0),
            battery_percent: (percent >= 0).then_some(percent),
        }
    }
}

/// Level of the battery for a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BatteryLevel {
    /// enough, or not known
    Good,
    /// no new trajectory
    Low,
    /// the vehicle must land
    Critical,
}

/// Percent below which a battery without a state of its own counts as low, and as critical.
const LOW_PERCENT: i8 = 20;
const CRITICAL_PERCENT: i8 = 10;

/// Level of a percentage.
#[must_use]
pub fn level_of_percent(percent: i8) -> BatteryLevel {
    match percent {
        _ if percent < CRITICAL_PERCENT => BatteryLevel::Critical,
        _ if percent < LOW_PERCENT => BatteryLevel::Low,
        _ => BatteryLevel::Good,
    }
}

/// Level from BATTERY_STATUS, by its charge state or else by its percentage; and the percentage.
#[must_use]
pub fn battery_status(payload: Payload<'_>) -> (BatteryLevel, Option<i8>) {
    let percent = i8::from_le_bytes([payload.u8(35)]);
    let percent = (percent >= 0).then_some(percent);
    let level = match payload.u8(40) {
        // undefined
        0 => percent.map_or(BatteryLevel::Good, level_of_percent),
        2 => BatteryLevel::Low,
        // critical, emergency, failed, unhealthy
        3..=6 => BatteryLevel::Critical,
        _ => BatteryLevel::Good,
    };
    (level, percent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimator_is_good_with_position_and_small_ratios() {
        let mut report = [0_u8; 22];
        report[20..].copy_from_slice(&0b11_0111_u16.to_le_bytes());
        assert!(EstimatorReport::from_ekf_status_report(Payload(&report)).is_good());
        report[4..8].copy_from_slice(&1.5_f32.to_le_bytes());
        let faults = EstimatorReport::from_ekf_status_report(Payload(&report)).faults;
        assert_eq!(faults, ["horizontal position test ratio 1.50, at most 1 is good"]);
        report[20..].copy_from_slice(&0b1010_0111_u16.to_le_bytes());
        let faults = EstimatorReport::from_ekf_status_report(Payload(&report)).faults;
        assert!(faults.contains(&"position is held constant".to_owned()), "{faults:?}");
    }

    #[test]
    fn a_px4_that_stands_on_the_ground_has_its_position() {
        let mut report = [0_u8; 42];
        for (flags, faults) in [
            (0b11_1111_1111_u16, &[][..]),
            (0b11_0111_1111, &[]),
            (0b00_1010_0111, &["no horizontal position", "position is held constant"]),
            (0b00_1011_1111, &["position is held constant"]),
        ] {
            report[40..].copy_from_slice(&flags.to_le_bytes());
            assert_eq!(EstimatorReport::from_estimator_status(Payload(&report)).faults, faults, "{flags:b}");
        }
    }

    #[test]
    fn what_is_off_is_not_unhealthy() {
        let mut status = [0_u8; 31];
        status[4..8].copy_from_slice(&(1_u32 << 14).to_le_bytes());
        status[30] = 0xFF;
        let report = SystemReport::from_sys_status(Payload(&status));
        assert_eq!(report.unhealthy, ["position control"]);
        assert_eq!((report.may_arm, report.battery_percent), (None, None));
        status[4..8].fill(0);
        assert!(SystemReport::from_sys_status(Payload(&status)).unhealthy.is_empty());
    }

    #[test]
    fn a_battery_without_a_state_is_judged_by_percent() {
        let mut status = [0_u8; 41];
        for (percent, level) in
            [(50, BatteryLevel::Good), (15, BatteryLevel::Low), (5, BatteryLevel::Critical)]
        {
            status[35] = percent;
            assert_eq!(battery_status(Payload(&status)).0, level);
        }
        status[40] = 2;
        assert_eq!(battery_status(Payload(&status)).0, BatteryLevel::Low);
    }
}
