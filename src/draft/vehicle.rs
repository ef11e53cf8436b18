//! Puts a vehicle together from what is stated, what was weighed and measured, and rules of thumb.

use nalgebra::{Matrix3, Vector3};

use super::hover::full_thrust;
use super::rules::{self, Rule};
use crate::autopilot::{Frame, Layout, LayoutError, LayoutUnit, Outputs, Stack};
use crate::recording::Recording;
use crate::signals::{RotorDifference, bus_range, holds_fractions, rotor_difference};
use crate::text::{compact, significant};
use crate::units::GRAVITY_M_S2;
use crate::vehicle::{
    Actuator, Anchor, Guess, Guessed, Limits, Propulsion, PwmRange, RigidBody, Rotor, Spin, ThrustLaw,
    Vehicle,
};

/// What a person knows of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// weighed, with battery, kg
    pub mass_kg: f64,
    /// from motor to motor across the centre, m: what frames are sold by
    pub size_m: Option<f64>,
    /// where the motors are; without it by the parameters
    pub frame: Option<&'static Frame>,
}

impl Given {
    /// Whether these can be the numbers of a multirotor.
    ///
    /// # Errors
    /// [`DraftError::Given`]: one of them cannot.
    pub fn checked(&self) -> Result<(), DraftError> {
        let within = |what, unit, (least, most): (f64, f64), came: f64| {
            if (least..=most).contains(&came) {
                Ok(())
            } else {
                Err(DraftError::Given { what, least, most, unit, came })
            }
        };
        within("mass", "kg", MASSES_KG, self.mass_kg)?;
        self.size_m.map_or(Ok(()), |size_m| within("size", "m", SIZES_M, size_m))
    }
}

/// A vehicle, and where its values come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// complete, with its guesses; the mass is the anchor
    pub vehicle: Vehicle,
    /// where the other values come from, sentence by sentence
    pub origins: Vec<String>,
    /// what is given and contradicts the log, sentence by sentence
    pub doubts: Vec<String>,
}

/// Why there is no vehicle.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DraftError {
    /// a number that no vehicle has
    #[error("expected a {what} from {least} to {most} {unit}, got {came}")]
    Given {
        /// mass or size
        what: &'static str,
        /// least
        least: f64,
        /// greatest
        most: f64,
        /// unit
        unit: &'static str,
        /// what was given
        came: f64,
    },
    /// an autopilot whose parameters are not known here
    #[error(
        "expected a log or vehicle of PX4 or ArduPilot, whose parameters say where the motors are, got none; give the frame \
         (--frame quadrotor-x)"
    )]
    Autopilot,
    /// the rotors' places are not known
    #[error("{0}; give the frame (--frame quadrotor-x)")]
    Layout(#[from] LayoutError),
}

/// Masses of multirotors, kg. Outside of it a unit is mistaken; nothing between is refused.
const MASSES_KG: (f64, f64) = (0.005, 500.0);
/// Sizes of multirotors, m. Outside of it a unit is mistaken; nothing between is refused.
const SIZES_M: (f64, f64) = (0.03, 10.0);
/// Pulse widths of none and of full command where no parameter states them, microseconds: the usual range.
const PULSES_US: (f64, f64) = (1000.0, 2000.0);
/// Rotors that do not overlap have a radius of less than half the distance of their hubs.
const CLEAR: f64 = 0.48;
/// Standard error of a thrust curve's exponent that a parameter states, and of one that is stated as linear, which is
/// the default of PX4. Set by judgement: a curve is measured at one voltage and with one propeller; the standard
/// errors of what is identified contain it.
const EXPO_STATED: f64 = 0.15;
/// See [`EXPO_STATED`].
const EXPO_LINEAR: f64 = 0.3;
/// Relative standard error of a full thrust by the share of thrust at which the autopilot expects to hover. Set by
/// judgement: many leave the default.
const BY_HOVER_SHARE: f64 = 0.25;

/// What the commands of a recording mean, as a first description of its vehicle would have it.
#[must_use]
pub fn actuator_of(recording: &Recording) -> Actuator {
    let outputs = recording.autopilot.stack().map(|stack| &stack.outputs);
    Noted::default().command(recording, outputs).0
}

/// A first description of the vehicle that a recording is of. Without streams, as from a vehicle's parameters alone, the
/// full thrust rests on the autopilot's hover parameter. `name` is the vehicle's, for reports.
///
/// # Errors
/// [`DraftError`] where a given number is no vehicle's, or the parameters do not say where the rotors are.
pub fn draft(recording: &Recording, given: &Given, name: &str) -> Result<Draft, DraftError> {
    given.checked()?;
    let stack = recording.autopilot.stack();
    let outputs = stack.map(|stack| &stack.outputs);
    let parameter = |name: &str| recording.parameters.get(name).copied();
    let layout = match (stack, given.frame) {
        (Some(stack), _) => layout(stack, given, &parameter)?,
        (None, Some(frame)) => Layout::of(frame, GIVEN_FRAME),
        (None, None) => return Err(DraftError::Autopilot),
    };
    let mut noted = Noted::default();
    let arm_m = noted.arm(&layout, given);
    let rotors = rotors(&layout, arm_m / layout.radius());
    let body = noted.body(given.mass_kg, arm_m);
    let (actuator, expo) = noted.command(recording, outputs);
    let radius_m = noted.rotor_radius(&rotors, arm_m);
    let torque_per_thrust_m = noted.torque_ratio(radius_m);
    let mut vehicle = Vehicle {
        name: name.to_owned(),
        body,
        propulsion: Propulsion {
            actuator,
            law: ThrustLaw::Curve { thrust_max_n: 1.0, expo },
            thrust_coefficient: None,
            torque_per_thrust_m,
            rotor_radius_m: Some(radius_m),
            time_constant_s: None,
            time_constant_down_s: None,
        },
        rotors,
        limits: Limits::default(),
        anchor: Anchor::Mass,
        gravity_m_s2: GRAVITY_M_S2,
        guesses: Vec::new(),
    };
    let thrust_max_n = noted.thrust_max(recording, outputs, &vehicle);
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n, expo };
    let of = stack.map_or_else(String::new, |stack| format!(" of {}", stack.name));
    noted.origins.insert(0, format!("{}{of} by {}", layout.name, layout.stated_by));
    vehicle.guesses = noted.guesses;
    let other =
        given.frame.and_then(|_| rotor_difference(recording.autopilot, &recording.parameters, &vehicle));
    let contradiction = |RotorDifference { file, stated, .. }: &RotorDifference| {
        format!(
            "--frame: the given frame contradicts the autopilot's parameters: {stated}, the given frame has {file}: leave \
             --frame out, and the parameters say where the motors are"
        )
    };
    let arms_are_known = vehicle.guessed(Guessed::Arms) == 0.0;
    let unfit = unfit(given, arm_m).filter(|_| arms_are_known);
    let doubts = other.iter().map(contradiction).chain(unfit).collect();
    Ok(Draft { vehicle, origins: noted.origins, doubts })
}

/// A mass that does not go with the arms (m), in a sentence.
fn unfit(given: &Given, arm_m: f64) -> Option<String> {
    let (least, most) = rules::mass_over_arm_squared();
    let (least, most) = (least / rules::BEYOND_PUBLISHED, most * rules::BEYOND_PUBLISHED);
    let square_m2 = arm_m * arm_m;
    if (least * square_m2..=most * square_m2).contains(&given.mass_kg) {
        return None;
    }
    let what = if given.size_m.is_some() { "--size" } else { "the arms that the parameters state" };
    Some(format!(
        "--mass: {} kg does not go with {what}: with arms of {} m it would be {} to {} kg, a factor of {} on both sides of published \
         multirotors. Weigh the vehicle with its battery, in kg, and measure from motor to motor across the centre, in m",
        compact(given.mass_kg),
        compact(arm_m),
        significant(least * square_m2, 2),
        significant(most * square_m2, 2),
        rules::BEYOND_PUBLISHED
    ))
}

/// What states the layout, where it is not the parameters.
const GIVEN_FRAME: &str = "the given frame";

/// Where the rotors are, by what is given or by the parameters.
pub(super) fn layout(
    stack: &Stack,
    given: &Given,
    parameter: &dyn Fn(&str) -> Option<f64>,
) -> Result<Layout, LayoutError> {
    match given.frame {
        Some(frame) => Ok(Layout::of(frame, GIVEN_FRAME)),
        None => stack.geometry.layout(parameter, stack.outputs.motors(parameter)),
    }
}

fn rotors(layout: &Layout, scale: f64) -> Vec<Rotor> {
    // a cosine of a right angle is not quite nothing
    let place = |share: f64| if share.abs() < 1e-9 { 0.0 } else { rounded(share * scale) };
    let rotor = |(index, rotor): (usize, &crate::autopilot::RotorPlace)| Rotor {
        name: format!("motor_{}", index + 1),
        position_m: Vector3::from(rotor.place).map(place),
        spin: if rotor.ccw { Spin::Ccw } else { Spin::Cw },
    };
    layout.rotors.iter().enumerate().map(rotor).collect()
}

/// To five significant digits: none of it is known better, and files are read by people.
fn rounded(value: f64) -> f64 {
    // without the negative zero
    format!("{value:.4e}").parse::<f64>().unwrap_or(value) + 0.0
}

/// Values as they are decided, and why.
#[derive(Default)]
struct Noted {
    guesses: Vec<Guess>,
    origins: Vec<String>,
}

impl Noted {
    fn guess(&mut self, of: Guessed, relative: f64, why: impl Into<String>) {
        let relative = format!("{relative:.2}").parse().unwrap_or(relative);
        self.guesses.push(Guess { of, relative, why: why.into() });
    }

    /// Distance of the outermost rotor from the centre, m.
    fn arm(&mut self, layout: &Layout, given: &Given) -> f64 {
        match (given.size_m, layout.unit) {
            (Some(size_m), _) => {
                self.origins.push(format!("arms from the given size of {size_m} m"));
                0.5 * size_m
            }
            (None, LayoutUnit::Metres) => {
                self.origins.push("arms as the parameters state them".to_owned());
                layout.radius()
            }
            (None, LayoutUnit::Shares) => {
                let Rule { usual, relative } = rules::arm();
                self.guess(
                    Guessed::Arms,
                    relative,
                    "usual for the mass; the parameters state ratios only, give the size",
                );
                usual * given.mass_kg.cbrt()
            }
        }
    }

    /// A body as flat as multirotors are.
    fn body(&mut self, mass_kg: f64, arm_m: f64) -> RigidBody {
        let (horizontal, vertical) = (rules::horizontal_inertia(), rules::vertical_inertia());
        let unit = mass_kg * arm_m * arm_m;
        let relative = horizontal.relative.max(vertical.relative);
        self.guess(Guessed::Inertia, relative, "usual for mass and arms, of seven published multirotors");
        self.guess(Guessed::CenterOfMass, rules::BALANCE, "usual between flights, with rotors that differ");
        let moments = Vector3::new(horizontal.usual, horizontal.usual, vertical.usual);
        let moments = moments.map(|moment| rounded(moment * unit));
        RigidBody {
            mass_kg,
            inertia_kg_m2: Matrix3::from_diagonal(&moments),
            center_of_mass_m: Vector3::zeros(),
            gyroscopic: 1.0,
        }
    }

    /// What a command of an autopilot that is not known means, and the exponent of its thrust curve.
    fn command_of_any(&mut self, recording: &Recording) -> (Actuator, f64) {
        let Rule { usual, relative } = rules::THRUST_EXPO;
        self.guess(Guessed::Expo, relative, "usual; no autopilot's parameter states it");
        if holds_fractions(recording) {
            self.origins.push("commands in 0..1, from no thrust to full thrust".to_owned());
            return (Actuator::Thrust, usual);
        }
        let (min_us, max_us) = PULSES_US;
        self.origins.push(format!("pulses from {min_us} to {max_us} us, usual, stated by no parameter"));
        (Actuator::Pwm(Some(PwmRange { min_us, max_us })), usual)
    }

    /// What a command means, and the exponent of its thrust curve.
    fn command(&mut self, recording: &Recording, outputs: Option<&Outputs>) -> (Actuator, f64) {
        let Some(outputs) = outputs else { return self.command_of_any(recording) };
        let parameter = |name: &str| recording.parameters.get(name).copied();
        let stated = parameter(outputs.expo).filter(|expo| (0.0..=1.0).contains(expo));
        if holds_fractions(recording) {
            // the autopilot takes its curve out between these commands and the pulses
            self.origins.push("commands in 0..1, which the autopilot takes for shares of thrust".to_owned());
            self.guess(Guessed::Expo, EXPO_LINEAR, "linear in the command, as the autopilot takes it");
            return (Actuator::Thrust, 0.0);
        }
        let range = outputs.pulses.ends_us(parameter).filter(|(low_us, high_us)| high_us > low_us);
        let (min_us, max_us) = match (bus_range(recording), range) {
            (Some(PwmRange { min_us, max_us }), _) => {
                self.origins
                    .push(format!("outputs of a bus, from {min_us} to {max_us}, as the log holds them"));
                (min_us, max_us)
            }
            (None, range) => {
                // parameters are in single precision
                let (min_us, max_us) =
                    range.map_or(PULSES_US, |(min_us, max_us)| (rounded(min_us), rounded(max_us)));
                let from =
                    if range.is_some() { "by its parameters" } else { "usual, stated by no parameter" };
                self.origins.push(format!("pulses from {min_us} to {max_us} us, {from}"));
                (min_us, max_us)
            }
        };
        let linear = outputs.linear_without_expo.then_some(0.0);
        let expo = match stated.or(linear) {
            Some(expo) => {
                let expo = rounded(expo);
                let deviation = if expo > 0.0 { EXPO_STATED } else { EXPO_LINEAR };
                self.guess(Guessed::Expo, deviation, format!("{} = {expo}", outputs.expo));
                expo
            }
            None => {
                let Rule { usual, relative } = rules::THRUST_EXPO;
                self.guess(Guessed::Expo, relative, format!("usual; the log holds no {}", outputs.expo));
                usual
            }
        };
        (Actuator::Pwm(Some(PwmRange { min_us, max_us })), expo)
    }

    /// As large as is usual, and clear of its neighbours, m.
    fn rotor_radius(&mut self, rotors: &[Rotor], arm_m: f64) -> f64 {
        let Rule { usual, relative } = rules::rotor_radius();
        self.guess(Guessed::RotorRadius, relative, "usual for the arms");
        let apart = |a: &Rotor, b: &Rotor| (a.position_m.xy() - b.position_m.xy()).norm();
        let pairs = rotors
            .iter()
            .enumerate()
            .flat_map(|(at, one)| rotors[at + 1..].iter().map(move |other| apart(one, other)));
        // coaxial rotors stand above each other
        let nearest_m = pairs.filter(|distance_m| *distance_m > 0.1 * arm_m).fold(f64::INFINITY, f64::min);
        rounded((usual * arm_m).min(CLEAR * nearest_m))
    }

    /// Torque for each thrust, m.
    fn torque_ratio(&mut self, radius_m: f64) -> f64 {
        let Rule { usual, relative } = rules::torque_per_thrust();
        let relative = relative.hypot(rules::rotor_radius().relative);
        self.guess(Guessed::TorqueRatio, relative, "usual for the rotors' radius");
        rounded(usual * radius_m)
    }

    /// Full thrust of one rotor, N, of a vehicle whose full thrust is still 1 N.
    fn thrust_max(&mut self, recording: &Recording, outputs: Option<&Outputs>, unit: &Vehicle) -> f64 {
        if let Some(shown) = full_thrust(recording, unit) {
            let by = if shown.felt { "its accelerometer" } else { "its hover" };
            self.guess(
                Guessed::ThrustMax,
                shown.relative,
                format!("from the mass, the commands of the flight and {by}"),
            );
            return rounded(shown.thrust_max_n);
        }
        let weight_n = unit.body.mass_kg * unit.gravity_m_s2 / unit.rotors.len() as f64;
        let hover = outputs.and_then(|outputs| {
            let share = recording.parameters.get(outputs.hover).copied()?;
            // parameters are in single precision
            (0.05..0.95).contains(&share).then(|| (outputs.hover, rounded(share)))
        });
        if let Some((name, share)) = hover {
            self.guess(Guessed::ThrustMax, BY_HOVER_SHARE, format!("from the mass and {name} = {share}"));
            return rounded(weight_n / share);
        }
        let Rule { usual, relative } = rules::THRUST_TO_WEIGHT;
        self.guess(Guessed::ThrustMax, relative, "usual for the weight");
        rounded(usual * weight_n)
    }
}

#[cfg(test)]
#[path = "vehicle_tests.rs"]
mod tests;
