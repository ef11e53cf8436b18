//! Forecast of identification and diagnosis: both are tried on the two minutes of the log with the most excitation.

use crate::diagnose::{ExpectedError, LAW_OF_THRUST, LAW_OF_TORQUE, expected_errors};
use crate::draft::{Given, draft};
use crate::estimate::{
    Contradiction, Estimated, GuessedCurve, WeakInformation, contradicted, solve_weak, theta_of,
};
use crate::recording::{Quantity, Recording};
use crate::regression::{WeakMotion, weak_rows};
use crate::signals::{
    ConditionSettings, Signals, SignalsError, ThrustPreference, ThrustSource, WeakKernel, best, condition,
    median_period_s,
};
use crate::vehicle::{Guessed, Vehicle};

/// Shortest step of the grid, s: what is faster adds memory and no knowledge to a kernel of 0.4 s.
const LEAST_STEP_S: f64 = 0.008;
/// Mass of the vehicle that is assumed where none is given, kg: what is relative does not depend on it.
const ASSUMED_KG: f64 = 1.0;

/// What would come out of a log.
#[derive(Debug)]
pub(super) struct Forecast {
    /// by which vehicle: the given one, or one drafted from the log
    pub vehicle: Vehicle,
    /// mass and size are assumed: only what is relative counts
    pub assumed: bool,
    /// rigid body, by this window alone
    pub body: Option<Estimated>,
    /// what `identify` makes of this window that is far from what the given vehicle's file states
    pub contradictions: Vec<Contradiction>,
    /// the other quantities; why there are none
    pub effects: Result<Vec<ExpectedError>, String>,
}

impl Forecast {
    /// The vehicle of assumed mass and size, and the rigid body that would come out; `None` where one was given.
    pub(super) fn assumed(&self) -> Option<(&Vehicle, &Estimated)> {
        Some((&self.vehicle, self.body.as_ref()?)).filter(|_| self.assumed)
    }
}

/// What would come out of a window of flight.
///
/// # Errors
/// Why it cannot be conditioned; `None` where no vehicle is given and none can be drafted.
pub(super) fn forecast(
    window: &Recording,
    vehicle: Option<&Vehicle>,
) -> Result<Forecast, Option<SignalsError>> {
    let given = Given { mass_kg: ASSUMED_KG, size_m: None, frame: None };
    let known = vehicle.cloned().or_else(|| Some(draft(window, &given, "assumed").ok()?.vehicle));
    let mut known = known.ok_or(None)?;
    if vehicle.is_none() {
        // what is relative rests on the shape of the curve alone
        known.guesses.retain(|guess| guess.of == Guessed::Expo);
    }
    let period_s = best(window, Quantity::AngularRate, |stream| stream.width == 3)
        .map_or(LEAST_STEP_S, |(_, stream)| median_period_s(stream));
    let step_s = (period_s < LEAST_STEP_S).then_some(LEAST_STEP_S);
    let settings = ConditionSettings { step_s, ..ConditionSettings::default() };
    let signals = condition(window, &known, &settings)?;
    // rotor speeds may be there for the rigid body, and better commands for the effects
    let for_effects = ConditionSettings { thrust: ThrustPreference::BestSampled, ..settings };
    let of_effects = match signals.quality.thrust_source {
        ThrustSource::MeasuredSpeed => condition(window, &known, &for_effects).ok(),
        _ => None,
    };
    let of_effects = std::slice::from_ref(of_effects.as_ref().unwrap_or(&signals));
    Ok(Forecast {
        contradictions: vehicle
            .map(|vehicle| contradicted(std::slice::from_ref(&signals), vehicle))
            .unwrap_or_default(),
        body: body(&signals, &known),
        effects: expected_errors(of_effects, &known).map_err(|error| error.to_string()),
        assumed: vehicle.is_none(),
        vehicle: known,
    })
}

fn body(signals: &Signals, vehicle: &Vehicle) -> Option<Estimated> {
    Some(Learnt::of(signals, vehicle)?.combined())
}

/// What the weak form learns of windows of flight.
#[derive(Debug, Clone)]
pub(super) struct Learnt {
    body: WeakInformation,
    /// the same at both ends of a guessed thrust curve
    at_ends: Option<(GuessedCurve, [WeakInformation; 2])>,
}

impl Learnt {
    /// Of a window; `None` where nothing can be learnt.
    pub(super) fn of(signals: &Signals, vehicle: &Vehicle) -> Option<Self> {
        let at_ends = GuessedCurve::of(vehicle).and_then(|curve| {
            let [low, high] = curve.bent(signals, vehicle);
            Some((curve, [information(&low, vehicle)?, information(&high, vehicle)?]))
        });
        Some(Self { body: information(signals, vehicle)?, at_ends })
    }

    /// Adds another window.
    pub(super) fn add(&mut self, other: &Self) {
        self.body.add(&other.body);
        if let (Some((_, ends)), Some((_, others))) = (&mut self.at_ends, &other.at_ends) {
            ends.iter_mut().zip(others).for_each(|(end, other)| end.add(other));
        }
    }

    /// The estimate that all windows together give.
    pub(super) fn combined(&self) -> Estimated {
        let body = self.body.combined();
        let moved = self.at_ends.as_ref().map(|(curve, [low, high])| {
            curve.moved([&low.combined().theta, &high.combined().theta]).on(&body.theta)
        });
        with_laws(body.with_guessed_curve(moved))
    }
}

/// With the errors that the laws of thrust and torque add to mass and moments of inertia.
fn with_laws(mut body: Estimated) -> Estimated {
    let [about_x, about_y, about_z] = LAW_OF_TORQUE;
    for (index, law) in [(0, LAW_OF_THRUST), (1, about_x), (4, about_y), (6, about_z)] {
        body.covariance[(index, index)] += (law * body.theta[index]).powi(2);
    }
    body
}

/// What the weak form learns of a window.
fn information(signals: &Signals, vehicle: &Vehicle) -> Option<WeakInformation> {
    let kernel = WeakKernel::new(ConditionSettings::default().weak_half_width_s, signals.grid.step_s);
    let motion = WeakMotion::measured(signals, &kernel, vehicle.gravity_m_s2);
    let rows = weak_rows(signals, &motion, &kernel);
    let estimate = solve_weak(&[rows], &theta_of(&vehicle.body))?;
    Some(WeakInformation::of(&estimate))
}
