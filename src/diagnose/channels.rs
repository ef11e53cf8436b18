//! One value a row for each axis of force and torque, and the nuisance columns that are always estimated.

use super::trace::Trace;

/// One value a row and channel.
pub type Channels = [Vec<f64>; CHANNELS];

/// Channels: force on body x, y, z (N), torque about them (N m), and the second measurement of the force (N).
///
/// The first measurement is the accelerometer's, the second that of the kinematics (velocity and attitude). If there is
/// only one, it is the first, and the second is zero.
pub const CHANNELS: usize = 9;

/// Axes of force and torque: the first channels.
pub const AXES: usize = 6;

/// Index of the first channel of the second measurement of the force.
pub const SECOND: usize = 6;

/// Names of the channels, as in JSON.
pub const CHANNEL_NAMES: [&str; CHANNELS] = [
    "force_x",
    "force_y",
    "force_z",
    "torque_x",
    "torque_y",
    "torque_z",
    "kinematic_force_x",
    "kinematic_force_y",
    "kinematic_force_z",
];

/// The quantity of a nuisance column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nuisance {
    /// kg
    Mass,
    /// kg m^2: xx xy xz yy yz zz
    Inertia(usize),
    /// share of the gyroscopic torque, of simulators that leave it out
    Gyroscopic,
    /// kg m^2, the moment about z in the gyroscopic torque beyond that of [`Self::Inertia`], which goes with a guessed torque per thrust
    GuessedMomentAboutZ,
    /// s, of all channels
    Latency,
    /// s, of the force beyond that of the torque
    ForceLatency,
    /// s, of the kinematics along body z beyond that of the accelerometer
    KinematicLatency,
    /// s, of the velocity beyond that of the attitude, against the accelerometer's: the kinematics along body x and y
    LateralLatency,
    /// rad, thrust axis about body x, y
    Tilt(usize),
    /// N m/(m/s), about body x, y, of the air in averaged torques
    AirMoment(usize),
    /// N m, about body x, y, z, of a balance that is a guess, in averaged torques
    Balance(usize),
    /// s, by which the body turns between the force and the frame of the accelerometer's sample of it
    TurnedAccelerometer,
    /// share of the commands' jitter that the rotors do not follow, less one half
    Jitter,
    /// m/s^2, on body x, y, z of the accelerometer
    AccelerometerBias(usize),
    /// rad, of the attitude's level about world x, y
    Level(usize),
    /// m/s, of the vertical velocity about one knot of one flight
    VelocityError,
}

/// A column with the prior of its coefficient.
#[derive(Debug, Clone)]
pub struct NuisanceColumn {
    /// the quantity
    pub nuisance: Nuisance,
    /// per unit, from [`Self::first_row`] on; zero in the rows before and after
    pub values: Channels,
    /// row of the first value
    pub first_row: usize,
    /// standard deviation of the coefficient about [`Self::prior_mean`], its unit; `None`: nothing is known
    pub prior_std: Option<f64>,
    /// what is known of the coefficient beforehand, its unit: zero of what the model does not have; of a value that the model has, the
    /// distance of what is known from it
    pub prior_mean: f64,
    /// per unit, in rows that do not estimate it but contain its error (consider covariance)
    pub considered: Option<Channels>,
}

impl NuisanceColumn {
    /// Its value in a row of a channel; zero where it has none.
    #[must_use]
    pub fn at(&self, channel: usize, row: usize) -> f64 {
        let of_row = row.checked_sub(self.first_row).and_then(|place| self.values[channel].get(place));
        of_row.copied().unwrap_or(0.0)
    }

    /// The column of one flight among the rows of all, of which its own begin at `first`.
    pub(super) fn among(self, first: usize) -> Self {
        Self { first_row: self.first_row + first, ..self }
    }
}

/// Channels of the force in each available measurement (N), and of the torque (N m): of each row, or averaged where commands or
/// body rates are slow.
pub(super) fn channels(trace: &Trace, force: [Vec<f64>; 3], torque: [Vec<f64>; 3]) -> Channels {
    let torque = trace.torque_rows(torque);
    let mut out = force_channels(trace, force);
    out[3..AXES].iter_mut().zip(torque).for_each(|(channel, torque)| *channel = torque);
    out
}

/// Channels of the force in each available measurement (N), at any of the rows, without a torque.
pub(super) fn force_channels(trace: &Trace, force: [Vec<f64>; 3]) -> Channels {
    let rows = force[0].len();
    let nothing = || vec![0.0; rows];
    let second = if trace.reads_force_twice() { force.clone() } else { std::array::from_fn(|_| nothing()) };
    let ([fx, fy, fz], [kx, ky, kz]) = (force, second);
    [fx, fy, fz, nothing(), nothing(), nothing(), kx, ky, kz]
}

/// Whether a flight measures a channel. The others are zero.
pub(super) fn measures(trace: &Trace, channel: usize) -> bool {
    match channel {
        0..3 => true,
        3..AXES => trace.compares_torques(),
        _ => trace.reads_force_twice(),
    }
}

pub(super) fn nothing(trace: &Trace) -> [Vec<f64>; 3] {
    std::array::from_fn(|_| vec![0.0; trace.rows()])
}

pub(super) fn append(to: &mut Channels, from: &Channels) {
    to.iter_mut().zip(from).for_each(|(to, from)| to.extend_from_slice(from));
}

/// Decrease of the residual per unit of a parameter: `(down - up) / step`.
pub(super) fn per_step(mut up: Channels, down: &Channels, step: f64) -> Channels {
    for (up, down) in up.iter_mut().zip(down) {
        up.iter_mut().zip(down).for_each(|(up, down)| *up = (down - *up) / step);
    }
    up
}

/// The nuisances' columns over the rows of earlier flights, continued by those of a further one. A flight that lacks a
/// nuisance, such as the jitter of commands if rotor speeds were measured, has zeros in its column.
pub(super) fn joined(
    mut all: Vec<NuisanceColumn>,
    rows_before: usize,
    of_flight: Vec<NuisanceColumn>,
    rows: usize,
) -> Vec<NuisanceColumn> {
    let zeros = |rows: usize| -> Channels { std::array::from_fn(|_| vec![0.0; rows]) };
    for of in &of_flight {
        if all.iter().all(|column| column.nuisance != of.nuisance) {
            let considered = of.considered.as_ref().map(|_| zeros(rows_before));
            all.push(NuisanceColumn { values: zeros(rows_before), considered, ..of.clone() });
        }
    }
    for column in &mut all {
        let of = of_flight.iter().find(|of| of.nuisance == column.nuisance);
        append(&mut column.values, of.map_or(&zeros(rows), |of| &of.values));
        // what is known of it is what is known in the flight that knows least
        if let Some(std) = of.map(|of| of.prior_std) {
            column.prior_std = column.prior_std.zip(std).map(|(all, of)| all.max(of));
        }
        if let Some(considered) = &mut column.considered {
            append(considered, of.and_then(|of| of.considered.as_ref()).unwrap_or(&zeros(rows)));
        }
    }
    all
}
