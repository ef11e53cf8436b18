//! Columns that are in every fit: properties that no vehicle file states exactly, and errors of sensors.

use super::base::Base;
use super::channels::{Channels, Nuisance, NuisanceColumn, SECOND, channels, force_channels, nothing};
use super::feedback_noise::{UNCONFIRMED_S, is_fed_back};
use super::rotors::RotorMotion;
use super::trace::Trace;
use crate::estimate::{INERTIA_ENTRIES, JITTER_STD};
use crate::reconstruction::ACCELEROMETER_TURN_STD_S;
use crate::signals::central_difference;
use crate::trim::mean_arm_m;
use crate::vehicle::{Guess, Guessed, RigidBody, Vehicle};
use nalgebra::Vector3;
use std::f64::consts::SQRT_2;

/// Standard deviation of the prior of the latency of force against torque, s. Filters of accelerometer and gyroscopes
/// differ by milliseconds.
const FORCE_LATENCY_STD_S: f64 = 0.004;
/// Standard deviation of the prior of the latency of the estimated vertical velocity, s: estimators correct it by a
/// barometer and a receiver that are late by tenths of a second.
const KINEMATIC_LATENCY_STD_S: f64 = 0.05;
/// Standard deviation of the prior of the latency of the velocity beyond that of the attitude, s: what their stamps
/// and the comparison with the inertial unit leave open.
const LATERAL_LATENCY_STD_S: f64 = 0.01;
/// Standard deviation of the prior of the attitude's level, rad: attitude estimates are level to about half a degree.
const LEVEL_STD_RAD: f64 = 0.01;
/// Standard deviation of the prior of the accelerometer's bias if velocity does not determine it, m/s^2. It is the 20
/// mg of data sheets (ICM-42688-P, table 2).
pub(super) const BIAS_STD_M_S2: f64 = 0.2;

/// Standard deviation of the prior of the share of the gyroscopic torque that a simulator has, about that of a body. It has all or none.
const GYROSCOPIC_STD: f64 = 1.0;
/// Standard deviation of the prior of a product of inertia, as a share of the geometric mean of its two moments, of the vehicle
/// file or of the fit, whichever is larger. Multirotors are built
/// symmetrically; of a Crazyflie 2.0 they were measured as 3, 5 and 8 % (Förster 2015, ETH Zürich), and on larger vehicles they are less.
const PRODUCT_STD: f64 = 0.03;
/// Share of the gyroscopic torque of a body.
const WHOLE: f64 = 1.0;

pub(super) fn nuisances(
    trace: &Trace,
    base: &Base,
    commanded: &RotorMotion,
    by_commands_n: &[Vector3<f64>],
) -> Vec<NuisanceColumn> {
    let none = || vec![0.0; trace.rows()];
    let force = |values: [Vec<f64>; 3]| force_channels(trace, values);
    // averaged torques tell what acts always, not how the vehicle turns
    let torque = |values: [Vec<f64>; 3]| if trace.torques { values } else { nothing(trace) };
    let mass_kg = base.vehicle.body.mass_kg;
    let mut out = Vec::new();
    // more mass than assumed: more force than assumed was there, in proportion to it
    let forces: Vec<Vector3<f64>> = by_commands_n.iter().map(|force_n| force_n / -mass_kg).collect();
    out.push(column(Nuisance::Mass, None, force(trace.weak_vector(0, &forces))));
    for (entry, axes) in trace.momentum(base.vehicle.body.gyroscopic).iter().enumerate() {
        let values = axes.each_ref().map(|values| values.iter().map(|v| -v).collect::<Vec<f64>>());
        // where no torque is compared, the inertia stays undetermined
        let (prior_std, prior_mean) = product_prior(base, entry).filter(|_| trace.torques).unzip();
        let known =
            column(Nuisance::Inertia(entry), prior_std, channels(trace, nothing(trace), torque(values)));
        out.push(NuisanceColumn { prior_mean: prior_mean.unwrap_or_default(), ..known });
    }
    out.extend(guessed_moment_about_z(trace, &base.vehicle));
    if base.estimates_gyroscopic {
        let values = gyroscopic_column(trace, &base.vehicle.body);
        // known is the share, and the column is of what it changes by
        let prior_mean = WHOLE - base.vehicle.body.gyroscopic;
        out.push(NuisanceColumn { prior_mean, ..column(Nuisance::Gyroscopic, Some(GYROSCOPIC_STD), values) });
    }
    let thrust: Vec<f64> = commanded.thrust_n.each().map(|thrusts| thrusts.iter().sum::<f64>()).collect();
    out.extend(latencies(trace, base, &thrust));
    let thrust = trace.weak(0, &thrust);
    let negative: Vec<f64> = thrust.iter().map(|t| -t).collect();
    // no thrust axis is known to a tenth of a degree; one that leans much is an effect
    if !base.stands_for(Nuisance::Tilt(0)) {
        out.push(column(Nuisance::Tilt(0), None, force([none(), negative, none()])));
        out.push(column(Nuisance::Tilt(1), None, force([thrust, none(), none()])));
    }
    if let Some(jitter) = &trace.jitter(&base.vehicle.propulsion) {
        let channel =
            |row: usize| trace.weak(0, &jitter.iter().map(|jitter| -jitter[row]).collect::<Vec<f64>>());
        let torques = torque([channel(1), channel(2), channel(3)]);
        let values = channels(trace, [none(), none(), channel(0)], torques);
        out.push(column(Nuisance::Jitter, Some(JITTER_STD), values));
    }
    if !trace.torques && trace.known.velocity && trace.known.attitude {
        out.extend(air_moments(trace));
    }
    if !trace.torques {
        out.extend(guessed_balance(trace, &base.vehicle));
    }
    out.extend(sensor_nuisances(trace, mass_kg, base));
    out
}

/// What is known of a product of inertia, as a change from the base, kg m^2: standard deviation and mean. `None` of a moment.
///
/// A motion that goes round, as a planned one may, makes a product look like more damping about one axis and less about the other.
fn product_prior(base: &Base, entry: usize) -> Option<(f64, f64)> {
    let (row, column) = INERTIA_ENTRIES[entry];
    let (begun, now) = (&base.begun_kg_m2, &base.vehicle.body.inertia_kg_m2);
    // a fit that leaves no moment must not hold the products as well
    let moment = |axis: usize| begun[(axis, axis)].max(now[(axis, axis)]);
    (row != column).then(|| {
        let std = PRODUCT_STD * (moment(row) * moment(column)).sqrt();
        (std, begun[(row, column)] - now[(row, column)])
    })
}

/// The moment about z that the gyroscopic torque shows, of a vehicle whose torque per thrust or arms are a guess. The motion about z tells
/// only the ratio of izz to that torque. An izz on the scale of a wrong guess would make a gyroscopic torque about x and y that looks like
/// damping and latency.
fn guessed_moment_about_z(trace: &Trace, vehicle: &Vehicle) -> Option<NuisanceColumn> {
    let guessed = vehicle.guessed(Guessed::TorqueRatio).hypot(vehicle.guessed(Guessed::Arms));
    (trace.torques && guessed > 0.0).then(|| {
        let [about_x, about_y, _] = &trace.momentum(vehicle.body.gyroscopic)[INERTIA_ENTRIES.len() - 1];
        let negative = |values: &[f64]| values.iter().map(|v| -v).collect::<Vec<f64>>();
        let torque = [negative(about_x), negative(about_y), vec![0.0; trace.rows()]];
        let std = guessed * vehicle.body.inertia_kg_m2[(2, 2)];
        column(Nuisance::GuessedMomentAboutZ, Some(std), channels(trace, nothing(trace), torque))
    })
}

/// More of the gyroscopic torque than assumed: more torque than assumed was needed for the motion.
pub(super) fn gyroscopic_column(trace: &Trace, body: &RigidBody) -> Channels {
    if !trace.torques {
        return channels(trace, nothing(trace), nothing(trace));
    }
    let needed = trace.gyroscopic(body).map(|axis| axis.iter().map(|torque_nm| -torque_nm).collect());
    channels(trace, nothing(trace), needed)
}

/// Latencies: of the commands, of the force beyond that of the torques, and of the kinematics. The thrust is by the commands, N.
fn latencies(trace: &Trace, base: &Base, thrust_n: &[f64]) -> Vec<NuisanceColumn> {
    let none = || vec![0.0; trace.rows()];
    let mut out = Vec::new();
    // by the commands for the force, by the motion for the torques
    let late: Vec<f64> = central_difference(thrust_n, trace.grid.step_s).iter().map(|d| -d).collect();
    let late = trace.weak(0, &late);
    let turning = trace.turning_torque(&base.vehicle.body);
    let [late_x, late_y, late_z] = [0, 1, 2].map(|axis| {
        let column: Vec<f64> = turning.iter().map(|t| -t[axis]).collect();
        trace.weak(0, &central_difference(&column, trace.grid.step_s))
    });
    // in yaw the rotors' inertia leads by as much as a latency lags: where the one is estimated, roll and pitch tell the
    // other, and its error goes into the inertia's
    let of_yaw = channels(trace, nothing(trace), [none(), none(), late_z.clone()]);
    let spins_up = base.estimates(|term| term.signature.role.spin_up.is_some());
    let late_torque = match (trace.torques, spins_up) {
        (false, _) => nothing(trace),
        (true, true) => [late_x, late_y, none()],
        (true, false) => [late_x, late_y, late_z],
    };
    let both = channels(trace, [none(), none(), late.clone()], late_torque);
    let considered = spins_up.then_some(of_yaw);
    out.push(NuisanceColumn { considered, ..column(Nuisance::Latency, None, both) });
    if trace.reads_force_twice() {
        let mut values: Channels = std::array::from_fn(|_| vec![0.0; trace.rows()]);
        values[SECOND + 2].clone_from(&late);
        out.push(column(Nuisance::KinematicLatency, Some(KINEMATIC_LATENCY_STD_S), values));
        out.push(lateral_latency(trace, thrust_n));
    }
    let is_fed_back = is_fed_back(std::slice::from_ref(trace));
    // elsewhere the reconstruction of the flight path has it alone: beside a drag that is not found yet, it would take a part of it
    if trace.has_accelerometer() && is_fed_back {
        out.push(turned_accelerometer(trace, thrust_n));
    }
    let late = force_channels(trace, [none(), none(), late]);
    // where the gyroscopes' noise is fed back, the torques do not tell the latency as well as that
    let unsure_s = if is_fed_back { UNCONFIRMED_S } else { 0.0 };
    out.push(column(Nuisance::ForceLatency, Some(FORCE_LATENCY_STD_S.hypot(unsure_s)), late));
    out
}

/// The moment of the air about the centre of mass, in averaged torques: what acts at the hubs, what at the centre, and the hub moment
/// itself are not told apart there, and a flight with a mean airspeed must not show them as a centre of mass.
fn air_moments(trace: &Trace) -> [NuisanceColumn; 2] {
    let across: Vec<Vector3<f64>> = trace
        .states
        .iter()
        .map(|state| {
            let along = state.attitude.inverse_transform_vector(&state.velocity_m_s);
            Vector3::new(along.y, along.x, 0.0)
        })
        .collect();
    let [about_x, about_y, none] = trace.weak_vector(0, &across);
    let of = |torque| channels(trace, nothing(trace), torque);
    [
        column(Nuisance::AirMoment(0), None, of([about_x, none.clone(), none.clone()])),
        column(Nuisance::AirMoment(1), None, of([none.clone(), about_y, none])),
    ]
}

/// The balance of a vehicle whose centre of mass is a guess, in averaged torques: it is not told from a mean wind that pushes the frame
/// beside its centre of mass, nor from rotors that differ a little.
fn guessed_balance(trace: &Trace, vehicle: &Vehicle) -> Vec<NuisanceColumn> {
    let of = |guess: &&Guess| guess.of == Guessed::CenterOfMass;
    let Some(guess) = vehicle.guesses.iter().find(of) else { return Vec::new() };
    let share_n = guess.relative * vehicle.body.mass_kg * trace.gravity_m_s2;
    let across_nm = share_n * mean_arm_m(vehicle);
    // of rotors that differ by chance, each has its whole torque about body z, and across it only the part of its arm along that axis
    let about_z_nm = SQRT_2 * share_n * vehicle.propulsion.torque_per_thrust_m;
    let about = |(axis, std_nm): (usize, f64)| {
        let mut torque = nothing(trace);
        torque[axis].fill(1.0);
        column(Nuisance::Balance(axis), Some(std_nm), channels(trace, nothing(trace), torque))
    };
    [across_nm, across_nm, about_z_nm].into_iter().enumerate().map(about).collect()
}

/// A column of the whole flight.
fn column(nuisance: Nuisance, prior_std: Option<f64>, values: Channels) -> NuisanceColumn {
    NuisanceColumn { nuisance, values, prior_std, prior_mean: 0.0, first_row: 0, considered: None }
}

/// The kinematics along body x and y as they come late: the force in the world changes as the thrust, N, turns with the body. It
/// goes with the velocity as a drag does, the faster the motion the more.
fn lateral_latency(trace: &Trace, thrust_n: &[f64]) -> NuisanceColumn {
    let values = turned_thrust(trace, thrust_n, SECOND);
    column(Nuisance::LateralLatency, Some(LATERAL_LATENCY_STD_S), values)
}

/// The body turns between the force and the frame of the accelerometer's sample of it, so the thrust, N, leans in the sample.
fn turned_accelerometer(trace: &Trace, thrust_n: &[f64]) -> NuisanceColumn {
    let values = turned_thrust(trace, thrust_n, 0);
    column(Nuisance::TurnedAccelerometer, Some(ACCELEROMETER_TURN_STD_S), values)
}

/// Change of the force across the rotor axis, N/s, in a reading that begins with this channel, as the thrust, N, turns with the body.
fn turned_thrust(trace: &Trace, thrust_n: &[f64], first: usize) -> Channels {
    let turning = trace.states.iter().zip(thrust_n).map(|(state, thrust_n)| {
        let rates = state.rates_rad_s;
        (-thrust_n * rates.y, thrust_n * rates.x)
    });
    let (along_x, along_y): (Vec<f64>, Vec<f64>) = turning.unzip();
    let mut values: Channels = std::array::from_fn(|_| vec![0.0; trace.rows()]);
    values[first] = trace.weak(0, &along_x);
    values[first + 1] = trace.weak(0, &along_y);
    values
}

/// The accelerometer's bias, and the level of the attitude for the kinematics, unless the base has an effect for it.
fn sensor_nuisances(trace: &Trace, mass_kg: f64, base: &Base) -> Vec<NuisanceColumn> {
    let leans = base.stands_for(Nuisance::Level(0));
    let mut out = Vec::new();
    if trace.has_accelerometer() && (trace.reads_force_twice() || !base.is_unbiased) {
        let prior_std = if trace.reads_force_twice() { None } else { Some(BIAS_STD_M_S2) };
        for axis in 0..3 {
            let mut values: Channels = std::array::from_fn(|_| vec![0.0; trace.rows()]);
            values[axis].fill(mass_kg);
            out.push(column(Nuisance::AccelerometerBias(axis), prior_std, values));
        }
    }
    if trace.known.attitude && trace.known.velocity && !leans {
        let first = if trace.has_accelerometer() { SECOND } else { 0 };
        for axis in 0..2 {
            // gravity leans by the error's cross product with up
            let lean = Vector3::ith(axis, 1.0).cross(&Vector3::z()) * (mass_kg * trace.gravity_m_s2);
            let leaning: Vec<Vector3<f64>> =
                trace.states.iter().map(|state| state.attitude.inverse_transform_vector(&lean)).collect();
            let mut values: Channels = std::array::from_fn(|_| vec![0.0; trace.rows()]);
            for (slot, column) in trace.weak_vector(0, &leaning).into_iter().enumerate() {
                values[first + slot] = column;
            }
            out.push(column(Nuisance::Level(axis), Some(LEVEL_STD_RAD), values));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::super::rows::tests::vehicle;
    use super::*;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::{ExplainSettings, explain};
    use crate::simulate::RandomTrajectory;
    use std::cell::Cell;

    #[test]
    fn products_of_inertia_are_known_about_those_of_the_vehicle_that_was_given() {
        let mut vehicle = vehicle();
        let (ixx, iyy) = (vehicle.body.inertia_kg_m2[(0, 0)], vehicle.body.inertia_kg_m2[(1, 1)]);
        let stated = 0.01 * ixx;
        vehicle.body.inertia_kg_m2[(0, 1)] = stated;
        let mut base = Base::rigid(&vehicle);
        base.vehicle.body.inertia_kg_m2[(0, 1)] = 0.1 * ixx;
        let product = INERTIA_ENTRIES.iter().position(|entry| *entry == (0, 1)).unwrap();
        let (std, mean) = product_prior(&base, product).unwrap();
        assert!((std - 0.03 * (ixx * iyy).sqrt()).abs() < 1e-12);
        assert!((mean - (stated - 0.1 * ixx)).abs() < 1e-12);
        let moment = INERTIA_ENTRIES.iter().position(|entry| *entry == (0, 0)).unwrap();
        assert_eq!(product_prior(&base, moment), None);
    }

    /// Thrusts that differ from their mean 1.4 times as much as the stated law has it, as of motors that are described with too flat a curve.
    #[test]
    fn a_thrust_law_that_does_not_hold_is_no_bias_of_the_accelerometer() {
        let truth_kg = Cell::new(0.0);
        let random = RandomTrajectory::default();
        let (mut signals, vehicle) =
            flown(4711, &random, |truth, _| truth_kg.set(truth.vehicle.body.mass_kg));
        (signals.velocity, signals.position, signals.attitude) = (None, None, None);
        let count = signals.rotor_thrust_n.len() as f64;
        let mean_n = signals.rotor_thrust_n.iter().sum::<f64>() / count;
        let steep = signals.rotor_thrust_n.iter().map(|thrust_n| mean_n + 1.4 * (thrust_n - mean_n));
        signals.rotor_thrust_n = steep.collect::<Vec<f64>>().into();
        let trace = Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap();
        let fitted = fit(&[trace], Base::rigid(&vehicle), Newton::Free).unwrap();
        let mass_kg = fitted.base.vehicle.body.mass_kg;
        assert!(fitted.base.is_unbiased, "{mass_kg} of {}", truth_kg.get());
        assert!((mass_kg / truth_kg.get() - 1.0).abs() < 0.04, "{mass_kg} of {}", truth_kg.get());
    }

    #[test]
    fn the_gyroscopic_torque_tells_the_moment_about_z_that_a_guessed_torque_puts_on_another_scale() {
        let truth_kg_m2 = Cell::new(0.0);
        let random = RandomTrajectory::default();
        let (signals, mut vehicle) =
            flown(4711, &random, |truth, _| truth_kg_m2.set(truth.vehicle.body.inertia_kg_m2[(2, 2)]));
        let torque_per_thrust_m = vehicle.propulsion.torque_per_thrust_m;
        vehicle.propulsion.torque_per_thrust_m *= 0.75;
        vehicle.guesses = vec![Guess { of: Guessed::TorqueRatio, relative: 0.45, why: String::new() }];
        let found = explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap().search.after;
        let of = |column: &NuisanceColumn| column.nuisance == Nuisance::GuessedMomentAboutZ;
        let place = found.rows.nuisances.iter().position(of).unwrap();
        let (body, propulsion) = (&found.base.vehicle.body, &found.base.vehicle.propulsion);
        let on_scale_kg_m2 = body.inertia_kg_m2[(2, 2)];
        let (told, std) =
            (on_scale_kg_m2 + found.coefficients[place], found.covariance[(place, place)].sqrt());
        let truth_kg_m2 = truth_kg_m2.get();
        let scale = propulsion.torque_per_thrust_m / torque_per_thrust_m;
        assert!((scale - 1.0).abs() > 0.15, "{scale}");
        assert!((on_scale_kg_m2 / truth_kg_m2 / scale - 1.0).abs() < 0.07, "{on_scale_kg_m2}, {truth_kg_m2}");
        assert!(
            std < 0.15 * truth_kg_m2 && (told - truth_kg_m2).abs() < 4.0 * std,
            "{told} +- {std}, {truth_kg_m2}"
        );
    }
}
