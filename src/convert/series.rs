//! Named series of one clock.

use crate::diagnose::CHANNEL_NAMES;
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use crate::study::ExplainStudy;

/// Samples of several values on the vehicle's clock.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeSeries {
    /// `attitude/ATTITUDE`, `residual/force x`: quantity and source
    pub name: String,
    /// of each value
    pub columns: Vec<String>,
    /// SI; empty where it has none
    pub unit: &'static str,
    /// s
    pub time_s: Vec<f64>,
    /// one row a sample, one column a value
    pub values: Vec<f64>,
}

impl TimeSeries {
    /// The values of a sample.
    #[must_use]
    pub fn sample(&self, index: usize) -> &[f64] {
        let width = self.columns.len();
        self.values.get(index * width..(index + 1) * width).unwrap_or(&[])
    }

    /// As the name of a file: `attitude_ATTITUDE`.
    #[must_use]
    pub fn file_name(&self) -> String {
        self.name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect()
    }
}

/// The streams of a recording, setpoints among them.
#[must_use]
pub fn of_recording(recording: &Recording) -> Vec<TimeSeries> {
    recording
        .streams
        .iter()
        .filter(|(_, stream)| !stream.is_empty())
        .map(|(key, stream)| series(*key, stream))
        .collect()
}

fn series(key: StreamKey, stream: &Stream) -> TimeSeries {
    let (unit, names) = meaning(key.quantity);
    let columns = if names.len() == stream.width {
        names.iter().map(|name| (*name).to_owned()).collect()
    } else {
        (0..stream.width).map(|place| format!("channel_{}", place + 1)).collect()
    };
    let instance = if key.instance == 0 { String::new() } else { format!("/{}", key.instance) };
    TimeSeries {
        name: format!("{}/{}{instance}", key.quantity.name(), key.source),
        columns,
        unit,
        time_s: stream.time_s.clone(),
        values: stream.values.clone(),
    }
}

/// Unit and names of the values of a quantity.
fn meaning(quantity: Quantity) -> (&'static str, &'static [&'static str]) {
    const XYZ: &[&str] = &["x", "y", "z"];
    match quantity {
        Quantity::Attitude | Quantity::AttitudeSetpoint => ("", &["w", "x", "y", "z"]),
        Quantity::RollYaw => ("rad", &["roll", "yaw"]),
        Quantity::AngularRate | Quantity::AngularRateSetpoint => ("rad/s", XYZ),
        Quantity::SpecificForce | Quantity::WorldAcceleration | Quantity::AccelerationSetpoint => {
            ("m/s^2", XYZ)
        }
        Quantity::Position | Quantity::PositionSetpoint => ("m", XYZ),
        Quantity::Velocity | Quantity::GpsVelocity | Quantity::VelocitySetpoint => ("m/s", XYZ),
        Quantity::TorqueSetpoint | Quantity::ThrustVectorSetpoint => ("", XYZ),
        Quantity::BarometricHeight => ("m", &["height"]),
        Quantity::Wrench => ("N, N m", &["fz", "tau_x", "tau_y", "tau_z"]),
        Quantity::RotorSpeed => ("rad/s", &[]),
        Quantity::BatteryVoltage => ("V", &["voltage"]),
        Quantity::BatteryCurrent => ("A", &["current"]),
        Quantity::YawSetpoint => ("rad", &["yaw"]),
        Quantity::YawRateSetpoint => ("rad/s", &["yaw_rate"]),
        Quantity::ThrustSetpoint => ("", &["thrust"]),
        Quantity::ActuatorCommand | Quantity::ActuatorDemand => ("", &[]),
        Quantity::LandedState => ("", &["landed_state"]),
        Quantity::Armed => ("", &["armed"]),
        Quantity::Mode => ("", &["mode"]),
    }
}

/// What an explanation leaves of the first flight's equations: by the rigid body alone, by the model found, and what its effects account
/// for, one series an axis.
#[must_use]
pub fn of_study(study: &ExplainStudy) -> Vec<TimeSeries> {
    let series = |left: crate::study::LeftAlongTime| {
        let axis = CHANNEL_NAMES[left.axis];
        let each = left.before.iter().zip(&left.after);
        TimeSeries {
            name: format!("residual/{axis}"),
            columns: ["before", "after", "effects"].map(str::to_owned).to_vec(),
            unit: if axis.starts_with("torque") { "N m" } else { "N" },
            values: each.flat_map(|(before, after)| [*before, *after, before - after]).collect(),
            time_s: left.time_s,
        }
    };
    study.left_of_all_axes().into_iter().map(series).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_keeps_its_samples_and_gets_names() {
        let mut recording = Recording::default();
        let key = |quantity, instance| StreamKey { quantity, source: "SOURCE", instance };
        let stream = |width: usize| Stream { time_s: vec![0.0, 0.5], width, values: vec![1.0; 2 * width] };
        recording.streams.insert(key(Quantity::Attitude, 0), stream(4));
        recording.streams.insert(key(Quantity::ActuatorCommand, 1), stream(6));
        recording.streams.insert(key(Quantity::Position, 0), Stream::default());
        let found = of_recording(&recording);
        assert_eq!(found.len(), 2);
        assert_eq!(
            (found[0].name.as_str(), found[0].columns.join("")),
            ("attitude/SOURCE", "wxyz".to_owned())
        );
        assert_eq!(found[1].columns[5], "channel_6");
        assert_eq!(
            (found[1].file_name().as_str(), found[1].sample(1).len()),
            ("actuator_command_SOURCE_1", 6)
        );
    }
}
