//! The drag of the rotors as the writers read it.

use super::source::Source;
use nalgebra::Vector3;

/// Drag in proportion to the airspeed, of the whole vehicle at hover, about the body's axes.
pub(super) struct RotorDrag {
    /// N/(m/s); along z with what climbing costs
    pub(super) force: Vector3<f64>,
    /// N/(m/s), the part that acts at the hubs; the rest acts at the centre of mass
    pub(super) at_hubs: Vector3<f64>,
    /// share that grows with the rotors' speed (-)
    with_speed: f64,
}

impl RotorDrag {
    pub(super) fn of(source: &mut Source<'_>) -> Self {
        let rotors = Vector3::from(["dx", "dy", "dz"].map(|axis| source.take("linear_drag", axis)));
        let inflow = Vector3::z() * source.take("inflow", "kz");
        let share = source.take_or("linear_drag", "at_hubs", 1.0);
        let inflow_share = source.take_or("inflow", "at_hubs", 1.0);
        let with_speed = source.take_or("linear_drag", "with_speed", 1.0);
        Self { force: rotors + inflow, at_hubs: rotors * share + inflow * inflow_share, with_speed }
    }

    /// N/(m/s), the mean across the rotor axis.
    pub(super) fn across(&self) -> f64 {
        f64::midpoint(self.force.x, self.force.y)
    }

    /// N/(m/s) of a simulator whose drag is the same along all axes: [`Self::across`]. What it is not is told;
    /// `name` is that of the simulator's parameter.
    pub(super) fn even(&self, source: &mut Source<'_>, name: &str) -> f64 {
        let (across, f) = (self.across(), self.force);
        if f.iter().any(|axis| (axis - across).abs() > 0.05 * across) {
            source.note(format!(
                "the simulator's drag is the same along all axes: {name} is from the mean across the rotor axis; the model has {:.4}, {:.4}, {:.4} N/(m/s)",
                f.x, f.y, f.z
            ));
        }
        across
    }

    /// N/(m/s) across the rotor axis of a simulator whose drag is the same along x and y.
    pub(super) fn even_across(&self, source: &mut Source<'_>, name: &str) -> f64 {
        let across = self.across();
        if (self.force.x - self.force.y).abs() > 0.05 * across {
            source.note(format!(
                "{name} is the same along x and y: from the mean of {:.4} and {:.4} N/(m/s)",
                self.force.x, self.force.y
            ));
        }
        across
    }

    /// Tells what is lost where the simulator's drag grows with the rotors' speed.
    pub(super) fn tell_growth(&self, source: &mut Source<'_>) {
        if self.force.norm() > 0.0 && self.with_speed < 0.95 {
            source.note("the simulator's drag grows with the rotors' speed, the model's in part only: they are the same at hover");
        }
    }

    /// Tells what is lost where the simulator's drag does not grow with the rotors' speed.
    pub(super) fn tell_no_growth(&self, source: &mut Source<'_>) {
        if self.force.norm() > 0.0 && self.with_speed > 0.05 {
            source.note("the simulator's drag does not grow with the rotors' speed, the model's does: they are the same at hover");
        }
    }

    /// Tells what is lost where the simulator's drag acts at the hubs, and grows with the speed of their rotors.
    pub(super) fn tell_at_hubs(&self, source: &mut Source<'_>) {
        self.tell_growth(source);
        if (self.force - self.at_hubs).norm() > 0.05 * self.force.norm() {
            source.note("the simulator's drag acts at the hubs; the model's acts there in part only");
        }
    }

    /// Tells what is lost where the simulator's drag acts at the centre of mass.
    pub(super) fn tell_at_center(&self, source: &mut Source<'_>, arms_m: &[Vector3<f64>]) {
        let lever_nms_m = self.at_hubs.component_mul(&Vector3::new(1.0, 1.0, 0.0)) * mean(arms_m).z;
        if lever_nms_m.norm() > 1e-4 {
            source.note(format!(
                "the simulator's drag acts at the centre of mass; the model's, at the hubs, turns the vehicle as well: {:.4} N m about y for 1 m/s along x, {:.4} N m about x for 1 m/s along y",
                -lever_nms_m.x, lever_nms_m.y
            ));
        }
    }
}

/// Mean of the hubs, m.
pub(super) fn mean(arms_m: &[Vector3<f64>]) -> Vector3<f64> {
    arms_m.iter().sum::<Vector3<f64>>() / arms_m.len().max(1) as f64
}

/// Damping of the rotation, N m/(rad/s) about the body's axes, by a drag (N/(m/s), whole vehicle) at these hubs
/// (m): each hub moves by `w x r`.
pub(super) fn damping(drag: &Vector3<f64>, hubs_m: &[Vector3<f64>]) -> Vector3<f64> {
    let squares = mean(&hubs_m.iter().map(|hub| hub.component_mul(hub)).collect::<Vec<_>>());
    Vector3::new(
        drag.z * squares.y + drag.y * squares.z,
        drag.z * squares.x + drag.x * squares.z,
        drag.y * squares.x + drag.x * squares.y,
    )
}
