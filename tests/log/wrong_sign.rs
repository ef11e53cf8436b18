//! Logs of the autopilots' default profiles: ordinary regression finds the controller in them, and not the vehicle. Inertia comes out
//! of such a log with the right sign and size, or with a reason and no number.

use crate::support;

use std::path::{Path, PathBuf};

use mavid::draft::Given;
use mavid::estimate::Finding;
use mavid::inspect::{Inspection, inspect};
use mavid::log::OpenOptions;
use mavid::study::{IdentifyRequest, IdentifyStudy, Silent, StudyError, VehicleGiven, identify};

/// Places of Ixx, Iyy, Izz among the parameters.
const MOMENTS: [usize; 3] = [1, 4, 6];
/// An inertia of the default profile that is told is within so many of its standard errors.
const ERRORS: f64 = 3.0;

fn identified(log: PathBuf, vehicle: VehicleGiven) -> Result<IdentifyStudy, StudyError> {
    identify(&IdentifyRequest { vehicle, logs: vec![log], ..IdentifyRequest::default() }, &Silent)
}

fn moments(study: &IdentifyStudy) -> [Finding; 3] {
    MOMENTS.map(|index| study.identification.best.result.parameters[index].finding.clone())
}

fn inspected(log: &Path) -> Inspection {
    inspect(log, &OpenOptions::default(), None, &mut |_| ()).unwrap()
}

/// What `inspect` says of inertia: whether it can be told, the reason why not, and what to set.
fn inertia(found: &Inspection) -> (&'static str, String, String) {
    let quantity = found.quantities.iter().find(|quantity| quantity.name == "inertia").unwrap();
    let text = |words: &Option<String>| words.clone().unwrap_or_default();
    (quantity.status, text(&quantity.reason), text(&quantity.set))
}

#[test]
fn real_quadrotors_of_the_default_profile_give_no_inertia() {
    let Some(shared) = support::shared() else { return };
    for name in ["px4_115_cubeorange_quad.ulg", "px4_190_quad_esc_status.ulg"] {
        let log = shared.join("onboard/logs").join(name);
        let (status, reason, _) = inertia(&inspected(&log));
        assert!(status == "no" && !reason.is_empty(), "{name}: {status} {reason}");
        let weighed = Given { mass_kg: 1.5, size_m: Some(0.5), frame: None };
        match identified(log, VehicleGiven::Weighed(weighed)) {
            Ok(study) => {
                for finding in moments(&study) {
                    let Finding::NotDetermined { reason } = finding else { panic!("{name}: {finding:?}") };
                    assert!(!reason.is_empty(), "{name}");
                }
            }
            Err(refusal) => assert!(!refusal.to_string().is_empty(), "{name}"),
        }
    }
}

#[test]
fn simulated_flights_of_px4s_default_profile_have_the_right_sign_or_none() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    for flight in ["px02", "px03", "px08"] {
        let vehicle = VehicleGiven::File(folder.join("px4-v1.toml"));
        let study = identified(folder.join(format!("{flight}.ulg")), vehicle).unwrap();
        let parameters = &study.identification.best.result.parameters;
        let Finding::Determined { value: mass_kg, .. } = parameters[0].finding else { panic!("{flight}") };
        // the battery takes thrust away in one of them: all is too large by that
        let scale = mass_kg / study.vehicle.body.mass_kg;
        for (axis, finding) in moments(&study).into_iter().enumerate() {
            let Finding::Determined { value, std } = finding else { continue };
            let stated = scale * study.vehicle.body.inertia_kg_m2[(axis, axis)];
            let is_right = value > 2.0 * std && (value - stated).abs() < ERRORS * std.max(0.05 * stated);
            assert!(is_right, "{flight}: {value} +- {std}, is {stated}, axis {axis}");
        }
    }
}

#[test]
fn inertia_cannot_come_from_ardupilots_default_log_and_what_to_set_is_said() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    for (flight, vehicle) in
        [("ap02", "ardupilot-quad-a"), ("ap04", "ardupilot-quad-a"), ("ap06", "ardupilot-hexa-b")]
    {
        let log = folder.join(format!("{flight}.bin"));
        let (status, reason, set) = inertia(&inspected(&log));
        assert_eq!(status, "no", "{flight}: {reason}");
        assert!(reason.contains("10 Hz: too slow"), "{flight}: {reason}");
        assert!(
            set.contains("(adds fast attitude, fast IMU)") && set.contains("LOG_BITMASK = "),
            "{flight}: {set}"
        );
        let vehicle = VehicleGiven::File(folder.join(format!("{vehicle}.toml")));
        let study = identified(log, vehicle).unwrap();
        for finding in moments(&study) {
            assert!(matches!(finding, Finding::NotDetermined { .. }), "{flight}: {finding:?}");
        }
        let notes = study.flights.iter().flat_map(|flight| &flight.quality.notes);
        let told: Vec<&str> = notes.map(|note| note.text.as_str()).collect();
        assert!(told.iter().any(|text| text.contains("set LOG_BITMASK = ")), "{flight}: {told:?}");
    }
}

#[test]
fn a_real_log_at_ten_hertz_gives_no_inertia_and_says_what_to_set() {
    let Some(shared) = support::shared() else { return };
    for flight in ["flight_01.BIN", "flight_08.BIN"] {
        let (status, reason, set) = inertia(&inspected(&shared.join("onboard/propeller_cut").join(flight)));
        assert!(status == "no" && reason.contains("too slow"), "{flight}: {status} {reason}");
        assert!(set.contains("LOG_BITMASK"), "{flight}: {set}");
    }
}
