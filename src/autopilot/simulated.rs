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

/// The parameters by which [`is_simulated`] tells: what a vehicle is asked for.
pub const TELLS_SIMULATED: [&str; 5] =
    ["INS_ACC_ID", "INS_GYR_ID", "CAL_ACC0_ID", "CAL_GYRO0_ID", IN_THE_LOOP];
/// What the parameters of a simulator itself begin with: PX4's simulation in hardware, and what simulates for either autopilot.
const OF_SIMULATOR: [&str; 2] = ["SIH_", "SIM_"];

/// The parameters of a file, by name and value, that a simulator has and an aircraft has no use for. Boards have such parameters as
/// well: a file with all parameters of an aircraft, known by the identifiers of its sensors, has none.
#[must_use]
pub fn of_simulator(file: &[(String, f64)]) -> Vec<&str> {
    let value = |wanted: &str| file.iter().find(|(name, _)| name == wanted).map(|(_, value)| *value);
    if INERTIAL.into_iter().any(|name| value(name).is_some()) && !is_simulated(value) {
        return Vec::new();
    }
    let names = file.iter().map(|(name, _)| name.as_str());
    names.filter(|name| OF_SIMULATOR.into_iter().any(|begin| name.starts_with(begin))).collect()
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
        assert!(TELLS_SIMULATED[..4] == INERTIAL);
    }

    #[test]
    fn a_file_for_a_simulator_is_told_from_all_parameters_of_an_aircraft() {
        let file = |parameters: &[(&str, f64)]| -> Vec<(String, f64)> {
            parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
        };
        let sih = [("SIH_MASS", 1.5), ("THR_MDL_FAC", 0.0), ("SIH_KDV", 0.3)];
        assert_eq!(of_simulator(&file(&sih)), ["SIH_MASS", "SIH_KDV"]);
        assert_eq!(of_simulator(&file(&[("SIM_WIND_SPD", 4.0)])), ["SIM_WIND_SPD"]);
        assert!(of_simulator(&file(&[("EKF2_MCOEF", 0.2), ("MPC_THR_HOVER", 0.5)])).is_empty());
        // all that a board on SPI has, and all that a simulator has
        let whole = |id: f64| file(&[&sih[..], &[("CAL_ACC0_ID", id)][..]].concat());
        assert!(of_simulator(&whole(2_490_378.0)).is_empty());
        assert_eq!(of_simulator(&whole(1_310_988.0)).len(), 2);
    }
}
