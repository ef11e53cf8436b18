//! The planner against the paper, against its own limits, and against itself.

use crate::python;
use crate::support::require;

use mavid::config::{read_trajectory, read_vehicle};
use mavid::plan::{
    Criterion, FlightPlan, PlanError, PlanRequest, Quantity, StartPlace, assess, bounds_of, check,
    flight_path, plan, search_of, work_of,
};
use mavid::vehicle::Vehicle;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

fn configs() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs")
}

fn vehicle(name: &str) -> Vehicle {
    read_vehicle(&configs().join(name)).unwrap().vehicle
}

fn largest(report: &mavid::plan::CheckReport, quantity: Quantity) -> f64 {
    let of_quantity = report.margins.iter().filter(|margin| margin.quantity == quantity);
    of_quantity.map(|margin| margin.value.abs()).fold(0.0, f64::max)
}

#[test]
fn table_2_has_the_papers_condition_number_and_breaks_its_angle_bounds() {
    let vehicle = vehicle("qball2.toml");
    let table_2 = read_trajectory(&configs().join("trajectories/table2.toml")).unwrap();
    let bounds = bounds_of(&vehicle.limits, &vehicle);
    let worth = assess(&table_2.series, &vehicle, &bounds, &PlanRequest::default());
    assert!((worth.condition_number - 16.22).abs() < 0.005, "{}", worth.condition_number);
    assert!((worth.scaled_condition_number - 1.04).abs() < 0.005, "{}", worth.scaled_condition_number);
    assert!((largest(&worth.check, Quantity::Roll).to_degrees() - 6.22).abs() < 0.005);
    assert!((largest(&worth.check, Quantity::Pitch).to_degrees() - 6.07).abs() < 0.005);
    // and yaw rate by 0.3 %, more than its four printed digits can explain
    let yaw_rate = Quantity::Path { axis: 3, order: 1 };
    assert!((largest(&worth.check, yaw_rate).to_degrees() - 28.73).abs() < 0.005);
    // those digits leave z 5e-5 m below its bound
    assert!(worth.check.first_violation.is_some());
    let broken = worth.check.margins.iter().filter(|margin| margin.spare() < -1e-4);
    let known = [Quantity::Roll, Quantity::Pitch, yaw_rate];
    assert!(broken.into_iter().all(|margin| known.contains(&margin.quantity)));
}

#[test]
fn qball_2_reaches_16_20_with_every_bound_kept() {
    let vehicle = vehicle("qball2.toml");
    let plan = plan(&vehicle, &vehicle.limits, &PlanRequest::default(), &|| {}).unwrap();
    assert!(plan.assessment.condition_number <= 16.20, "{}", plan.assessment.condition_number);
    assert!((plan.criterion_value - plan.assessment.condition_number).abs() < 1e-6);
    assert_eq!(plan.assessment.check.first_violation, None);
    assert!(plan.assessment.check.margins.iter().all(|margin| margin.spare() >= 0.0));
    for time_s in [0.0, 10.0] {
        for axis in plan.trajectory.derivatives(time_s) {
            assert!(axis[1].abs() < 1e-12 && axis[2].abs() < 1e-12);
        }
    }
}

#[test]
fn the_papers_own_start_on_the_floor_keeps_every_bound() {
    let vehicle = vehicle("qball2.toml");
    let start = StartPlace { z_m: Some(0.7), ..StartPlace::default() };
    let request = PlanRequest { start, ..PlanRequest::default() };
    let plan = plan(&vehicle, &vehicle.limits, &request, &|| {}).unwrap();
    assert!(plan.assessment.condition_number < 16.25, "{}", plan.assessment.condition_number);
    assert_eq!(plan.assessment.check.first_violation, None);
    assert!((plan.trajectory.derivatives(0.0)[2][0] - 0.7).abs() < 1e-5);
}

#[test]
fn a_seed_gives_one_plan_whatever_the_number_of_threads() {
    let vehicle = vehicle("qball2.toml");
    let request = PlanRequest { starts: 4, seed: 3, ..PlanRequest::default() };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| plan(&vehicle, &vehicle.limits, &request, &|| {}).unwrap())
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one, three);
    let other = PlanRequest { seed: 4, ..request };
    assert_ne!(one.trajectory, plan(&vehicle, &vehicle.limits, &other, &|| {}).unwrap().trajectory);
}

#[test]
fn every_criterion_improves_on_table_2s_manner_of_flight() {
    let vehicle = vehicle("x500.toml");
    for criterion in [Criterion::ScaledCond, Criterion::DOpt, Criterion::AOpt] {
        let request = PlanRequest { criterion, starts: 4, ..PlanRequest::default() };
        let plan = plan(&vehicle, &vehicle.limits, &request, &|| {}).unwrap();
        assert_eq!(plan.assessment.check.first_violation, None, "{criterion:?}");
        let errors = plan.assessment.standard_errors.unwrap();
        if criterion == Criterion::ScaledCond {
            assert!(plan.assessment.scaled_condition_number < 1.05);
        } else {
            assert!(errors.iter().all(|error| *error < 0.05), "{criterion:?} {errors:?}");
        }
    }
}

#[test]
fn conflicts_are_named() {
    let vehicle = vehicle("qball2.toml");
    let message = |change: &dyn Fn(&mut mavid::vehicle::Limits, &mut PlanRequest)| {
        let (mut limits, mut request) = (vehicle.limits, PlanRequest::default());
        change(&mut limits, &mut request);
        match plan(&vehicle, &limits, &request, &|| {}) {
            Err(error @ (PlanError::Conflict(_) | PlanError::Request { .. })) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let heights = message(&|limits, _| limits.z_min_m = Some(2.0));
    assert!(heights.contains("z_min_m = 2") && heights.contains("z_max_m = 1.5"), "{heights}");
    let start = message(&|_, request| request.start.x_m = Some(3.0));
    assert!(start.contains("x_max_m") && start.contains("start at x = 3"), "{start}");
    let thrust = message(&|limits, _| limits.thrust_max_n = Some(10.0));
    assert!(thrust.contains("thrust_max_n = 10") && thrust.contains("weight of 17.560 N"), "{thrust}");
    let speed = message(&|limits, _| limits.speed_max_m_s = Some(0.0));
    assert!(speed.contains("speed_max_m_s = 0"), "{speed}");
    let harmonics = message(&|_, request| request.harmonics = 2);
    assert!(harmonics.contains("4 to 20, got 2"), "{harmonics}");
}

#[test]
fn a_whole_flight_keeps_the_limits_and_has_no_steps() {
    let vehicle = vehicle("x500.toml");
    let request = PlanRequest { starts: 2, criterion: Criterion::DOpt, ..PlanRequest::default() };
    let planned = plan(&vehicle, &vehicle.limits, &request, &|| {}).unwrap();
    let bounds = bounds_of(&vehicle.limits, &vehicle);
    let dynamics = mavid::plan::Dynamics::new(&vehicle);
    let flight = FlightPlan {
        takeoff: [0.5, -0.5, 2.0, 0.0],
        landing: [0.0, 0.0, 1.0, 0.0],
        hover_s: 2.0,
        repeats: 4,
    };
    let path = flight_path(&planned.trajectory, &flight, &bounds, &dynamics).unwrap();
    assert!(path.duration_s() > 46.0);
    let at = |t: f64| path.derivatives(t).unwrap();
    let inside: Vec<_> =
        bounds.into_iter().filter(|b| b.quantity != Quantity::Path { axis: 2, order: 0 }).collect();
    let report = check(at, path.duration_s(), &inside, &dynamics);
    assert_eq!(report.first_violation, None);
    let mut joint = 0.0;
    for (_, duration) in &path.segments {
        joint += duration;
        let (before, after) = (at(joint - 1e-7), at(joint + 1e-7));
        for axis in 0..4 {
            for order in 0..4 {
                let step = (after[axis][order] - before[axis][order]).abs();
                assert!(step < 1e-4, "joint {joint} axis {axis} order {order}");
            }
        }
    }
}

/// The Python peer is written from the paper's equations on its own.
#[test]
fn an_independent_program_finds_the_same() {
    let table_2 = configs().join("trajectories/table2.toml");
    let asked = ["assess", table_2.to_str().unwrap()];
    let theirs = match python::ask("plan_with_slsqp.py", &asked, &serde_json::Value::Null) {
        Ok(theirs) => theirs,
        Err(why) => return require::skip(require::Needed::Peers, &why),
    };
    let vehicle = vehicle("qball2.toml");
    let bounds = bounds_of(&vehicle.limits, &vehicle);
    let ours = assess(&read_trajectory(&table_2).unwrap().series, &vehicle, &bounds, &PlanRequest::default());
    let close = |key: &str, value: f64| {
        let their = theirs[key].as_f64().unwrap();
        assert!((their - value).abs() < 1e-8 * value, "{key}: {their} and {value}");
    };
    close("condition_number", ours.condition_number);
    close("roll_deg", largest(&ours.check, Quantity::Roll).to_degrees());
    close("pitch_deg", largest(&ours.check, Quantity::Pitch).to_degrees());
}

#[test]
fn progress_counts_the_work_after_the_search_as_well() {
    let vehicle = vehicle("qball2.toml");
    for rests_inside in [false, true] {
        let request = PlanRequest { starts: 2, rests_inside, ..PlanRequest::default() };
        let done = AtomicU64::new(0);
        let count = || {
            done.fetch_add(1, Ordering::Relaxed);
        };
        plan(&vehicle, &vehicle.limits, &request, &count).unwrap();
        assert_eq!(done.into_inner(), work_of(&request), "{rests_inside}");
        // with five margins of the rotors and eight distances inside the room
        let after = if rests_inside { 13 } else { 5 };
        assert_eq!(work_of(&request), search_of(&request).work() + after);
    }
}
