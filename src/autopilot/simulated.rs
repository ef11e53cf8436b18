//! Whether an autopilot's parameters say that a simulator stands for its sensors.

/// Parameters with the device identifiers of the inertial sensors: ArduPilot's, PX4's.
const INERTIAL: [&str; 4] = ["INS_ACC_ID", "INS_GYR_ID", "CAL_ACC0_ID", "CAL_GYRO0_ID"];
/// The three lowest bits of a device identifier are the bus that the device is on.
const BUSES: f64 = 8.0;
/// The bus of simulated devices, in both autopilots: `BUS_TYPE_SITL` of ArduPilot's `AP_HAL/Device.h`,
/// `DeviceBusType_SIMULATION` of PX4's `drivers/device/Device.hpp`.
const SIMULATED_BUS: f64 = 4.0;
/// Identifiers have 24 bits.
const LARGEST: f64 = 16_777_216.0;
/// PX4's parameter for a simulator: hardware in the loop (1), simulation in hardware (2), and hardware in the loop that the autopilot
/// takes for a real vehicle, whose only trace in the log is this value (-1, `external HITL`).
const IN_THE_LOOP: &str = "SYS_HITL";

/// Whether the values of an autopilot's parameters, by name, say that its inertial unit is simulated.
#[must_use]
pub fn is_simulated(parameter: impl Fn(&str) -> Option<f64>) -> bool {
    let on_simulated_bus = |id: f64| id > 0.0 && id < LARGEST && id % BUSES == SIMULATED_BUS;
    INERTIAL.into_iter().filter_map(&parameter).any(on_simulated_bus)
        || parameter(IN_THE_LOOP).is_some_and(|value| [-1.0, 1.0, 2.0].contains(&value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bus_of_the_inertial_unit_tells_a_simulator() {
        let with = |name: &'static str, value: f64| is_simulated(|of| (of == name).then_some(value));
        // ArduCopter's and PX4's simulators
        assert!(with("INS_ACC_ID", 2_753_028.0) && with("CAL_GYRO0_ID", 1_310_988.0));
        // flight controllers with sensors on SPI
        assert!(!with("INS_ACC_ID", 1_442_082.0) && !with("INS_GYR_ID", 3_866_898.0));
        assert!([-1.0, 1.0, 2.0].into_iter().all(|value| with("SYS_HITL", value)) && !with("SYS_HITL", 0.0));
        assert!(!with("SYS_HITL", f64::NAN));
        // no identifier, or not one
        assert!(!with("INS_ACC_ID", 0.0) && !with("INS_ACC_ID", f64::NAN) && !with("INS_ACC_ID", 4e9));
        assert!(!is_simulated(|_| None));
    }
}
