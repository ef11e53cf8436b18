//! What gives the vehicle its height: motion capture, or something less exact.

use crate::recording::{Quantity, Recording};

/// What holds the vertical velocity of an estimate beside its accelerometer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct VelocityHeldBy {
    /// whether motion capture or a camera gives the height, or else satellites and air pressure; `None` where it is not known
    pub pose: Option<bool>,
    /// the position took the slow error out of the vertical velocity
    pub position: bool,
}

/// Poses from outside of the vehicle's own sensors: motion capture, or a camera on it.
const POSES: [&str; 4] =
    ["vehicle_mocap_odometry", "vehicle_visual_odometry", "att_pos_mocap", "vehicle_vision_position"];

/// Whether motion capture or a camera gives the height: the autopilot's parameters say so; where they are not known, poses
/// are logged and no satellite receiver's velocity. `None` where nothing tells.
pub(super) fn is_height_by_pose(recording: &Recording) -> Option<bool> {
    let parameter = |name: &str| recording.parameters.get(name).copied();
    let stated = recording.autopilot.stack().and_then(|stack| stack.has_height_by_pose(parameter));
    let logs = |what: fn(Quantity, &str) -> bool| {
        let mut streams = recording.streams.iter();
        streams.any(|(key, stream)| what(key.quantity, key.source) && !stream.is_empty())
    };
    stated.or_else(|| {
        let by_pose = logs(|quantity, source| quantity == Quantity::Position && POSES.contains(&source));
        let by_receiver = logs(|quantity, _| quantity == Quantity::GpsVelocity);
        (by_pose || by_receiver).then_some(!by_receiver)
    })
}

/// Whether a satellite receiver gives the position: its velocity is logged, and no pose.
pub(super) fn is_position_by_receiver(recording: &Recording) -> bool {
    let mut streams = recording.streams.iter().filter(|(_, stream)| !stream.is_empty());
    let by_receiver = streams.clone().any(|(key, _)| key.quantity == Quantity::GpsVelocity);
    by_receiver && !streams.any(|(key, _)| key.quantity == Quantity::Position && POSES.contains(&key.source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;
    use crate::recording::{Stream, StreamKey};

    fn with(
        streams: &[(Quantity, &'static str)],
        parameters: &[(&str, f64)],
        autopilot: Autopilot,
    ) -> Recording {
        let stream = Stream { time_s: vec![0.0], width: 3, values: vec![0.0; 3] };
        let streams = streams.iter().map(|(quantity, source)| {
            (StreamKey { quantity: *quantity, source, instance: 0 }, stream.clone())
        });
        Recording {
            streams: streams.collect(),
            parameters: parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            autopilot,
            ..Recording::default()
        }
    }

    #[test]
    fn a_receiver_gives_the_position_where_no_pose_is_logged() {
        let (pose, receiver) =
            ((Quantity::Position, "vehicle_mocap_odometry"), (Quantity::GpsVelocity, "GPS_RAW_INT"));
        for (streams, expected) in
            [(&[receiver][..], true), (&[pose], false), (&[pose, receiver], false), (&[], false)]
        {
            // what gives the height says nothing of the axes
            for parameters in [&[][..], &[("EKF2_HGT_REF", 0.0)]] {
                let recording = with(streams, parameters, Autopilot::Px4);
                assert_eq!(is_position_by_receiver(&recording), expected, "{streams:?}");
            }
        }
    }

    #[test]
    fn parameters_say_it_before_streams_do() {
        let estimate = (Quantity::Position, "vehicle_local_position");
        let pose = (Quantity::Position, "vehicle_mocap_odometry");
        let receiver = (Quantity::GpsVelocity, "sensor_gps");
        let cases = [
            (with(&[estimate], &[], Autopilot::Px4), None),
            (with(&[estimate, receiver], &[], Autopilot::Px4), Some(false)),
            (with(&[estimate, pose], &[], Autopilot::Px4), Some(true)),
            (with(&[estimate, pose, receiver], &[], Autopilot::Px4), Some(false)),
            (with(&[estimate, pose, receiver], &[("EKF2_HGT_REF", 3.0)], Autopilot::Px4), Some(true)),
            (with(&[estimate, pose], &[("EKF2_HGT_REF", 1.0)], Autopilot::Px4), Some(false)),
            (with(&[estimate], &[("EKF2_HGT_MODE", 3.0)], Autopilot::Px4), Some(true)),
            (with(&[estimate], &[("EK3_SRC1_POSZ", 6.0)], Autopilot::ArduPilot), Some(true)),
            (with(&[estimate], &[("EK3_SRC1_POSZ", 1.0)], Autopilot::ArduPilot), Some(false)),
            (with(&[], &[], Autopilot::default()), None),
        ];
        for (recording, expected) in cases {
            assert_eq!(is_height_by_pose(&recording), expected, "{:?}", recording.parameters);
        }
    }
}
