//! Planning of an excitation trajectory: from limits and a criterion to coefficients, margins and expected standard
//! errors.

use super::bounds::{Bound, Dynamics, Quantity, ROTOR_MARGINS, RotorMargin, bounds_of, bounds_to_plan_in};
use super::check::{SAMPLE_S, check};
use super::criterion::{Criterion, condition_number, scaled_condition_number};
use super::descent::{Iterate, Problem};
use super::expected::{FlightSpan, expected_standard_errors, share_at_bound};
use super::feasible::{StartPlace, feasible};
use super::information::GramSampler;
use super::noise::parameter_scale;
use super::optimise::Search;
use super::request::{Assessment, Plan, PlanError, PlanRequest, RestInside};
use super::room::rest_bounds;
use super::space::{AxisStart, SeriesSpace};
use crate::trajectory::{FourierTrajectory, check_size};
use crate::vehicle::{Limits, Vehicle};
use nalgebra::Vector4;

/// Samples a period and harmonic for the information; [`GramSampler`] says why so few are sufficient.
const INFORMATION_SAMPLES_PER_HARMONIC: u32 = 13;

/// Largest number of random starts of a search: each is held in memory.
const STARTS_MAX: u64 = 100_000;

/// How often a plan that breaks a bound is polished.
const POLISHES: u32 = 3;
/// Largest factor on the criterion for a plan that is safe if setpoints end: only the choice between plans.
const CALM_COSTS: f64 = 1.5;
/// Distances inside the room at which the vehicle is to come to rest, m, in the order of trial. The preflight check
/// refuses more than 1.25 m outside.
const INSIDE_M: [f64; 8] = [-1.25, -1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5];
/// Largest share of the commands of a simulated flight that may be at a rotor's bound: the transition from hover has
/// some, and more would contradict the thrust law.
const AT_BOUND_MAX: f64 = 0.002;

/// The margins of the rotors after that of the search, in the order of trial.
const LARGER_MARGINS: &[RotorMargin] = ROTOR_MARGINS.split_at(1).1;

/// Plans a trajectory. `done` is called once for each step of the work, [`work_of`] times in all.
///
/// ```no_run
/// use mavid::config::load_vehicle;
/// use mavid::plan::{Criterion, PlanRequest, plan};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let vehicle = load_vehicle("configs/qball2.toml".as_ref())?;
/// let request = PlanRequest { criterion: Criterion::DOpt, ..PlanRequest::default() };
/// let plan = plan(&vehicle, &vehicle.limits, &request, &|| ())?;
/// // relative standard errors of mass and inertia after five periods
/// println!("{:?}", plan.assessment.standard_errors);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// If a number is out of range, limits conflict, or no trajectory inside the limits was found.
pub fn plan(
    vehicle: &Vehicle,
    limits: &Limits,
    request: &PlanRequest,
    done: &(dyn Fn() + Sync),
) -> Result<Plan, PlanError> {
    let _stage = tracing::info_span!("plan", seed = request.seed, starts = request.starts).entered();
    check_request(request)?;
    feasible(limits, vehicle, &request.start)?;
    let mut problem = problem_of(vehicle, limits, request);
    let samples = whole((request.period_s / SAMPLE_S).ceil());
    let search = search_of(request);
    let best = search.run(&problem, samples, done).ok_or(PlanError::NotDetermined)?;
    let mut best = polished(&search, &problem, best, (vehicle, request))?;
    done();
    let mut rest = None;
    if request.rests_inside {
        (best, rest) = calmed(&search, &problem, best, (vehicle, limits, request), done);
    }
    let mut left = Left::of(LARGER_MARGINS.len(), done);
    // what a controller adds to the planned thrusts is known once it is flown
    for margin in LARGER_MARGINS {
        let trajectory = problem.space.trajectory(&best.unknowns);
        if share_at_bound(&trajectory, vehicle).is_some_and(|share| share <= AT_BOUND_MAX) {
            break;
        }
        problem.bounds = bounds_to_plan_in(limits, vehicle, *margin);
        problem.bounds.extend(rest.iter().flat_map(|rest| &rest.bounds).copied());
        let calmer = search.polish(&problem, best.unknowns.clone(), samples);
        match polished(&search, &problem, calmer, (vehicle, request)) {
            Ok(calmer) => best = calmer,
            // no calmer one fits in
            Err(_) => break,
        }
        left.step();
    }
    drop(left);
    let trajectory = problem.space.trajectory(&best.unknowns);
    // what is left is told to the bounds themselves
    let assessment = assess(&trajectory, vehicle, &bounds_of(limits, vehicle), request);
    let criterion_value = best.log_value.exp();
    tracing::info!(criterion = ?request.criterion, criterion_value, "trajectory planned");
    Ok(Plan { trajectory, criterion_value, assessment, rest })
}

/// The plan with which a vehicle without setpoints stays furthest inside the room, if the cost in the criterion is
/// small, and the bounds for it; the unchanged plan if there is none. The bounds are tightened in steps, because the
/// best plan without them is far outside of them.
fn calmed(
    search: &Search,
    problem: &Problem,
    best: Iterate,
    (vehicle, limits, request): (&Vehicle, &Limits, &PlanRequest),
    done: &(dyn Fn() + Sync),
) -> (Iterate, Option<RestInside>) {
    let mut left = Left::of(INSIDE_M.len(), done);
    let samples = whole((request.period_s / SAMPLE_S).ceil());
    let worth = best.log_value + CALM_COSTS.ln();
    let (mut calmest, mut kept) = (best, None);
    for inside_m in INSIDE_M {
        let Some(bounds) = rest_bounds(limits, vehicle, inside_m) else { break };
        let mut calm = problem.clone();
        calm.bounds.extend_from_slice(&bounds);
        let calmer = search.polish(&calm, calmest.unknowns.clone(), samples);
        match polished(search, &calm, calmer, (vehicle, request)) {
            Ok(calmer) if calmer.log_value <= worth => {
                (calmest, kept) = (calmer, Some(RestInside { inside_m, bounds }));
            }
            _ => break,
        }
        left.step();
    }
    (calmest, kept)
}

/// Polishes the plan until every bound is kept.
fn polished(
    search: &Search,
    problem: &Problem,
    mut best: Iterate,
    (vehicle, request): (&Vehicle, &PlanRequest),
) -> Result<Iterate, PlanError> {
    let samples = whole((request.period_s / SAMPLE_S).ceil());
    let dynamics = Dynamics::new(vehicle);
    let mut polished = 0;
    loop {
        if !best.log_value.is_finite() {
            return Err(PlanError::NotDetermined);
        }
        let trajectory = problem.space.trajectory(&best.unknowns);
        let report = check(|t| trajectory.derivatives(t), trajectory.period_s, &problem.bounds, &dynamics);
        match report.first_violation {
            None => return Ok(best),
            Some(violation) if polished == POLISHES => {
                return Err(PlanError::OutsideLimits { starts: request.starts, violation });
            }
            Some(_) => best = search.polish(problem, best.unknowns, samples),
        }
        polished += 1;
    }
}

/// The largest share by which a peak can exceed the samples beside it. Attitude multiplies path by yaw and therefore
/// contains twice the highest harmonic.
fn rise_between_samples(request: &PlanRequest) -> f64 {
    let highest_rad_s = 2.0 * std::f64::consts::TAU * f64::from(request.harmonics) / request.period_s;
    0.5 * (0.5 * highest_rad_s * SAMPLE_S).powi(2)
}

/// Steps of a part of the work, of which fewer may be needed than there are: the rest is done with its end.
struct Left<'a> {
    steps: usize,
    done: &'a (dyn Fn() + Sync),
}

impl<'a> Left<'a> {
    fn of(steps: usize, done: &'a (dyn Fn() + Sync)) -> Self {
        Self { steps, done }
    }

    fn step(&mut self) {
        if self.steps > 0 {
            self.steps -= 1;
            (self.done)();
        }
    }
}

impl Drop for Left<'_> {
    fn drop(&mut self) {
        while self.steps > 0 {
            self.step();
        }
    }
}

/// Steps of the whole work for a request, for a progress bar: the descents of the search, the plan brought inside every
/// bound, the steps further inside the room, and the larger margins of the rotors.
#[must_use]
pub fn work_of(request: &PlanRequest) -> u64 {
    let inside = if request.rests_inside { INSIDE_M.len() } else { 0 };
    search_of(request).work() + 1 + (inside + LARGER_MARGINS.len()) as u64
}

/// The search for a request. Bounds are tightened by the possible rise of a peak between two samples.
#[must_use]
pub fn search_of(request: &PlanRequest) -> Search {
    let mut search = Search::new(request.seed, request.starts);
    search.margin = search.margin.max(rise_between_samples(request));
    search
}

/// Assesses any series.
#[must_use]
pub fn assess(
    trajectory: &FourierTrajectory,
    vehicle: &Vehicle,
    bounds: &[Bound],
    request: &PlanRequest,
) -> Assessment {
    let dynamics = Dynamics::new(vehicle);
    let gravity = vehicle.gravity_m_s2;
    let samples = whole((trajectory.period_s / SAMPLE_S).round().max(1.0));
    let gram = GramSampler::of_series(trajectory, samples, Vector4::repeat(1.0), gravity);
    let flight_s = f64::from(request.repeats) * trajectory.period_s;
    Assessment {
        condition_number: condition_number(&gram),
        scaled_condition_number: scaled_condition_number(&gram),
        standard_errors: expected_standard_errors(
            trajectory,
            vehicle,
            &request.noise,
            FlightSpan { flown_s: flight_s, left_out_s: 0.0 },
        ),
        flight_s,
        check: check(|t| trajectory.derivatives(t), trajectory.period_s, bounds, &dynamics),
        share_at_bound: share_at_bound(trajectory, vehicle),
    }
}

fn problem_of(vehicle: &Vehicle, limits: &Limits, request: &PlanRequest) -> Problem {
    let space = SeriesSpace::new(request.period_s, request.harmonics, starts_of(limits, request));
    let information = match request.criterion {
        Criterion::Cond | Criterion::ScaledCond => Vector4::repeat(1.0),
        Criterion::DOpt | Criterion::AOpt => {
            let flight_s = f64::from(request.repeats) * request.period_s;
            request.noise.row_information(vehicle) * flight_s
        }
    };
    let samples = INFORMATION_SAMPLES_PER_HARMONIC * request.harmonics;
    Problem {
        sampler: GramSampler::new(&space, samples, information, vehicle.gravity_m_s2),
        criterion: request.criterion,
        parameter_scale: parameter_scale(vehicle),
        bounds: bounds_to_plan_in(limits, vehicle, ROTOR_MARGINS[0]),
        dynamics: Dynamics::new(vehicle),
        space,
    }
}

/// Start conditions of the axes. The height is free unless it is prescribed, and so is the place of a plan that is to
/// rest inside the room. A start on a bound has no jerk, and keeps the same distance to the bound as all other points.
fn starts_of(limits: &Limits, request: &PlanRequest) -> [AxisStart; 4] {
    let margin = search_of(request).margin;
    let at = |value: f64, min: Option<f64>, max: Option<f64>| {
        let bound = Bound { quantity: Quantity::Path { axis: 0, order: 0 }, min, max };
        let off = margin * bound.scale();
        let near = |bound: &f64| (bound - value).abs() < off;
        if let Some(min) = min.filter(near) {
            AxisStart::OnBound(min + off)
        } else if let Some(max) = max.filter(near) {
            AxisStart::OnBound(max - off)
        } else {
            AxisStart::At(value)
        }
    };
    let both = |value: f64, max: Option<f64>| at(value, max.map(|max| -max), max);
    let start = &request.start;
    let height = match (start.z_m, limits.z_min_m, limits.z_max_m) {
        (Some(z), min, max) => at(z, min, max),
        (None, Some(min), Some(max)) => AxisStart::Near(0.5 * (min + max)),
        (None, Some(only), None) => AxisStart::Near(only + 1.0),
        (None, None, Some(only)) => AxisStart::Near(only - 1.0),
        (None, None, None) => AxisStart::At(0.0),
    };
    // where a series lies costs nothing: in the middle it is furthest from the walls
    let level = |value: Option<f64>, max: Option<f64>| match value {
        None if request.rests_inside => AxisStart::Near(0.0),
        value => both(value.unwrap_or(0.0), max),
    };
    [
        level(start.x_m, limits.x_max_m),
        level(start.y_m, limits.y_max_m),
        height,
        both(start.yaw_rad, limits.yaw_max_rad),
    ]
}

fn check_request(request: &PlanRequest) -> Result<(), PlanError> {
    let refuse = |name, expected, came: String| Err(PlanError::Request { name, expected, came });
    if !(0.1..=1000.0).contains(&request.period_s) {
        return refuse("period", "0.1 to 1000 s", request.period_s.to_string());
    }
    if !(4..=20).contains(&request.harmonics) {
        return refuse("harmonics", "4 to 20", request.harmonics.to_string());
    }
    check_size(request.period_s, whole_harmonics(request), request.repeats)?;
    if request.starts == 0 || request.starts > STARTS_MAX {
        return refuse("starts", "1 to 100000", request.starts.to_string());
    }
    let StartPlace { x_m, y_m, z_m, yaw_rad } = request.start;
    let place = [x_m.unwrap_or(0.0), y_m.unwrap_or(0.0), z_m.unwrap_or(0.0), yaw_rad];
    if place.iter().any(|value| !value.is_finite()) {
        return refuse("start", "finite numbers", format!("{place:?}"));
    }
    Ok(())
}

/// As a count of values.
fn whole_harmonics(request: &PlanRequest) -> usize {
    usize::try_from(request.harmonics).unwrap_or(usize::MAX)
}

/// A count that is known to be small and positive, as an integer.
fn whole(count: f64) -> u32 {
    let mut low = 0_u32;
    let mut high = 1_000_000_u32;
    while low < high {
        let middle = low + (high - low) / 2;
        if f64::from(middle) < count { low = middle + 1 } else { high = middle }
    }
    low
}
