//! The bounds (22)-(25) of the paper, those of roll and pitch, and those of thrust and torque.

use super::sensitivity::{
    INPUTS, Sensitive, kinematics_of, motion_of, path_slope, regressor_inputs, regressor_slopes,
    sensitive_motion_of,
};
use super::space::Path;
use crate::regression::standard_regressor;
use crate::trajectory::FlatMotion;
use crate::units::deg_from_rad;
use crate::vehicle::{AXIS_NAMES, Limits, RigidBody, Vehicle};
use nalgebra::{DMatrix, SVector, Vector4};

/// A quantity that a bound may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// derivative number `order` (0 to 2) of x, y, z (world NWU, m) or psi (rad)
    Path {
        /// x, y, z, psi
        axis: usize,
        /// 0 position, 1 velocity, 2 acceleration
        order: usize,
    },
    /// roll (27), rad
    Roll,
    /// pitch (26), rad
    Pitch,
    /// total thrust, N
    Thrust,
    /// torque about body x, y, z, N m
    Torque(usize),
    /// one rotor's thrust, N, in the order of the actuators
    RotorThrust(usize),
    /// x, y or z (m) at which the vehicle comes to rest if it receives no more setpoints, by [`AHEAD_S`]
    Rest(usize),
}

/// Time constants of the point of rest of a vehicle that receives no setpoint after one of a path. The point is its
/// position, plus its velocity times the first constant (s), plus its acceleration times the second (s^2).
///
/// They follow from the default parameters of PX4 along the ground: its position and velocity loops follow the last
/// setpoint for COM_OF_LOSS_T (1 s) and the 0.15 s until the loss is noticed. Then its mode brakes within 0.75 s of
/// flight. Upwards PX4 is quicker; ArduPilot is not.
pub const AHEAD_S: [f64; 2] = [1.3, 0.65];

impl Quantity {
    /// In words, for people: the world's axes by where they point.
    #[must_use]
    pub fn words(self) -> String {
        const AXES: [&str; 3] = ["north", "west", "up"];
        match self {
            Self::Path { axis: 3, order } => ["yaw", "yaw rate", "yaw acceleration"][order.min(2)].to_owned(),
            Self::Path { axis, order } => {
                let what = ["place", "speed", "acceleration"][order.min(2)];
                format!("{what} along {}", AXES[axis.min(2)])
            }
            Self::Roll => "roll".to_owned(),
            Self::Pitch => "pitch".to_owned(),
            Self::Thrust => "thrust".to_owned(),
            Self::Torque(axis) => format!("torque about body {}", AXIS_NAMES[axis.min(2)]),
            Self::RotorThrust(rotor) => format!("thrust of motor {}", rotor + 1),
            Self::Rest(axis) => format!("place along {} at rest without setpoints", AXES[axis.min(2)]),
        }
    }

    /// A value (in the unit of the quantity) with the unit that people use: angles in degrees.
    #[must_use]
    pub fn amount(self, value: f64) -> String {
        let in_degrees = |unit: &str| format!("{:.2} {unit}", deg_from_rad(value));
        match self {
            Self::Path { axis: 3, order: 0 } | Self::Roll | Self::Pitch => in_degrees("degrees"),
            Self::Path { axis: 3, order: 1 } => in_degrees("degrees/s"),
            Self::Path { axis: 3, .. } => in_degrees("degrees/s^2"),
            Self::Path { order: 0, .. } | Self::Rest(_) => format!("{value:.3} m"),
            Self::Path { order: 1, .. } => format!("{value:.3} m/s"),
            Self::Path { .. } => format!("{value:.3} m/s^2"),
            Self::Thrust | Self::RotorThrust(_) => format!("{value:.3} N"),
            Self::Torque(_) => format!("{value:.4} N m"),
        }
    }

    /// The name used in files.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Path { axis, order } => {
                const NAMES: [[&str; 4]; 3] = [
                    ["x_m", "y_m", "z_m", "yaw_rad"],
                    ["x_speed_m_s", "y_speed_m_s", "z_speed_m_s", "yaw_rate_rad_s"],
                    [
                        "x_acceleration_m_s2",
                        "y_acceleration_m_s2",
                        "z_acceleration_m_s2",
                        "yaw_acceleration_rad_s2",
                    ],
                ];
                NAMES[order.min(2)][axis.min(3)].to_owned()
            }
            Self::Roll => "roll_rad".to_owned(),
            Self::Pitch => "pitch_rad".to_owned(),
            Self::Thrust => "thrust_n".to_owned(),
            Self::Torque(axis) => format!("torque_{}_nm", ["x", "y", "z"][axis.min(2)]),
            Self::RotorThrust(rotor) => format!("rotor_{rotor}_thrust_n"),
            Self::Rest(axis) => format!("{}_at_rest_m", ["x", "y", "z"][axis.min(2)]),
        }
    }
}

/// `min <= quantity <= max`, either side optional.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// what is bounded
    pub quantity: Quantity,
    /// lower bound in the quantity's unit
    pub min: Option<f64>,
    /// upper bound in the quantity's unit
    pub max: Option<f64>,
}

impl Bound {
    /// The scale of violations: half the width of the bound, or the size of the only side.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let scale = match (self.min, self.max) {
            (Some(min), Some(max)) => 0.5 * (max - min),
            (Some(only), None) | (None, Some(only)) => only.abs(),
            (None, None) => 1.0,
        };
        if scale > 0.0 { scale } else { 1.0 }
    }
}

/// The wrench that a motion needs, from the nominal body.
#[derive(Debug, Clone)]
pub struct Dynamics {
    gravity_m_s2: f64,
    theta: SVector<f64, 7>,
    /// rotors x 4: thrusts of least norm that give `[Fz tau_x tau_y tau_z]`
    allocation: DMatrix<f64>,
}

impl Dynamics {
    /// From a vehicle's nominal body and its rotors.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let mixer = vehicle.mixer().matrix;
        let dense = DMatrix::from_fn(4, mixer.ncols(), |row, column| mixer[(row, column)]);
        let allocation =
            dense.pseudo_inverse(1e-9).unwrap_or_else(|_| DMatrix::zeros(vehicle.rotors.len(), 4));
        Self { gravity_m_s2: vehicle.gravity_m_s2, theta: parameters_of(&vehicle.body), allocation }
    }

    /// m/s^2
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// `Theta` of the nominal body (kg, kg m^2).
    #[must_use]
    pub fn theta(&self) -> &SVector<f64, 7> {
        &self.theta
    }
}

/// `Theta = [m Ixx Ixy Ixz Iyy Iyz Izz]` of a body (kg, kg m^2).
#[must_use]
pub fn parameters_of(body: &RigidBody) -> SVector<f64, 7> {
    let i = &body.inertia_kg_m2;
    SVector::from([body.mass_kg, i.m11, i.m12, i.m13, i.m22, i.m23, i.m33])
}

/// One instant of a path, evaluated as far as bounds need it.
#[derive(Debug, Clone)]
pub struct Instant {
    path: Path,
    motion: FlatMotion<f64>,
    wrench: Vector4<f64>,
}

impl Instant {
    /// The motion and wrench of a path entry.
    #[must_use]
    pub fn new(path: Path, dynamics: &Dynamics) -> Self {
        let motion = motion_of(&path, dynamics.gravity_m_s2);
        let wrench = standard_regressor(&kinematics_of(&motion)) * dynamics.theta;
        Self { path, motion, wrench }
    }

    /// The value of a quantity, in its unit.
    #[must_use]
    pub fn value(&self, quantity: Quantity, dynamics: &Dynamics) -> f64 {
        match quantity {
            Quantity::Path { axis, order } => self.path[axis][order],
            Quantity::Rest(axis) => {
                let [speed_s, acceleration_s2] = AHEAD_S;
                let [place, velocity, acceleration, ..] = self.path[axis];
                place + speed_s * velocity + acceleration_s2 * acceleration
            }
            Quantity::Roll => self.motion.roll[0],
            Quantity::Pitch => self.motion.pitch[0],
            Quantity::Thrust => self.wrench[0],
            Quantity::Torque(axis) => self.wrench[1 + axis],
            Quantity::RotorThrust(rotor) => {
                (0..4).map(|row| dynamics.allocation[(rotor, row)] * self.wrench[row]).sum()
            }
        }
    }

    /// The derivative of a quantity with respect to each path entry.
    #[must_use]
    pub fn slope(&self, quantity: Quantity, dynamics: &Dynamics) -> Path {
        if let Quantity::Path { axis, order } = quantity {
            let mut slope = Path::default();
            slope[axis][order] = 1.0;
            return slope;
        }
        if let Quantity::Rest(axis) = quantity {
            let mut slope = Path::default();
            let [speed_s, acceleration_s2] = AHEAD_S;
            [slope[axis][0], slope[axis][1], slope[axis][2]] = [1.0, speed_s, acceleration_s2];
            return slope;
        }
        let motion = sensitive_motion_of(&self.path, dynamics.gravity_m_s2);
        let gradient = match quantity {
            Quantity::Roll => motion.roll[0].gradient,
            Quantity::Pitch => motion.pitch[0].gradient,
            Quantity::Thrust => self.wrench_slope(&motion, dynamics, |row| f64::from(u8::from(row == 0))),
            Quantity::Torque(axis) => {
                self.wrench_slope(&motion, dynamics, |row| f64::from(u8::from(row == 1 + axis)))
            }
            Quantity::RotorThrust(rotor) => {
                self.wrench_slope(&motion, dynamics, |row| dynamics.allocation[(rotor, row)])
            }
            Quantity::Path { .. } | Quantity::Rest(_) => [0.0; INPUTS],
        };
        path_slope(&gradient)
    }

    fn wrench_slope(
        &self,
        motion: &FlatMotion<Sensitive>,
        dynamics: &Dynamics,
        share: impl Fn(usize) -> f64,
    ) -> [f64; INPUTS] {
        let slopes = regressor_slopes(&regressor_inputs(&self.motion));
        let mut gradient = [0.0; INPUTS];
        for (slope, input) in slopes.iter().zip(regressor_inputs(motion)) {
            let wrench = slope * dynamics.theta;
            let along: f64 = (0..4).map(|row| share(row) * wrench[row]).sum();
            for (out, value) in gradient.iter_mut().zip(input.gradient) {
                *out += along * value;
            }
        }
        gradient
    }
}

/// All bounds of a vehicle's limits. Rotor thrusts are kept between zero and full command.
#[must_use]
pub fn bounds_of(limits: &Limits, vehicle: &Vehicle) -> Vec<Bound> {
    let mut bounds = Vec::new();
    let mut push = |quantity, min: Option<f64>, max: Option<f64>| {
        if min.is_some() || max.is_some() {
            bounds.push(Bound { quantity, min, max });
        }
    };
    let both = |max: Option<f64>| (max.map(|value| -value), max);
    let path = |axis, order| Quantity::Path { axis, order };
    let symmetric = [
        (path(0, 0), limits.x_max_m),
        (path(1, 0), limits.y_max_m),
        (path(3, 0), limits.yaw_max_rad),
        (path(0, 1), limits.speed_max_m_s),
        (path(1, 1), limits.speed_max_m_s),
        (path(2, 1), limits.speed_max_m_s),
        (path(3, 1), limits.yaw_rate_max_rad_s),
        (path(0, 2), limits.acceleration_max_m_s2),
        (path(1, 2), limits.acceleration_max_m_s2),
        (path(3, 2), limits.yaw_acceleration_max_rad_s2),
        (Quantity::Roll, limits.roll_max_rad),
        (Quantity::Pitch, limits.pitch_max_rad),
        (Quantity::Torque(0), limits.torque_max_nm),
        (Quantity::Torque(1), limits.torque_max_nm),
        (Quantity::Torque(2), limits.torque_max_nm),
    ];
    for (quantity, max) in symmetric {
        let (min, max) = both(max);
        push(quantity, min, max);
    }
    push(path(2, 0), limits.z_min_m, limits.z_max_m);
    let (general_min, general_max) = both(limits.acceleration_max_m_s2);
    push(
        path(2, 2),
        tighter(limits.vertical_acceleration_min_m_s2, general_min, f64::max),
        tighter(limits.vertical_acceleration_max_m_s2, general_max, f64::min),
    );
    push(Quantity::Thrust, None, limits.thrust_max_n);
    let full_n = vehicle.propulsion.thrust_from_command_n(1.0);
    if full_n.is_finite() && full_n > 0.0 {
        for rotor in 0..vehicle.rotors.len() {
            push(Quantity::RotorThrust(rotor), Some(0.0), Some(full_n));
        }
    }
    bounds
}

/// Margin of each rotor's thrust in a plan. Gusts, drag and the controller need it, and a rotor at its bound leads to
/// another flight than the planned one. The smaller of the two counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorMargin {
    /// share of the full thrust
    pub of_full: f64,
    /// share of the distance to each bound in hover
    pub of_rest: f64,
}

/// The margins in the order of trial. The first one with which the rotors of the simulated flight stay off their bounds
/// is taken.
pub const ROTOR_MARGINS: [RotorMargin; 5] = [
    RotorMargin { of_full: 0.1, of_rest: 0.25 },
    RotorMargin { of_full: 0.2, of_rest: 0.5 },
    RotorMargin { of_full: 0.3, of_rest: 0.7 },
    RotorMargin { of_full: 0.35, of_rest: 0.8 },
    RotorMargin { of_full: 0.4, of_rest: 0.88 },
];

/// The bounds of a plan: those of [`bounds_of`], with a margin to the rotors' bounds.
#[must_use]
pub fn bounds_to_plan_in(limits: &Limits, vehicle: &Vehicle, margin: RotorMargin) -> Vec<Bound> {
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let dynamics = Dynamics::new(vehicle);
    let RotorMargin { of_full, of_rest } = margin;
    let mut bounds = bounds_of(limits, vehicle);
    for bound in &mut bounds {
        if let (Quantity::RotorThrust(rotor), Some(min), Some(max)) = (bound.quantity, bound.min, bound.max) {
            let hover_n = dynamics.allocation[(rotor, 0)] * weight_n;
            let margin = |rest_n: f64| (of_full * (max - min)).min(of_rest * rest_n).max(0.0);
            bound.min = Some(min + margin(hover_n - min));
            bound.max = Some(max - margin(max - hover_n));
        }
    }
    bounds
}

fn tighter(a: Option<f64>, b: Option<f64>, choose: fn(f64, f64) -> f64) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(choose(a, b)),
        (one, other) => one.or(other),
    }
}
