//! From a row's cells to a sample in SI, body FLU, world NWU.

use super::{AxisFrame, CsvQuantity};
use crate::frames::{self, Attitude};
use crate::recording::Quantity;

/// Cells (SI, NaN where empty, in the file's axes) to the sample. `None` where an attitude is not one.
pub(super) fn to_sample(mapped: &CsvQuantity, cells: &[f64]) -> Option<Vec<f64>> {
    match (mapped.quantity, cells) {
        (Quantity::Attitude | Quantity::AttitudeSetpoint, &[w, x, y, z]) => {
            quaternion(mapped.frame, [w, x, y, z]).map(wxyz)
        }
        (Quantity::Attitude | Quantity::AttitudeSetpoint, &[roll, pitch, yaw]) => {
            euler(mapped.frame, [roll, pitch, yaw]).map(wxyz)
        }
        (Quantity::RollYaw, &[roll, yaw]) => Some(vec![roll, yaw_in(mapped.frame, yaw)]),
        (Quantity::YawSetpoint, &[yaw]) => Some(vec![yaw_in(mapped.frame, yaw)]),
        (Quantity::AngularRate | Quantity::SpecificForce, &[x, y, z]) => {
            Some(body_vector(mapped.frame, [x, y, z]))
        }
        (
            Quantity::WorldAcceleration
            | Quantity::Position
            | Quantity::Velocity
            | Quantity::PositionSetpoint
            | Quantity::VelocitySetpoint
            | Quantity::AccelerationSetpoint,
            &[x, y, z],
        ) => Some(world_vector(mapped.frame, [x, y, z])),
        _ => Some(cells.to_vec()),
    }
}

fn quaternion(frame: AxisFrame, cells: [f64; 4]) -> Option<Attitude> {
    match frame {
        AxisFrame::FluNwu => frames::attitude_from_quaternion(cells),
        AxisFrame::FrdNed => frames::attitude_from_frd_ned(cells),
        AxisFrame::FluEnu => frames::attitude_from_flu_enu(cells),
    }
}

fn euler(frame: AxisFrame, [roll, pitch, yaw]: [f64; 3]) -> Option<Attitude> {
    if !(roll.is_finite() && pitch.is_finite() && yaw.is_finite()) {
        return None;
    }
    Some(match frame {
        AxisFrame::FluNwu => Attitude::from_euler(roll, pitch, yaw),
        AxisFrame::FrdNed => frames::attitude_from_euler_frd_ned(roll, pitch, yaw),
        AxisFrame::FluEnu => Attitude::from_euler(roll, pitch, frames::yaw_from_enu(yaw)),
    })
}

fn wxyz(attitude: Attitude) -> Vec<f64> {
    let q = attitude.0.quaternion();
    vec![q.w, q.i, q.j, q.k]
}

fn yaw_in(frame: AxisFrame, yaw_rad: f64) -> f64 {
    match frame {
        AxisFrame::FluNwu => yaw_rad,
        AxisFrame::FrdNed => frames::yaw_from_ned(yaw_rad),
        AxisFrame::FluEnu => frames::yaw_from_enu(yaw_rad),
    }
}

fn body_vector(frame: AxisFrame, cells: [f64; 3]) -> Vec<f64> {
    match frame {
        AxisFrame::FrdNed => frames::body_from_frd(cells).0.as_slice().to_vec(),
        AxisFrame::FluNwu | AxisFrame::FluEnu => cells.to_vec(),
    }
}

fn world_vector(frame: AxisFrame, cells: [f64; 3]) -> Vec<f64> {
    match frame {
        AxisFrame::FluNwu => cells.to_vec(),
        AxisFrame::FrdNed => frames::world_from_ned(cells).0.as_slice().to_vec(),
        AxisFrame::FluEnu => frames::world_from_enu(cells).0.as_slice().to_vec(),
    }
}
